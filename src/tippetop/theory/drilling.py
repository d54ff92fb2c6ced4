"""Drilling: what the table's torque takes from a top that stands, and how long that top can stand.

A torque M about the vertical changes Jellett's integral of a sphere at the rate lambda' = M h, h
the height of the centre of mass. Under Contensou's friction with a patch of radius R a steady
state, which has no slip, feels M = -(3 pi / 16) mu m g R, whatever its spin and for both pressures:
lambda' is a slow clock. A vertical spin loses |M| / I3 per second, exactly, and stands until too
little is left for stability.

The torque takes from the vertical part of L alone, so that L leans the more the less of it is left:
while the spin is stable, a small tilt decays as its eigenvalue says and grows as 1 / omega3, which
is often quicker.
"""

import math

import numpy as np

from tippetop.mechanics.contacts.forces import is_set_valued
from tippetop.mechanics.motion import angular_velocity, contact
from tippetop.mechanics.top import Top
from tippetop.problem.problem import Problem, require_problem
from tippetop.support.errors import Described, InvalidInput
from tippetop.theory.requirements import require_creep, require_sphere
from tippetop.theory.stability import drilling, spectrum
from tippetop.theory.steady import (
    VERTICAL_SPINS,
    SteadyKind,
    SteadyState,
    jellett_of_launch,
    state_of,
    vertical_spin,
)
from tippetop.theory.thresholds import critical_spin, stands


def spin_rate(steady: SteadyState[float], top: Top) -> float:
    """Rate omega3' of the axial spin that drilling takes from a vertical spin, rad/s^2; 0 without
    drilling.

    Raises `InvalidInput` if friction has no linear motion about a vertical spin.
    """
    axis, momentum, velocity = state_of(steady, top)
    turning = angular_velocity(axis, momentum, top)[2]
    # On the branch of a law that drills without slip.
    touch = contact(axis, momentum, velocity, drilling(top, np.array([turning])))
    return float(touch.torque[2]) * math.cos(steady.tilt) / float(top.axial_inertia)


def standing_time(problem: Problem) -> float:
    """How long drilling lets a vertical spin stand, s: until it is stable no longer, or turns no
    more.

    Exact for a launch at tilt 0 or pi, which the torque of drilling alone changes. For any other
    launch of an eccentric sphere it is the time of the inverted spin with its Jellett's integral:
    how long it could stand if it turned over at once. inf without drilling, and 0 where the spin is
    not stable to begin with, or the centre of mass is not above the table. A small tilt may grow
    meanwhile, but hardly more than as 1 / omega3.

    Raises
    ------
    InvalidInput
        If there is no linear motion about a vertical spin: a dry point rubs, rolling is resisted,
        or nothing spins. If a body other than an eccentric sphere is not launched at tilt 0 or pi,
        or it has several surfaces.

    Examples
    --------
    >>> import tippetop as tt
    >>> patch = {"friction.kind": "contensou", "friction.patch_radius": 1e-3}
    >>> round(tt.standing_time(tt.presets.report_problem().replace(patch)), 2)  # s, upside down
    3.84
    >>> tt.standing_time(tt.presets.report_problem())  # viscous friction does not drill
    inf
    """
    require_problem(problem)
    top, tilt = problem.top, problem.launch.tilt
    require_creep(top)
    if tilt not in (0.0, math.pi):
        require_sphere(top)
    kind = SteadyKind.INVERTED if tilt else SteadyKind.UPRIGHT
    if not stands(kind, top):  # and no spin has any lambda
        return 0.0
    spin = jellett_of_launch(problem) / vertical_spin(kind, top, 1.0).jellett
    return time_to_stand(vertical_spin(kind, top, spin), top)


def time_to_stand(steady: SteadyState[float], top: Top) -> float:
    """How long drilling lets a vertical spin stand, s; see `standing_time`.

    Raises `InvalidInput` if it is another steady state, there is no linear motion about it, or a
    torque changes with the spin.
    """
    if steady.kind not in VERTICAL_SPINS:
        raise InvalidInput("kind", steady.kind.value, "a vertical spin")
    if not (top.friction.torque_free or is_set_valued(top.friction)):
        raise InvalidInput(
            "friction", Described("this law"), "Contensou friction, or one without torque"
        )
    if not spectrum(steady, top).stable:
        return 0.0
    rate, spin = abs(spin_rate(steady, top)), abs(steady.spin)
    if rate == 0.0:
        return math.inf
    limit = critical_spin(steady.kind, top)
    return (spin - limit if limit < spin else spin) / rate
