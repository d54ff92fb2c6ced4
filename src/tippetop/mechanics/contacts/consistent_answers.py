"""The resolver: every consistent answer of closed contacts that have no normal velocities.

An answer says which contacts stay closed, which of the velocities that have ended are held, and in
which directions the others begin. Closed contacts have N_i > 0 and gap_i'' = 0, open ones N_i = 0
and gap_i'' >= 0; what is held is within friction's limits, and what begins grows along its
direction, A(e) = R e with R >= 0.

Under given normal forces the friction of velocities that have ended is that of least power: it
exists, and the accelerations are unique, as friction takes a convex set of wrenches. That leaves
the normal forces to be found. One number says them:

- one contact: N = W x and all that acts without contact forces times 1 - x, for x from 0 to 1,
- two contacts: N_1 = W x and N_2 = W (1 - x), as the height of the centre of mass stays constant
  and W = m g is the weight.

gap'' of the one contact, or the difference of both, is a continuous function of x, and its roots
are the answers. Where it rises everywhere (`rises`), there is at most one, and the answers are
tried in turn; else the function is searched for all its roots.
"""

# translate module: numbers

from collections.abc import Callable, Sequence
from typing import NamedTuple

from tippetop.mechanics.contacts.contact_forces import ContactForces, forces_on_two
from tippetop.mechanics.contacts.contact_point import Acceleration, ContactPoint
from tippetop.mechanics.contacts.forces import (
    Load,
    Slips,
    directions_of,
    normal_constraints,
    normal_wrench,
    rolling_constraints,
    slip_length,
    solve_loaded,
    sticking_constraints,
    sum_at,
)
from tippetop.mechanics.contacts.onset_forces import (
    Onset,
    TableResponse,
    contact_after_end,
    find_onset,
)
from tippetop.mechanics.contacts.pair import ContactPair, apart, slip_apart, slips_of
from tippetop.mechanics.contacts.pair_resolution import (
    Resolution,
    both_begin_to_slip,
    first_begins_to_slip,
    resolution,
    turning_about,
)
from tippetop.mechanics.contacts.slip_variables import inner
from tippetop.mechanics.contacts.system import (
    delassus_matrix,
    free_rates,
    rates_under,
    responses_to,
)
from tippetop.mechanics.contacts.wrench import Slip, Wrench
from tippetop.mechanics.roots import crossing, dip
from tippetop.mechanics.vectors import solve

PIECES = 16
"""Pieces of the interval that are searched for a root each, or for two about a least value. Fewer
miss more of two roots that are near one another.
"""

EDGE = 1e-12
"""Part of the weight on one of two contacts from which it counts as closed: next to no force,
friction has no direction.
"""


class Answer(NamedTuple):
    """One consistent answer."""

    closed: tuple[int, ...]
    """Numbers of the contacts that stay closed."""
    onset: Onset | None = None
    """How the only closed one goes on."""
    begins: tuple[bool, bool] = (False, False)
    """Whether its slip, and its rolling, have ended and begin again."""
    resolution: Resolution | None = None
    """How both go on, if both stay closed."""


def answers(points: Sequence[ContactPoint], slips: Slips, rolling: Slip | None) -> list[Answer]:
    """Return every consistent answer of one closed contact or of two.

    Those with both contacts closed come first, then those with one, and last the one with none;
    among those with both, such as begin fewest velocities. Who asks takes the first.

    While rolling is held on two contacts, the couple that holds it acts along their line alone: one
    contact carries the body with rolling held only where both do not.

    Parameters
    ----------
    points
        The contact points, floats. If slip has ended on one of two, that comes first.
    slips
        Slip of each, None where it has ended.
    rolling
        Horizontal angular velocity, or its direction; None where rolling is resisted and has ended.

    Raises
    ------
    ArithmeticError
        If a search fails: then it is not known which answers there are.
    """
    pair = tuple(points)
    if len(pair) == 1:
        closed = closed_alone(pair[0], slips[0], rolling, 0)
    else:
        closed = _closed_on_two(pair, slips, rolling)
    opens = min([float(point.free.point[2]) for point in pair]) >= 0.0
    return [*closed, Answer(())] if opens else closed


