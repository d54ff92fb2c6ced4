"""The tippe top of MuJoCo's tutorial: its numbers by hand, and what the page says of it."""

import math

import pytest

import tippetop as tt
from tippetop.engines import tutorial


def test_the_body_is_that_of_its_parts():
    body = tutorial.problem().body
    ball, stem = 1000 * 4 / 3 * math.pi * 0.02**3, 1000 * 2 * math.pi * 0.004**2 * 0.008
    ballast = 1000 * 8 * 0.023**2 * 0.005
    mass = ball + stem + ballast
    center = (0.02 * stem - 0.015 * ballast) / mass
    assert body.mass == pytest.approx(mass, rel=1e-14)
    ball_surface, rim = body.shapes
    assert (ball_surface.kind, rim.kind) == ("sphere", "ring")
    assert (ball_surface.radius, rim.radius) == (0.02, 0.004)
    assert ball_surface.center == pytest.approx(-center, rel=1e-13)
    assert rim.center == pytest.approx(0.028 - center, rel=1e-13)
    axial = 0.4 * ball * 0.02**2 + stem * 0.004**2 / 2 + ballast * 2 * 0.023**2 / 3
    assert pytest.approx(axial, rel=1e-14) == body.I3


def test_it_sticks_when_dry_friction_has_used_up_the_slip():
    problem = tutorial.problem()
    body, height = problem.body, float(problem.start().height)
    # The axis is vertical meanwhile, within 1e-3 rad: the slip falls at a constant rate.
    deceleration = body.mass * problem.gravity * (1 / body.mass + height**2 / body.I1)
    assert tutorial.first_stick() == pytest.approx(0.02 / deceleration, rel=0.02)
    assert not math.isfinite(tutorial.exactly(duration=1.0).turnover_time)


def test_what_is_stored_is_what_the_page_says():
    runs = tutorial.TOP_RUNS.stored().rows
    assert [(run.about, run.step, run.patch) for run in runs] == [
        (setting.about, setting.step, setting.patch) for setting in tutorial.SETTINGS
    ]
    by_step = [run for run in runs if run.about.startswith("RK4, as")]
    times = [run.turnover_time for run in by_step]
    assert max(times) - min(times) < 0.01 * min(times), "whatever the step"
    films = [run.film for run in by_step]
    assert max(films) - min(films) < 0.01 * min(films)
    assert all(abs(run.jellett_change) < 2e-4 for run in by_step)
    hard = [run for run in runs if "impratio" in run.about or "noslip" in run.about]
    assert all(run.max_tilt < 0.007 for run in hard if not run.patch)
    elliptic = next(run for run in runs if run.about == "RK4, elliptic cone")
    assert elliptic.film == pytest.approx(2.0 * by_step[0].film, rel=0.02)
    exact = tutorial.exactly(tt.ViscousFriction(mu=elliptic.film))
    assert exact.turnover_time == pytest.approx(elliptic.turnover_time, rel=0.1)
    stiff = [run for run in runs if "solref" in run.about]
    for run, late in zip(stiff, (0.45, 0.3, 0.08), strict=True):
        law = tt.ContensouFriction(mu=1.0, patch_radius=run.patch, pressure="ellipsoidal")
        exact = tutorial.exactly(law, duration=2.0)
        assert run.turnover_time == pytest.approx(exact.turnover_time, rel=late)


def test_what_is_stored_comes_again():
    mujoco = pytest.importorskip(
        "mujoco", reason="MuJoCo is not installed: pip install 'tippetop[engines]'"
    )
    stored = tutorial.TOP_RUNS.stored()
    if mujoco.__version__ != stored.versions["MuJoCo"]:
        pytest.skip(f"the stored runs are of MuJoCo {stored.versions['MuJoCo']}")
    for place in (0, 4, 8):
        run = tutorial.in_mujoco(tutorial.SETTINGS[place])
        stored_run = stored.rows[place]
        assert run.turnover_time == pytest.approx(stored_run.turnover_time, rel=1e-6, nan_ok=True)
        assert run.energy_lost == pytest.approx(stored_run.energy_lost, abs=1e-6)
