// The page's words, in one catalogue for each language.

import { DOUBTS } from "engine-tables";

import account from "../../../src/tippetop/results/account_en.json";
import de from "../../texts/de.json";
import english from "../../texts/en.json";

const en = { ...english, account };

// The sentences of doubts are Python's in English.
export const LANGUAGES = { en: { ...en, doubts: DOUBTS }, de };

let words = LANGUAGES.en;

export function speak(language) {
  words = LANGUAGES[language] ?? LANGUAGES.en;
}

export function preferred() {
  return (
    navigator.languages?.map((name) => name.slice(0, 2)).find((name) => name in LANGUAGES) ?? "en"
  );
}

// A part of the catalogue, by its name with dots; fields of a launch have dots in their own names.
export function part(name, found = words) {
  if (typeof found !== "object" || name in found) return found[name];
  const first = Object.keys(found).find((key) => name.startsWith(`${key}.`));
  return first && part(name.slice(first.length + 1), found[first]);
}

// A text of the catalogue with its gaps filled.
export function t(name, gaps = {}) {
  const text = part(name);
  return typeof text === "string" ? filled(text, gaps) : name;
}

/** A text with its gaps filled. */
export function filled(text, gaps) {
  return text.replace(/\{(\w+)\}/g, (whole, gap) => gaps[gap] ?? whole);
}

// The engine's texts of a refusal in another language, each as a whole: what it is in English, with gaps, and in it.
const wholes = new Map();
function wholesOf(catalogue) {
  if (!wholes.has(catalogue)) {
    const letters = (template) => template.replaceAll("{}", "").length;
    const all = Object.entries(catalogue)
      .sort(([one], [other]) => letters(other) - letters(one))
      .map(([template, text]) => [patternOf(template), text]);
    wholes.set(catalogue, all);
  }
  return wholes.get(catalogue);
}

// What fills a gap: numbers, names and lists of these, and no words of a sentence.
const GAP = String.raw`([^\s,]+(?:, [^\s,]+| or [^\s,]+| (?![a-z]{3,})[^\s,]+)*?)`;

function patternOf(template) {
  const parts = template.split("{}").map((part) => part.replace(/[.*+?^${}()|[\]\\]/g, "\\$&"));
  return new RegExp(`^${parts.join(GAP)}$`, "s");
}

/** Whether the page's language is another than the engine's. */
export const isTranslated = () => Boolean(words.refusals);

/** A text of the engine in the page's language; null if that has no words for all of it. */
export function translated(text) {
  const { refusals } = words;
  if (!refusals || !text) return text;
  for (const [pattern, other] of wholesOf(refusals)) {
    const gaps = pattern.exec(text)?.slice(1);
    if (!gaps) continue;
    return other.replaceAll("{}", () => decimalsIn(gaps.shift()));
  }
  return null;
}

// A text with the decimal sign of the language in its numbers.
const decimalsIn = (text) => text.replace(/(\d)\.(\d)/g, `$1${words.player.point}$2`);

// A number with the language's decimal sign.
export function decimal(text) {
  return text.replace(".", words.player.point);
}