def _closed_on_two(
    pair: tuple[ContactPoint, ...], slips: Slips, rolling: Slip | None
) -> list[Answer]:
    """Return the answers in which one of two contacts stays closed, or both do."""
    both = closed_both(pair, slips, rolling)
    open_beside, held = list[Answer](), list[Answer]()
    for number in (0, 1):
        for answer in closed_alone(pair[number], slips[number], rolling, number):
            assert answer.onset is not None
            if answer.onset.rolling is None:  # The other contact moves neither up nor down.
                held.append(answer)
                continue
            wrench = answer.onset.wrench
            rates = rates_under(pair, [(number, wrench)], free_rates(pair))
            if rates.points[1 - number][2] >= 0.0:
                open_beside.append(answer)
    return [*both, *open_beside] if both else [*held, *open_beside]


# One contact.


def closed_alone(
    point: ContactPoint, slip: Slip | None, rolling: Slip | None, number: int
) -> list[Answer]:
    """Return the answers in which one contact, of this number, stays closed."""
    free = float(point.free.point[2])
    if slip is not None and rolling is not None:
        onset = find_onset(point, slip, rolling, (False, False))
        return [Answer((number,), onset)] if onset.wrench.force[2] > 0.0 else []
    if rises((point,), (slip,), rolling):
        if free >= 0.0:
            return []
        onset, begins = contact_after_end(point, slip, rolling)
        return [Answer((number,), onset, begins)]

    weight = point.top.mass * point.top.gravity

    def loaded(x: float) -> tuple[Onset, tuple[bool, bool]]:
        return contact_after_end(point, slip, rolling, moved=moved_under(weight * x, 1.0 - x))

    def opening(x: float) -> float:
        return free if x == 0.0 else float(loaded(x)[0].acceleration.point[2])

    results = []
    for x in roots_of(opening, 0.0, 1.0):
        onset, begins = loaded(x)
        both = (onset.slip, onset.rolling)
        near = [e for e, starts in zip(both, begins, strict=True) if starts and e is not None]
        onset = find_onset(point, slip, rolling, begins, near=near)
        results.append(Answer((number,), onset, begins))
    return sorted(results, key=_count_of_beginning)


def moved_under(normal: float, share: float) -> TableResponse:
    """Return what the table does to one contact under a given normal force, and the acceleration,
    as a function of slip and rolling; see `Load`.
    """

    def moved(
        point: ContactPoint, slip: Slip | None, rolling: Slip | None
    ) -> tuple[Wrench, Acceleration]:
        solution = solve_loaded((point,), (slip,), rolling, Load((normal,), share))
        (acceleration,), turning = solution.rates
        return sum_at(0, solution.wrenches), Acceleration(acceleration, turning)

    return moved


def _count_of_beginning(answer: Answer) -> int:
    """Return how many velocities begin."""
    if answer.resolution is not None:
        return 2 - sum(answer.resolution.sticks)
    return sum(answer.begins)


# Two contacts.


