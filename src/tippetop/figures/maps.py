"""Maps of a sweep: a variable of every launch over one, two or more of the swept fields."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm, ListedColormap, LogNorm, Normalize
from matplotlib.figure import Figure

import tippetop.figures.annotation as mark
from tippetop.figures.style import (
    CONVERGED,
    FAINT,
    INK,
    MUTED,
    SEQUENTIAL,
    house_style,
    pi_ticks,
)
from tippetop.results.catalogue import SWEPT, Outcome, written_unit
from tippetop.results.cf_flags import encoded
from tippetop.support.errors import Described, InvalidInput
from tippetop.support.suggestions import not_one_of

MAPPED = ("outcome", "final_tilt", "turnover_time", "flights")
"""Variables of which maps are drawn for every sweep."""

SHORT = {
    "friction.mu": "friction coefficient μ",
    "body.shape.eccentricity": "eccentricity α",
    "body.I1": "I₁",
    "body.I3": "I₃",
    "launch.tilt": "tilt at launch",
    "launch.spin": "axial spin at launch",
    "gravity": "gravity",
}
"""Short names of fields for the labels of axes; other fields are labelled by their `long_name`, and
in titles by their path.
"""

MISSING_MEANS = {
    "turnover_time": ["not within the run"],
    "arrival_time": ["not settled"],
    "max_tilt_ever": ["may still rise"],
    "flights": ["none"],
    "liftoff_time": ["not within the run"],
}
"""Meaning of a missing value, by variable; it is grey in maps and no point of a curve."""

UNFINISHED = {
    Outcome.LIFTED_OFF: "left the table before the end",
    Outcome.FAILED: "failed",
    Outcome.INACCURATE: "inaccurate",
}
"""Outcomes after which the last tilt is not where the launch ends, and their names in maps."""

STILL_MOVING = (
    Outcome.MOVING_UPRIGHT,
    Outcome.MOVING_INVERTED,
    Outcome.MOVING_TILTED,
    Outcome.ROLLING,
)
"""Outcomes of launches that had not settled; maps of the last tilt mark them by dots."""

UPRIGHT, INVERTED, TILTED = "#0B5FA5", "#E07B00", "#109B60"
FLAGS = (
    *(UPRIGHT, INVERTED, TILTED, "#9E1F54", "#4A2410", "#C9CFD6", "#05305A", "#8A6D1A"),
    *("#9CC3E6", "#F6C48A", "#9CDDBD", "#C58BE0", "#EACF36", INK),
)
"""Colours of the values of a flag variable, in order.

