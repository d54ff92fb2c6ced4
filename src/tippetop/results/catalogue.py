"""Every variable of a result: what it is called, what it is, its SI unit and how plots name it."""

# translate module: by hand in tables.js

import re
from collections.abc import Mapping
from enum import IntEnum
from typing import Any, NamedTuple

import numpy as np

NEAR_POLE = 0.1
"""Tilt from the vertical, rad, up to which a launch counts as ending upright or inverted."""

NEAR_FINAL = 0.01
"""How close to its final value the tilt must be to count as arrived, rad (the report's definition).
"""


class Ending(IntEnum):
    """What became of a launch.

    Examples
    --------
    >>> import tippetop as tt
    >>> swept = tt.sweep(tt.presets.report_problem(), {"launch.spin": [10.0, 155.0]}, duration=20.0)
    >>> [tt.Ending(number).name for number in swept["outcome"].values]
    ['UPRIGHT', 'INVERTED']
    """

    UPRIGHT = 0
    INVERTED = 1
    TILTED = 2
    LIFTED_OFF = 3
    FAILED = 4
    BAD = 5
    AT_REST = 6
    INACCURATE = 7


class Fault(IntEnum):
    """Why there is no such problem as a cell of a sweep asks for."""

    NONE = 0
    VALUE_OUT_OF_RANGE = 1
    NO_SUCH_BODY = 2
    NO_CONTACT_FORCE = 3


class Variable(NamedTuple):
    """A variable of a result."""

    long_name: str
    """What it is."""
    units: str = ""
    """Its SI unit; none for flags and words."""
    label: str = ""
    """How plots name it, in TeX between dollars, without the unit."""
    dimensions: tuple[str, ...] = ()
    """Its dimensions after that of its table."""
    dtype: str = "float64"
    """How it is stored."""
    flags: tuple[str, ...] = ()
    """The meanings of the numbers 0, 1, ..., of a variable of flags."""

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
            found["flag_values"] = np.arange(len(self.flags), dtype=self.dtype)
            found["flag_meanings"] = " ".join(self.flags)
        return found


def written_unit(units: str) -> str:
    """A unit of CF as people write it: rad/s for rad s-1."""
    powers = [re.fullmatch(r"([A-Za-z]+)(-?\d*)", unit) for unit in units.split()]
    sides: dict[bool, list[str]] = {False: [], True: []}
    for found in filter(None, powers):
        power = found[2].lstrip("-")
        sides[found[2].startswith("-")].append(
            found[1] + (f"^{power}" if power not in ("", "1") else "")
        )
    return "/".join([" ".join(sides[False]) or "1", *sides[True]])


def meanings(flags: type[IntEnum]) -> tuple[str, ...]:
    """The words of a variable of flags."""
    return tuple(flag.name.lower() for flag in flags)


SAMPLED: Mapping[str, Variable] = {
    "theta": Variable("tilt of the axis from the vertical", "rad", r"tilt $\theta$"),
    "theta_dot": Variable("rate of the tilt", "rad s-1", r"rate of the tilt $\dot\theta$"),
    "phi": Variable("azimuth of the axis, in (-pi, pi]", "rad", r"azimuth $\varphi$"),
    "phi_dot": Variable(
        "precession; not a number where the axis is vertical",
        "rad s-1",
        r"precession $\dot\varphi$",
    ),
    "omega3": Variable("axial spin", "rad s-1", r"axial spin $\omega_3$"),
    "slip_x": Variable(
        "slip velocity along the direction into which the axis leans", "m s-1", r"slip $v_x$"
    ),
    "slip_y": Variable(
        "slip velocity 90 degrees to the left of the direction into which the axis leans",
        "m s-1",
        r"slip $v_y$",
    ),
    "normal_force": Variable("normal force of the table", "N", r"normal force $N$"),
    "contact_force": Variable("force of the table", "N", r"contact force $F$", ("space",)),
    "contact_torque": Variable(
        "torque of the table about the contact point", "N m", r"contact torque $T$", ("space",)
    ),
    "energy": Variable(
        "kinetic and potential energy; zero at rest with the centre of mass on the table",
        "J",
        r"energy $E$",
    ),
    "work": Variable("work of the contact force since launch", "J", r"work $W$"),
    "sliding_loss": Variable("energy lost to sliding since launch", "J", "lost to sliding"),
    "drilling_loss": Variable("energy lost to drilling since launch", "J", "lost to drilling"),
    "rolling_loss": Variable(
        "energy lost to rolling resistance since launch", "J", "lost to rolling"
    ),
    "jellett": Variable("Jellett's integral", "kg m3 s-1", r"Jellett's integral $\lambda$"),
    "height": Variable("height of the centre of mass above the table", "m", r"height $z$"),
    "gap": Variable("height of the lowest point above the table", "m", "gap"),
    "x": Variable("position of the centre of mass along x", "m", r"$x$"),
    "y": Variable("position of the centre of mass along y", "m", r"$y$"),
    "axis": Variable("unit vector along the axis of symmetry", "1", r"axis $n$", ("space",)),
    "velocity": Variable("velocity of the centre of mass", "m s-1", r"velocity $u$", ("space",)),
    "angular_momentum": Variable(
        "angular momentum about the centre of mass",
        "kg m2 s-1",
        r"angular momentum $L$",
        ("space",),
    ),
    "orientation": Variable(
        "orientation of the body as a unit quaternion", "1", "orientation", ("quaternion",)
    ),
}
"""Every variable over time but the contact mode."""

