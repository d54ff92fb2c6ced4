"""The reference suite: runs of the cases, each number with the agreement of a second method."""

import csv
import json
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from importlib.resources import files
from io import BytesIO, StringIO
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import NDArray

import tippetop as tt
from tippetop.engines.cases import CASES, Case
from tippetop.results.dataset import CONVENTIONS
from tippetop.support.files import make_folder, place_for, written_beside
from tippetop.support.suggestions import not_one_of

SUITE_VERSION = "1.0"
"""Version of the cases: another problem, launch or instant is another version."""

INDEPENDENT_FOLDER = "independent"
"""Where the numbers of the independent solver are, in this package."""

EVENT_LIMIT, STATE_LIMIT = 1e-10, 1e-8
"""Largest differences of the two methods where a case allows no more: of events, s, and of states,
relative to their scale.
"""

RATE_AFTER_CUT_OFF = 10.0
"""Change of a state's number a second of delay, over the largest of its kind, 1/s."""

ROUNDING = 2.0**-52
"""Relative rounding of a number: no agreement is better."""

Array = NDArray[np.float64]

COLUMNS: Mapping[str, tuple[str, str]] = {
    "tilt": ("rad", "tilt of the axis from the vertical"),
    "axis_x": ("1", "unit vector along the axis of symmetry"),
    "axis_y": ("1", "unit vector along the axis of symmetry"),
    "axis_z": ("1", "unit vector along the axis of symmetry"),
    "angular_velocity_x": ("rad s-1", "angular velocity"),
    "angular_velocity_y": ("rad s-1", "angular velocity"),
    "angular_velocity_z": ("rad s-1", "angular velocity"),
    "velocity_x": ("m s-1", "velocity of the centre of mass"),
    "velocity_y": ("m s-1", "velocity of the centre of mass"),
    "velocity_z": ("m s-1", "velocity of the centre of mass"),
    "height": ("m", "height of the centre of mass above the table"),
    "energy": ("J", "kinetic energy, and potential energy m g height"),
    "jellett": ("kg m2 s-1 m", "-L.a, with a from the centre of mass to the lowest point"),
}
"""The numbers of a state: their units and meaning; x and y along the table, z up."""


class Reference(NamedTuple):
    """A case with its numbers and how well two methods agree on each."""

    case: Case
    states: xr.Dataset
    """Over `time` the variables of `COLUMNS`, and with `_agreement` the differences between the
    methods, never less than rounding."""
    events: tuple[tuple[float, str, int, float], ...]
    """Time, kind, surface and agreement of each event; nan where the second method has no such
    event."""
    status: str
    energy_error: float
    jellett_drift: float
    method: str
    """The second method in words."""

    @property
    def event_agreement(self) -> float:
        """The largest difference of an event's time, s; nan without events."""
        times = [event[3] for event in self.events]
        return float(np.nanmax(times)) if times and not all(map(math.isnan, times)) else math.nan

    @property
    def state_agreement(self) -> float:
        """The largest difference of a state's number, relative to the largest of its kind."""
        groups = {
            "axis": ("axis_x", "axis_y", "axis_z"),
            "angular_velocity": ("angular_velocity_x", "angular_velocity_y", "angular_velocity_z"),
            "velocity": ("velocity_x", "velocity_y", "velocity_z"),
            "height": ("height",),
        }
        errors = []
        for names in groups.values():
            size = max(float(np.abs(self.states[name]).max()) for name in names)
            apart = max(float(self.states[f"{name}_agreement"].max()) for name in names)
            errors.append(apart / size if size else 0.0)
        return max(errors)

    @property
    def event_limit(self) -> float:
        """The largest difference of an event's time with which the methods agree, s.

        Events after an infinite sequence of rebounds are late by the time it is cut off before.
        """
        return EVENT_LIMIT + self.case.cut_off + self.case.added_up

    @property
    def state_limit(self) -> float:
        """The largest difference of a state's number with which the methods agree, relative."""
        return STATE_LIMIT + self.case.cut_off * RATE_AFTER_CUT_OFF

    @property
    def agrees(self) -> bool:
        """Whether both methods agree within the limits."""
        late = self.event_agreement > self.event_limit
        return not late and self.state_agreement <= self.state_limit


