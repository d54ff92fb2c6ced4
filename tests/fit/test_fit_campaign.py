"""Fits from guesses that are off find what made the data, of known truth."""

import warnings
from typing import NamedTuple

import numpy as np
import pytest

import tippetop as tt
from campaigns import seed_ranges
from made_data import NOISES, rising_law

KINDS = ("tilt", "tip from the side", "tip from above", "turns a minute", "time of turning over")
TIP = 0.026
"""Height of the report's top above its centre of mass, m."""
PIXEL, BLUR = 2e-4, 1.5
OFF = 0.1
"""How far guesses are off, relative to the truth, at most."""
LAUNCHES = 10
"""Launches of a table of times."""
LONGEST = 60.0
"""Seconds within which a launch of a table turns over."""


class Case(NamedTuple):
    """Data of known truth."""

    kind: str
    true: list[tuple[tt.Problem, tt.Measurement]]
    """The problems that made the data, and the data."""
    fields: list[str]

    @property
    def truth(self):
        """The numbers that are sought."""
        return np.array([self.true[0][0].get(field) for field in self.fields])

    def fitted(self, numbers, **options):
        """Return the fit from some numbers."""
        guess = dict(zip(self.fields, numbers.tolist(), strict=True))
        pairs = [(problem.replace(guess), data) for problem, data in self.true]
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", tt.Implausible)
            if len(pairs) == 1:
                return tt.fit(*pairs[0], self.fields, **options)
            return tt.fit(pairs, shared=self.fields, **options)


def scores_of(fitted, truth):
    """Return (fitted - true) / error of the numbers that are sought."""
    values, errors = (np.array(list(one.values())) for one in (fitted.values, fitted.errors))
    return (values[: len(truth)] - truth) / errors[: len(truth)]


class Verdict(NamedTuple):
    """What became of a fit."""

    kind: str
    scores: np.ndarray
    """(fitted - true) / error of the numbers that are sought."""
    has_caution: bool
    above: float
    """Sum of squares above that of a search from the truth, in variances."""
    runs: int


def case_of(seed):
    """Return data of known truth, and the generator that made them."""
    random, kind = np.random.default_rng(seed), KINDS[seed % len(KINDS)]
    spin, mu = float(random.uniform(100.0, 160.0)), float(random.uniform(0.2, 0.4))
    true = tt.presets.report_problem(spin=spin).replace(
        {"friction": rising_law(seed // len(KINDS), mu)}
    )
    is_stated = bool(random.random() < 0.5)
    if kind == "time of turning over":
        return Case(kind, timed(true, is_stated, random), ["friction.mu"]), random
    film = filmed(kind, true, is_stated, random)
    return Case(kind, [(true, film)], ["friction.mu", "launch.spin"]), random


def timed(true, is_stated, random):
    """Return launches of several spins, and when each has turned over."""
    pairs, noise = list[tuple[tt.Problem, tt.Measurement]](), NOISES["time of turning over"]
    while len(pairs) < LAUNCHES:
        launch = true.replace({"launch.spin": float(random.uniform(100.0, 160.0))})
        turned = float(tt.simulate(launch, LONGEST, samples=2)["turnover_time"])
        if np.isfinite(turned):
            times = {"turnover_time": turned + float(random.normal(0.0, noise))}
            pairs.append((launch, tt.Measurement.of_events(times, noise if is_stated else None)))
    return pairs


def filmed(kind, true, is_stated, random):
    """Return a film or a sound of a launch."""
    rate, duration = float(random.choice([30, 60, 120, 240])), float(random.choice([1, 2, 4]))
    times = np.arange(0.0, duration, 1.0 / rate)
    run = tt.simulate(true, duration, times=np.append(times, duration)).isel(time=slice(0, -1))
    noise = NOISES.get(kind, BLUR)
    stated = noise if is_stated else None
    if kind == "tilt":
        seen = run["tilt"].values + random.normal(0.0, noise, len(times))
        return tt.Measurement.of_variables(times, {"tilt": seen}, stated)
    if kind == "turns a minute":
        seen = np.abs(run["spin"].values) * 30.0 / np.pi
        return tt.Measurement.of_spin(times, seen + random.normal(0.0, noise, len(times)), stated)
    axis, angle = TIP * run["axis"].values, float(random.uniform(-1.0, 1.0))
    east, north = run["x"].values + axis[:, 0], run["y"].values + axis[:, 1]
    across = np.cos(angle) * east + np.sin(angle) * north
    side = kind.endswith("side")
    up = run["height"].values + axis[:, 2] if side else np.cos(angle) * north - np.sin(angle) * east
    x, y = (one / PIXEL + random.normal(300.0, noise, len(times)) for one in (across, up))
    view = "side" if side else "above"
    return tt.Measurement.of_point(times, x + 20.0, y - 260.0, view, scale=PIXEL, noise=stated)


def verdicts(seed, guesses):
    """Return what becomes of the fits of one case from several guesses."""
    case, random = case_of(seed)
    truth = case.truth
    local, rows = case.fitted(truth, starts=1), list[Verdict]()
    for _ in range(guesses):
        fitted = case.fitted(truth * (1.0 + random.uniform(-OFF, OFF, len(truth))))
        scores = scores_of(fitted, truth)
        variance = 1.0 if np.isfinite(fitted.chi2) else float(local.noise[0][0]) ** 2
        above = (fitted.cost - local.cost) / variance
        rows.append(Verdict(case.kind, scores, bool(fitted.cautions), above, fitted.runs))
    return rows


@pytest.mark.parametrize("which", seed_ranges(check=0, sample=2, claim=202, size=200))
def test_fits_without_a_caution_hold_the_truth(which):
    """Of fits without a caution 97 % have both numbers within 3 standard errors, and one fit a film
    covers at 1 standard error with a rate between 60 and 76 %.
    """
    guesses = 1 if len(which) < 10 else 3
    rows = [row for seed in which for row in verdicts(seed, guesses)]
    clean = [row for row in rows if not row.has_caution]
    wrong = sum(np.abs(row.scores).max() > 3.0 for row in clean)
    assert wrong <= 0.03 * len(clean)
    assert max(row.above for row in rows) < 0.1
    right = [row for row in rows if np.abs(row.scores).max() <= 3.0]
    assert np.median([row.runs for row in rows]) <= 2000
    if len(which) > 10:
        assert np.mean([row.has_caution for row in right]) <= 0.1
        covered = np.mean([np.abs(row.scores) < 1.0 for row in rows[::guesses]])
        assert 0.6 < covered < 0.76


@pytest.mark.slow
@pytest.mark.parametrize(("seed", "jumps"), [(118, True), (119, False)])
def test_searches_end_in_one_minimum_where_the_misfit_jumps(seed, jumps):
    """In 118 the top leaves the table in another order beside the minimum; in 119 ten times of
    turning over move in steps of half a standard deviation.
    """
    case, random = case_of(seed)
    ends = [
        case.fitted(case.truth * (1.0 + random.uniform(-OFF, OFF, len(case.truth))))
        for _ in range(2)
    ]
    variance = 1.0 if np.isfinite(ends[0].chi2) else float(ends[0].noise[0][0]) ** 2
    assert abs(ends[0].cost - ends[1].cost) < 0.1 * variance
    for fitted in ends:
        assert any("jumps" in one for one in fitted.cautions) == jumps == bool(fitted.cautions)
        assert np.all(np.abs(scores_of(fitted, case.truth)) < 3.0)
