"""Writing and reading of runs as NetCDF files with a checksum.

A file ends in a line with the digest of everything before it, which HDF5, and so every reader of
NetCDF, ignores. `read_run` checks the digest first: HDF5 reads damaged numbers and words without an
error, and may crash on other damage.
"""

import hashlib
from io import BytesIO
from pathlib import Path

import psutil
import xarray as xr

from tippetop.results.cf_flags import decoded, encoded
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
"""Bytes between the NetCDF file and its digest."""

_LENGTH = len(SEAL) + 2 * hashlib.sha256().digest_size + 1


def write_run(run: xr.Dataset, path: Path | str, overwrite: bool = False) -> Path:
    """Write a result as a NetCDF file, and return its path; never leave a half-written file.

    Raises
    ------
    InvalidInput
        If the result is no dataset, or the name has the ending of another kind of file.
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
    # In memory first, because HDF5 aborts the process if the disk is full.
    memory = BytesIO()
    encoded(run).to_netcdf(memory, engine="h5netcdf")
    content = memory.getvalue()
    with written_beside(path, overwrite) as beside, beside.open("wb") as file:
        file.write(content)
        file.write(_sealed(content))
    return Path(path)


def read_run(path: Path | str) -> xr.Dataset:
    """Return a result that `write_run` wrote.

    A file that was changed since is refused; `xarray.open_dataset` opens it without a check.

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
        content = _checked_content(Path(path))
        try:
            with xr.open_dataset(BytesIO(content), engine="h5netcdf", decode_times=False) as opened:
                run = opened.load()
        except (ValueError, KeyError, RuntimeError) as error:
            raise FileTrouble(f"{named(path)} cannot be read: {error}") from None
    words = {name: run[name].astype(str) for name in run.variables if run[name].dtype == object}
    return decoded(run.assign(words))


def _sealed(content: bytes | memoryview) -> bytes:
    return SEAL + hashlib.sha256(content).hexdigest().encode() + b"\n"


def _checked_content(path: Path) -> bytes:
    """Return the content of a file; raise `FileTrouble` if it is damaged or too large for
    memory.
    """
    size, free = path.stat().st_size, psutil.virtual_memory().available
    if not path.is_file():
        raise FileTrouble(f"{named(path)} cannot be read: it is no file")
    if 2 * size > free:
        raise FileTrouble(
            f"{named(path)} cannot be read: it needs {2 * size:,} bytes of memory, and {free:,}"
            " are free"
        )
    content = path.read_bytes()
    if not content[-_LENGTH:].startswith(SEAL):
        raise FileTrouble(
            f"{named(path)} cannot be read: it is not a result of this program, or its end is"
            " missing"
        )
    if content[-_LENGTH:] != _sealed(memoryview(content)[:-_LENGTH]):
        raise FileTrouble(f"{named(path)} cannot be read: it is damaged")
    return content
