"""A number has one definition: the same wherever it is asked for, and however many samples there are."""

import json
import re

import numpy as np
import pytest
from typer.testing import CliRunner

import tippetop as tt
from tippetop.catalogue import METRICS, NEAR_FINAL
from tippetop.cli.main import app
from tippetop.export.words import tell
from tippetop.integrators import has_taylor
from tippetop.presets import report_problem

SAME = ("turns_over", "arrives", "first_lift_off", "least_normal_force", "energy_lost", "airborne_time")
"""What an executor finds on its way: events, extremes and losses."""
COARSER = {"highest": 1e-6, "highest_gap": 1e-5}
"""What is looked at between steps, by how far two executors may differ, relatively."""
EXACT = 2.3e-16
LAUNCHES = {"turns over": 155.0, "hops and turns over": 175.0, "stops half-way": 50.0}


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


@pytest.mark.skipif(not has_taylor(), reason="sweeps and runs then use methods of different orders")
def test_a_sweep_says_what_a_run_says(problem, run):
    found = tt.sweep(problem, {"launch.tilt": [problem.launch.tilt]}, duration=20.0, tolerance=EXACT)
    cell = found.isel({"launch.tilt": 0})
    for name in (*SAME, "flights", "final_theta", "end_time"):
        assert float(cell[name]) == pytest.approx(float(run[name]), abs=1e-9, rel=1e-9, nan_ok=True), name
    for name, closeness in COARSER.items():
        assert float(cell[name]) == pytest.approx(float(run[name]), rel=closeness, abs=1e-12), name
    assert found["turns_over"].attrs == run["turns_over"].attrs


def test_the_laboratory_tells_the_time_of_the_run(run):
    if float(run["final_theta"]) < 3.0:
        pytest.skip("this top does not invert")
    (told,) = re.findall(r"inverts at ([0-9.]+) s", tell(run).headline)
    assert float(told) == pytest.approx(float(run["arrives"]), abs=0.005)


def test_numbers_are_events_and_extremes_of_the_motion(problem, run):
    """Seen in samples so close that little lies between them."""
    fine = tt.simulate(problem, 20.0, samples=200_001)
    step = float(fine.time[1])
    theta = fine.theta.values
    if not np.isnan(run["turns_over"]):
        first = fine.time.values[np.argmax(theta >= np.pi / 2)]
        assert first - step <= float(run["turns_over"]) <= first
    near = fine.time.values[np.argmax(np.abs(theta - theta[-1]) < NEAR_FINAL)]
    assert near - step <= float(run["arrives"]) <= near
    least = float(fine.normal_force[fine.mode == 0].min()) if not run.sizes["flight"] else 0.0
    assert least - 1e-4 * 0.2 <= float(run["least_normal_force"]) <= least
    assert float(run["highest"]) == pytest.approx(float(fine.height.max()), rel=1e-6)
