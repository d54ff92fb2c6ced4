"""Convex hull of a turned body: the surfaces on which it stands, by tilt.

At tilt theta the table is a line in the half-plane through the axis, with the normal (sin(theta),
-cos(theta)) away from the body. The support function of a circle with centre (rho, zeta) and radius
tube, or of a point (tube = 0), is rho sin(theta) - zeta cos(theta) + tube. The body stands on the
surface with the largest support function.
"""

# translate module: numpy

import cmath
import math
from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tippetop.lathe.arcs import least_squares
from tippetop.lathe.profile import ROUNDING, Profile

ON_AXIS = 1e-4
"""Distance of a sphere arc's centre from the axis that counts as rounding, in radii and in body
sizes.
"""

NARROWEST = 1e-9
"""Smallest range of tilts of a surface, rad."""

FEWEST_CURVE_ARCS = 2
"""Smallest number of successive arcs that can approximate another smooth curve."""

_CLOSE = 1e-7
"""Error by rounding of the tilt at which one surface follows another that it almost touches, rad.
"""


class Zone(NamedTuple):
    """Surface of revolution on which a body stands, with its range of tilts."""

    radius: float
    """Radius of the circle in the middle of the tube, m: 0 for a sphere or a tip."""
    height: float
    """Height of that circle, in the profile's own coordinates, m."""
    tube: float
    """Radius of the tube, m: 0 for a sharp edge; the radius of a sphere."""
    low: float
    high: float
    """Smallest and largest tilt at which the body stands on it, rad."""

    def support(self, tilt: float) -> float:
        """Return the height above the table of the origin of the profile's coordinates, m."""
        return self.radius * math.sin(tilt) - self.height * math.cos(tilt) + self.tube

    def apart(self, second: "Zone") -> float:
        """Return the largest difference of the three lengths from those of another zone, m."""
        across, along = abs(self.radius - second.radius), abs(self.height - second.height)
        return max(across, along, abs(self.tube - second.tube))

    @property
    def name(self) -> str:
        """Kind of the surface."""
        if self.radius:
            return "ring" if self.tube else "edge"
        return "sphere" if self.tube else "tip"


class ConvexHull(NamedTuple):
    """Surfaces of revolution on which a turned body can stand, each with its range of tilts."""

    zones: tuple[Zone, ...]
    """The surfaces on which the body stands, by tilt."""
    flats: tuple[float, ...]
    """Tilts at which the body rests on a circle or a line: 0 and pi on a flat end, between them on
    a cylinder or a cone.
    """

    def support(self, tilt: float) -> float:
        """Return the height above the table of the origin of the profile's coordinates, m."""
        return max(zone.support(tilt) for zone in self.zones if zone.low <= tilt <= zone.high)

    def protrusion(self, zone: Zone) -> tuple[float, float]:
        """Return how far (m) a surface, if complete, would protrude from the hull, and at which
        tilt.
        """
        distances = [(0.0, zone.low)]
        for second in self.zones:
            tilts = [second.low, second.high]
            steepest = math.atan2(zone.radius - second.radius, second.height - zone.height)
            tilts += [
                tilt for tilt in (steepest, steepest + math.pi) if second.low < tilt < second.high
            ]
            distances += [(zone.support(tilt) - second.support(tilt), tilt) for tilt in tilts]
        return max(distances)

    def rows(self, zones: Sequence[Zone]) -> list[list[Zone]]:
        """Return surfaces in rows that continue each other: the contact point passes from one to
        the next without a jump.
        """
        rows: list[list[Zone]] = []
        for zone in zones:
            continues = bool(rows) and rows[-1][-1].high == zone.low
            if continues and zone.low not in self.flats:
                rows[-1].append(zone)
            else:
                rows.append([zone])
        return rows

    def smooth_parts(self, reach: float) -> list[tuple[float, float]]:
        """Return the ranges of tilts in which the body stands on a smooth curve that is no circle.

        Such a curve is a row of arcs that continue each other, at least one of which would protrude
        from the hull by more than `reach` (m) if it were complete.
        """
        rows: list[list[Zone]] = [[]]
        for zone in self.zones:
            before = rows[-1][-1] if rows[-1] else None
            if before is not None and not (
                zone.tube and before.tube and zone.low not in self.flats
            ):
                rows.append([])
            rows[-1].append(zone)
        return [
            (row[0].low, row[-1].high)
            for row in rows
            if len(row) >= FEWEST_CURVE_ARCS
            and any(zone.radius < 0.0 or self.protrusion(zone)[0] > reach for zone in row)
        ]

    def spheroid(self, within: float) -> tuple[float, float, float] | None:
        """Return the semi-axes across and along the axis, and the centre's height, of a spheroid.

        The result is None if the hull is not a spheroid to within a length, m.
        """
        tilts = np.linspace(0.0, math.pi, 181)
        support = np.array([self.support(tilt) for tilt in tilts.tolist()])
        sine, cosine = np.sin(tilts), np.cos(tilts)
        # (h + height cos)^2 = across^2 sin^2 + along^2 cos^2 is linear in the unknowns.
        columns = [sine**2, cosine**2, -2.0 * support * cosine]
        square, remainder, height = least_squares(columns, support**2)
        along = remainder + height**2
        if not (square > 0.0 and along > 0.0):
            return None
        spheroid = np.sqrt(square * sine**2 + along * cosine**2) - height * cosine
        if np.abs(spheroid - support).max() > within:
            return None
        return math.sqrt(square), math.sqrt(along), height

    def complete_surfaces(self, reach: float) -> list[Zone]:
        """Return the distinct surfaces that make up the body if each is complete.

        A surface is omitted if, at all its tilts, it then protrudes from the others by less than
        `reach`, m.
        """
        surfaces: list[Zone] = []
        for zone in self.zones:
            if not any(zone.apart(second) == 0.0 for second in surfaces):
                surfaces.append(zone)
        for zone in list(surfaces):
            others = [second for second in surfaces if second is not zone]
            tilts = [
                tilt
                for part in self.zones
                if part.apart(zone) == 0.0
                for tilt in np.linspace(part.low, part.high, 33).tolist()
            ]
            beyond = [
                zone.support(t) - max(second.support(t) for second in others)
                for t in tilts
                if others
            ]
            if max(beyond, default=math.inf) <= reach:
                surfaces = others
        return surfaces


