"""What a toy can be expected to do, from its body alone: does it turn over, and can it stand on its
stem.
"""

import math
from dataclasses import dataclass

from tippetop.mechanics.laws.friction import ViscousLaw
from tippetop.mechanics.surfaces.hull import Hull
from tippetop.mechanics.surfaces.surface import Surface, contact_vector
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Vector, add, dot, scale
from tippetop.problem.bodies import Body
from tippetop.problem.frictions import ViscousFriction
from tippetop.problem.launch import Launch
from tippetop.problem.problem import Problem
from tippetop.problem.shapes import EccentricSphere, Shape, Sphere
from tippetop.theory.groups import Group, classify
from tippetop.theory.prediction import touching_tilts
from tippetop.theory.steady import SteadyKind, branch_jellett
from tippetop.theory.thresholds import (
    CriticalSpins,
    critical_jellett,
    critical_spin,
    jellett_line,
    stability_limits,
)


@dataclass(frozen=True)
class StemTest:
    """What it takes to stand on a stem: the inverted spin of the sphere at its tip holds above
    this.
    """

    jellett: float
    """Jellett's integral about the tip, -L.a, kg m^3/s; inf if nothing is enough."""
    spin: float
    """The axial spin that goes with it when the axis is vertical, rad/s."""
    launch: float
    """Spin of launches, rad/s, that rise slowly on the sphere and have this integral when the tip
    first touches; nan where something else touches before it. What is lost while both touch comes
    on top.
    """


@dataclass(frozen=True)
class Touch:
    """Where another surface first comes to the table, and what it takes to get there."""

    tilt: float
    """theta, rad."""
    surface: int
    """Number of that surface."""
    spin: float
    """Least spin of launches, rad/s, whose end on the sphere alone is beyond; inf if there is none.
    """


@dataclass(frozen=True)
class Prospects:
    """What is known of a toy that is launched on its sphere."""

    eccentricity: float
    """alpha: how far the centre of mass is below the centre of the sphere, in radii."""
    group: Group
    """How such eccentric spheres behave."""
    critical_spins: CriticalSpins
    """For launches at `tilt`, at rest in tilt, rad/s."""
    tilt: float
    """That tilt, rad."""
    touch: Touch | None
    """Where another surface first touches; None if there is none."""
    stem: StemTest | None
    """What it takes to stand on the sphere at the other end; None if there is none."""


def prospects(
    body: Body, shapes: list[Shape], gravity: float = 9.8, tilt: float = 0.1
) -> Prospects | None:
    """What a toy can be expected to do; None if it does not lie on a sphere, below the centre of
    that.

    Of the body count its mass and moments of inertia; its surfaces are given from the one it stands
    on upright to the one it stands on inverted. `gravity` is in m/s^2, `tilt` that of the launches
    meant, rad.
    """
    sphere = shapes[0]
    if isinstance(sphere, Sphere) and 0.0 < sphere.center < sphere.radius:
        sphere = EccentricSphere(radius=sphere.radius, eccentricity=sphere.center / sphere.radius)
    if not isinstance(sphere, EccentricSphere):
        return None
    problem = Problem(
        body=body.model_copy(update={"shape": sphere}),
        friction=ViscousFriction(mu=1.0),
        launch=Launch(tilt=tilt, spin=0.0),
        gravity=gravity,
    )
    group = classify(body.I1 / body.I3, sphere.eccentricity)
    surfaces = (problem.top.surface, *(shape.surface for shape in shapes[1:]))
    touch = _touch(problem, surfaces, group)
    stem = (
        _stem(problem, surfaces, touch)
        if isinstance(shapes[-1], Sphere) and len(shapes) > 1
        else None
    )
    return Prospects(sphere.eccentricity, group, stability_limits(problem), tilt, touch, stem)


def _touch(problem: Problem, surfaces: tuple[Surface, ...], group: Group) -> Touch | None:
    ends = touching_tilts(Hull.of(surfaces), problem.launch.tilt)
    beyond = [at for at in ends if at > problem.launch.tilt]
    if not beyond:
        return None
    # From upright it rises along the steady precessions once they have no stable one before this
    # tilt.
    needed = max(
        critical_jellett(SteadyKind.UPRIGHT, problem.top), branch_jellett(beyond[0], problem.top)
    )
    spin = jellett_line(problem).spin_at(needed if group.leaves_upright else math.inf)
    return Touch(beyond[0], ends[beyond[0]], spin)


def _stem(problem: Problem, surfaces: tuple[Surface, ...], touch: Touch | None) -> StemTest:
    body, inverted = problem.body, SteadyKind.INVERTED
    top = Top(body.mass, body.I1, body.I3, surfaces[-1], ViscousLaw(1.0), problem.gravity)
    least, launch = critical_jellett(inverted, top), math.nan
    if touch is not None and touch.surface == len(surfaces) - 1:
        share = _handed_over(touch.tilt, problem.top, surfaces[-1])
        launch = max(
            touch.spin, jellett_line(problem).spin_at(least / share) if share > 0.0 else math.inf
        )
    return StemTest(least, critical_spin(inverted, top), launch)


def _handed_over(tilt: float, top: Top, other: Surface) -> float:
    """Jellett's integral about another surface, of the motion that has the least energy with that
    of one: 1.

    That motion, L along I a, is the precession without slip, to which a rise comes the closer the
    slower.
    """
    axis: Vector = (math.sin(tilt), 0.0, math.cos(tilt))
    arm, new = contact_vector(axis, top.surface), contact_vector(axis, other)
    along, across = dot(arm, axis), top.transverse_inertia
    momentum = add(scale(across, arm), scale((top.axial_inertia - across) * along, axis))
    return float(dot(momentum, new) / dot(momentum, arm))
