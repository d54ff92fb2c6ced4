"""Random tops, motions and problems that can exist, for hypothesis."""

import math

from hypothesis import assume, reject
from hypothesis import strategies as st

from tippetop.mechanics.laws.friction import RegularizedCoulombLaw, ViscousLaw
from tippetop.mechanics.motion import sliding_contact
from tippetop.mechanics.state import SlidingState
from tippetop.mechanics.surfaces.surface import SphereSurface, SpheroidSurface
from tippetop.mechanics.top import Top
from tippetop.mechanics.view import Angles
from tippetop.problem.problem import Problem
from tippetop.support.errors import InvalidInput


def numbers(low, high):
    """Floats in a closed interval: zero, or not so small that squares of them vanish."""
    return st.floats(low, high, allow_subnormal=False).map(lambda x: 0.0 if abs(x) < 1e-12 else x)


def spheres():
    """Eccentric spheres from a bead to a melon."""
    return st.builds(
        lambda radius, alpha: SphereSurface(radius, alpha * radius),
        numbers(0.005, 0.1),
        numbers(0.05, 0.6),
    )


def spheroids():
    """Spheroids from a lentil to an egg."""
    return st.builds(
        lambda across, ratio: SpheroidSurface(across, ratio * across),
        numbers(0.005, 0.1),
        numbers(0.5, 2.0),
    )


@st.composite
def tops(draw, shapes=None, friction_laws=(ViscousLaw, RegularizedCoulombLaw)):
    """Bodies of revolution on a rough table, with inertias that a body can have."""
    shape = draw(shapes if shapes is not None else st.one_of(spheres(), spheroids()))
    mass, gravity = draw(numbers(0.001, 1.0)), draw(numbers(1.6, 25.0))
    speed = math.sqrt(gravity * shape.size)
    transverse = draw(numbers(0.2, 1.0)) * mass * shape.size**2
    axial = draw(numbers(0.2, 2.0)) * transverse
    law = draw(st.sampled_from(friction_laws))
    mu = draw(numbers(0.0, 1.0))
    friction = law(mu / speed) if law is ViscousLaw else law(mu, draw(numbers(1e-3, 1.0)) * speed)
    return Top.of(mass, transverse, axial, shape, friction, gravity)


@st.composite
def unit_vectors(draw, shortest_sine=0.0):
    """Directions in space; none closer to the vertical than this sine."""
    tilt = draw(numbers(math.asin(shortest_sine), math.pi - math.asin(shortest_sine)))
    azimuth = draw(numbers(-math.pi, math.pi))
    return (math.sin(tilt) * math.cos(azimuth), math.sin(tilt) * math.sin(azimuth), math.cos(tilt))


@st.composite
def sliding_states(draw, top):
    """Motions of this top on its table, brisk but consistent with a contact force."""
    axis = draw(unit_vectors())
    speed = math.sqrt(top.gravity * top.surface.size)
    spin = 10.0 * top.axial_inertia * speed / top.surface.size
    momentum = tuple(spin * draw(numbers(-1.0, 1.0)) for _ in range(3))
    velocity = tuple(speed * draw(numbers(-1.0, 1.0)) for _ in range(2))
    assume(top.mass * sliding_contact(axis, momentum, velocity, top).delassus > 0.05)
    return SlidingState(axis, momentum, velocity)


@st.composite
def slides(draw, top_strategy=None):
    """A top and a motion of it: a pair."""
    top = draw(top_strategy if top_strategy is not None else tops())
    return top, draw(sliding_states(top))


@st.composite
def angles(draw, top, lowest_tilt=0.01):
    """Motions of this top in Euler angles, no closer to the vertical than this tilt."""
    speed = math.sqrt(top.gravity * top.surface.size)
    rate = 10.0 * speed / top.surface.size
    return Angles(
        tilt=draw(numbers(lowest_tilt, math.pi - lowest_tilt)),
        tilt_rate=rate * draw(numbers(-1.0, 1.0)),
        azimuth=draw(numbers(-math.pi, math.pi)),
        precession=rate * draw(numbers(-1.0, 1.0)),
        spin=rate * draw(numbers(-1.0, 1.0)),
        slip=(speed * draw(numbers(-1.0, 1.0)), speed * draw(numbers(-1.0, 1.0))),
    )


@st.composite
def problems(draw):
    """Problems in all their variety, as dictionaries would describe them."""
    radius = draw(numbers(1e-3, 1.0))
    shape = draw(
        st.one_of(
            st.builds(
                lambda e: {"kind": "eccentric_sphere", "radius": radius, "eccentricity": e},
                numbers(1e-6, 0.999),
            ),
            st.builds(
                lambda k: {"kind": "spheroid", "across": radius, "along": k * radius},
                numbers(0.1, 10.0),
            ),
        )
    )
    friction = draw(
        st.one_of(
            st.builds(lambda mu: {"kind": "viscous", "mu": mu}, numbers(0.0, 10.0)),
            st.builds(
                lambda mu, eps: {"kind": "regularized_coulomb", "mu": mu, "eps": eps},
                numbers(0.0, 1.0),
                numbers(1e-6, 1.0),
            ),
        )
    )
    mass = draw(numbers(1e-4, 10.0))
    transverse = draw(numbers(0.1, 1.0)) * mass * radius**2
    rates = numbers(-500.0, 500.0)
    launch = {
        "tilt": draw(st.one_of(st.sampled_from([0.0, math.pi]), numbers(0.0, math.pi))),
        "spin": draw(rates),
        "azimuth": draw(numbers(-10.0, 10.0)),
        "tilt_rate": draw(rates),
        "precession": draw(rates),
        "slip": (draw(numbers(-1.0, 1.0)), draw(numbers(-1.0, 1.0))),
    }
    liftoff = draw(st.sampled_from(["fly", "stop", "ignore"]))
    if liftoff == "fly":
        launch["gap"] = draw(numbers(0.0, 1.0))
        if launch["gap"] or draw(st.booleans()):
            launch["velocity"] = tuple(draw(numbers(-1.0, 1.0)) for _ in range(3))
            del launch["slip"]
    body = {
        "mass": mass,
        "shape": shape,
        "I1": transverse,
        "I3": draw(numbers(0.01, 2.0)) * transverse,
    }
    try:
        return Problem(
            body=body,
            friction=friction,
            launch=launch,
            contact={"liftoff": liftoff, "restitution": draw(numbers(0.0, 1.0))},
            gravity=draw(numbers(0.1, 100.0)),
        )
    except InvalidInput as refusal:
        if refusal.field != "launch.slip":
            raise
        reject()
