"""The cases in other programs, held against the reference: errors, order and cost."""

import datetime
import json
import math
import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from importlib.resources import files
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

import tippetop as tt
from tippetop.engines.adapters import ADAPTERS, adapter, results_name
from tippetop.engines.adapters.base import (
    Adapter,
    EngineState,
    Setting,
    is_installed,
    refusals,
    settings_of,
    version_of,
)
from tippetop.engines.cases import CASES, Case
from tippetop.engines.limits import Limit, limit_of
from tippetop.engines.reference import (
    SUITE_VERSION,
    case_of,
    independent,
    judged_state,
    numbers_of,
    reference_state,
)
from tippetop.support.errors import InvalidInput
from tippetop.support.files import make_folder, read_text, written_beside

Array = NDArray[np.float64]

STEPS = (2e-3, 1e-3, 5e-4, 2.5e-4, 1.25e-4)
"""Lengths of the steps, s; each is shortened to fit the instants of the states."""

READINGS = 2e-3
"""How often the tilt is read for the time of turning over, s: a case whose states are closer has
steps shorter in the same proportion."""

SHORTEST = 1e-6
"""Shortest step, s: a run of the briefest case, whose steps are a twentieth, takes seconds with it,
and one of the longest some minutes."""

HOLDS = 0.01
"""Error of the tilt up to which a run holds, rad."""

ROUNDING_OF_JELLETT = 1e-9
"""Part of I1 times angular velocity times height below which Jellett's integral is zero: rounding
is far below it, and no case that spins is near it."""

LONGEST = 60.0
"""Longest processor time of a run, s: a shorter step that would take longer is left out."""

DRAWN = 200
"""Number of tilts that are stored of the shortest step, for figures."""

RESULTS_FOLDER = "results"
"""Where stored results are, in this package."""

Progress = Callable[[float, float, str], None]


class EngineTask(NamedTuple):
    """A case in a program at a setting."""

    adapter: Adapter
    case: Case
    setting: Setting
    results: str = ""
    """Name of its results."""


def tasks(names: Sequence[str] | None, cases: Sequence[str] | None) -> Iterator[EngineTask]:
    """Yield what programs can follow, program by program; `InvalidInput` for unknown names."""
    made = {name: adapter(name) for name in names or ADAPTERS}
    _require_results_apart(list(made))
    chosen = [case_of(name) for name in cases] if cases else list(CASES)
    for name, one in made.items():
        for case in chosen:
            for setting in settings_of(one, case):
                yield EngineTask(one, case, setting, results_name(name))


def _require_results_apart(names: Sequence[str]) -> None:
    """Refuse a program whose results would be in the same file as those of another one."""
    by_results = {name: name for name in ADAPTERS}
    for name in names:
        first = by_results.setdefault(results_name(name), name)
        if first != name:
            fault = f"has results of the same name as {first}"
            raise InvalidInput("engine", name, "", fault, "rename the file")


def installed(names: Sequence[str] | None = None) -> list[str]:
    """Return the names of the programs installed here, among them the stepping of this one."""
    return [name for name in names or ADAPTERS if is_installed(adapter(name))]


class Exact(NamedTuple):
    """What a case has to be: states at its instants, and when it turns over."""

    numbers: Mapping[str, Array]
    turnover_time: float
    """First time at which the tilt passes a right angle, s; nan where it does not."""
    energy: float
    """At launch, J."""
    jellett: float
    """At launch, kg m^3/s; nan where it is zero, or rounding of zero."""


def exact(case: Case) -> Exact:
    """Return the reference of a case, from the independent solver's states and a run here."""
    rows = np.array(independent(case)["states"])
    numbers = numbers_of(case.problem, rows[:, 1:4], rows[:, 4:7], rows[:, 7:10], rows[:, 10])
    run = tt.simulate(case.problem, case.duration, samples=2)
    energy, jellett = float(run["energy"][0]), float(run["jellett"][0])
    largest = case.problem.body.I1 * np.abs(rows[:, 4:7]).max() * rows[:, 10].max()
    if abs(jellett) < ROUNDING_OF_JELLETT * largest:
        jellett = math.nan
    return Exact(numbers, float(run["turnover_time"]), energy, jellett)


