"""Prospects of a toy by its body alone: whether it turns over, and can stand on its stem."""

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
from tippetop.problem.problem import Problem, top_of
from tippetop.problem.shapes import EccentricSphere, Meridian, Shape, Sphere
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
    """Conditions for standing on a stem: those of the inverted spin of the sphere at its tip."""

    jellett: float
    """Least Jellett's integral about the tip, -L.a, kg m^3/s; inf if none is enough."""
    spin: float
    """Axial spin of a vertical axis with this integral, rad/s."""
    launch: float
    """Spin of launches, rad/s, that rise slowly on the sphere and have this integral when the tip
    first touches; nan if another surface touches before. Losses while both touch are not included.
    """


@dataclass(frozen=True)
class Touch:
    """First contact of another surface than the ball, and the least spin that leads to it."""

    tilt: float
    """theta, rad."""
    surface: int
    """Number of that surface; 0 if it is the edge of the cut of the ball."""
    spin: float
    """Least spin of launches, rad/s, that would end beyond this tilt on the sphere alone; inf if
    there is none.
    """


@dataclass(frozen=True)
class Prospects:
    """Theoretical results about a toy that is launched on its sphere."""

    eccentricity: float
    """alpha: how far the centre of mass is below the centre of the sphere, in radii."""
    group: Group
    """Group of such eccentric spheres."""
    critical_spins: CriticalSpins
    """Critical spins of launches with tilt `tilt` and no tilt rate, rad/s."""
    tilt: float
    """Tilt of the launches, rad."""
    touch: Touch | None
    """First contact of a second surface; None if there is none."""
    stem: StemTest | None
    """Conditions for standing on the sphere at the other end; None if there is none."""


def prospects(
    body: Body, shapes: list[Shape], gravity: float = 9.8, tilt: float = 0.1
) -> Prospects | None:
    """Return the prospects of a toy; None unless it lies on a sphere, with its centre of mass below
    the centre of that.

    Parameters
    ----------
    body
        The body, of which only the mass and the moments of inertia are used.
    shapes
        Its surfaces, from the one it stands on upright to the one it stands on inverted.
    gravity
        Acceleration of gravity, m/s^2.
    tilt
        Tilt of the launches, rad.
    """
    shapes, cut = _as_balls(shapes)
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
    surfaces = (top_of(problem).surface, *(shape.surface for shape in shapes[1:]))
    touch = _touch(problem, surfaces, group, cut)
    stem = (
        _stem(problem, surfaces, touch)
        if isinstance(shapes[-1], Sphere) and len(shapes) > 1
        else None
    )
    return Prospects(sphere.eccentricity, group, stability_limits(problem), tilt, touch, stem)


def _as_balls(shapes: list[Shape]) -> tuple[list[Shape], float]:
    """Return surfaces with cut balls complete, and the tilt up to which the first one exists."""
    balls, cut = list[Shape](), math.inf
    for number, shape in enumerate(shapes):
        if not isinstance(shape, Meridian):
            balls.append(shape)
            continue
        arcs = shape.surface.arcs
        if number == 0:
            cut = shape.tilts[0]
        if arcs[0 if number == 0 else -1].is_sphere:
            ball = arcs[0 if number == 0 else -1]
            balls.append(Sphere(radius=ball.tube, center=ball.center))
        else:
            balls.append(shape)
    return balls, cut


def _touch(
    problem: Problem, surfaces: tuple[Surface, ...], group: Group, cut: float
) -> Touch | None:
    """Return the first contact beyond the ball: of another surface, or of the edge of its cut."""
    tilt = problem.launch.tilt
    ends = touching_tilts(Hull.of(surfaces), tilt) if len(surfaces) > 1 else {}
    beyond = [at for at in ends if at > tilt]
    first = min([*beyond, cut]) if beyond or cut > tilt else math.inf
    if not math.isfinite(first):
        return None
    # From upright the top rises along the steady precessions until one is stable.
    needed = max(
        critical_jellett(SteadyKind.UPRIGHT, top_of(problem)),
        branch_jellett(first, top_of(problem)),
    )
    spin = jellett_line(problem).spin_at(needed if group.leaves_upright else math.inf)
    return Touch(first, ends.get(first, 0), spin)


def _stem(problem: Problem, surfaces: tuple[Surface, ...], touch: Touch | None) -> StemTest:
    body, inverted = problem.body, SteadyKind.INVERTED
    top = Top.of(body.mass, body.I1, body.I3, surfaces[-1], ViscousLaw(1.0), problem.gravity)
    least, launch = critical_jellett(inverted, top), math.nan
    if touch is not None and touch.surface == len(surfaces) - 1:
        ratio = jellett_ratio(touch.tilt, top_of(problem), surfaces[-1])
        launch = max(
            touch.spin, jellett_line(problem).spin_at(least / ratio) if ratio > 0.0 else math.inf
        )
    return StemTest(least, critical_spin(inverted, top), launch)


def jellett_ratio(tilt: float, top: Top, second: Surface) -> float:
    """Return the ratio of Jellett's integrals about a second surface and about that of the top.

    The motion is that of least energy, with L along I a: the precession without slip, which a slow
    rise approaches.
    """
    axis: Vector = (math.sin(tilt), 0.0, math.cos(tilt))
    arm, new = contact_vector(axis, top.surface), contact_vector(axis, second)
    along, across = dot(arm, axis), top.transverse_inertia
    momentum = add(scale(across, arm), scale((top.axial_inertia - across) * along, axis))
    return float(dot(momentum, new) / dot(momentum, arm))