def closed_both(pair: tuple[ContactPoint, ...], slips: Slips, rolling: Slip | None) -> list[Answer]:
    """Return the answers in which both contacts stay closed."""
    ended = (slips[0] is None, slips[1] is None)
    stopped = rolling is None and pair[0].top.resists_rolling
    rolls = 0.0
    if rolling is not None and pair[0].top.resists_rolling:
        rolls = 1.0 if inner(rolling, directions_of(pair[0].axis)[0][:2]) >= 0.0 else -1.0
    first: Slip = (0.0, 0.0) if slips[0] is None else slips[0][:2]
    xi: Slip = (*first, 0.0 if all(ended) else slip_apart(pair))
    if not any(ended) and not stopped:
        resolved = resolution(pair, xi, ended, rolls)
        return [Answer((0, 1), resolution=resolved)] if _presses_both(resolved) else []
    unique = rises(pair, slips, rolling)
    if unique:
        tried = _in_turn(pair, xi, ended, rolls)
        if tried is not None:
            return [Answer((0, 1), resolution=tried)]

    weight = pair[0].top.mass * pair[0].top.gravity

    def loaded(x: float) -> Resolution:
        load = Load((weight * x, weight * (1.0 - x)), 1.0)

        def moved(pair: ContactPair, slips: Slips, rolls: float) -> ContactForces:
            return forces_on_two(pair, slips, rolls, load)

        return resolution(pair, xi, ended, rolls, moved)

    def opening(x: float) -> float:
        first, second = loaded(x).motion.rates.points
        return float(first[2] - second[2])

    results = []
    for x in roots_of(opening, EDGE, 1.0 - EDGE, 1 if unique else PIECES):
        resolved = _kept_closed(pair, xi, ended, loaded(x))
        results.append(Answer((0, 1), resolution=resolved))
    return sorted(results, key=_count_of_beginning)


def _in_turn(
    pair: tuple[ContactPoint, ...], xi: Slip, ended: tuple[bool, bool], rolls: float
) -> Resolution | None:
    """Return the first consistent resolution of two contacts that is found, if one is."""
    try:
        resolved = resolution(pair, xi, ended, rolls)
    except ArithmeticError:
        return None
    return resolved if _presses_both(resolved) else None


def _presses_both(resolved: Resolution) -> bool:
    """Return whether both normal forces are positive."""
    return bool(min(resolved.motion.normal) > 0.0)


def _kept_closed(
    pair: tuple[ContactPoint, ...], xi: Slip, ended: tuple[bool, bool], trial: Resolution
) -> Resolution:
    """Return the resolution of two contacts that stay closed, from one under nearly its normal
    forces.
    """
    begins, rolls = trial.begins, trial.rolls
    if begins is None:
        pairs = zip(slips_of(pair, xi), trial.sticks, strict=True)
        slips = [None if sticks else slip for slip, sticks in pairs]
        return Resolution(forces_on_two(pair, slips, rolls), trial.sticks, rolls)
    if any(trial.sticks):
        return turning_about(pair, 0 if trial.sticks[0] else 1, begins[2], rolls)
    if all(ended):
        return both_begin_to_slip(pair, rolls, near=begins)
    return first_begins_to_slip(pair, xi, rolls, near=begins)


# The search.


def roots_of(
    function: Callable[[float], float], low: float, high: float, pieces: int = PIECES
) -> list[float]:
    """Return the roots of a function between two numbers: one in each of some pieces at whose ends
    its signs differ, and two about a value that is the least in size of three.
    """
    places = [low + (high - low) * k / pieces for k in range(pieces + 1)]
    values = [function(x) for x in places]
    roots = list[float]()
    for k in range(pieces):
        if (values[k] > 0.0) != (values[k + 1] > 0.0):
            roots.append(crossing(function, places[k], places[k + 1]))
    for k in range(1, pieces):
        sign = 1.0 if values[k] > 0.0 else -1.0
        sizes = [sign * values[k - 1], sign * values[k], sign * values[k + 1]]
        if sizes[1] < sizes[0] and sizes[1] <= sizes[2] and min(sizes) > 0.0:
            x, value = dip(_signed(function, sign), places[k - 1], places[k + 1])
            if value <= 0.0:
                roots += [
                    crossing(function, places[k - 1], x),
                    crossing(function, x, places[k + 1]),
                ]
    return sorted(roots)


def _signed(function: Callable[[float], float], sign: float) -> Callable[[float], float]:
    """Return a function times a sign."""
    return lambda x: sign * function(x)


