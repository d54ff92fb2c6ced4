"""The instant at which a free flight ends."""

import math
from enum import IntEnum
from typing import NamedTuple

from tippetop.mechanics.algebra import Disc, TruncatedSeries
from tippetop.mechanics.flight import SMALL
from tippetop.mechanics.motion import axis_rate
from tippetop.mechanics.roots import Triple, crossing, first_root
from tippetop.mechanics.state import State
from tippetop.mechanics.surface import Surface
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import length, scale

DEGREE = 16
"""Degree of the Taylor polynomial of the gap at the start of a flight."""

START = 10.0 ** (-16.0 / (DEGREE + 1))
"""Fraction of its disc on which that polynomial is used: its tail is below round-off there."""

WIDEST = 4.0
"""Largest radius of a disc of complex time, as an angle of the axis about L, rad."""

NARROWEST = 1e-9
"""Smallest such radius that is tried, rad."""

LOOKS = 10.0
"""Looks for the highest gap per radian that the axis turns; between them, its rate is searched for a zero."""

MOST_LOOKS = 1000
"""Such looks at most."""

MOST_DISCS = 100_000
"""Discs after which the search is given up, within some seconds; most flights take some ten."""


class Start(IntEnum):
    """How a flight starts: how many of gap, gap rate and gap acceleration are then zero by construction."""

    AIRBORNE = 0
    REBOUND = 1
    RELEASE = 2
    LIFT_OFF = 3


def touchdown(state: State, top: Top, horizon: float, start: Start = Start.AIRBORNE) -> float | None:
    """Time of the first touch of the table after the start of a flight, s.

    Parameters
    ----------
    state
        The state at the start, floats.
    top
        The body and gravity, floats.
    horizon
        How far to look, s; it may be infinite if there is gravity.
    start
        What vanishes at the start: nothing (the gap is positive), the gap (a rebound), its rate too (a body
        that is let go on the table), or its acceleration too (lift-off, where the normal force reaches zero).
        What vanishes is taken as exactly zero, so that round-off in `state` can neither end a flight at once
        nor lengthen it.

    Returns
    -------
    float or None
        The time, 0.0 if the body penetrates the table at once, None if it touches nowhere in (0, horizon].

    Raises
    ------
    ArithmeticError
        If the body turns so often meanwhile that the search would take too long.

    Notes
    -----
    The gap is G(t) = z + v t - g t^2/2 - h(c(t)), where the height c of the axis's tip is a sine in time.

    *Start.* On a first interval G is its Taylor polynomial of degree 16, made by arithmetic of truncated
    power series on h and divided by t^k, where k coefficients vanish: what remains is free of cancellation,
    and has a simple root even for flights of picoseconds. After it, G is evaluated directly.

    *Bounds.* On a disc of complex time of radius rho, c stays in a disc that is known, and arithmetic of
    discs on h gives a disc of some radius r for h(c). By Cauchy's estimate, |G'''| <= 6 r / (rho^3 (1 - q)^4)
    within q rho of its centre. For the first polynomial the same estimate bounds the tail, below 2e-16 r.

    *Horizon.* A body of revolution reaches at least as low as the lower of the ends of its axis, h(c) >= |c|
    h(+-1): it has touched by the time at which the centre of mass falls as deep as that.

    *Search.* With G, G', G'' at t and that bound on G''', a step [t, t + s] is passed only if the cubic below
    G is positive on it, or if G is surely falling or surely concave on it and positive at its end. If it is
    falling or concave, and not positive at its end, the step holds exactly one root, which is the first: it
    is found by bracketing. Otherwise s is halved. So no touch is passed over and none is invented, up to
    round-off: the gap is known within about 1e-16 of h, and a graze nearer than that counts as a touch. Any
    shape will do that is written in plain operators and is analytic on [-1, 1].
    """
    tip, _, ballistic = Separation.of(state, top)
    deepest = min(0.0, *(float(top.surface.height(c)) for c in (-1.0, 1.0)))
    horizon = min(horizon, 2.0 * falling_time(ballistic[0] - deepest, *ballistic[1:]))
    time = 0.0
    if start != Start.AIRBORNE:
        support = (top.surface.height(tip.series()) + 0.0 * tip.series()).terms
        ballistic = (*support[:start], *ballistic[start:])
        terms = [b - s for b, s in zip(ballistic, support[:3], strict=True)] + [-s for s in support[3:]]
        opening = Opening(terms[next((j for j in range(start, DEGREE) if terms[j]), DEGREE) :])
        time = min(horizon, START * analytic_disc(tip, top.surface, 0.0, 0.0, WIDEST)[0])
        root = first_root(opening.at, 0.0, time, opening.jerk_bound(time))
        if root is not None:
            return root

    separation = Separation(tip, top.surface, ballistic)
    angle = WIDEST
    for _ in range(MOST_DISCS):
        if time >= horizon:
            return None
        radius, spread = analytic_disc(tip, top.surface, time, 0.25, angle)
        angle = min(WIDEST, 2.0 * radius * tip.frequency)
        end = min(horizon, time + 0.5 * radius)
        root = first_root(separation.at, time, end, 6.0 * spread / (0.75**4 * radius**3))
        if root is not None:
            return root
        time = end
    raise ArithmeticError("a flight turns too often for its end to be found")


