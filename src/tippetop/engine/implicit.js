// Collocation at Radau's points (Hairer and Wanner, Solving Ordinary Differential Equations II): for stiff motions.
import { Arc, FAILURES, MANY, SINGULAR, STUCK_of_dormand_prince as STUCK, first_fall, first_step } from "./mechanics.js";
import { DenseSolution } from "./dense.js";
import { RADAU } from "./tables.js";

const { integrals: WEIGHTS, powers: POWERS, last: [LAST] } = RADAU;
const STAGES = WEIGHTS.length, TURNS = 12, ENOUGH = 1e-3, LEAST_STEP = 1e-15;

/** Follow a motion; see tippetop.integrators.base.Integrator. */
export function* collocated(motion, functions, parameters, [start, begin], end, tolerance) {
  const step = new Step(functions, parameters, begin), { size } = step;
  let knots = [start], terms = [], time = start, growth = 10, counted = 0;
  const guards = motion.guards.map((guard, number) => functions.guard(guard, number));
  const arc = (guard, failure, last) => {
    const solution = new DenseSolution(knots, Float64Array.from(terms.flat()), size, STAGES);
    const found = new Arc(solution, Float64Array.from(last), guard, failure, knots.length - 1, step.evaluations - counted);
    [knots, terms, counted] = [[time], [], step.evaluations];
    return found;
  };
  step.begin();
  if (!step.slopes[0].every(Number.isFinite)) {
    yield arc(null, FAILURES.get(SINGULAR), begin);
    return;
  }
  let span = first_step(
    functions.rates, parameters, step.state, step.slopes, step.work, end - start, [tolerance, tolerance]);
  step.begin();
  while (time < end) {
    const reach = Math.min(time + span, end), doubt = step.take(reach - time, tolerance);
    if (!(doubt < 1)) {
      if (span <= LEAST_STEP * Math.max(1, Math.abs(reach))) {
        yield arc(null, FAILURES.get(STUCK), step.state);
        return;
      }
      span = (reach - time) * (doubt > 0 && doubt < Infinity ? Math.max(0.2, 0.9 * doubt ** (-1 / STAGES)) : 0.2);
      growth = 1;
      continue;
    }
    const taken = step.terms(), here = new DenseSolution([time, reach], Float64Array.from(taken), size, STAGES);
    let again = false;
    const advance = (at) => {
      again = true;
      step.take(at - time, tolerance);
      return step.reached.slice();
    };
    const fall = first_fall(guards, parameters, (at) => here.rows(at), advance, [time, reach]);
    if (fall !== null) {
      const [number, at, last] = fall;
      advance(at);
      terms.push(step.terms());
      knots.push((time = at));
      yield arc(guards[number].name, null, last);
      return;
    }
    if (again) step.take(reach - time, tolerance);
    step.accept();
    terms.push(taken);
    knots.push(reach);
    span = (reach - time) * Math.min(growth, doubt === 0 ? 10 : 0.9 * doubt ** (-1 / STAGES));
    [time, growth] = [reach, 10];
    if (terms.length === MANY || time >= end) yield arc(null, null, step.state);
  }
}

class Step {
  constructor(functions, parameters, state) {
    Object.assign(this, { functions, parameters, size: state.length, jacobian: null, evaluations: 0 });
    const room = () => new Float64Array(this.size);
    this.state = Float64Array.from(state);
    [this.reached, this.work, this.there] = [room(), room(), room()];
    this.slopes = Array.from({ length: STAGES + 1 }, room);
    this.moved = new Float64Array(STAGES * this.size);
  }

  rates(y, out) {
    this.evaluations += 1;
    this.functions.rates(y, this.parameters, out);
  }

  begin() {
    this.rates(this.state, this.slopes[0]);
  }

  accept() {
    this.state.set(this.reached);
    this.slopes[0].set(this.slopes[STAGES]);
    this.jacobian = null;
  }

  /** Derivatives of the rates at the start of the step, by differences that are small beside what moves in it. */
  differentiate(span) {
    const { size, state, slopes, work, there } = this;
    return Array.from({ length: size }, (_, j) => {
      const shift = 1e-7 * Math.max(Math.abs(state[j]), span * Math.abs(slopes[0][j]), 1e-3 * span);
      const [above, below] = [shift, -shift].map((by) => {
        work.set(state);
        work[j] += by;
        this.rates(work, there);
        return there.slice();
      });
      return above.map((value, i) => (value - below[i]) / (2 * shift));
    });
  }

  /** The matrix 1 - span (weights x derivatives), with a right-hand side beside it. */
  system(weights, span, right) {
    const { size, jacobian } = this;
    return Array.from({ length: weights.length * size }, (_, row) => {
      const a = Math.floor(row / size), i = row % size, found = new Float64Array(weights.length * size + 1);
      weights[a].forEach((weight, b) => jacobian.forEach((column, j) => (found[b * size + j] = -span * weight * column[i])));
      found[row] += 1;
      found[found.length - 1] = right[row];
      return found;
    });
  }

  /** Take a step from the state to `reached`; its error over the one allowed. */
  take(span, tolerance) {
    const { size, state, slopes, work, moved } = this, right = new Float64Array(moved.length);
    this.jacobian ??= this.differentiate(span);
    moved.fill(0);
    let error = Infinity, before = Infinity;
    for (let turn = 0; turn < TURNS; turn += 1) {
      for (let a = 0; a < STAGES; a += 1) {
        for (let i = 0; i < size; i += 1) work[i] = state[i] + moved[a * size + i];
        this.rates(work, slopes[a + 1]);
      }
      for (let k = 0; k < right.length; k += 1) {
        const total = WEIGHTS[Math.floor(k / size)].reduce((sum, weight, b) => sum + weight * slopes[b + 1][k % size], 0);
        right[k] = span * total - moved[k];
      }
      const change = solved(this.system(WEIGHTS, span, right));
      error = 0;
      for (let k = 0; k < right.length; k += 1) {
        moved[k] += change[k];
        error = Math.max(error, Math.abs(change[k]) / (tolerance * (1 + Math.abs(state[k % size]))));
      }
      if (error <= ENOUGH || !(error < 0.7 * before || turn < 2)) break;
      before = error;
    }
    for (let i = 0; i < size; i += 1) this.reached[i] = state[i] + moved[moved.length - size + i];
    return error <= 0.1 ? this.doubt(span, tolerance) : error === error ? 1e3 : NaN;
  }

  /** The error of the step over the one allowed, without what stiffness makes of rounding (Hairer's filter). */
  doubt(span, tolerance) {
    const last = this.slopes[0].map((_, i) => span * LAST.reduce((sum, weight, a) => sum + weight * this.slopes[a + 1][i], 0));
    const off = solved(this.system([[WEIGHTS[STAGES - 1][STAGES - 1]]], span, last));
    return 0.1 * Math.max(...off.map((one, i) => Math.abs(one) / (tolerance * (1 + Math.abs(this.state[i])))));
  }

  /** The polynomials of the step just taken, [number][power] in a row. */
  terms() {
    const { size, state, moved } = this;
    return Array.from(state).flatMap((start, i) => POWERS.map((row, power) =>
      row.reduce((sum, weight, a) => (a ? sum + weight * moved[(a - 1) * size + i] : sum), power ? 0 : start)));
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
    let total = rows[i][count];
    for (let j = i + 1; j < count; j += 1) total -= rows[i][j] * found[j];
    found[i] = total / rows[i][i];
  }
  return found;
}
