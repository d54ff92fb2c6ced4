// Follows one launch from contact mode to contact mode, sums up its metrics, and samples it on demand.
import { integrator, reader } from "./compile.js";
import { DenseSolution, earliest, shifted } from "./dense.js";
import * as m from "./mechanics.js";
import { inUnits } from "./part.js";
import { neg, plain, replace } from "./runtime.js";
import { CATALOGUE, FORCE_DEGREE, GAUSS } from "./tables.js";

// A search for a root or a least value in a step first looks at the ends of this many intervals.
const PROBES_PER_STEP = 16;
const PROBES = Array.from({ length: PROBES_PER_STEP + 1 }, (_, probe) => probe / PROBES_PER_STEP);

// Share of the range of its probes by which a number may still be smaller between them.
const BETWEEN_PROBES = 0.1;
// The same of the normal force between and beyond the nodes of Gauss's rule, which are fewer.
const BETWEEN_NODES = 0.5;

// How far a polynomial may be from the normal force, in weights, where that is smooth: a jump is 100 times as much.
const SMOOTH_FORCE = 1e-6;
// The part of a step at whose ends the force is not read.
const NEAR_END = 1e-6;

// The most digits of a metric for people.
const MOST_DIGITS = 4;
// The status of a mode whose contact sticks.
const STICKING = "sticking";
// Relative difference of two times below which nothing happens between them.
const AT_ONCE = 1e-6;

// Numbers of a solution: n_z, and in flight the height of the centre of mass.
const AXIS_Z = 2;
const HEIGHT = 9;

// What is read off a mode's numbers in a step: functions for `reader`, and how many values each returns.
const rates = (mode, y, pole) => m.Rates.of(mode, y, pole);
const RATES = m.Rates.fields.length;
const FORCE = m.Rates.fields.indexOf("force");
const MARGIN = m.Rates.fields.indexOf("margin");
const conserved = (mode, y) => m.monitored_quantities(mode.state(y), mode.top);
const CONSERVED = 3;
const depth = (mode, y) => [neg(m.gap_at(mode, y))];

// Places of what is summed up along a run, in the order of `RunSums`.
const SUMS = m.RunSums.fields.length;
const [TURN, WORK, AIR, STRUCK] = ["turn", "work", "air", "struck"].map((name) =>
  m.RunSums.fields.indexOf(name),
);
// Those from the work on are energies.
const ENERGIES = Array.from({ length: SUMS - WORK }, (_, k) => WORK + k);

/**
 * Follow the launch of a problem (as JSON tells it) for a duration, s, at a relative error a step.
 *
 * `pushes` are what is done to the body and the table on the way, in order of time: each has a `time`, s, a horizontal
 * `impulse`, N s, at a point of the axis at one size from the centre of mass, its `direction`, rad, from that into
 * which the axis leans, and the friction coefficient `mu` and the table's `slope`, rad, from then on, null for those
 * which were. The run goes on from the state that it has then, relative to the table, which turns about the place of
 * launch; what comes after its end is left out.
 */
export function simulate(
  problem,
  { duration, pushes = [], tolerance = 1e-10, step_limit, mode_limit, onProgress } = {},
) {
  m.require_tolerance(tolerance, "dop853");
  const seconds = inUnits("duration", duration, "s");
  const run = new Run(new m.Problem(problem), seconds, tolerance, [mode_limit, step_limit]);
  const follow = (end) => run.follow(end, (time) => onProgress?.(time / seconds));
  for (const push of pushesOf(pushes, problem)) {
    if (push.time >= seconds) break;
    if (!follow(push.time) && !run.restsUntil(push.time)) break;
    run.push(push);
  }
  follow(seconds);
  run.finish();
  return run;
}

/**
 * How many digits of the times that a run tells a minute change of its launch or of its friction leaves, by the names of
 * clauses and metrics; 0 where it may change the run. Two runs beside it are followed, as `tt.time_uncertainties` does.
 */
