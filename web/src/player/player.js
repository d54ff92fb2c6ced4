// The player: a scene with a clock, buttons and a strip to scrub on. One host element, one run at a time.

import { player as english } from "../../texts/en.json";
import { LEAD, nearness, pace } from "./climax.js";
import { icon, markup } from "./markup.js";
import { COLUMNS, Scene } from "./scene.js";
import { Sharpness } from "./sharpness.js";
import { SPEEDS } from "./speeds.js";
import { drawStrip } from "./strip.js";
import { STYLE } from "./style.js";
import { Tone } from "./tone.js";
import { Track } from "./track.js";

// The share of a new time between pictures in what is taken for it.
const SMOOTHING = 0.05;
// How often numbers that change are written anew, ms.
export const READING = 80;

// Steps of a run where no motion is wanted.
const STILL_STEPS = 50;
// Time from one picture to the next, s, at best, and how far a top may turn in it, so that an eye sees which way it does.
const PICTURE = 1 / 60;
const MOST_TURN = Math.PI / 3;

// Turns of the camera by keys, rad: across and up.
const TURNS = {
  ArrowLeft: [-0.1, 0],
  ArrowRight: [0.1, 0],
  ArrowUp: [0, 0.1],
  ArrowDown: [0, -0.1],
};

export class Player extends EventTarget {
  // `facts` returns what is written on the stage of a track at a time.
  constructor(host, { theme = "auto", words = english, open = false, facts = null } = {}) {
    super();
    this.facts = facts;
    this.host = host;
    this.labels = words;
    this.time = 0;
    // The share of its speed at which a run is played; null for the fastest at which turns are seen as they are.
    this.speed = null;
    // Least time from one picture to the next, s, and how long it takes here.
    this.picture = PICTURE;
    this.interval = PICTURE;
    this.playing = false;
    this.loop = false;
    this.climax = !stillness();
    // Whether the scene, and whether the strip too, must be drawn anew.
    this.dirty = true;
    this.stale = true;
    // When the time was last written, ms, and the time at which the strip's mark is, s.
    this.lastReading = -Infinity;
    this.marked = -Infinity;
    this.build(words, open);
    this.buildScene(words);
    this.listen();
    this.setTheme(theme);
    this.resizing = new ResizeObserver(() => this.resize());
    this.resizing.observe(host);
    this.tick = this.tick.bind(this);
    this.frame = requestAnimationFrame(this.tick);
  }

  find(selector) {
    return this.host.querySelector(selector);
  }

  build(words, open) {
    this.host.classList.add("tt-player");
    this.host.innerHTML = `<style>${STYLE}</style>${markup(words)}`;
    this.find(".tt-more").open = open;
    this.find("[data-do=climax]").checked = this.climax;
    this.canvas = this.find(".tt-canvas");
    this.strip = this.find(".tt-strip");
    this.range = this.find(".tt-scrub input");
    this.readout = this.find(".tt-time");
    this.note = this.find(".tt-facts");
    this.playButton = this.find("[data-do=play]");
  }

  // Without graphics all but the scene works.
  buildScene(words) {
    try {
      this.scene = new Scene(this.canvas);
      this.sharpness = new Sharpness(this.scene);
      this.scene.controls.addEventListener("change", () => {
        if (!this.drawing) this.dirty = true;
      });
      this.scene.controls.addEventListener("end", () => this.dispatchEvent(new Event("view")));
    } catch (error) {
      this.find(".tt-trouble").textContent = words.noGraphics;
      this.find(".tt-trouble").hidden = false;
      this.reason = error;
    }
  }

  listen() {
    const actions = {
      play: () => this.toggle(),
      back: () => this.step(-1),
      on: () => this.step(1),
      flip: () => this.flip(),
    };
    this.host.addEventListener("click", ({ target }) => {
      const name = target.closest("button")?.dataset.do;
      actions[name]?.();
    });
    this.host.addEventListener("change", ({ target }) => this.choose(target));
    this.range.addEventListener("input", () => {
      this.toggle(false);
      this.seek(Number(this.range.value));
    });
    this.canvas.addEventListener("keydown", (event) => this.key(event));
  }

  // Take over what a control says that was changed.
  choose({ dataset, value, checked }) {
    const choices = {
      speed: () => {
        this.speed = value ? Number(value) : null;
      },
      view: () => this.look(value),
      climax: () => {
        this.slow(checked);
      },
      loop: () => {
        this.loop = checked;
      },
      tone: () => this.sing(checked),
      follow: () => {
        if (this.scene) this.scene.following = checked;
      },
    };
    const { do: what, show } = dataset;
    choices[what]?.();
    if (show) this.show({ [show]: checked });
    this.dirty = true;
    if (what || show) this.dispatchEvent(new Event("view"));
  }

