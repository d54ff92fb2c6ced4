"""Variables over time that follow from the others: parts of the energy, and vectors in the body
frame.
"""

import numpy as np

from tippetop.integrators.base import Array
from tippetop.mechanics.motion import angular_velocity
from tippetop.mechanics.top import Top
from tippetop.mechanics.units import Units
from tippetop.mechanics.vectors import Vector, cross, dot, scale
from tippetop.results.samples import Samples


def derive(samples: Samples, orientation: Array, top: Top, units: Units) -> dict[str, Array]:
    """Return every variable of `catalogue.DERIVED` in SI, by name.

    The samples and the top are in natural units; the orientations are quaternions, shape (k, 4).
    """
    instants, state = samples.instants, samples.instants.state
    vectors = np.array([instants.force, state.velocity, state.momentum])
    vectors *= np.array([units.force, units.speed, units.angular_momentum]).reshape(-1, 1, 1)
    force, velocity, momentum = in_body_frame(vectors, orientation, state.axis)
    omega = angular_velocity(state.axis, state.momentum, top)
    moments = np.array([top.transverse_inertia, top.transverse_inertia, top.axial_inertia])
    turning = cross(state.momentum, state.axis)
    half = 0.5 * units.energy
    return {
        "angular_velocity": np.stack(scale(1.0 / units.time, omega), -1),
        "contact_force_body": force,
        "velocity_body": velocity,
        "angular_momentum_body": momentum,
        "angular_velocity_body": momentum / (units.inertia * moments),
        "energy_height": top.mass * top.gravity * units.energy * state.height,
        "energy_translation": half * top.mass * dot(state.velocity, state.velocity),
        "energy_spin": half * top.axial_inertia * instants.spin**2,
        "energy_turning": half / top.transverse_inertia * dot(turning, turning),
    }


def in_body_frame(vectors: Array, orientation: Array, axis: Vector) -> Array:
    """Return the components of vectors, shape (n, 3, k), in the body frame, shape (n, k, 3).

    The orientations are quaternions, shape (k, 4), that turn the body frame to the table's; the
    axis is the third unit vector of the body frame.
    """
    w, x, y, z = np.ascontiguousarray(orientation.T)
    first = (1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y))
    rows: Vector = (vectors[:, 0], vectors[:, 1], vectors[:, 2])
    components = np.empty((len(vectors), len(w), 3))
    for place, unit in enumerate((first, cross(axis, first), axis)):
        components[..., place] = dot(unit, rows)
    return components
