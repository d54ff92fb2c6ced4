"""The house style: one palette, one set of sizes, and output that is the same on every run.

Figures are plain `matplotlib.figure.Figure` objects, never pyplot ones, so there is no display to
need and nothing to close. Both making and saving a figure must happen inside `house_style`; `save`
sees to the latter.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from io import BytesIO
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from cycler import cycler
from matplotlib.axis import Axis
from matplotlib.figure import Figure

INK = "#1E252D"
MUTED = "#7C8793"
FAINT = "#DCE1E6"
TABLE, TABLE_EDGE = "#EEF0F2", "#C9CFD6"

CONVERGED = "#0B5FA5"
"""Colour of converged results."""
REPORT = "#E07B00"
"""Colour of results by the report's own method, with its errors left in."""
ACCENT = "#9E1F54"
"""Colour of what a figure draws attention to: an event, a force, a threshold."""

CYCLE = (CONVERGED, REPORT, "#109B60", ACCENT, "#66C5F0", "#4A2410", "#EACF36")
UNILATERAL = CYCLE[2]
"""Colour of results on a table that only pushes, beside converged ones on a table that pulls."""

SEQUENTIAL = "cividis"

DASHED = (0, (4, 3))

WIDTH = 7.0
"""Full figure width in inches: 700 px on a page at 100 dpi."""

_STYLE: dict[Any, Any] = {
    "font.family": "sans-serif",
    "font.sans-serif": ["DejaVu Sans", "Verdana", "sans-serif"],
    "mathtext.fontset": "dejavusans",
    "font.size": 10,
    "axes.titlesize": 11,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.labelsize": 10,
    "xtick.labelsize": 9,
    "ytick.labelsize": 9,
    "legend.fontsize": 9,
    "figure.titlesize": 12,
    "text.color": INK,
    "axes.labelcolor": INK,
    "axes.titlecolor": INK,
    "axes.edgecolor": MUTED,
    "xtick.color": MUTED,
    "ytick.color": MUTED,
    "xtick.labelcolor": INK,
    "ytick.labelcolor": INK,
    "axes.prop_cycle": cycler(color=CYCLE),
    "image.cmap": SEQUENTIAL,
    "lines.linewidth": 1.6,
    "lines.markersize": 5,
    "lines.solid_capstyle": "round",
    "axes.linewidth": 0.8,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": FAINT,
    "grid.linewidth": 0.6,
    "axes.formatter.limits": (-4, 5),
    "axes.xmargin": 0.02,
    "legend.frameon": False,
    "legend.handlelength": 1.6,
    "figure.figsize": (WIDTH, 4.2),
    "figure.facecolor": "white",
    "figure.constrained_layout.use": True,
    "figure.dpi": 100,
    "savefig.dpi": 200,
    "savefig.facecolor": "white",
    "svg.fonttype": "none",
    "svg.hashsalt": "tippetop",
    "pdf.fonttype": 42,
}


@contextmanager
def house_style() -> Iterator[None]:
    """Return the context in which every figure is made and saved. It is also a decorator."""
    with mpl.rc_context(_STYLE):
        yield


class ShownFigure(Figure):
    """Figure that notebooks show although pyplot does not know it."""

    @house_style()
    def _repr_png_(self) -> bytes:
        picture = BytesIO()
        self.savefig(picture, format="png")
        return picture.getvalue()


def save(figure: Figure, path: Path | str, **options: Any) -> None:
    """Write a figure without a date, in the house style, so that equal figures are equal files."""
    dated = {".svg": {"Date": None}, ".pdf": {"CreationDate": None}, ".png": {"Software": None}}
    with house_style():
        figure.savefig(path, **{"metadata": dated.get(Path(path).suffix.lower()), **options})


def pi_ticks(axis: Axis) -> None:
    """Label an angle axis at the quarters of pi, from 0 to pi."""
    axis.set_ticks([k * np.pi / 4 for k in range(5)], ["0", "π/4", "π/2", "3π/4", "π"])
