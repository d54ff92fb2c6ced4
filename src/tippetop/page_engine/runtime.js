// What Python means where JavaScript means something else: for the translated modules.
import { repr } from "./words.js";

export class ArithmeticError extends Error {}
export class ZeroDivisionError extends ArithmeticError {}
export class ValueError extends Error {}
export class NotImplementedError extends Error {}
export class AssertionError extends Error {}
export const NotImplemented = null;

// Blocks under way in which undefined results are no errors, but no numbers, as in arrays.
let lenientBlocks = 0;
let strict = true;

/** Begin (false) or leave (true) a block in which undefined results are no errors; blocks may be nested. */
export function heed(whether) {
  lenientBlocks += whether ? -1 : 1;
  strict = lenientBlocks === 0;
}

// ---- numbers, and what else has arithmetic: series, discs, nodes of a graph; lists are joined

export const hasattr = (one, name) => one !== null && typeof one === "object" && name in one;
const callMethod = (a, name, b) => (hasattr(a, name) ? a[name](b) : NotImplemented);

/** Whether Python asks the second operand first: its class derives from the first one's. */
function isMoreSpecial(a, name, b, reflected) {
  if (typeof a !== "object" || typeof b !== "object" || a === null || b === null) return false;
  if (b.constructor === a.constructor || !(b instanceof a.constructor)) return false;
  return reflected in b && name in a;
}

/** An operation on operands that are not both numbers: by a method of either, or of truth values as numbers. */
function operate(a, b, name, reflected, onNumbers) {
  let result = NotImplemented;
  if (!isMoreSpecial(a, name, b, reflected)) result = callMethod(a, name, b);
  if (result === NotImplemented) result = callMethod(b, reflected, a);
  if (result !== NotImplemented) return result;
  if (typeof a === "boolean" || typeof b === "boolean") return onNumbers(Number(a), Number(b));
  throw new TypeError(`${name} of ${a} and ${b}`);
}

export function add(a, b) {
  if ((typeof a === "number" && typeof b === "number") || typeof a === "string") return a + b;
  if (Array.isArray(a)) return [...a, ...b];
  return operate(a, b, "__add__", "__radd__", add);
}

export function sub(a, b) {
  if (typeof a === "number" && typeof b === "number") return a - b;
  return operate(a, b, "__sub__", "__rsub__", sub);
}

export function mul(a, b) {
  if (typeof a === "number" && typeof b === "number") return a * b;
  if (typeof a === "string") return a.repeat(b);
  if (Array.isArray(a)) return Array.from({ length: b * a.length }, (_, i) => a[i % a.length]);
  return operate(a, b, "__mul__", "__rmul__", mul);
}

export function div(a, b) {
  if (typeof a === "number" && typeof b === "number") {
    if (b === 0 && strict) throw new ZeroDivisionError("division by zero");
    return a / b;
  }
  return operate(a, b, "__truediv__", "__rtruediv__", div);
}

export function pow(a, b) {
  if (typeof a !== "number" || typeof b !== "number") {
    return operate(a, b, "__pow__", "__rpow__", pow);
  }
  if (b === 2) return finite(a * a, a);
  if (!strict) return a ** b;
  if (a === 0 && b < 0) throw new ZeroDivisionError("0.0 cannot be raised to a negative power");
  if (a < 0 && b !== Math.trunc(b)) throw new ArithmeticError("a root of a negative number");
  if (b === 0.5) return Math.sqrt(a);
  if (b === -0.5) return 1 / Math.sqrt(a);
  if (b === 0.25) return Math.sqrt(Math.sqrt(a));
  return finite(a ** b, a);
}

/** A result, which must be finite if what it was computed from is. */
function finite(result, operand) {
  if (strict && !Number.isFinite(result) && Number.isFinite(operand)) {
    throw new ArithmeticError("a result too large");
  }
  return result;
}

/** Whether undefined results are errors. */
export const heeds = () => strict;

