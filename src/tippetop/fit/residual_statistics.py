"""Statistics of the residuals of a fit: their size and their correlation."""

from typing import NamedTuple

import numpy as np

from tippetop.integrators.base import Array

CORRELATED_RESIDUALS = 2.6
"""Standard deviations of the statistic of Durbin and Watson of random residuals, from its mean, at
which residuals count as correlated: one table in a hundred is named wrongly. With 3 a wrong law of
friction passes that leaves residuals of half as much again as the noise."""

RARE_LINE = 5e-3
"""Probability of a line in the periodogram of random residuals below which they count as
correlated: it adds half as many tables that are named wrongly, and all films of a wrong law in
which the oscillation that is left is neither slow nor alternates."""

FEWEST_RESIDUALS, FEWEST_DEGREES = 8, 2.0
"""Residuals, and those less the fitted numbers, from which on their statistic says something."""

FINER = 16
"""How much finer than Fourier's the frequencies are at which an oscillation is sought."""

FEWEST_SWINGS = 1.5
"""Periods within the data from which on an oscillation is a swing, and not a drift."""

MANY_DEGREES = 30.0
"""Residuals less the fitted numbers from which on some pattern of them is always named."""

MOST_ABOVE = 4.0
"""Standard deviations of a sum of squares from its expected value beyond which noise of the stated
size does not explain it."""


ROUNDING = 1e-9
"""Size of residuals over the largest of the values, up to which they are rounding of runs: a real
reading is rougher, and a run more exact."""

FAR_BELOW_NOISE = 0.1
"""Size of residuals over the stated noise, up to which they are none of it: errors of that size
would show in nothing that a fit tells."""


class ResidualColumn(NamedTuple):
    """Residuals of a column of the data, without missing ones."""

    label: str
    residuals: Array
    """(prediction - data) / noise, or prediction - data where no noise is known."""
    is_negligible: bool
    """Whether they are so small that their pattern says nothing of the model."""
    fitted: Array
    """Directions in which the fit moves them, orthonormal in all data, shape (rows, numbers)."""

    @property
    def is_correlated(self) -> bool:
        """Whether the residuals show that the model lacks something."""
        return not self.is_negligible and are_correlated(self.residuals, self.fitted)

    @property
    def correlation_time(self) -> float:
        """How many successive residuals count as one."""
        return correlation_time(self.residuals) if self.is_correlated else 1.0


def is_negligible(residuals: Array, values: Array, is_noise_known: bool) -> bool:
    """Return whether residuals are rounding of the values, or far below a noise that is known.

    Both are over the noise, where that is known.
    """
    size = float(np.sqrt(np.mean(residuals**2))) if len(residuals) else 0.0
    least = ROUNDING * float(np.abs(values).max(initial=0.0))
    return size <= (max(least, FAR_BELOW_NOISE) if is_noise_known else least)


def exceeds_noise(cost: float, degrees: int, deviations: float = MOST_ABOVE) -> bool:
    """Return whether a sum of squares over known variances is so far above the expected one."""
    return degrees > 0 and cost > degrees + deviations * (2.0 * degrees) ** 0.5


def durbin_watson(series: Array) -> float:
    """Return the statistic of Durbin and Watson of residuals: 2 for random ones, 0 for drifts."""
    return float(np.sum(np.diff(series) ** 2) / np.sum(series**2))


class Moments(NamedTuple):
    """Mean and standard deviation of a statistic of residuals of white noise."""

    mean: float
    deviation: float


def durbin_watson_moments(fitted: Array) -> Moments:
    """Return the moments of the statistic of Durbin and Watson of a fit's residuals.

    Of the n residuals S e of white noise e, with S = 1 - Q Q^T, the statistic is the ratio of
    e^T S A S e and e^T S S e, with the second differences A. Its mean is E = tr(A S) / tr(S), and
    its variance 2 tr((B S)^2) / (tr(S)^2 + 2 tr(S^2)), with B = A - E: J. Durbin and G. S. Watson,
    Testing for serial correlation in least squares regression, Biometrika 37 (1950), 409. Both are
    exact where S is a projection, as it is for the only column of a table.

    Parameters
    ----------
    fitted
        Orthonormal directions Q in which the fit moves the data, shape (n, numbers), or the rows of
        them that belong to the column.
    """
    count = len(fitted)
    steps = np.diff(fitted, axis=0)
    second = np.diff(steps, axis=0, prepend=0.0, append=0.0) * -1.0  # A Q
    gram, bent = fitted.T @ fitted, fitted.T @ second
    trace = count - float(np.trace(gram))
    mean = (2.0 * (count - 1.0) - float(np.trace(bent))) / trace
    moved, shifted = second - mean * fitted, bent - mean * gram  # B Q and Q^T B Q
    total = (6.0 * count - 8.0) - 4.0 * mean * (count - 1.0) + mean**2 * count  # tr(B^2)
    squares = total - 2.0 * float(np.sum(moved**2)) + float(np.sum(shifted**2))
    norm = count - 2.0 * float(np.trace(gram)) + float(np.sum(gram**2))
    variance = 2.0 * squares / (trace**2 + 2.0 * norm)
    return Moments(mean, max(variance, 0.0) ** 0.5)


