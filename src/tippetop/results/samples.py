"""Samples of a run, and the variables over time that are computed from them."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tippetop.contact.mode import Event
from tippetop.contact.readings import Instants
from tippetop.integrators.base import Array
from tippetop.mechanics.natural_units import Units
from tippetop.mechanics.quadratures import orientation
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Scalar, Vector, scale
from tippetop.mechanics.view import axis_sine
from tippetop.results.sums import RunSums


class Samples(NamedTuple):
    """Samples of a launch in natural units; every number has shape (k,)."""

    times: Array
    """Sample times."""
    instants: Instants
    """Readings of the state and the contact."""
    sums: RunSums
    """What is summed up from launch on."""
    pole: Array
    """Pole of the chart of the angle about the axis (see `tippetop.mechanics.quadratures`)."""
    mode: NDArray[np.int8]
    """Number of the contact mode in the recorder's list `modes`."""


def observe(samples: Samples, top: Top, units: Units) -> dict[str, Array]:
    """Return every variable of `catalogue.SAMPLED` in SI, by name, of a top in natural units."""
    instants = samples.instants
    variables = {name: function(instants, top, units) for name, function in OF_INSTANTS.items()}
    for name, in_si in OF_SUMS.items():
        variables[name] = in_si(instants, samples.sums, samples.pole, top, units)
    return variables


def sliding_loss(sums: RunSums) -> Scalar:
    """Return the energy lost to sliding, in natural units."""
    drilled, rolled, _ = sums.losses
    return -sums.work - sums.struck - drilled - rolled


def orientation_of(instants: Instants, sums: RunSums, pole: Scalar) -> Array:
    """Return the orientations as unit quaternions, shape (k, 4), each of either sign."""
    return np.stack(orientation(instants.state.axis, sums.turn, pole, np), -1)


def tilt_in_rad(instants: Instants) -> Array:
    """Return the tilt of the axis, rad."""
    axis = instants.state.axis
    tilt: Array = np.arctan2(axis_sine(axis), axis[2])
    return tilt


def azimuth_in_rad(instants: Instants) -> Array:
    """Return the azimuth of the axis, rad."""
    axis = instants.state.axis
    azimuth: Array = np.arctan2(axis[1], axis[0])
    return azimuth


def tilt_rate_in_si(instants: Instants, top: Top, units: Units) -> Array:
    """Return theta', rad/s; at a vertical axis the rate at which it leaves the pole."""
    state, tilting = instants.state, instants.tilting
    upright = axis_sine(state.axis) == 0.0
    if np.any(upright):
        leaving = np.hypot(state.momentum[0], state.momentum[1]) / top.transverse_inertia
        tilting = np.where(upright, np.copysign(leaving, state.axis[2]), tilting)
    rate: Array = tilting / units.time
    return rate


def slip_in_si(instants: Instants, units: Units, component: int) -> Array:
    """Return a component of the slip along the direction of leaning and across, m/s.

    A vertical axis has no such direction: the components are then along x and y of the table.
    """
    slip, upright = instants.slip[component], axis_sine(instants.state.axis) == 0.0
    if np.any(upright):
        slip = np.where(upright, instants.point[component], slip)
    velocity: Array = slip * units.speed
    return velocity


def vector_in_si(unit: Scalar, vector: Vector) -> Array:
    """Return vectors in natural units, whose unit is `unit`, as an array of shape (k, 3)."""
    return np.stack(scale(unit, vector), -1)


OF_INSTANTS: Mapping[str, Callable[[Instants, Top, Units], Array]] = {
    "tilt": lambda instants, _top, _units: tilt_in_rad(instants),
    "tilt_rate": tilt_rate_in_si,
    "azimuth": lambda instants, _top, _units: azimuth_in_rad(instants),
    "precession": lambda instants, _top, units: instants.precession / units.time,
    "spin": lambda instants, _top, units: instants.spin / units.time,
    "slip_x": lambda instants, _top, units: slip_in_si(instants, units, 0),
    "slip_y": lambda instants, _top, units: slip_in_si(instants, units, 1),
    "normal_force": lambda instants, _top, units: instants.force[2] * units.force,
    "contact_force": lambda instants, _top, units: vector_in_si(units.force, instants.force),
    "contact_torque": lambda instants, _top, units: vector_in_si(units.energy, instants.torque),
    "jellett": lambda instants, _top, units: instants.jellett * units.jellett,
    "height": lambda instants, _top, units: instants.state.height * units.length,
    "gap": lambda instants, _top, units: instants.gap * units.length,
    "axis": lambda instants, _top, _units: np.stack(instants.state.axis, -1),
    "velocity": lambda instants, _top, units: vector_in_si(units.speed, instants.state.velocity),
    "angular_momentum": lambda instants, _top, units: vector_in_si(
        units.angular_momentum, instants.state.momentum
    ),
}
"""Variables of `catalogue.SAMPLED` that follow from the state at an instant, in SI: functions of
`Instants` and of the top, in natural units, and of these units.
"""


OF_SUMS: Mapping[str, Callable[[Instants, RunSums, Scalar, Top, Units], Array]] = {
    "energy": lambda instants, sums, _pole, top, units: (
        (instants.energy - sums.descent_work(top)) * units.energy
    ),
    "work": lambda _instants, sums, _pole, _top, units: sums.work * units.energy,
    "sliding_loss": lambda _instants, sums, _pole, _top, units: sliding_loss(sums) * units.energy,
    "drilling_loss": lambda _instants, sums, _pole, _top, units: sums.losses[0] * units.energy,
    "rolling_loss": lambda _instants, sums, _pole, _top, units: sums.losses[1] * units.energy,
    "air_loss": lambda _instants, sums, _pole, _top, units: sums.losses[2] * units.energy,
    "x": lambda _instants, sums, _pole, _top, units: sums.x * units.length,
    "y": lambda _instants, sums, _pole, _top, units: sums.y * units.length,
    "orientation": lambda instants, sums, pole, _top, _units: orientation_of(instants, sums, pole),
}
"""The others, in SI: functions of `Instants`, of `RunSums` and the pole of the chart of the angle,
and of the top, in natural units, and of these units.
"""


def event_in_si(event: Event, units: Units) -> Event:
    """Return an event with its numbers in SI."""
    return replace(
        event,
        time=event.time * units.time,
        impulse=event.impulse * units.mass * units.speed,
        energy_lost=event.energy_lost * units.energy,
    )


# translate: skip
def continuous(quaternions: Array) -> Array:
    """Return quaternions of shape (..., k, 4) with signs chosen so that the k are continuous."""
    jumps = np.einsum("...i,...i->...", quaternions[..., 1:, :], quaternions[..., :-1, :]) < 0
    signs = np.ones(quaternions.shape[:-1])
    signs[..., 1:] = np.cumprod(np.where(jumps, -1.0, 1.0), axis=-1)
    return np.asarray(quaternions * signs[..., None])
