"""The toy of a body, intersected with rays and shaded: for pictures that are made without a
browser.

Lengths are in sizes of the toy. Points and directions are in the body's frame, from its centre of
mass.
"""

from collections.abc import Iterator
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from matplotlib.colors import to_rgb
from numpy.typing import NDArray

from tippetop.figures.appearance import size, toy_parts
from tippetop.problem.bodies import Body

Array = NDArray[np.floating[Any]]

CLOSE = 3e-4
"""Largest distance of a quadric from the outline that it stands for, in sizes of the toy."""

LEVEL = 1e-9
"""Difference of heights below which two points count as level, in sizes of the toy."""

LAP = 1e-5
"""Length by which each quadric reaches over its ends, in sizes of the toy, so that no ray passes
between two of them.
"""

FAR = 1e9
"""Distance along a ray that stands for a ray that misses the toy."""


class _Quadric(NamedTuple):
    """Quadric w (x^2 + y^2) = p + q z + s z^2 between two heights and two distances from the
    axis.
    """

    w: float
    p: float
    q: float
    s: float
    low: float = -np.inf
    high: float = np.inf
    narrowest: float = 0.0
    widest: float = np.inf

    @property
    def inwards(self) -> "_Quadric":
        """Copy of this quadric with normals that point inwards."""
        return self._replace(w=-self.w, p=-self.p, q=-self.q, s=-self.s)

    def meet(self, o: Array, d: Array) -> tuple[Array, ...]:
        """Return the distances along rays to both intersections; `FAR` where there is none."""
        ox, oy, oz = np.moveaxis(o, -1, 0)
        dx, dy, dz = np.moveaxis(d, -1, 0)
        a = self.w * (dx * dx + dy * dy) - self.s * dz * dz
        b = self.w * (ox * dx + oy * dy) - (self.q / 2 + self.s * oz) * dz
        c = self.w * (ox * ox + oy * oy) - self.p - (self.q + self.s * oz) * oz
        discriminant = b * b - a * c
        # Either root by the form that loses no digits, and that holds for planes, where a is zero.
        lesser = -(b + np.copysign(np.sqrt(np.maximum(discriminant, 0.0)), b))
        with np.errstate(divide="ignore", invalid="ignore"):
            roots = c / lesser, lesser / a
            return tuple(
                self._within_bounds(o, d, np.where(discriminant < 0, FAR, root)) for root in roots
            )

    def _within_bounds(self, o: Array, d: Array, distance: Array) -> Array:
        """Return the distances, `FAR` for places outside the quadric's bounds or behind the
        start.
        """
        z = o[..., 2] + distance * d[..., 2]
        inside = (distance > 1e-6) & (z >= self.low) & (z <= self.high)
        if self.w == 0.0:
            away = (o[..., 0] + distance * d[..., 0]) ** 2 + (o[..., 1] + distance * d[..., 1]) ** 2
            inside &= (away >= self.narrowest**2) & (away <= self.widest**2)
        return np.where(inside, distance, FAR)

    def normal(self, point: Array) -> Array:
        """Return outward normals (not of unit length) at points of the quadric."""
        outward = self.w * point
        outward[..., 2] = -self.q / 2 - self.s * point[..., 2]
        return outward


class Hits(NamedTuple):
    """First intersections of rays with the toy."""

    distances: Array
    """Distances along the rays; `FAR` for a ray that misses."""
    normals: Array
    """Unit normals at the intersections."""
    parts: NDArray[np.intp]
    """Indices of the solid parts that the rays hit."""

    def some(self, which: Any) -> "Hits":
        """Return the intersections of some of the rays, selected as an array is indexed."""
        return Hits(*(values[which] for values in self))


