// The linked plots: one ECharts canvas with a panel for each variable, and a cursor that is cheap to move.

import { echarts } from "nicegui-echart";

const HEIGHT = 132;
const LEFT = 58;
const RIGHT = 14;
const TOP = 30;
const BOTTOM = 26;
const COLOURS = ["#0b5fa5", "#109b60", "#9e1f54", "#e07b00", "#7b4fd0", "#0e8a9a", "#b0453c"];
const DARK_COLOURS = ["#66c5f0", "#4cd694", "#ff7fb0", "#ffb04d", "#b79cff", "#4fd3e0", "#ff8f85"];

export class Plots extends EventTarget {
  constructor(host) {
    super();
    this.host = host;
    host.classList.add("lab-plots-host");
    this.chartHost = document.createElement("div");
    this.overlay = document.createElement("div");
    this.overlay.className = "lab-plots-overlay";
    host.append(this.chartHost, this.overlay);
    this.chart = echarts.init(this.chartHost, null, { renderer: "canvas" });
    this.window = null;
    this.listen();
    this.resizing = new ResizeObserver(() => this.lay());
    this.resizing.observe(host);
  }

  listen() {
    let dragging = false;
    const seek = (event) => {
      const time = this.timeAt(event);
      if (time !== null) this.dispatchEvent(new CustomEvent("seek", { detail: time }));
    };
    this.overlay.addEventListener("pointerdown", (event) => {
      dragging = true;
      this.overlay.setPointerCapture(event.pointerId);
      seek(event);
    });
    this.overlay.addEventListener("pointermove", (event) => dragging && seek(event));
    for (const end of ["pointerup", "pointercancel"]) this.overlay.addEventListener(end, () => (dragging = false));
    this.overlay.addEventListener(
      "wheel",
      (event) => {
        const time = this.timeAt(event);
        if (!(event.ctrlKey || event.shiftKey) || time === null) return;
        event.preventDefault();
        this.zoom((event.deltaY || event.deltaX) > 0 ? 1.25 : 0.8, time);
      },
      { passive: false },
    );
  }

  timeAt(event) {
    const box = this.overlay.getBoundingClientRect();
    const [x, y] = [event.clientX - box.left, event.clientY - box.top];
    const panel = this.panels?.find((p) => x > p.x - LEFT && x < p.x + p.width + RIGHT && y > p.y - TOP && y < p.y + p.height);
    if (!panel) return null;
    const [begin, end] = this.span;
    return begin + Math.min(Math.max((x - panel.x) / panel.width, 0), 1) * (end - begin);
  }

  get span() {
    return this.window ?? [0, this.track?.duration || 1];
  }

  // Make the span shown longer or shorter by a factor, the same time staying where it is; null shows all.
  zoom(factor, time) {
    const whole = this.track?.duration || 1;
    const [begin, end] = this.span;
    const length = factor === null ? whole : Math.max((end - begin) * factor, 0.01);
    if (length >= whole) this.window = null;
    else {
      const start = Math.min(Math.max(time - ((time - begin) / (end - begin)) * length, 0), whole - length);
      this.window = [start, start + length];
    }
    this.fill();
  }

  load(track) {
    this.track = track;
    if (this.window && this.window[1] > track.duration) this.window = null;
    if (!this.panels || this.names.join() !== Object.keys(track.header.plots).join()) this.lay();
    else this.fill();
  }

  setTheme(dark) {
    this.dark = dark;
    if (this.track) this.lay();
  }

  // Place the panels for the width there is.
  lay() {
    const width = this.host.clientWidth;
    if (!this.track || !width) return;
    this.names = Object.keys(this.track.header.plots);
    const columns = width < 640 ? 1 : width < 1250 ? 2 : 3;
    const rows = Math.ceil(this.names.length / columns);
    const room = width / columns;
    const pitch = HEIGHT + TOP + BOTTOM;
    this.host.style.height = `${rows * pitch}px`;
    this.chart.resize({ width, height: rows * pitch });
    this.panels = this.names.map((name, k) => ({
      name,
      x: (k % columns) * room + LEFT,
      y: Math.floor(k / columns) * pitch + TOP,
      width: room - LEFT - RIGHT,
      height: HEIGHT,
    }));
    this.overlay.replaceChildren();
    for (const panel of this.panels) {
      const title = document.createElement("div");
      title.className = "lab-plot-title";
      title.style.cssText = `left:${panel.x - LEFT + 8}px;top:${panel.y - TOP + 5}px;width:${panel.width + LEFT}px`;
      const name = document.createElement("span");
      name.textContent = this.track.header.plots[panel.name].title;
      panel.value = document.createElement("b");
      title.append(name, panel.value);
      panel.cursor = document.createElement("div");
      panel.cursor.className = "lab-plot-cursor";
      panel.cursor.style.cssText = `left:${panel.x}px;top:${panel.y}px;height:${panel.height}px`;
      this.overlay.append(title, panel.cursor);
    }
    this.fill(true);
    this.move(this.time ?? 0);
  }