export function timeDigits(problem, options) {
  const { facts, status, endTime } = simulate(problem, options);
  const times = Object.fromEntries(m.account_times(facts).entries());
  const most = Object.fromEntries(Object.keys(times).map((name) => [name, 0]));
  const duration = status.name === "completed" ? options.duration : m.LONGER * endTime;
  for (const fields of m.MOVED) {
    const beside = duration > 0 && changedBy(problem, fields, m.CHANGE);
    if (!beside) continue;
    const { facts: other } = simulate(beside, { ...options, duration });
    for (const [name, change] of m.time_changes(facts, other).entries())
      most[name] = Math.max(most[name], change);
  }
  return Object.fromEntries(
    Object.entries(times).map(([name, time]) => [
      name,
      name.endsWith("_time")
        ? m.digits_left(time, most[name], MOST_DIGITS)
        : m.time_digits(time, most[name]),
    ]),
  );
}

/** A problem whose numbers in some fields are changed by a share; null if there are none, or it is refused. */
function changedBy(problem, fields, change) {
  const copy = structuredClone(problem);
  let isChanged = false;
  for (const field of fields) {
    const [part, name] = field.split(".");
    const number = copy[part]?.[name];
    if (typeof number !== "number" || number === 0) continue;
    copy[part][name] = number * (1 + change);
    isChanged = true;
  }
  try {
    return isChanged && new m.Problem(copy) ? copy : null;
  } catch (error) {
    // The field is at its bound.
    if (error instanceof m.InvalidInput) return null;
    throw error;
  }
}

/** Pushes with the problem from each on, refused where they are none. */
function pushesOf(pushes, problem) {
  let before = 0;
  let present = problem;
  return pushes.map(({ time, impulse, direction, mu = null, slope = null }) => {
    requireNumber("push.time", time, time > before, `of seconds greater than ${before}`);
    requireNumber("push.impulse", impulse, impulse >= 0, "at least 0 N s");
    requireNumber("push.direction", direction, true, "in rad");
    const isHeld = (problem.contact?.liftoff ?? "fly") !== "fly";
    if (impulse > 0 && isHeld)
      throw new m.InvalidInput("push.impulse", impulse, "0 where contact.liftoff is not fly");
    before = time;
    if (mu !== null) present = { ...present, friction: { ...present.friction, mu } };
    if (slope !== null) present = { ...present, table: { ...present.table, slope } };
    return { time, impulse, direction, mu, slope, problem: new m.Problem(present) };
  });
}

function requireNumber(field, value, isRight, bounds) {
  if (typeof value === "number" && Number.isFinite(value) && isRight) return;
  throw new m.InvalidInput(field, value, `a number ${bounds}`);
}

class Run {
  constructor(problem, duration, tolerance, limits) {
    const top = m.top_of(problem);
    this.problem = problem;
    this.duration = duration;
    this.tolerance = tolerance;
    this.limits = limits;
    // The natural units of the table that there is.
    this.units = m.natural_units(top);
    this.start = m.natural_state(problem.start(), this.units);
    m.require_limits(duration, this.units.time, ...limits);

    this.pole = m.nearer_pole(this.start.axis[2]);
    const turn = m.turn_at_launch(problem.launch.azimuth, this.pole);
    this.sums = Float64Array.from(m.RunSums.at_launch(turn, 0));
    this.happened = [];
    this.pushes = [];
    this.segments = [];
    this.steps = 0;
    this.rolls = false;
    // The first time at which n_z fell to zero, s.
    this.firstHorizontal = NaN;
    // Whether n_z was positive at the start of a step.
    this.wasAbove = false;
    this.flightRecord = new m.Flights();
    this.leastForce = new LeastValue();
    this.leastAxisZ = new LeastValue();
    // The greatest of these are the least of their negatives.
    this.mostAxisZ = new LeastValue();
    this.mostHeight = new LeastValue();
    this.begin(problem, this.start, 0);
  }

