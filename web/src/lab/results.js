// Results of a class: what became of launches as short codes, a spin in rad/s and the final tilt in degrees.

const DEGREES = 180 / Math.PI;
const FIRST_PART = /^\s*(-?\d+(?:[.,]\d+)?)\s*[ ;:/→\t]\s*(\d+(?:[.,]\d+)?)\s*°?\s*$/;

/** The code of a run: "155 179.9". */
export function resultCode({ problem, metrics }) {
  const spin = Number(problem.launch.spin.toPrecision(4));
  return `${spin} ${(metrics.final_theta * DEGREES).toFixed(1)}`;
}

/** Spins and tilts of the codes in a text, one a line, and the numbers of the lines that are none. */
export function readResults(text) {
  const points = [];
  const wrong = [];
  text.split("\n").forEach((line, k) => {
    if (!line.trim()) return;
    const [, spin, tilt] = FIRST_PART.exec(line) ?? [];
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
