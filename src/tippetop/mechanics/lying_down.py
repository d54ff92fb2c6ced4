r"""How a body on an edge comes to lie flat, and when.

With the sine s of the tilt, the edge's radius R and the angular velocity of the body along the
horizontal part e of its axis, omega_e, and across it, omega_t, a face closes onto the table in one
of two ways.

It **slaps** onto the table where the tilt falls at a finite rate: s' = omega_t, and the time left
is s / |omega_t| but for the tilt's acceleration. A little of omega_e turns the body round instead:
e turns at the rate Omega = omega_z - c omega_e / s, with c the cosine of the tilt, and s has a
least value near s omega_e / omega_t.

It **wobbles** down (Euler's disk) where omega_t is small beside omega_e, or where the body rocks
from side to side and turns round near s = 0 every time. Near s = 0 the motion keeps its form if s,
the velocities and Omega are multiplied by q^2, q and 1/q, and time by q. The energy of the wobble,

    Q = m g R s + 1/2 I (omega_e^2 + omega_t^2) + 1/2 m z'^2,

without those of the spin about the vertical and of the motion along the table, falls as the square
of the time left. I is I1, and where the contact sticks I1 + m h^2, with the height h of the centre
of mass, which then swings above the contact. The table takes the power P = -Q' from the wobble, and
the time left is

    T = 2 Q / P.

Rolling resistance eps takes P = N eps |omega|, with the horizontal angular velocity omega. On a
thin disk without slip, I1 = m R^2 / 4, this is s = [(2/3) (eps / R) sqrt(g / R) T]^2. T is wrong
by as much as the motion departs from its form: relatively by s, by the slope of the table, and by
the size of a nutation: the difference of the tilt's rate from -2 s / T, and that of N from the
weight. Where the contact slips,
friction takes some power, too, and the departure is taken to be 1. Whether T is short enough is
asked with the weight in place of N, which has no bound where a body that rocks turns round.

Without rolling resistance there is an end where friction on the slip R omega_z of a body that goes
on spinning, at the depth H below its centre of mass, slows the wobble down: then P is as with eps =
H f(R omega_z). Friction that speeds the wobble up makes the body rise. Elsewhere P falls faster
than sqrt(Q), T grows, and there is no end: without loss; where the contact sticks; and on a thin
disk, whose friction has an arm that falls with s.
"""

from typing import NamedTuple

from tippetop.mechanics.contacts.forces import is_set_valued, spun_up
from tippetop.mechanics.motion import angular_velocity, axis_rate, contact_swing
from tippetop.mechanics.state import SlidingState
from tippetop.mechanics.surfaces.surface import POLE, support_at
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Scalar, Vector, power

LEFT_OUT = 1e-8
"""Time, in natural units, that the time left may be wrong by where a wobble is followed no further:
below 1e-9 s on earth where a body's radius is less than 9 cm. Far above it the end of a run would
show it; a tenth of it, and a body that rocks from side to side turns round within so short times
that rounding hides the slip that begins then.
"""

FRICTION_ARM = 0.01
"""Arm of the couple that stands for friction in the power without rolling resistance, over the
edge's radius. Friction's own arm may have either sign and changes with every nutation. With this
one a wobble that lasts a hundredth of `LEFT_OUT` counts as none. A smaller one follows rounding,
and a larger one ends a wobble that friction still lifts.
"""

SLAP = 1e-6
"""Time left, in natural units, at which a face that slaps onto the table is followed no further:
the tilt's acceleration changes by as little until then. The polynomials of a step do not show much
shorter times beside a double zero.
"""

TURNING = 1e6
"""Ratio of the tilt's rate to omega_e from which a face slaps, so that the least s it could come to
is a millionth of the present one.
"""


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
    """Power P that the table takes from it, W, where it presses with the weight."""
    pressing: Scalar
    """Normal force over the weight; 1 where the contact slips."""
    departure: Scalar
    """Square of its departure from the form that it keeps, relatively."""

    @classmethod
    def of(cls, axis: Vector, momentum: Vector, normal: Scalar | None, top: Top) -> "Wobble":
        """Return the wobble for an axis and an angular momentum.

        Parameters
        ----------
        axis, momentum
            Axis, and angular momentum, kg m^2/s.
        normal
            Normal force of the table where the contact sticks, N; None where it slips.
        top
            The body; its active surface is an edge.
        """
        sine, along, across, circling = Tilting.of(axis, momentum, top)
        height, slope, _ = support_at(axis, top.surface)
        arm, weight = power(slope * slope * (sine * sine), 0.5), top.mass * top.gravity
        square = along * along + across * across
        inertia = top.transverse_inertia
        if normal is not None:
            inertia = inertia + top.mass * (height * height)
        sinking = arm * across
        energy = weight * arm * sine + 0.5 * (inertia * square + top.mass * (sinking * sinking))
        if top.rolling_resistance is None:
            fastest = power(2.0 * energy / top.transverse_inertia, 0.5)
            return cls(energy, weight * (FRICTION_ARM * arm) * fastest, 1.0, 1.0)
        loss = weight * top.rolling_resistance.length * power(square + POLE, 0.5)
        if normal is None:
            return cls(energy, loss, 1.0, 1.0)
        pressing = normal / weight
        drifting = across * energy + axis[2] * sine * loss
        pace = weight * arm / top.transverse_inertia
        nutation = (drifting * circling / (energy * pace)) ** 2 + (pressing - 1.0) ** 2
        departure = sine * sine + nutation
        if top.field is not None and top.field.slope is not None:
            east, north = top.field.slope
            departure = departure + (east * east + north * north) / (top.gravity * top.gravity)
        return cls(energy, loss, pressing, departure)

    @property
    def time_left(self) -> Scalar:
        """Time T until the body lies flat, s."""
        return 2.0 * self.energy / (self.loss * self.pressing)


