"""How many cells of a sweep are implausible."""

import numpy as np

from tippetop.integrators.base import Array
from tippetop.problem.implausible import sentence
from tippetop.problem.plausibility import Outside, checks, doubts, outside_of
from tippetop.sweeps.cells import put
from tippetop.sweeps.definition import Sweep
from tippetop.sweeps.draws import Draws

CELLS_EXAMINED, MOST_SHAPES = 100_000, 256
"""Cells that are looked at; and where every cell has a shape of its own, whose outside takes 0.1 ms
to measure.
"""


def implausible_cells(sweep: Sweep) -> str:
    """Return how many cells of a sweep are implausible, and what is of the first; "" if none is.

    Of a sweep with more cells than `CELLS_EXAMINED`, or `MOST_SHAPES`, so many are looked at: the
    first draws, or cells evenly spaced over the axes.
    """
    first = sweep.grid.values(np.arange(1))
    shapes = any(field.startswith("body.shape.") for field in first)
    count = min(sweep.cells, MOST_SHAPES if shapes else CELLS_EXAMINED)
    last = count if isinstance(sweep.grid, Draws) else sweep.cells
    values = sweep.grid.values(np.linspace(0, last - 1, count).astype(np.intp))
    filled = put(sweep.problem, values)
    outside = _outsides(sweep, values, count) if shapes else outside_of(sweep.problem.body.surface)
    holds = np.zeros(count, dtype=bool)
    with np.errstate(all="ignore"):
        for _, doubtful, _ in checks(filled, outside):
            holds |= doubtful
    if not holds.any():
        return ""
    cell = int(np.argmax(holds))
    problem = put(sweep.problem, {field: numbers[cell] for field, numbers in values.items()})
    reasons = "; ".join(map(sentence, doubts(problem)))
    population = f"{count:,} cells" if count == sweep.cells else f"{count:,} cells looked at"
    return f"{holds.sum():,} of {population} are implausible; the first: {reasons}"


def _outsides(sweep: Sweep, values: dict[str, Array], count: int) -> Outside:
    """Return the outsides of cells whose shapes differ, as arrays."""
    bodies = (
        put(sweep.problem, {field: numbers[cell] for field, numbers in values.items()}).body
        for cell in range(count)
    )
    return Outside(*np.transpose([outside_of(body.surface) for body in bodies]))
