"""All variables over time, and those that derive from others: parts of the energy, and vectors in
the body frame.
"""

import numpy as np

from tippetop.contact.natural_launch import NaturalLaunch
from tippetop.integrators.base import Array
from tippetop.mechanics.motion import angular_velocity
from tippetop.mechanics.natural_units import Units
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Vector, cross, dot, scale
from tippetop.results.catalogue import SAMPLED
from tippetop.results.samples import Samples, continuous, observe


def variables_of(launch: NaturalLaunch, samples: Samples) -> dict[str, Array]:
    """Return every variable over time in SI, by name, from the samples of a launch."""
    variables = observe(samples, launch.top, launch.units)
    orientation = continuous(variables["orientation"])
    variables["orientation"] = orientation
    variables = {name: variables[name] for name in SAMPLED}
    return variables | derive(samples, orientation, launch.top, launch.units)


def derive(samples: Samples, orientation: Array, top: Top, units: Units) -> dict[str, Array]:
    """Return every variable of `catalogue.DERIVED` in SI, by name.

    The samples and the top are in natural units; the orientations are quaternions, shape (k, 4).
    """
    instants, state = samples.instants, samples.instants.state
    frame = body_frame(orientation, state.axis)
    in_body = in_frame(frame, scale(units.angular_momentum, state.momentum))
    omega = angular_velocity(state.axis, state.momentum, top)
    moments = np.array([top.transverse_inertia, top.transverse_inertia, top.axial_inertia])
    turning = cross(state.momentum, state.axis)
    half = 0.5 * units.energy
    return {
        "angular_velocity": np.stack(scale(1.0 / units.time, omega), -1),
        "contact_force_body": in_frame(frame, scale(units.force, instants.force)),
        "velocity_body": in_frame(frame, scale(units.speed, state.velocity)),
        "angular_momentum_body": in_body,
        "angular_velocity_body": in_body / (units.inertia * moments),
        "energy_height": units.energy
        * (top.mass * top.gravity * state.height - samples.sums.descent_work(top)),
        "energy_translation": half * top.mass * dot(state.velocity, state.velocity),
        "energy_spin": half * top.axial_inertia * instants.spin**2,
        "energy_turning": half / top.transverse_inertia * dot(turning, turning),
    }


def body_frame(orientation: Array, axis: Vector) -> tuple[Vector, Vector, Vector]:
    """Return the unit vectors of the body frame, each component of shape (k,).

    The orientations are quaternions, shape (k, 4), that turn the body frame to the table's; the
    axis is the third unit vector of the body frame.
    """
    w, x, y, z = np.ascontiguousarray(orientation.T)
    first = (1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y))
    return first, cross(axis, first), axis


def in_frame(frame: tuple[Vector, Vector, Vector], vector: Vector) -> Array:
    """Return the components of a vector along the unit vectors of a frame, shape (k, 3)."""
    return np.stack([dot(unit, vector) for unit in frame], -1)
