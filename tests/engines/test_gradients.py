"""Derivatives of launches in other programs: the exact ones, and what is stored of theirs."""

import math
from typing import NamedTuple

import numpy as np
import pytest

from tippetop.engines import gradients
from tippetop.engines.adapters import adapter
from tippetop.engines.comparison import STEPS
from tippetop.engines.gradients.base import PART, by_runs, exact_gradient
from tippetop.engines.gradients.mujoco import MuJoCoLaunch
from tippetop.engines.measurements import Measurements
from tippetop.engines.reference import case_of, judged_state
from tippetop.run import simulate


@pytest.mark.parametrize("parameter", gradients.PARAMETERS)
def test_the_exact_derivative_is_that_of_exact_runs(parameter):
    case = case_of("slope")
    value, part = case.problem.get(parameter), 1e-4
    until = float(case.times[case.judged - 1])
    ends = []
    for sign in (1.0, -1.0):
        problem = case.problem.replace({parameter: value * (1.0 + sign * part)})
        run = simulate(problem, until, samples=2)
        ends.append(judged_state(case, run["axis"].values[-1], run["angular_velocity"].values[-1]))
    differed = (ends[0] - ends[1]) / (2.0 * part * value)
    exact = exact_gradient(case, parameter)
    assert exact == pytest.approx(differed, rel=1e-6, abs=1e-6 * np.abs(exact).max())


def test_stored_derivatives_are_of_every_case_and_step():
    stored = gradients.LAUNCH_GRADIENTS.stored()
    for program in stored.versions:
        rows = [row for row in stored.rows if row.program == program]
        asked = {
            (name, parameter, step)
            for name in gradients.CASES_OF[program]
            for parameter in gradients.PARAMETERS
            if case_of(name).problem.get(parameter)
            for step in STEPS
        }
        assert {(row.case, row.parameter, row.step) for row in rows} == asked
        assert all(row.error > 0.0 or math.isnan(row.error) for row in rows)


def test_the_page_says_what_is_stored():
    rows = gradients.LAUNCH_GRADIENTS.stored().rows
    errors = {
        (row.case, row.parameter, row.setting, row.method, row.step): row.error for row in rows
    }
    by_runs, stepwise = "differences of runs", "mjd_transitionFD, eps 1e-08"
    # A contact that stays deeper than the difference: true to the program, and near the problem.
    for step in STEPS:
        key = ("peg", "launch.spin", "stiff")
        assert errors[*key, stepwise, step] == pytest.approx(errors[*key, by_runs, step], rel=0.02)
        assert errors[*key, by_runs, step] < 0.05
    # A launch that just touches: differences of the first step open the contact.
    assert min(errors["peg", "launch.tilt", "stiff", stepwise, step] for step in STEPS) > 100.0


def test_the_page_says_what_newton_gives():
    rows = [one for one in gradients.LAUNCH_GRADIENTS.stored().rows if one.program == "Newton"]
    errors = {
        (one.case, one.parameter, one.setting, one.method, one.step): one.error for one in rows
    }
    by_runs, backwards = "differences of runs", "reverse mode of Warp"
    stiff, soft = ("coulomb-roll", "launch.spin", "stiff springs"), ("coulomb-roll", "launch.spin")
    for step in STEPS:
        assert errors[*stiff, backwards, step] == pytest.approx(
            errors[*stiff, by_runs, step], rel=0.05
        )
    assert errors[*stiff, backwards, STEPS[-1]] < 0.05 < errors[*stiff, backwards, STEPS[0]]
    assert max(errors[*soft, "springs", backwards, step] for step in STEPS) > 1e6
    chattering = [
        errors["coulomb-roll", parameter, "springs", by_runs, step]
        for parameter in ("launch.spin", "launch.tilt")
        for step in STEPS
    ]
    assert 0.07 < min(chattering) < 0.08
    assert 8.0 < max(chattering) < 8.2
    tilted = "coulomb-roll", "launch.tilt", "stiff springs"
    *longer, shortest = STEPS
    for step in longer:
        assert errors[*tilted, backwards, step] == pytest.approx(
            errors[*tilted, by_runs, step], rel=0.05
        )
    assert errors[*tilted, backwards, shortest] < 0.08
    assert errors[*tilted, by_runs, shortest] > errors[*tilted, by_runs, longer[-1]]
    larger = list[bool]()
    for parameter in ("launch.spin", "launch.tilt"):
        for setting in ("springs", "stiff springs"):
            slope = "slope", parameter, setting
            assert errors[*slope, backwards, shortest] < 0.01
            assert errors[*slope, backwards, shortest] < errors[*slope, backwards, STEPS[0]] / 5.0
            larger += [errors[*slope, backwards, s] > errors[*slope, by_runs, s] for s in STEPS]
    assert larger.count(False) == 1


@pytest.mark.slow
def test_steps_carry_a_change_as_runs_do_in_mujoco():
    pytest.importorskip("mujoco", reason="MuJoCo is not installed")
    case, made = case_of("peg"), adapter("mujoco")
    (stiff,) = (one for one in made.settings if one.name == "stiff")
    launch = MuJoCoLaunch(case, 2e-3, stiff)
    differed = by_runs("mujoco", case, 2e-3, stiff, PART, "launch.spin")
    carried = launch.carried(launch.change("launch.spin"), 1e-8)
    assert carried == pytest.approx(differed, abs=1e-3 * np.abs(differed).max())


class Reading(NamedTuple):
    program: str
    value: float


def measurements(path, values):
    return Measurements(
        about="Readings.",
        file=str(path),
        row=Reading,
        packages={"one": "numpy", "two": "pytest", "three": "a-package-that-nobody-has"},
        measure=lambda program: [Reading(program, value) for value in values],
        program_of=lambda row: row.program,
        line=lambda row: f"{row.program} {row.value:g}",
    )


def test_measured_rows_replace_those_of_their_program_alone(tmp_path, capsys):
    path = tmp_path / "rows.json"
    measurements(path, [1.0, math.nan]).run(["--write"])
    assert (
        "three is not installed: pip install a-package-that-nobody-has" in capsys.readouterr().out
    )
    measurements(path, [3.0]).run(["--program", "two"])
    measurements(path, [2.0]).run(["--program", "one", "--write"])
    stored = measurements(path, []).stored()
    assert stored.versions == {"one": np.__version__, "two": pytest.__version__}
    assert [(row.program, row.value) for row in stored.rows[::2]] == [("two", 1.0), ("one", 2.0)]
    assert math.isnan(stored.rows[1].value)
    with pytest.raises(SystemExit):
        measurements(path, []).run(["--program", "four"])
    assert "invalid choice: 'four'" in capsys.readouterr().err
