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
from tippetop.engines.bodies import launch_state
from tippetop.engines.case_page import page_of
from tippetop.engines.cases import CASES, Case
from tippetop.engines.derivatives import Derivative, derivatives, units_of
from tippetop.engines.outline import POLE
from tippetop.problem.problem import top_of
from tippetop.results.dataset import CONVENTIONS
from tippetop.support.files import make_folder, place_for, written_beside
from tippetop.support.suggestions import not_one_of

SUITE_VERSION = "1.1"
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

UP = np.array([0.0, 0.0, 1.0])

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
    "energy": ("J", "kinetic energy, and m times height times gravity across the table"),
    "jellett": (
        "kg m2 s-1 m",
        "-L.a, with a from the centre of mass to the lowest point, or the middle of a face",
    ),
}
"""The numbers of a state: their units and meaning; x and y along the table, z up."""


UNITS = {name: unit for name, (unit, _) in COLUMNS.items()}
"""Units of the numbers of a state."""


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
    """Relative change of Jellett's integral; nan where it is not conserved."""
    method: str
    """The second method in words."""
    derivatives: tuple[Derivative, ...] = ()

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
        arm = -float(lowest.height(n[2])) * UP
        if np.hypot(n[0], n[1]) > POLE:  # On a face the arm is to its middle.
            arm -= float(lowest.slope(n[2])) * (n - n[2] * UP)
        jellett.append(-float(L @ arm))
    return {
        "tilt": np.arctan2(np.hypot(axis[:, 0], axis[:, 1]), axis[:, 2]),
        **_components("axis", axis),
        **_components("angular_velocity", omega),
        **_components("velocity", velocity),
        "height": height,
        "energy": energy - body.mass * problem.gravity_vector[2] * height,
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


def reference(case: Case, with_derivatives: bool = False) -> Reference:
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
        float(run["jellett_drift"]) if _conserves_jellett(case) else math.nan,
        stored["method"],
        tuple(derivatives(case, UNITS)) if with_derivatives else (),
    )


def _conserves_jellett(case: Case) -> bool:
    """Return whether nothing in a case changes Jellett's integral."""
    return top_of(case.problem).conserves_jellett


def start_of(problem: tt.Problem) -> dict[str, float]:
    """Return the variables of `COLUMNS` at launch."""
    start, launch = problem.start(), launch_state(problem)
    axis, omega, velocity = (
        np.array([vector], float) for vector in (start.axis, launch.omega, start.velocity)
    )
    numbers = numbers_of(problem, axis, omega, velocity, np.array([float(start.height)]))
    return {name: float(values[0]) + 0.0 for name, values in numbers.items()}


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

SUITE_FOLDER = "suite"
"""Where the texts of the suite are, in this package."""

TEXTS = {
    "README.md": "README.md",
    "DATA_CARD.md": "DATA_CARD.md",
    "test_suite.py": "test_suite.py.txt",
    "test_suite.mjs": "test_suite.mjs",
}
"""Files of the suite that are texts of this package."""


def write_suite(
    folder: Path | str,
    names: Sequence[str] | None = None,
    overwrite: bool = False,
    progress: Callable[[float, float, str], None] = lambda *_: None,
) -> list[Reference]:
    """Write the suite, or the cases named: pages, JSON, CSV and NetCDF, tests and explanations.

    Raises
    ------
    InvalidInput
        If there is no such case.
    FileTrouble
        If a file exists and `overwrite` is false, or cannot be written.
    """
    folder = Path(folder)
    cases = [case_of(name) for name in dict.fromkeys(names)] if names else list(CASES)
    paths = [folder / f"{case.name}{ending}" for case in cases for ending in ENDINGS]
    for path in [*paths, *(folder / name for name in (*TEXTS, "schema.json"))]:
        if path.parent.is_dir():
            place_for(path, overwrite)
    make_folder("out", folder)
    references = []
    for k, case in enumerate(cases):
        progress(k, len(cases), case.name)
        one = reference(case, with_derivatives=True)
        references.append(one)
        for ending, content in ENDINGS.items():
            _write(folder / f"{case.name}{ending}", content(one), overwrite)
    progress(len(cases), len(cases), "")
    _write(folder / "schema.json", json.dumps(SCHEMA, indent=1) + "\n", overwrite)
    for name, source in TEXTS.items():
        _write(folder / name, _text(source, references), overwrite)
    return references


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
        "start": start_of(case.problem),
        "time": one.states["time"].values.tolist(),
        "judged": case.judged - 1,
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
                "agreement": _or_none(apart),
            }
            for time, kind, surface, apart in one.events
        ],
        "derivatives": [
            {**row, "value": _or_none(row["value"]), "agreement": _or_none(row["agreement"])}
            for row in _derivative_rows(one)
        ],
        "checks": {
            "second_method": one.method,
            "energy_error": one.energy_error,
            "jellett_drift": _or_none(one.jellett_drift),
            "event_limit": one.event_limit,
            "state_limit": one.state_limit,
        },
    }


