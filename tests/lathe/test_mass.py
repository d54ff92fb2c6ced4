"""What turned bodies weigh, against the formulas of the textbooks and against themselves cut in
two.
"""

import math

import pytest
from hypothesis import given, settings
from profiles import BALL, lines, made, profiles

from campaigns import examples
from strategies import numbers
from tippetop.lathe.mass import mass_properties
from tippetop.lathe.profile import profile_of
from tippetop.lathe.workpiece import Insert, Workpiece

RHO = 700.0


def properties(points, density=RHO):
    return mass_properties([(profile_of(points), density)])


def exactly(mass, center, I1, I3, of):
    """Within rounding, of heights relative to a length."""
    return (
        pytest.approx(mass, rel=1e-13),
        pytest.approx(center, abs=1e-14 * of),
        pytest.approx(I1, rel=1e-12),
        pytest.approx(I3, rel=1e-12),
    )


@pytest.mark.parametrize("radius", [0.02, 1.0, 37.0])
@pytest.mark.parametrize("height", [0.0, 5.0])
def test_ball(radius, height):
    mass = RHO * 4 / 3 * math.pi * radius**3
    about = 2 / 5 * mass * radius**2
    low, high = height * radius - radius, height * radius + radius
    expected = exactly(mass, height * radius, about, about, radius * (1 + height))
    assert properties([(0, low), (0, high, radius)]) == expected
    assert properties([(0, high), (0, low, -radius)]) == expected
    quarters = [(0, low), (radius, low + radius, radius), (0, high, radius)]
    assert properties(quarters) == expected


@pytest.mark.parametrize("cut", [-0.9, -0.3, 0.0, 0.42, 0.99])
def test_spherical_cap(cut):
    """What is below a plane at `cut` radii: the integrals of pi (1 - z^2) and its like over z."""
    R = 0.03
    edge = R * math.sqrt(1 - cut**2)
    m0 = (cut - cut**3 / 3) + 2 / 3
    m1 = (cut**2 / 2 - cut**4 / 4) - 1 / 4
    m2 = (cut**3 / 3 - cut**5 / 5) + 2 / 15
    m4 = (cut - 2 * cut**3 / 3 + cut**5 / 5) + 8 / 15
    scale = math.pi * RHO * R**3
    axial = scale * R**2 * m4 / 2
    transverse = axial / 2 + scale * R**2 * (m2 - m1**2 / m0)
    # The arc of more than half a ball is more than a quarter of the circle.
    wide = [(R, 0, R)] if cut > 0 else []
    found = properties([(0, -R), *wide, (edge, cut * R, R), (0, cut * R)])
    # What the formulas lose where the cap is small is theirs.
    lost = 1e-12 / (1 + cut) if cut < 0 else 1e-12
    assert found == (
        pytest.approx(scale * m0, rel=lost),
        pytest.approx(R * m1 / m0, rel=lost),
        pytest.approx(transverse, rel=10 * lost),
        pytest.approx(axial, rel=lost),
    )


def test_cone():
    R, H = 0.02, 0.05
    mass = RHO * math.pi * R**2 * H / 3
    expected = exactly(
        mass, 3 / 4 * H, 3 / 20 * mass * R**2 + 3 / 80 * mass * H**2, 3 / 10 * mass * R**2, H
    )
    assert properties([(0, 0), (R, H), (0, H)]) == expected


def test_cylinder():
    R, H = 0.02, 0.05
    mass = RHO * math.pi * R**2 * H
    expected = exactly(mass, 0.0, mass * (R**2 / 4 + H**2 / 12), mass * R**2 / 2, H)
    assert properties([(0, -H / 2), (R, -H / 2), (R, H / 2), (0, H / 2)]) == expected


def test_torus():
    R, r = 0.03, 0.01
    mass = RHO * 2 * math.pi**2 * R * r**2
    expected = exactly(mass, 0.0, mass * (R**2 / 2 + 5 / 8 * r**2), mass * (R**2 + 3 / 4 * r**2), R)
    assert properties([(R, -r), (R, r, r), (R, -r, r)]) == expected


def test_shell():
    """A ball with a cavity, as an insert and as one line around both."""
    R, r = 0.02, 0.013
    mass = RHO * 4 / 3 * math.pi * (R**3 - r**3)
    about = 2 / 5 * RHO * 4 / 3 * math.pi * (R**5 - r**5)
    hollow = Workpiece(
        profile=BALL, density=RHO, inserts=[Insert(profile=[(0, -r), (0, r, r)], density=0)]
    )
    assert hollow.mass_properties == exactly(mass, 0.0, about, about, R)


