"""Results in files: nothing is lost, nothing is overwritten unasked, and no half-written file is
left.
"""

import gc
import math
import os
from pathlib import Path

import h5py
import numpy as np
import pytest
import xarray as xr

import tippetop as tt
from tippetop.problem.presets import report_problem


@pytest.fixture(scope="module")
def lifted_off():
    """A run with an event in it."""
    problem = report_problem(0.0, tilt=2.5).replace(
        {"launch.tilt_rate": 100.0, "contact.liftoff": "stop"}
    )
    run = tt.simulate(problem, 1.0, samples=201)
    assert run.sizes["event"] == 1
    return run


@pytest.fixture(scope="module")
def completed():
    """A run without any event."""
    run = tt.simulate(report_problem().replace({"contact.liftoff": "stop"}), 0.1, samples=11)
    assert run.sizes["event"] == 0
    return run


@pytest.fixture(scope="module")
def vertical():
    """A run in which something is not a number."""
    run = tt.simulate(report_problem(tilt=0.0).replace({"contact.liftoff": "stop"}), 0.1, samples=3)
    assert np.all(np.isnan(run.precession))
    return run


@pytest.fixture(scope="module")
def content(lifted_off, tmp_path_factory):
    """The bytes of a file of `lifted_off`."""
    return tt.write_run(lifted_off, tmp_path_factory.mktemp("content") / "run.nc").read_bytes()


@pytest.fixture
def path(content, tmp_path):
    """A file of `lifted_off`."""
    path = tmp_path / "run.nc"
    path.write_bytes(content)
    return path


@pytest.fixture(params=["lifted_off", "completed", "vertical"])
def run(request):
    return request.getfixturevalue(request.param)


def test_a_result_is_as_xarray_itself_would_build_it(run):
    built = xr.Dataset(
        {
            name: (values.dims, values.values, values.attrs)
            for name, values in run.data_vars.items()
        },
        {name: (name, values.values, values.attrs) for name, values in run.coords.items()},
        run.attrs,
    )
    assert same(run, built)
    assert list(run.variables) == list(built.variables)
    assert run.sizes == built.sizes
    assert {name: type(index) for name, index in run.xindexes.items()} == {
        name: type(index) for name, index in built.xindexes.items()
    }
    labels = run.contact_force.sel(space="z").isel(time=0)
    assert labels == run.normal_force[0]
    assert run.sel(time=run.time[-1] / 2, method="nearest").sizes == built.isel(time=0).sizes


def test_results_share_nothing_that_can_be_changed(completed):
    completed.space.attrs["long_name"] = "changed"
    again = tt.simulate(tt.presets.report_problem(), 0.1, samples=11)
    assert again.space.attrs == {}
    del completed.space.attrs["long_name"]


def same(read, written):
    """Whether everything is the same: values to the last bit, types, dimensions, units and
    attributes.
    """
    xr.testing.assert_identical(read, written)
    assert list(read.attrs) == list(written.attrs)
    for name in written.variables:
        assert read[name].dtype == written[name].dtype, name
        for key, value in written[name].attrs.items():
            assert np.asarray(read[name].attrs[key]).dtype == np.asarray(value).dtype, (name, key)
    for key, value in written.attrs.items():
        assert type(read.attrs[key]) is type(value) or read.attrs[key].dtype.kind in "fi", key
    return True


# --- there and back
# -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("name_type", [Path, pytest.param(str, marks=pytest.mark.slow)])
def test_what_is_read_is_what_was_written(name_type, request, tmp_path):
    run = request.getfixturevalue("vertical" if name_type is str else "completed")
    path = tt.write_run(run, name_type(tmp_path / "run.nc"))
    assert path == tmp_path / "run.nc"
    assert same(tt.read_run(name_type(path)), run)


def test_problem_that_is_read_runs_as_the_one_written(lifted_off, path):
    read = tt.read_run(path)
    assert same(read, lifted_off)
    again = tt.simulate(tt.Problem.from_json(read.attrs["problem"]), 1.0, samples=201)
    assert same(again, lifted_off)


