"""Bodies from profiles: the surfaces they stand on, and which they cannot have."""

import math

import pytest
from profiles import BALL

import tippetop as tt

R = 0.02


def test_a_ball_with_a_cavity_is_an_eccentric_sphere():
    cavity, up = 0.008, 0.006
    body = tt.Body.turned(
        BALL, 700.0, inserts=[{"profile": [(0, up - cavity), (0, up + cavity, cavity)], "density": 0}]
    )
    share = (cavity / R) ** 3
    below = up * share / (1 - share)
    assert isinstance(body.shape, tt.EccentricSphere)
    assert (body.shape.radius, body.shape.eccentricity) == pytest.approx((R, below / R), rel=1e-12)
    mass = 700.0 * 4 / 3 * math.pi * R**3
    assert body.mass == pytest.approx(mass * (1 - share), rel=1e-13)
    axial = 2 / 5 * mass * R**2 * (1 - (cavity / R) ** 5)
    transverse = axial - mass * share * up**2 - body.mass * below**2
    inertias = body.I1, body.I3
    assert inertias == pytest.approx((transverse, axial), rel=1e-12)
    run = tt.simulate(
        tt.Problem(body=body, friction=tt.ViscousFriction(mu=0.3), launch=tt.Launch(tilt=0.1, spin=100.0)),
        0.1,
    )
    assert run.attrs["outcome"] == "completed"


def test_a_ball_upside_down_stands_on_its_other_side():
    weight = {"profile": [(0, 0.006), (0, 0.014, 0.004)], "density": 8000.0}
    body = tt.Body.turned(BALL, 700.0, inserts=[weight])
    assert isinstance(body.shape, tt.Sphere)
    assert body.shape.center < 0.0


def test_a_ring_is_a_ring():
    body = tt.Body.turned([(R, 0), (R, 0.01, 0.005), (R, 0, 0.005)], 1200.0)
    assert isinstance(body.shape, tt.Ring)
    assert (body.shape.radius, body.shape.center, body.shape.tube) == pytest.approx(
        (R, 0.0, 0.005), abs=1e-15
    )


@pytest.mark.parametrize(
    ("profile", "sentence"),
    [
        ([(0, -R), (R, 0, R), (0, 0)], "a sphere cut off, left from tilt 0 to 1.5708"),
        ([(0, 0), (R, R), (0, R)], "a sharp tip"),
        ([(0, 0), (0.005, 0), (0.01, R, 0.05), (0, R)], "an arc around a point beyond the axis"),
    ],
)
def test_bodies_that_stand_on_something_else_are_refused(profile, sentence):
    with pytest.raises(tt.InvalidInput) as refusal:
        tt.Body.turned(profile, 700.0)
    assert sentence in str(refusal.value)


def test_a_sphere_cut_off_may_be_taken_as_whole():
    body = tt.Body.turned([(0, -R), (R, 0, R), (0, 0)], 700.0, whole=True)
    assert isinstance(body.shape, tt.EccentricSphere)
    assert body.shape.eccentricity == pytest.approx(3 / 8, rel=1e-12)


def test_what_is_given_to_a_workpiece_takes_the_place_of_its_own():
    piece = tt.Workpiece(profile=BALL, density=700.0)
    assert tt.Body.turned(piece, 1400.0).mass == pytest.approx(2 * tt.Body.turned(piece).mass)
    assert tt.Body.turned(piece, unit="mm").mass == pytest.approx(1e-9 * tt.Body.turned(piece).mass)
    with pytest.raises(tt.InvalidInput, match="density is missing"):
        tt.Body.turned(BALL)
