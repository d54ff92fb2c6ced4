"""Result of a fit: standard errors, residuals, cautions, and what the data do not determine."""

from collections.abc import Mapping, Sequence, Sized
from dataclasses import dataclass, field
from itertools import combinations
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from scipy.stats import norm, t

from tippetop.fit.measurement import Measurement
from tippetop.fit.observations import Camera
from tippetop.fit.residual_statistics import (
    FEWEST_RESIDUALS,
    MOST_ABOVE,
    RARE_LINE,
    ResidualColumn,
    can_be_correlated,
    durbin_watson,
    durbin_watson_moments,
    exceeds_noise,
    line_probability,
    swing_period,
)
from tippetop.fit.search import Minimum, Search
from tippetop.integrators.base import Array
from tippetop.problem.problem import Problem
from tippetop.results.catalogue import written_unit
from tippetop.support.errors import Described, InvalidInput, NotConverged, is_number
from tippetop.support.suggestions import not_one_of

UNDETERMINED = 1e-6
"""Singular value, relative to the largest, below which data do not determine a direction: above the
errors of the derivatives, which are 1e-8."""

WEAK = 1.0
"""Relative standard error from which on a direction counts as not determined in practice."""

SHARE = 0.3
"""Least component of a number in an undetermined direction to be named."""

ENTANGLED = 0.1
"""Error of a number with another one held, over its error, below which the two count as known only
together. Friction and spin of usual films stay above twice that."""

OUTLIER = 5.0
"""Standardised residual from which on a number counts as an outlier: one in a million random ones
is larger."""

TOO_FEW = "the data are too few to show whether the model fits: a wrong one may fit as well"
"""What is said where no pattern of the residuals would be named."""

RIVAL = 6.0
"""Sum of squares above the least, in variances, up to which another minimum is reported."""

CLEAR = 6.0
"""Difference of BIC from which on one model is preferred: "strong" evidence of Kass and Raftery."""


class Interval(NamedTuple):
    """Limits of a number."""

    low: float
    high: float


