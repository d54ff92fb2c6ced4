"""Friction laws, a surface and a contact mode of a user's own, and problems with them."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Annotated, ClassVar, Literal, NamedTuple, Self

from pydantic import Field, model_validator

import tippetop as tt
from tippetop.contact.automaton import Automaton
from tippetop.contact.mode import IntegratedMode, Mode, ModeEnd, Reaction, Transition
from tippetop.extend import (
    NO_TORQUE,
    FrictionLaw,
    Horizontal,
    Positive,
    Quantity,
    Scalar,
    Surface,
    Traction,
    Units,
    Vector,
)
from tippetop.integrators.base import Guard, Motion
from tippetop.mechanics.contacts.contact_point import ContactPoint
from tippetop.mechanics.contacts.forces import sum_at, velocity_without_slip
from tippetop.mechanics.contacts.system import Component, Constraint, free_rates, solve_constraints
from tippetop.mechanics.contacts.wrench import FORCES, Wrench
from tippetop.mechanics.motion import axis_rate, on_table
from tippetop.mechanics.state import SlidingState, State
from tippetop.mechanics.top import Kind, Top
from tippetop.mechanics.vectors import Row
from tippetop.support.errors import InvalidInput


class StribeckLaw(NamedTuple):
    """Smoothed Coulomb friction that is stronger while slip is slow: mu (1 + more / (1 + v^2 /
    slow^2)).
    """

    mu: Scalar
    more: Scalar
    slow: Scalar

    @property
    def torque_free(self) -> bool:
        return True

    def traction(self, slip: Horizontal, angular_velocity: Vector) -> Traction:
        speed = (slip[0] ** 2 + slip[1] ** 2) / self.slow**2
        factor = -self.mu / self.slow * (1.0 + self.more / (1.0 + speed)) * (1.0 + speed) ** -0.5
        return Traction((factor * slip[0], factor * slip[1]), NO_TORQUE)

    def coefficients(self, units: Units) -> tuple[Scalar, ...]:
        return (self.mu, self.more, self.slow / units.speed)


class StribeckFriction(tt.Friction):
    kind: Literal["stribeck"] = "stribeck"
    mu: Annotated[Positive, Quantity("1", "friction coefficient of fast slip")]
    more: Annotated[Positive, Quantity("1", "how much more it is of slow slip")]
    slow: Annotated[Positive, Quantity("m s-1", "speed of slow slip")]

    @property
    def law(self) -> FrictionLaw:
        return StribeckLaw(self.mu, self.more, self.slow)


class RampLaw(NamedTuple):
    """Coulomb friction whose force rises with slip up to a speed: mu min(v / full, 1)."""

    mu: Scalar
    full: Scalar

    @property
    def torque_free(self) -> bool:
        return True

    def traction(self, slip: Horizontal, angular_velocity: Vector) -> Traction:
        speed = tt.extend.sqrt(slip[0] ** 2 + slip[1] ** 2)
        factor = -self.mu / tt.extend.max(speed, self.full)
        return Traction((factor * slip[0], factor * slip[1]), NO_TORQUE)

    def coefficients(self, units: Units) -> tuple[Scalar, ...]:
        return (self.mu, self.full / units.speed)


class RampFriction(tt.Friction):
    kind: Literal["ramp"] = "ramp"
    mu: Annotated[Positive, Quantity("1", "friction coefficient of fast slip")]
    full: Annotated[Positive, Quantity("m s-1", "speed from which on friction is that")]

    @property
    def law(self) -> FrictionLaw:
        return RampLaw(self.mu, self.full)


@tt.extend.friction_law(mu="1", more="1", slow="m s-1")
def stribeck_function(
    slip: Horizontal, angular_velocity: Vector, mu: Scalar, more: Scalar, slow: Scalar
) -> tuple[Scalar, Scalar]:
    """Return the force of `StribeckLaw`."""
    speed = (slip[0] ** 2 + slip[1] ** 2) / slow**2
    factor = -mu / slow * (1.0 + more / (1.0 + speed)) * (1.0 + speed) ** -0.5
    return factor * slip[0], factor * slip[1]


class SquashedSurface(NamedTuple):
    """A sphere squashed along its axis: h = r - center c - squash c^2."""

    radius: Scalar
    center: Scalar
    squash: Scalar

    def height(self, c: Scalar) -> Scalar:
        return self.radius - self.center * c - self.squash * c * c

    def slope(self, c: Scalar) -> Scalar:
        return -self.center - 2.0 * self.squash * c

    def curvature(self, c: Scalar) -> Scalar:
        return -2.0 * self.squash + 0.0 * c

    @property
    def spherical(self) -> bool:
        return False

    @property
    def size(self) -> Scalar:
        return self.radius

    @property
    def proportions(self) -> tuple[Scalar, ...]:
        return (self.center / self.radius, self.squash / self.radius)

    @classmethod
    def from_proportions(cls, proportions: tuple[Scalar, ...]) -> Self:
        return cls(1.0, *proportions)


class SquashedSphere(tt.Shape):
    kind: Literal["squashed_sphere"] = "squashed_sphere"
    radius: Positive
    center: float
    squash: Annotated[float, Field(ge=0)]

    @model_validator(mode="after")
    def _is_convex(self) -> Self:
        if self.squash > self.radius / 3.0:
            raise InvalidInput(
                "squash", self.squash, f"at most a third of the radius, {self.radius / 3.0:g}"
            )
        return self

    @property
    def surface(self) -> Surface:
        return SquashedSurface(self.radius, self.center, self.squash)


@dataclass(frozen=True)
class Pinned(IntegratedMode):
    """The contact point is held at rest, whatever force that needs, until the time of release."""

    left: float

    name: ClassVar[str] = "pinned"

    @property
    def motion(self) -> Motion:
        return pinned_motion(self.top.kind)

    def numbers(self, state: State) -> tuple[Scalar, ...]:
        return (*state.axis, *state.momentum, self.left)

    def state(self, y: Row) -> State:
        axis, momentum = (y[0], y[1], y[2]), (y[3], y[4], y[5])
        velocity = velocity_without_slip(axis, momentum, self.top)
        return on_table(SlidingState(axis, momentum, velocity), self.top)

    def reaction(self, y: Row) -> Reaction:
        wrench, _ = pin(y, self.top)
        return Reaction(wrench.force, NO_TORQUE, 0.0)


def pin(y: Row, top: Top) -> tuple[Wrench, ContactPoint]:
    """The force that holds the contact point."""
    point = ContactPoint.of((y[0], y[1], y[2]), (y[3], y[4], y[5]), top)
    held = [Constraint.of(Component(0, force.force)) for force in FORCES]
    return sum_at(0, solve_constraints((point,), held, free_rates((point,))).wrenches), point


@lru_cache
def pinned_motion(kind: Kind) -> Motion:
    def rates(y: Sequence[Scalar], numbers: Sequence[Scalar]) -> tuple[Scalar, ...]:
        top = kind.top(tuple(numbers))
        wrench, point = pin(y, top)
        return (
            *axis_rate(point.axis, (y[3], y[4], y[5]), top),
            *point.moment(wrench),
            -1.0 + 0.0 * y[6],
        )

    return Motion(rates, 7, kind.numbers, (Guard("released", lambda y, numbers: y[6]),))


@dataclass(frozen=True)
class PinAutomaton(Automaton):
    """As for any top that may fly, once it is released."""

    left: float = 0.0

    def launch(self, state: State) -> Transition:
        return Transition((), Pinned(self.top, self.left), state)

    def follow(self, mode: Mode, end: ModeEnd, time: float) -> Transition:
        if end.cause == "released":
            return super().launch(end.state)
        return super().follow(mode, end, time)


class PinnedAtFirst(tt.Contact):
    kind: Literal["pinned_at_first"] = "pinned_at_first"
    until: Annotated[Positive, Quantity("s", "when the pin is drawn")]

    def rules(self, top: Top, units: Units) -> PinAutomaton:
        return PinAutomaton(top, self.liftoff, self.restitution, left=self.until / units.time)


DRAWN = 0.2037
"""When the pin is drawn: at no sample, where a force that jumps would have two values."""
REPORT = tt.presets.report_problem(spin=155.0, tilt=0.6)
SQUASHED = tt.Body(
    mass=0.02, shape=SquashedSphere(radius=0.02, center=0.005, squash=0.002), I1=3.5e-6, I3=3.2e-6
)
STRIBECK = StribeckFriction(mu=0.2, more=0.5, slow=0.05)
PROBLEMS = {
    "law": REPORT.model_copy(update={"friction": STRIBECK}),
    "law with rolling resistance": REPORT.model_copy(
        update={"friction": STRIBECK, "rolling_resistance": 1e-4}
    ),
    "law of a function": REPORT.model_copy(
        update={"friction": stribeck_function(mu=0.2, more=0.5, slow=0.05)}
    ),
    "law with a choice": REPORT.model_copy(update={"friction": RampFriction(mu=0.2, full=0.05)}),
    "surface": REPORT.model_copy(update={"body": SQUASHED}),
    "mode": REPORT.model_copy(update={"contact": PinnedAtFirst(until=DRAWN)}),
}
OVER = {
    "law": {"friction.more": [0.1, 0.6], "launch.spin": [90.0, 155.0]},
    "law with rolling resistance": {
        "friction.more": [0.1, 0.6],
        "rolling_resistance": [1e-5, 3e-4],
    },
    "law of a function": {"friction.slow": [0.05, 0.1], "launch.spin": [90.0, 155.0]},
    "law with a choice": {"friction.full": [0.02, 0.05], "launch.spin": [90.0, 155.0]},
    "surface": {"body.shape.squash": [1e-3, 2e-3], "launch.spin": [90.0, 155.0]},
    "mode": {"contact.until": [0.1, 0.3], "launch.spin": [90.0, 155.0]},
}
