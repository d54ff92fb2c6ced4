"""Taylor's method of high order, compiled by heyoka once for all values of the parameters."""

import math
import pickle
import threading
from array import array
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from inspect import getsource
from typing import Any, ClassVar

import heyoka as hy
import numpy as np

from tippetop.integrators.base import NO_STEP, NOT_FINITE, TOLERANCES, Arc, Array, Expansion, Motion
from tippetop.integrators.dense import DenseSolution
from tippetop.integrators.sealed_folders import kept_content
from tippetop.interrupts import heard

SHORTEST = 1e-6
"""Step, relative to the longest, that only a solution that blows up takes; rounding of time matters in it."""

LONG = 4096
"""Steps in an arc at most."""

GUARDED = 2.0**-5
"""Weight of guards beside the numbers of the motion where the compiler chooses steps by the largest of all. A
guard's zero needs fewer digits than they do, since the state there is theirs: by itself a guard would cost
steps."""

# For the whole process: what it says of guards on the terminal, its makers understand; and what is compiled
# is kept by this package, whole or not at all.
hy.set_logger_level_critical()
hy.llvm_state.set_diskcache_enabled(False)


@dataclass(frozen=True)
class Taylor:
    """Adaptive Taylor series, accurate to rounding at its default tolerance."""

    tolerance: float = TOLERANCES["taylor"]
    """Relative and absolute error per step, at least 2.2e-16."""
    name: str = field(default="taylor", init=False)
    caution: ClassVar[str] = ""

    def integrate(
        self, motion: Motion, parameters: Sequence[float], start: tuple[float, Array], end: float
    ) -> Iterator[Arc]:
        """Follow the motion; see `tippetop.integrators.base.Integrator`."""
        compiled = _compiled(motion, self.tolerance)
        while start[0] < end:
            with compiled.lock:
                run = compiled.integrator
                run.time = start[0]
                run.state[:] = start[1]
                # Those that appear in no equation, beyond the last that does, it has no room for.
                run.pars[:] = parameters[: len(run.pars)]
                if motion.guards:
                    run.reset_cooldowns()
                solution, outcome = compiled.advance(end)
                state = np.array(run.state)
            steps = len(solution.terms)
            # Rounding of time may swallow all steps before numbers have grown beyond all bounds.
            stuck = outcome == hy.taylor_outcome.step_limit and not solution.end > start[0]
            if stuck or outcome == hy.taylor_outcome.err_nf_state:
                solution = _before_blow_up(solution)
                state = solution(solution.knots[-1:])[0] if len(solution.terms) else start[1]
                yield Arc(solution, state, None, NO_STEP if stuck else NOT_FINITE, steps, steps)
                return
            guard = None
            if outcome not in (hy.taylor_outcome.step_limit, hy.taylor_outcome.time_limit):
                guard = motion.guards[-int(outcome) - 1].name
            yield Arc(solution, state, guard, None, steps, steps)
            if guard is not None:
                return
            start = solution.end, state

    def expansion(self, motion: Motion, parameters: Sequence[float], degree: int, count: int) -> Expansion:
        """The coefficients of the first numbers of a motion's solutions in powers of time, compiled."""
        compiled = _compiled(motion, math.exp(3.0 - 2.0 * degree))
        numbers = np.array(parameters)
        return lambda start: compiled.expanded(start, numbers, count)


class _Compiled:
    """An integrator, and a lock that it is used under."""

    def __init__(self, integrator: Any) -> None:
        self.integrator, self.lock = integrator, threading.Lock()
        self._coefficients, self._state, self._parameters = integrator.tc, integrator.state, integrator.pars

    def advance(self, end: float) -> tuple[DenseSolution, Any]:
        """Take an arc's steps: for half the price of heyoka's continuous output."""
        shape, terms, knots = self._coefficients.shape, bytearray(), array("d", [self.integrator.time])
        # Bytes are copied in a third of the time that arrays need.
        step, keep, note = self._coefficients.reshape(-1).data, terms.extend, knots.append

        def take(run: Any) -> bool:
            keep(step)
            note(run.time)
            return True

        outcome, *_ = self.integrator.propagate_until(end, max_steps=LONG, write_tc=True, callback=take)
        if outcome == hy.taylor_outcome.time_limit:
            knots[-1] = end
        return DenseSolution.in_time(np.array(knots), np.frombuffer(terms).reshape(-1, *shape)), outcome

    def expanded(self, start: Sequence[float], parameters: Array, count: int) -> Array:
        """Coefficients of the first numbers of the solution about its start."""
        with self.lock:
            self._state[:], self._parameters[:] = start, parameters[: len(self._parameters)]
            self.integrator.step(write_tc=True)
            found: Array = self._coefficients[:count].copy()
        return found


@lru_cache(maxsize=32)
def _compiled(motion: Motion, tolerance: float) -> _Compiled:
    """Compile the equations and the guards, or fetch them from the cache across processes."""
    state = [hy.make_vars(f"y{i}") for i in range(motion.size)]
    parameters = [hy.par[i] for i in range(motion.parameters)]
    rates = [hy.expression(rate) for rate in motion.rates(state, parameters)]
    guards = [GUARDED * guard.value(state, parameters) for guard in motion.guards]

    def make() -> Any:
        falling = hy.event_direction.negative
        return hy.taylor_adaptive(
            list(zip(state, rates, strict=True)),
            [0.0] * motion.size,
            tol=tolerance,
            t_events=[hy.t_event(guard, direction=falling) for guard in guards],
            compact_mode=not motion.lasting,
        )

    # Of two installations of one version, each compiles for itself.
    made = (
        pickle.dumps((rates, guards, tolerance, motion.lasting)),
        getsource(make),
        hy.__version__,
        hy.__file__,
    )
    content = heard(lambda: kept_content(made, lambda: pickle.dumps(make())))
    try:
        return _Compiled(pickle.loads(content))
    except Exception:  # noqa: BLE001 - whatever is wrong with what was kept, it can be made anew
        return _Compiled(make())


def _before_blow_up(solution: DenseSolution) -> DenseSolution:
    """A solution that ended in numbers that are none, without its last steps, too short to be told."""
    knots = solution.knots
    spans = np.diff(knots)
    fine = np.flatnonzero(spans > SHORTEST * spans.max(initial=0.0))
    steps = fine[-1] + 1 if len(fine) else 0
    return DenseSolution(knots[: steps + 1], solution.terms[:steps])
