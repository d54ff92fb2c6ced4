"""Settling of a motion: the tilt near which it stays for ever."""

import math

import numpy as np

from tippetop.contact.mode import Status
from tippetop.integrators.base import Array
from tippetop.mechanics.invariants import energy, jellett
from tippetop.mechanics.roots import crossing
from tippetop.mechanics.state import State
from tippetop.mechanics.surfaces.hull import (
    Hull,
    acting,
    lowest_surface,
    outer_height,
)
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Scalar
from tippetop.mechanics.view import axis_sine
from tippetop.results.catalogue import NEAR_FINAL
from tippetop.theory.prediction import is_held
from tippetop.theory.steady import balance_of_moments, has_level_spin, least_energy

NEAR_STEADY = 1e-3
"""Largest deviation from a vertical or level spin, natural units, of a body without Jellett's
integral that counts as settled. Deviations decay exponentially; with a larger bound slow passages
would count as ends, a smaller one needs longer runs.
"""

APPROACHED = 0.1
"""Largest ratio of the deviation to that at launch of a settled body: a launch near an unstable
spin begins with a small deviation, which grows.
"""

BESIDE_POLE = 1e-6
"""Least angle from a pole, rad, at which the slope of the height is used: at the pole it is 0."""

HALVINGS = 44
"""Bisections that reduce 0.02 rad to the rounding of an angle."""


def tilt(state: State) -> Array:
    """Return the tilts, rad."""
    angles: Array = np.arctan2(axis_sine(state.axis), state.axis[2])
    return angles


def settled_tilt_of_one(status: Status, state: State, start: State, top: Top) -> float:
    """Return the tilt near which one launch that has ended stays for ever, rad, or nan.

    The criteria are those of `settled_tilts`. A body at rest stays where it is; a
    body that rolls on two surfaces stays at the tilt at which both touch. All numbers are floats in
    natural units.
    """
    theta = math.atan2(axis_sine(state.axis), state.axis[2])
    if status is Status.AT_REST:
        return theta
    if status is not Status.COMPLETED:
        return math.nan
    settled = _settled_spin_tilt(theta, state, start, top) if spins_for_ever(top) else math.nan
    return settled if math.isfinite(settled) else _tilt_of_rest(theta, state, top)


def spins_for_ever(top: Top) -> bool:
    """Return whether nothing takes a steady spin: no torque of the table, no slope and no air."""
    return top.torque_free and top.field is None


def slides_down(top: Top) -> bool:
    """Return whether the table slopes, so that no energy bounds what the top can reach."""
    return top.field is not None and top.field.slope is not None


def _settled_spin_tilt(theta: float, state: State, start: State, top: Top) -> float:
    """Return the tilt at which a motion without friction torque keeps spinning, rad, or nan."""
    if isinstance(top.surface, Hull):
        top = top.body.lowest_at(state.axis[2])
        if not _only_touches(top, theta):
            return math.nan
    if acting(top.surface).spherical:
        return _steady_tilt_near(theta, state, top) if is_held(state, top, NEAR_FINAL) else math.nan
    if not _has_come_to_steady_spin(state, start, top):
        return math.nan
    if has_level_spin(top) and abs(state.axis[2]) < axis_sine(state.axis):
        return 0.5 * math.pi
    return 0.0 if state.axis[2] > 0.0 else math.pi


def _tilt_of_rest(theta: float, state: State, top: Top) -> float:
    """Return the tilt within `NEAR_FINAL` at which the body can rest, rad, or nan.

    There the centre of mass is lowest, on one surface or on two. The result is nan if the energy is
    enough to leave this neighbourhood.
    """
    if slides_down(top):
        return math.nan
    low, high = theta - NEAR_FINAL, theta + NEAR_FINAL
    total, weight = float(energy(state, top)), float(top.mass * top.gravity)
    for at in (low, high):
        if 0.0 < at < math.pi and weight * float(outer_height(top.surface, math.cos(at))) <= total:
            return math.nan

    def slope(at: float) -> float:
        cosine = math.cos(at)
        return -math.sin(at) * float(lowest_surface(top.surface, cosine).slope(cosine))

    low, high = max(low, BESIDE_POLE), min(high, math.pi - BESIDE_POLE)
    if slope(low) >= 0.0:
        return 0.0
    return math.pi if slope(high) <= 0.0 else crossing(slope, low, high)


def _steady_tilt_near(theta: float, state: State, top: Top) -> float:
    """Return the tilt of least energy within `NEAR_FINAL` of a sphere's tilt, rad.

    At this tilt the moments balance; if there is none, it is the pole within `NEAR_FINAL`.
    """
    integral = jellett(state, top)

    def balance(at: float) -> float:
        return float(balance_of_moments(at, integral, top, math))

    low, high = max(theta - NEAR_FINAL, 0.0), min(theta + NEAR_FINAL, math.pi)
    if balance(low) * balance(high) < 0.0:
        return crossing(balance, low, high)
    return 0.0 if low == 0.0 else math.pi if high == math.pi else theta


def _has_come_to_steady_spin(state: State, start: State, top: Top) -> Scalar:
    """Return whether a body has approached a spin about a vertical or level axis since launch."""
    remaining = deviation(state, top)
    return (remaining <= NEAR_STEADY) & (remaining <= APPROACHED * deviation(start, top))


