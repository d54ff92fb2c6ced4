// What modes state in plain operators, recorded once a kind and compiled by the browser.
import { javascript_source, record } from "./mechanics.js";
import { ArithmeticError } from "./runtime.js";

/** A function (y, p) => numbers in plain operators as code (y, p, out); run as it stands where it cannot be. */
export function compiled(function_, size, parameters, count) {
  if (count === 0) return () => {};
  try {
    const source = javascript_source(record(function_, size, parameters), "recorded");
    return new Function(`"use strict";\n${source}\nreturn recorded;`)();
  } catch (error) {
    if (error instanceof ReferenceError || error instanceof SyntaxError) throw error;
    return (y, p, out) => {
      try {
        const found = function_(y, p);
        for (let i = 0; i < count; i += 1) out[i] = found[i];
      } catch (trouble) {
        if (!(trouble instanceof ArithmeticError)) throw trouble;
        out.fill(NaN);
      }
    };
  }
}

const known = new WeakMap();

/** The rates and guards of a motion. */
export function compiledMotion(motion) {
  if (!known.has(motion)) {
    const rates = compiled(motion.rates, motion.size, motion.parameters, motion.size);
    const values = (y, p) => motion.guards.map((guard) => guard.value(y, p));
    const guards = compiled(values, motion.size, motion.parameters, motion.guards.length);
    known.set(motion, { rates, guards });
  }
  return known.get(motion);
}
