// What a printer makes of a top: its profile turned into a closed surface, in millimetres, as export/solid.py does.

import { edge } from "../run/arc.js";

// Facets around the axis, and around a circle of the profile.
const FACETS = 180;
const MM = 1e3;
// Bytes of a binary STL before its triangles, and of each of them.
const HEADER = 84;
const RECORD = 50;

// The body as binary STL.
export function stl(body) {
  const triangles = turned(line(body), FACETS);
  const view = new DataView(new ArrayBuffer(HEADER + RECORD * triangles.length));
  view.setUint32(80, triangles.length, true);
  triangles.forEach((corners, k) => {
    writeTriangle(view, HEADER + RECORD * k, corners);
  });
  return view.buffer;
}

function writeTriangle(view, offset, [a, b, c]) {
  const normal = unit(cross(minus(b, a), minus(c, a)));
  const corners = [a, b, c].flat().map((value) => MM * value);
  [...normal, ...corners].forEach((value, i) => {
    view.setFloat32(offset + 4 * i, value, true);
  });
}

// Points of a body from below, m: of its profile, or else of what is drawn of it.
function line({ profile, parts, size }) {
  if (!profile) {
    const opaque = parts.filter(({ opacity }) => opacity === 1);
    return chained(opaque).map(([r, z]) => [Math.max(r, 0) * size, z * size]);
  }
  const edges = profile.slice(1).map((point, k) => edge(profile[k], point, (2 * Math.PI) / FACETS));
  return edges.flatMap((points, k) => (k ? points.slice(1) : points));
}

// Parts in the order in which one goes on where another ends, from the lowest point on the axis.
function chained(parts) {
  const left = parts.map(({ profile }) => profile);
  const begins = left.filter(([[r]]) => r === 0).sort(([[, a]], [[, b]]) => a - b);
  const points = [begins[0][0]];
  for (;;) {
    const [r, z] = points.at(-1);
    const next = left.findIndex(([[x, y]]) => Math.hypot(x - r, y - z) < 1e-9);
    if (next < 0) return points;
    points.push(...left.splice(next, 1)[0].slice(1));
  }
}

// Triangles of the surface that points sweep out, from outside anticlockwise; what is on the axis is one corner.
function turned(points, facets) {
  const turns = Array.from({ length: facets }, (_, k) => (2 * Math.PI * k) / facets);
  const rings = points.map(([r, z]) =>
    turns.map((turn) => (r ? [r * Math.cos(turn), r * Math.sin(turn), z] : [0, 0, z])),
  );
  const triangles = [];
  for (let row = 1; row < rings.length; row++) {
    const below = rings[row - 1];
    const above = rings[row];
    for (let k = 0; k < facets; k++) {
      const next = (k + 1) % facets;
      if (points[row - 1][0]) triangles.push([below[k], below[next], above[next]]);
      if (points[row][0]) triangles.push([below[k], above[next], above[k]]);
    }
  }
  return triangles;
}

const minus = (a, b) => a.map((value, k) => value - b[k]);
const cross = ([a, b, c], [d, e, f]) => [b * f - c * e, c * d - a * f, a * e - b * d];

function unit(vector) {
  const length = Math.hypot(...vector) || 1;
  return vector.map((value) => value / length);
}
