// What the toy of a body looks like: of a tippe top that is known as a sphere as Python describes it, of any
// other body its own profile where it fits its surfaces, or their hull, as in figures/meridian.py.

import { extent, outline, ownOutline } from "engine";

import looks from "../generated/looks.json";
import { edge } from "./arc.js";

const { band: BAND } = looks.meridian;

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
  const lines = whole.map((line) => line.map(([r, z]) => [r / size, z / size]));
  const belts = lines.length === 1 ? withBand(lines[0]) : lines;
  return belts.map((profile, k) => ({
    name: `belt ${k}`,
    profile,
    colours: k % 2 ? looks.band : looks.bowl,
    opacity: 1,
  }));
}

// A profile in three parts, of which the middle one is a narrow band.
function withBand(profile) {
  const middle = profile.length >> 1;
  return [
    profile.slice(0, middle - BAND + 1),
    profile.slice(middle - BAND, middle + BAND + 1),
    profile.slice(middle + BAND),
  ];
}

// Whether a body is known to be an eccentric sphere, and nothing else of it.
function isBall({ shape }, profile) {
  return shape.kind === "eccentric_sphere" && !profile;
}

// The profile that a body has, in smooth lines from below; null if it has none, or not this shape.
function ownProfile(body) {
  const { profile } = body;
  if (!profile) return null;
  const pairs = profile.slice(1).map((point, k) => [profile[k], point]);
  const edges = pairs
    .filter(([before, point]) => before[0] || point[0] || point[2])
    .map((pair) => edge(...pair));
  const points = edges.flat();
  let area = 0;
  points.forEach(([r, z], k) => {
    const [next, up] = points[(k + 1) % points.length];
    area += r * up - next * z;
  });
  const isClockwise = area < 0;
  if (!isClockwise) return ownOutline(body, edges);
  return ownOutline(
    body,
    edges.reverse().map((line) => line.reverse()),
  );
}
