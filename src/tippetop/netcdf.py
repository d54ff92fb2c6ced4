"""Runs in NetCDF files, read back as they were written or not at all.

A file ends in a line with the digest of all that stands before it. HDF5, and so every reader of NetCDF,
passes over what follows its own end. Here nothing is made of a file before its digest is found right: HDF5
itself takes damaged numbers and words for good ones, and may crash where a file is damaged elsewhere.
"""

import hashlib
import os
from io import BytesIO
from pathlib import Path
from typing import BinaryIO

import psutil
import xarray as xr

from tippetop.errors import FileTrouble
from tippetop.files import in_words, named, place_for, written_beside

SEAL = b"\ntippetop sha256 "
"""What stands between the NetCDF and its digest."""

_LENGTH = len(SEAL) + 2 * hashlib.sha256().digest_size + 1
_PIECE = 2**20


def write_run(run: xr.Dataset, path: Path | str, overwrite: bool = False) -> Path:
    """Write a result as NetCDF, beside its place first, so that no half-written file is ever left there.

    Raises
    ------
    FileTrouble
        If the file exists and `overwrite` is false, or cannot be written.

    Examples
    --------
    >>> import tippetop as tt
    >>> run = tt.simulate(tt.presets.report_problem(), duration=1.0, samples=11)
    >>> tt.write_run(run, "run.nc").name
    'run.nc'
    """
    place_for(path, overwrite)
    # In memory first: where a disk is full HDF5 takes the whole process with it.
    memory = BytesIO()
    run.to_netcdf(memory, engine="h5netcdf")
    content = memory.getvalue()
    with written_beside(path, overwrite) as beside, beside.open("wb") as file:
        file.write(content)
        file.write(_seal(hashlib.sha256(content)))
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
        if not Path(path).is_file():
            Path(path).stat()
            raise FileTrouble(f"{named(path)} cannot be read: it is no file")
        with Path(path).open("rb") as file:
            _check(file, path)
            try:
                with xr.open_dataset(file, engine="h5netcdf", decode_times=False) as opened:
                    run = opened.load()
            except (ValueError, KeyError, RuntimeError) as error:
                raise FileTrouble(f"{named(path)} cannot be read: {error}") from None
    words = {name: run[name].astype(str) for name in run.variables if run[name].dtype == object}
    return run.assign(words)


def _seal(digest: "hashlib._Hash") -> bytes:
    return SEAL + digest.hexdigest().encode() + b"\n"


def _check(file: BinaryIO, path: Path | str) -> None:
    """Refuse a file that is not, to the last bit, as it was written, or for which there is no memory."""
    size = file.seek(0, os.SEEK_END)
    free = psutil.virtual_memory().available
    if size > free:
        raise FileTrouble(
            f"{named(path)} cannot be read: it has {size:,} bytes, and {free:,} of memory are free"
        )
    left = max(size - _LENGTH, 0)
    file.seek(left)
    seal = file.read()
    file.seek(0)
    if not seal.startswith(SEAL):
        raise FileTrouble(
            f"{named(path)} cannot be read: it is not a result of this program, or no longer all of it"
        )
    digest = hashlib.sha256()
    while left:
        piece = file.read(min(left, _PIECE))
        digest.update(piece)
        left -= len(piece)
    if seal != _seal(digest):
        raise FileTrouble(f"{named(path)} cannot be read: it is damaged")
    file.seek(0)
