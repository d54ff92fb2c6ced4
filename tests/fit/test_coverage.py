"""Intervals of fits cover the truth as often as they say, over synthetic films."""

import numpy as np
import pytest

import tippetop as tt
from campaigns import seed_ranges
from tippetop.fit.fit_result import CLEAR
from tippetop.fit.residual_statistics import exceeds_noise

PIXEL, BLUR, LOST = 2e-4, 0.5, 0.1
"""Size of a pixel, m; noise of a mark, pixels; and share of frames without one."""

BODIES = (tt.presets.REPORT, tt.presets.COHEN)
TIPS = (0.026, 0.03)
"""Heights of the marked points over the centres of mass, m."""

RATES = {0.68: 0.994458, 0.95: 1.959964}
"""Rates at which intervals cover, and their half-widths in standard errors."""


WRONGLY_PREFERRED = 0.0072
"""Rate at which, at most, noise makes a wrong law of as many numbers fit better by a BIC of 6: the
difference is d^2 + 2 d z for laws that are d standard errors apart, z normal."""


def laws_of(random, seed, spin):
    """Return a friction law, and another one that acts alike at small slip."""
    mu, patch, eps = float(random.uniform(0.2, 0.4)), 1e-3, 0.1
    drilling = 3.0 * np.pi / (8.0 * spin * patch)
    return (
        (
            tt.ViscousFriction(mu=mu),
            tt.ContensouFriction(mu=mu / drilling, patch_radius=patch),
        ),
        (tt.RegularizedCoulombFriction(mu=mu, eps=eps), tt.ViscousFriction(mu=mu / eps)),
        (tt.ContensouFriction(mu=mu, patch_radius=patch), tt.ViscousFriction(mu=mu * drilling)),
    )[seed % 3]


def experiment(seed):
    """Return (fitted - true) / error of every number of a synthetic film, how much larger BIC is
    with another law, and whether the residuals are of the size of the noise.
    """
    random = np.random.default_rng(seed)
    spin, tilt = float(random.uniform(100.0, 150.0)), float(random.uniform(0.08, 0.3))
    friction, beside = laws_of(random, seed, spin)
    which = seed // 3 % 2
    launch = tt.Launch(tilt=tilt, spin=spin)
    true = tt.Problem(body=BODIES[which], friction=friction, launch=launch)
    times = np.arange(0.0, 1.0, 1.0 / 60.0)
    run = tt.simulate(true, float(times[-1]), times=times)
    angle, tip = float(random.uniform(-1.0, 1.0)), TIPS[which]
    axis = run["axis"].values * tip
    east, north = run["x"].values + axis[:, 0], run["y"].values + axis[:, 1]
    across = (np.cos(angle) * east + np.sin(angle) * north) / PIXEL + 320.0
    up = (run["height"].values + axis[:, 2]) / PIXEL + 40.0
    seen = np.stack([across, up], 1) + random.normal(0.0, BLUR, (len(times), 2))
    seen[random.random(len(times)) < LOST] = np.nan
    film = tt.Measurement.of_point(times, *seen.T, "side", scale=PIXEL, noise=BLUR)
    mu_off, spin_off = map(float, random.normal(1.0, 0.03, 2))

    def fitted_with(law, **options):
        guess = {"friction.mu": law.mu * mu_off, "launch.spin": spin * spin_off}
        start = true.replace({"friction": law}).replace(guess)
        return tt.fit(start, film, ["friction.mu", "launch.spin"], **options)

    fitted = fitted_with(friction)
    truth = {"friction.mu": friction.mu, "launch.spin": spin, "camera.angle": angle}
    truth |= {"camera.x": 320.0, "camera.y": 40.0}
    scores = [(fitted.values[name] - truth[name]) / fitted.errors[name] for name in truth]
    fits = not exceeds_noise(fitted.chi2, fitted.degrees_of_freedom)
    try:
        comparison = tt.compare_fits({"true": fitted, "other": fitted_with(beside, starts=1)})
    except tt.NotConverged:
        return scores, np.inf, fits
    return scores, comparison.differences["other"] - comparison.differences["true"], fits


@pytest.mark.parametrize("which", seed_ranges(check=0, sample=3, claim=200, size=197))
def test_intervals_cover_the_truth(which):
    """Seeds 5, 40 and 57 begin beside other minima. Of 200 films one, 59, ends in another minimum,
    and its fit says that it does not describe the data.
    """
    films = [experiment(seed) for seed in which]
    assert sum(not fits for *_, fits in films) <= 0.01 * len(films)
    scores = np.abs([scores for scores, *_ in films])
    for rate, width in RATES.items():
        covered = np.mean(scores < width)
        # The numbers of one film are correlated: films count, not numbers.
        standard_error = np.sqrt(rate * (1.0 - rate) / len(scores))
        assert abs(covered - rate) < 3.0 * standard_error, (rate, covered)
    wrong = sum(difference <= -CLEAR for _, difference, _ in films)
    expected = WRONGLY_PREFERRED * len(films)
    assert wrong <= expected + 3.0 * np.sqrt(expected)
