"""Results as labelled datasets: names, units, provenance, and files that keep all of it."""

import os
from collections.abc import Hashable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from tippetop.catalogue import LISTED, METRICS, MONITORS, SAMPLED, Variable
from tippetop.errors import FileTrouble
from tippetop.files import refuse_overwriting, written_beside

SPACE = ["x", "y", "z"]
QUATERNION = ["w", "x", "y", "z"]
CONVENTIONS = "CF-1.11"


def assemble(
    times: NDArray[np.float64],
    samples: Mapping[str, NDArray[np.float64]],
    modes: tuple[NDArray[np.int8], Sequence[str]],
    numbers: Mapping[str, Any],
    lists: Mapping[str, NDArray[Any]],
    attributes: Mapping[str, Any],
) -> xr.Dataset:
    """Label the arrays of a run as `tippetop.catalogue` says.

    Parameters
    ----------
    times
        Sample times, s, shape (k,).
    samples
        The variables of `SAMPLED`, shape (k, ...).
    modes
        Number of the contact mode at every sample, shape (k,), and the names that the numbers stand for.
    numbers
        Those of `METRICS` and `MONITORS`.
    lists
        Those of `LISTED`.
    attributes
        Provenance.
    """
    data: dict[str, Any] = {}
    for name, values in samples.items():
        variable = SAMPLED[name]
        data[name] = xr.Variable(("time", *variable.dimensions), values, variable.attributes)
    described = Variable("contact mode", dtype="int8", flags=tuple(modes[1]))
    data["mode"] = xr.Variable(("time",), modes[0], described.attributes)
    for name, value in numbers.items():
        variable = {**METRICS, **MONITORS}[name]
        data[name] = xr.Variable((), np.asarray(value, dtype=variable.dtype), variable.attributes)
    for name, values in lists.items():
        data[name] = xr.Variable((name.partition("_")[0],), values, LISTED[name].attributes)
    coordinates = {
        "time": (("time",), times, {"long_name": "time since launch", "units": "s", "standard_name": "time"}),
        "space": SPACE,
        "quaternion": QUATERNION,
    }
    return xr.Dataset(data, coordinates, {"Conventions": CONVENTIONS, **attributes})


def write_run(run: xr.Dataset, path: Path | str, overwrite: bool = False) -> Path:
    """Write a result as NetCDF, beside its place first, so that no half-written file is ever left there.

    Raises
    ------
    FileTrouble
        If the file exists and `overwrite` is false, or cannot be written.
    """
    path = Path(path)
    refuse_overwriting(path, overwrite)
    with written_beside(path) as beside:
        run.to_netcdf(beside, engine="h5netcdf", encoding=_encoding(run))
    return path


def _encoding(run: xr.Dataset) -> dict[Hashable, dict[str, Any]]:
    """How each variable is kept: with a checksum, so that damage is seen when it is read."""
    encoding: dict[Hashable, dict[str, Any]] = {}
    for name, variable in run.variables.items():
        # HDF5 keeps no checksum of a single number.
        if variable.ndim:
            encoding[name] = {"fletcher32": True}
            if variable.dtype.kind == "U":
                # Nor of strings of any length, only of where they are; of letters it does.
                encoding[name]["dtype"] = "S1"
    return encoding


def read_run(path: Path | str) -> xr.Dataset:
    """Read a result written by `write_run`.

    Raises
    ------
    FileTrouble
        If the file cannot be read, is damaged or is not a result.
    """
    path = Path(path)
    try:
        with xr.open_dataset(path, engine="h5netcdf", decode_times=False) as file:
            run = file.load()
    except (OSError, ValueError, KeyError, RuntimeError) as error:
        number = error.errno if isinstance(error, OSError) else None
        reason = os.strerror(number) if number else "it is damaged or no NetCDF"
        raise FileTrouble(f"{path} cannot be read: {reason}") from None
    if "tippetop_version" not in run.attrs:
        raise FileTrouble(f"{path} is not a result of this program")
    words = {name: run[name].astype(str) for name in run.variables if run[name].dtype == object}
    return run.assign(words)
