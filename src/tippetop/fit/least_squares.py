"""Fit numbers of a problem to measurements by least squares.

The search is SciPy's trust region with bounds. lmfit, which wraps the same search, was not taken:
its parameters must be Python names, and a problem's fields have dots; what its reports add (errors,
correlations, profiles) needs the directions that the data do not determine, which it leaves out.
"""

import contextlib
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from scipy.optimize import OptimizeResult, least_squares
from scipy.stats import qmc

from tippetop.fit.fitted import FitResult, Minimum, are_correlated, columns_of, exceeds_noise
from tippetop.fit.measurement import Measurement
from tippetop.fit.model import Model
from tippetop.integrators.base import Array
from tippetop.problem.implausible import warn_if_implausible
from tippetop.problem.problem import Problem, require_problem
from tippetop.support.errors import InvalidInput, NotConverged, is_number, is_whole
from tippetop.sweeps.axes import in_si_of

TOLERANCE = 1e-9
"""Relative change of the sum of squares, and of the numbers, at which the search ends: far below a
standard error, above the rounding of runs."""

STATIONARY = 0.05
"""Standard errors by which a last step of Gauss and Newton would still move a fit that counts as
converged."""

UNLIKELY = 1.0
"""Standard deviations of a sum of squares above the expected one from which on another minimum is
sought: one fit in six that is right has more, and false ones may have little more than 1.5."""

REPRODUCED = 1e-16
"""Variance of residuals, where their noise is not known, that is rounding."""

MOST_STEPS = 100
"""Trial points of one search."""

BEGINNING, WHOLE = ((1 / 4, 3.0), (1 / 2, 3.0)), ((1.0, 3.0), (1.0, 1.0))
"""Parts of the data that are fitted first, and over how many periods of nutation they are averaged.

A phase of nutation that is half a turn off makes a minimum of its own, and there are hundreds of
turns. Without nutation there is one minimum for each turn of precession; over a short time the
phase of that is nearly right.
"""

GUESS = 0.1
"""Relative error ascribed to the numbers of a start in those fits: a part of the data does not
determine all of them, and would move them far."""

SPREAD = 0.2
"""Relative distance up to which several starts lie from the problem's numbers without a range."""

HOPELESS = 50.0
"""Sum of squares above that of the best start, in variances, from which on a start is dropped."""

FEWEST_PER_NUMBER = 4
"""Data for each fitted number from which on a part of them is fitted first."""

ROUGH, ROUGH_STEPS = 1e-3, 30
"""Tolerance and trial points of those searches: what they find is refined."""

MOST_REFINED = 3
"""How many of several starts are refined."""

SCANNED, MORE_STARTS = 64, 12
"""Points whose runs are compared with the data where the fit from the problem's own numbers does
not describe them, and how many of them, the nearest, are fitted.

Minima that differ by a phase of nutation over a second lie 8 % of the spin apart. Averaged over
nutation they are as wide as that, and several of the points lie in each.
"""

Vary = Sequence[str] | Mapping[str, Any] | str


