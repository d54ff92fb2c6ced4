// Solutions as polynomials in time, one a step, as in tippetop.integrators.dense.
import { POWERS, crossing, within } from "./mechanics.js";
import { CHEBYSHEV, SHORTEST } from "./tables.js";

export const ELEMENTARY = Math;
export const as_array = (numbers) => Float64Array.from(numbers);

/** So many numbers: these, and zeros. */
export function longer(numbers, count) {
  const found = new Float64Array(count);
  found.set(numbers);
  return found;
}

/** The first of some places, from 0 on, from which on something holds; the last if it does nowhere. */
export function earliest(count, holds) {
  let low = 0,
    high = count - 1;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (holds(middle)) high = middle;
    else low = middle + 1;
  }
  return low;
}

export class DenseSolution {
  /** Knots, and coefficients [step][number][power], in a row, in powers of the part of a step that has passed. */
  constructor(knots, terms, size) {
    const count = knots.length - 1;
    Object.assign(this, {
      knots,
      terms,
      size,
      count,
      end: knots[count],
      degree: terms.length / size / count - 1,
    });
  }

  /** The step in which a time lies, the earlier one where two meet. */
  step(time) {
    return earliest(this.count, (step) => this.knots[step + 1] >= time);
  }

  /** One number at a part of a step. */
  value(step, number, part) {
    const first = (step * this.size + number) * (this.degree + 1);
    let total = 0;
    for (let k = first + this.degree; k >= first; k -= 1) total = total * part + this.terms[k];
    return total;
  }

  /** Least and most that a number may be in a step: x - x^k is at most (k - 1) / (k + 2) between its ends. */
  bounds(step, number) {
    const first = (step * this.size + number) * (this.degree + 1),
      start = this.terms[first],
      end = this.value(step, number, 1);
    let beyond = 0;
    for (let k = 2; k <= this.degree; k += 1)
      beyond += ((k - 1) / (k + 2)) * Math.abs(this.terms[first + k]);
    return [Math.min(start, end) - beyond, Math.max(start, end) + beyond];
  }

  /** All numbers at a part of a step. */
  numbers(step, part, out = new Array(this.size)) {
    if (this.degree === POWERS - 1) within(this.terms, step * this.size * POWERS, part, out);
    else
      for (let number = 0; number < this.size; number += 1)
        out[number] = this.value(step, number, part);
    return out;
  }

  /** Which part of a step has passed at a time. */
  part(step, time) {
    const from = this.knots[step],
      span = this.knots[step + 1] - from;
    return Math.min(Math.max((time - from) / (span > 0 ? span : 1), 0), 1);
  }

  /** When a part of a step has passed. */
  time(step, part) {
    return this.knots[step] + part * (this.knots[step + 1] - this.knots[step]);
  }

  rows(time) {
    const step = this.step(time);
    return this.numbers(step, this.part(step, time));
  }

  moved(start, end) {
    const knots = this.knots.map((knot) => start + knot);
    knots[knots.length - 1] = end;
    return new DenseSolution(knots, this.terms, this.size);
  }

  knots_of(number, end) {
    const shown = Array.from({ length: this.count }, (_, step) => this.value(step, number, 0));
    return [...shown.filter((value) => value < end * (1 - SHORTEST)), end];
  }

  when(number, wanted) {
    const step = earliest(this.count, (here) => this.value(here, number, 1) > wanted),
      at = (part) => this.value(step, number, part);
    const held = Math.min(Math.max(wanted, at(0)), at(1));
    return this.time(
      step,
      crossing((part) => at(part) - held, 0, 1),
    );
  }

  /** Size of the largest last term of its polynomials, in Chebyshev's. */
  get unresolved() {
    const last = this.terms.filter((_, place) => place % (this.degree + 1) === this.degree);
    return (
      last.reduce((most, term) => Math.max(most, Math.abs(term)), 0) * 2 ** (1 - 2 * this.degree)
    );
  }

  /** The first of some steps, with all coefficients in a row: these in the room they are in if they fill most of it. */
  static of_steps(knots, terms, size, count) {
    const used = (count * terms.length) / (knots.length - 1),
      kept = 2 * used < terms.length ? "slice" : "subarray";
    return new DenseSolution(knots.slice(0, count + 1), terms[kept](0, used), size);
  }

  /** Steps whose coefficients from the first on lie in rows, from the numbers with which they begin. */
  static of_rows(knots, start, rows) {
    const size = start.length,
      terms = [],
      now = [...start],
      later = rows.flatMap((row) => [...row]);
    const degree = later.length / size / (knots.length - 1);
    for (let at = 0, i = 0; at < later.length; at += degree, i = (i + 1) % size) {
      const some = later.slice(at, at + degree);
      terms.push(now[i], ...some);
      now[i] += some.reduce((a, b) => a + b);
    }
    return new DenseSolution(knots, Float64Array.from(terms), size);
  }

  static nothing(time, size) {
    return new DenseSolution([time], new Float64Array(0), size);
  }

  static joined(parts) {
    const knots = parts.flatMap((part, i) => Array.from(part.knots).slice(i ? 1 : 0));
    return new DenseSolution(
      knots,
      Float64Array.from(parts.flatMap((part) => Array.from(part.terms))),
      parts[0].size,
    );
  }

  static in_time(knots, terms) {
    const scaled = terms.flatMap((rows, step) =>
      rows.flatMap((row) => row.map((term, k) => term * (knots[step + 1] - knots[step]) ** k)),
    );
    return new DenseSolution(knots, Float64Array.from(scaled), terms[0].length);
  }

  /** Polynomials that agree with a function, from a time to numbers, at Chebyshev's points of every step. */
  static fitted(function_, knots, degree) {
    const { places, transform, powers } = CHEBYSHEV[degree],
      rows = [];
    const product = (matrix, column) =>
      matrix.map((row) => row.reduce((sum, one, k) => sum + one * column[k], 0));
    for (let step = 1; step < knots.length; step += 1) {
      const values = places.map((place) =>
        function_(knots[step - 1] + place * (knots[step] - knots[step - 1])),
      );
      values[0].forEach((_, number) =>
        rows.push(
          product(
            powers,
            product(
              transform,
              values.map((row) => row[number]),
            ),
          ),
        ),
      );
    }
    return new DenseSolution(
      knots,
      Float64Array.from(rows.flat()),
      rows.length / Math.max(knots.length - 1, 1),
    );
  }

  /** Power series, in steps of equal length, of numbers the first of which obey y''' = -w^2 y', and the others y''' = 0. */
  static swinging(moving, frequency, knots, degree, count) {
    const span = knots[1] - knots[0],
      wide = degree + 1,
      begins = knots.slice(0, -1).map(moving),
      size = begins[0][0].length;
    const terms = new Float64Array(begins.length * size * wide),
      square = (frequency * span) ** 2;
    begins.forEach(([numbers, rates, seconds], step) => {
      for (let number = 0, at = step * size * wide; number < size; number += 1, at += wide) {
        terms[at] = numbers[number];
        terms[at + 1] = span * rates[number];
        terms[at + 2] = 0.5 * span * span * seconds[number];
        if (number < count)
          for (let k = 3; k < wide; k += 1)
            terms[at + k] = (-square / (k * (k - 1))) * terms[at + k - 2];
      }
    });
    return new DenseSolution(knots, terms, size);
  }
}
