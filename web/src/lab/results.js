// Results of a class: what became of launches as short codes, a spin in rad/s and the final tilt in degrees, or as links.

const DEGREES = 180 / Math.PI;
// The name that a result code has in a link.
const RESULT = "result";
const FIRST_PART = /^\s*(-?\d+(?:[.,]\d+)?)\s*[ ;:/→\t]\s*(\d+(?:[.,]\d+)?)\s*°?\s*$/;

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

// The result code that a line is, or that the link in a line carries.
function codeIn(line) {
  const [, query] = /#(\S+)/.exec(line) ?? [];
  return query ? (new URLSearchParams(query).get(RESULT) ?? "") : line;
}

/** Spins and tilts of the codes and links in a text, one a line, and the numbers of the lines that are none. */
export function readResults(text) {
  const points = [];
  const wrong = [];
  text.split("\n").forEach((line, k) => {
    if (!line.trim()) return;
    const [, spin, tilt] = FIRST_PART.exec(codeIn(line)) ?? [];
    const point = [spin, tilt].map((part) => Number(part?.replace(",", ".")));
    if (point.every(Number.isFinite) && point[1] <= 180)
      points.push([Math.abs(point[0]), point[1]]);
    else wrong.push(k + 1);
  });
  return { points, wrong };
}

/** Spins for so many groups, from one to another. */
export function spinsOf(groups, low, high) {
  const step = groups > 1 ? (high - low) / (groups - 1) : 0;
  return Array.from({ length: groups }, (_, k) => Number((low + k * step).toPrecision(4)));
}
