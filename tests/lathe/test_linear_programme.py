"""The lowest point of linear programmes, and ovals as such points, are those of SciPy's solver."""

import math

import numpy as np
import pytest
from scipy.optimize import linprog

from tippetop.lathe.linear_programme import lowest_point
from tippetop.lathe.support import SHARPEST, polynomial_support
from tippetop.lathe.workpiece import Workpiece

DEGREE = 16


def random_bounds(seed: int, unknowns: int) -> tuple[np.ndarray, np.ndarray]:
    """Rows and bounds of a programme: x[-1] is not below some planes, nor below 0."""
    rng = np.random.default_rng(seed)
    rows = np.hstack([rng.normal(size=(60, unknowns)), np.full((60, 1), -1.0)])
    bounds = rng.normal(size=60)
    box = np.hstack([np.eye(unknowns), np.zeros((unknowns, 1))])
    last = np.zeros((1, unknowns + 1))
    last[0, -1] = -1.0
    return np.vstack([rows, box, -box, last]), np.concatenate(
        [bounds, np.full(2 * unknowns, 3.0), [0.0]]
    )


@pytest.mark.parametrize("seed", range(12))
def test_the_lowest_point_is_that_of_scipy(seed: int) -> None:
    unknowns = 2 + seed % 5
    rows, bounds = random_bounds(seed, unknowns)
    first = [len(rows) - 1, *range(60, 60 + unknowns)]
    point = lowest_point(list(rows.T), bounds, first)
    cost = np.append(np.zeros(unknowns), 1.0)
    expected = linprog(cost, rows, bounds, bounds=(None, None)).x
    assert point is not None
    assert point[-1] == pytest.approx(expected[-1], abs=1e-7)
    assert (rows @ point - bounds).max() < 1e-9


def test_bounds_that_no_point_keeps_have_no_lowest_point() -> None:
    # x <= -1 and -x <= -1.
    columns = [np.array([0.0, 1.0, -1.0]), np.array([-1.0, 0.0, 0.0])]
    assert lowest_point(columns, np.array([0.0, -1.0, -1.0]), [0, 1]) is None


def pear(narrower: float) -> Workpiece:
    angles = np.linspace(-math.pi / 2, math.pi / 2, 61).tolist()
    points = [(15 * math.cos(a) * (1 - narrower * math.sin(a)), 20 * math.sin(a)) for a in angles]
    points[0], points[-1] = (0.0, -20.0), (0.0, 20.0)
    return Workpiece(profile=points, unit="mm", density=700)


@pytest.mark.parametrize("narrower", [0.05, 0.15, 0.3])
def test_an_oval_is_the_closest_convex_surface_that_stays_within(narrower: float) -> None:
    piece = pear(narrower)
    center, size = piece.mass_properties.center, piece.outline.size
    support, error = polynomial_support(piece.hull, 0.0, math.pi, center, DEGREE, False)
    tilts = np.linspace(0.0, math.pi, 361)
    c, s = np.cos(tilts), np.sin(tilts)
    height = np.polynomial.Polynomial(support)
    hull = np.array([piece.hull.support(tilt) for tilt in tilts.tolist()]) + center * c
    apart = height(c) - hull
    assert np.abs(apart).max() == pytest.approx(error, rel=1e-6)
    slope, bend = height.deriv()(c), height.deriv(2)(c)
    across, along = height(c) - c * slope, height(c) - c * slope + s**2 * bend
    assert min(across.min(), along.min()) >= (SHARPEST - 1e-9) * hull.max()
    # By the powers of the cosine, and another solver.
    powers = np.vander(c, DEGREE + 1, increasing=True)
    ones = np.ones((len(c), 1))
    rows = np.vstack([np.hstack([powers, -ones]), np.hstack([-powers, -ones])])
    bounds = np.concatenate([hull, -hull]) / size
    cost = np.append(np.zeros(DEGREE + 1), 1.0)
    least = linprog(cost, rows, bounds, bounds=(None, None)).x[-1]
    assert error / size >= least - 1e-7
    if along.min() > 2 * SHARPEST * hull.max():
        assert error / size == pytest.approx(least, abs=2e-7)
