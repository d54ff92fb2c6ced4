"""Directions in which velocities begin that cannot be held: along each, A(e) = R e with R >= 0.

Under dry friction the rate A of a velocity xi depends on its direction e = xi / s alone. Friction
takes energy, so that e -> c e + A(e), normalized, comes to such a direction if c is large enough.
It comes there slowly where one component of xi responds much less than another to what resists it,
such as drilling of a small patch: Newton's method ends the search. And it circles where friction
nearly holds xi, or one of two contacts hardly slips, so that the least change of e turns friction.
Damped steps for x = R e, of which x = A(x / |x|), come out of that: under given normal forces x is
the least point of a convex function, and |x - A| falls along every such step but where friction has
a kink.
"""

from collections.abc import Callable, Sequence
from typing import NamedTuple

from tippetop.mechanics.contacts.slip_variables import inner, plus, scaled, size, tangents
from tippetop.mechanics.contacts.wrench import Slip
from tippetop.mechanics.unsolved import Unsolved
from tippetop.mechanics.vectors import solve

ROUNDS = 20
"""Rounds of the search at most."""

ITERATIONS = 50
"""Iterations in each."""

SLOW_TURN = 0.01
"""Turn of directions in an iteration, rad, from which on Newton's method is tried in a round before
its iterations are over: the directions are near then, and each further iteration brings little.
"""

NEWTON_STEPS = 12
"""Steps of Newton's method that try to end a round."""

DAMPED_STEPS = 50
"""Damped steps of Newton's method in a round at most."""

SHORTEST = 1e-6
"""Part of a step of Newton's method below which none is tried: where friction has a kink, no part
of it leads nearer.
"""

EXACT = 4e-16
"""Change of a direction that is rounding."""

DIRECTED = 1e-9
"""How well a direction must be known at least."""

DIFFERENCE = 1e-9
"""Difference of a direction to both sides from which a derivative is found; its error costs steps,
no digits. Much larger, it is more than the slip of one of two contacts that hardly slips; much
smaller, rounding is as large as what differs.
"""


class Resisted(NamedTuple):
    """How a velocity that begins in a direction changes."""

    rate: Slip
    """A."""
    strength: float
    """Size of what resists it, as large as its share in A at least: the part of c that is not A
    itself.
    """


Response = Callable[[Sequence[Slip]], Sequence[Resisted]]
"""From the directions of velocities that begin at once to how they change, all floats."""


def directions(response: Response, start: Sequence[Slip]) -> list[Slip]:
    """Directions in which velocities that cannot be held begin.

    Parameters
    ----------
    response
        How they change.
    start
        Unit vectors, or longer ones, in whose directions the search begins.

    Raises
    ------
    ArithmeticError
        If no such directions are found: more than one contact force may be consistent, or none.
    """
    ways = [_unit(direction) for direction in start]
    for turn in range(ROUNDS):
        is_tried = False
        for step in range(ITERATIONS):
            before, responses = ways, response(ways)
            ways = [
                _unit(plus(scaled(resisted.strength + size(resisted.rate), e), resisted.rate))
                for resisted, e in zip(responses, ways, strict=True)
            ]
            moved = _apart(ways, before)
            if moved < EXACT:
                if turn + step == 0 and _leads(responses, before):
                    return before
                break
            if moved < SLOW_TURN and not is_tried:
                is_tried, improved = True, _improved(response, ways)
                if improved is not None:
                    return improved
        improved = _improved(response, ways)
        if improved is None:
            improved = _improved(response, _descended(response, ways))
        if improved is not None:
            return improved
        # Exactly against what drives it, as may be in a plane, a direction stays so: it is turned
        # round.
        rates = [resisted.rate for resisted in response(ways)]
        along = [inner(rate, e) for rate, e in zip(rates, ways, strict=True)]
        against = min(0.0, *along)
        ways = [
            _unit(rates[i]) if along[i] < 0.0 and along[i] == against else ways[i]
            for i in range(len(ways))
        ]
    raise Unsolved("no direction in which the contact can go on, though nothing can hold it")


def directions_near(response: Response, ways: Sequence[Slip]) -> list[Slip]:
    """Return the directions of which approximate ones are known, by Newton's method.

    Raises
    ------
    ArithmeticError
        If Newton's method does not converge, or velocities do not grow along them.
    """
    improved = _improved(response, [_unit(direction) for direction in ways])
    if improved is None:
        raise Unsolved("the directions in which the contact goes on are not found from near ones")
    return improved


