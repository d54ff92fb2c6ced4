"""Results as labelled datasets: names, units, provenance."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from tippetop.catalogue import LISTED, METRICS, MONITORS, SAMPLED, Variable

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
        data[name] = ("time", *variable.dimensions), values, variable.attributes
    described = Variable("contact mode", dtype="int8", flags=tuple(modes[1]))
    data["mode"] = "time", modes[0], described.attributes
    for name, value in numbers.items():
        variable = METRICS.get(name) or MONITORS[name]
        data[name] = (), np.asarray(value, dtype=variable.dtype), variable.attributes
    for name, values in lists.items():
        data[name] = name.partition("_")[0], values, LISTED[name].attributes
    coordinates = {
        "time": (("time",), times, {"long_name": "time since launch", "units": "s", "standard_name": "time"}),
        "space": SPACE,
        "quaternion": QUATERNION,
    }
    return xr.Dataset(data, coordinates, {"Conventions": CONVENTIONS, **attributes})
