"""The map on the page: which launches it is of, and what becomes known of them."""

import asyncio
import threading
from collections.abc import AsyncIterator, Callable
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from typing import NamedTuple

import numpy as np
from nicegui import background_tasks, ui

from tippetop.errors import InvalidInput, TippetopError
from tippetop.export.words import spin_marks
from tippetop.lab.elements import PhaseMap
from tippetop.lab.map_job import Fate, MapPart
from tippetop.lab.setup import Setup
from tippetop.lab.workers import Workers

COLUMNS, ROWS = 64, 32
"""As fine as a cell can still be pointed at."""


class MapPlan(NamedTuple):
    """The launches of a map: what all have in common, spins (rad/s), and friction coefficients."""

    setup: Setup
    spins: list[float]
    frictions: list[float]

    def cell(self, spin: float, mu: float) -> Setup:
        """One of them."""
        return self.setup.changed({"launch.spin": spin, "friction.mu": mu})


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
    stopped = threading.Event()
    parts = pool.map_parts(plan.setup, plan.spins, plan.frictions, stopped)
    thread = ThreadPoolExecutor(1, "phase map")
    try:
        while part := await asyncio.get_running_loop().run_in_executor(thread, next, parts, None):
            yield part
    finally:
        stopped.set()
        thread.submit(next, parts, None)  # so that it hears of that, and frees its process
        thread.shutdown(wait=False)


class MapSection:
    """The part of the page with the map.

    Parameters
    ----------
    pool
        The processes that compute it.
    highest_spin
        The highest spin on it, rad/s.
    current
        Gives the launch that the page shows.
    go_to, complain
        Are told which launch was chosen, or why it cannot be.
    """

    def __init__(
        self,
        pool: Workers,
        highest_spin: float,
        current: Callable[[], Setup],
        go_to: Callable[[Setup], None],
        complain: Callable[[str], None],
    ) -> None:
        self._pool, self._highest_spin = pool, highest_spin
        self._current, self._go_to, self._complain = current, go_to, complain
        self._plan: MapPlan | None = None
        self._work: asyncio.Task[None] | None = None
        with ui.element("section").classes("lab-map-section").props('aria-label="Phase map"'):
            with ui.element("div").classes("lab-map-head"):
                title = ui.label("Map: where launches end").classes("lab-subtitle")
                title.props('role="heading" aria-level="2"')
                self._button = ui.button("Compute", on_click=self._press).props("dense no-caps outline")
            self._progress = ui.linear_progress(0.0, show_value=False)
            self._progress.props('aria-label="Progress of the map"')
            self._note = ui.label("Spin across, friction up; the rest as set above.").classes("lab-note")
            self._map = PhaseMap(self._launch)

    def show(self) -> None:
        """Mark the launch that the page shows, if the map is of launches like it."""
        setup, here = self._current(), None
        mu = getattr(setup.problem.friction, "mu", None)
        if mu is not None and self._plan is not None:
            with suppress(InvalidInput):
                if self._plan.cell(setup.problem.launch.spin, mu) == setup:
                    here = (setup.problem.launch.spin, mu)
        self._map.run_method("here", here)

    def stop(self) -> None:
        """Stop computing the map, if it is being computed."""
        if self._work is not None:
            self._work.cancel()
        self._work = None

    def _launch(self, spin: float, mu: float) -> None:
        """Launch what a cell shows: the rest of it may have been set otherwise since."""
        if self._plan is not None:
            try:
                self._go_to(self._plan.cell(spin, mu))
            except InvalidInput as error:
                self._complain(str(error))

    def _press(self) -> None:
        if self._work is None:
            self._begin()
        else:
            self.stop()
            self._button.text = "Compute again"
            self._note.text = "Stopped. What there is of it can be launched."

    def _begin(self) -> None:
        setup = self._current()
        try:
            self._plan = plan = plan_map(setup, self._highest_spin)
        except InvalidInput as error:
            self._note.text = str(error)
            return
        marks = list(spin_marks(setup.problem).values())
        unit = " s/m" if setup.problem.friction.kind == "viscous" else ""
        self._map.run_method("begin", plan.spins, plan.frictions, unit, marks)
        self.show()
        self._button.text = "Stop"
        self._progress.value = 0.0
        self._note.text = "The laboratory gets ready for it."
        self._work = background_tasks.create(self._compute(plan), name="phase map")

    async def _compute(self, plan: MapPlan) -> None:
        followed = 0
        try:
            async for part in parts_of(plan, self._pool):
                followed += sum(fate != Fate.IN_THE_AIR for fate in part.fates)
                self._map.run_method("put", part.cells, part.tilts, part.flights, part.fates)
                self._progress.value = part.share
                self._note.text = f"{followed} launches followed"
            self._progress.value = 1.0
            self._note.text = (
                f"{followed} launches. Click one to see it. The map stays as it is when controls move."
            )
        except TippetopError as error:
            self._note.text = str(error)
        self._work = None
        self._button.text = "Compute again"
