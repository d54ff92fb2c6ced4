"""Sampled trajectories of sweeps: the samples of single runs, and NaN after the end of each."""

import shutil

import numpy as np
import pytest
import xarray as xr
from sweep_cases import lively, problem_of, stored, thrown, truth

import tippetop as tt
from campaigns import among
from tippetop.problem.presets import report_problem
from tippetop.results.samples import OF_INSTANTS, OF_SUMS
from tippetop.run import simulate
from tippetop.support.errors import InvalidInput
from tippetop.sweeps import Product, Store, Sweep, compute, fill, read_sweep
from tippetop.sweeps.axes import Axis
from tippetop.sweeps.contents import CONTENTS

EVERY = tuple(OF_INSTANTS)


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
    among(
        [
            (tt.CoulombFriction(mu=0.3), 0.0),
            (tt.ContensouFriction(mu=0.3, patch_radius=5e-4, pressure="hertz"), 0.0),
            (tt.ViscousFriction(mu=0.3), 1e-5),
        ],
        check=1,
    ),
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


@pytest.mark.parametrize("azimuth", [0.0, 2.5])
def test_samples_of_what_is_summed_up_are_those_of_single_runs(azimuth):
    """Position, orientation, work and losses, in slides, flights, impacts and at the pole."""
    problem = report_problem(tilt=0.3, spin=175.0).replace({"launch.azimuth": azimuth})
    tilts = Product((Axis.of("launch.tilt", [0.0, 0.3, 2.0]),))
    sweep = Sweep(problem, tilts, 3.0, 1e-12)
    found = check_against_runs(with_samples(sweep, keep=(*OF_SUMS, "tilt")), closeness=1e-6)
    assert found["orientation"].dims == ("launch.tilt", "time", "quaternion")
    assert float(abs(found["x"]).max()) > 1e-3
    assert (found["work"].isel(time=-1) < 0.0).any()


def test_events_up_to_a_bound_are_those_of_single_runs(tmp_path):
    problem, spins = report_problem(tilt=0.3), [5.0, 155.0, 175.0]
    options = {"duration": 6.0, "keep": ["events", "tilt"], "samples": 3, "most_events": 4}
    found = tt.sweep(problem, {"launch.spin": spins}, workers=1, **options)
    kept = tt.sweep(problem, {"launch.spin": spins}, workers=1, out=tmp_path / "a.zarr", **options)
    xr.testing.assert_identical(kept.load(), found)
    counts = []
    for spin in spins:
        run, cell = simulate(problem.replace({"launch.spin": spin}), 6.0), found.sel(spin=spin)
        count = len(run["event_time"])
        counts.append(count)
        assert int(cell["event_count"]) == count
        listed = min(count, 4)
        kinds = [kind.replace(" ", "_") for kind in run["event_kind"].values[:4]]
        assert cell["event_kind"].values.tolist() == kinds + [""] * (4 - listed)
        for name in ("event_time", "event_impulse", "event_energy_lost"):
            np.testing.assert_allclose(cell[name][:listed], run[name][:4], rtol=1e-6, atol=1e-12)
            assert np.isnan(cell[name][listed:]).all()
    assert min(counts) < 4 < max(counts)


def test_events_are_a_table_of_their_own():
    problem, spins = report_problem(tilt=0.3), {"launch.spin": [5.0, 175.0]}
    options = {"duration": 6.0, "samples": 3, "most_events": 50, "workers": 1}
    found = tt.sweep(problem, spins, keep=["events", "tilt"], **options)
    events = tt.to_dataframe(found, "events")
    assert len(events) == min(50, int(found["event_count"].max())) > 0
    assert next(iter(events)) == "spin"
    assert set(events["event_kind"]) <= {"liftoff", "touchdown", "impact"}
    launches = tt.to_dataframe(found)
    assert len(launches) == 6
    assert "event_time" not in launches
    with pytest.raises(InvalidInput, match='None for a sweep, or "events"'):
        tt.to_dataframe(found, "flights")


def test_sweeps_that_keep_come_back_from_their_description():
    kept = {"keep": ("tilt", "events"), "samples": 7, "most_events": 3}
    sweep = with_samples(lively("fly", 2, 1, 0.1, 1e-9), **kept)
    fields = sweep.to_fields()
    assert (fields["most_events"], fields["samples"]) == (3, 7)
    assert Sweep(**fields) == sweep


def test_events_alone_have_no_samples():
    found = tt.sweep(
        report_problem(), {"launch.spin": [175.0]}, duration=0.2, keep="events", workers=1
    )
    assert "time" not in found.dims
    assert found["event_time"].shape == (1, 20)
    assert found["outcome"][0] == "moving_upright"
    assert int(found["event_count"][0]) == 0


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
        ({"keep": 3}, "a name, or a list of names, such as tilt"),
        ({"samples": 5}, "samples: 5 is only for"),
        ({"times": [0.1]}, "is only for"),
        ({"keep": "events", "samples": 5}, "samples: 5 is only for samples of variables in keep"),
        ({"keep": "tilt", "most_events": 5}, 'is only for "events" in keep'),
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
