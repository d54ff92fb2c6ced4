"""The toy met by rays, and lit: what pictures of it made without a browser are drawn with.

Lengths are in sizes of the toy; points and directions are in the body's frame, about its centre of
mass.
"""

from collections.abc import Iterator
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from matplotlib.colors import to_rgb
from numpy.typing import NDArray

from tippetop.figures.looks import size, toy_parts
from tippetop.problem.bodies import Body

Array = NDArray[np.floating[Any]]

CLOSE = 3e-4
"""How near to an outline what is drawn for a piece of it must be, in sizes of the toy."""

LEVEL = 1e-9
"""Height between two points below which they are on one level, in sizes of the toy."""

LAP = 1e-5
"""How far each piece reaches over its ends, in sizes of the toy: no ray passes between two."""

FAR = 1e9
"""How far along a ray that misses it the toy is."""


class _Quadric(NamedTuple):
    """Where w (x^2 + y^2) = p + q z + s z^2, between two heights and two distances from the
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
        """The same surface seen from its other side."""
        return self._replace(w=-self.w, p=-self.p, q=-self.q, s=-self.s)

    def meet(self, o: Array, d: Array) -> tuple[Array, ...]:
        """How far along rays its two places are; far where there is none."""
        ox, oy, oz = np.moveaxis(o, -1, 0)
        dx, dy, dz = np.moveaxis(d, -1, 0)
        a = self.w * (dx * dx + dy * dy) - self.s * dz * dz
        b = self.w * (ox * dx + oy * dy) - (self.q / 2 + self.s * oz) * dz
        c = self.w * (ox * ox + oy * oy) - self.p - (self.q + self.s * oz) * oz
        inside = b * b - a * c
        # Either root by the form that loses no digits, and that holds for planes, where a is zero.
        lesser = -(b + np.copysign(np.sqrt(np.maximum(inside, 0.0)), b))
        with np.errstate(divide="ignore", invalid="ignore"):
            roots = c / lesser, lesser / a
            return tuple(self._kept(o, d, np.where(inside < 0, FAR, root)) for root in roots)

    def _kept(self, o: Array, d: Array, distance: Array) -> Array:
        z = o[..., 2] + distance * d[..., 2]
        kept = (distance > 1e-6) & (z >= self.low) & (z <= self.high)
        if self.w == 0.0:
            away = (o[..., 0] + distance * d[..., 0]) ** 2 + (o[..., 1] + distance * d[..., 1]) ** 2
            kept &= (away >= self.narrowest**2) & (away <= self.widest**2)
        return np.where(kept, distance, FAR)

    def normal(self, point: Array) -> Array:
        """Vectors along its normals at points of it, outwards."""
        outward = self.w * point
        outward[..., 2] = -self.q / 2 - self.s * point[..., 2]
        return outward


class Hits(NamedTuple):
    """Where rays meet the toy."""

    distances: Array
    """How far along each ray; far if it misses."""
    normals: Array
    """Unit normals there."""
    parts: NDArray[np.intp]
    """Numbers of the solid parts that are met."""

    def some(self, which: Any) -> "Hits":
        """Some of them, as an array is indexed."""
        return Hits(*(values[which] for values in self))


class Toy:
    """The toy of a body: of a `size`, m, by which it is measured, and a `reach` from its `middle`.

    That is the point halfway along its axis.
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
        """Where rays meet the toy."""
        o = start - self.middle.astype(start.dtype)
        shape = o.shape[:-1]
        hits = Hits(np.full(shape, FAR, o.dtype), np.zeros_like(o), np.zeros(shape, np.intp))
        near = np.nonzero(_passes(o, direction, self.reach))
        if len(near[0]):
            for found, those in zip(hits, self._meet(o[near], direction[near]), strict=True):
                found[near] = those
        return hits

    def _meet(self, o: Array, d: Array) -> Hits:
        """The same for rays that pass through the sphere in which all of the toy is."""
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
        """The colours of surface points of its parts."""
        turn = np.arctan2(point[..., 1], point[..., 0]) / (2 * np.pi) % 1.0
        colours = np.zeros_like(point)
        for part, sectors in enumerate(self._sectors):
            at = parts == part
            colours[at] = sectors[(turn[at] * len(sectors)).astype(int) % len(sectors)]
        return colours

    def lit(self, point: Array, hits: Hits, light: Array, eye: Array, upward: Array) -> Array:
        """The colours of surface points that were hit, lit by one light and a bright sky.

        Given are unit vectors to the light, to the eye and upwards.
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
    """The surface that a smooth line turns to, with the body on its left: as few quadrics as it
    takes.
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
    """The surface of a line that rises all the way, or falls, and then is seen from inside."""
    away, along = curve.T
    some = [0, len(curve) // 2, -1]
    if len(curve) == 2:
        slope = (away[1] - away[0]) / (along[1] - along[0])
        tip = away[0] - slope * along[0]
        s, q, p = slope * slope, 2 * slope * tip, tip * tip
    else:
        s, q, p = np.polyfit(along[some], away[some] ** 2, 2)
    off = np.sqrt(np.maximum(p + (q + s * along) * along, 0.0)) - away
    if len(curve) > 3 and np.abs(off).max() > CLOSE:
        for half in (curve[: some[1] + 1], curve[some[1] :]):
            yield from _sloping(half, falls)
    else:
        low, high = sorted((float(along[0]), float(along[-1])))
        found = _Quadric(1.0, float(p), float(q), float(s), low - LAP, high + LAP)
        yield found.inwards if falls else found


def _passes(o: Array, d: Array, reach: float) -> NDArray[np.bool_]:
    """Whether rays pass through the sphere of this radius."""
    b = np.einsum("...i,...i", o, d)
    a, c = np.einsum("...i,...i", d, d), np.einsum("...i,...i", o, o)
    return np.asarray(b * b > a * (c - reach * reach))
