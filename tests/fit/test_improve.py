"""Improved tops turn over and stand in runs, can be made, and have the mass that they claim."""

import math

import numpy as np
import pytest

import tippetop as tt
from campaigns import seeds
from tippetop.fit.improve import BowlFamily, Trial, standing_duration
from tippetop.fit.standing import CLOSE, least_passing

CREEP = tt.ContensouFriction(mu=0.3, patch_radius=5e-4)

WOODEN = tt.Workpiece(profile=tt.presets.WOODEN.profile, density=1240.0)


def volume(profile):
    """Return the volume that a closed polygon of (distance, height) sweeps about the axis, m^3."""
    r, z = np.array(profile).T
    s, w = np.roll(r, -1), np.roll(z, -1)
    return np.pi / 3.0 * abs(np.sum((r * w - s * z) * (r + s)))


def highest(body, spin):
    """Return the largest tilt of a run on a drilling patch, rad."""
    problem = tt.Problem(body=body, friction=CREEP, launch=tt.Launch(tilt=0.1, spin=spin))
    return float(tt.simulate(problem, 20.0, samples=2)["max_tilt"])


UPSIDE_DOWN = math.pi - 0.1
"""Tilt from which on a top is upside down, rad, in every result."""


@pytest.mark.parametrize(
    ("fails", "least"),
    [
        (lambda x: x < 3.0, 3.0),
        (lambda x: x < 80.0, 80.0),
        (lambda x: x < 20.0 or 25.0 < x < 29.0, 29.0),
        (lambda x: x < 10.0 or 12.0 < x < 12.7 or 17.0 < x < 18.5, 18.5),
        (lambda x: x < 150.0, math.inf),
        (lambda x: True, math.inf),
    ],
)
@pytest.mark.parametrize("guess", [5.0, 11.0, 40.0, 200.0])
def test_the_least_number_from_which_on_a_test_is_passed(fails, least, guess):
    found = least_passing(lambda x: not fails(x), guess, 100.0)
    if math.isinf(least):
        assert found == math.inf
    else:
        assert found == pytest.approx(least, rel=2.0 * CLOSE) or (
            # What is further than half as much again below the guess is not looked at.
            least == 18.5 and found < 12.0
        )
        assert not fails(found)


def body_of(seed):
    """Return a random ball with a cavity and a stem that its sphere rights, which may or may not
    turn over.
    """
    rng = np.random.default_rng(seed)
    radius = round(rng.uniform(0.01, 0.02), 6)
    family = BowlFamily(radius, 700.0, 1e-3, 1.5e-3, None, 9.8, 0.1)
    while True:
        at = family.low + rng.uniform(size=3) * np.array([0.4, 0.4, 1.0]) * (
            family.high - family.low
        )
        if np.all(family.margins(np.round(at, 6)) > 0.0):
            body = family.body(np.round(at, 6))
            if body.shapes[0].center > 0.0:
                return body


@pytest.mark.parametrize("seed", seeds(check=0, sample=0, claim=20))
def test_what_is_claimed_is_seen_in_runs_and_improving_again_makes_nothing_worse(seed):
    better = tt.improve(body_of(seed))
    assert better.spin <= better.before
    # Between a spin just below that does not stand, and all above that do. Of the spins below some
    # stand: impacts decide.
    below = better.spin * np.linspace(1.0, 0.99, 51)[1:]
    assert any(highest(better.body, spin) < UPSIDE_DOWN for spin in below)
    assert highest(better.body, 1.001 * better.spin) >= UPSIDE_DOWN
    assert highest(better.body, 1.25 * better.spin) >= UPSIDE_DOWN
    # The solid can be made, and its volume, of a polygon along its profile, has the mass.
    assert better.sizes["wall"] >= 1e-3
    assert better.sizes["stem"] >= 1.5e-3
    points = better.workpiece.outline.points(200)
    mass = better.workpiece.density * volume(np.stack([points.real, points.imag], 1))
    assert better.body.mass == pytest.approx(mass, rel=1e-3)
    again = tt.improve(better.body)
    assert again.before == better.spin
    assert again.spin <= better.spin


@pytest.mark.parametrize("seed", range(8))
def test_a_body_made_of_sizes_gives_them_back(seed):
    rng = np.random.default_rng(seed)
    family = BowlFamily(0.015, 700.0, 1e-3, 1.5e-3, None, 9.8, 0.1)
    at = family.high
    while np.any(family.margins(at) <= 0.0):
        at = np.round(family.low + rng.uniform(size=3) * (family.high - family.low), 6)
    assert family.sizes_of(family.body(at)) == pytest.approx(at, abs=1e-12)
    heavier = BowlFamily(0.015, 800.0, 1e-3, 1.5e-3, None, 9.8, 0.1)
    assert heavier.sizes_of(family.body(at)) is None
    assert family.sizes_of(tt.presets.WOODEN) is None


