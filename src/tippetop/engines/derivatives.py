"""Derivatives of the numbers of a case by the parameters of its problem, confirmed twice.

`tt.sensitivities` follows the variational equations of a run through its events; the second method
differs runs of its solver at two steps. A derivative on which they do not agree is left out.
"""

import json
import math
from collections.abc import Iterable, Iterator, Mapping
from importlib.resources import files
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

import tippetop as tt
from tippetop.engines.cases import Case
from tippetop.mechanics.top import natural_units
from tippetop.problem.problem import top_of
from tippetop.support.field_paths import numbers_of as fields_of
from tippetop.support.units import exponents_of

Array = NDArray[np.float64]

LIMIT = 1e-6
"""Largest difference of the two methods, in the largest derivative of the same number, with each
parameter in its value.
"""

LEAST = 1e-6
"""Least size of the largest derivative of a number, in natural units: of one that does not change,
such as a component that is zero, the methods give rounding.
"""

NOT_CONFIRMED = "the second method has not computed it"

NO_PLACE = "on a slope the energy that states list leaves out the work of gravity along the table"


class Derivative(NamedTuple):
    """The derivative of a number of a case by a parameter."""

    parameter: str
    number: str
    """A column of the states, at the end of the run; or "event 3" for its time."""
    value: float
    """In the unit of the number over that of the parameter; nan where there is none."""
    agreement: float
    """Difference of the two methods; nan where one of them has none."""
    reason: str
    """Why there is none; "" where there is one."""


def parameters_of(case: Case) -> list[str]:
    """Return the parameters of a problem that are not zero: by the others it is not smooth.

    The azimuth of a launch only turns the motion.
    """
    return [
        name
        for name, value in fields_of(case.problem.model_dump())
        if value and not name.startswith("body.profile") and name != "launch.azimuth"
    ]


def units_of(case: Case) -> dict[str, str]:
    """Return the units of a case's parameters."""
    return {name: case.problem.quantity(name).units for name in parameters_of(case)}


def independent_slopes(case: Case) -> dict[str, Any] | None:
    """Return the stored derivatives of the second method; None without them."""
    path = files(__package__) / "independent" / f"{case.name}_derivatives.json"
    if not path.is_file():
        return None
    stored: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    return stored


def _natural_unit(case: Case, units: str) -> float:
    """Return the natural unit of a number with SI units in a case."""
    natural = natural_units(top_of(case.problem))
    length, mass, time, _ = exponents_of(units) if units != "1" else (0, 0, 0, 0)
    return float(natural.length**length * natural.mass**mass * natural.time**time)


def derivatives(case: Case, columns: Mapping[str, str]) -> list[Derivative]:
    """Return the derivatives of the states at the end and of the times of events, by parameter.

    `columns` are the numbers of a state with their units.
    """
    stored = independent_slopes(case)
    names = parameters_of(case)
    if stored is None:
        return [
            Derivative(name, number, math.nan, math.nan, NOT_CONFIRMED)
            for name in names
            for number in columns
        ]
    slopes = tt.sensitivities(case.problem, case.duration, names, times=[0.0, *case.times])
    reasons = [str(reason) for reason in slopes["reason"].values]
    if not case.problem.table.is_level:
        # The energy of a run is that of its place too, which states do not list.
        slopes["energy"] = slopes["energy"] * math.nan
        reasons = [reason or NO_PLACE for reason in reasons]
    first = {name: _numbers(slopes.isel(parameter=k), columns) for k, name in enumerate(names)}
    second = {one["parameter"]: _stored_numbers(one, columns) for one in stored["parameters"]}
    largest = {name: LEAST * _natural_unit(case, units) for name, units in columns.items()}
    for name in names:
        scale = abs(case.problem.get(name))
        for number, value in first[name].items():
            if math.isfinite(value):
                least = LEAST * _natural_unit(case, "s")
                largest[number] = max(largest.get(number, least), abs(value) * scale)
    return [
        one
        for name, reason in zip(names, reasons, strict=True)
        for one in _compared(case, name, first[name], second.get(name, {}), largest, reason)
    ]


def _compared(
    case: Case,
    parameter: str,
    first: Mapping[str, float],
    second: Mapping[str, float],
    largest: Mapping[str, float],
    reason: str,
) -> Iterator[Derivative]:
    """Yield the derivatives by a parameter, without those on which the methods do not agree."""
    scale = abs(case.problem.get(parameter))
    for number, value in first.items():
        apart = abs(value - second.get(number, math.nan))
        limit = LIMIT * largest.get(number, 0.0) / scale
        if math.isnan(value):
            why = reason or "there is none"
        elif not second:
            why = NOT_CONFIRMED
        elif math.isnan(apart):
            why = "the second method follows another sequence of events"
        elif apart > limit:
            why = f"the two methods differ by {apart:.1e}, more than {limit:.1e}"
        else:
            yield Derivative(parameter, number, value, apart, "")
            continue
        yield Derivative(parameter, number, math.nan, apart, why)


def _numbers(slopes: Any, columns: Iterable[str]) -> dict[str, float]:
    """Return the derivatives of a run's last state and of its events, by number."""
    numbers = {}
    for column in columns:
        name, _, letter = column.rpartition("_")
        vector = name in slopes and letter in ("x", "y", "z")
        values = slopes[name].isel(space="xyz".index(letter)) if vector else slopes[column]
        numbers[column] = float(values.values[-1])
    for place, value in enumerate(slopes["event_time"].values):
        numbers[f"event {place}"] = float(value)
    return numbers


def _stored_numbers(record: Mapping[str, Any], columns: Iterable[str]) -> dict[str, float]:
    """Return the second method's derivatives by number."""
    numbers = {name: value for name, (value, _) in zip(columns, record["states"], strict=True)}
    for place, (value, _) in enumerate(record["events"] or ()):
        numbers[f"event {place}"] = value
    return numbers
