// The engine of tippetop in a page, a worker or Node: problems as tippetop's JSON has them, in SI units.
import * as m from "./mechanics.js";
import { plain } from "./runtime.js";

export { extent, InvalidInput, MISSING } from "./mechanics.js";
export { simulate, timeDigits } from "./run.js";

/** What the theory says without a run: where a launch ends, its critical spins, what a body can do at all. */
export function predict(problem) {
  const found = m.predict(new m.Problem(problem));
  return { ...plain(found), certain: found.is_certain };
}
/**
 * How the friction of a table serves a launch of one sphere: it "creeps", as `predict` needs, takes spin because it
 * "drills", "sticks" where slip ends, or there is "none".
 */
export function tableKind(problem) {
  const stated = new m.Problem(problem);
  const [top, friction] = [m.top_of(stated), stated.friction];
  if (friction.vanishes) return "none";
  if (!m.creeps(top)) return "sticks";
  return top.conserves_jellett ? "creeps" : "drills";
}
export const criticalSpins = (problem) => plain(m.critical_spins(new m.Problem(problem)));
/** How many samples a run of a duration, s, needs so that it can be played at any speed. */
export const sampleCount = (problem, duration) => m.sample_count(new m.Problem(problem), duration);
export function prospects(body, gravity, tilt) {
  const whole = new m.Body(body);
  return plain(m.prospects(whole, whole.shapes, gravity, tilt));
}
/** The least change of each size alone by which a top stands; `bodyWith` makes the body with one size changed. */
export const advice = (bodyWith, sizes, reach, gravity, tilt) =>
  m
    .advice(
      (name, value) => new m.Body(bodyWith(name, value)),
      sizes.map(({ name, value, low, high }) => new m.Size(name, value, low, high)),
      reach,
      gravity,
      tilt,
    )
    .map(plain);
/** What is implausible about a launch: kinds, and texts for the gaps in their sentences. */
export const doubts = (problem) =>
  m
    .doubts(new m.Problem(problem))
    .map(({ kind, gaps }) => ({ kind, gaps: Object.fromEntries(gaps) }));

/** The surface of a body that touches at cos(tilt): `height` and `slope` of its support function. */
export function lowestSurface(body) {
  const { surface } = new m.Body(body);
  return (c) => m.lowest_surface(surface, c);
}

/** The outline of a body: of a profile, whose edges are lines of points, if it is the body's; null if not, or none. */
export function ownOutline(body, edges) {
  const lines = m.smoothly_joined(edges);
  return m.is_outline(lines, new m.Body(body).surface) ? lines : null;
}

/** The outline of the hull of its surfaces. */
export const outline = (body) => m.outline(new m.Body(body).surface);
export { fromDrawing, fromPoints, pointsOf, turned, weighed } from "./brought.js";
