"""Measurements: data, the times they were taken at, and what they show of a run."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Self

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from tippetop.fit.delimited import (
    DataColumn,
    columns_of_frame,
    read_columns,
    text_of_bytes,
    text_of_workbook,
)
from tippetop.fit.headings import event_of, plain_unit
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
from tippetop.problem.problem import Problem
from tippetop.results.catalogue import SAMPLED
from tippetop.support.errors import MISSING, Described, InvalidInput, is_number, within_part
from tippetop.support.files import made_of, read_text
from tippetop.support.suggestions import not_one_of
from tippetop.support.units import NUMBER, exponents_of, named_unit, number_in, unit_of

MORE_THAN_A_TURN = 7.0
"""Angle without a unit, rad, that is more than a turn: it is taken for degrees."""

SCALARS = tuple(name for name, variable in SAMPLED.items() if not variable.dimensions)

LONGEST_FILM = 3600.0
"""Seconds beyond which times without a unit are taken for milliseconds or frames."""

LATE_START = 3.0
"""Intervals between rows from which on a first time after 0 may mean another time of launch."""

WORKBOOKS = (".xlsx", ".xlsm")

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
        size = number_in("scale", scale, "m")
        if not (size is None or (is_number(size) and size > 0.0)):
            raise InvalidInput("scale", scale, 'metres per pixel greater than 0, such as "0.2 mm"')
        camera = Camera(view, _point(point), size, unit)
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
    source: Any,
    *,
    view: View | None = None,
    point: Point = "tip",
    scale: Any = None,
    noise: Any = None,
    frame_rate: float | None = None,
    start: Any = None,
    y_down: bool = False,
    track: str | None = None,
) -> Measurement:
    r"""Read data of a video analysis, a spreadsheet or a sound's analysis: a file or a table.

    The header names the columns, with units in brackets, in English or German. There is a time `t`,
    or a number `frame` of the picture; beside it `tilt` or other scalar variables of a run; or `x`
    and `y` of a point in pictures; or `rpm`. A file with columns `event` and `t` has times of
    events. Tabs, semicolons, commas and spaces separate columns, numbers may have decimal commas,
    and cells of missing frames are empty. Files of Tracker are read as they are, places in metres.
    Text is UTF-8, UTF-16 or a code page of Windows; workbooks of Excel (.xlsx) need openpyxl.

    Parameters
    ----------
    source
        The file; or a DataFrame of pandas, or a mapping of headings to lists of numbers.
    view, point, scale
        Of columns x and y, see `Measurement.of_point`. Where the header has a unit of length, it is
        the scale.
    noise
        Standard deviation of each column, in its unit, or a text with another one, such as
        "0.3 mm"; None if it is not known.
    frame_rate
        Pictures a second, where the file numbers pictures; refused beside a column of times.
    start
        Time in the data at which the top is launched, s; rows before it are left out. None for 0,
        which is refused where the data begin later.
    y_down
        Whether y grows downwards, as pixels are counted.
    track
        Name of a track, of files of Tracker that have several; of tracks without names the number.

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
    if not isinstance(source, str | Path):
        return _measurement_of(
            _columns_of(source), view, point, scale, noise, frame_rate, start, y_down
        )
    text = _text_of(source)
    with made_of(source):
        columns = read_columns(text, track)
        return _measurement_of(columns, view, point, scale, noise, frame_rate, start, y_down)


def read_launches(
    source: Any, problem: Problem, *, noise: Any = None
) -> list[tuple[Problem, Measurement]]:
    """Read a table of launches: a row for each, with what it was launched with and when it did
    what.

    Headings are fields of the problem with units, such as "launch.spin (rad/s)", and events, such
    as "turns over (s)". The list goes into `tippetop.fit`.

    Parameters
    ----------
    source
        A file, a DataFrame, or a mapping of headings to lists of numbers.
    problem
        The problem whose fields the rows replace.
    noise
        Standard deviation of the times, in their unit; None if it is not known.

    Returns
    -------
    list
        Problems and measurements; none if the table is not of launches.

    Raises
    ------
    FileTrouble
        If the file cannot be read.
    InvalidInput
        If a launch cannot have such numbers.

    Examples
    --------
    >>> import tippetop as tt
    >>> table = {"launch.spin (rev/s)": [24.0, 25.0], "turns over (s)": [6.1, 5.7]}
    >>> launches = tt.read_launches(table, tt.presets.report_problem(), noise=0.1)
    >>> [round(problem.launch.spin, 1) for problem, _ in launches]
    [150.8, 157.1]
    """
    if not isinstance(source, str | Path):
        return _launches_of(_columns_of(source), problem, noise)
    text = _text_of(source)
    with made_of(source):
        return _launches_of(read_columns(text), problem, noise)


