// Follows the launches that are asked for, one a line of JSON, and writes what came of each, one a line.
import { createInterface } from "node:readline";
import { pathToFileURL } from "node:url";

const { InvalidInput, criticalSpins, doubts, predict, prospects, sampleCount, simulate } =
  await import(pathToFileURL(process.argv[2]));

function followed({ problem, times, ...options }) {
  try {
    const run = simulate(problem, options);
    const track = run.track(times.filter((time) => time <= run.endTime));
    return {
      status: run.status,
      end: run.endTime,
      events: run.events,
      flights: run.flights,
      metrics: run.metrics,
      account: run.account,
      fellBack: run.fellBack,
      track: Object.fromEntries(
        Object.entries(track).map(([name, values]) => [name, Array.from(values)]),
      ),
    };
  } catch (error) {
    if (error instanceof InvalidInput) return { refused: error.message };
    return { broken: `${error.stack}` };
  }
}

// What the theory says of a launch; of what it refuses, the field.
function foreseen({ problem }) {
  const asked = {
    predict: () => predict(problem),
    critical: () => criticalSpins(problem),
    prospects: () => prospects(problem.body),
    doubts: () => doubts(problem),
  };
  const told = (ask) => {
    try {
      return ask();
    } catch (error) {
      if (error instanceof InvalidInput) return { refused: error.field };
      return { broken: `${error.stack}` };
    }
  };
  return Object.fromEntries(Object.entries(asked).map(([name, ask]) => [name, told(ask)]));
}

function answer(asked) {
  if (asked.theory) return foreseen(asked);
  if (asked.samples) return sampleCount(asked.problem, asked.samples);
  return followed(asked);
}

// Numbers that JSON does not know, as Python writes them.
const written = (_, value) => (value === Infinity ? "inf" : value);

for await (const line of createInterface({ input: process.stdin })) {
  const asked = JSON.parse(line);
  console.log(JSON.stringify(answer(asked), written));
}
