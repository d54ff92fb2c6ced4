// What can be set: each dial's field, the kind of its unit, bounds, step; `log` goes by powers of ten.

const dial = (field, kind, low, high, step, log = false) => ({ field, kind, low, high, step, log });

export const MAIN = [
  dial("launch.spin", "spin", 0, 250, 0.5),
  dial("launch.tilt", "angle", 0, Math.PI, 0.01),
  dial("friction.mu", "", 0.01, 10, 0.01, true),
];
export const LAW = [
  dial("friction.static_mu", "", 0.01, 10, 0.01, true),
  dial("friction.eps", "m/s", 1e-5, 0.1, 0.01, true),
  dial("friction.patch_radius", "mm", 1e-5, 1e-2, 0.01, true),
];
export const TABLE = [
  dial("contact.restitution", "", 0, 1, 0.01),
  dial("gravity", "m/s²", 0.1, 25, 0.1),
  dial("rolling_resistance", "mm", 0, 1e-3, 1e-5),
  dial("table.slope", "angle", 0, 0.3, 1e-3),
  dial("air.axial_linear", "µN m s", 0, 2e-6, 1e-8),
  dial("air.transverse_linear", "µN m s", 0, 2e-6, 1e-8),
  dial("duration", "s", 1, 60, 1),
];
export const TOP = [
  dial("body.shape.eccentricity", "", 0.02, 0.6, 0.01),
  dial("body.I1", "mR²", 0.2, 0.7, 0.005),
  dial("body.I3", "mR²", 0.2, 0.7, 0.005),
  dial("body.mass", "gram", 2e-3, 0.5, 0.01, true),
];
export const START = [
  dial("launch.tilt_rate", "spin", -50, 50, 0.5),
  dial("launch.precession", "spin", -100, 100, 0.5),
  dial("launch.gap", "mm", 0, 0.1, 1e-3),
];
export const ALL = [...MAIN, ...LAW, ...TABLE, ...TOP, ...START];

// The kind of a dial's unit, which friction has where it grows with slip.
export const frictionKind = ({ problem: { friction } }) =>
  friction.kind === "viscous" ? "s/m" : "";
export const kindOf = ({ field, kind }, setup) =>
  field === "friction.mu" ? frictionKind(setup) : kind;

// The size in SI of the number that a dial shows: inertias are in masses times radius squared.
export function scaleOf({ kind }, { problem: { body } }) {
  return kind === "mR²" ? body.mass * (body.shape.radius ?? 1) ** 2 : 1;
}

export const placeOf = (dial, value) =>
  dial.log ? Math.log10(Math.max(value, dial.low / 10)) : value;
export const valueAt = (dial, place) => (dial.log ? Number((10 ** place).toPrecision(3)) : place);
