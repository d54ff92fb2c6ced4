"""Catalogue of the variables of a result: name, meaning, SI unit and label of each."""

# translate module: by hand in tables.js

import re
from collections.abc import Mapping
from enum import IntEnum
from typing import Any, NamedTuple

import numpy as np

NEAR_POLE = 0.1
"""Largest final tilt from the vertical, rad, that counts as upright or inverted."""

NEAR_FINAL = 0.01
"""Distance from its final value within which the tilt counts as arrived, rad: the report's
definition. The decay is exponential, so that a smaller distance takes longer.
"""

RISE = 0.35
"""Angle, rad, by which a top must rise and come down again to have fallen back: 20 degrees, more
than the nutation of a tippe top.
"""

LEANS_AT_LAUNCH = 0.8
"""Tilt at launch, rad, beyond which passing the horizontal does not count as turning over."""


class Outcome(IntEnum):
    """What became of a launch: the words of `outcome` of runs and sweeps, and their numbers.

    Upright, inverted and tilted are settled ends: the tilt stays there for ever (see
    `tippetop.results.settling`). The members that begin with MOVING say where a top was whose run
    ended before that. A top that fell back had risen by more than 20 degrees and came down by as
    much. A top that rolls has stopped slipping and loses no energy any more.

    Examples
    --------
    >>> import tippetop as tt
    >>> problem, spins = tt.presets.report_problem(), {"launch.spin": [10.0, 155.0]}
    >>> tt.sweep(problem, spins, duration=20.0)["outcome"].values.tolist()
    ['upright', 'inverted']
    >>> numbers = tt.sweep(problem, spins, duration=20.0, decode=False)["outcome"]
    >>> [tt.Outcome(number).name for number in numbers.values]
    ['UPRIGHT', 'INVERTED']
    """

    UPRIGHT = 0
    INVERTED = 1
    TILTED = 2
    LIFTED_OFF = 3
    FAILED = 4
    INVALID = 5
    AT_REST = 6
    INACCURATE = 7
    MOVING_UPRIGHT = 8
    MOVING_INVERTED = 9
    MOVING_TILTED = 10
    FELL_BACK = 11
    ROLLING = 12


FRAMES: Mapping[str, str] = {
    "table": "x and y along the table, z up; at rest",
    "body": (
        "z along the axis of symmetry n, x towards the marker; it moves with the body and has"
        " the table's directions where the axis is up and the marker along x"
    ),
    "contact": (
        "x along the table into the direction into which the axis leans, y 90 degrees to its left"
        " seen from above, z up; the table's directions where the axis is vertical"
    ),
}
"""Right-handed frames in which variables have their components, by their attribute `frame`."""


class Fault(IntEnum):
    """Reason why a cell of a sweep has no valid problem."""

    NONE = 0
    VALUE_OUT_OF_RANGE = 1
    NO_SUCH_BODY = 2
    NO_CONTACT_FORCE = 3


class Variable(NamedTuple):
    """Description of a variable of a result."""

    long_name: str
    """Meaning of the variable."""
    units: str = ""
    """SI unit; "" for flags and words."""
    label: str = ""
    """Label in plots, in TeX between dollars, without the unit."""
    dimensions: tuple[str, ...] = ()
    """Dimensions after the first one, which is that of its table."""
    dtype: str = "float64"
    """NumPy type in which it is stored."""
    flags: tuple[str, ...] = ()
    """Meanings of the numbers 0, 1, ... of a variable of flags."""
    frame: str = ""
    """Frame of its components, a key of `FRAMES`; "" for scalars."""
    convention: str = ""
    """Sign, origin or order of components."""
    lasting: bool = False
    """Whether a longer run does not change the variable once it is a number."""

    @property
    def missing(self) -> Any:
        """Value for "not known"; a truth value is then false."""
        if self.dtype == "bool":
            return False
        return np.nan if self.dtype.startswith("float") else -1

    @property
    def bytes(self) -> int:
        """Size of one number, bytes."""
        return np.dtype(self.dtype).itemsize

    @property
    def attributes(self) -> dict[str, Any]:
        """Attributes by the CF conventions."""
        attributes: dict[str, Any] = {"long_name": self.long_name}
        if self.units:
            attributes["units"] = self.units
        if self.frame:
            attributes["frame"] = self.frame
        if self.convention:
            attributes["convention"] = self.convention
        if self.flags:
            attributes["flag_values"] = np.arange(len(self.flags), dtype=self.dtype)
            attributes["flag_meanings"] = " ".join(self.flags)
        return attributes


