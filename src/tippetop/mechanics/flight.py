"""Free flight of a body of revolution in closed form, and the instant it ends.

In flight the angular momentum L is constant, the axis n turns about it at the constant rate L / I1, and the
centre of mass falls (Landau and Lifshitz, Mechanics, sections 33 and 35). The body turns with omega = L / I1
+ s n, where s is constant and n turns with L / I1: its rotation is the one about the initial axis by s t,
followed by the one about L by |L| t / I1.
"""

import math
from collections.abc import Callable
from enum import IntEnum
from operator import mul
from typing import Any, NamedTuple, Self, TypeAlias

from tippetop.mechanics.motion import along_table, angular_velocity, axis_rate, on_table
from tippetop.mechanics.shape import Shape
from tippetop.mechanics.state import State
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Functions, Scalar, Vector, add, cross, length, scale

SMALL = 1e-100
"""Added to a rate or an angle that is about to divide: changes nothing but 0 / 0."""

DEGREE = 16
"""Degree of the Taylor polynomial of the gap at the start of a flight."""

START = 10.0 ** (-16.0 / (DEGREE + 1))
"""Fraction of its disc on which that polynomial is used: its tail is below round-off there."""

WIDEST = 4.0
"""Largest radius of a disc of complex time, as an angle of the axis about L, rad."""

NARROWEST = 1e-9
"""Smallest such radius that is tried, rad."""

FINEST = 1e-10
"""Step, relative to its piece, below which a gap that is neither open nor closing counts as closed."""

Triple: TypeAlias = tuple[float, float, float]
"""A function's value and its first two derivatives."""


def fly(state: State, elapsed: Scalar, top: Top, functions: Functions) -> State:
    """The state after a time of free flight.

    Parameters
    ----------
    state
        The state at the start.
    elapsed
        Time since then, s: a number, or an array of them, whose shape every number of the result then has.
    top
        The body and gravity.
    functions
        Where sin and cos come from: `math`, `numpy`, ...
    """
    precession = scale(1.0 / top.transverse_inertia, state.momentum)
    spinning = add(angular_velocity(state.axis, state.momentum, top), scale(-1.0, precession))
    marker = turned(state.marker, spinning, elapsed, functions)
    still = (0.0 * elapsed, 0.0 * elapsed, 0.0 * elapsed)
    falling = (0.0 * elapsed, 0.0 * elapsed, -top.gravity * elapsed)
    return State(
        axis=turned(state.axis, precession, elapsed, functions),
        momentum=add(state.momentum, still),
        velocity=add(state.velocity, falling),
        position=add(state.position, scale(elapsed, add(state.velocity, scale(0.5, falling)))),
        marker=turned(marker, precession, elapsed, functions),
        work=state.work + 0.0 * elapsed,
    )


def turned(vector: Vector, rate: Vector, elapsed: Scalar, functions: Functions) -> Vector:
    """A vector after turning for a time with a constant angular velocity (rad/s), which may be zero."""
    half = 0.5 * elapsed * length(rate) + SMALL
    pivot = scale(0.5 * elapsed * functions.sin(half) / half, rate)
    swung = cross(pivot, vector)
    return add(vector, scale(2.0, add(scale(functions.cos(half), swung), cross(pivot, swung))))


def gap(state: State, top: Top) -> Scalar:
    """Height of the lowest point of the body above the table, z - h(n_z), m."""
    return state.position[2] - on_table(along_table(state), top).position[2]


