// A step of Dormand and Prince's method of order 8(5, 3), and the polynomials that stand for it.
import { compiledMotion } from "./compile.js";
import * as method from "./tableau.js";

const STAGES = 12;
const STAGE = Array.from({ length: STAGES - 1 }, (_, s) => method[`stage${s + 1}`]);
const EXTRA = [method.extra0, method.extra1, method.extra2];
const BENDS = [method.bend0, method.bend1, method.bend2, method.bend3];

/** A motion on its way: the state, the slopes of a step, and the polynomials of the step taken last. */
export class Stepper {
  constructor(motion, parameters, state, degree = 7, order = 8) {
    this.degree = degree;
    this.order = order;
    this.code = compiledMotion(motion);
    this.parameters = Float64Array.from(parameters);
    this.size = motion.size;
    this.state = Float64Array.from(state);
    this.slopes = Array.from({ length: STAGES + 4 }, () => new Float64Array(this.size));
    this.reached = new Float64Array(this.size);
    this.work = new Float64Array(this.size);
    this.terms = new Float64Array(this.size * (degree + 1));
    this.none = new Float64Array(this.size);
    this.offs = new Float64Array(this.size);
    this.bends = BENDS.map(() => new Float64Array(this.size));
    this.evaluations = 0;
    this.most = Infinity;
  }

  rates(y, out) {
    this.evaluations += 1;
    this.code.rates(y, this.parameters, out);
  }

  get slope() {
    return this.slopes[0];
  }

  begin() {
    this.rates(this.state, this.slope);
  }

  /** Go on from where the step ended. */
  accept() {
    this.state.set(this.reached);
    this.slopes[0].set(this.slopes[STAGES]);
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
      const first = 8 * i, f0 = reached[i] - state[i];
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
    const { terms, size, degree } = this;
    for (let i = 0; i < size; i += 1) {
      let total = 0;
      for (let k = (i + 1) * (degree + 1) - 1; k >= i * (degree + 1); k -= 1) total = total * part + terms[k];
      out[i] = total;
    }
    return out;
  }
}