/** Quotient and remainder as Python has them: the remainder is exact, with the sign of the divisor. */
function divided(a, b) {
  if (b === 0) throw new ZeroDivisionError("division by zero");
  let remainder = a % b;
  let quotient = (a - remainder) / b;
  if (remainder !== 0 && remainder < 0 !== b < 0) {
    remainder += b;
    quotient -= 1;
  }
  const whole = Math.floor(quotient);
  return [quotient - whole > 0.5 ? whole + 1 : whole, remainder];
}

export function floordiv(a, b) {
  if (typeof a === "number" && typeof b === "number") return divided(a, b)[0];
  return operate(a, b, "__floordiv__", "__rfloordiv__", floordiv);
}

export function mod(a, b) {
  if (typeof a === "number" && typeof b === "number") return divided(a, b)[1];
  return operate(a, b, "__mod__", "__rmod__", mod);
}

function truths(a, b) {
  if (typeof a !== "boolean" || typeof b !== "boolean")
    throw new TypeError("| and & are of truth values only");
}
export function either(a, b) {
  if (hasattr(a, "__or__")) return a.__or__(b);
  truths(a, b);
  return a || b;
}
export function both(a, b) {
  if (hasattr(a, "__and__")) return a.__and__(b);
  truths(a, b);
  return a && b;
}

/** A sum for `+=` of what is no list: a list would be extended in place. */
export function add_in_place(a, b) {
  if (Array.isArray(a))
    throw new TypeError("it is not known whether a list or a tuple is extended");
  return add(a, b);
}

export function neg(a) {
  if (typeof a === "number") return -a;
  if (typeof a === "boolean") return -Number(a);
  return a.__neg__();
}

export const abs = (a) => (typeof a === "number" ? Math.abs(a) : a.__abs__());
export function float(a) {
  if (typeof a !== "string") return Number(a);
  const text = a.trim().toLowerCase();
  if (/^[+-]?(inf|infinity)$/.test(text)) return text.startsWith("-") ? -Infinity : Infinity;
  const number = Number(text);
  if (text !== "nan" && (!text || Number.isNaN(number) || /[xob]/.test(text)))
    throw new ValueError(`could not convert string to float: ${repr(a)}`);
  return number;
}
export function int(a) {
  if (typeof a === "string" && !/^\s*[+-]?\d+\s*$/.test(a))
    throw new ValueError(`invalid literal for int() with base 10: ${repr(a)}`);
  const number = Math.trunc(Number(a));
  if (Number.isNaN(number)) throw new ValueError("cannot convert float NaN to integer");
  if (!Number.isFinite(number))
    throw new ArithmeticError("cannot convert float infinity to integer");
  return number;
}
export function str(a) {
  if (typeof a === "string") return a;
  if (a instanceof Error) return a.message;
  if (a instanceof StrEnum) return a.value;
  return a instanceof Enum ? `${a.constructor.name}.${a.name}` : repr(a);
}
export const sum = (values, start = 0) =>
  tuple(values).reduce((total, value) => add(total, value), start);

export function truth(a) {
  if (typeof a === "number") return a !== 0;
  if (a === null || a === undefined || typeof a !== "object") return Boolean(a);
  if (typeof a.__bool__ === "function") return a.__bool__();
  if (a instanceof Set) return a.size > 0;
  if (ArrayBuffer.isView(a)) throw new TypeError("an array has no truth value");
  return a instanceof NamedTuple || a.length === undefined ? true : a.length > 0;
}
const or_ = (a, other) => (truth(a) ? a : other());
const and_ = (a, other) => (truth(a) ? other() : a);

export { and_ as and, or_ as or, truth as bool };

function within_domain(x, holds) {
  if (!holds && !Number.isNaN(x)) throw new ValueError("math domain error");
  return x;
}

function whole(number) {
  if (number > 2 ** 53) throw new ArithmeticError("integers are exact up to 2**53 only");
  return number;
}

