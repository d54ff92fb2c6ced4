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

// A text with its gaps filled.
export function t(name, gaps = {}) {
  const text = part(name);
  if (typeof text !== "string") return name;
  return text.replace(/\{(\w+)\}/g, (whole, gap) => gaps[gap] ?? whole);
}

// What the engine says in English, in the page's language as far as it has words for it.
export function translated(text) {
  return (words.patterns ?? []).reduce(
    (found, [pattern, other]) => found.replace(pattern, other),
    text,
  );
}

// A number with the language's decimal sign.
export function decimal(text) {
  return text.replace(".", words.player.point);
}
