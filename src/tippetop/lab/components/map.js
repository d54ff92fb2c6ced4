// The phase map: final tilt over spin and friction, drawn from coarse to fine as it is computed; a cell is a launch.

import { echarts } from "nicegui-echart";

// How far a cell reaches until the finer ones between it and the next are known.
const REACH = [1, 2, 4];
const STOPS = ["#00224e", "#3c4e6c", "#7c7b78", "#bbae6c", "#fee838"];
const TICKS = [-5, -4, -3, -2, -1, 0, 1, 2, 3, 4].flatMap((power) => [1, 2, 5].map((k) => k * 10 ** power));

export class PhaseMap extends EventTarget {
  constructor(host, tip) {
    super();
    Object.assign(this, { host, tip, cells: null, chosen: null, now: null });
    this.chart = echarts.init(host, null, { renderer: "canvas" });
    const surface = this.chart.getZr();
    surface.on("mousemove", (event) => this.point(this.cellAt(event)));
    surface.on("globalout", () => this.point(null));
    surface.on("click", (event) => this.choose(this.cellAt(event)));
    host.addEventListener("keydown", (event) => this.key(event));
    this.resizing = new ResizeObserver(() => this.chart.resize());
    this.resizing.observe(host);
  }

  // Begin a map: its spins, friction coefficients, the unit of the latter, and spins to mark.
  begin(spins, frictions, unit, marks) {
    Object.assign(this, { spins, frictions, unit, marks });
    const step = (spins.at(-1) - spins[0]) / (spins.length - 1);
    const ratio = (frictions.at(-1) / frictions[0]) ** (1 / (frictions.length - 1));
    // The lower edges of columns and rows, and in which of them a spin and a friction coefficient are.
    this.left = (column) => spins[0] + (column - 0.5) * step;
    this.below = (row) => frictions[0] * ratio ** (row - 0.5);
    this.column = (spin) => Math.floor((spin - spins[0]) / step + 0.5);
    this.row = (mu) => Math.floor(Math.log(mu / frictions[0]) / Math.log(ratio) + 0.5);
    this.cells = new Array(spins.length * frictions.length).fill(null);
    this.draw();
    this.point(null);
  }

  // Some cells by their numbers, counted along the spins, row by row.
  put(cells, tilts, flights, fates) {
    if (!this.cells) return;
    cells.forEach((cell, k) => (this.cells[cell] = { tilt: tilts[k], flights: flights[k], fate: fates[k] }));
    this.draw();
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
    this.update("now", place ? [place] : []);
  }

  setTheme(dark) {
    this.dark = dark;
    this.draw();
  }

  cellAt({ offsetX, offsetY }) {
    const place = [offsetX, offsetY];
    if (!this.cells || !this.chart.containPixel("grid", place)) return null;
    const [spin, mu] = this.chart.convertFromPixel("grid", place);
    return this.shown(this.row(mu), this.column(spin));
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
    this.update("chosen", cell ? [[cell.column, cell.row, cell.reach]] : []);
  }

  choose(cell) {
    if (!cell) return;
    const detail = { spin: this.spins[cell.column], mu: this.frictions[cell.row] };
    this.dispatchEvent(new CustomEvent("launch", { detail }));
  }

  update(id, data) {
    if (this.cells) this.chart.setOption({ series: [{ id, data }] });
  }

  draw() {
    if (!this.cells) return;
    const places = [];
    const flown = [];
    this.frictions.forEach((mu, row) =>
      this.spins.forEach((spin, column) => {
        const cell = this.shown(row, column);
        if (!cell) return;
        places.push([column, row, 1, cell.tilt]);
        if (cell.tilt !== null && cell.flights) flown.push([spin, mu]);
      }),
    );
    const [ink, empty] = this.dark ? ["#d3dae1", "#2a313a"] : ["#2b343c", "#e6eaee"];
    const axis = {
      nameLocation: "middle", nameTextStyle: { color: ink, fontSize: 11 }, axisLabel: { color: ink, fontSize: 11 },
      axisLine: { show: false }, axisTick: { show: false }, splitLine: { show: false },
    };
    const unit = this.unit ? ` (${this.unit.trim()})` : "";
    const rectangle = (style) => (_, api) => (
      { type: "rect", shape: this.rectangle(api), style: style(api.value(3)) }
    );
    const fill = (tilt) => ({ fill: Number.isNaN(tilt) ? HATCH : echarts.color.lerp(tilt / Math.PI, STOPS) });
    const dashes = { color: "#ffffff", type: [5, 4], width: 1.5 };
    const halo = { shadowColor: "#ffffff", shadowBlur: 4 };
    const ring = { color: "transparent", borderColor: "#9e1f54", borderWidth: 2.5, ...halo };
    const frame = () => ({ fill: "none", stroke: "#1e252d", lineWidth: 2, ...halo });
    this.chart.setOption({
      animation: false,
      grid: {
        left: 54, right: 10, top: 8, bottom: 40, outerBoundsMode: "none",
        show: true, backgroundColor: empty, borderWidth: 0,
      },
      xAxis: {
        ...axis, type: "value", name: "spin (rad/s)", nameGap: 24, interval: 50,
        min: this.left(0), max: this.left(this.spins.length),
      },
      yAxis: {
        ...axis, type: "log", name: `μ${unit}`, nameGap: 38,
        min: this.below(0), max: this.below(this.frictions.length),
        axisLabel: { ...axis.axisLabel, customValues: TICKS, formatter: (mu) => `${+mu.toPrecision(1)}` },
      },
      series: [
        { id: "cells", type: "custom", data: places, silent: true, renderItem: rectangle(fill),
          markLine: { silent: true, symbol: "none", label: { show: false }, lineStyle: dashes,
            data: this.marks.map((xAxis) => ({ xAxis })) } },
        { id: "flown", type: "scatter", data: flown, silent: true, symbolSize: 3, itemStyle: { color: "#e03c31" } },
        { id: "now", type: "scatter", silent: true, z: 4, symbolSize: 12, itemStyle: ring },
        { id: "chosen", type: "custom", silent: true, z: 5, renderItem: rectangle(frame) },
      ],
    });
  }

  // Where a square of so many places is, in whole pixels: without a seam between neighbours.
  rectangle(api) {
    const [column, row, reach] = [0, 1, 2].map((k) => api.value(k));
    const last = [Math.min(column + reach, this.spins.length), Math.min(row + reach, this.frictions.length)];
    const [x, bottom] = api.coord([this.left(column), this.below(row)]).map(Math.round);
    const [right, y] = api.coord([this.left(last[0]), this.below(last[1])]).map(Math.round);
    return { x, y, width: right - x, height: bottom - y };
  }

  dispose() {
    this.resizing.disconnect();
    this.chart.dispose();
  }
}

// What a launch came to that was followed to its end.
function ended({ tilt, flights }) {
  const flew = flights ? `, leaves the table ${flights}×` : "";
  return `ends at ${((tilt * 180) / Math.PI).toFixed(1)}°${flew}`;
}

// Stripes for cells without a final tilt, unlike any colour of one.
const HATCH = (() => {
  const image = document.createElement("canvas");
  image.width = image.height = 6;
  const brush = image.getContext("2d");
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
  return { image, repeat: "repeat" };
})();
