"""Conditions of the theory on a top, and the refusals of tops that do not meet them."""

import math

from tippetop.mechanics.contacts.forces import is_set_valued, slip_length
from tippetop.mechanics.surfaces.hull import Hull, lies_flat_at
from tippetop.mechanics.top import Top
from tippetop.support.errors import Described, InvalidInput


def require_one_surface(top: Top) -> None:
    """Raise `InvalidInput` if the body has several surfaces."""
    if isinstance(top.surface, Hull):
        raise InvalidInput(
            "body.shape",
            Described("a body of several surfaces"),
            "one of them at a time",
            "is beyond the theory",
        )


def require_no_field(top: Top) -> None:
    """Raise `InvalidInput` if the table slopes, or there is air: no motion is steady then."""
    field = top.field
    if field is None:
        return
    if field.slope is not None:
        slope = math.atan2(math.hypot(*field.slope), top.gravity)
        accepted = "0: on a slope a spinning top drifts and gains speed, and no motion is steady"
        raise InvalidInput("table.slope", slope, accepted)
    fault = "brakes every spin, and no motion is steady"
    raise InvalidInput("air", Described("the air of this problem"), "", fault, "omit it")


def require_sphere(top: Top) -> None:
    """Raise `InvalidInput` if the body is no eccentric sphere, or an outer field acts on it."""
    require_no_field(top)
    require_one_surface(top)
    if not top.surface.spherical:
        raise InvalidInput(
            "body.shape",
            Described("this one"),
            "an eccentric sphere; Jellett's integral holds for no other",
        )
    if top.surface.height(0.0) == 0.0:
        raise InvalidInput(
            "body.shape.radius",
            0.0,
            "more than 0: a sharp tip does not roll, and has no precession",
        )


def require_jellett(top: Top) -> None:
    """Raise `InvalidInput` if the top does not conserve Jellett's integral."""
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
    """Raise `InvalidInput` unless a top with a vertical axis creeps: friction is linear in slip.

    Otherwise there is no linear motion: a point on dry friction sticks and then rolls for ever, and
    rolling resistance holds an axis that hardly moves. A patch on dry friction does creep, by
    drilling. Bodies of several surfaces, and bodies that lie flat whenever their axis is vertical,
    are refused too, and tops on a slope or in air.
    """
    require_no_field(top)
    require_one_surface(top)
    if _lies_flat_at_both_ends(top):
        raise InvalidInput(
            "body.shape",
            Described("this one"),
            "a shape that touches in one point when its axis is vertical",
        )
    require_smooth_friction(top)


def require_smooth_friction(top: Top) -> None:
    """Raise `InvalidInput` if rolling resistance or dry friction of a point leaves a steady state
    without a linear motion beside it.
    """
    if top.rolling_resistance is not None:
        arm = top.rolling_resistance.length
        raise InvalidInput(
            "rolling_resistance", arm, "0: with it a steady state has no linear motion beside it"
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

    For a body of several surfaces the active one decides.
    """
    return not (_lies_flat_at_both_ends(top) or top.resists_rolling or sticks(top))


def _lies_flat_at_both_ends(top: Top) -> bool:
    return lies_flat_at(top.surface, 1.0) and lies_flat_at(top.surface, -1.0)
