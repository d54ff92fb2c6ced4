"""Derivatives of the last state of a run alone, which take half as long as those of all that is
read off the run.
"""

from collections.abc import Callable, Sequence
from typing import TypeAlias

import numpy as np

from tippetop.fit.linearized_run import (
    BESIDE,
    CHECKED,
    FOUR,
    SHORTER,
    TRIES,
    Differs,
    LinearizedRun,
)
from tippetop.fit.problem_numbers import Direction
from tippetop.fit.variable_slopes import DIGITS, NIL
from tippetop.integrators.base import Array
from tippetop.mechanics.natural_units import Units
from tippetop.mechanics.state import State
from tippetop.mechanics.top import Top
from tippetop.problem.problem import Problem

StateReading: TypeAlias = Callable[[State, Top, Units], Array]
"""Numbers read off a state in natural units, of a top in natural units."""


@np.errstate(all="ignore")
def end_slopes(run: LinearizedRun, direction: int, read: StateReading) -> Array | None:
    """Return the derivatives of numbers of the last state with respect to a field, in SI.

    None where they do not exist: where the derivatives of the run end before, or where runs beside
    it end otherwise.
    """
    if direction in run.failures:
        return None
    change = run.reach(direction, BESIDE)
    for _ in range(TRIES):
        try:
            ends = [
                weight * read(*run.end_beside(direction, place * change)) for place, weight in FOUR
            ]
        except Differs:
            change *= SHORTER
            continue
        slopes: Array = np.sum(ends, axis=0) / (change * run.fields[direction].scale)
        return slopes
    return None


def known_end_slopes(
    problem: Problem,
    end: float,
    directions: Sequence[Direction],
    read: StateReading,
    naturals: Array,
) -> Array:
    """Return the derivatives of numbers of the last state with respect to fields, in SI, shape
    (fields, numbers).

    They are NaN where they do not exist, and, where events are differentiated by differences, where
    two distances agree to fewer than six digits of the largest by any field. Unlike
    `tippetop.sensitivities` they are NaN also where they are zero within rounding. `naturals` has
    the natural unit of each number.
    """
    grid, scales = np.array([0.0, end]), np.array([[one.scale] for one in directions])

    def changes(run: LinearizedRun) -> Array:
        """Return the changes of the numbers where each field changes by its own size."""
        missing = np.full(len(naturals), np.nan)
        rows = [end_slopes(run, place, read) for place in range(len(directions))]
        return np.asarray(scales * [missing if one is None else one for one in rows])

    run = LinearizedRun(problem, end, grid, directions)
    slopes = changes(run)
    if run.is_differenced:
        check = LinearizedRun(problem, end, grid, directions, distance=CHECKED * BESIDE)
        numbers = read(
            run.trajectory.state, run.numbers.top_of(run.kind), run.numbers.natural_units
        )
        largest = np.max(np.abs(slopes), axis=0, initial=0.0, where=~np.isnan(slopes))
        least = np.maximum(DIGITS * largest, NIL * np.maximum(naturals, np.abs(numbers)))
        slopes = np.where(np.abs(slopes - changes(check)) <= least, slopes, np.nan)
    return np.asarray(slopes / scales)
