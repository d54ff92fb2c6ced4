"""The search of a fit: from templates over a first part of the data to minima in all of them.

It goes from `Search.minima` to templates (see `template_bank`) over a first part of the data, the
best of them are polished there, and followed over longer parts to all data. The polish is SciPy's
trust region with bounds. lmfit, which wraps the same one, was not taken: its parameters must be
Python names, and a problem's fields have dots; what its reports add (errors, correlations,
profiles) needs the directions that the data do not determine, which it leaves out.
"""

import contextlib
from collections.abc import Callable, Iterator, Sequence
from operator import itemgetter
from typing import NamedTuple

import numpy as np
from scipy.optimize import OptimizeResult, least_squares, minimize

from tippetop.fit.joint_model import JointModel
from tippetop.fit.measurement import Measurement
from tippetop.fit.model import FORWARD_STEP, Model
from tippetop.fit.residual_statistics import ResidualColumn, exceeds_noise, is_negligible
from tippetop.fit.template_bank import SPACING, lattice, phase_metric, template_count
from tippetop.integrators.base import Array
from tippetop.support.errors import InvalidInput, NotConverged

TOLERANCE, STEPPED_TOLERANCE = 1e-9, 1e-4
"""Relative change of the sum of squares, and of the numbers, at which a search ends: far below a
standard error, above the rounding of runs; and above the steps in which times of events move."""

STATIONARY = 0.05
"""Standard errors by which a last step of Gauss and Newton would still move a fit that counts as
converged."""

NEGLIGIBLE_SLOPE = 1e-6
"""Singular value of the derivatives, relative to the largest, below which a direction is not
searched: its derivatives are rounding of runs."""

LONG_STEP, SHORT_STEP = 3e-3, 1e-3
"""Standard errors of a number, the others held, from which on a step of differences is too long,
and those of the step that is taken instead. Second derivatives of the residuals then change the
gradient by less than `STATIONARY` where two numbers are correlated so much that the errors of both
are a hundred times as large as those with the other held."""

SHORTEST_PART = 1e-3
"""Least part of the usual step: below it rounding of runs counts."""

UNLIKELY = 1.0
"""Standard deviations of a sum of squares above the expected one from which on the search goes on
in a wider region: one fit in six that is right has more, and false ones may have little more than
1.5."""

REPRODUCED = 1e-16
"""Variance of residuals, where their noise is not known, that is rounding."""

MOST_STEPS, FEW_STEPS, QUASI_NEWTON_STEPS = 30, 12, 30
"""Trial points of a search in all data, and in a part of them, and steps that count with second
derivatives where the former come to no end."""

ROUGH = 1e-3
"""Relative change of the sum of squares at which a search in a part of the data ends: what it finds
is refined."""

REACHES = (0.2, 0.5)
"""Relative distances from the problem's numbers within which minima are sought where there is no
range; the second where those of the first do not describe the data."""

MOST_TEMPLATES = 120
"""Templates over the first part of the data. That is the longest which needs no more."""

DATA_PARTS = tuple(0.5**halving for halving in range(7, -1, -1))
"""Parts of the duration of the data."""

REGULAR = 0.8
"""Part of the time until the top turns over that the first part of the data ends before: beyond it
a change of the launch moves the run more and more."""

FEWEST_PER_NUMBER = 4
"""Data for each fitted number that the first part has at least."""

FOLLOWED, KEPT, MOST_REFINED = 12, 6, 4
"""Templates that are polished, minima that are followed to the next part of the data, and minima
that are refined in all of them."""

FOLLOWED_OF_EVENTS = 2
"""Points that are refined where data are times of events, which have few minima."""

HOPELESS = 50.0
"""Sum of squares above the least, in variances, from which on a minimum is dropped."""

SAME = 3.0
"""Standard errors within which two minima are one."""

SPREAD = 3.0
"""Standard errors after a part of the data within which the truth is sought in the next."""

EVENT_GRID = {1: 9, 2: 5, 3: 3}
"""Values of each field, by the number of fields, that are tried where data have no phase, such as
times of events; of more fields the problem's own alone."""

