// One launch: followed from mode to mode, its numbers found on the way, and sampled when asked.
import * as m from "./mechanics.js";
import { integrator, reader } from "./compile.js";
import { DenseSolution, earliest } from "./dense.js";
import { plain } from "./runtime.js";
import { CATALOGUE, GAUSS } from "./tables.js";

const LOOKS = 16,
  PLACES = Array.from({ length: LOOKS + 1 }, (_, look) => look / LOOKS);
const rates = (mode, y, pole) => m.Rates.of(mode, y, pole),
  RATES = 8,
  FORCE = 7;
const kept = (mode, y) => m.kept(mode.state(y), mode.top),
  KEPT = 5;
// A number in a step of a solution, as it is or with the other sign, as a function of the part that has passed.
const reading =
  (solution, step, number, sign = 1) =>
  (part) =>
    sign * solution.value(step, number, part);
// Parts of a step from its ends on in which friction has a direction, which it has not where slip is zero.
const WITHIN = 1e-8;
// What is added up: the first of them as they are told, as rates, in `Rates`.
const [X, Y, TURN, WORK, DRILLED, ROLLED, STRUCK, SUMS] = [0, 1, 2, 3, 4, 5, 6, 7];

/** Follow the launch of a problem (as JSON tells it) for a duration, s, at a relative error a step. */
export function simulate(
  problem,
  { duration, tolerance = 1e-10, step_limit, phase_limit, onProgress } = {},
) {
  m.require_tolerance(tolerance, "compiled");
  const run = new Run(new m.Problem(problem), duration, tolerance, [phase_limit, step_limit]);
  for (const segment of run.trajectory.segments()) {
    run.take(segment);
    onProgress?.(run.trajectory.time / run.trajectory.end);
  }
  return run.finish();
}

class Run {
  constructor(problem, duration, tolerance, limits) {
    const units = m.natural_units(problem.top),
      top = m.natural(problem.top),
      start = m.natural_state(problem.start(), units);
    m.require_limits(duration, units.time, ...limits);
    const { liftoff, restitution } = problem.contact,
      launch = m.rules_for(top, liftoff, restitution).launch(start);
    const pole = start.axis[2] >= 0 ? 1 : -1,
      lost = launch.energy_lost;
    Object.assign(this, {
      duration,
      tolerance,
      units,
      top,
      start,
      pole,
      pieces: [],
      turned: NaN,
      steps: 0,
    });
    this.trajectory = new m.Trajectory(
      launch,
      duration / units.time,
      integrator(tolerance),
      ...limits,
    );
    this.sums = Float64Array.of(0, 0, pole * problem.launch.azimuth, -lost, 0, 0, lost);
    [this.monitor, this.flights] = [new m.Monitor(top, start), new m.Flights()];
    // Of the tip and, in flights, of the centre of mass: where these are highest, their negatives are least.
    [this.force, this.down, this.up, this.depth] = [
      new Least(),
      new Least(),
      new Least(),
      new Least(),
    ];
  }

  /** A solution in a mode, with how its numbers are read. */
  piece(mode, solution, label = mode.label) {
    const read = reader(mode, solution.size),
      of = read(rates, RATES),
      numbers = new Float64Array(solution.size);
    const at = (step, part) => solution.numbers(step, part, numbers),
      look = (step, part, pole = 1) => of(at(step, part), pole);
    const sums = new Float64Array(SUMS * solution.count),
      rule = GAUSS[mode.touching && solution.degree > 7 ? 8 : 4];
    const value = (step, number, part) =>
      look(step, Math.min(Math.max(part, WITHIN), 1 - WITHIN))[number];
    this.pieces.push({ solution, label, read, at, look, value, sums, poles: [], rule });
    return this.pieces.at(-1);
  }

  /** Take in a segment: what is integrated along it, and the extremes of the motion. */
  take(segment) {
    const { solution, mode, transition } = segment;
    this.steps += segment.steps;
    if (!mode.touching) this.flights.take(segment);
    if (solution.count) {
      const piece = this.piece(mode, solution),
        known = piece.read(kept, KEPT),
        presses = mode.touching && !this.flights.rows.length;
      for (let step = 0; step < solution.count; step += 1) {
        const out = known(piece.at(step, 0));
        this.monitor.see(out[0], out[1], out[2], out[3], out[4], this.sums[WORK]);
        this.sum(piece, step, presses);
        this.see(solution, step, 2, this.down, this.up);
        if (!mode.touching) this.see(solution, step, 9, null, this.depth);
      }
    }
    const lost = transition?.energy_lost ?? 0;
    this.sums[STRUCK] += lost;
    this.sums[WORK] -= lost;
  }

