"""State of the top at instants of a run, in SI, for users' functions and dense solutions."""

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tippetop.contact.block import Block
from tippetop.contact.readings import TOLD, Instants
from tippetop.integrators.base import Array
from tippetop.mechanics.natural_units import Units
from tippetop.mechanics.vectors import Scalar
from tippetop.mechanics.view import axis_sine


class MotionState(NamedTuple):
    """State of the top at an instant, or at n instants, in SI units.

    At one instant numbers are floats and vectors have shape (3,); at n instants numbers have shape
    (n,) and vectors shape (3, n), so that ``s.axis[2]`` is n_z of either. Vectors are in the
    table's frame: x and y along the table, z up.

    Examples
    --------
    >>> import tippetop as tt
    >>> _, solution = tt.simulate(tt.presets.report_problem(tilt=0.1), duration=1.0, dense=True)
    >>> start = solution(0.0)
    >>> round(start.tilt, 12), round(start.height, 6), start.time
    (0.1, 0.01403, 0.0)
    """

    time: Scalar
    """Time since launch, s."""
    axis: Array
    """Unit vector along the axis of symmetry."""
    angular_momentum: Array
    """Angular momentum about the centre of mass, kg m^2/s."""
    velocity: Array
    """Velocity of the centre of mass, m/s."""
    height: Scalar
    """Height of the centre of mass above the table, m."""
    tilt: Scalar
    """Tilt of the axis from the vertical, rad."""
    azimuth: Scalar
    """Azimuth of the axis, in (-pi, pi], rad."""
    tilt_rate: Scalar
    precession: Scalar
    """Rates of both, rad/s; not numbers where the axis is vertical."""
    spin: Scalar
    """Angular velocity about the axis, rad/s."""
    energy: Scalar
    """Kinetic and potential energy, J; 0 at rest with the centre of mass on the table."""
    normal_force: Scalar
    """Normal force of the table, N; 0 in flight."""

    @classmethod
    def of(cls, time: Array, instants: Instants, units: Units) -> "MotionState":
        """Return the states at n times, s, from readings in natural units."""
        state = instants.state
        return cls(
            time,
            np.array(state.axis),
            np.array(state.momentum) * units.angular_momentum,
            np.array(state.velocity) * units.speed,
            state.height * units.length,
            np.arctan2(axis_sine(state.axis), state.axis[2]),
            np.arctan2(state.axis[1], state.axis[0]),
            instants.tilting / units.time,
            instants.precession / units.time,
            instants.spin / units.time,
            instants.energy * units.energy,
            instants.force[2] * units.force,
        )

    def each(self) -> Iterator["MotionState"]:
        """Return an iterator over the states at n instants, with floats and vectors of shape
        (3,).
        """
        columns: list[Any] = [
            value.T.copy() if value.ndim > 1 else value.tolist() for value in self
        ]
        return (MotionState(*row) for row in zip(*columns, strict=True))


def states_in(
    block: Block, step: NDArray[np.intp], part: Array, units: Units, time: Array | None = None
) -> MotionState:
    """Return the states at m instants of a block.

    Parameters
    ----------
    block
        The steps.
    step, part
        The step of each instant, and the fraction of that step that has passed, both of shape (m,).
    units
        Units of the block.
    time
        Times of the instants, s, shape (m,); by default computed from step and part.
    """
    rows = np.empty((TOLD, len(step)))
    for _, where, numbers in block.sampled(step, part):
        rows[:, where] = numbers
    if time is None:
        time = (block.starts[step] + part * block.spans[step]) * units.time
    return MotionState.of(time, Instants.unpack(rows), units)
