// Parts of a problem: complete, checked, and clear about what they refuse, as in tippetop.support.validation.
import * as m from "./mechanics.js";
import { not_one_of, unknown_field } from "./suggestions.js";
import { PLACES, SCHEMA } from "./tables.js";
import { degreesHint, inSi, NoNumber, numberHint, written } from "./units.js";

/** The full names of fields by their last names. */
export const declare_places = () => PLACES;

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
    const { fields, checks } = SCHEMA[this.constructor.title];
    const unknown = Object.keys(given).filter((name) => !Object.hasOwn(fields, name));
    const wrong = unknown.map((name) =>
      unknown_field(
        name,
        given[name],
        Object.keys(fields),
        kindsWith(name, this.constructor.title),
      ),
    );
    for (const [name, field] of Object.entries(fields)) {
      const value =
        given[name] === undefined || (given[name] === null && field.default !== undefined)
          ? field.default
          : given[name];
      if (value === undefined) wrong.push(new m.InvalidInput(name, m.MISSING, wanted(field)));
      else this[name] = taken(name, value, field, wrong);
    }
    if (wrong.length) throw m.within_part(wrong[0], "", wrong.length - 1);
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

/** The words of the other kinds of a part that have a field. */
function kindsWith(name, title) {
  const fields = Object.values(SCHEMA).flatMap((part) => Object.values(part.fields));
  const kinds = fields.find(({ parts }) => parts?.includes(title) && parts.length > 1)?.parts ?? [];
  return kinds
    .filter((kind) => Object.hasOwn(SCHEMA[kind].fields, name))
    .map((kind) => SCHEMA[kind].fields.kind.default);
}

/** What a field without a default takes, in words. */
function wanted({ units = "", parts, count, accepted, points }) {
  if (parts) return TABLE;
  if (count) return accepted;
  if (points) return "a list";
  return units === "" || units === "1" ? "a value" : `a number in ${written(units)}`;
}

/** A value of a field, or a list of them, with its numbers in SI; refuses texts that are no numbers. */
export function inUnits(where, value, units, depth = 0) {
  if (Array.isArray(value) && depth)
    return value.map((inner, place) => inUnits(`${where}.${place}`, inner, units, depth - 1));
  if (typeof value !== "string") return value;
  if (units === undefined)
    throw new m.InvalidInput(where, value, "a number", "", numberHint(value));
  try {
    return inSi(value, units);
  } catch (error) {
    if (!(error instanceof NoNumber)) throw error;
    throw new m.InvalidInput(where, value, error.accepted, error.fault, error.hint);
  }
}

/** The value of a field, with parts made of their fields; what is wrong with it is added to the rest. */
function taken(name, asked, field, wrong) {
  if (asked === null && field.default === null) return null;
  if (field.parts) return takenParts(name, asked, field, wrong);
  if (field.choices) {
    if (!field.choices.includes(asked)) wrong.push(not_one_of(name, asked, field.choices));
    return asked;
  }
  const depth = depthOf(field);
  const isList = depth > 0;
  let value = asked;
  if (typeof asked !== "string" || !isList) {
    try {
      value = inUnits(name, asked, field.units, depth);
    } catch (error) {
      if (!(error instanceof m.InvalidInput)) throw error;
      wrong.push(error);
      return asked;
    }
  }
  if (Array.isArray(value) && value.length === field.least) value = [...value, 0];
  if (isList && !isListed(value, field)) {
    wrong.push(refused(name, asked, field.accepted));
  } else if (field.points) {
    value.forEach((point, k) => {
      point.forEach((one, i) => {
        checkNumber(`${name}.${k}.${i}`, one, one, field, wrong);
      });
    });
  } else if (field.count) {
    value.forEach((one, k) => {
      checkNumber(`${name}.${k}`, one, one, field, wrong);
    });
  } else {
    checkNumber(name, value, asked, field, wrong);
  }
  return value;
}

/** How deep the lists of a field's numbers are: none, one, or lists of points. */
function depthOf({ points, count }) {
  if (points) return 2;
  return count ? 1 : 0;
}

function isListed(value, { points, count, fewest }) {
  if (!Array.isArray(value)) return false;
  if (points) return value.every(Array.isArray);
  return value.length <= count && value.length >= (fewest ?? count);
}

function takenParts(name, value, field, wrong) {
  if (field.listed && !Array.isArray(value)) {
    wrong.push(refused(name, value, "a list of tables"));
    return value;
  }
  if (field.listed)
    return value.map((inner, place) => part(`${name}.${place}`, inner, field.parts, wrong));
  if (!(Array.isArray(value) && field.several)) return part(name, value, field.parts, wrong);
  const parts = value.map((inner, place) => part(`${name}.${place}`, inner, field.parts, wrong));
  if (!parts.length) wrong.push(refused(name, value, TABLE));
  return parts.length === 1 ? parts[0] : parts;
}

function refused(where, value, accepted) {
  return new m.InvalidInput(where, value, accepted, "", degreesHint(value, accepted));
}

/** Check one number, in SI; `asked` is how it was written. */
function checkNumber(where, value, asked, field, wrong) {
  const { gt, ge, lt, le } = field.limits ?? {};
  if (typeof value === "boolean") {
    wrong.push(refused(where, value, "a number"));
  } else if (typeof value !== "number" || !Number.isFinite(value)) {
    wrong.push(refused(where, value, "a finite number"));
  } else if (value <= gt || value < ge || value >= lt || value > le) {
    wrong.push(refused(where, typeof asked === "string" ? asked : value, field.accepted));
  }
}

/** A part of one of some kinds. */
function part(name, value, kinds, wrong) {
  if (value instanceof Part) return value;
  try {
    return new m[chosen(value, kinds)](value);
  } catch (error) {
    if (!(error instanceof m.InvalidInput)) throw error;
    wrong.push(`${error.field}.`.startsWith(`${name}.`) ? error : m.within_part(error, name));
    return null;
  }
}

/** The kind that fields are of, told apart by the one that is called `kind`. */
function chosen(value, kinds) {
  if (value === null || typeof value !== "object" || Array.isArray(value))
    throw new m.InvalidInput("", value, TABLE);
  const words = kinds.map((kind) => SCHEMA[kind].fields.kind?.default);
  if (words[0] === undefined) return kinds[0];
  if (value.kind === undefined)
    throw new m.InvalidInput("kind", m.MISSING, `one of ${words.join(", ")}`);
  if (!words.includes(value.kind)) throw not_one_of("kind", value.kind, words);
  return kinds[words.indexOf(value.kind)];
}
