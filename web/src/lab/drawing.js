// Drawings in SVG: every element with an outline, in its place on the sheet, as strokes with y up.

import { SVGPathData } from "svg-pathdata";

// Size of a pixel, mm: a 96th of an inch, as CSS has it; and units of the size of a drawing, mm.
const PIXEL = 25.4 / 96;
const LENGTHS = {
  "": PIXEL,
  px: PIXEL,
  mm: 1,
  cm: 10,
  q: 0.25,
  in: 25.4,
  pt: 25.4 / 72,
  pc: 25.4 / 6,
};

const GROUPS = ["svg", "g", "a", "switch"];
const SHAPES = { path, circle: round, ellipse: round, rect, line, polyline, polygon: polyline };
// What sentences call an element whose name is another thing's.
const CALLED = { line: "simpleline" };
// How deep elements may use one another, and how many there may be with all that are used again.
const DEEPEST = 20;
const MOST_ELEMENTS = 20_000;

/** A text is no drawing: the key of what it needs, and its gaps. */
export class NoDrawing extends Error {
  constructor(key, gaps = {}) {
    super(key);
    Object.assign(this, { key, gaps });
  }
}

/** The paths of a drawing with what sentences call them: in mm of its physical size, or in its own numbers. */
export function readSvg(text, isInOwnNumbers) {
  const content = new DOMParser().parseFromString(text, "image/svg+xml");
  const root = content.documentElement;
  if (content.querySelector("parsererror") || root.localName !== "svg") throw new NoDrawing("root");
  const scale = isInOwnNumbers ? 1 : millimetresOf(root);
  const place = new DOMMatrix([scale, 0, 0, -scale, 0, 0]);
  const shapes = [...shapesIn(root, new DOMMatrix(), 0, { count: 0 })];
  return shapes.flatMap(({ element, matrix }, k) => {
    const kind = element.localName;
    const { id } = element;
    const name = `${CALLED[kind] ?? kind} ${id ? `'${id}'` : `${k + 1} of ${shapes.length}`}`;
    const moved = place.multiply(matrix);
    return pathsOf(element)
      .filter((strokes) => strokes.length)
      .map((strokes) => [name, strokes.map((stroke) => movedBy(moved, stroke))]);
  });
}

function pathsOf(element) {
  try {
    return SHAPES[element.localName](element);
  } catch (error) {
    throw new NoDrawing("element", { name: element.localName, message: error.message });
  }
}

// What a number of a drawing is, mm: of one without a physical size, a pixel.
function millimetresOf(root) {
  const sides = numbersOf(root.getAttribute("viewBox")).slice(2);
  const scales = ["width", "height"]
    .map((name, k) => physical(root.getAttribute(name)) / sides[k])
    .filter((scale) => scale > 0 && Number.isFinite(scale));
  return scales.length ? Math.min(...scales) : PIXEL;
}

// A length, mm; NaN of one that is relative, or none.
function physical(text) {
  const [, number, unit] = /^\s*([-+.\deE]+?)\s*([a-zA-Z]*)\s*$/.exec(text ?? "") ?? [];
  return number === undefined ? NaN : Number(number) * (LENGTHS[unit.toLowerCase()] ?? NaN);
}

// A length of an element, in pixels or a drawing's own numbers.
function lengthOf(element, name, otherwise = 0) {
  const text = element.getAttribute(name);
  if (text === null) return otherwise;
  const length = physical(text) / PIXEL;
  return Number.isFinite(length) ? length : otherwise;
}

