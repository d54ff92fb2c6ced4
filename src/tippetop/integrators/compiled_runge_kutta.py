"""Dormand and Prince's method of order 8(5,3), compiled by numba once for every kind of motion."""

import inspect
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cache, lru_cache
from typing import Any, NamedTuple

import numpy as np
from numba import types

from tippetop.emit.python import python_source
from tippetop.emit.recording import record
from tippetop.integrators import dormand_prince as loop
from tippetop.integrators.base import Arc, Array, Guard, Motion
from tippetop.integrators.dense import DenseSolution
from tippetop.integrators.numba_cache import compiled
from tippetop.integrators.sampling import first_fall, polish
from tippetop.integrators.scipy_methods import MANY, SciPy
from tippetop.mechanics.vectors import Scalar

ROW = types.float64[::1]
FUNCTION = types.void(ROW, ROW, ROW)
ADVANCE = types.UniTuple(types.int64, 3)(  # type: ignore[no-untyped-call]
    types.FunctionType(FUNCTION),
    types.FunctionType(FUNCTION),
    types.int64,
    *[ROW] * 3,
    types.float64[:, ::1],
    *[ROW] * 3,
    types.float64[:, :, ::1],
)
"""What the functions take: a motion's, and `dormand_prince.advance`."""

DEGREE = 7
"""Degree of the dense output."""

FAILURES = {
    loop.SINGULAR: "the motion is singular from the start",
    loop.STUCK: "the step size fell to nothing",
}
"""Why there may be no solution, or no more of it."""


@dataclass(frozen=True)
class CompiledRungeKutta:
    """SciPy's DOP853, compiled: the same steps, with compensated sums, and the same guards.

    A motion that cannot be recorded (see `tippetop.emit.recording`) is left to SciPy.

    Attributes
    ----------
    tolerance
        Relative and absolute error per step.
    """

    tolerance: float
    name: str = field(default="compiled", init=False)

    def integrate(
        self, motion: Motion, parameters: Sequence[float], start: tuple[float, Array], end: float
    ) -> Iterator[Arc]:
        """Follow the motion; see `tippetop.integrators.base.Integrator`."""
        functions = _compiled(motion)
        if functions is None:
            yield from SciPy("dop853", self.tolerance).integrate(motion, parameters, start, end)
            return
        integration = _Integration(functions, np.array(parameters, dtype=float), start, end, self.tolerance)
        while integration.time < end:
            ended = integration.advance()
            fall = integration.fall(motion.guards) if ended == loop.SUSPECT else None
            if fall is not None:
                yield integration.arc(guard=integration.end_at(*fall))
                return
            if ended in FAILURES:
                yield integration.arc(failure=FAILURES[ended])
                return
            if integration.is_full or integration.time >= end:
                yield integration.arc()


class _Address(types.WrapperAddressProtocol):
    """A compiled function as others take it, who would else ask it every time where it is."""

    def __init__(self, function: Any) -> None:
        found = function.get_compile_result(FUNCTION)
        self.address = found.library.get_pointer_to_function(found.fndesc.llvm_cfunc_wrapper_name)

    def __wrapper_address__(self) -> int:
        return int(self.address)

    def signature(self) -> Any:
        """What the function takes and gives."""
        return FUNCTION


class _Functions(NamedTuple):
    """A motion's rates and guards, compiled, how many guards there are, and the guards for Python."""

    rates: _Address
    guards: _Address
    number: int
    called: Any

    def guard(self, guard: Guard, number: int) -> Guard:
        """A guard that is evaluated by the compiled function."""

        def value(y: Sequence[Scalar], p: Sequence[Scalar]) -> Scalar:
            found = np.empty(self.number)
            self.called(np.array(y), p, found)
            return found[number]

        return Guard(guard.name, value)


