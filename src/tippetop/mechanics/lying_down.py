r"""How a body on an edge comes to lie flat, and when.

With the sine s of the tilt, the edge's radius R and the angular velocity of the body along the
horizontal part e of its axis, omega_e, and across it, omega_t, a face closes onto the table in one
of two ways.

It **slaps** onto the table where the tilt falls at a finite rate: s' = omega_t, and the time left
is s / |omega_t|. A little of omega_e turns the body round instead: e turns at the rate Omega =
omega_z - c omega_e / s, with c the cosine of the tilt, and s has a least value near s omega_e /
omega_t.

It **wobbles** down (Euler's disk) where omega_t is small beside omega_e. Near s = 0 the motion
keeps its form if s, the velocities and Omega are multiplied by q^2, q and 1/q, and time by q. The
energy of the wobble,

    Q = m g R s + 1/2 I1 (omega_e^2 + omega_t^2) + 1/2 m z'^2,

without those of the spin about the vertical and of the motion along the table, falls as the square
of the time left. The table takes the power P = -Q' from it, and the time left is

    T = 2 Q / P.

There is an end where P falls as sqrt(Q), so that the table resists the wobble with a torque that
does not end with it:

- Rolling resistance eps: P = m g eps |omega_e|. On a thin disk without slip, I1 = m R^2 / 4, this
  is s = [(2/3) (eps / R) sqrt(g / R) T]^2.
- Friction on the slip R omega_z of a body that goes on spinning, at the depth H below its centre of
  mass: P is as with eps = -+ H f(R omega_z), as friction slows the wobble down or speeds it up.

Where P falls faster than sqrt(Q), T grows, and there is no end: without loss; where the contact
sticks without rolling resistance; and on a thin disk without rolling resistance, whose friction has
an arm that falls with s.

T is wrong by as much as the motion departs from that form: relatively by s, and by the size of a
nutation: the difference of the tilt's rate from -2 s / T, and its acceleration. Where the contact
slips, the departure is taken to be 1.
"""

from typing import NamedTuple

from tippetop.mechanics.contacts.contact_point import Acceleration
from tippetop.mechanics.contacts.forces import spun_up
from tippetop.mechanics.contacts.wrench import Slip, Wrench
from tippetop.mechanics.motion import angular_velocity, axis_rate
from tippetop.mechanics.state import SlidingState
from tippetop.mechanics.surfaces.surface import POLE, support_at
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Scalar, Vector, dot, power

LEFT_OUT = 1e-9
"""Time, in natural units, that the time left may be wrong by where a wobble is followed no further:
below 1e-9 s on any body smaller than 9 m. Far above it the end of a run would show it; far below,
slip that begins in so short a time is rounding.
"""

SLAP = 1e-6
"""Time left, in natural units, at which a face that slaps onto the table is followed no further:
the tilt's rate changes by as little until then, and the time by its square, 1e-12. The polynomials
of a step do not show much shorter times beside a double zero.
"""

TURNING = 1e6
"""Ratio of the tilt's rate to omega_e from which a face slaps, so that the least s it could come to
is a millionth of the present one.
"""

TURNING_FLOOR = 1e-12
"""An omega_e, in natural units, that is rounding."""


class Tilting(NamedTuple):
    """Angular velocity of a body on an edge, by its parts, rad/s."""

    sine: Scalar
    """Sine s of the tilt."""
    along: Scalar
    """Part omega_e along the horizontal part of the axis."""
    across: Scalar
    """Part omega_t across it: the rate of the tilt."""
    circling: Scalar
    """Rate Omega at which the horizontal part of the axis turns."""

    @classmethod
    def of(cls, axis: Vector, momentum: Vector, top: Top) -> "Tilting":
        """Return the parts for an axis and an angular momentum (kg m^2/s)."""
        square = axis[0] * axis[0] + axis[1] * axis[1]
        inverse = power(square + POLE, -0.5)
        x, y = axis[0] * inverse, axis[1] * inverse
        turning, rate = angular_velocity(axis, momentum, top), axis_rate(axis, momentum, top)
        return cls(
            square * inverse,
            turning[0] * x + turning[1] * y,
            turning[1] * x - turning[0] * y,
            (rate[1] * x - rate[0] * y) * inverse,
        )


