"""Rings that never touch: the run is that of the body without them, through the vertical too."""

from typing import Any

import numpy as np
import pytest

import tippetop as tt
from tippetop.mechanics.surfaces.hull import Hull
from tippetop.mechanics.surfaces.surface import (
    RingSurface,
    SphereSurface,
    contact_vector,
    gap_guard,
)

MASS, SIZE = 0.02, 0.02
BALL = tt.Sphere(radius=SIZE, center=0.006)
STEM = tt.Ring(radius=0.004, center=0.0334)
TILTS = [0.0, 1e-9, 1e-8, 1e-3, np.pi - 1e-3]


def ball(*others: tt.Shape, **launch: Any) -> tt.Problem:
    """The published top with other surfaces."""
    return tt.Problem(
        body=tt.Body(mass=MASS, shape=[BALL, *others], I1=3e-6, I3=3.2e-6),
        friction=tt.ViscousFriction(mu=0.3),
        launch=tt.Launch(**{"tilt": 0.0, "spin": 10.0} | launch),
    )


@pytest.mark.parametrize(
    ("friction", "tilt"),
    [
        ("coulomb", 0.0),
        pytest.param("coulomb", 1e-8, marks=pytest.mark.slow),
        ("viscous", 0.0),
        ("viscous", 1e-9),
        ("viscous", 1e-3),
    ],
)
def test_a_ring_that_never_touches_changes_nothing(tilt: float, friction: str) -> None:
    changes = {"friction": {"kind": friction, "mu": 0.3}}
    launch = {"tilt": tilt, "spin": 40.0, "tilt_rate": 1.0, "slip": (0.0, 0.02)}
    times = np.linspace(0.0, 0.2, 21)
    with_ring, without = (
        tt.simulate(
            ball(*rings, **launch).replace(changes),
            0.2,
            times=times,
            integrator="dop853",
            tolerance=1e-12,
        )
        for rings in ((STEM,), ())
    )
    assert with_ring.attrs["status"] == without.attrs["status"] == "completed"
    assert float(with_ring["energy_error"]) < 1e-11
    for name in ("axis", "velocity", "angular_momentum", "height", "gap", "energy", "jellett"):
        scale = float(np.abs(without[name]).max()) or 1.0
        assert np.allclose(with_ring[name], without[name], rtol=0.0, atol=1e-9 * scale), name


def test_a_ring_that_does_not_touch_never_limits_a_step() -> None:
    """The tilt decays to nothing, and planar rocking passes through the vertical."""
    ring = tt.Ring(radius=0.017, center=0.018)
    run = tt.simulate(ball(ring, tilt=0.1), 20.0, samples=3)
    assert run.attrs["status"] == "completed"
    assert float(run["tilt"][-1]) < 1e-9
    alone = tt.simulate(ball(tilt=0.1), 20.0, samples=3)
    assert float(run["final_spin"]) == pytest.approx(float(alone["final_spin"]), rel=1e-12)
    planar = ball(ring, tilt=0.1, spin=0.0).replace({"friction": tt.CoulombFriction(mu=0.3)})
    rocked = tt.simulate(planar, 2.0, samples=3)
    assert rocked.attrs["status"] == "completed"
    assert float(rocked["energy_error"]) < 1e-13


def test_a_ball_turned_over_spins_on_the_flat_end_of_its_stem() -> None:
    run = tt.simulate(ball(STEM, tilt=np.pi), 0.01, samples=3)
    assert set(run["mode"].values.tolist()) == {"sliding_flat_on_1"}


@pytest.mark.parametrize("tilt", [0.0, 1e-9, 1e-8, 1e-3, np.pi - 1e-9])
def test_a_ball_with_a_flat_stem_is_launched_upright(tilt: float) -> None:
    stem = ball(STEM, tilt=tilt, spin=200.0, tilt_rate=1.0)
    run = tt.simulate(stem, 0.01, samples=3, integrator="dop853", tolerance=1e-10)
    if tilt > 3.0:
        # Its face lands on the table, and being so small rocks on over its other side.
        assert run["event_kind"].values.tolist() == ["impact"]
    assert run.attrs["status"] == "completed"


