"""From numbers of a problem and of the instruments to the values of measurements, and back.

`Model.values` follows one run and asks every measurement what it would have shown. `Model.jacobian`
has the derivatives by extrapolated central differences of runs that go through the same sequence of
events.
"""

import warnings
from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

import numpy as np
import xarray as xr

from tippetop.fit.measurement import Measurement
from tippetop.integrators.base import Array
from tippetop.mechanics.top import natural_units
from tippetop.problem.implausible import Implausible
from tippetop.problem.problem import Problem, get
from tippetop.run import simulate
from tippetop.support.errors import InvalidInput, is_number
from tippetop.support.units import exponents_of

STEP = 3e-5
"""Step of differences, relative to the scale of a number.

The phase of a spin of a thousand radians moves by 0.03 rad: smaller steps meet the rounding of
runs, larger ones the third derivative of such a phase.
"""

SMALLEST_SCALE = 0.01
"""Least scale of a number, in natural units: numbers such as a rate at launch may be zero."""

SHORTER = 0.25
"""How much shorter a step is made where two runs differ in their events."""

TRIES = 4
"""Steps that are tried until two runs have the same events."""


NEGLIGIBLE = 1e-8
"""Change of the values, relative to them, for a change of a number by its size, below which they do
not depend on it: what is smaller is rounding of runs over the step of differences."""


class PredictedData(NamedTuple):
    """What a run shows."""

    values: Array
    """Of all measurements, one after the other, shape (numbers,)."""
    events: tuple[str, ...]
    """Kinds of the events of the run, in order."""


