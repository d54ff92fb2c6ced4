"""The top flies, in closed form."""

import math
from dataclasses import dataclass

import numpy as np

from tippetop.integrators.base import Array, Integrator
from tippetop.mechanics.flight import fly, gap
from tippetop.mechanics.motion import along_table, on_table
from tippetop.mechanics.state import State
from tippetop.mechanics.top import Kind
from tippetop.mechanics.touchdown import Start, touchdown
from tippetop.phases.base import Outcome, PhaseKind, Stretch, Transition, Transitions

LOOKS = 64
"""Looks at the gap in search of its highest value; the search is repeated around the best one."""


@dataclass(frozen=True)
class Flight:
    """Free flight, until the body's lowest point touches the table again.

    Attributes
    ----------
    top
        What kind of top it is.
    numbers
        Its dimensionless numbers.
    transitions
        What follows when it touches the table.
    start
        How the flight starts: thrown, rebounding, released or lifting off.
    """

    top: Kind
    numbers: tuple[float, ...]
    transitions: Transitions
    start: Start

    def follow(self, start: tuple[float, Array], end: float, times: Array, integrator: Integrator) -> Stretch:
        """Evaluate the flight where it is asked for; see `tippetop.phases.base.Phase`."""
        top = self.top.top(self.numbers)
        begin = State.unpack(start[1].tolist())
        landing = touchdown(begin, top, end - start[0], self.start)
        duration = end - start[0] if landing is None else landing
        here = times[times <= start[0] + duration]
        states = fly(begin, here - start[0], top, np)
        last = fly(begin, duration, top, math)
        if landing is not None:
            ground = on_table(along_table(last), top).position
            last = last._replace(position=ground)
        end_state = np.array(last.pack())
        end_time = end if landing is None else start[0] + duration
        if landing is None:
            transition = Transition((), Outcome.COMPLETED, end_state)
        else:
            transition = self.transitions.touchdown(end_time, end_state)
        return Stretch(
            PhaseKind.FLIGHT,
            here,
            np.stack(np.broadcast_arrays(*states.pack()), axis=1),
            end_time,
            end_state,
            transition,
            highest_gap=self._highest_gap(begin, duration),
        )

    def _highest_gap(self, begin: State, duration: float) -> float:
        """The highest gap of the flight."""
        top = self.top.top(self.numbers)
        low, high = 0.0, duration
        for _ in range(2):
            looks = np.linspace(low, high, LOOKS)
            gaps = np.broadcast_to(gap(fly(begin, looks, top, np), top), looks.shape)
            best = int(np.argmax(gaps))
            low, high = looks[max(best - 1, 0)], looks[min(best + 1, LOOKS - 1)]
        return float(gaps[best])
