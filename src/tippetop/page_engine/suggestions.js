// Names that were likely meant, as in tippetop.support.suggestions.
import * as m from "./mechanics.js";
import { HINTS_BY_NAME, OTHER_NAMES, PLACES } from "./tables.js";
import { closest } from "./words.js";

const LONGEST = 60;

const last = (name) => name.slice(name.lastIndexOf(".") + 1);
const own = (table, name) => (Object.hasOwn(table, name) ? table[name] : undefined);

/** The refusal of a value for a field that a part does not have. */
export function unknown_field(name, value, fields, kinds = []) {
  let hint = own(HINTS_BY_NAME, name) ?? "";
  if (kinds.length) hint = `it is a field of the kind ${kinds.join(" or ")}`;
  const meant = hint ? "" : likely(name, fields, PLACES);
  if (meant) hint = `did you mean ${meant}?`;
  const fault = "is given for an unknown field";
  return new m.InvalidInput(name, value, `one of ${fields.join(", ")}`, fault, hint);
}

/** The refusal of a word that is not one of the choices, with the one likely meant. */
export function not_one_of(field, value, choices) {
  const word = typeof value === "string" ? value : "";
  const meant = likely(word, choices, {});
  const hint = own(HINTS_BY_NAME, word) ?? (meant ? `did you mean ${meant}?` : "");
  return new m.InvalidInput(field, value, `one of ${choices.join(", ")}`, "", hint);
}

function likely(name, fields, places) {
  if (name.length > LONGEST) return "";
  const word =
    own(OTHER_NAMES, last(name)) ?? own(OTHER_NAMES, last(name).toLowerCase()) ?? last(name);
  const exact = fields.find((field) => last(field) === word);
  if (exact) return exact;
  if (own(places, word)) return places[word];
  const [near] = [...closest(name, fields), ...closest(last(name), fields.map(last))];
  if (near) return fields.find((field) => near === field || near === last(field));
  const [other] = closest(last(name), Object.keys(places));
  return other ? places[other] : "";
}