def gap_rate(state: State, top: Top) -> Scalar:
    """Rate of change of the gap, m/s: the vertical velocity of the body's lowest point."""
    return state.velocity[2] - on_table(along_table(state), top).velocity[2]


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

    Notes
    -----
    The gap is G(t) = z + v t - g t^2/2 - h(c(t)), where the height c of the axis's tip is a sine in time.

    *Start.* On a first interval G is its Taylor polynomial of degree 16, made by arithmetic of truncated
    power series on h and divided by t^k, where k coefficients vanish: what remains is free of cancellation,
    and has a simple root even for hops of picoseconds. After it, G is evaluated directly.

    *Bounds.* On a disc of complex time of radius rho, c stays in a disc that is known, and arithmetic of
    discs on h gives a disc of some radius r for h(c). By Cauchy's estimate, |G'''| <= 6 r / (rho^3 (1 - q)^4)
    within q rho of its centre. For the first polynomial the same estimate bounds the tail, below 2e-16 r.

    *Search.* With G, G', G'' at t and that bound on G''', a step [t, t + s] is passed only if the cubic below
    G is positive on it, or if G is surely falling or surely concave on it and positive at its end. If it is
    falling or concave, and not positive at its end, the step holds exactly one root, which is the first: it
    is found by bracketing. Otherwise s is halved. So no touch is passed over and none is invented, up to
    round-off: the gap is known within about 1e-16 of h, and a graze nearer than that counts as a touch. Any
    shape will do that is written in plain operators and is analytic on [-1, 1].
    """
    turning = axis_rate(state.axis, state.momentum, top)
    tip = Tip(
        state.axis[2],
        turning[2],
        axis_rate(turning, state.momentum, top)[2],
        length(scale(1.0 / top.transverse_inertia, state.momentum)) + SMALL,
    )
    ballistic = (state.position[2], state.velocity[2], -0.5 * top.gravity)
    horizon = min(horizon, 2.0 * falling_time(*ballistic))
    time = 0.0
    if start != Start.AIRBORNE:
        support = (top.shape.height(tip.series()) + 0.0 * tip.series()).terms
        ballistic = (*support[:start], *ballistic[start:])
        terms = [-term for term in support]
        terms[start:3] = [b - s for b, s in zip(ballistic[start:], support[start:3], strict=True)]
        opening = Opening(terms[next((j for j in range(start, DEGREE) if terms[j]), DEGREE) :])
        time = min(horizon, START * Disc.of_time(tip, top.shape, 0.0, 0.0, WIDEST)[0])
        root = first_root(opening.at, 0.0, time, opening.jerk_bound(time))
        if root is not None:
            return root

    separation = Separation(tip, top.shape, ballistic)
    angle = WIDEST
    while time < horizon:
        radius, spread = Disc.of_time(tip, top.shape, time, 0.25, angle)
        angle = min(WIDEST, 2.0 * radius * tip.frequency)
        end = min(horizon, time + 0.5 * radius)
        root = first_root(separation.at, time, end, 6.0 * spread / (0.75**4 * radius**3))
        if root is not None:
            return root
        time = end
    return None


def falling_time(height: float, rate: float, half: float) -> float:
    """Time after which height + rate t + half t^2 stays negative, infinite if half is not negative."""
    if half >= 0.0:
        return math.inf
    return -(rate + math.sqrt(max(rate * rate - 4.0 * half * height, 0.0))) / (2.0 * half)


class Tip(NamedTuple):
    """Height c = n_z of the tip of the axis in free flight: its value, two derivatives, and frequency."""

    height: float
    rate: float
    acceleration: float
    frequency: float

    def at(self, time: float) -> Triple:
        """Height, rate and acceleration at a time: c'' turns into -w^2 c' and back."""
        w = self.frequency
        cosine, sine, half = math.cos(w * time), math.sin(w * time) / w, math.sin(0.5 * w * time) / w
        return (
            self.height + self.rate * sine + 2.0 * self.acceleration * half * half,
            self.rate * cosine + self.acceleration * sine,
            self.acceleration * cosine - self.rate * w * w * sine,
        )

    def series(self) -> "Series":
        """Height as a power series in time."""
        terms = [self.height, self.rate, 0.5 * self.acceleration]
        for j in range(1, DEGREE - 1):
            terms.append(-(self.frequency**2) * terms[j] / ((j + 1) * (j + 2)))
        return Series(terms)

    def spread(self, time: float, angle: float) -> float:
        """Largest |c - c(time)| for complex times within angle / frequency of a real one."""
        _, rate, acceleration = self.at(time)
        w = self.frequency
        return abs(rate) * math.sinh(angle) / w + abs(acceleration) * (math.cosh(angle) - 1.0) / w**2


