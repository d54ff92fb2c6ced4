"""Two surfaces of a body touch the table at once: the tilt stays, and both push.

The gaps change at gap_i'' = A_ij N_j + b_i, with A and b of `motion.contact` on the diagonal, and

    A_ij = 1/m - (h_i'/I1) [(a_j x (z + f_j) + t_j) x n]_z.

Both stay closed where A N + b = 0 has N > 0. There c' = 0, and c'' with it.
"""

from typing import NamedTuple

from tippetop.mechanics.motion import (
    SlidingContact,
    axis_rate,
    contact,
    moment_per_normal_force,
)
from tippetop.mechanics.state import SlidingState, State
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Scalar, Vector, add, cross, dot, scale

Tops = tuple[Top, Top]
"""A top with one, and with the other, of two of its surfaces active."""


class DoubleContact(NamedTuple):
    """Both contacts, as if each were alone, and their normal forces when both stay closed.

    Attributes
    ----------
    first, second
        Geometry, slip, friction, and the diagonal parts of A and b.
    normal
        Normal forces, N.
    acceleration
        Of the gap of each while the other alone is closed, m/s^2.
    """

    first: SlidingContact
    second: SlidingContact
    normal: tuple[Scalar, Scalar]
    acceleration: tuple[Scalar, Scalar]

    @property
    def force(self) -> Vector:
        """Force of the table, N."""
        return add(*(self._force(number) for number in (0, 1)))

    @property
    def moment(self) -> Vector:
        """Moment of the table about the centre of mass, N m."""
        pairs = zip(self.normal, (self.first, self.second), strict=True)
        one, other = (scale(n, moment_per_normal_force(touch.arm, touch.traction)) for n, touch in pairs)
        return add(one, other)

    @property
    def couple(self) -> Vector:
        """Torque of drilling friction at both contacts, N m."""
        pairs = zip(self.normal, (self.first, self.second), strict=True)
        one, other = (scale(n, touch.traction.torque) for n, touch in pairs)
        return add(one, other)

    @property
    def torque(self) -> Vector:
        """Torque of the table about the first contact point, N m."""
        return add(self.moment, scale(-1.0, cross(self.first.arm, self.force)))

    @property
    def power(self) -> Scalar:
        """Power of friction, W."""
        return self._power(0) + self._power(1)

    def _power(self, number: int) -> Scalar:
        touch = (self.first, self.second)[number]
        (x, y), torque = touch.traction.force, touch.traction.torque
        return self.normal[number] * (x * touch.slip[0] + y * touch.slip[1] + dot(torque, touch.spin))

    def _force(self, number: int) -> Vector:
        (x, y), n = (self.first, self.second)[number].traction.force, self.normal[number]
        return (n * x, n * y, n)


def double_contact(state: SlidingState, tops: Tops) -> DoubleContact:
    """The contacts of a body that touches the table with two surfaces, whose gaps have no rates."""
    first, second = (contact(*state, top) for top in tops)
    a, d = first.delassus, second.delassus
    b, c = _coupling(state, tops[0], second), _coupling(state, tops[1], first)
    p, q = first.free_acceleration, second.free_acceleration
    inverse = 1.0 / (a * d - b * c)
    normal = ((b * q - d * p) * inverse, (c * p - a * q) * inverse)
    return DoubleContact(first, second, normal, (p - b * q / d, q - c * p / a))


def _coupling(state: SlidingState, top: Top, other: SlidingContact) -> Scalar:
    """A_ij, 1/kg: acceleration of this top's gap per unit normal force at the other contact."""
    lever = top.surface.slope(state.axis[2]) / top.transverse_inertia
    return 1.0 / top.mass - lever * cross(moment_per_normal_force(other.arm, other.traction), state.axis)[2]


def double_rates(state: SlidingState, tops: Tops) -> SlidingState:
    """Time derivative of the state of a body that slides on two surfaces."""
    both, top = double_contact(state, tops), tops[0]
    x, y, _ = both.force
    return SlidingState(axis_rate(state.axis, state.momentum, top), both.moment, (x / top.mass, y / top.mass))


def without_tilting(state: State, top: Top) -> State:
    """The state with c' = 0 and no sinking: what is taken from the momentum lies across the axis."""
    n = state.axis
    rate = axis_rate(n, state.momentum, top)[2]
    part = top.transverse_inertia * rate / (n[0] * n[0] + n[1] * n[1])
    momentum = (state.momentum[0] - part * n[1], state.momentum[1] + part * n[0], state.momentum[2])
    return state._replace(momentum=momentum, velocity=(*state.velocity[:2], 0.0))
