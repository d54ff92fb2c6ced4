"""The toy met by rays, and lit: what pictures of it made without a browser are drawn with.

Lengths are in sizes of the toy; points and directions are in the body's frame, about its centre of mass.
"""

from typing import Any, NamedTuple

import numpy as np
from matplotlib.colors import to_rgb
from numpy.typing import NDArray

from tippetop.bodies import Body, EccentricSphere
from tippetop.figures.looks import FACE, KNOB, STEM, STEM_TOP, outline, size, toy_parts

Array = NDArray[np.floating[Any]]

PIECE = 4
"""Steps along an outline that are drawn as one piece: an even number."""

FAR = 1e9
"""How far along a ray that misses it the toy is."""


class _Quadric(NamedTuple):
    """Where w (x^2 + y^2) = p + q z + s z^2, between two heights and within a distance from the axis."""

    w: float
    p: float
    q: float
    s: float
    low: float = -np.inf
    high: float = np.inf
    widest: float = np.inf

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
        away = (o[..., 0] + distance * d[..., 0]) ** 2 + (o[..., 1] + distance * d[..., 1]) ** 2
        kept = (distance > 1e-6) & (z >= self.low) & (z <= self.high) & (away <= self.widest**2)
        return np.where(kept, distance, FAR)

    def normal(self, point: Array) -> Array:
        """Vectors along its normals at points of it, outwards."""
        outward = self.w * point
        outward[..., 2] = -self.q / 2 - self.s * point[..., 2]
        return outward


class Toy:
    """The toy of a body.

    Attributes
    ----------
    size
        The length by which it is measured, m.
    middle
        The middle of its surface.
    """

    def __init__(self, body: Body) -> None:
        shape = body.shape
        self.size = size(body)
        self._parts = [part for part in toy_parts(body) if part.opacity == 1]
        if isinstance(shape, EccentricSphere):
            self.middle = np.array([0.0, 0.0, shape.eccentricity])
            self._surfaces = _tippe_top()
        else:
            arcs = [arc / self.size for arc in outline(body.surface)]
            heights = np.concatenate(arcs)[:, 1]
            self.middle = np.array([0.0, 0.0, (heights.min() + heights.max()) / 2])
            self._surfaces = tuple(
                quadric for arc in arcs for quadric in _turned(arc - (0.0, self.middle[2]))
            )

    def meet(self, start: Array, direction: Array) -> tuple[Array, Array]:
        """How far along each ray the toy is, and its normal there; far if missed."""
        o = start - self.middle.astype(start.dtype)
        distances, normals = np.full(o.shape[:-1], FAR, o.dtype), np.zeros_like(o)
        near = np.nonzero(_passes(o, direction))
        if len(near[0]):
            distances[near], normals[near] = self._meet(o[near], direction[near])
        return distances, normals

    def _meet(self, o: Array, d: Array) -> tuple[Array, Array]:
        """The same for rays that pass through the sphere in which all of the toy is."""
        nearest, normals = np.full(o.shape[:-1], FAR, o.dtype), np.zeros_like(o)
        for surface in self._surfaces:
            for distance in surface.meet(o, d):
                nearer = np.nonzero(distance < nearest)
                nearest[nearer] = distance[nearer]
                normals[nearer] = surface.normal(o[nearer] + distance[nearer][..., None] * d[nearer])
        return nearest, normals / np.maximum(np.linalg.norm(normals, axis=-1, keepdims=True), 1e-12)

    def paint(self, point: Array) -> Array:
        """The colours of surface points."""
        along, away = point[..., 2], np.hypot(point[..., 0], point[..., 1])
        turn = np.arctan2(point[..., 1], point[..., 0]) / (2 * np.pi) % 1.0
        colours = np.zeros_like(point)
        for part in self._parts:
            (narrow, low), (wide, high) = part.profile.min(axis=0), part.profile.max(axis=0)
            at = (along > low - 1e-3) & (along < high + 1e-3) & (away > narrow - 0.01) & (away < wide + 0.01)
            sectors = np.array([to_rgb(colour) for colour in part.colours])
            colours[at] = sectors[(turn[at] * len(sectors)).astype(int) % len(sectors)]
        return colours

    def lit(self, point: Array, normal: Array, light: Array, eye: Array, upward: Array) -> Array:
        """The colours of surface points under one light and a bright sky, given unit vectors to all three."""
        sun = np.clip(normal @ light, 0, None)
        sky = 0.5 + 0.5 * (normal @ upward)
        half = light + eye
        half /= np.linalg.norm(half, axis=-1, keepdims=True)
        gloss = 0.4 * np.clip(np.einsum("...i,...i", normal, half), 0, 1) ** 40
        return np.asarray(self.paint(point) * (0.42 + 0.28 * sky + 0.42 * sun)[..., None] + gloss[..., None])


def _tippe_top() -> tuple[_Quadric, ...]:
    """The cut sphere, the face, the stem and the ball at its end, about the sphere's centre."""
    slope = (KNOB - STEM) / (STEM_TOP - FACE)
    start = STEM - slope * FACE
    return (
        _Quadric(1.0, 1.0, 0.0, -1.0, high=FACE),
        _Quadric(0.0, FACE, -1.0, 0.0, widest=float(np.sqrt(1 - FACE**2))),
        _Quadric(1.0, start**2, 2 * slope * start, slope**2, FACE, STEM_TOP),
        _Quadric(1.0, KNOB**2 - STEM_TOP**2, 2 * STEM_TOP, -1.0, low=STEM_TOP),
    )


def _turned(outline: NDArray[np.float64]) -> tuple[_Quadric, ...]:
    """The surface of an arc or a line of an outline turned about the axis, a quadric through three points."""
    found = []
    for first in range(0, len(outline) - 1, PIECE):
        piece = outline[first : first + PIECE + 1]
        if len(piece) == 2:
            found.append(_line(*piece))
            continue
        away, along = piece[[0, len(piece) // 2, -1]].T
        s, q, p = np.polyfit(along, away**2, 2)
        found.append(_Quadric(1.0, float(p), float(q), float(s), float(along[0]), float(along[-1])))
    return tuple(found)


def _line(start: NDArray[np.float64], end: NDArray[np.float64]) -> _Quadric:
    """The cone, or the face, that a line from below turns to."""
    (away, low), (there, high) = start.tolist(), end.tolist()
    if high - low < 1e-9:
        up = 1.0 if there < away else -1.0
        return _Quadric(0.0, up * low, -up, 0.0, widest=max(away, there))
    slope = (there - away) / (high - low)
    tip = away - slope * low
    return _Quadric(1.0, tip * tip, 2 * slope * tip, slope * slope, low, high)


def _passes(o: Array, d: Array) -> NDArray[np.bool_]:
    """Whether rays pass through the unit sphere."""
    b = np.einsum("...i,...i", o, d)
    a, c = np.einsum("...i,...i", d, d), np.einsum("...i,...i", o, o)
    return np.asarray(b * b > a * (c - 1.0))