def are_correlated(series: Array, fitted: Array | None = None) -> bool:
    """Return whether residuals, where there are enough, are no random ones.

    The statistic of Durbin and Watson is below its mean for drifts, and above it where neighbours
    alternate; an oscillation between shows as a line in the periodogram.

    Parameters
    ----------
    series
        The residuals.
    fitted
        Directions in which the fit moves the data (see `durbin_watson_moments`); none where the
        series is no residual of a fit.
    """
    count = len(series)
    fitted = np.zeros((count, 0)) if fitted is None else fitted
    if count < FEWEST_RESIDUALS or count - np.sum(fitted**2) < FEWEST_DEGREES or not series.any():
        return False
    mean, deviation = durbin_watson_moments(fitted)
    is_drift = abs(durbin_watson(series) - mean) > CORRELATED_RESIDUALS * deviation
    return bool(is_drift) or line_probability(series, fitted) < RARE_LINE


def line_probability(series: Array, fitted: Array) -> float:
    """Return how probable so strong a line in the periodogram is among random residuals.

    Of m ordinates the largest has more than a part g of their sum with a probability of at most
    m (1 - g)^(m - 1): R. A. Fisher, Tests of significance in harmonic analysis, Proc. R. Soc. A 125
    (1929), 54. An ordinate of which the fit takes a part away counts as the part that is left.
    """
    inner = slice(1, (len(series) + 1) // 2)
    power = np.abs(np.fft.rfft(series))[inner] ** 2
    if not np.any(power):  # All residuals are equal.
        return 1.0
    removed = np.sum(np.abs(np.fft.rfft(fitted, axis=0))[inner] ** 2, axis=1) / len(series)
    largest, count = float(power.max() / power.sum()), float(np.sum(1.0 - removed))
    return float(min(1.0, count * (1.0 - largest) ** max(count - 1.0, 0.0)))


def swing_period(series: Array) -> float | None:
    """Return the period of the strongest oscillation, in values; None if they drift."""
    count = len(series)
    power = np.abs(np.fft.rfft(series, FINER * count)) ** 2
    turns = float(np.argmax(power)) / FINER
    return count / turns if turns >= FEWEST_SWINGS else None


def can_be_correlated(fitted: Array) -> bool:
    """Return whether any residuals of a fit would be named as no random ones.

    Tried are the smoothest and the roughest that the fit leaves, and what it leaves of waves.

    Parameters
    ----------
    fitted
        Directions in which the fit moves the data (see `durbin_watson_moments`).
    """
    count = len(fitted)
    if count - np.sum(fitted**2) >= MANY_DEGREES:
        return True
    projection = np.eye(count) - fitted @ fitted.T
    sizes, directions = np.linalg.eigh(projection)
    basis = directions[:, sizes > 1e-9]
    if not basis.size:
        return False
    _, by_roughness = np.linalg.eigh(
        basis.T @ np.diff(np.eye(count), axis=0).T @ np.diff(basis, axis=0)
    )
    waves = np.fft.rfft(np.eye(count), axis=0)
    patterns = [
        *(basis @ by_roughness[:, [0, -1]]).T,
        *waves.real @ projection,
        *waves.imag @ projection,
    ]
    return any(are_correlated(one, fitted) for one in patterns if np.abs(one).max() > 1e-9)


def correlation_time(series: Array) -> float:
    """Return how many successive residuals count as one: the sum of their autocorrelation.

    The sum ends where the autocorrelation of two neighbouring lags is negative together:
    C. J. Geyer, Practical Markov chain Monte Carlo, Statistical Science 7 (1992), 473.
    """
    size, total = float(series @ series), 1.0
    for lag in range(1, len(series) - 1, 2):
        pair = series[lag:] @ series[:-lag] + series[lag + 1 :] @ series[: -lag - 1]
        if pair <= 0.0:
            break
        total += 2.0 * float(pair) / size
    return min(total, len(series) / 2.0)
