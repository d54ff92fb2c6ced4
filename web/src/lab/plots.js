// Plots over time, linked to the player: curves of the run, pale ones of pinned runs, flights shaded.

import uPlot from "uplot";

import { READING } from "../player/player.js";
import { part, t } from "./i18n.js";
import { digits, unitOf } from "./units.js";

export const QUANTITIES = {
  theta: "angle",
  omega3: "spin",
  phi_dot: "spin",
  slip: "m/s",
  energy: "mJ",
  normal_force: "N",
  jellett_error: "",
  height: "mm",
};
export const USUAL = ["theta", "omega3", "phi_dot", "slip", "energy", "normal_force"];

const HEIGHT = 168;
const COLOURS = [
  "#0b5fa5",
  "#b3401f",
  "#1b7f4c",
  "#6a3fc0",
  "#8a6100",
  "#a3195b",
  "#0f7680",
  "#5c6670",
];
const DARK_COLOURS = [
  "#66c5f0",
  "#ff9b78",
  "#62d09a",
  "#b79cff",
  "#e3b34d",
  "#ff7fb5",
  "#5fd3dd",
  "#b4bdc6",
];
// How small a change beside the value counts as none: a constant is then seen as one.
const CONSTANT = 0.02;
const LEAST = { jellett_error: 1e-6, slip: 1e-7 };

// A number beside an axis, where there is little room.
const brief = (value) => digits(value, 4).replace(/[.,]0+e/, "e");

export class Plots {
  constructor(host, { seek, time, playing }) {
    Object.assign(this, {
      host,
      seek,
      time,
      playing,
      charts: [],
      window: null,
      ghosts: [],
      told: -Infinity,
    });
    this.resizing = new ResizeObserver(() => this.lay());
    this.resizing.observe(host);
  }

  load(track, ghosts, names, units, dark) {
    const before = JSON.stringify([this.names, this.units, this.dark]);
    Object.assign(this, { track, ghosts, names, units, dark });
    if (this.window && this.window[1] > track.duration) this.window = null;
    const same =
      before === JSON.stringify([names, units, dark]) &&
      this.language === t("name") &&
      this.charts.length;
    this.language = t("name");
    if (same) this.fill();
    else this.lay(true);
  }

  get span() {
    return this.window ?? [0, this.track?.duration || 1];
  }

  zoom(factor) {
    const whole = this.track?.duration || 1;
    const [begin, end] = this.span;
    const length = factor ? Math.max((end - begin) * factor, 0.01) : whole;
    const now = this.time();
    const start = Math.min(
      Math.max(now - ((now - begin) / (end - begin)) * length, 0),
      whole - length,
    );
    this.window = length >= whole ? null : [start, start + length];
    this.fill();
  }

  // Make every plot so large, pixels, whatever room there is; without a size, as large as there is room.
  size(width, height) {
    this.fixed = Boolean(width);
    for (const { chart } of width ? this.charts : []) chart.setSize({ width, height });
    this.lay();
    this.move();
  }

  lay(anew = false) {
    const width = this.host.clientWidth;
    if (!width || !this.track || this.fixed) return;
    const columns = width < 560 ? 1 : width < 1000 ? 2 : 3;
    const room = Math.floor(width / columns) - 8;
    this.host.style.gridTemplateColumns = `repeat(${columns}, minmax(0, 1fr))`;
    if (!anew && this.charts.length) {
      for (const { chart } of this.charts) chart.setSize({ width: room, height: HEIGHT });
      return;
    }
    this.clear();
    this.charts = this.names.map((name) => this.make(name, room));
    this.fill();
  }

  make(name, width) {
    const { name: title, symbol } = part(`quantities.${name}`);
    const { name: unit } = unitOf(QUANTITIES[name], this.units);
    const figure = document.createElement("figure");
    const caption = document.createElement("figcaption");
    const value = document.createElement("b");
    const label = `${title} ${symbol}${unit ? ` (${unit})` : ""}`;
    caption.append(label, value);
    figure.append(caption);
    figure.dataset.quantity = name;
    this.host.append(figure);
    const number = Object.keys(QUANTITIES).indexOf(name);
    const chart = new uPlot(
      this.options(name, width, number, `${symbol}${unit ? ` (${unit})` : ""}`),
      null,
      figure,
    );
    chart.root.setAttribute("role", "img");
    chart.root.setAttribute("aria-label", label);
    const cursor = document.createElement("i");
    cursor.className = "plot-now";
    chart.over.append(cursor);
    this.drag(chart);
    return { name, chart, cursor, value };
  }