@pytest.mark.parametrize("count", [pytest.param(0, marks=pytest.mark.slow), 3])
def test_every_number_and_every_sentence_survives_a_file(completed, tmp_path, count):
    """Also what is infinite, not a number, negative zero or too small for full precision."""
    special = [math.inf, -math.inf, math.nan, -0.0, 5e-324, -2.5e-310, 1e308, 0.1]
    numbers = [*special, *np.random.default_rng(count).normal(size=3)]
    kinds = np.array(["liftoff", "touchdown", "impact"][:count], dtype=completed.event_kind.dtype)
    run = completed.drop_dims(set(completed.sizes) - {"time", "space", "quaternion"})
    run["tilt"] = run.tilt.copy(data=numbers)
    run["event_kind"] = ("event", kinds.astype(str), completed.event_kind.attrs)
    run.attrs["message"] = ["", "é, 中, 🎠 \U0010ffff ' \" \\ %"][count > 0]
    read = tt.read_run(tt.write_run(run, tmp_path / "run.nc"))
    assert same(read, run)
    np.testing.assert_array_equal(np.signbit(read.tilt), np.signbit(run.tilt))


def test_file_follows_the_cf_conventions(path):
    """CF: a convention named, units on every quantity, and flags explained by as many words as
    values.
    """
    with xr.open_dataset(path, engine="h5netcdf", decode_cf=False) as raw:
        assert raw.attrs["Conventions"].startswith("CF-1.")
        flags, meanings = raw.mode.attrs["flag_values"], raw.mode.attrs["flag_meanings"].split()
        assert np.size(flags) == len(meanings)
        assert np.asarray(flags).dtype == raw.mode.dtype == np.int8
        assert set(raw.mode.values) <= set(np.atleast_1d(flags))
        assert meanings[0] == "sliding"
        for name, variable in raw.data_vars.items():
            if variable.dtype == np.float64:
                assert variable.attrs["units"], name


def test_file_takes_the_permissions_of_any_new_file(completed, tmp_path):
    (tmp_path / "any").write_text("")
    path = tt.write_run(completed, tmp_path / "run.nc")
    assert path.stat().st_mode == (tmp_path / "any").stat().st_mode


# --- nothing is overwritten unasked, nor half written
# -------------------------------------------------------


def told(trouble):
    """What a user is told, which is one line."""
    text = str(trouble.value)
    assert "\n" not in text
    return text


def test_file_that_exists_is_not_overwritten_unasked(completed, path, content):
    with pytest.raises(tt.FileTrouble, match="exists") as trouble:
        tt.write_run(completed, path)
    assert str(path) in told(trouble)
    assert path.read_bytes() == content


def test_file_that_exists_is_overwritten_when_asked_for(completed, path, tmp_path):
    tt.write_run(completed, path, overwrite=True)
    assert same(tt.read_run(path), completed)
    assert list(tmp_path.iterdir()) == [path]


class PowerCut(BaseException):
    """Something that is no ordinary error."""


@pytest.mark.parametrize(
    ("error", "raised", "overwriting"),
    [
        (OSError(28, "No space left on device"), tt.FileTrouble, False),
        pytest.param(
            OSError(28, "No space left on device"), tt.FileTrouble, True, marks=pytest.mark.slow
        ),
        pytest.param(ValueError("cannot be encoded"), ValueError, False, marks=pytest.mark.slow),
        (KeyboardInterrupt(), KeyboardInterrupt, True),
        (PowerCut(), PowerCut, False),
    ],
)
def test_nothing_is_left_of_a_file_whose_writing_fails(
    completed, content, tmp_path, monkeypatch, error, raised, overwriting
):
    path = tmp_path / "run.nc"
    if overwriting:
        path.write_bytes(content)

    def fails_now(handle):
        beside = set(tmp_path.iterdir()) - {path}
        assert len(beside) == 1
        assert beside.pop().stat().st_size == os.fstat(handle).st_size > 1000
        raise error

    with monkeypatch.context() as broken:
        broken.setattr(os, "fsync", fails_now)
        with pytest.raises(raised) as trouble:
            tt.write_run(completed, path, overwrite=overwriting)
    if raised is tt.FileTrouble:
        assert str(path) in told(trouble)
        assert "No space left" in told(trouble)
    assert list(tmp_path.iterdir()) == ([path] if overwriting else [])
    if overwriting:
        assert path.read_bytes() == content


