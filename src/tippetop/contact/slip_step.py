"""One step of collocation along slip that begins or ends, compiled once for a motion."""

import math
from collections.abc import Sequence
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from tippetop.integrators.base import Array
from tippetop.integrators.iteration import (
    Iteration,
    copied,
    first_of,
    iterated,
    put_from,
    put_rows,
    room,
)
from tippetop.integrators.zero_crossings import brackets
from tippetop.mechanics.contacts.gauss_points import (
    CONSTANTS,
    GAUSS,
    PARTS,
    STAGES,
    TERMS,
    interpolated,
)
from tippetop.mechanics.contacts.slip_collocation import (
    LaneValues,
    SlipMotion,
    StepRows,
    frame_of,
    step_terms,
    sweep,
)
from tippetop.mechanics.contacts.slip_variables import inner
from tippetop.mechanics.contacts.wrench import Slip
from tippetop.mechanics.roots import crossing
from tippetop.mechanics.series import horner
from tippetop.mechanics.vectors import Scalar

CONVERGED = 1e-28
"""Sum of the squares of changes, in natural units, that is rounding."""

SWEEP_LIMIT = 50
"""Sweeps of a step at most."""

COMPILER_EFFORT = 0
"""How hard the compiler tries, see `tippetop.integrators.machine_code`: with 1 sweeps, a thousandth
of a run, take a sixth less, and are ready to be called in twice the time.
"""

PROBE_INTERVALS = 16
"""Intervals of a step at whose ends a margin's polynomial, of degree 15, is searched for a fall."""


class _Compiled(NamedTuple):
    """The compiled sweep of a motion and the compiled polynomials of its steps."""

    improve: Iteration
    terms: Iteration


