// Collocation at Radau's points (Hairer and Wanner, Solving Ordinary Differential Equations II): for stiff motions.
import { toPowers, chebyshev } from "./dense.js";
import { gauss } from "./polynomials.js";
import { Stepper } from "./stepper.js";

const STAGES = 6, TURNS = 12, ENOUGH = 1e-3, MOST = 2048;

/** Radau's points in (0, 1], of which the last is 1. */
const POINTS = Array.from({ length: STAGES }, (_, j) => {
  let x = Math.cos((2 * Math.PI * (STAGES - 1 - j)) / (2 * STAGES - 1));
  for (let turn = 0; turn < 30 && j < STAGES - 1; turn += 1) {
    const [before, now] = legendre(STAGES, x), value = before - now, step = 1e-7;
    const [b, n] = legendre(STAGES, x + step);
    x -= (value * step) / (b - n - value);
  }
  return 0.5 * (1 + x);
});

function legendre(count, x) {
  let [before, now] = [1, x];
  for (let k = 2; k <= count; k += 1) [before, now] = [now, ((2 * k - 1) * x * now - (k - 1) * before) / k];
  return [before, now];
}

const lagrange = (j, x) => POINTS.reduce((total, c, i) => (i === j ? total : (total * (x - c)) / (POINTS[j] - c)), 1);
const { nodes, weights } = gauss(STAGES);
const integral = (j, x) => nodes.reduce((total, node, i) => total + weights[i] * x * lagrange(j, x * node), 0);
const WEIGHTS = POINTS.map((c) => POINTS.map((_, j) => integral(j, c)));
/** What a polynomial that is 0 at 0 is at Chebyshev's points, from what it is at Radau's. */
const PLACES = chebyshev(STAGES).places.map((place) => POINTS.map((c, j) => (place / c) * lagrange(j, place)));
/** The highest of Legendre's polynomials in what a function is at the points. */
const HIGHEST = POINTS.map((_, j) =>
  nodes.reduce((total, x, i) => total + (2 * STAGES - 1) * weights[i] * lagrange(j, x) * legendre(STAGES - 1, 2 * x - 1)[1], 0));

export class Collocation extends Stepper {
  constructor(motion, parameters, state) {
    super(motion, parameters, state, STAGES, STAGES);
    this.most = MOST;
    this.jacobian = null;
    this.there = new Float64Array(this.size);
    this.moved = new Float64Array(STAGES * this.size);
  }

  accept() {
    this.state.set(this.reached);
    this.slopes[0].set(this.slopes[STAGES]);
    this.jacobian = null;
  }

  /** Derivatives of the rates at the start of the step, by differences that are small beside what moves in it. */
  differentiate(step) {
    const { size, state, slopes, work, there } = this, found = [];
    for (let j = 0; j < size; j += 1) {
      const shift = 1e-7 * Math.max(Math.abs(state[j]), step * Math.abs(slopes[0][j]), 1e-3 * step), columns = [];
      for (const sign of [1, -1]) {
        work.set(state);
        work[j] += sign * shift;
        this.rates(work, there);
        columns.push(there.slice());
      }
      found.push(columns[0].map((value, i) => (value - columns[1][i]) / (2 * shift)));
    }
    return found;
  }

