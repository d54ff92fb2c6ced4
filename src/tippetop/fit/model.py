"""From numbers of a problem and of the instruments to the values of measurements, and back.

`Model.predict` asks every measurement what a run would have shown. `Model.jacobian` has the
derivatives: those of the run (see `linearized_run`) through what each measurement makes of it.
"""

import contextlib
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple, Self

import numpy as np
import xarray as xr

from tippetop.fit.linearized_run import Differs, LinearizedRun
from tippetop.fit.measurement import Measurement
from tippetop.fit.problem_numbers import SMALLEST_SCALE, Direction, require_fields, scale_of
from tippetop.integrators.base import Array
from tippetop.problem.implausible import Implausible
from tippetop.problem.problem import Problem
from tippetop.run import simulate
from tippetop.support.errors import InvalidInput

DIFFERENCE_STEP = 3e-5
"""Step of differences with respect to numbers of an instrument, relative to their scale."""

FORWARD_STEP = 1e-6
"""Step of the differences that a search steps by, relative to the scale of a number: the second
derivative of a phase of a thousand radians changes them by 1e-3, rounding of runs by 1e-7."""

ROUNDED = 1e-12
"""Change of the values over that step, relative to them, below which it is rounding of runs."""

GOLDEN_RATIO = (5.0**0.5 - 1.0) / 2.0
"""Distance of the places that are compared, in their range and modulo it: equal distances may be
whole numbers of steps, and would hide them.
"""

SECANT, SECANT_RUNS, SECANT_RUNS_OF_SEARCH = 0.03, 8, 4
"""How far beside a problem, relative to the scale of a field, the times of its events are compared,
and in how many runs: of these the errors follow. A search needs the slope alone, and fewer.

A time of an event moves in steps where the event waits for the next swing of a nutation; a step is
some thousandths of a field wide. Over less than a few steps the slope is that of a step, over much
more it is bent.
"""

SHARPNESS = 12
"""Instants on each period of nutation at which the run's own phases are followed."""

