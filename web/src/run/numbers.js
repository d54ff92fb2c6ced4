// A run as a table of numbers: the sampled variables of the catalogue over time, as Python's export/tables.py writes
// them; those that follow from them are left out.

import { simulate } from "engine";
import { CATALOGUE } from "engine-tables";

// Near the vertical the tilt and its rate lose digits: what is kept is followed more exactly than what is shown.
const TOLERANCE = 1e-12;

const PARTS = { 1: [""], 3: ["_x", "_y", "_z"], 4: ["_w", "_x", "_y", "_z"] };

// `point` is the decimal sign: with a comma, cells stand between semicolons, as spreadsheets take it.
export function numbers({ problem, duration, pushes, point = "." }) {
  const track = simulate(problem, { duration, pushes, tolerance: TOLERANCE }).track();
  const between = point === "," ? ";" : ",";
  const columns = [["time (s)", (i) => track.time[i]]];
  for (const [name, { units, width }] of Object.entries(CATALOGUE.sampled)) {
    const unit = units && units !== "1" ? ` (${units})` : "";
    PARTS[width].forEach((part, k) => {
      columns.push([`${name}${part}${unit}`, (i) => track[name][width * i + k]]);
    });
  }
  columns.push(["mode", (i) => track.mode[i]]);
  const rows = Array.from(track.time, (_, i) =>
    columns.map(([, value]) => cellOf(value(i), point)).join(between),
  );
  return { csv: `${[columns.map(([name]) => name).join(between), ...rows].join("\n")}\n` };
}

function cellOf(value, point) {
  if (Number.isNaN(value)) return "";
  return point === "." ? value : String(value).replace(".", point);
}
