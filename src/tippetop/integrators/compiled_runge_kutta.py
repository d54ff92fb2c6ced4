"""Dormand and Prince's method of order 8(5,3), compiled by numba; what it follows, by LLVM."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cache, lru_cache
from inspect import getsource
from typing import Any, ClassVar

import numpy as np
from numba import types

from tippetop.graph.recording import recordable
from tippetop.integrators import dormand_prince, numba_calls
from tippetop.integrators.base import Arc, Array, Motion
from tippetop.integrators.dormand_prince import LOOKS
from tippetop.integrators.machine_code import machine_code
from tippetop.integrators.numba_cache import compiled
from tippetop.integrators.scipy_methods import SciPy
from tippetop.integrators.stepping import Machinery, stepped
from tippetop.integrators.tableau import written_out
from tippetop.mechanics.vectors import Scalar

ABREAST = 8
"""Numbers of a state an instruction: rows of them are filled up with zeros to multiples."""

ROW = types.float64[::1]
ADVANCE = types.UniTuple(types.int64, 3)(  # type: ignore[no-untyped-call]
    types.UniTuple(types.int64, 1),  # type: ignore[no-untyped-call]
    types.UniTuple(types.int64, 2),  # type: ignore[no-untyped-call]
    types.int64,
    *[ROW] * 3,
    types.float64[:, ::1],
    *[ROW] * 4,
    *[types.int64] * 2,
)
WITHIN = types.void(ROW, types.int64, types.float64, ROW)
"""What the functions of `dormand_prince` take; a motion's functions are the addresses of their
code.
"""


@dataclass(frozen=True)
class CompiledRungeKutta:
    """SciPy's DOP853, compiled: the same steps, with compensated sums, and the same guards.

    A motion that cannot be recorded (see `tippetop.graph.recording`) is left to SciPy.
    """

    tolerance: float
    """Relative and absolute error per step."""
    name: str = field(default="compiled", init=False)
    caution: ClassVar[str] = ""

    def integrate(
        self, motion: Motion, parameters: Sequence[float], start: tuple[float, Array], end: float
    ) -> Iterator[Arc]:
        """Follow the motion; see `tippetop.integrators.base.Integrator`."""
        functions = _compiled(motion)
        if functions is None:
            yield from SciPy("dop853", self.tolerance).integrate(motion, parameters, start, end)
            return
        known = [float(number) for number in parameters]
        numbers = [*known, *np.repeat(known, LOOKS)]
        yield from stepped(motion, functions, numbers, start, end, self.tolerance)


@lru_cache(maxsize=64)
def _compiled(motion: Motion) -> Machinery | None:
    """A motion's functions; None where they cannot be recorded."""

    def all_guards(y: Sequence[Scalar], p: Sequence[Scalar]) -> list[Scalar]:
        return [guard.value(y, p) for guard in motion.guards]

    rates = recordable(motion.rates, motion.size, motion.parameters)
    guards = recordable(all_guards, motion.size, motion.parameters)
    if rates is None or guards is None:
        return None
    one = machine_code({"rates": rates, "guards": guards})
    several = machine_code({"guards": guards}, LOOKS)
    width = -(-motion.size // ABREAST) * ABREAST
    method = _method(width)
    addresses = (one["rates"].address,), (one["guards"].address, several["guards"].address)
    numbers = len(motion.guards), width
    return Machinery(
        method["advance"], method["within"], *addresses, *numbers, one["guards"], several
    )


@cache
def _method(width: int) -> dict[str, Any]:
    """What the method is, compiled for rows of so many numbers."""
    parts = getsource(dormand_prince), written_out(), getsource(numba_calls)
    source = "\n".join([*parts, f"WIDTH = {width}"])
    return compiled(source, {"advance": ADVANCE, "within": WITHIN})
