"""Samples of a run, and the variables over time that are computed from them."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tippetop.contact.mode import Event
from tippetop.contact.readings import Instants
from tippetop.integrators.base import Array
from tippetop.mechanics.quadratures import orientation
from tippetop.mechanics.top import Top
from tippetop.mechanics.units import Units
from tippetop.mechanics.vectors import scale
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
    instants, state, sums = samples.instants, samples.instants.state, samples.sums
    drilled, rolled, braked = sums.losses
    axis, momentum = state.axis, state.momentum
    sine, (slip_x, slip_y), tilting = axis_sine(axis), instants.slip, instants.tilting
    upright = sine == 0.0
    if np.any(upright):
        # A vertical axis has no direction of leaning: the slip is then along x and y of the table,
        # and theta' is the rate at which the axis leaves the pole.
        slip_x, slip_y = (
            np.where(upright, *both) for both in zip(instants.point, instants.slip, strict=True)
        )
        leaving = np.hypot(momentum[0], momentum[1]) / top.transverse_inertia
        tilting = np.where(upright, np.copysign(leaving, axis[2]), tilting)
    return {
        "tilt": np.arctan2(sine, axis[2]),
        "tilt_rate": tilting / units.time,
        "azimuth": np.arctan2(axis[1], axis[0]),
        "precession": instants.precession / units.time,
        "spin": instants.spin / units.time,
        "slip_x": slip_x * units.speed,
        "slip_y": slip_y * units.speed,
        "normal_force": instants.force[2] * units.force,
        "contact_force": np.stack(scale(units.force, instants.force), -1),
        "contact_torque": np.stack(scale(units.energy, instants.torque), -1),
        "energy": (instants.energy - sums.descent_work(top)) * units.energy,
        "work": sums.work * units.energy,
        "sliding_loss": (-sums.work - sums.struck - drilled - rolled) * units.energy,
        "drilling_loss": drilled * units.energy,
        "rolling_loss": rolled * units.energy,
        "air_loss": braked * units.energy,
        "jellett": instants.jellett * units.jellett,
        "height": state.height * units.length,
        "gap": instants.gap * units.length,
        "x": sums.x * units.length,
        "y": sums.y * units.length,
        "axis": np.stack(axis, -1),
        "velocity": np.stack(scale(units.speed, state.velocity), -1),
        "angular_momentum": np.stack(scale(units.angular_momentum, momentum), -1),
        "orientation": np.stack(orientation(axis, sums.turn, samples.pole, np), -1),
    }


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
    """Return quaternions of shape (k, 4) with signs chosen so that they are continuous."""
    jumps = np.einsum("ij,ij->i", quaternions[1:], quaternions[:-1]) < 0
    signs = np.concatenate(([1.0], np.cumprod(np.where(jumps, -1.0, 1.0))))
    return np.asarray(quaternions * signs[:, None])
