"""Run a problem: follow its phases, one after the other, and label what came of it."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import psutil
import xarray as xr
from numpy.typing import ArrayLike

from tippetop import __version__
from tippetop.dataset import Described, assemble
from tippetop.errors import InvalidInput, is_number
from tippetop.integrators import Integrator, make_integrator
from tippetop.integrators.base import Array
from tippetop.mechanics.state import State
from tippetop.mechanics.top import natural_units
from tippetop.mechanics.units import Units
from tippetop.observables import in_si, observe, si_factors
from tippetop.phases import Event, Outcome, PhaseKind, Stretch, Transition, first_phase
from tippetop.problem import Problem

PHASE_LIMIT = 100_000
"""How many phases a run goes through at most unless told otherwise."""

BYTES_PER_SAMPLE = 1600
"""Memory that a sample takes at most while a result is being made."""

SURELY_FIT = 10_000
"""Samples for which nobody needs to ask how much memory there is."""


@dataclass(frozen=True)
class Course:
    """The phases a run went through, in natural units.

    Attributes
    ----------
    start
        How the run began.
    stretches
        What each phase made of its time, in order.
    outcome, detail
        How the run ended, and more about it where there is more to say.
    """

    start: Transition
    stretches: tuple[Stretch, ...]
    outcome: Outcome
    detail: str = ""

    @property
    def events(self) -> list[Event]:
        """Everything that happened, in order."""
        transitions = [self.start, *(stretch.transition for stretch in self.stretches)]
        return [event for transition in transitions for event in transition.events]


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
) -> xr.Dataset:
    """Simulate a problem.

    Parameters
    ----------
    problem
        The physics.
    duration
        Length of the run, s.
    samples
        Number of equally spaced samples from launch to end.
    times
        Sample times instead, s: increasing, from 0 to `duration`.
    integrator
        "taylor", "dop853", "rk45", "radau", "bdf", "lsoda" or "rk4"; None for the best installed; or an
        object of one's own, which follows motions as `tippetop.integrators.base.Integrator` does.
    tolerance
        Relative error per step; None for the integrator's own default. Only with an integrator by name.
    step
        Step size of "rk4", s; for no other.
    phase_limit
        How many phases (slides and flights) the run may go through before it ends early.

    Returns
    -------
    xarray.Dataset
        Variables over `time` (SI units on each): theta, theta_dot, phi, phi_dot, omega3, slip_x, slip_y,
        normal_force, energy, work, jellett, height, gap, x, y, axis, velocity, angular_momentum, orientation,
        phase. Over `event`: event_time, event_kind, event_impulse, event_energy_lost. Over `flight`:
        flight_start, flight_end, flight_highest_gap. Attributes: problem (JSON), outcome, outcome_advice,
        integrator, tolerance or step, steps, evaluations, tippetop_version, Conventions. When the run ends
        before `duration`, the last sample is its end.

    Raises
    ------
    InvalidInput
        If the duration, samples, integrator, tolerance or step cannot be.
    Unavailable
        If the integrator is not installed.
    """
    grid = sample_times(duration, samples, times)
    top = problem.top
    units = natural_units(top)
    method = integrator_of(integrator, tolerance, step, units)
    state = to_natural(problem.start(), units)
    contact = problem.contact
    start = first_phase(top.kind, top.numbers, state, contact.liftoff, contact.restitution)
    course = follow_phases(start, duration / units.time, grid / units.time, method, phase_limit)
    return _label(problem, course, grid, units, _method_attributes(method, units))


def follow_phases(
    start: Transition, end: float, times: Array, integrator: Integrator, limit: int = PHASE_LIMIT
) -> Course:
    """Go from phase to phase until one says how the run ends; times in the units of the phases.

    Parameters
    ----------
    start
        The first phase and the state in which it begins.
    end
        When the run ends at the latest.
    times
        Increasing sample times, shape (k,).
    integrator
        The method for phases that need one.
    limit
        How many phases to go through at most.
    """
    stretches: list[Stretch] = []
    time, transition = 0.0, start
    while not isinstance(transition.then, Outcome):
        if time >= end:
            return Course(start, tuple(stretches), Outcome.COMPLETED)
        if len(stretches) == limit:
            return Course(start, tuple(stretches), Outcome.TOO_MANY_PHASES)
        stretch = transition.then.follow((time, transition.state), end, times, integrator)
        stretches.append(stretch)
        time, transition = stretch.end_time, stretch.transition
        times = times[len(stretch.times) :]
    return Course(start, tuple(stretches), transition.then, transition.detail)


def sample_times(duration: float, samples: int, times: ArrayLike | None) -> Array:
    """Sample times, s, checked; see `simulate`."""
    if not (is_number(duration) and duration > 0):
        raise InvalidInput("duration", duration, "a finite number of seconds greater than 0")
    if times is None:
        if isinstance(samples, bool) or not isinstance(samples, (int, np.integer)) or samples < 2:
            raise InvalidInput("samples", samples, "a whole number, at least 2")
        _check_memory(samples)
        return np.linspace(0.0, duration, int(samples))
    try:
        grid = np.array(times, dtype=float)
    except (TypeError, ValueError):
        raise InvalidInput("times", times, "a list of increasing finite numbers") from None
    if grid.ndim != 1 or not len(grid) or not np.all(np.isfinite(grid)) or np.any(np.diff(grid) <= 0):
        raise InvalidInput("times", times, "a list of increasing finite numbers")
    if grid[0] < 0 or grid[-1] > duration:
        raise InvalidInput("times", times, f"times from 0 to the duration, {duration:g} s")
    _check_memory(len(grid))
    return grid


def integrator_of(
    integrator: str | Integrator | None, tolerance: float | None, step: float | None, units: Units
) -> Integrator:
    """The integrator asked for, with its step in natural units."""
    if integrator is None or isinstance(integrator, str) or not hasattr(integrator, "integrate"):
        return make_integrator(integrator, tolerance, step, units.time)
    for setting, value in {"tolerance": tolerance, "step": step}.items():
        if value is not None:
            raise InvalidInput(setting, value, "none with an integrator object, which has its own")
    return integrator


def to_natural(state: State, units: Units) -> Array:
    """A whole state, shape (16,), in natural units from one in SI."""
    return np.array(state.pack()) / si_factors(units)


def _check_memory(samples: int) -> None:
    if samples <= SURELY_FIT:
        return
    free = psutil.virtual_memory().available
    if samples * BYTES_PER_SAMPLE > free:
        limit = free // BYTES_PER_SAMPLE
        raise InvalidInput("samples", samples, f"at most {limit}, for which there is memory")


def _label(
    problem: Problem, course: Course, grid: Array, units: Units, method: dict[str, str | float]
) -> xr.Dataset:
    """The dataset of a run."""
    stretches = course.stretches
    times = grid[: sum(len(stretch.times) for stretch in stretches)]
    pieces = [stretch.states for stretch in stretches]
    kinds = [np.full(len(stretch.times), stretch.kind, dtype=np.int8) for stretch in stretches]
    if course.outcome is not Outcome.COMPLETED:
        ended = stretches[-1].end_time * units.time if stretches else 0.0
        if not len(times) or times[-1] < ended:
            times = np.append(times, ended)
            pieces.append((stretches[-1].end_state if stretches else course.start.state)[None])
            kinds.append(np.array([stretches[-1].kind if stretches else PhaseKind.SLIDING], dtype=np.int8))
    state = in_si(np.concatenate(pieces), units)
    phases = np.concatenate(kinds)
    variables = observe(state, phases == PhaseKind.SLIDING, problem.top)
    attributes = {
        "title": "Motion of a spinning top on a table",
        "problem": problem.to_json(),
        "outcome": course.outcome.name.lower(),
        "outcome_advice": " ".join(filter(None, (course.outcome.value, course.detail))),
        **method,
        "steps": sum(stretch.steps for stretch in stretches),
        "evaluations": sum(stretch.evaluations for stretch in stretches),
        "tippetop_version": __version__,
    }
    names = [kind.name.lower() for kind in PhaseKind]
    lists = {"event": _event_arrays(course.events, units), "flight": _flight_arrays(stretches, units)}
    return assemble(times, variables, phases, names, lists, attributes)


def _event_arrays(events: Sequence[Event], units: Units) -> dict[str, Described]:
    """Values over the events."""
    kinds = np.array([event.kind.value for event in events], dtype=str)
    numbers = [(event.time, event.impulse, event.energy_lost) for event in events]
    times, impulses, losses = np.array(numbers, dtype=float).reshape(-1, 3).T
    return {
        "event_time": Described(times * units.time, "when it happened", "s"),
        "event_kind": Described(kinds, "what happened"),
        "event_impulse": Described(impulses * units.mass * units.speed, "normal impulse of the table", "N s"),
        "event_energy_lost": Described(losses * units.energy, "energy lost in it", "J"),
    }


def _flight_arrays(stretches: Sequence[Stretch], units: Units) -> dict[str, Described]:
    """Values over the flights."""
    begun = [0.0, *(stretch.end_time for stretch in stretches)]
    numbers = [
        (begin, stretch.end_time, stretch.highest_gap)
        for begin, stretch in zip(begun, stretches, strict=False)
        if stretch.kind is PhaseKind.FLIGHT
    ]
    starts, ends, gaps = np.array(numbers, dtype=float).reshape(-1, 3).T
    return {
        "flight_start": Described(starts * units.time, "when the flight began", "s"),
        "flight_end": Described(ends * units.time, "when it ended", "s"),
        "flight_highest_gap": Described(gaps * units.length, "highest gap in it", "m"),
    }


def _method_attributes(method: Integrator, units: Units) -> dict[str, str | float]:
    """The method and its one setting."""
    settings: dict[str, str | float] = {"integrator": method.name}
    if hasattr(method, "step"):
        settings["step"] = float(method.step) * units.time
    elif hasattr(method, "tolerance"):
        settings["tolerance"] = float(method.tolerance)
    return settings
