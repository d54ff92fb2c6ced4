// One launch: followed from mode to mode, its numbers found on the way, and sampled when asked.
import * as m from "./mechanics.js";
import { make_integrator } from "./integrate.js";
import { observed, seen } from "./observe.js";
import * as of from "./observe.js";
import { InvalidInput } from "./part.js";
import { Polynomial, reach } from "./polynomials.js";
import { math } from "./runtime.js";
import { CATALOGUE, GAUSS, NEAR_FINAL, NEAR_POLE } from "./tables.js";

const NOT_FINITE = "the solution is no longer finite";
const LONGEST = 1e300, LEAST_TOLERANCE = 2.3e-14, HEIGHT_LOOKS = 65;
const [WORST, ACCUMULATED, LEAST_MOMENT] = [1e-6, 1e4, 1e-6];
const [X, Y, TURN, WORK, DRILLED, ROLLED, STRUCK, SUMS] = [0, 1, 2, 3, 4, 5, 6, 7];

/** Follow a launch; see the README beside. */
export function simulate(problem, { duration, tolerance = 1e-10, onProgress, shouldStop } = {}) {
  const whole = problem instanceof m.Problem ? problem : new m.Problem(problem);
  if (!(typeof duration === "number" && duration > 0 && duration <= LONGEST)) {
    throw new InvalidInput("duration", duration, "a number of seconds greater than 0, at most 1e+300");
  }
  if (!(tolerance >= LEAST_TOLERANCE && tolerance < 1)) {
    throw new InvalidInput("tolerance", tolerance, `a number from ${LEAST_TOLERANCE} to 1`);
  }
  const run = new Run(whole, duration, tolerance);
  for (const segment of run.trajectory.segments()) {
    run.take(segment);
    onProgress?.(run.trajectory.time / run.trajectory.end);
    if (shouldStop?.()) return run.finish({ name: "stopped", advice: "The run was stopped." });
  }
  return run.finish();
}

export class Run {
  constructor(problem, duration, tolerance) {
    this.problem = problem;
    this.duration = duration;
    this.tolerance = tolerance;
    this.units = m.natural_units(problem.top);
    this.top = m.natural(problem.top);
    this.start = m.natural_state(problem.start(), this.units);
    const { liftoff, restitution } = problem.contact;
    const launch = m.rules_for(this.top, liftoff, restitution).launch(this.start);
    this.trajectory = new m.Trajectory(launch, duration / this.units.time, make_integrator("dop853", tolerance));
    this.pieces = [];
    this.hops = [];
    [this.pressed, this.tips] = [[], []];
    this.landed = true;
    this.out = new Float64Array(of.OUTPUTS);
    this.sums = new Float64Array(SUMS);
    this.pole = this.start.axis[2] >= 0 ? 1 : -1;
    const lost = launch.events.reduce((total, event) => total + event.energy_lost, 0);
    this.sums[TURN] = this.pole * problem.launch.azimuth;
    this.sums[WORK] = -lost;
    this.sums[STRUCK] = lost;
    this.energy = m.energy(this.start, this.top);
    this.jellett = m.jellett(this.start, this.top);
    this.off = { imbalance: 0, largest: Math.abs(this.energy), stretch: 0, sunk: 0, least: this.jellett, most: this.jellett };
    Object.assign(this, { down: Infinity, up: -Infinity, turned: NaN, leastForce: Infinity, highest: 0, steps: 0 });
  }

  /** What a mode is, told at a part of a step. */
  look(piece, step, part, pole = 1) {
    piece.parameters[piece.parameters.length - 1] = pole;
    piece.code(piece.solution.numbers(step, part, piece.numbers), piece.parameters, this.out);
    return this.out;
  }

  /** Take in a segment: what is integrated along it, and the extremes of the motion. */
  take(segment) {
    const { solution, mode } = segment, { code, parameters } = observed(mode, solution.size);
    const piece = { solution, mode, code, parameters, sums: [], poles: [], numbers: new Float64Array(solution.size) };
    piece.rule = solution.degree > 7 ? GAUSS[8] : GAUSS[4];
    this.pieces.push(piece);
    this.steps += segment.steps;
    if (!mode.touching) this.fly(segment);
    for (let step = 0; step < solution.count; step += 1) {
      this.monitor(piece, step);
      this.sum(piece, step, mode.touching && !this.hops.length);
      this.tip(solution, step);
      if (!mode.touching) this.rise(solution, step);
    }
    for (const event of segment.transition?.events ?? []) {
      this.sums[STRUCK] += event.energy_lost;
      this.sums[WORK] -= event.energy_lost;
    }
  }

