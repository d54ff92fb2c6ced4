// The engine of tippetop in a page, a worker or Node: problems as tippetop's JSON has them, in SI units.
import * as m from "./mechanics.js";
import { CATALOGUE, PRESETS, SCHEMA } from "./tables.js";
import { InvalidInput } from "./part.js";
import { plain } from "./runtime.js";
import { simulate } from "./run.js";

export { InvalidInput, simulate };
export const catalogue = CATALOGUE, presets = PRESETS, schema = SCHEMA;

/** A problem with every field, checked. */
export const complete = (problem) => new m.Problem(problem).model_dump();

/** What the theory says without a run: where a launch ends, its critical spins, what a body can do at all. */
export function predict(problem) {
  const found = m.predict(new m.Problem(problem));
  return { ...plain(found), certain: found.certain };
}
export const criticalSpins = (problem) => plain(m.critical_spins(new m.Problem(problem)));
export function prospects(body, gravity, tilt) {
  const whole = new m.Body(body);
  return plain(m.prospects(whole, whole.shapes, gravity, tilt));
}

/** The surface of a body that touches at cos(tilt): `height` and `slope` of its support function, and `active`. */
export function lowestSurface(body) {
  const { surface } = new m.Body(body), several = surface instanceof m.Hull;
  return several ? (c) => m.lowest_surface(surface, c) : () => surface;
}

/** A problem with some fields replaced, named with dots. */
export function replace(problem, changes) {
  const found = structuredClone(problem);
  for (const [name, value] of Object.entries(changes)) {
    const steps = name.split("."), last = steps.pop();
    let inner = found;
    for (const step of steps) inner = inner[step] ??= {};
    inner[last] = value;
  }
  return found;
}

/** Rows of launches: every combination of the values of `axes`, a list of { name, values }, the last one fastest. */
export function map(problem, axes, { duration, tolerance = 1e-5, metric = null, onProgress, shouldStop } = {}) {
  const count = axes.reduce((total, axis) => total * axis.values.length, 1), rows = [];
  for (let cell = 0; cell < count && !shouldStop?.(); cell += 1) {
    let rest = cell;
    const changes = {};
    for (const axis of [...axes].reverse()) {
      changes[axis.name] = axis.values[rest % axis.values.length];
      rest = Math.floor(rest / axis.values.length);
    }
    rows.push(one(replace(problem, changes), { duration, tolerance }, metric));
    onProgress?.((cell + 1) / count);
  }
  return rows;
}

function one(problem, options, metric) {
  try {
    const { ending, metrics } = simulate(problem, options);
    return metric === null ? { outcome: ending, ...metrics } : { outcome: ending, [metric]: metrics[metric] };
  } catch (error) {
    if (error instanceof InvalidInput) return { outcome: "bad", message: error.message };
    return { outcome: "failed", message: String(error) };
  }
}
