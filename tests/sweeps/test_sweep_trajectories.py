"""Sampled trajectories of sweeps: what is kept, stored and refused."""

import shutil

import numpy as np
import pytest
import xarray as xr
from sweep_cases import lively, stored

import tippetop as tt
from tippetop.mechanics.motion import along_table, sliding_contact
from tippetop.mechanics.natural_units import Units
from tippetop.problem.presets import report_problem
from tippetop.results.samples import OF_INSTANTS
from tippetop.support.errors import InvalidInput
from tippetop.sweeps import Store, Sweep, compute, fill, read_sweep
from tippetop.sweeps.cells import cells_of, spread
from tippetop.sweeps.contents import CONTENTS
from tippetop.sweeps.lane_sums import LaneSums
from tippetop.sweeps.trajectory_samples import TrajectorySamples

EVERY = tuple(OF_INSTANTS)


def with_samples(sweep, **fields):
    """The sweep with samples of every variable."""
    stated = sweep.to_fields() | {"problem": sweep.problem, "keep": EVERY, "samples": 41}
    return Sweep(**{**stated, **fields})


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


def test_what_is_kept_changes_no_metric_beyond_rounding():
    sweep = lively("fly")
    plain, sampled = compute(sweep), compute(with_samples(sweep, samples=801))
    for name in CONTENTS:
        if plain[name].dtype.kind == "f":
            close = pytest.approx(plain[name].values, rel=1e-6, abs=1e-9, nan_ok=True)
            assert sampled[name].values == close
        elif name != "steps":
            assert np.array_equal(sampled[name].values, plain[name].values)


@pytest.fixture
def sampled_sweep(small_tasks):
    """A small sweep in several tasks of which samples are kept."""
    return with_samples(lively("fly", 6, 4, 0.3, 1e-9), keep=("tilt", "axis", "events"), samples=7)


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


def test_samples_that_are_due_when_launches_end_are_of_their_last_states():
    """Of one that slides, one in the air, and one that is about to lift off."""
    fast = np.array([0.0, 0.0, 1.0])
    rates = {"launch.precession": 200.0 * fast, "launch.spin": 50.0 + 250.0 * fast}
    cells = cells_of(report_problem(tilt=1.0), rates)
    launches, times = cells.launches(np.arange(3), 1.0), np.array([0.0, 0.5, 1.0])
    kept = {name: np.zeros((3, 3)) for name in ("normal_force", "height", "x")}
    sums = LaneSums.of(launches.kind, kept)
    units = Units(*(spread(unit, 3) for unit in cells.units))
    samples = TrajectorySamples(launches, units, times, kept, np.arange(3), np.zeros(3), sums)
    rise = np.array([0.0, 0.1, 0.0])
    ended = launches.state._replace(height=launches.state.height + rise)
    carried = np.arange(3.0) + np.zeros((sums.count, 1))
    samples.take_last(np.arange(3), ended, 0.5 / units.time, carried)
    samples.finish()
    assert np.array_equal(samples.is_sampled, np.tile([True, True, False], (3, 1)))
    touch = sliding_contact(*along_table(launches.state), launches.top)
    force = np.array([touch.normal_force[0], 0.0, 0.0]) * cells.units.energy / cells.units.length
    assert touch.normal_force[0] > 0.1
    assert touch.normal_force[2] < 0.0
    heights = np.broadcast_to(ended.height, 3) * cells.units.length
    for name, expected in (
        ("normal_force", force),
        ("height", heights),
        ("x", np.arange(3.0) * cells.units.length),
    ):
        shown = np.column_stack([expected, expected, np.full(3, np.nan)])
        assert kept[name] == pytest.approx(shown, rel=1e-12, nan_ok=True), name
