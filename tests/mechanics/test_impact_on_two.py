"""Impacts of one surface while another is pressed onto the table: closed and independent
solutions.
"""

import math

import numpy as np
import pytest
from hypothesis import Phase, assume, given, settings
from hypothesis import strategies as st

from independent_solver import cross
from strategies import numbers
from tippetop.contact import impact as contact_impact
from tippetop.contact.impact import impact
from tippetop.mechanics.flight.free_motion import gap_rate
from tippetop.mechanics.invariants import energy
from tippetop.mechanics.laws.coulomb import CoulombLaw
from tippetop.mechanics.laws.friction import RegularizedCoulombLaw, ViscousLaw
from tippetop.mechanics.motion import axis_rate, on_table
from tippetop.mechanics.state import SlidingState
from tippetop.mechanics.surfaces.hull import Hull
from tippetop.mechanics.surfaces.surface import SphereSurface, contact_vector
from tippetop.mechanics.top import Top


def rods(law):
    """Rods with balls at both ends, which lie on their side: the ends press on one another."""
    return st.builds(
        lambda first, second, inertia, axial: Top.of(
            1.0,
            inertia,
            axial * inertia,
            Hull.of((SphereSurface(1.0, first), SphereSurface(1.0, -second))),
            law,
            1.0,
        ),
        numbers(2.0, 4.0),
        numbers(2.0, 4.0),
        numbers(0.5, 2.0),
        numbers(0.2, 1.0),
    )


@st.composite
def collisions(draw, law):
    """A rod on its side, of which the second end strikes while the first one touches."""
    top = draw(rods(law))
    azimuth = draw(numbers(-math.pi, math.pi))
    axis = (math.cos(azimuth), math.sin(azimuth), 0.0)
    momentum = tuple(draw(numbers(-1.0, 1.0)) for _ in range(3))
    velocity = tuple(draw(numbers(-1.0, 1.0)) for _ in range(2))
    first, second = top.body.contacts
    state = on_table(SlidingState(axis, momentum, velocity), first)
    assume(gap_rate(state, second) < -0.1)
    return state, (second, first)


@given(collisions(ViscousLaw(0.0)), numbers(0.0, 1.0))
def test_without_friction_it_is_a_linear_complementarity_problem(collision, restitution):
    """M_ij = 1/m + h_i' h_j' s^2 / I1, and the first contact gives what keeps its velocity zero."""
    state, tops = collision
    slopes = np.array([top.surface.slope(state.axis[2]) for top in tops])
    matrix = 1.0 + np.outer(slopes, slopes) / tops[0].transverse_inertia
    assert matrix[0, 1] < 0.0
    approach = gap_rate(state, tops[0])
    struck = (1.0 + restitution) * -approach / (matrix[0, 0] - matrix[0, 1] ** 2 / matrix[1, 1])
    found = impact(state, restitution, *tops)
    assert gap_rate(found.state, tops[0]) == pytest.approx(-restitution * approach, abs=1e-12)
    assert gap_rate(found.state, tops[1]) == pytest.approx(0.0, abs=1e-12)
    pressed = -matrix[0, 1] * struck / matrix[1, 1]
    assert found.state.velocity[2] - state.velocity[2] == pytest.approx(struck + pressed, rel=1e-12)
    assert found.impulse == pytest.approx(struck + pressed, rel=1e-12)
    lost = 0.5 * (1.0 - restitution**2) * approach**2 * struck / ((1.0 + restitution) * -approach)
    assert found.energy_lost == pytest.approx(lost, abs=1e-12)


def test_slow_impact_of_a_fast_body_is_no_harder_than_a_quick_one():
    """Its velocities have fewer digits left than its changes of velocity, which decide when it is
    over.
    """
    slow, turned = 1e-7, 0.3
    hull = Hull.of((SphereSurface(1.0, 2.0), SphereSurface(1.0, -3.0)))
    first, second = Top.of(1.0, 1.0, 0.5, hull, ViscousLaw(0.3), 1.0).body.contacts
    axis, across = (
        (math.cos(turned), math.sin(turned), 0.0),
        (-math.sin(turned), math.cos(turned), 0.0),
    )
    # What lies across the axis tilts the rod, of which the second end sinks at 5 times its rate.
    parts = zip(axis, across, (0.0, 0.0, 30.0), strict=True)
    momentum = tuple(20.0 * along - slow / 5.0 * over + up for along, over, up in parts)
    state = on_table(SlidingState(axis, momentum, (7.0, -3.0)), first)
    assert gap_rate(state, second) == pytest.approx(-slow, rel=1e-6)
    found = impact(state, 0.0, second, first)
    _, velocity, _ = naive(state, (second, first), 100)
    assert found.impulse == pytest.approx(velocity[2] - state.velocity[2], rel=1e-4)
    assert gap_rate(found.state, second) == pytest.approx(0.0, abs=1e-15)


