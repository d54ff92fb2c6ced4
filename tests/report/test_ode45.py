"""The report's integrator and its listing."""

import math

import numpy as np
import pytest

from tippetop.mechanics.euler import published_normal_force
from tippetop.problem.presets import report_problem
from tippetop.problem.problem import top_of
from tippetop.report.listing import launch_state, listing_rates, listing_run
from tippetop.report.ode45 import REFINE, dormand_prince_step, ode45
from tippetop.run import simulate


def circle(y: np.ndarray) -> np.ndarray:
    return np.array([-y[1], y[0]])


def test_meets_its_tolerance_on_a_circle() -> None:
    solution = ode45(circle, 10.0, np.array([1.0, 0.0]), 1e-8, 1e-10)
    exact = np.stack([np.cos(solution.times), np.sin(solution.times)], axis=1)
    assert np.abs(solution.states - exact).max() < 1e-6
    assert solution.failure is None


def test_error_follows_the_tolerance() -> None:
    errors = [
        abs(
            ode45(circle, 10.0, np.array([1.0, 0.0]), tolerance, 1e-12).states[-1, 1]
            - math.sin(10.0)
        )
        for tolerance in (1e-3, 1e-6, 1e-9)
    ]
    assert errors[0] > 10 * errors[1] > 100 * errors[2]


def test_output_is_refined_and_ends_where_it_should() -> None:
    solution = ode45(circle, 7.3, np.array([1.0, 0.0]))
    assert solution.times[0] == 0.0
    assert solution.times[-1] == 7.3
    assert np.all(np.diff(solution.times) > 0)
    assert len(solution.times) == REFINE * solution.steps + 1
    assert solution.evaluations >= 6 * solution.steps + 1


def test_one_step_is_of_sixth_order_locally() -> None:
    start, steps = np.array([1.0, 0.0]), np.array([0.4, 0.2])
    ends = [dormand_prince_step(circle, start, circle(start), h)[0][1] for h in steps]
    errors = np.abs(np.array(ends) - np.sin(steps))
    assert np.log2(errors[0] / errors[1]) == pytest.approx(6.0, abs=1.1)


def test_gives_up_on_a_singularity() -> None:
    solution = ode45(lambda y: y**2, 2.0, np.array([1.0]))
    assert solution.failure
    assert solution.times[-1] == pytest.approx(1.0, abs=0.01)


def test_right_hand_side_wraps_theta_and_so_jumps_at_the_pole() -> None:
    rates = listing_rates(report_problem()).rates
    rest = (3.0, 0.0, 10.0, 155.0, 0.05, 0.05)
    below, above = rates((-1e-9, *rest), ()), rates((1e-9, *rest), ())
    assert below == pytest.approx(rates((math.pi - 1e-9, *rest), ()))
    assert abs(above[6] - below[6]) > 0.1 * abs(above[6])
    smooth = listing_rates(report_problem(), wrap=None).rates
    assert smooth((1e-9, *rest), ())[6] == pytest.approx(smooth((-1e-9, *rest), ())[6], rel=1e-6)


def test_lines_that_are_commented_out_keep_the_table_from_pulling() -> None:
    # A state in which the table would have to pull: a fast precession of a fast spin.
    state = (0.7, 0.0, 0.0, 40.0, 300.0, 0.1, 0.1)
    problem = report_problem()
    assert published_normal_force(state, top_of(problem), math) < 0
    pulled, pushed = (
        listing_rates(problem, unilateral=unilateral).rates(state, ())
        for unilateral in (False, True)
    )
    assert pulled[4] != pytest.approx(0.0, abs=1e-6)
    assert pushed[4] == 0.0
    gentle = (0.7, 0.0, 0.0, 2.0, 3.0, 0.1, 0.1)
    assert published_normal_force(gentle, top_of(problem), math) > 0
    pulled, pushed = (
        listing_rates(problem, unilateral=unilateral).rates(gentle, ())
        for unilateral in (False, True)
    )
    assert pulled == pushed


def test_listing_follows_the_true_motion_roughly() -> None:
    problem = report_problem(50.0)
    run = listing_run(problem, 2.0)
    true = simulate(problem.replace({"contact.liftoff": "ignore"}), 2.0, samples=2)
    assert float(run["tilt"][-1]) == pytest.approx(float(true["tilt"][-1]), abs=2e-3)
    assert float(run["spin"][-1]) == pytest.approx(float(true["spin"][-1]), rel=2e-3)
    assert float(run["normal_force"][0]) == pytest.approx(float(true["normal_force"][0]), rel=1e-9)
    assert float(run["energy"][0]) == pytest.approx(float(true["energy"][0]), rel=1e-9)
    assert float(run["tilt"].min()) >= 0
    assert float(run["tilt"].max()) < math.pi


def test_launch_state_is_the_launch() -> None:
    problem = report_problem(120.0, tilt=0.3).replace(
        {"launch.slip": (0.1, -0.2), "launch.precession": 4.0}
    )
    assert launch_state(problem).tolist() == [0.3, 0.0, 0.0, 4.0, 120.0, 0.1, -0.2]
