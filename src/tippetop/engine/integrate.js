// The integrator behind the seam of tippetop.integrators.base: Dormand and Prince's steps.
import { Machinery, advance, stepped, within } from "./mechanics.js";
import { compiled } from "./compile.js";

export const integrator = (tolerance) => ({
  tolerance,
  integrate(motion, given, start, end) {
    const { rates, guards } = compiledMotion(motion);
    const machinery = new Machinery(advance, within, rates, guards, motion.guards.length, motion.size, guards);
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
