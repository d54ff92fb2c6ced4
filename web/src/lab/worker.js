// What the page's workers do: runs, their numbers, what a body is good for, and single launches of a map.

import { MISSING, prospects, sampleCount, simulate } from "engine";

import { numbers } from "../run/numbers.js";
import { buffersOf, pack } from "../run/pack.js";

// How exactly a launch is followed while a slider moves, and how finely it is then sampled; of a map, how exactly.
const QUICK = { tolerance: 1e-7, samples: 320 };
const COARSE = 1e-6;

const JOBS = { run: answerRun, cell: answerCell, body: answerBody, numbers };

function answerRun({ id, problem, duration, quick }) {
  let told = 0;
  const onProgress = (share) => {
    if (performance.now() - told < 60) return;
    told = performance.now();
    postMessage({ id, share });
  };
  const samples = quick ? QUICK.samples : sampleCount(problem, duration);
  const run = simulate(problem, {
    duration,
    onProgress,
    ...(quick && { tolerance: QUICK.tolerance }),
  });
  return { track: pack(problem, run, samples) };
}

function answerCell({ problem, duration }) {
  const { metrics, outcome } = simulate(problem, { duration, tolerance: COARSE });
  return {
    tilt: metrics.final_theta,
    flights: metrics.flights,
    turnsOver: metrics.turns_over,
    outcome,
  };
}

function answerBody({ body, gravity, tilt }) {
  return prospects(body, gravity, tilt);
}

self.onmessage = ({ data }) => {
  const { id, job } = data;
  try {
    const answer = JOBS[job](data);
    postMessage({ id, answer }, answer?.track ? buffersOf(answer.track) : []);
  } catch (error) {
    const { field, value, accepted, fault, hint, message } = error;
    postMessage({
      id,
      error: {
        field,
        missing: value === MISSING,
        value,
        accepted,
        fault,
        hint,
        message: message ?? String(error),
      },
    });
  }
};
