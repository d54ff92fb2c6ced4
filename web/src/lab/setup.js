// A launch as the page knows it: a problem, as plain data, how long to follow it, s, and pushes on the way, if any.

import { PRESETS, SCHEMA } from "engine-tables";
import { NoNumber, inSi as numberInSi } from "engine-units";

export const FIRST = { problem: PRESETS.problems.report, duration: 20 };

export const LONGEST = 120;

// The friction coefficient of a law that is chosen where there is no friction.
const USUAL_FRICTION = 0.3;

// What each law has beside the friction coefficient, and where that starts.
const LAWS = {
  viscous: () => ({}),
  coulomb: () => ({}),
  static_coulomb: (mu) => ({ static_mu: Number((1.5 * mu).toPrecision(3)) }),
  regularized_coulomb: () => ({ eps: 1e-3 }),
  contensou: () => ({ patch_radius: 3e-4, pressure: "hertz" }),
};

export function fieldValue({ problem, duration }, field) {
  if (field === "duration") return duration;
  return field.split(".").reduce((table, name) => table?.[name], problem);
}

/** A field is named where there can be none. */
export class NoField extends Error {
  constructor(field) {
    super(field);
    this.field = field;
  }
}

// A copy with some fields replaced, named with dots; another law keeps the friction coefficient.
export function changed(setup, changes) {
  const copy = structuredClone(setup);
  for (const [field, value] of Object.entries(changes)) {
    if (field === "duration") copy.duration = value;
    else if (field === "friction.kind") changeLaw(copy.problem, value);
    else setField(copy.problem, field, value);
  }
  return copy;
}

function changeLaw(problem, kind) {
  const { friction } = problem;
  if (friction.kind === kind) return;
  const mu = friction.mu || USUAL_FRICTION;
  // A law that there is none of is refused later.
  const others = Object.hasOwn(LAWS, kind) ? LAWS[kind](mu) : {};
  problem.friction = { kind, mu, ...others };
}

function setField(problem, field, value) {
  const names = field.split(".");
  const last = names.pop();
  let table = problem;
  for (const name of names) {
    table[name] ??= {};
    table = table[name];
    if (!isTable(table)) throw new NoField(field);
  }
  table[last] = value;
}

const isTable = (value) => value !== null && typeof value === "object" && !Array.isArray(value);

/**
 * What keeps the page from showing a launch at all, before the engine sees it: the field of a part or a number that is
 * missing, or that is none, with its value; null if there is nothing.
 */
export function flawOf({ problem, duration }) {
  if (!isNumberLike(duration)) return { field: "duration", value: duration };
  return flawIn(problem, ["Problem"], "");
}

function flawIn(value, titles, place) {
  if (!isTable(value)) return { field: place, value };
  const title = titleOf(value, titles);
  for (const [name, field] of Object.entries(SCHEMA[title].fields)) {
    const inner = Object.hasOwn(value, name) ? value[name] : undefined;
    const where = place ? `${place}.${name}` : name;
    const flaw = flawOfField(inner, field, where);
    if (flaw) return flaw;
  }
  return null;
}

function flawOfField(inner, field, where) {
  if (inner === undefined || inner === null)
    return Object.hasOwn(field, "default") ? null : { field: where, missing: true };
  if (field.parts) {
    const isList = Array.isArray(inner) && (field.several || field.listed);
    if (isList && !inner.length) return { field: where, value: inner };
    for (const one of isList ? inner : [inner]) {
      const flaw = flawIn(one, field.parts, where);
      if (flaw) return flaw;
    }
    return null;
  }
  if (field.choices || field.count || field.points || field.units === undefined) return null;
  return isNumberLike(inner) ? null : { field: where, value: inner };
}

// A number, or a text that may be one with a unit.
const isNumberLike = (value) => typeof value === "number" || typeof value === "string";

// A copy with texts such as "2200 rpm" as numbers in SI. Texts that are no numbers stay: the engine refuses them.
export function inSi({ problem, duration, ...pushes }) {
  return { problem: partInSi(problem, "Problem"), duration: numberOf(duration, "s"), ...pushes };
}

function partInSi(value, ...titles) {
  if (Array.isArray(value)) return value.map((one) => partInSi(one, ...titles));
  if (value === null || typeof value !== "object") return value;
  const title = titleOf(value, titles);
  const inside = ([name, inner]) => {
    const field = Object.hasOwn(SCHEMA[title].fields, name) ? SCHEMA[title].fields[name] : {};
    if (field.parts) return [name, partInSi(inner, ...field.parts)];
    return [name, numberOf(inner, field.units)];
  };
  return Object.fromEntries(Object.entries(value).map(inside));
}

// The title of a part of those that it may be, by its kind.
const titleOf = ({ kind }, titles) =>
  titles.find((one) => SCHEMA[one].fields.kind?.default === kind) ?? titles[0];

function numberOf(value, units) {
  if (Array.isArray(value)) return value.map((one) => numberOf(one, units));
  if (typeof value !== "string" || units === undefined) return value;
  try {
    return numberInSi(value, units);
  } catch (error) {
    if (error instanceof NoNumber) return value;
    throw error;
  }
}

/** The launch that a run is of. */
export function setupOf({ header: { problem, asked: duration, pushes } }) {
  return pushes ? { problem, duration, pushes } : { problem, duration };
}

/** A launch with other pushes; of none there is no list. */
export function withPushes({ problem, duration }, pushes) {
  return pushes.length ? { problem, duration, pushes } : { problem, duration };
}

export function same(one, other) {
  return JSON.stringify(sorted(one)) === JSON.stringify(sorted(other));
}

function sorted(value) {
  if (Array.isArray(value) || value === null || typeof value !== "object") return value;
  return Object.fromEntries(
    Object.keys(value)
      .sort()
      .map((key) => [key, sorted(value[key])]),
  );
}

// The fields of a launch by their names with dots; lists, such as several surfaces, are one field.
export function* fields(value, prefix = "") {
  for (const [name, inner] of Object.entries(value)) {
    if (inner === undefined || inner === null) continue;
    if (typeof inner === "object" && !Array.isArray(inner))
      yield* fields(inner, `${prefix}${name}.`);
    else yield [`${prefix}${name}`, inner];
  }
}

// In what two launches differ: field, value in one, value in the other.
export function differences(one, other) {
  const flat = ({ problem, duration, pushes }) => {
    const others = pushes ? [["pushes", pushes]] : [];
    return new Map([...fields(problem), ["duration", duration], ...others]);
  };
  const a = flat(one);
  const b = flat(other);
  return [...new Set([...a.keys(), ...b.keys()])]
    .map((field) => [field, a.get(field), b.get(field)])
    .filter(([, x, y]) => JSON.stringify(x) !== JSON.stringify(y));
}
