"""A launch in natural units, with the rules of its contact: what every run starts from.

Problems come in SI units. They enter natural units here, and results return to SI in
`tippetop.results`.
"""

from typing import NamedTuple, Self

from tippetop.contact.automaton import Automaton
from tippetop.contact.contact_mode import ContactMode
from tippetop.contact.flight import Flight
from tippetop.contact.mode import Mode, Transition
from tippetop.mechanics.motion import along_table
from tippetop.mechanics.natural_units import Units
from tippetop.mechanics.state import State
from tippetop.mechanics.top import Top, natural, natural_state, natural_units
from tippetop.mechanics.vectors import Scalar
from tippetop.problem.contact_rules import Contact
from tippetop.problem.problem import Problem, top_of


# translate: skip
class NaturalLaunch(NamedTuple):
    """All that a run starts from, in natural units, and these units, by which `results.derived`
    and `results.metrics` go back to SI.
    """

    units: Units
    top: Top
    state: State
    azimuth: float
    """Direction into which the axis leans, rad."""
    automaton: Automaton
    """The rules of what follows each mode."""
    first: Transition
    """What follows at once: the first mode, perhaps after an impact."""

    @classmethod
    def of(cls, problem: Problem) -> Self:
        """Return the launch of a problem."""
        units = natural_units(top_of(problem))
        top, state = natural(top_of(problem)), natural_state(problem.start(), units)
        automaton = automaton_of(problem.contact, top, units)
        azimuth = float(problem.launch.azimuth)
        return cls(units, top, state, azimuth, automaton, automaton.launch(state))


# translate: skip
def automaton_of(rules: Contact, top: Top, units: Units) -> Automaton:
    """Return the automaton of a top in natural units: the one that its problem's contact brings, or
    the usual.
    """
    chosen: Automaton | None = rules.rules(top, units)
    if chosen is not None:
        return chosen
    return Automaton(
        top, rules.liftoff, rules.restitution, rules.indeterminate, rules.face_pressure
    )


def initial_mode(state: State, top: Top) -> tuple[Mode, tuple[Scalar, ...]]:
    """Return the mode that is reported for a launch that ends as it begins, and its numbers.

    It slides, but where the table would have to pull: then it lets go.
    """
    lowest = top.body.lowest_at(state.axis[2])
    sliding, numbers = ContactMode(lowest, pulls=True), along_table(state).pack()
    try:
        presses = sliding.reaction(numbers).force[2] > 0.0
    except ZeroDivisionError:
        # At zero slip dry friction has no direction, and the table lets go at once.
        presses = False
    return (sliding, numbers) if presses else (Flight(top), state.pack())
