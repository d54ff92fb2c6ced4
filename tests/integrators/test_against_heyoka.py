"""Random launches have the same events by the package's Taylor method and by heyoka's.

*How nearly the same.* A guard's value g is known to its rounding dg, and so the time at which it
falls through zero at the rate g' is known to dg / |g'|. Where a body rocks from one surface to the
other, g' falls without bound and dg stays: the times of its last rockings are known to 1e-10 s and
less well. A rocking that lasts longer by a part lets those after it last longer by that part, since
their durations are in fixed ratios. Two methods whose guards round in other ways differ by as much,
and no change of the launch shows it, for it changes both alike.
"""

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

import tippetop as tt
from campaigns import seeds
from launches import ROUNDINGS, launch_of, nudged
from tippetop.contact.mode import IntegratedMode, ModeEnd, Segment
from tippetop.fit.dual import Dual
from tippetop.mechanics.top import natural_units
from tippetop.problem.problem import top_of

DURATION = 1.0
SAME_TIME = 1e-10
"""Difference of event times, s, that rounding in two methods makes."""

LATER = 10.0
"""Duration of all rockings after one, at most, in units of that one: they shorten geometrically."""

ROCKS_LONG = 191
"""Seed of a launch whose last rockings no method tells to `SAME_TIME`."""


def problem_of(fields: dict[str, Any]) -> Any:
    """Return the problem with some fields, or None if it is refused."""
    try:
        return tt.Problem(**fields)
    except tt.InvalidInput:
        return None


def followed(problem: Any, integrator: Any) -> Any:
    """Return the run of a problem."""
    return tt.simulate(problem, DURATION, times=[0.0], integrator=integrator)


def falls(problem: Any) -> Iterator[tuple[float, float, float]]:
    """Yield when guards fall in a run, how long their mode lasted, and the rounding of that, s."""
    _, solution = tt.simulate(problem, DURATION, times=[0.0], integrator="taylor", dense=True)
    unit, begin = natural_units(top_of(problem)).time, 0.0
    for segment in solution._block.segments:
        if segment.mode_end is not None:
            if isinstance(segment.mode, IntegratedMode):
                for rounding in rounding_of_end(segment):
                    yield (
                        segment.end_time * unit,
                        (segment.end_time - begin) * unit,
                        rounding * unit,
                    )
            begin = segment.end_time


def rounding_of_end(segment: Segment) -> Iterator[float]:
    """Yield the rounding of the time at which the guard that ends a segment falls, if one does."""
    mode: Any = segment.mode
    y, parameters = segment.solution(segment.solution.knots[-1:])[0], tuple(mode.parameters)
    rates = mode.motion.rates(y.tolist(), parameters)
    random = np.random.default_rng(0)
    states = y[:, None] * (1.0 + 1e-12 * random.uniform(-1.0, 1.0, (len(y), 64)))
    roundings = 0.5 * np.spacing(states) * random.uniform(-1.0, 1.0, states.shape)
    exact_states = states.astype(np.longdouble) + roundings
    for guard in mode.motion.guards:
        end = ModeEnd.by_guard(guard.name, segment.end_state)
        if (end.cause, end.contact) == (segment.mode_end.cause, segment.mode_end.contact):
            moving = [Dual(a, np.array([b])) for a, b in zip(y.tolist(), rates, strict=True)]
            exact = guard.value(list(exact_states), parameters)
            rounding = np.std(guard.value(list(states), parameters) - exact)
            yield float(rounding / abs(guard.value(moving, parameters).parts[0]))


def roundings_of(times: Any, problem: Any) -> Any:
    """Return how far rounding of guards may move the events at some times, s."""
    moved = np.zeros(len(times))
    for time, lasted, rounding in falls(problem):
        later = np.clip((times - time) / lasted, 0.0, LATER)
        moved += np.where(times >= time - SAME_TIME, rounding * (1.0 + later), 0.0)
    return moved


def same_time(times: Any, problem: Any) -> Any:
    """Return how far events at some times, s, may be apart in two methods, s."""
    return np.maximum(SAME_TIME, ROUNDINGS * roundings_of(times, problem))


@pytest.mark.parametrize("seed", seeds(check=1, sample=12, claim=500))
def test_random_launches_have_the_events_that_heyoka_finds(seed):
    pytest.importorskip("heyoka")
    from heyoka_taylor import Heyoka  # noqa: PLC0415 - heyoka may not be installed

    fields = launch_of(seed)
    problem = problem_of(fields)
    if problem is None:
        return
    run, same = followed(problem, "taylor"), followed(problem, Heyoka())
    assert same.attrs["status"] == run.attrs["status"]
    assert same["event_kind"].values.tolist() == run["event_kind"].values.tolist()
    times = run["event_time"].values
    apart = np.abs(same["event_time"].values - times)
    if np.max(apart, initial=0.0) <= SAME_TIME:
        return
    allowed = same_time(times, problem)
    if np.any(apart > allowed):
        # A launch may multiply a rounding by more than the bound allows.
        beside = followed(problem_of(nudged(fields)), "taylor")
        assert beside["event_kind"].values.tolist() == run["event_kind"].values.tolist()
        moved = np.abs(beside["event_time"].values - times)
        allowed = np.maximum(allowed, ROUNDINGS * np.max(moved))
    assert np.all(apart <= allowed)


def test_only_the_last_rockings_may_be_further_apart():
    """An error of a nanosecond in any other event is ten times the bound."""
    problem = problem_of(launch_of(ROCKS_LONG))
    times = followed(problem, "taylor")["event_time"].values
    allowed = same_time(times, problem)
    uncertain = allowed > SAME_TIME
    assert 0.0 < np.mean(uncertain) < 0.2
    assert np.all(times[uncertain] > times[-1] - 1e-6)
    assert np.all(allowed < 20.0 * SAME_TIME)
