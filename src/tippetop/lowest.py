"""Which surface of a body is lowest, for many states at once."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tippetop.mechanics.hull import Hull, each_surface, outer_height
from tippetop.mechanics.state import State
from tippetop.mechanics.surface import Surface, contact_vector
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Scalar, Vector, dot

LEVEL = 1e-9
"""Difference of height, in sizes, up to which two surfaces are equally low: then the first of them counts."""

LOOKS = 65
"""Tilts at which the height of the centre of mass is looked at."""


def lowest_number(surface: Surface, c: Any) -> NDArray[np.intp]:
    """Number of the surface that reaches lowest for each c = n_z."""
    heights = np.array([one.height(c) for one in each_surface(surface)])
    found: NDArray[np.intp] = np.argmax(heights >= heights.max(axis=0) - LEVEL * surface.size, axis=0)
    return found


def lowest_contact_vector(axis: Vector, surface: Surface) -> Vector:
    """Vectors from the centre of mass to the lowest point of the body; of arrays, all of one shape."""
    if not isinstance(surface, Hull):
        return contact_vector(axis, surface)
    number = lowest_number(surface, axis[2])
    with np.errstate(divide="ignore", invalid="ignore"):
        arms = np.array([np.broadcast_arrays(*contact_vector(axis, one)) for one in surface.each])
    x, y, z = np.take_along_axis(arms, number[None, None], axis=0)[0]
    return (x, y, z)


def highest_between(surface: Surface, low: Scalar, high: Scalar) -> Scalar:
    """Largest height of the centre of mass on the table for n_z from `low` to `high`, in some looks."""
    heights = outer_height(surface, np.multiply.outer(np.linspace(0.0, 1.0, LOOKS), high - low) + low)
    return np.max(heights, axis=0)


def lowest_jellett(state: State, top: Top) -> Scalar:
    """Jellett's integral -L.a about the lowest point of the body, whichever surface that is on, kg m^3/s."""
    return -dot(state.momentum, lowest_contact_vector(state.axis, top.surface))
