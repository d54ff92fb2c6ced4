// Parts of a problem: complete, checked, and clear about what they refuse, as in tippetop.support.validation.
import * as m from "./mechanics.js";
import { SCHEMA } from "./tables.js";

/** Every number in the fields of a part, with its name with dots. */
export function numbers_of(value, name = "") {
  if (typeof value === "number") return [[name, value]];
  if (value === null || typeof value !== "object") return [];
  return Object.entries(value).flatMap(([field, inner]) =>
    numbers_of(inner, name ? `${name}.${field}` : field),
  );
}

const TABLE = "a table of its fields";

export class Part {
  constructor(given = {}) {
    const { fields, checks } = SCHEMA[this.constructor.title],
      keys = Object.keys(fields).join(", ");
    const unknown = Object.keys(given).filter((name) => !(name in fields));
    const wrong = unknown.map(
      (name) => new m.InvalidInput(name, given[name], `one of the keys ${keys}`),
    );
    for (const [name, field] of Object.entries(fields)) {
      const value =
        given[name] === undefined || (given[name] === null && field.default !== undefined)
          ? field.default
          : given[name];
      if (value === undefined)
        wrong.push(new m.InvalidInput(name, m.MISSING, "a value; it has no default"));
      else this[name] = taken(name, value, field, wrong);
    }
    if (wrong.length) throw wrong[0].within("", wrong.length - 1);
    for (const check of checks) this[check]();
  }

  *[Symbol.iterator]() {
    for (const name of Object.keys(SCHEMA[this.constructor.title].fields)) yield [name, this[name]];
  }

  /** A copy with other values, which are not checked. */
  model_copy(changes) {
    return Object.assign(
      Object.create(Object.getPrototypeOf(this)),
      this,
      Object.fromEntries(changes.entries()),
    );
  }

  model_dump() {
    return JSON.parse(JSON.stringify(this));
  }
}

/** The value of a field, with parts made of their fields; what is wrong with it is added to the rest. */
function taken(name, value, field, wrong) {
  const refuse = (where, one, accepted) => wrong.push(new m.InvalidInput(where, one, accepted));
  const number = (where, one, depth) => {
    const { gt, ge, lt, le } = field.limits ?? {};
    if (depth) one.forEach((inner, place) => number(`${where}.${place}`, inner, depth - 1));
    else if (typeof one !== "number" || !Number.isFinite(one))
      refuse(where, one, "a finite number");
    else if (one <= gt || one < ge || one >= lt || one > le) refuse(where, one, field.accepted);
  };
  if (value === null && field.default === null) return null;
  if (field.parts) {
    if (!(Array.isArray(value) && field.several)) return part(name, value, field.parts, wrong);
    const found = value.map((inner, place) => part(`${name}.${place}`, inner, field.parts, wrong));
    if (!found.length) refuse(name, value, TABLE);
    return found.length === 1 ? found[0] : found;
  }
  const listed =
    Array.isArray(value) &&
    (field.points ? value.every(Array.isArray) : value.length === field.count);
  if (field.choices ? !field.choices.includes(value) : (field.points || field.count) && !listed)
    refuse(name, value, field.accepted);
  else if (!field.choices) number(name, value, field.points ? 2 : field.count ? 1 : 0);
  return value;
}

/** A part of one of some kinds. */
function part(name, value, kinds, wrong) {
  if (value instanceof Part) return value;
  try {
    return new m[chosen(value, kinds)](value);
  } catch (error) {
    if (!(error instanceof m.InvalidInput)) throw error;
    wrong.push(`${error.field}.`.startsWith(`${name}.`) ? error : error.within(name));
    return null;
  }
}

/** The kind that fields are of, told apart by the one that is called `kind`. */
function chosen(value, kinds) {
  if (value === null || typeof value !== "object" || Array.isArray(value))
    throw new m.InvalidInput("", value, TABLE);
  const words = kinds.map((kind) => SCHEMA[kind].fields.kind?.default);
  if (words[0] === undefined) return kinds[0];
  if (value.kind === undefined) throw new m.InvalidInput("kind", m.MISSING, "a kind of it");
  if (!words.includes(value.kind))
    throw new m.InvalidInput("kind", value.kind, words.map((word) => `'${word}'`).join(", "));
  return kinds[words.indexOf(value.kind)];
}