def _only_touches(top: Top, at: float) -> bool:
    """Return whether only the active surface of a hull reaches the table near a tilt, rad."""
    near = (math.cos(at - NEAR_FINAL), math.cos(at), math.cos(at + NEAR_FINAL))
    others = [one.surface for one in top.body.contacts if one.number != top.number]
    return all(float(one.height(c)) < float(top.surface.height(c)) for one in others for c in near)


# translate: skip
def settled_tilts(state: State, start: State, top: Top) -> Array:
    """Return the tilts near which motions stay for ever, rad, shape (n,); nan where they may not.

    A sphere under friction without torque conserves Jellett's integral and loses energy. Its tilt
    has settled once its energy excludes every tilt farther away than `NEAR_FINAL`; it settles at
    the steady state in between. A body of another shape has settled once it is within `NEAR_STEADY`
    of a spin about a vertical or level axis. Any other body, and every body under friction with a
    torque, has settled once its energy is too small to leave the tilts within `NEAR_FINAL`; it
    settles where it can rest.

    `start` has the states at launch. All numbers have shape (n,), in natural units, and so have
    those of the top, which has one surface.
    """
    theta = tilt(state)
    resting = _tilts_of_rest(theta, state, top)
    if slides_down(top):
        return np.full(theta.shape, np.nan)
    if not spins_for_ever(top):
        return resting
    if top.surface.spherical:
        held = is_held(state, top, NEAR_FINAL)
        return np.where(held, _steady_tilts_near(theta, state, top), resting)
    come = _has_come_to_steady_spin(state, start, top)
    vertical = np.where(state.axis[2] > 0.0, 0.0, math.pi)
    leans = np.abs(state.axis[2]) < axis_sine(state.axis)
    level = (top.surface.slope(0.0) == 0.0) & leans
    return np.where(come, np.where(level, 0.5 * math.pi, vertical), resting)


# translate: skip
def _tilts_of_rest(theta: Array, state: State, top: Top) -> Array:
    """Return the result of `_tilt_of_rest` for many bodies of one surface, shape (n,)."""
    surface = top.surface

    def slope(at: Array) -> Array:
        rise: Array = -np.sin(at) * surface.slope(np.cos(at))
        return rise

    low, high = theta - NEAR_FINAL, theta + NEAR_FINAL
    total, weight = energy(state, top), top.mass * top.gravity
    held = np.full(theta.shape, True)
    for at in (low, high):
        inside = (at > 0.0) & (at < math.pi)
        held &= ~inside | (weight * surface.height(np.cos(at)) > total)
    low, high = np.maximum(low, BESIDE_POLE), np.minimum(high, math.pi - BESIDE_POLE)
    pole = np.where(slope(low) >= 0.0, 0.0, np.where(slope(high) <= 0.0, math.pi, np.nan))
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        falls = slope(middle) < 0.0
        low, high = np.where(falls, middle, low), np.where(falls, high, middle)
    return np.where(held, np.where(np.isnan(pole), 0.5 * (low + high), pole), np.nan)


# translate: skip
def _steady_tilts_near(theta: Array, state: State, top: Top) -> Array:
    """Return the result of `_steady_tilt_near` for many spheres, shape (n,)."""
    integral = jellett(state, top)
    low, high = np.maximum(theta - NEAR_FINAL, 0.0), np.minimum(theta + NEAR_FINAL, math.pi)
    pole = np.where(low == 0.0, 0.0, np.where(high == math.pi, math.pi, theta))
    before = balance_of_moments(low, integral, top, np)
    crosses = before * balance_of_moments(high, integral, top, np) < 0.0
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        same = balance_of_moments(middle, integral, top, np) * before > 0.0
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    return np.where(crosses, 0.5 * (low + high), pole)


def deviation(state: State, top: Top) -> Scalar:
    """Return the deviation of motions from a spin about a vertical or level axis, natural units.

    It is the largest of the horizontal angular momentum, the velocity, and the sine of the angle
    between the axis and the nearest direction in which the body can spin steadily.
    """
    sine, cosine = axis_sine(state.axis), abs(state.axis[2])
    lean = np.where(top.surface.slope(0.0) == 0.0, np.minimum(sine, cosine), sine)
    x, y, _ = state.momentum
    u, v, w = state.velocity
    speed = (u**2 + v**2 + w**2) ** 0.5
    return np.maximum(np.maximum(lean, speed), (x**2 + y**2) ** 0.5)


def is_barred(state: State, top: Top, height: Scalar, at: Scalar) -> Scalar:
    """Return whether the energy is too small for tilts `at`, rad, where it is at least that of the
    centre of mass at a height.

    A sphere that spins for ever needs its least energy at that tilt instead, with its Jellett's
    integral. On a slope, where all energies are reached, no tilt is barred.
    """
    least = -math.inf if slides_down(top) else height
    if acting(top.surface).spherical and spins_for_ever(top) and not isinstance(top.surface, Hull):
        least = least_energy(at, jellett(state, top), top, np)
    return energy(state, top) < least * (1.0 - ROUNDING)


ROUNDING = 1e-12
"""Relative rounding of the energy."""