def measure(task: EngineTask, step: float, reference: Exact, drawn: bool) -> dict[str, Any]:
    """Follow a task with steps of about this length, and return the row of a table."""
    case, problem = task.case, task.case.problem
    between, times = case.times[0], case.times[: case.compared]
    readings_between = max(1, math.ceil(between / READINGS * (1.0 - 1e-9)))
    interval = between / readings_between
    each = max(1, math.ceil(READINGS / step * (1.0 - 1e-9)))
    length = interval / each
    started = time.process_time()
    stepper = task.adapter.start(case, length, task.setting)
    readings, tilts, over = list[EngineState](), [problem.launch.tilt], math.nan
    try:
        for _ in times:
            for _ in range(readings_between):
                stepper.advance(each)
                reading = stepper.read()
                x, y, z = reading.axis
                tilts.append(math.atan2(math.hypot(x, y), z))
                a, b = tilts[-2:]
                if math.isnan(over) and a < math.pi / 2 <= b:
                    at = len(tilts) - 2 + (math.pi / 2 - a) / (b - a)
                    over = at * interval
            readings.append(reading)
    finally:
        stepper.close()
    took = time.process_time() - started
    vectors = [np.array([getattr(one, name) for one in readings]) for name in EngineState._fields]
    numbers = numbers_of(problem, *vectors)
    exact = {name: values[: len(times)] for name, values in reference.numbers.items()}
    apart = np.abs(numbers["tilt"] - exact["tilt"])
    judged = readings[case.judged - 1]
    state = judged_state(case, judged.axis, judged.omega)
    past = np.flatnonzero(~(apart <= HOLDS))
    holds = times[-1] if not len(past) else times[past[0] - 1] if past[0] else 0.0
    energies = np.concatenate([[reference.energy], numbers["energy"]])
    late = reference.turnover_time > times[-1]
    row = {
        "case": case.name,
        "setting": task.setting.name,
        "step": length,
        "asked_step": step,
        "error": float(np.abs(state - reference_state(case)).max()),
        "state": [round(float(x), 9) for x in state],
        "tilt_error": float(apart.max()),
        "holds_until": float(holds),
        "turnover_time": over,
        "turnover_time_exactly": math.nan if late else reference.turnover_time,
        "energy_error": float((energies[-1] - exact["energy"][-1]) / reference.energy),
        "energy_gain": float(np.diff(energies).max() / reference.energy),
        "jellett_error": float(numbers["jellett"][-1] - exact["jellett"][-1]) / reference.jellett,
        "seconds": took,
        "microseconds_per_step": 1e6 * took / (len(times) * readings_between * each),
    }
    if drawn:
        chosen = np.linspace(0, len(tilts) - 1, DRAWN + 1).round().astype(int)
        row["tilt"] = [round(tilts[k], 4) for k in chosen]
    return {name: _plain(value) for name, value in row.items()}


def _plain(value: Any) -> Any:
    return None if isinstance(value, float) and not math.isfinite(value) else value


# Results in files


def result_path(folder: Path, name: str) -> Path:
    """Return the file of a program's results."""
    return folder / f"{name}.json"


def load(folder: Path, name: str) -> dict[str, Any] | None:
    """Return a program's results in a folder; None without them."""
    path = result_path(folder, name)
    if not path.exists():
        return None
    try:
        results: dict[str, Any] = json.loads(read_text(path, "results of engines"))
    except ValueError:
        raise InvalidInput("out", str(path), "a file of results", "cannot be read") from None
    return results


