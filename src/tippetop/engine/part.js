// Parts of a problem: complete, checked, and clear about what they refuse, as in tippetop.validation.
import { SCHEMA } from "./tables.js";

export const MISSING = Symbol("nothing");

/** A value that cannot be. */
export class InvalidInput extends Error {
  constructor(field, value, accepted, others = 0) {
    const more = others ? ` (and ${others} more)` : "";
    const fault = value === MISSING ? "is missing" : `= ${short(value)} is not possible`;
    super(`${field} ${fault}; accepted: ${accepted}${more}`);
    Object.assign(this, { name: "InvalidInput", field, value: value === MISSING ? undefined : value, accepted, others });
  }
}

function short(value) {
  const text = typeof value === "string" ? `'${value}'` : Array.isArray(value) ? `(${value.map(short).join(", ")})`
    : value !== null && typeof value === "object" ? JSON.stringify(value) : value === null ? "None" : String(value);
  return text.length <= 60 ? text : `${text.slice(0, 57)}...`;
}

/** Every number in the fields of a part, with its name with dots. */
export function* numbers_of(value, name = "") {
  if (typeof value === "number") yield [name, value];
  else if (value !== null && typeof value === "object") {
    for (const [field, inner] of Object.entries(value)) yield* numbers_of(inner, name ? `${name}.${field}` : field);
  }
}

const KINDS = {}, TABLE = "a table of its fields";

export class Part {
  static enter(name, kind) {
    kind.title = name;
    KINDS[name] = kind;
  }

  constructor(given = {}) {
    const { fields, checks } = SCHEMA[this.constructor.title], wrong = [];
    for (const name of Object.keys(given)) {
      if (!(name in fields)) wrong.push([name, given[name], `one of the keys ${Object.keys(fields).join(", ")}`]);
    }
    for (const [name, field] of Object.entries(fields)) {
      const value = given[name] === undefined || (given[name] === null && field.default !== undefined) ? field.default : given[name];
      if (value === undefined) wrong.push([name, MISSING, "a value; it has no default"]);
      else this[name] = taken(name, value, field, wrong);
    }
    if (wrong.length) {
      const [name, value, accepted, others = 0] = wrong[0];
      throw new InvalidInput(name, value, accepted, wrong.length - 1 + others);
    }
    for (const check of checks) this[check]();
  }

  *[Symbol.iterator]() {
    for (const name of Object.keys(SCHEMA[this.constructor.title].fields)) yield [name, this[name]];
  }

  /** A copy with other values, which are not checked. */
  model_copy(changes) {
    return Object.assign(Object.create(Object.getPrototypeOf(this)), this, Object.fromEntries(changes.items()));
  }

  model_dump() {
    return JSON.parse(JSON.stringify(this));
  }
}

function taken(name, value, field, wrong) {
  const refuse = (where, what, accepted, others) => wrong.push([where, what, accepted, others]);
  const number = (where, one) => {
    const { gt, ge, lt, le } = field.limits ?? {};
    if (typeof one !== "number" || !Number.isFinite(one)) refuse(where, one, "a finite number");
    else if (one <= gt || one < ge || one >= lt || one > le) refuse(where, one, field.accepted);
  };
  const listed = (all) => Array.isArray(all) && (field.points ? all.every(Array.isArray) : all.length === field.count);
  if (value === null && field.default === null) return null;
  if (field.parts) {
    if (!(Array.isArray(value) && field.several)) return part(name, value, field.parts, refuse);
    const found = value.map((inner, place) => part(`${name}.${place}`, inner, field.parts, refuse));
    if (!found.length) refuse(name, value, TABLE);
    return found.length === 1 ? found[0] : found;
  }
  if (field.choices ? !field.choices.includes(value) : (field.points || field.count) && !listed(value)) refuse(name, value, field.accepted);
  else if (field.points) value.forEach((point, place) => point.forEach((one, k) => number(`${name}.${place}.${k}`, one)));
  else if (field.count) value.forEach((one, place) => number(`${name}.${place}`, one));
  else if (!field.choices) number(name, value);
  return value;
}

/** A part of one of some kinds, told apart by their field `kind`. */
function part(name, value, kinds, refuse) {
  if (value instanceof Part) return value;
  if (value === null || typeof value !== "object" || Array.isArray(value)) {
    refuse(name, value, TABLE);
    return null;
  }
  let found = kinds[0];
  const words = kinds.map((kind) => SCHEMA[kind].fields.kind?.default);
  if (words[0] !== undefined) {
    found = kinds[words.indexOf(value.kind)];
    if (found === undefined) {
      const missing = value.kind === undefined;
      refuse(`${name}.kind`, missing ? MISSING : value.kind, missing ? "a kind of it" : words.map((word) => `'${word}'`).join(", "));
      return null;
    }
  }
  try {
    return new KINDS[found](value);
  } catch (error) {
    if (!(error instanceof InvalidInput)) throw error;
    const where = `${error.field}.`.startsWith(`${name}.`) ? error.field : `${name}.${error.field}`;
    refuse(where, error.value === undefined ? MISSING : error.value, error.accepted, error.others);
    return null;
  }
}
