// Plots over time, linked to the player: curves of the run, pale ones of pinned runs, flights shaded.

import uPlot from "uplot";

import { READING } from "../player/player.js";
import { part, t } from "./i18n.js";
import { digits, QUANTITIES, unitOf } from "./units.js";

export const USUAL = ["tilt", "spin", "precession", "slip", "energy", "normal_force"];

// Height of a plot and smallest gap between two, pixels.
const HEIGHT = 168;
const GAP = 8;
// Widths of the page, pixels, from which on plots stand in two and in three columns.
const TWO_COLUMNS = 560;
const THREE_COLUMNS = 1000;

// Colours of curves by place in QUANTITIES, of ghosts by place among these, and of the rest, by theme.
const LIGHT = {
  curves: ["#0b5fa5", "#b3401f", "#1b7f4c", "#6a3fc0", "#8a6100", "#a3195b", "#0f7680", "#5c6670"],
  ghosts: ["#a5afb9", "#c0c8cf", "#d0d6db"],
  ink: "#3b444d",
  grid: "#e4e8ec",
  flight: "rgba(11,95,165,.14)",
};
const DARK = {
  curves: ["#66c5f0", "#ff9b78", "#62d09a", "#b79cff", "#e3b34d", "#ff7fb5", "#5fd3dd", "#b4bdc6"],
  ghosts: ["#76828e", "#5a6570", "#4a545e"],
  ink: "#c6ced6",
  grid: "#2c343d",
  flight: "rgba(102,197,240,.20)",
};

// A range of values is at least this share of the largest one, so that a constant is seen as one.
const SMALLEST_RANGE = 0.02;
// At least as much for any quantity, in SI, and for those that are zero but for rounding.
const SMALLEST = 1e-9;
const SMALLEST_OF = { jellett_change: 1e-6, slip: 1e-7 };
// Room above and below the curves, as a share of their range.
const MARGIN = 0.07;
// Share of the values of precession that are left out at either end of its range: its spikes.
const SPIKES = 0.02;

// Points of a curve across a plot; precession has fewer, each the middle one of many values.
const BINS = 500;
const PRECESSION_BINS = 200;

// The shortest time that plots show, s, and where in it the player's time is after a move, as a share.
const SHORTEST_WINDOW = 0.01;
const LEAD = 0.02;

// How long plots stay before they are put into words, ms.
const QUIET = 300;

// What stands for a ghost that is not there.
const NO_CURVE = [[0], [null]];
// How uPlot joins curves: what a curve has none of also blanks the times near it that only others have.
const NULL_EXPAND = 2;

const clamp = (value, low, high) => Math.min(Math.max(value, low), high);

// A number beside an axis, where there is little room.
const brief = (value) => digits(value, 4).replace(/[.,]0+e/, "e");

export class Plots {
  constructor(host, { seek, time, playing, isTold }) {
    this.host = host;
    this.seek = seek;
    this.time = time;
    this.playing = playing;
    this.isTold = isTold;
    this.charts = [];
    this.ghosts = [];
    this.window = null;
    this.lastReading = -Infinity;
    this.resizing = new ResizeObserver(() => this.lay());
    this.resizing.observe(host);
  }

  // Plot a run and its ghosts; plots are made anew only where their names, units, colours or words change.
  load(track, ghosts, names, units, dark) {
    const design = JSON.stringify([names, units, dark, t("name")]);
    const canBeKept = design === this.design && this.charts.length > 0;
    this.design = design;
    Object.assign(this, { track, ghosts, names, units, dark });
    if (this.window && this.window[1] > track.duration) this.window = null;
    if (canBeKept) this.fill();
    else this.lay(true);
  }

  get colours() {
    return this.dark ? DARK : LIGHT;
  }

  get duration() {
    return this.track?.duration || 1;
  }

  // Begin and end of the time that is shown, s.
  get span() {
    return this.window ?? [0, this.duration];
  }

