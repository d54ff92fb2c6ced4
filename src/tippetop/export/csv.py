"""A run as a table of numbers that any spreadsheet reads."""

from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from tippetop.results.dataset import require_run
from tippetop.support.files import written_beside


def write_csv(run: xr.Dataset, path: Path | str, overwrite: bool = False) -> Path:
    """Write every variable over time as CSV: a header of names with their units, then one row a
    sample.

    Vectors take a column for each component; what is not a number is left empty.

    Raises
    ------
    FileTrouble
        If the file exists and `overwrite` is false, or cannot be written.
    InvalidInput
        If the run is none, or the path no name of a file.

    Examples
    --------
    >>> import tippetop as tt
    >>> run = tt.simulate(tt.presets.report_problem(), duration=1.0, samples=11)
    >>> path = tt.write_csv(run, "run.csv")
    >>> path.read_text().splitlines()[0][:40]
    'time (s),theta (rad),theta_dot (rad s-1)'
    """
    require_run(run)
    columns: dict[str, Any] = {}
    for name, variable in {"time": run["time"], **run.data_vars}.items():
        units = variable.attrs.get("units", "1")
        unit = "" if units == "1" else f" ({units})"
        if variable.dims == ("time",):
            columns[f"{name}{unit}"] = ("time", _words(variable))
        elif variable.dims[:1] == ("time",):
            for number, label in enumerate(run[variable.dims[1]].values):
                columns[f"{name}_{label}{unit}"] = ("time", variable.values[:, number])
    with written_beside(path, overwrite) as beside:
        xr.Dataset(columns).to_dataframe().to_csv(beside, index=False)
    return Path(path)


def _words(variable: xr.DataArray) -> np.ndarray[Any, Any]:
    """The values, or what they stand for where they are flags."""
    if "flag_meanings" not in variable.attrs:
        return variable.values
    words = np.array(variable.attrs["flag_meanings"].split())
    return np.asarray(words[np.searchsorted(variable.attrs["flag_values"], variable.values)])