@pytest.mark.campaign
@pytest.mark.parametrize("goal", ["fastest", "stands longest"])
def test_goals_are_met_better_than_by_the_least_spin(goal):
    least = tt.improve(tt.presets.WOODEN, trials=0)
    spin = 1.3 * least.spin
    better = tt.improve(tt.presets.WOODEN, goal, spin=spin, trials=8)
    measure = turning_over if goal == "fastest" else lying
    assert measure(better.body, spin) <= measure(least.body, spin)
    assert better.launch_spin == spin
    assert abs(measure(better.body, spin)) == pytest.approx(better.seconds, abs=0.02)
    # Improved again, it is not worse, and what it was before is what was claimed.
    again = tt.improve(better.body, goal, spin=spin, trials=2)
    assert again.seconds_before == better.seconds
    gain = better.seconds - again.seconds if goal == "fastest" else again.seconds - better.seconds
    assert gain >= 0.0


@pytest.mark.slow
@pytest.mark.parametrize("goal", ["fastest", "stands longest"])
def test_times_that_are_claimed_are_those_of_runs(goal):
    """The report's top with a stem stands from 190 rad/s, and not from 20."""
    problem = tt.Problem(
        body=tt.presets.REPORT_STEM, friction=CREEP, launch=tt.Launch(tilt=0.1, spin=1.0)
    )
    trial = Trial(BowlFamily(0.02, 700.0, 1e-3, 1.5e-3, None, 9.8, 0.1), problem, goal)
    trial.spin = 20.0
    assert trial.measured(problem) == math.inf
    trial.spin = 190.0
    measure = turning_over if goal == "fastest" else lying
    measured = measure(tt.presets.REPORT_STEM, 190.0)
    assert trial.measured(problem) == pytest.approx(measured, abs=0.02)


def turning_over(body, spin):
    """Return the time after which a run has turned over, s."""
    problem = tt.Problem(body=body, friction=CREEP, launch=tt.Launch(tilt=0.1, spin=spin))
    return float(tt.simulate(problem, 20.0, samples=2)["turnover_time"])


def lying(body, spin):
    """Return minus the time for which a run stands, s, from its samples."""
    problem = tt.Problem(body=body, friction=CREEP, launch=tt.Launch(tilt=0.1, spin=spin))
    run = tt.simulate(problem, 60.0, samples=60001)
    stands = 1e-3 * float((run["tilt"] > math.pi - 0.35).sum())
    assert standing_duration(problem) == pytest.approx(stands, abs=0.02)
    return -stands


@pytest.mark.slow
def test_a_bound_on_the_mass_is_kept():
    bound = tt.improve(tt.presets.FRIEDL, density=1200.0, mass=0.004, trials=0)
    assert bound.body.mass <= 0.004 * (1.0 + 1e-9)


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
        ({"mass": -1.0}, "mass: -1"),
        ({"density": 0.0}, "density: 0"),
        ({"density": "unobtainium"}, "density: .unobtainium. is no known material"),
        ({"wall": "1 s"}, "wall: 1 s is a time"),
        ({"stem": -1e-3}, "stem: -0.001"),
        ({"goal": "fastest", "spin": -5.0}, "spin: -5"),
        ({"spin": 150.0}, "spin: 150 has no effect"),
        ({"tilt": 0.0}, "tilt: 0"),
        ({"body": "x"}, "body: 'x'"),
    ],
)
def test_what_cannot_be_improved_is_refused(arguments, sentence):
    with pytest.raises(tt.InvalidInput, match=sentence):
        tt.improve(**{"body": tt.presets.REPORT, **arguments})


@pytest.mark.parametrize(
    ("body", "stated", "density"),
    [
        (WOODEN, None, 1240.0),
        (WOODEN, 800.0, 800.0),
        (tt.Body.turned(WOODEN), None, 700.0),
        (tt.Body.turned(WOODEN), "brass", 8500.0),
    ],
)
def test_the_material_is_the_stated_one_or_that_of_the_workpiece(
    body, stated, density, monkeypatch
):
    densities = []

    def proposals(family, entrants):
        densities.append(family.density)
        raise InterruptedError

    monkeypatch.setattr(BowlFamily, "proposals", proposals)
    with pytest.raises(InterruptedError):
        tt.improve(body, density=stated)
    assert densities == [density]