def case_of(name: str) -> Case:
    """Return the case of this name; raises `InvalidInput` if there is none."""
    for case in CASES:
        if case.name == name:
            return case
    raise not_one_of("case", name, [case.name for case in CASES])


def numbers_of(
    problem: tt.Problem, axis: Array, omega: Array, velocity: Array, height: Array
) -> dict[str, Array]:
    """Return the variables of `COLUMNS` from states in rows: vectors and the height."""
    body = problem.body
    momentum = body.I1 * omega + (body.I3 - body.I1) * np.sum(axis * omega, 1)[:, None] * axis
    energy = 0.5 * body.mass * np.sum(velocity**2, 1) + 0.5 * np.sum(omega * momentum, 1)
    jellett = []
    for n, L in zip(axis, momentum, strict=True):
        surfaces = [shape.surface for shape in body.shapes]
        lowest = max(surfaces, key=lambda surface: float(surface.height(n[2])))
        slope, support = float(lowest.slope(n[2])), float(lowest.height(n[2]))
        up = np.array([0.0, 0.0, 1.0])
        jellett.append(float(L @ (slope * (n - n[2] * up) + support * up)))
    return {
        "tilt": np.arctan2(np.hypot(axis[:, 0], axis[:, 1]), axis[:, 2]),
        **_components("axis", axis),
        **_components("angular_velocity", omega),
        **_components("velocity", velocity),
        "height": height,
        "energy": energy + body.mass * problem.gravity * height,
        "jellett": np.array(jellett),
    }


def _components(name: str, vectors: Array) -> dict[str, Array]:
    return {f"{name}_{letter}": vectors[:, k] for k, letter in enumerate("xyz")}


def independent(case: Case) -> dict[str, Any]:
    """Return the stored states, events and method of the independent solver."""
    text = (files(__package__) / INDEPENDENT_FOLDER / f"{case.name}.json").read_text(
        encoding="utf-8"
    )
    stored: dict[str, Any] = json.loads(text)
    return stored


def judged_state(case: Case, axis: Array, omega: Array) -> Array:
    """Return the numbers by which programs are judged: the axis, and the angular velocity over the
    largest of the case.
    """
    rows = np.array(independent(case)["states"])[: case.compared]
    largest = float(np.linalg.norm(rows[:, 4:7], axis=1).max())
    return np.concatenate([axis, omega / largest])


def reference_state(case: Case) -> Array:
    """Return the `judged_state` of the independent solver."""
    row = np.array(independent(case)["states"][case.judged - 1])
    return judged_state(case, row[1:4], row[4:7])


def reference(case: Case) -> Reference:
    """Run a case here, and hold each number against the independent solver's."""
    stored = independent(case)
    times = case.times
    run = tt.simulate(case.problem, case.duration, times=[0.0, *times])
    sampled = [run[name].values[1:] for name in ("axis", "angular_velocity", "velocity", "height")]
    # A body that came to rest stays as it is.
    sampled = [_lasting(values, len(times)) for values in sampled]
    computed = numbers_of(case.problem, *sampled)
    rows = np.array(stored["states"])
    second = numbers_of(case.problem, rows[:, 1:4], rows[:, 4:7], rows[:, 7:10], rows[:, 10])
    variables = {}
    for name, (unit, meaning) in COLUMNS.items():
        apart = np.maximum(np.abs(computed[name] - second[name]), ROUNDING * np.abs(computed[name]))
        attributes = {"units": unit, "long_name": meaning}
        variables[name] = ("time", computed[name], attributes)
        about = {"units": unit, "long_name": f"difference of two methods: {name}"}
        variables[f"{name}_agreement"] = ("time", apart, about)
    states = xr.Dataset(variables, {"time": ("time", times, {"units": "s"})})
    return Reference(
        case,
        states,
        tuple(_events(run, stored["events"])),
        run.attrs["status"],
        float(run["energy_error"]),
        float(run["jellett_drift"]),
        stored["method"],
    )


