"""Drawing of the Euler angles of equation (2.1) (the report's Fig. 2)."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from scipy.spatial.transform import Rotation

import tippetop.figures.drawing as draw
from tippetop.figures.drawing import Array
from tippetop.figures.style import ACCENT, CONVERGED, INK, MUTED, house_style

_PRECESSION, _NUTATION, _ROTATION = np.radians((60.0, 34.0, 45.0))


@house_style()
def euler_angles_drawing() -> Figure:
    """Return the Euler angles: alpha about z, beta about the line of nodes N, gamma about Z.

    Space axes x, y, z are grey, body axes X, Y, Z blue; everything is drawn by one parallel
    projection.
    """
    figure, axes = draw.canvas((-1.22, 1.98), (-0.9, 1.32))
    view = draw.projection(azimuth=np.radians(35), elevation=np.radians(22))
    turned = Rotation.from_euler("ZXZ", [_PRECESSION, _NUTATION, _ROTATION])
    space, body = np.eye(3), turned.as_matrix().T
    nodes = np.array([np.cos(_PRECESSION), np.sin(_PRECESSION), 0.0])
    _discs(axes, view, space, body, nodes)
    _frame(axes, view, space, ("x", "y", "z"), MUTED)
    _frame(axes, view, body, ("X", "Y", "Z"), CONVERGED)
    draw.line(axes, np.outer([-1.1, 0.0], nodes @ view), INK, 1.1, dashed=True, z=3)
    _frame(axes, view, nodes[None], "N", INK)
    _euler_arcs(axes, view, space, body, nodes)
    _euler_key(axes, (1.08, 1.2))
    return figure


def _discs(axes: Axes, view: Array, space: Array, body: Array, nodes: Array) -> None:
    """Draw the planes xy and XY as discs; the half of XY below xy is drawn first."""
    across = np.cross(body[2], nodes)
    for start, order in ((np.pi, 0.2), (0.0, 1.2)):
        half = draw.arc(nodes, across, start + np.pi, start) @ view
        draw.filled(axes, draw.outline(half), CONVERGED, alpha=0.13, z=order)
        draw.line(axes, half, CONVERGED, 1.0, z=order + 0.1)
    level = draw.arc(space[0], space[1], 2 * np.pi) @ view
    draw.filled(axes, draw.outline(level), MUTED, alpha=0.16, z=0.8)
    draw.line(axes, level, MUTED, 1.0, z=0.9)


def _frame(axes: Axes, view: Array, frame: Array, names: Sequence[str], color: str) -> None:
    for direction, name in zip(frame, names, strict=True):
        tip = direction @ view
        draw.arrow(axes, [0 * tip, 1.2 * tip], color, width=1.6, head=0.09)
        draw.label(
            axes, 1.2 * tip + 0.09 * draw.unit(tip), f"$\\mathbf{{{name}}}$", color=color, size=12
        )


def _euler_arcs(axes: Axes, view: Array, space: Array, body: Array, nodes: Array) -> None:
    arcs = (
        ("\\alpha", space[0], nodes, _PRECESSION, 0.6),
        ("\\beta", space[2], body[2], _NUTATION, 0.75),
        ("\\gamma", nodes, body[0], _ROTATION, 0.55),
    )
    for name, first, towards, angle, radius in arcs:
        curve = draw.arc(first, towards, angle) @ view
        draw.arrow(axes, radius * curve, ACCENT, width=1.6, head=0.075, z=5)
        middle = curve[len(curve) // 2]
        draw.label(
            axes, radius * middle + 0.1 * draw.unit(middle), f"${name}$", color=ACCENT, size=13
        )
    draw.dot(axes, (0, 0), radius=0.025)


def _euler_key(axes: Axes, at: tuple[float, float]) -> None:
    turns = (("\\alpha", "z", "x", "N"), ("\\beta", "N", "z", "Z"), ("\\gamma", "Z", "N", "X"))
    rows = [
        (
            f"${angle}$",
            f"about $\\mathbf{{{axis}}}$, from $\\mathbf{{{first}}}$ to $\\mathbf{{{last}}}$",
        )
        for angle, axis, first, last in turns
    ]
    for row, (symbol, text) in enumerate([*rows, ("$\\mathbf{N}$", "line of nodes")]):
        y = at[1] - 0.15 * row
        draw.label(
            axes, (at[0], y), symbol, color=ACCENT if row < len(rows) else INK, va="baseline"
        )
        draw.label(axes, (at[0] + 0.1, y), text, size=9.5, ha="left", va="baseline")
