// Integrators behind the seam of tippetop.integrators.base: adaptive steps, arcs of them, and guards located.
import { Arc, crossing } from "./mechanics.js";
import { DenseSolution } from "./dense.js";
import { Collocation } from "./implicit.js";
import { Stepper } from "./stepper.js";

const MANY = 512, FEW = 32;
const LEAST_STEP = 1e-15;
const PARTS = [0, 0.25, 0.5, 0.75, 1];
const NEAR = 0.1, RISEN = 1e-15;
const NOT_FINITE = "the solution is no longer finite";

/** The implicit method by its names in Python, and the explicit one. */
export const make_integrator = (name, tolerance) => new Adaptive(["radau", "collocation"].includes(name) ? Collocation : Stepper, tolerance);

function isFinite_(values) {
  let total = 0;
  for (let i = 0; i < values.length; i += 1) total += 0 * values[i];
  return total === 0;
}

export class Adaptive {
  constructor(method, tolerance) {
    this.method = method;
    this.tolerance = tolerance;
  }

  *integrate(motion, parameters, [start, state], end) {
    const run = new this.method(motion, parameters, state), guards = new Guards(motion, run);
    run.begin(state);
    if (!isFinite_(run.slope)) {
      yield new Arc(DenseSolution.nothing(start, motion.size), state, null, "the motion is singular from the start");
      return;
    }
    let time = start, step = this.first(run, end - start), growth = 10;
    let knots = [time], taken = new Float64Array(0), counted = 0;
    const keep = (reach, terms) => {
      const from = (knots.length - 1) * terms.length;
      if (from === taken.length) {
        const wider = new Float64Array(Math.max(2 * from, FEW * terms.length));
        wider.set(taken);
        taken = wider;
      }
      taken.set(terms, from);
      knots.push(reach);
    };
    const arc = (guard, failure, last) => {
      const count = knots.length - 1, solution = new DenseSolution(knots, taken, motion.size, run.degree);
      const found = new Arc(solution, Array.from(last), guard, failure, count, run.evaluations - counted);
      [knots, taken, counted] = [[time], new Float64Array(0), run.evaluations];
      return found;
    };
    guards.begin();
    let count = 0;
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
        step = span * (doubt > 0 && doubt < Infinity ? Math.max(0.2, 0.9 * doubt ** (-1 / run.order)) : 0.2);
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
        keep(time, fall.terms);
        yield arc(fall.name, null, fall.state);
        return;
      }
      time = reach;
      keep(time, run.terms);
      run.accept();
      count += 1;
      if (count === run.most && time < end) {
        yield arc(null, "it takes too many steps", run.state);
        return;
      }
      if (knots.length > MANY) yield arc(null, null, run.state);
      step = span * Math.min(growth, doubt === 0 ? 10 : 0.9 * doubt ** (-1 / run.order));
      if (reach === end && span < step) step = Math.max(step, span);
      growth = 10;
    }
    if (knots.length > 1) yield arc(null, null, run.state);
  }

  /** A first step, as Hairer, Norsett and Wanner choose it. */
  first(run, span) {
    const size = (values) => {
      let total = 0;
      for (let i = 0; i < run.size; i += 1) total += (values[i] / (this.tolerance * (1 + Math.abs(run.state[i])))) ** 2;
      return Math.sqrt(total / run.size);
    };
    const d0 = size(run.state), d1 = size(run.slope);
    const guess = Math.min(d0 < 1e-5 || d1 < 1e-5 ? 1e-6 : (0.01 * d0) / d1, span);
    const there = run.state.map((value, i) => value + guess * run.slope[i]), slope = new Float64Array(run.size);
    run.rates(there, slope);
    const d2 = size(slope.map((value, i) => value - run.slope[i])) / guess;
    const longest = d1 <= 1e-15 && d2 <= 1e-15 ? Math.max(1e-6, guess * 1e-3) : (0.01 / Math.max(d1, d2)) ** (1 / run.order);
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
    const { looks } = this;
    let least = Infinity, most = -Infinity;
    for (let i = 0; i < looks.length; i += 1) {
      least = Math.min(least, looks[i][number]);
      most = Math.max(most, looks[i][number]);
    }
    if (least > NEAR * (most - least)) return null;
    if (looks[0][number] <= 0 && looks[1][number] <= 0) {
      const early = this.early(number);
      if (early !== null) return early;
    }
    for (let i = 0; i + 1 < looks.length; i += 1) {
      const before = looks[i][number], after = looks[i + 1][number];
      if (before > 0 && after <= 0) return [PARTS[i], PARTS[i + 1]];
      if (before <= 0 || after <= 0) continue;
      // It may dip between the two: look where its slopes at their ends say so.
      const dip = this.dip(number, PARTS[i], PARTS[i + 1], before, after);
      if (dip !== null) return [PARTS[i], dip];
    }
    return null;
  }

  /** Where a guard that starts at zero, rises, and is back before the first look falls. */
  early(number) {
    let low = 2 ** -40, before = this.inside(number, low);
    for (let high = 2 * low; high <= PARTS[1]; high *= 2) {
      const after = this.inside(number, high);
      if (before > RISEN && after <= 0) return [low, high];
      [low, before] = [high, after];
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
    const shift = Math.min(1e-4 * span, 0.1 * guess) || 1e-4 * span;
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
