// A run of the engine as the player and the plots take it: a header, times and columns, all to be transferred.

import { doubts, lowestSurface } from "engine";

import { foresee } from "./foresee.js";
import { SCENES, sizeOf, toyParts } from "./looks.js";

const PLAIN = ["tilt", "spin", "precession", "energy", "normal_force", "height"];
const WIDE = { orientation: 4, angular_momentum: 3, velocity: 3, axis: 3, contact_force: 3 };

// Of a launch, a problem as plain data, what the engine found.
export function pack(problem, run, samples) {
  const { metrics } = run;
  const end = Math.min(run.duration, run.endTime);
  const sampled = run.track(
    Float64Array.from({ length: samples }, (_, k) =>
      k === samples - 1 ? end : (end * k) / (samples - 1),
    ),
  );
  const count = sampled.time.length;
  const columns = {};
  for (const name of PLAIN) columns[name] = Float32Array.from(sampled[name]);
  for (const [name, width] of Object.entries(WIDE))
    columns[name] = flat(sampled[name], width, count);
  columns.momentum = columns.angular_momentum;
  columns.position = new Float32Array(3 * count);
  columns.friction = new Float32Array(2 * count);
  columns.slip = new Float32Array(count);
  columns.point = contactPath(sampled, problem.body, count);
  columns.slipping = slipOf(sampled, count);
  columns.torque = torqueOf(sampled, columns, count);
  columns.touching = new Float32Array(count);
  columns.mode = new Float32Array(count);
  columns.jellett_change = new Float32Array(count);
  const modes = [...new Set(sampled.mode)];
  const moment = Math.hypot(...columns.momentum.subarray(0, 3)) * sampled.height[0];
  for (let i = 0; i < count; i++) {
    columns.position.set([sampled.x[i], sampled.y[i], sampled.height[i]], 3 * i);
    columns.friction.set(columns.contact_force.subarray(3 * i, 3 * i + 2), 2 * i);
    columns.slip[i] = Math.hypot(sampled.slip_x[i], sampled.slip_y[i]);
    columns.mode[i] = modes.indexOf(sampled.mode[i]);
    columns.touching[i] = sampled.normal_force[i] ? 1 : 0;
    columns.jellett_change[i] = moment ? (sampled.jellett[i] - sampled.jellett[0]) / moment : 0;
  }
  delete columns.angular_momentum;
  delete columns.contact_force;
  delete columns.axis;
  const header = {
    duration: sampled.time[count - 1],
    flights: run.flights.map(({ start, end }) => [start, end]),
    body: { ...problem.body, size: sizeOf(problem.body), parts: toyParts(problem.body) },
    scenes: SCENES,
    problem,
    prospect: foresee(problem),
    doubts: doubts(problem),
    asked: run.duration,
    status: run.status,
    metrics: { ...metrics, jumps: run.jumps.count, max_jump_gap: run.jumps.max_gap },
    account: run.account,
    turnover_time: metrics.turnover_time ?? NaN,
    events: run.events,
    modes,
  };
  return { header, time: Float64Array.from(sampled.time), columns };
}

// A vector at every sample in one block, whether it comes as one or as an array of its components.
function flat(values, width, count) {
  if (values.length === width * count && typeof values[0] === "number")
    return Float32Array.from(values);
  const block = new Float32Array(width * count);
  const by_component = values.length === width && count !== width;
  for (let i = 0; i < count; i++) {
    for (let k = 0; k < width; k++)
      block[width * i + k] = by_component ? values[k][i] : values[i][k];
  }
  return block;
}

function contactPath({ x, y, axis }, body, count) {
  const lowest = lowestSurface(body);
  const path = new Float32Array(2 * count);
  for (let i = 0; i < count; i++) {
    // Where a ring lies flat, its point of contact is anywhere.
    const c = Math.min(Math.max(axis[3 * i + 2], Number.EPSILON - 1), 1 - Number.EPSILON);
    const slope = lowest(c).slope(c);
    path[2 * i] = x[i] - slope * axis[3 * i];
    path[2 * i + 1] = y[i] - slope * axis[3 * i + 1];
  }
  return path;
}

// The velocity of the contact point along the table, m/s.
function slipOf({ tilt, azimuth, slip_x, slip_y }, count) {
  const slip = new Float32Array(2 * count);
  for (let i = 0; i < count; i++) {
    // A vertical axis leans in no direction: its slip is along the axes of the table.
    const turn = Math.sin(tilt[i]) === 0 ? 0 : azimuth[i];
    const [sine, cosine] = [Math.sin(turn), Math.cos(turn)];
    slip[2 * i] = cosine * slip_x[i] - sine * slip_y[i];
    slip[2 * i + 1] = sine * slip_x[i] + cosine * slip_y[i];
  }
  return slip;
}

// The torque of friction about the centre of mass, N m.
function torqueOf({ x, y, height, gap, contact_torque }, { point, contact_force }, count) {
  const torque = new Float32Array(3 * count);
  for (let i = 0; i < count; i++) {
    const arm = [point[2 * i] - x[i], point[2 * i + 1] - y[i], gap[i] - height[i]];
    const [across, along] = contact_force.subarray(3 * i, 3 * i + 2);
    const about = [-arm[2] * along, arm[2] * across, arm[0] * along - arm[1] * across];
    for (let k = 0; k < 3; k++) torque[3 * i + k] = about[k] + contact_torque[3 * i + k];
  }
  return torque;
}

export function buffersOf(track) {
  return [track.time.buffer, ...Object.values(track.columns).map((column) => column.buffer)];
}