@dataclass(frozen=True, eq=False)
class FitResult:
    """The result of `tt.fit`.

    Attributes
    ----------
    problem
        The problem with its fitted numbers; of several launches the first.
    problems
        Those of all launches.
    values, errors
        Fitted numbers and their standard errors, by name: fields of the problem, then numbers of
        the instruments. An error is infinite where the data do not determine the number, and NaN
        where there are no data left to estimate their noise from. Where the run has no derivative,
        it follows from runs over the interval. A time of an event that moves in steps counts as
        known no better than the height of a step.
    covariance
        Labelled matrix.
    residuals
        (prediction - data) / noise of each measurement, shape (rows, columns).
    noise
        Standard deviation that the errors rest on: of each measurement's columns, as it was stated,
        or the estimated one.
    chi2, degrees_of_freedom
        Sum of squared standardised residuals, and the count it is expected to be. NaN where the
        noise was not stated: estimated from the residuals it makes the two equal.
    aic, bic
        Akaike's and Schwarz's criteria of the model; smaller is better.
    undetermined
        Directions that the data do not determine, in words.
    cautions
        Assumptions that the data contradict, and what else a reader must know, in words.
    alternatives
        Other minima that are almost as good, as numbers by name.
    runs
        How many runs the fit followed.

    Examples
    --------
    >>> import tippetop as tt
    >>> problem = tt.presets.report_problem()
    >>> film = tt.Measurement.of_variables(
    ...     [0.0, 0.1, 0.2, 0.3], {"tilt": [0.09, 0.13, 0.11, 0.07]}, noise=0.05
    ... )
    >>> fitted = tt.fit(problem, film, ["friction.mu"])
    >>> sorted(fitted.values)
    ['friction.mu']
    """

    problem: Problem
    problems: tuple[Problem, ...]
    values: Mapping[str, float]
    errors: Mapping[str, float]
    covariance: xr.DataArray
    residuals: tuple[Array, ...]
    noise: tuple[Array, ...]
    chi2: float
    degrees_of_freedom: int
    aic: float
    bic: float
    undetermined: tuple[str, ...]
    cautions: tuple[str, ...]
    alternatives: tuple[Mapping[str, float], ...]
    runs: int
    measurements: tuple[Measurement, ...] = field(repr=False)
    _search: Search = field(repr=False)

    @property
    def correlation(self) -> xr.DataArray:
        """Labelled matrix of correlations."""
        deviations = np.sqrt(np.diag(self.covariance.values))
        with np.errstate(invalid="ignore"):
            return self.covariance / np.outer(deviations, deviations)

    def interval(self, name: str, level: float = 0.95) -> Interval:
        """Return the interval of a number at a level of confidence, by its standard error."""
        reach = self._reach(level) * self.errors[self._checked(name)]
        return Interval(self.values[name] - reach, self.values[name] + reach)

    def profile(self, name: str, level: float = 0.95) -> Interval:
        """Return the interval by the profile likelihood, which needs no linear model.

        The other numbers are fitted again at each trial value. An end is infinite where the data do
        not bound it.

        Raises
        ------
        NotConverged
            If one of those fits does not converge.
        """
        place = list(self.values).index(self._checked(name))
        best = np.array(list(self.values.values()))
        variance = 1.0 if self._search.is_noise_known else self.cost / self.degrees_of_freedom
        reach = self._reach(level)
        error = self.errors[name]
        scale = float(self._search.model.scales(best)[place])
        step = reach * error if np.isfinite(error) else 0.1 * scale
        ends = []
        for side in (-1.0, 1.0):
            nearest = [best]

            def excess(distance: float, side: float = side, nearest: Any = nearest) -> float:
                start = nearest[0].copy()
                start[place] = best[place] + side * distance
                if not np.isfinite(self._search.residuals(start)).all():
                    return np.inf
                minimum = self._search.refine(start, held=place)
                if not minimum.converged:
                    raise NotConverged(
                        f"the profile of {name} did not converge at {start[place]:.4g}"
                        f" ({minimum.message})"
                    )
                nearest[0] = minimum.numbers
                return float(np.sqrt(max(minimum.cost - self.cost, 0.0) / variance) - reach)

            ends.append(best[place] + side * _crossing(excess, step))
        return Interval(float(ends[0]), float(ends[1]))

    def predict(self) -> tuple[Array, ...]:
        """Return what the fitted run shows at the data, shape (rows, columns) each."""
        return tuple(
            one.values + residual * noise
            for one, residual, noise in zip(
                self.measurements, self.residuals, self.noise, strict=True
            )
        )

    def summary(self) -> dict[str, Any]:
        """Return the fit for programs: plain numbers and texts by name."""
        return {
            "problem": self.problem.model_dump(),
            "values": dict(self.values),
            "errors": dict(self.errors),
            "covariance": self.covariance.values.tolist(),
            "chi2": self.chi2 if self._search.is_noise_known else None,
            "degrees_of_freedom": self.degrees_of_freedom,
            "noise": [one.tolist() for one in self.noise],
            "aic": self.aic,
            "bic": self.bic,
            "undetermined": list(self.undetermined),
            "cautions": list(self.cautions),
            "alternatives": [dict(one) for one in self.alternatives],
            "runs": self.runs,
        }

    def __str__(self) -> str:
        """Return the fit in lines for people."""
        units = self.units
        lines = [
            f"{name} = {value:.5g} ± {self.errors[name]:.2g} {units[name]}".rstrip()
            for name, value in self.values.items()
        ]
        lines.append(self.goodness)
        lines += [f"not determined: {direction}" for direction in self.undetermined]
        return "\n".join([*lines, *self.cautions])

    @property
    def units(self) -> dict[str, str]:
        """Units of the fitted numbers as people write them, by name; "" of pure numbers."""
        return dict(zip(self.values, _units(self._search, self.problem), strict=True))

    @property
    def goodness(self) -> str:
        """How well the run fits the data, in words."""
        if self._search.is_noise_known:
            return f"chi² = {self.chi2:.4g} for {self.degrees_of_freedom} degrees of freedom"
        unit = _for_people(self.measurements[0].observation.units[0])
        size = f"{float(self.noise[0][0]):.3g} {unit}".rstrip()
        return f"the noise was not stated: estimated from the residuals, {size}"

    @property
    def cost(self) -> float:
        """Sum of the squared residuals, over the stated variances where there are any."""
        residuals = np.concatenate([one.ravel() for one in self.residuals])
        scale = 1.0 if self._search.is_noise_known else float(self.noise[0][0]) ** 2
        return float(np.nansum(residuals**2)) * scale

    def _reach(self, level: float) -> float:
        """Return half an interval in standard errors."""
        if not (is_number(level) and 0.0 < level < 1.0):
            raise InvalidInput("level", level, "a number between 0 and 1, such as 0.95")
        upper = 0.5 + 0.5 * level
        if self._search.is_noise_known:
            return float(norm.ppf(upper))
        return float(t.ppf(upper, max(self.degrees_of_freedom, 1)))

    def _checked(self, name: str) -> str:
        if name not in self.values:
            raise not_one_of("name", name, list(self.values))
        return name


