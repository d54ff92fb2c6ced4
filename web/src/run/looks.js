// What the toy of a body looks like: of a tippe top that is known as a sphere as Python describes it, of any
// other body its own profile where it fits its surfaces, or their hull, as in figures/meridian.py.

import { lowestSurface } from "engine";

import looks from "../generated/looks.json";
import { edge } from "./arc.js";

const { smooth: SMOOTH, fits: FITS, tilts: TILTS, outline: OUTLINE, pole: POLE, band: BAND } = looks.meridian;

export const SCENES = looks.scenes;

// The length by which the toy is measured when it is drawn, m.
export function sizeOf(body) {
  const profile = ownProfile(body);
  return isBall(body, profile) ? body.shape.radius : extent(profile ?? outline(body));
}

export function toyParts(body) {
  const { shape } = body;
  const profile = ownProfile(body);
  if (isBall(body, profile)) {
    const lift = ([r, z]) => [r, z + shape.eccentricity];
    return looks.tippe_top.map((part) => ({ ...part, profile: part.profile.map(lift) }));
  }
  const whole = profile ?? outline(body);
  const size = extent(whole);
  let pieces = whole.map((piece) => piece.map(([r, z]) => [r / size, z / size]));
  if (pieces.length === 1) {
    const [one] = pieces;
    const middle = one.length >> 1;
    pieces = [one.slice(0, middle - BAND + 1), one.slice(middle - BAND, middle + BAND + 1), one.slice(middle + BAND)];
  }
  return pieces.map((profile, k) => ({
    name: `belt ${k}`, profile, colours: k % 2 ? looks.band : looks.bowl, opacity: 1,
  }));
}

// Whether a body is known to be an eccentric sphere, and nothing else of it.
function isBall({ shape }, profile) {
  return shape.kind === "eccentric_sphere" && !profile;
}

function extent(pieces) {
  const points = pieces.flat();
  const heights = points.map(([, z]) => z);
  const across = Math.max(...points.map(([r]) => r));
  return Math.max(across, (Math.max(...heights) - Math.min(...heights)) / 2);
}

// The profile that a body has, in smooth pieces from below; null if it has none, or not this shape.
function ownProfile(body) {
  const { profile } = body;
  if (!profile) return null;
  const pieces = smoothPieces(profile);
  const points = pieces.flat();
  const lowest = lowestSurface(body);
  const size = extent(pieces);
  for (let k = 0; k < TILTS; k++) {
    const tilt = (Math.PI * k) / (TILTS - 1);
    const [s, c] = [Math.sin(tilt), Math.cos(tilt)];
    const reach = Math.max(...points.map(([r, z]) => r * s - z * c));
    if (Math.abs(reach - lowest(c).height(c)) > FITS * size) return null;
  }
  return pieces;
}

function smoothPieces(profile) {
  let pieces = [];
  for (let k = 1; k < profile.length; k++) {
    const [before, point] = [profile[k - 1], profile[k]];
    if (!before[0] && !point[0] && !point[2]) continue;
    const piece = edge(before, point);
    if (pieces.length && turn(pieces.at(-1), piece) < SMOOTH) pieces.at(-1).push(...piece.slice(1));
    else pieces.push(piece);
  }
  let area = 0;
  const points = pieces.flat();
  points.forEach(([r, z], k) => {
    const [next, up] = points[(k + 1) % points.length];
    area += r * up - next * z;
  });
  if (area < 0) pieces = pieces.reverse().map((piece) => piece.reverse());
  return pieces;
}

// The angle between the end of a piece and the beginning of the next, rad.
function turn(before, after) {
  const [[a, b], [c, d]] = before.slice(-2);
  const [[e, f], [g, h]] = after;
  const [x, y, u, v] = [c - a, d - b, g - e, h - f];
  return Math.abs(Math.atan2(x * v - y * u, x * u + y * v));
}

// The outline of a body from below: points (distance from the axis, height above the centre of mass), m, in
// smooth arcs and the straight lines between them.
export function outline(body) {
  const lowest = lowestSurface(body);
  const arcs = [];
  let last = null;
  for (let k = 0; k < OUTLINE; k++) {
    const tilt = Math.min(Math.max((Math.PI * k) / (OUTLINE - 1), POLE), Math.PI - POLE);
    const c = Math.cos(tilt);
    const surface = lowest(c);
    const slope = surface.slope(c);
    if (surface.active !== last) arcs.push([]);
    last = surface.active;
    const across = surface.height(c) - c * slope;
    const radius = Math.sin(tilt) * across;
    const point = [Math.abs(radius) < 1e-3 * Math.abs(across) ? 0 : radius, -slope - c * across];
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
