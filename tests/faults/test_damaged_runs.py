"""Runs whose files were damaged are refused: never read wrong, and never the end of the
interpreter.
"""

import os
import sys

import numpy as np
import pytest
import xarray as xr

import tippetop as tt
from campaigns import examples, seeds
from tippetop.results import netcdf
from tippetop.results.cf_flags import decoded


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    """A run with events, flights and words, and its file."""
    problem = tt.presets.report_problem(175.0)
    run = tt.simulate(problem, 7.0, samples=301)
    assert run.sizes["flight"]
    return tt.write_run(run, tmp_path_factory.mktemp("run") / "run.nc")


def damages(content, rng, count):
    """Contents that differ from a good one: bits that flipped, bytes of zero, of other places, or
    missing.
    """
    size = len(content)
    for number in range(count):
        damaged = bytearray(content)
        first = int(rng.integers(size))
        length = int(min(rng.integers(1, 600), size - first))
        match number % 5:
            case 0 | 1:
                damaged[first] ^= 1 << int(rng.integers(8))
            case 2:
                damaged[first : first + length] = bytes(length)
            case 3:
                other = int(rng.integers(size - length + 1))
                damaged[first : first + length] = content[other : other + length]
            case 4:
                del damaged[first : first + length]
        if damaged != content:
            yield bytes(damaged)


@pytest.mark.parametrize("seed", seeds(check=1, sample=3, claim=20))
def test_damage_at_any_place_is_seen(written, tmp_path, seed):
    path, content = tmp_path / "run.nc", written.read_bytes()
    refused, count = 0, examples(check=300, claim=1000)
    for damaged in damages(content, np.random.default_rng(seed), count):
        path.write_bytes(damaged)
        with pytest.raises(tt.FileTrouble, match=r"cannot be read: it is (damaged|not a result)"):
            tt.read_run(path)
        refused += 1
    assert refused > 0.8 * count


def test_others_read_the_file_as_it_is(written):
    """The digest behind the data is in nobody's way, and words are flags as CF has them."""
    with xr.open_dataset(written, engine="h5netcdf") as opened:
        xr.testing.assert_identical(decoded(opened.load()), tt.read_run(written))
    with xr.open_dataset(written) as opened:
        assert opened.attrs["status"] == tt.read_run(written).attrs["status"]


def test_a_run_for_which_there_is_no_memory_is_refused_before_it_is_read(
    written, tmp_path, monkeypatch
):
    path = tmp_path / "run.nc"
    path.write_bytes(written.read_bytes())
    with path.open("r+b") as file:
        file.truncate(2**43)
    with pytest.raises(tt.FileTrouble, match="memory"):
        tt.read_run(path)
    monkeypatch.setattr(
        netcdf.psutil, "virtual_memory", lambda: type("Memory", (), {"available": 100})
    )
    with pytest.raises(tt.FileTrouble, match="memory"):
        tt.read_run(written)


@pytest.mark.skipif(sys.platform == "win32", reason="there are no pipes with names")
def test_what_is_no_file_is_not_waited_for(tmp_path):
    os.mkfifo(tmp_path / "run.nc")
    for path in (tmp_path / "run.nc", "/dev/zero", tmp_path, "a\0b", "n" * 300):
        with pytest.raises(tt.FileTrouble, match="cannot be read"):
            tt.read_run(path)