def rises(points: tuple[ContactPoint, ...], slips: Slips, rolling: Slip | None) -> bool:
    """Return whether the acceleration of the gap, or the difference of both, certainly rises with x
    everywhere, so that at most one answer keeps all contacts closed.

    With the components that have ended (t) and the normal ones (n), friction U per unit normal
    force, and 0 <= Y <= 1 for what friction leaves free of the former,

        d gap'' / dN = S + P^T Y (P~ - P + P + W),    S = D_nn - P^T P~,

    where P and P~ are D_tn, without and with the friction of what goes on, and W is D_tt U, all
    times D_tt^(-1/2). For a change x of N the second part is -|(P~ - P + W) x|^2 / 4 at least.
    """
    ended = [slip is None for slip in slips]
    held = [*sticking_constraints(points, ended), *rolling_constraints(points, rolling)]
    normal = normal_constraints(points, slips, rolling)
    constraints, count = [*held, *normal], len(held)
    matrix = delassus_matrix(constraints, responses_to(points, constraints))
    inner_part = [[float(number) for number in row[:count]] for row in matrix[:count]]
    x = [1.0] if len(points) == 1 else [1.0, -1.0]
    change, reach = 0.0, 0.0
    pressed, skew = [0.0] * count, [0.0] * count
    for i, weight in enumerate(x):
        across, row = [float(line[count + i]) for line in matrix[:count]], matrix[count + i]
        pressed = [a + weight * b for a, b in zip(pressed, across, strict=True)]
        for k in range(count):
            skew[k] += weight * (across[k] - float(row[k]))
        change += weight * sum(
            [float(number) * part for number, part in zip(row[count:], x, strict=True)]
        )
        reach += _grip(points, i, ended, rolling is None, inner_part)
    symmetric = [a - b for a, b in zip(pressed, skew, strict=True)]
    change -= _inner(symmetric, solve([[*line] for line in inner_part], [*pressed]))
    reach += max(_inner(skew, solve([[*line] for line in inner_part], [*skew])), 0.0) ** 0.5
    return bool(change > 0.25 * reach * reach)


def _grip(
    points: tuple[ContactPoint, ...],
    number: int,
    ended: Sequence[bool],
    stopped: bool,
    matrix: Sequence[Sequence[float]],
) -> float:
    """Return a bound of W for one contact: the size of its friction per unit normal force in the
    metric of the components that have ended.
    """
    point, size, count = points[number], 0.0, len(matrix)
    law, resistance = point.top.friction, point.top.rolling_resistance
    if ended[number]:
        second = 2 if number == 1 and all(ended) else 1
        first = 0
        reach = slip_length(law)
        force = normal_wrench(point, (1.0, 0.0) if reach is None else (1.0, 0.0, 0.0)).force[0]
        size += abs(float(force)) * _largest(matrix, first, second)
        if reach is not None:
            torque = abs(float(normal_wrench(point, (0.0, 0.0, 1.0)).torque[2]))
            if len(points) == 1:
                size += torque * matrix[2][2] ** 0.5
            else:
                square = matrix[1][1] + matrix[2][2] - 2.0 * matrix[1][2]
                size += torque / abs(float(apart(points))) * square**0.5
    if stopped and resistance is not None and len(points) == 1:  # That of two has a fixed bound.
        size += float(resistance.length) * _largest(matrix, count - 2, count - 1)
    return size


def _largest(matrix: Sequence[Sequence[float]], i: int, j: int) -> float:
    """Return the square root of the largest eigenvalue of two rows and columns, or of one."""
    a, b, c = matrix[i][i], matrix[i][j], matrix[j][j]
    if i == j:
        return float(a**0.5)
    return float((0.5 * (a + c + ((a - c) ** 2 + 4.0 * b * b) ** 0.5)) ** 0.5)


def _inner(a: Sequence[float], b: Sequence[float]) -> float:
    """Scalar product."""
    return sum([x * y for x, y in zip(a, b, strict=True)])
