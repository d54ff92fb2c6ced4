// Files that people bring: problems and workpieces in TOML, points of a profile, drawings in SVG.

import { parse } from "smol-toml";

import { NoDrawing, readSvg } from "./drawing.js";

// How the names of files end that the command reads and the page does not.
const FOR_THE_COMMAND = ["stl", "dxf"];
// Longer than any profile of 100,000 points.
const LONGEST = 8_000_000;
const MOST_POINTS = 20_000;
// Letters of a line that are quoted.
const MOST_QUOTED = 40;

/** A file cannot be read here: the key of the sentence that says why, and its gaps. */
export class Unreadable extends Error {
  constructor(key, gaps = {}) {
    super(key);
    Object.assign(this, { key, gaps });
  }
}

/** What a text holds: a problem, a body, a workpiece, points or the paths of a drawing. */
export function contentOf(name, text) {
  const ending = name.toLowerCase().split(".").at(-1);
  if (FOR_THE_COMMAND.includes(ending)) throw new Unreadable("command", { name });
  if (text.length > LONGEST) throw new Unreadable("long", { name });
  if (ending === "svg" || /^\s*(<\?xml|<!--|<!DOCTYPE|<svg)/.test(text)) return { svg: text };
  if (ending === "toml" || (ending !== "csv" && /^\s*[\w.]+\s*=|^\s*\[/m.test(text)))
    return ofTable(tableOf(name, text));
  return { points: requireFew(name, text) };
}

// A text of points, unless there are more than are fitted here while one waits.
function requireFew(name, text) {
  const count = text.split("\n").filter((line) => line.trim()).length;
  if (count > MOST_POINTS) {
    const every = Math.ceil(count / MOST_POINTS);
    throw new Unreadable("points", { name, count, most: MOST_POINTS, every });
  }
  return text;
}

function tableOf(name, text) {
  try {
    return parse(text);
  } catch (error) {
    const line = error.line ?? 1;
    const words = (text.split(/\r?\n/)[line - 1] ?? "").trim().slice(0, MOST_QUOTED);
    throw new Unreadable("toml", { name, line, text: words });
  }
}

function ofTable(table) {
  if (table.body || table.launch || table.friction) return { problem: table };
  if (typeof table.profile === "string") throw new Unreadable("beside", { name: table.profile });
  if (table.shape) return { body: table };
  return { workpiece: table };
}

/** What the engine is asked of a workpiece, points or a drawing, with the visitor's material and unit. */
export function jobFor({ content, density, unit, whole }) {
  const fields = { density, ...(unit && { unit }) };
  if (content.workpiece) {
    const table = unit ? { ...content.workpiece, unit } : content.workpiece;
    return { table: { density, ...table }, whole };
  }
  if (content.points !== undefined) return { points: content.points, fields, whole };
  try {
    return { paths: readSvg(content.svg, Boolean(unit)), fields, whole };
  } catch (error) {
    if (error instanceof NoDrawing) throw new Unreadable(`svg.${error.key}`, error.gaps);
    throw error;
  }
}
