// The map's picture: squares coloured by the final tilt, coarse ones where finer are not known yet.

import { frictionKind } from "./dials.js";
import { t } from "./i18n.js";
import { changed, same } from "./setup.js";
import { digits, shown } from "./units.js";

const STOPS = ["#00224e", "#3c4e6c", "#7c7b78", "#bbae6c", "#fee838"].map((colour) =>
  [1, 3, 5].map((k) => parseInt(colour.slice(k, k + 2), 16)),
);
// Colours of launches that end at no tilt, of a dot on those that leave the table, of a bar on those that rose and fell
// back, and of the marked one's frame.
const FAILED = "#8f5fc4";
const FLYING = "#e03c31";
const BACK = "#37d3c0";
const MARK = "#ff3d7f";

// The highest spin of a map, rad/s.
export const HIGHEST = 250;

// Rows and columns that a cell stands for, grid by grid: the finest first.
const REACH = [1, 2, 4, 8];
const ROOM = { left: 50, right: 14, top: 8, bottom: 34 };
// Rows and columns by which keys move the mark.
const MOVES = { ArrowLeft: [0, -1], ArrowRight: [0, 1], ArrowUp: [1, 0], ArrowDown: [-1, 0] };

// Number of the grid at which a cell is computed: 0 for the coarsest.
export function fineness({ row, column }) {
  const coarsest = REACH.findLastIndex((reach) => row % reach === 0 && column % reach === 0);
  return REACH.length - 1 - coarsest;
}

// Whether a launch is one of a map's: all but its spin and its friction is as there.
function isOnMap({ setup }, launch) {
  const { launch: start, friction } = launch.problem;
  const moved = changed(setup, { "launch.spin": start.spin, "friction.mu": friction.mu });
  return same(moved, launch);
}

function colourOf(tilt) {
  if (!Number.isFinite(tilt)) return FAILED;
  const place = Math.min(Math.max(tilt / Math.PI, 0), 1) * (STOPS.length - 1);
  const k = Math.min(Math.floor(place), STOPS.length - 2);
  const mixed = STOPS[k].map((low, channel) =>
    Math.round(low + (place - k) * (STOPS[k + 1][channel] - low)),
  );
  return `rgb(${mixed})`;
}

