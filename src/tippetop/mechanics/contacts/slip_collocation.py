"""Steps of implicit collocation for slip, or rolling, that begins or ends under dry friction.

In the words of `slip_clock`, a velocity xi = s e changes at a rate xi' = A(z, e) that depends on
its direction e but not on its speed s. Near s = 0 the direction relaxes at the rate 1/s towards the
one along which A drives it, so an explicit method needs ever shorter steps. Collocation at Gauss's
points takes the directions as unknowns instead. With z for all numbers of the motion, xi among
them, the equations of a step are

    z_i = z_0 + h sum_j a_ij Z(z_j, e_j),        xi_i = s_i e_i.

A sweep solves the second for the directions by one step of Newton's method, and puts the rates that
follow into the first (Picard's iteration, whose error falls by more each time). Several velocities
may begin at once, each with a direction of its own.

Two solutions are smooth at s = 0, and collocation follows them there to rounding: the one on which
slip begins at s = 0 (xi ~ t or t^2), and its continuation to the end of that same slip. Slip that
comes from elsewhere ends with a term s^kappa in its direction, kappa not an integer, which no
polynomial in time resolves: that end belongs to the clock of `slip_clock`, unless the term has
decayed below rounding, as it has on a small patch (see `from_end` in `sweep`).
"""

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple, Protocol, TypeAlias

from tippetop.mechanics.contacts.gauss_points import GAUSS, PARTS, STAGES
from tippetop.mechanics.contacts.slip_variables import inner, plus, scaled
from tippetop.mechanics.contacts.slip_variables import tangents as unit_tangents
from tippetop.mechanics.contacts.wrench import Slip
from tippetop.mechanics.series import PLAIN, Series
from tippetop.mechanics.vectors import Scalar

# translate module: series

SlipRates: TypeAlias = Callable[
    [Sequence[Scalar], Sequence[Any], Sequence[Scalar]], tuple[Sequence[Any], Sequence[Any]]
]
"""From numbers, directions and parameters to the rates of the numbers, and to margins."""


class LaneValues(Protocol):
    """Operations on numbers that have a value at each point, beside plain operators."""

    def spread(self, a: Scalar, point: int) -> Scalar:
        """Return the value at a point, for all points."""

    def total(self, a: Scalar) -> Scalar:
        """Return the sum of all values, for all points."""


class SlipMotion(NamedTuple):
    """Equations of motion while velocities begin, or end, with their directions as unknowns."""

    rates: SlipRates
    """Rates and margins in plain operators. A margin is positive while the motion may go on: a
    normal force, a gap, a reserve of friction.
    """
    size: int
    """How many numbers the motion has."""
    velocities: tuple[tuple[int, int], ...]
    """Of each velocity that begins: its first number, and how many components it has."""
    parameters: int
    margins: int


class StepRows(NamedTuple):
    """Layout of the rows of a step: each row has a value for every point."""

    size: int
    directions: int
    """How many numbers the motion has, and how many components its directions have together."""
    frames: int
    """How many numbers the frames of directions in space have: see `frame_of`."""
    velocities: int
    margins: int

    @classmethod
    def of(cls, motion: SlipMotion) -> "StepRows":
        """Return the layout for a motion."""
        counts = [count for _, count in motion.velocities]
        frames = sum([6 for count in counts if count == 3])
        return cls(motion.size, sum(counts), frames, len(counts), motion.margins)

    @property
    def unknowns(self) -> int:
        """How many rows a sweep improves: the numbers, then the directions."""
        return self.size + self.directions

    @property
    def parameters(self) -> int:
        """First row of the parameters of the motion, after numbers at the start, extent, frames."""
        return self.size + 1 + self.frames

    @property
    def first_margin(self) -> int:
        """First row of the margins among the results of a sweep, after the rates."""
        return self.size

    @property
    def first_speed(self) -> int:
        """First row of the speeds."""
        return self.size + self.margins

    @property
    def length(self) -> int:
        """Row of the length of the step; the row after it is the size of the last change."""
        return self.first_speed + self.velocities

    @property
    def results(self) -> int:
        """How many rows a sweep returns after the unknowns."""
        return self.length + 2


