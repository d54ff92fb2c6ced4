"""Launches as arrays, and where they were on the way."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from tippetop.contact.automaton import Automaton
from tippetop.contact.contact_mode import ContactMode
from tippetop.integrators.base import Array
from tippetop.mechanics.contacts.branches import is_branched, off_branch, on_numbered_branch
from tippetop.mechanics.contacts.slip_variables import slip_of
from tippetop.mechanics.motion import along_table
from tippetop.mechanics.state import State
from tippetop.mechanics.top import Kind, Top

Indices = NDArray[np.intp]
Flags = NDArray[np.bool_]
Own = NDArray[np.object_]
"""What makes the rules of tops, for launches whose contact brings its own; see `Contact.rules`."""


@dataclass(frozen=True)
class Launches:
    """Launches of tops of one kind, in natural units."""

    kind: Kind
    numbers: Array
    """The tops: their dimensionless numbers, shape (kind.numbers, n)."""
    state: State
    """The states at launch, every number of shape (n,)."""
    end: Array
    """When the runs end, shape (n,)."""
    liftoff: str
    """"ignore", "stop" or "fly"."""
    restitution: Array
    """Ratio of the normal impulses of restitution and compression, shape (n,)."""
    indeterminate: str
    """What the table does where the contact force is indeterminate: "impact" or "liftoff"."""
    face_pressure: str = "uniform"
    """Pressure under a face: "uniform", "rim" or "ellipsoidal"."""
    rules: Own | None = None
    """For contacts that bring their own rules, what makes them of a top, shape (n,)."""

    def __len__(self) -> int:
        return len(self.end)

    def some(self, which: Indices) -> "Launches":
        """Return some of the launches."""
        state = picked(self.state, which)
        numbers, end, restitution = self.numbers[:, which], self.end[which], self.restitution[which]
        rules = None if self.rules is None else self.rules[which]
        return replace(
            self, numbers=numbers, state=state, end=end, restitution=restitution, rules=rules
        )

    @property
    def top(self) -> Top:
        """The tops, with arrays for numbers."""
        return self.tops(slice(None))

    def tops(self, which: Indices | Flags | slice) -> Top:
        """Return some of the tops, with arrays for numbers."""
        return self.kind.top(tuple(self.numbers[:, which]))

    @property
    def unresisted(self) -> Flags:
        """Which roll without the resistance that the others have, shape (n,)."""
        resistance, none = self.top.rolling_resistance, np.zeros(len(self), dtype=bool)
        is_free: Flags = none if resistance is None else none | (resistance.length == 0.0)
        return is_free

    def automaton(self, launch: int) -> Automaton:
        """Return the automaton of one launch, for when its contact begins or ends."""
        top = off_branch(self._top(launch))
        if top.rolling_resistance is not None and top.rolling_resistance.length == 0.0:
            top = top.altered(rolling_resistance=None)
        if top.body.field is not None:
            top = top.altered(field=top.body.field.without_zeros())
        if self.rules is not None:
            automaton: Automaton = self.rules[launch](top)
            return automaton
        restitution = float(self.restitution[launch])
        return Automaton(top, self.liftoff, restitution, self.indeterminate, self.face_pressure)

    def sliding(self, launch: int, state: State) -> ContactMode:
        """Return the mode in which one launch slides in a state, on the branch that holds there."""
        top = branched(self._top(launch), state)
        return ContactMode(top, pulls=self.liftoff == "ignore")

    def _top(self, launch: int) -> Top:
        return self.kind.top(tuple(self.numbers[:, launch].tolist()))


def branched(top: Top, state: State) -> Top:
    """Tops in these states with the branch of their law that holds there, where it is made of
    branches.
    """
    if not is_branched(top.friction):
        return top
    return on_numbered_branch(top, slip_of(*along_table(state), top))


@dataclass(frozen=True)
class Checkpoint:
    """Where some launches were at the start of a window of steps, and how far n_z went in it."""

    cells: Indices
    """Which launches, shape (n,)."""
    rows: Array
    """Their numbers and the time left, shape (size + 1, n)."""
    down: Array
    up: Array
    """Least and largest n_z in the window, shape (n,)."""


def picked(state: State, launches: Indices | Flags) -> State:
    """Return some of many states."""
    return State.unpack([np.asarray(number)[launches] for number in state.pack()])


def single(state: State, launch: int) -> State:
    """Return one of many states, in floats."""
    return State.unpack([float(number[launch]) for number in state.pack()])
