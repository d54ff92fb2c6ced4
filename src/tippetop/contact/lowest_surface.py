"""Which surface of a body is lowest, for many states at once."""

import numpy as np

from tippetop.mechanics.state import State
from tippetop.mechanics.surfaces.hull import Hull, each_surface, outer_height
from tippetop.mechanics.surfaces.surface import Surface, contact_vector
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Scalar, Vector, dot

LEVEL = 1e-9
"""Difference of height, in sizes, up to which two surfaces are equally low: then the first of them
counts.
"""

PROBED_TILTS = 65
"""Tilts at which the height of the centre of mass is looked at."""


def lowest_contact_vector(axis: Vector, surface: Surface) -> Vector:
    """Vectors from the centre of mass to the lowest point of the body; of numbers, or arrays of one
    shape.
    """
    if not isinstance(surface, Hull):
        return contact_vector(axis, surface)
    arms = [contact_vector(axis, one) for one in each_surface(surface)]
    depth = arms[0][2]
    for _, _, z in arms[1:]:
        depth = 0.5 * (depth + z - abs(depth - z))
    level = depth + LEVEL * surface.size
    x, y, z = arms[-1]
    for arm in reversed(arms):
        lowest = np.less(arm[2], level)
        x, y, z = (np.where(lowest, arm[i], former) for i, former in enumerate((x, y, z)))
    return (x, y, z)


def highest_between(surface: Surface, low: Scalar, high: Scalar) -> Scalar:
    """Largest height of the centre of mass on the table for n_z from `low` to `high`, in some
    looks.

    A sphere's is linear in n_z: there it is at one of the ends.
    """
    low, high = np.maximum(low, -1.0), np.minimum(high, 1.0)
    highest, last = outer_height(surface, low), 1 if surface.spherical else PROBED_TILTS - 1
    for probe in range(1, last + 1):
        highest = np.maximum(highest, outer_height(surface, low + probe / last * (high - low)))
    return highest


def lowest_jellett(state: State, top: Top) -> Scalar:
    """Jellett's integral -L.a about the lowest point of the body, whichever surface that is on, kg
    m^3/s.
    """
    return -dot(state.momentum, lowest_contact_vector(state.axis, top.surface))
