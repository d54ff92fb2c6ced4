// What the page's workers do: runs, their numbers, what a body is good for, and single launches of a map.

import {
  advice,
  doubts,
  fromDrawing,
  fromPoints,
  MISSING,
  pointsOf,
  prospects,
  sampleCount,
  simulate,
  tableKind,
  timeDigits,
  turned,
  weighed,
} from "engine";

import { numbers } from "../run/numbers.js";
import { buffersOf, pack } from "../run/pack.js";
import { bodyOf, possible, SIZES } from "./turning.js";

// How exactly a launch is followed while a slider moves, and how finely it is then sampled; of a map, how exactly.
const QUICK = { tolerance: 1e-7, samples: 320 };
const COARSE = 1e-6;

const JOBS = {
  run: answerRun,
  cell: answerCell,
  body: answerBody,
  brought: answerBrought,
  solid: answerSolid,
  digits: answerDigits,
  advice: answerAdvice,
  numbers,
};

// How far the mass properties of a solid may be from those of the top that is simulated, relative.
const SAME_SOLID = 1e-3;

function answerRun({ id, problem, duration, pushes, quick }) {
  let told = 0;
  const onProgress = (share) => {
    if (performance.now() - told < 60) return;
    told = performance.now();
    postMessage({ id, share });
  };
  const samples = quick ? QUICK.samples : sampleCount(problem, duration);
  const run = simulate(problem, {
    duration,
    pushes,
    onProgress,
    ...(quick && { tolerance: QUICK.tolerance }),
  });
  const track = pack(problem, run, samples);
  track.header.quick = Boolean(quick);
  if (pushes?.length) {
    // What theory says of a launch ends with the first push.
    const prospect = track.header.prospect && { ...track.header.prospect, ends: [] };
    Object.assign(track.header, { pushes, reached: run.pushes.length, prospect });
  }
  return { track };
}

function answerCell({ problem, duration, pushes }) {
  const run = simulate(problem, { duration, pushes, tolerance: COARSE });
  const { final_tilt: tilt, max_tilt_ever: highest, turnover_time: turnsOver } = run.metrics;
  const { fellBack, jumps, status } = run;
  return { tilt, highest, fellBack, flights: jumps.count, turnsOver, status };
}

// How many digits of its times a run has.
function answerDigits({ problem, duration, pushes }) {
  return timeDigits(problem, { duration, pushes });
}

// What a body is good for on the table of a problem; null of one that does not stand on its ball.
function answerBody({ body, problem }) {
  const ahead = prospects(body, problem.gravity, problem.launch.tilt);
  return ahead && { ...ahead, table: tableOf(body, problem) };
}

// How the friction of a table serves a ball that is to turn over, by the theory that predicts launches: it "creeps", as
// that theory needs, "drills" spin away, "sticks", or there is "none".
function tableOf(body, problem) {
  const [ball] = [body.shape].flat();
  const launch = {
    ...problem,
    body: { ...body, shape: ball, profile: null },
    rolling_resistance: 0,
  };
  return tableKind(launch);
}

// What a workpiece, points or a drawing weighs, and the body that it is; or why it cannot be simulated.
function answerBrought({ table, points, paths, fields, whole, problem }) {
  let read = { table, remarks: [] };
  if (points !== undefined) read = fromPoints(pointsOf(points), fields);
  if (paths) read = fromDrawing(paths, fields);
  const answer = { remarks: read.remarks, weight: weighed(read.table) };
  try {
    const body = turned(read.table, whole);
    return { ...answer, body, doubts: doubts({ ...problem, body }) };
  } catch (error) {
    return { ...answer, refusal: plainError(error) };
  }
}

// The density of the uniform solid that is the top which is simulated; null if there is none.
function answerSolid({ body }) {
  if (!body.profile) return null;
  const { mass, center, I1, I3 } = weighed({ profile: body.profile, density: 1 });
  const density = body.mass / mass;
  const size = Math.sqrt(body.I1 / body.mass);
  const differences = [center / size, (density * I1) / body.I1 - 1, (density * I3) / body.I3 - 1];
  return differences.every((one) => Math.abs(one) <= SAME_SOLID) ? density : null;
}

// What to change in a top of sliders, each to the next of its steps that does.
function answerAdvice({ top, reach, gravity, tilt }) {
  const bodyWith = (name, value) => bodyOf(possible({ ...top, [name]: value }));
  const sizes = Object.entries(SIZES).map(([name, [low, high]]) => ({
    name,
    value: top[name],
    low,
    high,
  }));
  return advice(bodyWith, sizes, reach, gravity, tilt).map(({ name, value, spin }) => {
    const [low, , step] = SIZES[name];
    const round = value > top[name] ? Math.ceil : Math.floor;
    return { name, value: low + step * round((value - low) / step), spin };
  });
}

self.onmessage = ({ data }) => {
  const { id, job } = data;
  try {
    const answer = JOBS[job](data);
    postMessage({ id, answer }, answer?.track ? buffersOf(answer.track) : []);
  } catch (error) {
    postMessage({ id, error: plainError(error) });
  }
};

function plainError(error) {
  const { field, value, accepted, fault, hint, message } = error;
  const missing = value === MISSING;
  return { field, missing, value, accepted, fault, hint, message: message ?? String(error) };
}
