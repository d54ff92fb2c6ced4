"""Dissipation of a nutation by weak friction: mean torque and power, and rates of its
amplitudes.
"""

import math
from typing import NamedTuple

from tippetop.theory.nutation import Amplitudes, Numbers, Orbit, excess_slope, orbit_of_amplitudes


class Dissipation(NamedTuple):
    """Mean rates of a nutation's constants per unit friction coefficient, in natural units."""

    axial: float
    """Rate of L3."""
    energy: float
    """Rate of the energy."""


class AmplitudeRates(NamedTuple):
    """Mean rates of a nutation's amplitudes per unit friction coefficient, in natural units.

    Jellett's integral and the amplitudes allow two values of the third root, which can meet;
    therefore its rate is needed too.
    """

    fast: float
    slow: float
    """Logarithmic rates of the amplitudes."""
    root: float
    """Rate of sqrt(|p3|), which continues to negative values where p3 touches zero."""


def phases(path: Orbit) -> tuple[float, ...]:
    """Return cosines of equidistant phases psi between 0 and pi, enough to average over a nutation.

    The error falls as exp(-2 n kappa) for n phases, with cosh(kappa) the distance of the third root
    from the middle of the nutation over its half-width. n is the least number with an error of
    1e-12, at most 64.
    """
    reach = abs(path.far - path.middle) / path.half if path.half > 0.0 else math.inf
    kappa = math.acosh(reach) if reach > 1.0 else 0.0
    return _PHASES[
        max(2, min(_MOST_PHASES, math.ceil(_DIGITS / (2.0 * kappa))))
        if kappa > 0.0
        else _MOST_PHASES
    ]


_MOST_PHASES = 64
_DIGITS = 12.0 * math.log(10.0)
_PHASES = tuple(
    tuple(math.cos((j + 0.5) * math.pi / count) for j in range(count))
    for count in range(_MOST_PHASES + 1)
)


def mean_dissipation(path: Orbit, numbers: Numbers) -> Dissipation:
    """Return the mean torque about the axis and the mean power of friction over a nutation.

    The centre of mass rests horizontally, as it does on average: its own motion decays as exp(-mu g
    t) and does not follow the nutation. The slip is then (omega x a) along the table, v_X = -h
    theta' and s v_Y = s^2 omega3 - (L_z - L3 c)(c - alpha) / I1, and the torque about the axis is
    -mu N s v_Y. N is the reaction of the smooth table, 1 + z'' with z = 1 - alpha c.
    """
    I1, I3, alpha = numbers
    middle, half, far, excess, axial, _ = path
    spin = axial / I3
    weights = torque = power = 0.0
    for cosine in phases(path):
        p = middle + half * cosine
        c = 1.0 - p
        sine_squared = p * (2.0 - p)
        inertia, rate_squared, reaction = _motion(p, path, numbers)
        across = sine_squared * spin - (excess + axial * p) / I1 * (c - alpha)
        height = 1.0 - alpha * c
        weight = math.sqrt(inertia / (alpha * (far - p)))
        pressed = weight * reaction
        weights += weight
        torque -= pressed * across
        power -= pressed * (height * height * rate_squared + across * across) / sine_squared
    return Dissipation(torque / weights, power / weights)


def least_reaction(path: Orbit, numbers: Numbers) -> float:
    """Return the least reaction of the table over a nutation, in weights; negative for a pull."""
    places = (path.middle + path.half * cosine for cosine in (1.0, *phases(path), -1.0))
    return min(_motion(p, path, numbers).reaction for p in places)


class _Motion(NamedTuple):
    """Motion of a nutation at one tilt, in natural units."""

    inertia: float
    rate_squared: float
    """p'^2."""
    reaction: float
    """1 + z'' = 1 + alpha p''."""


def _motion(p: float, path: Orbit, numbers: Numbers) -> _Motion:
    I1, _, alpha = numbers
    c, sine_squared = 1.0 - p, p * (2.0 - p)
    inertia = I1 + alpha * alpha * sine_squared
    about = path.excess + path.axial * p
    room = path.swing - alpha * p
    rate_squared = (2.0 * sine_squared * room - about * about / I1) / inertia
    acceleration = (
        2.0 * c * room
        - alpha * sine_squared
        - about * path.axial / I1
        - rate_squared * alpha * alpha * c
    ) / inertia
    return _Motion(inertia, rate_squared, 1.0 + alpha * acceleration)


def amplitude_rates(
    pair: Amplitudes, root: float, jellett: float, numbers: Numbers
) -> AmplitudeRates:
    """Return the rates of a nutation's amplitudes per unit friction coefficient, in natural units.

    They follow from the rates of L3 and of the energy at constant Jellett's integral, by
    differentiating the sum of the cubic's roots, the sum of their products in pairs, and L_z - L3.
    """
    I1, I3, alpha = numbers
    path = orbit_of_amplitudes(pair, root, jellett, numbers)
    lost = mean_dissipation(path, numbers)
    far, excess, axial = path.far, path.excess, path.axial
    root = math.copysign(math.sqrt(abs(far)), root)
    difference, both = pair.fast - pair.slow, 2.0 * path.middle
    slope = excess_slope(numbers)
    axial_rate = lost.axial
    excess_rate = (alpha - 1.0) * axial_rate
    swing_rate = lost.energy - axial / I3 * axial_rate
    total_rate = (swing_rate + axial * axial_rate / I1) / alpha
    pairs_rate = (2.0 * swing_rate - (excess * axial_rate + axial * excess_rate) / I1) / alpha

    first = pairs_rate - far * total_rate
    second = excess_rate / slope
    span = 8.0 * difference * difference + 2.0 * far * (far - both)
    far_slope = math.copysign(2.0 * root, root * alpha)
    difference_rate = (first * difference - far_slope * (both - far) * second) / span
    root_rate = (8.0 * difference * second - root * first) / span
    sum_rate = (total_rate - far_slope * root_rate) / 4.0
    return AmplitudeRates(
        0.5 * (sum_rate + difference_rate) / pair.fast,
        0.5 * (sum_rate - difference_rate) / pair.slow,
        root_rate,
    )
