// The phase map: final tilt over spin and friction, drawn cell by cell as it is computed; a cell is a launch.

const LEFT = 54;
const BOTTOM = 40;
const TOP = 8;
const RIGHT = 10;
const STOPS = [[0, 34, 78], [60, 78, 108], [124, 123, 120], [187, 174, 108], [254, 232, 56]];

export class PhaseMap extends EventTarget {
  constructor(canvas, tip) {
    super();
    this.canvas = canvas;
    this.tip = tip;
    this.pen = canvas.getContext("2d");
    this.cells = null;
    this.chosen = null;
    this.resizing = new ResizeObserver(() => this.draw());
    this.resizing.observe(canvas);
    canvas.addEventListener("pointermove", (event) => this.point(this.cellAt(event)));
    canvas.addEventListener("pointerleave", () => this.point(null));
    canvas.addEventListener("click", (event) => this.choose(this.cellAt(event)));
    canvas.addEventListener("keydown", (event) => this.key(event));
  }

  // Begin a map: its spins, friction coefficients, the unit of the latter, and spins to mark.
  begin({ spins, frictions, unit, marks }) {
    Object.assign(this, { spins, frictions, unit, marks });
    this.cells = frictions.map(() => null);
    this.point(null);
    this.draw();
  }

  put(row, tilts, flights) {
    if (!this.cells) return;
    this.cells[row] = { tilts, flights };
    this.draw();
  }

  // Mark the launch that is shown now.
  here(spin, mu) {
    this.now = [spin, mu];
    this.draw();
  }

  setTheme(dark) {
    this.dark = dark;
    this.draw();
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
    return this.cells[row] && column >= 0 && column < this.spins.length ? [row, column] : null;
  }

  key(event) {
    const moves = { ArrowLeft: [0, -1], ArrowRight: [0, 1], ArrowUp: [1, 0], ArrowDown: [-1, 0] };
    if (!this.cells) return;
    if (moves[event.key]) {
      const [row, column] = this.chosen ?? [0, 0];
      const [up, along] = this.chosen ? moves[event.key] : [0, 0];
      const next = [
        Math.min(Math.max(row + up, 0), this.frictions.length - 1),
        Math.min(Math.max(column + along, 0), this.spins.length - 1),
      ];
      if (this.cells[next[0]]) this.point(next);
    } else if (event.key === "Enter" || event.key === " ") this.choose(this.chosen);
    else return;
    event.preventDefault();
  }

  point(cell) {
    this.chosen = cell;
    if (cell) {
      const [row, column] = cell;
      const { tilts, flights } = this.cells[row];
      const angle = ((tilts[column] * 180) / Math.PI).toFixed(1);
      const flew = flights[column] ? `, leaves the table ${flights[column]}×` : "";
      this.tip.textContent =
        `spin ${round(this.spins[column])} rad/s, μ ${round(this.frictions[row])}${this.unit}: ends at ${angle}°${flew}`;
    } else this.tip.textContent = this.cells ? "Point at a cell, click to launch it." : "";
    this.draw();
  }

  choose(cell) {
    if (!cell) return;
    const [row, column] = cell;
    const detail = { spin: this.spins[column], mu: this.frictions[row] };
    this.dispatchEvent(new CustomEvent("launch", { detail }));
  }

  draw() {
    const ratio = globalThis.devicePixelRatio || 1;
    const { clientWidth, clientHeight } = this.canvas;
    this.canvas.width = Math.round(clientWidth * ratio);
    this.canvas.height = Math.round(clientHeight * ratio);
    const pen = this.pen;
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, clientWidth, clientHeight);
    if (!this.cells) return;
    const { x, y, width, height } = this.box;
    const [w, h] = [width / this.spins.length, height / this.frictions.length];
    pen.fillStyle = this.dark ? "#2a313a" : "#e6eaee";
    pen.fillRect(x, y, width, height);
    this.cells.forEach((cells, row) => {
      cells?.tilts.forEach((tilt, column) => {
        const [left, top] = [x + column * w, y + height - (row + 1) * h];
        pen.fillStyle = colour(tilt / Math.PI);
        pen.fillRect(left, top, w + 0.6, h + 0.6);
        if (cells.flights[column]) {
          pen.fillStyle = "#e03c31";
          pen.beginPath();
          pen.arc(left + w / 2, top + h / 2, Math.min(w, h) * 0.17, 0, 7);
          pen.fill();
        }
      });
    });
    this.frame(x, y, width, height, w, h);
  }

  frame(x, y, width, height, w, h) {
    const pen = this.pen;
    const ink = this.dark ? "#d3dae1" : "#2b343c";
    pen.font = "11px system-ui, sans-serif";
    pen.fillStyle = ink;
    pen.textAlign = "center";
    const every = Math.ceil(this.spins.length / Math.max(3, Math.floor(width / 52)));
    this.spins.forEach((spin, k) => k % every === 0 && pen.fillText(round(spin), x + (k + 0.5) * w, y + height + 14));
    pen.fillText("spin (rad/s)", x + width / 2, y + height + 32);
    pen.textAlign = "right";
    const rows = Math.ceil(this.frictions.length / Math.max(3, Math.floor(height / 28)));
    this.frictions.forEach((mu, k) => {
      if (k % rows === 0) pen.fillText(round(mu), x - 6, y + height - (k + 0.5) * h + 4);
    });
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
      const [row, column] = this.chosen;
      pen.lineWidth = 2;
      pen.strokeStyle = ink;
      pen.strokeRect(x + column * w, y + height - (row + 1) * h, w, h);
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

function round(value) {
  return `${+value.toPrecision(3)}`;
}
