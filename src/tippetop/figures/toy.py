"""A shaded picture of the tippe top, seen along parallel rays from a little above the table.

The toy is a solid of revolution given by its signed distance; each pixel's ray is followed to the surface
by steps of that distance, and the surface is lit from above on the left. Lengths are in sphere radii.
"""

from __future__ import annotations

import numpy as np
from matplotlib.colors import to_rgb

from tippetop.figures.drawing import Array, unit
from tippetop.figures.style import CONVERGED

FACE = 0.42
"""Distance from the sphere's centre to the flat face, along the axis."""
STEM_END = 1.42
"""Distance from the sphere's centre to the end of the stem."""

_STEM_RADIUS, _KNOB_RADIUS = 0.12, 0.165
_REACH = 1.5
_LIGHT = unit([-0.55, -0.6, 1.0])
_WOOD, _CREAM, _PAINT = (np.array(to_rgb(c)) for c in ("#D9AE78", "#F4E7CF", CONVERGED))


class Camera:
    """Parallel projection of space (x right, y away, z up) from an elevation in radians."""

    def __init__(self, elevation: float) -> None:
        sine, cosine = np.sin(elevation), np.cos(elevation)
        self.right = np.array([1.0, 0.0, 0.0])
        self.up = np.array([0.0, sine, cosine])
        self.towards = np.array([0.0, -cosine, sine])

    def project(self, points: Array) -> Array:
        """Return the picture coordinates of points given as rows."""
        return np.stack([points @ self.right, points @ self.up], axis=-1)


def centre_height(axis: Array) -> float:
    """Return the height of the sphere's centre when the toy touches the table, by its sphere or its stem."""
    knob = STEM_END - _KNOB_RADIUS
    return float(max(1.0, _KNOB_RADIUS - knob * axis[2]))


def toy_image(axis: Array, camera: Camera, pixels: int = 420, oversample: int = 2) -> tuple[Array, float]:
    """Return the toy's picture (RGBA, rows from the bottom up) about the sphere's centre, and its half width.

    `axis` is the unit vector from the sphere's centre to the stem, in space.
    """
    n = pixels * oversample
    grid = (np.arange(n) + 0.5) / n * 2 * _REACH - _REACH
    across, upward = np.meshgrid(grid, grid)
    origins = across.reshape(-1, 1) * camera.right + upward.reshape(-1, 1) * camera.up
    hit, points = _trace(origins, camera.towards, axis)
    rgba = np.zeros((n * n, 4))
    rgba[hit, :3] = _lit(points[hit], axis, camera.towards)
    rgba[hit, 3] = 1.0
    blocks = rgba.reshape(pixels, oversample, pixels, oversample, 4).mean(axis=(1, 3))
    return _bled(blocks), _REACH


def _bled(blocks: Array) -> Array:
    """Undo the averaging of colour with empty space, and spread the edge's colour one pixel outwards.

    Without it, a viewer that interpolates the picture draws a dark fringe around it.
    """
    around = sum(
        (np.roll(blocks, shift, axis) for axis in (0, 1) for shift in (-1, 1)), np.zeros_like(blocks)
    )
    source = np.where(blocks[..., 3:] > 0, blocks, around)
    blocks[..., :3] = source[..., :3] / np.maximum(source[..., 3:], 1e-9)
    return blocks


def shadow_image(offset: float, spread: float, strength: float, pixels: int = 160) -> Array:
    """Return a soft round shadow (RGBA) on the square of half width 2, darkest `offset` to the right."""
    grid = np.linspace(-2, 2, pixels)
    x, y = np.meshgrid(grid, grid)
    rgba = np.zeros((pixels, pixels, 4))
    fade = np.clip(1 - (x**2 + y**2) / 4, 0, 1)
    rgba[..., 3] = strength * fade * np.exp(-(((x - offset) ** 2 + y**2) / spread**2))
    return rgba


def _trace(origins: Array, towards: Array, axis: Array) -> tuple[Array, Array]:
    """Follow each ray to the surface; return which rays arrive, and where."""
    depth = np.full(len(origins), _REACH)
    hit = np.zeros(len(origins), dtype=bool)
    seen = axis - (axis @ towards) * towards
    along_stem = np.clip(origins @ seen / max(float(seen @ seen), 1e-9), 0, STEM_END)[:, None] * seen
    near_stem = ((origins - along_stem) ** 2).sum(axis=1) < (1.1 * _KNOB_RADIUS) ** 2
    active = np.flatnonzero(near_stem | ((origins**2).sum(axis=1) < 1.01))
    for _ in range(80):
        distance = _distance(*_profile(origins[active] + depth[active, None] * towards, axis))
        depth[active] -= 0.9 * distance
        hit[active[distance < 2e-3]] = True
        active = active[(distance >= 2e-3) & (depth[active] > -_REACH)]
    return hit, origins + depth[:, None] * towards


def _profile(points: Array, axis: Array) -> tuple[Array, Array]:
    """Return the coordinates of points along the axis and away from it."""
    along = points @ axis
    return along, np.sqrt(np.maximum((points**2).sum(axis=1) - along**2, 1e-12))


def _distance(along: Array, away: Array) -> Array:
    return -_smooth_max(-_bowl(along, away), -_stem(along, away), 0.10)


def _bowl(along: Array, away: Array) -> Array:
    return _smooth_max(np.hypot(along, away) - 1.0, along - FACE, 0.05)


def _stem(along: Array, away: Array) -> Array:
    knob = STEM_END - _KNOB_RADIUS
    beyond = along - np.clip(along, 0.0, knob)
    swell = _STEM_RADIUS + (_KNOB_RADIUS - _STEM_RADIUS) * np.clip((along - FACE) / (knob - FACE), 0, 1) ** 2
    return np.hypot(away, beyond) - swell


def _smooth_max(a: Array, b: Array, radius: float) -> Array:
    """Return the larger of two distances, the edge where they meet rounded off over `radius`."""
    overlap = np.maximum(radius - np.abs(a - b), 0.0) / radius
    return np.maximum(a, b) + overlap**2 * radius / 4


def _lit(points: Array, axis: Array, towards: Array) -> Array:
    """Return the colours of surface points under one light and a bright sky."""
    along, away = _profile(points, axis)
    step = 1e-4
    slope_along = _distance(along + step, away) - _distance(along - step, away)
    slope_away = _distance(along, away + step) - _distance(along, away - step)
    radial = (points - along[:, None] * axis) / away[:, None]
    normal = slope_along[:, None] * axis + slope_away[:, None] * radial
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    sun = np.clip(normal @ _LIGHT, 0, None)
    sky = 0.5 + 0.5 * normal[:, 2]
    rim = 1 - np.clip(normal @ towards, 0, 1)
    shade = 0.46 + 0.30 * sky + 0.40 * sun - 0.14 * rim**3
    gloss = 0.45 * np.clip(normal @ unit(_LIGHT + towards), 0, 1) ** 45
    return np.clip(_paint(along, away) * shade[:, None] + gloss[:, None], 0, 1)


def _paint(along: Array, away: Array) -> Array:
    colours = np.tile(_PAINT, (len(along), 1))
    colours[(along > FACE - 0.26) & (along < FACE - 0.17)] = _CREAM
    colours[along > FACE - 0.035] = _CREAM
    colours[_stem(along, away) < _bowl(along, away)] = _WOOD
    return colours
