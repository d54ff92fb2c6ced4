"""What is written on figures: notes beside points, letters of panels, ticks, legends and insets."""

from collections.abc import Callable, Iterable
from functools import wraps
from inspect import signature
from typing import Any, Concatenate, ParamSpec, Protocol, overload

import numpy as np
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke
from matplotlib.ticker import FixedLocator, NullFormatter, ScalarFormatter

from tippetop.figures.style import INK, WIDTH, house_style, pi_ticks

Box = tuple[float, float, float, float]


def plain_ticks(axis: Axis, ticks: Iterable[float]) -> None:
    """Put ticks on a logarithmic axis, and label them with plain numbers."""
    axis.set_major_locator(FixedLocator(list(ticks)))
    axis.set_major_formatter(ScalarFormatter())
    axis.set_minor_formatter(NullFormatter())


TILT, FRICTION = r"tilt $\theta$ (rad)", r"friction $\mu$ (s/m)"
SPIN = r"spin at launch $\omega_0$ (rad/s)"
"""What axes are called."""

CRITICAL = (r"$\omega_{c1}$", r"$\omega_{c2}$")
"""The symbols of the two critical spins."""


def panels(
    height: float, rows: int = 1, columns: int = 1, *, lettered: bool = True, **options: Any
) -> tuple[Figure, Any]:
    """Return a figure of this height, inches, with its panel, or an array of panels marked with
    letters.
    """
    figure = Figure(figsize=(WIDTH, height))
    made = figure.subplots(rows, columns, **options)
    if lettered and rows * columns > 1:
        letters(made.flat)
    return figure, made


Told = ParamSpec("Told")


class Drawing(Protocol):
    """Makes what draws into two panels, or into one or an array of them, a figure of what it is
    told.
    """

    @overload
    def __call__(
        self, draw: Callable[Concatenate[Axes, Axes, Told], None], /
    ) -> Callable[Told, Figure]: ...

    @overload
    def __call__(
        self, draw: Callable[Concatenate[Axes, Told], None], /
    ) -> Callable[Told, Figure]: ...


def drawn(height: float, rows: int = 1, columns: int = 1, **options: Any) -> Drawing:
    """Let what draws into the `panels` of a figure return the figure, in the house style.

    It is given the panels, those of several rows and columns as an array, before what is to be
    drawn.
    """
    whole = rows > 1 and columns > 1

    def drawing(draw: Callable[..., None]) -> Callable[..., Figure]:
        @wraps(draw)
        def figure_of(*told: Any, **others: Any) -> Figure:
            with house_style():
                figure, made = panels(height, rows, columns, **options)
                draw(*([made] if whole else np.ravel(made)), *told, **others)
            return figure

        own = signature(draw)
        taken, told = sum(one.annotation is Axes for one in own.parameters.values()), rows * columns
        if taken != (0 if whole else told):
            raise TypeError(f"{draw.__name__} draws into {taken} panels, and the figure has {told}")
        rest = list(own.parameters.values())[taken or 1 :]
        figure_of.__annotations__ = {one.name: one.annotation for one in rest} | {"return": Figure}
        vars(figure_of)["__signature__"] = own.replace(parameters=rest, return_annotation=Figure)
        return figure_of

    return drawing


def tilt_axis(axes: Axes, low: float = -0.06, high: float = np.pi + 0.1, label: str = TILT) -> None:
    """Make the upright axis of a panel one of tilts, with ticks at parts of pi."""
    axes.set_ylabel(label)
    pi_ticks(axes.yaxis)
    axes.set_ylim(low, high)


def letters(panels: Iterable[Axes]) -> None:
    """Mark the panels of a figure with bold letters above their top left corners."""
    for axes, letter in zip(panels, "abcdefgh", strict=False):
        axes.annotate(
            letter,
            (0, 1),
            (-6, 6),
            xycoords="axes fraction",
            textcoords="offset points",
            ha="right",
            va="bottom",
            fontweight="bold",
            annotation_clip=False,
        )


ALONG_X, ALONG_Y = ("data", "axes fraction"), ("axes fraction", "data")
"""Coordinates of notes that belong to a value of one axis and to a height or width of the panel."""


LEADER = {"arrowstyle": "-", "lw": 0.8, "shrinkA": 2, "shrinkB": 5}
"""The thin line from a note to what it is about, but for its colour."""


def note(
    axes: Axes,
    text: str,
    at: tuple[float, float],
    offset: tuple[float, float],
    color: str,
    *,
    halo: bool = False,
    **options: Any,
) -> None:
    """Write a note beside a point, on the side to which the offset, in points, leads.

    A halo keeps it legible over lines.
    """
    side = {-1: "right", 0: "center", 1: "left"}[int(np.sign(offset[0]))]
    height = {-1: "top", 0: "center", 1: "bottom"}[int(np.sign(offset[1]))]
    effects = [withStroke(linewidth=2.5, foreground="white")] if halo else None
    placed = {
        "ha": side,
        "va": height,
        "size": 9,
        "color": color,
        "path_effects": effects,
        **options,
    }
    axes.annotate(text, at, offset, textcoords="offset points", **placed)


def legend_above(axes: Axes, columns: int) -> None:
    """Put the legend on top of a panel, outside of it."""
    axes.legend(
        loc="lower left",
        bbox_to_anchor=(0.0, 1.0),
        ncols=columns,
        borderaxespad=0.2,
        columnspacing=1.4,
    )


def inset(axes: Axes, box: Box) -> Axes:
    """Return a panel within a panel, in the box (left, bottom, width, height) in parts of it."""
    panel = axes.inset_axes(box)
    panel.tick_params(labelsize=7.5, length=2, pad=2)
    panel.grid(visible=False)
    panel.spines[["top", "right"]].set_visible(True)
    return panel


def source(axes: Axes, panel: Axes) -> None:
    """Show where an inset is taken from: by a frame like its own, without lines across the
    panel.
    """
    (left, right), (low, high) = panel.get_xlim(), panel.get_ylim()
    axes.indicate_inset(
        (left, low, right - left, high - low), edgecolor=INK, alpha=0.8, lw=0.8, zorder=6
    )
    for spine in panel.spines.values():
        spine.set(edgecolor=INK, lw=0.8)