def test_a_top_turned_with_a_rim_spins_upright() -> None:
    profile = [(0, -0.012), (0.001, -0.011, 0.001), (0.02, 0.006), (0.02, 0.01), (0, 0.01)]
    body = tt.Body.turned(profile, 700.0, whole=True)
    friction, launch = tt.ViscousFriction(mu=3.0), tt.Launch(tilt=0.0, spin=300.0)
    problem = tt.Problem(body=body, friction=friction, launch=launch)
    run = tt.simulate(problem, 0.5, samples=3, integrator="dop853", tolerance=1e-10)
    assert run.attrs["status"] == "completed"
    assert float(run["tilt"].max()) == 0.0


def test_the_guard_of_a_ring_falls_where_its_gap_does() -> None:
    ring, random = RingSurface(0.8, 0.3, 0.05), np.random.default_rng(3)
    for _ in range(200):
        tilt, height = random.uniform(0.0, np.pi), random.uniform(0.0, 2.0)
        axis = (np.sin(tilt), 0.0, np.cos(tilt))
        gap = height + contact_vector(axis, ring)[2]
        if height - 0.05 + 0.3 * axis[2] > 0.0:
            assert (gap_guard(axis, height, 0.0, ring) > 0.0) == (gap > 0.0)
    hull = Hull.of((SphereSurface(2.0, 0.1), RingSurface(0.5, 0.2, 0.03)))
    axis = (0.6, 0.0, 0.8)
    level = hull.each[1].height(0.8)
    assert gap_guard(axis, level, 0.0, hull.each[1]) == pytest.approx(0.0, abs=1e-15)


@pytest.mark.parametrize("margin", [1e-15, 1e-12])
def test_a_margin_is_not_rounded_to_the_digits_of_the_height(margin: float) -> None:
    """Where the gap is zero the guard is the margin times the slope of the guard over the height.

    The slope is 1 for a sphere, and for a ring twice the height of its middle, here 2 * 1.5.
    """
    axis = (0.6, 0.0, 0.8)
    sphere = SphereSurface(3.0, 0.1)
    level = sphere.height(0.8)
    assert gap_guard(axis, level, margin, sphere) == pytest.approx(margin, rel=1e-12)
    # h = 0.25 + 2.5 * 0.6: every number of the guard is exact.
    ring = RingSurface(2.5, 0.0, 0.25)
    assert gap_guard(axis, 1.75, margin, ring) == pytest.approx(3.0 * margin, rel=1e-12)


@pytest.mark.parametrize("tilt", [1e-9, 1e-8, 1e-7, 1e-5, 9e-4, np.pi - 1e-7])
def test_energy_of_an_edge_near_flat_is_the_closed_form(tilt: float) -> None:
    """The lowest point is at rest, rho away from the centre in the disk's plane.

    So the centre moves at rho times spin and tilt rate, squared v^2 = rho^2 (w3^2 + theta'^2); it
    is rho sin(theta) high, and the disk turns at theta' and phi' sin(theta) across its axis.
    """
    disk = tt.Body(mass=MASS, shape=tt.Ring(radius=SIZE), I1=2e-6, I3=4e-6)
    launch = tt.Launch(tilt=tilt, spin=7.0, tilt_rate=-3.0, precession=5.0)
    problem = tt.Problem(body=disk, friction=tt.ViscousFriction(mu=0.3), launch=launch)
    run = tt.simulate(problem, 1e-6, samples=3)
    sine = np.sin(tilt)
    expected = 0.5 * (
        MASS * SIZE**2 * (7.0**2 + 3.0**2) + 2e-6 * (3.0**2 + (5.0 * sine) ** 2) + 4e-6 * 7.0**2
    )
    expected += MASS * problem.gravity * SIZE * sine
    assert float(run["initial_energy"]) == pytest.approx(expected, rel=1e-14)
    assert float(run["energy"][0]) == pytest.approx(expected, rel=1e-14)
    assert float(run["energy_error"]) < 1e-11