  options(name, width, number, label) {
    const ink = this.dark ? "#c6ced6" : "#3b444d";
    const faint = this.dark ? "#2c343d" : "#e4e8ec";
    const axis = {
      stroke: ink,
      grid: { stroke: faint, width: 1 },
      ticks: { stroke: faint },
      font: "11px system-ui",
      labelFont: "11px system-ui",
      labelSize: 14,
      values: (_, ticks) => ticks.map(brief),
    };
    const colour = (this.dark ? DARK_COLOURS : COLOURS)[number];
    const quarters = () =>
      [0, 1, 2, 3, 4].map((k) => (k * Math.PI) / 4 / unitOf("angle", this.units).size);
    const turned =
      name === "theta"
        ? {
            splits: (_, __, low, high) =>
              this.window ? [0, 1, 2, 3, 4].map((k) => low + (k * (high - low)) / 4) : quarters(),
          }
        : {};
    return {
      width,
      height: HEIGHT,
      legend: { show: false },
      cursor: { show: false },
      scales: { x: { time: false, range: () => this.span }, y: { range: () => this.range(name) } },
      axes: [
        { ...axis, label: t("plots.time"), size: 30, space: 55 },
        { ...axis, label, size: 60, space: 30, ...turned },
      ],
      series: [
        {},
        { stroke: this.dark ? "#76828e" : "#a5afb9", width: 1.2, points: { show: false } },
        { stroke: this.dark ? "#5a6570" : "#c0c8cf", width: 1.2, points: { show: false } },
        { stroke: this.dark ? "#4a545e" : "#d0d6db", width: 1.2, points: { show: false } },
        { stroke: colour, width: 1.6, points: { show: false } },
      ],
      // How wide a plot is beside its numbers is known when it is drawn.
      hooks: {
        drawClear: [(chart) => this.shade(chart)],
        draw: [(chart) => this.mark(this.charts.find((one) => one.chart === chart))],
      },
    };
  }

  // Where the top flies.
  shade(chart) {
    if (!this.track) return;
    const [begin, end] = this.span;
    chart.ctx.fillStyle = this.dark ? "rgba(102,197,240,.20)" : "rgba(11,95,165,.14)";
    // Of flights that lie in one pixel that is shaded once.
    chart.ctx.beginPath();
    for (const [from, to] of this.track.header.flights) {
      if (to < begin || from > end) continue;
      const [left, right] = [Math.max(from, begin), Math.min(to, end)].map((time) =>
        chart.valToPos(time, "x", true),
      );
      chart.ctx.rect(left, chart.bbox.top, Math.max(right - left, 1), chart.bbox.height);
    }
    chart.ctx.fill();
  }

  drag(chart) {
    const { over } = chart;
    over.style.touchAction = "pan-y";
    const go = (event) => {
      const box = over.getBoundingClientRect();
      const share = Math.min(Math.max((event.clientX - box.left) / box.width, 0), 1);
      const [begin, end] = this.span;
      this.seek(begin + share * (end - begin));
    };
    over.addEventListener("pointerdown", (event) => {
      over.setPointerCapture(event.pointerId);
      go(event);
    });
    over.addEventListener("pointermove", (event) => event.buttons && go(event));
  }

  fill() {
    if (!this.charts.length) return;
    for (const { name, chart } of this.charts) {
      const curves = [...this.ghosts, ...Array(3)]
        .slice(0, 3)
        .map((ghost) => ghost && this.curve(ghost, name));
      chart.setData(joined([...curves, this.curve(this.track, name)]));
    }
    this.move();
  }