  /** Begin a motion on the table of a problem, from a state at a time, in the natural units of that table. */
  begin(problem, state, time) {
    const { contact } = problem;
    this.present = problem;
    this.top = m.natural(m.top_of(problem));
    this.automaton = new m.Automaton(
      this.top,
      contact.liftoff,
      contact.restitution,
      contact.indeterminate,
      contact.face_pressure,
    );
    this.launch = after(this.automaton.launch(state), time);
    this.from = state;
    this.monitor = new m.Monitor(this.top, state, this.automaton.pulls);
    this.workBefore = this.totalWork;
    this.lose(this.launch.energy_lost);
    this.trajectory = null;
  }

  /** Energy that went with an impact. */
  lose(energy) {
    this.sums[STRUCK] += energy;
    this.sums[WORK] -= energy;
  }

  /** All work but that of the weight along the normal since the motion began. */
  get work() {
    return this.totalWork - this.workBefore;
  }

  /** Follow the motion to a time, s, and tell of the times that it reaches; whether it goes on from there. */
  follow(end, tell) {
    if (this.trajectory) return false;
    const { automaton, launch, tolerance, limits, units } = this;
    const start = this.pushes.length ? this.pushes.at(-1).time : 0;
    const trajectory = new m.Trajectory(
      automaton,
      launch,
      end / units.time,
      integrator(tolerance),
      ...limits,
      start / units.time,
    );
    this.trajectory = trajectory;
    for (const segment of trajectory.segments()) {
      this.include(segment);
      tell(trajectory.time * units.time);
    }
    this.happened.push(...trajectory.events);
    return trajectory.status === m.Status.COMPLETED;
  }

  /** Whether the body came to rest just before a time, s. */
  restsUntil(time) {
    const { status, time: end } = this.trajectory;
    return status === m.Status.AT_REST && time - end * this.units.time < AT_ONCE * time;
  }

  /** Push the body, and go on with the table of the problem from then on. */
  push(push) {
    const { impulse, direction, problem } = push;
    const { state } = this.trajectory;
    this.breach ||= this.breachUntil(m.Status.COMPLETED);
    const azimuth = Math.atan2(state.axis[1], state.axis[0]) + direction;
    const size = impulse / (this.units.mass * this.units.speed);
    const along = [size * Math.cos(azimuth), size * Math.sin(azimuth), 0];
    const pushed = m.pushed_state(state, along, 1, this.top);
    this.pushes.push(push);
    const units = this.change(m.natural_units(m.top_of(problem)));
    const time = push.time / this.units.time;
    this.begin(problem, m.natural_state(pushed, units), time);
    const { next } = this.launch;
    if (this.segments.at(-1)?.mode.status === STICKING && next.status !== STICKING)
      this.happened.push(new m.Event(m.EventKind.SLIP, time));
  }

  /** Go over to other natural units, which differ in that of time alone; returns them in those that were. */
  change(other) {
    const units = new m.Units(1, 1, other.time / this.units.time);
    this.units = other;
    for (const energy of ENERGIES) this.sums[energy] /= units.energy;
    this.happened = this.happened.map((event) =>
      replace(event, {
        time: event.time / units.time,
        impulse: event.impulse / units.speed,
        energy_lost: event.energy_lost / units.energy,
      }),
    );
    const { rows } = this.flightRecord;
    rows.forEach(([start, end, gap], k) => {
      rows[k] = [start / units.time, end / units.time, gap];
    });
    this.leastForce.change(units.force);
    this.start = m.natural_state(this.start, units);
    return units;
  }

  /** Why a motion that ends with a status cannot be trusted; empty if it can. */
  breachUntil(status) {
    const { monitor, trajectory, work, tolerance } = this;
    const trusted = monitor.final_status(status, trajectory.state, work, tolerance);
    return trusted === m.Status.INACCURATE ? monitor.breach(tolerance) : "";
  }

  /** Take in a segment: what is integrated along it, and the extremes of its motion. */
  include(segment) {
    const { solution, mode, transition } = segment;
    this.steps += segment.steps;
    this.rolls = mode.status === STICKING && m.spins_for_ever(mode.top);
    if (!mode.touching) this.flightRecord.take(segment, highestGap(mode, solution));
    if (solution.count) this.includeSteps(mode, solution);
    this.lose(transition?.energy_lost ?? 0);
  }

