"""Sweeps that the tests share: small, quick, and with all that can happen in them."""

import time

import numpy as np
import pytest

import tippetop as tt
from tippetop.problem.presets import report_problem
from tippetop.run import simulate
from tippetop.sweeps import Axis, Product, Sweep
from tippetop.sweeps.axes import Spaced

zarr = pytest.importorskip("zarr")

FIELDS = (
    "final_tilt",
    "final_spin",
    "energy_lost",
    "airborne_time",
    "liftoff_time",
    "end_time",
)


def lively(liftoff="fly", spins=5, mus=3, duration=1.4, tolerance=1e-12, tilt=1.0):
    """Launches of which some lift off, over spin and friction; tilted, so that things happen
    early.
    """
    problem = report_problem(tilt=tilt).replace({"contact.liftoff": liftoff})
    axes = (
        Spaced("launch.spin", 40.0, 240.0, spins),
        Spaced("friction.mu", 0.2, 1.0, mus, "log"),
    )
    return Sweep(problem, Product(axes), duration, tolerance)


def thrown(tolerance=1e-9):
    """Launches that fall on the table, bounce, and slide on; short."""
    problem = report_problem(spin=150.0, tilt=0.5)
    axes = Axis.of("launch.gap", [0.0, 0.001]), Axis.of("contact.restitution", [0.0, 0.4])
    return Sweep(problem, Product(axes), 0.12, tolerance)


def stored(sweep, out, **options):
    """A sweep carried out into a store, as anybody does that; flags as numbers."""
    limits = {"duration": sweep.duration, "tolerance": sweep.tolerance, "settled": sweep.settled}
    return tt.sweep(sweep.problem, sweep.grid, **limits, out=out, decode=False, **options)


def problem_of(sweep, cell):
    """The problem of a cell."""
    return sweep.problem.replace(
        {field: float(values[0]) for field, values in sweep.grid.values(np.array([cell])).items()}
    )


def truth(problem, duration, samples=2001, **options):
    """A run to compare with."""
    return simulate(problem, duration, samples=samples, **options)


def wait_for_a_task(store, process):
    """Wait until the process that fills a store has finished a task of it."""
    while not (store.exists() and np.any(zarr.open_array(store / "is_done", mode="r")[...])):
        assert process.poll() is None
        time.sleep(0.05)


def same(one, other):
    """Whether two results are equal, number by number."""
    return all(
        np.array_equal(one[name], other[name], equal_nan=one[name].dtype.kind == "f")
        for name in one
    )