AROUND = 3.0
"""Standard errors around a minimum within which a lower one is sought, along each direction. Where
times of events move in steps, a search ends on one of them, and others 2.5 standard errors away may
be 2 variances lower; where events change their order within a standard error, the run jumps.
"""

TRIED_AROUND, STEPS_TRIED = 12, 48
"""Points that are tried there along each direction: of a run, and of times that move in steps."""

LOWER, MOST_ROUNDS = 0.01, 4
"""Variances by which a point beside a minimum is lower that is searched from again, and how often.
"""

DESCENT_PART = 1e-3
"""Part of the last step of Gauss and Newton over which the sum of squares falls, unless the run
jumps."""

INTERVAL_ROUNDS = 3
"""How often a change about as large as a standard error is sought."""

MOST_RUNS = 20_000
"""Runs after which a search returns what it has."""


class Minimum(NamedTuple):
    """Where a search ended."""

    numbers: Array
    cost: float
    """Sum of the squares of the residuals."""
    converged: bool
    message: str
    slopes: Array = np.zeros((0, 0))
    """Derivatives of the residuals, by differences, shape (data, numbers)."""
    jumps: bool = False
    """Whether it lies where the run jumps, since events beside it come in another order."""


class FitProgress(NamedTuple):
    """How far a fit is."""

    runs: int
    """Runs that were followed."""
    part: float
    """Part of the data that is searched."""
    candidates: int
    """Points of this part that were compared with the data."""


class SearchStopped(Exception):
    """The search has followed as many runs as it may."""


def by_cost(one: Minimum) -> float:
    """Return the sum of the squares of the residuals."""
    return one.cost


