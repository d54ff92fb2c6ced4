"""Events of users' functions: changes of sign of functions of the state, located during a run.

Crossings are located on the dense solution of each step: Python code that branches on numbers
cannot be recorded and compiled as the guards of contact modes are, and the dense solution is exact
to rounding, so that one mechanism serves all functions. The integrator takes the same steps with
and without them.

`tippetop.integrators.zero_crossings.brackets`, the search for guards, is another one for three
reasons. It looks along one guard of one step for the first fall from above, where this one lists
every crossing, in either direction. It evaluates numbers one by one, where this one calls a
function once for all steps of a block: of functions written in NumPy a call costs as much as
hundreds of its values. And a function of a user may jump, within a step and across an impact
between two, which counts as a crossing; a guard does not.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tippetop.contact.block import Block, in_blocks
from tippetop.contact.mode import EventKind, Status, Transition
from tippetop.contact.trajectory import Trajectory
from tippetop.integrators.base import Array
from tippetop.mechanics.natural_units import Units
from tippetop.mechanics.state import State
from tippetop.results.motion_state import MotionState, states_in
from tippetop.support.errors import InvalidInput, is_number
from tippetop.support.suggestions import not_one_of

INTERVALS_PER_STEP = 16
"""Intervals of a step at whose ends a function is evaluated. With fewer, crossings of functions
that vary faster than the motion are missed; with more, every step costs more.
"""

KINDS = tuple(kind.value for kind in EventKind)
"""Names of the events that every run reports."""

UNTIL = "until"
"""Name of the event of a function passed as `until`."""

Value = Callable[[MotionState], Any]


@dataclass(frozen=True)
class EventFunction:
    """Function of the state whose changes of sign are events.

    Instead of an instance, a function may be passed that has the attributes `direction` and
    `terminal`, as for `scipy.integrate.solve_ivp`.

    Attributes
    ----------
    function
        Function of a `MotionState` that returns a number.
    direction
        1 for crossings from below only, -1 for those from above only, 0 for both.
    terminal
        Whether the first crossing ends the run.

    Examples
    --------
    >>> import tippetop as tt
    >>> falls = tt.extend.EventFunction(lambda s: s.axis[2], direction=-1, terminal=True)
    >>> run = tt.simulate(tt.presets.report_problem(), 20.0, events={"level": falls})
    >>> run.attrs["status"], round(float(run["end_time"]), 3)
    ('stopped', 5.879)
    """

    function: Value
    direction: int = 0
    terminal: bool = False

    def __call__(self, state: MotionState) -> Any:
        """Return the value of the function."""
        return self.function(state)


class FunctionEvent(NamedTuple):
    """Change of sign of a user's function."""

    time: float
    """Time, in the units of the run."""
    name: str
    """Name of the function."""


class Stop(NamedTuple):
    """End of a run at a terminal event."""

    block: Block
    """Steps of the block up to the event."""
    time: float
    state: State
    """Time and state of the event, in the units of the run."""
    name: str
    """Name of the event."""