  /** Work of all forces but the weight along the table's normal so far. */
  get totalWork() {
    return this.top.field ? new m.RunSums(...this.sums).total_work(this.top) : this.sums[WORK];
  }

  includeSteps(mode, solution) {
    const segment = this.addSegment(mode, solution, mode.label);
    const readConserved = segment.read(conserved, CONSERVED);
    const watchesForce = mode.touching && !this.flightRecord.rows.length;
    for (let step = 0; step < solution.count; step += 1) {
      const values = readConserved(segment.numbersAt(step, 0));
      this.monitor.check(values[0], values[1], values[2], this.work);
      this.integrate(segment, step);
      if (watchesForce) this.includeForce(segment, step);
      this.includeAxis(segment, step);
      if (!mode.touching) this.includeHeight(segment, step);
    }
  }

  addSegment(mode, solution, label) {
    const segment = new SegmentReader(mode, solution, label, this.top, this.units);
    this.segments.push(segment);
    return segment;
  }

  /** Add what is integrated along a step. */
  integrate(segment, step) {
    const { solution, rule } = segment;
    const middle = rule.nodes[rule.nodes.length >> 1];
    const pole = m.nearer_pole(solution.value(step, AXIS_Z, middle));
    if (pole !== this.pole) {
      const azimuth = Math.atan2(solution.value(step, 1, 0), solution.value(step, 0, 0));
      this.sums[TURN] = m.turn_in_chart(this.sums[TURN], azimuth, this.pole, pole);
      this.pole = pole;
    }
    segment.sums.set(this.sums, SUMS * step);
    segment.poles.push(pole);
    this.addUpTo(1, segment, step, pole, this.sums);
  }

  /** Add to sums what is gained up to a part of a step, and note the range of the normal force there. */
  addUpTo(part, segment, step, pole, sums) {
    const { knots } = segment.solution;
    const { nodes, weights } = segment.rule;
    const span = part * (knots[step + 1] - knots[step]);
    let lowest = Infinity;
    let highest = -Infinity;
    for (let i = 0; i < nodes.length; i += 1) {
      const gains = segment.ratesAt(step, part * nodes[i], pole);
      const weight = weights[i] * span;
      for (let k = 0; k < m.INTEGRALS; k += 1) sums[k] += weight * gains[k];
      lowest = Math.min(lowest, gains[FORCE]);
      highest = Math.max(highest, gains[FORCE]);
      if (segment.checksForce) this.monitor.check_force(gains[FORCE]);
      if (!(gains[MARGIN] >= m.NEGATIVE)) {
        const numbers = segment.numbersAt(step, part * nodes[i]);
        const [gap, pressing, reserve] = m.conditions(segment.mode, numbers);
        this.monitor.check_gap(gap);
        this.monitor.check_force(pressing);
        this.monitor.check_reserve(reserve);
      }
    }
    this.lowestForce = lowest;
    this.highestForce = highest;
  }

  /** Take in the normal force of the step that was integrated last. */
  includeForce(segment, step) {
    const { lowestForce, highestForce } = this;
    const bound = lowestForce - BETWEEN_NODES * (highestForce - lowestForce);
    this.leastForce.include(lowestForce, bound, segment, step, () => segment.force(step));
  }

  /** Take in the range of n_z in a step, and when it first falls to zero. */
  includeAxis(segment, step) {
    const { solution } = segment;
    const start = solution.value(step, AXIS_Z, 0);
    const [low, high] = solution.bounds(step, AXIS_Z);
    this.leastAxisZ.include(start, low, segment, step, () => reading(solution, step, AXIS_Z));
    this.mostAxisZ.include(-start, -high, segment, step, () => reading(solution, step, AXIS_Z, -1));
    if (low <= 0 && (high >= 0 || this.wasAbove) && Number.isNaN(this.firstHorizontal)) {
      const value = reading(solution, step, AXIS_Z);
      // Where one step ends and another begins with a level axis, as in an impact there, no step falls through zero.
      const fallsFromStart = this.wasAbove && start <= 0 && value(PROBES[1]) < 0;
      const terms = solution.coefficients(step, AXIS_Z);
      const part = fallsFromStart ? 0 : m.first_fall(terms, true);
      this.firstHorizontal = segment.time(step, part);
    }
    this.wasAbove ||= start > 0;
  }

