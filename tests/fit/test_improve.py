"""Improved tops turn over in runs, can be made, and have the mass that they claim."""

import numpy as np
import pytest

import tippetop as tt
from tippetop.theory.advice import standing_spin
from tippetop.theory.prospects import prospects

CREEP = tt.ContensouFriction(mu=0.3, patch_radius=5e-4)
USUAL = 155.0
"""Spin of a launch by hand, rad/s."""

POOR = [
    name
    for name in ("friedl", "wooden", "report-thin-stem")
    if not standing_spin(tt.presets.body(name)) < USUAL
]
"""Presets that are tops, and do not turn over and stand from the usual spin."""


def volume(profile):
    """Return the volume that a closed polygon of (distance, height) sweeps about the axis, m^3."""
    r, z = np.array(profile).T
    s, w = np.roll(r, -1), np.roll(z, -1)
    return np.pi / 3.0 * abs(np.sum((r * w - s * z) * (r + s)))


@pytest.mark.slow  # Examples of `tt.improve` follow one of them in every check.
@pytest.mark.parametrize("name", POOR)
def test_a_poor_top_made_better_turns_over(name):
    better = tt.improve(tt.presets.body(name))
    assert better.spin < USUAL < better.before
    launch = tt.Launch(tilt=0.1, spin=USUAL)
    problem = tt.Problem(body=better.body, friction=CREEP, launch=launch)
    assert float(tt.simulate(problem, 20.0, samples=2)["turnover_time"]) < 20.0
    # The solid can be made, and its volume, of a polygon along its profile, has the mass.
    assert better.sizes["wall"] >= 1e-3
    assert better.sizes["stem"] >= 1.5e-3
    points = better.workpiece.outline.points(200)
    mass = better.workpiece.density * volume(np.stack([points.real, points.imag], 1))
    assert better.body.mass == pytest.approx(mass, rel=1e-3)


@pytest.mark.slow
@pytest.mark.parametrize("goal", ["fastest", "stands longest"])
def test_goals_are_met_better_than_by_the_least_spin(goal):
    least = tt.improve(tt.presets.WOODEN)
    spin = 1.3 * least.spin
    better = tt.improve(tt.presets.WOODEN, goal, spin=spin)
    assert better.spin <= spin
    measure = turning_over if goal == "fastest" else lying
    assert measure(better.body, spin) <= measure(least.body, spin)


def turning_over(body, spin):
    """Return the time after which a run has turned over, s."""
    problem = tt.Problem(body=body, friction=CREEP, launch=tt.Launch(tilt=0.1, spin=spin))
    return float(tt.simulate(problem, 20.0, samples=2)["turnover_time"])


def lying(body, spin):
    """Return minus the time for which drilling lets a top stand on its stem, s."""
    stem = prospects(body, list(body.shapes)).stem
    inverted = tt.Launch(tilt=np.pi, spin=stem.spin * spin / stem.launch)
    alone = body.model_copy(update={"shape": body.shapes[-1]})
    return -tt.standing_time(tt.Problem(body=alone, friction=CREEP, launch=inverted))


@pytest.mark.slow
def test_a_bound_on_the_mass_is_kept():
    free = tt.improve(tt.presets.FRIEDL)
    bound = tt.improve(tt.presets.FRIEDL, density=1200.0, mass=0.004)
    assert bound.body.mass <= 0.004 * (1.0 + 1e-9)
    assert bound.spin >= free.spin * (1.0 - 1e-3)


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        ({"body": tt.presets.COIN}, "sphere"),
        ({"body": tt.presets.HURRICANE_BALLS}, "sphere"),
        ({"body": tt.presets.EGG}, "spheroid"),
        ({"friction": tt.CoulombFriction(mu=0.3)}, "sticks"),
        ({"goal": "nicest"}, "lowest spin"),
        ({"wall": 0.1}, "wall"),
        ({"mass": 1e-5}, "mass"),
    ],
)
def test_what_cannot_be_improved_is_refused(arguments, sentence):
    with pytest.raises(tt.InvalidInput, match=sentence):
        tt.improve(**{"body": tt.presets.REPORT, **arguments})
