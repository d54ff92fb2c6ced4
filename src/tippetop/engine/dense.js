// Solutions as polynomials in time, one a step, as in tippetop.integrators.dense.
import { CHEBYSHEV } from "./tables.js";
import { math } from "./runtime.js";

/** Elementary functions of numbers, and of the nodes of a graph. */
const of = (name) => (x) => (typeof x === "number" ? math[name](x) : x.graph.node(name, [x]));
export const ELEMENTARY = { sin: of("sin"), cos: of("cos") };
export const as_array = (numbers) => Float64Array.from(numbers);

const NEWTON = 6;
const SHORTEST = 1e-8;
/** Coefficients in powers of a polynomial with some values at Chebyshev's points, put in `out` from `at` on. */
export function toPowers(values, degree, out, at = 0) {
  const { transform, powers } = CHEBYSHEV[degree], first = values[0];
  let same = 1;
  while (same <= degree && values[same] === first) same += 1;
  if (same > degree) {
    out[at] = first;
    return;
  }
  for (let k = 0; k <= degree; k += 1) {
    const terms = powers[k], row = transform[k];
    let weight = 0;
    for (let j = 0; j <= degree; j += 1) weight += row[j] * values[j];
    for (let i = 0; i <= k; i += 1) out[at + i] += weight * terms[i];
  }
}

export class DenseSolution {
  /** Knots, and coefficients [step][number][power] in powers of the part of a step that has passed. */
  constructor(knots, terms, size, degree) {
    this.knots = knots;
    this.terms = terms;
    this.size = size;
    this.degree = degree;
  }

  get count() {
    return this.knots.length - 1;
  }

  get end() {
    return this.knots[this.count];
  }

