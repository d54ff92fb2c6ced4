"""Support functions against the surfaces they stand for."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from strategies import numbers, spheres, spheroids, unit_vectors
from tippetop.mechanics.surfaces.surface import (
    OvalSurface,
    RingSurface,
    SphereSurface,
    SpheroidSurface,
    contact_vector,
)

OFF_CENTRE = st.builds(
    lambda egg, center: egg._replace(center=center * min(egg.across, egg.along)),
    spheroids(),
    numbers(-0.9, 0.9),
)
RINGS = st.builds(
    lambda radius, center, tube: RingSurface(radius, center * radius, tube * radius),
    numbers(0.005, 0.1),
    numbers(-1.5, 1.5),
    numbers(0.0, 1.0),
)
SHAPES = st.one_of(spheres(), spheroids(), OFF_CENTRE)


def derivative(function, at):
    """Derivative of an analytic function by a complex step, exact to rounding."""
    step = 1e-30
    return complex(function(at + 1j * step)).imag / step


def surface_points(shape, axis, points=(121, 160)):
    """Points all over the surface, from the centre of mass, and how far apart they are at most."""
    polar = np.linspace(0.0, np.pi, points[0])[:, None]
    around = np.linspace(0.0, 2 * np.pi, points[1], endpoint=False)[None, :]
    third = np.array(axis)
    first = np.cross(third, np.eye(3)[np.argmin(np.abs(third))])
    first /= np.linalg.norm(first)
    second = np.cross(third, first)
    across = np.sin(polar)[..., None] * (
        np.cos(around)[..., None] * first + np.sin(around)[..., None] * second
    )
    along = (np.cos(polar) + 0 * around)[..., None] * third
    if isinstance(shape, SphereSurface):
        surface = shape.center * third + shape.radius * (across + along)
        spacing = shape.radius * 2 * np.pi / points[1]
    else:
        surface = shape.across * across + shape.along * along + shape.center * third
        spacing = max(shape.across, shape.along) * 2 * np.pi / points[1]
    return surface.reshape(-1, 3), spacing


def implicit_surface(shape, axis, point):
    """How far the point is outside the surface, in its square, and the outward normal there."""
    third, point = np.array(axis), np.array(point)
    if isinstance(shape, SphereSurface):
        from_centre = point - shape.center * third
        return from_centre @ from_centre / shape.radius**2 - 1.0, from_centre / shape.radius
    along = point @ third - shape.center
    across = point - (point @ third) * third
    normal = across / shape.across**2 + along * third / shape.along**2
    return across @ normal + along * (third @ normal) - 1.0, normal / np.linalg.norm(normal)


@given(RINGS, numbers(-0.99, 0.99))
def test_so_are_those_of_a_ring_on_its_edge(ring, c):
    assert ring.slope(c) == pytest.approx(
        derivative(ring.height, c), rel=1e-12, abs=1e-14 * ring.size
    )
    assert ring.curvature(c) == pytest.approx(derivative(ring.slope, c), rel=1e-12)


@given(RINGS, unit_vectors(shortest_sine=0.05))
def test_a_ring_touches_at_the_lowest_point_of_its_tube(ring, axis):
    """Which is straight below the lowest point of its circle."""
    c, sine = axis[2], math.hypot(*axis[:2])
    downhill = np.array([axis[0] * c, axis[1] * c, -sine * sine]) / sine
    lowest = ring.center * np.array(axis) + ring.radius * downhill - [0.0, 0.0, ring.tube]
    assert contact_vector(axis, ring) == pytest.approx(tuple(lowest), abs=1e-12 * ring.size)


@given(SHAPES, numbers(-1.0, 1.0))
def test_slope_and_curvature_are_the_derivatives_of_the_support_function(shape, c):
    assert shape.slope(c) == pytest.approx(
        derivative(shape.height, c), rel=1e-12, abs=1e-14 * shape.size
    )
    assert shape.curvature(c) == pytest.approx(
        derivative(shape.slope, c), rel=1e-12, abs=1e-14 * shape.size
    )


@given(SHAPES, unit_vectors())
def test_the_contact_vector_ends_at_the_lowest_point_of_the_surface(shape, axis):
    arm = np.array(contact_vector(axis, shape))
    points, spacing = surface_points(shape, axis)
    lowest = points[np.argmin(points[:, 2])]
    assert points[:, 2].min() >= arm[2] - 1e-13
    assert np.linalg.norm(lowest - arm) < 4 * spacing
    outside, normal = implicit_surface(shape, axis, arm)
    assert outside == pytest.approx(0.0, abs=1e-12)
    assert normal == pytest.approx([0.0, 0.0, -1.0], abs=1e-7)


@given(SHAPES, unit_vectors())
def test_the_support_function_is_the_height_of_the_centre_of_mass(shape, axis):
    assert contact_vector(axis, shape)[2] == pytest.approx(-shape.height(axis[2]), rel=1e-15)


@given(numbers(0.005, 0.1), unit_vectors())
def test_a_spheroid_with_equal_semi_axes_is_a_centred_sphere(radius, axis):
    assert contact_vector(axis, SpheroidSurface(radius, radius)) == pytest.approx(
        (0.0, 0.0, -radius), abs=1e-16
    )


@pytest.mark.parametrize(("tilt", "height"), [(0.0, 0.014), (math.pi / 2, 0.02), (math.pi, 0.026)])
def test_the_tippe_top_lies_lowest_upright_and_highest_upside_down(tilt, height):
    """Radius 20 mm, centre of mass 6 mm below the centre while upright."""
    assert SphereSurface(0.02, 0.006).height(math.cos(tilt)) == pytest.approx(height, rel=1e-15)


@pytest.mark.parametrize(("tilt", "height"), [(0.0, 0.03), (math.pi / 2, 0.02), (math.pi, 0.03)])
def test_an_egg_stands_on_its_long_semi_axis_and_lies_on_its_short_one(tilt, height):
    assert SpheroidSurface(0.02, 0.03).height(math.cos(tilt)) == pytest.approx(height, rel=1e-15)


@given(st.one_of(SHAPES, RINGS))
def test_a_shape_is_its_size_and_its_proportions(shape):
    unit = type(shape).from_proportions(shape.proportions)
    assert unit.size == 1.0
    assert unit.proportions == shape.proportions
    for c in (-1.0, -0.3, 0.0, 0.6, 1.0):
        assert shape.size * unit.height(c) == pytest.approx(shape.height(c), rel=1e-14)


@given(
    coefficients=st.lists(numbers(-0.02, 0.02), min_size=17, max_size=17),
    c=numbers(-1.0, 1.0),
)
def test_an_ovals_derivatives_are_those_of_its_support_function(coefficients, c):
    oval = OvalSurface((0.05, *coefficients[1:]))
    powers = np.polynomial.Polynomial(oval.coefficients)
    assert oval.height(c) == pytest.approx(powers(c), abs=1e-12)
    assert oval.slope(c) == pytest.approx(powers.deriv()(c), abs=1e-11)
    assert oval.curvature(c) == pytest.approx(powers.deriv(2)(c), abs=1e-9)
    unit = OvalSurface.from_proportions(oval.proportions)
    assert 0.05 * unit.height(c) == pytest.approx(oval.height(c), rel=1e-12)
