"""The gap of a body in free flight as a function of time."""

# translate module: numbers

import math
from collections.abc import Sequence
from typing import NamedTuple

from tippetop.mechanics.flight.complex_disc import Disc
from tippetop.mechanics.flight.free_motion import SMALL, flight_rates, precession, swing
from tippetop.mechanics.roots import Triple, crossing
from tippetop.mechanics.series import Series, Sums
from tippetop.mechanics.state import State
from tippetop.mechanics.surfaces.surface import Surface
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Scalar

DEGREE = 16
"""Degree of the Taylor polynomial of the gap at the start of a flight."""

NARROWEST = 1e-7
"""Smallest radius of a disc that is tried, as an angle of the axis about L, rad.

Nearer to flat than that, the height of an edge is lost in rounding of c."""

ACROSS = 8.0 * NARROWEST
"""Angle of the axis about L that leads across flat, from where the discs are narrower than that,
rad.
"""

WIDEST = 4.0
"""Largest radius of a disc of complex time, as an angle of the axis about L, rad."""

CLEAR = 1e-9
"""How much higher than a body reaches its centre of mass is when it is clear of the table, in
sizes.
"""

INSIDE = 1.0 - 2.0**-53
"""Largest c below 1, where an edge has a slope."""


class Tip(NamedTuple):
    """Height c = n_z of the tip of the axis in free flight: its value, two derivatives, and
    frequency.
    """

    height: float
    rate: float
    acceleration: float
    frequency: float

    @classmethod
    def of(cls, state: State, top: Top) -> "Tip":
        """Return the tip in a free flight from a state on; of numbers, or arrays of them."""
        rate, second = flight_rates(state, top)
        return cls(state.axis[2], rate.axis[2], second.axis[2], precession(state, top) + SMALL)

    def at(self, time: float) -> Triple:
        """Height, rate and acceleration at a time: c'' turns into -w^2 c' and back."""
        square = self.frequency * self.frequency
        sine, versine = swing(self.frequency, time, math)
        cosine = 1.0 - square * versine
        return (
            min(max(self.height + self.rate * sine + self.acceleration * versine, -1.0), 1.0),
            self.rate * cosine + self.acceleration * sine,
            self.acceleration * cosine - self.rate * square * sine,
        )

    @property
    def period(self) -> float:
        """Time of a turn about the angular momentum."""
        return 2.0 * math.pi / self.frequency

    @property
    def range(self) -> tuple[float, float]:
        """Least and largest height, between the poles."""
        sway = self.acceleration / self.frequency**2
        mean, amplitude = self.height + sway, math.hypot(sway, self.rate / self.frequency)
        low, high = (min(max(c, -INSIDE), INSIDE) for c in (mean - amplitude, mean + amplitude))
        return low, high

    @property
    def terms(self) -> list[Scalar]:
        """Coefficients of the height in powers of time."""
        terms = [self.height, self.rate, 0.5 * self.acceleration]
        for j in range(1, DEGREE - 1):
            terms.append(-(self.frequency**2) * terms[j] / ((j + 1) * (j + 2)))
        return terms

    def spread(self, time: float, angle: float) -> float:
        """Largest |c - c(time)| for complex times within angle / frequency of a real one."""
        _, rate, acceleration = self.at(time)
        w = self.frequency
        return (
            abs(rate) * math.sinh(angle) / w + abs(acceleration) * (math.cosh(angle) - 1.0) / w**2
        )


