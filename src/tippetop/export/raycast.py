"""Pictures of the toy on its table without a browser: a ray for every pixel, met by formulas.

Lengths are in sizes of the toy. The toy is the sphere (or spheroid) of the model, cut by the flat face, with
the stem; `tippetop.export.geometry` has the same as a mesh.
"""

from typing import Any

import numpy as np
from matplotlib.colors import to_rgb
from numpy.typing import NDArray

from tippetop.export.camera import View, pixel_grid, pixels_of_box
from tippetop.export.geometry import Part, size, toy_parts
from tippetop.figures.style import ACCENT, INK
from tippetop.figures.toy import FACE
from tippetop.problem import Body, EccentricSphere

Array = NDArray[np.floating[Any]]

_LIGHT = np.array([-0.35, -0.60, 1.0]) / np.linalg.norm([-0.35, -0.60, 1.0])
_TABLE, _LINE, _SKY = (np.array(to_rgb(c)) for c in ("#e3d9c8", "#b7a98f", "#eef1f4"))
_TRACE = np.array(to_rgb(ACCENT))
_STEM, _KNOB = 0.14, 0.165
_FAR = 1e9


class Toy:
    """The toy of a body, to be met by rays."""

    def __init__(self, body: Body) -> None:
        shape = body.shape
        self.size = size(body)
        if isinstance(shape, EccentricSphere):
            self.stretch = np.ones(3)
            self.middle = np.array([0.0, 0.0, shape.eccentricity])
            self.cut = True
        else:
            self.stretch = np.array([shape.across, shape.across, shape.along]) / self.size
            self.middle = np.zeros(3)
            self.cut = False
        self._paints = [_Paint(part, self.size) for part in toy_parts(body) if part.opacity == 1]

    def meet(self, start: Array, direction: Array) -> tuple[Array, Array]:
        """How far along each ray the toy is, and its normal there, in the body's frame; far if missed."""
        o, d = (start - self.middle) / self.stretch, direction / self.stretch
        distances, normals = np.full(o.shape[:-1], _FAR, o.dtype), np.zeros_like(o)
        near = np.nonzero(_passes(o, d))
        if len(near[0]):
            distances[near], normals[near] = self._meet(o[near], d[near])
        return distances, normals

    def _meet(self, o: Array, d: Array) -> tuple[Array, Array]:
        """The same for rays that pass through the whole sphere, in which all of the toy is."""
        far = np.full(o.shape[:-1], _FAR, o.dtype)
        near, farther = _sphere(o, d, 1.0)
        normal = np.zeros_like(o)
        for distance in (farther, near):
            point = o + np.where(distance < _FAR, distance, 0.0)[..., None] * d
            kept = (distance > 1e-6) & (distance < far) & (not self.cut or (point[..., 2] < FACE))
            far = np.where(kept, distance, far)
            normal = np.where(kept[..., None], point / self.stretch, normal)
        if self.cut:
            far, normal = self._meet_face(o, d, far, normal)
            far, normal = self._meet_stem(o, d, far, normal)
        return far, normal / np.maximum(np.linalg.norm(normal, axis=-1, keepdims=True), 1e-12)

    def _meet_face(self, o: Array, d: Array, far: Array, normal: Array) -> tuple[Array, Array]:
        with np.errstate(divide="ignore", invalid="ignore"):
            distance = (FACE - o[..., 2]) / d[..., 2]
        point = o + np.where(np.isfinite(distance), distance, 0.0)[..., None] * d
        kept = (distance > 1e-6) & (distance < far) & (point[..., 0] ** 2 + point[..., 1] ** 2 < 1 - FACE**2)
        return np.where(kept, distance, far), np.where(kept[..., None], [0.0, 0.0, 1.0], normal)

    def _meet_stem(self, o: Array, d: Array, far: Array, normal: Array) -> tuple[Array, Array]:
        knob = np.array([0.0, 0.0, 1.0 - _KNOB])
        distance, _ = _sphere(o - knob, d, _KNOB)
        point = o + np.where(distance < _FAR, distance, 0.0)[..., None] * d
        kept = (distance > 1e-6) & (distance < far)
        far, normal = np.where(kept, distance, far), np.where(kept[..., None], point - knob, normal)
        flat = np.array([1.0, 1.0, 0.0])
        distance, _ = _sphere(o * flat, d * flat, _STEM)
        point = o + np.where(distance < _FAR, distance, 0.0)[..., None] * d
        kept = (distance > 1e-6) & (distance < far) & (point[..., 2] > FACE) & (point[..., 2] < knob[2])
        return np.where(kept, distance, far), np.where(kept[..., None], point * flat, normal)

    def paint(self, point: Array) -> Array:
        """The colours of surface points in the body's frame."""
        colour = np.tile(np.array(to_rgb("#D9AE78")), (*point.shape[:-1], 1))
        away = np.hypot(point[..., 0], point[..., 1])
        turn = np.arctan2(point[..., 1], point[..., 0]) % (2 * np.pi)
        for paint in self._paints:
            inside = paint.covers(point[..., 2], away)
            colour[inside] = paint.at(turn[inside])
        return colour


