"""Drilling friction: loss of spin of a standing top, and the time for which it can stand.

A torque M about the vertical changes Jellett's integral of a sphere at the rate lambda' = M h, h
the height of the centre of mass. Under Contensou's friction with a patch of radius R a steady
state, which has no slip, has the torque M = -(3 pi / 16) mu m g R at any spin and for both
pressures. A vertical spin loses |M| / I3 per second, exactly, and stands until its spin falls below
the threshold of stability.

The torque reduces only the vertical component of L, so that L leans more as that decreases: while
the spin is stable, a small tilt decays at the rate of its eigenvalue and grows as 1 / omega3, which
is often faster.
"""

import math

import numpy as np

from tippetop.mechanics.contacts.forces import is_set_valued
from tippetop.mechanics.motion import angular_velocity, sliding_contact
from tippetop.mechanics.surfaces.hull import Hull
from tippetop.mechanics.top import Top
from tippetop.problem.problem import Problem, require_problem, top_of
from tippetop.support.errors import Described, InvalidInput
from tippetop.theory.prediction import hull_of, on_surface, touching_tilts
from tippetop.theory.prospects import jellett_ratio
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
from tippetop.theory.thresholds import can_stand, critical_spin


def spin_rate(steady: SteadyState[float], top: Top) -> float:
    """Return the rate omega3' of a vertical spin by drilling, rad/s^2; 0 without drilling.

    Raises `InvalidInput` if friction has no linear motion about a vertical spin.
    """
    axis, momentum, velocity = state_of(steady, top)
    turning = angular_velocity(axis, momentum, top)[2]
    # `drilling` gives the branch of the law for drilling without slip.
    touch = sliding_contact(axis, momentum, velocity, drilling(top, np.array([turning])))
    return float(touch.torque[2]) * math.cos(steady.tilt) / float(top.axial_inertia)


def standing_time(problem: Problem) -> float:
    """Return the time, s, after which drilling has made a vertical spin unstable or stopped it.

    The time is exact for a launch at tilt 0 or pi, which only the drilling torque changes. For any
    other launch of an eccentric sphere it is that of the inverted spin with its Jellett's integral:
    the time for which it could stand if it turned over at once. A sphere with a stem then stands on
    the stem, with the integral that the precession without slip has about its tip where that first
    touches; what is lost while both touch is left out. The result is inf without drilling,
    and 0 if the spin is unstable from the start or the centre of mass is not above the table. A
    small tilt may grow meanwhile, but hardly faster than 1 / omega3.

    Raises
    ------
    InvalidInput
        If there is no linear motion about a vertical spin: under dry friction of a point, with
        rolling resistance, or without spin. If a body other than an eccentric sphere, or one whose
        stem is not the first to touch, is not launched at tilt 0 or pi.

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
    top, tilt = top_of(problem), problem.launch.tilt
    if isinstance(top.surface, Hull):
        return _standing_time_of_several_surfaces(problem)
    require_creep(top)
    if tilt not in (0.0, math.pi):
        require_sphere(top)
    kind = SteadyKind.INVERTED if tilt else SteadyKind.UPRIGHT
    if not can_stand(kind, top):  # lambda of any spin may then be 0
        return 0.0
    spin = jellett_of_launch(problem) / vertical_spin(kind, top, 1.0).jellett
    return time_to_stand(vertical_spin(kind, top, spin), top)


def _standing_time_of_several_surfaces(problem: Problem) -> float:
    hull, tilt = hull_of(problem), problem.launch.tilt
    single = on_surface(problem, hull.active)
    ends = touching_tilts(hull, tilt)
    beyond = [at for at in ends if at > tilt]
    if tilt in (0.0, math.pi) or not beyond:
        return standing_time(single)
    sphere, number = top_of(single), ends[beyond[0]]
    require_creep(sphere)
    require_sphere(sphere)
    stem = top_of(on_surface(problem, number))
    inverted = SteadyKind.INVERTED
    if not stem.surface.spherical or hull.height(-1.0) > stem.surface.height(-1.0):
        raise InvalidInput(
            "body.shape",
            Described(f"one whose surface {number} touches first"),
            "a sphere with a stem that is round at its end, or a launch at tilt 0 or pi",
        )
    if not can_stand(inverted, stem):
        return 0.0
    integral = jellett_of_launch(single) * jellett_ratio(beyond[0], sphere, stem.surface)
    spin = integral / vertical_spin(inverted, stem, 1.0).jellett
    return time_to_stand(vertical_spin(inverted, stem, spin), stem)


def time_to_stand(steady: SteadyState[float], top: Top) -> float:
    """Return the time for which drilling lets a vertical spin stand, s; see `standing_time`.

    Raises `InvalidInput` if the steady state is another one, there is no linear motion about it, or
    the torque depends on the spin.
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