def _launches_of(
    named: Mapping[str, DataColumn], problem: Problem, noise: Any
) -> list[tuple[Problem, Measurement]]:
    """Return the launches of some columns; none if they are not of launches."""
    events = {event_of(name): column for name, column in named.items()}
    events = {name: column for name, column in events.items() if name in EVENT_NAMES}
    fields = {name: column for name, column in named.items() if "." in name}
    if not events or not fields:
        return []
    times = {name: _in_unit(column, "s") for name, column in events.items()}
    noises = _noises(list(events.values()), ["s"] * len(events), noise)
    values = {
        name: _in_unit(column, problem.quantity(name).units) for name, column in fields.items()
    }
    launches = list[tuple[Problem, Measurement]]()
    for row in range(len(next(iter(times.values())))):
        launched = problem.replace({name: float(column[row]) for name, column in values.items()})
        seen = {name: column[row] for name, column in times.items() if np.isfinite(column[row])}
        if seen:
            spreads = None if noises is None else [noises[list(times).index(name)] for name in seen]
            launches.append((launched, Measurement.of_events(seen, spreads)))
    return launches


def _text_of(path: Path | str) -> str:
    """Return the text of a file with a table."""
    if Path(path).suffix.lower() in WORKBOOKS:
        return text_of_workbook(path)
    return read_text(path, "a table of data", text_of_bytes)


def _columns_of(source: Any) -> dict[str, DataColumn]:
    """Return the columns of a table in memory."""
    if isinstance(source, Mapping) or (hasattr(source, "columns") and hasattr(source, "to_csv")):
        return columns_of_frame(source)
    accepted = "a file, a DataFrame, or a mapping of headings to numbers"
    raise InvalidInput("data", Described(f"a {type(source).__name__}"), accepted)


def _measurement_of(
    named: Mapping[str, DataColumn],
    view: View | None,
    point: Point,
    scale: Any,
    noise: Any,
    frame_rate: float | None,
    start: Any,
    y_down: bool,
) -> Measurement:
    """Return the measurement of some columns."""
    if "event" in named:
        return _events(named, noise)
    times = _times(named, frame_rate)
    times = times - _launch_in(times, start)
    since = times >= 0.0
    if not since.any():
        raise InvalidInput("start", start, "a time before the last one of the data")

    def column(name: str, units: str) -> Array:
        return _in_unit(named[name], units)[since]

    if "x" in named and "y" in named:
        metres = _is_length(named["x"].unit)
        units = "m" if metres else "px"
        for name in ("x", "y"):
            unit = named[name].unit
            if _is_length(unit) != metres or not (metres or unit in ("", "px")):
                stated = Described(unit or "no unit")
                accepted = "a length or px, the same for x and y"
                raise InvalidInput(f"unit of column {name}", stated, accepted)
        if view is None:
            raise InvalidInput(
                "view", MISSING, "'above' or 'side': where the pictures were taken from"
            )
        if metres and scale is not None:
            fault = f"is the size of a pixel, and column x is in {named['x'].unit}"
            raise InvalidInput("scale", scale, "", fault, "leave it out")
        x, y = (column(name, units) for name in ("x", "y"))
        return Measurement.of_point(
            times[since],
            x,
            -y if y_down else y,
            view,
            point=point,
            scale=1.0 if metres else scale,
            unit=units,
            noise=_noises([named["x"], named["y"]], [units, units], noise),
        )
    if "rpm" in named:
        rates = np.abs(column("rpm", "rpm"))
        return Measurement.of_spin(times[since], rates, _noises([named["rpm"]], ["rpm"], noise))
    names = [name for name in named if name in SCALARS]
    if not names:
        shown = ", ".join(named)
        accepted = (
            "t and tilt (deg), t and x (mm) and y (mm), t and rpm, t and f (Hz), or event and t"
        )
        raise InvalidInput("columns", shown, accepted)
    units_of = [SAMPLED[name].units for name in names]
    columns = dict(zip(names, map(column, names, units_of), strict=True))
    noises = _noises([named[name] for name in names], units_of, noise)
    return Measurement.of_variables(times[since], columns, noises)


def _launch_in(times: Array, start: Any) -> float:
    """Return the time of the launch in the data."""
    if start is not None:
        return float(number_in("start", start, "s"))
    steps = np.diff(times[np.isfinite(times)])
    apart = float(np.median(steps)) if len(steps) else 0.0
    if len(times) and times[0] > LATE_START * apart > 0.0:
        first = f"{times[0]:.4g}"
        fault = f"is not stated, and the data begin at {first} s"
        hint = f"write {first} if the top is launched at the first row, or 0 if at time 0"
        raise InvalidInput("start", MISSING, "", fault, hint)
    return 0.0