  /** Take in how high the centre of mass is in a step of a flight. */
  includeHeight(segment, step) {
    const { solution } = segment;
    const start = solution.value(step, HEIGHT, 0);
    const [, high] = solution.bounds(step, HEIGHT);
    this.mostHeight.include(-start, -high, segment, step, () =>
      reading(solution, step, HEIGHT, -1),
    );
  }

  /** Put together what is asked of a run that has ended, in SI. */
  finish() {
    const { trajectory, units } = this;
    const { status, detail, state } = trajectory;
    this.breach ||= this.breachUntil(status);
    const trusted = this.breach ? m.Status.INACCURATE : status;
    this.status = {
      name: trusted.name.toLowerCase(),
      message: [trusted.value, detail, this.breach, m.ambiguity_of(this.happened)]
        .filter(Boolean)
        .join(" "),
    };
    this.early = trusted !== m.Status.COMPLETED && state.pack().every(Number.isFinite);
    const completed = status === m.Status.COMPLETED;
    this.endTime = completed ? this.duration : trajectory.time * units.time;
    const events = this.happened.map((event) => m.event_in_si(event, units));
    this.events = plain(events);
    this.flights = this.flightRecord.rows.map(([start, end, gap]) => ({
      start: start * units.time,
      end: end * units.time,
      max_gap: gap * units.length,
    }));
    const ends = this.ends(trusted);
    const metrics = m.metrics(ends, this.start, this.top, units);
    if (this.pushes.length) {
      // What pushes give and what lifts the table is in the difference of energies: the work of the rest is not.
      const lost = -(this.sums[WORK] + this.sums[AIR]) * units.energy;
      const given = lost - metrics.get("energy_lost");
      for (const name of ["energy_lost", "energy_lost_sliding"])
        metrics.set(name, metrics.get(name) + given);
    }
    this.metrics = Object.fromEntries(metrics.entries());
    metrics.set("end_time", this.endTime);
    const peak = [m.highest_seen(ends), this.peakTime()];
    const flights = this.flights.map(({ start, end }) => [start, end]);
    const since = this.since(m.settled_band(ends.settled));
    this.facts = new m.Facts(this.present, trusted, metrics, peak, since, events, flights);
    if (!this.segments.length) this.addLaunch();
  }

  /** What is found of the run in natural units, for `m.metrics`. */
  ends(status) {
    const { state, time } = this.trajectory;
    const { time: unit } = this.units;
    // Of every step the value at its start is taken in: the end of the last one is missing.
    const lastAxisZ = this.segments.length ? state.axis[2] : NaN;
    this.leastAxisZ.includeValue(lastAxisZ, null);
    this.mostAxisZ.includeValue(-lastAxisZ, null);
    const extremes = [this.leastForce, this.leastAxisZ, this.mostAxisZ, this.mostHeight];
    const settled = m.settled_tilt_of_one(status, state, this.from, this.top);
    const sums = new m.RunSums(...this.sums);
    return m.Ends.of_one(
      state,
      time,
      null,
      this.happened,
      this.flightRecord,
      this.steps,
      sums,
      sums.descent_work(this.top),
      extremes.map((extreme) => extreme.refined()),
      [this.firstHorizontal / unit, settled, this.arrival(m.settled_band(settled)) / unit],
      Number(this.rolls),
    );
  }

  /** When the tilt was largest, s, once `ends` has searched for it. */
  peakTime() {
    const { place } = this.leastAxisZ;
    if (!place) return this.trajectory.time * this.units.time;
    return place.segment.time(place.step, place.part);
  }

