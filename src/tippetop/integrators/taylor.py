"""Taylor's method of high order, compiled by heyoka once for all values of the parameters."""

import threading
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Any

import heyoka as hy
import numpy as np

from tippetop.integrators.base import Arc, Array, Guard, Motion
from tippetop.integrators.compile_cache import compiling

CHUNK = 20_000.0
"""Span of time followed in one call into compiled code, so that Ctrl-C is heard between calls."""


@dataclass(frozen=True)
class Taylor:
    """Adaptive Taylor series, accurate to rounding at its default tolerance.

    Attributes
    ----------
    tolerance
        Relative and absolute error per step, at least 2.2e-16.
    """

    tolerance: float = float(np.finfo(float).eps)
    name: str = field(default="taylor", init=False)

    def integrate(
        self,
        motion: Motion,
        parameters: Sequence[float],
        start: tuple[float, Array],
        end: float,
        times: Array,
        guards: Sequence[Guard] = (),
    ) -> Arc:
        """Follow the motion; see `tippetop.integrators.base.Integrator`."""
        compiled = _compiled(motion, tuple(guards), self.tolerance)
        grid = np.union1d(times, (start[0], end))
        with compiled.lock:
            run = compiled.integrator
            run.time = start[0]
            run.state[:] = start[1]
            run.pars[:] = parameters
            if guards:
                run.reset_cooldowns()
            pieces, steps, outcome = _propagate(run, grid)
            end_time, end_state = float(run.time), np.array(run.state)
        states = np.concatenate(pieces)
        stopped = outcome != hy.taylor_outcome.time_limit
        failure = None
        if outcome == hy.taylor_outcome.err_nf_state:
            # The last step led nowhere; what is known ends with the last sample before it.
            failure = "the solution is no longer finite"
            states = states[np.isfinite(states).all(axis=1)] if len(states) else start[1][None]
            end_time, end_state = float(grid[len(states) - 1]), states[-1]
        wanted = np.searchsorted(grid, times)
        wanted = wanted[wanted < len(states)]
        return Arc(
            grid[wanted],
            states[wanted],
            end_time,
            end_state,
            guard=-int(outcome) - 1 if stopped and failure is None else None,
            failure=failure,
            steps=steps,
            evaluations=steps,
        )


@dataclass
class _Compiled:
    integrator: Any
    lock: threading.Lock = field(default_factory=threading.Lock)


@lru_cache(maxsize=32)
def _compiled(motion: Motion, guards: tuple[Guard, ...], tolerance: float) -> _Compiled:
    """Compile the equations and the guards, or fetch them from the cache across processes."""
    state = [hy.make_vars(f"y{i}") for i in range(motion.size)]
    parameters = [hy.par[i] for i in range(motion.parameters)]
    rates = [hy.expression(rate) for rate in motion.rates(state, parameters)]
    events = [
        hy.t_event(guard.value(state, parameters), direction=hy.event_direction.negative) for guard in guards
    ]
    with compiling():
        integrator = hy.taylor_adaptive(
            list(zip(state, rates, strict=True)),
            [0.0] * motion.size,
            pars=[1.0] * motion.parameters,
            tol=tolerance,
            t_events=events,
        )
    return _Compiled(integrator)


def _propagate(run: Any, grid: Array) -> tuple[list[Array], int, Any]:
    """Propagate over the grid, chunk by chunk; return states at grid points, steps and the outcome."""
    pieces: list[Array] = []
    steps, first = 0, 0
    while True:
        last = int(np.searchsorted(grid, grid[first] + CHUNK, side="right"))
        last = max(last, first + 2)
        outcome, _, _, taken, _, states = run.propagate_grid(grid[first:last])
        steps += taken
        finished = last >= len(grid) or outcome != hy.taylor_outcome.time_limit
        pieces.append(states if finished else states[:-1])
        if finished:
            return pieces, steps, outcome
        first = last - 1