def written_unit(units: str) -> str:
    """Return a unit of CF as people write it: rad/s for rad s-1."""
    powers = [re.fullmatch(r"([A-Za-z]+)(-?\d*)", unit) for unit in units.split()]
    sides: dict[bool, list[str]] = {False: [], True: []}
    for match in filter(None, powers):
        power = match[2].lstrip("-")
        sides[match[2].startswith("-")].append(
            match[1] + (f"^{power}" if power not in ("", "1") else "")
        )
    return "/".join([" ".join(sides[False]) or "1", *sides[True]])


def meanings(flags: type[IntEnum]) -> tuple[str, ...]:
    """Return the words of a variable of flags."""
    return tuple(flag.name.lower() for flag in flags)


_ON_THE_BODY = "of the table on the body"
_SLIP = "velocity of the body's lowest point over the table; friction acts against it"

SAMPLED: Mapping[str, Variable] = {
    "tilt": Variable(
        "tilt of the axis from the vertical",
        "rad",
        r"tilt $\theta$",
        frame="table",
        convention="0 with the axis up, pi with the axis down",
    ),
    "tilt_rate": Variable(
        "rate of the tilt",
        "rad s-1",
        r"rate of the tilt $\dot\theta$",
        frame="table",
        convention="positive while the axis falls away from up",
    ),
    "azimuth": Variable(
        "azimuth of the axis, in (-pi, pi]",
        "rad",
        r"azimuth $\varphi$",
        frame="table",
        convention="from x towards y",
    ),
    "precession": Variable(
        "precession; not a number where the axis is vertical",
        "rad s-1",
        r"precession $\dot\varphi$",
        frame="table",
        convention="positive counterclockwise seen from above",
    ),
    "spin": Variable(
        "axial spin",
        "rad s-1",
        r"axial spin $\omega_3$",
        frame="body",
        convention="component of the angular velocity along the axis, right-handed about it",
    ),
    "slip_x": Variable(
        "slip velocity along the direction into which the axis leans",
        "m s-1",
        r"slip $v_x$",
        frame="contact",
        convention=_SLIP,
    ),
    "slip_y": Variable(
        "slip velocity 90 degrees to the left of the direction into which the axis leans",
        "m s-1",
        r"slip $v_y$",
        frame="contact",
        convention=_SLIP,
    ),
    "normal_force": Variable(
        "normal force of the table",
        "N",
        r"normal force $N$",
        frame="table",
        convention="on the body, positive up",
    ),
    "contact_force": Variable(
        "force of the table",
        "N",
        r"contact force $F$",
        ("space",),
        frame="table",
        convention=_ON_THE_BODY,
    ),
    "contact_torque": Variable(
        "torque of the table about the contact point",
        "N m",
        r"contact torque $T$",
        ("space",),
        frame="table",
        convention=_ON_THE_BODY,
    ),
    "energy": Variable(
        "kinetic and potential energy; zero at rest with the centre of mass on the table where it"
        " is at launch",
        "J",
        r"energy $E$",
    ),
    "work": Variable(
        "work of the contact force since launch",
        "J",
        r"work $W$",
        convention="positive where the body gains energy",
    ),
    "sliding_loss": Variable("energy lost to sliding since launch", "J", "lost to sliding"),
    "drilling_loss": Variable("energy lost to drilling since launch", "J", "lost to drilling"),
    "rolling_loss": Variable(
        "energy lost to rolling resistance since launch", "J", "lost to rolling"
    ),
    "air_loss": Variable("energy lost to air since launch", "J", "lost to air"),
    "jellett": Variable(
        "Jellett's integral",
        "kg m3 s-1",
        r"Jellett's integral $\lambda$",
        convention="-L.a, with a from the centre of mass to the lowest point",
    ),
    "height": Variable(
        "height of the centre of mass above the table", "m", r"height $z$", frame="table"
    ),
    "gap": Variable("height of the lowest point above the table", "m", "gap", frame="table"),
    "x": Variable(
        "position of the centre of mass along x",
        "m",
        r"$x$",
        frame="table",
        convention="0 at launch",
    ),
    "y": Variable(
        "position of the centre of mass along y",
        "m",
        r"$y$",
        frame="table",
        convention="0 at launch",
    ),
    "axis": Variable(
        "unit vector along the axis of symmetry", "1", r"axis $n$", ("space",), frame="table"
    ),
    "velocity": Variable(
        "velocity of the centre of mass", "m s-1", r"velocity $u$", ("space",), frame="table"
    ),
    "angular_momentum": Variable(
        "angular momentum about the centre of mass",
        "kg m2 s-1",
        r"angular momentum $L$",
        ("space",),
        frame="table",
    ),
    "orientation": Variable(
        "orientation of the body as a unit quaternion",
        "1",
        "orientation",
        ("quaternion",),
        frame="table",
        convention="scalar first: w, x, y, z; it turns vectors from the body frame to the table's",
    ),
}
"""Variables over time that Python and the page's engine compute, except the contact mode."""

