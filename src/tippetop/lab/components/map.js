// The phase map: final tilt over spin and friction, drawn from coarse to fine as it is computed; a cell is a launch.

const LEFT = 54;
const BOTTOM = 40;
const TOP = 8;
const RIGHT = 10;
// How far a cell reaches until the finer ones between it and the next are known.
const REACH = [1, 2, 4];
const STOPS = [[0, 34, 78], [60, 78, 108], [124, 123, 120], [187, 174, 108], [254, 232, 56]];

export class PhaseMap extends EventTarget {
  constructor(canvas, tip) {
    super();
    this.canvas = canvas;
    this.tip = tip;
    this.pen = canvas.getContext("2d");
    this.cells = null;
    this.chosen = null;
    this.picture = document.createElement("canvas");
    this.resizing = new ResizeObserver(() => this.paint());
    this.resizing.observe(canvas);
    canvas.addEventListener("pointermove", (event) => this.point(this.cellAt(event)));
    canvas.addEventListener("pointerleave", () => this.point(null));
    canvas.addEventListener("click", (event) => this.choose(this.cellAt(event)));
    canvas.addEventListener("keydown", (event) => this.key(event));
  }

  // Begin a map: its spins, friction coefficients, the unit of the latter, and spins to mark.
  begin(spins, frictions, unit, marks) {
    Object.assign(this, { spins, frictions, unit, marks });
    this.cells = new Array(spins.length * frictions.length).fill(null);
    this.paint();
    this.point(null);
  }

  // Some cells by their numbers, counted along the spins, row by row.
  put(cells, tilts, flights, fates) {
    if (!this.cells) return;
    cells.forEach((cell, k) => (this.cells[cell] = { tilt: tilts[k], flights: flights[k], fate: fates[k] }));
    this.paint();
  }

  // The launch that a place of the map shows: its own, or a coarser one that reaches over it.
  shown(row, column) {
    for (const reach of REACH) {
      const [r, c] = [row - (row % reach), column - (column % reach)];
      const cell = this.cells[r * this.spins.length + c];
      if (cell) return { ...cell, row: r, column: c, reach };
    }
    return null;
  }

  // Mark the spin and friction of the launch that is shown now; null if it is not on the map.
  here(place) {
    this.now = place;
    this.draw();
  }

  setTheme(dark) {
    this.dark = dark;
    this.paint();
  }

  get box() {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    return { x: LEFT, y: TOP, width: width - LEFT - RIGHT, height: height - TOP - BOTTOM };
  }

  cellAt(event) {
    if (!this.cells) return null;
    const { x, y, width, height } = this.box;
    const column = Math.floor(((event.offsetX - x) / width) * this.spins.length);
    const row = Math.floor((1 - (event.offsetY - y) / height) * this.frictions.length);
    const within = row >= 0 && row < this.frictions.length && column >= 0 && column < this.spins.length;
    return within ? this.shown(row, column) : null;
  }

  key(event) {
    const moves = { ArrowLeft: [0, -1], ArrowRight: [0, 1], ArrowUp: [1, 0], ArrowDown: [-1, 0] };
    if (!this.cells) return;
    if (moves[event.key]) {
      const { row, column, reach } = this.chosen ?? { row: 0, column: 0, reach: 1 };
      const [up, along] = this.chosen ? moves[event.key] : [0, 0];
      const next = this.shown(
        Math.min(Math.max(row + up * reach, 0), this.frictions.length - 1),
        Math.min(Math.max(column + along * reach, 0), this.spins.length - 1),
      );
      if (next) this.point(next);
    } else if (event.key === "Enter" || event.key === " ") this.choose(this.chosen);
    else return;
    event.preventDefault();
  }

  point(cell) {
    this.chosen = cell;
    if (cell) {
      const where = `spin ${this.spins[cell.column]} rad/s, μ ${this.frictions[cell.row]}${this.unit}`;
      this.tip.textContent = `${where}: ${cell.fate || ended(cell)}`;
    } else this.tip.textContent = this.cells ? "Point at a cell, click to launch it." : "";
    this.draw();
  }

  choose(cell) {
    if (!cell) return;
    const detail = { spin: this.spins[cell.column], mu: this.frictions[cell.row] };
    this.dispatchEvent(new CustomEvent("launch", { detail }));
  }

  // Paint the cells; what moves above them is drawn over this picture.
  paint() {
    const ratio = globalThis.devicePixelRatio || 1;
    const { clientWidth, clientHeight } = this.canvas;
    for (const canvas of [this.canvas, this.picture]) {
      canvas.width = Math.round(clientWidth * ratio);
      canvas.height = Math.round(clientHeight * ratio);
    }
    if (this.cells && clientWidth) this.paintCells(this.picture.getContext("2d"), ratio);
    this.draw();
  }

  paintCells(pen, ratio) {
    const { x, y, width, height } = this.box;
    const [w, h] = [width / this.spins.length, height / this.frictions.length];
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.fillStyle = this.dark ? "#2a313a" : "#e6eaee";
    pen.fillRect(x, y, width, height);
    const hatch = hatching(pen);
    const dots = [];
    this.frictions.forEach((_, row) => {
      this.spins.forEach((_, column) => {
        const cell = this.shown(row, column);
        if (!cell) return;
        const [left, top] = [x + column * w, y + height - (row + 1) * h];
        pen.fillStyle = cell.tilt === null ? hatch : colour(cell.tilt / Math.PI);
        // Without a seam between neighbours, and not beyond the frame.
        pen.fillRect(left, top, Math.min(w + 0.6, x + width - left), Math.min(h + 0.6, y + height - top));
        if (cell.tilt !== null && cell.flights) dots.push([left + w / 2, top + h / 2]);
      });
    });
    pen.fillStyle = "#e03c31";
    pen.beginPath();
    for (const [left, top] of dots) {
      pen.moveTo(left, top);
      pen.arc(left, top, Math.max(1, Math.min(w, h) * 0.2), 0, 7);
    }
    pen.fill();
  }

