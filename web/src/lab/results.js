// Results of a class: what became of launches as short codes, a spin in rad/s and the final tilt in degrees, or as links.

import { readLaunch } from "./link.js";
import { changed, same } from "./setup.js";

const DEGREES = 180 / Math.PI;
// More than any hand or string spins a top, rad/s: it is a slip of the pen.
const MOST_SPIN = 2000;
// The name that a result code has in a link.
const RESULT = "result";
const FIRST_PART = /^\s*([-−]?\d+(?:[.,]\d+)?)\s*[ ;:/→\t]\s*(\d+(?:[.,]\d+)?)\s*°?\s*$/;

/** The code of a run: "155 179.9". */
export function resultCode({ problem, metrics }) {
  const spin = Number(problem.launch.spin.toPrecision(4));
  return `${spin} ${(metrics.final_tilt * DEGREES).toFixed(1)}`;
}

/** The address under which a run is seen again, with its result code. */
export function resultLink(place, query, header) {
  query.set("tab", "launch");
  query.set(RESULT, resultCode(header));
  return `${place}#${query}`;
}

// The result code that a line is, or that the link in a line carries; and the launch of that link.
function partsOf(line) {
  const [, text] = /#(\S+)/.exec(line) ?? [];
  if (!text) return { code: line, launch: null };
  const query = new URLSearchParams(text);
  return { code: query.get(RESULT) ?? "", launch: readLaunch(query).setup };
}

/**
 * Spins and tilts of the codes and links in a text, one a line, the numbers of the lines that are none, and of those
 * whose link is to another launch than that of the class, but for its spin.
 */
export function readResults(text, setup) {
  const points = [];
  const wrong = [];
  const others = [];
  text.split("\n").forEach((line, k) => {
    if (!line.trim()) return;
    const { code, launch } = partsOf(line);
    const [, spin, tilt] = FIRST_PART.exec(code) ?? [];
    const point = [spin, tilt].map((part) => Number(part?.replace("−", "-").replace(",", ".")));
    const isPoint = point.every(Number.isFinite) && point[1] <= 180;
    if (!isPoint || Math.abs(point[0]) > MOST_SPIN) wrong.push(k + 1);
    else if (launch && !isOfClass(launch, setup)) others.push(k + 1);
    else points.push(point);
  });
  return { points, wrong, others };
}

const isOfClass = (launch, setup) =>
  same(changed(setup, { "launch.spin": launch.problem.launch.spin }), launch);

/** Spins for so many groups, from one to another. */
export function spinsOf(groups, low, high) {
  const step = groups > 1 ? (high - low) / (groups - 1) : 0;
  return Array.from({ length: groups }, (_, k) => Number((low + k * step).toPrecision(4)));
}