  /** The step in which a time lies, the earlier one where two meet. */
  step(time) {
    let low = 0, high = this.count - 1;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.knots[middle + 1] < time) low = middle + 1;
      else high = middle;
    }
    return low;
  }

  /** The polynomial of a number in a step: an array, where in it its coefficients begin, and the degree. */
  polynomial(step, number) {
    return [this.terms, (step * this.size + number) * (this.degree + 1), this.degree];
  }

  /** One number, or its rate with the part of the step, at a part of a step. */
  value(step, number, part) {
    const first = (step * this.size + number) * (this.degree + 1);
    let total = 0;
    for (let k = first + this.degree; k >= first; k -= 1) total = total * part + this.terms[k];
    return total;
  }

  slope(step, number, part) {
    const first = (step * this.size + number) * (this.degree + 1);
    let total = 0;
    for (let k = this.degree; k > 0; k -= 1) total = total * part + k * this.terms[first + k];
    return total;
  }

  /** All numbers at a part of a step. */
  numbers(step, part, out = new Array(this.size)) {
    for (let number = 0; number < this.size; number += 1) out[number] = this.value(step, number, part);
    return out;
  }

  rows(time) {
    const step = this.step(time), span = this.knots[step + 1] - this.knots[step];
    return this.numbers(step, (time - this.knots[step]) / (span > 0 ? span : 1));
  }

  moved(start, end) {
    const knots = this.knots.map((knot) => start + knot);
    knots[knots.length - 1] = end;
    return new DenseSolution(knots, this.terms, this.size, this.degree);
  }

  knots_of(number, end) {
    const shown = Array.from({ length: this.count }, (_, step) => this.value(step, number, 0));
    return [...shown.filter((value) => value < end * (1 - SHORTEST)), end];
  }

  when(number, value) {
    const shown = Array.from({ length: this.count }, (_, step) => this.value(step, number, 0));
    shown.push(this.value(this.count - 1, number, 1));
    let at = shown.findIndex((one) => one >= value);
    at = at < 0 ? this.count : Math.max(at, 1);
    const share = (value - shown[at - 1]) / (shown[at] - shown[at - 1] || 1);
    let time = this.knots[at - 1] + Math.min(Math.max(share, 0), 1) * (this.knots[at] - this.knots[at - 1]);
    for (let turn = 0; turn < NEWTON; turn += 1) {
      const step = this.step(time), span = this.knots[step + 1] - this.knots[step];
      const part = (time - this.knots[step]) / span;
      time += ((value - this.value(step, number, part)) * span) / this.slope(step, number, part);
      time = Math.min(Math.max(time, this.knots[0]), this.end);
    }
    return time;
  }

  /** The first of some steps, with rows [power][number] of coefficients. */
  static of_steps(knots, steps, count) {
    const wide = steps[0].length, size = steps[0][0].length, terms = new Float64Array(count * size * wide);
    for (let step = 0, at = 0; step < count; step += 1) {
      for (let number = 0; number < size; number += 1) {
        for (let power = 0; power < wide; power += 1, at += 1) terms[at] = steps[step][power][number];
      }
    }
    return new DenseSolution(knots.slice(0, count + 1), terms, size, wide - 1);
  }

  static nothing(time, size) {
    return new DenseSolution([time], new Float64Array(0), size, 0);
  }

  static standing(numbers, start, end) {
    return new DenseSolution([start, end], Float64Array.from(numbers), numbers.length, 0);
  }

  /** Coefficients [step][number][power] in powers of the time since the start of a step. */
  get unresolved() {
    let largest = 0.0;
    for (let row = this.degree; row < this.terms.length; row += this.degree + 1) largest = Math.max(largest, Math.abs(this.terms[row]));
    return largest * 2 ** (1 - 2 * this.degree);
  }

  static in_time(knots, terms) {
    const size = terms[0].length, degree = terms[0][0].length - 1;
    const scaled = terms.flatMap((rows, step) => rows.flatMap((row) => row.map((term, k) => term * (knots[step + 1] - knots[step]) ** k)));
    return new DenseSolution(knots, Float64Array.from(scaled), size, degree);
  }

  static straight(begin, last, start, end, degree) {
    const terms = begin.flatMap((number, i) => [number, last[i] - number, ...new Array(degree - 1).fill(0.0)]);
    return new DenseSolution([start, end], Float64Array.from(terms), begin.length, degree);
  }

  static joined(parts) {
    if (parts.length === 1) return parts[0];
    const knots = parts.flatMap((part, i) => Array.from(part.knots).slice(i ? 1 : 0));
    const wide = parts[0].size * (parts[0].degree + 1), terms = new Float64Array((knots.length - 1) * wide);
    let at = 0;
    for (const part of parts) {
      terms.set(part.terms.subarray(0, part.count * wide), at);
      at += part.count * wide;
    }
    return new DenseSolution(knots, terms, parts[0].size, parts[0].degree);
  }

  /** Polynomials that agree with a function, from a time to numbers, at Chebyshev's points of every step. */
  static fitted(function_, knots, degree) {
    if (function_.size) return new Evaluated(function_, Array.from(knots), Array.from(knots), degree);
    const { places } = CHEBYSHEV[degree], count = knots.length - 1, wide = degree + 1;
    let terms = null, size = 0, values = null;
    for (let step = 0; step < count; step += 1) {
      for (let place = 0; place < wide; place += 1) {
        const row = function_(knots[step] + places[place] * (knots[step + 1] - knots[step]));
        if (terms === null) {
          size = row.length;
          terms = new Float64Array(count * size * wide);
          values = Array.from({ length: size }, () => new Float64Array(wide));
        }
        for (let number = 0; number < size; number += 1) values[number][place] = row[number];
      }
      for (let number = 0; number < size; number += 1) toPowers(values[number], degree, terms, (step * size + number) * wide);
    }
    return new DenseSolution(Array.from(knots), terms, size, degree);
  }
}

/** A solution whose function takes no time to speak of: it is asked itself, and fitted number by number when asked. */
class Evaluated extends DenseSolution {
  constructor(function_, knots, own, degree) {
    super(knots, null, function_.size, degree);
    this.function_ = function_;
    this.own = own;
    this.fits = new Map();
  }

  moved(start, end) {
    const { knots } = DenseSolution.prototype.moved.call(this, start, end);
    return new Evaluated(this.function_, knots, this.own, this.degree);
  }

  numbers(step, part, out = new Array(this.size)) {
    const found = this.function_(this.own[step] + part * (this.own[step + 1] - this.own[step]));
    for (let number = 0; number < this.size; number += 1) out[number] = found[number];
    return out;
  }

  value(step, number, part) {
    return this.function_(this.own[step] + part * (this.own[step + 1] - this.own[step]))[number];
  }

  polynomial(step, number) {
    const wide = this.degree + 1;
    if (!this.fits.has(number)) {
      const { places } = CHEBYSHEV[this.degree], values = new Float64Array(wide), terms = new Float64Array(wide * this.count);
      for (let each = 0; each < this.count; each += 1) {
        for (let place = 0; place < wide; place += 1) values[place] = this.value(each, number, places[place]);
        toPowers(values, this.degree, terms, each * wide);
      }
      this.fits.set(number, terms);
    }
    return [this.fits.get(number), step * wide, this.degree];
  }
}
