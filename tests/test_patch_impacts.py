"""Impacts under every law, against integrations of the whole law by other means."""

import math
from itertools import product

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import tippetop as tt
from campaigns import among, seeds
from tippetop.contact.automaton import Automaton
from tippetop.contact.impact import impact
from tippetop.integrators import make_integrator
from tippetop.mechanics.contacts.slip_variables import slip_of
from tippetop.mechanics.invariants import energy
from tippetop.mechanics.laws.contensou import EllipsoidalLaw
from tippetop.mechanics.laws.contensou_hertz import HertzLaw
from tippetop.mechanics.laws.coulomb import CoulombLaw, RollingResistance
from tippetop.mechanics.laws.friction import RegularizedCoulombLaw, ViscousLaw
from tippetop.mechanics.motion import (
    along_table,
    angular_velocity,
    moment_per_normal_force,
    on_table,
    point_velocity,
)
from tippetop.mechanics.state import SlidingState, State
from tippetop.mechanics.surfaces.surface import SphereSurface, contact_vector
from tippetop.mechanics.top import Top

TAYLOR = make_integrator("taylor")


def struck_top(law, random):
    """A top that comes down on the table, in natural units."""
    top = Top.of(1.0, 0.45, 0.38, SphereSurface(1.0, 0.3), law, 1.0)
    axis = random.normal(size=3)
    axis /= np.linalg.norm(axis)
    sliding = SlidingState(tuple(axis), tuple(random.normal(size=3)), tuple(random.normal(size=2)))
    state = on_table(sliding, top)
    velocity = (*state.velocity[:2], state.velocity[2] - random.uniform(0.1, 2.0))
    return state._replace(velocity=velocity), top


def integrated(state, top):
    """State and normal impulse where the contact point stops sinking, by SciPy and with the whole
    law.
    """
    arm = contact_vector(state.axis, top.surface)

    def now(y):
        return State(state.axis, tuple(y[:3]), tuple(y[3:]), state.height)

    def rates(_, y):
        here = now(y)
        turning = angular_velocity(here.axis, here.momentum, top)
        slip = point_velocity(here.velocity, turning, arm)[:2]
        traction = top.traction(slip, turning)
        x, z = traction.force
        return [*moment_per_normal_force(arm, traction), x / top.mass, z / top.mass, 1.0 / top.mass]

    def sinking(_, y):
        here = now(y)
        turning = angular_velocity(here.axis, here.momentum, top)
        return point_velocity(here.velocity, turning, arm)[2]

    sinking.terminal, sinking.direction = True, 1.0
    start = [*state.momentum, *state.velocity]
    found = solve_ivp(
        rates,
        (0.0, 100.0),
        start,
        method="DOP853",
        events=sinking,
        rtol=1e-13,
        atol=1e-14,
        max_step=0.05,
    )
    assert found.status == 1
    return now(found.y[:, -1]), found.t[-1]


@pytest.mark.parametrize("law", [EllipsoidalLaw, HertzLaw])
def test_an_impact_of_a_patch_is_the_integrated_one(law):
    random, changed = np.random.default_rng(5), 0
    for _ in range(60):
        state, top = struck_top(law(0.3, random.uniform(0.02, 0.6)), random)
        mine = impact(state, 0.0, top, integrator=TAYLOR)
        then, impulse = integrated(state, top)
        assert mine.state.momentum == pytest.approx(then.momentum, abs=1e-11)
        assert mine.state.velocity == pytest.approx(then.velocity, abs=1e-11)
        assert mine.impulse == pytest.approx(impulse, abs=1e-11)
        assert mine.energy_lost == pytest.approx(energy(state, top) - energy(then, top), abs=1e-11)
        if law is HertzLaw:
            changed += len({drills(one, top) for one in (state, mine.state)}) - 1
    assert law is EllipsoidalLaw or changed > 5, "in some the other branch should take over"


LAWS = {
    "viscous": ViscousLaw(0.3),
    "regularized": RegularizedCoulombLaw(0.3, 0.5),
    "coulomb": CoulombLaw(0.3),
    "ellipsoidal": EllipsoidalLaw(0.3, 0.4),
    "hertz": HertzLaw(0.3, 0.4),
}