def fit(
    problem: Problem,
    data: Measurement | Sequence[Measurement],
    vary: Vary,
    *,
    noise: Any = None,
    starts: int | None = None,
    seed: int = 0,
) -> FitResult:
    """Return the problem whose run is nearest to measurements, with errors.

    Parameters
    ----------
    problem
        The problem to start from: its numbers are where the search begins.
    data
        A measurement, or several of the same launch.
    vary
        Fields of numbers that are fitted, such as ``["friction.mu", "launch.spin"]``; or a mapping
        of fields to ranges ``(low, high)`` that they stay in, or None for none. Missing initial
        conditions are fitted like anything else: "launch.tilt_rate", "launch.precession".
    noise
        Standard deviation of the data in their unit, a number for each column or one for all; for
        several measurements, a list. None for what the measurements say; if they say nothing, it
        is estimated from the residuals.
    starts
        From how many points the search begins: the problem's own, and others spread over the
        ranges, or over 20 % where there are none. All are fitted to the first part of the data, and
        those that stay near it to longer ones. None for the problem's own alone, and where that fit
        does not describe the data, for those of 64 points too whose runs are nearest to them, until
        a fit does: nutation makes other minima.
    seed
        Of the points.

    Raises
    ------
    InvalidInput
        If there is no such field, fewer data than numbers to fit, or the run of the start does not
        show what was measured.
    NotConverged
        If the search does not reach a minimum.

    Examples
    --------
    >>> import numpy as np
    >>> import tippetop as tt
    >>> true = tt.presets.report_problem(spin=155.0)
    >>> times = np.linspace(0.0, 0.5, 60)
    >>> tilt = tt.simulate(true, 0.5, times=times)["tilt"].values
    >>> film = tt.Measurement.of_variables(times, {"tilt": tilt}, noise=0.01)
    >>> fitted = tt.fit(true.replace({"friction.mu": 0.25}), film, ["friction.mu"])
    >>> round(fitted.problem.friction.mu, 6)
    0.3
    """
    require_problem(problem)
    measurements = _measurements(data, noise)
    fields, low, high = _ranges(problem, vary)
    model = Model(problem, measurements, fields)
    if not (starts is None or (is_whole(starts) and starts >= 1)):
        raise InvalidInput("starts", starts, "a whole number, at least 1; or None for enough")
    warn_if_implausible(problem)
    measured = np.isfinite(model.data)
    if measured.sum() < len(model.names):
        shown = f"{measured.sum()} numbers"
        fewest = f"at least {len(model.names)}, as many as are fitted: {', '.join(model.names)}"
        raise InvalidInput("data", shown, fewest)
    search = Search(model, _deviations(measurements), low, high)
    minima = search.minima(search.starts(starts or 1, seed))
    if starts is None and not search.describes(minima[0]):
        beside = [one for one in search.first_description(seed) if one.converged]
        minima = sorted([*minima, *beside], key=by_cost)
    best = minima[0]
    if not best.converged:
        pairs = zip(model.names, best.numbers, strict=True)
        nearest = ", ".join(f"{name} = {number:.4g}" for name, number in pairs)
        raise NotConverged(
            f"the fit did not reach a minimum in {model.runs} runs ({best.message}; nearest so far:"
            f" {nearest}); start nearer to the data, fit fewer numbers, or give ranges and several"
            " starts"
        )
    return FitResult.of(search, best, [one for one in minima[1:] if one.converged])


class Branch(NamedTuple):
    """A start, fitted to a part of the data."""

    numbers: Array
    guess: Array
    """Values of the fields at the start."""
    cost: float = 0.0


def by_cost(one: Branch | Minimum) -> float:
    """Return the sum of the squares of the residuals."""
    return one.cost


