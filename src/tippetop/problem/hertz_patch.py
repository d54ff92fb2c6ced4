"""Contact patch of two elastic bodies (Hertz 1882; Johnson, Contact Mechanics, chapter 4)."""

import math
from typing import Annotated

from pydantic import Field

from tippetop.support.errors import InvalidInput, is_number, require
from tippetop.support.validation import NO_WORD, Part, Positive


class Material(Part):
    """Isotropic elastic material.

    Attributes
    ----------
    modulus
        Young's modulus, Pa.
    poisson
        Poisson's ratio, above -1 and at most 1/2.

    Examples
    --------
    >>> import tippetop as tt
    >>> beech = tt.Material(modulus=14e9, poisson=0.3)
    >>> tt.MATERIALS["steel"]
    Material(modulus=207000000000.0, poisson=0.3)
    """

    modulus: Positive
    poisson: Annotated[float, Field(gt=-1, le=0.5), NO_WORD]


GLASS = Material(modulus=69e9, poisson=0.23)
STEEL = Material(modulus=207e9, poisson=0.30)
WOOD = Material(modulus=12e9, poisson=0.29)
PLASTIC = Material(modulus=2.8e9, poisson=0.33)
MATERIALS = {"glass": GLASS, "steel": STEEL, "wood": WOOD, "plastic": PLASTIC}
"""Soda-lime glass, plain carbon steel, Douglas fir along its grain and polystyrene (Callister,
Materials Science and Engineering, 7th edition, appendix B). Wood is not isotropic: its patch is
right only in the order of magnitude.
"""


def hertz_patch_radius(
    load: float, radius: float, body: Material, table: Material | None = None
) -> float:
    """Return the radius of the contact patch of a sphere on a plane, (3 P r / (4 E*))^(1/3), m.

    Parameters
    ----------
    load
        Normal force P, N: m g for a top at rest.
    radius
        Radius r of the sphere at the contact, m.
    body, table
        Their materials; a table of None is rigid. 1/E* is the sum of (1 - nu^2)/E of both.

    Raises
    ------
    InvalidInput
        If the load or the radius is not positive or overflows, or an argument is no material.

    Examples
    --------
    >>> import tippetop as tt
    >>> wood, glass = tt.MATERIALS["wood"], tt.MATERIALS["glass"]
    >>> radius = tt.hertz_patch_radius(load=0.02 * 9.8, radius=0.02, body=wood, table=glass)
    >>> round(1e6 * radius, 1)  # micrometres
    64.2
    """
    for field, value in {"load": load, "radius": radius}.items():
        if not (is_number(value) and value > 0.0):
            raise InvalidInput(field, value, "a number greater than 0")
    require("body", body, Material, "a Material")
    if table is not None:
        require("table", table, Material, "a Material, or None for a rigid one")
    compliance = sum((1.0 - m.poisson**2) / m.modulus for m in (body, table) if m is not None)
    patch = float((0.75 * load * radius * compliance) ** (1.0 / 3.0))
    if not 0.0 < patch < math.inf:
        raise InvalidInput(
            "load", load, "a number whose product with the radius is neither 0 nor infinite"
        )
    return patch