  /** Integrate along a step; and see how small the normal force is. */
  sum(piece, step, presses) {
    const { solution, rule } = piece,
      pole = solution.value(step, 2, rule.nodes[rule.nodes.length >> 1]) >= 0 ? 1 : -1;
    if (pole !== this.pole) {
      this.sums[TURN] +=
        (pole - this.pole) * Math.atan2(solution.value(step, 1, 0), solution.value(step, 0, 0));
      this.pole = pole;
    }
    piece.sums.set(this.sums, SUMS * step);
    piece.poles.push(pole);
    this.along(piece, step, 1, pole, this.sums);
    // Between Gauss's points, and beyond them, it is lower by a part of what it varies by there.
    const { least, most } = this,
      bound = least - 0.5 * (most - least);
    if (presses) this.force.see(least, bound, piece, step, FORCE);
  }

  /** Add to sums what is gained up to a part of a step; the normal forces on the way. */
  along({ solution, rule, look }, step, part, pole, sums) {
    const { nodes, weights } = rule,
      span = part * (solution.knots[step + 1] - solution.knots[step]);
    [this.least, this.most] = [Infinity, -Infinity];
    for (let i = 0; i < nodes.length; i += 1) {
      const out = look(step, part * nodes[i], pole),
        share = weights[i] * span;
      for (let k = X; k <= ROLLED; k += 1) sums[k] += share * out[k];
      this.least = Math.min(this.least, out[FORCE]);
      this.most = Math.max(this.most, out[FORCE]);
    }
  }

  /** Take in how far a number of a solution goes down and up in a step. */
  see(solution, step, number, down, up) {
    const start = solution.value(step, number, 0),
      [low, high] = solution.bounds(step, number);
    down?.see(start, low, solution, step, number);
    up.see(-start, -high, solution, step, number, -1);
    const turns = down && low <= 0 && high >= 0 && this.turned !== this.turned;
    if (turns) this.turned = solution.time(step, firstFall(reading(solution, step, number), true));
  }

  /** First time at which n_z is in a band. */
  arrival([low, high]) {
    for (const { solution } of this.pieces) {
      for (let step = 0; step < solution.count; step += 1) {
        const start = solution.value(step, 2, 0),
          [least, most] = solution.bounds(step, 2);
        if (least > high || most < low) continue;
        const sign = start > high ? 1 : -1,
          edge = start > high ? high : low;
        const part =
          start <= high && start >= low
            ? 0
            : firstFall((x) => sign * (solution.value(step, 2, x) - edge));
        if (!Number.isNaN(part)) return solution.time(step, part);
      }
    }
    return NaN;
  }

  finish() {
    const { trajectory, units, sums } = this,
      { events, outcome, detail, state } = trajectory,
      flights = this.flights.rows;
    const ended = this.monitor.concluded(outcome, state, sums[WORK], this.tolerance);
    this.outcome = {
      name: ended.name.toLowerCase(),
      advice: [ended.value, detail].filter(Boolean).join(" "),
    };
    this.early = ended !== m.Outcome.COMPLETED && detail !== m.NOT_FINITE;
    this.endTime = outcome === m.Outcome.COMPLETED ? this.duration : trajectory.time * units.time;
    this.events = plain(events.map((event) => m.event_in_si(event, units)));
    for (const [way, last] of [
      [this.down, state.axis[2]],
      [this.up, -state.axis[2]],
    ])
      way.see(this.pieces.length ? last : NaN);
    const least = [this.force, this.down, this.up, this.depth].map((one) => one.found());
    const [resisted, when] = [
      [-sums[DRILLED], -sums[ROLLED]],
      [this.turned, this.arrival(m.final_band(state))],
    ];
    const ends = m.Ends.of_one(
      state,
      trajectory.time,
      null,
      events,
      this.flights,
      this.steps,
      resisted,
      least,
      when,
    );
    this.metrics = Object.fromEntries(m.metrics(ends, this.start, this.top, units).entries());
    this.flights = flights.map(([start, end, gap]) => ({
      start: start * units.time,
      end: end * units.time,
      highest_gap: gap * units.length,
    }));
    if (!this.pieces.length) {
      const [mode, numbers] = m.as_begun(this.start, this.top);
      const still = DenseSolution.in_time([0, 1], [numbers.map((number) => [number])]);
      Object.assign(this.piece(mode, still, "sliding"), { sums, poles: [this.pole] });
    }
    return this;
  }

