// Complex numbers, and NumPy's arrays of one dimension, for translated modules that declare `numpy`.
import * as py from "./runtime.js";
import { GAUSS } from "./tables.js";

/** A complex number with Python's operators. */
export class Complex {
  constructor(real, imag = 0) {
    this.real = real;
    this.imag = imag;
  }
  conjugate() {
    return new Complex(this.real, -this.imag);
  }
  __neg__() {
    return new Complex(-this.real, -this.imag);
  }
  __abs__() {
    return Math.hypot(this.real, this.imag);
  }
  __bool__() {
    return this.real !== 0 || this.imag !== 0;
  }
  __eq__(other) {
    const { real, imag } = complexOf(other) ?? { real: NaN, imag: NaN };
    return this.real === real && this.imag === imag;
  }
  valueOf() {
    throw new TypeError("a complex number is no number of JavaScript");
  }
}

function complexOf(one) {
  if (one instanceof Complex) return one;
  return typeof one === "number" || typeof one === "boolean" ? new Complex(Number(one)) : null;
}

const COMPLEX = {
  add: (a, b) => new Complex(a.real + b.real, a.imag + b.imag),
  sub: (a, b) => new Complex(a.real - b.real, a.imag - b.imag),
  mul: (a, b) => new Complex(a.real * b.real - a.imag * b.imag, a.real * b.imag + a.imag * b.real),
  truediv: quotient,
};

/** A quotient by Smith's method, as Python and NumPy have it. */
function quotient(a, b) {
  const { real: c, imag: d } = b;
  if (c === 0 && d === 0) {
    if (py.heeds()) throw new py.ZeroDivisionError("complex division by zero");
    return new Complex(NaN, NaN);
  }
  if (Math.abs(c) >= Math.abs(d)) {
    const ratio = d / c;
    const scale = c + d * ratio;
    return new Complex((a.real + a.imag * ratio) / scale, (a.imag - a.real * ratio) / scale);
  }
  const ratio = c / d;
  const scale = c * ratio + d;
  return new Complex((a.real * ratio + a.imag) / scale, (a.imag * ratio - a.real) / scale);
}

for (const [name, operation] of Object.entries(COMPLEX)) {
  Complex.prototype[`__${name}__`] = function with_(other) {
    const right = complexOf(other);
    return right ? operation(this, right) : py.NotImplemented;
  };
  Complex.prototype[`__r${name}__`] = function from(other) {
    const left = complexOf(other);
    return left ? operation(left, this) : py.NotImplemented;
  };
}

