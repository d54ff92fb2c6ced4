"""Labelling of results as datasets, with names, units and provenance."""

from collections.abc import Mapping, Sequence
from functools import cache
from typing import Any, TypeGuard

import numpy as np
import pandas as pd
import xarray as xr
from numpy.typing import NDArray
from xarray.indexes import Index, PandasIndex

from tippetop.results.accessor import TippetopAccessor as TippetopAccessor
from tippetop.results.catalogue import (
    DERIVED,
    LISTED,
    METRICS,
    MONITORS,
    SAMPLED,
    SWEPT,
    Variable,
)
from tippetop.results.cf_flags import worded
from tippetop.support.errors import MISSING, InvalidInput
from tippetop.support.lazy_pint import leave_pint_alone

leave_pint_alone()

COMPONENTS = {"space": "xyz", "quaternion": "wxyz"}
"""Names of the components of vectors and quaternions, by their dimensions."""

TIME = {"long_name": "time since launch", "units": "s", "standard_name": "time"}
CONVENTIONS = "CF-1.11"


def require_run(run: object) -> None:
    """Raise `InvalidInput` unless a value is a run that `simulate` returned, or some samples of
    one.
    """
    named = {"time", *SAMPLED, *DERIVED, *METRICS, *MONITORS, *LISTED}
    if not (isinstance(run, xr.Dataset) and named <= set(run.variables) and run.sizes.get("time")):
        raise InvalidInput("run", run, "a run that simulate returned, or some of its samples")
    for name in ("problem", "status", "message", "integrator"):
        if name not in run.attrs:
            raise InvalidInput(
                f"run.attrs.{name}", MISSING, "a run that simulate returned, with its attributes"
            )


def is_sweep(result: object) -> TypeGuard[xr.Dataset]:
    """Return whether a value is a sweep, or some of its launches."""
    return isinstance(result, xr.Dataset) and "sweep" in result.attrs


def assemble(
    times: NDArray[np.float64],
    samples: Mapping[str, NDArray[np.float64]],
    modes: tuple[NDArray[np.int8], Sequence[str]],
    numbers: Mapping[str, Any],
    lists: Mapping[str, NDArray[Any]],
    attributes: Mapping[str, Any],
) -> xr.Dataset:
    """Return the arrays of a run as a dataset, labelled by `tippetop.results.catalogue`.

    Parameters
    ----------
    times
        Sample times, s, shape (k,).
    samples
        Variables of `SAMPLED` and `DERIVED`, shape (k, ...).
    modes
        Numbers of the contact modes, shape (k,), and the names by these numbers.
    numbers
        Single numbers: those of `METRICS` and `MONITORS`, and the word of the outcome.
    lists
        Variables of `LISTED`.
    attributes
        Provenance.
    """
    variables: dict[Any, xr.Variable] = {}
    for name, values in samples.items():
        variable = SAMPLED.get(name) or DERIVED[name]
        dimensions = "time", *variable.dimensions
        variables[name] = xr.Variable(dimensions, values, variable.attributes, fastpath=True)
    words = np.array(modes[1], dtype=str)[modes[0]] if modes[1] else np.empty(0, dtype=str)
    described = Variable("contact mode", flags=tuple(modes[1]))
    variables["mode"] = xr.Variable(("time",), words, worded(described), fastpath=True)
    for name, value in numbers.items():
        variable = SWEPT.get(name) or MONITORS[name]
        number = np.array(value, dtype=str if variable.flags else variable.dtype)
        variables[name] = xr.Variable((), number, worded(variable), fastpath=True)
    lengths = {"time": len(times), **{name: len(names) for name, names in COMPONENTS.items()}}
    for name, values in lists.items():
        dimension = name.partition("_")[0]
        variables[name] = xr.Variable((dimension,), values, LISTED[name].attributes, fastpath=True)
        lengths[dimension] = len(values)
    # A ready index saves xarray the analysis of the times.
    instants = PandasIndex(pd.Index(times, name="time"), "time", times.dtype, fastpath=True)
    indexes: dict[Any, Index] = {"time": instants, **_component_indexes()}
    variables |= instants.create_variables()
    for index in _component_indexes().values():
        variables |= index.create_variables()
    variables["time"].attrs = dict(TIME)
    # The public constructor would align and merge aligned variables: it takes five times as long.
    return xr.Dataset._construct_direct(
        variables, set(indexes), lengths, {"Conventions": CONVENTIONS, **attributes}, indexes
    )


@cache
def _component_indexes() -> dict[str, PandasIndex]:
    """Return the indexes of `COMPONENTS`, made when first asked for: xarray imports dask then."""
    return {
        name: PandasIndex(np.array(list(names)), name, coord_dtype=np.dtype("<U1"))
        for name, names in COMPONENTS.items()
    }
