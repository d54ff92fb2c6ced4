// Numbers as people type them, in the signs of the page's language, with a unit or without one.

import { decimal } from "./i18n.js";

const TYPED = /^\s*([+\-−]?)([\d.,  ’']*\d[.,]?)((?:e[+\-−]?\d+)?)\s*(.*?)\s*$/i;

/** The number that a text begins with, null if it begins with none, and what comes after it. */
export function typed(text) {
  const [, sign, figures, power, unit] = TYPED.exec(text) ?? [];
  const plain = figures === undefined ? null : plainFigures(figures);
  if (plain === null) return { number: null, unit: text };
  const number = Number(`${sign.replace("−", "-")}${plain}${power.replace("−", "-")}`);
  return { number: Number.isFinite(number) ? number : null, unit };
}

// Figures with a point alone; null where their signs mean nothing. Groups of three are as the language writes them: an
// English 1,000 is a thousand and a German 1.000 too, but 0,125 and 1,5 are less than two in both.
function plainFigures(figures) {
  const point = decimal(".");
  const comma = point === "." ? "," : ".";
  const bare = figures.replaceAll(/(?<=\d)[  ’'](?=\d{3})/g, "");
  const [whole, ...parts] = bare.split(point);
  const isGrouped = new RegExp(`^[1-9]\\d{0,2}(\\${comma}\\d{3})+$`).test(whole);
  if (isGrouped && parts.length < 2) return [whole.replaceAll(comma, ""), ...parts].join(".");
  const other = bare.replace(",", ".");
  return /^(\d+\.?\d*|\.\d+)$/.test(other) ? other : null;
}
