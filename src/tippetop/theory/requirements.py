"""What the theory asks of a top, with a sentence for those it does not hold for."""

from tippetop.errors import InvalidInput
from tippetop.mechanics.hull import Hull
from tippetop.mechanics.rolling import is_set_valued
from tippetop.mechanics.top import Top


def require_one_surface(top: Top) -> None:
    """Refuse a body of several surfaces, with `InvalidInput`."""
    if isinstance(top.surface, Hull):
        raise InvalidInput("body.shape", "several surfaces", "one of them at a time, for the theory to tell")


def require_sphere(top: Top) -> None:
    """Refuse a body that is no eccentric sphere, with `InvalidInput`."""
    require_one_surface(top)
    if not top.surface.spherical:
        raise InvalidInput(
            "body.shape", top.surface, "an eccentric sphere; Jellett's integral holds for no other"
        )


def require_jellett(top: Top) -> None:
    """Refuse a top that does not conserve Jellett's integral, with `InvalidInput`."""
    require_sphere(top)
    if not top.conserves_jellett:
        raise InvalidInput(
            "friction", top.friction, "friction without torque, which conserves Jellett's integral"
        )


def require_lasting_slip(top: Top) -> None:
    """Refuse dry friction, with `InvalidInput`: a top that sticks may roll for ever, whatever is stable.

    There is no linear motion about sticking either. A body of several surfaces is refused too.
    """
    require_one_surface(top)
    if is_set_valued(top.friction):
        raise InvalidInput(
            "friction", top.friction, "friction under which slip never ends; the theory knows no sticking"
        )
