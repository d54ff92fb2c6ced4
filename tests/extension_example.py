"""A friction law, a surface, a contact mode and an integrator that use only public names.

`test_extensions` runs them, and mypy checks their types, as those of any project that extends the
package.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Annotated, ClassVar, Literal, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

import tippetop as tt
from tippetop.extend import (
    NO_TORQUE,
    Arc,
    Automaton,
    Contact,
    Friction,
    FrictionLaw,
    Guard,
    Horizontal,
    IntegratedMode,
    Integrator,
    Kind,
    Mode,
    ModeEnd,
    Motion,
    Positive,
    Quantity,
    Reaction,
    Row,
    Scalar,
    SlidingState,
    State,
    Top,
    Traction,
    Transition,
    Units,
    Vector,
    axis_rate,
    make_integrator,
    on_table,
    sliding_contact,
)


class WeakeningLaw(NamedTuple):
    """Smoothed dry friction that is weaker in fast slip: mu slow / (slow + v) of the normal
    force.
    """

    mu: Scalar
    slow: Scalar

    @property
    def torque_free(self) -> bool:
        """Whether the law has no torque: it has none."""
        return True

    def traction(self, slip: Horizontal, angular_velocity: Vector) -> Traction:
        """Return the force and torque per unit normal force."""
        speed = (slip[0] ** 2 + slip[1] ** 2 + self.slow**2) ** 0.5
        factor = -self.mu * self.slow / (self.slow + speed) / speed
        return Traction((factor * slip[0], factor * slip[1]), NO_TORQUE)

    def coefficients(self, units: Units) -> tuple[Scalar, ...]:
        """Return the numbers of the law in natural units."""
        return (self.mu, self.slow / units.speed)


class WeakeningFriction(Friction):
    """The law as users state it."""

    kind: Literal["weakening_example"] = "weakening_example"
    mu: Annotated[Positive, Quantity("1", "friction coefficient of slow slip")]
    slow: Annotated[Positive, Quantity("m s-1", "speed of slow slip")]

    @property
    def law(self) -> FrictionLaw:
        """Law in the form that the mechanics uses."""
        return WeakeningLaw(self.mu, self.slow)


@dataclass(frozen=True)
class SmoothTable(IntegratedMode):
    """The top slides without friction until a time, in natural units."""

    until: float

    name: ClassVar[str] = "smooth_table"

    @property
    def motion(self) -> Motion:
        """Equations of motion, with the remaining time as the last number."""
        return smooth_motion(self.top.kind)

    def numbers(self, state: State) -> tuple[Scalar, ...]:
        """Return the numbers that the equations move."""
        return (*state.axis, *state.momentum, *state.velocity[:2], self.until)

    def state(self, y: Row) -> State:
        """Return the state of the body."""
        return on_table(SlidingState.unpack(y), self.top)

    def reaction(self, y: Row) -> Reaction:
        """Return the normal force; the table has no friction and takes no power."""
        return Reaction((0.0 * y[0], 0.0 * y[0], normal_force(y, self.top)), NO_TORQUE, 0.0 * y[0])


def normal_force(y: Row, top: Top) -> Scalar:
    """Return the force that keeps a body without friction on the table."""
    state = SlidingState.unpack(y)
    touch = sliding_contact(state.axis, state.momentum, state.velocity, top)
    lever = top.surface.slope(state.axis[2])
    sine_squared = 1.0 - state.axis[2] ** 2
    inverse_mass = 1.0 / top.mass + lever * lever * sine_squared / top.transverse_inertia
    return -touch.free_acceleration / inverse_mass


@lru_cache
def smooth_motion(kind: Kind) -> Motion:
    """Return the equations of motion of all tops of one kind."""

    def rates(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> tuple[Scalar, ...]:
        top = kind.top(tuple(numbers))
        axis, momentum, _ = SlidingState.unpack(y)
        moment = normal_force(y, top) * top.surface.slope(axis[2])
        # a x N z, with the horizontal part -h' n of the contact vector a
        turning = (-moment * axis[1], moment * axis[0], 0.0)
        return (
            *axis_rate(axis, momentum, top),
            *turning,
            0.0 * y[6],
            0.0 * y[7],
            -1.0 + 0.0 * y[8],
        )

    return Motion(rates, 9, kind.numbers, (Guard("drying", lambda y, numbers: y[8]),))


@dataclass(frozen=True)
class SmoothAtFirst(Automaton):
    """Contact modes of a top on a table that is smooth until a time, in natural units."""

    until: float = 0.0

    def launch(self, state: State) -> Transition:
        """Begin on the smooth table."""
        return Transition((), SmoothTable(self.top, self.until), state)

    def follow(self, mode: Mode, end: ModeEnd, time: float) -> Transition:
        """Go on with friction when the table has dried."""
        if end.cause == "drying":
            return super().launch(end.state)
        return super().follow(mode, end, time)


class DryingTable(Contact):
    """A table that is smooth until a time."""

    kind: Literal["drying_example"] = "drying_example"
    until: Annotated[Positive, Quantity("s", "time until which the table is smooth")]

    def rules(self, top: Top, units: Units) -> Automaton:
        """Return the contact modes."""
        return SmoothAtFirst(top, self.liftoff, self.restitution, until=self.until / units.time)


class Counting:
    """An integrator that counts how often it is called, and lets another one work."""

    name, caution = "counting", ""

    def __init__(self, inner: Integrator) -> None:
        self.inner, self.calls = inner, 0

    @classmethod
    def of(cls, name: str) -> Self:
        """Return a counter of the calls of an integrator by name."""
        return cls(make_integrator(name))

    def integrate(
        self,
        motion: Motion,
        parameters: Sequence[float],
        start: tuple[float, NDArray[np.float64]],
        end: float,
    ) -> Iterator[Arc]:
        """Yield the arcs of the inner integrator."""
        self.calls += 1
        yield from self.inner.integrate(motion, parameters, start, end)


def drying_problem(until: float) -> tt.Problem:
    """Return the report's problem with the law and the table of this file."""
    problem = tt.presets.report_problem(spin=155.0, tilt=0.6)
    friction = WeakeningFriction(mu=0.3, slow=0.1)
    return problem.model_copy(update={"friction": friction, "contact": DryingTable(until=until)})
