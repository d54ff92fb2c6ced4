// What modes state in plain operators, recorded once a kind and compiled by the browser.
import {
  Machinery,
  NodeValues,
  advance,
  javascript_source,
  record,
  stepped,
  unrolled,
  within,
} from "./mechanics.js";
import { add, cached, mul, neg, replace, sub } from "./runtime.js";

/** A function (y, p) => numbers in plain operators as code (y, p, out). */
export const compiled = (function_, size, parameters) => made(record(function_, size, parameters));

function made(recorded) {
  try {
    return new Function(
      `"use strict";\n${javascript_source(recorded, "recorded")}\nreturn recorded;`,
    )();
  } catch (error) {
    if (!(error instanceof EvalError)) throw error;
    return interpreted(recorded);
  }
}

const OPERATIONS = {
  __proto__: Math,
  "+": add,
  "-": sub,
  "*": mul,
  negative: neg,
  "/": (a, b) => a / b,
  less: (a, b) => (a < b ? 1 : 0),
  select: (condition, a, b) => (condition !== 0 ? a : b),
};

/** What is recorded, operation by operation: where pages may not make code, as some servers' policies have it. */
function interpreted({ nodes, outputs }) {
  const values = new Float64Array(nodes.length ? nodes.at(-1).place + 1 : 0);
  const given = nodes.filter(({ name }) => name === "y" || name === "p"),
    made = nodes.filter(({ operands }) => operands.length);
  const steps = made.map(({ name, place, operands: [a, b = a, c = a] }) => [
    OPERATIONS[name],
    place,
    a.place,
    b.place,
    c.place,
  ]);
  for (const { name, place, value } of nodes) if (name === "constant") values[place] = value;
  return (y, p, out) => {
    for (const { name, place, value } of given) values[place] = (name === "y" ? y : p)[value];
    for (const [operation, place, a, b, c] of steps)
      values[place] = operation(values[a], values[b], values[c]);
    outputs.forEach(({ place }, number) => (out[number] = values[place]));
  };
}

/** The integrator behind the seam of tippetop.integrators.base: Dormand and Prince's steps. */
export const integrator = (tolerance) => ({
  tolerance,
  integrate(motion, given, start, end) {
    const { rates, guards, size, parameters } = motion,
      values = (y, p) => guards.map((guard) => guard.value(y, p));
    motion.code ??= [rates, values].map((one) => compiled(one, size, parameters));
    const machinery = new Machinery(
      advance,
      within,
      ...motion.code,
      guards.length,
      size,
      motion.code[1],
    );
    return stepped(motion, machinery, Float64Array.from(given), start, end, tolerance);
  },
});

export const room = (count) => new Float64Array(count);
export const copied = (numbers) => numbers.slice();
export const first_of = (numbers, count) => numbers.slice(0, count);
export const put_from = (numbers, first, values) => numbers.set(values, first);

/** Put values into room for numbers, from one of them on, each for as many as there are abreast. */
export const put_rows = (numbers, first, values, abreast) =>
  values.forEach((value, i) =>
    numbers.fill(value, (first + i) * abreast, (first + i + 1) * abreast),
  );

/** A function that makes numbers, of some values each, better again and again: see tippetop.integrators.iteration. */
export function iterated(function_, size, parameters, abreast) {
  const values = new NodeValues(),
    recorded = unrolled(
      record((y, p) => function_(y, p, values), size, parameters),
      abreast,
    );
  const once = made(recorded),
    found = new Float64Array(recorded.outputs.length),
    last = found.length - 1;
  return (y, p, out, enough, most) => {
    for (let turn = 1; ; turn += 1) {
      once(y, p, found);
      y.set(found.subarray(0, recorded.size));
      out.set(found.subarray(recorded.size));
      if (turn === most || !(found[last] >= enough)) return turn;
    }
  };
}

const codes = cached(() => new Map()),
  readers = new WeakMap();

/** What makes readings, of so many numbers, of those of a mode and another one: kept for tops of one surface. */
export function reader(mode, size) {
  const [top, other] = mode.tops,
    known = (!other && readers.get(top)) || {};
  if (!other) readers.set(top, known);
  return (known[`${mode.form} ${size}`] ??= readerOf(mode, size));
}

function readerOf(mode, size) {
  const kinds = mode.tops.map((top) => top.kind),
    numbers = mode.tops.flatMap((top) => top.numbers);
  const known = codes(mode.form, kinds, size),
    parameters = Float64Array.of(...numbers, 0);
  const values = (of) => (y, p) => {
    let from = 0;
    const [top, other] = kinds.map((kind) => kind.top(p.slice(from, (from += kind.numbers))));
    return [...of(replace(mode, other ? { top, other } : { top }), y, p[from])];
  };
  return (of, count) => {
    if (!known.has(of)) known.set(of, compiled(values(of), size, parameters.length));
    const code = known.get(of),
      out = new Float64Array(count);
    return (y, other = 0) => {
      parameters[numbers.length] = other;
      code(y, parameters, out);
      return out;
    };
  };
}
