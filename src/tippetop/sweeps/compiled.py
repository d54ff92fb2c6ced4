"""Steps of Taylor's method compiled by LLVM."""

from collections.abc import Sequence

import numpy as np

from tippetop.emit.coefficients import NodeArithmetic
from tippetop.emit.llvm import ABREAST
from tippetop.emit.recording import Recorded, record
from tippetop.integrators.base import Array, Motion
from tippetop.integrators.machine_code import Compiled, machine_code
from tippetop.mechanics.vectors import Scalar
from tippetop.sweeps.stride import LANES, Jet, Layout, motion_series, stride

NODES = NodeArithmetic()


class CompiledStepper:
    """Taylor's method as a pair of compiled functions; see `tippetop.sweeps.stride.Stepper`."""

    def __init__(self, motion: Motion, order: int) -> None:
        self.motion, self.order, self.layout = motion, order, Layout.of(motion)
        self._step: Compiled | None = None
        self._jet: Compiled | None = None

    def step(self, before: Array, after: Array, numbers: Array) -> None:
        """Take a step."""
        layout = self.layout
        if self._step is None:
            self._step = _compiled(record(self._rows, layout.kept, layout.numbers))
        self._step(before[: layout.kept], numbers, after)

    def jet(self, before: Array, numbers: Array) -> Jet:
        """The polynomials of the steps."""
        layout, order = self.layout, self.order
        if self._jet is None:
            self._jet = _compiled(record(self._jet_rows, layout.size, layout.parameters), effort=0)
        count = before.shape[1]
        start, given = padded(before[: layout.size]), padded(numbers[: layout.parameters])
        cut = layout.size * (order + 1)
        values = np.empty((cut + layout.guards * order, start.shape[1]))
        self._jet(start, given, values)
        guards = values[cut:, :count].reshape(layout.guards, order, count)
        return Jet(values[:cut, :count].reshape(layout.size, order + 1, count), guards)

    def _rows(self, before: Sequence[Scalar], numbers: Sequence[Scalar]) -> list[Scalar]:
        return stride(self.motion, self.order, before, numbers, NODES)

    def _jet_rows(self, start: Sequence[Scalar], numbers: Sequence[Scalar]) -> list[Scalar]:
        y, guards = motion_series(self.motion, start, numbers, NODES)
        rows = [series[k] for series in y for k in range(self.order + 1)]
        return rows + [guard[k] for guard in guards for k in range(self.order)]


def _compiled(recorded: Recorded, **options: int) -> Compiled:
    return machine_code({"made": recorded}, ABREAST, **options)["made"]


def padded(rows: Array) -> Array:
    """Rows filled up with copies of their last number to a multiple of `LANES`."""
    missing = -rows.shape[1] % LANES
    return np.ascontiguousarray(np.pad(rows, ((0, 0), (0, missing)), mode="edge"))