  /** The flights that begin on the table: how many there are, and the largest gap below them, m. */
  get jumps() {
    const jumps = this.flights.filter(({ start }) => m.is_jump(start, this.problem));
    const max_gap = Math.max(0, ...jumps.map((jump) => jump.max_gap));
    return { count: jumps.length, max_gap };
  }

  /** Whether the top rose and fell back. */
  get fellBack() {
    return m.fell_back(this.facts);
  }

  /** What became of the launch, as clauses of a name and numbers; what theory says of it ends with a push. */
  get account() {
    const clauses = clausesOf(this.facts);
    if (!this.pushes.length || this.status.name === "inaccurate") return clauses;
    const pushes = this.pushes.flatMap(clausesOfPush);
    const of = (part) => clauses.filter((clause) => clause.part === part);
    const launch = clausesOf(replace(this.facts, { problem: this.problem }));
    const motion = [...of("motion"), ...pushes].sort(
      (one, other) => (one.numbers.time ?? Infinity) - (other.numbers.time ?? Infinity),
    );
    return [...launch.filter(({ part }) => part === "launch"), ...motion, ...of("end")];
  }

  /** First time, s, at which n_z is in a band; NaN if it never is. */
  arrival([low, high]) {
    if (Number.isNaN(low)) return NaN;
    for (const segment of this.segments) {
      for (let step = 0; step < segment.solution.count; step += 1) {
        const part = firstPartInBand(segment.solution, step, low, high);
        if (!Number.isNaN(part)) return segment.time(step, part);
      }
    }
    return NaN;
  }

  /** Time, s, since which n_z stays in a band; NaN of a band of NaN. */
  since([low, high]) {
    if (Number.isNaN(low)) return NaN;
    for (const segment of [...this.segments].reverse()) {
      for (let step = segment.solution.count - 1; step >= 0; step -= 1) {
        const part = lastPartOutside(segment.solution, step, low, high);
        if (!Number.isNaN(part)) return segment.time(step, part);
      }
    }
    return 0;
  }

  /** Let a run that ended at its launch be sampled there, as if it slid. */
  addLaunch() {
    const [mode, numbers] = m.initial_mode(this.start, this.top);
    const still = DenseSolution.in_time([0, 1], [numbers.map((number) => [number])]);
    const segment = this.addSegment(mode, still, "sliding");
    segment.sums.set(this.sums);
    segment.poles.push(this.pole);
  }

  /** Every variable of the catalogue's SAMPLED at some times, s, or at so many from start to end. */
  track(when = m.DEFAULT_SAMPLES) {
    const times = typeof when === "number" ? this.grid(when) : Float64Array.from(when);
    const track = { time: times, mode: [] };
    for (const [name, variable] of Object.entries(CATALOGUE.sampled)) {
      track[name] = new Float64Array(times.length * variable.width);
    }
    times.forEach((time, i) => {
      this.sample(track, i, time);
    });
    makeContinuous(track.orientation);
    return track;
  }

  /** Times, s, that divide the duration evenly, up to the end of the run. */
  grid(count) {
    const times = [];
    for (let i = 0; i < count; i += 1) {
      const time = this.duration * (i / (count - 1));
      if (time <= this.endTime) times.push(time);
    }
    if (this.early && times.at(-1) < this.endTime) times.push(this.endTime);
    return Float64Array.from(times);
  }

  /** Put the variables at a time, s, into a track; where two segments meet, those of the earlier one. */
  sample(track, i, seconds) {
    const { segments } = this;
    const within = ({ solution, units }) => solution.end >= seconds / units.time;
    const segment = segments[earliest(segments.length, (k) => within(segments[k]))];
    const time = seconds / segment.units.time;
    const step = segment.solution.step(time);
    const part = segment.solution.part(step, time);
    const pole = segment.poles[step];
    const sums = segment.sums.slice(step * SUMS, (step + 1) * SUMS);
    this.addUpTo(part, segment, step, pole, sums);
    const samples = new m.Samples(
      time,
      segment.instantsAt(step, part),
      new m.RunSums(...sums),
      pole,
      null,
    );
    for (const [name, value] of m.observe(samples, segment.top, segment.units).entries()) {
      if (typeof value === "number") track[name][i] = value;
      else track[name].set(value, i * value.length);
    }
    track.mode.push(segment.label);
  }
}

