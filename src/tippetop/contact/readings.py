"""What is read off the numbers of a mode, at many instants at once: by arrays, or compiled."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import lru_cache
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from tippetop.contact.conditions import least
from tippetop.contact.lowest_surface import lowest_contact_vector
from tippetop.contact.mode import IntegratedMode, Mode, Reaction
from tippetop.integrators.base import Array, Rows
from tippetop.integrators.evaluation import Evaluation, compiled_evaluation
from tippetop.mechanics.invariants import energy
from tippetop.mechanics.motion import air_power, angular_velocity, axial_spin, point_velocity
from tippetop.mechanics.quadratures import quadrature_rates, resistance_powers
from tippetop.mechanics.state import State
from tippetop.mechanics.surfaces.hull import Hull, lowest_gap
from tippetop.mechanics.top import Kind
from tippetop.mechanics.vectors import Horizontal, Row, Scalar, Vector, dot
from tippetop.mechanics.view import precession_rate, slip_along_tilt, tilt_rate

WORTH = 1000
"""Instants from which on a compiled function is asked for, which takes hundredths of a second to
load.
"""


class Rates(NamedTuple):
    """What is integrated along a motion, as rates, and what its extremes are looked for of."""

    x: Scalar
    y: Scalar
    turn: Scalar
    work: Scalar
    """Rates of the quadratures."""
    drilling: Scalar
    rolling: Scalar
    """Powers of drilling and of rolling friction."""
    air: Scalar
    """Power of air."""
    axis: Scalar
    """n_z."""
    force: Scalar
    """Normal force."""
    margin: Scalar
    """Least of `conditions`."""

    @classmethod
    def of(cls, mode: Mode, y: Row, pole: Scalar) -> "Rates":
        """Read them off the numbers of a mode, with the angle about the axis in the chart of a
        pole.
        """
        state, reaction = mode.state(y), mode.reaction(y)
        east, north, turn, work = quadrature_rates(state, reaction.power, pole, mode.top)
        drilling = rolling = 0.0
        if not mode.torque_free:
            drilling, rolling = resistance_powers(state, reaction.resistance, mode.top)
        air = air_power(state.axis, state.momentum, state.velocity, mode.top)
        quadratures = east, north, turn, work, drilling, rolling, air
        margin = least([one for one in conditions_of(mode, state, reaction) if one is not None])
        return cls(*quadratures, state.axis[2], reaction.force[2], margin)


def conditions_of(mode: Mode, state: State, reaction: Reaction) -> tuple[Scalar | None, ...]:
    """Return what is nowhere negative while a mode goes on.

    That is the gap of the lowest surface, where it may be below the table; the least normal force
    of several contacts; and the least reserve of what friction holds. None where there is none.
    """
    surface = mode.top.surface
    may_sink = not mode.touching or isinstance(surface, Hull)
    gap = lowest_gap(state.axis, state.height, surface) if may_sink else None
    return gap, reaction.pressing, reaction.reserve


def conditions(mode: Mode, y: Row) -> tuple[Scalar, ...]:
    """Return `conditions_of` the numbers of a mode, 0 where there is none."""
    values = conditions_of(mode, mode.state(y), mode.reaction(y))
    return tuple([0.0 if value is None else value for value in values])


class Instants(NamedTuple):
    """What is told of an instant."""

    state: State
    force: Vector
    torque: Vector
    """Force of the table, and its torque about the contact point."""
    energy: Scalar
    jellett: Scalar
    """Jellett's integral about the lowest point."""
    gap: Scalar
    """Height of the lowest point."""
    spin: Scalar
    """omega3."""
    precession: Scalar
    tilting: Scalar
    """phi' and theta', which are not numbers where the axis is vertical."""
    slip: Horizontal
    """Slip velocity along the direction into which the axis leans, and across; there not a number
    either.
    """
    point: Horizontal
    """Horizontal velocity of the lowest point along the space axes."""

    @classmethod
    def of(cls, mode: Mode, y: Row) -> "Instants":
        """Read them off the numbers of a mode."""
        state, reaction, top = mode.state(y), mode.reaction(y), mode.top
        axis, momentum = state.axis, state.momentum
        arm = lowest_contact_vector(axis, top.surface)
        x, y, _ = point_velocity(state.velocity, angular_velocity(axis, momentum, top), arm)
        return cls(
            state,
            reaction.force,
            reaction.torque,
            energy(state, top),
            -dot(momentum, arm),
            state.height + arm[2],
            axial_spin(axis, momentum, top),
            precession_rate(axis, momentum, top),
            tilt_rate(axis, momentum, top),
            slip_along_tilt(axis, (x, y)),
            (x, y),
        )

    def pack(self) -> tuple[Scalar, ...]:
        """Return the numbers in the order of the attributes."""
        numbers = self.energy, self.jellett, self.gap, self.spin, self.precession, self.tilting
        return (*self.state.pack(), *self.force, *self.torque, *numbers, *self.slip, *self.point)

    @classmethod
    def unpack(cls, rows: Row) -> "Instants":
        """Read them from their numbers."""
        force, torque = (rows[10], rows[11], rows[12]), (rows[13], rows[14], rows[15])
        slip, point = (rows[22], rows[23]), (rows[24], rows[25])
        numbers = rows[16], rows[17], rows[18], rows[19], rows[20], rows[21]
        return cls(State.unpack(rows), force, torque, *numbers, slip, point)