export class Chart {
  constructor(canvas, { choose, point }) {
    this.canvas = canvas;
    this.choose = choose;
    this.point = point;
    this.chosen = null;
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
      const firstRow = row - (row % reach);
      const firstColumn = column - (column % reach);
      const answer = this.cells[firstRow * this.plan.spins.length + firstColumn];
      if (answer) return { row: firstRow, column: firstColumn, reach, answer };
    }
    return null;
  }

  // Where the chart is within its numbers, pixels, with the size of a cell.
  get box() {
    const { clientWidth, clientHeight } = this.canvas;
    const width = clientWidth - ROOM.left - ROOM.right;
    const height = clientHeight - ROOM.top - ROOM.bottom;
    return { width, height, across: width / this.columns, up: height / this.rows };
  }

  get rows() {
    return this.plan.frictions.length;
  }

  get columns() {
    return this.plan.spins.length;
  }

  cellAt({ offsetX, offsetY }) {
    if (!this.plan) return null;
    const { width, height } = this.box;
    const column = Math.floor(((offsetX - ROOM.left) / width) * this.columns);
    const row = Math.floor((1 - (offsetY - ROOM.top) / height) * this.rows);
    const isInside = column >= 0 && row >= 0 && column < this.columns && row < this.rows;
    return isInside ? this.shown(row, column) : null;
  }

  key(event) {
    if (!this.plan) return;
    const isChoice = event.key === "Enter" || event.key === " ";
    if (MOVES[event.key]) this.moveMark(...MOVES[event.key]);
    else if (isChoice && this.chosen) this.choose(this.chosen);
    else return;
    event.preventDefault();
  }

  // Mark the launch beside the marked one, or the first of all; the mark stays where no answer is known yet.
  moveMark(up, along) {
    const { row, column, reach } = this.chosen ?? { row: 0, column: 0, reach: 0 };
    const next = (place, by, count) => Math.min(Math.max(place + by * reach, 0), count - 1);
    const beside = this.shown(next(row, up, this.rows), next(column, along, this.columns));
    if (beside) this.mark(beside);
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
    const { canvas } = this;
    const ratio = devicePixelRatio || 1;
    canvas.width = canvas.clientWidth * ratio;
    canvas.height = canvas.clientHeight * ratio;
    const pen = canvas.getContext("2d");
    pen.scale(ratio, ratio);
    if (!this.plan) return;
    const style = getComputedStyle(canvas);
    this.drawCells(pen, style.getPropertyValue("--line"));
    pen.fillStyle = style.color;
    pen.font = "11px system-ui";
    this.drawSpins(pen);
    this.drawFrictions(pen);
    if (this.chosen) this.drawMark(pen, this.chosen);
    this.drawLaunch(pen);
  }

  // Left and upper edge of a cell, pixels.
  cornerOf(row, column) {
    const { height, across, up } = this.box;
    return [ROOM.left + column * across, ROOM.top + height - (row + 1) * up];
  }

  drawCells(pen, empty) {
    const { across, up } = this.box;
    for (let row = 0; row < this.rows; row++) {
      for (let column = 0; column < this.columns; column++) {
        const cell = this.shown(row, column);
        const [x, y] = this.cornerOf(row, column);
        pen.fillStyle = cell ? colourOf(cell.answer.tilt) : empty;
        // A bit wider than a cell, so that nothing shines through between two.
        pen.fillRect(x, y, across + 0.6, up + 0.6);
        if (cell?.answer.fellBack) {
          pen.fillStyle = BACK;
          pen.fillRect(x, y + 0.72 * up, across + 0.6, 0.28 * up);
        }
        if (!cell?.answer.flights) continue;
        pen.fillStyle = FLYING;
        pen.fillRect(x + 0.35 * across, y + 0.3 * up, 0.3 * across, 0.4 * up);
      }
    }
  }

  drawMark(pen, { row, column, reach }) {
    const { across, up } = this.box;
    const [x, y] = this.cornerOf(row + reach - 1, column);
    pen.strokeStyle = MARK;
    pen.lineWidth = 2;
    pen.strokeRect(x, y, across * reach, up * reach);
  }

  drawSpins(pen) {
    const { units } = this.state;
    const { width, height } = this.box;
    pen.textAlign = "center";
    for (const spin of [0, 50, 100, 150, 200, 250]) {
      const [number] = shown(spin, "spin", units, 3).split(" ");
      pen.fillText(number, ROOM.left + (width * spin) / HIGHEST, ROOM.top + height + 14);
    }
    const [, unit] = shown(1, "spin", units).split(" ");
    pen.fillText(`${t("map.spin")} (${unit})`, ROOM.left + width / 2, ROOM.top + height + 29);
  }

  drawFrictions(pen) {
    const { height, up } = this.box;
    pen.textAlign = "right";
    for (const row of [0, Math.floor(this.rows / 2), this.rows - 1]) {
      const y = ROOM.top + height - (row + 0.5) * up + 4;
      pen.fillText(digits(this.plan.frictions[row], 2), ROOM.left - 5, y);
    }
    pen.save();
    pen.translate(11, ROOM.top + height / 2);
    pen.rotate(-Math.PI / 2);
    pen.textAlign = "center";
    const unit = frictionKind(this.plan.setup);
    pen.fillText(`${t("map.friction")}${unit && ` (${unit})`}`, 0, 0);
    pen.restore();
  }

  // A circle where the launch is that the player shows, if the map has it.
  drawLaunch(pen) {
    const { width, height } = this.box;
    const { setup } = this.state;
    if (!isOnMap(this.plan, setup)) return;
    const { launch, friction } = setup.problem;
    const low = Math.log(this.plan.frictions[0]);
    const high = Math.log(this.plan.frictions.at(-1));
    const share = (Math.log(friction.mu) - low) / (high - low);
    const isInside = share >= 0 && share <= 1 && launch.spin >= 0 && launch.spin <= HIGHEST;
    if (!isInside) return;
    const x = ROOM.left + (width * launch.spin) / HIGHEST;
    const y = ROOM.top + height * (1 - share);
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