class Separation(NamedTuple):
    """The gap as a function of time: a parabola less the support function at the tip's height."""

    tip: Tip
    shape: Shape
    parabola: Triple

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


def first_root(function: Callable[[float], Triple], low: float, high: float, jerk: float) -> float | None:
    """First root from `low` to `high`, or `low` if not positive there; `jerk` bounds the third derivative."""
    time, step, finest = low, high - low, FINEST * (high - low)
    value, rate, acceleration = function(time)
    while value > 0.0:
        step = min(step, high - time)
        end = high if step == high - time else time + step
        positive = stays_positive(value, rate, acceleration, jerk, step)
        if positive or is_one_way(rate, acceleration, jerk, step):
            if end == high and positive:
                return None
            later = function(end)
            if later[0] <= 0.0 and not positive:
                return crossing(lambda t: function(t)[0], time, end)
            if end == high and later[0] > 0.0:
                return None
            time, step = end, 2.0 * step
            value, rate, acceleration = later
        else:
            step *= 0.5
            if step < finest:
                break
    return time


def stays_positive(value: float, rate: float, acceleration: float, jerk: float, step: float) -> bool:
    """Whether value + rate s + acceleration s^2/2 - jerk s^3/6 is positive for all s in [0, step]."""

    def cubic(s: float) -> float:
        return value + s * (rate + s * (acceleration / 2.0 - s * jerk / 6.0))

    if cubic(step) <= 0.0:
        return False
    discriminant = acceleration * acceleration + 2.0 * jerk * rate
    if rate >= 0.0 or acceleration <= 0.0 or discriminant <= 0.0:
        return True
    dip = -2.0 * rate / (acceleration + discriminant**0.5)
    return dip >= step or cubic(dip) > 0.0


def is_one_way(rate: float, acceleration: float, jerk: float, step: float) -> bool:
    """Whether a function surely falls, or surely is concave, all along a step: it has one root at most."""
    falls = rate < 0.0 and rate + step * (acceleration + 0.5 * step * jerk) < 0.0
    return falls or acceleration + step * jerk < 0.0


def crossing(function: Callable[[float], float], low: float, high: float) -> float:
    """Root of a function between two points where its signs differ, by the method of Chandrupatla (1997)."""
    x1, x2, part = high, low, 0.5
    y1, y2 = function(x1), function(x2)
    if y1 == 0.0 or y2 == 0.0:
        return x2 if y2 == 0.0 else x1
    best = x1
    for _ in range(400):
        x = x1 + part * (x2 - x1)
        y = function(x)
        if (y > 0.0) == (y1 > 0.0):
            x3, y3 = x1, y1
        else:
            x3, y3, x2, y2 = x2, y2, x1, y1
        x1, y1 = x, y
        best = x1 if abs(y1) < abs(y2) else x2
        fuzz = 2.3e-16 * abs(best) / abs(x2 - x1)
        if fuzz > 0.5 or y == 0.0:
            break
        xi, phi = (x1 - x2) / (x3 - x2), (y1 - y2) / (y3 - y2)
        part = 0.5
        if phi * phi < xi and (1.0 - phi) ** 2 < 1.0 - xi:
            part = y1 / (y2 - y1) * y3 / (y2 - y3)
            part += (x3 - x1) / (x2 - x1) * y1 / (y3 - y1) * y2 / (y3 - y2)
        part = min(max(part, fuzz), 1.0 - fuzz)
    return best


