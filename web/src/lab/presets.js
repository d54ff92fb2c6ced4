// Launches to start from, by what happens in them; and tables, by what they are made of.

import { PRESETS as PACKAGED } from "engine-tables";

import { changed, FIRST } from "./setup.js";

const { bodies, problems } = PACKAGED;
const DRILL = { kind: "contensou", mu: 0.3, patch_radius: 3e-4, pressure: "hertz" };

// Where the report's figures stand beside what this package makes of them.
const REPRODUCTION = "https://tippetop.github.io/tippetop/report/index.html#";

// Key of its name and source, what it changes, and which figure shows it.
export const PRESETS = [
  ["turns", {}, "fig04"],
  ["half", { "launch.spin": 50 }, "fig05"],
  ["slow", { "launch.spin": 20 }],
  ["jumps", { "launch.spin": 175 }, "fig09"],
  ["much", { "friction.mu": 100 }, "fig08"],
  ["none", { "friction.mu": 0 }],
  ["dry", { friction: { kind: "coulomb", mu: 0.3 } }],
  ["drill", { friction: DRILL, "launch.spin": 100, duration: 6 }],
  ["stem", { body: bodies["report-stem"], duration: 10 }],
  ["thin", { body: bodies["report-thin-stem"], duration: 10 }],
  ["wooden", { body: bodies.wooden, friction: DRILL, duration: 10 }],
  ["leine", problems["leine-glocker"]],
].map(([key, changes, figure]) => ({
  key,
  figure: figure && REPRODUCTION + figure,
  setup: changed(FIRST, changes),
}));

export function preset(key) {
  return PRESETS.find((one) => one.key === key).setup;
}

export const TABLES = {
  glass: { kind: "contensou", mu: 0.2, patch_radius: 1e-4, pressure: "hertz" },
  wood: { kind: "contensou", mu: 0.3, patch_radius: 3e-4, pressure: "hertz" },
  felt: { kind: "contensou", mu: 0.5, patch_radius: 2e-3, pressure: "hertz" },
  oil: { kind: "viscous", mu: 0.3 },
};