Settled ends are strong colours, the same places of moving launches pale ones, and launches that
fell back have a colour that no place has.
"""

DOT = 1.6
"""Size of the dots of moving launches, points: smaller than the cells of most maps."""

MOST_PANELS = 9
"""Largest number of maps side by side."""

WIDEST = 1e300
"""Largest distance between the ends of an axis, in its unit: the search for ticks overflows beyond
it.
"""

MOST_STEP = 1.05
"""Ratio of the largest to the smallest step above which an axis with even ratios is logarithmic."""


@house_style()
def phase_map(sweep: xr.Dataset, variable: str = "final_tilt") -> Figure:
    """Draw a variable of a sweep: as colours over two axes, as a curve over one, as points over
    draws.

    With three axes there is a panel for each of at most `MOST_PANELS` values of the third. With
    more, the axes after the third stay at the middle of their values.

    Raises
    ------
    InvalidInput
        If the values of an axis are too far apart to be drawn.
    """
    sweep = _in_order(sweep)
    if variable not in SWEPT:
        raise not_one_of("variable", variable, list(SWEPT))
    values = sweep[variable]
    require_drawable({_path(sweep, str(name)): at.values for name, at in sweep.coords.items()})
    if values.ndim > 2:
        return _panels(sweep, variable)
    figure, axes = mark.panels(4.6)
    draw_map(axes, sweep, variable)
    return figure


def draw_map(axes: Axes, sweep: xr.Dataset, variable: str) -> None:
    """Draw a variable of a sweep of one or two axes, or of draws, into a panel.

    Raises
    ------
    InvalidInput
        If the sweep has no such variable, or more axes.
    """
    sweep = _in_order(sweep)
    if variable not in SWEPT:
        raise not_one_of("variable", variable, list(SWEPT))
    values, figure = sweep[variable], axes.get_figure(root=True)
    assert figure is not None
    if not 1 <= values.ndim <= 2:
        raise InvalidInput(
            "ax", Described(f"{values.ndim} axes"), "one or two axes", "do not fit into a panel"
        )
    axes.set_title(_title(sweep, variable))
    if values.dims == ("draw",):
        _scatter(figure, axes, sweep, variable)
    elif values.ndim == 1:
        _curve(axes, sweep, variable)
    else:
        shade = _shade(sweep, variable, _values(sweep, variable))
        image = _colours(axes, sweep, variable, shade)
        _bar(figure, [axes], image, sweep, variable)


def require_drawable(coordinates: Mapping[str, np.ndarray[Any, Any]]) -> None:
    """Raise `InvalidInput` if an axis is too long to be drawn.

    Raises
    ------
    InvalidInput
        If the cells at the values of a coordinate reach farther than `WIDEST`.
    """
    for name, values in coordinates.items():
        if not np.issubdtype(values.dtype, np.number):
            continue
        with np.errstate(all="ignore"):
            least, most = _edges(np.unique(values))[[0, -1]]
        if not most - least < WIDEST:
            ends = float(values.min()), float(values.max())
            raise InvalidInput(
                name, ends, f"ends at most {WIDEST:g} apart", "reach too far to be drawn"
            )


def _in_order(sweep: xr.Dataset) -> xr.Dataset:
    """Return a sweep with words as numbers, and with the values of its axes in ascending order."""
    dimensions = map(str, sweep["outcome"].dims)
    return encoded(sweep).sortby([name for name in dimensions if name in sweep.coords])


def _panels(sweep: xr.Dataset, variable: str) -> Figure:
    """Return a figure of maps side by side, one for each of some values of the third axis."""
    third, *others = (str(name) for name in sweep[variable].dims[2:])
    sweep = sweep.isel({name: sweep.sizes[name] // 2 for name in others})
    places = np.unique(np.linspace(0, sweep.sizes[third] - 1, MOST_PANELS).round().astype(int))
    columns = min(3, len(places))
    rows = -(-len(places) // columns)
    figure, grid = mark.panels(
        1.2 + 2.4 * rows, rows, columns, sharex=True, sharey=True, squeeze=False, lettered=False
    )
    title = "; ".join([_title(sweep, variable), *(_value(sweep, name) for name in others)])
    figure.suptitle(title, x=0.01, ha="left", weight="bold", size="medium")
    shade = _shade(sweep, variable, _values(sweep, variable))
    for place, axes in enumerate(grid.flat):
        if place >= len(places):
            axes.set_visible(False)
            continue
        part = sweep.isel({third: places[place]})
        image = _colours(axes, part, variable, shade)
        axes.set_title(_value(part, third), size="small", weight="normal")
        axes.tick_params(labelbottom=place + columns >= len(places))
        figure.supxlabel(axes.get_xlabel(), size="medium")
        figure.supylabel(axes.get_ylabel(), size="medium")
        axes.set(xlabel="", ylabel="")
    _bar(figure, list(grid.flat), image, sweep, variable)
    return figure


def _value(sweep: xr.Dataset, name: str) -> str:
    """Return the text of the value at which a sweep is cut, with the name of its field."""
    path = _path(sweep, name)
    return f"{_name(sweep, name) if path in SHORT else path} = {sweep[name].values:.4g}"


def _colours(axes: Axes, sweep: xr.Dataset, variable: str, shade: dict[str, Any]) -> Any:
    """Draw a map of cells, with the first dimension to the right and the second upwards."""
    across, up = (str(name) for name in sweep[variable].dims)
    values = _values(sweep, variable).T
    axes.set_facecolor(FAINT)
    axes.grid(visible=False)
    edges = [_edges(sweep[name].values) for name in (across, up)]
    image = axes.pcolormesh(*edges, np.ma.masked_invalid(values), rasterized=True, **shade)
    _dot_moving(axes, sweep, variable, *np.meshgrid(sweep[across].values, sweep[up].values))
    for name, axis in ((across, axes.xaxis), (up, axes.yaxis)):
        axis.set_label_text(_name(sweep, name))
        if _is_logarithmic(sweep[name].values):
            (axes.set_xscale if axis is axes.xaxis else axes.set_yscale)("log")
    axes.set_xlim(*edges[0][[0, -1]])
    axes.set_ylim(*edges[1][[0, -1]])
    return image


def _curve(axes: Axes, sweep: xr.Dataset, variable: str) -> None:
    (across,) = (str(name) for name in sweep[variable].dims)
    axes.plot(sweep[across].values, _values(sweep, variable), ".-", color=CONVERGED, linewidth=0.8)
    _dot_moving(axes, sweep, variable, sweep[across].values, sweep[variable].values)
    axes.set_xlabel(_name(sweep, across))
    if _is_logarithmic(sweep[across].values):
        axes.set_xscale("log")
    axes.set_xlim(*_edges(sweep[across].values)[[0, -1]])
    if variable == "final_tilt":
        pi_ticks(axes.yaxis)


def _scatter(figure: Figure, axes: Axes, sweep: xr.Dataset, variable: str) -> None:
    fields = [str(name) for name in sweep.coords if name != "draw"]
    values = _values(sweep, variable)
    if len(fields) == 1:
        axes.plot(sweep[fields[0]].values, values, ".", color=CONVERGED)
    else:
        shade = _shade(sweep, variable, values)
        x, y = sweep[fields[0]].values, sweep[fields[1]].values
        missing = ~np.isfinite(values)
        axes.scatter(x[missing], y[missing], 8, facecolors="none", edgecolors=MUTED, linewidths=0.4)
        image = axes.scatter(x[~missing], y[~missing], 8, values[~missing], **shade)
        _dot_moving(axes, sweep, variable, x, y)
        axes.set_ylabel(_name(sweep, fields[1]))
        _bar(figure, [axes], image, sweep, variable)
    axes.set_xlabel(_name(sweep, fields[0]))


def _dot_moving(
    axes: Axes,
    sweep: xr.Dataset,
    variable: str,
    x: np.ndarray[Any, Any],
    y: np.ndarray[Any, Any],
) -> None:
    """Mark launches that were still moving in a map of last tilts; `x` and `y` have its shape."""
    moving = _is_moving(sweep, variable).T
    if moving.any():
        axes.plot(x[moving], y[moving], ".", color="white", markersize=DOT, rasterized=True)


def _is_moving(sweep: xr.Dataset, variable: str) -> np.ndarray[Any, Any]:
    """Return which launches had not settled at their end; none if the variable is not the last
    tilt.
    """
    return np.isin(sweep["outcome"].values, STILL_MOVING) & (variable == "final_tilt")


def _path(sweep: xr.Dataset, name: str) -> str:
    """Return the path, with dots, of the field of a coordinate."""
    return str(sweep[name].attrs.get("path", name))


def _name(sweep: xr.Dataset, name: str) -> str:
    """Return the label of the axis of a coordinate."""
    attrs, path = sweep[name].attrs, _path(sweep, name)
    return _heading(SHORT.get(path, attrs.get("long_name", path)), attrs.get("units", ""))


def _heading(words: str, units: str) -> str:
    """Return a name with a capital letter and its unit in brackets."""
    heading = words[:1].upper() + words[1:]
    if units in ("", "1"):
        return heading
    unit = written_unit(units).replace("^2", "²").replace("^3", "³")
    return f"{heading} ({unit})"


def _title(sweep: xr.Dataset, variable: str) -> str:
    title = _heading(SWEPT[variable].label, SWEPT[variable].units)
    means = MISSING_MEANS.get(variable, [])
    if variable == "final_tilt":
        outcomes = sweep["outcome"].values
        means = [words for outcome, words in UNFINISHED.items() if (outcomes == outcome).any()]
    if means:
        single = sweep[variable].ndim == 1 and len(sweep.coords) == 1 + ("draw" in sweep.coords)
        title += f"; {'no point' if single else 'grey'}: {', '.join(means)}"
    if _is_moving(sweep, variable).any():
        title += "; dot: still moving"
    return title


def _values(sweep: xr.Dataset, variable: str) -> np.ndarray[Any, Any]:
    """Return the values of a variable as numbers, nan where they are missing."""
    values = np.asarray(sweep[variable].values, dtype=float)
    missing = ~sweep["is_done"].values
    if variable == "final_tilt":
        missing = missing | np.isin(sweep["outcome"].values, list(UNFINISHED))
    if np.issubdtype(sweep[variable].dtype, np.integer):
        missing = missing | (values < 0)
    return np.where(missing, np.nan, values)


def _shade(sweep: xr.Dataset, variable: str, values: np.ndarray[Any, Any]) -> dict[str, Any]:
    """Return the colormap and the norm by which the values of a variable become colours."""
    meanings = sweep[variable].attrs.get("flag_meanings")
    if meanings is not None:
        count = len(meanings.split())
        norm = BoundaryNorm(np.arange(count + 1) - 0.5, count)
        return {"cmap": ListedColormap(FLAGS[:count]), "norm": norm}
    if variable == "final_tilt":
        return {"cmap": SEQUENTIAL, "norm": Normalize(0.0, np.pi)}
    finite = values[np.isfinite(values)]
    least, most = (float(finite.min()), float(finite.max())) if len(finite) else (0.0, 1.0)
    if variable == "flights" and most > 20:
        return {"cmap": SEQUENTIAL, "norm": LogNorm(1.0, most)}
    return {"cmap": SEQUENTIAL, "norm": Normalize(least, most if most > least else least + 1.0)}


def _bar(figure: Figure, axes: list[Axes], image: Any, sweep: xr.Dataset, variable: str) -> None:
    bar = figure.colorbar(image, ax=axes, pad=0.02)
    bar.outline.set_visible(False)
    meanings = sweep[variable].attrs.get("flag_meanings")
    if meanings is not None:
        names = [name.replace("_", " ") for name in meanings.split()]
        bar.set_ticks(list(range(len(names))), labels=names)
    elif variable == "final_tilt":
        pi_ticks(bar.ax.yaxis)


def _is_logarithmic(values: np.ndarray[Any, Any]) -> bool:
    """Return whether the values grow by even ratios rather than by even steps."""
    if len(values) < 3 or np.any(values <= 0):
        return False
    steps, ratios = np.diff(values), np.diff(np.log(values))
    even = [float(np.abs(jumps).max() / np.abs(jumps).min()) for jumps in (ratios, steps)]
    return even[0] < MOST_STEP <= even[1]


def _edges(values: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    """Return the edges of the cells at the values of an axis, one more than there are values.

    Edges are halfway between values: at the geometric mean on a logarithmic axis.
    """
    if len(values) == 1:
        return np.array([values[0] - 0.5, values[0] + 0.5])
    if _is_logarithmic(values):
        edges: np.ndarray[Any, Any] = np.exp(_edges(np.log(values)))
        return edges
    middles = 0.5 * values[:-1] + 0.5 * values[1:]
    first, last = middles[0] - values[0], values[-1] - middles[-1]
    return np.array([values[0] - first, *middles, values[-1] + last])
