"""Where in a step another branch of the law takes over."""

import numpy as np
import pytest

import tippetop as tt
from tippetop.integrators.polynomial_zeros import single_fall
from tippetop.integrators.polynomials import Polynomials
from tippetop.mechanics.contacts.branches import on_branch, on_numbered_branch
from tippetop.mechanics.contacts.forces import velocity_without_slip
from tippetop.mechanics.contacts.slip_variables import slip_of
from tippetop.mechanics.motion import along_table, angular_velocity
from tippetop.mechanics.top import natural, natural_state, natural_units
from tippetop.problem.problem import top_of
from tippetop.sweeps.launch_arrays import Launches
from tippetop.sweeps.taylor_stepper import NumPyArithmetic


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


@pytest.mark.parametrize("slip", [1e-5, 1.0])
def test_a_launch_that_leaves_the_arrays_takes_the_branch_of_its_present_state(slip):
    """It is launched on the other one, whose polynomial means nothing here."""
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
    launches = Launches(launched.kind, numbers, other, np.ones(1), "fly", np.zeros(1), "impact")
    zeta = slip_of(*along_table(here), top)
    turning = angular_velocity(here.axis, here.momentum, top)
    found = launches.sliding(0, here).top.friction.traction(zeta[:2], turning)
    expected = on_branch(top, zeta).friction.traction(zeta[:2], turning)
    np.testing.assert_allclose(found.force, expected.force, rtol=1e-12)
    np.testing.assert_allclose(found.torque, expected.torque, rtol=1e-12)
    wrong = launched.friction.traction(zeta[:2], turning)
    assert np.abs(np.subtract(wrong.force, expected.force)).max() > 1e-6
