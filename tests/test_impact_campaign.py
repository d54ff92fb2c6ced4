"""Impacts of one surface while another is closed, against another solver of the same process."""

import math

import numpy as np
import pytest
from scipy.optimize import brentq

from brute_impacts import Law, Struck, Unknown, struck
from campaigns import seeds
from tippetop.contact.impact import impact
from tippetop.mechanics.laws.contensou import EllipsoidalLaw
from tippetop.mechanics.laws.contensou_hertz import HertzLaw
from tippetop.mechanics.laws.coulomb import CoulombLaw, RollingResistance
from tippetop.mechanics.laws.friction import RegularizedCoulombLaw, ViscousLaw
from tippetop.mechanics.state import State
from tippetop.mechanics.surfaces.hull import Hull
from tippetop.mechanics.surfaces.surface import SphereSurface, SpheroidSurface
from tippetop.mechanics.top import Top

LAWS = {
    "coulomb": CoulombLaw,
    "ellipsoidal": EllipsoidalLaw,
    "hertz": HertzLaw,
    "viscous": ViscousLaw,
    "regularized": RegularizedCoulombLaw,
}


def touching_at(first, second):
    """Tilts at which two surfaces touch at once, from their support functions."""
    across, along, centre = second
    cosines = np.linspace(-0.98, 0.98, 400)

    def apart(c):
        height = math.sqrt(across**2 * (1.0 - c * c) + along**2 * c * c) - centre * c
        return first[0] - first[1] * c - height

    values = [apart(c) for c in cosines]
    return [
        brentq(apart, a, b, xtol=1e-15)
        for a, b, x, y in zip(cosines[:-1], cosines[1:], values[:-1], values[1:], strict=True)
        if x * y < 0.0
    ]


def drawn(seed):
    """A body on two surfaces, of which the second strikes, in units of mass and size; and the same
    for the package.
    """
    random = np.random.default_rng(seed)
    while True:
        sphere = 1.0, random.uniform(-0.6, 3.0)
        spheroid = random.uniform(0.2, 1.2), random.uniform(0.2, 1.2), random.uniform(-4.0, 2.0)
        tilts = touching_at(sphere, spheroid)
        if tilts:
            break
    c = tilts[random.integers(len(tilts))]
    s, azimuth = math.sqrt(1.0 - c * c), random.uniform(-math.pi, math.pi)
    axis = np.array([s * math.cos(azimuth), s * math.sin(azimuth), c])
    root = math.sqrt(spheroid[0] ** 2 * s * s + spheroid[1] ** 2 * c * c)
    slopes = [-sphere[1], (spheroid[1] ** 2 - spheroid[0] ** 2) * c / root - spheroid[2]]
    height = sphere[0] - sphere[1] * c
    up = np.array([0.0, 0.0, 1.0])
    arms = [-slope * (axis - c * up) - height * up for slope in slopes]
    inertia = random.uniform(0.2, 1.5)
    inertias = inertia, random.uniform(0.3, 1.6) * inertia
    name = list(LAWS)[random.integers(len(LAWS))]
    law = Law(name, random.uniform(0.05, 1.0))
    speed = 10.0 ** random.uniform(-1.0, 0.7)
    if name == "viscous":
        law.mu /= 3.0 * speed
    if name in ("ellipsoidal", "hertz") or name == "regularized":
        law.scale = 10.0 ** random.uniform(-2.0, 0.0)
    rolling = 10.0 ** random.uniform(-3.0, -1.0) if random.random() < 0.3 else 0.0
    order = [0, 1] if random.random() < 0.5 else [1, 0]
    body = Struck(1.0, inertias, axis, [arms[k] for k in order], law, rolling)
    # No normal velocity of the second contact, and an approach of 1 of the first, by the velocity
    # of the centre of mass and the angular velocity that tilts.
    velocities = speed * random.normal(size=6)
    rows = np.array([body.rows[0][0], body.rows[1][0]])
    velocities -= np.linalg.pinv(rows) @ (rows @ velocities - np.array([-1.0, 0.0]))
    numbers = (law.mu,) if not law.scale else (law.mu, law.scale)
    hull = Hull.of((SphereSurface(*sphere), SpheroidSurface(*spheroid)))
    resistance = RollingResistance(rolling) if rolling else None
    top = Top.of(1.0, *inertias, hull, LAWS[name](*numbers), 1.0, resistance)
    omega = velocities[3:]
    momentum = inertias[0] * omega + (inertias[1] - inertias[0]) * (omega @ axis) * axis
    state = State(tuple(axis), tuple(momentum), tuple(velocities[:3]), height)
    restitution = 0.5 if random.random() < 0.25 else 0.0
    return body, velocities, state, [top.body.contacts[k] for k in order], restitution


@pytest.mark.parametrize("seed", seeds(check=4, sample=40, claim=500))
def test_an_impact_beside_a_closed_contact_is_that_of_small_steps(seed):
    """Velocities, and the second contact, whose normal velocity never falls below zero.

    Where friction jams a contact (Painleve's paradox), or Hertz's patch sticks, small steps do not
    tell what follows.
    """
    try:
        body, velocities, state, tops, restitution = drawn(seed)
        after, impulse, least = struck(body, velocities, restitution)
    except Unknown:
        return
    assert least > -1e-9
    result = impact(state, restitution, *tops)
    first, third = body.inertias
    momentum = np.array(result.state.momentum)
    omega = momentum / first + (1.0 / third - 1.0 / first) * (momentum @ body.axis) * body.axis
    ours = np.array([*result.state.velocity, *omega])
    change = np.linalg.norm(after - velocities)
    assert np.linalg.norm(ours - after) < 1e-6 * change
    assert body.rows[1][0] @ ours > -1e-12
    assert result.impulse >= impulse * (1.0 - 1e-6)
