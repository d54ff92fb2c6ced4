"""Derivatives of the last state of a run alone, which take half as long as those of all that is
read off the run.
"""

from collections.abc import Callable
from typing import TypeAlias

import numpy as np

from tippetop.fit.linearized_run import BESIDE, FOUR, SHORTER, TRIES, Differs, LinearizedRun
from tippetop.integrators.base import Array
from tippetop.mechanics.natural_units import Units
from tippetop.mechanics.state import State
from tippetop.mechanics.top import Top

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