class Search:
    """Least squares of a model, with some numbers held.

    Attributes
    ----------
    model
        What predicts the data.
    deviations
        Standard deviation of each number of the data; 1 where none is known.
    is_noise_known
        Whether they are known.
    low, high
        Bounds of all numbers.
    guess
        Values of the fields that are taken for measured ones, to `GUESS`; None for none.
    average
        Matrix that averages residuals over time; None for none.
    """

    def __init__(
        self,
        model: Model,
        deviations: Array | None,
        low: Array,
        high: Array,
        guess: Array | None = None,
        average: Array | None = None,
    ) -> None:
        instruments = len(model.names) - len(model.fields)
        self.model, self.is_noise_known = model, deviations is not None
        self.measured = np.isfinite(model.data)
        self.deviations = np.ones(len(model.data)) if deviations is None else deviations
        self.low = np.append(low, np.full(instruments, -np.inf))
        self.high = np.append(high, np.full(instruments, np.inf))
        self.guess, self.average = guess, average

    def starts(self, count: int, seed: int) -> list[Array]:
        """Return the points to begin at: the problem's own, and others beside it."""
        first = self.model.start
        if not np.isfinite(self.residuals(first)).all():
            raise InvalidInput(
                "problem",
                f"the run of {self._written(first)}",
                "",
                "does not show all that was measured",
                "start from a problem whose run lasts as long and has those events",
            )
        fields = len(self.model.fields)
        reach = SPREAD * self.model.scales(first)[:fields]
        low = np.where(np.isfinite(self.low[:fields]), self.low[:fields], first[:fields] - reach)
        high = np.where(np.isfinite(self.high[:fields]), self.high[:fields], first[:fields] + reach)
        points = [first]
        for point in qmc.LatinHypercube(fields, rng=seed).random(count - 1):
            with contextlib.suppress(InvalidInput, np.linalg.LinAlgError):
                points.append(self.model.with_instruments(low + point * (high - low)))
        return points

    def residuals(self, numbers: Array) -> Array:
        """Return prediction minus data over the noise; NaN where there is no prediction."""
        try:
            values = self.model.predict(numbers).values
        except InvalidInput:
            guesses = 0 if self.guess is None else len(self.guess)
            return np.full(int(self.measured.sum()) + guesses, np.nan)
        residuals: Array = ((values - self.model.data) / self.deviations)[self.measured]
        if self.average is not None:
            residuals = self.average @ residuals
        if self.guess is None:
            return residuals
        return np.append(residuals, (numbers[: len(self.guess)] - self.guess) / self._guess_errors)

    def jacobian(self, numbers: Array, *, exact: bool = False) -> Array:
        """Return the derivatives of the residuals."""
        matrix: Array = self.model.jacobian(numbers, exact=exact) / self.deviations[:, None]
        matrix = matrix[self.measured]
        if self.average is not None:
            matrix = self.average @ matrix
        if self.guess is None:
            return matrix
        rows = np.eye(len(self.guess), len(numbers)) / self._guess_errors[:, None]
        return np.concatenate([matrix, rows])

    @property
    def _guess_errors(self) -> Array:
        assert self.guess is not None
        return GUESS * self.model.scales(self.guess)

    def minima(self, points: list[Array]) -> list[Minimum]:
        """Return the minima that the search reaches from points, the least first."""
        branches = [self._branch(point) for point in points]
        branches = self.approach(branches, (*BEGINNING, *WHOLE))
        return sorted([self.refine(one.numbers) for one in branches[:MOST_REFINED]], key=by_cost)

    def first_description(self, seed: int) -> list[Minimum]:
        """Return the minima from points whose runs are near the data, one after the other, up to
        one that describes them.
        """
        minima = list[Minimum]()
        branches = [self._branch(point) for point in self.nearest(seed)]
        for branch in self.approach(branches, WHOLE[:1])[:MOST_REFINED]:
            minima += [self.refine(one.numbers) for one in self.approach([branch], WHOLE[1:])]
            if minima and self.describes(minima[-1]):
                break
        return minima

    def nearest(self, seed: int) -> list[Array]:
        """Return those of many points whose runs are nearest to the data without nutation."""
        measurements, fields = self.model.measurements, len(self.model.fields)
        average = None
        if all(len(one.times) for one in measurements):
            average = _average(measurements, WHOLE[0][1] * nutation_period(self.model.problem))
        deviations = self.deviations if self.is_noise_known else None
        bounds = self.low[:fields], self.high[:fields]
        averaged = Search(self.model, deviations, *bounds, average=average)
        points = self.starts(SCANNED, seed)
        costs = np.array([averaged.sum_of_squares(point) for point in points])
        return [points[place] for place in np.argsort(costs)[:MORE_STARTS]]

    def describes(self, minimum: Minimum) -> bool:
        """Return whether a minimum was reached whose residuals may be noise."""
        if not minimum.converged:
            return False
        values = self.residuals(minimum.numbers)
        degrees = len(values) - len(minimum.numbers)
        if self.is_noise_known:
            return not exceeds_noise(minimum.cost, degrees, UNLIKELY)
        if minimum.cost < REPRODUCED * max(degrees, 1):
            return True
        residuals = np.full(len(self.model.data), np.nan)
        residuals[self.measured] = values
        return not any(are_correlated(one) for _, one in columns_of(self.model, residuals))

    def approach(
        self, branches: list["Branch"], stages: Sequence[tuple[float, float]]
    ) -> list["Branch"]:
        """Return branches nearer to minima, by fits of parts of the data without nutation.

        Those far above the least are left out, which comes first.
        """
        model, fields = self.model, len(self.model.fields)
        for part, periods in stages:
            first = [one.until(part * model.times[-1]) for one in model.measurements]
            count = sum(one.count for one in first)
            if count < FEWEST_PER_NUMBER * len(model.names) or not all(
                len(one.times) > 1 for one in first
            ):
                continue
            shorter = Model(model.problem, first, model.fields)
            deviations = _deviations(first) if self.is_noise_known else None
            average = _average(first, periods * nutation_period(model.problem))
            bounds = self.low[:fields], self.high[:fields]
            ends = list[Branch]()
            for one in branches:
                search = Search(shorter, deviations, *bounds, one.guess, average)
                if np.isfinite(search.residuals(one.numbers)).all():
                    end = search.refine(one.numbers, tolerance=ROUGH, steps=ROUGH_STEPS)
                    ends.append(Branch(end.numbers, one.guess, end.cost))
            model.runs += shorter.runs
            if not ends:
                break
            least = min(one.cost for one in ends)
            hopeless = least + HOPELESS * (1.0 if self.is_noise_known else least / count)
            branches = sorted([one for one in ends if one.cost < hopeless], key=by_cost)
        return branches

    def refine(
        self,
        start: Array,
        held: int | None = None,
        tolerance: float = TOLERANCE,
        steps: int = MOST_STEPS,
    ) -> Minimum:
        """Return the minimum that the search reaches from a point, with one number held or none."""
        free = np.array([place != held for place in range(len(start))])

        def all_numbers(free_numbers: Array) -> Array:
            numbers = start.copy()
            numbers[free] = free_numbers
            return numbers

        if not free.any():
            values = self.residuals(start)
            return Minimum(start, float(values @ values), True, "nothing is free")
        # In units of each number's size: pixels of an origin must not hide a small coefficient.
        sizes = self.model.scales(start)[free]
        low, high = self.low[free] / sizes, self.high[free] / sizes

        def residuals_of(scaled: Array) -> Array:
            return self.residuals(all_numbers(scaled * sizes))

        def jacobian_of(scaled: Array) -> Array:
            matrix: Array = self.jacobian(all_numbers(scaled * sizes))[:, free] * sizes
            return matrix

        result: OptimizeResult = least_squares(
            residuals_of,
            np.clip(start[free] / sizes, low, high),
            jacobian_of,
            bounds=(low, high),
            x_scale="jac",
            ftol=tolerance,
            xtol=TOLERANCE,
            gtol=None,
            max_nfev=steps,
        )
        inside = (result.active_mask == 0) & (np.abs(result.jac).max(axis=0) > 0.0)
        remaining = _step_left(result.jac[:, inside], result.fun, self.is_noise_known)
        converged = bool(result.status > 0 and remaining < STATIONARY)
        message = (
            "too many steps"
            if result.status == 0
            else f"the last step still moves by {remaining:.2g} standard errors"
        )
        numbers = all_numbers(result.x * sizes)
        return Minimum(numbers, 2.0 * float(result.cost), converged, message)

    def _branch(self, point: Array) -> "Branch":
        return Branch(point, point[: len(self.model.fields)])

    def sum_of_squares(self, numbers: Array) -> float:
        """Return the sum of the squares of the residuals; infinity without a prediction."""
        values = self.residuals(numbers)
        total = float(values @ values)
        return total if np.isfinite(total) else np.inf

    def _written(self, numbers: Array) -> str:
        names = zip(self.model.fields, numbers, strict=False)
        return ", ".join(f"{name} = {number:.4g}" for name, number in names)


