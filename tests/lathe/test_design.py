"""Bodies to order have what was ordered, and what there is not is refused with what there is."""

import math
import re

import pytest

import tippetop as tt

BALL = tt.Workpiece(profile=[(0, -20), (0, 20, 20)], density=700.0, unit="mm")
TOP = tt.Workpiece(
    profile=[(0, -15), (15, 0, 15), (9, 12, 15), (2.5, 12), (2.5, 16), (0, 18.5, 2.5)],
    density=700.0,
    unit="mm",
)


def proportions(piece):
    """Eccentricity and ratio of inertias."""
    sphere, found = piece.hull.zones[0], piece.mass_properties
    return (sphere.height - found.center) / sphere.tube, found.I1 / found.I3


@pytest.mark.parametrize(
    ("piece", "density", "alpha", "gamma"),
    [
        (BALL, 0.0, 0.1, 0.95),
        (BALL, 0.0, 0.05, 0.975),
        (BALL, 8000.0, 0.2, 1.1),
        (TOP, 8000.0, 0.1, 1.05),
        (TOP, 0.0, 0.05, 0.95),
    ],
)
def test_a_cavity_or_a_weight_gives_what_is_wanted(piece, density, alpha, gamma):
    found = tt.design_insert(piece, alpha, gamma, density=density)
    assert proportions(found) == pytest.approx((alpha, gamma), rel=1e-9)
    assert found.hull == piece.hull
    (inside,) = found.insides
    wall = piece.hull.zones[0].tube / 20
    gap = min(piece.outline.distance(complex(point)) for point in inside.points(50))
    assert gap >= wall - 1e-9


@pytest.mark.parametrize(
    ("alpha", "gamma"), [pytest.param(0.1, 1.3, marks=pytest.mark.slow), (0.05, 1.7)]
)
def test_a_bowl_and_a_stem_give_what_is_wanted(alpha, gamma):
    found = tt.design_bowl(0.015, 1000.0, alpha, gamma, stem=0.002 if alpha == 0.1 else 0.0015)
    assert proportions(found) == pytest.approx((alpha, gamma), rel=1e-9)
    assert [zone.name for zone in found.hull.zones] == ["sphere", "sphere"]
    # The sphere ends where the stem takes over.
    rim = found.profile[2]
    tilt = found.hull.zones[0].high
    assert (0.015 * math.sin(tilt), -0.015 * math.cos(tilt)) == pytest.approx(rim[:2], rel=1e-6)


def refused(design, *arguments, **options):
    with pytest.raises(tt.InvalidInput) as refusal:
        design(*arguments, **options)
    return refusal.value


def test_the_range_that_a_refusal_names_is_the_one_there_is():
    for gamma in (0.8, 0.99):
        refusal = refused(tt.design_insert, BALL, 0.1, gamma)
        assert refusal.field == "inertia_ratio"
        low, high = map(float, re.findall(r"0\.\d+", refusal.accepted))
        for inside in (low + 1e-4, (low + high) / 2, high - 1e-4):
            assert proportions(tt.design_insert(BALL, 0.1, inside))[1] == pytest.approx(
                inside, rel=1e-9
            )
        for outside in (low - 0.01, high + 0.01):
            assert refused(tt.design_insert, BALL, 0.1, outside).field == "inertia_ratio"
    refusal = refused(tt.design_insert, BALL, 0.3, 0.95)
    assert refusal.field == "eccentricity"
    assert str(refusal).endswith("(write one from -0.160 to 0.160)")


def test_a_ball_with_a_cavity_follows_the_formula_of_its_range():
    """A cavity of radius c at the wall w of a ball of radius 1 shifts it by c^3 (1 - w - c) / (1 -
    c^3).
    """
    best = max(c**3 * (0.95 - c) / (1 - c**3) for c in [k / 1000 for k in range(1, 950)])
    assert round(best, 3) == 0.160
    assert refused(tt.design_insert, BALL, best + 1e-3, 0.95).field == "eccentricity"


@pytest.mark.parametrize(
    ("design", "arguments", "options", "field"),
    [
        (tt.design_insert, (BALL, 0.1, 0.95), {"density": 700.0}, "density"),
        (tt.design_insert, (BALL, 0.1, 0.95), {"wall": 0.5}, "wall"),
        (tt.design_insert, (BALL, 0.1, 0.95), {"density": -1.0}, "density"),
        (tt.design_bowl, (-1.0, 1000.0, 0.1, 0.95), {}, "radius"),
        (tt.design_bowl, (0.015, 1000.0, 0.1, 0.95), {"stem": 0.1}, "stem"),
        (tt.design_bowl, (0.015, 1000.0, 0.5, 0.95), {}, "eccentricity"),
        (tt.design_bowl, (0.015, 1000.0, 0.1, 3.0), {}, "inertia_ratio"),
        (tt.design_bowl, (0.015, -1.0, 0.1, 0.95), {}, "density"),
    ],
)
def test_what_cannot_be_made_is_refused(design, arguments, options, field):
    assert refused(design, *arguments, **options).field == field


def test_a_body_that_stands_on_no_sphere_is_refused():
    coin = tt.Workpiece(profile=[(0, 0), (0.01, 0), (0.01, 0.002), (0, 0.002)], density=8000.0)
    assert refused(tt.design_insert, coin, 0.1, 0.95).field == "piece"