export const math = {
  __proto__: Math,
  pi: Math.PI,
  inf: Infinity,
  nan: NaN,
  sqrt: (x) => Math.sqrt(within_domain(x, x >= 0)),
  log: (x) => Math.log(within_domain(x, x > 0)),
  log10: (x) => Math.log10(within_domain(x, x > 0)),
  log1p: (x) => Math.log1p(within_domain(x, x > -1)),
  acos: (x) => Math.acos(within_domain(x, x >= -1 && x <= 1)),
  acosh: (x) => Math.acosh(within_domain(x, x >= 1)),
  asin: (x) => Math.asin(within_domain(x, x >= -1 && x <= 1)),
  exp: (x) => finite(Math.exp(x), x),
  expm1: (x) => finite(Math.expm1(x), x),
  isnan: Number.isNaN,
  factorial: (count) => whole(count > 1 ? count * math.factorial(count - 1) : 1),
  isfinite: Number.isFinite,
  isinf: (x) => Math.abs(x) === Infinity,
  sinh: (x) => finite(Math.sinh(x), x),
  cosh: (x) => finite(Math.cosh(x), x),
  tau: 2 * Math.PI,
  radians: (x) => (x * Math.PI) / 180,
  copysign: (a, b) => (b < 0 || Object.is(b, -0) ? -Math.abs(a) : Math.abs(a)),
  dist: (a, b) => Math.hypot(...Array.from(a, (x, i) => x - b[i])),
};

const identity = (one) => one;

/** What is asked of NumPy: arrays to be filled, those of two dimensions as lists of arrays; and numbers for arrays. */
export const np = {
  __proto__: Math,
  pi: Math.PI,
  inf: Infinity,
  nan: NaN,
  isfinite: Number.isFinite,
  arctan2: Math.atan2,
  minimum: Math.min,
  maximum: Math.max,
  fmax: (a, b) => (a >= b || Number.isNaN(b) ? a : b),
  copysign: math.copysign,
  less: (a, b) => (hasattr(a, "__lt__") ? a.__lt__(b) : a < b),
  where: (condition, a, b) => {
    if (hasattr(condition, "graph")) return condition.graph.select(condition, a, b);
    return condition ? a : b;
  },
  any: identity,
  max: identity,
  min: identity,
  stack: (parts) => Float64Array.from(parts),
  empty: (shape) => {
    if (typeof shape === "number") return new Float64Array(shape);
    const [rows, columns] = shape;
    return filled(rows, () => new Float64Array(columns));
  },
  zeros: (shape) => np.empty(shape),
  array: (numbers) => new Float64Array(numbers),
};

// ---- tuples with names, records and enumerations

export class Thing {
  valueOf() {
    throw new TypeError("what is compared, or added to something, is no number");
  }
}

export class NamedTuple extends Thing {
  *[Symbol.iterator]() {
    for (const name of this.constructor.fields) yield this[name];
  }
}

export class Record extends Thing {}

export function replace(one, changes) {
  const { fields } = one.constructor;
  for (const name of Object.keys(changes))
    if (!fields.includes(name)) throw new TypeError(`${one.constructor.name} has no field ${name}`);
  return new one.constructor(
    ...fields.map((name) => (name in changes ? changes[name] : one[name])),
  );
}

/** Its members are numbers. */
export class IntEnum extends Thing {}

export class Enum {
  constructor(name, value) {
    this.name = name;
    this.value = value;
    Object.freeze(this);
  }
  static [Symbol.iterator]() {
    return Object.values(this)[Symbol.iterator]();
  }
}

/** Its members equal their values. */
export class StrEnum extends Enum {}

/** Records, tuples with names and words of an enumeration as plain objects, arrays and strings. */
export function plain(one) {
  if (one instanceof Enum) return one.value;
  if (Array.isArray(one)) return one.map(plain);
  if (!(one instanceof Record || one instanceof NamedTuple)) return one;
  return Object.fromEntries(one.constructor.fields.map((name) => [name, plain(one[name])]));
}