  key(event) {
    const keys = {
      " ": () => this.toggle(),
      ArrowLeft: () => this.step(-1),
      ArrowRight: () => this.step(1),
      Home: () => this.isLocked || this.seek(0),
      End: () => this.isLocked || this.seek(this.duration),
      "+": () => this.scene?.eye.zoom(0.9),
      "-": () => this.scene?.eye.zoom(1 / 0.9),
    };
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.shiftKey && TURNS[event.key]) this.scene?.eye.turn(...TURNS[event.key]);
    else if (keys[event.key]) keys[event.key]();
    else return;
    this.dirty = true;
    event.preventDefault();
  }

  get duration() {
    return this.track?.duration ?? 0;
  }

  get turnsOver() {
    return this.track?.header.turnover_time ?? NaN;
  }

  // Show another run, given as a track or a block of bytes; the time and whether it plays stay as they are.
  load(run) {
    this.track = run instanceof Track ? run : new Track(run);
    this.time = this.track.within(this.time);
    this.range.min = this.track.start;
    this.range.max = this.duration;
    this.scene?.load(this.track);
    this.find(".tt-scale").textContent = this.scene?.scaleText(this.labels.squares) ?? "";
    this.find("[data-do=flip]").disabled = this.isLocked || !Number.isFinite(this.turnsOver);
    for (const [name, column] of Object.entries(COLUMNS))
      this.find(`[data-show=${name}]`).parentElement.hidden = !this.track.columns[column];
    if (this.track.header.story) this.say(this.track.header.story);
    this.stale = true;
    this.dirty = true;
    this.dispatchEvent(new Event("run"));
    return this.track;
  }

  // Take over from a player before, of another language, how and what it plays.
  adopt(before) {
    const { time, playing, speed, loop, climax, until } = before;
    Object.assign(this, { time, loop });
    this.goAt(speed);
    this.find("[data-do=loop]").checked = loop;
    const { view, open } = before.choices;
    this.find(".tt-more").open = open;
    this.slow(climax);
    if (before.tone) this.find("[data-do=tone]").checked = true;
    this.sing(Boolean(before.tone));
    const { scene } = before;
    if (!scene || !this.scene) return;
    this.show(scene.shown);
    this.scene.following = scene.following;
    this.find("[data-do=follow]").checked = scene.following;
    this.find("[data-do=view]").value = view;
    this.scene.eye.place = scene.eye.place;
    this.scene.eye.held = scene.eye.held;
    this.toggle(playing);
    this.until = until;
  }

  // What was chosen below the buttons that nothing else holds; of a player that is gone, at its end.
  get choices() {
    const isThere = Boolean(this.find(".tt-more"));
    if (isThere) {
      const { value } = this.find("[data-do=view]");
      this.chosen = { view: value, open: this.find(".tt-more").open };
    }
    return this.chosen;
  }

  // Show other runs as ghosts beside the run.
  compare(tracks) {
    this.scene?.compare(tracks);
    this.ghosts = tracks;
    this.stale = true;
    this.dirty = true;
  }

  say({ headline, details }) {
    const strong = document.createElement("strong");
    strong.textContent = headline;
    const span = document.createElement("span");
    span.textContent = details.join(" ");
    this.find(".tt-words").replaceChildren(strong, span);
  }

  toggle(playing = !this.playing) {
    if (this.isLocked && playing) return;
    if (playing && this.time >= this.duration) this.time = this.track?.start ?? 0;
    const changed = this.playing !== playing;
    this.playing = playing;
    this.until = Infinity;
    this.last = undefined;
    if (changed && playing) this.sharpness?.begin();
    this.playButton.innerHTML = icon(playing ? "pause" : "play");
    const name = playing ? this.labels.pause : this.labels.play;
    this.playButton.setAttribute("aria-label", name);
    this.playButton.title = name;
    this.dirty = true;
    if (changed) this.dispatchEvent(new Event("view"));
  }

  // One picture at the speed of play; where no motion is wanted, a share of the run that is seen as a change.
  step(direction) {
    if (this.isLocked) return;
    this.toggle(false);
    const pictures = PICTURE * this.paceAt(this.time);
    this.seek(this.time + direction * (stillness() ? this.duration / STILL_STEPS : pictures));
  }

  seek(time) {
    this.time = this.track?.within(time) ?? 0;
    this.dirty = true;
    this.dispatchEvent(new Event("view"));
  }

  // Play from just before the top turns over, with the camera free to sink.
  flip() {
    if (!Number.isFinite(this.turnsOver)) return;
    this.scene?.eye.release();
    this.seek(this.turnsOver - LEAD);
    this.toggle(!stillness());
  }

  look(view) {
    this.scene?.eye.look(view);
    this.find("[data-do=view]").value = view;
    this.dirty = true;
  }

  // Play at a share of its speed; null for as fast as turns are seen.
  goAt(speed) {
    this.speed = speed;
    this.find("[data-do=speed]").value = speed ?? "";
    this.dirty = true;
  }

  // Whether a run may be played at all: before a guess it may not.
  lock(isLocked) {
    this.isLocked = isLocked;
    for (const one of this.host.querySelectorAll(".tt-bar :is(button, input)"))
      one.disabled = isLocked;
    if (!isLocked) this.find("[data-do=flip]").disabled = !Number.isFinite(this.turnsOver);
    if (isLocked) this.toggle(false);
  }

  // Whether time slows down, and the camera sinks, as the top turns over.
  slow(on) {
    this.climax = on;
    this.find("[data-do=climax]").checked = on;
    this.dirty = true;
  }

  show(shown) {
    this.scene?.show(shown);
    for (const [name, on] of Object.entries(shown)) this.find(`[data-show=${name}]`).checked = on;
    this.dirty = true;
  }

  sing(on) {
    this.tone?.close();
    this.tone = on ? new Tone() : null;
  }

  setTheme(theme) {
    const dark =
      theme === "auto" ? matchMedia("(prefers-color-scheme: dark)").matches : theme === "dark";
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
    if (this.playing && this.track) this.advance(now);
    if (!this.track) return;
    if (!this.dirty) {
      this.sharpness?.rest(now - this.moved, this.moved, () => this.draw());
      return;
    }
    this.dirty = false;
    this.moved = now;
    this.draw();
    this.frames = (this.frames ?? 0) + 1;
    this.dispatchEvent(new Event("time"));
  }

  // Play from the start for a while, s.
  preview(time) {
    this.seek(this.track?.start ?? 0);
    this.toggle(true);
    this.until = time;
  }

  // The share of its speed at which a moment is played.
  paceAt(time) {
    const slower = this.climax ? pace(time, this.turnsOver) : 1;
    if (this.speed !== null) return this.speed * slower;
    const { rate } = this.track.turning(time);
    const most = MOST_TURN / (rate * Math.max(this.picture, this.interval));
    return (SPEEDS.find((speed) => speed <= most) ?? SPEEDS.at(-1)) * slower;
  }

  advance(now) {
    const passed = this.last === undefined ? 0 : Math.min((now - this.last) / 1000, 0.25);
    this.last = now;
    if (passed) this.interval += SMOOTHING * (Math.max(passed, PICTURE) - this.interval);
    this.time += this.gain(passed);
    this.sharpness?.pace(passed);
    if (this.time >= this.until) this.toggle(false);
    if (this.time >= this.duration) {
      this.time = this.loop ? this.track.start : this.duration;
      if (!this.loop) this.toggle(false);
    }
    this.dirty = true;
  }

  // How far a run goes on in a picture that is shown for so long, s: of what turns fast, no further than is seen.
  gain(passed) {
    const played = passed * this.paceAt(this.time);
    if (this.speed !== null) return played;
    return Math.min(played, MOST_TURN / this.track.turning(this.time).rate);
  }

  draw() {
    const sunk = this.climax ? nearness(this.time, this.turnsOver) : 0;
    this.drawing = true;
    const exposure = this.playing ? this.gain(Math.max(this.picture, this.interval)) : 0;
    this.scene?.draw(this.time, sunk, exposure);
    this.drawing = false;
    if (this.stale) drawStrip(this.strip, this.track, this.dark, this.ghosts);
    this.stale = false;
    this.tellTime();
    this.tellMode();
    this.tone?.sound(this.track.value("spin", this.time), this.speed ?? 1, this.playing);
  }

  // Draw with `quality` pixels for each pixel of the screen, call `use`, draw as before, and return its result.
  finely(quality, use) {
    const { scene } = this;
    const usual = scene.quality;
    scene.setQuality(quality);
    this.draw();
    const result = use();
    scene.setQuality(usual, false);
    this.dirty = true;
    return result;
  }

  // The time in words and on the strip; while it runs, only as often as digits can be read and the mark moves.
  tellTime() {
    const { time, strip, track } = this;
    const now = performance.now();
    const pixel = (track.duration - track.start) / Math.max(strip.width, 1);
    if (!this.playing || Math.abs(time - this.marked) >= pixel) {
      this.marked = time;
      this.range.value = time;
    }
    if (this.playing && now - this.lastReading < READING) return;
    this.lastReading = now;
    const seconds = (count) => `${time.toFixed(count).replace(".", this.labels.point)} s`;
    this.range.setAttribute("aria-valuetext", seconds(3));
    const share = this.paceAt(time);
    this.readout.textContent = seconds(share < 0.02 ? 5 : 3);
    this.find(".tt-pace").textContent = this.paceText(share);
    if (this.facts) this.note.textContent = this.facts(track, time);
  }

  // The share of its speed at which a run is played, in words.
  paceText(share) {
    if (share > 0.995) return share > 1.005 ? "" : this.labels.realTime;
    const times = 1 / share;
    const factor = String(Number(times.toFixed(times < 10 ? 1 : 0)));
    return this.labels.paced.replace("{factor}", factor.replace(".", this.labels.point));
  }

  // Whether the top slides, rolls, flies or stands on its stem.
  tellMode() {
    const mode = this.track.mode(this.time);
    if (mode === this.mode) return;
    this.mode = mode;
    const badge = this.find(".tt-mode");
    badge.hidden = !mode;
    badge.dataset.mode = mode ?? "";
    badge.textContent = mode ? (this.labels.modes[mode] ?? mode) : "";
  }

  dispose() {
    this.chosen = this.choices;
    cancelAnimationFrame(this.frame);
    this.tone?.close();
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

export function createPlayer(host, options) {
  return new Player(host, options);
}