def _improved(response: Response, ways: list[Slip]) -> list[Slip] | None:
    """Return the directions by Newton's method from near ones; None if it fails."""
    last = DIRECTED
    for _ in range(NEWTON_STEPS):
        try:
            better = _newton(response, ways)
        except ArithmeticError:
            return None
        moved, ways = _apart(better, ways), better
        if moved < EXACT or last * 0.5 <= moved < DIRECTED:
            return ways if _grow(response(ways), ways) else None
        last = moved
    return None


def _descended(response: Response, ways: Sequence[Slip]) -> list[Slip]:
    """Return directions that are nearer to some that do not turn, by damped steps of Newton's
    method for the velocities x = R e.
    """
    sizes = [len(e) for e in ways]

    def parts(x: Slip) -> list[Slip]:
        velocities, first = list[Slip](), 0
        for count in sizes:
            velocities.append(x[first : first + count])
            first += count
        return velocities

    def excess(x: Slip) -> Slip:
        """Return x - A(x / |x|)."""
        rates = [number for one in response([_unit(e) for e in parts(x)]) for number in one.rate]
        return tuple([number - rate for number, rate in zip(x, rates, strict=True)])

    rated = [scaled(size(one.rate), e) for one, e in zip(response(ways), ways, strict=True)]
    x: Slip = tuple([float(number) for velocity in rated for number in velocity])
    present = excess(x)
    for _ in range(DAMPED_STEPS):
        if size(present) < DIRECTED * size(x):
            break
        nearer = _nearer(excess, x, present)
        if nearer is None:
            break
        x, present = nearer
    return [_unit(e) for e in parts(x)]


def _nearer(function: Callable[[Slip], Slip], x: Slip, values: Slip) -> tuple[Slip, Slip] | None:
    """Return a place at which a function is smaller than at x, and its values there, by a damped
    step of Newton's method; None if there is none.
    """
    try:
        step = solve(
            _derivatives(function, x, DIFFERENCE * size(x)), [-number for number in values]
        )
        part = 1.0
        while part > SHORTEST:
            trial: Slip = tuple([a + part * b for a, b in zip(x, step, strict=True)])
            beyond = function(trial)
            if size(beyond) < (1.0 - 0.1 * part) * size(values):
                return trial, beyond
            part *= 0.5
    except ArithmeticError:
        return None
    return None


def _grow(responses: Sequence[Resisted], ways: Sequence[Slip]) -> bool:
    """Return whether velocities in these directions grow, or stay."""
    return all(
        inner(a.rate, e) >= -DIRECTED * a.strength for a, e in zip(responses, ways, strict=True)
    )


def _leads(responses: Sequence[Resisted], ways: Sequence[Slip]) -> bool:
    """Return whether directions that did not turn are exact: those of slip alone, in a plane."""
    return len(ways) == 1 and len(ways[0]) == 2 and _grow(responses, ways)


def _newton(response: Response, ways: Sequence[Slip]) -> list[Slip]:
    """Return the directions after one Newton step towards directions that do not turn."""
    bases = [tangents(e) for e in ways]

    def across(ways: Sequence[Slip]) -> Slip:
        responses = response(ways)
        across_rates = [
            plus(resisted.rate, scaled(-inner(resisted.rate, e), e))
            for resisted, e in zip(responses, ways, strict=True)
        ]
        return tuple(
            [inner(rate, b) for rate, basis in zip(across_rates, bases, strict=True) for b in basis]
        )

    def moved(parts: Sequence[float]) -> list[Slip]:
        turned_ways, used = list[Slip](), 0
        for e, basis in zip(ways, bases, strict=True):
            turned = e
            for b in basis:
                turned = plus(turned, scaled(parts[used], b))
                used += 1
            turned_ways.append(_unit(turned))
        return turned_ways

    present = across(ways)
    zero: Slip = tuple([0.0 for _ in present])
    rows = _derivatives(lambda parts: across(moved(parts)), zero, DIFFERENCE)
    return moved(solve(rows, [-x for x in present]))


def _derivatives(function: Callable[[Slip], Slip], x: Slip, reach: float) -> list[list[float]]:
    """Return the derivatives of each value of a function by each number, by differences."""
    columns = list[list[float]]()
    for j in range(len(x)):
        ahead = function(tuple([x[i] + (reach if i == j else 0.0) for i in range(len(x))]))
        behind = function(tuple([x[i] - (reach if i == j else 0.0) for i in range(len(x))]))
        columns.append([0.5 * (a - b) / reach for a, b in zip(ahead, behind, strict=True)])
    return [[column[i] for column in columns] for i in range(len(columns[0]))]


def _apart(ways: Sequence[Slip], others: Sequence[Slip]) -> float:
    return max(size(plus(a, scaled(-1.0, b))) for a, b in zip(ways, others, strict=True))


def _unit(a: Slip) -> Slip:
    return scaled(1.0 / size(a), a)
