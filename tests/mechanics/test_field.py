"""The outer field: its units, its forces, and that all equations of contact have it."""

import numpy as np
import pytest

from tippetop.mechanics.contacts.contact_point import ContactPoint
from tippetop.mechanics.contacts.forces import forces_and_accelerations, solve_contacts, sum_at
from tippetop.mechanics.contacts.slip_variables import slip_of
from tippetop.mechanics.field import OuterField, Resistance
from tippetop.mechanics.flight.free_motion import free_rates
from tippetop.mechanics.invariants import energy
from tippetop.mechanics.laws.coulomb import CoulombLaw
from tippetop.mechanics.motion import (
    along_table,
    angular_velocity,
    on_table,
    outer_forces,
    sliding_rates,
)
from tippetop.mechanics.state import SlidingState, State
from tippetop.mechanics.surfaces.surface import SphereSurface, SpheroidSurface
from tippetop.mechanics.top import Top, natural, natural_state, natural_units
from tippetop.mechanics.vectors import dot

FIELD = OuterField(
    (0.7, -1.3), Resistance(4e-7, 2e-9), Resistance(3e-7, 1e-9), Resistance(2e-3, 1e-2)
)
TOPS = {
    "sphere": Top.of(0.02, 3e-6, 3.2e-6, SphereSurface(0.02, 0.006), CoulombLaw(0.3), 9.6),
    "spheroid": Top.of(
        0.02, 4e-6, 3.2e-6, SpheroidSurface(0.02, 0.03, 0.002), CoulombLaw(0.3), 9.6
    ),
}


def launched(name, field, seed=1):
    rng = np.random.default_rng(seed)
    axis = rng.normal(size=3)
    axis /= np.linalg.norm(axis)
    momentum = tuple((3e-4 * rng.normal(size=3)).tolist())
    velocity = tuple(rng.normal(size=2).tolist())
    return SlidingState(tuple(axis.tolist()), momentum, velocity), TOPS[name].altered(field=field)


@pytest.mark.parametrize("name", TOPS)
def test_natural_units_describe_the_same_field(name):
    state, top = launched(name, FIELD)
    units, small = natural_units(top), natural(top)
    whole = natural_state(on_table(state, top), units)
    outer, scaled = (
        outer_forces(one.axis, one.momentum, one.velocity[:2], body)
        for one, body in ((state, top), (whole, small))
    )
    assert np.array(scaled.couple) * units.energy == pytest.approx(outer.couple, rel=1e-7)
    assert np.array(scaled.force) * units.force == pytest.approx(outer.force, rel=1e-7)


@pytest.mark.parametrize("part", ["slope", "axial", "transverse", "drag"])
def test_kind_remembers_each_part(part):
    _, top = launched("sphere", OuterField(**{part: getattr(FIELD, part)}))
    assert top.kind.top(top.numbers).kind == top.kind
    assert len(top.numbers) == top.kind.numbers == len(TOPS["sphere"].numbers) + 2
    assert natural(natural(top)).numbers == pytest.approx(natural(top).numbers)


@pytest.mark.parametrize("name", TOPS)
def test_slipping_top_and_system_agree(name):
    state, top = launched(name, FIELD)
    rates = sliding_rates(state, top)
    point = ContactPoint.of(state.axis, state.momentum, top, state.velocity)
    wrench, _ = forces_and_accelerations(point, slip_of(*state, top), None)
    moment = np.array(point.moment(wrench)) + point.outer.couple
    assert rates.momentum == pytest.approx(moment, rel=1e-12)
    drawn = (np.array(wrench.force) + point.outer.force) / top.mass
    assert rates.velocity == pytest.approx(drawn[:2], rel=1e-12)


@pytest.mark.parametrize("name", TOPS)
def test_sticking_top_and_system_agree(name):
    state, top = launched(name, FIELD)
    point = ContactPoint.of(state.axis, state.momentum, top)
    fast, acceleration = forces_and_accelerations(point, None)
    solution = solve_contacts((point,), (None,), None)
    wrench = sum_at(0, solution.wrenches)
    assert fast.force == pytest.approx(wrench.force, rel=1e-11)
    assert acceleration.turning == pytest.approx(solution.rates.turning, rel=1e-11)


@pytest.mark.parametrize("name", TOPS)
def test_flight_changes_the_energy_by_the_power_of_the_field(name):
    sliding, top = launched(name, FIELD)
    state = State(*sliding[:2], (*sliding.velocity, 0.4), 0.5)
    step = 1e-6
    rates = free_rates(state, top).pack()
    ends = [
        State.unpack([a + sign * step * b for a, b in zip(state.pack(), rates, strict=True)])
        for sign in (-1.0, 1.0)
    ]
    gained = (energy(ends[1], top) - energy(ends[0], top)) / (2.0 * step)
    spin = dot(state.momentum, state.axis) / top.axial_inertia
    turning = angular_velocity(state.axis, state.momentum, top)
    force = np.array(FIELD.air_force(state.velocity)) + top.mass * np.array([0.7, -1.3, 0.0])
    couple = FIELD.couple(state.axis, spin, turning)
    power = force @ np.array(state.velocity) + np.array(couple) @ np.array(turning)
    assert gained == pytest.approx(power, rel=1e-7)


def test_air_resists_and_never_drives():
    state, top = launched("spheroid", OuterField(None, *FIELD[1:]))
    whole = on_table(along_table(on_table(state, top)), top)
    outer = outer_forces(state.axis, state.momentum, state.velocity, top)
    assert dot(outer.force, whole.velocity) < 0.0
    assert dot(outer.couple, angular_velocity(state.axis, state.momentum, top)) < 0.0


def test_without_a_field_nothing_is_added():
    state, top = launched("sphere", None)
    assert outer_forces(*state, top) is None
    assert len(top.numbers) == 4
