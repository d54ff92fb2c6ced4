"""Times that an account tells, how far they are from those of another run, and their digits."""

import math
from collections.abc import Sequence

from tippetop.contact.mode import Event, Status
from tippetop.results.account import Facts, account_of

CHANGE = 1e-6
"""Relative change of the numbers of the launch and of friction: nobody knows them better."""

MOVED = (
    ("launch.spin", "launch.tilt", "launch.precession", "launch.tilt_rate", "launch.gap"),
    ("friction.mu",),
)
"""Fields that are changed together."""

LONGER = 1.05
"""How much longer than a run that ended early the runs beside it are followed."""

EDGE = 1e-3
"""Part of a time before it in which an event counts as one at that time."""

TENS = 10.0
"""Time, s, from which on four digits are written, and three below it."""


def account_times(facts: Facts) -> dict[str, float]:
    """Return the times that a run and its account tell, s, by the names of variables and clauses.

    When a run ends as long as it was asked for is no result.
    """
    metrics = facts.metrics
    times = {
        "turnover_time": metrics["turnover_time"],
        "arrival_time": metrics["arrival_time"],
        "settling_time": facts.settling_time,
        "liftoff_time": metrics["liftoff_time"],
    }
    for clause in account_of(facts):
        if "time" in clause.numbers and clause.name not in times:
            times[clause.name] = clause.numbers["time"]
    is_complete, end = facts.status is Status.COMPLETED, metrics["end_time"]
    return {
        name: time
        for name, time in times.items()
        if math.isfinite(time) and time > 0.0 and not (is_complete and time == end)
    }


def time_changes(facts: Facts, facts_beside: Facts) -> dict[str, float]:
    """Return how far the times of a run are from those of a run beside it, s, by name.

    Infinite where the run beside it does not tell the same, or goes through other events before.
    """
    times, others = account_times(facts), account_times(facts_beside)
    changes = dict[str, float]()
    for name, time in times.items():
        changes[name] = math.inf
        if name in others:
            kinds = _kinds_before(facts.events, time)
            if kinds == _kinds_before(facts_beside.events, others[name]):
                changes[name] = abs(others[name] - time)
    return changes


def _kinds_before(events: Sequence[Event], time: float) -> list[str]:
    """Return the kinds of the events up to a time, in order.

    The event at the time itself is left out: it may be a little before or after.
    """
    return [event.kind.value for event in events if event.time < time * (1.0 - EDGE)]


def digits_left(time: float, uncertainty: float, usual: int) -> int:
    """Return how many digits an uncertainty leaves of a time, of the usual ones; 0 for none."""
    if not uncertainty < 0.5 * time:
        return 0
    if uncertainty == 0.0:
        return usual
    digits = math.floor(math.log10(time)) - math.ceil(math.log10(uncertainty)) + 1
    return min(max(digits, 1), usual)


def time_digits(time: float, uncertainty: float) -> int:
    """Return how many digits of a time, s, are written in sentences; 0 for none."""
    return digits_left(time, uncertainty, usual_digits(time))


def usual_digits(time: float) -> int:
    """Return how many digits of a time, s, are written where nothing takes any from it."""
    return 3 if time < TENS else 4
