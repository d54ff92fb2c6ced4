"""Annotation of figures: panels, notes beside points, letters, ticks, legends and insets."""

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

from tippetop.figures.style import INK, WIDTH, ShownFigure, house_style, pi_ticks

Box = tuple[float, float, float, float]


def plain_ticks(axis: Axis, ticks: Iterable[float]) -> None:
    """Put ticks on a logarithmic axis, labelled with plain numbers."""
    axis.set_major_locator(FixedLocator(list(ticks)))
    axis.set_major_formatter(ScalarFormatter())
    axis.set_minor_formatter(NullFormatter())


TILT, FRICTION = r"tilt $\theta$ (rad)", r"friction $\mu$ (s/m)"
SPIN = r"spin at launch $\omega_0$ (rad/s)"
"""Labels of axes of tilt, friction and spin."""

CRITICAL = (r"$\omega_{c1}$", r"$\omega_{c2}$")
"""The symbols of the two critical spins."""


def panels(
    height: float, rows: int = 1, columns: int = 1, *, lettered: bool = True, **options: Any
) -> tuple[Figure, Any]:
    """Return a figure of a height in inches, and its panel or its array of lettered panels."""
    figure = ShownFigure(figsize=(WIDTH, height))
    made = figure.subplots(rows, columns, **options)
    if lettered and rows * columns > 1:
        letters(made.flat)
    return figure, made


Arguments = ParamSpec("Arguments")


class Drawing(Protocol):
    """Decorator of functions that draw into one or two panels, or into an array of them.

    It replaces such a function by one that takes the remaining arguments and returns the figure.
    """

    @overload
    def __call__(
        self, draw: Callable[Concatenate[Axes, Axes, Arguments], None], /
    ) -> Callable[Arguments, Figure]: ...

    @overload
    def __call__(
        self, draw: Callable[Concatenate[Axes, Arguments], None], /
    ) -> Callable[Arguments, Figure]: ...


def drawn(height: float, rows: int = 1, columns: int = 1, **options: Any) -> Drawing:
    """Return a decorator by which a function that draws into panels returns their figure.

    The decorated function makes a figure with `panels`, in the house style, draws into it and
    returns it. Its first parameters are the panels, each annotated with `Axes`; with several rows
    and several columns the first parameter is the array of all panels. The other parameters are
    those of the function that is returned.

    Raises
    ------
    TypeError
        If the number of parameters annotated with `Axes` is not the number of panels.
    """
    as_array = rows > 1 and columns > 1

    def drawing(draw: Callable[..., None]) -> Callable[..., Figure]:
        @wraps(draw)
        def make_figure(*arguments: Any, **keywords: Any) -> Figure:
            with house_style():
                figure, made = panels(height, rows, columns, **options)
                axes = [made] if as_array else np.ravel(made)
                draw(*axes, *arguments, **keywords)
            return figure

        parameters = list(signature(draw).parameters.values())
        drawn_into = sum(parameter.annotation is Axes for parameter in parameters)
        count = rows * columns
        if drawn_into != (0 if as_array else count):
            raise TypeError(
                f"{draw.__name__} draws into {drawn_into} panels, and the figure has {count}"
            )
        arguments = parameters[1:] if as_array else parameters[count:]
        annotations = {parameter.name: parameter.annotation for parameter in arguments}
        make_figure.__annotations__ = annotations | {"return": Figure}
        vars(make_figure)["__signature__"] = signature(draw).replace(
            parameters=arguments, return_annotation=Figure
        )
        return make_figure

    return drawing


def tilt_axis(axes: Axes, low: float = -0.06, high: float = np.pi + 0.1, label: str = TILT) -> None:
    """Make the vertical axis of a panel an axis of tilts, with ticks at quarters of pi."""
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
"""Coordinates of notes at a value of one axis and at a share of the panel's height or width."""


LEADER = {"arrowstyle": "-", "lw": 0.8, "shrinkA": 2, "shrinkB": 5}
"""Style of the thin line from a note to its point, without its colour."""


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
    """Write a note beside a point.

    The note is aligned so that it lies on the side of the point to which `offset` (points) leads. A
    halo keeps it legible over lines.
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
    """Place the legend above a panel."""
    axes.legend(
        loc="lower left",
        bbox_to_anchor=(0.0, 1.0),
        ncols=columns,
        borderaxespad=0.2,
        columnspacing=1.4,
    )


def inset(axes: Axes, box: Box) -> Axes:
    """Return an inset panel; `box` is (left, bottom, width, height) in shares of the panel."""
    panel = axes.inset_axes(box)
    panel.tick_params(labelsize=7.5, length=2, pad=2)
    panel.grid(visible=False)
    panel.spines[["top", "right"]].set_visible(True)
    return panel


def source(axes: Axes, panel: Axes) -> None:
    """Frame the region that an inset enlarges, without lines across the panel."""
    (left, right), (low, high) = panel.get_xlim(), panel.get_ylim()
    axes.indicate_inset(
        (left, low, right - left, high - low), edgecolor=INK, alpha=0.8, lw=0.8, zorder=6
    )
    for spine in panel.spines.values():
        spine.set(edgecolor=INK, lw=0.8)
