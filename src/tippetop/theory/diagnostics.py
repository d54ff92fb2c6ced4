"""Theoretical quantities along a run: gyroscopic balance, constants of a smooth table, envelope.

All functions take the axis n and the angular momentum L about the centre of mass (kg m^2/s) of a
run, shape (n, 3), and are regular where the axis is vertical, except for quantities that are
infinite there.
"""

import numpy as np

from tippetop.integrators.base import Array
from tippetop.mechanics.motion import axial_spin
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Vector
from tippetop.mechanics.view import precession_rate
from tippetop.theory import nutation


def gyroscopic_balance(axis: Array, momentum: Array, top: Top) -> Array:
    """Return xi = I1 phi' cos(theta) - I3 omega3, kg m^2/s, shape (n,); nan where n is vertical.

    A spinning body is in gyroscopic balance where xi is small compared with I3 omega3: its nutation
    is then fast, and its tilt moves slowly (Moffatt and Shimomura 2002; Ueda, Sasaki and Watanabe
    2005).
    """
    n, L = _vector(axis), _vector(momentum)
    with np.errstate(divide="ignore", invalid="ignore"):
        precessing = top.transverse_inertia * precession_rate(n, L, top) * n[2]
    balance: Array = precessing - top.axial_inertia * axial_spin(n, L, top)
    return np.where(np.isfinite(balance), balance, np.nan)


def smooth_constants(axis: Array, momentum: Array, top: Top) -> nutation.Constants:
    """Return L_z, L3 and the energy, which a smooth table would conserve; each of shape (n,).

    The energy is that of a body on the table without horizontal motion of its centre of mass.
    """
    return nutation.constants(_vector(axis), _vector(momentum), top)


def potential_at(index: int, axis: Array, momentum: Array, top: Top, tilts: Array) -> Array:
    """Return the effective potential, J, at tilts (rad, between 0 and pi, shape (k,)).

    Its constants are those of the run at the instant number `index`.
    """
    values = smooth_constants(axis[index : index + 1], momentum[index : index + 1], top)
    return np.asarray(nutation.effective_potential(np.asarray(tilts, dtype=float), values, top, np))


def nutation_envelope(axis: Array, momentum: Array, top: Top) -> tuple[Array, Array]:
    """Return the least and largest tilt, rad, of the nutation on a smooth table from each instant
    on.

    Both have shape (n,). Raises `InvalidInput` if the body is not an eccentric sphere.
    """
    numbers = nutation.numbers_of(top)
    values = nutation.natural_constants(smooth_constants(axis, momentum, top), top)
    return nutation.turning_tilts(nutation.amplitudes(nutation.orbit(values, numbers)))


def _vector(rows: Array) -> Vector:
    """Return the three components of vectors in rows."""
    x, y, z = np.asarray(rows, dtype=float).T
    return x, y, z