class EventSearch:
    """Search for events of functions, and for the event that ends the run, block by block.

    Parameters
    ----------
    events
        Functions of the state by the names of their events.
    until
        Event that ends the run: the name of a function or of a kind of event, or a function.
    units
        Units of the run.

    Raises
    ------
    InvalidInput
        If there is no such event, or a function or its attributes are not accepted.
    """

    def __init__(
        self, events: Mapping[str, Value] | None, until: str | Value | None, units: Units
    ) -> None:
        self.units = units
        self.functions = _checked(events)
        self.kind: str | None = None
        if callable(until):
            self.functions[UNTIL] = _event_function(UNTIL, until, terminal=True)
        elif isinstance(until, str) and until in self.functions:
            self.functions[until] = _event_function(until, self.functions[until], terminal=True)
        elif until in KINDS:
            self.kind = str(until)
        elif until is not None:
            raise not_one_of("until", until, ["a function", *self.functions, *KINDS])
        self.events = list[FunctionEvent]()
        self._signs = dict[str, float]()

    def blocks_of(self, trajectory: Trajectory) -> Iterator[Block]:
        """Yield the blocks of a trajectory up to its end, or to the event that ends it."""
        if self._is_end(trajectory.start):
            trajectory.events += trajectory.start.events
            self._end(trajectory, 0.0, trajectory.start.state, str(self.kind))
            return
        for block in in_blocks(trajectory.segments()):
            stop = self._take(block)
            if stop is None:
                yield block
            else:
                self._end(trajectory, stop.time, stop.state, stop.name)
                yield stop.block
                return

    def _end(self, trajectory: Trajectory, time: float, state: State, name: str) -> None:
        """End a trajectory at an event."""
        when = f"That event is {name!r}, at {time * self.units.time:.6g} s."
        trajectory.end_at(time, state, Status.STOPPED, when)

    def _is_end(self, transition: Transition) -> bool:
        """Return whether a transition has an event of the kind that ends the run."""
        return self.kind in [event.kind.value for event in transition.events]

    def _take(self, block: Block) -> Stop | None:
        """Record the events of functions in a block; return the end of the run if it is in it."""
        stop = self._stop_at_kind(block)
        if not self.functions or not len(block.starts):
            return stop
        step = np.repeat(np.arange(len(block.starts)), INTERVALS_PER_STEP + 1)
        part = np.tile(np.linspace(0.0, 1.0, INTERVALS_PER_STEP + 1), len(block.starts))
        states = states_in(block, step, part, self.units)
        events = list[FunctionEvent]()
        for name, function in self.functions.items():
            values = _values(name, function, states)
            crossing = self._crossings(name, function, block, (step, part, values))
            for in_step, at in zip(*crossing, strict=True):
                time = float(block.starts[in_step] + at * block.spans[in_step])
                events.append(FunctionEvent(time, name))
                if function.terminal and (stop is None or time < stop.time):
                    stop = Stop(*block.until(int(in_step), float(at)), name)
                    break
        self.events += [one for one in sorted(events) if stop is None or one.time <= stop.time]
        return stop

    def _stop_at_kind(self, block: Block) -> Stop | None:
        """Return the end of the first segment that ends with an event of the kind sought, or
        None.
        """
        if self.kind is None:
            return None
        for number, segment in enumerate(block.segments):
            follows = segment.transition
            if follows is not None and self._is_end(follows):
                some = Block(block.segments[: number + 1])
                return Stop(some, segment.end_time, follows.state, self.kind)
        return None

    def _crossings(
        self,
        name: str,
        function: EventFunction,
        block: Block,
        probes: tuple[NDArray[np.intp], Array, Array],
    ) -> tuple[NDArray[np.intp], Array]:
        """Return the steps in which a function changes sign, and the fraction of each step then.

        `probes` has the steps, the fractions and the values at which the function was evaluated.
        """
        # SciPy is slow to import, and needed only if there are functions.
        from scipy.optimize.elementwise import find_root  # noqa: PLC0415

        def evaluate(part: Array, step: Array) -> Array:
            part, step = np.broadcast_arrays(part, step)
            which = step.astype(np.intp).ravel()
            states = states_in(block, which, part.ravel(), self.units)
            return _values(name, function, states).reshape(part.shape)

        step, part, values = _with_dips(evaluate, *probes)
        # The sign at the end of the block before precedes the first probe.
        signs = np.concatenate([[self._signs.get(name, 0.0)], np.sign(values)])
        nonzero = np.flatnonzero(signs)
        if len(nonzero):
            self._signs[name] = float(signs[nonzero[-1]])
        before, after = nonzero[:-1], nonzero[1:]
        changes = signs[before] * signs[after] < 0.0
        if function.direction:
            changes &= signs[after] == np.sign(function.direction)
        low, high = before[changes] - 1, after[changes] - 1
        # If probes at zero lie between, the first of them is the crossing. If a step ends between,
        # it is the start of the next one: zero is there to rounding, or an impact jumps over it.
        place = low + 1
        crossing_step, crossing_part = step[place], part[place]
        inside = np.flatnonzero((high == place) & (low >= 0) & (step[low] == step[place]))
        if len(inside):
            ends = np.stack([low[inside], place[inside]])
            root = find_root(
                evaluate, tuple(part[ends]), args=(crossing_step[inside].astype(float),)
            )
            # A value within rounding of zero may have the other sign when evaluated again.
            sizes = np.abs(values[ends])
            nearest = np.where(sizes[0] < sizes[1], part[ends[0]], part[ends[1]])
            crossing_part[inside] = np.where(root.success, root.x, nearest)
        return crossing_step, crossing_part


