"""Runs in NetCDF files, read back as they were written or not at all.

A file ends in a line with the digest of all that stands before it. HDF5, and so every reader of
NetCDF, passes over what follows its own end. Here nothing is made of a file before its digest is
found right: HDF5 itself takes damaged numbers and words for good ones, and may crash where a file
is damaged elsewhere.
"""

import hashlib
from io import BytesIO
from pathlib import Path

import psutil
import xarray as xr

from tippetop.support.errors import FileTrouble, require
from tippetop.support.files import (
    in_words,
    named,
    path_of,
    place_for,
    refuse_ending_of_others,
    written_beside,
)

SEAL = b"\ntippetop sha256 "
"""What stands between the NetCDF and its digest."""

_LENGTH = len(SEAL) + 2 * hashlib.sha256().digest_size + 1


def write_run(run: xr.Dataset, path: Path | str, overwrite: bool = False) -> Path:
    """Write a result as NetCDF, beside its place first, so that no half-written file is ever left
    there.

    Raises
    ------
    InvalidInput
        If it is no dataset, or the name ends as that of another kind of file.
    FileTrouble
        If the file exists and `overwrite` is false, or cannot be written.

    Examples
    --------
    >>> import tippetop as tt
    >>> run = tt.simulate(tt.presets.report_problem(), duration=1.0, samples=11)
    >>> tt.write_run(run, "run.nc").name
    'run.nc'
    """
    require("run", run, xr.Dataset, "a dataset, such as simulate returns")
    refuse_ending_of_others("path", path_of(path))
    place_for(path, overwrite)
    # In memory first: where a disk is full HDF5 takes the whole process with it.
    memory = BytesIO()
    run.to_netcdf(memory, engine="h5netcdf")
    content = memory.getvalue()
    with written_beside(path, overwrite) as beside, beside.open("wb") as file:
        file.write(content)
        file.write(_sealed(content))
    return Path(path)


def read_run(path: Path | str) -> xr.Dataset:
    """Read a result written by `write_run`, which nobody has changed since.

    What is not as it was written is for `xarray.open_dataset`, which does not check it.

    Raises
    ------
    FileTrouble
        If the file cannot be read, is damaged or is not a result.

    Examples
    --------
    >>> import tippetop as tt
    >>> run = tt.simulate(tt.presets.report_problem(), duration=1.0, samples=11)
    >>> again = tt.read_run(tt.write_run(run, "read.nc"))
    >>> again.equals(run)
    True
    >>> tt.Problem.from_json(again.attrs["problem"]) == tt.presets.report_problem()
    True
    """
    with in_words(path, "read"):
        content = _whole(Path(path))
        try:
            with xr.open_dataset(BytesIO(content), engine="h5netcdf", decode_times=False) as opened:
                run = opened.load()
        except (ValueError, KeyError, RuntimeError) as error:
            raise FileTrouble(f"{named(path)} cannot be read: {error}") from None
    words = {name: run[name].astype(str) for name in run.variables if run[name].dtype == object}
    return run.assign(words)


def _sealed(content: bytes | memoryview) -> bytes:
    return SEAL + hashlib.sha256(content).hexdigest().encode() + b"\n"


def _whole(path: Path) -> bytes:
    """What a file holds that is, to the last bit, as it was written, and for which there is memory
    twice.
    """
    size, free = path.stat().st_size, psutil.virtual_memory().available
    if not path.is_file():
        raise FileTrouble(f"{named(path)} cannot be read: it is no file")
    if 2 * size > free:
        raise FileTrouble(
            f"{named(path)} cannot be read: it has {size:,} bytes, twice as many are needed, and"
            f" {free:,} of memory are free"
        )
    content = path.read_bytes()
    if not content[-_LENGTH:].startswith(SEAL):
        raise FileTrouble(
            f"{named(path)} cannot be read: it is not a result of this program, or no longer all"
            " of it"
        )
    if content[-_LENGTH:] != _sealed(memoryview(content)[:-_LENGTH]):
        raise FileTrouble(f"{named(path)} cannot be read: it is damaged")
    return content
