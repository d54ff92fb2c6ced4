"""Pictures of the toy on its table, by one ray or more per pixel; lengths in sizes of the toy."""

from typing import Any, NamedTuple

import numpy as np
from matplotlib.colors import to_rgb
from numpy.typing import NDArray

from tippetop.figures.appearance import SCENES
from tippetop.figures.toy import FAR, Toy
from tippetop.problem.table import Table

Array = NDArray[np.floating[Any]]
LEVEL = Table()
Area = tuple[int, int, int, int]
"""Area of a picture, pixels: first and end column, first and end row."""

_LIGHT = np.array([-0.35, -0.60, 1.0]) / np.linalg.norm([-0.35, -0.60, 1.0])
"""Unit vector to the light."""

_SPREAD = 0.42
"""Half the width of the picture over its depth."""

_TABLE, _LINE, _SKY, _TRACE = (
    np.array(to_rgb(SCENES["light"][name])) for name in ("table", "line", "background", "trace")
)


_POINT_DISTANCE = 0.012
"""Distance between points that are drawn as a line: about a pixel."""


class View(NamedTuple):
    """Camera of a picture."""

    eye: Array
    """Place of the camera."""
    right: Array
    up: Array
    ahead: Array
    """Unit vectors to the right and upwards in the picture, and from the eye into it."""
    pixels: tuple[int, int]
    """Width and height of the picture."""

    def rays(self, area: Area, fine: int) -> Array:
        """Return unit directions of `fine` x `fine` rays through each pixel of an area, (rows,
        columns, 3).
        """
        first_column, end_column, first_row, end_row = area
        width, height = self.pixels
        x = (
            first_column + (np.arange((end_column - first_column) * fine) + 0.5) / fine
        ) * 2 / width - 1
        y = (
            height - 2 * (first_row + (np.arange((end_row - first_row) * fine) + 0.5) / fine)
        ) / width
        across = np.multiply.outer(x, _SPREAD * self.right)
        upward = np.multiply.outer(y, _SPREAD * self.up)
        direction = (self.ahead + across + upward[:, None]).astype(np.float32)
        return np.asarray(
            direction / np.sqrt(np.einsum("...i,...i", direction, direction))[..., None]
        )

    def project(self, points: Array) -> tuple[Array, Array]:
        """Return the columns and the rows, in pixels, of points in space of shape (k, 3)."""
        width, height = self.pixels
        offset = points - self.eye
        depth = np.maximum(offset @ self.ahead, 1e-6) * _SPREAD * 2 / width
        return width / 2 + offset @ self.right / depth, height / 2 - offset @ self.up / depth

    def area(self, about: Array, reach: Array) -> Area:
        """Return the area of the picture that a box may cover.

        The box has its centre at `about` and half its sides `reach` along the coordinate axes.
        """
        width, height = self.pixels
        corners = np.array([[i, j, k] for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)])
        columns, rows = self.project(about + corners * reach)
        first_column, end_column = np.clip([columns.min(), columns.max() + 1], 0, width).astype(int)
        first_row, end_row = np.clip([rows.min(), rows.max() + 1], 0, height).astype(int)
        return int(first_column), int(end_column), int(first_row), int(end_row)


def view_of(target: Array, offset: Array, pixels: tuple[int, int], table: Table = LEVEL) -> View:
    """Return the camera at an offset from its target, with the vertical upwards in the picture.

    The offset is stated beside a level table. The camera stands on level ground beside a table that
    slopes.
    """
    across = np.array([-np.sin(table.azimuth), np.cos(table.azimuth), 0.0])
    offset, vertical = (
        _turned(vector, across, -table.slope) for vector in (offset, np.array([0.0, 0.0, 1.0]))
    )
    ahead = -offset / np.linalg.norm(offset)
    right = np.cross(ahead, vertical)
    right /= np.linalg.norm(right)
    return View(target + offset, right, np.cross(right, ahead), ahead, pixels)


def _turned(vector: Array, about: Array, angle: float) -> Array:
    """Return a vector turned about a unit vector by an angle, rad."""
    along = (about @ vector) * about
    turned: Array = (
        along + np.cos(angle) * (vector - along) + np.sin(angle) * np.cross(about, vector)
    )
    return turned


