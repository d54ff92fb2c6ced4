"""Tables of results in files: CSV and Parquet."""

from importlib.util import find_spec
from pathlib import Path

import pandas as pd
import xarray as xr

from tippetop.results.dataframes import to_dataframe
from tippetop.support.errors import Unavailable
from tippetop.support.files import written_beside
from tippetop.support.installation import install_command


def write_csv(
    result: xr.Dataset, path: Path | str, overwrite: bool = False, *, table: str | None = None
) -> Path:
    """Write a table of a run or of a sweep as CSV.

    The header has names with units; each row is a sample, an event, a flight or a launch. The
    tables and their columns are those of `to_dataframe`; nan is written as an empty cell.

    Raises
    ------
    FileTrouble
        If the file exists and `overwrite` is false, or cannot be written.
    InvalidInput
        If the result is neither a run nor a sweep or has no such table, or the path is no name of
        a file.

    Examples
    --------
    >>> import tippetop as tt
    >>> run = tt.simulate(tt.presets.report_problem(), duration=1.0, samples=11)
    >>> path = tt.write_csv(run, "run.csv")
    >>> path.read_text().splitlines()[0][:39]
    'time (s),tilt (rad),tilt_rate (rad s-1)'
    """
    frame = _with_columns_alone(to_dataframe(result, table))
    units = frame.attrs["units"]
    heads = [f"{name} ({units[name]})" if units[name] not in ("", "1") else name for name in frame]
    with written_beside(path, overwrite) as beside:
        frame.to_csv(beside, index=False, header=heads)
    return Path(path)


def write_parquet(
    result: xr.Dataset, path: Path | str, overwrite: bool = False, *, table: str | None = None
) -> Path:
    """Write a table of a run or of a sweep as Parquet, with units and attributes.

    The tables and their columns are those of `to_dataframe`, and ``pandas.read_parquet`` returns
    them with their attributes.

    Raises
    ------
    FileTrouble
        If the file exists and `overwrite` is false, or cannot be written.
    InvalidInput
        If the result is neither a run nor a sweep or has no such table, or the path is no name of
        a file.
    Unavailable
        If pyarrow is not installed.

    Examples
    --------
    >>> import pandas as pd
    >>> import tippetop as tt
    >>> run = tt.simulate(tt.presets.report_problem(), duration=1.0, samples=11)
    >>> table = pd.read_parquet(tt.write_parquet(run, "run.parquet"))
    >>> table.attrs["units"]["tilt_rate"]
    'rad s-1'
    """
    need_parquet()
    frame = _with_columns_alone(to_dataframe(result, table))
    with written_beside(path, overwrite) as beside:
        frame.to_parquet(beside, engine="pyarrow", index=False)
    return Path(path)


def need_parquet() -> None:
    """Raise `Unavailable` if pyarrow is not installed."""
    if find_spec("pyarrow") is None:
        raise Unavailable(
            f"Parquet is written by pyarrow; install it with: {install_command('parquet')}"
        )


def _with_columns_alone(frame: pd.DataFrame) -> pd.DataFrame:
    """Return the table with a named index, such as the time, as its first column."""
    return frame.reset_index() if frame.index.name else frame
