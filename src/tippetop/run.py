"""Simulation of a problem: `simulate` follows a launch from mode to mode and labels the result."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Literal, overload

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from tippetop import __version__
from tippetop.contact.mode import Event, Segment, Status, ambiguity_of
from tippetop.contact.natural_launch import NaturalLaunch
from tippetop.contact.trajectory import MODE_LIMIT, STEP_LIMIT, Trajectory, require_limits
from tippetop.graph.own_parts import require_recordable
from tippetop.integrators import Integrator, make_integrator
from tippetop.mechanics.invariants import energy
from tippetop.mechanics.natural_units import Units
from tippetop.mechanics.state import State
from tippetop.problem.implausible import warn_if_implausible
from tippetop.problem.problem import (
    Problem,
    force_missing_at_rest,
    require_problem,
    top_of,
)
from tippetop.results.catalogue import Outcome
from tippetop.results.checked_times import sample_times
from tippetop.results.dataset import assemble
from tippetop.results.derived import variables_of
from tippetop.results.event_functions import EventSearch, FunctionEvent, Value
from tippetop.results.metrics import metrics, outcomes_of
from tippetop.results.observables import Recorder
from tippetop.results.run_metrics import RunMetrics
from tippetop.results.run_solution import RunSolution
from tippetop.results.sample_counts import DEFAULT_SAMPLES
from tippetop.results.samples import event_in_si
from tippetop.results.stiffness import stiffness_sentence
from tippetop.support.errors import InvalidInput, require
from tippetop.support.units import number_in
from tippetop.support.validation import require_callback

WITHOUT_A_STEP = (Status.FAILED, Status.TOO_MANY_STEPS)
"""Endings of runs whose law of friction may have no force where slip ends."""


@overload
def simulate(
    problem: Problem,
    duration: float,
    *,
    samples: int = DEFAULT_SAMPLES,
    times: ArrayLike | None = None,
    events: Mapping[str, Value] | None = None,
    until: str | Value | None = None,
    dense: Literal[False] = False,
    integrator: str | Integrator | None = None,
    tolerance: float | None = None,
    step: float | None = None,
    mode_limit: int = MODE_LIMIT,
    step_limit: int = STEP_LIMIT,
    callback: Callable[[float], None] | None = None,
) -> xr.Dataset: ...


@overload
def simulate(
    problem: Problem,
    duration: float,
    *,
    samples: int = DEFAULT_SAMPLES,
    times: ArrayLike | None = None,
    events: Mapping[str, Value] | None = None,
    until: str | Value | None = None,
    dense: Literal[True],
    integrator: str | Integrator | None = None,
    tolerance: float | None = None,
    step: float | None = None,
    mode_limit: int = MODE_LIMIT,
    step_limit: int = STEP_LIMIT,
    callback: Callable[[float], None] | None = None,
) -> tuple[xr.Dataset, RunSolution]: ...


@np.errstate(all="ignore")  # numbers that overflow end the run with a status of their own
def simulate(
    problem: Problem,
    duration: float,
    *,
    samples: int = DEFAULT_SAMPLES,
    times: ArrayLike | None = None,
    events: Mapping[str, Value] | None = None,
    until: str | Value | None = None,
    dense: bool = False,
    integrator: str | Integrator | None = None,
    tolerance: float | None = None,
    step: float | None = None,
    mode_limit: int = MODE_LIMIT,
    step_limit: int = STEP_LIMIT,
    callback: Callable[[float], None] | None = None,
) -> xr.Dataset | tuple[xr.Dataset, RunSolution]:
    """Simulate a problem and return its run; warn with `Implausible` of numbers that no top has.

    Parameters
    ----------
    problem
        The problem.
    duration
        Length of the run, s; or a text such as "1 min", or a quantity of pint.
    samples
        Number of equally spaced samples from launch to end.
    times
        Sample times instead, s, or texts such as "50 ms", or quantities of pint: increasing, from
        0 to `duration`.
    events
        Functions of the state (see `tippetop.extend.MotionState`) by the names of their events:
        each change of sign of a function is an event, located to rounding on the dense solution and
        reported with the others. A function may have a `direction`, and be `terminal`: see
        `tippetop.extend.EventFunction`.
    until
        Event that ends the run early, with the status "stopped": the name of a function in
        `events`, a kind of event such as "liftoff" or "stick", or a function whose first change
        of sign ends the run. If an impact ends it, the last sample is just before the impact, and
        the numbers of the end are those just after.
    dense
        Whether to return the dense solution too, which has the state at any time.
    integrator
        "taylor", "collocation", "dop853", "rk45", "radau", "bdf", "lsoda" or "rk4"; None for
        "taylor", replaced by "collocation" where friction is stiff; or an object with the methods
        of `tippetop.extend.Integrator`.
    tolerance
        Relative error per step; None for the integrator's default. Only for an integrator by name.
    step
        Step size, s, or a text such as "1 ms", or a quantity of pint; only for "rk4".
    mode_limit
        Number of contact modes, such as sliding and flight, after which the run ends early.
    step_limit
        Number of steps of the integrator after which the run ends early; it is checked after every
        mode, and within a mode every 4096 steps at the latest.
    callback
        Function that is called from time to time with the completed fraction of the run.

    Returns
    -------
    xarray.Dataset
        The variables of `tippetop.results.catalogue` with their SI units. Over `time`: those of
        `SAMPLED` and `DERIVED`, and the contact mode. Over `event` and `flight`: those of `LISTED`.
        Single numbers: those of `METRICS`, which are events and extremes of the motion and do not
        depend on the samples, and of `MONITORS`. Attributes: problem (JSON), status,
        message, integrator (every one that took steps), tolerance (the largest) or step,
        tippetop_version, Conventions. If the run ends before `duration`, the last sample is at its
        end, unless its numbers overflowed.
    RunSolution
        Only with ``dense=True``: the state, and all variables, at any time.

    Raises
    ------
    InvalidInput
        If an argument is not accepted, or a function of `events` returns no finite number.

    Examples
    --------
    >>> import tippetop as tt
    >>> run = tt.simulate(tt.presets.report_problem(spin=155.0), duration=20.0)
    >>> round(float(run["turnover_time"]), 2), round(float(run["tilt"][-1]), 2)  # s, rad
    (5.88, 3.14)
    >>> bool(run["energy_error"] < 1e-12)
    True
    >>> run = tt.simulate(tt.presets.report_problem(), 20.0, until=lambda s: s.axis[2] - 0.5)
    >>> run.attrs["status"], round(float(run["tilt"][-1]), 6)  # at 60 degrees
    ('stopped', 1.047198)
    """
    require_problem(problem)
    require_callback("callback", callback)
    require("dense", dense, bool, "True or False")
    require_recordable(top_of(problem))
    start = NaturalLaunch.of(problem)
    units = start.units
    duration = number_in("duration", duration, "s")
    require_limits(duration, units.time, mode_limit, step_limit)
    duration = float(duration)
    grid = sample_times(duration, samples, times)
    step = number_in("step", step, "s")
    search = EventSearch(events, until, units)
    method = integrator_of(integrator, tolerance, step, units)
    warn_if_implausible(problem)
    end = duration / units.time
    trajectory = Trajectory(start.automaton, start.first, end, method, mode_limit, step_limit)
    recorder = Recorder.of(start, grid / units.time)
    run_metrics = RunMetrics(start.top, start.state)
    segments = list[Segment]()
    last: Sequence[Segment] = ()
    for block in search.blocks_of(trajectory):
        last = block.segments
        recorder.take(block)
        run_metrics.take(block)
        if dense:
            segments += block.segments
        if callback is not None:
            callback(trajectory.time / trajectory.end)
    status = recorder.status_of(trajectory)
    breach = recorder.breach_of(trajectory) if status is Status.INACCURATE else ""
    attributes = {
        "title": "Motion of a spinning top on a table",
        "problem": problem.to_json(),
        "status": status.name.lower(),
        "message": " ".join(
            filter(
                None,
                (
                    status.value,
                    trajectory.detail and f"Reason: {trajectory.detail.removesuffix('.')}.",
                    stiffness_sentence(last, units) if status is Status.TOO_MANY_STEPS else "",
                    breach,
                    force_missing_at_rest(problem) if status in WITHOUT_A_STEP else "",
                    ambiguity_of(trajectory.events),
                    method.caution,
                ),
            )
        ),
        **_method_attributes(
            [one or method for one in run_metrics.methods.values()], method, units
        ),
        "tippetop_version": __version__,
    }
    readers = recorder, run_metrics
    run = read_off(start, readers, trajectory, status, grid, duration, search.events, attributes)
    return (run, RunSolution(start, segments, run)) if dense else run


def read_off(
    start: NaturalLaunch,
    readers: tuple[Recorder, RunMetrics],
    trajectory: Trajectory,
    status: Status,
    grid: NDArray[np.float64],
    duration: float,
    function_events: Sequence[FunctionEvent] = (),
    attributes: Mapping[str, Any] | None = None,
) -> xr.Dataset:
    """Return the dataset of a trajectory that has ended, from the readers that took its blocks.

    Parameters
    ----------
    start
        The launch, with the top and the units of the trajectory.
    readers
        The recorder and the metrics that took the trajectory's blocks.
    trajectory
        The trajectory.
    status
        The status of the run.
    grid, duration
        The requested sample times, shape (k,), and length of the run, s.
    function_events
        Events of users' functions.
    attributes
        Attributes of the dataset.
    """
    recorder, run_metrics = readers
    top, units, state = start.top, start.units, start.state
    is_finite = bool(np.all(np.isfinite(trajectory.state.pack())))
    early = status is not Status.COMPLETED and is_finite
    sampled = recorder.finish(trajectory.time, trajectory.state, early)
    ends = run_metrics.ends(
        trajectory.state, trajectory.time, status, trajectory.events, recorder.sums
    )
    max_tilt, max_tilt_time = run_metrics.peak
    begin = State.unpack([np.float64(number) for number in state.pack()])
    end_time = duration if trajectory.time == trajectory.end else trajectory.time * units.time
    scalars = metrics(ends, begin, top, units) | {
        "outcome": Outcome(int(outcomes_of(ends, begin))).name.lower(),
        "end_time": end_time,
        "initial_energy": float(energy(state, top)) * units.energy,
        "energy_lost_impacts": ends.struck * units.energy,
        "max_tilt": max_tilt,
        "max_tilt_time": max_tilt_time * units.time,
        "settling_time": run_metrics.settling_time * units.time,
        "evaluations": run_metrics.evaluations,
        "energy_error": recorder.monitor.energy_error,
        "jellett_drift": recorder.monitor.jellett_drift,
    }
    lists = _event_arrays(trajectory.events, function_events, units)
    lists |= _flight_arrays(run_metrics.flights.rows, units)
    times = np.append(grid, end_time)[: len(sampled.times)]
    if early:
        times[-1] = end_time
    variables, modes = variables_of(start, sampled), (sampled.mode, recorder.modes)
    return assemble(times, variables, modes, scalars, lists, attributes or {})


def integrator_of(
    integrator: str | Integrator | None,
    tolerance: float | None,
    step: float | None,
    units: Units,
) -> Integrator:
    """Return the requested integrator, with its step in natural units, or the default one."""
    if integrator is None or isinstance(integrator, str):
        return make_integrator(integrator, tolerance, step, units.time)
    for setting, value in {"tolerance": tolerance, "step": step}.items():
        if value is not None:
            raise InvalidInput(
                setting,
                value,
                "none",
                "is given with an integrator object, which has its own",
                "omit it",
            )
    method, *texts = (getattr(integrator, name, None) for name in ("integrate", "name", "caution"))
    has_texts = all(isinstance(text, str) for text in texts)
    if isinstance(integrator, type) or not (callable(method) and has_texts):
        accepted = "a name, or an object with a method integrate and the texts name and caution"
        raise InvalidInput("integrator", integrator, accepted)
    return integrator


def _event_arrays(
    events: Sequence[Event], of_functions: Sequence[FunctionEvent], units: Units
) -> dict[str, NDArray[Any]]:
    """Return the variables over the events in SI, those of users' functions included, by time."""
    in_si = [event_in_si(event, units) for event in events]
    rows = [(one.time, one.kind.value, one.impulse, one.energy_lost, one.surface) for one in in_si]
    rows += [(time * units.time, name, 0.0, 0.0, 0) for time, name in of_functions]
    rows.sort(key=lambda row: row[0])
    columns = list(zip(*rows, strict=True)) or [()] * 5
    names = ("time", "kind", "impulse", "energy_lost", "surface")
    kinds = (float, str, float, float, np.int8)
    return {
        f"event_{name}": np.array(column, dtype=kind)
        for name, column, kind in zip(names, columns, kinds, strict=True)
    }


def _flight_arrays(
    flights: Sequence[tuple[float, float, float]], units: Units
) -> dict[str, NDArray[Any]]:
    """Return the variables over the flights in SI."""
    starts, ends, gaps = np.array(flights).reshape(-1, 3).T
    return {
        "flight_start": starts * units.time,
        "flight_end": ends * units.time,
        "flight_max_gap": gaps * units.length,
    }


def _method_attributes(
    methods: Sequence[Integrator], asked: Integrator, units: Units
) -> dict[str, str | float]:
    """Return the names of the methods that took steps, and their step or largest tolerance.

    A run that needed no steps names the method that was asked for.
    """
    methods = methods or [asked]
    settings: dict[str, str | float] = {"integrator": ", ".join(method.name for method in methods)}
    steps = [float(method.step) for method in methods if hasattr(method, "step")]
    if steps:
        settings["step"] = max(steps) * units.time
    tolerances = [float(method.tolerance) for method in methods if hasattr(method, "tolerance")]
    if tolerances:
        settings["tolerance"] = max(tolerances)
    return settings
