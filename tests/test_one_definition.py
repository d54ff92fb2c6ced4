"""A number has one definition: the same wherever it is asked for, and however many samples there
are.
"""

import json
import re

import numpy as np
import pytest
from typer.testing import CliRunner

import tippetop as tt
from tippetop.cli.commands import app
from tippetop.problem.presets import report_problem
from tippetop.results.catalogue import METRICS, NEAR_FINAL

SAME = sorted(set(METRICS) - {"steps", "jellett_change", "final_precession"})
"""What is the same for every executor: events, extremes and losses; not how many steps, or their
rounding.
"""
EXACT = 2.3e-16
LAUNCHES = {"turns over": 155.0, "flies and turns over": 175.0, "stops half-way": 50.0}


def numbers(run):
    return {name: float(run[name]) for name in METRICS}


@pytest.fixture(scope="module", params=LAUNCHES.values(), ids=LAUNCHES)
def problem(request):
    return report_problem(request.param)


@pytest.fixture(scope="module")
def run(problem):
    return tt.simulate(problem, 20.0, samples=2001)


@pytest.mark.parametrize("samples", [2, 77, 20_001])
def test_samples_change_no_number(problem, run, samples):
    other = numbers(tt.simulate(problem, 20.0, samples=samples))
    for name, number in numbers(run).items():
        assert other[name] == pytest.approx(number, rel=1e-12, abs=1e-15, nan_ok=True), name


def test_the_command_line_says_what_python_says(problem, run):
    said = CliRunner().invoke(
        app, ["simulate", "--spin", str(problem.launch.spin), "--samples", "11", "--json"]
    )
    assert said.exit_code == 0, said.output
    there, here = json.loads(said.stdout), tt.summarize(run)
    for name in set(here) & set(METRICS):
        assert there[name] == here[name], name
    assert there["events"] == here["events"]


def test_a_sweep_says_what_a_run_says(problem, run):
    found = tt.sweep(
        problem,
        {"launch.tilt": [problem.launch.tilt]},
        duration=20.0,
        tolerance=EXACT,
        decode=False,
    )
    cell = found.isel(tilt=0)
    for name in SAME:
        assert float(cell[name]) == pytest.approx(
            float(run[name]), abs=1e-9, rel=1e-9, nan_ok=True
        ), name
    assert found["turnover_time"].attrs == run["turnover_time"].attrs


@pytest.mark.parametrize("tilt", [1.1, 1.44])
def test_extremes_agree_where_many_dips_come_close(tilt):
    """Of dips that nearly tie, looks alone would take the wrong one."""
    problem, spins = (
        report_problem(155.0).replace({"launch.tilt": tilt}),
        np.linspace(140.0, 210.0, 8),
    )
    found = tt.sweep(problem, {"launch.spin": spins}, duration=8.0, tolerance=EXACT)
    for place, spin in enumerate(spins):
        run = tt.simulate(problem.replace({"launch.spin": spin}), 8.0, samples=3)
        for name in ("min_normal_force", "max_height", "max_gap"):
            assert float(found[name][place]) == pytest.approx(
                float(run[name]), rel=1e-9, abs=1e-12
            ), name


def test_the_account_tells_the_time_of_the_run(run):
    if float(run["final_tilt"]) < 3.0:
        pytest.skip("this top does not invert")
    (told,) = re.findall(r"from ([0-9.]+) s on", tt.describe(run).headline)
    assert float(told) == pytest.approx(float(run["settling_time"]), abs=0.005)


def test_numbers_are_events_and_extremes_of_the_motion(problem, run):
    """Seen in samples so close that little lies between them."""
    fine = tt.simulate(problem, 20.0, samples=200_001)
    step = float(fine.time[1])
    theta = fine.tilt.values
    if not np.isnan(run["turnover_time"]):
        first = fine.time.values[np.argmax(theta >= np.pi / 2)]
        assert first - step <= float(run["turnover_time"]) <= first
    settled = tt.predict(problem).final.tilt
    near = fine.time.values[np.argmax(np.abs(theta - settled) < NEAR_FINAL)]
    assert near - step <= float(run["arrival_time"]) <= near
    least = (
        float(fine.normal_force[fine.mode == "sliding"].min()) if not run.sizes["flight"] else 0.0
    )
    assert least - 1e-4 * 0.2 <= float(run["min_normal_force"]) <= least
    assert float(run["max_height"]) == pytest.approx(float(fine.height.max()), rel=1e-6)
