// Compare a program with the reference suite: run `node --test test_suite.mjs` in this folder.
//
// It needs a function `simulate(problem)` in simulate.mjs, or in the file that SIMULATE names;
// README.md says what it takes and returns. TOLERANCE is relative, 1e-3 unless set.

import assert from "node:assert/strict";
import { existsSync, readdirSync, readFileSync } from "node:fs";
import path from "node:path";
import test from "node:test";
import { fileURLToPath, pathToFileURL } from "node:url";

const folder = path.dirname(fileURLToPath(import.meta.url));
const tolerance = Number(process.env.TOLERANCE ?? "1e-3");
const file = path.resolve(process.env.SIMULATE ?? path.join(folder, "simulate.mjs"));
if (!existsSync(file)) {
  throw new Error(`there is no ${file}: write it, or name your file by SIMULATE`);
}
const { simulate } = await import(pathToFileURL(file));
const vectors = ["axis", "angular_velocity", "velocity"];

/** Return the number that is farthest off at some instants, and by how much of what is allowed. */
function farthest(reference, states, instants) {
  let worst = { error: 0, text: "" };
  for (const kind of [...vectors, "height"]) {
    const isVector = vectors.includes(kind);
    const columns = isVector ? ["x", "y", "z"].map((letter) => `${kind}_${letter}`) : [kind];
    const values = columns.flatMap((column) => reference.states[column].values);
    const largest = Math.max(...values.map(Math.abs)) || 1;
    for (const k of instants) {
      columns.forEach((column, place) => {
        const value = isVector ? states[k][kind][place] : states[k][kind];
        const exact = reference.states[column].values[k];
        const bound = tolerance * largest + reference.states[column].agreement[k];
        const error = Math.abs(value - exact) / bound;
        if (!(error <= worst.error)) {
          const text = `${column} at ${reference.time[k]} s: ${value}, not ${exact} +- ${bound}`;
          worst = { error, text };
        }
      });
    }
  }
  return worst;
}

for (const name of readdirSync(folder).sort()) {
  if (!name.endsWith(".json")) continue;
  const reference = JSON.parse(readFileSync(path.join(folder, name), "utf8"));
  if (reference.case === undefined) continue;
  test(reference.case, async (suite) => {
    const problem = { ...reference.problem, times: reference.time, start: reference.start };
    const states = await simulate(problem);
    if (states === null || states === undefined) {
      suite.skip("the program cannot state this problem");
      return;
    }
    const every = reference.time.map((_, k) => k);
    for (const [title, instants] of [
      ["the state at the judged instant", [reference.judged]],
      ["all states", every],
    ]) {
      await suite.test(title, () => {
        const worst = farthest(reference, states, instants);
        assert.ok(worst.error <= 1, worst.text);
      });
    }
  });
}
