"""Statistics of the residuals of a fit: their size and their correlation."""

from collections.abc import Iterator

import numpy as np

from tippetop.fit.joint_model import JointModel
from tippetop.fit.model import Model
from tippetop.integrators.base import Array

CORRELATED_RESIDUALS = 3.0
"""Standard deviations of the statistic of Durbin and Watson of random residuals, below its mean, at
which residuals count as correlated: one table in a thousand is named wrongly."""

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
    4 (n - 2) / (n^2 - 1).
    """
    count = len(series)
    if count < FEWEST_RESIDUALS or not np.any(series):
        return False
    deviation = (4.0 * (count - 2.0) / (count**2 - 1.0)) ** 0.5
    return bool(durbin_watson(series) < 2.0 - CORRELATED_RESIDUALS * deviation)


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
