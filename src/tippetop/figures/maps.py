"""Maps of a sweep: what became of every launch, over one or two of its numbers."""

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
from tippetop.results.catalogue import SWEPT, Ending, written_unit
from tippetop.results.flags import encoded
from tippetop.support.errors import InvalidInput

MAPPED = ("outcome", "final_theta", "turns_over", "flights")
"""The maps that are drawn of every sweep."""

SHORT = {
    "friction.mu": "friction coefficient μ",
    "body.shape.eccentricity": "eccentricity α",
    "body.I1": "I₁",
    "body.I3": "I₃",
    "launch.tilt": "tilt at launch",
    "launch.spin": "axial spin at launch",
    "gravity": "gravity",
}
"""What some fields are called, in few words; others on axes by what they are, elsewhere by their
name.
"""

NOTHING = {
    "turns_over": ["not within the run"],
    "arrives": ["not settled"],
    "highest_tilt": ["may still rise"],
    "flights": ["none"],
    "first_lift_off": ["not within the run"],
}
"""What it means where some variables have no value: grey in maps, and no point of a curve."""

UNFINISHED = {
    Ending.LIFTED_OFF: "left the table before the end",
    Ending.FAILED: "failed",
    Ending.INACCURATE: "inaccurate",
}
"""Launches whose last tilt is not their end, or not to be trusted, and how maps of it name them."""

STILL_MOVING = (
    Ending.MOVING_UPRIGHT,
    Ending.MOVING_INVERTED,
    Ending.MOVING_TILTED,
    Ending.ROLLING,
)
"""Launches that had not settled when they ended: a dot in maps of where they were then."""

UPRIGHT, INVERTED, TILTED = "#0B5FA5", "#E07B00", "#109B60"
FLAGS = (
    *(UPRIGHT, INVERTED, TILTED, "#9E1F54", "#4A2410", "#C9CFD6", "#05305A", "#8A6D1A"),
    *("#9CC3E6", "#F6C48A", "#9CDDBD", "#C58BE0", "#EACF36", INK),
)
"""Colours of the variables of flags, in their order. Settled ends of launches are strong, the same
places of moving ones pale, and those that fell back have a colour that no place has.
"""

DOT = 1.6
"""Size of the dots of moving launches, points: smaller than the cells of most maps."""

MOST_PANELS = 9
"""Maps that are drawn side by side."""

WIDEST = 1e300
"""How far the ends of an axis may be apart, in its unit: farther ones overflow where ticks are
looked for.
"""

MOST_STEP = 1.05
"""Ratio of neighbouring steps of an axis from which on it counts as geometric."""


@house_style()
def phase_map(sweep: xr.Dataset, variable: str = "final_theta") -> Figure:
    """Draw a variable of a sweep: over axes as colours, over one axis as a curve, of draws as
    points.

    Of three axes the third goes from panel to panel, over at most `MOST_PANELS` of its values; of
    more than three, those after the third stay at the middle one of their values.

    Raises
    ------
    InvalidInput
        If values of an axis are too far apart to be drawn.
    """
    sweep = encoded(sweep)
    values = sweep[variable]
    require_drawable({_path(sweep, str(name)): at.values for name, at in sweep.coords.items()})
    if values.ndim > 2:
        return _panels(sweep, variable)
    figure, axes = mark.panels(4.6)
    axes.set_title(_title(sweep, variable))
    if values.dims == ("sample",):
        _scatter(figure, axes, sweep, variable)
    elif values.ndim == 1:
        _curve(axes, sweep, variable)
    else:
        shade = _shade(sweep, variable, _shown(sweep, variable))
        image = _colours(axes, sweep, variable, shade)
        _bar(figure, [axes], image, sweep, variable)
    return figure


def require_drawable(coordinates: Mapping[str, np.ndarray[Any, Any]]) -> None:
    """Refuse to draw over what reaches too far.

    Raises
    ------
    InvalidInput
        If cells at these values, along an axis or drawn, reach farther than `WIDEST`.
    """
    for name, values in coordinates.items():
        if not np.issubdtype(values.dtype, np.number):
            continue
        with np.errstate(all="ignore"):
            least, most = _ends(np.unique(values))
        if not most - least < WIDEST:
            ends = float(values.min()), float(values.max())
            raise InvalidInput(
                name, ends, f"ends at most {WIDEST:g} apart", "reach too far to be drawn"
            )


def _panels(sweep: xr.Dataset, variable: str) -> Figure:
    """Maps side by side, one for each of some values of the third axis."""
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
    shade = _shade(sweep, variable, _shown(sweep, variable))
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
    """Where a sweep was cut."""
    path = _path(sweep, name)
    return f"{_name(sweep, name) if path in SHORT else path} = {sweep[name].values:.4g}"


def _colours(axes: Axes, sweep: xr.Dataset, variable: str, shade: dict[str, Any]) -> Any:
    """One cell a rectangle; the first dimension to the right, the second upwards."""
    across, up = (str(name) for name in sweep[variable].dims)
    values = _shown(sweep, variable).T
    axes.set_facecolor(FAINT)
    axes.grid(visible=False)
    image = axes.pcolormesh(
        sweep[across].values,
        sweep[up].values,
        np.ma.masked_invalid(values),
        shading="nearest",
        rasterized=True,
        **shade,
    )
    _dot_moving(axes, sweep, variable, *np.meshgrid(sweep[across].values, sweep[up].values))
    for name, axis in ((across, axes.xaxis), (up, axes.yaxis)):
        axis.set_label_text(_name(sweep, name))
        if _is_geometric(sweep[name].values):
            (axes.set_xscale if axis is axes.xaxis else axes.set_yscale)("log")
    axes.set_xlim(*_ends(sweep[across].values))
    axes.set_ylim(*_ends(sweep[up].values))
    return image


