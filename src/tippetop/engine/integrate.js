// Integrators behind the seam of tippetop.integrators.base: Dormand and Prince's steps, and an implicit method.
import { Machinery, advance, stepped, within } from "./mechanics.js";
import { compiledMotion } from "./compile.js";
import { collocated } from "./implicit.js";

/** The implicit method by its names in Python, and the explicit one. */
export const make_integrator = (name, tolerance) => ({
  tolerance,
  integrate(motion, given, start, end) {
    const { rates, guards } = compiledMotion(motion), parameters = Float64Array.from(given);
    const machinery = new Machinery(advance, within, rates, guards, motion.guards.length, guards);
    const follow = ["radau", "collocation"].includes(name) ? collocated : stepped;
    return follow(motion, machinery, parameters, start, end, tolerance);
  },
});
