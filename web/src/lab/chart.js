// The map's picture: squares coloured by the final tilt, coarse ones where finer are not known yet.

import { frictionKind } from "./dials.js";
import { t } from "./i18n.js";
import { digits, shown } from "./units.js";

const STOPS = ["#00224e", "#3c4e6c", "#7c7b78", "#bbae6c", "#fee838"].map((colour) =>
  [1, 3, 5].map((k) => parseInt(colour.slice(k, k + 2), 16)),
);
const REACH = [1, 2, 4];
const ROOM = { left: 50, right: 14, top: 8, bottom: 34 };

// How fine a grid must be to have a cell: 0 for the coarsest.
export function fineness({ row, column }) {
  return row % 4 === 0 && column % 4 === 0 ? 0 : row % 2 === 0 && column % 2 === 0 ? 1 : 2;
}

function colourOf(tilt) {
  const place = Math.min(Math.max(tilt / Math.PI, 0), 1) * (STOPS.length - 1) || 0;
  const k = Math.min(Math.floor(place), STOPS.length - 2);
  const mixed = STOPS[k].map((low, channel) =>
    Math.round(low + (place - k) * (STOPS[k + 1][channel] - low)),
  );
  return `rgb(${mixed})`;
}

export class Chart {
  constructor(canvas, { choose, point }) {
    Object.assign(this, { canvas, choose, point, chosen: null });
    canvas.addEventListener("pointermove", (event) => this.mark(this.cellAt(event)));
    canvas.addEventListener("pointerleave", () => this.mark(null));
    canvas.addEventListener("click", (event) => {
      const cell = this.cellAt(event);
      if (cell) choose(cell);
    });
    canvas.addEventListener("keydown", (event) => this.key(event));
    this.resizing = new ResizeObserver(() => this.redraw());
    this.resizing.observe(canvas);
  }

  load({ plan, cells }) {
    Object.assign(this, { plan, cells, chosen: null });
    this.redraw();
  }

  paint(state) {
    this.state = state;
    this.redraw();
  }

  // The launch that a place shows: its own, or a coarser one that reaches over it.
  shown(row, column) {
    for (const reach of REACH) {
      const [r, c] = [row - (row % reach), column - (column % reach)];
      const answer = this.cells[r * this.plan.spins.length + c];
      if (answer) return { row: r, column: c, reach, answer };
    }
    return null;
  }

  get box() {
    const { clientWidth, clientHeight } = this.canvas;
    return {
      width: clientWidth - ROOM.left - ROOM.right,
      height: clientHeight - ROOM.top - ROOM.bottom,
    };
  }

  cellAt({ offsetX, offsetY }) {
    if (!this.plan) return null;
    const { width, height } = this.box;
    const column = Math.floor(((offsetX - ROOM.left) / width) * this.plan.spins.length);
    const row = Math.floor((1 - (offsetY - ROOM.top) / height) * this.plan.frictions.length);
    const inside =
      column >= 0 &&
      row >= 0 &&
      column < this.plan.spins.length &&
      row < this.plan.frictions.length;
    return inside ? this.shown(row, column) : null;
  }

  key(event) {
    const moves = { ArrowLeft: [0, -1], ArrowRight: [0, 1], ArrowUp: [1, 0], ArrowDown: [-1, 0] };
    if (!this.plan) return;
    if (moves[event.key]) {
      const { row, column, reach } = this.chosen ?? { row: 0, column: 0, reach: 0 };
      const [up, along] = moves[event.key];
      const next = (at, step, count) => Math.min(Math.max(at + step * reach, 0), count - 1);
      this.mark(
        this.shown(
          next(row, up, this.plan.frictions.length),
          next(column, along, this.plan.spins.length),
        ),
      );
    } else if ((event.key === "Enter" || event.key === " ") && this.chosen)
      this.choose(this.chosen);
    else return;
    event.preventDefault();
  }

  mark(cell) {
    if (!this.plan) return;
    this.chosen = cell;
    this.point(cell);
    this.redraw();
  }

