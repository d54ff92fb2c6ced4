"""The state of the body: no angle, no pole, nothing periodic.

Position along the table, orientation about the axis and the work of the table move nothing: they
are quadratures of the motion, found from its solution (see `tippetop.mechanics.quadratures`).
"""

from typing import NamedTuple, Self

from tippetop.mechanics.vectors import Horizontal, Row, Scalar, Vector


class State(NamedTuple):
    """What the motion of the body depends on, whether it touches the table or not."""

    axis: Vector
    """Unit vector n along the axis of symmetry."""
    momentum: Vector
    """Angular momentum L about the centre of mass, kg m^2/s."""
    velocity: Vector
    """Velocity of the centre of mass, m/s."""
    height: Scalar
    """Height of the centre of mass above the table, m."""

    def pack(self) -> tuple[Scalar, ...]:
        """Return the 10 numbers of the state in the order of its attributes."""
        return (*self.axis, *self.momentum, *self.velocity, self.height)

    @classmethod
    def unpack(cls, y: Row) -> Self:
        """Read a state from its 10 numbers."""
        return cls((y[0], y[1], y[2]), (y[3], y[4], y[5]), (y[6], y[7], y[8]), y[9])


class SlidingState(NamedTuple):
    """The part of a `State` that is free while the body touches the table: height and sinking are
    not.
    """

    axis: Vector
    momentum: Vector
    velocity: Horizontal

    def pack(self) -> tuple[Scalar, ...]:
        """Return the 8 numbers of the state in the order of its attributes."""
        return (*self.axis, *self.momentum, *self.velocity)

    @classmethod
    def unpack(cls, y: Row) -> Self:
        """Read a state from its 8 numbers."""
        return cls((y[0], y[1], y[2]), (y[3], y[4], y[5]), (y[6], y[7]))
