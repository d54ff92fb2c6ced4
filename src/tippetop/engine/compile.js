// What modes state in plain operators, recorded once a kind and compiled by the browser.
import { javascript_source, record } from "./mechanics.js";
import { ArithmeticError } from "./runtime.js";

/** A function (y, p) => numbers in plain operators as code (y, p, out); run as it stands where it cannot be. */
export function compiled(function_, size, parameters, count) {
  if (count === 0) return () => {};
  let recorded;
  try {
    recorded = record(function_, size, parameters);
  } catch (error) {
    if (error instanceof ReferenceError) throw error;
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
  try {
    return new Function(`"use strict";\n${javascript_source(recorded, "recorded")}\nreturn recorded;`)();
  } catch (error) {
    if (!(error instanceof EvalError)) throw error;
    return interpreted(recorded);
  }
}

const NAMES = ["y", "p", "+", "-", "*", "/", "negative", "sqrt", "pow", "abs", "less", "select", "sin", "cos"], WIDE = 5;

/** What is recorded, operation by operation: where pages may not make code, as some servers' policies have it. */
function interpreted({ nodes, outputs }) {
  const places = new Map(nodes.map((node, place) => [node, place]));
  const values = Float64Array.from(nodes, (node) => node.value), tape = [];
  nodes.forEach((node, place) => {
    if (node.name === "constant") return;
    const given = node.operands.length ? node.operands.map((one) => places.get(one)) : [node.value];
    tape.push(NAMES.indexOf(node.name), place, given[0], given[1] ?? 0, given[2] ?? 0);
  });
  const steps = Int32Array.from(tape), ends = Int32Array.from(outputs, (node) => places.get(node));
  return (y, p, out) => {
    for (let at = 0; at < steps.length; at += WIDE) {
      const first = steps[at + 2], a = values[first], b = values[steps[at + 3]];
      let found;
      switch (steps[at]) {
        case 0: found = y[first]; break;
        case 1: found = p[first]; break;
        case 2: found = a + b; break;
        case 3: found = a - b; break;
        case 4: found = a * b; break;
        case 5: found = a / b; break;
        case 6: found = -a; break;
        case 7: found = Math.sqrt(a); break;
        case 8: found = Math.pow(a, b); break;
        case 9: found = Math.abs(a); break;
        case 10: found = a < b ? 1 : 0; break;
        case 11: found = a !== 0 ? b : values[steps[at + 4]]; break;
        case 12: found = Math.sin(a); break;
        default: found = Math.cos(a);
      }
      values[steps[at + 1]] = found;
    }
    for (let i = 0; i < ends.length; i += 1) out[i] = values[ends[i]];
  };
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
