"""Bodies of two surfaces that touch the table at one point where the axis is vertical: beside it
only the blunter of the two can touch.
"""

import numpy as np
import pytest

import tippetop as tt
from tippetop.mechanics.surfaces.hull import lowest_surface

R = 0.02
SHARP = tt.Sphere(radius=2.0 * R, center=R)
BLUNT = tt.Spheroid(across=3.0 * R, along=R, center=0.0)


def launched(
    shape: list[tt.Shape], friction: tt.Friction, tilt: float, *, gap: float = 0.0
) -> tt.Problem:
    return tt.Problem(
        body=tt.Body(mass=0.015, shape=shape, I1=6e-6, I3=6e-6),
        friction=friction,
        launch=tt.Launch(tilt=tilt, spin=10.0, tilt_rate=0.1, gap=gap),
    )


@pytest.mark.parametrize("order", [1, -1])
@pytest.mark.parametrize("tilt", [0.0, 1e-9, 1e-7, 1e-5])
@pytest.mark.parametrize(
    "friction", [tt.CoulombFriction(mu=0.3), tt.ViscousFriction(mu=0.3)], ids=["dry", "viscous"]
)
def test_the_blunter_of_two_surfaces_carries_the_body(
    friction: tt.Friction, tilt: float, order: int
) -> None:
    both = tt.simulate(launched([SHARP, BLUNT][::order], friction, tilt), 0.3, samples=31)
    alone = tt.simulate(launched([BLUNT], friction, tilt), 0.3, samples=31)
    assert both.attrs["status"] == alone.attrs["status"] == "completed"
    assert both["event_kind"].values.tolist() == alone["event_kind"].values.tolist()
    for name in ("axis", "angular_momentum", "velocity"):
        size = float(abs(alone[name]).max())
        np.testing.assert_allclose(both[name], alone[name], rtol=0, atol=1e-11 * size)


def test_a_body_that_falls_on_its_pole_lands_on_the_blunter_surface() -> None:
    both, alone = (
        tt.simulate(launched(shape, tt.CoulombFriction(mu=0.3), 0.0, gap=1e-4), 0.1, samples=5)
        for shape in ([SHARP, BLUNT], [BLUNT])
    )
    assert both.attrs["status"] == "completed"
    np.testing.assert_allclose(both["event_time"], alone["event_time"], rtol=0, atol=1e-12)
    np.testing.assert_allclose(both["axis"], alone["axis"], rtol=0, atol=1e-10)


@pytest.mark.parametrize("c", [1.0, -1.0])
def test_of_surfaces_that_are_equally_low_the_bluntest_counts(c: float) -> None:
    shapes = (
        tt.Sphere(radius=2.0 * R, center=c * R),
        tt.Spheroid(across=3.0 * R, along=R, center=0.0),
    )
    hull = tt.Body(mass=0.015, shape=list(shapes), I1=6e-6, I3=6e-6).surface
    beside = 0.9999 * c
    heights = [float(one.height(beside)) for one in hull.each]
    chosen = lowest_surface(hull, c)
    assert chosen.active == int(np.argmax(heights)) == 1
