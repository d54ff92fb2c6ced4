// What is wrong with a launch, in the page's words.

import { ALL, kindOf, scaleOf } from "./dials.js";
import { part, t, translated } from "./i18n.js";
import { digits, shown, unitOf, withUnit } from "./units.js";

// The field that is refused, null if it is of no control, and a sentence with the values as the visitor reads them.
export function refusal(error, { units, setup }) {
  const dial = dialOf(error.field);
  if (!dial) {
    return {
      field: null,
      sentence: t("controls.refusedOther", { message: translated(error.message) }),
    };
  }
  const { field } = dial;
  const { name } = part(`quantities.${field}`);
  if (error.missing) return { field: null, sentence: t("controls.missing", { name }) };
  const scale = scaleOf(dial, setup);
  const kind = kindOf(dial, setup);
  const accepted = acceptedText(error.accepted, kind, scale, units);
  const { value, fault } = error;
  const gaps = {
    name,
    value: valueText(value, kind, scale, units),
    accepted,
    fault: translated(fault ?? ""),
  };
  const sentence = t(fault ? "controls.refusedFor" : "controls.refused", gaps);
  const note = fault ? translated(advice(error, accepted)) : "";
  return { field, sentence: `${sentence}${note && ` (${note})`}.` };
}

// What to write instead of a value that has a fault. The engine's hints give numbers in SI, so that only those about
// the unit of a text hold at a dial.
function advice({ value, hint }, accepted) {
  if (typeof value === "string" && hint) return hint;
  return accepted && `write ${accepted}`;
}

// The dial of a field, which the engine names with or without its table.
function dialOf(field) {
  if (!field) return null;
  return ALL.find((dial) => dial.field === field || dial.field.endsWith(`.${field}`)) ?? null;
}

function valueText(value, kind, scale, units) {
  if (typeof value !== "number") return t("controls.quoted", { text: value });
  return shown(value / scale, kind, units);
}

const BOUND =
  /(at least|greater than|from|at most|less than|to|=) (pi|\d+(?:\.\d+)?(?:e[-+]?\d+)?)(?: [ms])?(?![\w.]| I1)/g;

// Bounds as the engine says them are in SI; here they are told in the unit of the dial, rounded so that the
// visitor may enter them.
function acceptedText(text, kind, scale, units) {
  const unit = unitOf(kind, units);
  const size = scale * unit.size;
  const bounds = text.replace(BOUND, (_, words, number) => {
    const bound = (number === "pi" ? Math.PI : Number(number)) / size;
    const isLower = /least|greater|from/.test(words);
    const rounded = digits(isLower ? roundedUp(bound) : -roundedUp(-bound));
    return `${words} ${bound ? withUnit(rounded, unit) : rounded}`;
  });
  return translated(bounds);
}

// A number of four digits that is no less, but for rounding.
function roundedUp(number) {
  const near = Number(number.toPrecision(4));
  if (near >= number - 1e-12 * Math.abs(number)) return near;
  const lastDigit = 10 ** (Math.floor(Math.log10(Math.abs(number))) - 3);
  return Number((near + lastDigit).toPrecision(4));
}
