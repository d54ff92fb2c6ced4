"""The page's method, Dormand and Prince's, run as the Python that it is translated from."""

import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from inspect import getsource
from types import ModuleType

from tippetop.graph.recording import record
from tippetop.integrators import Arc, Motion, dormand_prince
from tippetop.integrators.base import Array
from tippetop.integrators.machine_code import machine_code
from tippetop.integrators.stepping import Machinery, stepped
from tippetop.integrators.tableau import written_out
from tippetop.mechanics.vectors import Scalar


@cache
def method() -> ModuleType:
    """The method with its coefficients written out."""
    module = ModuleType("dormand_prince_written_out")
    sys.modules[module.__name__] = module
    exec("\n".join([getsource(dormand_prince), written_out()]), module.__dict__)
    return module


@dataclass(frozen=True)
class PageMethod:
    """The page's integrator; rates and guards are compiled."""

    tolerance: float = 1e-13
    name: str = "page"
    caution: str = ""

    def integrate(
        self, motion: Motion, parameters: Sequence[float], start: tuple[float, Array], end: float
    ) -> Iterator[Arc]:
        """Follow the motion."""

        def all_guards(y: Sequence[Scalar], p: Sequence[Scalar]) -> list[Scalar]:
            return [guard.value(y, p) for guard in motion.guards]

        code = machine_code(
            {
                "rates": record(motion.rates, motion.size, motion.parameters),
                "guards": record(all_guards, motion.size, motion.parameters),
            }
        )
        functions = Machinery(
            method().advance,
            method().within,
            code["rates"],
            code["guards"],
            len(motion.guards),
            motion.size,
            code["guards"],
        )
        numbers = [float(number) for number in parameters]
        begin = start[0], start[1].astype(float)
        yield from stepped(motion, functions, numbers, begin, end, self.tolerance)
