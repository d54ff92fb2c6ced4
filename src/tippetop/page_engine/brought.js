// Bodies from what people bring: workpieces, points, and strokes of drawings, as tippetop.lathe.files reads them.
import { Complex } from "./arrays.js";
import * as m from "./mechanics.js";
import { SCHEMA } from "./tables.js";

const ACCEPTED_ROW = "two or three numbers, with a decimal point and commas between them";
const UNIT_OF_DRAWINGS = "mm";
const TOLERANCE = SCHEMA.Workpiece.fields.tolerance.default;

/**
 * The points in rows of numbers with commas, semicolons, tabs or spaces between them. Between semicolons or tabs a comma
 * is a decimal sign.
 */
export function pointsOf(text) {
  const lines = text.split(/\r\n|\r|\n/).map((line) => line.split("#")[0].trim());
  const between = [";", "\t", ","].find((mark) => lines.some((line) => line.includes(mark)));
  const isPointed = between !== ";" && between !== "\t";
  const rows = lines
    .map((line, k) => [k + 1, (between ? line.split(between) : line.split(/\s+/)).map(bare)])
    .map(([number, cells]) => [number, isPointed ? cells : cells.map(withPoint)])
    .filter(([, cells]) => cells.some(Boolean));
  const isHeading = ([, cells]) => !cells.some((cell) => /^[0-9+\-.]/.test(cell));
  if (rows.length && isHeading(rows[0])) rows.shift();
  return rows.map(([number, cells]) => numbersOf(number, cells));
}

const withPoint = (cell) => cell.replaceAll(",", ".");
const bare = (cell) => cell.replace(/^[ "]+|[ "]+$/g, "");

function numbersOf(number, cells) {
  while (!cells.at(-1)) cells.pop();
  const isNumber = (cell) => /^[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/i.test(cell);
  if (!cells.every(isNumber))
    throw new m.InvalidInput(`row ${number}`, cells.join(","), ACCEPTED_ROW);
  return cells.map(Number);
}

/** A workpiece from points beside the axis, or on both sides of it; what else it has is in fields. */
export function fromPoints(points, fields) {
  const isWhole =
    points.every((point) => point.length === 2) &&
    points.some(([r]) => r < 0) &&
    points.some(([r]) => r > 0);
  if (!isWhole) return { table: { ...fields, profile: points }, remarks: [] };
  const corners = [...points, points[0]].map(([r, z]) => new Complex(r, z));
  const outline = corners
    .slice(1)
    .map((end, k) => [corners[k], end])
    .filter(([one, other]) => one.real !== other.real || one.imag !== other.imag)
    .map(([start, end]) => m.line(start, end));
  return fromSheet([["the line of points", outline]], fields.unit ?? "m", false, fields);
}

/** A workpiece from paths of strokes, of a drawing whose own y counts downwards, in mm or a unit. */
export function fromDrawing(paths, fields) {
  const strokes = paths.map(([name, path]) => [name, path.map(strokeOf)]);
  const unit = fields.unit ?? UNIT_OF_DRAWINGS;
  return fromSheet(strokes, unit, true, { ...fields, unit });
}

function fromSheet(paths, unit, isYDown, fields) {
  const sheet = new m.Sheet(paths, unit, isYDown);
  const tolerance = fields.tolerance ?? TOLERANCE;
  const { profile, cavities, remarks } = m.read_along(sheet, "xy", null, tolerance, "profile");
  const bores = cavities.map((points) => ({ profile: points, density: 0 }));
  const table = { ...fields, profile };
  if (bores.length) table.inserts = [...(fields.inserts ?? []), ...bores];
  return { table, remarks };
}

/** A stroke from plain numbers: the control points of a curve, or the centre and semi-axes of an arc. */
function strokeOf({ points, center, one, other, begin, end }) {
  const place = ([x, y]) => new Complex(x, y);
  if (center) return m.ellipse(place(center), place(one), place(other), begin, end);
  const places = points.map(place);
  return places.length === 2 ? m.line(...places) : m.bezier(places);
}

// The workpieces of tables: to fit a profile takes most of the time.
const pieces = new WeakMap();

function pieceOf(table) {
  if (!pieces.has(table)) pieces.set(table, new m.Workpiece(table));
  return pieces.get(table);
}

/** What a workpiece weighs, and to how few edges its points were fitted, whether it can be simulated or not. */
export function weighed(table) {
  const piece = pieceOf(table);
  const { mass, center, I1, I3 } = piece.mass_properties;
  const { stated, edges } = piece.fit;
  return {
    mass,
    center,
    size: piece.outline.size,
    I1,
    I3,
    stated,
    edges,
    deviation: piece.deviation,
  };
}

/** Return the body that a workpiece makes; with `whole`, incomplete surfaces are accepted. */
export function turned(table, whole = false) {
  const [mass, shapes, I1, I3, profile] = m.turned_fields(pieceOf(table), whole);
  const shape = shapes.length === 1 ? shapes[0] : shapes;
  return new m.Body({ mass, shape, I1, I3, profile }).model_dump();
}