  // Show a time longer by a factor around the player's; all of it without one.
  zoom(factor) {
    const [begin, end] = this.span;
    const length = factor ? Math.max((end - begin) * factor, SHORTEST_WINDOW) : this.duration;
    const now = this.time();
    const start = now - ((now - begin) / (end - begin)) * length;
    this.window = length >= this.duration ? null : this.windowFrom(start, length);
    this.fill();
  }

  // A window of some length within the run, from a time on or nearly so.
  windowFrom(time, length) {
    const start = clamp(time, 0, this.duration - length);
    return [start, start + length];
  }

  // Make every plot so large, pixels, whatever room there is; without a size, as large as there is room.
  size(width, height) {
    this.fixed = Boolean(width);
    for (const { chart } of width ? this.charts : []) chart.setSize({ width, height });
    this.lay();
    this.move();
  }

  // Fit the plots to the host's width.
  lay(anew = false) {
    const width = this.host.clientWidth;
    if (!width || !this.track || this.fixed) return;
    const columns = columnsFor(width);
    const room = Math.floor(width / columns) - GAP;
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
    const label = `${symbol}${unit ? ` (${unit})` : ""}`;
    const full = `${title} ${label}`;
    const figure = document.createElement("figure");
    const caption = document.createElement("figcaption");
    const value = document.createElement("b");
    caption.append(full, value);
    figure.append(caption);
    figure.dataset.quantity = name;
    this.host.append(figure);
    const chart = new uPlot(this.options(name, width, label), null, figure);
    chart.root.setAttribute("role", "img");
    chart.root.setAttribute("aria-label", full);
    const cursor = document.createElement("i");
    cursor.className = "plot-now";
    chart.over.append(cursor);
    this.seekByPointer(chart, name, value);
    return { name, chart, cursor, value, title: full };
  }

  options(name, width, label) {
    const { curves, ghosts, ink, grid } = this.colours;
    const axis = {
      stroke: ink,
      grid: { stroke: grid, width: 1 },
      ticks: { stroke: grid },
      font: "11px system-ui",
      labelFont: "11px system-ui",
      labelSize: 14,
      values: (_, ticks) => ticks.map(brief),
    };
    const upright = { ...axis, label, size: 60, space: 30 };
    if (name === "tilt") upright.splits = (_, __, low, high) => this.splitsOfTilt(low, high);
    const curve = (stroke, thickness) => ({ stroke, width: thickness, points: { show: false } });
    const colour = curves[Object.keys(QUANTITIES).indexOf(name)];
    return {
      width,
      height: HEIGHT,
      legend: { show: false },
      cursor: { show: false },
      scales: { x: { time: false, range: () => this.span }, y: { range: () => this.range(name) } },
      axes: [{ ...axis, label: t("plots.time"), size: 30, space: 55 }, upright],
      series: [{}, ...ghosts.map((stroke) => curve(stroke, 1.2)), curve(colour, 1.6)],
      // How wide a plot is beside its numbers is known when it is drawn.
      hooks: {
        drawClear: [(chart) => this.shade(chart)],
        draw: [(chart) => this.mark(this.charts.find((one) => one.chart === chart))],
      },
    };
  }

  // Where the axis of the tilt has numbers: at quarters of a half turn where all of it is shown.
  splitsOfTilt(low, high) {
    const quarters = [0, 1, 2, 3, 4];
    if (this.window) return quarters.map((k) => low + (k * (high - low)) / 4);
    const { size } = unitOf("angle", this.units);
    return quarters.map((k) => (k * Math.PI) / 4 / size);
  }

  // Shade the times at which the top flies.
  shade(chart) {
    if (!this.track) return;
    const [begin, end] = this.span;
    const { ctx, bbox } = chart;
    ctx.fillStyle = this.colours.flight;
    // Flights that lie in one pixel are shaded once.
    ctx.beginPath();
    for (const [from, to] of this.track.header.flights) {
      if (to < begin || from > end) continue;
      const left = chart.valToPos(Math.max(from, begin), "x", true);
      const right = chart.valToPos(Math.min(to, end), "x", true);
      ctx.rect(left, bbox.top, Math.max(right - left, 1), bbox.height);
    }
    ctx.fill();
  }