def hull_of(profile: Profile) -> ConvexHull:
    """Return the convex hull of a body of revolution.

    The hull is traced from tilt 0 to pi: each surface is followed until another protrudes, or its
    arc ends.
    """
    outline = _ConvexParts(profile)
    within = ROUNDING * profile.size
    zones, tilt, number = [], 0.0, outline.lowest()
    while tilt < math.pi:
        tilt_next, next_number = outline.after(number, tilt)
        zones.append(outline.zone(number, tilt, tilt_next))
        tilt, number = tilt_next, next_number
    wide = [zone for zone in zones if zone.high - zone.low > NARROWEST]
    merged = _merged([zone for zone in wide if not _is_end_of_sphere(zone, wide)], within)
    between = [high.low for low, high in pairwise(merged) if _apart(low, high) > 10.0 * within]
    flats = [0.0] * bool(merged[0].radius) + between + [math.pi] * bool(merged[-1].radius)
    return ConvexHull(tuple(merged), tuple(flats))


def _is_end_of_sphere(zone: Zone, zones: list[Zone]) -> bool:
    """Return whether a tip is an artefact of a sphere's arc that ends a little off the axis."""
    ends = (zone.low, zone.high)
    beside = any(
        neighbour.name == "sphere" and (neighbour.low in ends or neighbour.high in ends)
        for neighbour in zones
    )
    return zone.name == "tip" and zone.high - zone.low < 2.0 * ON_AXIS and beside


def _apart(low: Zone, high: Zone) -> float:
    """Return the distance, m, of the contact points of two surfaces where one follows the other."""
    sine, cosine = math.sin(high.low), math.cos(high.low)
    across = high.radius - low.radius + (high.tube - low.tube) * sine
    return math.hypot(across, high.height - low.height - (high.tube - low.tube) * cosine)


def _merged(zones: list[Zone], within: float) -> list[Zone]:
    """Return the zones with neighbours of one surface merged."""
    merged: list[Zone] = []
    for zone in zones:
        last = merged[-1] if merged else None
        if last and last.apart(zone) <= within:
            merged[-1] = last._replace(high=zone.high)
        else:
            merged.append(zone._replace(low=last.high if last else 0.0))
    return [*merged[:-1], merged[-1]._replace(high=math.pi)]


