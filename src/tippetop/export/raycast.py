"""Pictures of the toy on its table without a browser: a ray for every pixel, in sizes of the toy."""

from typing import Any

import numpy as np
from matplotlib.colors import to_rgb
from numpy.typing import NDArray

from tippetop.export.camera import View, pixel_grid, pixels_of_box
from tippetop.figures.looks import SCENES
from tippetop.figures.style import INK
from tippetop.figures.toy import FAR, Toy

Array = NDArray[np.floating[Any]]

_LIGHT = np.array([-0.35, -0.60, 1.0]) / np.linalg.norm([-0.35, -0.60, 1.0])
_TABLE, _LINE, _SKY, _TRACE = (
    np.array(to_rgb(SCENES["light"][name])) for name in ("table", "line", "background", "trace")
)


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
    hit = np.nonzero(distance < FAR)
    point = eye + distance[hit][..., None] * ahead[hit]
    paint = np.zeros((*rays.shape[:-1], 4), np.float32)
    light = (_LIGHT @ frame).astype(np.float32)
    lit = toy.lit(point, normal[hit], light, -ahead[hit], frame[2])
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
    dark = toy.meet(foot, np.broadcast_to(towards, foot.shape))[0] < FAR
    colours[dark] *= 0.58


CAPTION = tuple(round(255 * value) for value in to_rgb(INK))
"""Colour of writing on a picture."""
