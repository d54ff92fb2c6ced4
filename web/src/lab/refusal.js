// What is wrong with a launch, in the page's words.

import { ALL, kindOf, scaleOf } from "./dials.js";
import { isTranslated, part, t, translated } from "./i18n.js";
import { fieldValue } from "./setup.js";
import { digits, shown, unitOf, withUnit } from "./units.js";

// Letters of a value that are quoted.
const MOST_QUOTED = 60;

// The field that is refused, null if it is of no control, and a sentence with the values as the visitor reads them.
export function refusal(error, { units, setup }) {
  const dial = dialOf(error.field);
  if (error.missing || error.message === undefined) return flawed(error, dial, setup);
  if (!dial) return { field: null, sentence: refusedOther(error) };
  const { field } = dial;
  const { name } = part(`quantities.${field}`);
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
  if (gaps.accepted === null || gaps.fault === null)
    return { field, sentence: t("controls.impossible", gaps) };
  const sentence = t(fault ? "controls.refusedFor" : "controls.refused", gaps);
  const note = fault ? advice(error, accepted) : "";
  return { field, sentence: `${sentence}${note && ` (${note})`}.` };
}

/** Why something other than a dial's value is refused, in the page's language throughout. */
export function refusedOther(error) {
  const { field, value, accepted, fault, hint, message } = error;
  if (!isTranslated() || accepted === undefined) return t("controls.refusedOther", { message });
  const shownValue = value?.description ? translated(value.description) : quoted(value);
  const texts = [shownValue, translated(fault || accepted), translated(hint ?? "")];
  const gaps = { name: field || t("controls.thing"), value: texts[0] ?? "–" };
  if (texts.includes(null)) return t("controls.impossible", gaps);
  const kind = fault ? "controls.refusedFor" : "controls.refused";
  const sentence = t(kind, { ...gaps, fault: texts[1], accepted: texts[1] });
  const own = fault && accepted ? translated(accepted) : "";
  const note = texts[2] || (own && t("controls.write", { accepted: own }));
  return t("controls.refusedOther", { message: `${sentence}${note ? ` (${note})` : ""}.` });
}

// What is said of a part or a number that is missing, or is none.
function flawed({ field, missing, value, accepted }, dial, setup) {
  const name = dial ? part(`quantities.${dial.field}`).name : field;
  if (missing) return { field: null, sentence: t("controls.missing", { name }) };
  const text = typeof value === "number" ? digits(value) : quoted(value);
  if (accepted) {
    const sentence = `${t("controls.refused", { name, value: text, accepted })}.`;
    return { field: isShown(dial, setup) ? dial.field : null, sentence };
  }
  return { field: null, sentence: t("controls.impossible", { name, value: text }) };
}

const isShown = (dial, setup) => Boolean(dial) && fieldValue(setup, dial.field) !== undefined;

function quoted(value) {
  const text = typeof value === "string" ? value : JSON.stringify(value);
  return t("controls.quoted", { text: (text ?? "").slice(0, MOST_QUOTED) });
}

// What to write instead of a value that has a fault. The engine's hints give numbers in SI, so that only those about
// the unit of a text hold at a dial.
function advice({ value, hint }, accepted) {
  if (typeof value === "string" && hint) return translated(hint) ?? "";
  return accepted && t("controls.write", { accepted });
}

// The dial of a field, which the engine names with or without its table.
function dialOf(field) {
  if (!field) return null;
  return ALL.find((dial) => dial.field === field || dial.field.endsWith(`.${field}`)) ?? null;
}

function valueText(value, kind, scale, units) {
  if (typeof value !== "number") return quoted(value);
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
