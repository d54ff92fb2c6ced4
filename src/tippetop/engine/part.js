// Parts of a problem: complete, checked, and clear about what they refuse, as in tippetop.validation.
import { typed } from "./runtime.js";
import { SCHEMA } from "./tables.js";

export const MISSING = undefined;

/** A value that cannot be. */
export class InvalidInput extends Error {
  constructor(field, value, accepted, others = 0) {
    const fault = value === MISSING ? "is missing" : `= ${short(value)} is not possible`;
    super(`${field} ${fault}; accepted: ${accepted}${others ? ` (and ${others} more)` : ""}`);
    Object.assign(this, { name: "InvalidInput", field, value, accepted, others });
  }

  /** The same of a field of a part, or of the part itself if it names none; more cannot be besides. */
  within(part, more = 0) {
    const field = [part, this.field].filter(Boolean).join(".");
    return new InvalidInput(field, this.value, this.accepted, this.others + more);
  }
}

function short(value) {
  const text = typeof value === "string" ? `'${value}'` : Array.isArray(value) ? `(${value.map(short).join(", ")})`
    : typeof value === "number" ? typed(value)
    : value !== null && typeof value === "object" ? JSON.stringify(value) : value === null ? "None" : String(value);
  return text.length <= 60 ? text : `${text.slice(0, 57)}...`;
}

/** Every number in the fields of a part, with its name with dots. */
export function numbers_of(value, name = "") {
  if (typeof value === "number") return [[name, value]];
  if (value === null || typeof value !== "object") return [];
  return Object.entries(value).flatMap(([field, inner]) => numbers_of(inner, name ? `${name}.${field}` : field));
}

export const is_number = Number.isFinite, is_whole = Number.isInteger;

const KINDS = {}, TABLE = "a table of its fields";

export class Part {
  static enter(name, kind) {
    kind.title = name;
    KINDS[name] = kind;
  }

  constructor(given = {}) {
    const { fields, checks } = SCHEMA[this.constructor.title], keys = Object.keys(fields).join(", ");
    const unknown = Object.keys(given).filter((name) => !(name in fields));
    const wrong = unknown.map((name) => new InvalidInput(name, given[name], `one of the keys ${keys}`));
    for (const [name, field] of Object.entries(fields)) {
      const value = given[name] === undefined || (given[name] === null && field.default !== undefined) ? field.default : given[name];
      if (value === undefined) wrong.push(new InvalidInput(name, MISSING, "a value; it has no default"));
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
    return Object.assign(Object.create(Object.getPrototypeOf(this)), this, Object.fromEntries(changes.entries()));
  }

  model_dump() {
    return JSON.parse(JSON.stringify(this));
  }
}

/** The value of a field, with parts made of their fields; what is wrong with it is added to the rest. */
function taken(name, value, field, wrong) {
  const refuse = (where, one, accepted) => wrong.push(new InvalidInput(where, one, accepted));
  const number = (where, one, depth) => {
    const { gt, ge, lt, le } = field.limits ?? {};
    if (depth) one.forEach((inner, place) => number(`${where}.${place}`, inner, depth - 1));
    else if (typeof one !== "number" || !Number.isFinite(one)) refuse(where, one, "a finite number");
    else if (one <= gt || one < ge || one >= lt || one > le) refuse(where, one, field.accepted);
  };
  if (value === null && field.default === null) return null;
  if (field.parts) {
    if (!(Array.isArray(value) && field.several)) return part(name, value, field.parts, wrong);
    const found = value.map((inner, place) => part(`${name}.${place}`, inner, field.parts, wrong));
    if (!found.length) refuse(name, value, TABLE);
    return found.length === 1 ? found[0] : found;
  }
  const listed = Array.isArray(value) && (field.points ? value.every(Array.isArray) : value.length === field.count);
  if (field.choices ? !field.choices.includes(value) : (field.points || field.count) && !listed) refuse(name, value, field.accepted);
  else if (!field.choices) number(name, value, field.points ? 2 : field.count ? 1 : 0);
  return value;
}

/** A part of one of some kinds. */
function part(name, value, kinds, wrong) {
  if (value instanceof Part) return value;
  try {
    return new KINDS[chosen(value, kinds)](value);
  } catch (error) {
    if (!(error instanceof InvalidInput)) throw error;
    wrong.push(`${error.field}.`.startsWith(`${name}.`) ? error : error.within(name));
    return null;
  }
}

/** The kind that fields are of, told apart by the one that is called `kind`. */
function chosen(value, kinds) {
  if (value === null || typeof value !== "object" || Array.isArray(value)) throw new InvalidInput("", value, TABLE);
  const words = kinds.map((kind) => SCHEMA[kind].fields.kind?.default);
  if (words[0] === undefined) return kinds[0];
  if (value.kind === undefined) throw new InvalidInput("kind", MISSING, "a kind of it");
  if (!words.includes(value.kind)) throw new InvalidInput("kind", value.kind, words.map(short).join(", "));
  return kinds[words.indexOf(value.kind)];
}