def sweep(
    y: Sequence[Scalar],
    p: Sequence[Scalar],
    motion: SlipMotion,
    points: LaneValues,
    *,
    from_end: bool = False,
) -> list[Scalar]:
    """Improve the unknowns of a step.

    Parameters
    ----------
    y
        The unknowns: numbers and directions at the points.
    p
        Numbers at the start of the step, its extent, the frames, the parameters of the motion, and
        `gauss_points.CONSTANTS`. The extent is the length of the step.
    motion
        The equations of motion.
    points
        Operations across points.
    from_end
        Whether the one velocity of the motion is zero at the end of the step instead of known at
        its start. Then the extent is its speed at the start, and the length is the last unknown.

    Returns
    -------
    list
        The unknowns; the rates of the numbers; the margins; the speeds; the length; and the sum of
        the squares of all changes.
    """
    rows = StepRows.of(motion)
    size, last = rows.size, len(p) - 2 * STAGES
    parameters, units = p[rows.parameters : last], p[last + STAGES :]
    integrals = [*p[last : last + STAGES]]
    ways, tangents = _directions(y, p, motion)
    rates, margins = motion.rates(y[:size], ways, parameters)
    slopes = [
        _slope(motion, (y[:size], ways, parameters), number, tangent)
        for number, tangent in tangents
    ]
    length, start, ending = p[size], [*p[:size]], integrals
    if from_end:
        first, count = motion.velocities[0]
        length = y[rows.unknowns]
        start = [*p[:first], *[0.0] * count]
        ending = [
            integral - weight for integral, weight in zip(integrals, GAUSS.weights, strict=True)
        ]

    def moved(place: int) -> Scalar:
        """Integrate the rate of a number from the start, or the end, of the step."""
        is_velocity = from_end and place >= motion.velocities[0][0]
        matrix = ending if is_velocity else integrals
        return start[place] + length * _integral(matrix, rates[place], points)

    velocities = [
        tuple([moved(place) for place in range(first, first + count)])
        for first, count in motion.velocities
    ]
    speeds = [
        inner(velocity, direction) for velocity, direction in zip(velocities, ways, strict=True)
    ]
    residuals = [-inner(velocities[number], tangent) for number, tangent in tangents]
    columns = list[list[Scalar]]()
    for point in range(STAGES):
        for slope, (number, tangent) in zip(slopes, tangents, strict=True):
            column = list[Scalar]()
            for index, across in tangents:
                first, count = motion.velocities[index]
                slope_at_point = [
                    points.spread(rate, point) for rate in slope[first : first + count]
                ]
                entry = length * ending[point] * inner(across, tuple(slope_at_point))
                if index == number:
                    entry = entry - speeds[number] * inner(across, tangent) * units[point]
                column.append(entry)
            columns.append(column)
    turns = _solved(columns, residuals, units, points)
    for turn, slope in zip(turns, slopes, strict=True):
        rates = plus(tuple(rates), scaled(turn, slope))
    if from_end:
        change = tuple([_integral(GAUSS.weights, rate, points) for rate in rates[first:]])
        length = p[size] * inner(change, change) ** -0.5
    numbers = [moved(place) for place in range(size)]
    directions = list[Scalar]()
    for number, direction in enumerate(ways):
        turned = direction
        for turn, (index, tangent) in zip(turns, tangents, strict=True):
            if index == number:
                turned = plus(turned, scaled(turn, tangent))
        directions += [*scaled(inner(turned, turned) ** -0.5, turned)]
    changes = tuple([new - old for new, old in zip(numbers, y[:size], strict=True)])
    squares = inner(changes, changes)
    for turn in turns:
        squares = squares + turn * turn
    unknowns = [*numbers, *directions, *([length] if from_end else [])]
    return [*unknowns, *rates, *margins, *speeds, length, points.total(squares)]