DERIVED: Mapping[str, Variable] = {
    "angular_velocity": Variable(
        "angular velocity", "rad s-1", r"angular velocity $\omega$", ("space",), frame="table"
    ),
    "contact_force_body": Variable(
        "force of the table in the body frame",
        "N",
        r"contact force $F$, body frame",
        ("space",),
        frame="body",
        convention=_ON_THE_BODY,
    ),
    "velocity_body": Variable(
        "velocity of the centre of mass in the body frame",
        "m s-1",
        r"velocity $u$, body frame",
        ("space",),
        frame="body",
        convention="relative to the table",
    ),
    "angular_momentum_body": Variable(
        "angular momentum about the centre of mass in the body frame",
        "kg m2 s-1",
        r"angular momentum $L$, body frame",
        ("space",),
        frame="body",
    ),
    "angular_velocity_body": Variable(
        "angular velocity in the body frame",
        "rad s-1",
        r"angular velocity $\omega$, body frame",
        ("space",),
        frame="body",
        convention="relative to the table, as a gyroscope on the body reads it",
    ),
    "energy_height": Variable(
        "potential energy; zero with the centre of mass on the table where it is at launch",
        "J",
        "energy of height",
    ),
    "energy_translation": Variable(
        "kinetic energy of the centre of mass", "J", "energy of translation"
    ),
    "energy_spin": Variable("kinetic energy of the spin about the axis", "J", "energy of spin"),
    "energy_turning": Variable(
        "kinetic energy of the turning of the axis", "J", "energy of turning"
    ),
}
"""Variables over time that follow from those of `SAMPLED`; the page's engine omits them.

The four parts of the energy add up to `energy`.
"""