def result_of(search: Search, best: Minimum, rivals: Sequence[Minimum]) -> FitResult:
    """Return the result of a search that ended in a minimum."""
    model, numbers = search.model, best.numbers
    residuals = search.residuals(numbers)
    jacobian = search.jacobian(numbers)
    count, fitted = jacobian.shape
    degrees = count - fitted
    variance = 1.0 if search.is_noise_known else best.cost / max(degrees, 1)
    for place in np.flatnonzero(~np.isfinite(jacobian).all(axis=0)):
        jacobian[:, place] = search.slopes_over_interval(numbers, int(place), variance)
    scaled = _with_steps(jacobian, search, variance)
    covariance, undetermined = _covariance(
        scaled, model.scales(numbers), model.names, len(model.fields), variance
    )
    columns = search.columns(residuals, jacobian)
    if not search.is_noise_known:
        covariance *= max((one.correlation_time for one in columns), default=1.0)
    if degrees < 1 and not search.is_noise_known:
        covariance[:] = np.nan
    errors = np.sqrt(np.diag(covariance))
    standardised = np.full(len(model.data), np.nan)
    standardised[search.measured] = residuals / np.sqrt(variance) if variance else residuals
    ends = np.cumsum([one.values.size for one in model.measurements])[:-1]
    parts = np.split(standardised, ends)
    deviations = np.split(search.deviations * np.sqrt(variance), ends)
    shaped = tuple(
        part.reshape(one.values.shape) for part, one in zip(parts, model.measurements, strict=True)
    )
    log_likelihood, parameters = _log_likelihood(search, best.cost, count)
    parameters += fitted
    names = list(model.names)
    near = [
        rival
        for rival in rivals
        if rival.cost - best.cost < RIVAL * variance
        and not np.all(np.abs(rival.numbers - numbers) < 3.0 * errors)
    ]
    return FitResult(
        model.problem_of(numbers),
        tuple(model.problems_of(numbers)),
        dict(zip(names, numbers.tolist(), strict=True)),
        dict(zip(names, errors.tolist(), strict=True)),
        xr.DataArray(
            covariance,
            {"parameter": names, "other_parameter": names},
            ("parameter", "other_parameter"),
        ),
        shaped,
        tuple(
            level.reshape(one.values.shape)[0]
            for level, one in zip(deviations, model.measurements, strict=True)
        ),
        best.cost if search.is_noise_known else np.nan,
        degrees,
        2.0 * parameters - 2.0 * log_likelihood,
        float(np.log(count)) * parameters - 2.0 * log_likelihood,
        undetermined,
        (
            *_cautions(search, best, columns, degrees, near),
            *known_together(names, numbers, covariance, _units(search, model.problem_of(numbers))),
        ),
        tuple(dict(zip(names, rival.numbers.tolist(), strict=True)) for rival in near),
        search.runs,
        model.measurements,
        search,
    )


def search_of(fit: FitResult) -> Search:
    """Return the search that a fit came from."""
    return fit._search


FARTHEST = 6
"""Doublings of a distance in search of the end of a profile's interval."""


def _crossing(excess: Any, step: float) -> float:
    """Return the distance at which an increasing function passes zero; infinity if none does."""
    inner, outer = 0.0, step
    for _ in range(FARTHEST):
        height = excess(outer)
        if height == np.inf:
            outer = 0.5 * (inner + outer)
        elif height > 0.0:
            return _halved(excess, inner, outer, 1e-3 * step)
        else:
            inner, outer = outer, 2.0 * outer
    return np.inf