class Model:
    """Values of measurements as a function of numbers.

    Attributes
    ----------
    names
        Names of the numbers: fields of the problem, then numbers of the instruments.
    fields
        How many of them are fields of the problem.
    runs
        How many runs were followed.
    reasons
        Why a derivative does not exist, by the names of the numbers.
    """

    def __init__(
        self, problem: Problem, measurements: Sequence[Measurement], fields: Sequence[str]
    ) -> None:
        self.problem, self.measurements = problem, tuple(measurements)
        self.fields, self.runs, self.reasons = tuple(fields), 0, dict[str, str]()
        for field in fields:
            try:
                number = get(problem, field)
            except InvalidInput as error:
                hint = error.hint
                raise InvalidInput("vary", field, error.accepted, hint=hint) from None
            if not is_number(number):
                accepted = "the name of a field with a number, such as friction.mu"
                raise InvalidInput("vary", field, accepted)
        several = len(self.measurements) > 1
        self.instruments = tuple(
            {name: f"{place}.{name}" if several else name for name in one.observation.parameters}
            for place, one in enumerate(self.measurements)
        )
        self.names = (*self.fields, *(name for one in self.instruments for name in one.values()))
        end = max(one.duration for one in self.measurements)
        self.times = np.unique(np.concatenate([[0.0, end], *(m.times for m in self.measurements)]))
        self.data = np.concatenate([one.values.ravel() for one in self.measurements])

    @property
    def start(self) -> Array:
        """The problem's own numbers, and the instruments' that fit best to its run."""
        fields = [float(get(self.problem, field)) for field in self.fields]
        return self.with_instruments(np.array(fields))

    def with_instruments(self, fields: Array) -> Array:
        """Return numbers with those of the instruments that fit best to the run of some fields."""
        numbers = list(fields)
        if len(self.names) > len(self.fields):
            run = self.run(np.asarray(fields))
            for one, names in zip(self.measurements, self.instruments, strict=True):
                guess = one.observation.guess(self._seen(run, one), one.values)
                numbers += [guess[name] for name in names]
        return np.array(numbers, dtype=float)

    def problem_of(self, numbers: Array) -> Problem:
        """Return the problem with its varied fields replaced."""
        return self.problem.replace(
            dict(zip(self.fields, map(float, numbers[: len(self.fields)]), strict=True))
        )

    def run(self, numbers: Array) -> xr.Dataset:
        """Return the run that shows all measurements."""
        self.runs += 1
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", Implausible)
            return simulate(self.problem_of(numbers), float(self.times[-1]), times=self.times)

    def predict(self, numbers: Array, run: xr.Dataset | None = None) -> PredictedData:
        """Return what the run of these numbers shows; NaN after its end and where nothing is."""
        run = self.run(numbers) if run is None else run
        values = list[Array]()
        for one, names in zip(self.measurements, self.instruments, strict=True):
            table = one.observation(self._seen(run, one), self._instrument(names, numbers))
            if table.shape != one.values.shape:
                accepted = f"values of shape {one.values.shape}, as the data"
                raise InvalidInput("function", f"values of shape {table.shape}", accepted)
            if len(one.times):
                table = np.where((one.times <= float(run["end_time"]))[:, None], table, np.nan)
            values.append(table.ravel())
        return PredictedData(np.concatenate(values), tuple(map(str, run["event_kind"].values)))

    def jacobian(self, numbers: Array, *, exact: bool) -> Array:
        """Return the derivatives of the values, shape (values, numbers).

        Those with respect to instruments need no run. Those with respect to fields are differences
        of two runs, good enough to step by. If `exact`, they are extrapolated from four runs, all
        with the same events, and a column is NaN where no short step leads to such runs: `reasons`
        says so.
        """
        run = self.run(numbers)
        center = self.predict(numbers, run)
        columns = list[Array]()
        largest = np.nanmax(np.abs(center.values))
        for place, scale in enumerate(self.scales(numbers)):
            of_field = place < len(self.fields)
            column = self._column(numbers, place, center, None if of_field else run, exact)
            has_effect = not np.max(np.abs(column)) * scale < NEGLIGIBLE * largest
            columns.append(column if has_effect else np.zeros_like(column))
        return np.stack(columns, axis=1)

    def scales(self, numbers: Array) -> Array:
        """Return the size of each number, above which a change of it is large."""
        units = natural_units(self.problem.top)
        sizes = list[float]()
        for name, number in zip(self.names, numbers, strict=False):
            natural = 1.0
            if name in self.fields:
                si = self.problem.quantity(name).units
                length, mass, time, _ = exponents_of(si) if si not in ("", "1") else (0, 0, 0, 0)
                natural = units.length**length * units.mass**mass * units.time**time
            sizes.append(max(abs(number), SMALLEST_SCALE * natural))
        return np.array(sizes)

    def _column(
        self, numbers: Array, place: int, center: PredictedData, run: xr.Dataset | None, exact: bool
    ) -> Array:
        """Return the derivatives with respect to one number."""
        step = STEP * self.scales(numbers)[place]

        def beside(change: float) -> PredictedData:
            moved = numbers.copy()
            moved[place] += change
            return self.predict(moved, run)

        if not exact:
            slope = _slope(beside, center, step, same_events=False)
            return np.zeros_like(center.values) if slope is None else np.nan_to_num(slope)
        for _ in range(TRIES):
            coarse = _slope(beside, center, step)
            fine = None if coarse is None else _slope(beside, center, 0.5 * step)
            if coarse is not None and fine is not None:
                return (4.0 * fine - coarse) / 3.0
            step *= SHORTER
        self.reasons[self.names[place]] = (
            "runs nearby go through other events: the motion grazes, or is at a limit of sticking"
        )
        return np.full(len(center.values), np.nan)

    def _seen(self, run: xr.Dataset, one: Measurement) -> xr.Dataset:
        """Return the run sampled at the times of a measurement, up to its end."""
        if not len(one.times):
            return run
        places = np.searchsorted(self.times, one.times)
        return run.isel(time=np.minimum(places, run.sizes["time"] - 1))

    def _instrument(self, names: Mapping[str, str], numbers: Array) -> dict[str, float]:
        """Return the numbers of an instrument by their own names."""
        return {plain: float(numbers[self.names.index(name)]) for plain, name in names.items()}


class Rule(NamedTuple):
    """A rule for a first derivative, of second order."""

    offsets: tuple[float, ...]
    weights: tuple[float, ...]
    center: float
    """Weight of the value in the middle."""


CENTRAL = Rule((-1.0, 1.0), (-0.5, 0.5), 0.0)
FORWARD = Rule((1.0, 2.0), (2.0, -0.5), -1.5)
BACKWARD = Rule((-1.0, -2.0), (-2.0, 0.5), 1.5)


def _slope(
    beside: Callable[[float], PredictedData],
    center: PredictedData,
    step: float,
    same_events: bool = True,
) -> Array | None:
    """Return a difference quotient; None if runs have other events, or there are no runs."""
    for rule in (CENTRAL, FORWARD, BACKWARD):
        total = rule.center * center.values
        try:
            for offset, weight in zip(rule.offsets, rule.weights, strict=True):
                prediction = beside(offset * step)
                if same_events and prediction.events != center.events:
                    return None
                total = total + weight * prediction.values
        except InvalidInput:  # The number is at its bound: look to its inside.
            continue
        return total / step
    return None
