"""Fits in files: a fit with its data is written as JSON and read again.

Numbers that JSON does not have are the texts "inf", "-inf" and "nan".
"""

import json
import math
from collections.abc import Mapping
from dataclasses import asdict, fields
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from tippetop.fit.fit_result import FitResult, search_of
from tippetop.fit.measurement import Measurement
from tippetop.fit.model import Model
from tippetop.fit.observations import Camera, EventTimes, SpinRate, Variables
from tippetop.fit.search import Search
from tippetop.problem.problem import Problem
from tippetop.support.errors import Described, FileTrouble, InvalidInput, require
from tippetop.support.files import in_words, named, path_of, require_ending, written_beside

FORMAT = "tippetop fit 1"
"""Name and version of the format; a file of another is refused."""

OBSERVATIONS: Mapping[str, Any] = {
    "variables": Variables,
    "spin": SpinRate,
    "point": Camera,
    "events": EventTimes,
}
"""Observations that can be written, by their names in files."""


def write_fit(fit: FitResult, path: Path | str, overwrite: bool = False) -> Path:
    """Write a fit with its data as JSON, and return the path.

    Raises
    ------
    InvalidInput
        If the argument is no fit, the data are those of a function, which cannot be written, or the
        name does not end in .json.
    FileTrouble
        If the file exists and `overwrite` is false, or cannot be written.

    Examples
    --------
    >>> import tippetop as tt
    >>> film = tt.Measurement.of_variables(
    ...     [0.0, 0.1, 0.2, 0.3], {"tilt": [0.09, 0.13, 0.11, 0.07]}, noise=0.05
    ... )
    >>> fitted = tt.fit(tt.presets.report_problem(), film, "friction.mu")
    >>> again = tt.read_fit(tt.write_fit(fitted, "fit.json"))
    >>> again.values == fitted.values and again.problem == fitted.problem
    True
    """
    require("fit", fit, FitResult, "a fit, as fit returns it")
    place = path_of(path)
    require_ending("path", place, (".json",))
    text = json.dumps(_plain(_content(fit)), indent=1)
    with written_beside(place, overwrite) as beside:
        beside.write_text(text + "\n", encoding="utf-8")
    return place


def read_fit(path: Path | str) -> FitResult:
    """Return a fit that `write_fit` wrote; all its methods work as before.

    Raises
    ------
    FileTrouble
        If the file cannot be read, or is not a fit.

    Examples
    --------
    >>> import tippetop as tt
    >>> film = tt.Measurement.of_events({"turnover_time": 6.0}, noise=0.05)
    >>> fitted = tt.fit(tt.presets.report_problem(spin=155.0), film, "friction.mu")
    >>> tt.read_fit(tt.write_fit(fitted, "clock.json")).errors == fitted.errors
    True
    """
    place = path_of(path)
    with in_words(place, "read"):
        text = place.read_text(encoding="utf-8")
    try:
        content = json.loads(text)
        if content["format"] != FORMAT:
            raise FileTrouble(
                f"{named(place)} is written as {content['format']}, and this version reads {FORMAT}"
            )
        return _fit(content)
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError):
        raise FileTrouble(f"{named(place)} is not a fit of this program") from None


def _content(fit: FitResult) -> dict[str, Any]:
    """Return a fit as plain data."""
    search = search_of(fit)
    if len(fit.problems) > 1:
        raise InvalidInput("fit", Described("a fit of several launches"), "a fit of one launch")
    content = {one.name: getattr(fit, one.name) for one in fields(fit) if one.name != "_search"}
    return content | {
        "format": FORMAT,
        "problem": json.loads(fit.problem.to_json()),
        "problems": [],
        "covariance": fit.covariance.values,
        "measurements": [_measurement_content(one) for one in fit.measurements],
        "search": {
            "fields": search.model.fields,
            "low": search.low[: len(search.model.fields)],
            "high": search.high[: len(search.model.fields)],
            "deviations": search.deviations if search.is_noise_known else None,
        },
    }


def _measurement_content(one: Measurement) -> dict[str, Any]:
    """Return a measurement as plain data."""
    kinds = [name for name, kind in OBSERVATIONS.items() if type(one.observation) is kind]
    if not kinds:
        raise InvalidInput(
            "fit", Described("data of a function"), "data of variables, points, spins or events"
        )
    observation: Any = one.observation
    return {
        "name": one.name,
        "times": one.times,
        "values": one.values,
        "noise": one.noise,
        "observation": {"kind": kinds[0], **asdict(observation)},
    }


def _fit(content: dict[str, Any]) -> FitResult:
    """Return the fit of plain data."""
    problem = Problem(**content["problem"])
    measurements = tuple(_measurement(one) for one in content["measurements"])
    stated = content["search"]
    model = Model(problem, measurements, stated["fields"])
    model.runs = content["runs"]
    deviations = None if stated["deviations"] is None else _array(stated["deviations"])
    search = Search(model, deviations, _array(stated["low"]), _array(stated["high"]))
    names = list(content["values"])
    restored: dict[str, Any] = {
        "problem": problem,
        "problems": (problem,),
        "values": _numbers(content["values"]),
        "errors": _numbers(content["errors"]),
        "covariance": xr.DataArray(
            _array(content["covariance"]).reshape(len(names), len(names)),
            {"parameter": names, "other_parameter": names},
            ("parameter", "other_parameter"),
        ),
        "residuals": tuple(
            _array(part).reshape(one.values.shape)
            for part, one in zip(content["residuals"], measurements, strict=True)
        ),
        "noise": tuple(map(_array, content["noise"])),
        "alternatives": tuple(map(_numbers, content["alternatives"])),
        "measurements": measurements,
        "_search": search,
    }
    plain = {one.name: content[one.name] for one in fields(FitResult) if one.name not in restored}
    texts: dict[str, Any] = {
        name: tuple(value) if isinstance(value, list) else _number(value)
        for name, value in plain.items()
    }
    return FitResult(**restored, **texts)


def _measurement(content: dict[str, Any]) -> Measurement:
    """Return the measurement of plain data."""
    stated = dict(content["observation"])
    kind = OBSERVATIONS[stated.pop("kind")]
    observation = kind(
        **{key: tuple(value) if isinstance(value, list) else value for key, value in stated.items()}
    )
    values = _array(content["values"]).reshape(-1, len(observation.labels))
    noise = None if content["noise"] is None else _array(content["noise"])
    return Measurement(_array(content["times"]), values, observation, noise, content["name"])


def _plain(value: Any) -> Any:
    """Return a value as JSON has it, with texts for numbers that are not finite."""
    if isinstance(value, Mapping):
        return {str(key): _plain(inner) for key, inner in value.items()}
    if isinstance(value, np.ndarray | np.generic):
        return _plain(value.tolist())
    if isinstance(value, list | tuple):
        return [_plain(inner) for inner in value]
    return str(value) if isinstance(value, float) and not math.isfinite(value) else value


def _number(value: Any) -> Any:
    return float(value) if isinstance(value, str) else value


def _numbers(table: Mapping[str, Any]) -> dict[str, float]:
    return {name: float(value) for name, value in table.items()}


def _array(value: Any) -> np.ndarray[Any, np.dtype[np.float64]]:
    return np.array(value, dtype=float)
