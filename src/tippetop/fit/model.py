"""From numbers of a problem and of the instruments to the values of measurements, and back.

`Model.predict` asks every measurement what a run would have shown. `Model.jacobian` has the
derivatives: those of the run (see `linearized_run`) through what each measurement makes of it.
"""

import contextlib
import warnings
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
import xarray as xr

from tippetop.fit.linearized_run import READ_ONE_SIDE, Differs, LinearizedRun
from tippetop.fit.measurement import Measurement
from tippetop.fit.problem_numbers import SMALLEST_SCALE, Direction, require_fields, scale_of
from tippetop.integrators.base import Array
from tippetop.problem.implausible import Implausible
from tippetop.problem.problem import Problem
from tippetop.run import simulate
from tippetop.support.errors import InvalidInput

DIFFERENCE_STEP = 3e-5
"""Step of differences, relative to the scale of a number.

It is for numbers of an instrument, and for fields where a run has no derivative: the phase of a
spin of a thousand radians moves by 0.03 rad. Smaller steps meet the rounding of runs, larger ones
the third derivative of such a phase.
"""

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
        require_fields(problem, self.fields, "vary")
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
        fields = [float(self.problem.get(field)) for field in self.fields]
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

        Where the run has no derivative, a column is NaN if `exact`, and `reasons` says why; else it
        is a difference of runs. What is not exact is good enough to step by.
        """
        problem = self.problem_of(numbers)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", Implausible)
            directions = [Direction.of(problem, field) for field in self.fields]
            end = float(self.times[-1])
            linear = LinearizedRun(problem, end, self.times, directions, rough=not exact)
        self.runs += 1
        run = linear.read().run
        center = self.predict(numbers, run)
        columns = list[Array]()
        largest = np.nanmax(np.abs(center.values))
        for place, scale in enumerate(self.scales(numbers)):
            if place < len(self.fields):
                values = None if exact else center.values
                column = self._field_column(numbers, place, linear, values)
                if exact and np.isnan(column).all():
                    self.reasons[self.names[place]] = linear.failures[place][1]
                elif not exact and place in linear.failures:
                    column = self._difference(numbers, place, None)
            else:
                column = self._difference(numbers, place, run)
            has_effect = not np.max(np.abs(column)) * scale < NEGLIGIBLE * largest
            columns.append(column if has_effect else np.zeros_like(column))
        return np.stack(columns, axis=1)

    def scales(self, numbers: Array) -> Array:
        """Return the size of each number, above which a change of it is large."""
        sizes = list[float]()
        for name, number in zip(self.names, numbers, strict=False):
            of_field = name in self.fields
            least = SMALLEST_SCALE
            sizes.append(
                scale_of(self.problem, name, number) if of_field else max(abs(number), least)
            )
        return np.array(sizes)

    def _field_column(
        self, numbers: Array, place: int, linear: LinearizedRun, center: Array | None
    ) -> Array:
        """Return the derivatives with respect to a field; NaN where the run has none.

        They are differences from the values of the run itself, if those are given.
        """

        def beside(change: float) -> Array:
            return self.predict(numbers, linear.read_beside(place, change).run).values

        if place not in linear.failures:
            scale = linear.fields[place].scale
            with contextlib.suppress(Differs):
                if center is None:
                    change = linear.reach(place)
                    return np.asarray((beside(change) - beside(-change)) / (2.0 * change * scale))
                change = linear.reach(place, READ_ONE_SIDE)
                return np.asarray((beside(change) - center) / (change * scale))
        return np.full(len(self.data), np.nan)

    def _difference(self, numbers: Array, place: int, run: xr.Dataset | None) -> Array:
        """Return a difference quotient with respect to a number, of a run or of what it shows."""
        step = DIFFERENCE_STEP * self.scales(numbers)[place]
        ends, changes = list[Array](), list[float]()
        for sign in (1.0, -1.0, 0.0):
            moved = numbers.copy()
            moved[place] += sign * step
            with contextlib.suppress(InvalidInput):  # The number is at its bound.
                ends.append(self.predict(moved, run).values)
                changes.append(sign * step)
        if len(ends) < 2:
            return np.zeros(len(self.data))
        return np.nan_to_num((ends[0] - ends[1]) / (changes[0] - changes[1]))

    def _seen(self, run: xr.Dataset, one: Measurement) -> xr.Dataset:
        """Return the run sampled at the times of a measurement, up to its end."""
        if not len(one.times):
            return run
        places = np.searchsorted(self.times, one.times)
        if len(places) == run.sizes["time"] and places[-1] == len(places) - 1:
            return run  # All samples of it.
        return run.isel(time=np.minimum(places, run.sizes["time"] - 1))

    def _instrument(self, names: Mapping[str, str], numbers: Array) -> dict[str, float]:
        """Return the numbers of an instrument by their own names."""
        return {plain: float(numbers[self.names.index(name)]) for plain, name in names.items()}