  draw() {
    const ratio = globalThis.devicePixelRatio || 1;
    const { clientWidth, clientHeight } = this.canvas;
    const pen = this.pen;
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, clientWidth, clientHeight);
    if (!this.cells || !clientWidth) return;
    const { x, y, width, height } = this.box;
    pen.drawImage(this.picture, 0, 0, clientWidth, clientHeight);
    this.frame(x, y, width, height, width / this.spins.length, height / this.frictions.length);
  }

  frame(x, y, width, height, w, h) {
    const pen = this.pen;
    const ink = this.dark ? "#d3dae1" : "#2b343c";
    pen.font = "11px system-ui, sans-serif";
    pen.fillStyle = ink;
    pen.textAlign = "center";
    for (let spin = 0; spin <= this.spins.at(-1) * 1.1; spin += 50) {
      const at = along(this.spins, spin);
      if (at !== null) pen.fillText(`${spin}`, x + at * w, y + height + 14);
    }
    pen.fillText("spin (rad/s)", x + width / 2, y + height + 32);
    pen.textAlign = "right";
    for (let power = -5; power < 5; power++) {
      for (const first of [1, 2, 5]) {
        const at = along(this.frictions, first * 10 ** power);
        if (at !== null) pen.fillText(`${+(first * 10 ** power).toPrecision(1)}`, x - 6, y + height - at * h + 4);
      }
    }
    pen.save();
    pen.translate(12, y + height / 2);
    pen.rotate(-Math.PI / 2);
    pen.textAlign = "center";
    pen.fillText(`μ${this.unit ? ` (${this.unit.trim()})` : ""}`, 0, 0);
    pen.restore();
    for (const mark of this.marks) {
      const at = along(this.spins, mark);
      if (at === null) continue;
      pen.strokeStyle = "#ffffff";
      pen.setLineDash([5, 4]);
      pen.lineWidth = 1.5;
      pen.strokeRect(x + at * w, y, 0, height);
      pen.setLineDash([]);
    }
    if (this.now) {
      const [column, row] = [along(this.spins, this.now[0]), along(this.frictions, this.now[1])];
      if (column !== null && row !== null) {
        for (const [width_, style] of [[5, "#ffffff"], [2.5, "#9e1f54"]]) {
          pen.lineWidth = width_;
          pen.strokeStyle = style;
          pen.beginPath();
          pen.arc(x + column * w, y + height - row * h, 6, 0, 7);
          pen.stroke();
        }
      }
    }
    if (this.chosen) {
      const { row, column, reach } = this.chosen;
      const [left, below] = [x + column * w, y + height - row * h];
      const [wide, high] = [Math.min(reach * w, x + width - left), Math.min(reach * h, below - y)];
      for (const [wide_, style] of [[4, "#ffffff"], [2, "#1e252d"]]) {
        pen.lineWidth = wide_;
        pen.strokeStyle = style;
        pen.strokeRect(left, below - high, wide, high);
      }
    }
  }

  dispose() {
    this.resizing.disconnect();
  }
}

// Where a value lies among increasing ones, in cells from the left edge; null if it is beyond.
function along(values, value) {
  const last = values.length - 1;
  for (let k = 0; k < last; k++) {
    if (values[k] <= value && value <= values[k + 1]) return k + 0.5 + (value - values[k]) / (values[k + 1] - values[k]);
  }
  const edges = [values[0] - (values[1] - values[0]) / 2, values[last] + (values[last] - values[last - 1]) / 2];
  if (value >= edges[0] && value < values[0]) return 0.5 - (values[0] - value) / (values[1] - values[0]);
  if (value > values[last] && value <= edges[1]) {
    return last + 0.5 + (value - values[last]) / (values[last] - values[last - 1]);
  }
  return null;
}

function colour(share) {
  const at = Math.min(Math.max(share, 0), 1) * (STOPS.length - 1);
  const low = Math.min(Math.floor(at), STOPS.length - 2);
  const mixed = STOPS[low].map((value, k) => Math.round(value + (at - low) * (STOPS[low + 1][k] - value)));
  return `rgb(${mixed.join()})`;
}

// What a launch came to that was followed to its end.
function ended({ tilt, flights }) {
  const flew = flights ? `, leaves the table ${flights}×` : "";
  return `ends at ${((tilt * 180) / Math.PI).toFixed(1)}°${flew}`;
}

// Stripes for cells without a final tilt, unlike any colour of one.
function hatching(pen) {
  const tile = document.createElement("canvas");
  tile.width = tile.height = 6;
  const brush = tile.getContext("2d");
  brush.fillStyle = "#e9def6";
  brush.fillRect(0, 0, 6, 6);
  brush.strokeStyle = "#8f5fc4";
  brush.lineWidth = 2;
  for (const shift of [-6, 0, 6]) {
    brush.beginPath();
    brush.moveTo(shift - 1, 7);
    brush.lineTo(shift + 7, -1);
    brush.stroke();
  }
  return pen.createPattern(tile, "repeat");
}
