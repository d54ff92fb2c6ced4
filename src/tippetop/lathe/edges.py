"""Edges of profiles: straight lines and arcs of circles in the half-plane through the axis.

A point is a complex number: its distance from the axis and, times i, its height along it, m.
"""

# translate module: numpy

import cmath
import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

Points = NDArray[np.complex128]

NEWTON = 3
"""Number of Newton steps that refine the meeting of two edges."""

TANGENT = 1e-12
"""Sine of the angle below which edges that meet count as touching."""


# translate: runtime
def gauss_rule() -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the places and weights of Gauss's rule of 20 points on (0, 1)."""
    nodes, weights = np.polynomial.legendre.leggauss(20)
    return (nodes + 1.0) / 2.0, weights / 2.0


SHARES, WEIGHTS = gauss_rule()


class Edge(NamedTuple):
    """A straight edge, or an arc of at most half a circle."""

    start: complex
    end: complex
    """End points."""
    turn: float = 0.0
    """Angle by which the edge turns to the left, rad, between -pi and pi; 0 for a straight edge."""

    @property
    def chord(self) -> complex:
        """Vector from the start to the end."""
        return self.end - self.start

    @property
    def radius(self) -> float:
        """Radius of the arc, m: negative where it turns to the right, infinite where it is
        straight.
        """
        return abs(self.chord) / (2.0 * math.sin(self.turn / 2.0)) if self.turn else math.inf

    @property
    def center(self) -> complex:
        """Centre of the arc's circle; straight edges have none."""
        return (self.start + self.end) / 2.0 + 0.5j * self.chord / math.tan(self.turn / 2.0)

    @property
    def sagitta(self) -> float:
        """Largest distance of the arc from its chord, m."""
        return 0.5 * abs(self.chord) * math.tan(abs(self.turn) / 4.0)

    @property
    def backwards(self) -> "Edge":
        """Reverse of this edge, from its end to its start."""
        return Edge(self.end, self.start, -self.turn)

    def direction(self, share: float) -> complex:
        """Return the unit tangent at a share of the edge."""
        return self.chord / abs(self.chord) * cmath.exp(1j * (share - 0.5) * self.turn)

    def points(self, share: ArrayLike) -> Points:
        """Return points at shares of the edge, from 0 at its start to 1 at its end."""
        t = np.asarray(share)
        half = self.turn / 2.0
        # Chords of parts of the arc, which lose no digits in nearly straight arcs.
        along = t * np.sinc(t * half / math.pi) / np.sinc(half / math.pi)
        return np.asarray(self.start + self.chord * along * np.exp(1j * (t - 1.0) * half))

    def velocities(self, share: ArrayLike) -> Points:
        """Return the derivatives of `points` with respect to the share."""
        t = np.asarray(share)
        return np.asarray(
            self.chord / np.sinc(self.turn / math.tau) * np.exp(1j * (t - 0.5) * self.turn)
        )

    def point(self, share: float) -> complex:
        """Return one of `points`, in a tenth of the time."""
        half = self.turn / 2.0
        along = share * _sine_ratio(share * half) / _sine_ratio(half)
        return self.start + self.chord * along * cmath.exp(1j * (share - 1.0) * half)

    def velocity(self, share: float) -> complex:
        """Return one of `velocities`, in a tenth of the time."""
        turned = cmath.exp(1j * (share - 0.5) * self.turn)
        return self.chord / _sine_ratio(self.turn / 2.0) * turned

    def nodes(self) -> tuple[Points, NDArray[np.float64]]:
        """Return points on the edge, and their weights in integrals of polynomials of r, z over dz.

        A polynomial of degree 4 at most becomes a polynomial along a straight edge, or a
        trigonometric one of degree 5 over an angle of at most pi: Gauss's rule with 20 points is
        exact for both, up to rounding.
        """
        return self.points(SHARES), WEIGHTS * self.velocities(SHARES).imag

    def share(self, point: complex) -> float:
        """Return the share of the edge at a point on it, or on its line or circle."""
        gone, ahead = point - self.start, self.end - point
        if not self.turn:
            return (gone / self.chord).real
        # The angle at the farther end is the more exact one.
        if abs(gone) < abs(ahead):
            return 2.0 * cmath.phase(ahead / self.chord) / self.turn
        return 1.0 + 2.0 * cmath.phase(gone / self.chord) / self.turn

    def distance(self, point: complex) -> float:
        """Return the distance of a point from the edge, m."""
        ends = min(abs(point - self.start), abs(point - self.end))
        if not self.turn:
            away = (point - self.start) / self.chord
            return abs(away.imag * self.chord) if 0.0 < away.real < 1.0 else ends
        outward = point - self.center
        if not outward:
            return abs(self.radius)
        on_circle = self.center + outward / abs(outward) * abs(self.radius)
        share = self.share(on_circle)
        return abs(on_circle - point) if 0.0 < share < 1.0 else ends

    def angle_seen(self, point: complex) -> float:
        """Return the angle that the edge subtends at a point off it, with its sign, rad."""
        seen = cmath.phase((self.end - point) / (self.start - point))
        if not self.turn:
            return seen
        # A point between the chord and the arc has the arc on the other side of the chord.
        within = abs(point - self.center) < abs(self.radius)
        beyond = ((point - self.start) / self.chord).imag * self.turn < 0.0
        return seen + math.copysign(math.tau, self.turn) if within and beyond else seen


