"""Runs with set-valued friction in natural units (mass, size and gravity 1), driven by hand mode by mode."""

import math

import numpy as np
from tippetop.sweeps.series import Series

from tippetop.integrators.base import Guard, Motion
from tippetop.integrators.taylor import Taylor
from tippetop.mechanics.motion import axis_rate
from tippetop.mechanics.rolling import ContactPoint, contact_wrench, velocity_without_slip, without_drilling
from tippetop.mechanics.slip_onset import onset
from tippetop.mechanics.stick_slip import (
    HORIZON,
    LANDING,
    Closing,
    closing_rates,
    creep_rates,
    direction_of_slip,
    landed,
    landing_guard,
    reopening_guard,
    scaled,
    size,
    slip_guard,
    slip_of,
    stopping_guard,
)

LONGEST = 100.0
"""More of the clock -ln s than there is between any two speeds here."""


class Floats:
    """Sums of numbers."""

    def total(self, terms):
        return sum(terms)


def series(rule):
    return Series(rule, Floats())


def split(y):
    return tuple(y[:3]), tuple(y[3:6])


class Modes:
    """Motions and guards of a top that sticks and slips, made once."""

    def __init__(self, top, dimension):
        self.top, self.dimension = top, dimension

        def motion(rates, size):
            return Motion(lambda y, _: rates(y), size, 0)

        def guards(*values):
            return tuple(Guard(str(i), lambda y, _, v=v: v(y)) for i, v in enumerate(values))

        self.stick = motion(self.sticking, 6), guards(lambda y: slip_guard(*split(y), top))
        self.slide = motion(self.sliding, 6 + dimension), guards(self.stopping, self.normal)
        reopens = lambda y: reopening_guard(self.closing(y), top, HORIZON)  # noqa: E731
        self.close = [
            (
                motion(self.coming_to_rest, 8 + dimension),
                guards(reopens, lambda y, h=h: landing_guard(self.closing(y), top, h)),
            )
            for h in LANDING
        ]

    def sticking(self, y):
        point = ContactPoint.of(*split(y), self.top)
        return (
            *axis_rate(*split(y), self.top),
            *point.moment(contact_wrench(point, None, point.turning[:2])),
        )

    def sliding(self, y):
        creep = creep_rates(*split(y), tuple(y[6:]), self.top)
        return (*creep.axis, *creep.momentum, *creep.slip)

    def stopping(self, y):
        return stopping_guard(*split(y), tuple(y[6:]), self.top, HORIZON)

    def normal(self, y):
        return creep_rates(*split(y), tuple(y[6:]), self.top).wrench.force[2]

    def closing(self, y):
        d = self.dimension
        return Closing(*split(y), tuple(y[6 : 6 + d]), y[6 + d], y[7 + d])

    def coming_to_rest(self, y):
        r = closing_rates(self.closing(y), self.top)
        return (*r.axis, *r.momentum, *r.direction, r.speed, r.time)


class DryRun:
    """A top that sticks and slips, driven by an integrator; `events` are pairs of a name and a time."""

    def __init__(self, top, axis, momentum, velocity, integrator=None, order=12, error=1e-13):
        self.top, self.axis, self.momentum = top, axis, momentum
        self.slip = slip_of(axis, momentum, velocity, top)
        self.modes = Modes(top, len(self.slip))
        self.time, self.events = 0.0, []
        self.integrator = integrator or Taylor()
        self.order, self.error = order, error
        self.mode = self.stick if size(self.slip) == 0.0 else self.slide

    def follow(self, end, events=10**9):
        """Go on up to a time, or to a number of events."""
        while self.time < end and len(self.events) < events and self.mode is not None:
            self.mode(end)
        return self

    def times(self, name):
        return [time for event, time in self.events if event == name]

    def go(self, mode, start, end):
        """Integrate; return time and state at the end, and the guard that ended it."""
        motion, guards = mode
        arc = self.integrator.integrate(motion, (), (0.0, np.array(start)), end, np.array([0.0, end]), guards)
        assert arc.failure is None, arc.failure
        return arc.end_time, arc.end_state.tolist(), arc.guard

    def stick(self, end):
        if slip_guard(self.axis, self.momentum, self.top) < 0.0:
            self.start(1)
            return
        if len(self.slip) == 3:
            self.momentum = without_drilling(self.axis, self.momentum, self.top)
        self.events.append(("stick", self.time))
        time, y, guard = self.go(self.modes.stick, (*self.axis, *self.momentum), end - self.time)
        self.time += time
        self.axis, self.momentum = split(y)
        self.slip = (0.0,) * len(self.slip)
        if guard is not None:
            self.events.append(("slip", self.time))
            self.mode = lambda _: self.start(2)

    def start(self, power):
        direction, _ = direction_of_slip(self.axis, self.momentum, self.top)
        begin = onset((self.axis, self.momentum, direction), power, self.top, self.order, series)
        time = begin.valid_until(self.error)
        self.axis, self.momentum, self.slip = begin.at(time)
        self.time += time
        self.mode = self.slide

    def slide(self, end):
        start = (*self.axis, *self.momentum, *self.slip)
        self.mode = self.close
        if self.modes.stopping(start) <= 0.0:
            return
        time, y, ended = self.go(self.modes.slide, start, end - self.time)
        self.time += time
        self.axis, self.momentum = split(y)
        self.slip = tuple(y[6:])
        if ended == 1:
            self.events.append(("lift-off", self.time))
            self.mode = None

    def close(self, _):
        speed = size(self.slip)
        y = (*self.axis, *self.momentum, *scaled(1.0 / speed, self.slip), speed, self.time)
        for mode in self.modes.close:
            _, y, guard = self.go(mode, y, LONGEST)
            state, doubt = landed(self.modes.closing(y), self.top)
            if guard == 0:
                state = self.modes.closing(y)
            if guard == 0 or doubt < 1e-14:
                break
        self.axis, self.momentum, self.time = state.axis, state.momentum, state.time
        self.slip = scaled(state.speed, state.direction)
        self.mode = self.slide if guard == 0 else self.stick


def launched(top, tilt, spin, *, rests=False):
    """A launch at rest in tilt: without slip, or with the centre of mass at rest; natural units."""
    axis = (math.sin(tilt), 0.0, math.cos(tilt))
    momentum = tuple(top.axial_inertia * spin * x for x in axis)
    velocity = (0.0, 0.0) if rests else velocity_without_slip(axis, momentum, top)
    return top, axis, momentum, velocity