class Toy:
    """Toy of a body, with the colours and the surfaces of its solid parts.

    `size` (m) is the unit of length. `middle` is the point halfway along the axis, and `reach` is
    the greatest distance of the toy from it.
    """

    def __init__(self, body: Body) -> None:
        self.size = size(body)
        parts = [part for part in toy_parts(body) if part.opacity == 1]
        points = np.concatenate([part.profile for part in parts])
        self.middle = np.array([0.0, 0.0, (points[:, 1].min() + points[:, 1].max()) / 2])
        self.reach = float(np.hypot(*(points - (0.0, self.middle[2])).T).max())
        self._sectors = [np.array([to_rgb(colour) for colour in part.colours]) for part in parts]
        self._surfaces = [
            (number, quadric)
            for number, part in enumerate(parts)
            for quadric in _turned(part.profile - (0.0, self.middle[2]))
        ]

    def meet(self, start: Array, direction: Array) -> Hits:
        """Return the first intersections of rays with the toy."""
        o = start - self.middle.astype(start.dtype)
        shape = o.shape[:-1]
        hits = Hits(np.full(shape, FAR, o.dtype), np.zeros_like(o), np.zeros(shape, np.intp))
        near = np.nonzero(_passes(o, direction, self.reach))
        if len(near[0]):
            for values, of_near in zip(hits, self._meet(o[near], direction[near]), strict=True):
                values[near] = of_near
        return hits

    def _meet(self, o: Array, d: Array) -> Hits:
        """Return the first intersections of rays that pass through the sphere that encloses the
        toy.
        """
        nearest, normals = np.full(o.shape[:-1], FAR, o.dtype), np.zeros_like(o)
        parts = np.zeros(o.shape[:-1], np.intp)
        for part, surface in self._surfaces:
            for distance in surface.meet(o, d):
                nearer = np.nonzero(distance < nearest)
                nearest[nearer] = distance[nearer]
                normals[nearer] = surface.normal(
                    o[nearer] + distance[nearer][..., None] * d[nearer]
                )
                parts[nearer] = part
        length = np.maximum(np.linalg.norm(normals, axis=-1, keepdims=True), 1e-12)
        return Hits(nearest, normals / length, parts)

    def paint(self, point: Array, parts: NDArray[np.intp]) -> Array:
        """Return the colours of points on the surfaces of parts, shape (k, 3)."""
        turn = np.arctan2(point[..., 1], point[..., 0]) / (2 * np.pi) % 1.0
        colours = np.zeros_like(point)
        for part, sectors in enumerate(self._sectors):
            at = parts == part
            colours[at] = sectors[(turn[at] * len(sectors)).astype(int) % len(sectors)]
        return colours

    def lit(self, point: Array, hits: Hits, light: Array, eye: Array, upward: Array) -> Array:
        """Return the colours of intersections under one light and a bright sky, shape (k, 3).

        `light`, `eye` and `upward` are unit vectors towards the light, towards the eye and upwards.
        """
        normal = hits.normals
        sun = np.clip(normal @ light, 0, None)
        sky = 0.5 + 0.5 * (normal @ upward)
        half = light + eye
        half /= np.linalg.norm(half, axis=-1, keepdims=True)
        gloss = 0.4 * np.clip(np.einsum("...i,...i", normal, half), 0, 1) ** 40
        return np.asarray(
            self.paint(point, hits.parts) * (0.42 + 0.28 * sky + 0.42 * sun)[..., None]
            + gloss[..., None]
        )


def _turned(curve: NDArray[np.float64]) -> Iterator[_Quadric]:
    """Yield the quadrics of the surface that a smooth line makes as it turns about the axis.

    The body lies to the left of the line. Neighbouring points share a quadric as long as it stays
    within `CLOSE` of them.
    """
    rises = np.sign(np.where(np.abs(np.diff(curve[:, 1])) < LEVEL, 0.0, np.diff(curve[:, 1])))
    turns = np.flatnonzero(np.diff(rises)) + 1
    if len(turns):
        corners = [0, *turns.tolist(), len(curve) - 1]
        for i, j in pairwise(corners):
            yield from _turned(curve[i : j + 1])
    elif rises[0] == 0.0:
        (start, height), (end, _) = curve[[0, -1]].tolist()
        narrow, wide = sorted((start, end))
        face = _Quadric(0.0, height, -1.0, 0.0, narrowest=max(narrow - LAP, 0.0), widest=wide + LAP)
        yield face if end < start else face.inwards
    else:
        yield from _sloping(curve, bool(rises[0] < 0.0))


def _sloping(curve: NDArray[np.float64], falls: bool) -> Iterator[_Quadric]:
    """Yield the quadrics of a line whose height only rises, or only falls.

    A line that falls (`falls`) bounds the body from inside.
    """
    away, along = curve.T
    middle = len(curve) // 2
    if len(curve) == 2:
        slope = (away[1] - away[0]) / (along[1] - along[0])
        tip = away[0] - slope * along[0]
        s, q, p = slope * slope, 2 * slope * tip, tip * tip
    else:
        through = [0, middle, -1]
        s, q, p = np.polyfit(along[through], away[through] ** 2, 2)
    off = np.sqrt(np.maximum(p + (q + s * along) * along, 0.0)) - away
    if len(curve) > 3 and np.abs(off).max() > CLOSE:
        for half in (curve[: middle + 1], curve[middle:]):
            yield from _sloping(half, falls)
    else:
        low, high = sorted((float(along[0]), float(along[-1])))
        quadric = _Quadric(1.0, float(p), float(q), float(s), low - LAP, high + LAP)
        yield quadric.inwards if falls else quadric


def _passes(o: Array, d: Array, reach: float) -> NDArray[np.bool_]:
    """Return whether each ray passes through the sphere of a radius about the origin."""
    b = np.einsum("...i,...i", o, d)
    a, c = np.einsum("...i,...i", d, d), np.einsum("...i,...i", o, o)
    return np.asarray(b * b > a * (c - reach * reach))