def stored(names: Sequence[str] | None = None) -> dict[str, dict[str, Any]]:
    """Return the results that come with this package, by program."""
    folder = files(__package__) / RESULTS_FOLDER
    results = {}
    for name in map(results_name, names or ADAPTERS):
        path = folder / f"{name}.json"
        if path.is_file():
            results[name] = json.loads(path.read_text(encoding="utf-8"))
    return results


def compare(
    folder: Path | str,
    names: Sequence[str] | None = None,
    cases: Sequence[str] | None = None,
    steps: Sequence[float] = STEPS,
    longest: float = LONGEST,
    progress: Progress = lambda *_: None,
) -> dict[str, dict[str, Any]]:
    """Run the cases in the programs that are installed, and return and write their results.

    Each run is written when it is done; what a folder has of the same versions is not run again. A
    run that fails has a `failure` in its row, and one that would take longer than `longest`
    seconds is listed in `left_out`. A name may be that of a Python file with an adapter.

    Raises
    ------
    InvalidInput
        If there is no such program, case or step.
    FileTrouble
        If results cannot be read or written.
    """
    check_steps(steps)
    folder = Path(folder)
    chosen = list(tasks(installed(names) if names else installed(), cases))
    make_folder("out", folder)
    steps = sorted(steps, reverse=True)
    references: dict[str, Exact] = {}
    results: dict[str, dict[str, Any]] = {}
    for k, task in enumerate(chosen):
        name = task.results
        progress(k, len(chosen), f"{task.adapter.name}, {task.case.name}")
        result = results.get(name) or _opened(folder, name, task.adapter)
        results[name] = result
        _forget_left_out(result, task, steps)
        missing = [step for step in steps if not _has(result, task, step)]
        if missing and task.case.name not in references:
            references[task.case.name] = exact(task.case)
        for step in missing:
            before = result["rows"][-1] if step != steps[0] else None
            predicted = _predicted(before, task, step) if before else 0.0
            if predicted > longest:
                reason = f"would take {predicted:.0f} s, more than {longest:g} s"
                result["left_out"].append({**_run_of(task, step), "reason": reason})
                continue
            result["rows"].append(_tried(task, step, references[task.case.name], step == steps[-1]))
            result["date"] = datetime.datetime.now(datetime.UTC).date().isoformat()
            _save(folder, name, result)
        if missing or not _limit_in(result, task):
            _add_limit(result, task)
            _save(folder, name, result)
    progress(len(chosen), len(chosen), "")
    return results


def _limit_in(result: Mapping[str, Any], task: EngineTask) -> dict[str, Any] | None:
    """Return what results have of the limit of a task; None without it."""
    key = (task.case.name, task.setting.name)
    return next((one for one in result["limits"] if (one["case"], one["setting"]) == key), None)


def _add_limit(result: dict[str, Any], task: EngineTask) -> None:
    """Put the limit of a task's rows into results, in place of an earlier one."""
    case, setting = task.case.name, task.setting.name
    rows = [row for row in result["rows"] if (row["case"], row["setting"]) == (case, setting)]
    limit = limit_of(task.case, rows, task.setting.width)._replace(case=case, setting=setting)
    others = [one for one in result["limits"] if one != _limit_in(result, task)]
    record = {name: _plain(value) for name, value in limit._asdict().items()}
    result["limits"] = [*others, record]


def _tried(task: EngineTask, step: float, reference: Exact, drawn: bool) -> dict[str, Any]:
    """Return the row of a run, or of what went wrong in it."""
    try:
        return measure(task, step, reference, drawn)
    except Exception as error:  # noqa: BLE001 - a program, or an adapter, may raise anything
        # The first sentence says what went wrong; others may number objects of the process.
        message = " ".join(str(error).split()).split(". ")[0][:200]
        if not isinstance(error, (ArithmeticError, AssertionError, RuntimeError, ValueError)):
            message = f"{type(error).__name__}: {message}"
        return {**_run_of(task, step), "failure": message or type(error).__name__}