/** The clauses of the account of a run, as plain data. */
const clausesOf = (facts) =>
  m.account_of(facts).map(({ name, numbers, part }) => ({
    name,
    numbers: Object.fromEntries(numbers.entries()),
    part,
  }));

/** The clauses of a push: what each change of it is. */
function clausesOfPush({ time, impulse, mu, slope }) {
  const clauses = [];
  if (impulse > 0) clauses.push(["is_pushed", { time }]);
  if (mu !== null) clauses.push(["meets_friction", { time }]);
  if (slope !== null) clauses.push(["meets_slope", { time, tilt: slope }]);
  return clauses.map(([name, numbers]) => ({ name, numbers, part: "motion" }));
}

/** A transition whose events are later by a time. */
function after(transition, time) {
  const events = transition.events.map((event) => replace(event, { time: event.time + time }));
  return replace(transition, { events });
}

/** A solution in a contact mode, of a top in natural units, and what is read off its numbers. */
class SegmentReader {
  constructor(mode, solution, label, top, units) {
    this.mode = mode;
    this.top = top;
    this.units = units;
    this.checksForce = mode instanceof m.ContactMode || mode instanceof m.TransientMode;
    this.solution = solution;
    this.label = label;
    this.read = reader(mode, solution.size);
    this.readRates = this.read(rates, RATES);
    this.readInstants = null;
    this.numbers = new Float64Array(solution.size);
    // What is integrated up to the start of every step, and the pole that the turn is counted around in it.
    this.sums = new Float64Array(SUMS * solution.count);
    this.poles = [];
    // Gauss's rule with four nodes is exact up to degree 7.
    this.rule = GAUSS[solution.degree > 7 ? 8 : 4];
  }

  /** When a part of a step has passed, s. */
  time(step, part) {
    return this.solution.time(step, part) * this.units.time;
  }

  /** The numbers at a part of a step, in an array that the next call overwrites. */
  numbersAt(step, part) {
    return this.solution.numbers(step, part, this.numbers);
  }

  /** `Rates` at a part of a step, in an array that the next call overwrites. */
  ratesAt(step, part, pole) {
    return this.readRates(this.numbersAt(step, part), pole);
  }

  /**
   * The normal force in a step, as a function of the part that has passed: a polynomial, or, where it jumps because the
   * contact passes to a part of a surface with another curvature, the force itself. That is not read at the very ends:
   * where slip is zero but for rounding, the direction of friction is undefined.
   */
  force(step) {
    const force = (part) => this.ratesAt(step, part, 1)[FORCE];
    const fitted = reading(
      DenseSolution.fitted((part) => [force(part)], [0, 1], FORCE_DEGREE),
      0,
      0,
    );
    const inner = PROBES.slice(1, -1);
    if (inner.every((part) => Math.abs(fitted(part) - force(part)) <= SMOOTH_FORCE)) return fitted;
    return (part) => force(Math.min(Math.max(part, NEAR_END), 1 - NEAR_END));
  }

  /** `Instants` at a part of a step. */
  instantsAt(step, part) {
    this.readInstants ??= this.read(m.instants, m.TOLD);
    return m.Instants.unpack(this.readInstants(this.solution.numbers(step, part)));
  }
}

/** The least value of a quantity along a run: the values it is known to take, and where it may be less. */
class LeastValue {
  value = Infinity;
  /** Where it takes this value: a segment, a step and its part; null for the end of the run. */
  place = null;
  candidates = [];

  includeValue(value, place) {
    const least = Math.min(this.value, value);
    if (least !== this.value) this.place = place;
    this.value = least;
  }

  /**
   * Take in a value in a step of a segment, and the step itself if the quantity may be less there, down to a bound;
   * `makeValues` makes the quantity as a function of the part that has passed.
   */
  include(value, bound, segment, step, makeValues) {
    this.includeValue(value, { segment, step, part: 0 });
    if (bound < this.value) this.candidates.push({ bound, segment, step, makeValues });
  }

