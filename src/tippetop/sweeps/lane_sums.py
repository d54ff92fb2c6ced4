"""Sums along launches that are followed together: position, angle about the axis, work and losses.

Lanes carry them as numbers after those of the state, in steps of sliding and of flying alike. Their
rates are those of a single run (`tippetop.results.sums`).
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from tippetop.contact.contact_mode import sliding_motion
from tippetop.contact.flight import SIZE, flight_motion
from tippetop.integrators.base import Array, Motion
from tippetop.mechanics.motion import air_power, on_table, sliding_contact
from tippetop.mechanics.quadratures import (
    nearer_pole,
    quadrature_rates,
    resistance_powers,
    turn_at_launch,
    turn_in_chart,
)
from tippetop.mechanics.state import SlidingState, State
from tippetop.mechanics.top import Kind, Top
from tippetop.mechanics.vectors import Scalar
from tippetop.results.sums import RunSums
from tippetop.sweeps.launch_arrays import Indices
from tippetop.sweeps.taylor_step import SLIDING

POLE = "pole"
"""Name of the pole of the chart of the angle about the axis, 1 or -1, which lanes carry with it."""

NEEDED_BY: Mapping[str, tuple[str, ...]] = {
    "x": ("x",),
    "y": ("y",),
    "orientation": ("turn", POLE),
    "work": ("work",),
    "sliding_loss": ("work", "struck"),
}
"""Sums that variables of `tippetop.results.samples.OF_SUMS` need beside those of every sweep."""


@dataclass(frozen=True)
class LaneSums:
    """The sums that lanes carry: some of `RunSums`, and `POLE`, in that order."""

    names: tuple[str, ...] = ()

    @classmethod
    def of(cls, kind: Kind, keep: Iterable[str] = ()) -> "LaneSums":
        """Return the sums that the metrics of tops of a kind need, and variables to keep."""
        field = kind.example.field
        needed = {name for variable in keep for name in NEEDED_BY.get(variable, ())}
        if not kind.example.torque_free:
            needed |= {"drilling", "rolling"}
        if field is not None and field.has_air:
            needed.add("air")
        if field is not None and field.slope is not None:
            needed |= {"x", "y"}
        return cls(tuple(name for name in (*RunSums._fields, POLE) if name in needed))

    @property
    def count(self) -> int:
        """How many there are."""
        return len(self.names)

    def rates(self, values: Mapping[str, Scalar]) -> list[Scalar]:
        """Return the rates of the sums, of which those that impacts alone change are zero."""
        return [values.get(name, 0.0) for name in self.names]

    def pole(self, sums: Sequence[Scalar] | Array) -> Scalar:
        """Return the pole among the numbers of the sums; 1 where no angle is carried."""
        return sums[self.names.index(POLE)] if POLE in self.names else 1.0

    def run_sums(self, sums: Sequence[Scalar] | Array) -> RunSums:
        """Return the sums by name from their numbers; 0 for those that are not carried."""
        values = dict(zip(self.names, sums, strict=True))
        return RunSums(*[values.get(name, 0.0) for name in RunSums._fields])

    def begin(self, axis: Array, sums: Array, azimuth: Array) -> None:
        """Set the angle about the axis at launch from the azimuth of the axis, rad, shape (n,)."""
        if POLE in self.names:
            pole = nearer_pole(axis[2])
            sums[self.names.index(POLE)] = pole
            sums[self.names.index("turn")] = turn_at_launch(azimuth, pole)

    def to_nearer_pole(self, axis: Array, sums: Array) -> None:
        """Take the angle about the axis to the chart of the nearer pole, where that is another.

        Axes have shape (3, n), and numbers of the sums (count, n).
        """
        if POLE not in self.names:
            return
        pole, turn = (sums[self.names.index(name)] for name in (POLE, "turn"))
        nearer = nearer_pole(axis[2])
        which = np.flatnonzero(nearer != pole)
        if len(which):
            azimuth = np.arctan2(axis[1, which], axis[0, which])
            turn[which] = turn_in_chart(turn[which], azimuth, pole[which], nearer[which])
            pole[which] = nearer[which]

    def strike(self, sums: Array, lanes: Indices, lost: Array) -> None:
        """Take in the energy that some lanes lose in impacts."""
        for name, sign in (("work", -1.0), ("struck", 1.0)):
            if name in self.names:
                sums[self.names.index(name), lanes] += sign * lost


NO_SUMS = LaneSums()
"""The sums of a lane that carries none."""


@lru_cache
def swept_motion(kind: Kind, sums: LaneSums) -> Motion:
    """Return the equations of motion of sliding tops of a kind, with the rates of sums."""

    def values_of(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> dict[str, Scalar]:
        top, sliding = kind.top(tuple(numbers)), SlidingState.unpack(y)
        touch = sliding_contact(*sliding, top)
        state = on_table(sliding, top)
        values = moving_rates(sums, state, top, sums.pole(y[SLIDING:]))
        if "work" in sums.names:
            values["work"] = touch.power
        if "drilling" in sums.names:
            drilling, rolling = resistance_powers(state, touch.traction.torque, top)
            values["drilling"] = touch.normal_force * drilling
            values["rolling"] = touch.normal_force * rolling
        return values

    return with_sums(sliding_motion(kind, guarded=True), sums, values_of)


@lru_cache
def flying_motion(kind: Kind, sums: LaneSums) -> Motion:
    """Return the equations of motion of flying tops of a kind, with the rates of sums."""

    def values_of(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> dict[str, Scalar]:
        top, pole = kind.top(tuple(numbers)), sums.pole(y[SIZE:])
        return moving_rates(sums, State.unpack(y), top, pole)

    return with_sums(flight_motion(kind), sums, values_of)


def with_sums(
    motion: Motion,
    sums: LaneSums,
    values_of: Callable[[Sequence[Scalar], Sequence[Scalar]], Mapping[str, Scalar]],
) -> Motion:
    """Return a motion that carries sums after its own numbers; `values_of` has their rates."""
    if not sums.count:
        return motion

    def rates(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> tuple[Scalar, ...]:
        return (*motion.rates(y, numbers), *sums.rates(values_of(y, numbers)))

    return replace(motion, rates=rates, size=motion.size + sums.count)


def moving_rates(sums: LaneSums, state: State, top: Top, pole: Scalar) -> dict[str, Scalar]:
    """Return the rates of sums that change without the table's force, by name."""
    moved = quadrature_rates(state, 0.0, pole, top)
    values: dict[str, Scalar] = {"x": moved.x, "y": moved.y, "turn": moved.turn}
    if "air" in sums.names:
        values["air"] = air_power(state.axis, state.momentum, state.velocity, top)
    return values