/** An array of one dimension; parts of it share its values, as NumPy's do. */
export class NdArray {
  constructor(values, offset = 0, stride = 1, length = values.length) {
    Object.assign(this, { values, offset, stride, length });
  }
  at(place) {
    if (place < -this.length || place >= this.length)
      throw new RangeError(`an array of ${this.length} has no ${place}`);
    return this.values[this.offset + this.stride * (place < 0 ? place + this.length : place)];
  }
  *[Symbol.iterator]() {
    for (let place = 0; place < this.length; place++) yield this.at(place);
  }
  get real() {
    return this.map((one) => (one instanceof Complex ? one.real : one));
  }
  get imag() {
    return this.map((one) => (one instanceof Complex ? one.imag : 0));
  }
  map(function_) {
    const found = new Array(this.length);
    for (let k = 0; k < this.length; k++)
      found[k] = function_(this.values[this.offset + this.stride * k]);
    return new NdArray(found);
  }
  /** What comes of joining its values one after another to a first one. */
  reduced(join, first, from = 0) {
    let found = first;
    for (let k = from; k < this.length; k++)
      found = join(found, this.values[this.offset + this.stride * k]);
    return found;
  }
  copy() {
    return new NdArray([...this]);
  }
  conjugate() {
    return this.map((one) => one.conjugate());
  }
  slice(from, to = null) {
    return this.strided(from, to, 1);
  }
  strided(from, to, step) {
    const [start, count] = py.span(this.length, from, to, step);
    return new NdArray(this.values, this.offset + this.stride * start, this.stride * step, count);
  }
  /** The places that an index means: a mask of truth values, or a list of places. */
  places(index) {
    const all = [...index];
    if (all.length && all.every((one) => typeof one === "boolean"))
      return all.flatMap((one, place) => (one ? [place] : []));
    return all;
  }
  __getitem__(index) {
    if (typeof index === "number") return this.at(index);
    return new NdArray(this.places(index).map((place) => this.at(place)));
  }
  __setitem__(index, value) {
    if (typeof index === "number") {
      const place = index < 0 ? index + this.length : index;
      this.values[this.offset + this.stride * place] = value;
      return;
    }
    const isRow = value instanceof NdArray;
    this.places(index).forEach((place, k) => {
      this.__setitem__(place, isRow ? value.at(k) : value);
    });
  }
  all() {
    return [...this].every(py.truth);
  }
  any() {
    return [...this].some(py.truth);
  }
  sum() {
    return this.reduced(OPERATIONS.add, 0);
  }
  mean() {
    return py.div(this.sum(), this.length);
  }
  max() {
    return this.best(Math.max);
  }
  min() {
    return this.best(Math.min);
  }
  best(better) {
    if (!this.length) throw new py.ValueError("an empty array has no largest or smallest value");
    return this.reduced(better, this.at(0), 1);
  }
  __neg__() {
    return this.map((one) => (typeof one === "number" ? -one : py.neg(one)));
  }
  __abs__() {
    return this.map((one) => (one instanceof Complex ? one.__abs__() : Math.abs(one)));
  }
  __invert__() {
    return this.map((one) => !one);
  }
  __bool__() {
    throw new TypeError("an array has no truth value");
  }
}

/** What a function of values makes of two arrays, of one and a value, or of two values. */
const each = (function_) => (a, b) => {
  const [isRow, isOtherRow] = [a instanceof NdArray, b instanceof NdArray];
  if (!(isRow || isOtherRow)) return function_(a, b);
  const length = isRow ? a.length : b.length;
  if (isRow && isOtherRow && b.length !== length)
    throw new py.ValueError("arrays of different lengths");
  const found = new Array(length);
  for (let k = 0; k < length; k++)
    found[k] = function_(
      isRow ? a.values[a.offset + a.stride * k] : a,
      isOtherRow ? b.values[b.offset + b.stride * k] : b,
    );
  return new NdArray(found);
};
const eachOne = (function_) => (a) => (a instanceof NdArray ? a.map(function_) : function_(a));

/** An operation of numbers as of JavaScript's, of others as of complex numbers; a division by zero is no error. */
const ofNumbers = (name, plain) => (a, b) => {
  if (typeof a === "number" && typeof b === "number") return plain(a, b);
  const [one, other] = [complexOf(a), complexOf(b)];
  if (!one || !other) throw new TypeError("arrays are of numbers");
  if (one !== a && other !== b) return plain(one.real, other.real);
  return COMPLEX[name](one, other);
};

const OPERATIONS = {
  add: ofNumbers("add", (a, b) => a + b),
  sub: ofNumbers("sub", (a, b) => a - b),
  mul: ofNumbers("mul", (a, b) => a * b),
  truediv: ofNumbers("truediv", (a, b) => a / b),
  pow: (a, b) => a ** b,
  and: (a, b) => a && b,
  or: (a, b) => a || b,
};
for (const [name, operation] of Object.entries(OPERATIONS)) {
  const ofArrays = each(operation);
  NdArray.prototype[`__${name}__`] = function with_(other) {
    return ofArrays(this, other);
  };
  NdArray.prototype[`__r${name}__`] = function from(other) {
    return ofArrays(other, this);
  };
}
NdArray.prototype.__eq__ = function equal(other) {
  return each((a, b) => py.eq(a, b))(this, other);
};

export const lt = each((a, b) => a < b);
export const le = each((a, b) => a <= b);
export const gt = each((a, b) => a > b);
export const ge = each((a, b) => a >= b);
export const invert = (a) => a.__invert__();
/** The scalar product of two arrays. */
export const matmul = (a, b) => each(OPERATIONS.mul)(a, b).sum();

