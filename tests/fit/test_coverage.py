"""Intervals of fits cover the truth as often as they say, over synthetic films."""

import numpy as np
import pytest

import tippetop as tt
from campaigns import seed_ranges

PIXEL, BLUR, LOST = 2e-4, 0.5, 0.1
"""Size of a pixel, m; noise of a mark, pixels; and share of frames without one."""

BODIES = (tt.presets.REPORT, tt.presets.COHEN)
TIPS = (0.026, 0.03)
"""Heights of the marked points over the centres of mass, m."""

RATES = {0.68: 0.994458, 0.95: 1.959964}
"""Rates at which intervals cover, and their half-widths in standard errors."""


def experiment(seed):
    """Return (fitted - true) / error of every number of a synthetic film."""
    random = np.random.default_rng(seed)
    mu = float(random.uniform(0.2, 0.4))
    friction = (
        tt.ViscousFriction(mu=mu),
        tt.RegularizedCoulombFriction(mu=mu, eps=0.1),
        tt.ContensouFriction(mu=mu, patch_radius=1e-3),
    )[seed % 3]
    which = seed // 3 % 2
    spin, tilt = float(random.uniform(100.0, 150.0)), float(random.uniform(0.08, 0.3))
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
    near = random.normal(1.0, 0.03, 2)
    guess = true.replace({"friction.mu": mu * float(near[0]), "launch.spin": spin * float(near[1])})
    fitted = tt.fit(guess, film, ["friction.mu", "launch.spin"])
    truth = {"friction.mu": mu, "launch.spin": spin, "camera.angle": angle}
    truth |= {"camera.x": 320.0, "camera.y": 40.0}
    return [(fitted.values[name] - truth[name]) / fitted.errors[name] for name in truth]


@pytest.mark.parametrize("which", seed_ranges(check=0, sample=3, claim=200, size=197))
def test_intervals_cover_the_truth(which):
    scores = np.abs([experiment(seed) for seed in which])
    for rate, width in RATES.items():
        covered = np.mean(scores < width)
        # The numbers of one film are correlated: films count, not numbers.
        standard_error = np.sqrt(rate * (1.0 - rate) / len(scores))
        assert abs(covered - rate) < 3.0 * standard_error, (rate, covered)
