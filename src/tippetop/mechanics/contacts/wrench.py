"""Forces and torques at the contact, and the slip that they resist: see
`tippetop.mechanics.contacts.forces`.
"""

from typing import NamedTuple, TypeAlias

from tippetop.mechanics.laws.friction import NO_TORQUE
from tippetop.mechanics.vectors import VERTICAL, Scalar, Vector

Slip: TypeAlias = tuple[Scalar, ...]
"""The velocity zeta, m/s, or its direction: two components, or three where drilling is resisted."""

EAST: Vector = (1.0, 0.0, 0.0)
NORTH: Vector = (0.0, 1.0, 0.0)


class Wrench(NamedTuple):
    """A force at the contact point, N, and a torque, N m; or both per unit of something."""

    force: Vector
    torque: Vector


FORCES = (Wrench(EAST, NO_TORQUE), Wrench(NORTH, NO_TORQUE), Wrench(VERTICAL, NO_TORQUE))
DRILLING = Wrench(NO_TORQUE, VERTICAL)
COUPLES = (Wrench(NO_TORQUE, EAST), Wrench(NO_TORQUE, NORTH))