class Region(NamedTuple):
    """Part of the space of the fields in which the truth is sought."""

    center: Array
    reach: Array
    """Matrix whose columns span the region from its centre, shape (fields, fields)."""


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
    most_runs
        Runs after which the search is stopped.
    callback
        Function that is called with the progress.
    stopped
        Why the search was stopped; empty if it was not.
    is_local
        Whether only the minimum next to the problem's own numbers was sought.
    """

    def __init__(
        self, model: Model | JointModel, deviations: Array | None, low: Array, high: Array
    ) -> None:
        instruments = len(model.names) - len(model.fields)
        self.model, self.is_noise_known = model, deviations is not None
        self.measured = np.isfinite(model.data)
        self.deviations = np.ones(len(model.data)) if deviations is None else deviations
        self.low = np.append(low, np.full(instruments, -np.inf))
        self.high = np.append(high, np.full(instruments, np.inf))
        self.callback: Callable[[FitProgress], None] | None = None
        self.most_runs, self.stopped, self.is_local = MOST_RUNS, "", False
        self._runs_of_parts = 0
        self._best = list[Minimum]()
        self._leading: Array | None = None

    @property
    def runs(self) -> int:
        """How many runs the search has followed."""
        return self._runs_of_parts + self.model.runs

    def residuals(self, numbers: Array) -> Array:
        """Return prediction minus data over the noise; NaN where there is no prediction."""
        try:
            values = self.model.predict(numbers).values
        except InvalidInput:
            return np.full(int(self.measured.sum()), np.nan)
        return np.asarray(((values - self.model.data) / self.deviations)[self.measured])

    def jacobian(self, numbers: Array) -> Array:
        """Return the derivatives of the residuals; NaN where the run has none."""
        matrix = self.model.jacobian(numbers) / self.deviations[:, None]
        return np.asarray(matrix[self.measured])

    def linearized(self, numbers: Array, steps: Array | None = None) -> tuple[Array, Array]:
        """Return the residuals and their derivatives, by differences of runs."""
        values, slopes = self.model.differences(numbers, steps)
        scaled = (values - self.model.data) / self.deviations
        return scaled[self.measured], (slopes / self.deviations[:, None])[self.measured]

    def slopes(self, numbers: Array) -> Array:
        """Return the derivatives of the residuals, by differences over steps that are short.

        Where the usual step of a number is not small beside its standard error, shorter steps
        follow: the second derivatives, of residuals that are not small, would move the minimum.
        """
        values, slopes = self.linearized(numbers)
        steps = FORWARD_STEP * self.model.scales(numbers)
        deviation = np.sqrt(self.variance(float(values @ values)))
        with np.errstate(divide="ignore", invalid="ignore"):  # Exact data have no deviation.
            moves = np.nan_to_num(np.linalg.norm(slopes, axis=0)) * steps / deviation
        long = (moves > LONG_STEP) & ~self.model.is_event.any()
        if long.any() and np.isfinite(moves).all():
            parts = np.divide(SHORT_STEP, moves, out=np.ones_like(moves), where=long)
            shorter = np.maximum(parts, SHORTEST_PART) * steps
            slopes[:, long] = self.linearized(numbers, shorter)[1][:, long]
        return slopes

    def minima(self, starts: int | None) -> list[Minimum]:
        """Return the minima that the search reaches, the least first.

        Raises
        ------
        InvalidInput
            If no run near the start shows the data.
        """
        bounds = np.stack([self.low, self.high])[:, : len(self.model.fields)]
        reaches = REACHES[:1] if np.isfinite(bounds).all() else REACHES
        followed = FOLLOWED_OF_EVENTS if self.model.is_event.all() else FOLLOWED
        try:
            if starts == 1:
                self.is_local = True
                self._best = [self.refine(self._own_start())]
                return self._best
            for reach in reaches:
                self._scan(self._region(reach), starts or followed)
                if self._best and self.describes(self._best[0]):
                    break
        except (KeyboardInterrupt, SearchStopped) as stop:
            bound = f"the search was ended at its bound of {self.most_runs} runs"
            is_bound = isinstance(stop, SearchStopped)
            if not self._best and self._leading is None:
                if is_bound:
                    raise NotConverged(f"{bound}, before it found a minimum: allow more") from None
                raise
            self.stopped = bound if is_bound else f"the search was ended after {self.runs} runs"
            if not self._best and self._leading is not None:
                self._best = [self._unfinished(self._leading)]
        if not self._best:
            self._own_start()
        return self._best

    def _unfinished(self, numbers: Array) -> Minimum:
        """Return where a search stands that has only seen a part of the data."""
        complete = self.model.with_instruments(numbers[: len(self.model.fields)])
        values = self.residuals(complete)
        return Minimum(complete, float(values @ values), False, self.stopped)

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
        return not any(one.is_correlated for one in self.columns(values, minimum.slopes))

    def columns(self, residuals: Array, jacobian: Array) -> list[ResidualColumn]:
        """Return the residuals of each column of the data; the Jacobian is that of all of them.

        Single readings, such as times of events, are a column of all launches, in the order of what
        the runs show.
        """
        columns, fitted = list[ResidualColumn](), _directions(jacobian, len(residuals))
        single = dict[str, list[int]]()
        values = (self.model.data / self.deviations)[self.measured]

        def add(label: str, rows: Array) -> None:
            small = is_negligible(residuals[rows], values[rows], self.is_noise_known)
            columns.append(ResidualColumn(label, residuals[rows], small, fitted[rows]))

        places = np.where(self.measured, np.cumsum(self.measured) - 1, -1)
        ends = np.cumsum([one.values.size for one in self.model.measurements])[:-1]
        for one, part in zip(self.model.measurements, np.split(places, ends), strict=True):
            table = part.reshape(one.values.shape)
            for label, column in zip(one.observation.labels, table.T, strict=True):
                rows = column[column >= 0]
                if len(column) == 1:
                    single.setdefault(label, []).extend(rows)
                else:
                    add(label, rows)
        for label, places_of in single.items():
            rows = np.array(places_of, dtype=int)
            shown = self.deviations[self.measured][rows] * (values[rows] + residuals[rows])
            add(label, rows[np.argsort(shown, kind="stable")])
        return columns

    def slopes_over_interval(self, numbers: Array, place: int, variance: float) -> Array:
        """Return how the residuals move with a number over about its standard error.

        It stands for derivatives where the run has none: it begins with a change of a thousandth,
        and goes on with the errors that follow.
        """
        scale = float(self.model.scales(numbers)[place])
        change, slopes = 1e-3 * scale, np.zeros(int(self.measured.sum()))
        for _ in range(INTERVAL_ROUNDS):
            ends = list[Array]()
            for sign in (1.0, -1.0):
                moved = numbers.copy()
                moved[place] += sign * change
                ends.append(self.residuals(moved))
            slopes = np.nan_to_num((ends[0] - ends[1]) / (2.0 * change))
            size = float(np.linalg.norm(slopes))
            error = np.sqrt(variance) / size if size else scale
            change = float(np.clip(error, 1e-6 * scale, 0.1 * scale))
        return slopes

    def _own_start(self) -> Array:
        """Return the problem's own numbers, if their run shows the data."""
        first = self.model.start
        if np.isfinite(self.residuals(first)).all():
            return first
        raise InvalidInput(
            "problem",
            f"the run of {self._written(first)}",
            "",
            "does not show all that was measured",
            "start from a problem whose run lasts as long and has those events",
        )

    def _scan(self, region: Region, followed: int) -> None:
        """Follow points of a region from a first part of the data to minima in all of them."""
        fields = len(self.model.fields)
        regions, ends = [region], list[Minimum]()
        for part in self._parts(region):
            search = self if part == 1.0 else self._until(part * self.model.times[-1])
            ranked = list[tuple[float, Array]]()
            for one in regions:
                for pair in search.ranked(one):
                    ranked.append(pair)
                    self._leading = min(ranked, key=itemgetter(0))[1]
                    self._tell(part, self.runs + search.runs * (search is not self), len(ranked))
            ranked = sorted(ranked, key=itemgetter(0))[:followed]
            if not ranked:
                break
            prior = None if part == 1.0 else region
            variance = search.variance(ranked[0][0])
            if search.model.is_event.all():  # Nothing is gained before all of them are refined.
                ends = [Minimum(point, cost, False, "") for cost, point in apart(ranked, region)]
                break
            ends = [search.polish(point, prior, variance) for _, point in ranked]
            ends = search.distinct(ends)[:KEPT]
            self._leading = ends[0].numbers if ends else None
            regions = [search.uncertainty(one, region) for one in ends]
            if search is not self:
                self._runs_of_parts += search.runs
        for end in ends[:MOST_REFINED]:
            with contextlib.suppress(InvalidInput):
                start = self.model.with_instruments(end.numbers[:fields])
                self._best = sorted([*self._best, self.refine(start)], key=by_cost)
            self._check()
        self._best = self.distinct(self._best)
        if self._best:
            self._best[0] = self.lowest_around(self._best[0])

    def lowest_around(self, minimum: Minimum) -> Minimum:
        """Return the lowest minimum within a few standard errors of one along each direction."""
        if self.model.is_event.all():
            return self._lowest_along(minimum, STEPS_TRIED)
        for _ in range(MOST_ROUNDS):
            lowest = self._lowest_along(minimum, TRIED_AROUND)
            if lowest.cost >= minimum.cost - LOWER * self.variance(minimum.cost):
                break
            reached = self.refine(lowest.numbers)
            if reached.cost >= minimum.cost:
                break
            minimum = reached
        return minimum

    def _lowest_along(self, minimum: Minimum, tried: int) -> Minimum:
        """Return the lowest of a minimum and of points around it along each direction."""
        sizes = self.model.scales(minimum.numbers)
        slopes = np.nan_to_num(minimum.slopes) * sizes
        _, strengths, directions = np.linalg.svd(slopes, full_matrices=False)
        deviation = np.sqrt(self.variance(minimum.cost))
        lowest = minimum
        for strength, direction in zip(strengths, directions, strict=True):
            if strength <= NEGLIGIBLE_SLOPE * strengths[0]:
                continue
            for place in np.linspace(-AROUND, AROUND, tried):
                numbers = minimum.numbers + place * deviation / strength * direction * sizes
                numbers = np.clip(numbers, self.low, self.high)
                values = self.residuals(numbers)
                cost = float(values @ values)
                if cost < lowest.cost:
                    lowest = minimum._replace(numbers=numbers, cost=cost)
                self._check()
        return lowest

    def variance(self, cost: float) -> float:
        """Return the variance of the data, in that which is known, by a sum of squares."""
        degrees = max(int(self.measured.sum()) - len(self.model.names), 1)
        return max(1.0 if self.is_noise_known else 0.0, cost / degrees)

    def _until(self, time: float) -> "Search":
        """Return the search in the data up to a time."""
        fields, model = len(self.model.fields), self.model.until(time)
        deviations = deviations_of(model.measurements) if self.is_noise_known else None
        search = Search(model, deviations, self.low[:fields], self.high[:fields])
        search.most_runs = self.most_runs - self.runs
        return search

    def _tell(self, part: float, runs: int, candidates: int) -> None:
        if self.callback is not None:
            self.callback(FitProgress(runs, part, candidates))

    def _check(self) -> None:
        if self.runs > self.most_runs:
            raise SearchStopped

    def _region(self, distance: float) -> Region:
        """Return the region to search: the ranges, or what is near the problem's own numbers."""
        fields = len(self.model.fields)
        center = self.model.own_fields
        sizes = np.where(center == 0.0, self.model.scales(center), np.abs(center))
        reach = distance * sizes
        low = np.where(np.isfinite(self.low[:fields]), self.low[:fields], center - reach)
        high = np.where(np.isfinite(self.high[:fields]), self.high[:fields], center + reach)
        return Region(0.5 * (low + high), np.diag(0.5 * (high - low)))

    def _parts(self, region: Region) -> Iterator[float]:
        """Yield the parts of the duration of the data that are searched one after the other."""
        measurements, end = self.model.measurements, float(self.model.times[-1])
        fewest = FEWEST_PER_NUMBER * len(self.model.names)
        parts = [
            part
            for part in DATA_PARTS
            if part == 1.0
            or sum(one.until(part * end).count for one in measurements if len(one.times)) >= fewest
        ]
        regular = REGULAR * self.model.turning_over(region.center)
        times, bends = self._bends(region.center)
        first = 0
        for place, part in enumerate(parts):
            count = template_count(region.reach, phase_metric(bends[times <= part * end]))
            if place and (count > MOST_TEMPLATES or part * end > regular):
                break
            first = place
        yield from parts[first:]

    def _bends(self, fields: Array) -> tuple[Array, Array]:
        """Return second differences over time of what a run shows, and of its derivatives.

        Returns
        -------
        tuple
            Times, shape (instants,), and the differences over the noise, of the values in the first
            column and of their derivatives in the others, shape (instants, 1 + fields).
        """
        if self.model.is_event.all():
            return np.zeros(0), np.zeros((0, 1 + len(fields)))
        model = self.model.on_fine_grid(float(self.model.times[-1]))
        values, slopes = model.differences(self.model.with_instruments(fields))
        self._runs_of_parts += model.runs
        table = np.column_stack([values, slopes[:, : len(fields)]])
        ends = np.cumsum([one.values.size for one in model.measurements])[:-1]
        times, bends = list[Array](), list[Array]()
        for one, rows in zip(model.measurements, np.split(table, ends), strict=True):
            series = rows.reshape(*one.values.shape, -1)
            if one.noise is not None:
                series = series / one.noise[:, None]
            bends.append(np.diff(series, n=2, axis=0).reshape(-1, table.shape[1]))
            times.append(np.repeat(one.times[2:], one.values.shape[1]))
        return np.concatenate(times), np.concatenate(bends)

    def ranked(self, region: Region) -> Iterator[tuple[float, Array]]:
        """Yield points of a region from which searches find the minima in it.

        Each stands after the sum of squares that the linear model at it promises within the region
        that it stands for. Points whose runs do not show the data are left out.
        """
        fields = len(self.model.fields)
        metric = np.zeros((fields, fields))
        if self.model.is_event.all():
            count = EVENT_GRID.get(fields, 1)
            axes = [np.linspace(-1.0, 1.0, count) if count > 1 else np.zeros(1)] * fields
            grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, fields)
            changes = grid @ region.reach.T
        else:
            metric = phase_metric(self._bends(region.center)[1])
            changes = lattice(region.reach, metric)[: 2 * MOST_TEMPLATES]
        for change in changes:
            center = np.clip(region.center + change, self.low[:fields], self.high[:fields])
            with contextlib.suppress(InvalidInput, np.linalg.LinAlgError):
                point = self.model.with_instruments(center)
                promised = 0.0
                if len(changes) > 1:
                    promised = self._promised(point, region, metric)
                if np.isfinite(promised):
                    yield promised, point
            self._check()

    def _promised(self, point: Array, region: Region, metric: Array) -> float:
        """Return the sum of squares after the linear model's step, no longer than a template's.

        Times of events move in steps, and have none.
        """
        if self.model.is_event.all():
            values = self.residuals(point)
            return float(values @ values)
        values, slopes = self.linearized(point)
        if not (np.isfinite(values).all() and np.isfinite(slopes).all()):
            return np.inf
        fields, sizes = len(self.model.fields), self.model.scales(point)
        step = -np.linalg.lstsq(slopes * sizes, values, rcond=1e-6)[0] * sizes
        moved = step[:fields]
        lengths = [float(np.sqrt(moved @ metric @ moved)) / SPACING]
        lengths.append(float(np.abs(np.linalg.solve(region.reach, moved)).max()))
        promised = values + slopes @ step / max(1.0, *lengths)
        return float(promised @ promised)

    def polish(self, start: Array, prior: Region | None, variance: float) -> Minimum:
        """Return where a short search in a part of the data ends.

        A part of the data does not determine all fields, and would move them far: the region that
        is searched counts as a measurement of them.
        """
        fields = len(self.model.fields)
        weights = np.zeros((0, len(start)))
        if prior is not None:
            weights = np.eye(fields, len(start))
            weights[:, :fields] = np.linalg.inv(prior.reach) * np.sqrt(variance)
        try:
            return self._descend(start, np.ones(len(start), dtype=bool), ROUGH, FEW_STEPS, weights)
        except InvalidInput:
            return Minimum(start, np.inf, False, "the run does not show the data")

    def uncertainty(self, minimum: Minimum, region: Region) -> Region:
        """Return where the truth lies after a search in a part of the data, within a region."""
        fields = len(self.model.fields)
        slopes = minimum.slopes
        if slopes.shape[1] > fields:  # The instrument's numbers are fitted again with the rest.
            basis = np.linalg.qr(slopes[:, fields:])[0]
            slopes = slopes - basis @ (basis.T @ slopes)
        inside = slopes[:, :fields] @ region.reach / np.sqrt(self.variance(minimum.cost))
        _, strengths, directions = np.linalg.svd(inside, full_matrices=True)
        strengths = np.append(strengths, np.zeros(fields - len(strengths)))
        widths = np.minimum(1.0, SPREAD / np.hypot(strengths, 1.0))
        return Region(minimum.numbers[:fields], region.reach @ directions.T * widths)

    def distinct(self, minima: Sequence[Minimum]) -> list[Minimum]:
        """Return minima, the least first, without repetitions and without those far above it."""
        ordered = sorted((one for one in minima if np.isfinite(one.cost)), key=by_cost)
        chosen = list[Minimum]()
        for one in ordered:
            variance = self.variance(ordered[0].cost)
            if one.cost > ordered[0].cost + HOPELESS * variance:
                break
            apart = [before.slopes @ (one.numbers - before.numbers) for before in chosen]
            if all(rows @ rows > SAME**2 * variance for rows in apart):
                chosen.append(one)
        return chosen

    def refine(self, start: Array, held: int | None = None) -> Minimum:
        """Return the minimum that the search reaches from a point, with one number held or none."""
        free = np.array([place != held for place in range(len(start))])
        if not free.any():
            values = self.residuals(start)
            return Minimum(start, float(values @ values), True, "nothing is free")
        has_steps = bool(self.model.is_event.any())
        tolerance = STEPPED_TOLERANCE if has_steps else TOLERANCE
        reached = self._descend(start, free, tolerance, MOST_STEPS, np.zeros((0, len(start))))
        if reached.converged or has_steps or not np.isfinite(reached.cost):
            return reached
        reached = self._by_curvature(reached, free)
        if not reached.converged and self._jumps_beside(reached, free):
            return reached._replace(converged=True, jumps=True)
        return reached

    def _jumps_beside(self, minimum: Minimum, free: Array) -> bool:
        """Return whether the sum of squares does not fall where its derivatives say so."""
        numbers = minimum.numbers.copy()
        free = np.logical_and(free, (self.low < numbers) & (numbers < self.high))
        if not free.any():
            return False
        sizes = self.model.scales(numbers)[free]
        values = self.residuals(numbers)
        slopes = np.nan_to_num(minimum.slopes[:, free]) * sizes
        step = -np.linalg.lstsq(slopes, values, rcond=NEGLIGIBLE_SLOPE)[0] * sizes
        numbers[free] = np.clip(
            numbers[free] + DESCENT_PART * step, self.low[free], self.high[free]
        )
        beside = self.residuals(numbers)
        return bool(np.isfinite(beside).all() and beside @ beside > minimum.cost)

    def _by_curvature(self, start: Minimum, free: Array) -> Minimum:
        """Return the minimum beside a point, by the method of Broyden, Fletcher, Goldfarb, Shanno.

        Steps of Gauss and Newton leave out the second derivatives of the residuals. Where the data
        determine a direction weakly, and the residuals are not small, they approach a minimum
        slowly or not at all. The coordinates are standard errors along the principal directions.
        """
        sizes = self.model.scales(start.numbers)[free]
        slopes = start.slopes[:, free] * sizes
        moved = np.abs(slopes).max(axis=0) > 0.0
        _, strengths, directions = np.linalg.svd(slopes, full_matrices=False)
        determined = strengths > NEGLIGIBLE_SLOPE * strengths[0]
        if not determined.any():
            return start
        variance = 1.0 if self.is_noise_known else self.variance(start.cost)
        basis = sizes[:, None] * directions[determined].T / strengths[determined] * variance**0.5
        low, high = self.low[free], self.high[free]

        def numbers_at(shift: Array) -> Array:
            numbers = start.numbers.copy()
            numbers[free] = np.clip(numbers[free] + basis @ shift, low, high)
            return numbers

        def half_cost(shift: Array) -> float:
            values = self.residuals(numbers_at(shift))
            cost = 0.5 * float(values @ values) / variance
            return cost if np.isfinite(cost) else np.inf

        def gradient(shift: Array) -> Array:
            self._check()
            numbers = numbers_at(shift)
            projected = np.nan_to_num(self.slopes(numbers))[:, free] @ basis
            return np.asarray(projected.T @ np.nan_to_num(self.residuals(numbers)) / variance)

        with np.errstate(all="ignore"):
            result: OptimizeResult = minimize(
                half_cost,
                np.zeros(basis.shape[1]),
                jac=gradient,
                method="BFGS",
                options={"gtol": 0.5 * STATIONARY, "maxiter": QUASI_NEWTON_STEPS},
            )
        numbers = numbers_at(result.x)
        values, slopes = self.residuals(numbers), self.slopes(numbers)
        remaining = _step_left((slopes[:, free] * sizes)[:, moved], values, self.is_noise_known)
        message = f"the last step still moves by {remaining:.2g} standard errors"
        return Minimum(numbers, float(values @ values), remaining < STATIONARY, message, slopes)

    def _descend(
        self, start: Array, free: Array, tolerance: float, steps: int, weights: Array
    ) -> Minimum:
        """Return where SciPy's search ends.

        Its residuals are those of the data and, after them, the matrix `weights` times the way from
        the start.
        """

        def all_numbers(scaled: Array) -> Array:
            numbers = start.copy()
            numbers[free] = scaled * sizes
            return numbers

        # In units of each number's size: pixels of an origin must not hide a small coefficient.
        sizes = self.model.scales(start)[free]
        low, high = self.low[free] / sizes, self.high[free] / sizes

        def residuals_of(scaled: Array) -> Array:
            numbers = all_numbers(scaled)
            return np.append(self.residuals(numbers), weights @ (numbers - start))

        def jacobian_of(scaled: Array) -> Array:
            self._check()
            slopes = np.concatenate([self.slopes(all_numbers(scaled)), weights])
            return np.asarray(np.nan_to_num(slopes[:, free] * sizes))

        first = np.clip(start[free] / sizes, low, high)
        if not np.isfinite(residuals_of(first)).all():
            return Minimum(start, np.inf, False, "the run does not show the data")
        with np.errstate(
            divide="ignore", invalid="ignore"
        ):  # SciPy divides by slopes, which may be zero.
            result: OptimizeResult = least_squares(
                residuals_of,
                first,
                jacobian_of,
                bounds=(low, high),
                x_scale="jac",
                ftol=tolerance,
                xtol=tolerance,
                gtol=None,
                max_nfev=steps,
            )
        data = int(self.measured.sum())
        values, slopes = result.fun[:data], result.jac[:data]
        inside = (result.active_mask == 0) & (np.abs(slopes).max(axis=0) > 0.0)
        remaining = _step_left(slopes[:, inside], values, self.is_noise_known)
        # On a step of a time of an event the linear model leads to where another step begins.
        converged = bool(
            result.status > 0 and (remaining < STATIONARY or self.model.is_event.any())
        )
        message = (
            "too many steps"
            if result.status == 0
            else f"the last step still moves by {remaining:.2g} standard errors"
        )
        all_slopes = np.zeros((data, len(start)))
        all_slopes[:, free] = slopes / sizes
        cost = float(values @ values)
        return Minimum(all_numbers(result.x), cost, converged, message, all_slopes)

    def _written(self, numbers: Array) -> str:
        names = zip(self.model.fields, numbers, strict=False)
        return ", ".join(f"{name} = {number:.4g}" for name, number in names)


