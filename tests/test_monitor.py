"""A run is held against what every motion keeps."""

from typing import Any

import numpy as np
import pytest

import tippetop as tt
from tippetop.lowest import lowest_jellett
from tippetop.mechanics.invariants import energy
from tippetop.mechanics.top import natural, natural_state, natural_units
from tippetop.mechanics.vectors import length
from tippetop.monitor import Monitor

PROBLEM = tt.presets.report_problem()
TOP = natural(PROBLEM.top)
START = natural_state(PROBLEM.start(), natural_units(PROBLEM.top))
ENERGY = float(energy(START, TOP))


def seen(**changes: Any) -> Monitor:
    """A monitor that saw three instants as the first, but for some changes to the last."""
    monitor = Monitor(TOP, START)
    ones = np.array([1.0, 1.0, 1.0])
    told = {
        "size": length(START.axis) * ones,
        "cosine": START.axis[2] * ones,
        "height": START.height * ones,
        "energy": ENERGY * ones,
        "jellett": lowest_jellett(START, TOP) * ones,
        "work": 0.0 * ones,
    }
    for name, change in changes.items():
        told[name] = told[name] + change * np.array([0.0, 0.0, 1.0])
    monitor.see(**told)
    return monitor


def test_what_stays_as_it_was_is_exact() -> None:
    assert seen().inaccuracy < 1e-15


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_energy_that_no_work_explains_is_an_error(sign: float) -> None:
    assert seen(energy=sign * 1e-3 * ENERGY).energy_error == pytest.approx(1e-3)
    assert seen(energy=-1e-3 * ENERGY, work=-1e-3 * ENERGY).energy_error < 1e-15
    assert not seen(work=sign * 1e-3 * ENERGY).is_trusted(1e-12)


def test_jellett_s_integral_may_not_drift() -> None:
    assert TOP.conserves_jellett
    assert seen(jellett=1e-3).inaccuracy > 1e-5
    assert seen(jellett=1e-3).jellett_drift == pytest.approx(seen(jellett=-1e-3).jellett_drift)


def test_steps_that_are_too_long_are_told() -> None:
    outcomes = [
        tt.simulate(PROBLEM, 0.5, samples=2, integrator="rk4", step=step).attrs["outcome"]
        for step in (1e-2, 1e-3)
    ]
    assert outcomes == ["inaccurate", "completed"]