def _halved(excess: Any, inner: float, outer: float, width: float) -> float:
    """Return where a function, negative at the inner end, passes zero or ceases to be finite."""
    while outer - inner > width:
        middle = 0.5 * (inner + outer)
        inner, outer = (middle, outer) if excess(middle) <= 0.0 else (inner, middle)
    return 0.5 * (inner + outer)


def _with_steps(jacobian: Array, search: Search, variance: float) -> Array:
    """Return the derivatives of the residuals over a noise that has the heights of steps in it."""
    steps = (search.model.steps / search.deviations)[search.measured]
    noise = np.sqrt(variance + steps**2)
    weights = np.divide(np.sqrt(variance), noise, out=np.ones_like(noise), where=noise > 0.0)
    return np.asarray(jacobian * weights[:, None])


def _covariance(
    jacobian: Array, scales: Array, names: Sequence[str], fields: int, variance: float
) -> tuple[Array, tuple[str, ...]]:
    """Return the covariance, and the directions that are not determined, in words.

    The first names are those of `fields` of the problem.
    """
    _, strengths, directions = np.linalg.svd(jacobian * scales, full_matrices=False)
    singular = strengths <= UNDETERMINED * strengths[0]
    spread = np.where(singular, 0.0, 1.0 / np.where(singular, 1.0, strengths))
    relative = (directions.T * spread**2) @ directions * variance
    covariance = scales[:, None] * relative * scales
    words = list[str]()
    for direction, strength, null in zip(directions, strengths, singular, strict=True):
        error = np.inf if null else np.sqrt(variance) / strength
        # The origin of a picture may be near zero: its relative error means nothing.
        strongest = np.argmax(np.abs(direction))
        if null or (error >= WEAK and strongest < fields):
            words.append(_direction(direction, names, error))
        if null:
            involved = np.abs(direction) > UNDETERMINED**0.5
            covariance[np.ix_(involved, involved)] = np.inf
    return covariance, tuple(words)


def _direction(direction: Array, names: Sequence[str], error: float) -> str:
    """Return a direction in words."""
    order = np.argsort(-np.abs(direction))
    named = [place for place in order if abs(direction[place]) >= SHARE]
    sign = np.sign(direction[named[0]])
    if len(named) == 1:
        subject = names[named[0]]
    else:
        moves = [
            f"{names[place]} {'up' if sign * direction[place] > 0 else 'down'}" for place in named
        ]
        subject = " with ".join(moves)
    if np.isinf(error):
        return f"{subject} (the data do not change with it)"
    return f"{subject} (to {100.0 * error:.2g} %)"


def _log_likelihood(search: Search, cost: float, count: int) -> tuple[float, int]:
    """Return the logarithm of the likelihood, and how many numbers of the noise it fits."""
    deviations = search.deviations[search.measured]
    if search.is_noise_known:
        return -0.5 * (cost + float(np.log(2.0 * np.pi * deviations**2).sum())), 0
    smallest = np.finfo(float).tiny
    return -0.5 * count * float(np.log(2.0 * np.pi * max(cost / count, smallest)) + 1.0), 1