def _run_of(task: EngineTask, step: float) -> dict[str, Any]:
    """Return what names a run in results."""
    return {"case": task.case.name, "setting": task.setting.name, "asked_step": step}


def check_steps(steps: Iterable[float]) -> None:
    """Raise `InvalidInput` unless programs can be measured with steps of all these lengths, s."""
    for step in steps:
        if not SHORTEST <= step <= READINGS:
            raise InvalidInput("step", step, f"a time from {SHORTEST:g} to {READINGS:g} s")


def _forget_left_out(result: dict[str, Any], task: EngineTask, steps: Sequence[float]) -> None:
    """Remove from results that runs of a task at these steps were left out."""
    again = [_run_of(task, step) for step in steps]
    earlier = result.get("left_out", [])
    result["left_out"] = [
        one for one in earlier if {name: one[name] for name in _run_of(task, 0.0)} not in again
    ]


def _predicted(before: Mapping[str, Any], task: EngineTask, step: float) -> float:
    """Return how long a run will take by the one before it, s."""
    same = (before["case"], before["setting"]) == (task.case.name, task.setting.name)
    if not same or "seconds" not in before:
        return 0.0
    return float(before["seconds"] * before["asked_step"] / step)


def _opened(folder: Path, name: str, made: Adapter) -> dict[str, Any]:
    """Return the results of a folder if they are of the same versions and options, or empty ones.

    Results of settings whose options or width are no longer the same are left out.
    """
    head = {"engine": made.name, "version": version_of(made), "suite": SUITE_VERSION}
    about = {
        "settings": [setting._asdict() for setting in made.settings],
        "refused": refusals(made, CASES),
    }
    results = load(folder, name)
    if results is None or any(results.get(key) != value for key, value in head.items()):
        return {**head, **about, "limits": [], "left_out": [], "rows": []}
    earlier = {one["name"]: (one["options"], one.get("width")) for one in results["settings"]}
    unchanged = [
        one.name for one in made.settings if earlier.get(one.name) == (one.options, one.width)
    ]
    for part in ("limits", "rows"):
        results[part] = [one for one in results[part] if one["setting"] in unchanged]
    return {**results, **about}


def _has(result: Mapping[str, Any], task: EngineTask, step: float) -> bool:
    key = (task.case.name, task.setting.name, step)
    return any((row["case"], row["setting"], row["asked_step"]) == key for row in result["rows"])


def _save(folder: Path, name: str, result: Mapping[str, Any]) -> None:
    """Write results, a run a line."""
    head = json.dumps({key: value for key, value in result.items() if key != "rows"}, indent=1)
    rows = ",\n".join(json.dumps(row) for row in result["rows"])
    with written_beside(result_path(folder, name), True) as beside:
        beside.write_text(f'{head[:-2]},\n "rows": [\n{rows}\n]}}\n', encoding="utf-8")


# What results say


def dropped(results: Mapping[str, Mapping[str, Any]]) -> list[str]:
    """Return a sentence for each run that failed or was left out."""
    sentences = []
    for result in results.values():
        for row in [*result["rows"], *result.get("left_out", ())]:
            why = f"failed: {row['failure'].rstrip('.')}" if "failure" in row else row.get("reason")
            if why:
                step = f"{1e3 * row['asked_step']:g} ms"
                sentences.append(
                    f"{result['engine']}, {row['case']}, {row['setting']} at {step} {why}"
                )
    return sentences


class EngineVerdict(NamedTuple):
    """What a program makes of a case at its best setting."""

    engine: str
    case: str
    setting: str
    step: float
    error: float
    order: float
    """Observed order of the error, of the last two steps; nan where it cannot be said."""
    holds_until: float
    turnover_time: float
    turnover_time_exactly: float
    energy_error: float
    jellett_error: float
    microseconds_per_step: float
    step_for_1_percent: float
    """Largest step from which on the error is below 0.01; nan if none is."""
    step_for_0_1_percent: float
    limit: Limit


