// What Python means where JavaScript means something else: for the translated modules.
import { repr } from "./words.js";

export * from "./words.js";

export class ArithmeticError extends Error {}
export class ZeroDivisionError extends ArithmeticError {}
export const NotImplemented = null;
export const ValueError = Error;
export const NotImplementedError = Error;
export const AssertionError = Error;

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
  return (
    hasattr(b, reflected) &&
    hasattr(a, name) &&
    b instanceof a.constructor &&
    b.constructor !== a.constructor
  );
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

export const floordiv = (a, b) => Math.floor(a / b);
export const mod = (a, b) => a - b * Math.floor(a / b);

export function neg(a) {
  if (typeof a === "number") return -a;
  if (typeof a === "boolean") return -Number(a);
  return a.__neg__();
}

export const abs = (a) => (typeof a === "number" ? Math.abs(a) : a.__abs__());
export const float = (a) => (a === "inf" ? Infinity : Number(a));
export const int = (a) => Math.trunc(Number(a));

export function str(a) {
  if (a instanceof Error) return a.message;
  if (a instanceof Enum) return a.name;
  return typeof a === "string" ? a : repr(a);
}

export const sum = (values, start = 0) =>
  tuple(values).reduce((total, value) => add(total, value), start);

export function truth(a) {
  if (typeof a === "number") return a !== 0;
  if (a === null || a === undefined || typeof a !== "object") return Boolean(a);
  if (typeof a.__bool__ === "function") return a.__bool__();
  return a instanceof NamedTuple || a.length === undefined ? true : a.length > 0;
}
const or_ = (a, other) => (truth(a) ? a : other());
const and_ = (a, other) => (truth(a) ? other() : a);

export { and_ as and, or_ as or, truth as bool };

export const math = {
  __proto__: Math,
  pi: Math.PI,
  inf: Infinity,
  nan: NaN,
  factorial: (count) => (count > 1 ? count * math.factorial(count - 1) : 1),
  isfinite: Number.isFinite,
  isinf: (x) => Math.abs(x) === Infinity,
  sinh: (x) => finite(Math.sinh(x), x),
  cosh: (x) => finite(Math.cosh(x), x),
  dist: (a, b) => Math.hypot(...Array.from(a, (x, i) => x - b[i])),
};

const identity = (one) => one;

/** What is asked of NumPy: arrays to be filled, those of two dimensions as lists of arrays; and numbers for arrays. */
export const np = {
  __proto__: math,
  arctan2: Math.atan2,
  minimum: Math.min,
  maximum: Math.max,
  fmax: (a, b) => (a >= b || Number.isNaN(b) ? a : b),
  copysign: (a, b) => (b < 0 || Object.is(b, -0) ? -Math.abs(a) : Math.abs(a)),
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
  return new one.constructor(
    ...fields.map((name) => (name in changes ? changes[name] : one[name])),
  );
}

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

/** Records, tuples with names and words of an enumeration as plain objects, arrays and strings. */
export function plain(one) {
  if (one instanceof Enum) return one.value;
  if (Array.isArray(one)) return one.map(plain);
  if (!(one instanceof Record || one instanceof NamedTuple)) return one;
  return Object.fromEntries(one.constructor.fields.map((name) => [name, plain(one[name])]));
}

// ---- equality, and the keys of tables and caches

const isRow = (a) => Array.isArray(a) || a instanceof NamedTuple;

export function eq(a, b) {
  if (a === b) return true;
  if (isRow(a) && isRow(b)) {
    return len(a) === len(b) && [...a].every((one, place) => eq(one, b[place]));
  }
  if (a instanceof Record && a.constructor === b?.constructor) {
    return a.constructor.fields.every((name) => eq(a[name], b[name]));
  }
  return typeof a === "boolean" && typeof b === "number" ? Number(a) === b : false;
}

export function contains(all, one) {
  if (all instanceof Map || all instanceof Set) return all.has(one);
  return [...all].some((each) => eq(each, one));
}

const identities = new WeakMap();
let identityCount = 0;

/** A text that is the same for values that are equal. */
function key(a) {
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

export class Dict extends Map {
  get length() {
    return this.size;
  }
  get(one, other = null) {
    return this.has(one) ? super.get(one) : other;
  }
  [Symbol.iterator]() {
    return this.keys();
  }
}

// ---- sequences

export function item(all, place) {
  if (
    typeof place === "number" &&
    (Array.isArray(all) || all instanceof NamedTuple || ArrayBuffer.isView(all))
  ) {
    return all[place < 0 ? len(all) + place : place];
  }
  if (all instanceof Dict) return all.get(place);
  return all.__getitem__ === undefined ? all[place] : all.__getitem__(place);
}

export function put(all, place, value) {
  if (all instanceof Dict) all.set(place, value);
  else all[place < 0 ? all.length + place : place] = value;
}

/** A slice of a sequence, backwards. */
export function slice(all, from, to, step) {
  if (step !== -1 || from < 0 || to < 0) throw new RangeError("such a slice is not known here");
  const start = to === null ? 0 : to + 1;
  const end = from === null ? undefined : from + 1;
  return tuple(all).slice(start, end).reverse();
}

export const len = (all) =>
  all instanceof NamedTuple ? all.constructor.fields.length : all.length;

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

export function range(start, stop = null, step = 1) {
  if (stop === null) return filled(start, identity);
  return filled(Math.ceil((stop - start) / step), (place) => start + place * step);
}

export const enumerate = (all) => Array.from(all, (one, place) => [place, one]);
export const reversed = (all) => [...all].reverse();

export function zip(...sequences) {
  const rows = sequences.map(tuple);
  const shortest = rows.reduce((a, b) => (b.length < a.length ? b : a));
  return shortest.map((_, place) => rows.map((row) => row[place]));
}

export function map(function_, ...sequences) {
  if (sequences.length !== 2) return zip(...sequences).map((row) => function_(...row));
  const [a, b] = sequences.map(tuple);
  return filled(Math.min(a.length, b.length), (place) => function_(a[place], b[place]));
}

export const pairwise = (all) => zip(all, all.slice(1));
export const any = (all) => [...all].some(truth);
export const all = (each) => [...each].every(truth);
export const next = ([first], otherwise) => (first === undefined ? otherwise : first);

function isBelow(a, b) {
  if (!isRow(a)) return a < b;
  const place = [...a].findIndex((one, i) => one !== b[i]);
  return place >= 0 && isBelow(a[place], b[place]);
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

export const is_number = Number.isFinite;
export const is_whole = Number.isInteger;
export const getattr = (one, name, otherwise) => (hasattr(one, name) ? one[name] : otherwise);
export const bound = (one, name) => one[name].bind(one);
export const type = (one) => one.constructor;

export function isinstance(one, kind) {
  if (Array.isArray(kind)) return kind.some((each) => isinstance(one, each));
  if (kind === float || kind === int) return typeof one === "number" || typeof one === "boolean";
  if (kind === tuple || kind === list) return Array.isArray(one);
  return one instanceof kind;
}