def picture(
    toy: Toy, view: View, position: Array, frame: Array, path: Array, cell: float
) -> NDArray[np.uint8]:
    """Return the picture of one instant, shape (height, width, 3).

    The toy's centre of mass is at `position`, and its axes are the columns of `frame`, shape (3,
    3). `path` are points along the path of the contact point up to this instant, shape (k, 2), from
    `fine_path`; `cell` is the width of the table's squares.
    """
    width, height = view.pixels
    colours = _table(view.eye, view.rays((0, width, 0, height), 1), cell)
    _draw_path(colours, view, path)
    frame = frame.astype(np.float32)
    middle = position + frame @ toy.middle
    shadow = middle - _LIGHT * middle[2] / _LIGHT[2]
    for draw, about, reach, fine in (
        (_cast_shadow, shadow, (1.7 * toy.reach, 2.1 * toy.reach, 0.02), 1),
        (_draw_toy, middle, 3 * (toy.reach,), 2),
    ):
        first_column, end_column, first_row, end_row = area = view.area(about, np.array(reach))
        if first_column < end_column and first_row < end_row:
            draw(
                colours[first_row:end_row, first_column:end_column],
                toy,
                view.eye,
                view.rays(area, fine),
                position,
                frame,
            )
    return (np.clip(colours, 0, 1) * 255 + 0.5).astype(np.uint8)


def _table(eye: Array, rays: Array, cell: float) -> Array:
    """Return the colours of the empty table and the sky along rays."""
    fall = np.minimum(rays[..., 2], -1e-6)
    distance = -eye[2] / fall
    seen = rays[..., 2] < -1e-3
    point = eye[:2].astype(np.float32) + np.minimum(distance, 1e3)[..., None] * rays[..., :2]
    blur = 0.004 * distance / np.maximum(-rays[..., 2], 0.05) / cell
    ink = np.zeros(distance.shape)
    for every, width, strength in ((1.0, 0.02, 0.5), (5.0, 0.045, 0.9)):
        for k in (0, 1):
            off = np.abs((point[..., k] / cell + every / 2) % every - every / 2)
            line = np.clip((width + blur - off) / np.maximum(2 * blur, 1e-6), 0, 1)
            ink = np.maximum(
                ink, strength * line * np.minimum(1.0, width / np.maximum(blur, width))
            )
    colour = _TABLE + ink[..., None] * (_LINE - _TABLE)
    fog = np.where(seen, np.clip((distance - 12) / 20, 0, 1), 1.0)[..., None]
    return np.asarray(colour + fog * (_SKY - colour))


def fine_path(trace: Array, touching: NDArray[np.bool_]) -> tuple[Array, NDArray[np.intp]]:
    """Return closely spaced points along a path, and their number up to each corner of the path.

    Between two corners there are points only if both are `touching` the table.
    """
    lengths = np.linalg.norm(np.diff(trace, axis=0), axis=1)
    steps = np.maximum(np.ceil(lengths / _POINT_DISTANCE), 1).astype(int)
    steps[~(touching[1:] & touching[:-1])] = 0
    number = np.repeat(np.arange(len(steps)), steps)
    share = (np.arange(len(number)) - np.repeat(np.cumsum(steps) - steps, steps)) / steps[number]
    path = trace[number] + share[:, None] * (trace[number + 1] - trace[number])
    return path, np.concatenate([[0], np.cumsum(steps)])


def _draw_path(colours: Array, view: View, path: Array) -> None:
    """Draw the points of a path, each two pixels wide and high."""
    width, height = view.pixels
    column, row = (at.astype(int) for at in view.project(np.pad(path, ((0, 0), (0, 1)))))
    for dx, dy in ((0, 0), (1, 0), (0, 1)):
        i, j = row + dy, column + dx
        inside = (i >= 0) & (i < height) & (j >= 0) & (j < width)
        colours[i[inside], j[inside]] = _TRACE


def _draw_toy(
    colours: Array, toy: Toy, eye: Array, rays: Array, position: Array, frame: Array
) -> None:
    """Draw the toy into an area of the picture; `rays` has several rays per pixel."""
    start, ahead = ((eye - position) @ frame).astype(np.float32), rays @ frame
    hits = toy.meet(np.broadcast_to(start, rays.shape), ahead)
    hit = np.nonzero(hits.distances < FAR)
    point = start + hits.distances[hit][..., None] * ahead[hit]
    paint = np.zeros((*rays.shape[:-1], 4), np.float32)
    light = (_LIGHT @ frame).astype(np.float32)
    lit = toy.lit(point, hits.some(hit), light, -ahead[hit], frame[2])
    paint[hit] = np.concatenate([lit, np.ones((len(lit), 1))], axis=1)
    rows, columns, _ = colours.shape
    paint = paint.reshape(rows, len(rays) // rows, columns, len(rays) // rows, 4).mean(axis=(1, 3))
    colours *= 1 - paint[..., 3:]
    colours += paint[..., :3]


def _cast_shadow(
    colours: Array, toy: Toy, eye: Array, rays: Array, position: Array, frame: Array
) -> None:
    """Darken the points of the table from which the toy hides the light."""
    ground = np.where(rays[..., 2] < -1e-3, -eye[2] / np.minimum(rays[..., 2], -1e-3), 1e3)
    foot = (eye + ground[..., None] * rays - position).astype(np.float32) @ frame
    towards = (_LIGHT @ frame).astype(np.float32)
    dark = toy.meet(foot, np.broadcast_to(towards, foot.shape)).distances < FAR
    colours[dark] *= 0.58
