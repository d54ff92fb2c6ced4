// What Python makes of values and texts in words.

/** A string as Python writes it in code, with its choice of quotes. */
function quoted(text) {
  const quote = text.includes("'") && !text.includes('"') ? '"' : "'";
  const shown = Array.from(text, (letter) => {
    if (letter === quote || letter === "\\") return `\\${letter}`;
    if (letter in ESCAPES) return ESCAPES[letter];
    return isprintable(letter) ? letter : escaped(letter.codePointAt(0));
  });
  return quote + shown.join("") + quote;
}
const ESCAPES = { "\n": "\\n", "\r": "\\r", "\t": "\\t" };

function escaped(code) {
  const digits = code.toString(16);
  if (code < 0x100) return `\\x${digits.padStart(2, "0")}`;
  if (code < 0x10000) return `\\u${digits.padStart(4, "0")}`;
  return `\\U${digits.padStart(8, "0")}`;
}

/** Strings, numbers, truth values and None as Python's `repr`; whole numbers are taken for integers. */
export function repr(a) {
  if (typeof a === "string") return quoted(a);
  if (typeof a === "number") return Object.is(a, -0) ? "-0.0" : typed(a, WHOLE);
  if (typeof a === "boolean") return a ? "True" : "False";
  if (a === null) return "None";
  throw new TypeError("only strings, numbers and truth values are written as text");
}
const WHOLE = 2 ** 53;

export const join = (between, all) => [...all].join(between);
export const isprintable = (text) => !/[\p{C}\p{Zl}\p{Zp}]|(?! )\p{Zs}/u.test(text);
export const removeprefix = (text, part) =>
  text.startsWith(part) ? text.slice(part.length) : text;
/** A number as it is typed, with powers of ten from some size on. */
export function typed(value, most = 1e16) {
  if (!Number.isFinite(value)) return String(value).toLowerCase().replace("inity", "");
  const size = Math.abs(value);
  const plainly = value === 0 || (size >= 1e-4 && size < most);
  return plainly ? String(value) : value.toExponential().replace(/([+-])(\d)$/, "$10$2");
}

/** A number with so many digits, as Python's format `g`: half-way cases go to the even digit. */
export function format(value, how_) {
  if (typeof value !== "number") throw new TypeError("only numbers have a format");
  if (!Number.isFinite(value)) return typed(value);
  const digits = how_.length > 1 ? Number(how_.slice(1, -1)) : 6;
  const sign = value < 0 || Object.is(value, -0) ? "-" : "";
  const [figures, power] = rounded(Math.abs(value), digits);
  if (power >= -4 && power < digits) {
    const text = power < 0 ? "0".repeat(-power) + figures : figures.padEnd(power + 1, "0");
    const whole = Math.max(power, 0) + 1;
    return sign + trimmed(text.slice(0, whole), text.slice(whole));
  }
  const size = String(Math.abs(power)).padStart(2, "0");
  return `${sign}${trimmed(figures[0], figures.slice(1))}e${power < 0 ? "-" : "+"}${size}`;
}

function trimmed(whole, part) {
  const shown = part.replace(/0+$/, "");
  return shown ? `${whole}.${shown}` : whole;
}

/** The first digits of a positive number, or of zero, and the power of ten of the first of them. */
function rounded(size, digits) {
  const split = (count) => {
    const [figures, power] = size.toExponential(count - 1).split("e");
    return [figures.replace(".", ""), Number(power)];
  };
  const [exact, power] = split(Math.min(digits + 40, 101));
  const isHalfWay = /^50*$/.test(exact.slice(digits)) && Number(exact[digits - 1]) % 2 === 0;
  return isHalfWay ? [exact.slice(0, digits), power] : split(digits);
}

const table = (value) =>
  `{${Object.entries(value)
    .map(([name, inner]) => `${repr(name)}: ${short(inner)}`)
    .join(", ")}}`;

/** A value as it would be typed. */
function written(value) {
  if (Array.isArray(value)) return `[${value.map(short).join(", ")}]`;
  if (typeof value === "number") return typed(value);
  if (value === null) return "None";
  if (typeof value === "object") return value.description ?? table(value);
  if (typeof value === "boolean") return repr(value);
  return /^[0-9+\-.,]/.test(value) && isprintable(value) ? value : repr(value);
}

/** A value in a sentence, as it would be typed. */
export function short(value) {
  const text = written(value);
  return text.length <= 60 ? text : `${text.slice(0, 57)}...`;
}

/** The choices that are most like a word, the best first, as Python's difflib ranks them. */
export function closest(word, choices, count = 1, cutoff = 0.6) {
  return choices
    .map((choice) => [likeness(choice, word), choice])
    .filter(([ratio]) => ratio >= cutoff)
    .sort(([a, one], [b, other]) => b - a || (one < other ? 1 : -1))
    .slice(0, count)
    .map(([, choice]) => choice);
}

const likeness = (a, b) => (a.length + b.length ? (2 * matched(a, b)) / (a.length + b.length) : 1);

// Letters in the longest common block, and in those before and after it.
function matched(a, b) {
  let [length, i, j] = [0, 0, 0];
  for (let p = 0; p < a.length; p++)
    for (let q = 0; q < b.length; q++) {
      let k = 0;
      while (p + k < a.length && q + k < b.length && a[p + k] === b[q + k]) k++;
      if (k > length) [length, i, j] = [k, p, q];
    }
  if (!length) return 0;
  return (
    length +
    matched(a.slice(0, i), b.slice(0, j)) +
    matched(a.slice(i + length), b.slice(j + length))
  );
}
