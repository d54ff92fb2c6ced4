// The player: a scene with a clock, buttons and a strip to scrub on. One host element, one run at a time.

import { ARROWS, Scene } from "./scene.js";
import { drawStrip } from "./strip.js";
import { STYLE } from "./style.js";
import { Track } from "./track.js";

export const SPEEDS = [1, 1 / 2, 1 / 5, 1 / 10, 1 / 30, 1 / 100, 1 / 300, 1 / 1000];

const MARKUP = `
  <div class="tt-stage">
    <canvas class="tt-canvas" tabindex="0" role="img" aria-label="The top on its table. Space plays and pauses,
      left and right step, shift and arrows turn the view."></canvas>
    <div class="tt-words" aria-live="polite"></div>
    <div class="tt-scale"></div>
    <p class="tt-trouble" role="alert" hidden></p>
  </div>
  <div class="tt-bar">
    <button data-do="back" title="Step back (left arrow)" aria-label="Step back">◂</button>
    <button data-do="play" class="tt-play" title="Play or pause (space)" aria-label="Play">▶</button>
    <button data-do="on" title="Step on (right arrow)" aria-label="Step on">▸</button>
    <div class="tt-scrub">
      <canvas class="tt-strip" aria-hidden="true"></canvas>
      <input type="range" min="0" max="1" step="any" value="0" aria-label="Time">
    </div>
    <output class="tt-time">0.000 s</output>
  </div>
  <div class="tt-bar tt-more">
    <label>Speed <select data-do="speed" aria-label="Speed"></select></label>
    <label>View <select data-do="view" aria-label="View">
      <option value="orbit">orbit</option><option value="side">from the side</option>
      <option value="above">from above</option></select></label>
    <label><input type="checkbox" data-do="follow" checked> follow</label>
    <label><input type="checkbox" data-show="trace" checked> trace</label>
    <label title="The part of the model's sphere that is cut from the toy"><input type="checkbox"
      data-show="glass" checked> glass</label>
    <span class="tt-arrows" role="group" aria-label="Arrows"></span>
  </div>`;

const NAMES = { axis: "axis", momentum: "angular momentum", friction: "friction" };

export class Player extends EventTarget {
  constructor(libraries, host, { theme = "auto" } = {}) {
    super();
    this.host = host;
    host.classList.add("tt-player");
    host.innerHTML = `<style>${STYLE}</style>${MARKUP}`;
    const find = (selector) => host.querySelector(selector);
    this.canvas = find(".tt-canvas");
    this.strip = find(".tt-strip");
    this.range = find(".tt-scrub input");
    this.readout = find(".tt-time");
    this.playButton = find("[data-do=play]");
    this.time = 0;
    this.speed = 1;
    this.playing = false;
    this.dirty = true;
    this.slow = 0;
    this.fill();
    try {
      this.scene = new Scene(libraries, this.canvas);
      this.scene.controls.addEventListener("change", () => (this.dirty ||= !this.drawing));
    } catch (error) {
      const trouble = find(".tt-trouble");
      trouble.textContent = "This browser shows no 3D graphics (WebGL); the plots still play.";
      trouble.hidden = false;
      this.reason = error;
    }
    this.listen();
    this.setTheme(theme);
    this.resizing = new ResizeObserver(() => this.resize());
    this.resizing.observe(host);
    this.tick = this.tick.bind(this);
    this.frame = requestAnimationFrame(this.tick);
  }

  fill() {
    const speeds = this.host.querySelector("[data-do=speed]");
    for (const speed of SPEEDS) {
      const name = speed === 1 ? "real time" : `1/${Math.round(1 / speed)}`;
      speeds.add(new Option(name, speed));
    }
    const arrows = this.host.querySelector(".tt-arrows");
    for (const [name, colour] of Object.entries(ARROWS)) {
      const label = document.createElement("label");
      label.innerHTML = `<input type="checkbox" data-show="${name}"><i style="background:${colour}"></i>`;
      label.append(` ${NAMES[name]}`);
      arrows.append(label);
    }
  }

  listen() {
    const actions = {
      play: () => this.toggle(), back: () => this.step(-1), on: () => this.step(1),
    };
    this.host.addEventListener("click", ({ target }) => actions[target.dataset?.do]?.());
    this.host.addEventListener("change", ({ target }) => {
      const { do: what, show } = target.dataset;
      if (what === "speed") this.speed = Number(target.value);
      if (what === "view") this.scene?.look(target.value);
      if (what === "follow" && this.scene) this.scene.following = target.checked;
      if (show) this.scene?.show({ [show]: target.checked });
      this.dirty = true;
    });
    this.range.addEventListener("input", () => this.seek(Number(this.range.value)));
    this.canvas.addEventListener("keydown", (event) => this.key(event));
  }

