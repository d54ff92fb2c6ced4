"""Conversion of results to tables of pandas: samples, events and flights, or cells of a sweep."""

from collections.abc import Sequence
from typing import Any

import pandas as pd
import xarray as xr

from tippetop.results.catalogue import LISTED
from tippetop.results.cf_flags import decoded
from tippetop.results.dataset import is_sweep, require_run
from tippetop.support.errors import InvalidInput
from tippetop.support.suggestions import not_one_of

TABLES = ("samples", "events", "flights")
"""The tables of a run."""


def to_dataframe(result: xr.Dataset, table: str | None = None) -> pd.DataFrame:
    """Return a table of a run, or the table of a sweep, for pandas.

    Parameters
    ----------
    result
        A run as `simulate` returns it, or a sweep as `sweep` does.
    table
        Table of a run: "samples", the default, "events" or "flights". A sweep has one table, and
        "events" where they are kept.

    Returns
    -------
    pandas.DataFrame
        Samples: one row a sample, with the time (s) as index; vectors and quaternions take a column
        for each component, axis_x or orientation_w. Events and flights: one row each. A sweep: one
        row a launch, the values of its axes first. Flags are words. The attributes `attrs` are
        those of the result, and "units", the SI units by columns.

    Raises
    ------
    InvalidInput
        If the result is neither a run nor a sweep, or has no such table.

    Examples
    --------
    >>> import tippetop as tt
    >>> run = tt.simulate(tt.presets.report_problem(spin=175.0), duration=8.0)
    >>> samples, flights = tt.to_dataframe(run), tt.to_dataframe(run, "flights")
    >>> samples.attrs["units"]["velocity_z"]
    'm s-1'
    >>> bool((samples.loc[samples["mode"] == "flight", "normal_force"] == 0.0).all())
    True
    >>> len(flights) == int(run["flights"])
    True
    """
    if is_sweep(result):
        has_events = "event" in result.dims
        if table is not None and not (has_events and table == "events"):
            also = ', or "events"' if has_events else ", which has one table"
            raise InvalidInput("table", table, f"None for a sweep{also}")
        columns, units = _events(result) if table else _cells(result)
    else:
        require_run(result)
        if table is not None and table not in TABLES:
            raise not_one_of("table", table, list(TABLES))
        kind = table or "samples"
        columns, units = _samples(result) if kind == "samples" else _list(result, kind)
    columns.attrs = {name: _plain(value) for name, value in result.attrs.items()}
    columns.attrs["units"] = units
    return columns


def _samples(run: xr.Dataset) -> tuple[pd.DataFrame, dict[str, str]]:
    columns, units = dict[str, Any](), {"time": run["time"].attrs["units"]}
    over_time = [str(name) for name in run.data_vars if "time" in run[name].dims]
    for name, variable in decoded(run[over_time]).data_vars.items():
        unit = variable.attrs.get("units", "")
        if variable.ndim == 1:
            parts: Sequence[tuple[str, Any]] = [(str(name), variable.values)]
        else:
            values = variable.transpose("time", ...).values
            labels = run[variable.transpose("time", ...).dims[1]].values
            parts = [(f"{name}_{label}", values[:, k]) for k, label in enumerate(labels)]
        for column, values in parts:
            columns[column], units[column] = values, unit
    return pd.DataFrame(columns, index=pd.Index(run["time"].values, name="time")), units


def _list(run: xr.Dataset, table: str) -> tuple[pd.DataFrame, dict[str, str]]:
    prefix = table.removesuffix("s") + "_"
    names = [name for name in LISTED if name.startswith(prefix)]
    columns = {name.removeprefix(prefix): run[name].values for name in names}
    units = {name.removeprefix(prefix): LISTED[name].units for name in names}
    return pd.DataFrame(columns), units


def _events(sweep: xr.Dataset) -> tuple[pd.DataFrame, dict[str, str]]:
    """Return one row an event that is kept of a launch, with the values of the launch's fields."""
    names = [name for name in sweep.data_vars if "event" in sweep[name].dims]
    columns, units = _cells(sweep[names].drop_vars("time", errors="ignore"), ())
    return columns[columns["event_time"].notna()].reset_index(drop=True), units


def _cells(
    sweep: xr.Dataset, omitted: Sequence[str] = ("event",)
) -> tuple[pd.DataFrame, dict[str, str]]:
    """Return one row a launch, or a sample of it, without variables over the omitted dimensions."""
    sweep = sweep.drop_dims(omitted, errors="ignore")
    # A single cell has no dimension, and pandas makes no table of it.
    cells = decoded(sweep if sweep.sizes else sweep.expand_dims("cell"))
    table = cells.to_dataframe().reset_index()
    order = [name for name in table if name in sweep.coords]
    order += [name for name in table if name in sweep.data_vars]
    units = {name: sweep[name].attrs.get("units", "") for name in order}
    return table[order], units


def _plain(value: Any) -> Any:
    """Return the value as a type of Python, which JSON can hold."""
    return value.tolist() if hasattr(value, "tolist") else value
