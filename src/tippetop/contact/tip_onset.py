"""The first moments in which a body tips over the rim of its face, from zero tilt.

At zero tilt the rim's point that touches is undefined. The direction into which the axis leans is
an unknown of its own here, beside the numbers of the contact mode, at Gauss's points of one step:
there the lean, integrated, must have that direction. Its size grows as the time where the body has
a rate of tilt already, after an impact; as its square where friction tips it at once; and as its
cube where the force that tips it grows from the limit.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

from tippetop.contact.contact_mode import ContactMode
from tippetop.contact.mode import COMPLETED, FAILURE, Mode, ModeEnd, Segment
from tippetop.integrators.base import Integrator
from tippetop.integrators.dense import DenseSolution, as_array
from tippetop.mechanics.contacts.gauss_points import GAUSS, PARTS, STAGES
from tippetop.mechanics.face_motion import BARELY_TILTED
from tippetop.mechanics.state import State
from tippetop.mechanics.vectors import Horizontal, Row, solve

TILTED = "tilted"
"""Cause of the end of `TipOnset`: the body has a tilt."""

UNFOLLOWED = "the first moments of tipping over the rim cannot be followed"

LONGEST_STEP, HALVINGS = 0.2, 32
"""Length of the first step that is tried, in natural units of time, and how often it is halved."""

PART_OF_RISE = 0.5
"""Part of the time in which a tilt that falls back would rise that the first step takes at most."""

ITERATIONS = 100
"""Iterations of a step at most: few, but where the normal force rises much as the body tips."""

SMALL_ANGLE = 1e-6
"""Angle, rad, by which the direction is turned for a derivative: its error is the square."""

UNMOVED = 3e-16
"""Change of the numbers, in natural units, at which an iteration has converged, per step."""

GUESSES = 2
"""Iterations of the first guess: by the second the force has grown as the velocity has."""

FIRST_TILT = 1e-13
"""Sine of the tilt of the first instant of a body that tilts at a rate: the energy of the result is
wrong by as much, and the force, of which terms with the inverse cancel, by its inverse times
rounding.
"""

UNRESOLVED = 1e-13
"""Last coefficient of the rates, in natural units or of the largest, up to which a step is
resolved; one that changes the numbers by rounding is, too: of the inverse of a small tilt the rates
have few digits.
"""


@dataclass(frozen=True)
class TipOnset(Mode):
    """A body begins to tip over the rim of its face."""

    contact_mode: ContactMode
    """The mode in which it tips: the edge slips or sticks."""
    direction: Horizontal
    """The direction into which the axis leans at first."""
    planar: bool = False
    """Whether the motion is in the plane of that direction: then rounding moves nothing out of it,
    which friction on slip that only begins would pull back at once.
    """

    name: ClassVar[str] = "tipping"

    @property
    def label(self) -> str:
        """The name of the contact mode."""
        return self.contact_mode.label

    def state(self, y: Row) -> State:
        """Return the state as the contact mode has it."""
        return self.contact_mode.state(y)

    def segments(
        self, time: float, state: State, end: float, integrator: Integrator
    ) -> Iterator[Segment]:
        """Follow one step, as long as the motion allows."""
        begin = [*self.contact_mode.numbers(state)]
        length = min(LONGEST_STEP, end - time, PART_OF_RISE * self._time_of_rise(begin))
        for _ in range(HALVINGS):
            rates = self._rates_at_points(begin, length)
            if rates is not None:
                yield self._segment(begin, rates, (time, length), end)
                return
            length = 0.5 * length
        empty = DenseSolution.empty(time, len(begin))
        yield Segment(self.contact_mode, empty, state, ModeEnd(FAILURE, state, detail=UNFOLLOWED))

    def _segment(
        self, begin: list[float], rates: list[list[float]], span: tuple[float, float], end: float
    ) -> Segment:
        """Return the step with these rates at its points."""
        (time, length), rows = span, list[Any]()
        legendre = [coefficients(each) for each in rates]
        for part in range(PARTS):
            row = list[float]()
            for each in legendre:
                for power in range(STAGES):
                    terms = [each[k] * GAUSS.powers[part][k][power] for k in range(STAGES)]
                    row.append(length * sum(terms))
            rows.append(as_array(row))
        knots = [length * part / PARTS for part in range(PARTS + 1)]
        reach = end if length >= end - time else time + length
        solution = DenseSolution.of_rows(knots, self._first_numbers(begin), rows)
        solution = solution.moved(time, reach)
        last = self.state(
            [a + length * integral(each) for a, each in zip(begin, rates, strict=True)]
        )
        how = ModeEnd(COMPLETED if reach >= end else TILTED, last)
        return Segment(self.contact_mode, solution, last, how, 1)

    def _first_numbers(self, begin: list[float]) -> list[float]:
        """Return the numbers that a result has of the first instant, at which the point that
        touches must be defined if it moves.
        """
        if not any(begin[3:5]):
            return begin
        x, y = self.direction
        return [FIRST_TILT * x, FIRST_TILT * y, *begin[2:]]

    def _rates_at_points(self, begin: list[float], length: float) -> list[list[float]] | None:
        """Return the rates of every number at the points of a step, by Newton's method for the
        directions; None where the step is too long.
        """
        up = 1.0 if begin[2] > 0.0 else -1.0
        directions = [self.direction] * STAGES
        points = self._first_guess(begin, length, self._lever(up))
        for _ in range(ITERATIONS):
            before, sizes = points, _sizes(points, directions)
            if min(sizes) <= 0.0:
                return None
            columns = [self._rates_at(points, sizes, directions, j) for j in range(STAGES)]
            turned = [
                self._rates_at(points, sizes, directions, j, SMALL_ANGLE) for j in range(STAGES)
            ]
            rates = [[columns[j][number] for j in range(STAGES)] for number in range(len(begin))]
            points = _moved(begin, rates, length)
            # The axis follows the momentum at once: else the direction lags, and swings.
            points = [*before[:3], *points[3:]]
            columns = [self._rates_at(points, sizes, directions, j) for j in range(STAGES)]
            for number in range(3):
                rates[number] = [columns[j][number] for j in range(STAGES)]
            points = _moved(begin, rates, length)
            leans = [points[0], points[1]]
            changes = _turns(columns, turned, leans, (directions, sizes), (length, self._lever(up)))
            directions = [_turned(directions[j], changes[j]) for j in range(STAGES)]
            moved = max(
                [
                    abs(a - b)
                    for now, earlier in zip(points, before, strict=True)
                    for a, b in zip(now, earlier, strict=True)
                ]
            )
            largest = max([1.0, *[abs(each[STAGES - 1]) for each in points]])
            fastest = max([1.0, *[abs(each[0]) for each in rates]])
            if moved <= UNMOVED * largest * fastest and max(map(abs, changes)) <= UNRESOLVED:
                tail = max([abs(coefficients(each)[STAGES - 1]) for each in rates])
                is_resolved = tail <= fastest * max(UNRESOLVED, UNMOVED * fastest, UNMOVED / length)
                return rates if is_resolved and self._lasts(points) else None
        return None

    def _lasts(self, points: list[list[float]]) -> bool:
        """Return whether no guard of the contact mode falls through zero between the points."""
        mode = self.contact_mode
        rows = [[each[j] for each in points] for j in range(STAGES)]
        for guard in mode.motion.guards:
            values = [float(guard.value(row, mode.parameters)) for row in rows]
            if any(values[j] > 0.0 >= values[j + 1] for j in range(STAGES - 1)):
                return False
        return True

    def _lever(self, up: float) -> float:
        """Return what makes the rate of the axis from the angular momentum: +-1 / I1."""
        return up / float(self.top.transverse_inertia)

    def _time_of_rise(self, begin: list[float]) -> float:
        """Return the time in which a tilt that falls back would rise, at its first acceleration;
        infinity where it does not fall back.
        """
        x, y = self.direction
        still = self._rates_at([[number] for number in begin], [BARELY_TILTED], [self.direction], 0)
        rising, driven = x * begin[4] - y * begin[3], x * still[4] - y * still[3]
        return -rising / driven if rising * driven < 0.0 else math.inf

    def _first_guess(self, begin: list[float], length: float, lever: float) -> list[list[float]]:
        """Return the numbers at the points where the tilt changes no rates yet."""
        points = [[number] * STAGES for number in begin]
        sizes, directions = [BARELY_TILTED] * STAGES, [self.direction] * STAGES
        for _ in range(GUESSES):
            columns = [self._rates_at(points, sizes, directions, j) for j in range(STAGES)]
            rates = [[columns[j][number] for j in range(STAGES)] for number in range(len(begin))]
            points = [*points[:3], *_moved(begin, rates, length)[3:]]
        rising = [[lever * each for each in points[4]], [-lever * each for each in points[3]]]
        return [*_moved(begin[:2], rising, length), *points[2:]]

    def _rates_at(
        self,
        points: list[list[float]],
        sizes: Sequence[float],
        directions: Sequence[Horizontal],
        place: int,
        turn: float = 0.0,
    ) -> list[float]:
        """Return the rates at a point where the axis leans into a direction, turned by an angle."""
        x, y = _turned(directions[place], turn)
        numbers = [each[place] for each in points]
        axis = (sizes[place] * x, sizes[place] * y, numbers[2])
        rates = [*self.contact_mode.rates((*axis, *numbers[3:]))]
        return self._in_plane(rates) if self.planar else rates

    def _in_plane(self, rates: list[float]) -> list[float]:
        """Return the part of the rates that keeps the motion in its plane."""
        x, y = self.direction
        axis, turning = x * rates[0] + y * rates[1], x * rates[4] - y * rates[3]
        sliding = [x * rates[k] + y * rates[k + 1] for k in range(6, len(rates), 2)]
        along = [number for speed in sliding for number in (x * speed, y * speed)]
        return [x * axis, y * axis, rates[2], -y * turning, x * turning, 0.0, *along]


def _sizes(points: list[list[float]], directions: Sequence[Horizontal]) -> list[float]:
    """Return how far the axis leans into each direction."""
    return [
        points[0][j] * directions[j][0] + points[1][j] * directions[j][1] for j in range(STAGES)
    ]


def _moved(begin: list[float], rates: list[list[float]], length: float) -> list[list[float]]:
    """Return the numbers at the points of a step by their rates there."""
    return [
        [number + length * at for at in integrated(each)]
        for number, each in zip(begin, rates, strict=True)
    ]


def _turned(direction: Horizontal, angle: float) -> Horizontal:
    """Return a direction turned by a small angle."""
    x, y = direction[0] - angle * direction[1], direction[1] + angle * direction[0]
    size = (x * x + y * y) ** 0.5
    return (x / size, y / size)


def _turns(
    columns: list[list[float]],
    turned: list[list[float]],
    leans: list[list[float]],
    lean: tuple[list[Horizontal], list[float]],
    step: tuple[float, float],
) -> list[float]:
    """Return the angles by which the directions at the points turn in an iteration of Newton's.

    The lean across each direction vanishes. It is twice the integral of the rate of the angular
    momentum, which depends on the direction.
    """
    (directions, sizes), (length, lever) = lean, step
    matrix, right = list[list[float]](), list[float]()
    squares = length * length
    for j in range(STAGES):
        x, y = directions[j]
        row = list[float]()
        for k in range(STAGES):
            p = lever * (turned[k][4] - columns[k][4]) / SMALL_ANGLE
            q = -lever * (turned[k][3] - columns[k][3]) / SMALL_ANGLE
            row.append(squares * TWICE[j][k] * (x * q - y * p))
        row[j] -= sizes[j]
        matrix.append([each / sizes[j] for each in row])
        right.append(-(x * leans[1][j] - y * leans[0][j]) / sizes[j])
    changes: list[float] = solve(matrix, right)
    return changes


def coefficients(values: Sequence[float]) -> list[float]:
    """Return the coefficients of Legendre's polynomials of values at Gauss's points."""
    return [sum([a * b for a, b in zip(row, values, strict=True)]) for row in GAUSS.terms]


def integral(values: Sequence[float]) -> float:
    """Return the integral of values at Gauss's points over a step of length 1."""
    return sum([a * b for a, b in zip(GAUSS.weights, values, strict=True)])


def integrated(values: Sequence[float]) -> list[float]:
    """Return the integrals of values at Gauss's points from 0 to each of them."""
    return [sum([GAUSS.integrals[k][j] * values[k] for k in range(STAGES)]) for j in range(STAGES)]


TWICE = [
    [
        sum([GAUSS.integrals[m][j] * GAUSS.integrals[k][m] for m in range(STAGES)])
        for k in range(STAGES)
    ]
    for j in range(STAGES)
]
"""Matrix of two integrations, from values at the points to the points."""