def _or_none(value: float) -> float | None:
    """Return a number as JSON has it: nothing for nan."""
    return None if math.isnan(value) else value


def _derivative_rows(one: Reference) -> list[dict[str, Any]]:
    """Return the derivatives of a case, each with its unit."""
    units = units_of(one.case)
    rows = []
    for derivative in one.derivatives:
        above = "s" if derivative.number.startswith("event") else COLUMNS[derivative.number][0]
        unit = f"({above})/({units[derivative.parameter]})"
        rows.append({**derivative._asdict(), "unit": unit})
    return rows


def _json(one: Reference) -> str:
    return json.dumps(record(one), indent=1) + "\n"


def _derivatives_csv(one: Reference) -> str:
    rows = _derivative_rows(one)
    headings = ("parameter", "number", "value", "unit", "agreement", "reason")
    cells = (
        [
            "" if isinstance(row[name], float) and math.isnan(row[name]) else row[name]
            for name in headings
        ]
        for row in rows
    )
    return _rows(headings, cells)


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


def _netcdf(one: Reference) -> bytes:
    memory = BytesIO()
    _dataset(one).to_netcdf(memory, engine="h5netcdf")
    return memory.getvalue()


def _page(one: Reference) -> str:
    return page_of(one.case, record(one))


ENDINGS: Mapping[str, Callable[[Reference], str | bytes]] = {
    ".html": _page,
    ".json": _json,
    "_states.csv": _states_csv,
    "_events.csv": _events_csv,
    "_derivatives.csv": _derivatives_csv,
    ".nc": _netcdf,
}
"""Files of a case by how they end, and what is in them."""


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
        *("start", "judged", "states", "events", "derivatives", "checks"),
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
        "start": {
            "type": "object",
            "description": "state at t = 0, units as those of states",
            "required": list(COLUMNS),
            "additionalProperties": {"type": "number"},
        },
        "time": {**_NUMBERS, "description": "instants of the states, s"},
        "judged": {
            "type": "integer",
            "description": "number of an instant, from 0, at which an error is no mere phase",
        },
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
        "derivatives": {
            "type": "array",
            "description": "of the last state, and of the times of events, by the parameters",
            "items": {
                "type": "object",
                "required": ["parameter", "number", "value", "unit", "agreement", "reason"],
                "properties": {
                    "parameter": {"type": "string", "description": "field of the problem"},
                    "number": {
                        "type": "string",
                        "description": "a column of the states, or 'event 3': number from 0",
                    },
                    "value": {"type": ["number", "null"]},
                    "unit": {"type": "string"},
                    "agreement": {
                        **_AGREEMENT,
                        "description": "difference of two methods; null where one has none",
                    },
                    "reason": {"type": "string", "description": "why there is no value"},
                },
            },
        },
        "checks": {"type": "object"},
    },
}
"""JSON schema of a case's file."""


def _text(source: str, references: Sequence[Reference]) -> str:
    """Return a text of the suite, with what depends on the cases in it."""
    text = (files(__package__) / SUITE_FOLDER / source).read_text(encoding="utf-8")
    rows = [
        f"| [`{one.case.name}`]({one.case.name}.html) | {one.case.title} | {one.case.tests} |"
        f" {len(one.events)} | {_order(one.event_agreement)} | {_order(one.state_agreement)} |"
        for one in references
    ]
    fields = {
        "version": SUITE_VERSION,
        "program": tt.__version__,
        "count": str(len(references)),
        "rows": "\n".join(rows),
    }
    for name, value in fields.items() if source.endswith(".md") else ():
        text = text.replace(f"{{{name}}}", value)
    return text


def _order(value: float) -> str:
    return "" if math.isnan(value) else f"{value:.0e}"
