"""Dormand and Prince's method of order 8(5,3), compiled by numba once for every kind of motion."""

import inspect
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cache, lru_cache
from typing import Any

from numba import types

from tippetop.emit.python import python_source
from tippetop.emit.recording import record
from tippetop.integrators import dormand_prince as loop
from tippetop.integrators.base import Arc, Array, Motion
from tippetop.integrators.numba_cache import compiled
from tippetop.integrators.scipy_methods import SciPy
from tippetop.integrators.stepping import Machinery, stepped
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
    types.int64,
)
WITHIN = types.void(types.float64[:, ::1], types.float64, ROW)
"""What the functions take: a motion's, and those of `dormand_prince`."""


@dataclass(frozen=True)
class CompiledRungeKutta:
    """SciPy's DOP853, compiled: the same steps, with compensated sums, and the same guards.

    A motion that cannot be recorded (see `tippetop.emit.recording`) is left to SciPy.
    """

    tolerance: float
    """Relative and absolute error per step."""
    name: str = field(default="compiled", init=False)

    def integrate(
        self, motion: Motion, parameters: Sequence[float], start: tuple[float, Array], end: float
    ) -> Iterator[Arc]:
        """Follow the motion; see `tippetop.integrators.base.Integrator`."""
        functions = _compiled(motion)
        if functions is None:
            yield from SciPy("dop853", self.tolerance).integrate(motion, parameters, start, end)
            return
        yield from stepped(motion, functions, parameters, start, end, self.tolerance)


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


@lru_cache(maxsize=64)
def _compiled(motion: Motion) -> Machinery | None:
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
    method = _method()
    addresses = _Address(rates), _Address(guarding)
    return Machinery(method["advance"], method["within"], *addresses, len(motion.guards), guarding)


@cache
def _method() -> dict[str, Any]:
    """What the method is, compiled."""
    return compiled(inspect.getsource(loop) + loop.written_out(), {"advance": ADVANCE, "within": WITHIN})
