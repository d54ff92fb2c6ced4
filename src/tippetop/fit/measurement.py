"""Measurements: data, the times they were taken at, and what they show of a run."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Self

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from tippetop.fit.delimited import DataColumn, read_columns
from tippetop.fit.observations import (
    EVENT_NAMES,
    VIEWS,
    Camera,
    EventTimes,
    Observation,
    OwnObservation,
    Point,
    SpinRate,
    Variables,
    View,
)
from tippetop.integrators.base import Array
from tippetop.results.catalogue import SAMPLED
from tippetop.support.errors import MISSING, InvalidInput, is_number, within_part
from tippetop.support.files import made_of, read_text
from tippetop.support.suggestions import not_one_of
from tippetop.support.units import exponents_of, named_unit, number_in, unit_of

NAMES = {
    **dict.fromkeys(("t", "time", "zeit", "temps", "seconds"), "t"),
    **dict.fromkeys(("theta", "tilt", "θ", "inclination", "neigung"), "tilt"),
    **dict.fromkeys(("rpm", "u/min", "1/min", "revolutions per minute"), "rpm"),
    **dict.fromkeys(("spin", "omega", "omega3", "ω3", "ω"), "spin"),
    **dict.fromkeys(("event", "ereignis", "what"), "event"),
    **dict.fromkeys(("frame", "step", "bild"), "frame"),
}
"""Names of columns as people write them, in lower case."""

SCALARS = tuple(name for name, variable in SAMPLED.items() if not variable.dimensions)

LONGEST_FILM = 3600.0
"""Seconds beyond which times without a unit are taken for milliseconds or frames."""

LATE_EVENTS = 1.5
"""How much longer than to the last event of the data a run is followed: its own may come later."""


@dataclass(frozen=True, eq=False)
class Measurement:
    """Data of one instrument.

    Attributes
    ----------
    times
        When each row was taken, s since launch; empty for times of events.
    values
        Shape (rows, columns); NaN where nothing was measured.
    observation
        What a run would have shown instead: a function of the run.
    noise
        Standard deviation of each column in its unit; None if it is not known.
    name
        Where the data are from.

    Examples
    --------
    >>> import tippetop as tt
    >>> film = tt.Measurement.of_variables([0.0, 0.1, 0.2], {"tilt": [0.10, 0.11, 0.13]})
    >>> film.values.shape
    (3, 1)
    >>> clock = tt.Measurement.of_events({"turnover_time": 3.1}, noise=0.1)
    """

    times: Array
    values: Array
    observation: Observation
    noise: Array | None = None
    name: str = "data"

    @classmethod
    def of_variables(
        cls, times: ArrayLike, columns: Mapping[str, ArrayLike], noise: Any = None
    ) -> Self:
        """Return a measurement of scalar variables of a run, SI, by name."""
        for name in columns:
            if name not in SCALARS:
                raise not_one_of("columns", name, SCALARS)
        return cls._of(times, columns, Variables(tuple(columns)), noise)

    @classmethod
    def of_spin(cls, times: ArrayLike, rpm: ArrayLike, noise: Any = None) -> Self:
        """Return a measurement of turns a minute about the axis, without their sign."""
        return cls._of(times, {"rpm": rpm}, SpinRate(), noise)

    @classmethod
    def of_point(
        cls,
        times: ArrayLike,
        x: ArrayLike,
        y: ArrayLike,
        view: View,
        *,
        point: Point = "tip",
        scale: Any = None,
        unit: str = "px",
        noise: Any = None,
    ) -> Self:
        """Return a measurement of a point's place in pictures.

        Parameters
        ----------
        times
            s since launch.
        x, y
            To the right and up, in pixels or another unit of the picture.
        view
            "above" or "side".
        point
            "tip", the end of the axis above the centre of mass; "center", the centre of mass; or
            the distance of a mark from the axis and, along the axis, from the centre of mass, m.
        scale
            Metres per unit of the picture, or a text such as "0.2 mm"; None to fit it.
        unit
            What the picture's unit is called.
        noise
            Standard deviation of x and of y, in units of the picture.
        """
        if view not in VIEWS:
            raise not_one_of("view", view, VIEWS)
        scale = number_in("scale", scale, "m")
        if not (scale is None or (is_number(scale) and scale > 0.0)):
            raise InvalidInput("scale", scale, 'metres per pixel greater than 0, such as "0.2 mm"')
        camera = Camera(view, _point(point), scale, unit)
        return cls._of(times, {"x": x, "y": y}, camera, noise)

    @classmethod
    def of_events(cls, times: Mapping[str, Any], noise: Any = None) -> Self:
        """Return a measurement of times of events, s, by their names.

        The names are those of metrics, `turnover_time`, `arrival_time` and `liftoff_time`, and of
        kinds of events, such as "stick", of which the first counts.
        """
        if not times:
            raise InvalidInput("times", times, "times of events by their names")
        for name in times:
            if name not in EVENT_NAMES:
                raise not_one_of("event", name, EVENT_NAMES)
        values = [number_in(name, time, "s") for name, time in times.items()]
        for name, value in zip(times, values, strict=True):
            if not (is_number(value) and value > 0.0):
                raise InvalidInput(name, value, "a time after launch, s")
        row = np.array([values], dtype=float)
        return cls(np.empty(0), row, EventTimes(tuple(times)), _noise(noise, len(values)))

    @classmethod
    def of_function(
        cls,
        times: ArrayLike,
        values: ArrayLike,
        function: Callable[[xr.Dataset], ArrayLike],
        noise: Any = None,
        unit: str = "",
    ) -> Self:
        """Return a measurement of what a function of the run, sampled at `times`, returns."""
        if not callable(function):
            raise InvalidInput("function", function, "a function of a run")
        table = np.asarray(values, dtype=float)
        table = table[:, None] if table.ndim == 1 else table
        labels = tuple(f"value {place}" for place in range(table.shape[1]))
        columns = dict(zip(labels, table.T, strict=True))
        units = (unit,) * len(labels)
        return cls._of(times, columns, OwnObservation(function, labels, units), noise)

    @classmethod
    def _of(
        cls,
        times: ArrayLike,
        columns: Mapping[str, ArrayLike],
        observation: Observation,
        noise: Any,
    ) -> Self:
        rows = _numbers("times", times)
        values = {name: _numbers(name, column) for name, column in columns.items()}
        for name, column in values.items():
            if len(column) != len(rows):
                shown = f"{len(column)} numbers"
                raise InvalidInput(name, shown, f"{len(rows)} numbers, as many as there are times")
        _check_times(rows)
        for name, column in values.items():
            _check_column(name, column)
        table = np.stack(list(values.values()), axis=-1)
        return cls(rows, table, observation, _noise(noise, len(values)))

    def with_noise(self, noise: Any) -> Self:
        """Return the same data with a standard deviation of each column."""
        return replace(self, noise=_noise(noise, self.values.shape[1]))

    def until(self, time: float) -> Self:
        """Return the rows up to a time."""
        rows = self.times <= time
        return replace(self, times=self.times[rows], values=self.values[rows])

    @property
    def duration(self) -> float:
        """How long a run must be to show the data, s."""
        if len(self.times):
            return float(self.times[-1])
        return LATE_EVENTS * float(np.nanmax(self.values))

    @property
    def count(self) -> int:
        """How many numbers were measured."""
        return int(np.isfinite(self.values).sum())


def read_measurement(
    path: Path | str,
    *,
    view: View | None = None,
    point: Point = "tip",
    scale: Any = None,
    noise: Any = None,
    frame_rate: float | None = None,
    start: float = 0.0,
    y_down: bool = False,
    track: str | None = None,
) -> Measurement:
    r"""Read data from a text file of a video analysis, a spreadsheet or a sound's analysis.

    The header names the columns, with units in brackets. There is a time `t`, or a number `frame`
    of the picture; beside it `tilt` or other scalar variables of a run; or `x` and `y` of a point
    in pictures; or `rpm`. A file with columns `event` and `t` has times of events. Tabs,
    semicolons, commas and spaces separate columns, numbers may have decimal commas, and cells of
    missing frames are empty. Files of Tracker are read as they are.

    Parameters
    ----------
    path
        The file.
    view, point, scale
        Of columns x and y, see `Measurement.of_point`. Where the header has a unit of length, it is
        the scale.
    noise
        Standard deviation of each column; None if it is not known.
    frame_rate
        Pictures a second, where the file numbers pictures.
    start
        Time in the file at which the top is launched, s; rows before it are left out.
    y_down
        Whether y grows downwards, as pixels are counted.
    track
        Name of a track, of files of Tracker that have several.

    Raises
    ------
    FileTrouble
        If the file cannot be read.
    InvalidInput
        If it holds no such data; the sentence names column and line.

    Examples
    --------
    >>> import tippetop as tt
    >>> from pathlib import Path
    >>> from tempfile import mkdtemp
    >>> file = Path(mkdtemp(), "film.csv")
    >>> _ = file.write_text("t (s);tilt (deg)\n0,00;5,7\n0,02;5,9\n0,04;6,3\n")
    >>> tt.read_measurement(file).values.round(3).tolist()
    [[0.099], [0.103], [0.11]]
    """
    text = read_text(path, "a table of data")
    with made_of(path):
        named = {
            NAMES.get(name, name): column for name, column in read_columns(text, track).items()
        }
        if "event" in named:
            return _events(named, noise)
        times = _times(named, frame_rate) - start
        since = times >= 0.0
        if not since.any():
            raise InvalidInput("start", start, f"before the last time, {times[-1] + start:.4g} s")

        def column(name: str, units: str) -> Array:
            return _in_unit(named[name], units)[since]

        if "x" in named and "y" in named:
            if view is None:
                raise InvalidInput(
                    "view", MISSING, "'above' or 'side': where the pictures were taken from"
                )
            metres = _is_length(named["x"].unit) and _is_length(named["y"].unit)
            x, y = (column(name, "m" if metres else "px") for name in ("x", "y"))
            return Measurement.of_point(
                times[since],
                x,
                -y if y_down else y,
                view,
                point=point,
                scale=1.0 if metres else scale,
                unit="m" if metres else "px",
                noise=noise,
            )
        if "rpm" in named:
            return Measurement.of_spin(times[since], column("rpm", "rpm"), noise)
        names = [name for name in named if name in SCALARS]
        if not names:
            shown = ", ".join(named)
            accepted = "t and tilt, t, x and y, t and rpm, or event and t"
            raise InvalidInput("columns", shown, accepted)
        columns = {name: column(name, SAMPLED[name].units) for name in names}
        return Measurement.of_variables(times[since], columns, noise)


def _times(named: Mapping[str, DataColumn], frame_rate: Any) -> Array:
    """Return the times of the rows, s."""
    if "t" in named:
        times = _in_unit(named["t"], "s")
        if not named["t"].unit and len(times) and np.nanmax(times) > LONGEST_FILM:
            longest = f"{np.nanmax(times):.6g}"
            fault = "is more than an hour, and the column has no unit"
            hint = "write the unit into the header, such as t (ms)"
            raise InvalidInput("t", longest, "", fault, hint)
        return times
    if "frame" not in named:
        raise InvalidInput(
            "columns", ", ".join(named), "", "have no time", "name a column t or frame"
        )
    if not (is_number(frame_rate) and frame_rate > 0.0):
        raise InvalidInput("frame_rate", frame_rate, "pictures a second, a number greater than 0")
    frames = named["frame"].numbers()
    since: Array = (frames - frames[0]) / frame_rate
    return since


def _events(named: Mapping[str, DataColumn], noise: Any) -> Measurement:
    """Return the measurement of a file of events."""
    if "t" not in named:
        raise InvalidInput("columns", ", ".join(named), "", "have no time", "name a column t")
    times = _in_unit(named["t"], "s")
    names = [cell.strip() for cell in named["event"].cells]
    for name in names:
        if names.count(name) > 1:
            raise InvalidInput("event", name, "", "stands twice", "keep the first of a kind")
    return Measurement.of_events(dict(zip(names, times.tolist(), strict=True)), noise)


def _in_unit(column: DataColumn, units: str) -> Array:
    """Return the numbers of a column in a unit; pixels and turns a minute as they are."""
    numbers = column.numbers()
    unit = column.unit.lower() if column.unit.lower() in ("px", "pixel", "rpm") else column.unit
    if not unit or units in ("px", "rpm"):
        if not unit and units == "rad" and len(numbers) and np.nanmax(np.abs(numbers)) > 7.0:
            largest = f"{np.nanmax(np.abs(numbers)):.4g}"
            fault = "is more than a turn in rad, and the column has no unit"
            hint = f"write the unit into the header: {column.name} (deg) or {column.name} (rad)"
            raise InvalidInput(column.name, largest, "", fault, hint)
        return numbers
    try:
        factor = unit_of(unit, unit, units)
    except InvalidInput as error:
        raise within_part(error, f"unit of column {column.name}") from None
    converted: Array = numbers * factor.over / factor.under
    return converted


def _is_length(unit: str) -> bool:
    """Return whether a unit measures lengths of the world."""
    measured = named_unit(unit) if unit and unit.lower() not in ("px", "pixel") else None
    return measured is not None and measured.exponents == exponents_of("m")


def _numbers(name: str, values: ArrayLike) -> Array:
    """Return a column of numbers; refuse others."""
    try:
        column = np.array(values, dtype=float)
    except (TypeError, ValueError):
        raise InvalidInput(name, values, "a list of numbers") from None
    if column.ndim != 1:
        raise InvalidInput(name, f"an array of {column.ndim} dimensions", "a list of numbers")
    return column


def _check_times(times: Array) -> None:
    if len(times) < 2:
        raise InvalidInput("times", f"{len(times)} of them", "at least two")
    if not np.isfinite(times).all():
        raise InvalidInput("times", "an empty cell", "a time in every row")
    if times[0] < 0.0:
        raise InvalidInput("times", float(times[0]), "at least 0, the time of launch")
    late = np.flatnonzero(np.diff(times) <= 0.0)
    if len(late):
        before, after = times[late[0]], times[late[0] + 1]
        fault = f"follows {before:.6g}: times must increase"
        raise InvalidInput("times", float(after), "", fault, "sort the rows by time")


def _check_column(name: str, column: Array) -> None:
    measured = column[np.isfinite(column)]
    if len(measured) < 2:
        raise InvalidInput(name, f"{len(measured)} numbers", "at least two")
    if np.ptp(measured) == 0.0:
        fault = "is in every row: nothing moves"
        raise InvalidInput(name, float(measured[0]), "", fault, "check which column was exported")


def _noise(noise: Any, columns: int) -> Array | None:
    """Return the standard deviation of each column; None if it is not known."""
    if noise is None:
        return None
    try:
        deviations = np.broadcast_to(np.array(noise, dtype=float), (columns,))
    except (TypeError, ValueError):
        deviations = np.array([np.nan])
    if not (np.isfinite(deviations).all() and (deviations > 0.0).all()):
        accepted = "a number greater than 0 in the unit of the data, or one for each column"
        raise InvalidInput("noise", noise, accepted)
    return deviations


def _point(point: Any) -> Point:
    if point in ("tip", "center"):
        return str(point)
    if isinstance(point, tuple | list) and len(point) == 2:
        numbers = [number_in("point", number, "m") for number in point]
        if all(is_number(number) for number in numbers):
            return (float(numbers[0]), float(numbers[1]))
    accepted = "'tip', 'center', or distances from the axis and along it from the centre of mass"
    raise InvalidInput("point", point, accepted)