def _sine_ratio(angle: float) -> float:
    """Return sin(angle) / angle."""
    return math.sin(angle) / angle if angle else 1.0


def meetings(first: Edge, second: Edge, within: float) -> list[complex]:
    """Return the points where two edges meet to within a distance, m.

    For edges that overlap, these are the ends that they share.
    """
    ends = [first.start, first.end, second.start, second.end]
    if first.turn and second.turn:
        points = [_polished(first, second, point) for point in _of_circles(first, second)]
    elif first.turn or second.turn:
        points = (
            _of_line_and_circle(first, second)
            if second.turn
            else _of_line_and_circle(second, first)
        )
        points = [_polished(first, second, point) for point in points]
    else:
        points = _of_lines(first, second)
    return [
        point
        for point in ends + points
        if max(first.distance(point), second.distance(point)) <= within
    ]


def _polished(first: Edge, second: Edge, point: complex) -> complex:
    """Return a meeting refined by Newton's method along both edges.

    The intersection of circles is inexact for arcs that are nearly straight.
    """
    t, u = first.share(point), second.share(point)
    for _ in range(NEWTON):
        along, across = first.velocity(t), second.velocity(u)
        gap = second.point(u) - first.point(t)
        area = (along.conjugate() * across).imag
        if abs(area) <= TANGENT * abs(along) * abs(across):
            return point
        t += (gap.conjugate() * across).imag / area
        u += (gap.conjugate() * along).imag / area
    return first.point(t)


def _of_lines(first: Edge, second: Edge) -> list[complex]:
    across = (first.chord.conjugate() * second.chord).imag
    if not across:
        return []
    share = ((second.start - first.start).conjugate() * second.chord).imag / across
    return [first.start + share * first.chord]


def _of_line_and_circle(line: Edge, arc: Edge) -> list[complex]:
    along = line.chord / abs(line.chord)
    center = (arc.center - line.start) / along
    half = math.sqrt(max(0.0, arc.radius**2 - center.imag**2))
    return [line.start + along * (center.real + side * half) for side in (-1.0, 1.0)]


def _of_circles(first: Edge, second: Edge) -> list[complex]:
    between = second.center - first.center
    apart = abs(between)
    if not apart:
        return []
    along = (apart + (first.radius**2 - second.radius**2) / apart) / 2.0
    half = math.sqrt(max(0.0, first.radius**2 - along**2))
    return [first.center + between / apart * complex(along, side * half) for side in (-1.0, 1.0)]
