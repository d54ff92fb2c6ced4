"""A run as a table of numbers that any spreadsheet reads."""

import csv
from pathlib import Path

import numpy as np
import xarray as xr

from tippetop.files import place_for, written_beside


def write_csv(run: xr.Dataset, path: Path | str, overwrite: bool = False) -> Path:
    """Write every variable over time as CSV: a header of names with their units, then one row a sample.

    Vectors take a column for each component; what is not a number is left empty.

    Raises
    ------
    FileTrouble
        If the file exists and `overwrite` is false, or cannot be written.
    """
    path = Path(path)
    place_for(path, overwrite)
    names, columns = _columns(run)
    with written_beside(path, overwrite) as beside, beside.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(names)
        for row in zip(*columns, strict=True):
            writer.writerow(row)
    return path


def _columns(run: xr.Dataset) -> tuple[list[str], list[list[str]]]:
    names, columns = [_header("time", run["time"])], [_texts(run["time"].values)]
    for name, variable in run.data_vars.items():
        if variable.dims == ("time",):
            names.append(_header(str(name), variable))
            columns.append(_words(variable) if name == "phase" else _texts(variable.values))
        elif variable.dims[:1] == ("time",):
            (along,) = variable.dims[1:]
            for number, label in enumerate(run[along].values):
                names.append(_header(f"{name}_{label}", variable))
                columns.append(_texts(variable.values[:, number]))
    return names, columns


def _header(name: str, variable: xr.DataArray) -> str:
    units = variable.attrs.get("units", "1")
    return name if units == "1" or name.startswith("phase") else f"{name} ({units})"


def _texts(values: np.ndarray[tuple[int, ...], np.dtype[np.float64]]) -> list[str]:
    return [repr(value) if value == value else "" for value in values.tolist()]


def _words(phase: xr.DataArray) -> list[str]:
    meanings = dict(
        zip(phase.attrs["flag_values"].tolist(), phase.attrs["flag_meanings"].split(), strict=True)
    )
    return [meanings[value] for value in phase.values.tolist()]