def by_gauss(state, top, impulse, steps=4000):
    """State after a normal impulse, with the whole law and extended precision: two series of steps
    of order four, and what is left of their error taken away.
    """
    arm = contact_vector(state.axis, top.surface)
    start = np.array([*state.momentum, *state.velocity], dtype=np.longdouble)

    def rates(y):
        turning = angular_velocity(state.axis, tuple(y[:3]), top)
        slip = point_velocity(tuple(y[3:]), turning, arm)[:2]
        traction = top.traction(slip, turning)
        x, z = traction.force
        return np.array([*moment_per_normal_force(arm, traction), x, z, np.longdouble(1.0)])

    def stepped(count):
        y, h = start, np.longdouble(impulse) / count
        for _ in range(count):
            one = rates(y)
            two = rates(y + h / 2 * one)
            three = rates(y + h / 2 * two)
            four = rates(y + h * three)
            y = y + h / 6 * (one + 2 * two + 2 * three + four)
        return y

    coarse, fine = stepped(steps // 2), stepped(steps)
    return (fine + (fine - coarse) / 15).astype(float)


@pytest.mark.parametrize(("name", "arm"), among(list(product(LAWS, (None, 0.02))), check=7))
@pytest.mark.parametrize("seed", seeds(check=1, sample=2, claim=2))
def test_impacts_are_right_to_rounding_under_every_law(name, arm, seed):
    random, resistance = np.random.default_rng(3 + seed), arm and RollingResistance(arm)
    while True:
        state, top = struck_top(LAWS[name], random)
        top = top.altered(rolling_resistance=resistance)
        mine = impact(state, 0.0, top)
        slip = math.hypot(*slip_of(*along_table(mine.state), top))
        if slip < 0.1 or math.hypot(*mine.state.momentum[:2]) < 0.2:
            continue  # Near an end of slip the steps of a fixed size are not so exact.
        last = by_gauss(state, top, mine.impulse)
        found = np.array([*mine.state.momentum, *mine.state.velocity])
        assert np.abs(found - last).max() < 2e-14
        return


def drills(state, top):
    """Whether drilling prevails."""
    return bool(top.friction.drills(slip_of(*along_table(state), top)))


def test_an_impact_is_the_same_by_any_integrator():
    random = np.random.default_rng(7)
    for law in LAWS.values():
        state, top = struck_top(law, random)
        ours, theirs = (
            impact(state, 0.4, top, integrator=make_integrator(name))
            for name in ("taylor", "dop853")
        )
        assert theirs.impulse == pytest.approx(ours.impulse, rel=1e-10)
        assert theirs.state.pack() == pytest.approx(ours.state.pack(), abs=1e-10)


def test_a_touchdown_is_the_impact():
    state, top = struck_top(HertzLaw(0.3, 0.1), np.random.default_rng(9))
    for restitution in (0.0, 0.5):
        automaton = Automaton(top, "fly", restitution)
        following = automaton.touchdown(top, 1.0, state)
        assert following.events[1].impulse == impact(state, restitution, top).impulse


@pytest.mark.parametrize(("tilt", "spin"), [(0.0, 0.0), (0.3, 0.0), (0.3, 1e-10)])
@pytest.mark.parametrize("restitution", [0.0, 0.5])
def test_a_patch_that_hardly_drills_strikes_as_a_point_does(tilt, spin, restitution):
    """In a plane Hertz's patch has Coulomb's friction, mu N, and slip ends without drilling."""
    launch = tt.Launch(tilt=tilt, spin=spin, gap=0.02, velocity=(0.3, 0.0, 0.0))
    patch = tt.ContensouFriction(mu=0.3, patch_radius=1e-3, pressure="hertz")
    contact = tt.Contact(restitution=restitution)
    events = []
    for friction in (patch, tt.CoulombFriction(mu=0.3)):
        problem = tt.Problem(
            body=tt.presets.body("report"), friction=friction, launch=launch, contact=contact
        )
        run = tt.simulate(problem, 0.07, samples=2)
        assert run.attrs["status"] == "completed"
        events.append([float(run[name][1]) for name in ("event_impulse", "event_energy_lost")])
    assert events[0] == pytest.approx(events[1], rel=max(1e-11, 10.0 * spin))