  /** Take in the height of the centre of mass in a flight. */
  rise(solution, step) {
    const [terms, from, degree] = solution.polynomial(step, 9);
    if (terms[from] + reach(terms, from, degree) <= this.highest) return;
    this.highest = Math.max(this.highest, -new Polynomial(terms, from, degree).least(-1)[1]);
  }

  fly(segment) {
    let begin = segment.solution.knots[0];
    if (this.hops.length && !this.landed) begin = this.hops.pop()[0];
    this.hops.push([begin, segment.end_time, segment.highest_gap]);
    this.landed = segment.transition !== null;
  }

  /** See that energy and work balance where a step begins, and what else the motion keeps. */
  monitor(piece, step) {
    const out = this.look(piece, step, 0), { off } = this, x = out[0], y = out[1], z = out[2];
    off.imbalance = Math.max(off.imbalance, Math.abs(out[of.ENERGY] - this.energy - this.sums[WORK]));
    off.largest = Math.max(off.largest, out[of.ENERGY]);
    off.stretch = Math.max(off.stretch, Math.abs(Math.sqrt(x * x + y * y + z * z) - 1));
    off.least = Math.min(off.least, out[of.JELLETT]);
    off.most = Math.max(off.most, out[of.JELLETT]);
    if (this.top.surface instanceof m.Hull) off.sunk = Math.max(off.sunk, m.outer_height(this.top.surface, z) - out[9]);
  }

  /** Integrate along a step; and see how small the normal force is. */
  sum(piece, step, presses) {
    const { solution, rule } = piece, span = solution.knots[step + 1] - solution.knots[step];
    const pole = solution.value(step, 2, rule.nodes[rule.nodes.length >> 1]) >= 0 ? 1 : -1;
    if (pole !== this.pole) {
      this.sums[TURN] += (pole - this.pole) * Math.atan2(solution.value(step, 1, 0), solution.value(step, 0, 0));
      this.pole = pole;
    }
    for (let i = 0; i < SUMS; i += 1) piece.sums.push(this.sums[i]);
    piece.poles.push(pole);
    this.along(piece, step, 1, span, pole, this.sums);
    if (!presses) return;
    const { least, most } = this;
    this.leastForce = Math.min(this.leastForce, least);
    // Between Gauss's points, and beyond them, it is lower by a part of what it varies by there.
    const bound = least - 0.5 * (most - least);
    if (bound <= this.leastForce) this.pressed.push([bound, piece, step]);
  }

  /** Add to sums what is gained up to a part of a step; the normal forces on the way. */
  along(piece, step, part, span, pole, sums) {
    const { nodes, weights } = piece.rule;
    [this.least, this.most] = [Infinity, -Infinity];
    for (let i = 0; i < nodes.length; i += 1) {
      const out = this.look(piece, step, part * nodes[i], pole), share = weights[i] * part * span;
      sums[X] += share * out[6];
      sums[Y] += share * out[7];
      sums[TURN] += share * out[of.TURNING];
      sums[WORK] += share * out[of.POWER];
      sums[DRILLED] -= share * out[of.DRILLING];
      sums[ROLLED] -= share * out[of.ROLLING];
      this.least = Math.min(this.least, out[of.FORCE + 2]);
      this.most = Math.max(this.most, out[of.FORCE + 2]);
    }
  }

  /** The least normal force in a step. */
  press(piece, step) {
    const force = (x) => this.look(piece, step, x)[of.FORCE + 2];
    const looks = Array.from({ length: 17 }, (_, i) => force(i / 16));
    const least = looks.indexOf(Math.min(...looks));
    let [a, b] = [Math.max(least - 1, 0) / 16, Math.min(least + 1, 16) / 16];
    this.leastForce = Math.min(this.leastForce, looks[least]);
    if (looks[least] - 0.1 * (Math.max(...looks) - looks[least]) > this.leastForce) return;
    for (let turn = 0; turn < 50 && b - a > 1e-9; turn += 1) {
      const x = a + 0.381966 * (b - a), y = b - 0.381966 * (b - a);
      if (force(x) < force(y)) b = y;
      else a = x;
    }
    this.leastForce = Math.min(this.leastForce, force(0.5 * (a + b)));
  }