  redraw() {
    cancelAnimationFrame(this.waiting);
    this.waiting = requestAnimationFrame(() => this.draw());
  }

  draw() {
    const { canvas, plan } = this;
    const ratio = devicePixelRatio || 1;
    canvas.width = canvas.clientWidth * ratio;
    canvas.height = canvas.clientHeight * ratio;
    const pen = canvas.getContext("2d");
    pen.scale(ratio, ratio);
    if (!plan) return;
    const style = getComputedStyle(canvas);
    const { width, height } = this.box;
    const [across, up] = [width / plan.spins.length, height / plan.frictions.length];
    const place = (row, column) => [
      ROOM.left + column * across,
      ROOM.top + height - (row + 1) * up,
    ];
    for (let row = 0; row < plan.frictions.length; row++) {
      for (let column = 0; column < plan.spins.length; column++) {
        const cell = this.shown(row, column);
        const [x, y] = place(row, column);
        pen.fillStyle = !cell
          ? style.getPropertyValue("--line")
          : Number.isFinite(cell.answer.tilt)
            ? colourOf(cell.answer.tilt)
            : "#8f5fc4";
        pen.fillRect(x, y, across + 0.6, up + 0.6);
        if (!cell?.answer.flights) continue;
        pen.fillStyle = "#e03c31";
        pen.fillRect(x + 0.35 * across, y + 0.3 * up, 0.3 * across, 0.4 * up);
      }
    }
    this.axes(pen, style.color, width, height);
    if (this.chosen) {
      const { row, column, reach } = this.chosen;
      const [x, y] = place(row + reach - 1, column);
      pen.strokeStyle = "#ff3d7f";
      pen.lineWidth = 2;
      pen.strokeRect(x, y, across * reach, up * reach);
    }
    this.here(pen, width, height);
  }

  axes(pen, ink, width, height) {
    const { plan, state } = this;
    pen.fillStyle = ink;
    pen.font = "11px system-ui";
    pen.textAlign = "center";
    for (const spin of [0, 50, 100, 150, 200, 250]) {
      const text = shown(spin, "spin", state.units, 3).split(" ")[0];
      pen.fillText(text, ROOM.left + (width * spin) / 250, ROOM.top + height + 14);
    }
    const unit = shown(1, "spin", state.units).split(" ")[1];
    pen.fillText(`${t("map.spin")} (${unit})`, ROOM.left + width / 2, ROOM.top + height + 29);
    pen.textAlign = "right";
    const count = plan.frictions.length;
    for (const row of [0, Math.floor(count / 2), count - 1]) {
      pen.fillText(
        digits(plan.frictions[row], 2),
        ROOM.left - 5,
        ROOM.top + height - (row + 0.5) * (height / count) + 4,
      );
    }
    pen.save();
    pen.translate(11, ROOM.top + height / 2);
    pen.rotate(-Math.PI / 2);
    pen.textAlign = "center";
    const kind = frictionKind(plan.setup);
    pen.fillText(`${t("map.friction")}${kind && ` (${kind})`}`, 0, 0);
    pen.restore();
  }

  // Where the launch is that is shown now.
  here(pen, width, height) {
    const { launch, friction } = this.state.setup.problem;
    const [low, high] = [Math.log(this.plan.frictions[0]), Math.log(this.plan.frictions.at(-1))];
    const share = (Math.log(friction.mu) - low) / (high - low);
    if (!(share >= 0 && share <= 1 && launch.spin >= 0 && launch.spin <= 250)) return;
    const [x, y] = [ROOM.left + (width * launch.spin) / 250, ROOM.top + height * (1 - share)];
    pen.strokeStyle = "#ffffff";
    pen.lineWidth = 4;
    pen.beginPath();
    pen.arc(x, y, 6, 0, 7);
    pen.stroke();
    pen.strokeStyle = "#d6336c";
    pen.lineWidth = 2;
    pen.stroke();
  }

  dispose() {
    cancelAnimationFrame(this.waiting);
    this.resizing.disconnect();
  }
}
