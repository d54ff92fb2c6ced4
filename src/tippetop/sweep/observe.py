"""What a sweep tells of every launch."""

from enum import IntEnum
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tippetop.integrators.base import Array
from tippetop.mechanics.invariants import energy, jellett
from tippetop.mechanics.motion import axial_spin
from tippetop.mechanics.state import State
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import length
from tippetop.mechanics.view import axis_sine, precession_rate
from tippetop.phases import Outcome
from tippetop.sweep.cells import Cells, Fault
from tippetop.sweep.courses import OUTCOMES, Ends, Launches

NEAR_POLE = 0.1
"""Tilt from the vertical, rad, up to which a launch counts as ending upright or inverted."""

NEAR_FINAL = 0.01
"""How close to its final value the tilt must be to count as arrived, rad (the report's definition)."""

HEIGHT_LOOKS = 65
"""Tilts at which the height of the centre of mass is looked at, over the range that a launch went through."""


class Ending(IntEnum):
    """What became of a launch."""

    UPRIGHT = 0
    INVERTED = 1
    TILTED = 2
    LIFTED_OFF = 3
    FAILED = 4
    BAD = 5


class Variable(NamedTuple):
    """A variable of a sweep.

    Attributes
    ----------
    long_name
        What it is.
    units
        Its SI unit; none for flags.
    dtype
        How it is stored.
    flags
        The meanings of the numbers 0, 1, ..., of a variable of flags.
    """

    long_name: str
    units: str
    dtype: str = "float64"
    flags: tuple[str, ...] = ()

    @property
    def missing(self) -> Any:
        """What stands where nothing is known."""
        return np.nan if self.dtype.startswith("float") else -1

    @property
    def attributes(self) -> dict[str, Any]:
        """The attributes by the CF conventions."""
        found: dict[str, Any] = {"long_name": self.long_name}
        if self.units:
            found["units"] = self.units
        if self.flags:
            found["flag_values"] = list(range(len(self.flags)))
            found["flag_meanings"] = " ".join(self.flags)
        return found


def _meanings(flags: type[IntEnum]) -> tuple[str, ...]:
    return tuple(flag.name.lower() for flag in flags)


VARIABLES = {
    "outcome": Variable(
        f"what became of it (upright, inverted: within {NEAR_POLE} rad)",
        "",
        "int8",
        _meanings(Ending),
    ),
    "fault": Variable("why there is no such launch", "", "int8", _meanings(Fault)),
    "final_theta": Variable("tilt of the axis from the vertical at the end", "rad"),
    "final_omega3": Variable("axial spin at the end", "rad s-1"),
    "final_phi_dot": Variable("precession at the end; not a number where the axis is vertical", "rad s-1"),
    "turns_over": Variable("time at which the tilt first rises past a right angle", "s"),
    "arrives": Variable(f"time at which the tilt is first within {NEAR_FINAL} rad of its final value", "s"),
    "least_normal_force": Variable("least normal force; 0 where the top left the table", "N"),
    "first_lift_off": Variable("time at which the table would first have to pull", "s"),
    "flights": Variable("number of flights", "1", "int32"),
    "airborne_time": Variable("time spent in the air", "s"),
    "energy_lost": Variable("energy lost from launch to end", "J"),
    "highest": Variable("largest height of the centre of mass above the table", "m"),
    "highest_gap": Variable("largest height of the lowest point above the table", "m"),
    "jellett_error": Variable(
        "change of Jellett's integral from launch to end, relative to |L| h at launch; "
        "an error for eccentric spheres alone, which conserve it",
        "1",
    ),
    "end_time": Variable("time at which the run ended", "s"),
    "steps": Variable("steps of the integrator", "1", "int32"),
}
"""Every variable over the cells but the status."""


def tilt(state: State) -> Array:
    """Tilts, rad."""
    found: Array = np.arctan2(axis_sine(state.axis), state.axis[2])
    return found


def final_band(ends: Ends) -> tuple[Array, Array]:
    """Least and largest n_z for which the tilt is near its final value, each of shape (n,)."""
    final = tilt(ends.state)
    low = np.cos(np.minimum(final + NEAR_FINAL, np.pi))
    high = np.cos(np.maximum(final - NEAR_FINAL, 0.0))
    return low, high


def observed(cells: Cells, which: NDArray[np.intp], launches: Launches, ends: Ends, arrives: Array) -> Any:
    """All variables but the fault, in SI, by name, for cells that were launched, each of shape (n,)."""
    top, end = launches.top, ends.state
    count = len(launches)
    mass, size, time = (np.broadcast_to(unit, len(cells.fault))[which] for unit in cells.units)
    force = mass * size / time**2
    with np.errstate(all="ignore"):
        moment = length(launches.state.momentum) * top.surface.height(launches.state.axis[2])
        change = np.abs(jellett(end, top) - jellett(launches.state, top))
        drift = change / np.where(moment > 0, moment, np.nan)
        lost = energy(launches.state, top) - energy(end, top)
        precession = np.where(axis_sine(end.axis) > 0, precession_rate(end.axis, end.momentum, top), np.nan)
    found = {
        "outcome": ending(ends),
        "final_theta": tilt(end),
        "final_omega3": axial_spin(end.axis, end.momentum, top) / time,
        "final_phi_dot": precession / time,
        "turns_over": ends.turned * time,
        "arrives": arrives * time,
        "least_normal_force": ends.least_force * force,
        "first_lift_off": ends.lift_off * time,
        "flights": ends.flights,
        "airborne_time": ends.airborne * time,
        "energy_lost": lost * force * size,
        "highest": np.fmax(sliding_height(ends, top), ends.highest) * size,
        "highest_gap": ends.highest_gap * size,
        "jellett_error": drift,
        "end_time": ends.time * time,
        "steps": ends.steps,
    }
    return {name: np.broadcast_to(values, (count,)) for name, values in found.items()}


def ending(ends: Ends) -> NDArray[np.int8]:
    """Numbers of `Ending`."""
    final = tilt(ends.state)
    near = [final <= NEAR_POLE, final >= np.pi - NEAR_POLE]
    found = np.select(near, [Ending.UPRIGHT, Ending.INVERTED], Ending.TILTED)
    found[ends.outcome == OUTCOMES.index(Outcome.LIFTED_OFF)] = Ending.LIFTED_OFF
    gave_up = np.isin(ends.outcome, [OUTCOMES.index(Outcome.FAILED), OUTCOMES.index(Outcome.TOO_MANY_PHASES)])
    found[gave_up] = Ending.FAILED
    return found.astype(np.int8)


def sliding_height(ends: Ends, top: Top) -> Array:
    """Largest support function over the tilts that were gone through, in natural units."""
    shares = np.linspace(0.0, 1.0, HEIGHT_LOOKS)[:, None]
    looks = top.surface.height(ends.down + shares * (ends.up - ends.down))
    found: Array = np.max(looks, axis=0)
    return found


def nothing_known(count: int) -> dict[str, NDArray[Any]]:
    """The variables of cells that were not launched."""
    found = {name: np.full(count, kind.missing, dtype=kind.dtype) for name, kind in VARIABLES.items()}
    found["outcome"][:] = Ending.BAD
    return found
