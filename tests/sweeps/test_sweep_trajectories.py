"""Sampled trajectories of sweeps: the samples of single runs, and NaN after the end of each."""

import shutil

import numpy as np
import pytest
import xarray as xr
from sweep_cases import lively, problem_of, stored, thrown, truth

import tippetop as tt
from tippetop.problem.presets import report_problem
from tippetop.run import simulate
from tippetop.support.errors import InvalidInput
from tippetop.sweeps import Product, Store, Sweep, compute, fill, read_sweep
from tippetop.sweeps.axes import Axis
from tippetop.sweeps.contents import CONTENTS
from tippetop.sweeps.trajectory_samples import SAMPLED_IN_SWEEPS

EVERY = tuple(SAMPLED_IN_SWEEPS)


def with_samples(sweep, **fields):
    """The sweep with samples of every variable."""
    stated = sweep.to_fields() | {"problem": sweep.problem, "keep": EVERY, "samples": 41}
    return Sweep(**{**stated, **fields})


def check_against_runs(sweep, closeness):
    """Compare every sample of every launch with that of a single run; return the sweep."""
    found = compute(sweep)
    for cell in range(sweep.cells):
        run = truth(problem_of(sweep, cell), sweep.duration, len(sweep.sample_times))
        place = np.unravel_index(cell, sweep.grid.shape)
        here = {name: found[name].values[place] for name in (*sweep.keep, "is_sampled")}
        end = float(run["end_time"])
        lasts = sweep.sample_times <= end
        assert np.array_equal(here["is_sampled"], lasts)
        at = run.sel(time=sweep.sample_times[lasts])
        for name in sweep.keep:
            expected = at[name].values
            scale = max(float(np.nanmax(np.abs(expected), initial=0.0)), 1e-9)
            got = here[name][lasts]
            assert np.array_equal(np.isnan(got), np.isnan(expected)), name
            assert np.nanmax(np.abs(got - expected), initial=0.0) <= closeness * scale, name
            assert np.all(np.isnan(here[name][~lasts]))
    return found


@pytest.mark.parametrize("liftoff", ["fly", "stop", "ignore"])
def test_samples_are_those_of_single_runs(liftoff):
    found = check_against_runs(with_samples(lively(liftoff)), closeness=1e-6)
    assert bool(found["is_sampled"].all()) == (liftoff != "stop")
    assert (found["gap"].max() > 0) == (liftoff == "fly")
    assert set(found["tilt"].dims) == {"spin", "mu", "time"} - {"spin"} | {"launch.spin"}
    assert found["axis"].dims[-1] == "space"


def test_samples_of_thrown_and_bouncing_tops_are_those_of_single_runs():
    found = check_against_runs(with_samples(thrown(1e-12), samples=301), closeness=1e-6)
    assert (found["normal_force"] == 0.0).any()
    assert (found["normal_force"] > 0.0).any()


@pytest.mark.parametrize(
    ("friction", "rolling_resistance"),
    [
        (tt.CoulombFriction(mu=0.3), 0.0),
        (tt.ContensouFriction(mu=0.3, patch_radius=5e-4, pressure="hertz"), 0.0),
        (tt.ViscousFriction(mu=0.3), 1e-5),
    ],
)
def test_samples_of_launches_that_are_followed_alone_or_change_branches(
    friction, rolling_resistance
):
    problem = report_problem(tilt=0.3).replace(
        {"friction": friction, "rolling_resistance": rolling_resistance}
    )
    sweep = Sweep(problem, Product((Axis.of("launch.spin", [5.0, 120.0]),)), 0.4, 1e-12)
    check_against_runs(with_samples(sweep), closeness=1e-6)


def test_samples_of_bodies_of_several_surfaces():
    problem = tt.Problem(
        body=tt.presets.LEINE_GLOCKER,
        friction=tt.ContensouFriction(mu=0.3, patch_radius=5e-4),
        launch=tt.Launch(tilt=0.1, spin=180.0),
    )
    sweep = Sweep(problem, Product((Axis.of("launch.spin", [120.0, 180.0]),)), 0.3, 1e-12)
    check_against_runs(with_samples(sweep, samples=11), closeness=1e-6)


def test_samples_at_given_times_dense_or_sparse_are_those_of_single_runs():
    problem, spins = report_problem(), [15.0, 150.0]
    for times in ([0.25], [0.0, 1e-5, 2e-5, 0.5], np.linspace(0.0, 0.5, 2001)):
        found = tt.sweep(
            problem, {"launch.spin": spins}, duration=0.5, keep="axis", times=times, workers=1
        )
        for spin in spins:
            run = simulate(problem.replace({"launch.spin": spin}), 0.5, times=times)
            error = np.abs(found["axis"].sel(spin=spin).values - run["axis"].values)
            assert error.max() < 1e-10


