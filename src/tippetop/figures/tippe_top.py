"""The toy itself, in three stages of turning over (the report's Fig. 1)."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from tippetop.figures import drawing as draw
from tippetop.figures.drawing import Array
from tippetop.figures.style import ACCENT, MUTED, TABLE, TABLE_EDGE, house_style
from tippetop.figures.toy import Camera, centre_height, shadow_image, toy_image

_STAGES = (
    (0.0, "Upright, $\\theta = 0$", "as it rests, and as it is launched"),
    (75.0, "Turning over, $\\theta = 75°$", "the sphere rubs on the table"),
    (180.0, "Inverted, $\\theta = 180°$", "it spins on its stem, higher up"),
)


def tippe_top_drawing() -> Figure:
    """Return the toy upright, half-way and inverted, side by side.

    The spin keeps its sense in space throughout; the centre of mass rises.
    """
    with house_style():
        camera = Camera(np.radians(14))
        figure, axes = draw.canvas((-1.85, 8.85), (-1.72, 3.5))
        _table(axes, (-1.7, 8.7), camera)
        for number, (tilt, title, text) in enumerate(_STAGES):
            x = 3.5 * number
            _stage(axes, x, np.radians(tilt), camera)
            draw.label(axes, (x, -1.1), title, size=10.5)
            draw.label(axes, (x, -1.44), text, color=MUTED, size=9)
        draw.label(axes, (0.55, 2.94), "spin", color=ACCENT, size=9.5, ha="left")
        draw.label(axes, (0.27, 2.1), "stem", size=9.5, ha="left")
    return figure


def _table(axes: Axes, ends: tuple[float, float], camera: Camera) -> None:
    left, right = ends
    far, near = (camera.up[1] * y for y in (5.5, -2.7))
    draw.filled(axes, draw.box(left, right, near, far), TABLE, z=0)
    draw.filled(axes, draw.box(left, right, near - 0.09, near), TABLE_EDGE, z=0)
    draw.line(axes, [(left, far), (right, far)], TABLE_EDGE, 1.0, z=0)


def _stage(axes: Axes, x: float, tilt: float, camera: Camera, eccentricity: float = 0.3) -> None:
    """Draw one toy: its shadow, its picture, its spin, and how high its centre of mass is."""
    azimuth = np.radians(-35)
    axis = np.array([np.sin(tilt) * np.cos(azimuth), np.sin(tilt) * np.sin(azimuth), np.cos(tilt)])
    centre = np.array([x, 0.0, centre_height(axis)])
    o, mass = camera.project(centre), camera.project(centre - eccentricity * axis)
    flat = 2 * camera.up[1]
    for offset, spread, strength in ((0.3, 0.95, 0.24), (0.06, 0.36, 0.45)):
        draw.picture(axes, shadow_image(offset, spread, strength), (x - 2, x + 2, -flat, flat), z=0.5)
    image, reach = toy_image(axis, camera)
    _spin(axes, centre, camera)
    draw.picture(axes, image, (o[0] - reach, o[0] + reach, o[1] - reach, o[1] + reach), z=3)
    draw.mass_centre(axes, mass, radius=0.085)
    draw.line(axes, [(x - 1.38, mass[1]), (x - 1.04, mass[1])], MUTED, 0.9)
    draw.dimension(axes, (x - 1.25, 0), (x - 1.25, mass[1]))
    draw.label(axes, (x - 1.25, mass[1] + 0.05), "CM", size=9.5, va="bottom")


def _spin(axes: Axes, centre: Array, camera: Camera, height: float = 3.0, radius: float = 0.42) -> None:
    """Draw the vertical through the sphere's centre and an arrow turning about it, the far part behind it."""
    ends = centre * [1, 1, 0] + [[0, 0, centre[2]], [0, 0, height + 0.4]]
    ring = draw.arc([1, 0, 0], [0, 1, 0], np.radians(325), np.radians(25)) * radius + centre * [1, 1, 0]
    ring[:, 2] = height
    draw.arrow(axes, camera.project(ring), ACCENT, width=1.8, head=0.2, z=2.5)
    back, front = camera.project(ends)
    draw.line(axes, [back, front], MUTED, 1.0, dashed=True, z=2.4)
