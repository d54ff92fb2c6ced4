// Problems as TOML, as `tippetop simulate` reads them.

import { stringify } from "smol-toml";

export function toml(problem) {
  return stringify(withoutGaps(problem), { numbersAsFloat: true });
}

// A copy without fields that are null or left out.
function withoutGaps(value) {
  if (Array.isArray(value)) return value.map(withoutGaps);
  if (value === null || typeof value !== "object") return value;
  const fields = Object.entries(value).filter(([, one]) => one !== null && one !== undefined);
  return Object.fromEntries(fields.map(([name, one]) => [name, withoutGaps(one)]));
}