def step_terms(y: Sequence[Scalar], p: Sequence[Scalar], points: LaneValues) -> list[Scalar]:
    """Return the polynomials of a step from the rates of its numbers.

    For every part of the step and every number, a row of coefficients in powers of the elapsed
    fraction of the part, from the first power on; for every number, its change over the step; and
    the sum of the squares of the last two coefficients of the rates in Legendre's polynomials,
    times the length. p is the length of the step, and `gauss_points.TERMS`.
    """
    step, legendre_rows = p[0], p[1 : STAGES + 1]
    series = [tuple([step * points.total(rate * row) for row in legendre_rows]) for rate in y]
    terms = list[Scalar]()
    for part in range(1, PARTS + 1):
        powers = tuple(p[part * STAGES + 1 : (part + 1) * STAGES + 1])
        terms += [inner(one, powers) for one in series]
    squares = [one[k] * one[k] for one in series for k in (STAGES - 2, STAGES - 1)]
    return [*terms, *[one[0] for one in series], sum(squares[1:], squares[0])]


def frame_of(direction: Slip) -> list[Scalar]:
    """Return the numbers of two tangents of a direction in space, one after the other; none of one
    in a plane, whose tangent follows from it. Floats.
    """
    return (
        [number for tangent in unit_tangents(direction) for number in tangent]
        if (len(direction) == 3)
        else []
    )


def _directions(
    y: Sequence[Scalar], p: Sequence[Scalar], motion: SlipMotion
) -> tuple[list[Slip], list[tuple[int, Slip]]]:
    """Return the directions, and every vector across one of them with the number of that."""
    ways, tangents = list[Slip](), list[tuple[int, Slip]]()
    place, frame = motion.size, motion.size + 1
    for number, (_, count) in enumerate(motion.velocities):
        direction = tuple(y[place : place + count])
        ways.append(direction)
        place += count
        if count == 2:
            tangents.append((number, (-direction[1], direction[0])))
        if count == 3:
            for first in (frame, frame + 3):
                fixed = tuple(p[first : first + 3])
                tangents.append((number, plus(fixed, scaled(-inner(fixed, direction), direction))))
            frame += 6
    return ways, tangents


def _slope(
    motion: SlipMotion,
    at: tuple[Sequence[Scalar], Sequence[Slip], Sequence[Scalar]],
    number: int,
    tangent: Slip,
) -> Slip:
    """Return the derivative of the rates as one of the directions moves along a tangent."""
    numbers, ways, parameters = at
    turned = [
        _line(direction, tangent) if index == number else direction
        for index, direction in enumerate(ways)
    ]
    rates, _ = motion.rates(numbers, turned, parameters)
    return tuple([rate[1] if isinstance(rate, Series) else 0.0 for rate in rates])


def _line(start: Slip, slope: Slip) -> tuple[Any, ...]:
    """Return series of numbers that change at some rates, up to the first power."""
    return tuple([_term_series(a, b) for a, b in zip(start, slope, strict=True)])


def _term_series(first: Scalar, second: Scalar) -> Series:
    """Return a series with two coefficients."""
    return Series(lambda k: second if k else first, PLAIN)


def _integral(matrix: Sequence[Scalar], rate: Scalar, points: LaneValues) -> Scalar:
    """Return the integral of a rate given at the points, by the integrals of their polynomials."""
    total = matrix[0] * points.spread(rate, 0)
    for point in range(1, STAGES):
        total = total + matrix[point] * points.spread(rate, point)
    return total


def _solved(
    columns: list[list[Scalar]], right: list[Scalar], units: Sequence[Scalar], points: LaneValues
) -> list[Scalar]:
    """Solve linear equations with some unknowns at every point, by Gauss and Jordan's elimination.

    Columns come point by point; each has an entry at every point for every unknown of a point.
    """
    count = len(right)
    diagonals: list[Scalar] = [0.0] * count
    for place, column in enumerate(columns):
        point, row = place // count, place % count
        diagonals[row] = diagonals[row] + column[row] * units[point]
        inverse = 1.0 / points.spread(column[row], point)
        factors = [entry * inverse for entry in column]
        factors[row] = factors[row] * (1.0 - units[point])
        pivot = points.spread(right[row], point)
        right = [entry - factor * pivot for entry, factor in zip(right, factors, strict=True)]
        for later in columns[place + 1 :]:
            pivot = points.spread(later[row], point)
            for index, factor in enumerate(factors):
                later[index] = later[index] - factor * pivot
    return [entry / diagonal for entry, diagonal in zip(right, diagonals, strict=True)]
