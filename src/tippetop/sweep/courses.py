"""Launches as arrays, how they ended, and notes of the way."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tippetop.integrators.base import Array
from tippetop.mechanics.state import State
from tippetop.mechanics.top import Kind, Top
from tippetop.phases import Outcome
from tippetop.sweep.hops import picked
from tippetop.sweep.watch import Indices

OUTCOMES = (Outcome.COMPLETED, Outcome.LIFTED_OFF, Outcome.FAILED, Outcome.TOO_MANY_PHASES)
"""How a launch can end, by number."""


@dataclass(frozen=True)
class Launches:
    """Launches of tops of one kind, in natural units.

    Attributes
    ----------
    kind, numbers
        The tops: their dimensionless numbers, shape (kind.numbers, n).
    state
        The states at launch, every number of shape (n,).
    end
        When the runs end, shape (n,).
    liftoff
        "ignore", "stop" or "fly".
    restitution
        Ratio of the normal impulses of restitution and compression, shape (n,).
    """

    kind: Kind
    numbers: Array
    state: State
    end: Array
    liftoff: str
    restitution: Array

    def __len__(self) -> int:
        return len(self.end)

    def some(self, which: Indices) -> "Launches":
        """Some of the launches."""
        state = picked(self.state, which)
        numbers, end, restitution = self.numbers[:, which], self.end[which], self.restitution[which]
        return Launches(self.kind, numbers, state, end, self.liftoff, restitution)

    @property
    def top(self) -> Top:
        """The tops, with arrays for numbers."""
        return self.kind.top(tuple(self.numbers))


@dataclass(frozen=True)
class Ends:
    """How launches ended, in natural units; all of shape (n,).

    Attributes
    ----------
    state
        The states at the end.
    time
        When that was.
    outcome
        Numbers of `OUTCOMES`.
    steps, flights
        Steps taken, and flights made.
    least_force
        Least normal force; 0 where the top left the table.
    lift_off
        First time the table let go; nan if it never did.
    airborne, highest_gap, highest
        Time spent in the air, and there the largest gap and the largest height of the centre of mass.
    down, up
        Least and largest n_z.
    turned
        First time n_z fell through 0; nan if it never did.
    """

    state: State
    time: Array
    outcome: NDArray[np.int8]
    steps: NDArray[np.int64]
    flights: NDArray[np.int64]
    least_force: Array
    lift_off: Array
    airborne: Array
    highest_gap: Array
    highest: Array
    down: Array
    up: Array
    turned: Array

    @classmethod
    def unknown(cls, count: int) -> "Ends":
        """Ends that nothing is known of yet."""
        unknown = np.full(count, np.nan)
        none = np.zeros(count)
        return cls(
            state=State.unpack([unknown.copy() for _ in range(16)]),
            time=unknown.copy(),
            outcome=np.full(count, OUTCOMES.index(Outcome.FAILED), dtype=np.int8),
            steps=np.zeros(count, dtype=np.int64),
            flights=np.zeros(count, dtype=np.int64),
            least_force=unknown.copy(),
            lift_off=unknown.copy(),
            airborne=none.copy(),
            highest_gap=none.copy(),
            highest=none.copy(),
            down=unknown.copy(),
            up=unknown.copy(),
            turned=unknown.copy(),
        )


@dataclass(frozen=True)
class Note:
    """A window of steps of some launches: where they were at its start, and how far n_z went in it.

    Attributes
    ----------
    cells
        Which launches, shape (n,).
    rows
        Their states and the time left, shape (SIZE + 1, n).
    down, up
        Least and largest n_z in the window, shape (n,).
    """

    cells: Indices
    rows: Array
    down: Array
    up: Array
