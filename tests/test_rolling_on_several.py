"""Rolling resistance of bodies of several surfaces: what is known exactly, and what must hold."""

import numpy as np
import pytest

import tippetop as tt

R, M, ARM = 0.02, 0.015, 2e-4
LAWS = {
    "coulomb": tt.CoulombFriction(mu=0.2),
    "ellipsoidal": tt.ContensouFriction(mu=0.3, patch_radius=1e-3, pressure="ellipsoidal"),
    "viscous": tt.ViscousFriction(mu=0.3),
}
SPHERE = tt.Sphere(radius=R, center=-0.3 * R)


def problem_of(shape, friction, tip=1.0, **launch):
    """A body with an off-centre sphere, or also a smaller one at the other end."""
    body = tt.Body(mass=M, shape=shape, I1=0.4 * M * R * R, I3=0.42 * M * R * R)
    return tt.Problem(body=body, friction=friction, launch=tt.Launch(**launch), rolling_resistance=ARM)


def followed(problem, duration, samples=41):
    return tt.simulate(problem, duration, samples=samples, integrator="dop853", tolerance=3e-14)


@pytest.mark.parametrize("friction", LAWS.values(), ids=LAWS)
def test_a_surface_that_never_touches_changes_nothing(friction):
    launch = {"tilt": 0.5, "spin": 40.0, "gap": 0.003}
    tip = tt.Sphere(radius=0.2 * R, center=R)
    alone, both = (
        followed(problem_of(shape, friction, **launch), 1.0) for shape in ([SPHERE], [SPHERE, tip])
    )
    assert both.attrs["outcome"] == alone.attrs["outcome"]
    assert both["event_kind"].values.tolist() == alone["event_kind"].values.tolist()
    assert len(alone["event_kind"]) > 1
    for name in ("event_time", "axis", "angular_momentum", "velocity", "energy_lost_rolling"):
        size = float(abs(alone[name]).max())
        np.testing.assert_allclose(both[name], alone[name], rtol=0, atol=1e-12 * size)