class _Paint:
    """The pattern of a part."""

    def __init__(self, part: Part, unit: float) -> None:
        self._low, self._high = part.profile[:, 1].min() / unit, part.profile[:, 1].max() / unit
        self._widest = part.profile[:, 0].max() / unit
        self._narrowest = part.profile[:, 0].min() / unit if part.name in ("face", "rim") else 0.0
        self._colours = np.array([to_rgb(colour) for colour in part.colours])

    def covers(self, along: Array, away: Array) -> NDArray[np.bool_]:
        slack = 0.02 if self._narrowest else 1e-4
        within = (along >= self._low - slack) & (along <= self._high + slack)
        return np.asarray(within & (away <= self._widest + 0.02) & (away >= self._narrowest - 1e-4))

    def at(self, turn: Array) -> Array:
        sector = (turn / (2 * np.pi) * len(self._colours)).astype(int) % len(self._colours)
        return np.asarray(self._colours[sector])


def _passes(o: Array, d: Array) -> NDArray[np.bool_]:
    """Whether rays pass through the unit sphere."""
    b = np.einsum("...i,...i", o, d)
    a, c = np.einsum("...i,...i", d, d), np.einsum("...i,...i", o, o)
    return np.asarray(b * b > a * (c - 1.0))


def _sphere(o: Array, d: Array, radius: float) -> tuple[Array, Array]:
    """The two distances at which rays meet a sphere about the origin; far where they miss it."""
    a = np.einsum("...i,...i", d, d)
    b = np.einsum("...i,...i", o, d)
    c = np.einsum("...i,...i", o, o) - radius**2
    inside = b * b - a * c
    root = np.sqrt(np.maximum(inside, 0.0))
    with np.errstate(divide="ignore", invalid="ignore"):
        near, far = (-b - root) / a, (-b + root) / a
    missed = (inside < 0) | (a < 1e-12)
    return np.where(missed, _FAR, near), np.where(missed, _FAR, far)


def picture(
    toy: Toy, view: View, position: Array, frame: Array, path: Array, cell: float, pixels: tuple[int, int]
) -> NDArray[np.uint8]:
    """The picture of a moment, shape (height, width, 3).

    Parameters
    ----------
    toy, view
        What is seen, from where.
    position, frame
        Centre of mass, and the body's axes as columns, shape (3, 3).
    path
        The path of the contact point so far, shape (k, 2), as `fine_path` makes it.
    cell
        Width of the table's squares.
    pixels
        Width and height of the picture.
    """
    width, height = pixels
    x, y = pixel_grid(0, width, 0, height, pixels, 1)
    colours = _table(view, view.rays(x, y), cell)
    _draw_path(colours, view, path, pixels)
    frame = frame.astype(np.float32)
    middle = position + frame @ toy.middle
    shadow = middle - _LIGHT * middle[2] / _LIGHT[2]
    for drawn, about, reach in ((_cast_shadow, shadow, (1.7, 2.1, 0.02)), (_shade, middle, (1.0, 1.0, 1.0))):
        area = pixels_of_box(view, about, np.array(reach), pixels)
        left, right, top, bottom = area
        if left < right and top < bottom:
            drawn(colours[top:bottom, left:right], toy, view, position, frame, area, pixels)
    return (np.clip(colours, 0, 1) * 255 + 0.5).astype(np.uint8)


def _table(view: View, rays: Array, cell: float) -> Array:
    fall = np.minimum(rays[..., 2], -1e-6)
    distance = -view.eye[2] / fall
    seen = rays[..., 2] < -1e-3
    point = view.eye[:2].astype(np.float32) + np.minimum(distance, 1e3)[..., None] * rays[..., :2]
    blur = 0.004 * distance / np.maximum(-rays[..., 2], 0.05) / cell
    ink = np.zeros(distance.shape)
    for every, width, strength in ((1.0, 0.02, 0.5), (5.0, 0.045, 0.9)):
        for k in (0, 1):
            off = np.abs((point[..., k] / cell + every / 2) % every - every / 2)
            line = np.clip((width + blur - off) / np.maximum(2 * blur, 1e-6), 0, 1)
            ink = np.maximum(ink, strength * line * np.minimum(1.0, width / np.maximum(blur, width)))
    colour = _TABLE + ink[..., None] * (_LINE - _TABLE)
    fog = np.where(seen, np.clip((distance - 12) / 20, 0, 1), 1.0)[..., None]
    return np.asarray(colour + fog * (_SKY - colour))


