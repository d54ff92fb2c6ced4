"""Units: a top and the same top in its natural units are one motion."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from strategies import angles, numbers, slides, tops
from tippetop.mechanics.invariants import energy, jellett
from tippetop.mechanics.motion import on_table, sliding_contact, sliding_rates
from tippetop.mechanics.natural_units import Units
from tippetop.mechanics.state import SlidingState
from tippetop.mechanics.top import natural, natural_units
from tippetop.mechanics.view import state_from_angles


def in_natural_units(state, units):
    """The same sliding state, measured in these units."""
    return SlidingState(
        state.axis,
        tuple(x / units.angular_momentum for x in state.momentum),
        tuple(x / units.speed for x in state.velocity),
    )


def in_natural_time(rates, units):
    """The same rates of change of a sliding state, measured in these units."""
    return SlidingState.unpack(
        [rate * units.time for rate in in_natural_units(rates, units).pack()]
    )


@given(tops())
def test_natural_units_make_mass_size_and_gravity_one(top):
    units = natural_units(top)
    assert top.mass / units.mass == 1.0
    assert top.surface.size / units.length == 1.0
    assert top.gravity * units.time**2 / units.length == pytest.approx(1.0, rel=1e-14)
    there = natural(top)
    assert (there.mass, there.surface.size, there.gravity) == (1.0, 1.0, 1.0)


@given(tops())
def test_derived_units_are_products_of_the_basic_ones(top):
    units = natural_units(top)
    assert units.speed == pytest.approx(math.sqrt(top.gravity * top.surface.size), rel=1e-14)
    assert units.energy == pytest.approx(top.mass * top.gravity * top.surface.size, rel=1e-14)
    assert units.angular_momentum == pytest.approx(units.energy * units.time, rel=1e-14)


@given(tops())
def test_a_top_in_natural_units_has_the_numbers_it_was_made_from(top):
    numbers_of_top = top.numbers
    there = natural(top)
    assert there.kind == top.kind
    assert there.numbers == pytest.approx(numbers_of_top, rel=1e-14)
    assert there.kind.top(there.numbers) == there


@given(slides())
def test_a_top_moves_the_same_in_its_natural_units(slide):
    top, state = slide
    units, small = natural_units(top), natural(top)
    scaled = in_natural_units(state, units)
    expected = in_natural_time(sliding_rates(state, top), units)
    rates = sliding_rates(scaled, small)
    for actual, there in zip(rates, expected, strict=True):
        assert actual == pytest.approx(there, rel=1e-10, abs=1e-10)
    touch, touch_there = (
        sliding_contact(s.axis, s.momentum, s.velocity, t)
        for s, t in ((scaled, small), (state, top))
    )
    weight = units.energy / units.length
    assert touch.normal_force == pytest.approx(
        touch_there.normal_force / weight, rel=1e-10, abs=1e-10
    )
    assert touch.delassus == pytest.approx(touch_there.delassus * units.mass, rel=1e-10)
    power = touch_there.power * units.time / units.energy
    assert touch.power == pytest.approx(power, rel=1e-10, abs=1e-12)


@given(slides())
def test_energy_and_jellett_scale_with_their_units(slide):
    top, state = slide
    units, small = natural_units(top), natural(top)
    scaled, whole = in_natural_units(state, units), on_table(state, top)
    there = on_table(scaled, small)
    assert energy(there, small) == pytest.approx(energy(whole, top) / units.energy, rel=1e-12)
    expected = jellett(whole, top) / (units.angular_momentum * units.length)
    assert jellett(there, small) == pytest.approx(expected, rel=1e-10, abs=1e-12)


@given(
    tops().flatmap(lambda top: st.tuples(st.just(top), angles(top))),
    numbers(0.1, 10.0),
    numbers(0.1, 10.0),
)
def test_a_larger_top_under_other_gravity_moves_alike_in_slower_time(launch, larger, stronger):
    """Lengths times k, gravity times g: times sqrt(k/g), with the friction law's numbers scaled
    along.
    """
    top, motion = launch
    slower = math.sqrt(larger / stronger)
    giant = top.altered(
        transverse_inertia=top.transverse_inertia * larger**2,
        axial_inertia=top.axial_inertia * larger**2,
        surface=type(top.surface)(*(length * larger for length in top.surface)),
        friction=type(top.friction)(
            *top.friction.coefficients(Units(1.0, 1.0 / larger, 1.0 / slower))
        ),
        gravity=top.gravity * stronger,
    )
    far = motion._replace(
        tilt_rate=motion.tilt_rate / slower,
        precession=motion.precession / slower,
        spin=motion.spin / slower,
        slip=tuple(v * larger / slower for v in motion.slip),
    )
    near_touch, far_touch = (
        sliding_contact(s.axis, s.momentum, s.velocity, t)
        for s, t in (
            (state_from_angles(motion, top, math), top),
            (state_from_angles(far, giant, math), giant),
        )
    )
    assert far_touch.delassus == pytest.approx(near_touch.delassus, rel=1e-10, abs=1e-10 / top.mass)
    assert far_touch.free_acceleration == pytest.approx(
        near_touch.free_acceleration * stronger, rel=1e-10, abs=1e-10 * top.gravity * stronger
    )
    assert giant.numbers == pytest.approx(top.numbers, rel=1e-12)