class Algebra:
    """Arithmetic that follows from a sum, a product and a power, for whatever a shape may be evaluated on."""

    def __add__(self, other: Any) -> Self:
        raise NotImplementedError

    def __mul__(self, other: Any) -> Self:
        raise NotImplementedError

    def power(self, exponent: float) -> Self:
        """A power that is not a natural number."""
        raise NotImplementedError

    def __pow__(self, exponent: float) -> Self:
        if exponent < 1 or exponent != int(exponent):
            return self.power(exponent)
        return self if exponent == 1 else self * self ** (exponent - 1)

    def __neg__(self) -> Self:
        return self * -1.0

    def __sub__(self, other: Any) -> Self:
        return self.__add__(-other)

    def __truediv__(self, other: Any) -> Self:
        return self.__mul__(other**-1.0)

    def __radd__(self, other: float) -> Self:
        return self + other

    def __rsub__(self, other: float) -> Self:
        return -self + other

    def __rmul__(self, other: float) -> Self:
        return self * other

    def __rtruediv__(self, other: float) -> Self:
        return self**-1.0 * other


class Series(Algebra):
    """A power series in time, truncated after the degree of all others."""

    def __init__(self, terms: list[float]) -> None:
        self.terms = terms

    def __add__(self, other: Any) -> "Series":
        if isinstance(other, Series):
            return Series([a + b for a, b in zip(self.terms, other.terms, strict=True)])
        return Series([self.terms[0] + other, *self.terms[1:]])

    def __mul__(self, other: Any) -> "Series":
        a = self.terms
        if isinstance(other, Series):
            b = other.terms[::-1]
            last = len(a) - 1
            return Series([sum(map(mul, a, b[last - k :])) for k in range(last + 1)])
        return Series([other * term for term in a])

    def power(self, exponent: float) -> "Series":
        """A real power, term by term from y' a = exponent a' y."""
        a, y = self.terms, [self.terms[0] ** exponent]
        for k in range(1, len(a)):
            total = sum(((exponent + 1.0) * j - k) * a[j] * y[k - j] for j in range(1, k + 1))
            y.append(total / (k * a[0]))
        return Series(y)


class Disc(Algebra):
    """All complex numbers within a radius of a real centre, and what arithmetic can make of them."""

    def __init__(self, centre: float, radius: float) -> None:
        self.centre, self.radius = centre, radius

    @classmethod
    def of_time(cls, tip: Tip, shape: Shape, time: float, ahead: float, angle: float) -> tuple[float, float]:
        """Radius of a disc of time centred `ahead` radii after `time` where h(c) is analytic, and of h(c)."""
        while True:
            radius = angle / tip.frequency
            centre = time + ahead * radius
            try:
                c = cls(tip.at(centre)[0], tip.spread(centre, angle))
                return radius, float((shape.height(c) + 0.0 * c).radius)
            except ArithmeticError:
                angle *= 0.5
                if angle < NARROWEST:
                    raise

    def __add__(self, other: Any) -> "Disc":
        if isinstance(other, Disc):
            return Disc(self.centre + other.centre, self.radius + other.radius)
        return Disc(self.centre + other, self.radius)

    def __mul__(self, other: Any) -> "Disc":
        if isinstance(other, Disc):
            far = abs(other.centre) + other.radius
            return Disc(self.centre * other.centre, abs(self.centre) * other.radius + self.radius * far)
        return Disc(self.centre * other, self.radius * abs(other))

    def power(self, exponent: float) -> "Disc":
        """A real power, by the mean value theorem; the disc must lie right of zero for it to be analytic."""
        near, far = self.centre - self.radius, self.centre + self.radius
        if near <= 0.0:
            raise ArithmeticError("a power of a disc that touches zero")
        steepest = max(near ** (exponent - 1.0), far ** (exponent - 1.0))
        return Disc(self.centre**exponent, self.radius * abs(exponent) * steepest)
