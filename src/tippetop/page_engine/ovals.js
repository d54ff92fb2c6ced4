// Smooth curves that are no circles, which the page does not read: the least polynomial is a linear programme.
import { Described, InvalidInput } from "./mechanics.js";

export function polynomial_support() {
  const part = new Described("a body that stands on a smooth curve that is no circle");
  const hint = "read it by the command tippetop body FILE --toml, and drop here what it prints";
  throw new InvalidInput("profile", part, "a body of arcs and lines", "", hint);
}
