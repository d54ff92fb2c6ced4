"""Condition for standing on a stem: the least Jellett's integral about its tip.

The least spin of a launch that has it is `tippetop.theory.outlook.outlook`'s; those of a body on
one surface are in `thresholds`, and sizes with which it is reached in `advice`.
"""

from tippetop.mechanics.laws.friction import ViscousLaw
from tippetop.mechanics.surfaces.hull import each_surface
from tippetop.mechanics.surfaces.surface import contact_vector
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Vector, dot
from tippetop.problem.bodies import Body
from tippetop.support.errors import Described, InvalidInput, is_number, is_whole, require
from tippetop.theory.steady import SteadyKind
from tippetop.theory.thresholds import critical_jellett


def least_jellett_to_stand(body: Body, surface: int = 1, gravity: float = 9.8) -> float:
    """Return the least Jellett's integral about a stem's tip with which a top stands upright on it.

    Parameters
    ----------
    body
        The body.
    surface
        Number of the stem's tip, a sphere, among its surfaces.
    gravity
        Acceleration of gravity, m/s^2.

    Returns
    -------
    float
        lambda = -L.a, kg m^3/s, with the contact vector a of the tip: 0 if the top stands at rest,
        infinite if it stands at no spin.

    Raises
    ------
    InvalidInput
        If the body has no such surface, the surface is no sphere, or gravity is not positive.

    Notes
    -----
    While the tip alone touches, lambda is constant, as for any sphere. With the tip's radius r, and
    its centre zeta above the centre of mass along the axis, spinning upright is stable under
    friction where

        lambda > sqrt(m g I3 zeta / (r (zeta + r (1 - I1 / I3)))) (r + zeta)^2,

    which is the condition of an inverted tippe top with the tip as its sphere (Rauch-Wojciechowski,
    Skoldstam and Glad, Regular and Chaotic Dynamics 10 (2005) 333-362).

    Examples
    --------
    >>> import tippetop as tt
    >>> bowl, tip = tt.Sphere(radius=0.02, center=0.006), tt.Sphere(radius=0.003, center=0.025)
    >>> top = tt.Body(mass=0.02, shape=[bowl, tip], I1=3.0e-6, I3=3.2e-6)
    >>> f"{tt.least_jellett_to_stand(top):.3e}"
    '1.129e-05'
    """
    require("body", body, Body, "a Body")
    if not (is_number(gravity) and gravity > 0.0):
        raise InvalidInput("gravity", gravity, "a number greater than 0")
    if len(body.shapes) == 1 and surface:
        raise InvalidInput(
            "body.shape", Described("one surface"), "several, of which one is the stem's tip"
        )
    if not is_whole(surface) or surface not in range(len(body.shapes)):
        raise InvalidInput("surface", surface, f"a whole number from 0 to {len(body.shapes) - 1}")
    tip = body.shapes[surface].surface
    if not tip.spherical:
        raise InvalidInput(
            "surface", surface, "that of a sphere; Jellett's integral holds for no other"
        )
    if tip.slope(0.0) >= 0.0:
        return 0.0
    top = Top.of(body.mass, body.I1, body.I3, tip, ViscousLaw(1.0), gravity)
    return critical_jellett(SteadyKind.INVERTED, top)


def jellett_about(surface: int, axis: Vector, momentum: Vector, top: Top) -> float:
    """Return -L.a about one of a top's surfaces, whether it touches or not, kg m^3/s."""
    return -float(dot(momentum, contact_vector(axis, each_surface(top.surface)[surface])))
