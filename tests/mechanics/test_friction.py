"""Friction laws: direction, size and limits."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from strategies import numbers
from tippetop.mechanics.laws.friction import RegularizedCoulombLaw, ViscousLaw
from tippetop.mechanics.natural_units import Units

COEFFICIENTS = numbers(0.01, 2.0)
SLIPS = st.tuples(numbers(-2.0, 2.0), numbers(-2.0, 2.0)).filter(
    lambda slip: math.hypot(*slip) > 1e-3
)
ANY_LAW = st.one_of(
    st.builds(ViscousLaw, COEFFICIENTS),
    st.builds(RegularizedCoulombLaw, COEFFICIENTS, numbers(1e-3, 1.0)),
)
AT_REST = (0.0, 0.0, 0.0)


@given(ANY_LAW, SLIPS)
def test_friction_opposes_slip_and_exerts_no_torque(law, slip):
    force, torque = law.traction(slip, (1.0, -2.0, 3.0))
    speed, size = math.hypot(*slip), math.hypot(*force)
    assert force[0] * slip[0] + force[1] * slip[1] == pytest.approx(-size * speed, rel=1e-12)
    assert size > 0.0
    assert torque == AT_REST
    assert law.torque_free


@given(ANY_LAW)
def test_there_is_no_friction_without_slip(law):
    assert law.traction((0.0, 0.0), AT_REST).force == (0.0, 0.0)


@given(COEFFICIENTS, SLIPS)
def test_viscous_friction_is_mu_times_the_slip_speed(mu, slip):
    assert math.hypot(*ViscousLaw(mu).traction(slip, AT_REST).force) == pytest.approx(
        mu * math.hypot(*slip)
    )


@given(COEFFICIENTS, SLIPS, numbers(1.0, 1e4))
def test_regularized_coulomb_friction_approaches_mu_for_fast_slip(mu, slip, ratio):
    """The force falls short of mu by (eps/v)^2 / 2, and by less than that."""
    law = RegularizedCoulombLaw(mu, math.hypot(*slip) / ratio)
    size = math.hypot(*law.traction(slip, AT_REST).force)
    shortfall = 1.0 - size / mu
    assert 0.5 / ratio**2 - 0.375 / ratio**4 - 1e-14 <= shortfall <= 0.5 / ratio**2 + 1e-14


@given(COEFFICIENTS, SLIPS, numbers(1.0, 1e4))
def test_regularized_coulomb_friction_is_viscous_for_slow_slip(mu, slip, ratio):
    """Its viscous coefficient there is mu / eps; it falls short of that by (v/eps)^2 / 2, and by
    less.
    """
    eps = math.hypot(*slip) * ratio
    size = math.hypot(*RegularizedCoulombLaw(mu, eps).traction(slip, AT_REST).force)
    viscous = math.hypot(*ViscousLaw(mu / eps).traction(slip, AT_REST).force)
    shortfall = 1.0 - size / viscous
    assert 0.5 / ratio**2 - 0.375 / ratio**4 - 1e-14 <= shortfall <= 0.5 / ratio**2 + 1e-14


@given(ANY_LAW, SLIPS, numbers(0.1, 10.0), numbers(0.1, 10.0))
def test_friction_is_the_same_force_whatever_the_units(law, slip, long, slow):
    units = Units(1.0, long, slow)
    there = type(law)(*law.coefficients(units))
    force = there.traction((slip[0] / units.speed, slip[1] / units.speed), AT_REST).force
    assert force == pytest.approx(law.traction(slip, AT_REST).force, rel=1e-13)