INSTANT_COUNTS = (100, 4000)
"""Fewest and most of these instants."""

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
    is_event
        Which of the values are times of events, shape (values,).
    steps
        Heights of the steps in which the values move, of the last derivatives, shape (values,).
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
        self.steps = np.zeros(len(self.data))
        self._last: tuple[tuple[float, ...], xr.Dataset] | None = None
        self.is_event = np.concatenate(
            [np.full(m.values.size, not len(m.times)) for m in self.measurements]
        )

    @property
    def start(self) -> Array:
        """The problem's own numbers, and the instruments' that fit best to its run."""
        return self.with_instruments(self.own_fields)

    @property
    def own_fields(self) -> Array:
        """The problem's own values of the fields."""
        return np.array([float(self.problem.get(field)) for field in self.fields])

    def turning_over(self, fields: Array) -> float:
        """Return when the run of some fields turns over, s; infinity if it does not."""
        turned = float(self.run(fields)["turnover_time"])
        return turned if np.isfinite(turned) else np.inf

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

    def problems_of(self, numbers: Array) -> list[Problem]:
        """Return the problem with its varied fields replaced, the only one."""
        return [self.problem_of(numbers)]

    def run(self, numbers: Array) -> xr.Dataset:
        """Return the run that shows all measurements; the last one is kept."""
        fields = tuple(numbers[: len(self.fields)].tolist())
        if self._last is None or self._last[0] != fields:
            self.runs += 1
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", Implausible)
                run = simulate(self.problem_of(numbers), float(self.times[-1]), times=self.times)
            self._last = fields, run
        return self._last[1]

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

    def until(self, time: float) -> Self:
        """Return the model of the data up to a time, without times of events."""
        parts = [one.until(time) for one in self.measurements if len(one.times)]
        return type(self)(self.problem, parts, self.fields)

    def on_fine_grid(self, time: float) -> Self:
        """Return the model of the same instruments at instants that follow the fastest motion."""
        period = nutation_period(self.problem)
        instants = SHARPNESS * time / period if period else 0.0
        grid = np.linspace(0.0, time, int(np.clip(instants, *INSTANT_COUNTS)))
        parts = [
            replace(one, times=grid, values=np.full((len(grid), one.values.shape[1]), np.nan))
            for one in self.measurements
            if len(one.times)
        ]
        return type(self)(self.problem, parts, self.fields)

    def differences(self, numbers: Array, steps: Array | None = None) -> tuple[Array, Array]:
        """Return the values, and their derivatives by differences of runs.

        A search steps by them: they take one run a field, where exact ones take six. The steps are
        `FORWARD_STEP` of the scales of the numbers where none are stated, shape (numbers,).
        """
        run = self.run(numbers)
        center = self.predict(numbers, run).values
        steps = FORWARD_STEP * self.scales(numbers) if steps is None else steps
        columns = list[Array]()
        for place, step in enumerate(steps):
            column = np.zeros(len(center))
            for change in (step, -step):
                moved = numbers.copy()
                moved[place] += change
                with contextlib.suppress(InvalidInput):  # The number is at its bound.
                    beside = self.predict(moved, None if place < len(self.fields) else run).values
                    column = (beside - center) / change
                    break
            has_effect = not np.max(np.abs(column)) * step < ROUNDED * np.max(np.abs(center))
            columns.append(column if has_effect else np.zeros_like(column))
        slopes = np.stack(columns, axis=1)
        if self.is_event.any():
            secants, _ = self.secants(numbers, SECANT_RUNS_OF_SEARCH)
            slopes[self.is_event] = secants[self.is_event]
        return center, slopes

    def secants(self, numbers: Array, runs: int = SECANT_RUNS) -> tuple[Array, Array]:
        """Return how the values move over a finite change of each field, and in which steps.

        Returns
        -------
        tuple
            Slopes, shape (values, numbers), and heights of the steps in which a value moves, shape
            (values,): the deviation of the values from a parabola, times that of a sawtooth of
            height 1 from its mean, sqrt(12).
        """
        slopes, heights = np.zeros((len(self.data), len(numbers))), np.zeros(len(self.data))
        places = 2.0 * ((np.arange(runs) + 0.5) * GOLDEN_RATIO % 1.0) - 1.0
        for field, scale in enumerate(self.scales(numbers)[: len(self.fields)]):
            rows, seen = list[Array](), list[float]()
            for place in places:
                moved = numbers.copy()
                moved[field] += SECANT * scale * place
                with contextlib.suppress(InvalidInput):
                    rows.append(self.predict(moved).values)
                    seen.append(SECANT * scale * float(place))
            table, changes = np.array(rows), np.array(seen)
            for value in np.flatnonzero(self.is_event):
                shown = np.isfinite(table[:, value]) if len(table) else np.zeros(0, dtype=bool)
                if shown.sum() < 4:
                    slopes[value, field] = np.nan
                    continue
                at, times = changes[shown], table[shown, value]
                fitted = np.polynomial.Polynomial.fit(at, times, 2)
                slopes[value, field] = fitted.deriv()(0.0)
                variance = float(np.sum((times - fitted(at)) ** 2)) / (len(at) - 3)
                heights[value] = max(heights[value], (12.0 * variance) ** 0.5)
        return slopes, heights

    def jacobian(self, numbers: Array) -> Array:
        """Return the derivatives of the values, shape (values, numbers).

        Where the run has no derivative, a column is NaN, and `reasons` says why. Times of events
        have slopes over a finite change instead (see `secants`).
        """
        if self.is_event.all():
            slopes, self.steps = self.secants(numbers)
            return slopes
        problem = self.problem_of(numbers)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", Implausible)
            directions = [Direction.of(problem, field) for field in self.fields]
            linear = LinearizedRun(problem, float(self.times[-1]), self.times, directions)
        self.runs += 1
        run = linear.read().run
        center = self.predict(numbers, run)
        columns = list[Array]()
        largest = np.nanmax(np.abs(center.values))
        for place, scale in enumerate(self.scales(numbers)):
            if place < len(self.fields):
                column = self._field_column(numbers, place, linear)
                if np.isnan(column).all():
                    self.reasons[self.names[place]] = linear.failures[place][1]
            else:
                column = self._difference(numbers, place, run)
            has_effect = not np.max(np.abs(column)) * scale < NEGLIGIBLE * largest
            columns.append(column if has_effect else np.zeros_like(column))
        matrix = np.stack(columns, axis=1)
        if self.is_event.any():
            slopes, self.steps = self.secants(numbers)
            matrix[self.is_event] = slopes[self.is_event]
        return matrix

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

    def _field_column(self, numbers: Array, place: int, linear: LinearizedRun) -> Array:
        """Return the derivatives with respect to a field; NaN where the run has none."""

        def beside(change: float) -> Array:
            return self.predict(numbers, linear.read_beside(place, change).run).values

        if place not in linear.failures:
            scale, change = linear.fields[place].scale, linear.reach(place)
            with contextlib.suppress(Differs):
                return np.asarray((beside(change) - beside(-change)) / (2.0 * change * scale))
        return np.full(len(self.data), np.nan)

    def _difference(self, numbers: Array, place: int, run: xr.Dataset) -> Array:
        """Return a difference quotient with respect to a number of an instrument."""
        step = DIFFERENCE_STEP * self.scales(numbers)[place]
        ends = list[Array]()
        for sign in (1.0, -1.0):
            moved = numbers.copy()
            moved[place] += sign * step
            ends.append(self.predict(moved, run).values)
        return np.asarray((ends[0] - ends[1]) / (2.0 * step))

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


def nutation_period(problem: Problem) -> float:
    """Return the period of a fast nutation at launch, 2 pi I1 / (I3 omega3), s; 0 without spin."""
    rate = problem.body.I3 * abs(problem.launch.spin) / problem.body.I1
    return 2.0 * np.pi / rate if rate else 0.0