// ---- equality, and the keys of tables and caches

const isRow = (a) => Array.isArray(a) || a instanceof NamedTuple;

const isPlain = (a) => a === null || (typeof a !== "object" && typeof a !== "boolean");

export function eq(a, b) {
  if (a === b) return true;
  if (isPlain(a) && isPlain(b)) return false;
  if (hasattr(a, "__eq__")) return a.__eq__(b);
  if (hasattr(b, "__eq__")) return b.__eq__(a);
  if (isRow(a) && isRow(b)) {
    const [one, other] = [[...a], [...b]];
    return one.length === other.length && one.every((each, place) => eq(each, other[place]));
  }
  if (a instanceof Record && a.constructor === b?.constructor)
    return a.constructor.fields.every((name) => eq(a[name], b[name]));
  if (a instanceof StrEnum || b instanceof StrEnum) return said(a) === said(b);
  for (const one of [a, b])
    if (one instanceof Map || one instanceof Set || ArrayBuffer.isView(one))
      throw new TypeError("equality of sets, dicts and arrays is not known");
  if (typeof a === "boolean" || typeof b === "boolean")
    return isNumber(a) && isNumber(b) && Number(a) === Number(b);
  return false;
}
const said = (a) => (a instanceof StrEnum ? a.value : a);
const isNumber = (a) => typeof a === "number" || typeof a === "boolean";

export function contains(all, one) {
  if (all instanceof Map || all instanceof Set) return all.has(place_of(one));
  if (typeof all === "string") return all.includes(one);
  return [...all].some((each) => eq(each, one));
}

const identities = new WeakMap();
let identityCount = 0;

/** A text that is the same for values that are equal. */
export function key(a) {
  if (typeof a === "string") return JSON.stringify(a);
  if (a === null || (typeof a !== "object" && typeof a !== "function")) return String(a);
  if (Array.isArray(a)) return `(${a.map(key).join()})`;
  if (a instanceof NamedTuple || a instanceof Record) {
    const values = a.constructor.fields.map((name) => key(a[name]));
    return `${key(a.constructor)}(${values.join()})`;
  }
  if (!identities.has(a)) {
    identityCount += 1;
    identities.set(a, `#${identityCount}`);
  }
  return identities.get(a);
}

/** A function that remembers its latest values, but not more than so many. */
export function cached(function_, most = 1024) {
  const values = new Map();
  return (...operands) => {
    const place = key(operands);
    if (!values.has(place)) values.set(place, function_(...operands));
    if (values.size > most) values.delete(values.keys().next().value);
    return values.get(place);
  };
}

/** What stands in a set or a dict: tuples and records would be told apart though they are equal. */
function place_of(one) {
  if (isRow(one) || one instanceof Record)
    throw new TypeError("tuples and records in sets and dicts are not known");
  return one;
}

export class Dict extends Map {
  get length() {
    return this.size;
  }
  get(one, other = null) {
    return this.has(place_of(one)) ? super.get(one) : other;
  }
  set(one, value) {
    return super.set(place_of(one), value);
  }
  [Symbol.iterator]() {
    return this.keys();
  }
}

// ---- sequences

export function item(all, place) {
  if (
    typeof place === "number" &&
    (Array.isArray(all) ||
      typeof all === "string" ||
      all instanceof NamedTuple ||
      ArrayBuffer.isView(all))
  ) {
    return all[place < 0 ? len(all) + place : place];
  }
  if (all instanceof Dict) {
    if (!all.has(place)) throw new TypeError(`a dict has no ${place}`);
    return all.get(place);
  }
  return all.__getitem__ === undefined ? all[place] : all.__getitem__(place);
}

export function put(all, place, value) {
  if (all instanceof Dict) all.set(place, value);
  else if (all.__setitem__ !== undefined) all.__setitem__(place, value);
  else all[place < 0 ? all.length + place : place] = value;
}