def test_a_contact_that_friction_all_but_jams_takes_over_without_a_jump():
    """Its normal velocity responds to its own normal impulse by 1 + (x^2 - f x) / I1, which f makes
    zero.
    """
    reach, inertia, speed, turning, eps = 2.0, 0.5, 1.0, 0.2, 0.1
    hull = Hull.of((SphereSurface(1.0, reach), SphereSurface(1.0, -3.0)))
    slip, found = speed + turning, []
    for part in (1.0 - 1e-7, 1.0 + 1e-7):
        mu = part * (reach + inertia / reach) * math.hypot(slip, eps) / slip
        law = RegularizedCoulombLaw(mu, eps)
        first, second = Top.of(1.0, inertia, 0.5, hull, law, 1.0).body.contacts
        momentum = (0.0, -inertia * turning, 0.0)
        state = on_table(SlidingState((1.0, 0.0, 0.0), momentum, (speed, 0.0)), first)
        assert gap_rate(state, second) == pytest.approx(-5.0 * turning)
        found.append(impact(state, 0.0, second, first))
    before, after = found
    assert after.state.velocity == pytest.approx(before.state.velocity, abs=1e-5)
    assert after.state.momentum == pytest.approx(before.state.momentum, abs=1e-5)
    for one in found:
        assert one.steps < 1000
        assert abs(gap_rate(one.state, second)) < 1e-9
        assert gap_rate(one.state, first) > -1e-6
        assert one.energy_lost > 0.0


def test_what_a_jammed_contact_stops_has_no_restitution():
    """Of two ends in a plane: what jams has all of the normal impulse, and sinks while it lifts the
    other.
    """
    reach, inertia, speed, turning, eps = 2.0, 0.5, 5.0, 0.2, 1e-3
    hull = Hull.of((SphereSurface(1.0, reach), SphereSurface(1.0, -3.0)))
    mu = 1.1 * (reach + inertia / reach)
    first, second = Top.of(
        1.0, inertia, 0.5, hull, RegularizedCoulombLaw(mu, eps), 1.0
    ).body.contacts
    state = on_table(
        SlidingState((1.0, 0.0, 0.0), (0.0, -inertia * turning, 0.0), (speed, 0.0)), first
    )
    for restitution in (0.0, 0.5):
        found = impact(state, restitution, second, first)
        assert found.compression == 0.0
        stopped = 5.0 * turning / (1.0 + 3.0 * (mu - reach) / inertia)
        assert found.impulse == pytest.approx(stopped, rel=1e-5)
        assert gap_rate(found.state, second) == pytest.approx(0.0, abs=1e-9)
        sinks = stopped * (1.0 - reach * (mu - reach) / inertia)
        assert gap_rate(found.state, first) == pytest.approx(sinks, rel=1e-4)


def test_a_contact_that_friction_jams_comes_back_and_stays_closed():
    """In a plane both ends slip alike until they stick, and with both closed nothing moves any
    more.

    The balances of momentum and angular momentum then tell the impulses at both.
    """
    reach, inertia, speed, turning, eps = 2.0, 0.5, 1.0, 0.5, 1e-2
    hull = Hull.of((SphereSurface(1.0, reach), SphereSurface(1.0, -3.0)))
    mu = 1.1 * (reach + inertia / reach)
    first, second = Top.of(
        1.0, inertia, 0.5, hull, RegularizedCoulombLaw(mu, eps), 1.0
    ).body.contacts
    state = on_table(
        SlidingState((1.0, 0.0, 0.0), (0.0, -inertia * turning, 0.0), (speed, 0.0)), first
    )
    found = impact(state, 0.0, second, first)
    assert gap_rate(found.state, first) == pytest.approx(0.0, abs=1e-9)
    assert gap_rate(found.state, second) == pytest.approx(0.0, abs=1e-9)
    assert found.state.velocity == pytest.approx((0.0, 0.0, 0.0), abs=eps)
    assert found.impulse == pytest.approx(reach * turning, rel=eps)
    assert found.compression == pytest.approx(
        ((inertia + 2.0 * reach) * turning - speed) / 5.0, rel=eps
    )