def falling_time(height: float, rate: float, half: float) -> float:
    """Time after which height + rate t + half t^2 stays negative, infinite if half is not negative."""
    if half >= 0.0:
        return math.inf
    return -(rate + math.sqrt(max(rate * rate - 4.0 * half * height, 0.0))) / (2.0 * half)


def highest_gap(state: State, top: Top, duration: float) -> float:
    """The highest gap of a free flight that lasts some time, s; floats."""
    gap, *others = (Separation.of(state, one).at for one in top.each)
    if others:
        everywhere = (gap, *others)

        def gap(time: float) -> Triple:
            return min(at(time) for at in everywhere)

    count = min(MOST_LOOKS, 2 + int(LOOKS * duration * length(state.momentum) / top.transverse_inertia))
    times = [duration * j / count for j in range(count + 1)]
    gaps = [gap(time)[0] for time in times]
    best = max(range(count + 1), key=gaps.__getitem__)
    if gap(times[best])[1] > 0.0:
        low, high = times[best], times[min(best + 1, count)]
    else:
        # At the start of a flight the rate may vanish too.
        low, high = max(times[max(best - 1, 0)], 1e-3 * times[1]), times[best]
    if not gap(low)[1] > 0.0 > gap(high)[1]:
        return gaps[best]
    return max(gaps[best], gap(crossing(lambda time: gap(time)[1], low, high))[0])


class Tip(NamedTuple):
    """Height c = n_z of the tip of the axis in free flight: its value, two derivatives, and frequency."""

    height: float
    rate: float
    acceleration: float
    frequency: float

    @classmethod
    def of(cls, state: State, top: Top) -> "Tip":
        """The tip in a free flight from a state on; of numbers, or arrays of them."""
        turning = axis_rate(state.axis, state.momentum, top)
        return cls(
            state.axis[2],
            turning[2],
            axis_rate(turning, state.momentum, top)[2],
            length(scale(1.0 / top.transverse_inertia, state.momentum)) + SMALL,
        )

    def at(self, time: float) -> Triple:
        """Height, rate and acceleration at a time: c'' turns into -w^2 c' and back."""
        w = self.frequency
        cosine, sine, half = math.cos(w * time), math.sin(w * time) / w, math.sin(0.5 * w * time) / w
        return (
            self.height + self.rate * sine + 2.0 * self.acceleration * half * half,
            self.rate * cosine + self.acceleration * sine,
            self.acceleration * cosine - self.rate * w * w * sine,
        )

    def series(self) -> TruncatedSeries:
        """Height as a power series in time."""
        terms = [self.height, self.rate, 0.5 * self.acceleration]
        for j in range(1, DEGREE - 1):
            terms.append(-(self.frequency**2) * terms[j] / ((j + 1) * (j + 2)))
        return TruncatedSeries(terms)

    def spread(self, time: float, angle: float) -> float:
        """Largest |c - c(time)| for complex times within angle / frequency of a real one."""
        _, rate, acceleration = self.at(time)
        w = self.frequency
        return abs(rate) * math.sinh(angle) / w + abs(acceleration) * (math.cosh(angle) - 1.0) / w**2


class Separation(NamedTuple):
    """The gap as a function of time: a parabola less the support function at the tip's height."""

    tip: Tip
    shape: Surface
    parabola: Triple

    @classmethod
    def of(cls, state: State, top: Top) -> "Separation":
        """The gap of a free flight from a state on."""
        return cls(Tip.of(state, top), top.surface, (state.height, state.velocity[2], -0.5 * top.gravity))

    def at(self, time: float) -> Triple:
        """Gap, its rate and its acceleration."""
        p0, p1, p2 = self.parabola
        c, rate, acceleration = self.tip.at(time)
        slope = self.shape.slope(c)
        return (
            p0 + time * (p1 + time * p2) - self.shape.height(c),
            p1 + 2.0 * time * p2 - slope * rate,
            2.0 * p2 - self.shape.curvature(c) * rate * rate - slope * acceleration,
        )


class Opening(NamedTuple):
    """A polynomial in time: the gap at the start of a flight, divided by the power of time that it has."""

    terms: list[float]

    def at(self, time: float) -> Triple:
        """Value and first two derivatives, by Horner's rule."""
        value = rate = half = 0.0
        for term in reversed(self.terms):
            half = half * time + rate
            rate = rate * time + value
            value = value * time + term
        return value, rate, 2.0 * half

    def jerk_bound(self, time: float) -> float:
        """A bound on the third derivative up to this time."""
        bound = 0.0
        for j in range(len(self.terms) - 1, 2, -1):
            bound = bound * time + j * (j - 1) * (j - 2) * abs(self.terms[j])
        return bound


def analytic_disc(tip: Tip, shape: Surface, time: float, ahead: float, angle: float) -> tuple[float, float]:
    """Radius of a disc of time centred `ahead` radii after `time` where h(c) is analytic, and of h(c)."""
    while True:
        radius = angle / tip.frequency
        centre = time + ahead * radius
        try:
            c = Disc(tip.at(centre)[0], tip.spread(centre, angle))
            return radius, float((shape.height(c) + 0.0 * c).radius)
        except ArithmeticError:
            angle *= 0.5
            if angle < NARROWEST:
                raise