const numbersOf = (text) =>
  (text ?? "").match(/[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?/g)?.map(Number) ?? [];

// The shapes that are drawn in an element, with what puts them in their place.
function* shapesIn(element, outer, depth, seen) {
  if (isHidden(element) || depth > DEEPEST) return;
  seen.count += 1;
  if (seen.count > MOST_ELEMENTS) throw new NoDrawing("many", { most: MOST_ELEMENTS });
  const own = element.transform?.baseVal.consolidate()?.matrix;
  const matrix = own ? outer.multiply(DOMMatrix.fromMatrix(own)) : outer;
  const kind = element.localName;
  if (kind in SHAPES) {
    yield { element, matrix };
  } else if (kind === "use") {
    const used = usedBy(element);
    const [x, y] = [lengthOf(element, "x"), lengthOf(element, "y")];
    if (used) yield* shapesIn(used, matrix.translate(x, y), depth + 1, seen);
  } else if (GROUPS.includes(kind) || (kind === "symbol" && depth)) {
    const inner = kind === "svg" && depth ? matrix.multiply(viewport(element)) : matrix;
    for (const child of element.children) yield* shapesIn(child, inner, depth + 1, seen);
  }
}

function isHidden(element) {
  const style = element.getAttribute("style") ?? "";
  return /display\s*:\s*none/.test(style) || element.getAttribute("display") === "none";
}

function usedBy(element) {
  const XLINK = "http://www.w3.org/1999/xlink";
  const name = element.getAttribute("href") ?? element.getAttributeNS(XLINK, "href") ?? "";
  return name.startsWith("#") ? element.ownerDocument.getElementById(name.slice(1)) : null;
}

// What puts the content of a sheet within a sheet in its place.
function viewport(element) {
  const moved = new DOMMatrix().translate(lengthOf(element, "x"), lengthOf(element, "y"));
  const [left, top, width, height] = numbersOf(element.getAttribute("viewBox"));
  if (!(width > 0 && height > 0)) return moved;
  const across = lengthOf(element, "width", width) / width;
  const down = lengthOf(element, "height", height) / height;
  const scale = Math.min(across, down);
  const room = [(across - scale) * width, (down - scale) * height];
  return moved
    .translate(room[0] / 2, room[1] / 2)
    .scale(scale)
    .translate(-left, -top);
}

// ---- strokes: the control points of a curve, or centre, conjugate semi-axes and angles of an arc

function movedBy(matrix, { points, center, one, other, ...angles }) {
  const at = ([x, y]) => [
    matrix.a * x + matrix.c * y + matrix.e,
    matrix.b * x + matrix.d * y + matrix.f,
  ];
  const along = ([x, y]) => [matrix.a * x + matrix.c * y, matrix.b * x + matrix.d * y];
  if (points) return { points: points.map(at) };
  return { center: at(center), one: along(one), other: along(other), ...angles };
}

const quarter = (center, [rx, ry], k) => ({
  center,
  one: [rx, 0],
  other: [0, ry],
  begin: (k * Math.PI) / 2,
  end: ((k + 1) * Math.PI) / 2,
});
const isLong = ([[x, y], [toX, toY]]) => x !== toX || y !== toY;
const segment = (...ends) => (isLong(ends) ? [{ points: ends }] : []);

function round(element) {
  const radius = lengthOf(element, "r");
  const radii = [lengthOf(element, "rx", radius), lengthOf(element, "ry", radius)];
  const center = [lengthOf(element, "cx"), lengthOf(element, "cy")];
  return Math.min(...radii) > 0 ? [[0, 1, 2, 3].map((k) => quarter(center, radii, k))] : [];
}

function rect(element) {
  const [x, y, width, height, rx, ry] = ["x", "y", "width", "height", "rx", "ry"].map((name) =>
    lengthOf(element, name, name === "rx" || name === "ry" ? null : 0),
  );
  if (!(width > 0 && height > 0)) return [];
  const across = Math.min(rx ?? ry ?? 0, width / 2);
  const down = Math.min(ry ?? rx ?? 0, height / 2);
  const [right, bottom] = [x + width, y + height];
  const corner = (cx, cy, k) => (across && down ? [quarter([cx, cy], [across, down], k)] : []);
  return [
    [
      ...segment([x + across, y], [right - across, y]),
      ...corner(right - across, y + down, -1),
      ...segment([right, y + down], [right, bottom - down]),
      ...corner(right - across, bottom - down, 0),
      ...segment([right - across, bottom], [x + across, bottom]),
      ...corner(x + across, bottom - down, 1),
      ...segment([x, bottom - down], [x, y + down]),
      ...corner(x + across, y + down, 2),
    ],
  ];
}

function line(element) {
  const end = (k) => [lengthOf(element, `x${k}`), lengthOf(element, `y${k}`)];
  return [segment(end(1), end(2))];
}

function polyline(element) {
  const numbers = numbersOf(element.getAttribute("points"));
  const count = Math.floor(numbers.length / 2);
  const points = Array.from({ length: count }, (_, k) => [numbers[2 * k], numbers[2 * k + 1]]);
  if (element.localName === "polygon" && points.length) points.push(points[0]);
  return [points.slice(1).flatMap((end, k) => segment(points[k], end))];
}

function path(element) {
  const { commands } = new SVGPathData(element.getAttribute("d") ?? "")
    .toAbs()
    .normalizeHVZ()
    .normalizeST();
  const paths = [];
  let at = [0, 0];
  for (const { type, x, y, x1, y1, x2, y2, ...arc } of commands) {
    const end = [x, y];
    const control = [
      [x1, y1],
      [x2, y2],
    ];
    if (type === SVGPathData.MOVE_TO) paths.push([]);
    else if (type === SVGPathData.CURVE_TO) paths.at(-1).push({ points: [at, ...control, end] });
    else if (type === SVGPathData.QUAD_TO) paths.at(-1).push({ points: [at, control[0], end] });
    else if (type === SVGPathData.ARC) paths.at(-1).push(...arcTo(at, end, arc));
    else paths.at(-1).push(...segment(at, end));
    at = end;
  }
  return paths;
}

// An arc by its centre, from its ends, as the implementation notes of SVG have it.
function arcTo(start, end, { rX, rY, xRot, lArcFlag, sweepFlag }) {
  let [rx, ry] = [Math.abs(rX), Math.abs(rY)];
  if (!isLong([start, end])) return [];
  if (!(rx && ry)) return segment(start, end);
  const turn = (xRot * Math.PI) / 180;
  const [cos, sin] = [Math.cos(turn), Math.sin(turn)];
  const half = [(start[0] - end[0]) / 2, (start[1] - end[1]) / 2];
  const u = (cos * half[0] + sin * half[1]) / rx;
  const v = (cos * half[1] - sin * half[0]) / ry;
  const short = Math.max(Math.hypot(u, v), 1);
  [rx, ry] = [rx * short, ry * short];
  const [p, q] = [u / short, v / short];
  const size = p * p + q * q;
  const side = Boolean(lArcFlag) === Boolean(sweepFlag) ? -1 : 1;
  const away = side * Math.sqrt(Math.max(0, 1 - size) / size);
  const [cu, cv] = [away * q, -away * p];
  const one = [rx * cos, rx * sin];
  const other = [-ry * sin, ry * cos];
  const middle = (k) => (start[k] + end[k]) / 2 + cu * one[k] + cv * other[k];
  const begin = Math.atan2(q - cv, p - cu);
  const last = Math.atan2(-q - cv, -p - cu);
  const full = 2 * Math.PI;
  const turned = (((sweepFlag ? last - begin : begin - last) % full) + full) % full;
  const sweep = sweepFlag ? turned : -turned;
  return [{ center: [middle(0), middle(1)], one, other, begin, end: begin + sweep }];
}
