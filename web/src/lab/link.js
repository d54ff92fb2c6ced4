// The link is the document: launch, time, view, units, curves and pins, after the # of the page's address.

import { SPEEDS } from "../player/speeds.js";
import { LANGUAGES } from "./i18n.js";
import { isPush, MOST_PUSHES, sortedPushes } from "./pushes.js";
import { changed, differences, FIRST, fields, flawOf, inSi, NoField, withPushes } from "./setup.js";
import { MATERIALS, SIZES } from "./turning.js";
import { AXES, CHOICES, FIRST as FIRST_UNITS, QUANTITIES } from "./units.js";

// Longer than any profile that a body may have; addresses may be as long.
const LONGEST_VALUE = 100_000;
export const TABS = ["story", "launch", "own", "compare", "map", "class", "keep"];
export const MOST_PINS = 3;
// What a link may say beside a launch.
const KNOWN = [
  ...["t", "pin", "camera", "show", "units", "tab", "step", "plots", "free", "lang", "theme"],
  ...["result", "picture", "speed", "own", "class", "results", "push"],
];
const FORBIDDEN = ["__proto__", "prototype", "constructor"];
const TABLES = /^(body|friction|launch|contact|table|air)\./;
// What a push says of friction, or of a slope, that stays as it is.
const SAME = "-";
const PLAIN = ["gravity", "rolling_resistance", "duration"];
// What the player shows where all that can be shown is off.
const NO_ARROWS = "none";

const isAxis = (name) => AXES.includes(name);
const isOfLaunch = (field) => TABLES.test(field) || PLAIN.includes(field);