/** The first place of a slice, and how many there are; null stands for an end that is left out. */
export function span(length, from, to, step) {
  const inside = (place, low, high) =>
    Math.min(Math.max(place < 0 ? place + length : place, low), high);
  const [low, high] = step > 0 ? [0, length] : [-1, length - 1];
  const [first, last] = step > 0 ? [low, high] : [high, low];
  const start = from === null ? first : inside(from, low, high);
  const end = to === null ? last : inside(to, low, high);
  return [start, Math.max(0, Math.ceil((end - start) / step))];
}

/** A slice of a sequence with a step. */
export function slice(all, from, to, step) {
  if (all.strided) return all.strided(from, to, step);
  const row = tuple(all);
  const [start, count] = span(row.length, from, to, step);
  return filled(count, (place) => row[start + place * step]);
}

/** Write the values of an array, or one value, to a slice of an array. */
export function put_slice(all, from, to, value) {
  const part = all.strided(from, to, 1);
  for (let place = 0; place < part.length; place++)
    part.__setitem__(place, value.length === undefined ? value : item(value, place));
}

/** A value of an object that is computed when it is first asked for. */
export function remembered(one, name, compute) {
  const value = compute();
  Object.defineProperty(one, name, { value });
  return value;
}

/** A function with its first operands set. */
export const partial =
  (function_, ...first) =>
  (...others) =>
    function_(...first, ...others);

/** Half a unit of the last decimal of a number, 0 of a whole number. */
export function rounding_of(number) {
  const [, places = "", power = "0"] =
    /^-?\d+(?:\.(\d*?)0*)?(?:e([+-]\d+))?$/.exec(String(number)) ?? [];
  const exponent = Number(power) - places.length;
  return exponent < 0 ? 0.5 * 10 ** exponent : 0;
}

export function len(all) {
  if (all instanceof NamedTuple) return all.constructor.fields.length;
  const count = all instanceof Set ? all.size : all.length;
  if (count === undefined) throw new TypeError("it has no length");
  return count;
}
/** Extend a list in place, as all who have it see. */
export function extend(all, values) {
  for (const value of list(values)) all.push(value);
  return all;
}
export function index(all, one) {
  const place = typeof all === "string" ? all.indexOf(one) : list(all).findIndex((a) => eq(a, one));
  if (place < 0) throw new ValueError("it is not in the list");
  return place;
}
export function pop(all, place = -1) {
  if (!all.length) throw new TypeError("pop from an empty list");
  return all.splice(place, 1)[0];
}
export const add_to = (all, one) => {
  all.add(place_of(one));
};
/** So many values: `Array.from`, and spreading of what is no list, take ten times as long. */
function filled(count, value) {
  const values = [];
  for (let place = 0; place < count; place += 1) values.push(value(place));
  return values;
}

export const list = (all = []) =>
  ArrayBuffer.isView(all) ? filled(all.length, (place) => all[place]) : [...all];
export const tuple = (all = []) => (Array.isArray(all) ? all : list(all));
export const dict = (pairs = []) => new Dict(pairs);
export const set = (all = []) => new Set(list(all).map(place_of));
export const range = (start, stop = null, step = 1) =>
  stop === null
    ? filled(start, (place) => place)
    : filled(Math.ceil((stop - start) / step), (place) => start + place * step);
export const enumerate = (all, start = 0) => Array.from(all, (one, place) => [start + place, one]);
export const reversed = (all) => [...all].reverse();

export function zip(...sequences) {
  const rows = sequences.map(tuple);
  const shortest = rows.reduce((a, b) => (b.length < a.length ? b : a));
  return shortest.map((_, place) => rows.map((row) => row[place]));
}
/** `zip` of rows that must be as long as each other. */
export function zip_equal(...rows) {
  const all = rows.map(tuple);
  if (all.some((row) => row.length !== all[0].length))
    throw new ValueError("zip() has arguments of different lengths");
  return zip(...all);
}
export function map(function_, ...rows) {
  const [a, b] = rows.map(tuple);
  if (rows.length !== 2) return zip(...rows).map((row) => function_(...row));
  return filled(Math.min(a.length, b.length), (place) => function_(a[place], b[place]));
}

