// Solutions as polynomials in time, one a step, as in tippetop.integrators.dense.
import { crossing, PLAIN, POWERS, Series, solved, unknown, within } from "./mechanics.js";
import { CHEBYSHEV, SHORTEST } from "./tables.js";

export const as_array = (numbers) => Float64Array.from(numbers);

/** So many numbers: these, and zeros. */
export function longer(numbers, count) {
  const extended = new Float64Array(count);
  extended.set(numbers);
  return extended;
}

/** The first of some places, from 0 on, from which on something holds; the last if it does nowhere. */
export function earliest(count, holds) {
  let low = 0;
  let high = count - 1;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (holds(middle)) high = middle;
    else low = middle + 1;
  }
  return low;
}

// Degree of the power series that stand for a first step.
const ORDER = 20;

/** Coefficients of a motion's solution and of its guards from a state on; no law here has choices with margins. */
export function expanded(motion, parameters, state) {
  const series = Array.from(state, () => new Series(unknown, PLAIN));
  solved(series, Array.from(state), (y) => motion.rates(y, parameters));
  const guards = motion.guards.map((guard) => guard.value(series, parameters));
  return [
    series.map((one) => one.up_to(ORDER).slice(0, ORDER + 1)),
    guards.map((one) => one.up_to(ORDER - 1).slice(0, ORDER)),
    [],
  ];
}

/** Values of each guard of a motion in several states. */
export function guard_values(motion, parameters, states) {
  return motion.guards.map((guard) => states.map((state) => guard.value(state, parameters)));
}

export class DenseSolution {
  /** Knots, and coefficients [step][number][power], in a row, in powers of the part of a step that has passed. */
  constructor(knots, terms, size) {
    const count = knots.length - 1;
    this.knots = knots;
    this.terms = terms;
    this.size = size;
    this.count = count;
    this.end = knots[count];
    this.degree = terms.length / size / count - 1;
  }

