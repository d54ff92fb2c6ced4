"""Which rules hold for a top."""

from tippetop.contact.mode import Rules
from tippetop.contact.rules import Bilateral, FreeToFly, StopAtLiftOff
from tippetop.contact.several import OnSeveral
from tippetop.mechanics.hull import Hull
from tippetop.mechanics.top import Top
from tippetop.mechanics.units import Units
from tippetop.problem import Contact


def rules_for(top: Top, liftoff: str, restitution: float) -> Rules:
    """The rules of a top in natural units.

    Parameters
    ----------
    top
        The top.
    liftoff
        "ignore", "stop" or "fly".
    restitution
        Ratio of the normal impulses of restitution and compression.
    """
    if liftoff == "fly":
        several = isinstance(top.surface, Hull)
        return OnSeveral(top, restitution) if several else FreeToFly(top, restitution)
    return StopAtLiftOff(top) if liftoff == "stop" else Bilateral(top)


def rules_of(way: Contact, top: Top, units: Units) -> Rules:
    """The rules of a top in natural units: those that its problem's contact brings, or the usual."""
    own: Rules | None = way.rules(top, units)
    return rules_for(top, way.liftoff, way.restitution) if own is None else own
