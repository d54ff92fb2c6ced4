"""What is accumulated along a run, and what is computed from it, is listed alike everywhere."""

from dataclasses import fields

import numpy as np
import pytest

import tippetop as tt
from tippetop.results.accumulation import ACCUMULATED, accumulate, before_launch, of_a_part
from tippetop.results.catalogue import METRICS, MONITORS, SWEPT
from tippetop.results.metrics import Ends
from tippetop.sweeps.lane_arrays import HELD_BY_LANES

PARTS = [
    {"struck": 1.0, "flights": 1, "lift_off": 3.0, "highest_gap": 0.1, "down": 0.5, "up": 0.6},
    {"struck": 0.5, "flights": 2, "lift_off": np.nan, "highest_gap": 0.3, "down": -0.2, "up": 0.1},
]
"""Quantities of two parts of a run, one after the other."""

WHOLE = {"struck": 1.5, "flights": 3, "lift_off": 3.0, "highest_gap": 0.3, "down": -0.2, "up": 0.6}


def test_every_quantity_says_how_it_is_accumulated():
    assert {field.name for field in fields(Ends)} == {"state", *ACCUMULATED}
    assert set(ACCUMULATED) > HELD_BY_LANES


def test_parts_of_a_run_make_the_whole():
    ends, launches = before_launch(3), np.array([0, 2])
    for part in PARTS:
        accumulate(ends, launches, **part)
    for name, number in WHOLE.items():
        assert getattr(ends, name)[launches].tolist() == [number, number], name
    untouched = of_a_part(before_launch(1))
    for name, quantity in of_a_part(ends).items():
        np.testing.assert_array_equal(quantity[1:2], untouched[name], name)


@pytest.mark.parametrize("spin", [50.0, 175.0])
def test_runs_and_sweeps_have_the_metrics_of_the_catalogue(spin):
    problem = tt.presets.report_problem(spin)
    run = tt.simulate(problem, 0.5, samples=2)
    cells = tt.sweep(problem, {"launch.spin": [spin]}, duration=0.5)
    assert {name for name, one in run.data_vars.items() if one.dims == ()} == {
        "outcome",
        *METRICS,
        *MONITORS,
    }
    assert set(cells.data_vars) == {"is_done", *SWEPT}
    assert set(SWEPT) == {"outcome", "fault", *METRICS}
