"""Full runs on a table that may pull, to hold the theory against, and random tops for it."""

import math

import numpy as np
from hypothesis import strategies as st

from strategies import numbers
from tippetop.contact.contact_mode import sliding_motion
from tippetop.integrators import make_integrator
from tippetop.integrators.dense import DenseSolution
from tippetop.mechanics.laws.friction import ViscousLaw
from tippetop.mechanics.motion import along_table
from tippetop.mechanics.surfaces.surface import SphereSurface
from tippetop.mechanics.top import Top, natural_units
from tippetop.problem.problem import Problem, top_of

RADIUS, MASS, GRAVITY, AXIAL_INERTIA = 0.02, 0.02, 9.8, 3.2e-6


def full_run(problem, times, smooth=False):
    """Axis, angular momentum and horizontal velocity of a sliding top, SI, in rows."""
    top = top_of(problem)
    if smooth:
        top = top.altered(friction=ViscousLaw(0.0))
    units = natural_units(top)
    start = along_table(problem.start())
    momentum = [number / units.angular_momentum for number in start.momentum]
    begin = np.array([*start.axis, *momentum, *(number / units.speed for number in start.velocity)])
    if smooth:
        begin[6:8] = 0.0
    natural = np.asarray(times, dtype=float) / units.time
    arcs = list(
        make_integrator().integrate(
            sliding_motion(top.kind, False), top.numbers, (0.0, begin), natural[-1]
        )
    )
    assert arcs[-1].failure is None
    states = DenseSolution.joined([arc.solution for arc in arcs])(natural)
    return states[:, :3], states[:, 3:6] * units.angular_momentum, states[:, 6:8] * units.speed


def tilts_of(axis):
    """Tilt from the axis, accurate at both poles."""
    return np.arctan2(np.hypot(axis[:, 0], axis[:, 1]), axis[:, 2])


def sphere(gamma, alpha, mu=0.3):
    """An eccentric sphere with this inertia ratio and eccentricity."""
    shape = SphereSurface(RADIUS, alpha * RADIUS)
    return Top.of(MASS, gamma * AXIAL_INERTIA, AXIAL_INERTIA, shape, ViscousLaw(mu), GRAVITY)


def sphere_problem(gamma, alpha, tilt, spin, mu=0.3):
    """A launch at rest in tilt of such a sphere."""
    return Problem(
        body={
            "mass": MASS,
            "shape": {"kind": "eccentric_sphere", "radius": RADIUS, "eccentricity": alpha},
            "I1": gamma * AXIAL_INERTIA,
            "I3": AXIAL_INERTIA,
        },
        friction={"kind": "viscous", "mu": mu},
        launch={"tilt": tilt, "spin": spin},
        contact={"liftoff": "ignore"},
        gravity=GRAVITY,
    )


def jellett_unit(top):
    """sqrt(m g R^3 I3 alpha), in which the thresholds are numbers of gamma and alpha."""
    radius, center = top.surface
    alpha = center / radius
    return math.sqrt(top.mass * top.gravity * radius**3 * top.axial_inertia * alpha)


gammas, alphas = numbers(0.5, 2.0), numbers(0.02, 0.9)
all_spheres = st.builds(sphere, gammas, alphas, numbers(0.01, 1.0))
"""Eccentric spheres of every group."""
