// What Python makes of values and texts in words.
export const repr = (a) =>
  typeof a === "string"
    ? `'${JSON.stringify(a).slice(1, -1).replaceAll('\\"', '"')}'`
    : Object.is(a, -0)
      ? "-0"
      : String(a);
export const join = (between, all) => [...all].join(between);
export const isprintable = (text) => !/[\p{C}\p{Zl}\p{Zp}]|(?! )\p{Zs}/u.test(text);
export const removeprefix = (text, part) =>
  text.startsWith(part) ? text.slice(part.length) : text;
/** A number as it is typed, with powers of ten from some size on. */
export function typed(value, most = 1e16) {
  if (!Number.isFinite(value)) return String(value).toLowerCase().replace("inity", "");
  const size = Math.abs(value),
    plainly = value === 0 || (size >= 1e-4 && size < most);
  return plainly ? String(value) : value.toExponential().replace(/([+-])(\d)$/, "$10$2");
}
/** The same of so many digits, as the format `g` says. */
export function format(value, how_) {
  const digits = how_.length > 1 ? Number(how_.slice(1, -1)) : 6;
  return typed(Number(value.toPrecision(digits)), 10 ** digits);
}

/** A value in a sentence, as it would be typed. */
export function short(value) {
  const text = Array.isArray(value)
    ? `(${value.map(short).join(", ")})`
    : typeof value === "number"
      ? typed(value)
      : value === null
        ? "None"
        : typeof value === "object"
          ? JSON.stringify(value)
          : repr(value);
  return text.length <= 60 ? text : `${text.slice(0, 57)}...`;
}
