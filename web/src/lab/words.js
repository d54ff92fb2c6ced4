// What became of a launch, in words: a headline, and sentences beside it.

import { decimal, t } from "./i18n.js";
import { digits, shown } from "./units.js";

// How near a vertical counts as there, how near all along as having stayed there, rad; the end of a run, its share.
const NEAR = 0.05;
const AROUND = 0.3;
const STILL = 0.02;
const LATE = 0.1;

export function tell(track, prospect, units) {
  const { header } = track;
  const details = [];
  if (prospect?.ends?.length)
    details.push(far(track, prospect) ? slowly(prospect, units) : heading(prospect, units));
  if (header.problem.friction.mu === 0) details.push(t("words.frictionless"));
  if (header.outcome.name === "lifted_off") details.push(t("words.stopped"));
  else if (!["completed", "at_rest", "lying_flat"].includes(header.outcome.name)) {
    details.unshift(t("words.ended", { advice: t(`outcomes.${header.outcome.name}`) }));
  }
  const jumps = jumpsOf(header);
  if (jumps) details.unshift(jumps);
  details.unshift(...header.doubts.map(doubtInWords));
  return { headline: headline(track, prospect, units), details };
}

export function heading({ ends, certain }, units) {
  const texts = ends.map((end) => endInWords(end, units));
  return t(certain ? "controls.heads" : "controls.headsMany", { end: texts.join(" / ") });
}

function doubtInWords({ kind, gaps }) {
  const texts = Object.entries(gaps).map(([name, text]) => [name, decimal(text)]);
  return t("words.doubt", { doubt: t(`doubts.${kind}`, Object.fromEntries(texts)) });
}

// Whether a run has hardly moved, though its end is elsewhere.
function far(track, { ends, certain }) {
  const [low, high] = range(track.columns.theta, 0);
  return certain && high - low < 0.1 && Math.abs(ends[0].tilt - high) > 0.5;
}

function slowly({ ends }, units) {
  return t("words.slowly", { end: endInWords(ends[0], units) });
}

export function endInWords({ kind, tilt, spin, precession }, units) {
  return t(`ends.${kind}`, {
    spin: shown(spin, "spin", units),
    tilt: shown(tilt, "angle", units, 3),
    precession: shown(precession, "spin", units),
  });
}

function headline(track, prospect, units) {
  const { metrics, problem, outcome } = track.header;
  const { theta } = track.columns;
  const last = theta.at(-1);
  const tilt = shown(last, "angle", units, 3);
  const [low, high] = range(theta, 0);
  const time = (value) => digits(Math.round(100 * value) / 100, 4);
  if (outcome.name === "lying_flat") return t("words.flat", { time: time(track.duration) });
  if (high < AROUND && last < NEAR + problem.launch.tilt)
    return upright(track, prospect, units, last, tilt);
  if (low > Math.PI - AROUND) return t("words.staysInverted");
  const [lateLow, lateHigh] = range(theta, 1 - LATE);
  const settled = lateHigh - lateLow < STILL;
  if (last > Math.PI - NEAR && (settled || lateLow > Math.PI - 2 * NEAR))
    return t("words.inverts", { time: time(metrics.arrives) });
  if (outcome.name === "at_rest") return t("words.rest", { tilt, time: time(track.duration) });
  // What settles level, as on two balls, has not turned over.
  const level = settled && Math.abs(last - Math.PI / 2) < NEAR;
  if (Number.isFinite(track.header.turns_over) && !level) {
    return t("words.turnsOver", { time: time(metrics.turns_over), tilt });
  }
  if (last < NEAR) return t("words.comesUpright");
  if (high - last > 0.35) return t("words.falls", { tilt });
  if (settled) return t(high - low < 0.1 ? "words.stays" : "words.settles", { tilt });
  return t("words.moves", { tilt });
}

function upright(track, prospect, units, last, tilt) {
  const { problem } = track.header;
  const spin = Math.abs(problem.launch.spin);
  if (problem.friction.mu === 0 || last > NEAR) return t("words.stays", { tilt });
  const critical = prospect?.critical?.upright;
  if (critical === undefined || critical === null) return t("words.staysUpright");
  if (spin < critical)
    return t("words.staysUprightBelow", { spin: shown(critical, "spin", units) });
  return t("words.uprightStill");
}

function jumpsOf({ flights, metrics, outcome }) {
  if (outcome.name === "lifted_off")
    return t("words.pulls", { time: digits(metrics.first_lift_off, 3) });
  if (!metrics.flights) return "";
  const first = digits(flights[0]?.[0] ?? metrics.first_lift_off, 3);
  return t(metrics.flights === 1 ? "words.jumpsOnce" : "words.jumps", {
    count: metrics.flights,
    time: first,
  });
}

function range(values, from) {
  let [low, high] = [Infinity, -Infinity];
  for (let i = Math.floor(from * (values.length - 1)); i < values.length; i++) {
    if (values[i] < low) low = values[i];
    if (values[i] > high) high = values[i];
  }
  return [low, high];
}
