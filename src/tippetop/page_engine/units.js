// Numbers with units in SI, as in tippetop.support.units: the names of units are pint's, from a table.
import { KINDS, UNIT_NAMES, UNITS } from "./tables.js";
import { closest, format, short } from "./words.js";

const DIGITS = String.raw`(?:\d+\.?\d*|\.\d+)`;
const NUMBER = new RegExp(String.raw`^\s*([+-]?${DIGITS}(?:[eE][+-]?\d+)?)\s*(.*?)\s*$`, "s");
const PLAIN_NUMBER = new RegExp(String.raw`^[+-]?${DIGITS}(?:[eE][+-]?\d+)?$`);
const FACTOR =
  /\s*(?:(\/|per(?![\p{L}_]))|[*·⋅×]?)\s*(\p{L}[\p{L}_]*|°|%)\s*(?:(?:\^|\*\*)\s*)?([+-]?\d+|⁻?[¹²³])?/uy;
const SUPERSCRIPTS = { "¹": "1", "²": "2", "³": "3", "⁻": "-" };
const MOST_POWER = 9;
const LONGEST = 60;
const UNKNOWN_UNIT = "has an unknown unit";
const BASES = {
  m: [1, 0, 0, 0],
  kg: [0, 1, 0, 0],
  s: [0, 0, 1, 0],
  rad: [0, 0, 0, 1],
  N: [1, 1, -2, 0],
  J: [2, 1, -2, 0],
};

const named = new Map();
for (const [si, units] of Object.entries(UNITS))
  for (const [name, [over, under]] of Object.entries(units))
    named.set(name, { over, under, exponents: exponentsOf(si) });

/** Why a text is no number in a unit: the words of an `InvalidInput`. */
export class NoNumber {
  constructor(accepted, fault, hint) {
    Object.assign(this, { accepted, fault, hint });
  }
}

/** A number in an SI unit from a text with a number and a unit; throws `NoNumber` for others. */
export function inSi(value, units) {
  const match = NUMBER.exec(value);
  if (!match?.[2] || !beginsUnit(match[2]))
    throw new NoNumber("a number", "", numberHint(value, units));
  const { over, under } = unitOf(match[2], value, units);
  return (Number(match[1]) * over) / under;
}

function unitOf(text, value, units) {
  const wanted = KINDS[units] ?? {
    name: `a quantity in ${units}`,
    examples: `in ${written(units)}`,
  };
  const factors = factorsOf(text);
  const known = (factors ?? []).map(([name, power]) => [name, namedUnit(name), power]);
  const strange = known.find(([, unit]) => !unit)?.[0];
  const asked = exponentsOf(units);
  const refuse = (fault, hint) => new NoNumber(wanted.name, fault, hint);
  if (!factors?.length || strange !== undefined) {
    const near = closest(strange ?? "", UNIT_NAMES, 3, 0.5).find(
      (name) => (factors ?? []).length > 1 || same(namedUnit(name)?.exponents, asked),
    );
    const likely = near && strange ? `did you mean ${near}? Write` : "write";
    throw refuse(UNKNOWN_UNIT, `${likely} it ${wanted.examples}`);
  }
  const unit = product(known);
  if (same(unit.exponents, asked)) return unit;
  if (same(asked, exponentsOf("rad s-1")) && same(unit.exponents, exponentsOf("s-1"))) {
    const number = unit.over === unit.under ? ` ${NUMBER.exec(value)[1]} ` : " it in ";
    const [first, second] = number === " it in " ? [number, " in "] : [number, number];
    const hint = `write${first}rev/s for turns, or${second}rad/s`;
    throw refuse("is a frequency, not an angular velocity", hint);
  }
  const kind = Object.entries(KINDS).find(([si]) => same(exponentsOf(si), unit.exponents));
  const fault = `is ${kind ? kind[1].name : "another quantity"}, not ${wanted.name}`;
  throw refuse(fault, `write it ${wanted.examples}`);
}

