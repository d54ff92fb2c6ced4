"""What the theory asks of a top, with a sentence for those it does not hold for."""

from tippetop.mechanics.contacts.forces import is_set_valued, slip_length
from tippetop.mechanics.surfaces.hull import Hull, is_edge
from tippetop.mechanics.top import Top
from tippetop.support.errors import Described, InvalidInput


def require_one_surface(top: Top) -> None:
    """Refuse a body of several surfaces, with `InvalidInput`."""
    if isinstance(top.surface, Hull):
        raise InvalidInput(
            "body.shape",
            Described("of several surfaces"),
            "one of them at a time",
            "is beyond the theory",
        )


def require_sphere(top: Top) -> None:
    """Refuse a body that is no eccentric sphere, with `InvalidInput`."""
    require_one_surface(top)
    if not top.surface.spherical:
        raise InvalidInput(
            "body.shape",
            Described("this one"),
            "an eccentric sphere; Jellett's integral holds for no other",
        )


def require_jellett(top: Top) -> None:
    """Refuse a top that does not conserve Jellett's integral, with `InvalidInput`."""
    require_sphere(top)
    if top.rolling_resistance is not None:
        arm = top.rolling_resistance.length
        raise InvalidInput(
            "rolling_resistance", arm, "0: with it Jellett's integral is not conserved"
        )
    if not top.conserves_jellett:
        raise InvalidInput(
            "friction",
            Described("this law"),
            "one without torque, which conserves Jellett's integral",
        )


def require_creep(top: Top) -> None:
    """Refuse friction that is not proportional to small slip about a vertical spin, with
    `InvalidInput`.

    There is no linear motion then: a point on dry friction sticks, and rolls for ever whatever is
    stable, and resistance to rolling holds an axis that hardly moves. A patch on dry friction does
    creep, by drilling. A body of several surfaces is refused too, and one that lies flat when its
    axis is vertical.
    """
    require_one_surface(top)
    if is_edge(top.surface):
        raise InvalidInput(
            "body.shape",
            Described("this one"),
            "a shape that touches in one point when its axis is vertical",
        )
    if top.rolling_resistance is not None:
        arm = top.rolling_resistance.length
        raise InvalidInput(
            "rolling_resistance", arm, "0: with it a spin about the vertical has no linear motion"
        )
    if sticks(top):
        raise InvalidInput(
            "friction",
            Described("dry friction of a point"),
            "viscous, regularized or Contensou friction, by which slip never ends while the top"
            " spins; on this one it sticks, and may roll for ever in a state that is not stable",
        )


def sticks(top: Top) -> bool:
    """Return whether slip of a spinning top ends: under dry friction of a point."""
    return is_set_valued(top.friction) and slip_length(top.friction) is None


def creeps(top: Top) -> bool:
    """Return whether friction is proportional to small slip about a vertical spin.

    Of a body of several surfaces, the active one counts.
    """
    return not (is_edge(top.surface) or top.resists_rolling or sticks(top))
