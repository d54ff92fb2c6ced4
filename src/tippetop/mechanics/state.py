"""The state of the body: no angle, no pole, nothing periodic."""

from collections.abc import Sequence
from typing import NamedTuple, Self

from tippetop.mechanics.vectors import Horizontal, Scalar, Vector


class State(NamedTuple):
    """Everything about the body at an instant, whether it touches the table or not.

    Attributes
    ----------
    axis
        Unit vector n along the axis of symmetry.
    momentum
        Angular momentum L about the centre of mass, kg m^2/s.
    velocity
        Velocity of the centre of mass, m/s.
    position
        Position of the centre of mass, m; the table is z = 0.
    marker
        Unit vector fixed in the body and perpendicular to the axis; with the axis it gives the orientation.
    work
        Work of the contact force since the start, J (friction only takes, as long as the table
        only pushes).
    """

    axis: Vector
    momentum: Vector
    velocity: Vector
    position: Vector
    marker: Vector
    work: Scalar

    def pack(self) -> tuple[Scalar, ...]:
        """The 16 numbers of the state in the order of its attributes."""
        return (*self.axis, *self.momentum, *self.velocity, *self.position, *self.marker, self.work)

    @classmethod
    def unpack(cls, y: Sequence[Scalar]) -> Self:
        """Read a state from its 16 numbers."""
        return cls(
            (y[0], y[1], y[2]),
            (y[3], y[4], y[5]),
            (y[6], y[7], y[8]),
            (y[9], y[10], y[11]),
            (y[12], y[13], y[14]),
            y[15],
        )


class SlidingState(NamedTuple):
    """The part of a `State` that is free while the body touches the table: its height is not."""

    axis: Vector
    momentum: Vector
    velocity: Horizontal
    position: Horizontal
    marker: Vector
    work: Scalar

    def pack(self) -> tuple[Scalar, ...]:
        """The 14 numbers of the state in the order of its attributes."""
        return (*self.axis, *self.momentum, *self.velocity, *self.position, *self.marker, self.work)

    @classmethod
    def unpack(cls, y: Sequence[Scalar]) -> Self:
        """Read a state from its 14 numbers."""
        return cls(
            (y[0], y[1], y[2]),
            (y[3], y[4], y[5]),
            (y[6], y[7]),
            (y[8], y[9]),
            (y[10], y[11], y[12]),
            y[13],
        )
