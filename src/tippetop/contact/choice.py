"""Which rules hold for a top, and what is told of one that ends as it begins."""

from tippetop.contact.flight import Flight
from tippetop.contact.liftoff import Bilateral, FreeToFly, StopAtLiftOff
from tippetop.contact.mode import Mode
from tippetop.contact.rules import Rules
from tippetop.contact.several import OnSeveral
from tippetop.contact.sliding import Sliding
from tippetop.mechanics.hull import Hull, lowest_surface
from tippetop.mechanics.motion import along_table
from tippetop.mechanics.state import State
from tippetop.mechanics.top import Top
from tippetop.mechanics.units import Units
from tippetop.mechanics.vectors import Scalar
from tippetop.problem.contact_rules import Contact


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


# translate: skip
def rules_of(way: Contact, top: Top, units: Units) -> Rules:
    """The rules of a top in natural units: those that its problem's contact brings, or the
    usual.
    """
    own: Rules | None = way.rules(top, units)
    return rules_for(top, way.liftoff, way.restitution) if own is None else own


def as_begun(state: State, top: Top) -> tuple[Mode, tuple[Scalar, ...]]:
    """The mode that a launch is told in that ends as it begins, and its numbers.

    It slides, but where the table would have to pull: then it lets go.
    """
    lowest = top._replace(surface=lowest_surface(top.surface, state.axis[2]))
    sliding, numbers = Sliding(lowest, Bilateral(lowest)), along_table(state).pack()
    try:
        presses = sliding.reaction(numbers).force[2] > 0.0
    except (
        ZeroDivisionError
    ):  # Without slip dry friction says nothing, and the table lets go at once.
        presses = False
    return (sliding, numbers) if presses else (Flight(top, Bilateral(top)), state.pack())
