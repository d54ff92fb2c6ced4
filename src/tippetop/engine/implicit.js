// Collocation at Radau's points (Hairer and Wanner, Solving Ordinary Differential Equations II): for stiff motions.
import { FULL, POWERS, REACHED, SINGULAR, STUCK_of_dormand_prince as STUCK, SUSPECT, first_step } from "./mechanics.js";
import { RADAU } from "./tables.js";

const { integrals: WEIGHTS, powers: TERMS, last: [LAST] } = RADAU;
const STAGES = WEIGHTS.length, TURNS = 12, ENOUGH = 1e-3, LEAST_STEP = 1e-15;

/** Steps from a state, as `advance` of Dormand and Prince takes them; where there are guards, every one is suspect. */
export function implicit(rates, guards, count, p, y, lost, k, span, tolerance, knots, terms, steps) {
  const step = new Step(rates, p, y, k, tolerance[0]), told = (ended) => [steps, step.calls, ended];
  let growth = 10;
  rates(y, p, k[0]);
  if (!k[0].every(Number.isFinite)) return told(SINGULAR);
  if (span[2] === 0) span[2] = first_step(rates, p, y, k, step.place, span[1] - span[0], tolerance);
  while (span[0] < span[1]) {
    if (steps === knots.length - 1) return told(FULL);
    const reach = Math.min(span[0] + span[2], span[1]), h = reach - span[0], doubt = step.take(h);
    if (doubt < 1) {
      step.accept(terms, steps);
      steps += 1;
      knots[steps] = span[0] = reach;
      span[2] = h * Math.min(growth, doubt === 0 ? 10 : 0.9 * doubt ** (-1 / STAGES));
      growth = 10;
      if (count > 0) return told(SUSPECT);
    } else {
      if (span[2] <= LEAST_STEP * Math.max(1, Math.abs(reach))) return told(STUCK);
      span[2] = h * (doubt < Infinity ? Math.max(0.2, 0.9 * doubt ** (-1 / STAGES)) : 0.2);
      growth = 1;
    }
  }
  return told(REACHED);
}

/** A step from a state y; k has the rates there and, once it is taken, at Radau's points. */
class Step {
  constructor(rates, p, y, k, tolerance) {
    const [place, there] = [new Float64Array(y.length), new Float64Array(y.length)];
    Object.assign(this, { rates, p, y, k, tolerance, place, there, jacobian: null, calls: 0 });
    this.moved = new Float64Array(STAGES * y.length);
  }

  /** Rates at the state moved by a part of some numbers. */
  look(moved, from, out) {
    for (let i = 0; i < this.y.length; i += 1) this.place[i] = this.y[i] + moved[from + i];
    this.calls += 1;
    this.rates(this.place, this.p, out);
  }

  accept(terms, steps) {
    const { y, k, moved } = this;
    TERMS.forEach((row, power) => y.forEach((start, i) => {
      terms[(steps * y.length + i) * POWERS + power] = row.reduce((sum, weight, a) => (a ? sum + weight * moved[(a - 1) * y.length + i] : sum), power ? 0 : start);
    }));
    y.forEach((start, i) => (y[i] = start + moved[moved.length - y.length + i]));
    k[0].set(k[STAGES]);
    this.jacobian = null;
  }

  /** Derivatives of the rates at the start of the step, by differences that are small beside what moves in it. */
  differentiate(span) {
    return Array.from(this.y, (start, j) => {
      const shift = 1e-7 * Math.max(Math.abs(start), span * Math.abs(this.k[0][j]), 1e-3 * span), moved = new Float64Array(this.y.length);
      const [above, below] = [shift, -shift].map((by) => {
        moved[j] = by;
        this.look(moved, 0, this.there);
        return this.there.slice();
      });
      return above.map((value, i) => (value - below[i]) / (2 * shift));
    });
  }

  /** The matrix 1 - span (weights x derivatives), with a right-hand side beside it. */
  system(weights, span, right) {
    const { jacobian } = this, size = this.y.length;
    return Array.from(right, (value, row) => {
      const a = Math.floor(row / size), i = row % size, found = new Float64Array(right.length + 1);
      weights[a].forEach((weight, b) => jacobian.forEach((column, j) => (found[b * size + j] = -span * weight * column[i])));
      found[row] += 1;
      found[right.length] = value;
      return found;
    });
  }

  /** Take the step; its error over the one allowed. */
  take(span) {
    const { y, k, moved } = this, size = y.length;
    this.jacobian ??= this.differentiate(span);
    moved.fill(0);
    let error = Infinity, before = Infinity;
    for (let turn = 0; turn < TURNS; turn += 1) {
      for (let a = 0; a < STAGES; a += 1) this.look(moved, a * size, k[a + 1]);
      const change = solved(this.system(WEIGHTS, span, moved.map((one, row) =>
        span * WEIGHTS[Math.floor(row / size)].reduce((sum, weight, b) => sum + weight * k[b + 1][row % size], 0) - one)));
      moved.forEach((one, row) => (moved[row] = one + change[row]));
      error = this.worst(change);
      if (error <= ENOUGH || !(error < 0.7 * before || turn < 2)) break;
      before = error;
    }
    if (!(error <= 0.1)) return error === error ? 1e3 : NaN;
    // Without what stiffness makes of rounding (Hairer's filter).
    const last = y.map((_, i) => span * LAST.reduce((sum, weight, a) => sum + weight * k[a + 1][i], 0));
    return 0.1 * this.worst(solved(this.system([[WEIGHTS[STAGES - 1][STAGES - 1]]], span, last)));
  }

  /** The largest of some numbers over the errors that are allowed. */
  worst(off) {
    return Math.max(...off.map((one, i) => Math.abs(one) / (this.tolerance * (1 + Math.abs(this.y[i % this.y.length])))));
  }
}

/** Solution of linear equations, a row each with its right-hand side last, by elimination with pivots. */
function solved(rows) {
  const count = rows.length, found = new Float64Array(count);
  for (let k = 0; k < count; k += 1) {
    let best = k;
    for (let i = k + 1; i < count; i += 1) if (Math.abs(rows[i][k]) > Math.abs(rows[best][k])) best = i;
    [rows[k], rows[best]] = [rows[best], rows[k]];
    for (let i = k + 1; i < count; i += 1) {
      const factor = rows[i][k] / rows[k][k];
      if (factor !== 0) for (let j = k + 1; j <= count; j += 1) rows[i][j] -= factor * rows[k][j];
    }
  }
  for (let i = count - 1; i >= 0; i -= 1) {
    found[i] = rows[i][count] / rows[i][i];
    for (let above = 0; above < i; above += 1) rows[above][count] -= rows[above][i] * found[i];
  }
  return found;
}