@pytest.mark.parametrize("place", ["no/such/folder/run.nc", "file/run.nc", "/proc/run.nc"])
def test_place_that_cannot_be_written_to_is_named(completed, tmp_path, place):
    (tmp_path / "file").write_text("mine")
    with pytest.raises(tt.FileTrouble) as trouble:
        tt.write_run(completed, tmp_path / place)
    assert str(tmp_path / place) in told(trouble)
    assert (tmp_path / "file").read_text() == "mine"
    assert len(list(tmp_path.iterdir())) == 1


def test_folder_is_not_replaced_by_a_file(completed, tmp_path):
    (tmp_path / "folder").mkdir()
    for overwrite in (False, True):
        with pytest.raises(tt.FileTrouble) as trouble:
            tt.write_run(completed, tmp_path / "folder", overwrite=overwrite)
        assert "folder" in told(trouble)
    assert [path.name for path in tmp_path.rglob("*")] == ["folder"]


# --- what cannot be read
# ------------------------------------------------------------------------------------


def refused(path):
    """What is said about a file that cannot be read, with nothing said anywhere else."""
    with pytest.raises(tt.FileTrouble) as trouble:
        tt.read_run(path)
    text = told(trouble)
    assert text.startswith(str(path))
    del trouble
    gc.collect()  # a complaint of a finalizer is a warning here, and thus an error
    return text


@pytest.mark.parametrize("fraction", [0.0, 0.01, 0.3, 0.9, 0.9999])
def test_truncated_file_is_refused(path, content, fraction):
    path.write_bytes(content[: math.floor(fraction * len(content))])
    assert "cannot be read" in refused(path)


@pytest.mark.parametrize(
    "content",
    [
        np.random.default_rng(2).bytes(5000),
        b"theta,phi\n0.1,0.2\n",
        b"CDF\x01" + bytes(100),
        b"\x89HDF\r\n\x1a\n" + bytes(3000),
    ],
    ids=["garbage", "text", "empty classic NetCDF", "HDF5 of zeros"],
)
def test_file_that_is_no_netcdf_is_refused(tmp_path, content):
    path = tmp_path / "run.nc"
    path.write_bytes(content)
    assert "cannot be read" in refused(path)


def test_damaged_beginning_is_refused(path, content):
    path.write_bytes(content[:60] + np.random.default_rng(3).bytes(500) + content[560:])
    assert "cannot be read" in refused(path)


def test_what_another_program_changed_is_refused(path):
    """Also where the change leaves a file as good as any to HDF5."""
    with h5py.File(path, "r+") as file:
        file.attrs["problem"] = file.attrs["problem"].replace("2.5", "2.4")
    refused(path)
    with xr.open_dataset(path, engine="h5netcdf") as changed:
        assert "2.4" in changed.attrs["problem"]


def test_netcdf_of_another_program_is_refused(tmp_path):
    path = tmp_path / "weather.nc"
    weather = xr.Dataset(
        {"temperature": ("time", [280.0, 281.0])}, attrs={"Conventions": "CF-1.11"}
    )
    weather.to_netcdf(path, engine="h5netcdf")
    assert "not a result of this program" in refused(path)


def test_file_that_is_not_there_is_refused(tmp_path):
    assert "No such file" in refused(tmp_path / "none.nc")


def test_folder_is_refused(tmp_path):
    assert "cannot be read" in refused(tmp_path)


def test_reading_leaves_the_file_alone_and_closed(lifted_off, path, content):
    """What is read can be written over its own file, and is the same when read again."""
    read = tt.read_run(path)
    assert path.read_bytes() == content
    tt.write_run(read, path, overwrite=True)
    assert same(tt.read_run(path), lifted_off)
