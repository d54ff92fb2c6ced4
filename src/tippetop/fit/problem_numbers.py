"""The numbers that a run starts from, and their derivatives with respect to fields of a problem."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from tippetop.contact.natural_launch import NaturalLaunch
from tippetop.integrators.base import Array
from tippetop.mechanics.natural_units import Units
from tippetop.mechanics.state import State
from tippetop.mechanics.top import Kind, Top, natural_units
from tippetop.problem.problem import Problem, top_of
from tippetop.support.errors import InvalidInput, is_number
from tippetop.support.units import exponents_of

SMALLEST_SCALE = 0.01
"""Least scale of a number, in natural units: numbers such as a rate at launch may be zero."""

STEP = 1e-3
"""Step of the differences of a problem's numbers, relative to the scale of a field.

The formulae from a problem to its numbers are algebraic: at this step the fourth-order rule leaves
out less than the rounding, 1e-13, that a shorter step would multiply.
"""

CENTRAL = ((-2, 1), (-1, -8), (1, 8), (2, -1))
"""Fourth-order rule for a first derivative: steps, and weights over 12."""

FORWARD = ((0, -25), (1, 48), (2, -36), (3, 16), (4, -3))
"""The same on one side, where the field is at its bound."""

BACKWARD = tuple((-step, -weight) for step, weight in FORWARD)


@dataclass(frozen=True)
class StartNumbers:
    """What a run starts from, in natural units; or derivatives of that."""

    top: Array
    """The numbers of the top (see `tippetop.mechanics.top.Top.numbers`)."""
    state: Array
    """The ten numbers of the state at launch."""
    units: Array
    """Units of mass, length and time, SI."""
    azimuth: float
    """Direction into which the axis leans, rad."""
    restitution: float
    """Ratio of the impulses of restitution and compression."""

    @classmethod
    def of(cls, problem: Problem) -> "StartNumbers":
        """Return the numbers of a problem."""
        launch = NaturalLaunch.of(problem)
        return cls(
            np.array(launch.top.numbers, dtype=float),
            np.array(launch.state.pack(), dtype=float),
            np.array(launch.units, dtype=float),
            launch.azimuth,
            float(problem.contact.restitution),
        )

    @classmethod
    def unpack(cls, row: Array, top_numbers: int) -> "StartNumbers":
        """Return the numbers from a row of them."""
        ends = np.cumsum([top_numbers, 10, 3])
        top, state, units, last = np.split(row, ends)
        return cls(top, state, units, float(last[0]), float(last[1]))

    def pack(self) -> Array:
        """Return all of them in a row."""
        return np.concatenate([self.top, self.state, self.units, [self.azimuth, self.restitution]])

    def moved(self, rates: "StartNumbers", change: float) -> "StartNumbers":
        """Return the numbers after a change along derivatives."""
        return StartNumbers.unpack(self.pack() + change * rates.pack(), len(self.top))

    def top_of(self, kind: Kind) -> Top:
        """Return the top of a kind with these numbers."""
        return kind.top(tuple(self.top.tolist()))

    @property
    def start(self) -> State:
        """The state at launch."""
        return State.unpack(self.state.tolist())

    @property
    def natural_units(self) -> Units:
        """The natural units."""
        return Units(*self.units.tolist())


def require_fields(problem: Problem, fields: Sequence[str], argument: str) -> None:
    """Refuse, with `InvalidInput`, names that are no fields with a number."""
    for field in fields:
        try:
            number = problem.get(field)
        except InvalidInput as error:
            raise InvalidInput(argument, field, error.accepted, hint=error.hint) from None
        if not is_number(number):
            accepted = "the name of a field with a number, such as friction.mu"
            raise InvalidInput(argument, field, accepted)


def scale_of(problem: Problem, field: str, number: float | None = None) -> float:
    """Return the size of a field by which its changes are measured, SI: its own, or, where that is
    small, `SMALLEST_SCALE` of its natural unit.
    """
    natural = natural_size(problem.quantity(field).units, natural_units(top_of(problem)))
    value = float(problem.get(field)) if number is None else number
    return float(max(abs(value), SMALLEST_SCALE * natural))


def natural_size(si: str, units: Units) -> float:
    """Return the natural unit of what is measured in an SI unit, in that."""
    if si in ("", "1"):
        return 1.0
    length, mass, time, _ = exponents_of(si)
    return float(units.length**length * units.mass**mass * units.time**time)


@dataclass(frozen=True)
class Direction:
    """A field of a problem, and how the numbers of the problem move with it."""

    field: str
    scale: float
    """Change of the field, SI, by which the numbers move as `rates` says."""
    rates: StartNumbers
    """Derivatives of the numbers, times the scale."""

    @classmethod
    def of(cls, problem: Problem, field: str) -> "Direction":
        """Return the direction of a field, by its own scale."""
        scale = scale_of(problem, field)
        slopes = derivatives(problem, field)
        return cls(field, scale, StartNumbers.unpack(scale * slopes.pack(), len(slopes.top)))

    def without_motion(self) -> "Direction":
        """Return the direction of a field by the same scale along which no number moves."""
        row = np.zeros_like(self.rates.pack())
        return replace(self, rates=StartNumbers.unpack(row, len(self.rates.top)))

    def beside(self, problem: Problem, change: float) -> Problem | None:
        """Return the problem after a change of the field; None where there is no such problem.

        Where no number moves it is the problem itself.
        """
        if not self.rates.pack().any():
            return problem
        value = float(problem.get(self.field)) + change * self.scale
        try:
            return problem.replace({self.field: value})
        except InvalidInput:
            return None


def derivatives(problem: Problem, field: str) -> StartNumbers:
    """Return the derivatives of the numbers of a problem with respect to a field.

    They are differences of fourth order of the formulae from problem to numbers, not of runs; they
    are one-sided where the field is at its bound.

    Raises
    ------
    InvalidInput
        If the problem has no neighbours with other values of the field.
    """
    value, step = float(problem.get(field)), STEP * scale_of(problem, field)

    def numbers(change: float) -> Array:
        return StartNumbers.of(problem.replace({field: value + change})).pack()

    size = len(StartNumbers.of(problem).top)
    for rule in (CENTRAL, FORWARD, BACKWARD):
        slopes = _difference(numbers, rule, step)
        if slopes is not None:
            return StartNumbers.unpack(slopes, size)
    accepted = "a field that may be changed by a thousandth of its value"
    raise InvalidInput("vary", field, accepted)


def _difference(
    numbers: Callable[[float], Array], rule: Sequence[tuple[int, int]], step: float
) -> Array | None:
    """Return a derivative by a rule; None where a problem that the rule needs is refused."""
    try:
        rows = [weight * numbers(place * step) for place, weight in rule]
    except InvalidInput:
        return None
    if any(len(row) != len(rows[0]) for row in rows):
        return None
    return np.asarray(np.sum(rows, axis=0) / (12.0 * step))