  /** The solution, whose time begins at zero in some unit, from a time to an end, each number times its own unit. */
  in_units(start, time_unit, units, end) {
    const knots = Float64Array.from(this.knots, (knot) => start + time_unit * knot);
    knots[this.count] = end;
    const powers = this.degree + 1;
    const inUnit = (term, place) => term * units[Math.floor(place / powers) % this.size];
    return new DenseSolution(knots, this.terms.map(inUnit), this.size);
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

  /** The coefficients of a number in a step, in powers of the part of the step. */
  coefficients(step, number) {
    const first = (step * this.size + number) * (this.degree + 1);
    return Array.from(this.terms.slice(first, first + this.degree + 1));
  }

  /** Least and most that a number may be in a step: x - x^k is at most (k - 1) / (k + 2) between its ends. */
  bounds(step, number) {
    const first = (step * this.size + number) * (this.degree + 1);
    const start = this.terms[first];
    const end = this.value(step, number, 1);
    let beyond = 0;
    for (let k = 2; k <= this.degree; k += 1) {
      beyond += ((k - 1) / (k + 2)) * Math.abs(this.terms[first + k]);
    }
    return [Math.min(start, end) - beyond, Math.max(start, end) + beyond];
  }

  /** All numbers at a part of a step. */
  numbers(step, part, out = new Array(this.size)) {
    if (this.degree === POWERS - 1) {
      within(this.terms, step * this.size * POWERS, part, out);
    } else {
      for (let number = 0; number < this.size; number += 1) {
        out[number] = this.value(step, number, part);
      }
    }
    return out;
  }

  /** Which part of a step has passed at a time. */
  part(step, time) {
    const start = this.knots[step];
    const span = this.knots[step + 1] - start;
    return Math.min(Math.max((time - start) / (span > 0 ? span : 1), 0), 1);
  }

  /** When a part of a step has passed. */
  time(step, part) {
    return this.knots[step] + part * (this.knots[step + 1] - this.knots[step]);
  }

  /** All numbers at a time. */
  rows(time) {
    const step = this.step(time);
    return this.numbers(step, this.part(step, time));
  }

  /** The same solution begun at a time; it ends at another one, to the last digit. */
  moved(start, end) {
    const knots = this.knots.map((knot) => start + knot);
    knots[knots.length - 1] = end;
    return new DenseSolution(knots, this.terms, this.size);
  }

  /** The same solution with every step in so many of equal length. */
  subdivided(parts) {
    if (parts === 1 || !this.count) return this;
    const width = this.degree + 1;
    const terms = new Float64Array(this.terms.length * parts);
    const knots = [];
    let place = 0;
    for (let step = 0; step < this.count; step += 1) {
      for (let part = 0; part < parts; part += 1) {
        knots.push(this.time(step, part / parts));
        for (let number = 0; number < this.size; number += 1) {
          const first = (step * this.size + number) * width;
          const row = this.terms.slice(first, first + width);
          terms.set(shifted(row, part / parts, 1 / parts), place);
          place += width;
        }
      }
    }
    knots.push(this.end);
    return new DenseSolution(Float64Array.from(knots), terms, this.size);
  }

  /** Values of an increasing number at the starts of steps, but for those next to its end, and that end. */
  knots_of(number, end) {
    const starts = Array.from({ length: this.count }, (_, step) => this.value(step, number, 0));
    return [...starts.filter((value) => value < end * (1 - SHORTEST)), end];
  }

  /** When an increasing number has a value. */
  when(number, value) {
    const step = earliest(this.count, (k) => this.value(k, number, 1) > value);
    const at = (part) => this.value(step, number, part);
    const reached = Math.min(Math.max(value, at(0)), at(1));
    const part = crossing((one) => at(one) - reached, 0, 1);
    return this.time(step, part);
  }

  /** Size of the largest last term of its polynomials, in Chebyshev's. */
  get unresolved() {
    let largest = 0;
    for (let place = this.degree; place < this.terms.length; place += this.degree + 1) {
      largest = Math.max(largest, Math.abs(this.terms[place]));
    }
    return largest * 2 ** (1 - 2 * this.degree);
  }

  /** The first of some steps, with all coefficients in a row. */
  static of_steps(knots, terms, size, count) {
    const used = (count * terms.length) / (knots.length - 1);
    // A view holds on to all of the room: that is well where most of it is used.
    const first = 2 * used < terms.length ? terms.slice(0, used) : terms.subarray(0, used);
    return new DenseSolution(knots.slice(0, count + 1), first, size);
  }

  /** Steps whose coefficients from the first on lie in rows, from the numbers with which they begin. */
  static of_rows(knots, start, rows) {
    const size = start.length;
    const later = rows.flatMap((row) => [...row]);
    const degree = later.length / size / (knots.length - 1);
    const numbers = [...start];
    const terms = [];
    for (let place = 0, i = 0; place < later.length; place += degree, i = (i + 1) % size) {
      const powers = later.slice(place, place + degree);
      terms.push(numbers[i], ...powers);
      numbers[i] += powers.reduce((a, b) => a + b);
    }
    return new DenseSolution(knots, Float64Array.from(terms), size);
  }

  static empty(time, size) {
    return new DenseSolution([time], new Float64Array(0), size);
  }

  /** Solutions that go on where the one before ends, as one. */
  static joined(parts) {
    const knots = parts.flatMap((part, i) => Array.from(part.knots).slice(i ? 1 : 0));
    const rows = parts.flatMap((part) => part.rows_of_terms());
    const degree = rows.reduce((most, row) => Math.max(most, row.length), 0);
    const terms = new Float64Array(rows.length * degree);
    rows.forEach((row, i) => {
      terms.set(row, i * degree);
    });
    return new DenseSolution(knots, terms, parts[0].size);
  }

  /** The coefficients of every number in every step. */
  rows_of_terms() {
    const degree = this.degree + 1;
    const rows = Array.from({ length: this.size * this.count }, (_, i) => i * degree);
    return rows.map((first) => this.terms.subarray(first, first + degree));
  }

  /** Of coefficients [step][number][power] in powers of the time since the start of a step. */
  static in_time(knots, terms) {
    const scaled = terms.flatMap((rows, step) => {
      const span = knots[step + 1] - knots[step];
      return rows.flatMap((row) => row.map((term, k) => term * span ** k));
    });
    return new DenseSolution(knots, Float64Array.from(scaled), terms[0].length);
  }

  /** Polynomials that agree with a function, from a time to numbers, at Chebyshev's points of every step. */
  static fitted(function_, knots, degree) {
    const { places, transform, powers } = CHEBYSHEV[degree];
    const rows = [];
    for (let step = 1; step < knots.length; step += 1) {
      const start = knots[step - 1];
      const span = knots[step] - start;
      const values = places.map((place) => function_(start + place * span));
      for (let number = 0; number < values[0].length; number += 1) {
        const column = values.map((row) => row[number]);
        rows.push(product(powers, product(transform, column)));
      }
    }
    const size = rows.length / Math.max(knots.length - 1, 1);
    return new DenseSolution(knots, Float64Array.from(rows.flat()), size);
  }
}

/** Coefficients in powers of a part that begins at a place and has a length, by Horner's scheme. */
export function shifted(row, place, length) {
  for (let first = 0; first < row.length; first += 1) {
    for (let k = row.length - 2; k >= first; k -= 1) row[k] += place * row[k + 1];
  }
  return row.map((term, k) => term * length ** k);
}

function product(matrix, column) {
  return matrix.map((row) => row.reduce((sum, one, k) => sum + one * column[k], 0));
}
