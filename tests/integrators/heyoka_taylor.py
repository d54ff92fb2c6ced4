"""Taylor's method by heyoka: an independent check of the package's own."""

import math
import pickle
import threading
from array import array
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from inspect import getsource
from io import BytesIO
from typing import Any, ClassVar, TypeAlias

import heyoka as hy
import numpy as np

from tippetop.graph.hoisting import evaluated, hoisted
from tippetop.graph.recording import recordable
from tippetop.integrators.base import NO_STEP, NOT_FINITE, TOLERANCES, Arc, Array, Motion
from tippetop.integrators.dense import DenseSolution
from tippetop.integrators.sealed_folders import kept_content
from tippetop.support.interrupts import run_interruptibly

RESOLVED = 1e6
"""Step, in roundings of time, below which only a solution that blows up is followed: these matter
in it.
"""

LONG = 4096
"""Steps in an arc at most."""

LEFT_OUT = 100.0
"""What the last terms of a step's series may add to a number, in tolerances of that number or of 1,
the larger: else the step is cut. The compiler compares them with the largest number or guard alone:
beside huge slip or friction the axis would go astray.
"""

SAFETY, SHORT = 0.9, 16
"""How long a step that is cut may be, of what that allows; and how many steps at most, none longer
than that, are taken next.
"""

GUARDED = 2.0**-5
"""Weight of guards beside the numbers of the motion where the compiler chooses steps by the largest
of all. A guard's zero needs fewer digits than they do, since the state there is theirs: by itself a
guard would cost steps.
"""

EFFORT = 0
"""How hard the compiler tries, of 3: a launch is followed once, and code that runs in half the time
takes ten times as long to compile.
"""

Numbers: TypeAlias = Callable[[tuple[float, ...]], Sequence[float]]
"""From the parameters of a motion to those of what is compiled."""

# For the whole process: what it says of guards on the terminal, its makers understand; and what is
# compiled is kept by this package, whole or not at all.
hy.set_logger_level_critical()
hy.llvm_state.set_diskcache_enabled(False)


@dataclass(frozen=True)
class Heyoka:
    """heyoka's adaptive Taylor series behind the seam of integrators."""

    tolerance: float = TOLERANCES["taylor"]
    """Relative and absolute error per step, at least 2.2e-16."""
    name: str = field(default="heyoka", init=False)
    caution: ClassVar[str] = ""

    def integrate(
        self, motion: Motion, parameters: Sequence[float], start: tuple[float, Array], end: float
    ) -> Iterator[Arc]:
        """Follow the motion; see `tippetop.integrators.base.Integrator`."""
        compiled = _compiled(motion, self.tolerance)
        while start[0] < end:
            solution, state, outcome, taken = compiled.arc(
                parameters, start, end, LEFT_OUT * self.tolerance
            )
            steps = len(solution.terms)
            # Rounding of time may swallow all steps before numbers have grown beyond all bounds.
            stuck = outcome == hy.taylor_outcome.step_limit and not solution.end > start[0]
            if stuck or outcome == hy.taylor_outcome.err_nf_state:
                solution = _before_blow_up(solution)
                state = solution(solution.knots[-1:])[0] if len(solution.terms) else start[1]
                yield Arc(solution, state, None, NO_STEP if stuck else NOT_FINITE, steps, taken)
                return
            guard = None
            if outcome not in (hy.taylor_outcome.step_limit, hy.taylor_outcome.time_limit):
                guard = motion.guards[-int(outcome) - 1].name
            yield Arc(solution, state, guard, None, steps, taken)
            if guard is not None:
                return
            start = solution.end, state


class _Compiled:
    """An integrator, the parameters it takes by those of the motion, and a lock that it is used
    under.
    """

    def __init__(self, integrator: Any, numbers: Numbers) -> None:
        self.integrator, self.numbers, self.lock = integrator, numbers, threading.Lock()
        self._room = BytesIO()
        self._coefficients, self._state, self._parameters = (
            integrator.tc,
            integrator.state,
            integrator.pars,
        )

    def arc(
        self, parameters: Sequence[float], start: tuple[float, Array], end: float, accuracy: float
    ) -> tuple[DenseSolution, Array, Any, int]:
        """An arc whose steps leave out no more of any number, its end, what ended it, and steps
        taken.
        """
        (time, state), parts, left, longest, most = (
            start,
            list[DenseSolution](),
            LONG,
            math.inf,
            LONG,
        )
        taken = 0
        run, outcome, numbers = (
            self.integrator,
            hy.taylor_outcome.step_limit,
            self.numbers(tuple(parameters)),
        )
        with self.lock:
            # Those that appear in no equation, beyond the last that does, it has no room for.
            run.pars[:] = numbers[: len(run.pars)]
            while left and outcome == hy.taylor_outcome.step_limit:
                run.time = time
                run.state[:] = state
                if run.with_events:
                    run.reset_cooldowns()
                solution, outcome = self._advance(end, longest, min(left, most))
                taken += len(solution.terms)
                cut = _cut(solution, accuracy)
                if cut is None:
                    state = np.array(run.state)
                    # What follows a step that is cut is lost: more are taken as long as none is.
                    longest, most = math.inf, 1 if longest < math.inf else 2 * most
                else:
                    solution, outcome = cut, hy.taylor_outcome.step_limit
                    state = cut.terms[-1].sum(axis=1)
                    longest, most = float(cut.knots[-1] - cut.knots[-2]), SHORT
                parts.append(solution)
                time, left = solution.end, left - len(solution.terms)
        return DenseSolution.joined(parts), state, outcome, taken

    def _advance(self, end: float, longest: float, most: int) -> tuple[DenseSolution, Any]:
        """Take so many steps at most, none longer: for half the price of heyoka's continuous
        output.
        """
        size, knots = self._coefficients.size, array("d", [self.integrator.time])
        # Bytes are copied in a third of the time that arrays need, and quicker where others were
        # before. Whoever interrupts this may still look at them: then there is new room.
        room, self._room = self._room, BytesIO()
        room.seek(0)
        step, keep, note = self._coefficients.reshape(-1).data, room.write, knots.append

        def take(run: Any) -> bool:
            keep(step)
            note(run.time)
            return True

        outcome, *_ = self.integrator.propagate_until(
            end, max_steps=most, max_delta_t=longest, write_tc=True, callback=take
        )
        if outcome == hy.taylor_outcome.time_limit:
            knots[-1] = end
        terms = np.frombuffer(room.getbuffer(), count=(len(knots) - 1) * size)
        solution = DenseSolution.in_time(knots, terms.reshape(-1, *self._coefficients.shape))
        self._room = room
        return solution, outcome


