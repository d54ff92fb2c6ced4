"""Statistics of the residuals of a fit: their size and their correlation."""

from collections.abc import Iterator

import numpy as np

from tippetop.fit.joint_model import JointModel
from tippetop.fit.model import Model
from tippetop.integrators.base import Array

CORRELATED_RESIDUALS = 2.6
"""Standard deviations of the statistic of Durbin and Watson of random residuals, from its mean, at
which residuals count as correlated: one table in a hundred is named wrongly. With 3 a wrong law of
friction passes that leaves residuals of half as much again as the noise."""

RARE_LINE = 5e-3
"""Probability of a line in the periodogram of random residuals below which they count as
correlated: it adds half as many tables that are named wrongly, and all films of a wrong law in
which the oscillation that is left is neither slow nor alternates."""

FEWEST_RESIDUALS = 8
"""Residuals from which on their statistic says something."""

MOST_ABOVE = 4.0
"""Standard deviations of a sum of squares from its expected value beyond which noise of the stated
size does not explain it."""


def exceeds_noise(cost: float, degrees: int, deviations: float = MOST_ABOVE) -> bool:
    """Return whether a sum of squares over known variances is so far above the expected one."""
    return degrees > 0 and cost > degrees + deviations * (2.0 * degrees) ** 0.5


def columns_of(model: Model | JointModel, residuals: Array) -> Iterator[tuple[str, Array]]:
    """Yield the label and the residuals of each column of the data, without missing ones."""
    ends = np.cumsum([one.values.size for one in model.measurements])[:-1]
    for one, part in zip(model.measurements, np.split(residuals, ends), strict=True):
        table = part.reshape(one.values.shape)
        for label, column in zip(one.observation.labels, table.T, strict=True):
            yield label, column[np.isfinite(column)]


def durbin_watson(series: Array) -> float:
    """Return the statistic of Durbin and Watson of residuals: 2 for random ones, 0 for drifts."""
    return float(np.sum(np.diff(series) ** 2) / np.sum(series**2))


def are_correlated(series: Array) -> bool:
    """Return whether residuals, where there are enough, are no random ones.

    For random ones the statistic of Durbin and Watson has the mean 2 and the variance
    4 (n - 2) / (n^2 - 1). It is below 2 for drifts, and above 2 where neighbours alternate; an
    oscillation between shows as a line in the periodogram.
    """
    count = len(series)
    if count < FEWEST_RESIDUALS or not np.any(series):
        return False
    deviation = (4.0 * (count - 2.0) / (count**2 - 1.0)) ** 0.5
    is_drift = abs(durbin_watson(series) - 2.0) > CORRELATED_RESIDUALS * deviation
    return bool(is_drift) or line_probability(series) < RARE_LINE


def line_probability(series: Array) -> float:
    """Return how probable so strong a line in the periodogram is among random residuals.

    Of m ordinates the largest has more than a part g of their sum with a probability of at most
    m (1 - g)^(m - 1): R. A. Fisher, Tests of significance in harmonic analysis, Proc. R. Soc. A 125
    (1929), 54.
    """
    power = np.abs(np.fft.rfft(series))[1 : (len(series) + 1) // 2] ** 2
    if not np.any(power):  # All residuals are equal.
        return 1.0
    largest, count = float(power.max() / power.sum()), len(power)
    return min(1.0, count * (1.0 - largest) ** (count - 1))


def correlation_time(series: Array) -> float:
    """Return how many successive residuals count as one: the sum of their autocorrelation.

    It is 1 for residuals that are not correlated. The sum ends where the autocorrelation of two
    neighbouring lags is negative together: C. J. Geyer, Practical Markov chain Monte Carlo,
    Statistical Science 7 (1992), 473.
    """
    if not are_correlated(series):
        return 1.0
    size, total = float(series @ series), 1.0
    for lag in range(1, len(series) - 1, 2):
        pair = series[lag:] @ series[:-lag] + series[lag + 1 :] @ series[: -lag - 1]
        if pair <= 0.0:
            break
        total += 2.0 * float(pair) / size
    return min(total, len(series) / 2.0)
