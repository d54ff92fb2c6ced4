"""Tables of results in files: CSV, workbooks of Excel, and Parquet."""

from importlib import import_module
from importlib.util import find_spec
from pathlib import Path

import pandas as pd
import xarray as xr

from tippetop.results.dataframes import to_dataframe
from tippetop.support.errors import Described, InvalidInput, Unavailable, require
from tippetop.support.files import path_of, require_ending, written_beside
from tippetop.support.installation import install_command


def write_csv(
    result: xr.Dataset,
    path: Path | str,
    overwrite: bool = False,
    *,
    table: str | None = None,
    sep: str | None = None,
    decimal: str = ".",
    units: bool = True,
) -> Path:
    """Write a table of a run or of a sweep as CSV, or as a workbook of Excel.

    The header has names with units; each row is a sample, an event, a flight or a launch. The
    tables and their columns are those of `to_dataframe`; nan is written as an empty cell.

    Parameters
    ----------
    result
        The run, or the sweep.
    path
        The file, whose name ends in .csv, .tsv, .txt or .dat; or in .xlsx, which openpyxl writes.
    overwrite
        Whether an existing file may be replaced.
    table
        The table, as of `to_dataframe`.
    sep
        What separates cells: by default a comma, a tab in .tsv, and a semicolon beside decimal
        commas.
    decimal
        What separates decimals: "." or ",".
    units
        Whether headings have units, as in ``tilt (rad)``.

    Raises
    ------
    FileTrouble
        If the file exists and `overwrite` is false, or cannot be written.
    InvalidInput
        If the result is neither a run nor a sweep or has no such table, the path is no name of
        such a file, or a separator is none; of a workbook, if a separator is stated, or the table
        has more rows than a sheet.
    Unavailable
        If the file is a workbook, and openpyxl is not installed.

    Examples
    --------
    >>> import tippetop as tt
    >>> run = tt.simulate(tt.presets.report_problem(), duration=1.0, samples=11)
    >>> path = tt.write_csv(run, "run.csv")
    >>> path.read_text().splitlines()[0][:39]
    'time (s),tilt (rad),tilt_rate (rad s-1)'
    """
    frame = _with_columns_alone(to_dataframe(result, table))
    ending = require_ending("path", path_of(path), (*CSV_ENDINGS, WORKBOOK))
    require("units", units, bool, "True or False")
    if decimal not in (".", ","):
        raise InvalidInput("decimal", decimal, '"." or ","')
    if ending == WORKBOOK:
        _require_workbook(frame, sep, decimal)
    if sep is None:
        sep = "\t" if ending == ".tsv" else ";" if decimal == "," else ","
    if not (isinstance(sep, str) and len(sep) == 1) or sep in '"\r\n':
        accepted = "one character that is neither a quotation mark nor the end of a line"
        raise InvalidInput("sep", sep, accepted, hint='write sep=";"')
    if sep == decimal:
        fault = "separates the decimals of the numbers already"
        raise InvalidInput("sep", sep, "", fault, 'write sep=";"')
    unit = frame.attrs["units"]
    is_named = {name: units and unit[name] not in ("", "1") for name in frame}
    heads = [f"{name} ({unit[name]})" if is_named[name] else name for name in frame]
    with written_beside(path, overwrite) as beside:
        if ending == WORKBOOK:
            with beside.open("wb") as file:
                frame.to_excel(file, index=False, header=heads, engine="openpyxl")
        else:
            frame.to_csv(beside, index=False, header=heads, sep=sep, decimal=decimal)
    return Path(path)


CSV_ENDINGS = (".csv", ".tsv", ".txt", ".dat")
"""Endings of the names of text files with tables."""


WORKBOOK, MOST_ROWS = ".xlsx", 1_048_575
"""Ending of the name of a workbook of Excel, and the rows that a sheet has below its heading."""


def _require_workbook(frame: pd.DataFrame, sep: str | None, decimal: str) -> None:
    """Raise an error unless a table can be written as a workbook of Excel."""
    for name, value, usual in (("sep", sep, None), ("decimal", decimal, ".")):
        if value != usual:
            raise InvalidInput(name, value, "", "has no effect in a workbook", "leave it out")
    if len(frame) > MOST_ROWS:
        shown = Described(f"a table of {len(frame):,} rows")
        fault = f"is longer than a sheet of Excel, which has {MOST_ROWS:,}"
        raise InvalidInput("path", shown, "", fault, "write .csv or .parquet")
    need_workbook()


def need_workbook() -> None:
    """Raise `Unavailable` if openpyxl is not installed."""
    try:
        import_module("openpyxl")
    except ImportError:
        raise Unavailable(
            "workbooks of Excel are written by openpyxl, which is not installed: install openpyxl,"
            " or write .csv"
        ) from None


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
    require_ending("path", path_of(path), (".parquet", ".pq"))
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
