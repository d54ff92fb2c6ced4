"""Primitives of schematic drawings: canvas, arrows, arcs, dimensions, labels, shading.

Points are rows of arrays in data units. A canvas has equal axes and no frame, so a data unit is a
length.
"""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.layout_engine import PlaceHolderLayoutEngine
from matplotlib.patches import Circle, PathPatch, Polygon, Wedge
from matplotlib.path import Path
from numpy.typing import ArrayLike, NDArray

from tippetop.figures.style import INK, MUTED, WIDTH

Array = NDArray[np.float64]


def canvas(xlim: tuple[float, float], ylim: tuple[float, float]) -> tuple[Figure, Axes]:
    """Return a figure of full width filled by frameless equal axes with exactly these limits."""
    height = WIDTH * (ylim[1] - ylim[0]) / (xlim[1] - xlim[0])
    # Without a layout engine, saving would fall back on the constrained layout of the style.
    figure = Figure(figsize=(WIDTH, height), layout=PlaceHolderLayoutEngine(True, False))
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set(xlim=xlim, ylim=ylim, aspect="equal")
    axes.set_axis_off()
    return figure, axes


def unit(vector: ArrayLike) -> Array:
    """Return the unit vector in the direction of a vector."""
    array = np.asarray(vector, dtype=np.float64)
    return array / float(np.linalg.norm(array))


def projection(azimuth: float, elevation: float) -> Array:
    """Return the matrix of a parallel projection, shape (3, 2).

    Points in rows times the matrix are their places in the picture. The columns of the matrix point
    to the right and upwards in the picture; z is up. `azimuth` and `elevation` (rad) are the
    direction to the eye.
    """
    ca, sa, ce, se = np.cos(azimuth), np.sin(azimuth), np.cos(elevation), np.sin(elevation)
    return np.array([[-sa, -se * ca], [ca, -se * sa], [0.0, ce]])


def arc(first: ArrayLike, towards: ArrayLike, angle: float, start: float = 0.0) -> Array:
    """Return points of the unit circle about the origin between two angles, shape (121, 2 or 3).

    The circle lies in the plane of the vectors `first` and `towards`, of two or three components.
    The angles `start` and `angle`, rad, are measured from `first` towards the other vector.
    """
    u = unit(first)
    along = np.asarray(towards, dtype=float)
    w = unit(along - (along @ u) * u)
    t = np.linspace(start, angle, 121)[:, None]
    return np.cos(t) * u + np.sin(t) * w


def line(
    axes: Axes,
    points: ArrayLike,
    color: str = INK,
    width: float = 1.0,
    dashed: bool = False,
    z: float = 2,
) -> None:
    """Draw a polyline."""
    x, y = np.asarray(points, dtype=float).T
    style = (0, (4, 3)) if dashed else "-"
    axes.plot(
        x, y, color=color, lw=width, ls=style, zorder=z, solid_capstyle="butt", dash_capstyle="butt"
    )


def arrow(
    axes: Axes,
    points: ArrayLike,
    color: str = INK,
    width: float = 1.6,
    head: float = 0.11,
    z: float = 4,
) -> None:
    """Draw an arrow along a polyline, its tip on the last point.

    `head` is the length of the arrow's head in data units. On an arc the head lies along the chord
    that it covers, so that it does not seem to leave the curve.
    """
    path = np.asarray(points, dtype=float)
    tip = path[-1]
    if len(path) == 2:
        path = path[0] + np.linspace(0, 1, 101)[:, None] * (tip - path[0])
    shaft = path[np.linalg.norm(path - tip, axis=1) >= 0.65 * head]
    along = unit(tip - shaft[-1])
    across = np.array([-along[1], along[0]]) * 0.36 * head
    base = tip - head * along
    line(axes, shaft, color, width, z=z)
    barbed = [tip, base + across, tip - 0.8 * head * along, base - across]
    axes.add_patch(Polygon(barbed, closed=True, fc=color, ec="none", zorder=z))


def dimension(axes: Axes, start: ArrayLike, end: ArrayLike) -> None:
    """Draw a thin double-headed arrow between two points."""
    middle = (np.asarray(start, dtype=float) + np.asarray(end, dtype=float)) / 2
    for tip in (start, end):
        arrow(axes, [middle, tip], MUTED, width=0.9, head=0.07, z=3)


def label(
    axes: Axes,
    at: ArrayLike,
    text: str,
    *,
    offset: tuple[float, float] = (0.0, 0.0),
    color: str = INK,
    size: float = 11,
    ha: str = "center",
    va: str = "center",
) -> None:
    """Write text at a point, or `offset` data units from it."""
    x, y = np.asarray(at, dtype=float) + offset
    axes.text(x, y, text, color=color, fontsize=size, ha=ha, va=va, zorder=9)


def dot(axes: Axes, at: ArrayLike, radius: float) -> None:
    """Draw a point with a thin white rim, so that it stays visible on lines."""
    x, y = np.asarray(at, dtype=float)
    axes.add_patch(Circle((x, y), radius, fc=INK, ec="white", lw=0.8, zorder=6))


def mass_centre(axes: Axes, at: ArrayLike, radius: float) -> None:
    """Draw the quartered disc that marks a centre of mass."""
    x, y = np.asarray(at, dtype=float)
    axes.add_patch(Circle((x, y), radius, fc="white", ec=INK, lw=1.0, zorder=6))
    for start in (0, 180):
        axes.add_patch(Wedge((x, y), radius, start, start + 90, fc=INK, ec="none", zorder=6))


def out_of_page(axes: Axes, at: ArrayLike, color: str) -> None:
    """Draw the circled point of a vector that comes out of the page."""
    x, y = np.asarray(at, dtype=float)
    axes.add_patch(Circle((x, y), 0.055, fc="white", ec=color, lw=1.4, zorder=6))
    axes.add_patch(Circle((x, y), 0.01815, fc=color, ec="none", zorder=6))


def outline(points: ArrayLike) -> Path:
    """Return the closed path through points."""
    vertices = np.asarray(points, dtype=float)
    return Path(np.vstack([vertices, vertices[:1]]), closed=True)


def box(left: float, right: float, bottom: float, top: float) -> Path:
    """Return a rectangle as a closed path."""
    return outline([(left, bottom), (right, bottom), (right, top), (left, top)])


def filled(
    axes: Axes,
    path: Path,
    face: str = "none",
    edge: str = "none",
    width: float = 1.0,
    alpha: float = 1.0,
    z: float = 1,
) -> PathPatch:
    """Draw a filled path and return its patch; `alpha` is the opacity of the face only."""
    color = (*to_rgb(face), alpha) if face != "none" else "none"
    patch = PathPatch(path, fc=color, ec=edge, lw=width, zorder=z, joinstyle="round")
    axes.add_patch(patch)
    return patch


def picture(
    axes: Axes, rgba: Array, extent: Sequence[float], z: float = 1, clip: PathPatch | None = None
) -> None:
    """Place an image on the canvas.

    Rows of `rgba` go from the bottom up; `extent` is (left, right, bottom, top) in data units. Only
    what lies within the patch `clip` is shown.
    """
    left, right, bottom, top = extent
    image = axes.imshow(
        rgba,
        extent=(left, right, bottom, top),
        origin="lower",
        interpolation="bilinear",
        aspect="equal",
        zorder=z,
    )
    if clip is not None:
        image.set_clip_path(clip)