def test_several_densities():
    """A ball of two halves, and a weight in a cavity in it."""
    R, r = 0.02, 0.005
    heavy = Insert(profile=[(0, -R), (R, 0, R), (0, 0)], density=3 * RHO)
    found = Workpiece(profile=BALL, density=RHO, inserts=[heavy]).mass_properties
    half = RHO * 2 / 3 * math.pi * R**3
    assert found.mass == pytest.approx(4 * half, rel=1e-13)
    assert found.center == pytest.approx((half - 3 * half) / (4 * half) * 3 / 8 * R, rel=1e-12)
    assert found.I3 / half == pytest.approx(8 / 5 * R**2, rel=1e-12)
    cavity = Insert(profile=[(0, -2 * r), (0, 2 * r, 2 * r)], density=0)
    weight = Insert(profile=[(0, -r), (0, r, r)], density=5 * RHO)
    for inserts in ([cavity, weight], [weight, cavity]):
        found = Workpiece(profile=BALL, density=RHO, inserts=inserts).mass_properties
        parts = R**3 - (2 * r) ** 3 + 5 * r**3
        assert found.mass == pytest.approx(RHO * 4 / 3 * math.pi * parts, rel=1e-13)


@settings(max_examples=examples(check=15, claim=400))
@given(points=lines(), density=numbers(100.0, 2e4))
def test_the_parts_of_a_body_cut_by_a_plane_add_up(points, density):
    middle = next(k for k, point in enumerate(points) if point[0] and point[1] == 0.0)
    below = made([*points[: middle + 1], (0.0, 0.0)])
    above = made([(0.0, 0.0), points[middle][:2], *points[middle + 1 :]])
    whole = mass_properties([(made(points), density)])
    parts = [mass_properties([(part, density)]) for part in (below, above)]
    mass = sum(part.mass for part in parts)
    center = sum(part.mass * part.center for part in parts) / mass
    assert whole == (
        pytest.approx(mass, rel=1e-12),
        pytest.approx(center, abs=1e-13),
        pytest.approx(
            sum(part.I1 + part.mass * (part.center - center) ** 2 for part in parts), rel=1e-12
        ),
        pytest.approx(sum(part.I3 for part in parts), rel=1e-12),
    )


@settings(max_examples=examples(check=15, claim=400))
@given(profile=profiles(), lift=numbers(-0.1, 0.1), factor=numbers(0.1, 10.0))
def test_a_body_moved_up_and_enlarged_keeps_its_proportions(profile, lift, factor):
    moved = [
        edge._replace(start=factor * edge.start + 1j * lift, end=factor * edge.end + 1j * lift)
        for edge in profile.edges
    ]
    one = mass_properties([(profile, 1.0)])
    other = mass_properties([(type(profile)(moved), 1.0)])
    assert other == (
        pytest.approx(factor**3 * one.mass, rel=1e-11),
        pytest.approx(factor * one.center + lift, abs=1e-12),
        pytest.approx(factor**5 * one.I1, rel=1e-9),
        pytest.approx(factor**5 * one.I3, rel=1e-9),
    )
    assert one.I3 <= 2 * one.I1


def test_arcs_however_straight_lose_no_digits():
    """A cylinder whose side bulges a little holds a little more: by the segment, and by its
    square.
    """
    R, H = 0.02, 0.05
    straight = properties([(0, 0), (R, 0), (R, H), (0, H)], 1.0).mass
    for radius in (10.0, 1e3, 1e5):
        bulging = properties([(0, 0), (R, 0), (R, H, radius), (0, H)], 1.0).mass
        segment = H**3 / (12 * radius)
        assert bulging - straight == pytest.approx(
            2 * math.pi * R * segment, rel=1e-2, abs=1e-15 * straight
        )
        shortened = properties([(0, 0), (R, 0), (R, H, -radius), (0, H)], 1.0).mass
        square = 2 * math.pi * 8 / 15 * (H**2 / (8 * radius)) ** 2 * H
        assert bulging + shortened - 2 * straight == pytest.approx(
            square, rel=1e-2, abs=3e-15 * straight
        )
