"""Impacts of patches followed as motions, against an integration of the whole law by other
means.
"""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tippetop.contact.automaton import Automaton
from tippetop.contact.striking import impact_of_patch
from tippetop.integrators import make_integrator
from tippetop.mechanics.contacts.slip_variables import slip_of
from tippetop.mechanics.impacts.struck_body import contact_velocity
from tippetop.mechanics.invariants import energy
from tippetop.mechanics.laws.contensou import EllipsoidalLaw
from tippetop.mechanics.laws.contensou_hertz import HertzLaw
from tippetop.mechanics.laws.coulomb import CoulombLaw, RollingResistance
from tippetop.mechanics.laws.friction import ViscousLaw
from tippetop.mechanics.motion import (
    along_table,
    angular_velocity,
    moment_per_normal_force,
    on_table,
)
from tippetop.mechanics.state import SlidingState, State
from tippetop.mechanics.surfaces.surface import SphereSurface, contact_vector
from tippetop.mechanics.top import Top

TAYLOR = make_integrator("taylor")


def struck_top(law, random):
    """A top that comes down on the table, in natural units."""
    top = Top(1.0, 0.45, 0.38, SphereSurface(1.0, 0.3), law, 1.0)
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
        slip = contact_velocity(here, arm, top)[:2]
        traction = top.friction.traction(slip, angular_velocity(here.axis, here.momentum, top))
        x, z = traction.force
        return [*moment_per_normal_force(arm, traction), x / top.mass, z / top.mass, 1.0 / top.mass]

    def sinking(_, y):
        return contact_velocity(now(y), arm, top)[2]

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
    random, changed, found = np.random.default_rng(5), 0, 0
    for _ in range(60):
        state, top = struck_top(law(0.3, random.uniform(0.02, 0.6)), random)
        mine = impact_of_patch(state, top, TAYLOR)
        if mine is None:
            continue
        found += 1
        then, impulse = integrated(state, top)
        assert mine.state.momentum == pytest.approx(then.momentum, abs=1e-11)
        assert mine.state.velocity == pytest.approx(then.velocity, abs=1e-11)
        assert mine.impulse == pytest.approx(impulse, abs=1e-11)
        assert mine.energy_lost == pytest.approx(energy(state, top) - energy(then, top), abs=1e-11)
        if law is HertzLaw:
            changed += len({drills(one, top) for one in (state, mine.state)}) - 1
    assert found > 55, "slip seldom ends in an impact of a patch that drills"
    assert law is EllipsoidalLaw or changed > 5, "in some the other branch should take over"


def drills(state, top):
    """Whether drilling prevails."""
    return bool(top.friction.drills(slip_of(*along_table(state), top)))


def test_impacts_are_left_to_other_ways_where_this_is_none():
    random = np.random.default_rng(7)
    patch = EllipsoidalLaw(0.3, 0.1)
    for law in (ViscousLaw(0.3), CoulombLaw(0.3)):
        state, top = struck_top(law, random)
        assert impact_of_patch(state, top, TAYLOR) is None
    state, top = struck_top(patch, random)
    resisted = top._replace(rolling_resistance=RollingResistance(0.01))
    assert impact_of_patch(state, resisted, TAYLOR) is None
    assert impact_of_patch(state, top, None) is None
    x, y, z = state.velocity
    assert impact_of_patch(state._replace(velocity=(x, y, z + 9.0)), top, TAYLOR) is None
    impact = impact_of_patch(state, top, TAYLOR)
    by_another = impact_of_patch(state, top, make_integrator("dop853"))
    assert impact is not None
    assert by_another is not None
    assert by_another.impulse == pytest.approx(impact.impulse, rel=1e-10)


def test_slip_and_drilling_that_end_in_an_impact_are_left_to_what_knows_that():
    top = Top(1.0, 0.45, 0.38, SphereSurface(1.0, 0.3), EllipsoidalLaw(0.9, 0.5), 1.0)
    state = on_table(SlidingState((0.0, 0.0, 1.0), (0.0, 0.0, 0.02), (0.05, 0.0)), top)
    state = state._replace(velocity=(*state.velocity[:2], -3.0))
    assert impact_of_patch(state, top, TAYLOR) is None


def test_a_touchdown_takes_this_way_where_nothing_is_given_back():
    state, top = struck_top(HertzLaw(0.3, 0.1), np.random.default_rng(9))
    for restitution in (0.0, 0.5):
        automaton = Automaton(top, "fly", restitution)
        ours, theirs = (automaton.touchdown(top, 1.0, state, way) for way in (TAYLOR, None))
        assert [event.kind for event in ours.events] == [event.kind for event in theirs.events]
        assert type(ours.next) is type(theirs.next)
        assert ours.state.pack() == pytest.approx(theirs.state.pack(), abs=1e-7)
        assert (ours.state == theirs.state) == (restitution > 0.0)
