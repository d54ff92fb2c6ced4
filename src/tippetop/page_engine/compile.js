// Compiles what modes state in plain operators: it is recorded once a kind of mode, and compiled by the browser.
import {
  advance,
  contact_numbers,
  contacts_with,
  javascript_source,
  Machinery,
  NodeValues,
  record,
  stepped,
  unrolled,
  within,
} from "./mechanics.js";
import { add, cached, key, mul, neg, sub } from "./runtime.js";

/** A function (y, p) => numbers in plain operators as code (y, p, out). */
export const compiled = (function_, size, parameters) =>
  executable(record(function_, size, parameters));

function executable(graph) {
  const source = `"use strict";\n${javascript_source(graph, "recorded")}\nreturn recorded;`;
  try {
    return new Function(source)();
  } catch (error) {
    // The policy of some servers lets no page make code.
    if (!(error instanceof EvalError)) throw error;
    return interpreted(graph);
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

/** A function (y, p, out) that goes through a recorded graph operation by operation. */
function interpreted({ nodes, outputs }) {
  const values = new Float64Array(nodes.length ? nodes.at(-1).place + 1 : 0);
  for (const { name, place, value } of nodes) {
    if (name === "constant") values[place] = value;
  }
  const inputs = nodes.filter(({ name }) => name === "y" || name === "p");
  const steps = nodes.filter(({ operands }) => operands.length).map(stepOf);
  return (y, p, out) => {
    for (const { name, place, value } of inputs) values[place] = (name === "y" ? y : p)[value];
    for (const { operation, place, a, b, c } of steps) {
      values[place] = operation(values[a], values[b], values[c]);
    }
    outputs.forEach(({ place }, number) => {
      out[number] = values[place];
    });
  };
}

/** A node's operation with the places of three operands, of which it uses as many as it has. */
function stepOf({ name, place, operands }) {
  const [a, b = a, c = a] = operands;
  return { operation: OPERATIONS[name], place, a: a.place, b: b.place, c: c.place };
}

/** The integrator behind the seam of tippetop.integrators.base: Dormand and Prince's steps. */
export const integrator = (tolerance) => ({
  tolerance,
  integrate(motion, begin, start, end) {
    const { rates, guards, size, parameters } = motion;
    const guardValues = (y, p) => guards.map((guard) => guard.value(y, p));
    motion.code ??= [rates, guardValues].map((one) => compiled(one, size, parameters));
    const [rateCode, guardCode] = motion.code;
    const machinery = new Machinery(
      advance,
      within,
      rateCode,
      guardCode,
      guards.length,
      size,
      guardCode,
    );
    return stepped(motion, machinery, Float64Array.from(begin), start, end, tolerance);
  },
});

const IMPACTS = 1e-13;

/** The integrator where a run has named none, as for the impact that begins one. */
export const unnamed_integrator = () => integrator(IMPACTS);

export const room = (count) => new Float64Array(count);
export const copied = (numbers) => numbers.slice();
export const first_of = (numbers, count) => numbers.slice(0, count);
export const put_from = (numbers, first, values) => numbers.set(values, first);

/** Put values into room for numbers, from one of them on, each for as many as there are abreast. */
export function put_rows(numbers, first, values, abreast) {
  values.forEach((value, i) => {
    numbers.fill(value, (first + i) * abreast, (first + i + 1) * abreast);
  });
}

/** A function that improves numbers, of some values each, again and again: see tippetop.integrators.iteration. */
export function iterated(function_, size, parameters, abreast) {
  const values = new NodeValues();
  const improvement = record((y, p) => function_(y, p, values), size, parameters);
  const graph = unrolled(improvement, abreast);
  const improve = executable(graph);
  const improved = new Float64Array(graph.outputs.length);
  const error = improved.length - 1;
  return (y, p, out, enough, most) => {
    for (let turn = 1; ; turn += 1) {
      improve(y, p, improved);
      y.set(improved.subarray(0, graph.size));
      out.set(improved.subarray(graph.size));
      // An error that is no number ends the search, too.
      if (turn === most || !(improved[error] >= enough)) return turn;
    }
  };
}

const readersOfTops = new WeakMap();
// Code is shared by tops of one kind, which differ in parameters only.
const codesOf = cached(() => new Map());

/**
 * Compile functions that read quantities off the numbers of a mode, of which there are `size`.
 *
 * `reader(mode, size)(of, count)` returns a function (y, other), which returns the `count` values of
 * `of(mode, y, other)` in an array that its next call overwrites.
 */
export function reader(mode, size) {
  const [top, second] = mode.tops;
  if (second) return readerOf(mode, size);
  if (!readersOfTops.has(top)) readersOfTops.set(top, new Map());
  const readers = readersOfTops.get(top);
  const place = key([mode.reading_key, size]);
  if (!readers.has(place)) readers.set(place, readerOf(mode, size));
  return readers.get(place);
}

function readerOf(mode, size) {
  const kinds = mode.tops.map((top) => top.kind);
  const numbers = contact_numbers(mode.tops);
  const codes = codesOf(mode.reading_key, kinds, size);
  const parameters = Float64Array.of(...numbers, 0);
  const last = numbers.length;
  const values = (of) => (y, p) => [...of(mode.on_tops(contacts_with(kinds, p)), y, p[last])];
  return (of, count) => {
    if (!codes.has(of)) codes.set(of, compiled(values(of), size, parameters.length));
    const code = codes.get(of);
    const out = new Float64Array(count);
    return (y, other = 0) => {
      parameters[last] = other;
      code(y, parameters, out);
      return out;
    };
  };
}