class _Integration:
    """A motion under way: the state, and the steps of the arc that is being made."""

    def __init__(
        self,
        functions: _Functions,
        parameters: Array,
        start: tuple[float, Array],
        end: float,
        tolerance: float,
    ) -> None:
        self.functions, self.parameters, self.tolerance = functions, parameters, np.full(2, tolerance)
        self.state, self.lost = np.array(start[1], dtype=float), np.zeros(len(start[1]))
        self.stages = np.empty((16, len(self.state)))
        self.span = np.array([start[0], end, 0.0])
        self.knots, self.terms = np.empty(MANY + 1), np.empty((MANY, DEGREE + 1, len(self.state)))
        self.knots[0], self.steps, self.calls = start[0], 0, 0

    @property
    def time(self) -> float:
        """Where it is."""
        return float(self.span[0])

    @property
    def is_full(self) -> bool:
        """Whether the arc has as many steps as it may."""
        return self.steps == MANY

    def advance(self, *, guarded: bool = True) -> int:
        """Take steps until something is to be done; tell what."""
        rates, guards, count, _ = self.functions
        room = self.knots[self.steps :], self.terms[self.steps :]
        motion = rates, guards, count if guarded else 0, self.parameters
        work = self.state, self.lost, self.stages, self.span, self.tolerance
        steps, calls, ended = _advance()(*motion, *work, *room)
        self.steps += steps
        self.calls += calls
        return int(ended)

    def arc(self, guard: str | None = None, failure: str | None = None) -> Arc:
        """The arc that has been made; the next one begins."""
        terms = np.ascontiguousarray(np.swapaxes(self.terms[: self.steps], 1, 2))
        solution = DenseSolution(self.knots[: self.steps + 1].copy(), terms)
        arc = Arc(solution, self.state.copy(), guard, failure, self.steps, self.calls)
        self.knots[0], self.steps, self.calls = self.time, 0, 0
        return arc

    def fall(self, guards: Sequence[Guard]) -> tuple[Guard, float, Array] | None:
        """The guard that first falls through zero in the last step, when, and the state there."""
        numbers: Any = self.parameters
        last, step = self.terms[self.steps - 1], (float(self.knots[self.steps - 1]), self.time)

        def dense(at: float) -> Array:
            found: Array = _powers((at - step[0]) / (step[1] - step[0])) @ last
            return found

        def advance(at: float) -> Array:
            return self._landed(step[0], last[0], at)

        guards = [self.functions.guard(guard, number) for number, guard in enumerate(guards)]
        found = first_fall(guards, numbers, dense, advance, step)
        if found is None:
            return None
        return guards[found[0]], *polish(guards[found[0]], numbers, advance, step, found[1])

    def end_at(self, guard: Guard, time: float, state: Array) -> str:
        """End within the last step; return the name of the guard that ended it."""
        start, end = self.knots[self.steps - 1 : self.steps + 1]
        self.terms[self.steps - 1] *= _powers((time - start) / (end - start))[:, None]
        self.knots[self.steps] = self.span[0] = time
        self.state = state
        return guard.name

    def _landed(self, time: float, state: Array, end: float) -> Array:
        """The state after steps that end at exactly this time."""
        if end <= time:
            return np.array(state)
        integration = _Integration(
            self.functions, self.parameters, (time, state), end, float(self.tolerance[0])
        )
        while integration.advance(guarded=False) == loop.FULL:
            integration.steps = 0
        return integration.state


def _powers(part: float) -> Array:
    return np.asarray(part ** np.arange(DEGREE + 1.0))


@lru_cache(maxsize=64)
def _compiled(motion: Motion) -> _Functions | None:
    """A motion's functions; None where they cannot be recorded."""

    def guards(y: Sequence[Scalar], p: Sequence[Scalar]) -> list[Scalar]:
        return [guard.value(y, p) for guard in motion.guards]

    functions: dict[str, Any] = {"rates": motion.rates} | ({"guards": guards} if motion.guards else {})
    try:
        sources = [
            python_source(record(function, motion.size, motion.parameters), name)
            for name, function in functions.items()
        ]
    except (TypeError, ValueError, ArithmeticError, AttributeError):
        return None
    found = compiled("\n\n".join(sources), dict.fromkeys(functions, FUNCTION))
    rates, guarding = found["rates"], found.get("guards", found["rates"])
    return _Functions(_Address(rates), _Address(guarding), len(motion.guards), guarding)


@cache
def _advance() -> Any:
    """`dormand_prince.advance`, compiled."""
    return compiled(inspect.getsource(loop) + loop.written_out(), {"advance": ADVANCE})["advance"]
