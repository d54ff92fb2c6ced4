// What the toy of a body looks like: of a tippe top as Python describes it, of any other body its outline.

import looks from "../generated/looks.json";
import { lowest, surfacesOf } from "./surfaces.js";

const OUTLINE = 97;
const POLE = 1e-4;

export const SCENES = looks.scenes;

// The length by which the toy is measured when it is drawn, m.
export function sizeOf(body) {
  const { shape } = body;
  if (shape.kind === "eccentric_sphere") return shape.radius;
  if (shape.kind === "spheroid") return Math.max(shape.across, shape.along);
  const points = outline(shape).flat();
  const heights = points.map(([, z]) => z);
  const across = Math.max(...points.map(([r]) => r));
  return Math.max(across, (Math.max(...heights) - Math.min(...heights)) / 2);
}

export function toyParts(body) {
  const { shape } = body;
  if (shape.kind === "eccentric_sphere") {
    const lift = ([r, z]) => [r, z + shape.eccentricity];
    return looks.tippe_top.map((part) => ({ ...part, profile: part.profile.map(lift) }));
  }
  const size = sizeOf(body);
  let pieces = outline(shape).map((piece) => piece.map(([r, z]) => [r / size, z / size]));
  if (pieces.length === 1) {
    const [whole] = pieces;
    const middle = whole.length >> 1;
    pieces = [whole.slice(0, middle - 1), whole.slice(middle - 2, middle + 3), whole.slice(middle + 2)];
  }
  return pieces.map((profile, k) => ({
    name: `belt ${k}`, profile, colours: k % 2 ? looks.band : looks.bowl, opacity: 1,
  }));
}

// The outline of a body from below: points (distance from the axis, height above the centre of mass), m, in
// smooth arcs and the straight lines between them.
export function outline(shape) {
  const surfaces = surfacesOf(shape);
  const arcs = [];
  let last = -1;
  for (let k = 0; k < OUTLINE; k++) {
    const tilt = Math.min(Math.max((Math.PI * k) / (OUTLINE - 1), POLE), Math.PI - POLE);
    const c = Math.cos(tilt);
    const number = lowest(surfaces, c);
    if (number !== last) arcs.push([]);
    last = number;
    const { height, slope } = surfaces[number];
    const across = height(c) - c * slope(c);
    const radius = Math.sin(tilt) * across;
    const point = [Math.abs(radius) < 1e-3 * Math.abs(across) ? 0 : radius, -slope(c) - c * across];
    const arc = arcs.at(-1);
    const before = arc.at(-1);
    if (!before || Math.hypot(point[0] - before[0], point[1] - before[1]) > 1e-6) arc.push(point);
  }
  const pieces = [];
  if (arcs[0][0][0]) pieces.push([[0, arcs[0][0][1]], arcs[0][0]]);
  arcs.forEach((arc, k) => {
    if (k) pieces.push([arcs[k - 1].at(-1), arc[0]]);
    if (arc.length > 1) pieces.push(arc);
  });
  const end = arcs.at(-1).at(-1);
  if (end[0]) pieces.push([end, [0, end[1]]]);
  return pieces;
}