def naive(state, tops, steps):
    """The same impact by matrices, with Heun's method in the normal impulse, until what strikes
    stops.

    Returns momentum and velocity then, and after each step the other contact's normal impulse and
    velocity.
    """
    top = tops[0]
    axis = np.array(state.axis)
    inverse = (np.eye(3) - np.outer(axis, axis)) / top.transverse_inertia
    inverse += np.outer(axis, axis) / top.axial_inertia
    arms = [np.array(contact_vector(state.axis, one.surface)) for one in tops]

    def normal(y, arm):
        return (y[3:] + cross(inverse @ y[:3], arm))[2]

    def units(y):
        """What a unit of either normal impulse changes, with the friction that it causes."""
        omega = inverse @ y[:3]
        for arm in arms:
            slip = y[3:] + cross(omega, arm)
            force = np.array([*top.friction.traction(tuple(slip[:2]), tuple(omega)).force, 1.0])
            yield np.array([*cross(arm, force), *(force / top.mass)])

    def rates(y, closed):
        one, other = units(y)
        share = max(0.0, -normal(one, arms[1]) / normal(other, arms[1])) if closed else 0.0
        return one + share * other, share

    y, impulse, others = np.array([*state.momentum, *state.velocity]), 0.0, []
    step = -normal(y, arms[0]) / steps
    while True:
        closed = normal(y, arms[1]) < 1e-12
        one, share = rates(y, closed)
        two, later = rates(y + step * one, closed)
        there = y + 0.5 * step * (one + two)
        more = 0.5 * step * (share + later)
        if not closed and (inside := normal(there, arms[1])) < 0.0:
            _, unit = units(there)
            more = -inside / normal(unit, arms[1])
            there = there + more * unit
        before, after = normal(y, arms[0]), normal(there, arms[0])
        part = before / (before - after) if after >= 0.0 else 1.0
        y, impulse = y + part * (there - y), impulse + part * more
        others.append((impulse, normal(y, arms[1])))
        if after >= 0.0:
            return y[:3], y[3:], np.array(others).T


@pytest.mark.parametrize(
    ("ends", "slip"), [((1.0, 3.0), 1.0), ((1.0, 1.4), 2.0), ((2.0, -1.0), 1.0)]
)
def test_friction_makes_an_impact_without_approach_end(ends, slip):
    """Painleve's paradox at one contact while another touches: slip falls until it opens."""
    hull = Hull.of(tuple(SphereSurface(1.0, center) for center in ends))
    tops = Top.of(1.0, 1.0, 0.5, hull, ViscousLaw(5.0), 1.0).body.contacts
    state = on_table(SlidingState((1.0, 0.0, 0.0), (0.0, 0.0, 0.2), (slip, 0.1)), tops[0])
    assert gap_rate(state, tops[0]) == gap_rate(state, tops[1]) == 0.0
    found = impact(state, 0.0, *tops)
    assert gap_rate(found.state, tops[0]) == pytest.approx(0.0, abs=1e-14)
    lost = energy(state, tops[0]) - energy(found.state, tops[0])
    assert found.energy_lost == pytest.approx(lost, rel=1e-12)
    assert lost > 0.0
    assert found.impulse == pytest.approx(found.state.velocity[2], rel=1e-12)


@pytest.mark.parametrize("law", [ViscousLaw(0.3), RegularizedCoulombLaw(0.2, 0.3)])
def test_with_friction_it_is_what_small_steps_find(law):
    @settings(max_examples=5, phases=(Phase.explicit, Phase.generate))
    @given(collisions(law))
    def agree(collision):
        state, tops = collision
        found = impact(state, 0.0, *tops)
        momentum, velocity, _ = naive(state, tops, 2000)
        assert found.impulse == pytest.approx(velocity[2] - state.velocity[2], rel=1e-5)
        assert found.state.momentum == pytest.approx(momentum, abs=1e-5)
        assert found.state.velocity == pytest.approx(velocity, abs=1e-5)
        assert gap_rate(found.state, tops[0]) == pytest.approx(0.0, abs=1e-9)
        assert gap_rate(found.state, tops[1]) > -1e-8
        change = energy(state, tops[0]) - energy(found.state, tops[0])
        assert found.energy_lost == pytest.approx(change, abs=1e-12)
        assert change > 0.0
        assert axis_rate(state.axis, found.state.momentum, tops[0])[2] == pytest.approx(
            0.0, abs=1e-8
        )

    agree()