@lru_cache(maxsize=32)
def _compiled(motion: Motion, tolerance: float, effort: int = EFFORT) -> _Compiled:
    """Compile the equations and the guards, or fetch them from the cache across processes."""
    state = [hy.make_vars(f"y{i}") for i in range(motion.size)]
    values, numbers = _expressions(motion, state)
    rates = [hy.expression(rate) for rate in values[: motion.size]]
    guards = [GUARDED * guard for guard in values[motion.size :]]

    def make() -> Any:
        falling = hy.event_direction.negative
        return hy.taylor_adaptive(
            list(zip(state, rates, strict=True)),
            [0.0] * motion.size,
            tol=tolerance,
            t_events=[hy.t_event(guard, direction=falling) for guard in guards],
            compact_mode=not motion.lasting,
            opt_level=effort,
        )

    # Of two installations of one version, each compiles for itself.
    made = (
        pickle.dumps((rates, guards, tolerance, motion.lasting, effort)),
        getsource(make),
        hy.__version__,
        hy.__file__,
    )
    content = run_interruptibly(lambda: kept_content(made, lambda: pickle.dumps(make())))
    try:
        return _Compiled(pickle.loads(content), numbers)
    except Exception:  # noqa: BLE001 - whatever is wrong with what was kept, it can be made anew
        return _Compiled(make(), numbers)


def _expressions(motion: Motion, state: Sequence[Any]) -> tuple[Sequence[Any], Numbers]:
    """The rates and guards in heyoka's terms, and the parameters in them by those of the motion.

    To heyoka, what is made of parameters alone is a series like any other, expanded in every step:
    so it is made once and is a parameter.
    """

    def values(y: Sequence[Any], p: Sequence[Any]) -> list[Any]:
        return [*motion.rates(y, p), *[guard.value(y, p) for guard in motion.guards]]

    recorded = recordable(values, motion.size, motion.parameters)
    if recorded is None:
        return values(state, [hy.par[i] for i in range(motion.parameters)]), tuple
    own, rest = hoisted(recorded)

    @lru_cache(maxsize=16)
    def numbers(parameters: tuple[float, ...]) -> Sequence[float]:
        with np.errstate(all="ignore"):  # what is infinite, heyoka tells
            return [*parameters, *evaluated(own, (), list(np.array(parameters)))]

    return evaluated(rest, state, [hy.par[i] for i in range(rest.parameters)]), numbers


def _cut(solution: DenseSolution, accuracy: float) -> DenseSolution | None:
    """A solution up to its first step that leaves out more of some number, and as much of that as
    does not.

    None if there is none but those in which rounding of time matters; to less than these, none is
    cut. A step that is cut needs not be repeated: a shorter one has the same series.
    """
    last = np.maximum(np.abs(solution.terms[:, :, -1]), np.abs(solution.terms[:, :, -2]))
    if last.max(initial=0.0) <= accuracy:
        return None
    spans, degree, shortest = (
        np.diff(solution.knots),
        solution.terms.shape[2] - 1,
        _resolved(solution.knots),
    )
    with np.errstate(all="ignore"):  # where nothing is left out, or numbers grow beyond all bounds
        excess = (last / (accuracy * np.maximum(np.abs(solution.terms[:, :, 0]), 1.0))).max(axis=1)
        allowed = np.maximum(SAFETY * spans * excess ** (-1.0 / (degree - 1)), shortest)
    bad = np.flatnonzero((excess > 1.0) & (spans > shortest))
    if not len(bad):
        return None
    step = int(bad[0])
    begin, end = solution.knots[step : step + 2]
    knots, terms = solution.knots[: step + 2].copy(), solution.terms[: step + 1].copy()
    knots[-1] = begin + allowed[step]
    terms[-1] *= ((knots[-1] - begin) / (end - begin)) ** np.arange(degree + 1)
    return DenseSolution(knots, terms)


def _resolved(knots: Array) -> Array:
    """The shortest steps in which rounding of time does not matter, by their ends."""
    return RESOLVED * np.spacing(np.maximum(np.abs(knots[:-1]), np.abs(knots[1:])))


def _before_blow_up(solution: DenseSolution) -> DenseSolution:
    """A solution that ended in numbers that are none, without its last steps, too short to be
    told.
    """
    fine = np.flatnonzero(np.diff(solution.knots) > _resolved(solution.knots))
    steps = fine[-1] + 1 if len(fine) else 0
    return DenseSolution(solution.knots[: steps + 1], solution.terms[:steps])
