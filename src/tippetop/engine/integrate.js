// Integrators behind the seam of tippetop.integrators.base: Dormand and Prince's steps, and, for stiff motions,
// collocation at Radau's points (Hairer and Wanner, Solving Ordinary Differential Equations II).
import {
  FULL, Machinery, POWERS, REACHED, SINGULAR, STUCK_of_dormand_prince as STUCK, SUSPECT, advance, factor_for, first_step, stepped, within,
} from "./mechanics.js";
import { compiled } from "./compile.js";
import { RADAU } from "./tables.js";

/** The implicit method by its names in Python, and the explicit one. */
export const make_integrator = (name, tolerance) => ({
  tolerance,
  integrate(motion, given, start, end) {
    const taking = ["radau", "collocation"].includes(name) ? implicit : advance, { rates, guards } = compiledMotion(motion);
    const machinery = new Machinery(taking, within, rates, guards, motion.guards.length, motion.size, guards);
    return stepped(motion, machinery, Float64Array.from(given), start, end, tolerance);
  },
});

const known = new WeakMap();

function compiledMotion(motion) {
  if (!known.has(motion)) {
    const values = (y, p) => motion.guards.map((guard) => guard.value(y, p));
    const [rates, guards] = [motion.rates, values].map((one) => compiled(one, motion.size, motion.parameters));
    known.set(motion, { rates, guards });
  }
  return known.get(motion);
}

const { integrals: WEIGHTS, powers: TERMS, last: [LAST] } = RADAU;
const STAGES = WEIGHTS.length, TURNS = 12, ENOUGH = 1e-3, LEAST_STEP = 1e-15;

const sum = (weights, term) => weights.reduce((total, weight, a) => total + weight * term(a), 0);

/** Steps from a state, as `advance` of Dormand and Prince takes them; where there are guards, every one is suspect. */
function implicit(rates, guards, count, p, y, lost, k, span, tolerance, knots, terms, steps) {
  const step = new Step(rates, p, y, k, tolerance[0]), told = (ended) => [steps, step.calls, ended];
  rates(y, p, k[0]);
  if (!k[0].every(Number.isFinite)) return told(SINGULAR);
  if (span[2] === 0) span[2] = first_step(rates, p, y, k, step.place, span[1] - span[0], tolerance, y.length);
  for (let tries = 1; span[0] < span[1]; tries += 1) {
    if (steps === knots.length - 1) return told(FULL);
    const reach = Math.min(span[0] + span[2], span[1]), h = reach - span[0], doubt = step.take(h);
    span[2] = h * factor_for(doubt ** (8 / STAGES), tries);
    if (doubt < 1) {
      step.accept(terms, steps * y.length * POWERS);
      [steps, tries] = [steps + 1, 0];
      knots[steps] = span[0] = reach;
      if (count > 0) return told(SUSPECT);
    } else if (span[2] <= LEAST_STEP * Math.max(1, Math.abs(reach))) return told(STUCK);
  }
  return told(REACHED);
}

/** A step from a state y; k has the rates there and, once it is taken, at Radau's points. */
class Step {
  constructor(rates, p, y, k, tolerance) {
    const [place, moved] = [new Float64Array(y.length), new Float64Array(STAGES * y.length)];
    Object.assign(this, { rates, p, y, k, tolerance, place, moved, jacobian: null, calls: 0 });
  }

  /** Rates at the state moved by a part of some numbers. */
  look(moved, from, out) {
    for (let i = 0; i < this.y.length; i += 1) this.place[i] = this.y[i] + moved[from + i];
    this.calls += 1;
    this.rates(this.place, this.p, out);
    return out;
  }

  accept(terms, first) {
    const { y, k, moved } = this, size = y.length;
    TERMS.forEach((row, power) => y.forEach((start, i) => {
      terms[first + i * POWERS + power] = (power ? 0 : start) + sum(row, (a) => moved[a * size + i]);
    }));
    y.forEach((start, i) => (y[i] = start + moved[moved.length - size + i]));
    k[0].set(k[STAGES]);
    this.jacobian = null;
  }

  /** Derivatives of the rates at the start of the step, by differences that are small beside what moves in it. */
  differentiate(span) {
    const { y, k } = this, moved = new Float64Array(y.length);
    return Array.from(y, (start, j) => {
      const shift = 1e-7 * Math.max(Math.abs(start), span * Math.abs(k[0][j]), 1e-3 * span);
      const at = (by) => this.look(moved.fill(by, j, j + 1), 0, new Float64Array(y.length)), above = at(shift), below = at(-shift);
      moved[j] = 0;
      return above.map((rate, i) => (rate - below[i]) / (2 * shift));
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
    const { y, k, moved } = this, size = y.length, gained = (weights, i) => span * sum(weights, (a) => k[a + 1][i]);
    this.jacobian ??= this.differentiate(span);
    moved.fill(0);
    let error = Infinity, before = Infinity;
    for (let turn = 0; turn < TURNS && !(error <= ENOUGH) && (error < 0.7 * before || turn < 3); turn += 1) {
      for (let a = 0; a < STAGES; a += 1) this.look(moved, a * size, k[a + 1]);
      const off = moved.map((one, row) => gained(WEIGHTS[Math.floor(row / size)], row % size) - one);
      const change = solved(this.system(WEIGHTS, span, off));
      change.forEach((one, row) => (moved[row] += one));
      [before, error] = [error, this.worst(change)];
    }
    if (!(error <= 0.1)) return NaN;
    // Without what stiffness makes of rounding (Hairer's filter).
    const last = y.map((_, i) => gained(LAST, i));
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
