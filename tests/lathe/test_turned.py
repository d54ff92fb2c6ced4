"""Bodies from profiles: the surfaces they stand on, and which they cannot have."""

import itertools
import math

import pytest
from hypothesis import given, reject, settings
from hypothesis import strategies as st
from profiles import BALL, lines

import tippetop as tt
from campaigns import examples
from strategies import numbers

R = 0.02


def test_a_ball_with_a_cavity_is_an_eccentric_sphere():
    cavity, up = 0.008, 0.006
    body = tt.Body.turned(
        BALL,
        700.0,
        inserts=[{"profile": [(0, up - cavity), (0, up + cavity, cavity)], "density": 0}],
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
        ([(0, -R), (R, 0, R), (0, 0)], "a sphere of which only tilts 0 to 1.5708 exist"),
        ([(0, 0), (0.005, 0), (0.01, R, 0.05), (0, R)], "an arc around a point beyond the axis"),
    ],
)
def test_bodies_that_stand_on_something_else_are_refused(profile, sentence):
    with pytest.raises(tt.InvalidInput) as refusal:
        tt.Body.turned(profile, 700.0)
    assert sentence in str(refusal.value)


def test_a_ball_of_many_edges_is_a_ball():
    angles = [math.pi * (k / 500 - 0.5) for k in range(501)]
    line = [(R * max(0.0, math.cos(angle)), R * math.sin(angle)) for angle in angles]
    line[0], line[-1] = (0.0, -R), (0.0, R)
    piece = tt.Workpiece(profile=line, density=700.0)
    exact = 2 / 5 * 700.0 * 4 / 3 * math.pi * R**5
    assert pytest.approx(exact, rel=1e-9) == piece.mass_properties.I3
    assert [zone.name for zone in piece.hull.zones] == ["sphere"]
    as_drawn = piece.model_copy(update={"tolerance": 0.0})
    assert exact > as_drawn.mass_properties.I3
    with pytest.raises(tt.InvalidInput, match="stands on 501 surfaces"):
        tt.Body.turned(as_drawn)


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


LEINE_GLOCKER = [(0, -15), (15, 0, 15), (9, 12, 15), (5, 12), (5, 13), (0, 18, 5)]
"""Spheres of 15 and 5 mm, 13 mm apart."""


def test_a_top_with_a_stem_stands_on_two_spheres():
    piece = tt.Workpiece(profile=LEINE_GLOCKER, density=400.0, unit="mm")
    body, center = tt.Body.turned(piece), piece.mass_properties.center
    bowl, tip = body.shapes
    assert (bowl.radius, bowl.center) == pytest.approx((0.015, -center), rel=1e-9)
    assert (tip.radius, tip.center) == pytest.approx((0.005, 0.013 - center), rel=1e-9)


@settings(max_examples=examples(check=20, claim=600))
@given(points=lines(), low=numbers(0.005, 0.04), high=numbers(0.005, 0.04), straight=st.booleans())
def test_the_body_is_as_high_over_the_table_as_its_hull(points, low, high, straight):
    """What the mechanics makes of the surfaces, against the hull of the profile, between flat
    ends.
    """
    side = [point[:2] if straight else point for point in points[1:-1]]
    try:
        piece = tt.Workpiece(
            profile=[(0, -0.04), (low, -0.04), *side, (high, 0.04), (0, 0.04)], density=500.0
        )
        body = tt.Body.turned(piece)
    except tt.InvalidInput:
        reject()
    for tilt in [k * math.pi / 60 for k in range(61)]:
        height = max(shape.surface.height(math.cos(tilt)) for shape in body.shapes)
        above = piece.hull.support(tilt) + piece.mass_properties.center * math.cos(tilt)
        assert height == pytest.approx(above, abs=2e-6 * piece.outline.size)


def test_a_turned_top_comes_to_lie_on_sphere_and_stem_where_the_hull_says():
    """It turns over, its stem strikes the table, and it rocks until both stay on it."""
    weight = {"profile": [(0, -10), (0, 5, 7.5)], "density": 7800.0}
    top = [(0, -15), (15, 0, 15), (9, 12, 15), (2.5, 12), (2.5, 16), (0, 18.5, 2.5)]
    piece = tt.Workpiece(profile=top, density=700.0, unit="mm", inserts=[weight])
    launch = tt.Launch(tilt=0.1, spin=120.0)
    problem = tt.Problem(
        body=tt.Body.turned(piece), friction=tt.ViscousFriction(mu=0.3), launch=launch
    )
    run = tt.simulate(problem, 9.0)
    (both,) = (tilt for tilt in piece.hull.flats)
    assert run["tilt"].values[-1] == pytest.approx(both, abs=1e-9)
    assert piece.hull.zones[0].high == both


WALL = 0.012
"""Inner radius of a tube of outer radius R."""


def test_a_tube_lies_on_annuli_with_the_radii_of_its_wall():
    body = tt.Body.turned([(WALL, 0), (R, 0), (R, 0.03), (WALL, 0.03), (WALL, 0)], 700.0)
    for ring, center in zip(body.shapes, (-0.015, 0.015), strict=True):
        face = (ring.radius, ring.inner_radius, ring.center)
        assert face == pytest.approx((R, WALL, center), rel=1e-12)


@pytest.mark.parametrize("pieces", [1, 7])
def test_a_cup_lies_on_a_disk_one_way_and_on_its_wall_the_other(pieces):
    """Points along the straight edges, as scans have them, change nothing."""
    corners = [(0, 0), (R, 0), (R, 0.03), (WALL, 0.03), (WALL, 0.004), (0, 0.004)]
    profile = [corners[0]]
    for (r, z), (s, w) in itertools.pairwise(corners):
        profile += [
            (r + k / pieces * (s - r), z + k / pieces * (w - z)) for k in range(1, pieces + 1)
        ]
    body = tt.Body.turned(profile, 700.0, tolerance=0.0)
    below, above = sorted(body.shapes, key=lambda ring: ring.center)
    assert below.inner_radius == 0.0
    assert above.inner_radius == pytest.approx(WALL, rel=1e-9)


def test_a_bottle_with_a_hollow_foot_and_a_rounded_rim():
    foot = [(0, 0.002), (WALL, 0), (R, 0), (R, 0.03), (WALL, 0.03, 0.004), (WALL, 0.01), (0, 0.01)]
    below, above = sorted(tt.Body.turned(foot, 700.0).shapes, key=lambda ring: ring.center)
    assert below.inner_radius == pytest.approx(WALL, rel=1e-9)
    assert above.tube == pytest.approx(0.004)
    assert above.radius * (1 - 2e-3) < above.inner_radius < above.radius
