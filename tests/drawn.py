"""True shapes of drawn bodies: curves in the half-plane beside the axis, and what they weigh.

A curve is a function from shares in [0, 1] to complex numbers, distance from the axis and, times i,
height, mm. The integrals are taken along the curves as they are, with many points.
"""

import itertools
import math

import numpy as np

NODES, WEIGHTS = np.polynomial.legendre.leggauss(40)
PARTS = 50


def segment(start, end):
    return lambda t: start + t * (end - start)


def arc(center, radius, begin, end):
    """An arc of a circle between two angles, rad."""
    return lambda t: center + radius * np.exp(1j * (begin + t * (end - begin)))


def oval(center, across, along, begin=-math.pi / 2, end=math.pi / 2):
    """An arc of an ellipse between two eccentric angles, rad."""

    def at(t):
        angle = begin + t * (end - begin)
        return center + across * np.cos(angle) + 1j * along * np.sin(angle)

    return at


def bezier(a, b, c, d):
    return lambda t: (1 - t) ** 3 * a + 3 * t * (1 - t) ** 2 * b + 3 * t**2 * (1 - t) * c + t**3 * d


def lines(*points):
    return [segment(one, other) for one, other in itertools.pairwise(points)]


def weighed(curves, density):
    """Mass, height of its centre, I1 and I3 about it, of what curves enclose with the axis."""
    totals = np.zeros(4)
    for curve in curves:
        for part in range(PARTS):
            middle, half = (part + 0.5) / PARTS, 0.5 / PARTS
            shares = middle + half * NODES
            step = 1e-6
            places = curve(shares)
            rates = (curve(shares + step) - curve(shares - step)).imag / (2 * step)
            r, z, dz = places.real, places.imag, half * WEIGHTS * rates
            kinds = (r**2, r**2 * z, r**2 * z**2, r**4 / 2.0)
            totals += [math.pi * float(kind @ dz) for kind in kinds]
    totals *= np.sign(totals[0]) * density * np.array([1e-9, 1e-12, 1e-15, 1e-15])
    mass, first, second, axial = totals
    center = first / mass
    return mass, center, axial / 2.0 + second - mass * center**2, axial


R, FACE, SLIM, TIP = 20.0, 12.0, 3.0, 30.0
CUT = math.sqrt(R**2 - FACE**2)

BALL = [arc(0.0, 15.0, -math.pi / 2, math.pi / 2)]
TOP = [
    arc(0.0, R, -math.pi / 2, math.asin(FACE / R)),
    *lines(CUT + FACE * 1j, SLIM + FACE * 1j, SLIM + TIP * 1j),
    arc(TIP * 1j, SLIM, 0.0, math.pi / 2),
]
"""A ball of 20 mm cut 12 mm above its middle, with a stem of 3 mm whose round tip is centred 30 mm
above.
"""
BORED = [*TOP, arc(-2.0j, 8.0, math.pi / 2, -math.pi / 2)]
"""The top with a round cavity of 8 mm."""
SPHEROID = [oval(0.0, 16.0, 25.0)]
EGG = [
    bezier(-20j, 11.0 - 20j, 15.0 - 9j, 15.0 - 1j),
    bezier(15.0 - 1j, 15.0 + 12j, 8.0 + 24j, 24j),
]
SPINDLE = lines(-15j, 4.0 - 14j, 12.0 - 2j, 12.0 + 3j, 2.5 + 9j, 2.5 + 22j, 22j)
BARREL = [
    *lines(0j, 10.0 + 0j),
    arc(10.0 + 3j, 3.0, -math.pi / 2, 0.0),
    *lines(13.0 + 3j, 13.0 + 17j),
    arc(10.0 + 17j, 3.0, 0.0, math.pi / 2),
    *lines(10.0 + 20j, 20j),
]
"""A cylinder of 13 mm by 20 mm with edges rounded by 3 mm."""
TORUS = [arc(18.0, 5.0, 0.0, math.tau)]
GOBLET = [
    bezier(0j, 14.0 + 0j, 18.0 + 8j, 18.0 + 16j),
    *lines(18.0 + 16j, 15.0 + 16j),
    bezier(15.0 + 16j, 15.0 + 10j, 12.0 + 4j, 4j),
]
"""A bowl between two Bezier curves."""


def polyline(curves, count):
    """Points along curves as programs export them: so many on each that is no line."""
    found = [complex(curves[0](0.0))]
    for curve in curves:
        is_line = abs(curve(0.5) - (curve(0.0) + curve(1.0)) / 2.0) < 1e-9
        found += [complex(curve(k / n)) for n in [1 if is_line else count] for k in range(1, n + 1)]
    return found
