"""Derivatives of the variables of a run: what runs beside it show, at distances that suit each."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Self

import numpy as np
from numpy.typing import NDArray

from tippetop.fit.linearized_run import (
    EVENT_STATES,
    FOUR,
    RULE_ROUNDING,
    Differs,
    LinearizedRun,
    RunReading,
)
from tippetop.integrators.base import Array
from tippetop.results.catalogue import DERIVED, LISTED, METRICS, SAMPLED, Variable

DISTANCES = (1e-4, 1e-5, 1e-6, 1e-7)
"""How far beside the run its variables are read off, in natural units, one after the other: the
error of the rule is the fourth power of that over the scale on which a variable changes, which is
1e-2 for normal forces and less near a pole, and rounding over it.
"""

FIRST_DISTANCE, SMALL_CHANGE = 1e-3, 3e-7
"""The distance that comes first, where the nearest of the others is a change of the field, in its
scale, so small that rounding in it is more than `NIL`: where derivatives are large for moments, as
near a pole.
"""

SETTLED = 1e-8
"""Error of the rule over the largest derivative of a variable up to which nearer runs are not asked
for."""

DIGITS = 5e-7
"""Difference of derivatives that are found by other distances beside the run, over the largest of
their variable by any field, beyond which fewer than six digits count as known: half of the sixth
digit."""

NIL = 1e-9
"""Change of a variable over its largest value, or its natural unit if that is more, where a field
changes by its own size, below which no digits of a derivative are asked for: it may be zero but for
rounding."""

WITHIN = 30.0
"""How many times the rounding that is followed through a run a derivative that is zero may be: an
impact rounds ten times and more.
"""

TIMES = {"time": "time", "event": "event_time"}
"""Variables with the times of the values along a dimension."""

TURN = 2.0 * np.pi


@dataclass(frozen=True)
class Slopes:
    """Derivatives of a variable with respect to a field."""

    values: Array
    """The derivatives, of the shape of the variable."""
    errors: Array
    """Estimates of the errors of the rule, of the same shape."""
    rounding: float
    """Estimate of the errors by rounding."""
    times: Array | None
    """When the run has the values, s, shape (k,); None of metrics and of flights."""
    is_settled: bool
    """Whether nearer runs would show no more."""

    @property
    def largest(self) -> float:
        """Size of the largest derivative."""
        return size_of(self.values)

    def up_to(self, second: Self) -> Self:
        """Return the derivatives of as many values as another run has."""
        if not self.values.ndim:
            return self
        common = slice(min(len(self.values), len(second.values)))
        times = None if self.times is None else self.times[common]
        return replace(self, values=self.values[common], errors=self.errors[common], times=times)

    def better(self, second: Self) -> Self:
        """Return of each two derivatives the one whose estimated error is less."""
        mine, others = self.up_to(second), second.up_to(self)
        is_less = others.errors + others.rounding < mine.errors + mine.rounding
        return replace(
            mine,
            values=np.where(is_less, others.values, mine.values),
            errors=np.where(is_less, others.errors, mine.errors),
            rounding=max(mine.rounding, others.rounding),
        )

    def before(self, end: float) -> Self:
        """Return the derivatives, NaN from a time on, s; without times all, if there is such a
        time.
        """
        if self.times is None:
            values = self.values if end == np.inf else np.full_like(self.values, np.nan)
        else:
            values = self.values.copy()
            values[self.times >= end] = np.nan
        return replace(self, values=values)

    def zeros_beside(self, second: Self, rounding: Self, bound: float) -> NDArray[np.bool_]:
        """Return where the derivatives, and those by differences at another distance, `second`, are
        no more than what rounding has made of them up to then, and that is within a bound.
        """
        count = len(self.values) if self.values.ndim else 0
        sizes = np.maximum(np.abs(self.values), _padded(np.abs(second.values), count))
        within = _padded(WITHIN * np.abs(rounding.values), count)
        if within.ndim:
            others = tuple(range(1, within.ndim))
            grown = np.maximum.accumulate(np.max(within, axis=others, keepdims=True, initial=0.0))
            within = np.broadcast_to(grown, within.shape)
        return np.asarray((sizes <= within) & (within <= bound))

    def known_beside(self, second: Self, bound: float) -> Array:
        """Return the derivatives, NaN where differences at another distance, `second`, or their own
        estimated errors are off by more than a bound, or `second` has none.
        """
        count = len(self.values) if self.values.ndim else 0
        off = np.maximum(np.abs(self.values - _padded(second.values, count)), self.errors)
        return np.where(off <= bound, self.values, np.nan)


def slopes_of(
    run: LinearizedRun, direction: int, distances: Sequence[float] = DISTANCES
) -> dict[str, Slopes]:
    """Return the derivatives of the variables of a run with respect to a field, by name, read off
    at some distances beside it.

    Where no run beside it goes through its events from some time on, the run is told so (see
    `LinearizedRun.failures`).
    """
    best = dict[str, Slopes]()
    while not best:
        is_small = run.reach(direction, DISTANCES[0]) < SMALL_CHANGE
        for distance in (FIRST_DISTANCE, *distances) if is_small else distances:
            change = run.reach(direction, distance)
            try:
                readings = [run.read_beside(direction, place * change) for place, _ in FOUR]
            except Differs as differs:
                error = differs
                continue
            nearer = differences(readings, change * run.fields[direction].scale)
            best = {name: one.better(best.get(name, one)) for name, one in nearer.items()}
            if all(one.is_settled for one in nearer.values()):
                break
        if not best:
            run.fail(direction, error.time, str(error))
    end = run.failures.get(direction, (np.inf, ""))[0] * float(run.numbers.units[2])
    return {name: one.before(end) for name, one in best.items()}


def differences(readings: Sequence[RunReading], step: float) -> dict[str, Slopes]:
    """Return the derivatives of the variables by what four runs show, at the places of `FOUR`.

    The rule's error is estimated by the square of that of the rule over the two nearer runs, which
    the four show.
    """
    shown = [one.variables for one in readings]
    slopes = dict[str, Slopes]()
    for name, variable in described().items():
        variables = [one[name] for one in shown]
        if variables[0].dtype.kind != "f":
            continue
        over = variables[0].dims[:1]
        # Where derivatives end, one of the runs may have a sample or an event more.
        common = slice(min(len(one) for one in variables)) if over else ...
        far_low, low, high, far_high = [one.values[common] for one in variables]
        near, far = high - low, far_high - far_low
        if variable.units == "rad":
            near, far = (np.remainder(one + 0.5 * TURN, TURN) - 0.5 * TURN for one in (near, far))
        values = (8.0 * near - far) / (12.0 * step)
        of_two = near / (2.0 * step)
        largest = max(size_of(values), float(np.finfo(float).tiny))
        truncation = 4.0 * (values - of_two) ** 2 / largest
        rounding = RULE_ROUNDING * size_of(high) / step
        is_settled = not np.any(truncation > max(SETTLED * largest, rounding))
        when = TIMES.get(str(over[0])) if over else None
        times = None if when is None else shown[2][when].values[common]
        slopes[name] = Slopes(values, truncation, rounding, times, is_settled)
    return slopes


def _padded(values: Array, count: int) -> Array:
    """Return so many values, NaN beyond their end; a number as it is."""
    if not values.ndim:
        return values
    return np.concatenate([values, np.full((count, *values.shape[1:]), np.nan)])[:count]


def size_of(values: Array) -> float:
    """Return the size of the largest of some values but those that are missing; 0 of none."""
    return float(np.max(np.abs(values), initial=0.0, where=~np.isnan(values)))


def described() -> dict[str, Variable]:
    """Return all variables of a run that may have derivatives, by name."""
    return {**SAMPLED, **DERIVED, **METRICS, **LISTED, **EVENT_STATES}