  // Move through time by dragging; otherwise the value under the pointer is read, unless it is still to be seen.
  seekByPointer({ over }, name, value) {
    over.style.touchAction = "pan-y";
    const timeOf = (event) => {
      const box = over.getBoundingClientRect();
      const share = clamp((event.clientX - box.left) / box.width, 0, 1);
      const [begin, end] = this.span;
      return begin + share * (end - begin);
    };
    const seek = (event) => this.seek(timeOf(event));
    const read = (event) => {
      if (!this.isTold() || this.playing()) return;
      const time = timeOf(event);
      const { size } = unitOf(QUANTITIES[name], this.units);
      const text = digits(this.track.value(name, time) / size, 4);
      value.textContent = `${text} (${digits(time, 3)} s)`;
    };
    over.addEventListener("pointerdown", (event) => {
      over.setPointerCapture(event.pointerId);
      seek(event);
    });
    over.addEventListener("pointermove", (event) => {
      if (event.buttons) seek(event);
      else read(event);
    });
    over.addEventListener("pointerleave", () => this.move());
  }

  fill() {
    if (!this.charts.length) return;
    const count = this.colours.ghosts.length;
    for (const { name, chart } of this.charts) {
      const curves = Array.from({ length: count }, (_, k) => {
        const ghost = this.ghosts[k];
        return ghost ? this.curve(ghost, name) : NO_CURVE;
      });
      chart.setData(joined([...curves, this.curve(this.track, name)]));
    }
    this.move();
    clearTimeout(this.describing);
    this.describing = setTimeout(() => this.describe(), QUIET);
  }

  // Say in words what the plots show, once they stay for a while.
  describe() {
    const isTold = this.isTold();
    for (const { name, chart, title } of this.charts) {
      const words = isTold ? [inWords(this.curve(this.track, name))] : [];
      chart.root.setAttribute("aria-label", [title, ...words].join(". "));
    }
  }

  // Times and values of a curve in the visitor's units, as finely as can be seen.
  curve(track, name) {
    const { size } = unitOf(QUANTITIES[name], this.units);
    const column = track.columns[name];
    const [begin, end] = this.span;
    const first = track.before(begin);
    const last = Math.min(track.before(end) + 1, track.count - 1);
    const bins = name === "precession" ? PRECESSION_BINS : BINS;
    if (last - first >= 2 * bins && name === "precession") {
      return middles(track.time, column, first, last, bins, size);
    }
    const places =
      last - first < 2 * bins ? upTo(first, last) : extremes(column, first, last, bins);
    const values = places.map((i) => (Number.isFinite(column[i]) ? column[i] / size : null));
    return [places.map((i) => track.time[i]), values];
  }

  // Lowest and highest value to show, in the visitor's units.
  range(name) {
    const { size } = unitOf(QUANTITIES[name], this.units);
    if (name === "tilt" && !this.window) return [0, Math.PI / size];
    const [low, high] = this.extent(name);
    if (!(low <= high)) return [0, 1];
    const smallest = Math.max(
      SMALLEST_RANGE * Math.max(Math.abs(low), Math.abs(high)),
      SMALLEST_OF[name] ?? 0,
      SMALLEST,
    );
    const room = Math.max(MARGIN * (high - low), (smallest - (high - low)) / 2);
    return [(low - room) / size, (high + room) / size];
  }

  // Lowest and highest value of a quantity in the time shown, in SI; precession without its spikes.
  extent(name) {
    let low = Infinity;
    let high = -Infinity;
    for (const track of [this.track, ...this.ghosts]) {
      const [first, last] = this.span.map((time) => track.before(Math.min(time, track.duration)));
      const values =
        name === "precession"
          ? withoutSpikes(track, first, last)
          : track.columns[name].subarray(first, last + 2);
      for (const value of values) {
        if (value < low) low = value;
        if (value > high) high = value;
      }
    }
    return [low, high];
  }