def wobble_guard(axis: Vector, momentum: Vector, normal: Scalar | None, top: Top) -> Scalar:
    """Falls through zero where the time left to a wobble is known to within `LEFT_OUT`, natural
    units.

    The arguments are those of `Wobble.of`.
    """
    wobble = Wobble.of(axis, momentum, normal, top)
    share = wobble.departure / (1.0 + wobble.departure)
    return 2.0 * wobble.energy * power(share, 0.5) - LEFT_OUT * wobble.loss


def slap_guard(axis: Vector, momentum: Vector, top: Top) -> Scalar:
    """Falls through zero where a face slaps onto the table within `SLAP`.

    That is s (s + `SLAP` s') + (`SLAP` `TURNING` omega_e)^2 with s' = c omega_t.
    """
    sine, along, across, _ = Tilting.of(axis, momentum, top)
    turning = SLAP * TURNING * along
    return sine * (sine + SLAP * axis[2] * across) + turning * turning


def slaps_soon(axis: Vector, momentum: Vector, top: Top) -> bool:
    """Return whether a face slaps onto the table within `SLAP`, of floats.

    It does where `slap_guard` has fallen. A body that begins nearer to the table passes flat within
    less than a step shows of that guard.
    """
    sine, along, across, _ = Tilting.of(axis, momentum, top)
    falling = -axis[2] * across
    return bool(falling > 0.0 and sine <= SLAP * falling and TURNING * abs(along) <= falling)


def time_to_slap(axis: Vector, momentum: Vector, moment: Vector, top: Top) -> Scalar:
    """Time until a face slaps onto the table, at the present acceleration of the tilt, s.

    Parameters
    ----------
    axis, momentum
        Axis, and angular momentum, kg m^2/s.
    moment
        Rate of the angular momentum, N m.
    top
        The body.
    """
    rate, (x, y, _) = axis_rate(axis, momentum, top), axis
    driven, carried = axis_rate(axis, moment, top), axis_rate(rate, momentum, top)
    sine = power(x * x + y * y, 0.5)
    falling = -(x * rate[0] + y * rate[1]) / sine
    bent = x * (driven[0] + carried[0]) + y * (driven[1] + carried[1])
    square = rate[0] * rate[0] + rate[1] * rate[1]
    return 2.0 * sine / (falling + power(3.0 * falling * falling - 2.0 * (bent + square), 0.5))


def scaled_wobble(state: SlidingState, part: Scalar, sticks: bool, top: Top) -> SlidingState:
    """Return the state where a part of the time left to a wobble is left.

    Its direction is kept: how far that turns until then has no bound. Where the contact slips, the
    spin about the vertical does not end with the wobble. Dry friction keeps the slip and its own
    direction. Friction that vanishes with slip, such as that of a film, keeps the velocity of the
    centre of mass: it has no time to act unless it damps slip within the time that is left, 1e-8 in
    natural units, and what it changes then is the velocity of the edge, 1e-10 m/s.

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
    u, v = state.velocity
    if sticks:
        momentum = spun_up(axis, (0.0, 0.0, 0.0), (part * p, part * q, part * w), top)
        return SlidingState(axis, momentum, (part * u, part * v))
    momentum = spun_up(axis, (0.0, 0.0, 0.0), (part * p, part * q, w), top)
    if not is_set_valued(top.friction):
        return SlidingState(axis, momentum, (u, v))
    before, after = (
        contact_swing(state.axis, state.momentum, top),
        contact_swing(axis, momentum, top),
    )
    return SlidingState(axis, momentum, (u + before[0] - after[0], v + before[1] - after[1]))
