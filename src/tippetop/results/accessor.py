"""Accessor `tippetop` of datasets: what can be done with a run or a sweep, as its methods."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import xarray as xr

from tippetop.support.errors import InvalidInput
from tippetop.support.files import path_of, require_ending
from tippetop.support.units import quantity_of

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

    from tippetop.results.account_text import Account

WRITERS = {
    ".nc": "write_run",
    ".csv": "write_csv",
    ".xlsx": "write_csv",
    ".parquet": "write_parquet",
    ".html": "write_html",
    ".glb": "write_glb",
    ".mp4": "write_movie",
    ".gif": "write_movie",
}
"""Functions that write a result, by the suffix of the file."""


@xr.register_dataset_accessor("tippetop")  # type: ignore[no-untyped-call]
class TippetopAccessor:
    """Methods of a run or a sweep, as ``run.tippetop``; functions of the package do the same.

    Examples
    --------
    >>> import tippetop as tt
    >>> run = tt.simulate(tt.presets.report_problem(), duration=1.0, samples=11)
    >>> run.tippetop.write("run.csv").name
    'run.csv'
    >>> run.tippetop.to_dataframe()["tilt"].size
    11
    """

    def __init__(self, dataset: xr.Dataset) -> None:
        self._dataset = dataset

    def plot(self, variable: str | None = None, *, ax: Any = None) -> "Figure":
        """Draw the result; see `tippetop.plot`."""
        import tippetop as tt  # noqa: PLC0415 - the package loads this module

        return tt.plot(self._dataset, variable, ax=ax)

    def view(self, height: int = 480, theme: str = "auto") -> Any:
        """Return a widget that plays the run; see `tippetop.view`."""
        import tippetop as tt  # noqa: PLC0415

        return tt.view(self._dataset, height, theme)

    def describe(self) -> "Account":
        """Return the account of the run in words; see `tippetop.describe`."""
        import tippetop as tt  # noqa: PLC0415

        return tt.describe(self._dataset)

    def write(self, path: Path | str, overwrite: bool = False) -> Path:
        """Write the result in the format of the suffix, and return the path.

        The suffix is .nc, .csv, .xlsx or .parquet, or for a run .html, .glb, .mp4 or .gif.
        """
        import tippetop as tt  # noqa: PLC0415

        suffix = require_ending("path", path_of(path), tuple(WRITERS))
        written: Path = getattr(tt, WRITERS[suffix])(self._dataset, path, overwrite)
        return written

    def to_dataframe(self, table: str | None = None) -> "pd.DataFrame":
        """Return a table of the result for pandas; see `tippetop.to_dataframe`."""
        import tippetop as tt  # noqa: PLC0415

        return tt.to_dataframe(self._dataset, table)

    def quantify(self) -> xr.Dataset:
        """Return the dataset with variables that are quantities of pint, in their SI units.

        Coordinates that index a dimension, words and truth values stay as they are. The quantities
        are of pint's application registry.
        """
        quantities = {}
        for name, variable in self._dataset.variables.items():
            units = variable.attrs.get("units")
            if units is None or name in self._dataset.xindexes or variable.dtype.kind not in "fiu":
                continue
            attributes = {key: value for key, value in variable.attrs.items() if key != "units"}
            quantity = quantity_of(variable.values, str(units))
            quantities[name] = xr.Variable(variable.dims, quantity, attributes)
        if not quantities:
            raise InvalidInput("dataset", self._dataset, "a dataset with units")
        return self._dataset.assign(quantities)
