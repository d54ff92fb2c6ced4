// Follows the launches that are asked for, one a line of JSON, and writes what came of each, one a line.
import { createInterface } from "node:readline";
import { pathToFileURL } from "node:url";

const { InvalidInput, simulate } = await import(pathToFileURL(process.argv[2]));

function followed({ problem, duration, tolerance, times }) {
  try {
    const run = simulate(problem, { duration, tolerance });
    const track = run.track(times.filter((time) => time <= run.endTime));
    return {
      outcome: run.outcome, end: run.endTime, ending: run.ending, events: run.events, metrics: run.metrics,
      track: Object.fromEntries(Object.entries(track).map(([name, values]) => [name, Array.from(values)])),
    };
  } catch (error) {
    if (error instanceof InvalidInput) return { refused: error.message };
    return { broken: `${error.stack}` };
  }
}

for await (const line of createInterface({ input: process.stdin })) {
  console.log(JSON.stringify(followed(JSON.parse(line))));
}
