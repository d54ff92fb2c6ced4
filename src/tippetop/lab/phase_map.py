"""Which map the page draws, and its rows as they are computed.

This is the one place that says how a map is computed: now by one launch after the other in a worker process.
"""

import asyncio
import threading
from collections.abc import AsyncIterator
from contextlib import suppress
from dataclasses import dataclass

import numpy as np

from tippetop.errors import TippetopError
from tippetop.lab.jobs import MapRow
from tippetop.lab.setup import Setup
from tippetop.lab.workers import Workers

COLUMNS, ROWS = 32, 16


@dataclass(frozen=True)
class MapPlan:
    """The launches of a map.

    Attributes
    ----------
    setup
        What all have in common.
    spins, frictions
        Spins, rad/s, and friction coefficients.
    """

    setup: Setup
    spins: list[float]
    frictions: list[float]


def plan_map(setup: Setup, highest_spin: float) -> MapPlan:
    """A map around a launch: spins to the highest of the slider, friction over a factor 100."""
    spins = (np.arange(COLUMNS) + 0.5) / COLUMNS * highest_spin
    middle = float(f"{max(getattr(setup.problem.friction, 'mu', 0.3), 1e-3):.1g}")
    frictions = middle * np.geomspace(0.1, 10.0, ROWS)
    return MapPlan(setup, [float(f"{v:.4g}") for v in spins], [float(f"{v:.3g}") for v in frictions])


async def rows_of(plan: MapPlan, pool: Workers) -> AsyncIterator[MapRow]:
    """The rows of a map in the order they are done; the work ends when they are no longer asked for.

    Raises
    ------
    InvalidInput
        If the map would take too long, or a launch in it cannot be.
    """
    loop, stopped = asyncio.get_running_loop(), threading.Event()
    rows: asyncio.Queue[MapRow | TippetopError | None] = asyncio.Queue()

    def put(item: MapRow | TippetopError | None) -> None:
        with suppress(RuntimeError):  # the loop is closed: nobody waits any more
            loop.call_soon_threadsafe(rows.put_nowait, item)

    def work() -> None:
        try:
            for row in pool.map_rows(plan.setup, plan.spins, plan.frictions, stopped):
                put(row)
            put(None)
        except TippetopError as error:
            put(error)

    threading.Thread(target=work, daemon=True, name="phase map").start()
    try:
        while (item := await rows.get()) is not None:
            if isinstance(item, TippetopError):
                raise item
            yield item
    finally:
        stopped.set()
