"""Hertz's law where slip ends and where it is held: on whichever of its two branches the direction
is.
"""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from campaigns import among
from dry_runs import DryRun
from tippetop.contact.contact_mode import ContactMode
from tippetop.contact.mode import split
from tippetop.contact.slip_end_motion import pack_clock, rates_in_time, unpack_clock
from tippetop.integrators.scipy_methods import SciPy
from tippetop.mechanics.contacts.contact_point import ContactPoint
from tippetop.mechanics.contacts.forces import (
    forces_and_accelerations,
    spun_up,
    velocity_without_slip,
    without_drilling,
)
from tippetop.mechanics.contacts.slip_clock import SlipComponent, slip_end_rates
from tippetop.mechanics.contacts.slip_variables import size, velocity_of
from tippetop.mechanics.laws.contensou_hertz import BRANCH_TORQUE, HertzLaw
from tippetop.mechanics.laws.coulomb import CoulombLaw
from tippetop.mechanics.motion import axis_rate
from tippetop.mechanics.surfaces.surface import SphereSurface
from tippetop.mechanics.top import Top

SLIP = SlipComponent(slip=True)


def about_to_stick(random):
    """A top whose slip, drilling included, is about to end, and that slip zeta."""
    law = HertzLaw(random.uniform(0.2, 0.8), random.uniform(0.1, 0.5))
    top = Top.of(1.0, 131 / 350, 2 / 5, SphereSurface(1.0, 0.3), law, 1.0)
    tilt = random.uniform(0.3, 2.8)
    axis = (math.sin(tilt), 0.0, math.cos(tilt))
    direction = random.normal(size=3)
    slip = (direction * random.uniform(1e-3, 5e-3) / np.linalg.norm(direction)).tolist()
    momentum = without_drilling(axis, tuple(0.4 * random.normal(size=3)), top)
    momentum = spun_up(axis, momentum, (0.0, 0.0, slip[2] / law.patch_radius), top)
    return top, axis, momentum, slip


@pytest.mark.parametrize("seed", among([1, 5, 8, 17, 35], check=3))
def test_slip_ends_on_the_branch_its_direction_turns_to(seed):
    """Against the whole law, which asks at every instant on which branch it is, and an implicit
    method.
    """
    top, axis, momentum, slip = about_to_stick(np.random.default_rng(seed))

    def rates(_, y):
        state = unpack_clock(y.tolist(), 8)
        return pack_clock(slip_end_rates(state, rates_in_time(state, ContactMode(top), SLIP)))

    velocity = velocity_of(axis, momentum, slip, top)
    direction = [x / size(slip) for x in slip]
    start = [*axis, *momentum, *velocity, *direction, size(slip), 0.0]
    whole = solve_ivp(rates, (0.0, 25.0), start, "Radau", rtol=1e-8, atol=1e-11).y
    drills = np.abs(whole[10]) > np.hypot(whole[8], whole[9])
    assert drills.any(), "it turns from one branch to the other"
    assert not drills.all(), "it turns from one branch to the other"
    run = DryRun(top, axis, momentum, velocity).follow(whole[12, -1] * 1.5)
    assert run.times("stick")[:1] == pytest.approx([whole[12, -1]], abs=1e-9)


@pytest.mark.parametrize("slip", [1e-6, 1e-9, 1e-12])
def test_slip_that_is_all_but_over_ends_when_it_does(slip):
    ball = Top.of(1.0, 0.4, 0.4, SphereSurface(1.0, 0.0), CoulombLaw(0.25), 1.0)
    axis, momentum = (0.6, 0.0, 0.8), (0.1, 0.2, 0.3)
    run = DryRun(ball, axis, momentum, velocity_of(axis, momentum, (slip, 0.0), ball)).follow(0.1)
    (stuck,) = run.times("stick")
    assert stuck == pytest.approx(slip / (3.5 * 0.25), abs=1e-14)


def stuck(random):
    """A top that sticks, or would, on a patch."""
    law = HertzLaw(random.uniform(0.2, 0.8), 10.0 ** random.uniform(-2.6, -1.2))
    top = Top.of(1.0, 0.5, 0.3, SphereSurface(1.0, 0.3), law, 1.0)
    tilt = random.uniform(0.3, 2.8)
    axis = (math.sin(tilt), 0.0, math.cos(tilt))
    return top, axis, without_drilling(axis, tuple(0.4 * random.normal(size=3)), top)


@pytest.mark.parametrize(("seed", "slips"), [(13, False), (38, False), (59, True)])
@pytest.mark.parametrize("integrator", [None, SciPy("dop853", 1e-12)], ids=["taylor", "dop853"])
def test_a_patch_sticks_while_its_limit_surface_admits_it_on_either_piece(seed, slips, integrator):
    """The drilling torque passes the one at kappa = 1 twice; against the whole limit surface."""
    top, axis, momentum = stuck(np.random.default_rng(seed))

    def held(y):
        axis, momentum = split([float(x) for x in y])
        point = ContactPoint.of(axis, momentum, top)
        return point, forces_and_accelerations(point, None)[0]

    def rates(_, y):
        point, wrench = held(y)
        return [*axis_rate(point.axis, point.momentum, top), *point.moment(wrench)]

    def reserve(_, y):
        (x, z, normal), torque = held(y)[1]
        return top.friction.reserve(normal, (x, z), torque[2])

    reserve.terminal, reserve.direction = True, -1
    whole = solve_ivp(
        rates, (0.0, 3.0), [*axis, *momentum], "DOP853", events=reserve, rtol=1e-12, atol=1e-13
    )
    wrenches = [held(y)[1] for y in whole.y.T]
    law = top.friction
    shares = [
        w.torque[2] / (law.mu * law.patch_radius * BRANCH_TORQUE * w.force[2]) for w in wrenches
    ]
    assert np.count_nonzero(np.diff(np.abs(shares) > 1.0)) == 2
    assert np.min(shares) < 0.0 < np.max(shares)
    velocity = velocity_without_slip(axis, momentum, top)
    run = DryRun(top, axis, momentum, velocity, integrator).follow(whole.t[-1] + 1e-3 * slips)
    assert run.times("slip") == pytest.approx([whole.t[-1]] * slips, abs=1e-9)
    if not slips:
        assert (*run.axis, *run.momentum) == pytest.approx(tuple(whole.y[:, -1]), abs=1e-9)