  // Draw the span shown of the run.
  fill(anew = false) {
    if (!this.panels) return;
    const [begin, end] = this.span;
    const axis = this.dark ? "#8b96a1" : "#7c8793";
    const faint = this.dark ? "#2c343d" : "#e4e8ec";
    const ink = this.dark ? "#c6ced6" : "#3b444d";
    const shade = this.dark ? "rgba(102,197,240,.20)" : "rgba(11,95,165,.13)";
    const areas = this.track.header.flights
      .filter(([from, to]) => to > begin && from < end)
      .map(([from, to]) => [{ xAxis: Math.max(from, begin) }, { xAxis: Math.min(to, end) }]);
    const option = {
      animation: false,
      grid: this.panels.map((p) => ({ left: p.x, top: p.y, width: p.width, height: p.height })),
      xAxis: this.panels.map((_, k) => ({
        gridIndex: k, type: "value", min: begin, max: end,
        axisLine: { lineStyle: { color: axis } },
        axisLabel: { color: ink, fontSize: 11, hideOverlap: true, showMinLabel: this.window ? false : true,
          showMaxLabel: this.window ? false : true, formatter: (t) => `${+t.toFixed(4)}` },
        splitLine: { lineStyle: { color: faint } },
      })),
      yAxis: this.panels.map((p, k) => {
        const [low, high] = this.range(p.name);
        const angle = p.name === "theta" && high - low > 2;
        // So many that neighbouring labels differ.
        const digits = Math.ceil(Math.log10(Math.max(Math.abs(low), Math.abs(high)) / (high - low))) + 2;
        return {
          gridIndex: k, type: "value", min: low, max: angle ? Math.PI : high, splitNumber: 3,
          ...(angle ? { interval: Math.PI / 4 } : {}),
          axisLabel: { color: ink, fontSize: 11, showMinLabel: angle, showMaxLabel: angle,
            formatter: angle ? quarter : (value) => short(value, Math.min(Math.max(digits, 3), 7)) },
          splitLine: { lineStyle: { color: faint } },
        };
      }),
      series: this.panels.map((p, k) => ({
        type: "line", xAxisIndex: k, yAxisIndex: k, silent: true, clip: true,
        // A run that ended at its launch is a point.
        symbol: "circle", symbolSize: 7, showSymbol: !this.track.duration,
        itemStyle: { color: (this.dark ? DARK_COLOURS : COLOURS)[k % COLOURS.length] },
        lineStyle: { width: 1.4, color: (this.dark ? DARK_COLOURS : COLOURS)[k % COLOURS.length] },
        data: this.points(p.name, begin, end, p.width),
        markArea: { silent: true, itemStyle: { color: shade }, data: areas },
      })),
    };
    this.chart.setOption(option, { notMerge: anew, lazyUpdate: false });
    this.move(this.time ?? 0);
  }

  range(name) {
    const whole = this.track.header.plots[name].range;
    if (!this.window || name === "phi_dot") return whole;
    const column = this.track.columns[name];
    const [first, last] = this.window.map((t) => this.track.before(t));
    let [low, high] = [Infinity, -Infinity];
    for (let i = first; i <= last + 1 && i < this.track.count; i++) {
      if (column[i] < low) low = column[i];
      if (column[i] > high) high = column[i];
    }
    if (!(low <= high)) return whole;
    const margin = 0.08 * (high - low) || Math.abs(high) * 1e-3 || 1e-12;
    return [low - margin, high + margin];
  }

  // The lowest and highest value in every pixel, or every sample where they are fewer.
  points(name, begin, end, width) {
    const { time, columns, count } = this.track;
    const column = columns[name];
    const first = this.track.before(begin);
    const last = Math.min(this.track.before(end) + 1, count - 1);
    const bins = Math.max(50, Math.floor(width));
    const points = [];
    if (last - first < 2 * bins) {
      for (let i = first; i <= last; i++) points.push([time[i], column[i]]);
      return points;
    }
    for (let bin = 0; bin < bins; bin++) {
      const from = first + Math.floor(((last - first + 1) * bin) / bins);
      const to = first + Math.floor(((last - first + 1) * (bin + 1)) / bins);
      let [low, high] = [from, from];
      for (let i = from; i < to; i++) {
        if (column[i] < column[low] || Number.isNaN(column[low])) low = i;
        if (column[i] > column[high] || Number.isNaN(column[high])) high = i;
      }
      for (const i of low < high ? [low, high] : [high, low]) points.push([time[i], column[i]]);
    }
    return points;
  }

  move(time) {
    this.time = time;
    if (!this.panels || !this.track) return;
    if (this.window && (time < this.window[0] || time > this.window[1])) {
      const length = this.window[1] - this.window[0];
      const start = Math.min(Math.max(time - 0.02 * length, 0), this.track.duration - length);
      this.window = [start, start + length];
      this.fill();
      return;
    }
    const [begin, end] = this.span;
    const share = (time - begin) / (end - begin);
    for (const panel of this.panels) {
      panel.cursor.style.transform = `translateX(${share * panel.width}px)`;
      panel.value.textContent = short(this.track.value(panel.name, time), 4);
    }
  }

  dispose() {
    this.resizing.disconnect();
    this.chart.dispose();
  }
}

function quarter(value) {
  const count = Math.round((4 * value) / Math.PI);
  return ["0", "π/4", "π/2", "3π/4", "π"][count] ?? "";
}

function short(value, digits = 3) {
  if (!Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  return size < 1e-3 || size >= 1e5 ? value.toExponential(Math.max(digits - 3, 0)) : `${+value.toPrecision(digits)}`;
}
