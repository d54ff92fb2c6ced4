// What modes state in plain operators, recorded once a kind and compiled by the browser.
import { NodeValues, javascript_source, record, unrolled } from "./mechanics.js";
import { ArithmeticError, heed } from "./runtime.js";

/** A function (y, p) => numbers in plain operators as code (y, p, out); run as it stands where it cannot be. */
export function compiled(function_, size, parameters, heeds = true) {
  try {
    return made(record(function_, size, parameters));
  } catch (error) {
    if (error instanceof ReferenceError || error instanceof SyntaxError) throw error;
  }
  return (y, p, out) => {
    heed(heeds);
    try {
      out.set(function_(y, p));
    } catch (trouble) {
      if (!(trouble instanceof ArithmeticError)) throw trouble;
      out.fill(NaN);
    } finally {
      heed(true);
    }
  };
}

function made(recorded) {
  try {
    return new Function(`"use strict";\n${javascript_source(recorded, "recorded")}\nreturn recorded;`)();
  } catch (error) {
    if (!(error instanceof EvalError)) throw error;
    return interpreted(recorded);
  }
}

const OPERATIONS = {
  "+": (v, to, a, b) => () => { v[to] = v[a] + v[b]; },
  "-": (v, to, a, b) => () => { v[to] = v[a] - v[b]; },
  "*": (v, to, a, b) => () => { v[to] = v[a] * v[b]; },
  "/": (v, to, a, b) => () => { v[to] = v[a] / v[b]; },
  negative: (v, to, a) => () => { v[to] = -v[a]; },
  sqrt: (v, to, a) => () => { v[to] = Math.sqrt(v[a]); },
  less: (v, to, a, b) => () => { v[to] = v[a] < v[b] ? 1 : 0; },
  select: (v, to, condition, a, b) => () => { v[to] = v[condition] !== 0 ? v[a] : v[b]; },
};
const elementary = (name) => (v, to, a, b = a) => () => { v[to] = Math[name](v[a], v[b]); };

/** What is recorded, operation by operation: where pages may not make code, as some servers' policies have it. */
function interpreted({ nodes, outputs }) {
  const values = new Float64Array(nodes.at(-1).place + 1), steps = [], given = [];
  for (const { name, place, value, operands } of nodes) {
    if (operands.length) steps.push((OPERATIONS[name] ?? elementary(name))(values, place, ...operands.map((one) => one.place)));
    else if (name === "constant") values[place] = value;
    else given.push({ name, place, value });
  }
  return (y, p, out) => {
    for (const { name, place, value } of given) values[place] = (name === "y" ? y : p)[value];
    for (let i = 0; i < steps.length; i += 1) steps[i]();
    for (let i = 0; i < outputs.length; i += 1) out[i] = values[outputs[i].place];
  };
}

export const room = (count) => new Float64Array(count);
export const copied = (numbers) => numbers.slice();
export const put_from = (numbers, first, values) => numbers.set(values, first);

/** Put values into room for numbers, from one of them on, each for as many as there are abreast. */
export function put_rows(numbers, first, values, abreast) {
  values.forEach((value, i) => numbers.fill(value, (first + i) * abreast, (first + i + 1) * abreast));
}

/** The first of some pieces of polynomials, of which the last may be a share. */
export function pieces_of(numbers, size, degree, count) {
  const whole = Math.ceil(count), share = count - (whole - 1), found = numbers.slice(0, whole * size * degree);
  if (count === whole) return found;
  for (let at = (whole - 1) * size * degree; at < found.length; at += 1) found[at] *= share ** (1 + at % degree);
  return found;
}

/** By how much numbers change over pieces. */
export function change_over(pieces, size, degree) {
  const found = new Array(size).fill(0);
  pieces.forEach((term, at) => (found[Math.floor(at / degree) % size] += term));
  return found;
}

/** A function that makes numbers, of some values each, better again and again: see tippetop.integrators.iteration. */
export function iterated(function_, size, parameters, abreast) {
  const values = new NodeValues(), recorded = unrolled(record((y, p) => function_(y, p, values), size, parameters), abreast);
  const once = made(recorded), found = new Float64Array(recorded.outputs.length), last = found.length - 1;
  return (y, p, out, enough, most) => {
    for (let turn = 1; ; turn += 1) {
      once(y, p, found);
      y.set(found.subarray(0, recorded.size));
      out.set(found.subarray(recorded.size));
      if (turn === most || !(found[last] >= enough)) return turn;
    }
  };
}

const known = new WeakMap();

/** The rates and guards of a motion. */
export function compiledMotion(motion) {
  if (!known.has(motion)) {
    const values = (y, p) => motion.guards.map((guard) => guard.value(y, p));
    const [rates, guards] = [motion.rates, values].map((one) => compiled(one, motion.size, motion.parameters));
    known.set(motion, { rates, guards });
  }
  return known.get(motion);
}