class Separation(NamedTuple):
    """The gap as a function of time: a parabola less the support function at the tip's height."""

    tip: Tip
    shape: Surface
    parabola: Triple

    @classmethod
    def of(cls, state: State, top: Top) -> "Separation":
        """Return the gap of a free flight from a state on."""
        return cls(
            Tip.of(state, top), top.surface, (state.height, state.velocity[2], -0.5 * top.gravity)
        )

    def at(self, time: float) -> Triple:
        """Gap, its rate and its acceleration."""
        c, rate, acceleration = self.tip.at(time)
        try:
            slope, curvature = self.shape.slope(c), self.shape.curvature(c)
        except ArithmeticError:  # Flat on an edge, where the gap has a peak.
            slope = curvature = 0.0
        z, rise, fall = self.fall(time)
        return (
            z - self.shape.height(c),
            rise - slope * rate,
            fall - curvature * rate * rate - slope * acceleration,
        )

    def fall(self, time: float) -> Triple:
        """Height of the centre of mass, its rate and its acceleration."""
        p0, p1, p2 = self.parabola
        return p0 + time * (p1 + time * p2), p1 + 2.0 * time * p2, 2.0 * p2

    @property
    def level(self) -> float:
        """Height of the centre of mass above which the body touches nowhere on its way."""
        low, high = self.tip.range
        highest = max(self.shape.height(low), self.shape.height(high))
        if self.shape.slope(low) > 0.0 > self.shape.slope(high):
            highest = max(highest, self.shape.height(crossing(self.shape.slope, low, high)))
        return float(highest + CLEAR * self.shape.size)

    def clear_until(self, time: float, level: float) -> float:
        """Until when, from a time on, the centre of mass is above a level; the time itself if it is
        not.
        """
        z, rise, fall = self.fall(time)
        return time + falling_time(z - level, rise, 0.5 * fall) if z > level else time

    def across_flat(self, time: float, horizon: float) -> tuple[float, float | None]:
        """Past an edge that lies flat: until when, and when the table is touched meanwhile, if it
        is.
        """
        angle = ACROSS
        while self.at(time)[0] > 0.0:
            end = min(horizon, time + angle / self.tip.frequency)
            if self.at(end)[0] <= 0.0:
                return end, crossing(lambda t: self.at(t)[0], time, end)
            if end >= horizon or analytic_disc(self.tip, self.shape, end, 0.25, WIDEST) is not None:
                return end, None
            time, angle = end, 2.0 * angle
        return time, time


def support_terms(shape: Surface, tip: Sequence[Scalar], plain: Sums) -> list[Scalar]:
    """Coefficients of the support function in powers of time, by those of the tip's height."""
    height = shape.height(Series(lambda k: tip[k], plain))
    if isinstance(height, Series):
        return height.up_to(len(tip) - 1)
    # It is the same number at any tilt.
    return [0.0 * tip[0] + height, *[0.0 * term for term in tip[1:]]]


class Opening(NamedTuple):
    """A polynomial in time: the gap at the start of a flight, divided by the power of time that it
    has.
    """

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
        """Return a bound on the third derivative up to this time."""
        bound = 0.0
        for j in range(len(self.terms) - 1, 2, -1):
            bound = bound * time + j * (j - 1) * (j - 2) * abs(self.terms[j])
        return bound


def analytic_disc(
    tip: Tip, shape: Surface, time: float, ahead: float, angle: float
) -> tuple[float, float] | None:
    """Radius of a disc of time centred `ahead` radii after `time` where h(c) is analytic, and of
    h(c).

    None where it would be too narrow: an edge lies flat there, or almost.
    """
    while angle >= NARROWEST:
        radius = angle / tip.frequency
        centre = time + ahead * radius
        try:
            c = Disc(tip.at(centre)[0], tip.spread(centre, angle))
            height = shape.height(c)
            return radius, float(height.radius) if isinstance(height, Disc) else 0.0
        except ArithmeticError:
            angle *= 0.5
    return None


def falling_time(height: float, rate: float, half: float) -> float:
    """Time after which height + rate t + half t^2 stays negative; infinite where it never does."""
    root = math.sqrt(max(rate * rate - 4.0 * half * height, 0.0))
    if rate > 0.0:
        return -(rate + root) / (2.0 * half) if half < 0.0 else math.inf
    return 2.0 * height / (root - rate) if root > rate else math.inf