def _with_dips(
    evaluate: Callable[[Array, Array], Array], step: NDArray[np.intp], part: Array, values: Array
) -> tuple[NDArray[np.intp], Array, Array]:
    """Return the probes with further ones where a function dips through zero and comes back."""
    from scipy.optimize.elementwise import find_minimum  # noqa: PLC0415 - see `_crossings`

    table = values.reshape(-1, INTERVALS_PER_STEP + 1)
    which, probe = np.indices(table.shape)
    middle = np.clip(probe, 1, INTERVALS_PER_STEP - 1)
    before, at, after = (table[which, middle + k] for k in (-1, 0, 1))
    sign = np.sign(table)
    bend = sign * (before - 2.0 * at + after)
    with np.errstate(all="ignore"):
        vertex = (middle + 0.5 * sign * (before - after) / bend) / INTERVALS_PER_STEP
    low, high = (
        np.maximum(probe - 1, 0) / INTERVALS_PER_STEP,
        np.minimum(probe + 1, INTERVALS_PER_STEP) / INTERVALS_PER_STEP,
    )
    near = (bend > 0.0) & (np.abs(table) <= bend) & (vertex > low) & (vertex < high)
    near &= (np.sign(before) == sign) & (np.sign(after) == sign)
    if not near.any():
        return step, part, values
    in_step, signs = which[near].astype(float), sign[near]

    def distance(part: Array, step: Array, side: Array) -> Array:
        return np.asarray(side * evaluate(part, step))

    bracket = low[near], vertex[near], high[near]
    least = find_minimum(distance, bracket, args=(in_step, signs))
    through = np.flatnonzero(least.success & (least.f_x < 0.0))
    step = np.concatenate([step, which[near][through]])
    part = np.concatenate([part, least.x[through]])
    values = np.concatenate([values, signs[through] * least.f_x[through]])
    order = np.lexsort((part, step))
    return step[order], part[order], values[order]


def _checked(events: Mapping[str, Value] | None) -> dict[str, EventFunction]:
    """Return the functions by name, with their attributes."""
    if events is None:
        return {}
    if not isinstance(events, Mapping):
        raise InvalidInput("events", events, "a table of functions by the names of their events")
    for name in events:
        if not isinstance(name, str) or not name or name in (*KINDS, UNTIL):
            accepted = f"a name other than those of the run's events: {', '.join((*KINDS, UNTIL))}"
            raise InvalidInput("events", name, accepted)
    return {name: _event_function(name, function) for name, function in events.items()}


def _event_function(name: str, function: Value, terminal: bool | None = None) -> EventFunction:
    """Return a function with its attributes; `terminal`, if not None, replaces its own."""
    field = _field(name)
    if not callable(function):
        raise InvalidInput(field, function, "a function of the state that returns a number")
    direction = getattr(function, "direction", 0)
    if not is_number(direction) or direction not in (-1, 0, 1):
        raise InvalidInput(f"{field}.direction", direction, "-1, 0 or 1")
    ends = getattr(function, "terminal", False) if terminal is None else terminal
    if not isinstance(ends, bool):
        raise InvalidInput(f"{field}.terminal", ends, "True or False")
    return EventFunction(function, int(direction), ends)


def _values(name: str, function: EventFunction, states: MotionState) -> Array:
    """Return the values of a function at n instants, shape (n,).

    It is called once for all of them, or once for each if it does not accept arrays.
    """
    try:
        values = np.asarray(function(states))
    except Exception:  # noqa: BLE001 - the calls with single numbers say what is wrong
        values = np.empty(0)
    if values.shape != states.time.shape or values.dtype.kind not in "iuf":
        values = np.array([_value(name, function, state) for state in states.each()])
    bad = np.flatnonzero(~np.isfinite(values))
    if len(bad):
        raise _no_number(name, states.time[bad[0]], float(values[bad[0]]))
    return values.astype(float)


def _value(name: str, function: EventFunction, state: MotionState) -> float:
    """Return the value of a function at one instant."""
    try:
        value = function(state)
    except Exception as error:
        raise _no_number(name, state.time, error) from error
    if not is_number(value):
        raise _no_number(name, state.time, value)
    return float(value)


def _no_number(name: str, time: float, value: object) -> InvalidInput:
    """Return the refusal of a function that returns or raises `value` at a time, s."""
    accepted = f"a function of the state that returns a finite number, also at {time:.4g} s"
    return InvalidInput(_field(name), value, accepted)


def _field(name: str) -> str:
    """Return the name of the argument that holds the function of an event."""
    return UNTIL if name == UNTIL else f"events[{name!r}]"