  /** Take in the motion of the tip of the axis. */
  tip(solution, step) {
    const [terms, from, degree] = solution.polynomial(step, 2), start = terms[from];
    const far = reach(terms, from, degree), lowest = start - far, highest = start + far;
    const turns = this.turned !== this.turned && lowest <= 0 && highest >= 0;
    if (lowest >= this.down && highest <= this.up && !turns) return;
    if (lowest < this.down || highest > this.up) this.tips.push([lowest, highest, solution, step]);
    this.down = Math.min(this.down, start);
    this.up = Math.max(this.up, start);
    if (turns) this.turned = timeAt(solution, step, new Polynomial(terms, from, degree).firstFall(1, 0, true));
  }

  /** Look at the steps in which there may be less of something than was seen so far. */
  refine() {
    if (!this.hops.length) {
      for (const [bound, piece, step] of this.pressed) if (bound <= this.leastForce) this.press(piece, step);
    }
    const last = this.trajectory.state.axis[2];
    [this.down, this.up] = [Math.min(this.down, last), Math.max(this.up, last)];
    for (const [lowest, highest, solution, step] of this.tips) {
      const tip = new Polynomial(...solution.polynomial(step, 2));
      if (lowest < this.down) this.down = Math.min(this.down, tip.least()[1]);
      if (highest > this.up) this.up = Math.max(this.up, -tip.least(-1)[1]);
    }
    [this.pressed, this.tips] = [null, null];
  }

  /** First time at which n_z is in a band. */
  arrival(low, high) {
    for (const { solution } of this.pieces) {
      for (let step = 0; step < solution.count; step += 1) {
        const [terms, from, degree] = solution.polynomial(step, 2), start = terms[from];
        const far = reach(terms, from, degree);
        if (start - far > high || start + far < low) continue;
        const tip = new Polynomial(terms, from, degree);
        const part = start > high ? tip.firstFall(1, -high) : start < low ? tip.firstFall(-1, low) : 0;
        if (!Number.isNaN(part)) return timeAt(solution, step, part);
      }
    }
    return NaN;
  }

  finish(stopped) {
    const { trajectory, units } = this, { events, outcome, detail } = trajectory;
    const accurate = stopped || outcome !== m.Outcome.COMPLETED || this.inaccuracy <= Math.max(WORST, ACCUMULATED * this.tolerance);
    this.ended = accurate ? outcome : m.Outcome.INACCURATE;
    const advice = [this.ended?.value, detail].filter(Boolean).join(" ");
    this.outcome = stopped ?? { name: this.ended.name.toLowerCase(), advice };
    this.early = this.ended !== m.Outcome.COMPLETED && detail !== NOT_FINITE;
    this.endTime = trajectory.time * units.time;
    this.events = events.map((event) => ({
      kind: event.kind.value, time: event.time * units.time, surface: event.surface,
      impulse: event.impulse * units.mass * units.speed, energyLost: event.energy_lost * units.energy,
    }));
    this.flights = this.hops.map(([start, end, gap]) => (
      { start: start * units.time, end: end * units.time, highestGap: gap * units.length }));
    this.refine();
    this.metrics = this.numbers();
    this.ending = this.ended === undefined || this.ended === null ? "failed" : ending(this.ended, this.metrics.final_theta);
    return this;
  }

  get inaccuracy() {
    const { off } = this, moment = Math.hypot(...this.start.momentum) * this.top.surface.height(this.start.axis[2]);
    const drift = this.top.conserves_jellett && moment > LEAST_MOMENT ? (off.most - off.least) / moment : 0;
    return Math.max(...[off.imbalance / off.largest, off.stretch, drift, off.sunk].filter((one) => !Number.isNaN(one)));
  }