def test_a_launch_that_ends_as_it_begins_has_the_sample_of_its_launch():
    problem = report_problem(spin=0.0, tilt=0.0)
    found = tt.sweep(
        problem, {"launch.spin": [0.0]}, duration=1.0, keep=["tilt", "height"], samples=5, workers=1
    )
    run = simulate(problem, 1.0, samples=5)
    count = len(run["time"]) if float(run["end_time"]) > 0 else 1
    assert found["is_sampled"].values[0].sum() == count
    assert found["height"].values[0, 0] == pytest.approx(float(run["height"][0]), rel=1e-15)


def test_what_is_kept_changes_no_metric_beyond_rounding():
    sweep = lively("fly")
    plain, sampled = compute(sweep), compute(with_samples(sweep, samples=801))
    for name in CONTENTS:
        if plain[name].dtype.kind == "f":
            close = pytest.approx(plain[name].values, rel=1e-6, abs=1e-9, nan_ok=True)
            assert sampled[name].values == close
        elif name != "steps":
            assert np.array_equal(sampled[name].values, plain[name].values)


def test_errors_are_below_1e_10_times_the_condition_of_the_launch():
    problem, step = report_problem(), 1e-7
    spins = [60.0, 150.0, 250.0]
    found = tt.sweep(
        problem, {"launch.spin": spins}, duration=4.0, keep="axis", samples=200, workers=1
    )
    for spin in spins:
        launched = problem.replace({"launch.spin": spin})
        exact = simulate(launched, 4.0, samples=200)["axis"].values
        condition = 0.0
        for field in ("launch.spin", "launch.tilt", "friction.mu"):
            shifted = launched.replace({field: launched.get(field) * (1.0 + step)})
            moved = simulate(shifted, 4.0, samples=200)["axis"].values
            condition += np.abs(moved - exact).max() / step
        error = np.abs(found["axis"].sel(spin=spin).values - exact).max()
        assert error <= 1e-10 * condition


@pytest.fixture
def sampled_sweep(small_tasks):
    """A small sweep in several tasks of which samples are kept."""
    return with_samples(lively("fly", 6, 4, 0.3, 1e-9), keep=("tilt", "axis"), samples=7)


def test_a_store_with_samples_is_the_sweep_in_memory(tmp_path, sampled_sweep):
    store = Store.create(tmp_path / "a.zarr", sampled_sweep)
    fill(store, workers=1)
    assert len(sampled_sweep.tasks) > 2
    xr.testing.assert_identical(store.dataset().load(), compute(sampled_sweep))
    opened = xr.open_zarr(tmp_path / "a.zarr")
    assert opened["axis"].encoding["chunks"] == (*sampled_sweep.chunk, 7, 3)


def test_a_store_with_samples_is_finished_and_mended(tmp_path, sampled_sweep):
    path = tmp_path / "a.zarr"
    store = Store.create(path, sampled_sweep)
    fill(store, workers=1)
    whole = store.dataset().load()
    task = sampled_sweep.tasks[1]
    shutil.rmtree(path.joinpath("axis", "c", *map(str, task)))
    assert Store.resume(path, sampled_sweep).remaining() == [task]
    limits = {name: getattr(sampled_sweep, name) for name in ("keep", "samples")}
    again = stored(sampled_sweep, path, resume=True, workers=1, **limits)
    xr.testing.assert_identical(again.load(), whole)
    assert read_sweep(path, decode=False).load().identical(whole)


def test_a_coordinate_makes_room_for_a_variable_of_its_name():
    found = tt.sweep(
        report_problem(),
        {"launch.tilt": [0.1, 0.2], "launch.spin": [50.0]},
        duration=0.1,
        keep=["tilt"],
        samples=3,
        workers=1,
    )
    assert found["tilt"].dims == ("launch.tilt", "spin", "time")
    assert found["launch.tilt"].attrs["path"] == "launch.tilt"
    assert found["tilt"].values[:, 0, 0] == pytest.approx([0.1, 0.2])


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        ({"keep": "theta"}, "did you mean tilt"),
        ({"keep": ["tilt", "tilt"]}, "every variable once"),
        ({"keep": ["x"]}, "summed up along a run"),
        ({"keep": 3}, "a name, or a list of names, such as tilt"),
        ({"samples": 5}, "samples: 5 is only for keep"),
        ({"times": [0.1]}, "is only for keep"),
        ({"keep": "tilt", "samples": 5, "times": [0.1]}, "is given beside times"),
        ({"keep": "tilt", "times": [0.2, 0.1]}, "increasing"),
        ({"keep": "tilt", "times": [0.0, 2.0]}, "from 0 to the duration, 1 s"),
        ({"keep": "tilt", "samples": 1}, "at least 2"),
        ({"keep": EVERY, "samples": 10**9, "count": 10**5}, "fit|free memory"),
    ],
)
def test_what_cannot_be_kept_is_refused(options, sentence):
    launches = {"over": {"launch.spin": [50.0]}}
    if "count" in options:
        launches = {"draw": {"launch.spin": {"from": 1, "to": 2}}}
    with pytest.raises(InvalidInput, match=sentence):
        tt.sweep(report_problem(), **launches, duration=1.0, workers=1, **options)
