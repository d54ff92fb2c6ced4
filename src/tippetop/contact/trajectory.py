"""One launch, followed from mode to mode: the executor of single launches."""

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

from tippetop.contact.automaton import Automaton
from tippetop.contact.mode import Event, Mode, Segment, Status, Transition
from tippetop.integrators.base import Integrator
from tippetop.mechanics.state import State
from tippetop.support.errors import InvalidInput, is_number, is_whole

MODE_LIMIT = 100_000
"""How many modes a run goes through at most unless told otherwise."""

LONGEST_RUN = 1e300
"""Seconds, and natural units of time, that a run may last at most, so that it is a number in both.
"""

STEP_LIMIT = 1_000_000
"""How many steps a run takes at most unless told otherwise: more than two hours of a tippe top's
spinning. A coin that rocks on a small patch, whose slip is stiff, takes 665,000 to its end.
"""


class Trajectory:
    """A launch under way; iterate over `segments` to follow it.

    Attributes
    ----------
    automaton
        The rules of what follows each mode.
    start
        How the run begins.
    end
        When it ends at the latest.
    integrator
        The method for modes that need one.
    limit, step_limit
        How many modes to go through, and how many steps to take, at most: those of the integrator
        and of impacts, and the pieces of flights.
    time, state
        Where it is.
    status, detail
        How it ended, once it has, and more about that.
    events
        Everything that happened so far, in order.
    """

    def __init__(
        self,
        automaton: Automaton,
        start: Transition,
        end: float,
        integrator: Integrator,
        limit: int = MODE_LIMIT,
        step_limit: int = STEP_LIMIT,
        time: float = 0.0,
    ) -> None:
        self.automaton = automaton
        self.start, self.end, self.integrator = start, end, integrator
        self.limit, self.step_limit = limit, step_limit
        self.time, self.state = time, start.state
        self.status: Status | None = None
        self.detail, self.events = "", list[Event]()

    def segments(self) -> Iterator[Segment]:
        """Follow the launch, mode by mode and piece by piece."""
        transition, modes, steps = self._enter(self.start), 0, 0
        while isinstance(transition.next, Mode):
            if self.time >= self.end or modes == self.limit:
                self.status = Status.COMPLETED if self.time >= self.end else Status.TOO_MANY_MODES
                return
            modes += 1
            mode = transition.next
            for segment in mode.segments(self.time, self.state, self.end, self.integrator):
                self.time, self.state = segment.end_time, segment.end_state
                steps += max(segment.steps, len(segment.solution.knots) - 1)
                if segment.mode_end is not None:
                    transition = self._enter(
                        self.automaton.follow(mode, segment.mode_end, self.time)
                    )
                    steps += sum(event.steps for event in transition.events)
                    segment = replace(segment, transition=transition)  # noqa: PLW2901
                yield segment
                if steps >= self.step_limit and self.status is None:
                    self.status = Status.TOO_MANY_STEPS
                    return

    def end_at(
        self, time: float, state: State, status: Status = Status.COMPLETED, detail: str = ""
    ) -> None:
        """Leave out what follows a time and state that the run has passed."""
        self.time, self.state, self.status, self.detail = time, state, status, detail
        self.events = [event for event in self.events if event.time <= time]

    def _enter(self, transition: Transition) -> Transition:
        self.events += transition.events
        self.state = transition.state
        if isinstance(transition.next, Status):
            self.status, self.detail = transition.next, transition.detail
        return transition


def require_limits(
    duration: Any, unit: float, mode_limit: Any = MODE_LIMIT, step_limit: Any = STEP_LIMIT
) -> None:
    """Refuse, with `InvalidInput`, a duration, s, or limits that no run can have; `unit` is that of
    time.
    """
    longest = LONGEST_RUN * min(1.0, unit)
    if not (is_number(duration) and 0.0 < duration <= longest):
        most = f", at most {longest:.3g}" if is_number(duration) and duration > longest else ""
        raise InvalidInput("duration", duration, f"a number of seconds greater than 0{most}")
    for name, limit in {"mode_limit": mode_limit, "step_limit": step_limit}.items():
        if not is_whole(limit) or limit < 0:
            raise InvalidInput(name, limit, "a whole number, at least 0")
