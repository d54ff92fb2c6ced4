"""Nutation of an eccentric sphere on a smooth table: constants, turning points and amplitudes.

Without friction L_z, L3 = L.n and the energy are constant, and the tilt swings between two turning
points. In units of mass, radius and gravity, with p = 1 - cos(theta), q = L_z - L3 and e the energy
above that of the axial spin and of theta = 0,

    (I1 + alpha^2 s^2) p'^2 / 2 = s^2 (e - alpha p) - (q + L3 p)^2 / (2 I1) = alpha (p - p1)(p2 -
    p)(p3 - p),

with s^2 = p (2 - p) and p1 <= p2 <= 2 <= p3. The substitution p = (p1 + p2)/2 + (p2 - p1)/2
cos(psi) makes time a smooth function of the phase psi down to p1 = p2, and averages over a nutation
converge exponentially with equidistant phases.

The tilt swings as if the axis were the sum of a fast and a slow circular motion, as it is near
theta = 0: sin(theta/2) at the turning points is the sum and the difference of two amplitudes, whose
squares are named `fast` and `slow`. These coordinates are regular where one of them vanishes (a
steady precession on a smooth table) and where they are equal (a nutation through the vertical), and
near theta = 0 friction makes them grow or decay exponentially.
"""

import math
from typing import NamedTuple, Self

import numpy as np

from tippetop.mechanics.invariants import energy
from tippetop.mechanics.motion import axial_spin, on_table
from tippetop.mechanics.state import SlidingState
from tippetop.mechanics.top import Top, natural_units
from tippetop.mechanics.vectors import Functions, Scalar, Vector
from tippetop.mechanics.view import Angles
from tippetop.theory.groups import eccentricity
from tippetop.theory.requirements import require_sphere


class Constants(NamedTuple):
    """Constants of a nutation on a smooth table."""

    vertical: Scalar
    axial: Scalar
    """Angular momentum about the vertical, L_z, and about the axis, L3, kg m^2/s."""
    energy: Scalar
    """Energy without the horizontal motion of the centre of mass, J."""


class Numbers(NamedTuple):
    """Dimensionless numbers of an eccentric sphere: inertias in m R^2, and alpha."""

    transverse: float
    axial: float
    alpha: float

    @property
    def turned(self) -> Self:
        """Numbers of the same top with its axis reversed: -alpha for alpha."""
        return self._replace(alpha=-self.alpha)


class Orbit(NamedTuple):
    """Nutation on a smooth table, in units of mass, radius and gravity."""

    middle: Scalar
    half: Scalar
    """(p1 + p2)/2 and (p2 - p1)/2 of the turning points p = 1 - cos(theta)."""
    far: Scalar
    """The third root p3."""
    excess: Scalar
    """q = L_z - L3."""
    axial: Scalar
    """L3."""
    swing: Scalar
    """e, the energy less that of the axial spin and of theta = 0."""


class Amplitudes(NamedTuple):
    """Squares of the amplitudes whose sum and difference are sin(theta/2) at the turning points."""

    fast: Scalar
    slow: Scalar


def constants(axis: Vector, momentum: Vector, top: Top) -> Constants:
    """Return the constants of the nutation at an instant, or arrays of them, SI."""
    resting = on_table(SlidingState(axis, momentum, (0.0, 0.0)), top)
    axial = top.axial_inertia * axial_spin(axis, momentum, top)
    return Constants(momentum[2], axial, energy(resting, top))


def natural_constants(values: Constants, top: Top) -> Constants:
    """Return the constants in units of mass, radius and gravity."""
    units = natural_units(top)
    momentum = units.angular_momentum
    return Constants(
        values.vertical / momentum, values.axial / momentum, values.energy / units.energy
    )


def numbers_of(top: Top) -> Numbers:
    """Return the dimensionless numbers of an eccentric sphere.

    Raises `InvalidInput` if the top is of another shape.
    """
    require_sphere(top)
    transverse, axial = top.numbers[:2]
    return Numbers(float(transverse), float(axial), eccentricity(top))


def effective_potential(tilt: Scalar, values: Constants, top: Top, functions: Functions) -> Scalar:
    """Return the potential energy, J, in which the tilt moves on a smooth table.

    It is (L_z - L3 c)^2 / (2 I1 s^2) + L3^2 / (2 I3) + m g h(c) for any shape and 0 < tilt < pi;
    the tilt, rad, stays where it is below the energy.
    """
    s, c = functions.sin(tilt), functions.cos(tilt)
    turning = (values.vertical - values.axial * c) ** 2 / (2.0 * top.transverse_inertia * s**2)
    spinning = values.axial**2 / (2.0 * top.axial_inertia)
    return turning + spinning + top.mass * top.gravity * top.surface.height(c)


_NEWTON_STEPS = 40
"""Steps of Newton's method: enough from any start, and cheap beside finding out when to stop."""


def orbit(values: Constants, numbers: Numbers) -> Orbit:
    """Return the nutation with these constants, or arrays of them, in natural units."""
    axial = values.axial
    swing = values.energy - axial**2 / (2.0 * numbers.axial) - (1.0 - numbers.alpha)
    return _orbit(values.vertical - axial, axial, swing, numbers)