// A launch as a query: what is not as in the first launch. Laws and shapes are named with all they have.
export function launchQuery(setup) {
  const query = new URLSearchParams();
  for (const push of setup.pushes ?? []) query.append("push", writePush(push));
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

/** The launch of a query, and the names in it that stand for nothing; of one that is none, its flaw and no launch. */
export function readLaunch(query) {
  const changes = {};
  const unread = [];
  for (const [field, text] of query) {
    if (!isOfLaunch(field)) continue;
    const isForbidden = field.split(".").some((name) => FORBIDDEN.includes(name) || !name);
    if (isForbidden || text.length > LONGEST_VALUE) unread.push(field);
    else changes[field] = parsed(text);
  }
  const pushes = query.getAll("push").slice(0, MOST_PUSHES).map(readPush);
  if (pushes.includes(null) || query.getAll("push").length > MOST_PUSHES) unread.push("push");
  let setup = withPushes(FIRST, sortedPushes(pushes.filter(Boolean)));
  const change = (field) => {
    try {
      setup = changed(setup, { [field]: changes[field] });
    } catch (error) {
      if (!(error instanceof NoField)) throw error;
      unread.push(field);
    }
  };
  // A law and a shape first, so that what they have is not lost; and then what is in others after these.
  const order = (field) => (field === "friction.kind" || field === "body.shape" ? 0 : 1);
  const depth = (field) => field.split(".").length;
  const names = Object.keys(changes).sort((a, b) => order(a) - order(b) || depth(a) - depth(b));
  for (const name of names) change(name);
  setup = inSi(setup);
  const flaw = flawOf(setup);
  return flaw ? { setup: null, unread, flaw } : { setup, unread, flaw: null };
}

// A push as words: its time, s, its impulse, N s, its direction, rad, the friction from then on, if another, and, of a
// table that is lifted, its slope, rad.
function writePush({ time, impulse, direction, mu, slope }) {
  const lifted = slope === null ? [] : [slope];
  return [time, impulse, direction, mu ?? SAME, ...lifted].join(" ");
}

function readPush(text) {
  const words = text.split(" ");
  const [time, impulse, direction] = words.map(Number);
  const [mu, slope] = [words[3], words[4] ?? SAME].map((one) =>
    one === SAME ? null : Number(one),
  );
  const push = { time, impulse, direction, mu, slope };
  const isRight = [4, 5].includes(words.length) && words.every(Boolean) && isPush(push);
  return isRight ? push : null;
}

function parsed(text) {
  try {
    return JSON.parse(text);
  } catch {
    return text;
  }
}

/** The class as it is at first: groups, their spins, rad/s, and its results. */
export const FIRST_CLASS = { groups: 8, low: 10, high: 150, results: "" };
// The most letters of results that a link holds.
const MOST_RESULTS = 4000;

function writeClass(query, { groups, low, high, results }) {
  const numbers = `${groups} ${low} ${high}`;
  const { groups: count, low: from, high: to } = FIRST_CLASS;
  if (numbers !== `${count} ${from} ${to}`) query.set("class", numbers);
  const lines = results.split("\n").map((line) => line.trim());
  const text = lines.filter(Boolean).join(";");
  if (text && text.length <= MOST_RESULTS) query.set("results", text);
}

function readClass(query) {
  const numbers = query.get("class")?.split(" ").map(Number);
  const results = query.get("results")?.slice(0, MOST_RESULTS).replaceAll(";", "\n") ?? "";
  if (!numbers) return results ? { ...FIRST_CLASS, results } : null;
  const [groups, low, high] = numbers;
  const isRight = numbers.length === 3 && numbers.every((one) => one >= 0 && one <= 250);
  return isRight && groups >= 2 && groups <= 30 ? { groups, low, high, results } : undefined;
}

// The sizes and the material of a top of one's own.
const writeOwn = (top) => [...Object.keys(SIZES).map((name) => top[name]), top.material].join(" ");

function readOwn(text) {
  if (!text) return null;
  const parts = text.split(" ");
  const material = parts.pop();
  const names = Object.keys(SIZES);
  const isRight =
    Object.hasOwn(MATERIALS, material) &&
    parts.length === names.length &&
    names.every((name, k) => parts[k] >= SIZES[name][0] && parts[k] <= SIZES[name][1]);
  if (!isRight) return undefined;
  const sizes = names.map((name, k) => [name, Number(parts[k])]);
  return { ...Object.fromEntries(sizes), material };
}

export function writeLink(state) {
  const { setup, pins, units, view, tab, step, plots, free, lang, theme, own, classroom } = state;
  const query = launchQuery(setup);
  if (view.time > 0.0005) query.set("t", view.time.toFixed(4));
  if (view.camera) query.set("camera", view.camera.map((v) => v.toFixed(3)).join(" "));
  if (view.shown) query.set("show", view.shown.join(" ") || NO_ARROWS);
  if (units.spin !== FIRST_UNITS.spin || units.angle !== FIRST_UNITS.angle)
    query.set("units", `${units.spin} ${units.angle}`);
  if (tab !== "story") query.set("tab", tab);
  if (view.speed) query.set("speed", Number(view.speed.toPrecision(6)));
  if (own) query.set("own", writeOwn(own));
  if (classroom) writeClass(query, classroom);
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
  const launch = readLaunch(query);
  const pins = query.getAll("pin").map((pin) => readLaunch(new URLSearchParams(pin)));
  const tab = query.get("tab");
  const lang = query.get("lang");
  const plots = words("plots");
  const own = readOwn(query.get("own"));
  const classroom = readClass(query);
  const speed = SPEEDS.find((one) => Math.abs(one - Number(query.get("speed"))) < 1e-5 * one);
  const known = plots?.filter((name) => Object.hasOwn(QUANTITIES, name));
  const unread = [
    ...launch.unread,
    ...[...query.keys()].filter((name) => !isOfLaunch(name) && !KNOWN.includes(name)),
    ...(tab === null || TABS.includes(tab) ? [] : ["tab"]),
    ...(lang === null || Object.hasOwn(LANGUAGES, lang) ? [] : ["lang"]),
    ...(plots?.length === known?.length ? [] : ["plots"]),
    ...(own === undefined ? ["own"] : []),
    ...(classroom === undefined ? ["class"] : []),
    ...(query.has("speed") && !speed ? ["speed"] : []),
    ...(axes && !(axes.length === 2 && axes.every(isAxis)) ? ["free"] : []),
    ...(pins.length > MOST_PINS || pins.some(isFaulty) ? ["pin"] : []),
  ];
  return {
    setup: launch.setup ?? FIRST,
    flaw: launch.flaw,
    unread: [...new Set(unread)],
    pins: pins
      .map(({ setup }) => setup)
      .filter(Boolean)
      .slice(0, MOST_PINS),
    units: {
      spin: CHOICES.spin.includes(spin) ? spin : FIRST_UNITS.spin,
      angle: CHOICES.angle.includes(angle) ? angle : FIRST_UNITS.angle,
    },
    view: {
      time: Math.max(Number(query.get("t")) || 0, 0),
      camera: right ? camera : null,
      speed: speed ?? null,
      shown: words("show")?.filter((word) => word !== NO_ARROWS) ?? null,
    },
    tab: TABS.includes(tab) ? tab : tabOf(query),
    step: Math.max(Math.trunc(Number(query.get("step")) || 0), 0),
    plots: known ?? null,
    own: own ?? null,
    classroom: classroom ?? null,
    free: axes?.length === 2 && axes.every(isAxis) ? axes : null,
    lang: Object.hasOwn(LANGUAGES, lang ?? "") ? lang : null,
    theme: ["light", "dark"].includes(query.get("theme")) ? query.get("theme") : "auto",
    timed: query.has("t"),
  };
}

const isFaulty = ({ setup, unread }) => !setup || unread.length > 0;

const tabOf = (query) => (isOfStory(query) ? "story" : "launch");

// Whether a link without a tab is one to the story: it names a step, or says nothing of a launch.
const isOfStory = (query) => query.has("step") || ![...query.keys()].some(isShown);
const isShown = (name) =>
  isOfLaunch(name) || ["t", "pin", "push", "camera", "show", "plots", "free"].includes(name);
