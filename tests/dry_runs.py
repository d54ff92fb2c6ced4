"""Runs with set-valued friction in natural units (mass, size and gravity 1), as the modes of
contact go.
"""

import math

from tippetop.contact.automaton import Automaton
from tippetop.contact.mode import EventKind, Status
from tippetop.contact.trajectory import Trajectory
from tippetop.integrators.taylor import Taylor
from tippetop.mechanics.contacts.forces import velocity_without_slip
from tippetop.mechanics.contacts.slip_variables import slip_of
from tippetop.mechanics.motion import on_table
from tippetop.mechanics.series import PLAIN, Series
from tippetop.mechanics.state import SlidingState


def series(rule):
    return Series(rule, PLAIN)


class DryRun:
    """A top that sticks and slips; `events` are pairs of a name and a time."""

    def __init__(self, top, axis, momentum, velocity, integrator=None):
        self.top, self.integrator = top, integrator or Taylor()
        self.start = on_table(SlidingState(axis, momentum, velocity), top)

    def follow(self, end):
        """Go on up to a time, or to where the table would have to pull."""
        automaton = Automaton(self.top, "fly", 0.0)
        trajectory = Trajectory(automaton, automaton.launch(self.start), end, self.integrator)
        for segment in trajectory.segments():
            if not segment.mode.touching:
                break
            self.state = segment.end_state
        else:
            assert trajectory.status is Status.COMPLETED, trajectory.detail
        self.events = [(event.kind.value, event.time) for event in trajectory.events]
        self.axis, self.momentum = self.state.axis, self.state.momentum
        self.slip = slip_of(self.axis, self.momentum, self.state.velocity[:2], self.top)
        return self

    def times(self, name):
        return [time for event, time in self.events if event == EventKind(name).value]


def launched(top, tilt, spin, *, rests=False):
    """A launch at rest in tilt: without slip, or with the centre of mass at rest; natural units."""
    axis = (math.sin(tilt), 0.0, math.cos(tilt))
    momentum = tuple(top.axial_inertia * spin * x for x in axis)
    velocity = (0.0, 0.0) if rests else velocity_without_slip(axis, momentum, top)
    return top, axis, momentum, velocity
