// What Python means where JavaScript means something else: for the translated modules.
import { repr } from "./words.js";
export * from "./words.js";

export class ArithmeticError extends Error {}
export class ZeroDivisionError extends ArithmeticError {}
export const NotImplemented = null,
  [ValueError, NotImplementedError, AssertionError] = [Error, Error, Error];

let heeded = true,
  within = 0;
/** Whether what has no value is an error, or no number, as in arrays: until every block that asked for those is left. */
export function heed(whether) {
  within += whether ? -1 : 1;
  heeded = within === 0;
}

// ---- numbers, and what else has arithmetic: series, discs, nodes of a graph; lists are joined

const takes = (a, word) => a !== null && typeof a === "object" && word in a;
const asked = (a, word, b) => (takes(a, word) ? a[word](b) : NotImplemented);

function applied(a, b, word, turned, plain) {
  // Where the second's class is one of the first's kind, it is asked first.
  const special =
    takes(b, turned) &&
    takes(a, word) &&
    b instanceof a.constructor &&
    b.constructor !== a.constructor;
  const first = special ? NotImplemented : asked(a, word, b),
    found = first === NotImplemented ? asked(b, turned, a) : first;
  if (found !== NotImplemented) return found;
  if (typeof a === "boolean" || typeof b === "boolean") return plain(Number(a), Number(b));
  throw new TypeError(`${word} of ${a} and ${b}`);
}

export function add(a, b) {
  if ((typeof a === "number" && typeof b === "number") || typeof a === "string") return a + b;
  if (Array.isArray(a)) return [...a, ...b];
  return applied(a, b, "__add__", "__radd__", add);
}

export function sub(a, b) {
  if (typeof a === "number" && typeof b === "number") return a - b;
  return applied(a, b, "__sub__", "__rsub__", sub);
}

export function mul(a, b) {
  if (typeof a === "number" && typeof b === "number") return a * b;
  if (typeof a === "string") return a.repeat(b);
  if (Array.isArray(a)) return Array.from({ length: b * a.length }, (_, i) => a[i % a.length]);
  return applied(a, b, "__mul__", "__rmul__", mul);
}

export function div(a, b) {
  if (typeof a === "number" && typeof b === "number") {
    if (b === 0 && heeded) throw new ZeroDivisionError("division by zero");
    return a / b;
  }
  return applied(a, b, "__truediv__", "__rtruediv__", div);
}

export function pow(a, b) {
  if (typeof a !== "number" || typeof b !== "number")
    return applied(a, b, "__pow__", "__rpow__", pow);
  if (b === 2) return finite(a * a, a);
  if (!heeded) return a ** b;
  if (a === 0 && b < 0) throw new ZeroDivisionError("0.0 cannot be raised to a negative power");
  if (a < 0 && b !== Math.trunc(b)) throw new ArithmeticError("a root of a negative number");
  if (b === 0.5) return Math.sqrt(a);
  if (b === -0.5) return 1 / Math.sqrt(a);
  if (b === 0.25) return Math.sqrt(Math.sqrt(a));
  return finite(a ** b, a);
}

function finite(value, ...given) {
  if (heeded && !Number.isFinite(value) && given.every(Number.isFinite))
    throw new ArithmeticError("a result too large");
  return value;
}

export const floordiv = (a, b) => Math.floor(a / b);
export const mod = (a, b) => a - b * Math.floor(a / b);
export const neg = (a) =>
  typeof a === "number" ? -a : typeof a === "boolean" ? -Number(a) : a.__neg__();
export const abs = (a) => (typeof a === "number" ? Math.abs(a) : a.__abs__());
export const float = (a) => (a === "inf" ? Infinity : Number(a));
export const int = (a) => Math.trunc(Number(a));
export const str = (a) =>
  a instanceof Error ? a.message : a instanceof Enum ? a.name : typeof a === "string" ? a : repr(a);
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
export { truth as bool, or_ as or, and_ as and };

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