def _cautions(
    search: Search,
    best: Minimum,
    columns: Sequence[ResidualColumn],
    degrees: int,
    rivals: Sequence[Minimum],
) -> tuple[str, ...]:
    """Return what a reader of the errors must know."""
    model, words = search.model, list[str]()
    is_stated = search.is_noise_known
    if search.stopped:
        words.append(f"{search.stopped}: there may be a better fit")
    if search.is_local:
        words.append(
            "only the minimum next to the start was looked for (one start): others may fit better"
        )
    if best.jumps:
        words.append(
            "the run jumps at these numbers, as its events come in another order beside them: the"
            " errors hold on one side of the jump"
        )
    for rival in rivals:
        numbers = ", ".join(
            f"{name} = {number:.4g}"
            for name, number in zip(model.fields, rival.numbers, strict=False)
        )
        words.append(f"other numbers fit nearly as well: {numbers}")
    for name, reason in model.reasons.items():
        words.append(f"{name} has no linear error: {reason}; its error is from runs beside the fit")
    for name, number, low, high in zip(
        model.names, best.numbers, search.low, search.high, strict=True
    ):
        if min(abs(number - low), abs(number - high)) <= 1e-6 * max(abs(number), 1e-300):
            words.append(f"{name} is at the end of its range: its error means nothing")
    if degrees < 1 and not is_stated:
        words.append("there are as many numbers as data: without a stated noise they have no error")
    if is_stated and exceeds_noise(best.cost, degrees):
        words.append(
            f"chi² is {best.cost:.4g} where {degrees} is expected: the noise is larger than stated,"
            " or the model lacks something (law of friction, air, wear)"
        )
    if is_stated and best.cost < degrees - MOST_ABOVE * (2.0 * max(degrees, 0)) ** 0.5:
        words.append(
            f"chi² is {best.cost:.4g} where {degrees} is expected: the noise is smaller than"
            " stated, and so are the errors"
        )
    has_pattern = any(can_be_correlated(column.fitted) for column in columns)
    if not has_pattern and (degrees > 0 or is_stated) and not exceeds_noise(best.cost, degrees):
        words.append(TOO_FEW)
    deviation = 1.0 if is_stated else np.sqrt(best.cost / max(degrees, 1))
    for column in columns:
        if not column.is_negligible:
            words += _cautions_of_column(column, deviation, is_stated)
    return tuple(words)


def _cautions_of_column(column: ResidualColumn, deviation: float, is_stated: bool) -> list[str]:
    """Return in words what the residuals of a column, of a standard deviation, contradict."""
    words, label, count = list[str](), column.label, len(column.residuals)
    distances = np.abs(column.residuals) / deviation
    outliers = int(np.sum(distances > OUTLIER))
    if outliers and count >= FEWEST_RESIDUALS:
        words.append(
            f"{outliers} of {count} values of {label} are farther from the run than"
            f" {OUTLIER:g} standard deviations, {distances.max():.3g} at most: check them"
        )
    if column.is_correlated:
        length, effect = column.correlation_time, ""
        if length > 1.0:
            effect = ", and the errors are too small"
            if not is_stated:
                effect = f", and the errors take the data for {count / length:.2g} independent ones"
        words.append(
            f"the residuals of {label} are not random: {_pattern(column)}: the model may lack"
            f" something, such as another law of friction{effect}"
        )
    return words


def _pattern(column: ResidualColumn) -> str:
    """Return in words what is regular in the residuals of a column."""
    residuals = column.residuals
    period = swing_period(residuals)
    probability = line_probability(residuals, column.fitted)
    if period is not None and probability < RARE_LINE:
        tables = 1000.0 * probability
        often = f"{tables:.0f}" if tables >= 1.0 else "fewer than 1"
        return (
            f"they swing with a period of {period:.3g} values, as regularly as random ones in"
            f" {often} of 1000 tables"
        )
    ratio, mean = durbin_watson(residuals), durbin_watson_moments(column.fitted).mean
    pattern = "they swing from one value to the next" if ratio > mean else "they drift"
    return f"{pattern} (Durbin-Watson {ratio:.2f}, where {mean:.2f} is expected)"


def _units(search: Search, problem: Problem) -> list[str]:
    """Return the units of the fitted numbers of a problem and of the instruments, for people."""
    units = list[str]()
    for name in search.model.fields:
        field = name.lstrip("0123456789.")  # of one launch of several
        units.append(_for_people(problem.quantity(field).units))
    for measurement in search.model.measurements:
        observation = measurement.observation
        picture = observation.unit if isinstance(observation, Camera) else ""
        for name in observation.parameters:
            if name.endswith("angle"):
                units.append("rad")
            else:
                units.append(f"m/{picture}" if name.endswith("scale") else picture)
    return units


def _for_people(units: str) -> str:
    return "" if units in ("", "1") else written_unit(units)


