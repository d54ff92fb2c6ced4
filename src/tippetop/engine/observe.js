// What a mode says of its numbers, compiled once a kind.
import { compiled } from "./compile.js";
import { cached, replace } from "./runtime.js";

const known = cached(() => new Map());

/** What makes readings, of so many numbers, of those of a mode and another one; what has no value is no number. */
export function reader(mode, size) {
  const kinds = mode.tops.map((top) => top.kind), numbers = mode.tops.flatMap((top) => top.numbers);
  const codes = known(mode.form, kinds, size), parameters = Float64Array.of(...numbers, 0);
  const values = (of) => (y, p) => {
    let from = 0;
    const [top, other] = kinds.map((kind) => kind.top(p.slice(from, (from += kind.numbers))));
    return [...of(replace(mode, other ? { top, other } : { top }), y, p[from])];
  };
  return (of, count) => {
    if (!codes.has(of)) codes.set(of, compiled(values(of), size, parameters.length, false));
    const code = codes.get(of), out = new Float64Array(count);
    return (y, other = 0) => {
      parameters[numbers.length] = other;
      code(y, parameters, out);
      return out;
    };
  };
}
