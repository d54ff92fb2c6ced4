"""The engine: cells in, observables out."""

import numpy as np
from numpy.typing import NDArray

from tippetop.integrators.base import Array
from tippetop.mechanics.vectors import length
from tippetop.sweep.cells import Fault, cells_of
from tippetop.sweep.courses import Launches
from tippetop.sweep.definition import Sweep
from tippetop.sweep.grid import Flat
from tippetop.sweep.lanes import Lanes, arrivals
from tippetop.sweep.observe import VARIABLES, final_band, nothing_known, observed
from tippetop.sweep.stepper import stepper

LANES_AT_ONCE = 2048
"""Launches that are followed together: enough to make little of Python's part, few enough for the cache."""


def follow_cells(sweep: Sweep, numbers: Flat) -> dict[str, NDArray[np.generic]]:
    """Every variable of `VARIABLES` for some cells of a sweep, each of shape (n,).

    Parameters
    ----------
    sweep
        What to compute.
    numbers
        Which cells, counted row by row.
    """
    cells = cells_of(sweep.problem, sweep.grid.values(numbers))
    found = nothing_known(len(numbers))
    found["fault"][:] = cells.fault
    good = np.flatnonzero(cells.fault == Fault.NONE)
    if not len(good):
        return found
    launches = cells.launches(good, sweep.duration)
    alike = np.argsort(expected_cost(launches), kind="stable")
    for first in range(0, len(alike), LANES_AT_ONCE):
        block = alike[first : first + LANES_AT_ONCE]
        some, which = launches.some(block), good[block]
        method = stepper(some.kind, sweep.tolerance)
        lanes = Lanes(some, method, settled=sweep.settled)
        ends = lanes.run()
        arrives = arrivals(some, method, lanes.notes, final_band(ends))
        for name, values in observed(cells, which, some, ends, arrives).items():
            found[name][which] = values.astype(VARIABLES[name].dtype)
    return found


def expected_cost(launches: Launches) -> Array:
    """Angle through which the axis nutates, rad: the steps that a launch takes grow with it."""
    cost: Array = length(launches.state.momentum) / launches.top.transverse_inertia * launches.end
    return cost
