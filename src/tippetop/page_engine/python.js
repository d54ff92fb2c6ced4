// Python's semantics in JavaScript, all of it: what the translated modules take for `py`.
export * from "./arrays.js";
export * from "./runtime.js";
export * from "./words.js";