@lru_cache(maxsize=64)
def compiled_step(motion: SlipMotion, from_end: bool) -> _Compiled:
    """Compile the sweep of a motion, or take it from those compiled."""
    rows = StepRows.of(motion)

    def improve(y: Sequence[Scalar], p: Sequence[Scalar], points: LaneValues) -> list[Scalar]:
        return sweep(y, p, motion, points, from_end=from_end)

    def terms(y: Sequence[Scalar], p: Sequence[Scalar], points: LaneValues) -> list[Scalar]:
        return [*y, *step_terms(y, p, points)]

    parameters = rows.parameters + motion.parameters + len(CONSTANTS) // STAGES
    return _Compiled(
        iterated(improve, rows.unknowns + int(from_end), parameters, STAGES, COMPILER_EFFORT),
        iterated(terms, rows.size, 1 + len(TERMS) // STAGES, STAGES, COMPILER_EFFORT),
    )


@lru_cache(maxsize=64)
def parameters_of(motion: SlipMotion, numbers: tuple[float, ...]) -> tuple[Any, Any]:
    """Return the parameters of a sweep and of its polynomials, but for those of one step."""
    first = StepRows.of(motion).parameters
    sweeping = room((first + motion.parameters) * STAGES + len(CONSTANTS))
    put_rows(sweeping, first, numbers, STAGES)
    put_from(sweeping, (first + motion.parameters) * STAGES, CONSTANTS)
    measuring = room(STAGES + len(TERMS))
    put_from(measuring, STAGES, TERMS)
    return sweeping, measuring


def row_of(numbers: Sequence[float], row: int) -> list[float]:
    """Return the values of a row at every point."""
    return [*numbers[row * STAGES : (row + 1) * STAGES]]


class SlipStep:
    """A step of collocation of a motion whose top has some numbers.

    With `from_end`, the velocity is zero at the end of the step, see `slip_collocation.sweep`.
    """

    def __init__(
        self, motion: SlipMotion, numbers: tuple[float, ...], *, from_end: bool = False
    ) -> None:
        self.motion, self.layout = motion, StepRows.of(motion)
        self.compiled = compiled_step(motion, from_end)
        sweeping, measuring = parameters_of(motion, numbers)
        self.sweeping, self.measuring = copied(sweeping), copied(measuring)
        layout = self.layout
        self.unknowns = room((layout.unknowns + int(from_end)) * STAGES)
        self.results = room(layout.results * STAGES)
        self.rows = room(((PARTS + 1) * layout.size + 1) * STAGES)
        self.sweeps = 0

    def solve(
        self,
        start: Sequence[float],
        directions: Sequence[Slip],
        extent: float,
        guess: Sequence[float] = (),
    ) -> bool:
        """Solve the equations of a step; return whether the sweeps converged.

        Parameters
        ----------
        start
            Numbers at its start.
        directions
            Where the search for the directions begins.
        extent
            Its length, or, from the end, the speed at its start.
        guess
            From the end, a guess of the length.
        """
        frames = [number for direction in directions for number in frame_of(direction)]
        ways = [number for direction in directions for number in direction]
        put_rows(self.sweeping, 0, [*start, extent, *frames], STAGES)
        put_rows(self.unknowns, 0, [*start, *ways, *guess], STAGES)
        improve, terms = self.compiled
        self.sweeps += improve(self.unknowns, self.sweeping, self.results, CONVERGED, SWEEP_LIMIT)
        if not self.results[len(self.results) - 1] < CONVERGED:
            return False
        put_rows(self.measuring, 0, [self.length], STAGES)
        terms(self.results, self.measuring, self.rows, 0.0, 1)
        return True

    @property
    def length(self) -> float:
        """Length of the step."""
        return float(self.results[self.layout.length * STAGES])

    @property
    def error(self) -> float:
        """Sum of the squares of the last coefficients of the rates, times the length."""
        return float(self.rows[len(self.rows) - 1])

    @property
    def speeds(self) -> list[float]:
        """Speed of the first velocity at the points."""
        return row_of(self.results, self.layout.first_speed)

    @property
    def least_speed(self) -> float:
        """The least speed of any velocity at a point."""
        first = self.layout.first_speed
        return min([min(row_of(self.results, first + i)) for i in range(self.layout.velocities)])

    @property
    def last_direction(self) -> Slip:
        """Direction of the first velocity at the last point."""
        first, count = self.layout.size, self.motion.velocities[0][1]
        return tuple([self.unknowns[(first + i + 1) * STAGES - 1] for i in range(count)])

    @property
    def changes(self) -> list[float]:
        """Changes of the numbers over the step."""
        size = self.layout.size
        return [self.rows[row * STAGES] for row in range(PARTS * size, (PARTS + 1) * size)]

    @property
    def axes(self) -> list[list[float]]:
        """The horizontal part of the axis at the points."""
        pairs = zip(row_of(self.unknowns, 0), row_of(self.unknowns, 1), strict=True)
        return [[x, y] for x, y in pairs]

    def margin_falls(self) -> bool:
        """Return whether a margin falls to zero anywhere within the step, dips between points
        included.
        """
        for number in range(self.layout.margins):
            values = row_of(self.results, self.layout.first_margin + number)
            if 2.0 * min(values) > max(values):
                continue
            value = interpolated(values)
            probes = [probe / PROBE_INTERVALS for probe in range(PROBE_INTERVALS + 1)]
            probed = [value(probe) for probe in probes]
            if min(values) <= 0.0 or next(brackets(probes, probed, value, value), None) is not None:
                return True
        return False

    def pieces(self, parts: float) -> Array:
        """Return coefficients of the numbers in some parts; the last may be a fraction."""
        return pieces_of(self.rows, self.layout.size, parts)

    def speed(self, number: int, begin: float, direction: Slip) -> list[float]:
        """Return coefficients of the velocity, in a plane, along a direction in a part of the step.

        `begin` is the value at the start of the part. Beyond the end of slip it is negative.
        """
        first = number * self.layout.size + self.motion.velocities[0][0]
        x, y = row_of(self.rows, first), row_of(self.rows, first + 1)
        return [begin, *[direction[0] * a + direction[1] * b for a, b in zip(x, y, strict=True)]]

    def end_of_slip(self, xi: Slip, speeds: Sequence[float]) -> float | None:
        """Return after how many parts slip ends that is xi at the start; None where no bracket of
        the end is found.
        """
        below = [number for number, speed in enumerate(speeds) if speed <= 0.0]
        point = below[0] if below else STAGES
        if point == 0:
            return None
        direction, polynomials = self.last_direction, list[list[float]]()
        begin = inner(xi, direction)
        for number in range(PARTS):
            polynomials.append(self.speed(number, begin, direction))
            begin = sum(polynomials[number])

        def speed(place: float) -> float:
            number = min(int(place), PARTS - 1)
            return float(horner(polynomials[number], place - number))

        high = GAUSS.places[point] if point < STAGES else 1.0
        return crossing(speed, PARTS * GAUSS.places[point - 1], PARTS * high)


def pieces_of(rows: Any, size: int, parts: float) -> Array:
    """Return polynomials of numbers in the first parts of a step. Where the last is a fraction of a
    part, its variable is scaled to run from 0 to 1 there.

    Part after part, and one number after the other: coefficients from the first power on.
    """
    full, count = math.ceil(parts), size * STAGES
    if parts == full:
        return first_of(rows, full * count)
    before, shares = (full - 1) * count, [(parts - full + 1) ** (k + 1) for k in range(STAGES)]
    last = [
        term * share
        for term, share in zip(rows[before : before + count], shares * size, strict=True)
    ]
    return np.array([*rows[:before], *last])
