// The page refuses smooth curves that are no circles: to fit them takes a solver of linear programmes.
import { Described, InvalidInput } from "./mechanics.js";

export function polynomial_support() {
  const part = new Described("a body that stands on a smooth curve that is no circle");
  const hint = "read it by the command tippetop body FILE --toml, and drop here what it prints";
  throw new InvalidInput("profile", part, "a body of arcs and lines", "", hint);
}
