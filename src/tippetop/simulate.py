"""Run a problem: follow its phases, one after the other, and label what came of it."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import psutil
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from tippetop import __version__
from tippetop.dataset import assemble
from tippetop.errors import InvalidInput
from tippetop.integrators import Integrator, make_integrator
from tippetop.integrators.base import Array
from tippetop.integrators.classical import ClassicalRK4
from tippetop.mechanics.motion import on_table
from tippetop.mechanics.state import State
from tippetop.mechanics.top import Units, dimensionless_numbers, kind_of, natural_units
from tippetop.observables import in_si, observe, si_factors
from tippetop.phases import Event, Outcome, Phase, PhaseKind, Sliding, Stretch
from tippetop.problem import Problem

BYTES_PER_SAMPLE = 1600
"""Memory that a sample takes at most while a result is being made."""


@dataclass(frozen=True)
class Course:
    """The phases a run went through, in natural units."""

    stretches: tuple[tuple[PhaseKind, Stretch], ...]
    outcome: Outcome

    @property
    def events(self) -> list[Event]:
        """Everything that happened, in order."""
        return [event for _, stretch in self.stretches for event in stretch.events]


def simulate(
    problem: Problem,
    duration: float,
    *,
    samples: int = 2001,
    times: ArrayLike | None = None,
    integrator: str | Integrator | None = None,
    tolerance: float | None = None,
    step: float | None = None,
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
        "taylor", "dop853", "rk45", "radau", "bdf", "lsoda" or "rk4"; None for the best installed.
    tolerance
        Relative error per step; None for the integrator's own default.
    step
        Step size of "rk4", s.

    Returns
    -------
    xarray.Dataset
        Variables over `time` (SI units on each): theta, theta_dot, phi, phi_dot, omega3, slip_x, slip_y,
        normal_force, energy, work, jellett, height, gap, x, y, axis, velocity, angular_momentum, orientation,
        phase. Over `event`: event_time, event_kind. Attributes: problem (JSON), outcome, outcome_advice,
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
    start = (0.0, to_natural(on_table(problem.start(), top), units))
    course = follow_phases(first_phase(problem), start, duration / units.time, grid / units.time, method)
    return _label(problem, course, grid, units, _method_attributes(method, units))


def follow_phases(
    phase: Phase, start: tuple[float, Array], end: float, times: Array, integrator: Integrator
) -> Course:
    """Go from phase to phase until one says how the run ends; times in the units of the phases.

    Parameters
    ----------
    phase, start
        The first phase, and the time and whole state (shape (16,)) in which it begins.
    end
        When the run ends at the latest.
    times
        Increasing sample times, shape (k,).
    integrator
        The method for phases that need one.
    """
    stretches: list[tuple[PhaseKind, Stretch]] = []
    while True:
        stretch = phase.follow(start, end, times, integrator)
        stretches.append((phase.kind, stretch))
        if isinstance(stretch.then, Outcome):
            return Course(tuple(stretches), stretch.then)
        phase, start = stretch.then, (stretch.end_time, stretch.next_state)
        times = times[len(stretch.times) :]


def first_phase(problem: Problem) -> Phase:
    """The phase in which a problem's launch begins.

    Raises
    ------
    InvalidInput
        If the problem lets the top fly, which is not possible yet.
    """
    if problem.contact.liftoff == "fly":
        raise InvalidInput("contact.liftoff", "fly", "'stop' or 'ignore'; flight is not available yet")
    top = problem.top
    return Sliding(kind_of(top), dimensionless_numbers(top), problem.contact.liftoff == "ignore")


def sample_times(duration: float, samples: int, times: ArrayLike | None) -> Array:
    """Sample times, s, checked; see `simulate`."""
    if not (np.isfinite(duration) and duration > 0):
        raise InvalidInput("duration", duration, "a finite number of seconds greater than 0")
    if times is None:
        if isinstance(samples, bool) or not isinstance(samples, (int, np.integer)) or samples < 2:
            raise InvalidInput("samples", samples, "a whole number, at least 2")
        _check_memory(samples)
        return np.linspace(0.0, duration, int(samples))
    grid = np.array(times, dtype=float)
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
    if integrator is None or isinstance(integrator, str):
        return make_integrator(integrator, tolerance, step, units.time)
    return integrator


def to_natural(state: State, units: Units) -> Array:
    """A whole state, shape (16,), in natural units from one in SI."""
    return np.array(state.pack()) / si_factors(units)


def _check_memory(samples: int) -> None:
    free = psutil.virtual_memory().available
    if samples * BYTES_PER_SAMPLE > free:
        limit = free // BYTES_PER_SAMPLE
        raise InvalidInput("samples", samples, f"at most {limit}, for which there is memory")


def _label(
    problem: Problem, course: Course, grid: Array, units: Units, method: dict[str, str | float]
) -> xr.Dataset:
    """The dataset of a run."""
    reached = sum(len(stretch.times) for _, stretch in course.stretches)
    times = grid[:reached]
    pieces = [stretch.states for _, stretch in course.stretches]
    kinds = [np.full(len(stretch.times), kind, dtype=np.int8) for kind, stretch in course.stretches]
    last_kind, last = course.stretches[-1]
    ended = last.end_time * units.time
    if course.outcome is not Outcome.COMPLETED and (not reached or times[-1] < ended):
        times = np.append(times, ended)
        pieces.append(last.end_state[None])
        kinds.append(np.array([last_kind], dtype=np.int8))
    state = in_si(np.concatenate(pieces), units)
    phases = np.concatenate(kinds)
    variables = observe(state, phases == PhaseKind.SLIDING, problem.top)
    attributes = {
        "title": "Motion of a spinning top on a table",
        "problem": problem.to_json(),
        "outcome": course.outcome.name.lower(),
        "outcome_advice": " ".join(filter(None, (course.outcome.value, last.detail))),
        **method,
        "steps": sum(stretch.steps for _, stretch in course.stretches),
        "evaluations": sum(stretch.evaluations for _, stretch in course.stretches),
        "tippetop_version": __version__,
    }
    names = [kind.name.lower() for kind in PhaseKind]
    return assemble(times, variables, phases, names, _event_arrays(course.events, units), attributes)


def _event_arrays(events: Sequence[Event], units: Units) -> dict[str, tuple[NDArray[np.generic], str, str]]:
    """Values over the events, with long name and unit."""
    kinds = np.array([event.kind.value for event in events], dtype="<U16")
    return {
        "event_time": (np.array([event.time for event in events]) * units.time, "when it happened", "s"),
        "event_kind": (kinds, "what happened", ""),
    }


def _method_attributes(method: Integrator, units: Units) -> dict[str, str | float]:
    """The method and its one setting."""
    settings: dict[str, str | float] = {"integrator": method.name}
    if isinstance(method, ClassicalRK4):
        settings["step"] = method.step * units.time
    elif hasattr(method, "tolerance"):
        settings["tolerance"] = float(method.tolerance)
    return settings
