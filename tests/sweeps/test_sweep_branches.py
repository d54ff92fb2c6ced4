"""Where in a step another branch of the law takes over."""

import numpy as np
import pytest

import tippetop as tt
from tippetop.integrators.polynomial_zeros import single_fall
from tippetop.integrators.polynomials import Polynomials
from tippetop.mechanics.contacts.branches import (
    on_branch,
    on_numbered_branch,
    on_other_branch,
)
from tippetop.mechanics.contacts.forces import velocity_without_slip
from tippetop.mechanics.contacts.slip_variables import slip_of
from tippetop.mechanics.laws.contensou_hertz import HertzLaw
from tippetop.mechanics.motion import along_table, angular_velocity, on_table
from tippetop.mechanics.state import SlidingState
from tippetop.mechanics.surfaces.surface import SphereSurface
from tippetop.mechanics.top import RollingResistance, Top, natural, natural_state, natural_units
from tippetop.problem.problem import top_of
from tippetop.sweeps.flights import rolls, slides, slips
from tippetop.sweeps.lane_arrays import Slots
from tippetop.sweeps.lane_executor import Lanes
from tippetop.sweeps.lane_sums import NO_SUMS, swept_motion
from tippetop.sweeps.launch_arrays import Launches, branched
from tippetop.sweeps.taylor_stepper import NumPyArithmetic, stepper


def told(terms, span):
    with np.errstate(all="ignore"):
        time, doubt = single_fall(list(terms), span, NumPyArithmetic())
    return time, doubt > 0.0


def test_a_change_of_branch_is_told_where_a_guard_first_falls_or_there_is_doubt():
    random = np.random.default_rng(5)
    count, degree = 4000, 12
    terms = (
        random.normal(size=(degree + 1, count))
        * random.uniform(0.2, 0.9, count) ** np.arange(degree + 1)[:, None]
    )
    terms[0] = np.abs(terms[0]) * 10.0 ** random.uniform(-8, 0, count)
    span = random.uniform(0.3, 1.0, count)
    time, doubt = told(terms, span)
    first = Polynomials(terms, span).first_fall()
    falls, sure = np.isfinite(first), ~doubt
    assert np.all(np.isfinite(time[sure]) == falls[sure])
    assert np.count_nonzero(sure & falls) > 0.1 * count
    assert np.abs(time - first)[sure & falls].max() < 1e-12


def test_a_guard_that_begins_at_zero_or_dips_between_looks_is_left_to_a_closer_look():
    terms = np.array([[0.0, 0.3**2 - 1e-9, 1.0], [-1.0, -0.6, -1.0], [2.0, 1.0, 0.0]])
    time, doubt = told(terms, np.ones(3))
    assert doubt.tolist() == [True, True, False]
    assert time[2] == 1.0 or np.isinf(time[2])


def launched_elsewhere(slip):
    """A launch that slips fast if it now hardly does, or the other way round, so that it begins on
    the branch whose polynomial means nothing now; and the state in which it slips as told.
    """
    problem = tt.presets.report_problem(spin=155.0).replace(
        {"friction.kind": "contensou", "friction.patch_radius": 5e-4, "friction.pressure": "hertz"}
    )
    units, top = natural_units(top_of(problem)), natural(top_of(problem))
    state = natural_state(problem.start(), units)
    still = velocity_without_slip(state.axis, state.momentum, top)
    here, other = (
        state._replace(velocity=(still[0] + speed, still[1], 0.0))
        for speed in (slip, 1e-5 if slip == 1.0 else 1.0)
    )
    launched = on_numbered_branch(top, slip_of(*along_table(other), top))
    numbers = np.array(launched.numbers)[:, None]
    zero = np.zeros(1)
    launches = Launches(launched.kind, numbers, other, np.ones(1), "fly", zero, "impact")
    return launches, here, (top, launched)


@pytest.mark.parametrize("slip", [1e-5, 1.0])
def test_wherever_a_launch_goes_on_it_takes_the_branch_of_its_present_state(slip):
    """Alone, after an impact or a flight on its lane, and where a part of the run is done again."""
    launches, here, (top, launched) = launched_elsewhere(slip)
    method = stepper(swept_motion(launches.kind, NO_SUMS), 1e-9)
    slots, lane = Slots(launches, method, None), np.zeros(1, dtype=int)
    slots.place(lane, here, np.zeros(1))
    again = Lanes(launches, method, 1e-9, resumed=np.array([[*along_table(here).pack(), 1.0]]).T)
    zeta = slip_of(*along_table(here), top)
    turning = angular_velocity(here.axis, here.momentum, top)
    expected = on_branch(top, zeta).friction.traction(zeta[:2], turning)
    tops = launches.sliding(0, here).top, launches.automaton(0).top
    for found in (*tops, slots.tops(lane), again.slots.tops(lane)):
        traction = found.friction.traction(zeta[:2], turning)
        np.testing.assert_allclose(np.ravel(traction.force), expected.force, rtol=1e-12)
        np.testing.assert_allclose(np.hstack(traction.torque), expected.torque, rtol=1e-12)
    wrong = launched.friction.traction(zeta[:2], turning)
    assert np.abs(np.subtract(wrong.force, expected.force)).max() > 1e-6


def test_whether_tops_go_on_in_contact_is_told_by_the_branch_of_their_states():
    """Whether they slide, slip and roll on, on whichever branch they come."""
    random, count = np.random.default_rng(1), 400
    axis = random.normal(size=(3, count))
    axis /= np.linalg.norm(axis, axis=0)
    law = HertzLaw(np.full(count, 0.3), 10.0 ** random.uniform(-4.0, -1.0, count))
    resistance = RollingResistance(np.full(count, 1e-3))
    surface = SphereSurface(1.0, 0.3)
    top = Top.of(1.0, 0.45, 0.38, surface, law, 1.0, rolling_resistance=resistance)
    momentum, velocity = random.normal(size=(2, 3, count)) * 10.0 ** random.uniform(-6, 1, count)
    sliding = SlidingState(tuple(axis), tuple(momentum), tuple(velocity[:2]))
    told = branched(top, on_table(sliding, top))
    for goes_on in (slides, slips, rolls):
        flags = goes_on(on_table(sliding, top), told)
        assert 0 < np.count_nonzero(flags) < count
        assert np.array_equal(goes_on(on_table(sliding, top), on_other_branch(told)), flags)
