// What a mode says of its numbers, and what is read off a state: the mechanics, compiled once a kind.
import {
  Flight, State, angular_velocity, axial_spin, axis_sine, contact_vector, dot, energy, fly, jellett,
  point_velocity, precession_rate, slip_along_tilt, tilt_rate, turn_rate, resistance_powers,
} from "./mechanics.js";
import { compiled } from "./compile.js";
import { ELEMENTARY } from "./dense.js";
import { cached, replace } from "./runtime.js";

export const STATE = 0, FORCE = 10, TORQUE = 13, POWER = 16, ENERGY = 17, JELLETT = 18, DRILLING = 19, ROLLING = 20,
  TURNING = 21, OUTPUTS = 22;
export const SINE = 0, PRECESSION = 1, TILTING = 2, SPIN = 3, POINT = 4, SLIP = 7, ARM = 9, INTEGRAL = 10, OMEGA = 11, SEEN = 14;

const numbersOf = (tops) => tops.flatMap((top) => top.numbers);

/** The state of a mode and what the table does, with what is integrated; the pole of the chart is the last parameter. */
export function observed(mode, size) {
  const kinds = mode.tops.map((top) => top.kind), parameters = numbersOf(mode.tops);
  const holder = holders(mode.form, kinds, size);
  holder.code ??= observing(mode, kinds, size);
  return { code: holder.code, parameters: Float64Array.of(...parameters, 1) };
}

const holders = cached((form, kinds, size) => ({ form, kinds, size, code: null }));

function observing(mode, kinds, size) {
  const count = kinds.reduce((total, kind) => total + kind.numbers, 0);
  const values = (y, p) => {
    const tops = [];
    let from = 0;
    for (const kind of kinds) tops.push(kind.top(p.slice(from, (from += kind.numbers))));
    const here = replace(mode, tops.length > 1 ? { top: tops[0], other: tops[1] } : { top: tops[0] });
    const state = here.state(y), table = here.reaction(y), [top] = tops;
    return [
      ...state.pack(), ...table.force, ...table.torque, table.power, energy(state, top), jellett(state, top),
      ...resistance_powers(state, table.resistance, top), turn_rate(state.axis, state.momentum, p[count], top),
    ];
  };
  return compiled(values, size, count + 1, OUTPUTS);
}

const flying = cached((kind) =>
  compiled((y, p) => fly(State.unpack(p), y[0], kind.top(p.slice(10)), ELEMENTARY).pack(), 1, 10 + kind.numbers, 10));

/** A flight's numbers as a function of its time, compiled. */
Flight.prototype._numbers = function numbers(state) {
  const code = flying(this.top.kind), given = Float64Array.of(...state.pack(), ...this.top.numbers);
  const time = new Float64Array(1), out = new Float64Array(10);
  const found = (elapsed) => {
    time[0] = elapsed;
    code(time, given, out);
    return out;
  };
  return Object.assign(found, { size: 10 });
};

/** What is seen of a state on the surface that is lowest. */
export function seen(top) {
  return { code: seeing(top.kind), parameters: Float64Array.from(top.numbers) };
}

const seeing = cached((kind) =>
  compiled((y, p) => {
    const top = kind.top(p), { axis, momentum, velocity } = State.unpack(y);
    const omega = angular_velocity(axis, momentum, top), arm = contact_vector(axis, top.surface);
    const point = point_velocity(velocity, omega, arm);
    return [
      axis_sine(axis), precession_rate(axis, momentum, top), tilt_rate(axis, momentum, top), axial_spin(axis, momentum, top),
      ...point, ...slip_along_tilt(axis, point), arm[2], dot(momentum, arm), ...omega,
    ];
  }, 10, kind.numbers, SEEN));
