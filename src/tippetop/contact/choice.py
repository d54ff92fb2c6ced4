"""The automaton of a problem, and the mode that is reported of a launch that ends as it begins."""

from tippetop.contact.automaton import Automaton
from tippetop.contact.contact_mode import ContactMode
from tippetop.contact.flight import Flight
from tippetop.contact.mode import Mode
from tippetop.mechanics.motion import along_table
from tippetop.mechanics.state import State
from tippetop.mechanics.surfaces.hull import lowest_surface
from tippetop.mechanics.top import Top
from tippetop.mechanics.units import Units
from tippetop.mechanics.vectors import Scalar
from tippetop.problem.contact_rules import Contact


# translate: skip
def automaton_of(rules: Contact, top: Top, units: Units) -> Automaton:
    """Return the automaton of a top in natural units: the one that its problem's contact brings, or
    the usual.
    """
    chosen: Automaton | None = rules.rules(top, units)
    if chosen is not None:
        return chosen
    return Automaton(top, rules.liftoff, rules.restitution, rules.indeterminate)


def initial_mode(state: State, top: Top) -> tuple[Mode, tuple[Scalar, ...]]:
    """Return the mode that is reported for a launch that ends as it begins, and its numbers.

    It slides, but where the table would have to pull: then it lets go.
    """
    lowest = top._replace(surface=lowest_surface(top.surface, state.axis[2]))
    sliding, numbers = ContactMode(lowest, pulls=True), along_table(state).pack()
    try:
        presses = sliding.reaction(numbers).force[2] > 0.0
    except ZeroDivisionError:
        # At zero slip dry friction has no direction, and the table lets go at once.
        presses = False
    return (sliding, numbers) if presses else (Flight(top), state.pack())