def _curve(axes: Axes, sweep: xr.Dataset, variable: str) -> None:
    (across,) = (str(name) for name in sweep[variable].dims)
    axes.plot(sweep[across].values, _shown(sweep, variable), ".-", color=CONVERGED, linewidth=0.8)
    _dot_moving(axes, sweep, variable, sweep[across].values, sweep[variable].values)
    axes.set_xlabel(_name(sweep, across))
    if _is_geometric(sweep[across].values):
        axes.set_xscale("log")
    axes.set_xlim(*_ends(sweep[across].values))
    if variable == "final_theta":
        pi_ticks(axes.yaxis)


def _scatter(figure: Figure, axes: Axes, sweep: xr.Dataset, variable: str) -> None:
    fields = [str(name) for name in sweep.coords if name != "sample"]
    values = _shown(sweep, variable)
    if len(fields) == 1:
        axes.plot(sweep[fields[0]].values, values, ".", color=CONVERGED)
    else:
        shade = _shade(sweep, variable, values)
        x, y = sweep[fields[0]].values, sweep[fields[1]].values
        nothing = ~np.isfinite(values)
        axes.scatter(x[nothing], y[nothing], 8, facecolors="none", edgecolors=MUTED, linewidths=0.4)
        image = axes.scatter(x[~nothing], y[~nothing], 8, values[~nothing], **shade)
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
    """Dot the launches in a map of last tilts that were still moving; places have its shape."""
    moving = _is_moving(sweep, variable).T
    if moving.any():
        axes.plot(x[moving], y[moving], ".", color="white", markersize=DOT, rasterized=True)


def _is_moving(sweep: xr.Dataset, variable: str) -> np.ndarray[Any, Any]:
    """Return which launches had not settled at their end, of a variable for which that counts."""
    return np.isin(sweep["outcome"].values, STILL_MOVING) & (variable == "final_theta")


def _path(sweep: xr.Dataset, name: str) -> str:
    """The field, with dots, that a coordinate holds."""
    return str(sweep[name].attrs.get("path", name))


def _name(sweep: xr.Dataset, name: str) -> str:
    """What the axis of a coordinate is called."""
    told, path = sweep[name].attrs, _path(sweep, name)
    return _heading(SHORT.get(path, told.get("long_name", path)), told.get("units", ""))


def _heading(words: str, units: str) -> str:
    """A name with its unit, as it begins a line."""
    unit = (
        written_unit(units).replace("^2", "²").replace("^3", "³") if units not in ("", "1") else ""
    )
    return words[:1].upper() + words[1:] + (f" ({unit})" if unit else "")


def _title(sweep: xr.Dataset, variable: str) -> str:
    title, means = _heading(SWEPT[variable].label, SWEPT[variable].units), NOTHING.get(variable, [])
    if variable == "final_theta":
        means = [
            words
            for ending, words in UNFINISHED.items()
            if (sweep["outcome"].values == ending).any()
        ]
    single = sweep[variable].ndim == 1 and len(sweep.coords) == 1 + ("sample" in sweep.coords)
    sign = "no point" if single else "grey"
    title = f"{title}; {sign}: {', '.join(means)}" if means else title
    return f"{title}; dot: still moving" if _is_moving(sweep, variable).any() else title


def _shown(sweep: xr.Dataset, variable: str) -> np.ndarray[Any, Any]:
    """The values, not a number where there are none."""
    values = np.asarray(sweep[variable].values, dtype=float)
    nothing = sweep["status"].values == 0
    if variable == "final_theta":
        nothing = nothing | np.isin(sweep["outcome"].values, list(UNFINISHED))
    if np.issubdtype(sweep[variable].dtype, np.integer):
        nothing = nothing | (values < 0)
    return np.where(nothing, np.nan, values)


def _shade(sweep: xr.Dataset, variable: str, values: np.ndarray[Any, Any]) -> dict[str, Any]:
    """How the values of a variable become colours: a colormap, and what goes where in it."""
    meanings = sweep[variable].attrs.get("flag_meanings")
    if meanings is not None:
        count = len(meanings.split())
        norm = BoundaryNorm(np.arange(count + 1) - 0.5, count)
        return {"cmap": ListedColormap(FLAGS[:count]), "norm": norm}
    if variable == "final_theta":
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
        names = meanings.replace("_", "-").split()
        bar.set_ticks(list(range(len(names))), labels=names)
    elif variable == "final_theta":
        pi_ticks(bar.ax.yaxis)


def _is_geometric(values: np.ndarray[Any, Any]) -> bool:
    """Whether the values grow by ratios rather than by steps."""
    if len(values) < 3 or np.any(values[0] * values <= 0):
        return False
    steps, ratios = np.diff(values), np.diff(np.log(np.abs(values)))
    even = [float(np.abs(jumps).max() / np.abs(jumps).min()) for jumps in (ratios, steps)]
    return even[0] < MOST_STEP <= even[1]


def _ends(values: np.ndarray[Any, Any]) -> tuple[float, float]:
    """Where the first and the last cell end."""
    if len(values) == 1:
        return float(values[0]) - 0.5, float(values[0]) + 0.5
    if _is_geometric(values):
        first, last = (values[1] / values[0]) ** 0.5, (values[-1] / values[-2]) ** 0.5
        return float(values[0] / first), float(values[-1] * last)
    half = 0.5 * (values[1] - values[0]), 0.5 * (values[-1] - values[-2])
    return float(values[0] - half[0]), float(values[-1] + half[1])
