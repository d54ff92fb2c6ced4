"""A phase map, computed by the engine of sweeps: from coarse to fine, and flights, the slow part, last."""

import time
from collections.abc import Iterator, Sequence
from enum import StrEnum
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tippetop.catalogue import Ending
from tippetop.lab.setup import Setup, first_setup
from tippetop.problem import Problem
from tippetop.sweeps.axes import Axis, Flat
from tippetop.sweeps.definition import Sweep
from tippetop.sweeps.ensemble import follow_cells
from tippetop.sweeps.grid import Product

STRIDES = (4, 2, 1)
"""Every fourth row and column comes first, then every second, then all."""
BANDS = 4
"""Parts in which the cells of one stride are told."""
HASTE = 10.0
"""A finer stride is left out if it would take longer than this, s."""


class Fate(StrEnum):
    """What is known of a cell, as a visitor reads it; nothing where the tilt says it all."""

    FOLLOWED = ""
    IN_THE_AIR = "leaves the table; its flights are not followed yet"
    STOPPED = "leaves the table, where the run stops"
    FAILED = "cannot be followed to the end"
    IMPOSSIBLE = "cannot be launched: any impulse of the table would drag it further in"


class MapPart(NamedTuple):
    """What has become known of some cells of a map.

    Attributes
    ----------
    cells
        Their numbers, counted along the spins, row by row.
    tilts
        Final tilts, rad; None where there is none.
    flights
        How many times each left the table.
    fates
        What is known of each.
    share
        Share of the finest map that is done.
    """

    cells: list[int]
    tilts: list[float | None]
    flights: list[int]
    fates: list[str]
    share: float


def map_parts(
    setup: Setup, spins: Sequence[float], frictions: Sequence[float], haste: float = HASTE
) -> Iterator[MapPart]:
    """Final tilts over spin and friction coefficient, part by part.

    A top let go on the table that flies is followed twice: to where the table lets go, with the thousands
    that never leave it, and then through its flights: most of the map is there before its slow part begins.
    """
    grid = Product((Axis.listed("friction.mu", frictions), Axis.listed("launch.spin", spins)))
    problem = setup.problem
    twice = problem.contact.liftoff == "fly" and problem.launch.gap == 0 and problem.launch.velocity is None
    at_first = Sweep(_stopped(problem) if twice else problem, grid, setup.duration)
    levels = list(_levels(grid.shape))
    done = 0
    flying: list[Flat] = []
    expected = 0.0
    for place, level in enumerate(levels):
        if expected > haste:
            break
        began = time.monotonic()
        for band in np.array_split(level, min(BANDS, len(level))):
            found = follow_cells(at_first, band)
            off = np.isin(found["outcome"], [Ending.LIFTED_OFF, Ending.BAD]) & twice
            flying.append(band[off])
            done += int(np.sum(~off))
            yield _part(band, found, off, done / at_first.cells)
        if place + 1 < len(levels):
            expected = (time.monotonic() - began) * len(levels[place + 1]) / len(level)
    # All in one: the flights of many launches take hardly longer than those of a few.
    left = np.concatenate(flying)
    if len(left):
        found = follow_cells(Sweep(problem, grid, setup.duration), left)
        yield _part(left, found, np.zeros(len(left), dtype=bool), 1.0)


def warm_up_map() -> None:
    """Load the libraries and compile the steps: then the first map comes as fast as the next."""
    setup = first_setup().changed({"launch.spin": 175.0, "duration": 6.0})
    list(map_parts(setup, [175.0], [0.3]))


def _stopped(problem: Problem) -> Problem:
    """The problem with runs that stop where the table lets go; not checked, for the cells of a sweep are."""
    contact = problem.contact.model_copy(update={"liftoff": "stop"})
    return problem.model_copy(update={"contact": contact})


def _levels(shape: tuple[int, ...]) -> Iterator[Flat]:
    """The cells that each stride adds to those before."""
    rows, columns = np.indices(shape)
    known = np.zeros(shape, dtype=bool)
    for stride in STRIDES:
        met = (rows % stride == 0) & (columns % stride == 0)
        fresh = np.flatnonzero(met & ~known)
        if len(fresh):
            yield fresh
        known |= met


def _part(
    cells: Flat, found: dict[str, NDArray[np.generic]], off: NDArray[np.bool_], share: float
) -> MapPart:
    outcome = found["outcome"]
    fates = np.select(
        [off, outcome == Ending.LIFTED_OFF, outcome == Ending.FAILED, outcome == Ending.BAD],
        [Fate.IN_THE_AIR, Fate.STOPPED, Fate.FAILED, Fate.IMPOSSIBLE],
        Fate.FOLLOWED,
    )
    shown = fates == Fate.FOLLOWED
    tilts = [float(tilt) if fine else None for tilt, fine in zip(found["final_theta"], shown, strict=True)]
    return MapPart(cells.tolist(), tilts, found["flights"].tolist(), fates.tolist(), share)
