"""A camera for pictures made without a browser."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.floating[Any]]


class View(NamedTuple):
    """A camera: where it is, which way its picture's right, up and depth go, and its width over its depth."""

    eye: Array
    right: Array
    up: Array
    ahead: Array
    spread: float

    def rays(self, x: Array, y: Array) -> Array:
        """Unit directions of rays through picture points, in half widths from its middle, shape (..., 3)."""
        kind = x.dtype
        ahead, right, up = (
            v.astype(kind) for v in (self.ahead, self.spread * self.right, self.spread * self.up)
        )
        direction = ahead + x[..., None] * right + y[..., None] * up
        return np.asarray(direction / np.sqrt(np.einsum("...i,...i", direction, direction))[..., None])

    def project(self, points: Array) -> Array:
        """Picture points, in half widths from the middle, of points in space, shape (..., 2)."""
        offset = points - self.eye
        depth = np.maximum(offset @ self.ahead, 1e-6) * self.spread
        return np.stack([offset @ self.right, offset @ self.up], axis=-1) / depth[..., None]


def view_of(target: Array, offset: Array, spread: float = 0.42) -> View:
    """A camera at an offset from what it looks at."""
    ahead = -offset / np.linalg.norm(offset)
    right = np.cross(ahead, [0.0, 0.0, 1.0])
    right /= np.linalg.norm(right)
    return View(target + offset, right, np.cross(right, ahead), ahead, spread)


def pixel_grid(
    left: int, right: int, top: int, bottom: int, pixels: tuple[int, int], fine: int
) -> tuple[Array, Array]:
    """Picture points of pixels, `fine` of them across each."""
    width, height = pixels
    x = (left + (np.arange((right - left) * fine) + 0.5) / fine) * 2 / width - 1
    y = (height - 2 * (top + (np.arange((bottom - top) * fine) + 0.5) / fine)) / width
    across, upward = np.meshgrid(x.astype(np.float32), y.astype(np.float32))
    return across, upward


def pixels_of_box(
    view: View, about: Array, reach: Array, pixels: tuple[int, int]
) -> tuple[int, int, int, int]:
    """The pixels that a box in space may cover: left, right, top, bottom."""
    width, height = pixels
    corners = np.array([[i, j, k] for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)])
    points = view.project(about + corners * reach)
    columns, rows = (points[:, 0] + 1) * width / 2, (height - points[:, 1] * width) / 2
    left, right = np.clip([columns.min(), columns.max() + 1], 0, width).astype(int)
    top, bottom = np.clip([rows.min(), rows.max() + 1], 0, height).astype(int)
    return int(left), int(right), int(top), int(bottom)