def nutation_period(problem: Problem) -> float:
    """Return the period of a fast nutation at launch, 2 pi I1 / (I3 omega3), s; 0 without spin."""
    rate = problem.body.I3 * abs(problem.launch.spin) / problem.body.I1
    return 2.0 * np.pi / rate if rate else 0.0


def _average(measurements: Sequence[Measurement], width: float) -> Array:
    """Return the matrix that averages each column of the data over a time, weighted by a bell."""
    rows, columns = list[Array](), list[Array]()
    for place, one in enumerate(measurements):
        several = one.values.shape[1]
        rows.append(np.repeat(one.times, several))
        columns.append(place + np.tile(np.arange(several) / several, len(one.times)))
    measured = np.concatenate([np.isfinite(one.values).ravel() for one in measurements])
    times, kinds = np.concatenate(rows)[measured], np.concatenate(columns)[measured]
    apart = (times[:, None] - times) / max(0.5 * width, 1e-300)
    weights = np.exp(-0.5 * np.minimum(apart**2, 1e3)) * (kinds[:, None] == kinds)
    average: Array = weights / weights.sum(axis=1, keepdims=True)
    return average


def _step_left(jacobian: Array, residuals: Array, is_noise_known: bool) -> float:
    """Return the length of the next step of Gauss and Newton, in standard errors."""
    count, free = jacobian.shape
    if not free:
        return 0.0
    sizes = np.linalg.norm(jacobian, axis=0)
    modes, strengths, _ = np.linalg.svd(jacobian / sizes, full_matrices=False)
    projected = (modes.T @ residuals)[strengths > 1e-6 * strengths[0]]
    variance = 1.0 if is_noise_known else residuals @ residuals / max(count - free, 1)
    if variance < REPRODUCED:
        return 0.0
    return float(np.linalg.norm(projected) / np.sqrt(variance))


