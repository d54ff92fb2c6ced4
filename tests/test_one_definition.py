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
