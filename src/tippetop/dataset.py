"""Results as labelled datasets: names, units, provenance."""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import NDArray


class Label(NamedTuple):
    """How a variable is described: what it is, its SI unit, and its dimensions after time."""

    long_name: str
    units: str
    dimensions: tuple[str, ...] = ()


class Described(NamedTuple):
    """Values over a dimension other than time, with what they are and their SI unit, if they have one."""

    values: NDArray[Any]
    long_name: str
    units: str = ""


LABELS = {
    "theta": Label("tilt of the axis from the vertical", "rad"),
    "theta_dot": Label("rate of the tilt", "rad s-1"),
    "phi": Label("azimuth of the axis, in (-pi, pi]", "rad"),
    "phi_dot": Label("precession; not a number where the axis is vertical", "rad s-1"),
    "omega3": Label("axial spin", "rad s-1"),
    "slip_x": Label("slip velocity along the direction into which the axis leans", "m s-1"),
    "slip_y": Label(
        "slip velocity 90 degrees to the left of the direction into which the axis leans", "m s-1"
    ),
    "normal_force": Label("normal force of the table", "N"),
    "energy": Label("kinetic and potential energy; zero at rest with the centre of mass on the table", "J"),
    "work": Label("work of the contact force since launch", "J"),
    "jellett": Label("Jellett's integral", "kg m3 s-1"),
    "height": Label("height of the centre of mass above the table", "m"),
    "gap": Label("height of the lowest point above the table", "m"),
    "x": Label("position of the centre of mass along x", "m"),
    "y": Label("position of the centre of mass along y", "m"),
    "axis": Label("unit vector along the axis of symmetry", "1", ("space",)),
    "velocity": Label("velocity of the centre of mass", "m s-1", ("space",)),
    "angular_momentum": Label("angular momentum about the centre of mass", "kg m2 s-1", ("space",)),
    "orientation": Label("orientation of the body as a unit quaternion", "1", ("quaternion",)),
}
"""Every variable over time but the phase."""

SPACE = ["x", "y", "z"]
QUATERNION = ["w", "x", "y", "z"]
CONVENTIONS = "CF-1.11"


def assemble(
    times: NDArray[np.float64],
    variables: Mapping[str, NDArray[np.float64]],
    phases: NDArray[np.int8],
    phase_names: Sequence[str],
    lists: Mapping[str, Mapping[str, Described]],
    attributes: Mapping[str, Any],
) -> xr.Dataset:
    """Label the arrays of a run.

    Parameters
    ----------
    times
        Sample times, s, shape (k,).
    variables
        The variables of `LABELS`, shape (k, ...).
    phases, phase_names
        Number of the phase at every sample, shape (k,), and the names that the numbers stand for.
    lists
        Values over dimensions other than time, by the dimension and the name.
    attributes
        Provenance.
    """
    data: dict[str, Any] = {}
    for name, values in variables.items():
        label = LABELS[name]
        described = {"long_name": label.long_name, "units": label.units}
        data[name] = (("time", *label.dimensions), values, described)
    flags = {
        "long_name": "what the top is doing",
        "flag_values": np.arange(len(phase_names), dtype=np.int8),
        "flag_meanings": " ".join(phase_names),
    }
    data["phase"] = (("time",), phases, flags)
    for dimension, columns in lists.items():
        for name, (values, long_name, units) in columns.items():
            described = {"long_name": long_name, "units": units} if units else {"long_name": long_name}
            data[name] = ((dimension,), values, described)
    coordinates = {
        "time": (("time",), times, {"long_name": "time since launch", "units": "s", "standard_name": "time"}),
        "space": SPACE,
        "quaternion": QUATERNION,
    }
    return xr.Dataset(data, coordinates, {"Conventions": CONVENTIONS, **attributes})