  // The lowest and highest value in every pixel, or every sample where they are fewer, in the visitor's units.
  curve(track, name) {
    const { time, columns, count } = track;
    const { size } = unitOf(QUANTITIES[name], this.units);
    const column = columns[name];
    const [begin, end] = this.span;
    const first = track.before(begin);
    const last = Math.min(track.before(end) + 1, count - 1);
    const bins = name === "phi_dot" ? 200 : 500;
    const points = [[], []];
    const add = (i) => {
      points[0].push(time[i]);
      points[1].push(Number.isFinite(column[i]) ? column[i] / size : null);
    };
    if (last - first < 2 * bins) {
      for (let i = first; i <= last; i++) add(i);
      return points;
    }
    if (name === "phi_dot") return middles(time, column, first, last, bins, size);
    for (let bin = 0; bin < bins; bin++) {
      const from = first + Math.floor(((last - first + 1) * bin) / bins);
      const to = first + Math.floor(((last - first + 1) * (bin + 1)) / bins);
      let [low, high] = [from, from];
      for (let i = from; i < to; i++) {
        if (column[i] < column[low]) low = i;
        if (column[i] > column[high]) high = i;
      }
      for (const i of low < high ? [low, high] : low > high ? [high, low] : [low]) add(i);
    }
    return points;
  }

  // Lowest and highest value to show, in the visitor's units: precession without its spikes.
  range(name) {
    const { size } = unitOf(QUANTITIES[name], this.units);
    if (name === "theta" && !this.window) return [0, Math.PI / size];
    let [low, high] = [Infinity, -Infinity];
    for (const track of [this.track, ...this.ghosts]) {
      const [first, last] = this.span.map((time) => track.before(Math.min(time, track.duration)));
      const values =
        name === "phi_dot"
          ? usual(track, first, last)
          : track.columns[name].subarray(first, last + 2);
      for (const value of values) {
        if (value < low) low = value;
        if (value > high) high = value;
      }
    }
    if (!(low <= high)) return [0, 1];
    const least = Math.max(
      CONSTANT * Math.max(Math.abs(low), Math.abs(high)),
      LEAST[name] ?? 0,
      1e-9,
    );
    const room = Math.max(0.07 * (high - low), (least - (high - low)) / 2);
    return [(low - room) / size, (high + room) / size];
  }

  // Show the player's time on every plot: the mark where that moves it, numbers as often as they can be read.
  move() {
    if (!this.track) return;
    const time = this.time();
    const [begin, end] = this.span;
    if (this.window && (time < begin || time > end)) {
      const length = end - begin;
      const start = Math.min(Math.max(time - 0.02 * length, 0), this.track.duration - length);
      this.window = [start, start + length];
      this.fill();
      return;
    }
    const now = performance.now();
    const reads = !this.playing() || now - this.told >= READING;
    if (reads) this.told = now;
    for (const one of this.charts) {
      this.mark(one);
      if (reads)
        one.value.textContent = digits(
          this.track.value(one.name, time) / unitOf(QUANTITIES[one.name], this.units).size,
          4,
        );
    }
  }

  // Put the mark of a plot where the player's time is, to half a pixel.
  mark(one) {
    if (!one) return;
    const [begin, end] = this.span;
    const place =
      Math.round(
        (2 * (this.time() - begin) * one.chart.bbox.width) / devicePixelRatio / (end - begin),
      ) / 2;
    if (place !== one.place) one.cursor.style.transform = `translateX(${place}px)`;
    one.place = place;
  }

  clear() {
    for (const { chart } of this.charts) chart.destroy();
    this.charts = [];
    this.host.replaceChildren();
  }
}

// Precession without the spikes.
function usual({ time, columns }, first, last) {
  const values = middles(time, columns.phi_dot, first, last, Math.min(200, last - first + 1), 1)[1];
  const known = Float64Array.from(values.filter((value) => value !== null)).sort();
  return known.subarray(Math.floor(0.02 * known.length), Math.ceil(0.98 * known.length));
}

// The middle value of every pixel: of precession, which has spikes where the axis passes the vertical.
function middles(time, column, first, last, bins, size) {
  const points = [[], []];
  for (let bin = 0; bin < bins; bin++) {
    const from = first + Math.floor(((last - first + 1) * bin) / bins);
    const to = Math.max(first + Math.floor(((last - first + 1) * (bin + 1)) / bins), from + 1);
    const values = column.slice(from, to).filter(Number.isFinite).sort();
    points[0].push(time[(from + to - 1) >> 1]);
    points[1].push(values.length ? values[values.length >> 1] / size : null);
  }
  return points;
}

// Curves with times of their own as one table.
function joined(curves) {
  return uPlot.join(
    curves.map((curve) => curve ?? [[0], [null]]),
    curves.map(() => [2, 2]),
  );
}
