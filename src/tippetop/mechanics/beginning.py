"""In which direction slip, or rolling, begins where the table cannot hold it."""

from typing import NamedTuple

from tippetop.mechanics.ending import Vanishing
from tippetop.mechanics.rolling import Acceleration, ContactPoint, Slip, Wrench, contact_motion, flat
from tippetop.mechanics.stick_slip import inner, plus, scaled, size
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Vector

ITERATIONS = 5000
"""Most iterations in search of a direction in which it can go on; a hundred are usual."""


class Beginning(NamedTuple):
    """How the velocities of a contact go on.

    Attributes
    ----------
    slip, rolling
        Slip and rolling, or the directions in which they begin; None where they are held.
    rates
        At which rates R >= 0 those that begin grow, slip first.
    wrench, acceleration
        What the table does, and how the contact accelerates.
    """

    slip: Slip | None
    rolling: Slip | None
    rates: tuple[float, ...]
    wrench: Wrench
    acceleration: Acceleration


def beginning(
    point: ContactPoint, slip: Slip | None, rolling: Slip | None, begins: tuple[bool, bool]
) -> Beginning:
    """Directions in which slip, or rolling, or both, begin: fixed points of e -> c e + A(e), normalized.

    Parameters
    ----------
    point
        The contact point, floats.
    slip, rolling
        Slip and horizontal angular velocity, None where they are zero.
    begins
        Whether slip, and rolling, begin; what is zero and does not is held.

    Raises
    ------
    ArithmeticError
        If no such direction is found: more than one contact force may be consistent, or none.
    """
    parts = [Vanishing(which) for which, wanted in zip((True, False), begins, strict=True) if wanted]
    held, acceleration = contact_motion(point, slip, rolling)
    found = {part: _start(part, held, point.top) for part in parts}
    moved = 0.0
    for _ in range(ITERATIONS):
        ways = found.get(Vanishing(True), slip), found.get(Vanishing(False), rolling)
        wrench, acceleration = contact_motion(point, *ways)
        moved = 0.0
        for part, direction in found.items():
            rate = part.rate(acceleration, point.top)
            hold = _stiffness(part, point) * size(_resisting(part, wrench)) + size(rate)
            ahead = plus(scaled(hold, direction), rate)
            found[part] = scaled(1.0 / size(ahead), ahead)
            moved = max(moved, size(plus(found[part], scaled(-1.0, direction))))
        if moved < 4e-16:
            break
    ways = found.get(Vanishing(True), slip), found.get(Vanishing(False), rolling)
    wrench, acceleration = contact_motion(point, *ways)
    along = [inner(part.rate(acceleration, point.top), direction) for part, direction in found.items()]
    if moved > 1e-9 or min(along, default=0.0) < -1e-9 * size(flat(point.free)):
        raise ArithmeticError("no direction in which the contact can go on, though nothing can hold it")
    return Beginning(ways[0], ways[1], tuple(max(rate, 0.0) for rate in along), wrench, acceleration)


def direction_of_slip(axis: Vector, momentum: Vector, top: Top) -> tuple[Slip, float]:
    """Direction in which a rolling body that cannot stick slips, floats, and the rate of its speed, m/s^2."""
    point = ContactPoint.of(axis, momentum, top)
    found = beginning(point, None, point.turning[:2], (True, False))
    assert found.slip is not None
    return found.slip, found.rates[0]


def _resisting(part: Vanishing, wrench: Wrench) -> Slip:
    """The force, or couple, of a wrench that resists slip, or rolling."""
    return wrench.force[:2] if part.slip else wrench.torque[:2]


def _start(part: Vanishing, held: Wrench, top: Top) -> Slip:
    """A direction to begin the search with: against what would have held it."""
    pushed: Slip = scaled(-1.0, _resisting(part, held))
    units = part.wrenches(top)
    if part.slip and len(units) == 3:
        pushed = (*pushed, -held.torque[2] / part.reach(top))
    return scaled(1.0 / size(pushed), pushed)


def _stiffness(part: Vanishing, point: ContactPoint) -> float:
    """How strongly the contact answers to what resists slip, or rolling, 1/kg or 1/(kg m^2)."""
    answers = [part.rate(point.response(unit), point.top) for unit in part.wrenches(point.top)]
    return float(sum(abs(answer[i]) for i, answer in enumerate(answers)))
