// Dormand and Prince's method of order 8(5, 3) behind the integrators' seam: arcs, guards located, dense output.
import { Arc, crossing } from "./mechanics.js";
import { DenseSolution } from "./dense.js";
import { compiledMotion } from "./compile.js";
import { Collocation } from "./implicit.js";
import * as method from "./tableau.js";

const STAGES = 12, DEGREE = 7, MANY = 1024;
const LEAST_STEP = 1e-15;
const PARTS = [0, 0.25, 0.5, 0.75, 1];
const NEAR = 0.1;
const NOT_FINITE = "the solution is no longer finite";

export const make_integrator = (name, tolerance) =>
  name === "radau" ? new Collocation(tolerance) : new DormandPrince(tolerance);

const STAGE = Array.from({ length: STAGES - 1 }, (_, s) => method[`stage${s + 1}`]);
const EXTRA = [method.extra0, method.extra1, method.extra2];
const BENDS = [method.bend0, method.bend1, method.bend2, method.bend3];

/** A motion on its way: the state, the slopes of a step, and the polynomials of the step taken last. */
export class Stepper {
  constructor(motion, parameters, state) {
    this.code = compiledMotion(motion);
    this.parameters = Float64Array.from(parameters);
    this.size = motion.size;
    this.state = Float64Array.from(state);
    this.slopes = Array.from({ length: STAGES + 4 }, () => new Float64Array(this.size));
    this.reached = new Float64Array(this.size);
    this.work = new Float64Array(this.size);
    this.terms = new Float64Array(this.size * (DEGREE + 1));
    this.none = new Float64Array(this.size);
    this.offs = new Float64Array(this.size);
    this.bends = BENDS.map(() => new Float64Array(this.size));
    this.evaluations = 0;
  }

  rates(y, out) {
    this.evaluations += 1;
    this.code.rates(y, this.parameters, out);
  }

  begin(state) {
    this.state.set(state);
    this.rates(this.state, this.slopes[0]);
  }

  /** Take a step from the state to `reached`; its error over the one allowed. */
  take(step, tolerance) {
    const { slopes, work, reached, state, size, none, offs } = this;
    for (let s = 1; s < STAGES; s += 1) {
      STAGE[s - 1](state, step, slopes, work, size);
      this.rates(work, slopes[s]);
    }
    method.result(state, step, slopes, reached, size);
    this.rates(reached, slopes[STAGES]);
    method.fine(none, 1, slopes, offs, size);
    method.rough(none, 1, slopes, work, size);
    let fine = 0, rough = 0;
    for (let i = 0; i < size; i += 1) {
      const scale = tolerance * (1 + Math.max(Math.abs(state[i]), Math.abs(reached[i])));
      fine += (offs[i] / scale) * (offs[i] / scale);
      rough += (work[i] / scale) * (work[i] / scale);
    }
    if (fine === 0 && rough === 0) return 0;
    return (Math.abs(step) * fine) / Math.sqrt((fine + 0.01 * rough) * size);
  }

  /** The polynomials of the step just taken. */
  interpolate(step) {
    const { slopes, work, reached, state, size, terms, none, bends } = this;
    EXTRA.forEach((row, s) => {
      row(state, step, slopes, work, size);
      this.rates(work, slopes[STAGES + 1 + s]);
    });
    BENDS.forEach((row, f) => row(none, step, slopes, bends[f], size));
    const [a, b, c, d] = bends, begin = slopes[0], finish = slopes[STAGES];
    for (let i = 0; i < size; i += 1) {
      const first = i * (DEGREE + 1), f0 = reached[i] - state[i];
      const f1 = step * begin[i] - f0, f2 = 2 * f0 - step * (finish[i] + begin[i]);
      // y0 + x (f0 + (1 - x) (f1 + x (f2 + (1 - x) (a + x (b + (1 - x) (c + x d)))))) in powers of x
      terms[first] = state[i];
      terms[first + 1] = f0 + f1;
      terms[first + 2] = f2 - f1 + a[i];
      terms[first + 3] = b[i] - f2 - 2 * a[i] + c[i];
      terms[first + 4] = a[i] - 2 * b[i] - 3 * c[i] + d[i];
      terms[first + 5] = b[i] + 3 * c[i] - 3 * d[i];
      terms[first + 6] = 3 * d[i] - c[i];
      terms[first + 7] = -d[i];
    }
  }