def verdicts(results: Mapping[str, Mapping[str, Any]]) -> list[EngineVerdict]:
    """Return what each program makes of each case, at the first setting with the least error."""
    verdicts = []
    for result in results.values():
        rows = [row for row in result["rows"] if "failure" not in row]
        for case in dict.fromkeys(row["case"] for row in rows):
            finest = _finest(row for row in result["rows"] if row["case"] == case)
            best = min(finest, key=_rounded_error)
            key = (case, best["setting"])
            same = [row for row in rows if (row["case"], row["setting"]) == key]
            limits = [one for one in result["limits"] if (one["case"], one["setting"]) == key]
            limit = _limit(limits[0]) if limits else Limit(*key, "none", *4 * (math.nan,))
            same.sort(key=lambda row: -row["step"])
            verdicts.append(_verdict(result["engine"], same, limit))
    return verdicts


def _limit(record: Mapping[str, Any]) -> Limit:
    """Return a limit from its record in a file."""
    values: dict[str, Any] = {
        name: math.nan if value is None else value for name, value in record.items()
    }
    return Limit(**values)


def errors_at(
    results: Mapping[str, Mapping[str, Any]], step: float
) -> dict[tuple[str, str], float]:
    """Return the errors at one step, by case and program, each at its best setting there."""
    errors: dict[tuple[str, str], float] = {}
    for result in results.values():
        for row in result["rows"]:
            if row["asked_step"] == step and "failure" not in row:
                key = (row["case"], result["engine"])
                error = _number(row["error"], math.inf)
                errors[key] = min(error, errors.get(key, math.inf))
    return errors


def _finest(rows: Iterable[Mapping[str, Any]]) -> list[Mapping[str, Any]]:
    """Return of each setting the row with the shortest step.

    Settings that fail at their shortest step are left out, unless all do: of those the row is the
    last before they fail.
    """
    by_step = sorted(rows, key=lambda row: -row["asked_step"])
    attempted = {row["setting"]: row for row in by_step}
    finished = {row["setting"]: row for row in by_step if "failure" not in row}
    reliable = [row for row in attempted.values() if "failure" not in row]
    return reliable or list(finished.values())


def _rounded_error(row: Mapping[str, Any]) -> float:
    """Return the error to two digits: settings that agree in them are equally good."""
    return float(f"{_number(row['error'], math.inf):.2g}")


def _verdict(engine: str, rows: Sequence[Mapping[str, Any]], limit: Limit) -> EngineVerdict:
    best = rows[-1]
    errors = [_number(row["error"]) for row in rows]
    return EngineVerdict(
        engine,
        best["case"],
        best["setting"],
        best["step"],
        errors[-1],
        order_of([row["step"] for row in rows], errors),
        best["holds_until"],
        _number(best["turnover_time"]),
        _number(best["turnover_time_exactly"]),
        _number(best["energy_error"]),
        _number(best["jellett_error"]),
        best["microseconds_per_step"],
        _largest_step(rows, errors, 1e-2),
        _largest_step(rows, errors, 1e-3),
        limit,
    )


def order_of(steps: Sequence[float], errors: Sequence[float]) -> float:
    """Return the slope of the logarithms of errors over those of the last three steps."""
    pairs = [(h, e) for h, e in zip(steps, errors, strict=True) if e > 0.0][-3:]
    if len(pairs) < 2:
        return math.nan
    h, e = np.log(np.array(pairs)).T
    return float(np.polyfit(h, e, 1)[0])


def _largest_step(
    rows: Sequence[Mapping[str, Any]], errors: Sequence[float], bound: float
) -> float:
    """Return the largest step from which on all errors are below a bound."""
    step = math.nan
    for row, error in zip(reversed(rows), reversed(errors), strict=True):
        if not error < bound:
            break
        step = row["step"]
    return step


def _number(value: float | None, missing: float = math.nan) -> float:
    return missing if value is None else float(value)
