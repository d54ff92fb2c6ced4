// The link is the document: launch, time, view, units, curves and pins, after the # of the page's address.

import { changed, differences, FIRST, fields, inSi } from "./setup.js";
import { AXES, CHOICES, FIRST as FIRST_UNITS } from "./units.js";

// Longer than any profile that a body may have; addresses may be as long.
const LONGEST_VALUE = 100_000;
const FORBIDDEN = ["__proto__", "prototype", "constructor"];
const TABLES = /^(body|friction|launch|contact)\./;
const PLAIN = ["gravity", "rolling_resistance", "duration"];
// What the player shows where all that can be shown is off.
const NO_ARROWS = "none";

const isAxis = (name) => AXES.includes(name);
const isOfLaunch = (field) => TABLES.test(field) || PLAIN.includes(field);

// A launch as a query: what is not as in the first launch. Laws and shapes are named with all they have.
export function launchQuery(setup) {
  const query = new URLSearchParams();
  const { friction, body } = setup.problem;
  const other = new Set(differences(FIRST, setup).map(([field]) => field));
  if (friction.kind !== FIRST.problem.friction.kind) other.add("friction.kind").add("friction.mu");
  const all = [...fields(setup.problem), ["duration", setup.duration]];
  const several = Array.isArray(body.shape) || body.shape.kind !== "eccentric_sphere";
  if (several) query.set("body.shape", JSON.stringify(body.shape));
  for (const [field, value] of all) {
    if (several && field.startsWith("body.shape")) continue;
    if (other.has(field))
      query.set(field, typeof value === "string" ? value : JSON.stringify(value));
  }
  return query;
}

export function readLaunch(query) {
  const changes = {};
  for (const [field, text] of query) {
    if (!isOfLaunch(field) || text.length > LONGEST_VALUE) continue;
    if (field.split(".").some((name) => FORBIDDEN.includes(name))) continue;
    changes[field] = parsed(text);
  }
  // A law first, so that what it has is not lost.
  const { "friction.kind": kind, "body.shape": shape, ...rest } = changes;
  let setup = FIRST;
  if (typeof kind === "string") setup = changed(setup, { "friction.kind": kind });
  if (shape && typeof shape === "object") setup = changed(setup, { "body.shape": shape });
  return inSi(changed(setup, rest));
}

function parsed(text) {
  try {
    return JSON.parse(text);
  } catch {
    return text;
  }
}

export function writeLink({ setup, pins, units, view, tab, step, plots, free, lang, theme }) {
  const query = launchQuery(setup);
  if (view.time > 0.0005) query.set("t", view.time.toFixed(4));
  if (view.camera) query.set("camera", view.camera.map((v) => v.toFixed(3)).join(" "));
  if (view.shown) query.set("show", view.shown.join(" ") || NO_ARROWS);
  if (units.spin !== FIRST_UNITS.spin || units.angle !== FIRST_UNITS.angle)
    query.set("units", `${units.spin} ${units.angle}`);
  if (tab !== "story") query.set("tab", tab);
  if (plots) query.set("plots", plots.join(" "));
  if (free) query.set("free", free.join(" "));
  if (lang) query.set("lang", lang);
  if (theme !== "auto") query.set("theme", theme);
  for (const pin of pins) query.append("pin", launchQuery(pin).toString());
  // What is shown opens the launch's controls, so that a story that shows something says where it is.
  if (step || (tab === "story" && [...query.keys()].some(isShown))) query.set("step", step);
  return query.toString();
}

export function readLink(text) {
  const query = new URLSearchParams(text.replace(/^[#?]/, ""));
  const words = (name) => query.get(name)?.split(" ").filter(Boolean);
  const camera = words("camera")?.map(Number);
  const [spin, angle] = words("units") ?? [];
  const axes = words("free");
  const right = camera?.length === 3 && camera.every(Number.isFinite);
  return {
    setup: readLaunch(query),
    pins: query
      .getAll("pin")
      .slice(0, 3)
      .map((pin) => readLaunch(new URLSearchParams(pin))),
    units: {
      spin: CHOICES.spin.includes(spin) ? spin : FIRST_UNITS.spin,
      angle: CHOICES.angle.includes(angle) ? angle : FIRST_UNITS.angle,
    },
    view: {
      time: Math.max(Number(query.get("t")) || 0, 0),
      camera: right ? camera : null,
      shown: words("show")?.filter((word) => word !== NO_ARROWS) ?? null,
    },
    tab: query.get("tab") ?? (isOfStory(query) ? "story" : "launch"),
    step: Math.max(Math.trunc(Number(query.get("step")) || 0), 0),
    plots: words("plots") ?? null,
    free: axes?.length === 2 && axes.every(isAxis) ? axes : null,
    lang: query.get("lang"),
    theme: ["light", "dark"].includes(query.get("theme")) ? query.get("theme") : "auto",
    timed: query.has("t"),
  };
}

// Whether a link without a tab is one to the story: it names a step, or says nothing of a launch.
const isOfStory = (query) => query.has("step") || ![...query.keys()].some(isShown);
const isShown = (name) =>
  isOfLaunch(name) || ["t", "pin", "camera", "show", "plots", "free"].includes(name);