export const pairwise = (all) => zip(all, all.slice(1));
export const any = (all) => [...all].some(truth);
export const all = (each) => [...each].every(truth);
export function next([first], ...otherwise) {
  if (first === undefined && !otherwise.length) throw new TypeError("there is no next one");
  return first === undefined ? otherwise[0] : first;
}

function isBelow(a, b) {
  if (!isRow(a) || !isRow(b)) return a < b;
  const [one, other] = [[...a], [...b]];
  const place = one.findIndex((each, i) => i >= other.length || !eq(each, other[i]));
  if (place < 0) return one.length < other.length;
  return place < other.length && isBelow(one[place], other[place]);
}

/** The best of some values, or of those in one sequence; `key` and `default` may be the last operand's. */
function best(operands, isBetter) {
  const options = operands.at(-1)?.constructor === Object ? operands.pop() : {};
  const { key: worth = identity } = options;
  const choices = operands.length === 1 ? [...operands[0]] : operands;
  if (!choices.length && "default" in options) return options.default;
  return choices.reduce((one, choice) => (isBetter(worth(choice), worth(one)) ? choice : one));
}
export const max = (...operands) => best(operands, (one, other) => isBelow(other, one));
export const min = (...operands) => best(operands, isBelow);

/** The larger of two, without a list of operands: this is asked for in every step. */
export function larger(a, b) {
  if (typeof a !== "number" || typeof b !== "number") return max(a, b);
  // biome-ignore lint/complexity/useMathMinMax: where one is no number, Python's max is the first
  return b > a ? b : a;
}

/** The smaller of two; see `larger`. */
export function smaller(a, b) {
  if (typeof a !== "number" || typeof b !== "number") return min(a, b);
  // biome-ignore lint/complexity/useMathMinMax: where one is no number, Python's min is the first
  return b < a ? b : a;
}

export function sorted(all, { key: worth = identity } = {}) {
  return [...all].sort((a, b) => {
    const [x, y] = [worth(a), worth(b)];
    return isBelow(y, x) - isBelow(x, y);
  });
}

// ---- objects

export const is_number = Number.isFinite,
  is_whole = Number.isInteger;
export function getattr(one, name, ...otherwise) {
  if (hasattr(one, name)) return member(one, name);
  if (!otherwise.length && typeof one !== "function") throw new TypeError(`it has no ${name}`);
  return typeof one === "function" && name in one ? one[name] : otherwise[0];
}
/** A field, or a method with the object or class it belongs to; of a class a method that takes the object first. */
export function member(one, name) {
  if (typeof one === "function" && !(name in one))
    return (self, ...others) => one.prototype[name].apply(self, others);
  const value = one[name];
  return typeof value === "function" && isMethod(one, name) ? value.bind(one) : value;
}
function isMethod(one, name) {
  if (typeof one === "function") return true;
  if (Object.hasOwn(one, name)) return false;
  let above = Object.getPrototypeOf(one);
  while (above !== null && !Object.hasOwn(above, name)) above = Object.getPrototypeOf(above);
  return above !== null && "value" in Object.getOwnPropertyDescriptor(above, name);
}
export const type = (one) => one.constructor;

export function isinstance(one, kind) {
  if (Array.isArray(kind)) return kind.some((each) => isinstance(one, each));
  if (kind === float || kind === int) return typeof one === "number" || typeof one === "boolean";
  if (kind === tuple) return isRow(one);
  if (kind === str) return typeof one === "string";
  if (kind === truth) return typeof one === "boolean";
  return one instanceof kind;
}