  take(step, tolerance) {
    const { size, state, slopes, work, reached } = this, count = STAGES * size;
    this.jacobian ??= this.differentiate(step);
    const matrix = Array.from({ length: count }, () => new Float64Array(count));
    for (let a = 0; a < STAGES; a += 1) {
      for (let b = 0; b < STAGES; b += 1) {
        for (let i = 0; i < size; i += 1) {
          for (let j = 0; j < size; j += 1) {
            matrix[a * size + i][b * size + j] = (a === b && i === j ? 1 : 0) - step * WEIGHTS[a][b] * this.jacobian[j][i];
          }
        }
      }
    }
    const order = factored(matrix), moved = this.moved.fill(0), right = new Float64Array(count);
    let error = Infinity, before = Infinity;
    for (let turn = 0; turn < TURNS; turn += 1) {
      for (let a = 0; a < STAGES; a += 1) {
        for (let i = 0; i < size; i += 1) work[i] = state[i] + moved[a * size + i];
        this.rates(work, slopes[a + 1]);
      }
      for (let a = 0; a < STAGES; a += 1) {
        for (let i = 0; i < size; i += 1) {
          let total = 0;
          for (let b = 0; b < STAGES; b += 1) total += WEIGHTS[a][b] * slopes[b + 1][i];
          right[a * size + i] = step * total - moved[a * size + i];
        }
      }
      solved(matrix, order, right);
      error = 0;
      for (let k = 0; k < count; k += 1) {
        moved[k] += right[k];
        error = Math.max(error, Math.abs(right[k]) / (tolerance * (1 + Math.abs(state[k % size]))));
      }
      if (error <= ENOUGH || !(error < 0.7 * before || turn < 2)) break;
      before = error;
    }
    for (let i = 0; i < size; i += 1) reached[i] = state[i] + moved[count - size + i];
    if (!(error <= 0.1)) return error === error ? 1e3 : NaN;
    return this.doubt(step, tolerance);
  }

  /** The error of the step over the one allowed, without what stiffness makes of rounding (Hairer's filter). */
  doubt(step, tolerance) {
    const { size, state, slopes, jacobian } = this, off = new Float64Array(size), share = WEIGHTS[STAGES - 1][STAGES - 1];
    const rows = Array.from({ length: size }, (_, i) =>
      Float64Array.from({ length: size }, (__, j) => (i === j ? 1 : 0) - step * share * jacobian[j][i]));
    for (let i = 0; i < size; i += 1) {
      for (let a = 0; a < STAGES; a += 1) off[i] += step * HIGHEST[a] * slopes[a + 1][i];
    }
    solved(rows, factored(rows), off);
    let largest = 0;
    for (let i = 0; i < size; i += 1) largest = Math.max(largest, Math.abs(off[i]) / (tolerance * (1 + Math.abs(state[i]))));
    return 0.1 * largest;
  }

  /** From what has moved, not from the rates: those of a stiff motion say of rounding what they say of motion. */
  interpolate() {
    const { size, state, moved, terms } = this;
    terms.fill(0);
    for (let i = 0; i < size; i += 1) {
      const values = PLACES.map((row) => row.reduce((total, weight, a) => total + weight * moved[a * size + i], state[i]));
      toPowers(values, STAGES, terms, i * (STAGES + 1));
    }
  }
}

/** Triangular factors of a matrix in its place, and the order of its rows. */
function factored(rows) {
  const count = rows.length, order = rows.map((_, i) => i);
  for (let k = 0; k < count; k += 1) {
    let best = k;
    for (let i = k + 1; i < count; i += 1) if (Math.abs(rows[i][k]) > Math.abs(rows[best][k])) best = i;
    [rows[k], rows[best]] = [rows[best], rows[k]];
    [order[k], order[best]] = [order[best], order[k]];
    const pivot = rows[k];
    for (let i = k + 1; i < count; i += 1) {
      const row = rows[i], factor = (row[k] /= pivot[k]);
      if (factor !== 0) for (let j = k + 1; j < count; j += 1) row[j] -= factor * pivot[j];
    }
  }
  return order;
}

function solved(rows, order, right) {
  const given = order.map((place) => right[place]), count = rows.length;
  for (let i = 0; i < count; i += 1) {
    let total = given[i];
    for (let j = 0; j < i; j += 1) total -= rows[i][j] * right[j];
    right[i] = total;
  }
  for (let i = count - 1; i >= 0; i -= 1) {
    let total = right[i];
    for (let j = i + 1; j < count; j += 1) total -= rows[i][j] * right[j];
    right[i] = total / rows[i][i];
  }
}