function factorsOf(text) {
  const product = text.replace(/^1\s*(?=\/)/, "");
  const found = [];
  FACTOR.lastIndex = 0;
  while (FACTOR.lastIndex < product.length) {
    const match = FACTOR.exec(product);
    if (!match) return null;
    const power = (match[3] ?? "1").replace(/[¹²³⁻]/g, (mark) => SUPERSCRIPTS[mark]);
    if (Math.abs(power) > MOST_POWER) return null;
    found.push([match[2], (match[1] ? -1 : 1) * Number(power)]);
  }
  return found;
}

function product(factors) {
  let [over, under] = [1, 1];
  const exponents = [0, 0, 0, 0];
  for (const [, unit, power] of factors) {
    for (let k = 0; k < Math.abs(power); k++) {
      over *= power > 0 ? unit.over : unit.under;
      under *= power > 0 ? unit.under : unit.over;
    }
    unit.exponents.forEach((own, place) => {
      exponents[place] += power * own;
    });
  }
  return { over, under, exponents };
}

function exponentsOf(units) {
  const found = [0, 0, 0, 0];
  for (const [name, power] of factorsOf(units) ?? []) {
    BASES[name].forEach((own, place) => {
      found[place] += power * own;
    });
  }
  return found;
}

const namedUnit = (name) => named.get(name);
const same = (one, other) => Boolean(one && other) && one.every((power, k) => power === other[k]);

/** An SI unit as people write it: "rad/s" for "rad s-1". */
export function written(units) {
  const factors = factorsOf(units) ?? [];
  const one = ([name, power]) => name + (Math.abs(power) > 1 ? `^${Math.abs(power)}` : "");
  const over = factors.filter(([, power]) => power > 0).map(one);
  return [over.join(" ") || "1", ...factors.filter(([, power]) => power <= 0).map(one)].join("/");
}

function beginsUnit(text) {
  if (/^1\s*\//.test(text)) return true;
  return !/^[0-9,.'_:]|^\/\s*\d|^[*·]?\s*(pi|π)(?![\p{L}_])/u.test(text);
}

/** What to write instead of a text that is no number; "" where nobody knows. */
export function numberHint(value, units = "") {
  const text = value.trim();
  if (text.length > LONGEST) return "";
  const pure = units === "" || units === "1";
  if (PLAIN_NUMBER.test(text))
    return `write ${text} without quotes${pure ? "" : `, or with its unit, "${text} ${written(units)}"`}`;
  let match = /^([+-]?)(\d[\d.,' _]*)(?<! )(.*)$/.exec(text);
  if (match) {
    const [, sign, number, rest] = match;
    let plain = number.replace(/[' _]/g, "").replace(/[.,]$/, "");
    if (/^[1-9]\d{0,2},\d{3}$/.test(plain)) {
      const [whole, point] = [plain.replace(",", ""), plain.replace(",", ".")];
      return `write ${sign}${point}${rest}, or ${sign}${whole}${rest} if thousands are meant`;
    }
    if (plain.split(",").length === 2 && plain.lastIndexOf(",") > plain.lastIndexOf("."))
      plain = plain.replaceAll(".", "").replace(",", ".");
    plain = plain.replaceAll(",", "");
    if (number !== plain && new RegExp(`^${DIGITS}$`).test(plain))
      return `write ${sign}${plain}${rest}`;
  }
  match = new RegExp(String.raw`^([+-]?)(${DIGITS})\s*/\s*(${DIGITS})(.*)$`).exec(text);
  if (match && Number(match[3]))
    return `write ${match[1]}${format(Number(match[2]) / Number(match[3]), ".7g")}${match[4]}`;
  match = new RegExp(
    String.raw`^([+-]?)(${DIGITS})?\s*\*?\s*(?:pi|π)\s*(?:/\s*(${DIGITS}))?$`,
  ).exec(text);
  if (match) {
    const number = (Number(match[2] ?? 1) * Math.PI) / (Number(match[3] ?? 1) || 1);
    return `write ${match[1]}${format(number, ".7g")}`;
  }
  return pure ? "" : `write a number in ${written(units)}, or with its unit`;
}

/** How an angle in degrees is written, for one that is too large in radians. */
export function degreesHint(value, accepted) {
  if (!(accepted?.endsWith("at most pi") && value > Math.PI && value <= 180)) return "";
  const degrees = short(value);
  return `for ${degrees} degrees write ${format((value * Math.PI) / 180, ".4g")}, or "${degrees} deg"`;
}
