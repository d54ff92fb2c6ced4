// The account of a run in the page's language: a headline, and sentences beside it.

import { decimal, filled, part, t } from "./i18n.js";
import { cleared, digits, shown } from "./units.js";

// Times below the first, s, are written in milliseconds, from the second on in four digits.
const MILLISECONDS = 0.01;
const TENS = 10;
// Distances below it, m, are written in millimetres.
const METRE = 1;
const DEGREE = Math.PI / 180;
// Slips below it, m/s, are written in mm/s.
const SLOW = 0.01;

// What happened and where it ends; beside it what is implausible, how it began and what theory says.
export function tell(track, units) {
  const { account, doubts } = track.header;
  const { digits: known = {} } = track;
  const of = (...parts) => account.filter((clause) => parts.includes(clause.part));
  const headline = of("motion", "end")
    .map((clause) => phrase(clause, units, known[clause.name]))
    .join("; ");
  return {
    headline: headline.slice(0, 1).toUpperCase() + headline.slice(1),
    details: [
      ...doubts.map(doubtInWords),
      ...of("launch", "theory").map(
        (clause) => `${part("account.pronoun")} ${phrase(clause, units, known[clause.name])}.`,
      ),
    ],
  };
}

// A clause, without its subject; `known` is how many digits its time has, undefined for the usual ones.
export function phrase({ name, numbers }, units, known) {
  const gaps = Object.entries(numbers).map(([gap, value]) => [
    gap,
    gap === "time" ? time(value, known) : written(gap, value, units),
  ]);
  const text = part(`account.clauses.${name}`) ?? part(`push.clauses.${name}`);
  return filled(text, Object.fromEntries(gaps));
}

// A number with the unit that the gap of a text asks for.
function written(gap, value, units) {
  switch (gap) {
    case "duration":
      return time(value);
    case "about":
      return `${digits(value, 2)} ${part("account.units.time")}`;
    case "tilt":
    case "highest":
      return shown(units.angle === "deg" ? tenths(value) : value, "angle", units);
    case "spin":
    case "precession":
      return shown(value, "spin", units);
    case "height":
    case "length":
    case "other_length":
      return `${digits(1e3 * value)} ${part("account.units.length")}`;
    case "distance":
      if (value < METRE) return `${digits(1e3 * value, 3)} ${part("account.units.length")}`;
      return `${digits(value, 3)} ${part("account.units.distance")}`;
    case "energy":
      return `${digits(1e6 * value)} ${part("account.units.energy")}`;
    case "speed":
    case "force":
      return `${digits(value, 3)} ${part(`account.units.${gap}`)}`;
  }
  return `${value}`;
}

// An angle rounded to a tenth of a degree, rad.
const tenths = (angle) => Number((angle / DEGREE).toFixed(1)) * DEGREE;

// A time, with so many digits; where it has none, chance decides it.
function time(value, known = value < TENS ? 3 : 4) {
  if (!known) return part("account.chance");
  if (value > 0 && value < MILLISECONDS)
    return `${digits(1e3 * value, known)} ${part("account.units.short")}`;
  return `${digits(value, known)} ${part("account.units.time")}`;
}

/** What happened in a step of the story, as a headline. */
export function happened(step) {
  const steps = part("story.steps");
  return { headline: steps[Math.min(step, steps.length - 1)].happened, details: [] };
}

/** The spin, the slip and the friction at a time of a run. */
export function factsAt(track, time, units) {
  const [across, along] = [0, 1].map((k) => track.value("friction", time, k, 2));
  const slip = cleared(track.value("slip", time));
  return t("player.facts", {
    spin: shown(track.value("spin", time), "spin", units, 3),
    slip: slip < SLOW ? `${digits(1e3 * slip, 2)} mm/s` : `${digits(slip, 2)} m/s`,
    friction: `${digits(1e3 * cleared(Math.hypot(across, along)), 2)} mN`,
  });
}

export function heading({ ends, certain }, units) {
  const texts = ends.map((end) => endInWords(end, units));
  return t(certain ? "controls.heads" : "controls.headsMany", { end: texts.join(" / ") });
}

export function doubtInWords({ kind, gaps }) {
  const texts = Object.entries(gaps).map(([name, text]) => [name, decimal(text)]);
  return t("words.doubt", { doubt: t(`doubts.${kind}`, Object.fromEntries(texts)) });
}

function endInWords({ kind, tilt, spin, precession }, units) {
  return t(`ends.${kind}`, {
    spin: shown(spin, "spin", units),
    tilt: shown(tilt, "angle", units, 3),
    precession: shown(precession, "spin", units),
  });
}