def known_together(
    names: Sequence[str], numbers: Array, covariance: Array, units: Sequence[str]
) -> list[str]:
    """Return in words which pairs of numbers are known only together, and what is known of them.

    Of a and b with relative errors s and t and correlation r, the product a b^(-r s/t) has the
    relative error s sqrt(1 - r^2), the least of all exponents. Of numbers that are not positive it
    is a sum, and the errors are absolute.
    """
    words = list[str]()
    for first, second in combinations(range(len(names)), 2):
        pair = covariance[np.ix_([first, second], [first, second])]
        if not np.isfinite(pair).all() or not np.diag(pair).all():
            continue
        s, t = np.sqrt(np.diag(pair))
        correlation = float(pair[0, 1] / (s * t))
        narrowing = max(1.0 - correlation**2, 0.0) ** 0.5
        if narrowing >= ENTANGLED:
            continue
        a, b = names[first], names[second]
        if min(numbers[first], numbers[second]) > 0.0:
            s, t = s / numbers[first], t / numbers[second]
            combination = f"{a} · {b}^{-correlation * s / t:.2g} to {100.0 * s * narrowing:.2g} %"
        else:
            sign = "\N{MINUS SIGN}" if correlation > 0.0 else "+"
            combination = f"{a} {sign} {abs(correlation) * s / t:.3g} · {b}"
            combination += f" to {s * narrowing:.2g} {units[first]}".rstrip()
        words.append(
            f"{a} and {b} are known only together (correlation {correlation:.4f}): the data"
            f" determine {combination}"
        )
    return words


class Comparison(NamedTuple):
    """Models compared by Schwarz's criterion.

    Examples
    --------
    >>> import tippetop as tt
    >>> verdict = "the data prefer viscous friction"
    >>> tt.Comparison({"viscous": 0.0}, {"viscous": 1.0}, "viscous", verdict).preferred
    'viscous'
    """

    differences: dict[str, float]
    """BIC above the least, by name of the model; least first."""
    weights: dict[str, float]
    """Akaike weights: how likely each is the best of these."""
    preferred: str | None
    """Name of the model that the data prefer; None if they cannot tell."""
    verdict: str
    """The same in words."""


def compare_fits(fits: Mapping[str, FitResult]) -> Comparison:
    """Return which of several models of the same data is preferred, if the data can tell.

    Parameters
    ----------
    fits
        Results of `tt.fit` by name, such as {"viscous": ..., "coulomb": ...}.

    Raises
    ------
    InvalidInput
        If there are fewer than two, or they are of different data.

    Examples
    --------
    >>> import tippetop as tt
    >>> film = tt.Measurement.of_variables(
    ...     [0.0, 0.1, 0.2, 0.3], {"tilt": [0.09, 0.13, 0.11, 0.07]}, noise=0.05
    ... )
    >>> slips = tt.fit(tt.presets.report_problem(), film, ["friction.mu"])
    >>> spins = tt.fit(tt.presets.report_problem(), film, ["friction.mu", "launch.spin"])
    >>> comparison = tt.compare_fits({"mu": slips, "mu and spin": spins})
    >>> sorted(comparison.weights)
    ['mu', 'mu and spin']
    """
    if not isinstance(fits, Mapping) or len(fits) < 2:
        size = f" of {len(fits)}" if isinstance(fits, Sized) else ""
        stated = Described(f"a {type(fits).__name__}{size}")
        accepted = 'at least two results of tt.fit by name, such as {"viscous": a, "dry": b}'
        raise InvalidInput("fits", stated, accepted)
    first, *others = fits.values()
    data = [one.values for one in first.measurements]
    for one in others:
        values = [measurement.values for measurement in one.measurements]
        if len(values) != len(data) or not all(
            np.array_equal(a, b, equal_nan=True) for a, b in zip(values, data, strict=True)
        ):
            raise InvalidInput("fits", ", ".join(fits), "fits of the same data")
    order = sorted(fits, key=lambda name: fits[name].bic)
    differences = {name: fits[name].bic - fits[order[0]].bic for name in order}
    least = min(one.aic for one in fits.values())
    weights = {name: float(np.exp(-0.5 * (fits[name].aic - least))) for name in order}
    total = sum(weights.values())
    weights = {name: weight / total for name, weight in weights.items()}
    second = order[1]
    clear = differences[second] >= CLEAR
    verdict = (
        f"the data prefer {order[0]}: BIC is {differences[second]:.3g} less than with {second}"
        if clear
        else f"the data cannot tell {order[0]} from {second}: BIC differs by"
        f" {differences[second]:.2g} alone"
    )
    return Comparison(differences, weights, order[0] if clear else None, verdict)