def apart(ranked: Sequence[tuple[float, Array]], region: Region) -> list[tuple[float, Array]]:
    """Return points of a grid of events, the best first, without neighbours of better ones.

    Searches from two neighbours end in the same minimum.
    """
    fields = len(region.center)
    spacing = 2.0 / max(EVENT_GRID.get(fields, 1) - 1, 1)
    chosen, places = list[tuple[float, Array]](), list[Array]()
    for cost, point in ranked:
        place = np.linalg.solve(region.reach, point[:fields] - region.center)
        if all(np.abs(place - better).max() > 1.5 * spacing for better in places):
            chosen.append((cost, point))
        places.append(np.asarray(place, dtype=np.float64))
    return chosen


def _directions(jacobian: Array, rows: int) -> Array:
    """Return orthonormal directions in which fitted numbers move the data, shape (rows, numbers).

    Directions that the data do not determine are left out.
    """
    slopes = np.nan_to_num(jacobian)
    slopes = slopes[:, np.abs(slopes).max(axis=0, initial=0.0) > 0.0]
    if not slopes.size:
        return np.zeros((rows, 0))
    sizes = np.linalg.norm(slopes, axis=0)
    directions, strengths, _ = np.linalg.svd(slopes / sizes, full_matrices=False)
    return np.asarray(directions[:, strengths > NEGLIGIBLE_SLOPE * strengths[0]])


def _step_left(jacobian: Array, residuals: Array, is_noise_known: bool) -> float:
    """Return the length of the next step of Gauss and Newton, in standard errors."""
    count, free = jacobian.shape
    if not free:
        return 0.0
    sizes = np.linalg.norm(jacobian, axis=0)
    modes, strengths, _ = np.linalg.svd(jacobian / sizes, full_matrices=False)
    projected = (modes.T @ residuals)[strengths > NEGLIGIBLE_SLOPE * strengths[0]]
    variance = 1.0 if is_noise_known else residuals @ residuals / max(count - free, 1)
    if variance < REPRODUCED:
        return 0.0
    return float(np.linalg.norm(projected) / np.sqrt(variance))


def deviations_of(measurements: Sequence[Measurement]) -> Array | None:
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