  /** Every number of the catalogue's METRICS, SI. */
  numbers() {
    const { top, units, start, hops, sums } = this, end = this.trajectory.state, { axis, momentum } = end;
    const final = Math.atan2(m.axis_sine(axis), axis[2]), force = (units.mass * units.length) / units.time ** 2;
    const band = [Math.cos(Math.min(final + NEAR_FINAL, Math.PI)), Math.cos(Math.max(final - NEAR_FINAL, 0))];
    const lifts = this.trajectory.events.filter((event) => event.kind === m.EventKind.LIFT_OFF).map((event) => event.time);
    const moment = Math.hypot(...start.momentum) * m.outer_height(top.surface, start.axis[2]);
    const lost = m.energy(start, top) - m.energy(end, top);
    const [down, up] = this.steps || this.pieces.length ? [this.down, this.up] : [NaN, NaN];
    const heights = Array.from({ length: HEIGHT_LOOKS }, (_, i) => heightAt(top, down + ((up - down) * i) / (HEIGHT_LOOKS - 1)));
    const upright = m.axis_sine(axis) === 0;
    const [drilled, rolled, struck] = [sums[DRILLED], sums[ROLLED], this.trajectory.events.reduce((t, e) => t + e.energy_lost, 0)];
    return {
      final_theta: final,
      final_omega3: m.axial_spin(axis, momentum, top) / units.time,
      final_phi_dot: upright ? NaN : m.precession_rate(axis, momentum, top) / units.time,
      turns_over: this.turned * units.time,
      arrives: this.arrival(...band) * units.time,
      least_normal_force: (lifts.length || hops.length ? 0 : this.leastForce) * force,
      first_lift_off: (lifts.length ? Math.min(...lifts) : NaN) * units.time,
      flights: hops.length,
      airborne_time: hops.reduce((total, [from, to]) => total + to - from, 0) * units.time,
      energy_lost: lost * units.energy,
      energy_lost_sliding: (lost - struck - drilled - rolled) * units.energy,
      energy_lost_drilling: drilled * units.energy,
      energy_lost_rolling: rolled * units.energy,
      highest: Math.max(this.highest, ...heights) * units.length,
      highest_gap: Math.max(0, ...hops.map(([, , gap]) => gap)) * units.length,
      jellett_error: moment > 0 ? Math.abs(m.jellett(end, top) - m.jellett(start, top)) / moment : NaN,
      end_time: this.endTime,
      steps: this.steps,
    };
  }

