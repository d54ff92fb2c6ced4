// Numbers as a visitor reads them: SI inside, the chosen units outside.

import { decimal, t } from "./i18n.js";

const DEGREE = Math.PI / 180;
// Below this values are zero but for rounding, in SI or relative.
const ROUNDING = 1e-12;

const SPINS = { "rad/s": 1, "turns/s": 2 * Math.PI, rpm: (2 * Math.PI) / 60 };
const ANGLES = { rad: 1, deg: DEGREE };

export const CHOICES = { spin: Object.keys(SPINS), angle: Object.keys(ANGLES) };
/** What is plotted over time, with the kinds of its units. */
export const QUANTITIES = {
  tilt: "angle",
  spin: "spin",
  precession: "spin",
  slip: "m/s",
  energy: "mJ",
  normal_force: "N",
  jellett_change: "",
  height: "mm",
};
/** What may be an axis of a graph. */
export const AXES = ["time", ...Object.keys(QUANTITIES)];

export const FIRST = { spin: "rad/s", angle: "deg" };

// The unit in which a quantity of a kind is shown, and its size in SI.
export function unitOf(kind, units) {
  if (kind === "spin") return { name: t(`units.${units.spin}`), size: SPINS[units.spin] };
  if (kind === "angle")
    return { name: units.angle === "deg" ? "°" : "rad", size: ANGLES[units.angle] };
  if (kind === "mm") return { name: "mm", size: 1e-3 };
  if (kind === "gram") return { name: "g", size: 1e-3 };
  if (kind === "µN m s") return { name: "µN m s", size: 1e-6 };
  if (kind === "mJ") return { name: "mJ", size: 1e-3 };
  return { name: kind ?? "", size: 1 };
}

// A number to read: so many digits, a true minus sign.
export function digits(value, count = 4) {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  const text =
    size < 1e-3 || size >= 1e5
      ? value.toExponential(Math.max(count - 2, 0))
      : `${+value.toPrecision(count)}`;
  return decimal(text.replaceAll("-", "−"));
}

export function shown(value, kind, units, count = 4) {
  const unit = unitOf(kind, units);
  return withUnit(digits(cleared(value) / unit.size, count), unit);
}

/** A value, or zero where it is zero but for the rounding of values of some size, in SI. */
export function cleared(value, size = 1) {
  return Math.abs(value) < ROUNDING * Math.min(size, 1) ? 0 : value;
}

export function withUnit(text, { name }) {
  if (name === "°") return `${text}°`;
  return name ? `${text} ${name}` : text;
}

// The least of 1, 2, 5 or 10 times a power of ten that is not below a step.
export function roundStep(step) {
  const power = 10 ** Math.floor(Math.log10(step));
  return power * [1, 2, 5, 10].find((one) => one * power >= step * (1 - 1e-9));
}
