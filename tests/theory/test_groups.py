"""The map of tops against the energies themselves, and the tops that are known."""

import math

import numpy as np
import pytest
from full_runs import alphas, gammas, jellett_unit, sphere
from hypothesis import assume, given, settings

from campaigns import examples
from strategies import numbers
from tippetop import presets
from tippetop.mechanics.laws.friction import ViscousLaw
from tippetop.mechanics.surfaces.surface import SpheroidSurface
from tippetop.problem.problem import top_of
from tippetop.support.errors import InvalidInput
from tippetop.theory.groups import (
    Group,
    classify,
    classify_top,
    coexistence,
    eccentricity,
    equal_thresholds,
    fold,
    inertia_ratio,
    inverted_boundary,
    jump_boundary,
    precession_boundaries,
    upright_boundary,
)
from tippetop.theory.prediction import stable_by_energy
from tippetop.theory.steady import SteadyKind, least_energy, precession_branch, steady_states
from tippetop.theory.thresholds import critical_jellett

TILTS = np.linspace(0.0, math.pi, 4001)
JELLETTS = np.geomspace(0.02, 100.0, 600)


def energy_minima(top):
    """For Jellett's integrals from small to large: tilts of the minima of the least energy, by
    looking.
    """
    rows = []
    for size in JELLETTS:
        energies = least_energy(TILTS, size * jellett_unit(top), top, np)
        padded = np.concatenate([[math.inf], energies, [math.inf]])
        rows.append(TILTS[(energies < padded[:-2]) & (energies < padded[2:])])
    return rows


def looked_at(top):
    """What the groups promise, read off the energies."""
    rows = energy_minima(top)
    return {
        "leaves_upright": 0.0 not in rows[-1],
        "inverts": 0.0 not in rows[-1] and math.pi in rows[-1],
        "coexistence": any(len(row) > 1 for row in rows),
        "tilted": any(0.0 < tilt < math.pi for row in rows for tilt in row),
    }


@settings(max_examples=examples(check=16, claim=500))
@given(gammas, alphas)
def test_the_group_says_what_the_energies_show(gamma, alpha):
    boundaries = (
        upright_boundary(alpha),
        inverted_boundary(alpha),
        jump_boundary(alpha),
        *precession_boundaries(alpha),
    )
    # Near a boundary the range of spins that makes the difference is too short to be looked at.
    assume(all(math.isnan(boundary) or abs(gamma - boundary) > 0.08 for boundary in boundaries))
    top = sphere(gamma, alpha)
    group = classify_top(top)
    seen = looked_at(top)
    assert group.leaves_upright == seen["leaves_upright"]
    assert group.inverts == seen["inverts"]
    assert group.coexistence == seen["coexistence"]
    assert (group not in (Group.IB, Group.IIC)) == seen["tilted"]


@pytest.mark.parametrize(
    ("gamma", "alpha", "group"),
    [
        (131 / 140, 0.3, Group.IIA),  # the report's listing
        (140 / 131, 0.3, Group.IIA),  # its Table 1
        (8 / 7, 0.2, Group.IIA),  # Leine and Glocker 2003
        (1.0, 0.1, Group.IIA),  # equal moments of inertia
        (0.6, 0.3, Group.IA),
        (0.88, 0.04, Group.IB),
        (0.75, 0.3, Group.IIB),
        (0.97, 0.04, Group.IIC),
        (1.29, 0.3, Group.IIA),
        (1.31, 0.3, Group.III),
        (0.71, 0.3, Group.IIB),
        (0.69, 0.3, Group.IA),
    ],
)
def test_known_tops(gamma, alpha, group):
    assert classify(gamma, alpha) is group
    assert group.description
    assert classify_top(sphere(gamma, alpha)) is group


def test_the_numbers_of_the_reports_top():
    top = top_of(presets.report_problem())
    assert inertia_ratio(top) == pytest.approx(131 / 140, rel=1e-14)
    assert eccentricity(top) == 0.3