class Wobble(NamedTuple):
    """The wobble of a body on an edge near the end of its motion."""

    energy: Scalar
    """Energy Q of the wobble, J."""
    loss: Scalar
    """Power P that the table takes from it, W."""
    departure: Scalar
    """Square of its departure from the form that it keeps, relatively."""

    @classmethod
    def of(
        cls,
        state: SlidingState,
        top: Top,
        wrench: Wrench,
        acceleration: Acceleration,
        slip: Slip | None,
    ) -> "Wobble":
        """Return the wobble in a state.

        Parameters
        ----------
        state
            Axis, angular momentum, and horizontal velocity of the centre of mass.
        top
            The body; its active surface is an edge.
        wrench, acceleration
            What the table does, and how the contact accelerates.
        slip
            The slip; None where the contact sticks.
        """
        tilting = Tilting.of(state.axis, state.momentum, top)
        sine, along, across, circling = tilting
        turning = angular_velocity(state.axis, state.momentum, top)
        slope = support_at(state.axis, top.surface)[1]
        arm = power(slope * slope * (sine * sine), 0.5)
        sinking = arm * across
        u, v = state.velocity
        energy = top.mass * top.gravity * arm * sine + 0.5 * (
            top.transverse_inertia * (along * along + across * across)
            + top.mass * sinking * sinking
        )
        gained = dot(wrench.torque, turning) - (wrench.force[0] * u + wrench.force[1] * v)
        if slip is not None:
            gained = gained + wrench.force[0] * slip[0] + wrench.force[1] * slip[1]
        spun = top.axial_inertia * turning[2] * acceleration.turning[2]
        loss = spun - gained
        inverse = power(sine * sine + POLE, -0.5)
        x, y = state.axis[0] * inverse, state.axis[1] * inverse
        tipping = acceleration.turning[1] * x - acceleration.turning[0] * y - circling * along
        drifting = across * energy + state.axis[2] * sine * loss
        pace = top.mass * top.gravity * arm / top.transverse_inertia
        nutation = (drifting * circling / (energy * pace)) ** 2 + (tipping / pace) ** 2
        departure = sine * sine + nutation
        return cls(energy, loss, departure if slip is None else departure + 1.0)

    @property
    def time_left(self) -> Scalar:
        """Time T until the body lies flat, s."""
        return 2.0 * self.energy / self.loss

    def reserve(self, left_out: Scalar) -> Scalar:
        """Falls through zero where the time left is known to within a time, s; in J."""
        share = self.departure / (1.0 + self.departure)
        return 2.0 * self.energy * power(share, 0.5) - left_out * self.loss


def slap_guard(axis: Vector, momentum: Vector, top: Top) -> Scalar:
    """Falls through zero where a face slaps onto the table within `SLAP`.

    That is s (s + `SLAP` (s' + `TURNING` |omega_e|)) with s' = c omega_t.
    """
    sine, along, across, _ = Tilting.of(axis, momentum, top)
    turning = TURNING * power(along * along + TURNING_FLOOR * TURNING_FLOOR, 0.5)
    return sine * (sine + SLAP * (axis[2] * across + turning))


def time_to_slap(axis: Vector, momentum: Vector, top: Top) -> Scalar:
    """Time until a face slaps onto the table, at the present rate of the tilt, s."""
    sine, _, across, _ = Tilting.of(axis, momentum, top)
    return sine / abs(across)


def scaled_wobble(state: SlidingState, part: Scalar, sticks: bool, top: Top) -> SlidingState:
    """Return the state where a part of the time left to a wobble is left.

    Its direction is kept: how far that turns until then has no bound. Where the contact slips, the
    spin about the vertical and the velocity along the table do not end with the wobble.

    Parameters
    ----------
    state
        The state at the beginning.
    part
        The part q of the time left.
    sticks
        Whether the contact sticks.
    top
        The body.
    """
    x, y, z = state.axis
    axis = (part * part * x, part * part * y, z)
    p, q, w = angular_velocity(state.axis, state.momentum, top)
    beside = part if sticks else 1.0
    momentum = spun_up(axis, (0.0, 0.0, 0.0), (part * p, part * q, beside * w), top)
    u, v = state.velocity
    return SlidingState(axis, momentum, (beside * u, beside * v))
