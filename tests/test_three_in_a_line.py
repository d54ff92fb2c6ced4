"""Bodies of which three surfaces touch the table at once: they rest on the outermost two.

On its side a spindle between two balls does, and touches alone where it is upright.
"""

from typing import Any

import numpy as np
import pytest
import xarray as xr

import tippetop as tt

MASS, BALL, HALF, MU, G = 0.01, 0.005, 0.02, 0.3, 9.8
FRICTIONS = {
    "viscous": tt.ViscousFriction(mu=2.0),
    "coulomb": tt.CoulombFriction(mu=MU),
    "ellipsoidal": tt.ContensouFriction(mu=MU, patch_radius=1e-3, pressure="ellipsoidal"),
}
ORDERS = {"between": (0, 1, 2), "first": (1, 0, 2), "last": (0, 2, 1)}
"""Where the spindle comes among the surfaces."""
SPINDLE = tt.Spheroid(across=BALL, along=0.026, center=0.004)


def rod(order: str | None, law: str = "coulomb", **launch: Any) -> tt.Problem:
    """A rod with balls at its ends, and with the spindle among its surfaces, or without it."""
    first, last = (tt.Sphere(radius=BALL, center=place) for place in (HALF, -0.6 * HALF))
    shapes = (first, SPINDLE, last)
    shape = [first, last] if order is None else [shapes[number] for number in ORDERS[order]]
    return tt.Problem(
        body=tt.Body(mass=MASS, shape=shape, I1=2e-6, I3=1.25e-7),
        friction=FRICTIONS[law],
        launch=tt.Launch(**{"tilt": np.pi / 2, "spin": 0.0} | launch),
    )


def followed(problem: tt.Problem, duration: float) -> xr.Dataset:
    """By a method that needs no compiling."""
    return tt.simulate(problem, duration, samples=41, integrator="dop853", tolerance=3e-14)


def words(run: xr.Dataset) -> list[str]:
    return run["mode"].values.tolist()


MOTIONS: dict[str, dict[str, Any]] = {
    "along": {"velocity": (0.2, 0.0, 0.0)},
    "across": {"velocity": (0.0, 0.2, 0.0)},
    "turning": {"precession": 8.0, "spin": 5.0, "velocity": (0.1, 0.1, 0.0)},
    "falling": {"tilt": 1.5, "spin": 20.0, "gap": 0.001},
}


CASES = [(law, motion) for law in FRICTIONS for motion in MOTIONS]
USUAL = {("coulomb", "along"), ("viscous", "turning"), ("viscous", "falling")}


@pytest.mark.parametrize(
    ("law", "motion"),
    [pytest.param(*case, marks=[] if case in USUAL else pytest.mark.slow) for case in CASES],
)
def test_a_surface_between_two_others_does_not_change_the_motion(law: str, motion: str) -> None:
    """As if it were smaller by a hair, and in whatever order the surfaces are told."""
    without = followed(rod(None, law, **MOTIONS[motion]), 0.25)
    assert without.attrs["status"] in {"completed", "at_rest"}
    for order in ORDERS if law == "coulomb" else ["first"]:
        run = followed(rod(order, law, **MOTIONS[motion]), 0.25)
        assert run.attrs["status"] == without.attrs["status"]
        assert run["event_kind"].values.tolist() == without["event_kind"].values.tolist()
        for name in ("event_time", "event_impulse", "axis", "angular_momentum", "velocity"):
            size = float(abs(without[name]).max()) if without[name].size else 0.0
            np.testing.assert_allclose(
                run[name], without[name], rtol=0, atol=1e-9 * size, err_msg=name
            )
        assert "double contact" in run["event_kind"].values
        outer = "_and_".join(str(number) for number in sorted(map(ORDERS[order].index, (0, 2))))
        assert words(run)[-1].endswith(f"_on_{outer}")
        assert float(run["energy_error"]) < 1e-12
        assert float(abs(run["gap"].min())) < 1e-12 * BALL


def test_a_body_of_three_surfaces_stops_as_a_block_does() -> None:
    run = followed(rod("first", velocity=(0.2, 0.0, 0.0)), 1.0)
    assert run.attrs["status"] == "at_rest"
    sticks = run["event_time"].values[run["event_kind"].values == "stick"]
    assert sticks == pytest.approx([0.2 / (MU * G)] * 2, rel=1e-12)
