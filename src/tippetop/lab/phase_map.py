"""Which map the page draws, and its parts as they are computed."""

import asyncio
import threading
from collections.abc import AsyncIterator
from contextlib import suppress
from dataclasses import dataclass

import numpy as np

from tippetop.errors import InvalidInput, TippetopError
from tippetop.lab.map_job import MapPart
from tippetop.lab.setup import Setup
from tippetop.lab.workers import Workers

COLUMNS, ROWS = 64, 32
"""As fine as a cell can still be pointed at."""


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
    """A map around a launch: spins to the highest of the slider, friction over a factor 100.

    Raises
    ------
    InvalidInput
        If the friction law has no coefficient mu.
    """
    friction = setup.problem.friction
    mu = getattr(friction, "mu", None)
    if mu is None:
        raise InvalidInput("friction.kind", friction.kind, "a law with a coefficient mu to draw a map over")
    # Rounded to what the page shows, so that a cell is launched exactly as it reads.
    spins = (np.arange(COLUMNS) + 0.5) / COLUMNS * highest_spin
    frictions = float(f"{max(mu, 1e-3):.1g}") * np.geomspace(0.1, 10.0, ROWS)
    return MapPlan(setup, [float(f"{v:.4g}") for v in spins], [float(f"{v:.3g}") for v in frictions])


async def parts_of(plan: MapPlan, pool: Workers) -> AsyncIterator[MapPart]:
    """The parts of a map as they are done; the work ends when they are no longer asked for.

    Raises
    ------
    InvalidInput
        If the map would take too long.
    """
    loop, stopped = asyncio.get_running_loop(), threading.Event()
    parts: asyncio.Queue[MapPart | TippetopError | None] = asyncio.Queue()

    def put(item: MapPart | TippetopError | None) -> None:
        with suppress(RuntimeError):  # the loop is closed: nobody waits any more
            loop.call_soon_threadsafe(parts.put_nowait, item)

    def work() -> None:
        try:
            for part in pool.map_parts(plan.setup, plan.spins, plan.frictions, stopped):
                put(part)
            put(None)
        except TippetopError as error:
            put(error)

    threading.Thread(target=work, daemon=True, name="phase map").start()
    try:
        while (item := await parts.get()) is not None:
            if isinstance(item, TippetopError):
                raise item
            yield item
    finally:
        stopped.set()
