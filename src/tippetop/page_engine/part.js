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
  /** A part of the values of its fields; throws the first error, which says how many others there are. */
  constructor(values = {}) {
    const { fields, checks } = SCHEMA[this.constructor.title];
    const errors = unknownFields(values, fields);
    for (const [name, field] of Object.entries(fields)) {
      const value = valueOrDefault(values[name], field);
      if (value === undefined) {
        errors.push(new m.InvalidInput(name, m.MISSING, "a value; it has no default"));
      } else {
        this[name] = checkedValue(name, value, field, errors);
      }
    }
    if (errors.length) throw errors[0].within("", errors.length - 1);
    for (const check of checks) this[check]();
  }

  *[Symbol.iterator]() {
    for (const name of Object.keys(SCHEMA[this.constructor.title].fields)) yield [name, this[name]];
  }

  /** A copy with other values, which are not checked. */
  model_copy(changes) {
    const copy = Object.create(Object.getPrototypeOf(this));
    return Object.assign(copy, this, Object.fromEntries(changes.entries()));
  }

  model_dump() {
    return JSON.parse(JSON.stringify(this));
  }
}

/** An error for each name that is no field. */
function unknownFields(values, fields) {
  const accepted = `one of the keys ${Object.keys(fields).join(", ")}`;
  const unknown = Object.keys(values).filter((name) => !(name in fields));
  return unknown.map((name) => new m.InvalidInput(name, values[name], accepted));
}

/** The value of a field, or its default where there is none; undefined where there is neither. */
function valueOrDefault(value, field) {
  if (value === undefined) return field.default;
  if (value === null && field.default !== undefined) return field.default;
  return value;
}

/** The value of a field, with parts made of their fields; what is wrong with it is added to the errors. */
function checkedValue(name, value, field, errors) {
  if (value === null && field.default === null) return null;
  if (field.parts) return checkedParts(name, value, field, errors);
  if (!hasForm(value, field)) errors.push(new m.InvalidInput(name, value, field.accepted));
  else if (!field.choices) checkNumbers(name, value, depthOf(field), field, errors);
  return value;
}

/** Whether a value is one of the choices of a field, or a list where the field is one. */
function hasForm(value, field) {
  if (field.choices) return field.choices.includes(value);
  if (field.points) return Array.isArray(value) && value.every(Array.isArray);
  if (field.count) return Array.isArray(value) && value.length === field.count;
  return true;
}

/** How deep in lists the numbers of a field lie. */
function depthOf(field) {
  if (field.points) return 2;
  return field.count ? 1 : 0;
}

/** A part, or several of them where the field allows that; one in a list is as one alone. */
function checkedParts(name, value, field, errors) {
  if (!(Array.isArray(value) && field.several)) return checkedPart(name, value, field, errors);
  if (!value.length) errors.push(new m.InvalidInput(name, value, TABLE));
  const parts = value.map((one, place) => checkedPart(`${name}.${place}`, one, field, errors));
  return parts.length === 1 ? parts[0] : parts;
}

/** A part of one of the kinds of a field. */
function checkedPart(name, value, field, errors) {
  if (value instanceof Part) return value;
  try {
    return new m[kindOf(value, field.parts)](value);
  } catch (error) {
    if (!(error instanceof m.InvalidInput)) throw error;
    // Checks of a part may name fields by their whole path.
    const isWhole = `${error.field}.`.startsWith(`${name}.`);
    errors.push(isWhole ? error : error.within(name));
    return null;
  }
}

/** The kind that fields are of, told apart by the one that is called `kind`. */
function kindOf(value, kinds) {
  if (value === null || typeof value !== "object" || Array.isArray(value)) {
    throw new m.InvalidInput("", value, TABLE);
  }
  const words = kinds.map((kind) => SCHEMA[kind].fields.kind?.default);
  if (words[0] === undefined) return kinds[0];
  if (value.kind === undefined) throw new m.InvalidInput("kind", m.MISSING, "a kind of it");
  if (!words.includes(value.kind)) {
    throw new m.InvalidInput("kind", value.kind, words.map((word) => `'${word}'`).join(", "));
  }
  return kinds[words.indexOf(value.kind)];
}

/** Check a number, or the numbers in lists of some depth. */
function checkNumbers(name, value, depth, field, errors) {
  if (depth) {
    value.forEach((inner, place) => {
      checkNumbers(`${name}.${place}`, inner, depth - 1, field, errors);
    });
    return;
  }
  const { gt, ge, lt, le } = field.limits ?? {};
  if (typeof value !== "number" || !Number.isFinite(value)) {
    errors.push(new m.InvalidInput(name, value, "a finite number"));
  } else if (value <= gt || value < ge || value >= lt || value > le) {
    errors.push(new m.InvalidInput(name, value, field.accepted));
  }
}
