// What the player consists of, in the words of a language.

import { ARROWS } from "./scene.js";
import { SPEEDS } from "./speeds.js";

const ICONS = {
  back: "M14 4 7 10l7 6z",
  on: "M6 4l7 6-7 6z",
  play: "M5 3l12 7-12 7z",
  pause: "M5 3h4v14H5zM11 3h4v14h-4z",
  flip: "M10 2a8 8 0 0 1 8 8h-3a5 5 0 0 0-5-5V8L5 4l5-4zM10 18a8 8 0 0 1-8-8h3a5 5 0 0 0 5 5v-3l5 4-5 4z",
};

export function icon(name) {
  return `<svg viewBox="0 0 20 20" width="18" height="18" aria-hidden="true"><path fill="currentColor" d="${ICONS[name]}"/></svg>`;
}

export function markup(words) {
  const button = (what, extra = "") =>
    `<button type="button" data-do="${what}" ${extra} title="${words[what]}" aria-label="${words[what]}">${icon(what)}</button>`;
  const box = (kind, name, checked) =>
    `<label><input type="checkbox" data-${kind}="${name}" ${checked ? "checked" : ""}> ${words[name]}</label>`;
  const speeds = SPEEDS.map(
    (speed) =>
      `<option value="${speed}">${speed === 1 ? words.realTime : `1/${Math.round(1 / speed)}`}</option>`,
  );
  speeds.unshift(`<option value="">${words.seen}</option>`);
  const arrows = Object.entries(ARROWS).map(
    ([name, colour]) =>
      `<label><input type="checkbox" data-show="${name}"><i style="background:${colour}"></i> ${words[name]}</label>`,
  );
  const views = ["orbit", "side", "above"].map(
    (name) => `<option value="${name}">${words[name]}</option>`,
  );
  return `
  <div class="tt-words" aria-live="polite" tabindex="0"></div>
  <div class="tt-stage">
    <canvas class="tt-canvas" tabindex="0" role="img" aria-label="${words.canvas}"></canvas>
    <div class="tt-facts"></div>
    <div class="tt-mode" hidden></div>
    <div class="tt-scale"></div>
    <div class="tt-pace"></div>
    <p class="tt-trouble" role="alert" hidden></p>
  </div>
  <div class="tt-bar">
    ${button("back")}${button("play", 'class="tt-play"')}${button("on")}
    <div class="tt-scrub">
      <canvas class="tt-strip" aria-hidden="true"></canvas>
      <input type="range" min="0" max="1" step="any" value="0" aria-label="${words.time}">
    </div>
    <output class="tt-time">0.000 s</output>
    ${button("flip", "disabled")}
  </div>
  <details class="tt-more"><summary>${words.more}</summary><div class="tt-options">
    <label>${words.speed} <select data-do="speed">${speeds.join("")}</select></label>
    <label>${words.view} <select data-do="view">${views.join("")}</select></label>
    ${box("do", "climax", true)}${box("do", "loop")}${box("do", "tone")}${box("do", "follow", true)}
    ${box("show", "trace", true)}${box("show", "glass", true)}
    <span class="tt-arrows" role="group" aria-label="${words.arrows}">${arrows.join("")}</span>
  </div></details>`;
}