  /** The least value, searched for in the steps where it may be. */
  refined() {
    const candidates = this.candidates.filter(({ bound }) => bound < this.value);
    candidates.sort((a, b) => a.bound - b.bound);
    for (const { bound, segment, step, makeValues } of candidates) {
      if (bound >= this.value) break;
      const { part, value } = leastInStep(makeValues(), this.value);
      this.includeValue(value, { segment, step, part });
    }
    return this.value;
  }

  /** Go over to another unit, from that which was. */
  change(unit) {
    this.value = this.refined() / unit;
    this.candidates = [];
  }
}

/** One of a source's numbers in a step, or its negative, as a function of the part that has passed. */
function reading(source, step, number, sign = 1) {
  return (part) => sign * source.value(step, number, part);
}

/** The least value of a function on [0, 1], and where; Infinity where none may be below a threshold. */
function leastInStep(values, threshold) {
  let low = Infinity;
  let high = -Infinity;
  let lowest = 0;
  for (let probe = 0; probe <= PROBES_PER_STEP; probe += 1) {
    const value = values(PROBES[probe]);
    if (value < low) {
      low = value;
      lowest = probe;
    }
    if (value > high) high = value;
  }
  const range = high - low;
  if (low - BETWEEN_PROBES * range > threshold) return { part: 0, value: Infinity };
  const start = PROBES[Math.max(lowest - 1, 0)];
  const end = PROBES[Math.min(lowest + 1, PROBES_PER_STEP)];
  // The search stops at values below zero, so that these are raised above it.
  const [dip] = m.dip((part) => values(part) - low + range, start, end);
  const dipValue = values(dip);
  if (dipValue < low) return { part: dip, value: dipValue };
  return { part: PROBES[lowest], value: low };
}

/** The highest gap in a segment of a flight. */
function highestGap(mode, solution) {
  const read = reader(mode, solution.size)(depth, 1);
  const numbers = new Float64Array(solution.size);
  let lowest = 0;
  for (let step = 0; step < solution.count; step += 1) {
    const values = (part) => read(solution.numbers(step, part, numbers))[0];
    lowest = Math.min(lowest, leastInStep(values, lowest).value);
  }
  return -lowest;
}

/** The first part of a step at which n_z is in a band; NaN if it is not in that step. */
function firstPartInBand(solution, step, low, high) {
  const start = solution.value(step, AXIS_Z, 0);
  const [least, most] = solution.bounds(step, AXIS_Z);
  if (least > high || most < low) return NaN;
  if (start <= high && start >= low) return 0;
  const terms = solution.coefficients(step, AXIS_Z);
  return m.first_fall(start > high ? changed(terms, 1, -high) : changed(terms, -1, low));
}

/** The last part of a step at which n_z is not in a band; NaN if it is in it all along. */
function lastPartOutside(solution, step, low, high) {
  const [least, most] = solution.bounds(step, AXIS_Z);
  if (least >= low && most <= high) return NaN;
  const last = solution.value(step, AXIS_Z, 1);
  if (last > high || last < low) return 1;
  const rest = shifted(solution.coefficients(step, AXIS_Z), 1, -1);
  const exits = [changed(rest, -1, high), changed(rest, 1, -low)]
    .map((terms) => m.first_fall(terms))
    .filter((part) => !Number.isNaN(part));
  return exits.length ? 1 - Math.min(...exits) : NaN;
}

/** The coefficients of a polynomial times a sign and plus a number. */
const changed = (terms, sign, shift) => terms.map((term, k) => sign * term + (k ? 0 : shift));

/** Give quaternions in a row the signs that let none jump. */
function makeContinuous(quaternions) {
  for (let i = 4; i < quaternions.length; i += 4) {
    let product = 0;
    for (let k = i; k < i + 4; k += 1) product += quaternions[k] * quaternions[k - 4];
    if (product < 0) {
      for (let k = i; k < i + 4; k += 1) quaternions[k] = -quaternions[k];
    }
  }
}