  key(event) {
    const turns = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1] };
    const keys = {
      " ": () => this.toggle(),
      ArrowLeft: () => this.step(-1),
      ArrowRight: () => this.step(1),
      Home: () => this.seek(0),
      End: () => this.seek(this.duration),
    };
    if (event.shiftKey && turns[event.key]) this.scene?.turn(...turns[event.key]);
    else if (keys[event.key]) keys[event.key]();
    else return;
    this.dirty = true;
    event.preventDefault();
  }

  get duration() {
    return this.track?.duration ?? 0;
  }

  // Show another run, given as a block of bytes; the time and whether it plays stay as they are.
  load(buffer) {
    this.track = new Track(buffer);
    this.time = Math.min(this.time, this.duration);
    this.range.max = this.duration;
    this.scene?.load(this.track);
    this.host.querySelector(".tt-scale").textContent = this.scene?.scaleText ?? "";
    const { headline, details } = this.track.header.story;
    const words = this.host.querySelector(".tt-words");
    words.replaceChildren();
    const strong = document.createElement("strong");
    strong.textContent = headline;
    const rest = document.createElement("span");
    rest.textContent = details.join(" ");
    words.append(strong, rest);
    this.stale = true;
    this.dirty = true;
    this.dispatchEvent(new Event("run"));
    return this.track;
  }

  toggle(playing = !this.playing) {
    if (playing && this.time >= this.duration) this.time = 0;
    this.playing = playing;
    this.last = undefined;
    this.playButton.textContent = playing ? "❚❚" : "▶";
    this.playButton.setAttribute("aria-label", playing ? "Pause" : "Play");
  }

  // One frame of a sixtieth of a second, at the speed of play.
  step(direction) {
    this.toggle(false);
    this.seek(this.time + (direction * this.speed) / 60);
  }

  seek(time) {
    this.time = Math.min(Math.max(time, 0), this.duration);
    this.dirty = true;
  }

  setTheme(theme) {
    const dark = theme === "auto" ? matchMedia("(prefers-color-scheme: dark)").matches : theme === "dark";
    this.host.classList.toggle("tt-dark", dark);
    this.dark = dark;
    this.scene?.setTheme(dark ? "dark" : "light");
    this.stale = true;
    this.dirty = true;
  }

  resize() {
    this.scene?.resize(this.canvas.clientWidth, this.canvas.clientHeight);
    this.stale = true;
    this.dirty = true;
  }

  tick(now) {
    this.frame = requestAnimationFrame(this.tick);
    if (this.playing && this.track) {
      const passed = this.last === undefined ? 0 : Math.min((now - this.last) / 1000, 0.25);
      this.last = now;
      this.time += passed * this.speed;
      this.pace(passed);
      if (this.time >= this.duration) {
        this.time = this.duration;
        this.toggle(false);
      }
      this.dirty = true;
    }
    if (!this.track) return;
    if (!this.dirty) {
      this.rest(now);
      return;
    }
    this.dirty = false;
    this.moved = now;
    this.drawing = true;
    this.scene?.draw(this.time);
    this.drawing = false;
    if (this.stale) drawStrip(this.strip, this.track, this.dark);
    this.stale = false;
    this.range.value = this.time;
    this.range.setAttribute("aria-valuetext", `${this.time.toFixed(3)} s`);
    this.readout.textContent = `${this.time.toFixed(this.speed < 0.02 ? 5 : 3)} s`;
    this.frames = (this.frames ?? 0) + 1;
    this.dispatchEvent(new Event("time"));
  }

  // When nothing moves any more, draw the moment once more, as sharp as can be.
  rest(now) {
    if (!this.scene || this.sharp === this.moved || now - this.moved < 600) return;
    this.sharp = this.moved;
    const { quality, best } = this.scene;
    if (quality >= best) return;
    this.scene.setQuality(best);
    this.scene.draw(this.time);
    this.scene.setQuality(quality, false);
  }

  // Where frames come late, draw fewer pixels.
  pace(passed) {
    if (!this.scene || !passed) return;
    this.slow = 0.9 * this.slow + 0.1 * passed;
    this.seen = (this.seen ?? 0) + 1;
    if (this.seen > 12 && this.slow > 0.024 && this.scene.quality > this.scene.least) {
      this.scene.setQuality(Math.max(this.scene.least, 0.75 * this.scene.quality));
      this.seen = 0;
    }
  }

  dispose() {
    cancelAnimationFrame(this.frame);
    this.resizing.disconnect();
    this.scene?.dispose();
    this.host.replaceChildren();
    this.host.classList.remove("tt-player", "tt-dark");
  }
}

// Whether the visitor asks for no motion that was not asked for.
export function stillness() {
  return matchMedia("(prefers-reduced-motion: reduce)").matches;
}

export function createPlayer(libraries, host, options) {
  return new Player(libraries, host, options);
}