TOLD = 26
"""How many numbers that are."""

Reading: TypeAlias = Callable[..., Sequence[Scalar]]
"""From a mode, its numbers and further ones to numbers, in plain operators."""


def normal_force(mode: Mode, y: Row) -> tuple[Scalar]:
    """Return the normal force."""
    return (mode.reaction(y).force[2],)


def instants(mode: Mode, y: Row) -> tuple[Scalar, ...]:
    """Return the numbers of `Instants`."""
    return Instants.of(mode, y).pack()


# translate: skip
def read(reading: Reading, mode: Mode, y: Array, *others: Scalar, total: int = 0) -> Array:
    """Read numbers off those of a mode.

    Parameters
    ----------
    reading
        What to read.
    mode
        The mode.
    y
        Its numbers, shape (size, ...).
    others
        Further numbers that the reading takes, each of a shape that becomes that of the instants.
    total
        How many instants are read in all, of which these may be a part: of many by a compiled
        function.

    Returns
    -------
    ndarray
        Shape (numbers, ...).
    """
    is_worth = is_compiled(mode, total)
    evaluation = _compiled(reading, mode, len(y), len(others)) if is_worth else None
    if evaluation is not None:
        return evaluation(y, (*mode.top.numbers, *others))
    with np.errstate(divide="ignore", invalid="ignore"):
        rows = reading(mode, y, *others)
    values = np.empty((len(rows), *y.shape[1:]))
    for place, row in zip(values, rows, strict=True):
        place[...] = row
    return values


# translate: skip
def read_of_kind(reading: Reading, mode: Mode, kind: Kind, y: Array) -> Array:
    """Read numbers off those of a mode of many tops of a kind, one an instant.

    Parameters
    ----------
    reading
        What to read.
    mode
        The mode, with arrays of shape (n,) for the numbers of its top.
    kind
        The kind of its top.
    y
        Its numbers, shape (size, n).

    Returns
    -------
    ndarray
        Shape (numbers, n).
    """
    evaluation = compiled_evaluation(_of_kind(reading, topless(mode), kind), len(y), kind.numbers)
    if evaluation is not None:
        return evaluation(y, mode.top.numbers)
    with np.errstate(all="ignore"):
        rows = reading(mode, list(y))
    return np.array(np.broadcast_arrays(*rows, y[0])[:-1])


# translate: skip
def is_compiled(mode: Mode, total: int) -> bool:
    """Return whether readings of a mode at so many instants are compiled."""
    if total < WORTH or not isinstance(mode, IntegratedMode) or not mode.lasting:
        return False
    return len(mode.tops) == 1 and not isinstance(mode.top.surface, Hull)


# translate: skip
def _compiled(reading: Reading, mode: Any, size: int, others: int) -> Evaluation | None:
    """Return the compiled reading of modes of this kind; None where it cannot be compiled."""
    kind = mode.top.kind
    return compiled_evaluation(_of_kind(reading, topless(mode), kind), size, kind.numbers + others)


# translate: skip
def topless(mode: Any) -> Any:
    """Return a mode of one top without it, but with its other parameters, which readings need."""
    no_top: Any = None
    return replace(mode, top=no_top)


# translate: skip
@lru_cache
def _of_kind(reading: Reading, form: Any, kind: Kind) -> Rows:
    """Return a reading as a function of the numbers of a mode and of its top."""

    def values(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> Sequence[Scalar]:
        top = kind.top(tuple(numbers[: kind.numbers]))
        return reading(form.on_tops((top,)), y, *numbers[kind.numbers :])

    return values