@given(numbers(0.02, 0.49))
def test_the_boundaries_are_where_something_happens_to_the_branch(alpha):
    """A threshold goes to infinity, the fold reaches a pole, both thresholds are equal."""
    just = 1e-9
    far = 1e3 * (1.0 - alpha) ** 2 * jellett_unit(sphere(1.0, alpha))
    assert critical_jellett(SteadyKind.UPRIGHT, sphere(upright_boundary(alpha) + just, alpha)) > far
    assert (
        critical_jellett(SteadyKind.UPRIGHT, sphere(upright_boundary(alpha) - just, alpha))
        == math.inf
    )
    assert (
        critical_jellett(SteadyKind.INVERTED, sphere(inverted_boundary(alpha) - just, alpha)) > far
    )
    assert (
        critical_jellett(SteadyKind.INVERTED, sphere(inverted_boundary(alpha) + just, alpha))
        == math.inf
    )
    equal = sphere(equal_thresholds(alpha), alpha)
    assert critical_jellett(SteadyKind.UPRIGHT, equal) == pytest.approx(
        critical_jellett(SteadyKind.INVERTED, equal), rel=1e-11
    )
    jump = jump_boundary(alpha)
    assert classify(jump + just, alpha) is Group.IIA
    assert classify(jump - just, alpha) is Group.IIB
    assert fold(sphere(jump - just, alpha)).tilt < 0.01


@given(numbers(0.02, 0.0717))
def test_between_two_gammas_no_precession_is_stable(alpha):
    low, high = precession_boundaries(alpha)
    assume(high - low > 1e-6)
    without = (Group.IB, Group.IIC)
    for edge, inward in ((low, 1e-7), (high, -1e-7)):
        assert classify(edge + inward, alpha) in without
        assert fold(sphere(edge + inward, alpha)) is None
        assert classify(edge - inward, alpha) not in without
        assert fold(sphere(edge - inward, alpha)).tilt == pytest.approx(math.pi, abs=0.05)


def test_above_the_last_eccentricity_some_precession_is_stable_for_every_gamma():
    assert all(
        math.isnan(gamma) for gamma in precession_boundaries(7.0 - 4.0 * math.sqrt(3.0) + 1e-6)
    )


@given(numbers(0.05, 0.49), numbers(0.0, 1.0))
def test_jelletts_integral_turns_back_at_the_fold(alpha, share):
    top = sphere(0.5 + share * (jump_boundary(alpha) - 0.5), alpha)
    turning = fold(top)
    assume(turning is not None and 0.05 < turning.tilt < math.pi - 0.05)
    near = 1e-3 * min(turning.tilt, math.pi - turning.tilt)
    around = precession_branch(top, turning.tilt + np.array([-near, 0.0, near])).jellett
    assert around[1] == pytest.approx(turning.jellett, rel=1e-12)
    assert around[0] > around[1] < around[2]
    assert (
        abs(around[2] - around[0])
        < 1e-2 * (around[0] + around[2] - 2.0 * around[1]) + 1e-12 * around[1]
    )


@given(gammas, alphas, numbers(-3.0, 3.0))
def test_two_states_are_stable_exactly_where_the_group_says(gamma, alpha, logarithm):
    top = sphere(gamma, alpha)
    kept = 10.0**logarithm * jellett_unit(top)
    both = coexistence(top)
    edges = [] if both is None else [edge for edge in both if math.isfinite(edge)]
    assume(all(abs(kept / edge - 1.0) > 1e-6 for edge in edges))
    expected = 2 if both is not None and both[0] < kept < both[1] else 1
    assert len(stable_by_energy(steady_states(top, kept))) == expected


def test_the_top_of_group_iic_has_two_vertical_spins_at_once():
    top = sphere(0.97, 0.04)
    both = coexistence(top)
    middle = 0.5 * sum(both)
    assert {state.kind for state in stable_by_energy(steady_states(top, middle))} == {
        SteadyKind.UPRIGHT,
        SteadyKind.INVERTED,
    }


@pytest.mark.parametrize(("gamma", "alpha"), [(0.4, 0.3), (1.0, 0.0), (1.0, 1.0), (math.nan, 0.3)])
def test_tops_that_cannot_be_are_refused(gamma, alpha):
    with pytest.raises(InvalidInput):
        classify(gamma, alpha)


def test_other_shapes_are_refused():
    with pytest.raises(InvalidInput, match="eccentric sphere"):
        classify_top(sphere(1.0, 0.3).altered(surface=SpheroidSurface(0.02, 0.03)))


class Drilling(ViscousLaw):
    """Viscous friction that would have a torque as well."""

    torque_free = False


def test_friction_with_a_torque_is_refused():
    top = sphere(1.0, 0.3).altered(friction=Drilling(0.3))
    for asked in (classify_top, fold, coexistence):
        with pytest.raises(InvalidInput, match="torque"):
            asked(top)