export function complex(a, b = 0) {
  if (typeof b !== "number") throw new TypeError("the imaginary part is a number");
  return a instanceof Complex && b === 0 ? a : new Complex(py.float(a), b);
}

const phase = (a) => (a instanceof Complex ? Math.atan2(a.imag, a.real) : Math.atan2(0, a));
const rect = (size, angle) => new Complex(size * Math.cos(angle), size * Math.sin(angle));
const exp = (a) => (a instanceof Complex ? rect(Math.exp(a.real), a.imag) : Math.exp(a));
export const cmath = { phase, rect, exp };

const sinc = (x) => (x === 0 ? 1 : Math.sin(Math.PI * x) / (Math.PI * x));
const rows = (count, value) => new NdArray(Array.from({ length: count }, (_, k) => value(k)));

export const numpy = {
  pi: Math.PI,
  inf: Infinity,
  abs: (a) => py.abs(a),
  angle: eachOne(phase),
  arange: (count) => rows(count, (k) => k),
  arcsin: eachOne(Math.asin),
  arctan2: each(Math.atan2),
  argmin: (a) => [...a].reduce((best, one, k, all) => (one < all[best] ? k : best), 0),
  array: (values) => new NdArray([...values]),
  asarray: (a) => (Array.isArray(a) ? new NdArray([...a]) : a),
  clip: (a, low, high) => each(Math.min)(each(Math.max)(a, low), high),
  concatenate: (parts) => new NdArray([...parts].flatMap((part) => [...part])),
  cos: eachOne(Math.cos),
  diff: (a) => py.sub(a.slice(1), a.slice(0, -1)),
  exp: eachOne(exp),
  flatnonzero: (a) => new NdArray([...a].flatMap((one, place) => (py.truth(one) ? [place] : []))),
  full: (count, value) => rows(count, () => value),
  hypot: each(Math.hypot),
  linspace: (low, high, count) =>
    rows(count, (k) => (k === count - 1 ? high : low + k * ((high - low) / (count - 1)))),
  maximum: each(Math.max),
  minimum: each(Math.min),
  mod: each((a, b) => py.mod(a, b)),
  ones: (count) => rows(count, () => 1),
  ptp: (a) => a.max() - a.min(),
  sin: eachOne(Math.sin),
  sinc: eachOne(sinc),
  sqrt: eachOne(Math.sqrt),
  where: (condition, a, b) => {
    const chosen = each((one, other) => [one, other])(a, b);
    const pairs = chosen instanceof NdArray ? chosen : rows(condition.length, () => chosen);
    return each((holds, [one, other]) => (holds ? one : other))(condition, pairs);
  },
  zeros: (count) => rows(count, () => 0),
};

/** Gauss's rule of 20 points on (0, 1). */
export function gauss_rule() {
  const { nodes, weights } = GAUSS[20];
  return [new NdArray(nodes), new NdArray(weights)];
}

/** The combination of columns that is closest to some values, by Householder's reflections. */
export function least_squares(columns, values) {
  const matrix = columns.map((column) => [...column]);
  const right = [...values];
  const diagonal = matrix.map((column, k) => reflect(column, k, [...matrix.slice(k + 1), right]));
  const solution = [];
  for (let k = matrix.length - 1; k >= 0; k--) {
    let value = right[k];
    for (let j = k + 1; j < matrix.length; j++) value -= matrix[j][k] * solution[j];
    solution[k] = value / diagonal[k];
  }
  return solution;
}

/** Make a column zero below a row by a reflection, which others are reflected by, too; gives its number there. */
function reflect(column, row, others) {
  const size = Math.hypot(...column.slice(row));
  const end = column[row] > 0 ? -size : size;
  const normal = column.map((one, k) => (k < row ? 0 : one));
  normal[row] -= end;
  const square = normal.reduce((sum, one) => sum + one * one, 0);
  for (const other of square ? others : []) {
    const share = (2 * normal.reduce((sum, one, k) => sum + one * other[k], 0)) / square;
    normal.forEach((one, k) => {
      other[k] -= share * one;
    });
  }
  return end;
}