  /** The state at a part of the step, by its polynomials. */
  within(part, out) {
    const { terms, size } = this;
    for (let i = 0; i < size; i += 1) {
      let total = 0;
      for (let k = (i + 1) * (DEGREE + 1) - 1; k >= i * (DEGREE + 1); k -= 1) total = total * part + terms[k];
      out[i] = total;
    }
    return out;
  }
}

const isFinite_ = (values) => values.every(Number.isFinite);

export class DormandPrince {
  constructor(tolerance = 1e-10) {
    this.tolerance = tolerance;
    this.name = "dop853";
  }

  *integrate(motion, parameters, [start, state], end) {
    const run = new Stepper(motion, parameters, state), guards = new Guards(motion, run);
    run.begin(state);
    if (!isFinite_(run.slopes[0])) {
      yield new Arc(DenseSolution.nothing(start, motion.size), state, null, "the motion is singular from the start");
      return;
    }
    let time = start, step = this.first(run, end - start), growth = 10;
    let knots = [time], pieces = [], counted = 0;
    const arc = (guard, failure, last) => {
      const terms = new Float64Array(pieces.length * run.terms.length);
      pieces.forEach((piece, i) => terms.set(piece, i * run.terms.length));
      const solution = new DenseSolution(knots, terms, motion.size, DEGREE);
      const found = new Arc(solution, Array.from(last), guard, failure, pieces.length, run.evaluations - counted);
      [knots, pieces, counted] = [[time], [], run.evaluations];
      return found;
    };
    guards.begin();
    while (time < end) {
      let reach = time + step;
      if (reach >= end || end - reach < 1e-14 * Math.abs(end)) reach = end;
      const span = reach - time, doubt = run.take(span, this.tolerance);
      if (!(doubt < 1)) {
        if (span <= LEAST_STEP * Math.max(1, Math.abs(reach))) {
          const failure = isFinite_(run.reached) ? "the step size fell to nothing" : NOT_FINITE;
          yield arc(null, failure, run.state);
          return;
        }
        step = span * (doubt > 0 && doubt < Infinity ? Math.max(0.2, 0.9 * doubt ** (-1 / 8)) : 0.2);
        growth = 1;
        continue;
      }
      if (!isFinite_(run.reached)) {
        yield arc(null, NOT_FINITE, run.state);
        return;
      }
      run.interpolate(span);
      const fall = guards.fall(span, this.tolerance);
      if (fall !== null) {
        time += fall.span;
        knots.push(time);
        pieces.push(fall.terms);
        yield arc(fall.name, null, fall.state);
        return;
      }
      time = reach;
      knots.push(time);
      pieces.push(run.terms.slice());
      run.state.set(run.reached);
      run.slopes[0].set(run.slopes[STAGES]);
      if (pieces.length === MANY) yield arc(null, null, run.state);
      step = span * Math.min(growth, doubt === 0 ? 10 : 0.9 * doubt ** (-1 / 8));
      if (reach === end && span < step) step = Math.max(step, span);
      growth = 10;
    }
    if (pieces.length) yield arc(null, null, run.state);
  }

  /** A first step, as Hairer, Norsett and Wanner choose it. */
  first(run, span) {
    const size = (values) => {
      let total = 0;
      for (let i = 0; i < run.size; i += 1) total += (values[i] / (this.tolerance * (1 + Math.abs(run.state[i])))) ** 2;
      return Math.sqrt(total / run.size);
    };
    const d0 = size(run.state), d1 = size(run.slopes[0]);
    const guess = Math.min(d0 < 1e-5 || d1 < 1e-5 ? 1e-6 : (0.01 * d0) / d1, span);
    const there = run.state.map((value, i) => value + guess * run.slopes[0][i]), slope = new Float64Array(run.size);
    run.rates(there, slope);
    const d2 = size(slope.map((value, i) => value - run.slopes[0][i])) / guess;
    const longest = d1 <= 1e-15 && d2 <= 1e-15 ? Math.max(1e-6, guess * 1e-3) : (0.01 / Math.max(d1, d2)) ** (1 / 8);
    return Math.min(100 * guess, longest > 0 ? longest : guess, span);
  }
}

