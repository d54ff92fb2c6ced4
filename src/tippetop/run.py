"""Run a problem: follow its launch from mode to mode, and label what came of it."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Literal, overload

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from tippetop import __version__
from tippetop.contact.choice import automaton_of
from tippetop.contact.mode import Event, Outcome, Segment, ambiguity_of
from tippetop.contact.trajectory import PHASE_LIMIT, STEP_LIMIT, Trajectory, require_limits
from tippetop.graph.own_parts import require_recordable
from tippetop.integrators import Integrator, make_integrator
from tippetop.integrators.base import NOT_FINITE
from tippetop.mechanics.invariants import energy
from tippetop.mechanics.state import State
from tippetop.mechanics.top import natural, natural_state, natural_units
from tippetop.mechanics.units import Units
from tippetop.problem.implausible import warn_if_implausible
from tippetop.problem.problem import Problem, require_problem
from tippetop.results.dataset import assemble
from tippetop.results.event_functions import EventSearch, OwnEvent, Value
from tippetop.results.metrics import metrics
from tippetop.results.observables import Recorder
from tippetop.results.run_metrics import Tally
from tippetop.results.run_solution import Begin, RunSolution
from tippetop.results.sample_times import sample_times
from tippetop.results.samples import event_in_si
from tippetop.support.errors import InvalidInput, require
from tippetop.support.units import number_in
from tippetop.support.validation import require_callback


@overload
def simulate(
    problem: Problem,
    duration: float,
    *,
    samples: int = 2001,
    times: ArrayLike | None = None,
    events: Mapping[str, Value] | None = None,
    until: str | Value | None = None,
    dense: Literal[False] = False,
    integrator: str | Integrator | None = None,
    tolerance: float | None = None,
    step: float | None = None,
    phase_limit: int = PHASE_LIMIT,
    step_limit: int = STEP_LIMIT,
    callback: Callable[[float], None] | None = None,
) -> xr.Dataset: ...


@overload
def simulate(
    problem: Problem,
    duration: float,
    *,
    samples: int = 2001,
    times: ArrayLike | None = None,
    events: Mapping[str, Value] | None = None,
    until: str | Value | None = None,
    dense: Literal[True],
    integrator: str | Integrator | None = None,
    tolerance: float | None = None,
    step: float | None = None,
    phase_limit: int = PHASE_LIMIT,
    step_limit: int = STEP_LIMIT,
    callback: Callable[[float], None] | None = None,
) -> tuple[xr.Dataset, RunSolution]: ...


@np.errstate(all="ignore")  # What grows beyond all numbers is the outcome's matter.
def simulate(
    problem: Problem,
    duration: float,
    *,
    samples: int = 2001,
    times: ArrayLike | None = None,
    events: Mapping[str, Value] | None = None,
    until: str | Value | None = None,
    dense: bool = False,
    integrator: str | Integrator | None = None,
    tolerance: float | None = None,
    step: float | None = None,
    phase_limit: int = PHASE_LIMIT,
    step_limit: int = STEP_LIMIT,
    callback: Callable[[float], None] | None = None,
) -> xr.Dataset | tuple[xr.Dataset, RunSolution]:
    """Simulate a problem; warn with `Implausible` of numbers that no top has.

    Parameters
    ----------
    problem
        The physics.
    duration
        Length of the run, s; or a text such as "1 min", or a quantity of pint.
    samples
        Number of equally spaced samples from launch to end.
    times
        Sample times instead, s: increasing, from 0 to `duration`.
    events
        Functions of the state (see `tippetop.extend.MotionState`) by the names of their events: a
        function that changes sign is an event, located to rounding on the dense solution and told
        among the others. A function may have a `direction`, and be `terminal`: see
        `tippetop.extend.EventFunction`.
    until
        What ends the run early, with the outcome "stopped": the name of an event, of `events` or of
        the run's own kinds such as "lift-off" or "stick", or a function whose first change of sign
        does. Where an impact ends it, the last sample is just before that, and the numbers of the
        end are just after.
    dense
        Whether to return the solution, which has the state at any time, beside the run.
    integrator
        "taylor", "collocation", "dop853", "rk45", "radau", "bdf", "lsoda" or "rk4"; None for
        "taylor", which "collocation" relieves where friction is stiff; or an object of one's own,
        which follows motions as `tippetop.integrators.base.Integrator` does.
    tolerance
        Relative error per step; None for the integrator's own default. Only with an integrator by
        name.
    step
        Step size of "rk4", s; for no other.
    phase_limit
        How many modes (slides and flights) the run may go through before it ends early.
    step_limit
        How many steps of the integrator it may take before it ends early: they are counted piece by
        piece, of up to 4096 steps.
    callback
        Told now and then which part of the run is done, between 0 and 1.

    Returns
    -------
    xarray.Dataset
        The variables of `tippetop.results.catalogue` with their SI units. Over `time`: those of
        `SAMPLED` and `DERIVED`, and the contact mode. Over `event` and `flight`: those of `LISTED`.
        Single numbers: those of `METRICS`, which are events and extremes of the motion and do not
        depend on the samples, and of `MONITORS`. Attributes: problem (JSON), outcome,
        outcome_advice, integrator (every one that took steps), tolerance (the largest) or step,
        tippetop_version, Conventions. When the run ends before `duration`, the last sample is its
        end, unless its numbers grew beyond all bounds.
    RunSolution
        With ``dense=True``, beside the dataset: the state, and all variables, at any time.

    Raises
    ------
    InvalidInput
        If the problem is none, or the duration, samples, events, integrator, tolerance, step, a
        limit or the callback cannot be, or a function of `events` gives no number.
    Unavailable
        If the integrator is not installed.

    Examples
    --------
    >>> import tippetop as tt
    >>> run = tt.simulate(tt.presets.report_problem(spin=155.0), duration=20.0)
    >>> round(float(run["turns_over"]), 2), round(float(run["theta"][-1]), 2)  # s, rad
    (5.88, 3.14)
    >>> bool(run["energy_error"] < 1e-12)
    True
    >>> run = tt.simulate(tt.presets.report_problem(), 20.0, until=lambda s: s.axis[2] - 0.5)
    >>> run.attrs["outcome"], round(float(run["theta"][-1]), 6)  # at 60 degrees
    ('stopped', 1.047198)
    """
    require_problem(problem)
    require_callback("callback", callback)
    require("dense", dense, bool, "True or False")
    units = natural_units(problem.top)
    duration = number_in("duration", duration, "s")
    require_limits(duration, units.time, phase_limit, step_limit)
    duration = float(duration)
    grid = sample_times(duration, samples, times)
    top = natural(problem.top)
    search = EventSearch(events, until, units)
    require_recordable(problem.top)
    method = integrator_of(integrator, tolerance, step, units)
    warn_if_implausible(problem)
    state = natural_state(problem.start(), units)
    automaton = automaton_of(problem.contact, top, units)
    launch = automaton.launch(state)
    trajectory = Trajectory(
        automaton, launch, duration / units.time, method, phase_limit, step_limit
    )
    start = Begin(top, units, state, problem.launch.azimuth, launch.energy_lost)
    recorder, tally = start.recorder(grid / units.time), Tally(top, state)
    segments = list[Segment]()
    for block in search.blocks_of(trajectory):
        recorder.take(block)
        tally.take(block)
        if dense:
            segments += block.segments
        if callback is not None:
            callback(trajectory.time / trajectory.end)
    outcome = recorder.outcome_of(trajectory)
    attributes = {
        "title": "Motion of a spinning top on a table",
        "problem": problem.to_json(),
        "outcome": outcome.name.lower(),
        "outcome_advice": " ".join(
            filter(
                None,
                (
                    outcome.value,
                    trajectory.detail,
                    ambiguity_of(trajectory.events),
                    method.caution,
                ),
            )
        ),
        **_method_attributes([method, *tally.methods.values()], units),
        "tippetop_version": __version__,
    }
    readers = recorder, tally
    run = read_off(start, readers, trajectory, outcome, grid, duration, search.events, attributes)
    return (run, RunSolution(start, segments, run)) if dense else run


def read_off(
    start: Begin,
    readers: tuple[Recorder, Tally],
    trajectory: Trajectory,
    outcome: Outcome,
    grid: NDArray[np.float64],
    duration: float,
    own_events: Sequence[OwnEvent] = (),
    attributes: Mapping[str, Any] | None = None,
) -> xr.Dataset:
    """Return the dataset of a trajectory that has ended, from the readers that took its blocks.

    Parameters
    ----------
    start
        The launch, with the top and the units of the trajectory.
    readers
        The recorder and the tally that took the trajectory's blocks.
    trajectory
        Where the trajectory ended, and its events.
    outcome
        How it ended.
    grid, duration
        The sample times, shape (k,), and the length that were asked for, s.
    own_events
        Events of the user's functions.
    attributes
        Attributes of the dataset.
    """
    recorder, tally = readers
    top, units, state = start.top, start.units, start.state
    early = outcome is not Outcome.COMPLETED and trajectory.detail != NOT_FINITE
    found = recorder.finish(trajectory.time, trajectory.state, early)
    ends = tally.ends(trajectory.state, trajectory.time, outcome, trajectory.events)
    peak_tilt, peak_time = tally.peak
    begin = State.unpack([np.float64(number) for number in state.pack()])
    end_time = duration if trajectory.time == trajectory.end else trajectory.time * units.time
    scalars = metrics(ends, begin, top, units) | {
        "end_time": end_time,
        "energy_start": float(energy(state, top)) * units.energy,
        "impact_energy_lost": ends.struck * units.energy,
        "peak_tilt": peak_tilt,
        "peak_time": peak_time * units.time,
        "settled_since": tally.settled_since * units.time,
        "evaluations": tally.evaluations,
        "energy_error": recorder.monitor.energy_error,
        "jellett_drift": recorder.monitor.jellett_drift,
    }
    lists = _event_arrays(trajectory.events, own_events, units)
    lists |= _flight_arrays(tally.flights.rows, units)
    times = np.append(grid, end_time)[: len(found.times)]
    if early:
        times[-1] = end_time
    variables, modes = start.variables(found), (found.mode, recorder.modes)
    return assemble(times, variables, modes, scalars, lists, attributes or {})


def integrator_of(
    integrator: str | Integrator | None,
    tolerance: float | None,
    step: float | None,
    units: Units,
) -> Integrator:
    """The integrator asked for, with its step in natural units, or the default."""
    if integrator is None or isinstance(integrator, str):
        return make_integrator(integrator, tolerance, step, units.time)
    for setting, value in {"tolerance": tolerance, "step": step}.items():
        if value is not None:
            raise InvalidInput(
                setting,
                value,
                "none",
                "stands beside an integrator object, which has its own",
                "leave it out",
            )
    method, *texts = (getattr(integrator, name, None) for name in ("integrate", "name", "caution"))
    told = all(isinstance(text, str) for text in texts)
    if isinstance(integrator, type) or not (callable(method) and told):
        accepted = "a name, or an object with a method integrate, and as texts a name and a caution"
        raise InvalidInput("integrator", integrator, accepted)
    return integrator


def _event_arrays(
    events: Sequence[Event], own: Sequence[OwnEvent], units: Units
) -> dict[str, NDArray[Any]]:
    """Return the values over the events in SI: those of the run and the user's own, in order."""
    told = [event_in_si(event, units) for event in events]
    rows = [(one.time, one.kind.value, one.impulse, one.energy_lost, one.surface) for one in told]
    rows += [(time * units.time, name, 0.0, 0.0, 0) for time, name in own]
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
    """Values over the flights, in SI."""
    starts, ends, gaps = np.array(flights).reshape(-1, 3).T
    return {
        "flight_start": starts * units.time,
        "flight_end": ends * units.time,
        "flight_highest_gap": gaps * units.length,
    }


def _method_attributes(methods: Sequence[Integrator], units: Units) -> dict[str, str | float]:
    """The methods that took the steps, and their one setting: of tolerances the largest."""
    settings: dict[str, str | float] = {"integrator": ", ".join(method.name for method in methods)}
    if hasattr(methods[0], "step"):
        settings["step"] = float(methods[0].step) * units.time
    tolerances = [float(method.tolerance) for method in methods if hasattr(method, "tolerance")]
    if tolerances:
        settings["tolerance"] = max(tolerances)
    return settings