class _ConvexParts:
    """Convex points and arcs of a profile, with the tilts at which each can touch the table."""

    def __init__(self, profile: Profile) -> None:
        edges = profile.edges
        closed = edges[0].start == edges[-1].end
        points = [edge.start for edge in edges] + ([] if closed else [edges[-1].end])
        arcs = [k for k, edge in enumerate(edges) if edge.turn > 0.0]
        self.count, self.size = len(points), profile.size
        self.ends = {self.count + n: (k, (k + 1) % self.count) for n, k in enumerate(arcs)}
        middles = np.array(points + [edges[k].center for k in arcs])
        self.radius, self.height = middles.real, middles.imag
        self.tube = np.array([0.0] * self.count + [edges[k].radius for k in arcs])
        # The table is parallel to the edge at the contact point.
        starts = [cmath.phase(edges[k].direction(0.0)) for k in arcs]
        self.low = np.array([0.0] * self.count + starts)
        self.high = np.array(
            [math.pi] * self.count + [s + edges[k].turn for s, k in zip(starts, arcs, strict=True)]
        )
        self.left_at = np.full(len(self.low), -math.inf)
        self.starting = [
            [n for n, ends in self.ends.items() if ends[0] == k] for k in range(self.count)
        ]

    def zone(self, number: int, low: float, high: float) -> Zone:
        """Return the surface of a point or arc."""
        radius, height, tube = (float(of[number]) for of in (self.radius, self.height, self.tube))
        on_axis = abs(radius) <= ON_AXIS * min(tube, self.size)
        return Zone(0.0 if on_axis else radius, height, tube, low, high)

    def lowest(self) -> int:
        """Return the point or arc on which the body stands at tilt 0, or just above it."""
        support = np.where(
            (self.low <= 0.0) & (self.high > 0.0), self.tube - self.height, -math.inf
        )
        lowest = np.flatnonzero(support >= support.max() - ROUNDING * self.size)
        return int(max(lowest, key=lambda number: (self.radius[number], self.tube[number])))

    def after(self, number: int, tilt: float) -> tuple[float, int]:
        """Return the tilt up to which the body stands on a point or arc, and the next one."""
        self.left_at[number] = tilt
        rises = self._rises(number, tilt)
        if number in self.ends:
            rises[self.ends[number][1]] = self.high[number]
        else:
            rises[self.starting[number]] = self.low[self.starting[number]]
        rises[self.left_at > tilt - _CLOSE] = math.inf
        rises[(rises < self.low - NARROWEST) | (rises >= self.high) | (rises < tilt - _CLOSE)] = (
            math.inf
        )
        first = int(np.argmin(rises))
        return (
            (max(tilt, float(rises[first])), first) if rises[first] < math.pi else (math.pi, number)
        )

    def _joined_to(self, number: int) -> list[int]:
        """Return the neighbours of a point or an arc.

        The neighbours of a point are the arcs that end at it; those of an arc are its ends, and the
        arcs that continue it smoothly.
        """
        if number not in self.ends:
            return [n for n, ends in self.ends.items() if number in ends]
        start, end = self.ends[number]
        before = [n for n in self.ends if self.ends[n][1] == start]
        after = [n for n in self.ends if self.ends[n][0] == end]
        smooth = [n for n in before if abs(self.high[n] - self.low[number]) < _CLOSE]
        smooth += [n for n in after if abs(self.low[n] - self.high[number]) < _CLOSE]
        return [start, end, *smooth]

    def _rises(self, number: int, tilt: float) -> NDArray[np.float64]:
        """Return the tilts from `tilt` on at which other points and arcs begin to protrude.

        Neighbours are omitted: an arc and its end have the same support function where they meet.
        """
        across, along = self.radius - self.radius[number], self.height - self.height[number]
        apart = np.hypot(across, along)
        with np.errstate(divide="ignore", invalid="ignore"):
            sine = (self.tube[number] - self.tube) / apart
        touching = np.abs(sine) <= 1.0
        tilts = np.arctan2(along, across) + np.arcsin(np.where(touching, sine, 0.0))
        tilts = tilt - _CLOSE + np.mod(tilts - tilt + _CLOSE, math.tau)
        tilts[~touching] = math.inf
        tilts[self._joined_to(number)] = math.inf
        return np.asarray(tilts)
