// Integrators behind the seam of tippetop.integrators.base: Dormand and Prince's steps, and an implicit method.
import { Machinery, advance, stepped, within } from "./mechanics.js";
import { compiledMotion } from "./compile.js";
import { implicit } from "./implicit.js";

/** The implicit method by its names in Python, and the explicit one. */
export const make_integrator = (name, tolerance) => ({
  tolerance,
  integrate(motion, given, start, end) {
    const { rates, guards } = compiledMotion(motion), taking = ["radau", "collocation"].includes(name) ? implicit : advance;
    const machinery = new Machinery(taking, within, rates, guards, motion.guards.length, motion.size, guards);
    return stepped(motion, machinery, Float64Array.from(given), start, end, tolerance);
  },
});