  /** The piece in which a natural time lies, the earlier one where two meet. */
  pieceAt(time) {
    let low = 0, high = this.pieces.length - 1;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.pieces[middle].solution.end < time) low = middle + 1;
      else high = middle;
    }
    while (low > 0 && !this.pieces[low].solution.count) low -= 1;
    return this.pieces[low];
  }

  /** State, mode and what the table does at a time, SI. */
  at(seconds) {
    const { units } = this, track = this.track([seconds]), axis = [...track.axis];
    const momentum = [...track.angular_momentum].map((one) => one / units.angular_momentum);
    return {
      axis, momentum: [...track.angular_momentum], velocity: [...track.velocity], height: track.height[0],
      mode: track.mode[0], force: [...track.contact_force], torque: [...track.contact_torque],
      omega: m.angular_velocity(axis, momentum, this.top).map((one) => one / units.time),
    };
  }

  /** Every variable of the catalogue's SAMPLED at some times, s, or at so many from start to end. */
  track(when = 2001) {
    const times = typeof when === "number" ? this.grid(when) : Float64Array.from(when);
    const track = { time: times, mode: [] }, count = times.length;
    for (const [name, variable] of Object.entries(CATALOGUE.sampled)) track[name] = new Float64Array(count * variable.width);
    if (!this.pieces.some((piece) => piece.solution.count)) return this.still(track);
    times.forEach((time, i) => this.sample(track, i, time / this.units.time));
    smooth(track.orientation);
    return track;
  }

  grid(count) {
    const all = Array.from({ length: count }, (_, i) => (this.duration * i) / (count - 1));
    // Its end is the last of them but for rounding.
    const times = this.early ? all.filter((time) => time <= this.endTime) : all;
    if (this.early && times.at(-1) < this.endTime) times.push(this.endTime);
    return Float64Array.from(times);
  }

  sample(track, i, time) {
    const piece = this.pieceAt(time), { solution } = piece, step = solution.step(time);
    const from = solution.knots[step], span = solution.knots[step + 1] - from;
    const part = Math.min(Math.max((time - from) / (span > 0 ? span : 1), 0), 1);
    const sums = piece.sums.slice(step * SUMS, (step + 1) * SUMS), pole = piece.poles[step];
    this.along(piece, step, part, span, pole, sums);
    this.tell(track, i, this.look(piece, step, part, pole), sums, pole);
    track.mode.push(piece.mode.label);
  }

  still(track) {
    const out = new Float64Array(of.OUTPUTS);
    out.set(this.start.pack());
    track.time.forEach((_, i) => this.tell(track, i, out, this.sums, this.pole));
    track.mode = Array.from(track.time, () => "sliding");
    return track;
  }

  /** Put what is known of a moment into a track, SI. */
  tell(track, i, out, sums, pole) {
    const { units, top } = this, { code, parameters } = seen(lowest(top, out[2])), view = new Float64Array(of.SEEN);
    const state = m.State.unpack(out), { axis, momentum } = state, upright = Math.hypot(axis[0], axis[1]) === 0;
    code(out, parameters, view);
    const leaving = Math.hypot(momentum[0], momentum[1]) / top.transverse_inertia, force = units.energy / units.length;
    const put = (name, unit, ...values) => values.forEach((value, k) => (track[name][i * values.length + k] = value * unit));
    put("theta", 1, Math.atan2(view[of.SINE], axis[2]));
    put("theta_dot", 1 / units.time, upright ? (axis[2] < 0 ? -leaving : leaving) : view[of.TILTING]);
    put("phi", 1, Math.atan2(axis[1], axis[0]));
    put("phi_dot", 1 / units.time, upright ? NaN : view[of.PRECESSION]);
    put("omega3", 1 / units.time, view[of.SPIN]);
    put("slip_x", units.speed, view[(upright ? of.POINT : of.SLIP)]);
    put("slip_y", units.speed, view[(upright ? of.POINT : of.SLIP) + 1]);
    put("normal_force", force, out[of.FORCE + 2]);
    put("contact_force", force, ...out.slice(of.FORCE, of.FORCE + 3));
    put("contact_torque", units.energy, ...out.slice(of.TORQUE, of.TORQUE + 3));
    put("energy", units.energy, m.energy(state, top));
    put("work", units.energy, sums[WORK]);
    put("sliding_loss", units.energy, -sums[WORK] - sums[STRUCK] - sums[DRILLED] - sums[ROLLED]);
    put("drilling_loss", units.energy, sums[DRILLED]);
    put("rolling_loss", units.energy, sums[ROLLED]);
    put("jellett", units.jellett, -view[of.INTEGRAL]);
    put("height", units.length, state.height);
    put("gap", units.length, state.height + view[of.ARM]);
    put("x", units.length, sums[X]);
    put("y", units.length, sums[Y]);
    put("axis", 1, ...axis);
    put("velocity", units.speed, ...state.velocity);
    put("angular_momentum", units.angular_momentum, ...momentum);
    put("orientation", 1, ...m.orientation(axis, sums[TURN], pole, math));
  }
}

const timeAt = (solution, step, part) => solution.knots[step] + part * (solution.knots[step + 1] - solution.knots[step]);
const lowest = (top, c) => (top.surface instanceof m.Hull ? top._replace({ surface: m.lowest_surface(top.surface, c) }) : top);

function heightAt(top, c) {
  try {
    return m.outer_height(top.surface, c);
  } catch {
    return NaN;
  }
}

/** What became of a launch, by the words of tippetop.catalogue.Ending. */
function ending(outcome, final) {
  const { COMPLETED, LIFTED_OFF, AT_REST, LYING_FLAT } = m.Outcome;
  if (outcome === LIFTED_OFF) return "lifted_off";
  if (outcome === AT_REST) return "at_rest";
  if (outcome !== COMPLETED && outcome !== LYING_FLAT) return "failed";
  return final <= NEAR_POLE ? "upright" : final >= Math.PI - NEAR_POLE ? "inverted" : "tilted";
}

/** Give quaternions in a row the signs that let none jump. */
function smooth(rows) {
  for (let i = 4; i < rows.length; i += 4) {
    let product = 0;
    for (let k = 0; k < 4; k += 1) product += rows[i + k] * rows[i + k - 4];
    if (product < 0) for (let k = 0; k < 4; k += 1) rows[i + k] = -rows[i + k];
  }
}
