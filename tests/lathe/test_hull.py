"""What turned bodies touch the table with, against very many points of them."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from profiles import BALL, brute_support, profiles

from campaigns import examples
from tippetop.lathe.edges import Edge
from tippetop.lathe.hull import hull_of
from tippetop.lathe.profile import profile_of

R = 0.02


def hull(*points):
    return hull_of(profile_of(points))


@settings(max_examples=examples(check=26, claim=800))
@given(profile=profiles())
def test_the_hull_is_that_of_all_points_of_the_profile(profile):
    found = hull_of(profile)
    tilts = np.linspace(0.0, math.pi, 181)
    support = np.array([found.support(tilt) for tilt in tilts])
    missed = max(
        (edge.radius * (edge.turn / 1000) ** 2 / 8 for edge in profile.edges if edge.turn),
        default=0,
    )
    within = 1e-12 * profile.size
    assert (support - brute_support(profile, tilts) >= -within).all()
    # A centre a little off the axis is taken to be on it.
    assert (support - brute_support(profile, tilts) <= abs(missed) + within).all()


@settings(max_examples=examples(check=15, claim=400))
@given(profile=profiles())
def test_its_surfaces_follow_each_other_from_tilt_to_tilt(profile):
    found = hull_of(profile)
    assert (found.zones[0].low, found.zones[-1].high) == (0.0, math.pi)
    for low, high in zip(found.zones, found.zones[1:], strict=False):
        assert low.high == high.low
        assert low.support(high.low) == pytest.approx(
            high.support(high.low), abs=1e-9 * profile.size
        )
        assert low[:3] != high[:3]


@settings(max_examples=examples(check=15, claim=400))
@given(profile=profiles())
def test_how_far_a_whole_surface_would_reach_out(profile):
    found = hull_of(profile)
    tilts = np.linspace(0.0, math.pi, 721)
    for zone in found.zones:
        excess, tilt = found.protrusion(zone)
        beyond = [zone.support(at) - found.support(at) for at in tilts]
        assert max(beyond) <= excess + 1e-9 * profile.size
        if excess > 0.0:
            assert zone.support(tilt) - found.support(tilt) == pytest.approx(
                excess, abs=1e-9 * profile.size
            )


def named(found):
    return [zone.name for zone in found.zones]


def test_bodies_that_are_known():
    ball = hull(*BALL)
    assert named(ball) == ["sphere"]
    assert ball.flats == ()
    coin = hull((0, 0), (R, 0), (R, 0.002), (0, 0.002))
    assert named(coin) == ["edge", "edge"]
    assert coin.flats == pytest.approx((0.0, math.pi / 2, math.pi))
    worn = hull((0, 0), (R, 0), (R, 0.002, 0.001), (0, 0.002))
    assert named(worn) == ["ring"]
    assert worn.zones[0][:3] == pytest.approx((R, 0.001, 0.001))
    assert worn.flats == (0.0, math.pi)
    cone = hull((0, 0), (R, R), (0, R))
    assert named(cone) == ["tip", "edge"]
    assert cone.flats == pytest.approx((math.pi / 4, math.pi))
    torus = hull((R, 0), (R, 0.01, 0.005), (R, 0, 0.005))
    assert named(torus) == ["ring"]


def test_points_along_straight_edges_are_no_surfaces():
    sides = [(R * k / 7, R * k / 21) for k in range(1, 8)]
    cone = hull((0, 0), *sides, *((R, R / 3 + 0.001 * k) for k in range(1, 5)), (0, R))
    assert [zone[:2] for zone in cone.zones] == [
        (0.0, 0.0),
        (R, R / 3),
        (R, R / 3 + 0.004),
        (0.0, R),
    ]


def test_a_stem_takes_over_where_its_tip_and_the_sphere_touch_one_line():
    """Leine and Glocker's top: spheres of 15 and 5 mm, 13 mm apart."""
    big, tip, apart = 0.015, 0.005, 0.013
    face = big * 0.8
    top = hull(
        (0, -big),
        (math.sqrt(big**2 - face**2), face, big),
        (tip, face),
        (tip, apart),
        (0, apart + tip, tip),
    )
    assert named(top) == ["sphere", "sphere"]
    assert top.zones[0].high == pytest.approx(math.acos(-(big - tip) / apart), abs=1e-9)
    assert top.flats == pytest.approx((top.zones[0].high,))
    assert all(top.protrusion(zone)[0] < 1e-15 for zone in top.zones)


def test_arcs_that_are_nearly_straight_are_no_spheres():
    dish = hull((0, 0), (2, 0, 4e4), (2, 1), (0, 1))
    assert named(dish) == ["ring", "edge", "edge"]
    assert dish.support(0.0) == pytest.approx(1 / 8e4, rel=1e-6)


def test_a_point_just_inside_an_arc_does_not_take_over():
    sliver = hull((0, 8.4e-8), (0.525, 4.666, -1e4), (0, 0, -60))
    assert named(sliver) == ["tip", "ring", "edge"]


def test_a_bowl_is_no_whole_sphere():
    bowl = hull((0, -R), (R, 0, R), (0, 0))
    assert named(bowl) == ["sphere", "edge"]
    assert bowl.protrusion(bowl.zones[0]) == pytest.approx((R, math.pi))
    assert bowl.protrusion(bowl.zones[1])[0] == pytest.approx(0.0, abs=1e-15)


def test_a_sphere_whose_edge_has_few_digits_is_one_still():
    face = hull((0, -15), (12.990, 7.5, 15), (0, 7.5))
    assert named(face) == ["sphere", "edge"]
    assert face.zones[0].low == 0.0


@pytest.mark.parametrize("turn", [0.0, 1e-300, 1e-9, 0.3, -2.0, 3.1])
def test_a_single_point_of_an_edge_is_one_of_its_points(turn):
    edge = Edge(0.1 + 0.2j, 0.5 - 0.3j, turn)
    shares = np.linspace(-1.0, 2.0, 7)
    np.testing.assert_allclose([edge.point(s) for s in shares], edge.points(shares), rtol=1e-15)
    velocities = [edge.velocity(s) for s in shares]
    np.testing.assert_allclose(velocities, edge.velocities(shares), rtol=1e-15)