METRICS: Mapping[str, Variable] = {
    "final_tilt": SAMPLED["tilt"]._replace(
        long_name="tilt of the axis from the vertical at the end", label=r"final tilt $\theta$"
    ),
    "final_spin": SAMPLED["spin"]._replace(
        long_name="axial spin at the end", label=r"final axial spin $\omega_3$"
    ),
    "final_precession": SAMPLED["precession"]._replace(
        long_name="precession at the end; not a number where the axis is vertical",
        label=r"final precession $\dot\varphi$",
    ),
    "is_settled": Variable(
        f"whether the tilt stays within {NEAR_FINAL} rad of a steady state for good",
        label="settled",
        dtype="bool",
    ),
    "turnover_time": Variable(
        "time at which the tilt first rises past a right angle",
        "s",
        "turns over at",
        lasting=True,
    ),
    "arrival_time": Variable(
        f"time at which the tilt is first within {NEAR_FINAL} rad of that at which it settles; "
        "not a number until it has settled",
        "s",
        "arrives at",
        lasting=True,
    ),
    "max_tilt_ever": Variable(
        "largest tilt of the axis; not a number while a larger one may follow",
        "rad",
        "largest tilt",
        lasting=True,
    ),
    "min_normal_force": SAMPLED["normal_force"]._replace(
        long_name="least normal force; 0 where the top left the table", label="least normal force"
    ),
    "liftoff_time": Variable(
        "time at which the table would first have to pull", "s", "first lift-off", lasting=True
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
    "energy_lost_air": Variable("energy lost to air from launch to end", "J", "lost to air"),
    "descent": Variable(
        "distance that the centre of mass moved down a table that slopes; 0 on a level one",
        "m",
        "way down the slope",
    ),
    "max_height": Variable(
        "largest height of the centre of mass above the table",
        "m",
        "largest height of the centre of mass",
        frame="table",
    ),
    "max_gap": Variable(
        "largest height of the lowest point above the table", "m", "highest jump", frame="table"
    ),
    "jellett_change": Variable(
        "change of Jellett's integral from launch to end, relative to |L| h at launch; "
        "an error for eccentric spheres alone, which conserve it",
        "1",
        "change of Jellett's integral",
    ),
    "end_time": Variable("time at which the run ended", "s", "end"),
    "steps": Variable("steps of the integrator", "1", "steps", dtype="int32"),
}
"""Single numbers of a launch: of a run, and over the cells of a sweep."""

LASTING = tuple(name for name, variable in METRICS.items() if variable.lasting)
"""Metrics that a longer run does not change once they are numbers."""

MONITORS: Mapping[str, Variable] = {
    "initial_energy": Variable("energy at launch", "J"),
    "energy_lost_impacts": Variable("energy lost in impacts", "J"),
    "energy_error": Variable(
        "largest error of the balance of energy and work, relative to the energy", "1"
    ),
    "max_tilt": Variable("largest tilt of the axis within the run", "rad"),
    "max_tilt_time": Variable("time of the largest tilt within the run", "s"),
    "settling_time": Variable(
        f"time since which the tilt stays within {NEAR_FINAL} rad of that at which it settles; "
        "not a number until it has settled",
        "s",
    ),
    "evaluations": Variable("evaluations of the equations of motion", "1", dtype="int64"),
    "jellett_drift": Variable(
        "range of Jellett's integral over the run, relative to |L| h at launch", "1"
    ),
}
"""Further single numbers of a run."""

SWEPT: Mapping[str, Variable] = {
    "outcome": Variable(
        f"outcome (upright, inverted: within {NEAR_POLE} rad; moving: not settled)",
        label="outcome",
        dtype="int8",
        flags=meanings(Outcome),
    ),
    "fault": Variable(
        "why the launch is not valid", label="fault", dtype="int8", flags=meanings(Fault)
    ),
    **METRICS,
}
"""Variables over the cells of a sweep, except the status."""

LISTED: Mapping[str, Variable] = {
    "event_time": Variable("time of the event", "s"),
    "event_kind": Variable("kind of event"),
    "event_impulse": Variable(
        "normal impulse of the table",
        "N s",
        frame="table",
        convention=SAMPLED["normal_force"].convention,
    ),
    "event_energy_lost": Variable("energy lost in the event", "J"),
    "event_surface": Variable("number of the body's surface in the event", "1", dtype="int8"),
    "flight_start": Variable("time at which the flight began", "s"),
    "flight_end": Variable("time at which the flight ended", "s"),
    "flight_max_gap": Variable("highest gap in the flight", "m", frame="table"),
}
"""Variables over the events and over the flights of a run; the prefix of the name says which."""
