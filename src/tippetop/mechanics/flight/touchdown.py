"""The instant at which a free flight ends.

The gap is G(t) = z + v t - g t^2/2 - h(c(t)), where the height c of the axis's tip is a sine in
time.

*Start.* On a first interval G is its Taylor polynomial of degree 16, made by arithmetic of
truncated power series on h and divided by t^k, where k coefficients vanish: what remains is free of
cancellation, and has a simple root even for flights of picoseconds. After it, G is evaluated
directly.

*Bounds.* On a disc of complex time of radius rho, c stays in a disc that is known, and arithmetic
of discs on h gives a disc of some radius r for h(c). By Cauchy's estimate, |G'''| <= 6 r / (rho^3
(1 - q)^4) within q rho of its centre. For the first polynomial the same estimate bounds the tail,
below 2e-16 r.

*Horizon.* A body of revolution reaches at least as low as the lower of the ends of its axis, h(c)
>= |c| h(+-1): it has touched by the time at which the centre of mass falls as deep as that.

*Turns.* While the centre of mass is higher than the largest h(c) on the way there is nothing to
search. The tip is back after every turn about L. So the search takes little more than the first
turn and the last one, however many there are: within one the body touches, or its centre of mass
passes that height.

*Flat.* Where the tip passes a pole, the h of an edge has a kink, and no disc is wide enough. Every
point of the body moves on a sine, and the gap is the least of their heights, so that G'' is bounded
from above, whatever the shape: over an angle so small, G is nowhere below both its ends by more
than rounding. Where that angle leads to no other height, as in a body that stays flat, it is
doubled.

*Search.* With G, G', G'' at t and that bound on G''', a step [t, t + s] is passed only if the cubic
below G is positive on it, or if G is surely falling or surely concave on it and positive at its
end. If it is falling or concave, and not positive at its end, the step holds exactly one root,
which is the first: it is found by bracketing. Otherwise s is halved. So no touch is passed over and
none is invented, up to round-off: the gap is known within about 1e-16 of h, and a graze nearer than
that counts as a touch. Any shape will do that is written in plain operators and is analytic on [-1,
1].
"""

# translate module: numbers

from enum import IntEnum

from tippetop.mechanics.flight.separation import (
    DEGREE,
    WIDEST,
    Opening,
    Separation,
    Tip,
    analytic_disc,
    falling_time,
    support_terms,
)
from tippetop.mechanics.roots import Triple, crossing, first_root
from tippetop.mechanics.series import PLAIN
from tippetop.mechanics.state import State
from tippetop.mechanics.surfaces.surface import Surface
from tippetop.mechanics.top import Top
from tippetop.mechanics.unsolved import Unsolved

START = 10.0 ** (-16.0 / (DEGREE + 1))
"""Fraction of its disc on which that polynomial is used: its tail is below round-off there."""

PROBES_PER_RADIAN = 10.0
"""Instants per radian that the axis turns at which the gap is evaluated for its highest value;
where its rate falls through zero between two, that zero is found.
"""

MOST_DISCS = 100_000
"""How many discs a flight is searched in at most: one that all but grazes the table may need any
number.
"""

TURNS_LOST = "the body turns so often that its turns are lost in rounding of time"
"""Why no touch of the table is found where a step of time is shorter than its rounding."""


class Start(IntEnum):
    """How a flight starts: how many of gap, gap rate and gap acceleration are then zero by
    construction.
    """

    AIRBORNE = 0
    REBOUND = 1
    RELEASE = 2
    LIFT_OFF = 3


def touchdown(
    state: State, top: Top, horizon: float, start: Start = Start.AIRBORNE
) -> float | None:
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
        What vanishes at the start: nothing (the gap is positive), the gap (a rebound), its rate too
        (a body that is let go on the table), or its acceleration too (lift-off, where the normal
        force reaches zero). What vanishes is taken as exactly zero, so that round-off in `state`
        can neither end a flight at once nor lengthen it.

    Returns
    -------
    float or None
        The time, 0.0 if the body penetrates the table at once, None if it touches nowhere in (0,
        horizon].

    Raises
    ------
    ArithmeticError
        If the body turns so often until then that its turns are lost in rounding of time, or too
        often near the table.
    """
    tip, _, ballistic = Separation.of(state, top)
    deepest = min(0.0, *(float(top.surface.height(c)) for c in (-1.0, 1.0)))
    horizon = min(horizon, 2.0 * falling_time(ballistic[0] - deepest, *ballistic[1:]))
    time = 0.0
    if start != Start.AIRBORNE:
        opening, ballistic, length = first_interval(tip, top.surface, ballistic, start)
        time = min(horizon, length)
        root = first_root(opening.at, 0.0, time, opening.jerk_bound(time))
        if root is not None:
            return root

    separation = Separation(tip, top.surface, ballistic)
    level, angle = separation.level, WIDEST
    for _ in range(MOST_DISCS):
        time = separation.clear_until(time, level)
        if time >= horizon:
            return None
        disc = analytic_disc(tip, top.surface, time, 0.25, angle)
        if disc is None:
            end, root = separation.across_flat(time, horizon)
        else:
            radius, spread = disc
            angle, end = (
                min(WIDEST, 2.0 * radius * tip.frequency),
                min(horizon, time + 0.5 * radius),
            )
            if end <= time and separation.at(time)[0] > 0.0:
                raise Unsolved(TURNS_LOST)
            root = first_root(separation.at, time, end, 6.0 * spread / (0.75**4 * radius**3))
        if root is not None:
            return root
        if end <= time:
            raise Unsolved(TURNS_LOST)
        time = end
    raise Unsolved("the body turns too often so near the table")


def first_interval(
    tip: Tip, surface: Surface, ballistic: Triple, start: Start
) -> tuple[Opening, Triple, float]:
    """Return the gap on the first interval, the flight without its vanishing terms, and the
    interval's length, s.
    """
    disc = analytic_disc(tip, surface, 0.0, 0.0, WIDEST)
    if disc is None:
        raise Unsolved("the body lies flat at its start, where no one point is lowest")
    support = support_terms(surface, tip.terms, PLAIN)
    ballistic = (*support[:start], *ballistic[start:])
    terms = [b - s for b, s in zip(ballistic, support[:3], strict=True)] + [-s for s in support[3:]]
    opening = Opening(terms[next((j for j in range(start, DEGREE) if terms[j]), DEGREE) :])
    return opening, ballistic, START * disc[0]


def highest_gap(state: State, top: Top, duration: float) -> float:
    """Return the highest gap of a free flight that lasts some time, s; floats.

    It is no further from the summit than the axis takes for a turn: a turn nearer the gap is
    larger.
    """
    everywhere = [Separation.of(state, one) for one in top.each]
    tip = everywhere[0].tip

    def lowest(time: float) -> Triple:
        return min(one.at(time) for one in everywhere)

    gap = everywhere[0].at if len(everywhere) == 1 else lowest
    summit = min(max(state.velocity[2] / top.gravity, 0.0), duration)
    first, last = max(summit - tip.period, 0.0), min(summit + tip.period, duration)
    count = 2 + int(PROBES_PER_RADIAN * (last - first) * tip.frequency)
    step = (last - first) / count
    # At the start of a flight the rate may vanish.
    times = [first + step * max(j, 1e-3) for j in range(count + 1)]
    rows = [gap(time) for time in times]
    highest = max([gap(first)[0], *(height for height, _, _ in rows)])
    for j in range(count):
        if rows[j][1] > 0.0 > rows[j + 1][1]:
            highest = max(
                highest, gap(crossing(lambda time: gap(time)[1], times[j], times[j + 1]))[0]
            )
    return highest