def fine_path(trace: Array, touching: NDArray[np.bool_]) -> tuple[Array, NDArray[np.intp]]:
    """Points near enough to look like a line, and how many there are up to every corner of a path.

    There are none between corners of which one is not `touching` the table.
    """
    steps = np.maximum(np.ceil(np.linalg.norm(np.diff(trace, axis=0), axis=1) / 0.012), 1).astype(int)
    steps[~(touching[1:] & touching[:-1])] = 0
    number = np.repeat(np.arange(len(steps)), steps)
    share = (np.arange(len(number)) - np.repeat(np.cumsum(steps) - steps, steps)) / steps[number]
    path = trace[number] + share[:, None] * (trace[number + 1] - trace[number])
    return path, np.concatenate([[0], np.cumsum(steps)])


def _draw_path(colours: Array, view: View, path: Array, pixels: tuple[int, int]) -> None:
    width, height = pixels
    points = view.project(np.concatenate([path, np.zeros((len(path), 1))], axis=1))
    column = ((points[:, 0] + 1) * width / 2).astype(int)
    row = ((height - points[:, 1] * width) / 2).astype(int)
    for dx, dy in ((0, 0), (1, 0), (0, 1)):
        i, j = row + dy, column + dx
        inside = (i >= 0) & (i < height) & (j >= 0) & (j < width)
        colours[i[inside], j[inside]] = _TRACE


def _shade(
    colours: Array,
    toy: Toy,
    view: View,
    position: Array,
    frame: Array,
    area: tuple[int, int, int, int],
    pixels: tuple[int, int],
) -> None:
    """Draw the toy into an area of the picture, four rays a pixel."""
    fine = 2
    rays = view.rays(*pixel_grid(*area, pixels, fine))
    ahead = rays @ frame
    eye = ((view.eye - position) @ frame).astype(np.float32)
    distance, normal = toy.meet(np.broadcast_to(eye, rays.shape), ahead)
    hit = np.nonzero(distance < _FAR)
    point = eye + distance[hit][..., None] * ahead[hit]
    paint = np.zeros((*rays.shape[:-1], 4), np.float32)
    light = (_LIGHT @ frame).astype(np.float32)
    lit = _lit(toy, point, normal[hit], light, -ahead[hit], frame[2])
    paint[hit] = np.concatenate([lit, np.ones((len(lit), 1))], axis=1)
    paint = paint.reshape(colours.shape[0], fine, colours.shape[1], fine, 4).mean(axis=(1, 3))
    colours *= 1 - paint[..., 3:]
    colours += paint[..., :3]


def _cast_shadow(
    colours: Array,
    toy: Toy,
    view: View,
    position: Array,
    frame: Array,
    area: tuple[int, int, int, int],
    pixels: tuple[int, int],
) -> None:
    """Darken the table where the toy is between it and the light."""
    rays = view.rays(*pixel_grid(*area, pixels, 1))
    ground = np.where(rays[..., 2] < -1e-3, -view.eye[2] / np.minimum(rays[..., 2], -1e-3), 1e3)
    foot = (view.eye + ground[..., None] * rays - position).astype(np.float32) @ frame
    towards = (_LIGHT @ frame).astype(np.float32)
    dark = toy.meet(foot, np.broadcast_to(towards, foot.shape))[0] < _FAR
    colours[dark] *= 0.58


def _lit(toy: Toy, point: Array, normal: Array, light: Array, eye: Array, upward: Array) -> Array:
    sun = np.clip(normal @ light, 0, None)
    sky = 0.5 + 0.5 * (normal @ upward)
    half = light + eye
    half /= np.linalg.norm(half, axis=-1, keepdims=True)
    gloss = 0.4 * np.clip(np.einsum("...i,...i", normal, half), 0, 1) ** 40
    return np.asarray(toy.paint(point) * (0.42 + 0.28 * sky + 0.42 * sun)[..., None] + gloss[..., None])


CAPTION = tuple(round(255 * value) for value in to_rgb(INK))
"""Colour of writing on a picture."""
