"""Run a problem: follow its launch from mode to mode, and label what came of it."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import psutil
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from tippetop import __version__
from tippetop.contact.block import in_blocks
from tippetop.contact.choice import rules_of
from tippetop.contact.mode import Event, Outcome
from tippetop.contact.trajectory import PHASE_LIMIT, STEP_LIMIT, Trajectory, require_limits
from tippetop.integrators import Integrator, make_integrator
from tippetop.integrators.base import NOT_FINITE, Array
from tippetop.mechanics.invariants import energy
from tippetop.mechanics.state import State
from tippetop.mechanics.top import natural, natural_state, natural_units
from tippetop.mechanics.units import Units
from tippetop.problem.implausible import warn_if_implausible
from tippetop.problem.problem import Problem, require_problem
from tippetop.results.dataset import assemble
from tippetop.results.derived import derive
from tippetop.results.metrics import metrics
from tippetop.results.observables import Recorder
from tippetop.results.run_metrics import Tally
from tippetop.results.samples import continuous, event_in_si, observe
from tippetop.support.errors import InvalidInput, is_whole
from tippetop.support.units import number_in
from tippetop.support.validation import require_callback

BYTES_PER_SAMPLE = 1600
"""Memory that a sample takes at most while a result is being made."""

SURELY_FIT = 10_000
"""Samples for which nobody needs to ask how much memory there is."""


@np.errstate(all="ignore")  # What grows beyond all numbers is the outcome's matter.
def simulate(
    problem: Problem,
    duration: float,
    *,
    samples: int = 2001,
    times: ArrayLike | None = None,
    integrator: str | Integrator | None = None,
    tolerance: float | None = None,
    step: float | None = None,
    phase_limit: int = PHASE_LIMIT,
    step_limit: int = STEP_LIMIT,
    callback: Callable[[float], None] | None = None,
) -> xr.Dataset:
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
    integrator
        "taylor", "collocation", "compiled", "dop853", "rk45", "radau", "bdf", "lsoda" or "rk4";
        None for the best installed, which collocation relieves where friction is stiff; or an
        object of one's own, which follows motions as `tippetop.integrators.base.Integrator` does.
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

    Raises
    ------
    InvalidInput
        If the problem is none, or the duration, samples, integrator, tolerance, step, a limit or
        the callback cannot be.
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
    """
    require_problem(problem)
    require_callback("callback", callback)
    units = natural_units(problem.top)
    duration = number_in("duration", duration, "s")
    require_limits(duration, units.time, phase_limit, step_limit)
    duration = float(duration)
    grid = sample_times(duration, samples, times)
    top = natural(problem.top)
    method = integrator_of(integrator, tolerance, step, units)
    warn_if_implausible(problem)
    state = natural_state(problem.start(), units)
    launch = rules_of(problem.contact, top, units).launch(state)
    trajectory = Trajectory(launch, duration / units.time, method, phase_limit, step_limit)
    recorder = Recorder(top, state, problem.launch.azimuth, grid / units.time, launch.energy_lost)
    tally = Tally()
    for block in in_blocks(trajectory.segments()):
        recorder.take(block)
        tally.take(block)
        if callback is not None:
            callback(trajectory.time / trajectory.end)
    outcome = recorder.outcome_of(trajectory)
    early = outcome is not Outcome.COMPLETED and trajectory.detail != NOT_FINITE
    found = recorder.finish(trajectory.time, trajectory.state, early)
    ends = tally.ends(trajectory.state, trajectory.time, outcome, trajectory.events)
    begin = State.unpack([np.float64(number) for number in state.pack()])
    end_time = duration if trajectory.time == trajectory.end else trajectory.time * units.time
    scalars = metrics(ends, begin, top, units) | {
        "end_time": end_time,
        "energy_start": float(energy(state, top)) * units.energy,
        "impact_energy_lost": ends.struck * units.energy,
        "evaluations": tally.evaluations,
        "energy_error": recorder.monitor.energy_error,
        "jellett_drift": recorder.monitor.jellett_drift,
    }
    attributes = {
        "title": "Motion of a spinning top on a table",
        "problem": problem.to_json(),
        "outcome": outcome.name.lower(),
        "outcome_advice": " ".join(
            filter(None, (outcome.value, trajectory.detail, method.caution))
        ),
        **_method_attributes([method, *tally.methods.values()], units),
        "tippetop_version": __version__,
    }
    lists = _event_arrays(trajectory.events, units) | _flight_arrays(tally.flights.rows, units)
    times = np.append(grid, end_time)[: len(found.times)]
    if early:
        times[-1] = end_time
    variables = observe(found, top, units)
    variables["orientation"] = continuous(variables["orientation"])
    variables |= derive(found, variables["orientation"], top, units)
    return assemble(times, variables, (found.mode, recorder.modes), scalars, lists, attributes)


def sample_times(duration: float, samples: int, times: ArrayLike | None) -> Array:
    """Sample times, s, checked; see `simulate`."""
    if times is None:
        if not is_whole(samples) or samples < 2:
            raise InvalidInput("samples", samples, "a whole number, at least 2")
        _check_memory(samples)
        return np.linspace(0.0, duration, int(samples))
    try:
        grid = np.array(times, dtype=float)
    except Exception:  # noqa: BLE001 - objects may raise anything on their way to numbers
        raise InvalidInput("times", times, "a list of increasing finite numbers") from None
    if (
        grid.ndim != 1
        or not len(grid)
        or not np.all(np.isfinite(grid))
        or np.any(np.diff(grid) <= 0)
    ):
        raise InvalidInput("times", times, "a list of increasing finite numbers")
    if grid[0] < 0 or grid[-1] > duration:
        raise InvalidInput("times", times, f"times from 0 to the duration, {duration:g} s")
    _check_memory(len(grid))
    return grid


def integrator_of(
    integrator: str | Integrator | None, tolerance: float | None, step: float | None, units: Units
) -> Integrator:
    """The integrator asked for, with its step in natural units."""
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


def _check_memory(samples: int) -> None:
    if samples <= SURELY_FIT:
        return
    free = psutil.virtual_memory().available
    if samples * BYTES_PER_SAMPLE > free:
        limit = free // BYTES_PER_SAMPLE
        raise InvalidInput(
            "samples", samples, f"at most {limit}", "is more than there is memory for"
        )


def _event_arrays(events: Sequence[Event], units: Units) -> dict[str, NDArray[Any]]:
    """Values over the events, in SI."""
    told = [event_in_si(event, units) for event in events]
    return {
        "event_time": np.array([event.time for event in told], dtype=float),
        "event_kind": np.array([event.kind.value for event in told], dtype=str),
        "event_impulse": np.array([event.impulse for event in told], dtype=float),
        "event_energy_lost": np.array([event.energy_lost for event in told], dtype=float),
        "event_surface": np.array([event.surface for event in told], dtype=np.int8),
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