def _times(named: Mapping[str, DataColumn], frame_rate: Any) -> Array:
    """Return the times of the rows, s."""
    if "t" in named:
        if frame_rate is not None:
            fault = "is only for a column of frames, and this file has column t"
            raise InvalidInput("frame_rate", frame_rate, "", fault, "leave it out")
        times = _in_unit(named["t"], "s")
        longest = float(np.nan_to_num(times).max(initial=0.0))
        if not named["t"].unit and longest > LONGEST_FILM:
            fault = "is more than an hour, and the column has no unit"
            hint = "write the unit into the header, such as t (ms)"
            raise InvalidInput("t", f"{longest:.6g}", "", fault, hint)
        return times
    if "frame" not in named:
        raise InvalidInput(
            "columns", ", ".join(named), "", "have no time", "name a column t or frame"
        )
    if not (is_number(frame_rate) and frame_rate > 0.0):
        rate = MISSING if frame_rate is None else frame_rate
        raise InvalidInput("frame_rate", rate, "pictures a second, a number greater than 0")
    frames = named["frame"].numbers()
    since: Array = (frames - frames[0]) / frame_rate
    return since


def _events(named: Mapping[str, DataColumn], noise: Any) -> Measurement:
    """Return the measurement of a file of events."""
    if "t" not in named:
        raise InvalidInput("columns", ", ".join(named), "", "have no time", "name a column t")
    times = _in_unit(named["t"], "s")
    names = [event_of(cell) for cell in named["event"].cells]
    for name in names:
        if names.count(name) > 1:
            raise InvalidInput("event", name, "", "stands twice", "keep the first of a kind")
    noises = _noises([named["t"]], ["s"], noise)
    return Measurement.of_events(dict(zip(names, times.tolist(), strict=True)), noises)


def _largest(numbers: Array) -> float:
    """Return the largest size of the numbers of a column, 0 without any."""
    return float(np.max(np.abs(numbers[np.isfinite(numbers)]), initial=0.0))


def _in_unit(column: DataColumn, units: str) -> Array:
    """Return the numbers of a column in a unit; pixels as they are."""
    numbers = column.numbers()
    if not column.unit and units == "rad" and _largest(numbers) > MORE_THAN_A_TURN:
        largest = f"{_largest(numbers):.4g}"
        fault = "is more than a turn in rad, and the column has no unit"
        hint = f"write the unit into the header: {column.name} (deg) or {column.name} (rad)"
        raise InvalidInput(column.name, largest, "", fault, hint)
    converted: Array = numbers * _factor(column, units)
    return converted


def _factor(column: DataColumn, units: str) -> float:
    """Return the size of a column's unit in another one."""
    if not column.unit or column.unit in ("px", units):
        return 1.0
    asked, size = ("rad s-1", 30.0 / np.pi) if units == "rpm" else (units, 1.0)
    try:
        factor = unit_of(column.unit, column.unit, asked)
    except InvalidInput as error:
        raise within_part(error, f"unit of column {column.name}") from None
    return float(factor.over / factor.under * size)


def _noises(columns: Sequence[DataColumn], units: Sequence[str], noise: Any) -> list[float] | None:
    """Return the standard deviations of columns in units, from numbers in the columns' own."""
    if noise is None:
        return None
    several = list(noise) if isinstance(noise, list | tuple | np.ndarray) else [noise]
    if len(several) not in (1, len(columns)):
        accepted = f"one number, or {len(columns)}, one for each column"
        raise InvalidInput("noise", noise, accepted)
    several *= len(columns) // len(several)
    return [
        _noise_in(one, column, unit)
        for one, column, unit in zip(several, columns, units, strict=True)
    ]


def _noise_in(noise: Any, column: DataColumn, units: str) -> float:
    """Return a standard deviation in a unit, from a number in the column's or a text."""
    value = noise
    if isinstance(noise, str) and (match := NUMBER.fullmatch(noise)):
        value = float(match[1])
        column = column._replace(unit=plain_unit(match[2]) or column.unit)
    if not (is_number(value) and value > 0.0):
        accepted = f"a number greater than 0 in the unit of column {column.name}"
        raise InvalidInput("noise", noise, f"{accepted}, or with a unit, such as '0.3 mm'")
    try:
        return float(value) * _factor(column, units)
    except InvalidInput as error:
        if value is noise:  # The unit is the column's.
            raise
        raise InvalidInput("noise", noise, "", error.fault, error.hint) from None


def _is_length(unit: str) -> bool:
    """Return whether a unit measures lengths of the world."""
    measured = named_unit(unit) if unit and unit != "px" else None
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