def _lasting(values: Array, count: int) -> Array:
    """Return rows with the last one repeated up to a number of them."""
    return np.concatenate([values, np.repeat(values[-1:], count - len(values), axis=0)])


def _events(
    run: xr.Dataset, others: Sequence[Sequence[Any]]
) -> Iterator[tuple[float, str, int, float]]:
    """Yield the events of a run with the distance to the nearest of the same kind and surface."""
    names = ("event_time", "event_kind", "event_surface")
    for time, kind, surface in zip(*(run[name].values for name in names), strict=True):
        alike = [abs(time - t) for t, k, i in others if (k, i) == (kind, surface)]
        apart = max(min(alike), ROUNDING * abs(time)) if alike else math.nan
        yield float(time), str(kind), int(surface), apart


# Files


def write_suite(
    folder: Path | str,
    names: Sequence[str] | None = None,
    overwrite: bool = False,
    progress: Callable[[float, float, str], None] = lambda *_: None,
) -> list[Reference]:
    """Write the suite, or the cases named, as JSON, CSV and NetCDF with a schema and a README.

    Raises
    ------
    InvalidInput
        If there is no such case.
    FileTrouble
        If a file exists and `overwrite` is false, or cannot be written.
    """
    folder = Path(folder)
    cases = [case_of(name) for name in dict.fromkeys(names)] if names else list(CASES)
    paths = [folder / name for case in cases for name in _files_of(case.name)]
    for path in [*paths, *(folder / name for name in ("README.md", "schema.json"))]:
        if path.parent.is_dir():
            place_for(path, overwrite)
    make_folder("out", folder)
    references = []
    for k, case in enumerate(cases):
        progress(k, len(cases), case.name)
        one = reference(case)
        references.append(one)
        as_json, states, events, netcdf = _files_of(case.name)
        _write(folder / as_json, json.dumps(record(one), indent=1) + "\n", overwrite)
        _write(folder / states, _states_csv(one), overwrite)
        _write(folder / events, _events_csv(one), overwrite)
        memory = BytesIO()
        _dataset(one).to_netcdf(memory, engine="h5netcdf")
        _write(folder / netcdf, memory.getvalue(), overwrite)
    progress(len(cases), len(cases), "")
    _write(folder / "schema.json", json.dumps(SCHEMA, indent=1) + "\n", overwrite)
    _write(folder / "README.md", _readme(references), overwrite)
    return references


def _files_of(name: str) -> tuple[str, str, str, str]:
    return f"{name}.json", f"{name}_states.csv", f"{name}_events.csv", f"{name}.nc"


def _write(path: Path, content: str | bytes, overwrite: bool) -> None:
    with written_beside(path, overwrite) as beside:
        beside.write_bytes(content.encode() if isinstance(content, str) else content)


def record(one: Reference) -> dict[str, Any]:
    """Return a case as its JSON file has it."""
    case = one.case
    return {
        "suite": SUITE_VERSION,
        "program": f"tippetop {tt.__version__}",
        "case": case.name,
        "title": case.title,
        "tests": case.tests,
        "problem": json.loads(case.problem.to_json()),
        "duration": case.duration,
        "status": one.status,
        "time": one.states["time"].values.tolist(),
        "states": {
            name: {
                "unit": unit,
                "meaning": meaning,
                "values": one.states[name].values.tolist(),
                "agreement": one.states[f"{name}_agreement"].values.tolist(),
            }
            for name, (unit, meaning) in COLUMNS.items()
        },
        "events": [
            {
                "time": time,
                "kind": kind,
                "surface": surface,
                "agreement": None if math.isnan(apart) else apart,
            }
            for time, kind, surface, apart in one.events
        ],
        "checks": {
            "second_method": one.method,
            "energy_error": one.energy_error,
            "jellett_drift": None if math.isnan(one.jellett_drift) else one.jellett_drift,
            "event_limit": one.event_limit,
            "state_limit": one.state_limit,
        },
    }


def _rows(headings: Sequence[str], rows: Iterator[Sequence[Any]]) -> str:
    text = StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(headings)
    writer.writerows(rows)
    return text.getvalue()


