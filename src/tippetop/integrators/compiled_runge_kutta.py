"""Dormand and Prince's method of order 8(5,3), compiled by numba; what it follows, by LLVM."""

import inspect
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cache, lru_cache
from typing import Any

from numba import types

from tippetop.emit.recording import record
from tippetop.integrators import dormand_prince as loop
from tippetop.integrators.base import Arc, Array, Motion
from tippetop.integrators.machine_code import Compiled, machine_code
from tippetop.integrators.numba_cache import compiled
from tippetop.integrators.scipy_methods import SciPy
from tippetop.integrators.stepping import Machinery, stepped
from tippetop.mechanics.vectors import Scalar

ROW = types.float64[::1]
PLACE = types.CPointer(types.float64)  # type: ignore[no-untyped-call]
FUNCTION = types.void(*[PLACE] * 3, types.int64)
ADVANCE = types.UniTuple(types.int64, 3)(  # type: ignore[no-untyped-call]
    types.FunctionType(FUNCTION),
    types.FunctionType(FUNCTION),
    types.int64,
    *[ROW] * 3,
    types.float64[:, ::1],
    *[ROW] * 4,
    types.int64,
)
WITHIN = types.void(ROW, types.int64, types.float64, ROW)
"""What the functions take: a motion's, and those of `dormand_prince`."""

CALLED = """
import numba

@numba.njit(inline="always")
def evaluate(function, y, p, out):
    function(y.ctypes, p.ctypes, out.ctypes, 1)
"""
"""How functions are called that LLVM compiled."""


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
    """Where a compiled function is, for others that are compiled."""

    def __init__(self, function: Compiled) -> None:
        self.function = function

    def __wrapper_address__(self) -> int:
        return int(self.function.address)

    def signature(self) -> Any:
        """What the function takes and gives."""
        return FUNCTION


@lru_cache(maxsize=64)
def _compiled(motion: Motion) -> Machinery | None:
    """A motion's functions; None where they cannot be recorded."""

    def guards(y: Sequence[Scalar], p: Sequence[Scalar]) -> list[Scalar]:
        return [guard.value(y, p) for guard in motion.guards]

    try:
        recorded = {
            name: record(function, motion.size, motion.parameters)
            for name, function in {"rates": motion.rates, "guards": guards}.items()
        }
    except (TypeError, ValueError, ArithmeticError, AttributeError):
        return None
    found, method = machine_code(recorded), _method()
    addresses = _Address(found["rates"]), _Address(found["guards"])
    return Machinery(method["advance"], method["within"], *addresses, len(motion.guards), found["guards"])


@cache
def _method() -> dict[str, Any]:
    """What the method is, compiled."""
    source = inspect.getsource(loop) + loop.written_out() + CALLED
    return compiled(source, {"advance": ADVANCE, "within": WITHIN})