def orbit_of_angles(angles: Angles, numbers: Numbers) -> Orbit:
    """Return the nutation that a motion belongs to, in natural units.

    There is no cancellation near theta = 0.
    """
    I1, I3, alpha = numbers
    sine_squared = math.sin(angles.tilt) ** 2
    p = 2.0 * math.sin(0.5 * angles.tilt) ** 2
    axial = I3 * angles.spin
    excess = I1 * sine_squared * angles.precession - axial * p
    nodding = (I1 + alpha**2 * sine_squared) * angles.tilt_rate**2
    swing = 0.5 * (nodding + I1 * sine_squared * angles.precession**2) + alpha * p
    return _orbit(excess, axial, swing, numbers)


def _orbit(excess: Scalar, axial: Scalar, swing: Scalar, numbers: Numbers) -> Orbit:
    """Return the nutation with the constants q = `excess`, L3 = `axial` and e = `swing`.

    Newton's method, started beyond the root that is separate from the others, converges to it
    monotonically, and the other two follow without cancellation. Constants that rounding has put
    beyond those of a steady precession give that precession.
    """
    I1, _, alpha = numbers
    total = (swing + axial**2 / (2.0 * I1)) / alpha + 2.0
    pairs = (2.0 * swing - excess * axial / I1) / alpha
    product = excess**2 / (2.0 * I1 * alpha)
    far = total + min(0.0, math.copysign(4.0, alpha))
    for _ in range(_NEWTON_STEPS):
        value = ((far - total) * far + pairs) * far - product
        slope = (3.0 * far - 2.0 * total) * far + pairs
        far = far - value / slope
    near = product / far
    middle = (pairs - near) / far / 2.0
    half = np.sqrt(np.maximum(middle**2 - near, 0.0))
    return Orbit(middle, half, far, excess, axial, swing)


def amplitudes(path: Orbit) -> Amplitudes:
    """Return the amplitudes of a nutation, or of arrays of them: fast > slow where L_z > L3."""
    apart = np.copysign(np.sqrt(np.maximum(path.middle**2 - path.half**2, 0.0)), path.excess)
    return Amplitudes((path.middle + apart) / 4.0, (path.middle - apart) / 4.0)


# translate: skip
def turning_tilts(pair: Amplitudes) -> tuple[Scalar, Scalar]:
    """Return the least and largest tilt, rad, of a nutation, or of arrays of them."""
    fast, slow = np.sqrt(pair.fast), np.sqrt(pair.slow)
    low, high = np.minimum(abs(fast - slow), 1.0), np.minimum(fast + slow, 1.0)
    return 2.0 * np.arcsin(low), 2.0 * np.arcsin(high)


def orbit_of_amplitudes(pair: Amplitudes, root: float, jellett: float, numbers: Numbers) -> Orbit:
    """Return the nutation with these amplitudes and Jellett's integral, in natural units.

    L_z - L3 and L3 are linear in r = sqrt(|p3|), and eliminating the energy from the coefficients
    of the cubic leaves a quadratic equation for r. Newton's method improves the estimate `root` of
    r. Its steps shrink smoothly where the two solutions approach each other, because a flow may
    pass a point where they meet.
    """
    I1, _, alpha = numbers
    difference = pair.fast - pair.slow
    both = 4.0 * (pair.fast + pair.slow)
    near = 4.0 * difference * difference
    slope = excess_slope(numbers) * difference
    off = 1.0 / (1.0 - alpha) ** 2
    square = abs(alpha) * I1 * (2.0 - both) - alpha * slope * slope * off
    linear = jellett * slope * (1.0 + alpha) * off
    constant = -alpha * I1 * (4.0 + near - 2.0 * both) - jellett * jellett * off
    for _ in range(4):
        steepness = 2.0 * square * root + linear
        least = _CLOSE * (abs(2.0 * square * root) + abs(linear))
        if least > 0.0:
            value = (square * root + linear) * root + constant
            root -= value * steepness**3 / (steepness**4 + least**4)
    far = math.copysign(root * root, alpha)
    excess = slope * root
    axial = (jellett - excess) / (1.0 - alpha)
    swing = 0.5 * (alpha * (near + far * both) + excess * axial / I1)
    return Orbit(0.5 * both, 4.0 * math.sqrt(pair.fast * pair.slow), far, excess, axial, swing)


def excess_slope(numbers: Numbers) -> float:
    """Return the ratio of L_z - L3 to sqrt(|p3|) times the difference of the amplitudes."""
    return 2.0 * math.sqrt(2.0 * numbers.transverse * abs(numbers.alpha))


_CLOSE = 1e-3
"""Relative slope of the quadratic below which Newton's steps shrink: two roots nearly meet."""


def turned_orbit(path: Orbit, numbers: Numbers) -> Orbit:
    """Return the same nutation of the top with its axis reversed: p = 1 + cos(theta).

    Its amplitudes are regular near theta = pi.
    """
    return Orbit(
        2.0 - path.middle,
        path.half,
        2.0 - path.far,
        path.excess + 2.0 * path.axial,
        -path.axial,
        path.swing - 2.0 * numbers.alpha,
    )