/** Looks within every step for the first guard that falls through zero, also where it dips and returns. */
class Guards {
  constructor(motion, run) {
    this.names = motion.guards.map((guard) => guard.name);
    this.run = run;
    this.place = new Float64Array(run.size);
    this.looks = PARTS.map(() => new Float64Array(this.names.length));
    this.out = new Float64Array(this.names.length);
  }

  begin() {
    this.run.code.guards(this.run.state, this.run.parameters, this.looks[0]);
  }

  value(number, state) {
    this.run.code.guards(state, this.run.parameters, this.out);
    return this.out[number];
  }

  inside(number, part) {
    return this.value(number, this.run.within(part, this.place));
  }

  fall(span, tolerance) {
    if (!this.names.length) return null;
    const { run, looks } = this;
    for (let look = 1; look < PARTS.length; look += 1) {
      const there = look === PARTS.length - 1 ? run.reached : run.within(PARTS[look], this.place);
      run.code.guards(there, run.parameters, looks[look]);
    }
    let first = null;
    for (let number = 0; number < this.names.length; number += 1) {
      const bracket = this.bracket(number);
      if (bracket === null) continue;
      const part = crossing((x) => this.inside(number, x), bracket[0], bracket[1]);
      if (first === null || part < first.part) first = { number, part };
    }
    if (first === null) {
      looks[0].set(looks[PARTS.length - 1]);
      return null;
    }
    return { name: this.names[first.number], ...this.land(first.number, first.part * span, span) };
  }

  /** Parts of the step between which a guard falls from positive to not positive. */
  bracket(number) {
    const values = this.looks.map((look) => look[number]);
    let least = 1e300, most = -1e300;
    for (const value of values) {
      least = Math.min(least, value);
      most = Math.max(most, value);
    }
    for (let i = 0; i + 1 < values.length; i += 1) {
      if (values[i] > 0 && values[i + 1] <= 0) return [PARTS[i], PARTS[i + 1]];
      if (values[i] <= 0 || least > NEAR * (most - least) || values[i + 1] <= 0) continue;
      // It may dip between the two: look where its slopes at their ends say so.
      const dip = this.dip(number, PARTS[i], PARTS[i + 1], values[i], values[i + 1]);
      if (dip !== null) return [PARTS[i], dip];
    }
    return null;
  }

  dip(number, low, high, before, after) {
    const small = 1e-3 * (high - low);
    if (this.inside(number, low + small) > before || this.inside(number, high - small) > after) return null;
    let [a, b] = [low, high];
    const golden = 0.3819660112501051;
    let x = a + golden * (b - a), y = b - golden * (b - a), f = this.inside(number, x), g = this.inside(number, y);
    for (let turn = 0; turn < 60 && b - a > 1e-9; turn += 1) {
      if (f <= 0) return x;
      if (g <= 0) return y;
      if (f < g) {
        [b, y, g] = [y, x, f];
        f = this.inside(number, (x = a + golden * (b - a)));
      } else {
        [a, x, f] = [x, y, g];
        g = this.inside(number, (y = b - golden * (b - a)));
      }
    }
    return null;
  }

  /** The step that ends where the guard is zero, improved by steps that really end there. */
  land(number, guess, span) {
    const { run } = this;
    const value = (step) => {
      run.take(step, 1);
      return this.value(number, run.reached);
    };
    const shift = 1e-4 * span;
    let [now, before] = [guess, guess > shift ? guess - shift : guess + shift];
    let [at, was] = [value(now), value(before)];
    for (let turn = 0; turn < 8 && at !== was && at !== 0; turn += 1) {
      let next = now - (at * (now - before)) / (at - was);
      next = Math.min(Math.max(next, 1e-3 * Math.min(shift, guess)), span + shift);
      if (Math.abs(next - now) <= 4e-16 * Math.max(1, Math.abs(next)) || next !== next) break;
      [before, was, now] = [now, at, next];
      at = value(now);
    }
    const best = Math.abs(was) < Math.abs(at) ? before : now;
    run.take(best, 1);
    run.interpolate(best);
    return { span: best, terms: run.terms.slice(), state: run.reached.slice() };
  }
}
