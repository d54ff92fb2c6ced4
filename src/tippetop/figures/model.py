"""Drawing of the model: an eccentric sphere on a table, and what acts on it (the report's Fig.
3).
"""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure

import tippetop.figures.drawing as draw
from tippetop.figures.appearance import FACE, KNOB, STEM, STEM_TOP
from tippetop.figures.drawing import Array
from tippetop.figures.style import ACCENT, CONVERGED, INK, MUTED, TABLE, house_style

_AXIS = 1.62
_ECCENTRICITY, _TILT = 0.3, np.radians(50.0)
"""The report's alpha, and a theta at which the labels stay clear of each other."""


@house_style()
def model_drawing() -> Figure:
    """Return the model seen from the side: an eccentric sphere on the table.

    The top leans to the left, so that axis 2 = z x X, with X the horizontal direction of the lean,
    points at the reader.
    """
    figure, axes = draw.canvas((-2.0, 2.15), (-0.7, 2.5))
    points = _Model(_ECCENTRICITY, _TILT)
    _model_body(axes, points)
    _model_axes(axes, points)
    _model_vectors(axes, points)
    _model_measures(axes, points)
    return figure


class _Model:
    """Points and directions of the model in the plane of the page; R = 1, the table at height 0."""

    def __init__(self, eccentricity: float, tilt: float) -> None:
        self.tilt = tilt
        self.lean, self.up = np.array([-1.0, 0.0]), np.array([0.0, 1.0])
        self.n = np.sin(tilt) * self.lean + np.cos(tilt) * self.up
        self.one = np.cos(tilt) * self.lean - np.sin(tilt) * self.up
        self.contact = np.zeros(2)
        self.centre = self.contact + self.up
        self.mass = self.centre - eccentricity * self.n


def _model_body(axes: Axes, model: _Model) -> None:
    """Draw the table, the sphere cut flat, the rest of the sphere dashed, and the stem."""
    draw.filled(axes, draw.box(-1.9, 2.05, -0.6, 0), TABLE, z=0)
    draw.line(axes, [(-1.9, 0), (2.05, 0)], INK, 1.2, z=1.5)
    rim = np.arccos(FACE)
    cut = draw.arc(model.n, model.one, 2 * np.pi - rim, rim) + model.centre
    cap = draw.arc(model.n, model.one, rim, -rim) + model.centre
    end = draw.arc([0, -1], [1, 0], np.pi) * KNOB + [STEM_TOP, 0]
    stem = np.array([(FACE, -STEM), *end, (FACE, STEM)])
    stem = model.centre + stem @ np.array([model.n, model.one])
    draw.filled(axes, draw.outline(stem), "#F3E8D8", MUTED, 1.0, z=0.8)
    body = draw.filled(axes, draw.outline(cut), "none", MUTED, 1.2, z=1.2)
    draw.picture(axes, _gradient(), (-1, 1, 0, 2), z=1, clip=body)
    draw.line(axes, cap, MUTED, 1.0, dashed=True)


def _gradient(pixels: int = 200) -> Array:
    """Return a pale shading for the square around the sphere."""
    grid = np.linspace(-1, 1, pixels)
    x, y = np.meshgrid(grid, grid)
    depth = np.clip(np.hypot(x + 0.3, y - 0.4) / 1.5, 0, 1)[..., None] ** 1.6
    return np.array(to_rgb("#F8FBFE")) * (1 - depth) + np.array(to_rgb("#C3D7EA")) * depth


def _model_axes(axes: Axes, model: _Model) -> None:
    draw.line(axes, [model.contact, model.centre], MUTED, 1.1, dashed=True)
    top = model.centre + 1.3 * model.up
    draw.arrow(axes, [model.centre, top], INK, width=1.5)
    draw.label(axes, top, "$\\mathbf{z}$", offset=(0, 0.09), size=12)
    three, one = model.centre + _AXIS * model.n, model.mass + 0.62 * model.one
    draw.arrow(axes, [model.mass, three], CONVERGED, width=1.5)
    name = "$\\mathbf{3} = \\mathbf{n}$"
    draw.label(axes, three, name, offset=(-0.06, 0.06), color=CONVERGED, size=12, ha="right")
    draw.arrow(axes, [model.mass, one], CONVERGED, width=1.5)
    draw.label(axes, one + 0.08 * model.one, "$\\mathbf{1}$", color=CONVERGED, size=12)
    draw.out_of_page(axes, model.mass, CONVERGED)
    draw.label(axes, model.mass, "$\\mathbf{2}$", offset=(0.12, 0.07), color=CONVERGED, size=12)


def _model_vectors(axes: Axes, model: _Model) -> None:
    """Draw the contact vector, the forces and the slip velocity."""
    draw.arrow(axes, [model.mass, model.contact], INK, width=2.2, head=0.14)
    draw.label(axes, 0.3 * model.mass, "$\\mathbf{a}$", offset=(0.1, 0), size=12)
    weight = model.mass - 0.5 * model.up
    draw.arrow(axes, [model.mass, weight], ACCENT, width=1.8)
    draw.label(axes, weight, "$m\\mathbf{g}$", offset=(0.07, 0.03), color=ACCENT, ha="left")
    draw.arrow(axes, [-0.52 * model.up, model.contact], ACCENT, width=1.8, z=3)
    draw.label(axes, (-0.07, -0.42), "$g_n\\mathbf{z}$", color=ACCENT, ha="right")
    draw.arrow(axes, [model.contact, -0.6 * model.lean], ACCENT, width=1.8)
    draw.label(
        axes, (0.3, -0.14), "$\\mathbf{f} = -\\mu\\, g_n \\mathbf{v}_A$", color=ACCENT, ha="left"
    )
    draw.arrow(axes, [model.contact, 0.6 * model.lean], MUTED, width=1.8)
    draw.label(axes, (-0.55, -0.14), "$\\mathbf{v}_A$", color=MUTED)
    draw.dot(axes, model.contact, radius=0.035)


def _model_measures(axes: Axes, model: _Model) -> None:
    aside = -model.one
    draw.dot(axes, model.centre, radius=0.035)
    draw.label(axes, model.centre, "O", offset=(-0.09, -0.07))
    draw.label(axes, model.mass, "CM", offset=(0.11, -0.08), ha="left")
    draw.label(axes, (-0.1, 0.1), "A")
    draw.label(axes, (model.centre + model.mass) / 2 + 0.14 * aside, "$\\alpha R$")
    edge = model.centre + np.array([np.cos(0.6), np.sin(0.6)])
    draw.dimension(axes, model.centre, edge)
    draw.label(axes, (model.centre + edge) / 2, "$R$", offset=(-0.04, 0.1))
    angle = draw.arc(model.up, model.n, model.tilt)
    draw.arrow(axes, model.centre + 0.5 * angle, INK, width=1.2, head=0.08)
    draw.label(axes, model.centre + 0.6 * angle[60], "$\\theta$", size=13)
    formula = "$\\mathbf{a} = \\alpha R\\,\\mathbf{3} - R\\,\\mathbf{z}$"
    draw.label(axes, (1.12, 0.45), formula, size=12, ha="left")
    note = "$\\mathbf{2}$ points out of the page"
    draw.label(axes, (1.12, 0.25), note, color=CONVERGED, size=9.5, ha="left")
    note = "the model is\nthe whole sphere:\nno stem, no cut"
    draw.label(axes, (1.3, 1.95), note, color=INK, size=11, ha="left")