  /** Every variable of the catalogue's SAMPLED at some times, s, or at so many from start to end. */
  track(when = 2001) {
    const times = typeof when === "number" ? this.grid(when) : Float64Array.from(when);
    const track = { time: times, mode: [] },
      count = times.length;
    for (const [name, variable] of Object.entries(CATALOGUE.sampled))
      track[name] = new Float64Array(count * variable.width);
    times.forEach((time, i) => this.sample(track, i, time / this.units.time));
    smooth(track.orientation);
    return track;
  }

  grid(count) {
    const times = Array.from({ length: count }, (_, i) => this.duration * (i / (count - 1))).filter(
      (time) => time <= this.endTime,
    );
    if (this.early && times.at(-1) < this.endTime) times.push(this.endTime);
    return Float64Array.from(times);
  }

  /** Put what is known of a time, the piece of which is the earlier one where two meet, into a track. */
  sample(track, i, time) {
    const { pieces } = this,
      piece = pieces[earliest(pieces.length, (here) => pieces[here].solution.end >= time)];
    const { solution } = piece,
      step = solution.step(time),
      part = solution.part(step, time);
    const sums = piece.sums.slice(step * SUMS, (step + 1) * SUMS),
      pole = piece.poles[step];
    this.along(piece, step, part, pole, sums);
    const told = m.Instants.unpack(
      (piece.told ??= piece.read(m.instants, m.TOLD))(solution.numbers(step, part)),
    );
    const here = new m.Samples(
      time,
      told,
      sums[X],
      sums[Y],
      sums[TURN],
      sums[WORK],
      sums[STRUCK],
      -sums[DRILLED],
      -sums[ROLLED],
      pole,
      null,
    );
    for (const [name, value] of m.observe(here, this.top, this.units).entries()) {
      if (typeof value === "number") track[name][i] = value;
      else track[name].set(value, i * value.length);
    }
    track.mode.push(piece.label);
  }
}

/** The least value of something along a run: what was seen, and where between there may be less of it. */
class Least {
  value = Infinity;
  places = [];

  /** Take in a value; where there may be less in a step, down to a bound, keep what tells it there. */
  see(value, bound, solution, step, number, sign) {
    this.value = Math.min(this.value, value);
    if (bound < this.value) this.places.push([bound, reading(solution, step, number, sign)]);
  }

  found() {
    for (const [bound, values] of this.places
      .filter(([bound]) => bound < this.value)
      .sort(([a], [b]) => a - b)) {
      if (bound >= this.value) break;
      let low = Infinity,
        high = -Infinity,
        at = 0;
      for (let look = 0; look <= LOOKS; look += 1) {
        const value = values(PLACES[look]);
        if (value < low) [low, at] = [value, look];
        if (value > high) high = value;
      }
      if (low - 0.1 * (high - low) > this.value) continue;
      const [start, end] = [Math.max(at - 1, 0), Math.min(at + 1, LOOKS)].map(
        (look) => PLACES[look],
      );
      this.value = Math.min(
        this.value,
        low,
        values(m.dip((part) => values(part) - low + (high - low), start, end)[0]),
      );
    }
    return this.value;
  }
}

/** Where a function on [0, 1] first falls to zero from above; nan where it does not. */
function firstFall(value, fromAbove = false) {
  const looks = PLACES.map(value);
  if ((fromAbove ? looks[0] === 0 : looks[0] <= 0) && looks[1] <= 0) return 0;
  const [found] = m.brackets(PLACES, looks, value, value);
  return found === undefined ? NaN : m.crossing(value, found[0], found[1]);
}

/** Give quaternions in a row the signs that let none jump. */
function smooth(rows) {
  for (let i = 4; i < rows.length; i += 4) {
    const before = rows.subarray(i - 4, i),
      here = rows.subarray(i, i + 4);
    if (here.reduce((sum, one, k) => sum + one * before[k], 0) < 0)
      here.forEach((one, k) => (here[k] = -one));
  }
}
