"""Drawing of the toy in three stages of turning over (the report's Fig. 1), along parallel rays."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from scipy.spatial.transform import Rotation

from tippetop.figures import drawing as draw
from tippetop.figures.drawing import Array
from tippetop.figures.style import ACCENT, MUTED, TABLE, TABLE_EDGE, house_style
from tippetop.figures.toy import FAR, Toy
from tippetop.problem.presets import REPORT

_LIGHT = draw.unit([-0.55, -0.6, 1.0])
_REACH = 1.05
"""Half the width of the picture of a toy, in radii."""
_STAGES = (
    (0.0, "Upright, $\\theta = 0$", "as it rests, and as it is launched"),
    (75.0, "Turning over, $\\theta = 75°$", "the sphere slides on the table"),
    (180.0, "Inverted, $\\theta = 180°$", "it spins on its stem, higher up"),
)


@house_style()
def tippe_top_drawing() -> Figure:
    """Return the toy upright, half-way and inverted, side by side.

    The spin keeps its sense in space throughout; the centre of mass rises.
    """
    view = draw.projection(azimuth=np.radians(-90), elevation=np.radians(14))
    figure, axes = draw.canvas((-1.85, 8.85), (-1.72, 3.5))
    _table(axes, (-1.7, 8.7), view)
    for number, (tilt, title, text) in enumerate(_STAGES):
        x = 3.5 * number
        _stage(axes, x, np.radians(tilt), view)
        draw.label(axes, (x, -1.1), title, size=10.5)
        draw.label(axes, (x, -1.44), text, color=MUTED, size=9)
    draw.label(axes, (0.55, 2.94), "spin", color=ACCENT, size=9.5, ha="left")
    draw.label(axes, (0.27, 1.8), "stem", size=9.5, ha="left")
    return figure


def _table(axes: Axes, ends: tuple[float, float], view: Array) -> None:
    left, right = ends
    far, near = (view[1, 1] * y for y in (5.5, -2.7))
    draw.filled(axes, draw.box(left, right, near, far), TABLE, z=0)
    draw.filled(axes, draw.box(left, right, near - 0.09, near), TABLE_EDGE, z=0)
    draw.line(axes, [(left, far), (right, far)], TABLE_EDGE, 1.0, z=0)


def _stage(axes: Axes, x: float, tilt: float, view: Array) -> None:
    """Draw one toy with its shadow, its spin and the height of its centre of mass."""
    toy, frame = Toy(REPORT), Rotation.from_euler("ZY", [np.radians(-35), tilt]).as_matrix()
    centre = np.array([x, 0.0, 1.0])
    o, mass = centre @ view, (centre - frame @ toy.middle) @ view
    flat = 2 * view[1, 1]
    for offset, spread, strength in ((0.3, 0.95, 0.24), (0.06, 0.36, 0.45)):
        draw.picture(axes, _shadow(offset, spread, strength), (x - 2, x + 2, -flat, flat), z=0.5)
    _spin(axes, centre, view)
    place = (o[0] - _REACH, o[0] + _REACH, o[1] - _REACH, o[1] + _REACH)
    draw.picture(axes, _picture(toy, frame, view), place, z=3)
    draw.mass_centre(axes, mass, radius=0.085)
    draw.line(axes, [(x - 1.38, mass[1]), (x - 1.04, mass[1])], MUTED, 0.9)
    draw.dimension(axes, (x - 1.25, 0), (x - 1.25, mass[1]))
    draw.label(axes, (x - 1.25, mass[1] + 0.05), "CM", size=9.5, va="bottom")


def _spin(
    axes: Axes, centre: Array, view: Array, height: float = 3.0, radius: float = 0.42
) -> None:
    """Draw the vertical through the sphere's centre, and an arrow that turns about it."""
    ends = centre * [1, 1, 0] + [[0, 0, centre[2]], [0, 0, height + 0.4]]
    ring = draw.arc([1, 0, 0], [0, 1, 0], np.radians(325), np.radians(25)) * radius + centre * [
        1,
        1,
        0,
    ]
    ring[:, 2] = height
    draw.arrow(axes, ring @ view, ACCENT, width=1.8, head=0.2, z=2.5)
    draw.line(axes, ends @ view, MUTED, 1.0, dashed=True, z=2.4)


def _picture(toy: Toy, frame: Array, view: Array, pixels: int = 300, oversample: int = 2) -> Array:
    """Return the picture of the toy about its sphere's centre: RGBA, rows from the bottom up."""
    n = pixels * oversample
    grid = ((np.arange(n) + 0.5) / n * 2 - 1) * _REACH
    across, upward = np.meshgrid(grid, grid)
    towards = np.cross(*view.T)
    start = np.stack([across, upward], axis=-1) @ view.T + 2 * towards
    start, ahead, light = start @ frame + toy.middle, -towards @ frame, _LIGHT @ frame
    hits = toy.meet(start, np.broadcast_to(ahead, start.shape))
    hit = hits.distances < FAR
    rgba = np.zeros((n, n, 4))
    point = start[hit] + hits.distances[hit][:, None] * ahead
    rgba[hit, :3] = np.clip(toy.lit(point, hits.some(hit), light, -ahead, frame[2]), 0, 1)
    rgba[hit, 3] = 1.0
    return _bled(rgba.reshape(pixels, oversample, pixels, oversample, 4).mean(axis=(1, 3)))


def _bled(blocks: Array) -> Array:
    """Undo the averaging of colours with empty space, and spread the edge's colour by one pixel.

    A viewer that interpolates the picture would otherwise draw a dark fringe around it.
    """
    around = sum(
        (np.roll(blocks, shift, axis) for axis in (0, 1) for shift in (-1, 1)),
        np.zeros_like(blocks),
    )
    source = np.where(blocks[..., 3:] > 0, blocks, around)
    blocks[..., :3] = source[..., :3] / np.maximum(source[..., 3:], 1e-9)
    return blocks


def _shadow(offset: float, spread: float, strength: float, pixels: int = 160) -> Array:
    """Return a soft round shadow (RGBA) on a square of half width 2, darkest at `offset` to the
    right.
    """
    grid = np.linspace(-2, 2, pixels)
    x, y = np.meshgrid(grid, grid)
    rgba = np.zeros((pixels, pixels, 4))
    fade = np.clip(1 - (x**2 + y**2) / 4, 0, 1)
    rgba[..., 3] = strength * fade * np.exp(-(((x - offset) ** 2 + y**2) / spread**2))
    return rgba