def _states_csv(one: Reference) -> str:
    names = ["time", *(part for name in COLUMNS for part in (name, f"{name}_agreement"))]
    columns = [one.states[name].values.tolist() for name in names]
    return _rows(names, zip(*columns, strict=True))


def _events_csv(one: Reference) -> str:
    rows = ((t, kind, i, "" if math.isnan(d) else d) for t, kind, i, d in one.events)
    return _rows(("time", "kind", "surface", "agreement"), rows)


def _dataset(one: Reference) -> xr.Dataset:
    """Return states and events as one dataset."""
    time, kind, surface, apart = zip(*one.events, strict=True) if one.events else ([],) * 4
    fields = record(one)
    attributes = {name: fields[name] for name in ("suite", "program", "case", "title", "status")}
    events = {
        "event_time": ("event", np.array(time, float), {"units": "s"}),
        "event_kind": ("event", np.array(kind, dtype=object)),
        "event_surface": ("event", np.array(surface, np.int8)),
        "event_agreement": ("event", np.array(apart, float), {"units": "s"}),
    }
    return one.states.assign(events).assign_attrs(
        **attributes,
        problem=case_json(one.case),
        second_method=one.method,
        Conventions=CONVENTIONS,
    )


def case_json(case: Case) -> str:
    """Return the problem of a case as JSON text."""
    return case.problem.to_json()


_NUMBERS = {"type": "array", "items": {"type": "number"}}
_AGREEMENT = {"type": ["number", "null"], "minimum": 0}
SCHEMA: Mapping[str, Any] = {
    "$schema": "https://json-schema.org/draft/2020-12/schema",
    "title": "A case of the tippetop reference suite",
    "type": "object",
    "required": [
        *("suite", "program", "case", "title", "problem", "duration", "status", "time"),
        *("states", "events", "checks"),
    ],
    "properties": {
        "suite": {"type": "string", "description": "version of the suite"},
        "program": {"type": "string"},
        "case": {"type": "string"},
        "title": {"type": "string"},
        "tests": {"type": "string"},
        "problem": {
            "type": "object",
            "description": "body, friction, launch, contact, gravity, rolling resistance; SI",
            "required": ["body", "friction", "launch", "contact", "gravity"],
        },
        "duration": {"type": "number", "description": "s"},
        "status": {"type": "string", "description": "how the run ended"},
        "time": {**_NUMBERS, "description": "instants of the states, s"},
        "states": {
            "type": "object",
            "required": list(COLUMNS),
            "additionalProperties": {
                "type": "object",
                "required": ["unit", "values", "agreement"],
                "properties": {
                    "unit": {"type": "string"},
                    "meaning": {"type": "string"},
                    "values": _NUMBERS,
                    "agreement": {
                        **_NUMBERS,
                        "description": "difference of two methods that share no code",
                    },
                },
            },
        },
        "events": {
            "type": "array",
            "items": {
                "type": "object",
                "required": ["time", "kind", "surface", "agreement"],
                "properties": {
                    "time": {"type": "number", "description": "s"},
                    "kind": {"type": "string"},
                    "surface": {"type": "integer", "description": "number in body.shape"},
                    "agreement": {**_AGREEMENT, "description": "s; null where there is none"},
                },
            },
        },
        "checks": {"type": "object"},
    },
}
"""JSON schema of a case's file."""


def _readme(references: Sequence[Reference]) -> str:
    template = (files(__package__) / "suite_readme.md").read_text(encoding="utf-8")
    rows = [
        f"| `{one.case.name}` | {one.case.title} | {one.case.tests} | {len(one.events)} |"
        f" {_order(one.event_agreement)} | {_order(one.state_agreement)} |"
        for one in references
    ]
    fields = {"version": SUITE_VERSION, "program": tt.__version__, "rows": "\n".join(rows)}
    for name, value in fields.items():
        template = template.replace(f"{{{name}}}", value)
    return template


def _order(value: float) -> str:
    return "" if math.isnan(value) else f"{value:.0e}"
