"""Impacts with dry friction: known exactly in a plane, and what no impact can do."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from test_impact import RESTITUTIONS, Rigid, check_laws_of_impact, planar

from strategies import numbers, slides
from tippetop.contact.impact import ImpactProcess, impact
from tippetop.integrators import make_integrator
from tippetop.mechanics.contacts.slip_variables import slip_of
from tippetop.mechanics.impacts.struck_body import NO_IMPULSE, StruckBody
from tippetop.mechanics.impacts.struck_status import HELD, slips_at, status_at
from tippetop.mechanics.impacts.unit_impulse import ALONE, changed
from tippetop.mechanics.laws.contensou import EllipsoidalLaw
from tippetop.mechanics.laws.contensou_hertz import HertzLaw
from tippetop.mechanics.laws.coulomb import CoulombLaw, RollingResistance
from tippetop.mechanics.laws.friction import RegularizedCoulombLaw, ViscousLaw
from tippetop.mechanics.motion import on_table
from tippetop.mechanics.state import SlidingState
from tippetop.mechanics.surfaces.surface import SphereSurface, SpheroidSurface
from tippetop.mechanics.top import Top


@pytest.mark.parametrize("restitution", [0.0, 0.4])
def test_slip_that_ends_in_compression_stays_ended(restitution):
    """It ends at p_s = slip / (mu M_tt - M_tn); then friction is -M_tn / M_tt, within the cone."""
    mu, slip, falling = 0.9, 0.3, -1.0
    state, top = planar(slip, falling, CoulombLaw(mu))
    M = Rigid(state, top).delassus
    stop = slip / (mu * M[0, 0] - M[0, 2])
    left = falling + stop * (M[2, 2] - mu * M[0, 2])
    compression = stop - left / (M[2, 2] - M[0, 2] ** 2 / M[0, 0])
    result = impact(state, restitution, top)
    assert left < 0.0
    assert result.compression == pytest.approx(compression, rel=1e-9)
    returned = 0.5 * (compression - stop) * -left + 0.5 * stop * (-falling - left)
    stuck = M[2, 2] - M[0, 2] ** 2 / M[0, 0]
    full = min(restitution * compression, math.sqrt(2.0 * returned / stuck))
    assert result.impulse == pytest.approx(compression + full, rel=1e-9)
    assert slip_of(
        result.state.axis, result.state.momentum, result.state.velocity[:2], top
    ) == pytest.approx((0.0, 0.0), abs=1e-15)


def test_slip_that_cannot_end_turns_back():
    """Below mu = |M_tn| / M_tt slip comes to zero and goes on the other way, friction with it."""
    mu, falling = 0.02, -1.0
    M = Rigid(*planar(-0.05, falling, CoulombLaw(mu))).delassus
    assert M[0, 2] > mu * M[0, 0]
    state, top = planar(-0.05, falling, CoulombLaw(mu))
    stop = 0.05 / (M[0, 2] + mu * M[0, 0])
    left = falling + stop * (M[2, 2] + mu * M[0, 2])
    compression = stop - left / (M[2, 2] - mu * M[0, 2])
    result = impact(state, 0.0, top)
    assert left < 0.0
    assert result.impulse == pytest.approx(compression, rel=1e-9)
    after = Rigid(state, top).velocity_of_point(result.state)
    assert after[0] == pytest.approx((compression - stop) * (M[0, 2] - mu * M[0, 0]), rel=1e-8)


@pytest.mark.parametrize("restitution", [0.0, 0.4])
def test_rolling_is_resisted_in_viscous_impacts_too(restitution):
    """Without friction a ball gets (1 + e) m v_n, and l times as much of it against its rolling."""
    arm, falling, momentum = 0.01, -0.7, (0.3, -0.4, 0.2)
    top = Top.of(
        1.0, 0.4, 0.4, SphereSurface(1.0, 0.0), ViscousLaw(0.0), 1.0, RollingResistance(arm)
    )
    state = on_table(SlidingState((0.6, 0.0, 0.8), momentum, (0.1, 0.2)), top)
    result = impact(state._replace(velocity=(0.1, 0.2, falling)), restitution, top)
    impulse = -(1.0 + restitution) * falling
    left = 1.0 - arm * impulse / math.hypot(*momentum[:2])
    assert result.impulse == pytest.approx(impulse, rel=1e-9)
    expected = (left * momentum[0], left * momentum[1], momentum[2])
    assert result.state.momentum == pytest.approx(expected, rel=1e-9)
    assert result.state.velocity == pytest.approx((0.1, 0.2, -restitution * falling), abs=1e-9)


def test_viscous_impacts_with_rolling_resistance_are_those_of_slow_slip():
    """A regularized law is viscous far below its speed, to the square of their ratio."""
    mu, far = 0.3, 1e4
    found = []
    for law in (ViscousLaw(mu), RegularizedCoulombLaw(mu * far, far)):
        top = Top.of(1.0, 0.4, 0.3, SphereSurface(1.0, 0.2), law, 1.0, RollingResistance(0.05))
        state = on_table(
            SlidingState((math.sin(1.0), 0.0, math.cos(1.0)), (0.3, 0.2, 0.1), (1.0, 0.3)), top
        )
        found.append(impact(state._replace(velocity=(1.0, 0.3, state.velocity[2] - 2.0)), 0.3, top))
    viscous, slow = found
    assert viscous.state.momentum == pytest.approx(slow.state.momentum, abs=1e-7)
    assert viscous.state.velocity == pytest.approx(slow.state.velocity, abs=1e-7)


@pytest.mark.parametrize("velocity", [(0.3, -0.2, -0.7), (-0.4, 0.1, -1.5)])
def test_regularized_friction_comes_to_it_as_its_speed_goes_to_zero(velocity):
    ends = []
    for law in (CoulombLaw(0.7), RegularizedCoulombLaw(0.7, 1e-6)):
        state, top = planar(0.0, -1.0, law)
        state = state._replace(velocity=velocity, momentum=(1e-4, 2e-4, -3e-4))
        ends.append(impact(state, 0.5, top))
    assert ends[0].impulse == pytest.approx(ends[1].impulse, rel=1e-5)
    assert ends[0].state.momentum == pytest.approx(ends[1].state.momentum, abs=1e-5 * 3e-4)


def test_drilling_alone_takes_no_steps():
    """A body that falls spinning upright: the patch takes mu rho p from L, exactly, until none is
    left.
    """
    mu, rho, restitution = 0.4, 0.05, 0.5
    for spin, falling in ((3.0, 1.0), (1e-2, 1.0)):
        top = Top.of(
            1.0,
            0.4,
            0.5,
            SpheroidSurface(1.0, 1.4),
            EllipsoidalLaw(mu, rho / (3.0 * math.pi / 16.0)),
            1.0,
        )
        state = on_table(SlidingState((0.0, 0.0, 1.0), (0.0, 0.0, 0.5 * spin), (0.0, 0.0)), top)
        result = impact(state._replace(velocity=(0.0, 0.0, -falling)), restitution, top)
        assert result.impulse == pytest.approx(1.0 + restitution, rel=1e-14)
        left = max(0.0, 0.5 * spin - mu * rho * result.impulse)
        assert result.state.momentum == pytest.approx((0.0, 0.0, left), abs=1e-15)
        assert result.steps < 20


@pytest.mark.parametrize("law", [EllipsoidalLaw, HertzLaw])
def test_the_smaller_a_patch_is_the_more_it_is_a_point(law):
    """Where drilling lasts, sliding follows it ever faster: the equations are stiff."""

    def struck(patch):
        top = Top.of(1.0, 0.4, 0.5, SpheroidSurface(1.0, 1.4), law(0.3, patch), 1.0)
        axis = (math.sin(1.2), 0.0, math.cos(1.2))
        state = on_table(SlidingState(axis, (0.1, 0.05, 0.4), (0.1, -0.2)), top)
        return impact(state._replace(velocity=(*state.velocity[:2], -1.0)), 0.7, top)

    small, smaller = (struck(patch) for patch in (1e-5, 1e-8))
    assert small.state.momentum == pytest.approx(smaller.state.momentum, abs=1e-4)
    assert small.state.velocity == pytest.approx(smaller.state.velocity, abs=1e-4)


DRY = {
    "coulomb": lambda mu, size: CoulombLaw(mu),
    "ellipsoidal": lambda mu, size: EllipsoidalLaw(mu, 0.05 * size),
    "hertz": lambda mu, size: HertzLaw(mu, 0.05 * size),
    "rolling": lambda mu, size: CoulombLaw(mu),
}


@settings(max_examples=25, deadline=None)
@given(st.sampled_from(sorted(DRY)), slides(), numbers(0.05, 0.9), numbers(-3.0, 0.5), RESTITUTIONS)
def test_dry_impacts_obey_the_laws_of_mechanics(name, slide, mu, fall, restitution):
    """No energy is gained, momentum is balanced, and the friction impulse stays inside of the
    cone.
    """
    top, sliding = slide
    resistance = RollingResistance(0.01 * top.surface.size) if name == "rolling" else None
    top = top.altered(friction=DRY[name](mu, top.surface.size), rolling_resistance=resistance)
    state = on_table(sliding, top)
    falling = 10.0**fall * math.sqrt(top.gravity * top.surface.size)
    state = state._replace(velocity=(*state.velocity[:2], state.velocity[2] - falling))
    if name == "coulomb":
        result = check_laws_of_impact(state, restitution, top)
    else:
        result = impact(state, restitution, top)
        assert result.energy_lost >= 0.0
    gained = top.mass * (np.array(result.state.velocity) - np.array(state.velocity))
    assert math.hypot(gained[0], gained[1]) <= mu * gained[2] * (1.0 + 1e-9)


@pytest.mark.parametrize("patch", [None, 3e-4, 0.1])
def test_what_has_ended_in_an_impact_is_held_within_friction_or_goes_on_the_way_it_is_driven(patch):
    """Of a body that falls without turning: both slip and rolling are zero.

    What is zero stays so if mu and the arm admit what holds it, per unit normal impulse,
    and else changes at a rate A = R e along its direction, R >= 0.
    """
    random, kinds = np.random.default_rng(3), set()
    for _ in range(40):
        mu, arm = random.uniform(0.0, 0.4), 10.0 ** random.uniform(-3.0, -0.3)
        law = CoulombLaw(mu) if patch is None else EllipsoidalLaw(mu, patch)
        inertia = random.uniform(0.2, 0.6)
        shape = SpheroidSurface(1.0, random.uniform(0.4, 1.8))
        top = Top.of(
            1.0,
            inertia,
            random.uniform(0.5, 1.6) * inertia,
            shape,
            law,
            1.0,
            RollingResistance(arm),
        )
        tilt = random.uniform(0.1, 3.0)
        axis = (math.sin(tilt), 0.0, math.cos(tilt))
        state = on_table(SlidingState(axis, (0.0, 0.0, 0.0), (0.0, 0.0)), top)
        body = StruckBody.of(state._replace(velocity=(0.0, 0.0, -1.0)), (top,))
        status = status_at(body, NO_IMPULSE, ALONE)
        unit = ImpactProcess(body, make_integrator()).unit(NO_IMPULSE, status).total
        change = changed(body.contacts, unit)
        slip, rolling = slips_at(body, change)[0], change[3:5]
        direction = None if status.slips[0] == HELD else status.directions[0]
        rolling_direction = None if status.rolling == HELD else status.directions[2]
        for way, rate, reserve in (
            (direction, slip, law.reserve(1.0, unit[:2], unit[5])),
            (rolling_direction, rolling, RollingResistance(arm).reserve(1.0, unit[3:5])),
        ):
            if way is None:
                assert rate == pytest.approx((0.0,) * len(rate), abs=1e-12)
                assert reserve >= 0.0
            else:
                along = sum(a * b for a, b in zip(way, rate, strict=True))
                assert along >= -1e-12
                assert rate == pytest.approx(tuple(along * e for e in way), abs=1e-12)
        kinds.add((direction is None, rolling_direction is None))
    assert len(kinds) == 3, "what does not roll has no reason to slip; all else should come about"