@pytest.mark.parametrize(
    ("law", "slip"), [(ViscousLaw(0.3), -8.0), (RegularizedCoulombLaw(1.1, 0.3), -2.0)]
)
def test_an_end_that_opens_meanwhile_closes_again(law, slip):
    """Friction at the end that strikes lifts the other one, until slip has fallen; then it is
    pressed.
    """
    hull = Hull.of((SphereSurface(1.0, 2.0), SphereSurface(1.0, -2.0)))
    inertia, tilting, turned = 2.0, -8.0, 0.3
    first, second = Top.of(1.0, inertia, 0.5, hull, law, 1.0).body.contacts
    along, across = (
        (math.cos(turned), math.sin(turned), 0.0),
        (-math.sin(turned), math.cos(turned), 0.0),
    )
    # Tilting moves both ends along the axis too, as their surfaces have radii of 1.
    turning = zip(along, across, (0.0, 0.0, 0.4 * inertia), strict=True)
    momentum = tuple(0.05 * one + tilting * inertia * other + up for one, other, up in turning)
    velocity = tuple(
        (slip + tilting) * one + 0.3 * other for one, other in zip(along, across, strict=True)
    )
    state = on_table(SlidingState(along, momentum, (velocity[0], velocity[1])), first)
    assert gap_rate(state, second) == pytest.approx(4.0 * tilting)
    found = impact(state, 0.0, second, first)
    momentum, velocity, (pressed, rises) = naive(state, (second, first), 2000)
    assert rises.max() > 0.1, "it opens"
    opened, closed = np.flatnonzero(rises > 1e-9)[[0, -1]]
    assert closed < 1900, "and closes"
    assert np.ptp(pressed[opened:closed]) == 0.0
    assert pressed[-1] > 0.1
    assert found.state.momentum == pytest.approx(momentum, abs=1e-5)
    assert found.state.velocity == pytest.approx(velocity, abs=1e-5)
    assert gap_rate(found.state, second) == pytest.approx(0.0, abs=1e-12)
    assert gap_rate(found.state, first) == pytest.approx(0.0, abs=1e-12)
    # The torque across the axis tells which end gives how much of the vertical impulse.
    gained = np.subtract(found.state.momentum, state.momentum) @ across
    slowed = np.subtract(found.state.velocity, state.velocity) @ along
    other = 0.5 * found.impulse - 0.25 * (gained + slowed)
    assert other == pytest.approx(pressed[-1], abs=1e-5)
    assert found.energy_lost > 0.0
    lost = energy(state, second) - energy(found.state, second)
    assert found.energy_lost == pytest.approx(lost, rel=1e-12)


@pytest.mark.parametrize("restitution", [0.0, 0.6])
@pytest.mark.parametrize("law", [ViscousLaw(0.3), RegularizedCoulombLaw(0.2, 0.3)])
def test_its_impulse_is_all_that_lifts_the_body(law, restitution):
    """m dv_z = p, whichever of the surfaces gives it."""

    @settings(max_examples=10, phases=(Phase.explicit, Phase.generate))
    @given(collisions(law))
    def balance(collision):
        state, tops = collision
        found = impact(state, restitution, *tops)
        lifted = tops[0].mass * (found.state.velocity[2] - state.velocity[2])
        assert found.impulse == pytest.approx(lifted, rel=1e-12)
        assert found.impulse > found.compression * (1.0 + 1e-3)

    balance()