  // Show the player's time on every plot: the mark where that moves it, numbers as often as they can be read.
  move() {
    if (!this.track) return;
    const time = this.time();
    const [begin, end] = this.span;
    if (this.window && (time < begin || time > end)) {
      const length = end - begin;
      this.window = this.windowFrom(time - LEAD * length, length);
      this.fill();
      return;
    }
    for (const one of this.charts) this.mark(one);
    const now = performance.now();
    if (this.playing() && now - this.lastReading < READING) return;
    this.lastReading = now;
    for (const { name, value } of this.charts) {
      const { size } = unitOf(QUANTITIES[name], this.units);
      value.textContent = digits(this.track.value(name, time) / size, 4);
    }
  }

  // Put the mark of a plot where the player's time is, to half a pixel.
  mark(one) {
    if (!one) return;
    const [begin, end] = this.span;
    const width = one.chart.bbox.width / devicePixelRatio;
    const place = Math.round((2 * (this.time() - begin) * width) / (end - begin)) / 2;
    if (place !== one.place) one.cursor.style.transform = `translateX(${place}px)`;
    one.place = place;
  }

  clear() {
    for (const { chart } of this.charts) chart.destroy();
    this.charts = [];
    this.host.replaceChildren();
  }
}

// A curve in words: where it begins and ends, and how low and high it goes.
function inWords([times, values]) {
  const known = values.flatMap((value, k) => (value === null ? [] : [k]));
  if (!known.length) return "";
  const best = (isBetter) => known.reduce((a, b) => (isBetter(values[b], values[a]) ? b : a));
  const text = (k) => ({ value: digits(values[k], 3), time: digits(times[k], 3) });
  const [low, high] = [text(best((b, a) => b < a)), text(best((b, a) => b > a))];
  return t("plots.words", {
    start: text(known[0]).value,
    end: text(known.at(-1)).value,
    low: low.value,
    lowTime: low.time,
    high: high.value,
    highTime: high.time,
  });
}

function columnsFor(width) {
  if (width < TWO_COLUMNS) return 1;
  return width < THREE_COLUMNS ? 2 : 3;
}

// Whole numbers from one to another.
function upTo(first, last) {
  return Array.from({ length: last - first + 1 }, (_, k) => first + k);
}

// The samples of a bin, from the first of it to that after the last.
function binOf(first, last, bin, bins) {
  const edge = (k) => first + Math.floor(((last - first + 1) * k) / bins);
  return [edge(bin), edge(bin + 1)];
}

// Places of the lowest and the highest value in every bin, in order.
function extremes(column, first, last, bins) {
  const places = [];
  for (let bin = 0; bin < bins; bin++) {
    const [from, to] = binOf(first, last, bin, bins);
    let low = from;
    let high = from;
    for (let i = from; i < to; i++) {
      if (column[i] < column[low]) low = i;
      if (column[i] > column[high]) high = i;
    }
    places.push(Math.min(low, high));
    if (low !== high) places.push(Math.max(low, high));
  }
  return places;
}

// The middle value of every bin: of precession, which has spikes where the axis passes the vertical.
function middles(time, column, first, last, bins, size) {
  const times = [];
  const values = [];
  for (let bin = 0; bin < bins; bin++) {
    const [from, edge] = binOf(first, last, bin, bins);
    const to = Math.max(edge, from + 1);
    const sorted = column.slice(from, to).filter(Number.isFinite).sort();
    times.push(time[(from + to - 1) >> 1]);
    values.push(sorted.length ? sorted[sorted.length >> 1] / size : null);
  }
  return [times, values];
}

// The values of precession but for the largest and smallest ones, in increasing order.
function withoutSpikes({ time, columns }, first, last) {
  const bins = Math.min(PRECESSION_BINS, last - first + 1);
  const [, values] = middles(time, columns.precession, first, last, bins, 1);
  const sorted = Float64Array.from(values.filter((value) => value !== null)).sort();
  const { length } = sorted;
  return sorted.subarray(Math.floor(SPIKES * length), Math.ceil((1 - SPIKES) * length));
}

// Curves with times of their own as one table.
function joined(curves) {
  return uPlot.join(
    curves,
    curves.map(() => [NULL_EXPAND, NULL_EXPAND]),
  );
}