METRICS: Mapping[str, Variable] = {
    "final_theta": Variable(
        "tilt of the axis from the vertical at the end", "rad", r"final tilt $\theta$"
    ),
    "final_omega3": Variable("axial spin at the end", "rad s-1", r"final axial spin $\omega_3$"),
    "final_phi_dot": Variable(
        "precession at the end; not a number where the axis is vertical",
        "rad s-1",
        r"final precession $\dot\varphi$",
    ),
    "turns_over": Variable(
        "time at which the tilt first rises past a right angle", "s", "turns over at"
    ),
    "arrives": Variable(
        f"time at which the tilt is first within {NEAR_FINAL} rad of its final value",
        "s",
        "arrives at",
    ),
    "least_normal_force": Variable(
        "least normal force; 0 where the top left the table", "N", "least normal force"
    ),
    "first_lift_off": Variable(
        "time at which the table would first have to pull", "s", "first lift-off"
    ),
    "flights": Variable("number of flights", "1", "flights", dtype="int32"),
    "airborne_time": Variable("time spent in the air", "s", "time in the air"),
    "energy_lost": Variable("energy lost from launch to end", "J", "energy lost"),
    "energy_lost_sliding": Variable(
        "energy lost to sliding from launch to end", "J", "lost to sliding"
    ),
    "energy_lost_drilling": Variable(
        "energy lost to drilling from launch to end", "J", "lost to drilling"
    ),
    "energy_lost_rolling": Variable(
        "energy lost to rolling resistance from launch to end", "J", "lost to rolling"
    ),
    "highest": Variable(
        "largest height of the centre of mass above the table",
        "m",
        "largest height of the centre of mass",
    ),
    "highest_gap": Variable(
        "largest height of the lowest point above the table", "m", "highest jump"
    ),
    "jellett_error": Variable(
        "change of Jellett's integral from launch to end, relative to |L| h at launch; "
        "an error for eccentric spheres alone, which conserve it",
        "1",
        "change of Jellett's integral",
    ),
    "end_time": Variable("time at which the run ended", "s", "end"),
    "steps": Variable("steps of the integrator", "1", "steps", dtype="int32"),
}
"""The numbers of a launch: of a run, and over the cells of a sweep."""

MONITORS: Mapping[str, Variable] = {
    "energy_start": Variable("energy at launch", "J"),
    "impact_energy_lost": Variable("energy lost in impacts", "J"),
    "energy_error": Variable(
        "largest error of the balance of energy and work, relative to the energy", "1"
    ),
    "evaluations": Variable("evaluations of the equations of motion", "1", dtype="int64"),
    "jellett_drift": Variable(
        "range of Jellett's integral over the run, relative to |L| h at launch", "1"
    ),
}
"""What is monitored in a run beside them."""

SWEPT: Mapping[str, Variable] = {
    "outcome": Variable(
        f"what became of it (upright, inverted: within {NEAR_POLE} rad)",
        label="outcome",
        dtype="int8",
        flags=meanings(Ending),
    ),
    "fault": Variable(
        "why there is no such launch", label="fault", dtype="int8", flags=meanings(Fault)
    ),
    **METRICS,
}
"""Every variable over the cells of a sweep but the status."""

LISTED: Mapping[str, Variable] = {
    "event_time": Variable("when it happened", "s"),
    "event_kind": Variable("what happened"),
    "event_impulse": Variable("normal impulse of the table", "N s"),
    "event_energy_lost": Variable("energy lost in it", "J"),
    "event_surface": Variable(
        "number of the body's surface to which it happened", "1", dtype="int8"
    ),
    "flight_start": Variable("when the flight began", "s"),
    "flight_end": Variable("when it ended", "s"),
    "flight_highest_gap": Variable("highest gap in it", "m"),
}
"""The variables over the events and the flights of a run, by the word before their underscore."""