def test_an_end_that_opens_neither_slips_nor_sticks():
    """What leaves the table with no slip leaves the friction at the other end alone."""
    hull = Hull.of((SphereSurface(1.0, 2.0), SphereSurface(1.0, -2.0)))
    first, second = Top.of(1.0, 1.5, 0.5, hull, CoulombLaw(0.3), 1.0).body.contacts
    still = on_table(SlidingState((1.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0)), first)
    # It turns with (0.2, -0.5, 0.4), and one end moves upwards, the other across and downwards.
    state = still._replace(momentum=(0.1, -0.75, 0.6), velocity=(-0.5, -1.0, 0.0))
    assert gap_rate(state, first) == pytest.approx(1.0)
    assert gap_rate(state, second) == pytest.approx(-1.0)
    found, alone = impact(state, 0.0, second, first), impact(state, 0.0, second)
    assert gap_rate(found.state, first) > 0.0
    assert found.impulse == pytest.approx(alone.impulse, rel=1e-7)
    assert found.state.momentum == pytest.approx(alone.state.momentum, abs=1e-7)
    assert found.state.velocity == pytest.approx(alone.state.velocity, abs=1e-7)


def rod(ends, inertias, law, momentum, velocity):
    """A rod along x that falls on its second end, and its tops."""
    hull = Hull.of((SphereSurface(1.0, ends[0]), SphereSurface(1.0, -ends[1])))
    first, second = Top.of(1.0, *inertias, hull, law, 1.0).body.contacts
    return on_table(SlidingState((1.0, 0.0, 0.0), momentum, velocity), first), (second, first)


def sliding_slowly(law):
    """A rod that falls on its second end faster than it slips, and its tops."""
    momentum = (0.03, -0.9, 0.03)  # turns about y, by which the second end sinks
    return rod((2.0, 3.0), (1.5, 0.5), law, momentum, (0.05, -0.04))


HELD = {
    "slowly": (sliding_slowly(RegularizedCoulombLaw(0.6, 1e-6)), 200),
    "firmly": (
        rod(
            (3.64, 3.92),
            (1.36, 0.46),
            RegularizedCoulombLaw(2.55, 9e-6),
            (-0.23, -1.0, 0.02),
            (-0.1, 0.38),
        ),
        200,
    ),
    "one end after the other": (
        rod(
            (3.5, 4.0),
            (1.7, 0.8),
            RegularizedCoulombLaw(3.3, 3e-5),
            (-0.6, -0.6, -0.4),
            (-0.1, 1.1),
        ),
        2000,
    ),
}
"""Rods that fall, and the steps their impacts may take: more where one end is held long before the
other.
"""


@pytest.mark.parametrize(("falling", "most"), HELD.values(), ids=HELD)
def test_a_steep_law_holds_both_ends_and_takes_few_steps(falling, most):
    """What is left is the motion next to the one before, by kinetic energy, that moves neither
    end.
    """
    state, tops = falling
    top = tops[0]
    assert gap_rate(state, top) < -1.0
    found = impact(state, 0.0, *tops)
    assert found.steps < most
    inertia = np.diag([top.axial_inertia, top.transverse_inertia, top.transverse_inertia])
    masses = np.block([[inertia, np.zeros((3, 3))], [np.zeros((3, 3)), np.eye(3)]])
    rows = [
        np.hstack([-cross_matrix(contact_vector(state.axis, one.surface)), np.eye(3)])
        for one in tops
    ]
    held = np.vstack(rows)
    before = np.array([*np.linalg.solve(inertia, state.momentum), *state.velocity])
    inverse = np.linalg.inv(masses)
    impulse = np.linalg.pinv(held @ inverse @ held.T) @ held @ before
    after = before - inverse @ held.T @ impulse
    assert found.state.momentum == pytest.approx(inertia @ after[:3], abs=1e-5)
    assert found.state.velocity == pytest.approx(after[3:], abs=1e-5)
    change = energy(state, top) - energy(found.state, top)
    assert found.energy_lost == pytest.approx(change, rel=1e-9)


def cross_matrix(a):
    return np.array([[0.0, -a[2], a[1]], [a[2], 0.0, -a[0]], [-a[1], a[0], 0.0]])


def test_steps_are_bounded_and_told(monkeypatch):
    state, tops = sliding_slowly(RegularizedCoulombLaw(0.6, 1e-6))
    steps = impact(state, 1.0, *tops).steps
    assert steps > impact(state, 0.0, *tops).steps > 10
    monkeypatch.setattr(contact_impact, "MOST_IMPACT_STEPS", 5)
    with pytest.raises(ArithmeticError, match="does not come to its end"):
        impact(state, 0.0, *tops)