def _measurements(data: Any, noise: Any) -> list[Measurement]:
    """Return the measurements with their noise."""
    several = [data] if isinstance(data, Measurement) else data
    if not (
        isinstance(several, list | tuple)
        and several
        and all(isinstance(one, Measurement) for one in several)
    ):
        accepted = "a measurement, or a list of them: see tt.read_measurement"
        raise InvalidInput("data", data, accepted)
    if noise is None:
        return list(several)
    noises = [noise] if len(several) == 1 else noise
    if not (isinstance(noises, list | tuple) and len(noises) == len(several)):
        raise InvalidInput("noise", noise, "a list with the noise of every measurement")
    return [
        one if level is None else one.with_noise(level)
        for one, level in zip(several, noises, strict=True)
    ]


def _deviations(measurements: Sequence[Measurement]) -> Array | None:
    """Return the standard deviation of each number; None if none is known and all have one unit."""
    if all(one.noise is None for one in measurements):
        units = {unit for one in measurements for unit in one.observation.units}
        if len(units) == 1:
            return None
    for one in measurements:
        if one.noise is None:
            columns = ", ".join(one.observation.labels)
            accepted = "the standard deviation of every column, as data of several units need it"
            raise InvalidInput("noise", None, accepted, f"is not known for {columns}")
    return np.concatenate(
        [
            np.broadcast_to(one.noise, one.values.shape).ravel()
            for one in measurements
            if one.noise is not None
        ]
    )


def _ranges(problem: Problem, vary: Any) -> tuple[tuple[str, ...], Array, Array]:
    """Return the fields to fit, with the lower and upper ends of their ranges."""
    ranges: Mapping[str, Any] = (
        vary
        if isinstance(vary, Mapping)
        else dict.fromkeys([vary] if isinstance(vary, str) else vary)
    )
    if not ranges or not all(isinstance(field, str) for field in ranges):
        raise InvalidInput("vary", vary, "names of fields, such as friction.mu and launch.spin")
    low, high = list[float](), list[float]()
    for field, ends in ranges.items():
        pair = (-np.inf, np.inf) if ends is None else ends
        if not (isinstance(pair, list | tuple) and len(pair) == 2):
            raise InvalidInput(f"vary.{field}", ends, "a range (low, high), or None")
        lower, upper = (in_si_of(field, end) if isinstance(end, str) else end for end in pair)
        if not (ends is None or (is_number(lower) and is_number(upper) and lower < upper)):
            raise InvalidInput(f"vary.{field}", ends, "a range (low, high), or None")
        low.append(lower)
        high.append(upper)
    return tuple(ranges), np.array(low), np.array(high)