const itself = (one) => one;
/** What is asked of NumPy: arrays to be filled, those of two dimensions as lists of arrays; and numbers for arrays. */
export const np = {
  __proto__: math,
  arctan2: Math.atan2,
  minimum: Math.min,
  maximum: Math.max,
  fmax: (a, b) => (a >= b || b !== b ? a : b),
  copysign: (a, b) => (b < 0 || Object.is(b, -0) ? -Math.abs(a) : Math.abs(a)),
  less: (a, b) => (takes(a, "__lt__") ? a.__lt__(b) : a < b),
  where: (condition, a, b) =>
    takes(condition, "graph") ? condition.graph.select(condition, a, b) : condition ? a : b,
  any: itself,
  max: itself,
  min: itself,
  stack: (parts) => Float64Array.from(parts),
  empty: (shape) =>
    typeof shape === "number"
      ? new Float64Array(shape)
      : made(shape[0], () => new Float64Array(shape[1])),
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

export const replace = (one, changes) =>
  new one.constructor(
    ...one.constructor.fields.map((name) => (name in changes ? changes[name] : one[name])),
  );

export class Enum {
  constructor(name, value) {
    Object.freeze(Object.assign(this, { name, value }));
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

// ---- equality, and what tables and caches are kept by

const isRow = (a) => Array.isArray(a) || a instanceof NamedTuple;

export function eq(a, b) {
  if (a === b) return true;
  if (isRow(a) && isRow(b))
    return len(a) === len(b) && [...a].every((one, place) => eq(one, b[place]));
  if (a instanceof Record && a.constructor === b?.constructor)
    return a.constructor.fields.every((name) => eq(a[name], b[name]));
  return typeof a === "boolean" && typeof b === "number" ? Number(a) === b : false;
}

export const contains = (all, one) =>
  all instanceof Map || all instanceof Set ? all.has(one) : [...all].some((each) => eq(each, one));

const known = new WeakMap();
let counted = 0;

function key(a) {
  if (a === null || (typeof a !== "object" && typeof a !== "function")) return String(a);
  if (Array.isArray(a)) return `(${a.map(key).join()})`;
  if (a instanceof NamedTuple || a instanceof Record)
    return `${key(a.constructor)}(${a.constructor.fields.map((name) => key(a[name])).join()})`;
  if (!known.has(a)) known.set(a, `#${(counted += 1)}`);
  return known.get(a);
}

/** A function that keeps what it was last asked for, but not more than so much. */
export function cached(function_, most = 1024) {
  const values = new Map();
  return (...given) => {
    const place = key(given);
    if (!values.has(place)) values.set(place, function_(...given));
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
  return tuple(all)
    .slice(to === null ? 0 : to + 1, from === null ? undefined : from + 1)
    .reverse();
}

export const len = (all) =>
  all instanceof NamedTuple ? all.constructor.fields.length : all.length;
/** So many values: `Array.from`, and spreading of what is no list, take ten times as long. */
function made(count, value) {
  const found = [];
  for (let place = 0; place < count; place += 1) found.push(value(place));
  return found;
}
export const list = (all = []) =>
  ArrayBuffer.isView(all) ? made(all.length, (place) => all[place]) : [...all];
export const tuple = (all = []) => (Array.isArray(all) ? all : list(all));
export const dict = (pairs = []) => new Dict(pairs);
export const range = (start, stop = null, step = 1) =>
  stop === null
    ? made(start, (place) => place)
    : made(Math.ceil((stop - start) / step), (place) => start + place * step);
export const enumerate = (all) => Array.from(all, (one, place) => [place, one]);
export const reversed = (all) => [...all].reverse();
export function zip(...rows) {
  const whole = rows.map(tuple),
    shortest = whole.reduce((a, b) => (b.length < a.length ? b : a));
  return shortest.map((_, place) => whole.map((row) => row[place]));
}
export function map(function_, ...rows) {
  const [a, b] = rows.map(tuple);
  if (rows.length !== 2) return zip(...rows).map((row) => function_(...row));
  return made(Math.min(a.length, b.length), (place) => function_(a[place], b[place]));
}
export const pairwise = (all) => zip(all, all.slice(1));
export const any = (all) => [...all].some(truth);
export const all = (each) => [...each].every(truth);
export const next = ([first], otherwise) => (first === undefined ? otherwise : first);

function below(a, b) {
  if (!isRow(a)) return a < b;
  const place = [...a].findIndex((one, i) => one !== b[i]);
  return place >= 0 && below(a[place], b[place]);
}

function most(given, better) {
  const told = given.at(-1)?.constructor === Object ? given.pop() : {},
    { key: worth = itself } = told;
  const choices = given.length === 1 ? [...given[0]] : given;
  if (!choices.length && "default" in told) return told.default;
  return choices.reduce((best, choice) => (better(worth(choice), worth(best)) ? choice : best));
}
export const max = (...given) => most(given, (one, other) => below(other, one));
export const min = (...given) => most(given, below);
// Of two, and without a list of what is given: this is asked for in every step.
export const larger = (a, b) =>
  typeof a === "number" && typeof b === "number" ? (b > a ? b : a) : max(a, b);
export const smaller = (a, b) =>
  typeof a === "number" && typeof b === "number" ? (b < a ? b : a) : min(a, b);
export const sorted = (all, { key: worth = itself } = {}) =>
  [...all].sort((a, b) => below(worth(b), worth(a)) - below(worth(a), worth(b)));

// ---- objects

export const is_number = Number.isFinite,
  is_whole = Number.isInteger;
export const hasattr = (one, name) => one !== null && typeof one === "object" && name in one;
export const getattr = (one, name, otherwise) => (hasattr(one, name) ? one[name] : otherwise);
export const bound = (one, name) => one[name].bind(one);
export const type = (one) => one.constructor;
export function isinstance(one, kind) {
  if (Array.isArray(kind)) return kind.some((each) => isinstance(one, each));
  if (kind === float || kind === int) return typeof one === "number" || typeof one === "boolean";
  if (kind === tuple || kind === list) return Array.isArray(one);
  return one instanceof kind;
}
