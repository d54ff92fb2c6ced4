"""The page: scene and controls side by side, plots and map below. One visitor's state is one `Laboratory`."""

import asyncio
import math
from contextlib import suppress
from pathlib import Path
from typing import Any
from urllib.parse import parse_qsl

from fastapi import Request
from nicegui import background_tasks, events, ui

from tippetop.errors import InvalidInput, TippetopError
from tippetop.export.words import end_in_words, known_end, known_spins
from tippetop.lab import controls
from tippetop.lab.elements import PhaseMap, Player, Plots
from tippetop.lab.jobs import KINDS
from tippetop.lab.launches import launches
from tippetop.lab.map_job import Fate
from tippetop.lab.phase_map import MapPlan, parts_of, plan_map
from tippetop.lab.server import FILE_PATH, TRACK_PATH
from tippetop.lab.setup import Setup, first_setup, read_query
from tippetop.lab.workers import Workers

SHOW_DELAY = 0.12
"""How long the words beside a slider wait for the picture of its run, s."""

_CSS = Path(__file__).parent / "components" / "page.css"
_FILE_NAMES = {
    "nc": "NetCDF",
    "csv": "CSV",
    "toml": "TOML (the launch)",
    "glb": "3D model (.glb)",
    "html": "HTML (plays offline)",
}
_LIFTOFF = {"fly": "top flies", "stop": "run stops", "ignore": "it pulls"}


def register_page(pool: Workers) -> None:
    """Make the page the server's first."""

    @ui.page("/", dark=None)
    def page(request: Request) -> None:
        try:
            setup, trouble = read_query(request.query_params), ""
        except InvalidInput as error:
            setup, trouble = first_setup(), f"The link is not followed: {error}"
        Laboratory(pool, setup, trouble)


class Laboratory:
    """One visitor's page."""

    def __init__(self, pool: Workers, setup: Setup, trouble: str) -> None:
        self.pool, self.setup = pool, setup
        self.quiet = self.showing = False
        self.law_shown: tuple[object, ...] = ()
        self.plan: MapPlan | None = None
        self.mapping: asyncio.Task[None] | None = None
        ui.add_css(_CSS)
        ui.colors(primary="#1b74bd")
        self.dark = ui.dark_mode(None)
        self._header()
        with ui.element("main").classes("lab"):
            with ui.element("section").classes("lab-scene").props('aria-label="Scene"'):
                self.player = Player(TRACK_PATH, FILE_PATH)
            with ui.element("section").classes("lab-controls").props('aria-label="Launch"'):
                self._controls()
            with ui.element("div").classes("lab-below"):
                Plots()
                with ui.element("div").classes("lab-side"):
                    self._map()
                    self._files()
        self.player.on("refused", self._refused)
        self.player.on("link", self._linked)
        self.player.on("ready", lambda: self.player.launch(self.setup.query, play=True))
        self.show()
        self.complain(trouble)
        ui.context.client.on_delete(self.stop_map)

    def _header(self) -> None:
        with ui.element("header").classes("lab-header"):
            ui.label("Tippe top laboratory").classes("lab-title").props('role="heading" aria-level="1"')
            ui.space()
            ui.button(icon="contrast", on_click=self._theme).props(
                'flat dense round aria-label="Light, dark or as the system"'
            )

    def _controls(self) -> None:
        self.presets = launches()
        self.preset = ui.select(
            list(self.presets), label="Start from", on_change=self._preset, clearable=False
        ).props("dense outlined options-dense")
        self.trouble = ui.label().classes("lab-refused").props('role="alert"')
        self.rows: list[controls.DialRow] = []
        self._dials(controls.MAIN)
        self.spin_row, self.mu_row = self.rows[0], self.rows[2]
        self.law = ui.select(controls.law_choices(), label="Friction law", on_change=self._law).props(
            "dense outlined options-dense"
        )
        self.law_numbers = ui.element("div").classes("lab-law")
        self.prospect = ui.label().classes("lab-prospect")
        with ui.expansion("Table and time").props("dense").classes("lab-more"):
            ui.label("Where the table would have to pull").classes("lab-dial-name")
            self.liftoff = ui.toggle(_LIFTOFF, on_change=self._liftoff).props("dense no-caps unelevated")
            self._dials(controls.TABLE)
        with ui.expansion("The top").props("dense").classes("lab-more"):
            self._dials(controls.TOP)
        with ui.expansion("How it is let go").props("dense").classes("lab-more"):
            self._dials(controls.START)

    def _dials(self, dials: tuple[controls.Dial, ...]) -> None:
        self.rows += [controls.DialRow(dial, lambda: self.setup, self.change) for dial in dials]

    def _map(self) -> None:
        with ui.element("section").classes("lab-map-section").props('aria-label="Phase map"'):
            with ui.element("div").classes("lab-map-head"):
                ui.label("Map: where launches end").classes("lab-subtitle").props(
                    'role="heading" aria-level="2"'
                )
                self.map_button = ui.button("Compute", on_click=self._press_map).props(
                    "dense no-caps outline"
                )
            self.progress = ui.linear_progress(0.0, show_value=False).props(
                'aria-label="Progress of the map"'
            )
            self.map_note = ui.label("Spin across, friction up; the rest as set above.").classes("lab-note")
            self.map = PhaseMap(self._launch_cell)

    def _files(self) -> None:
        with ui.element("section").classes("lab-files").props('aria-label="Files"'):
            ui.label("Keep or share this run").classes("lab-subtitle").props('role="heading" aria-level="2"')
            with ui.element("div").classes("lab-links"):
                # In the browser: what a click has not asked for may not reach the clipboard.
                copy = ui.button("Copy link", icon="link").props("outline dense no-caps")
                copy.on("click", js_handler="() => tippetopLab.copy()")
                for kind in KINDS:
                    link = ui.element("a").classes("lab-file")
                    link.props(f'data-kind="{kind}" download="tippetop.{kind}" href="#"')
                    with link:
                        ui.label(_FILE_NAMES[kind])
            with ui.element("div").classes("lab-link") as self.link_row:
                ui.label("The browser lets nothing onto the clipboard here. Copy the link from this field:")
                self.link = ui.input().props('dense outlined readonly aria-label="Link to this launch"')
            self.link_row.set_visibility(False)

    def change(self, changes: dict[str, Any], asked: bool = False, play: bool = False) -> None:
        """Change the launch and show what it does, or say why it cannot be.

        Parameters
        ----------
        changes
            Fields by their names with dots.
        asked
            Whether the browser has asked for the new run already.
        play
            Whether to play it from the start.
        """
        try:
            self.setup = self.setup.changed(changes)
        except InvalidInput as error:
            self.complain(str(error))
            self.show()
            return
        self.complain("")
        if asked:
            self._show_soon()
        else:
            self.player.launch(self.setup.query, play)
            self.show()

    def go_to(self, setup: Setup) -> None:
        """Launch something else, and play it from the start."""
        self.setup = setup
        self.complain("")
        self.player.launch(self.setup.query, play=True)
        self.show()

    def _refused(self, event: events.GenericEventArguments) -> None:
        """Go back to the launch that the browser still shows, as no run came of a newer one."""
        if event.args["heard"] != self.player.asked:
            return  # Another launch is on its way to the browser, and what comes of that will be told.
        with suppress(InvalidInput):
            self.setup = read_query(dict(parse_qsl(event.args["query"])))
        self.show()
        if event.args["why"]:
            self.complain(event.args["why"])

    def _show_soon(self) -> None:
        """Show the launch once the browser has its run: the picture comes first."""
        if self.showing:
            return
        self.showing = True

        async def later() -> None:
            await asyncio.sleep(SHOW_DELAY)
            self.showing = False
            self.show()

        background_tasks.create(later(), name="show the launch")

    def complain(self, sentence: str) -> None:
        """Say what is refused, or nothing."""
        self.trouble.text = sentence
        self.trouble.set_visibility(bool(sentence))

    def show(self) -> None:
        """Show the launch in the controls, with what theory says of it."""
        problem = self.setup.problem
        for row in self.rows:
            row.show(self.setup)
        word = problem.friction.kind
        self.quiet = True
        self.law.value = word
        self.liftoff.value = problem.contact.liftoff
        self.preset.value = next((name for name, setup in self.presets.items() if setup == self.setup), None)
        self.quiet = False
        self._show_law(word)
        spins, end = known_spins(problem), known_end(problem)
        marks = {"ωc₁": spins.upright, "ωc₂": spins.inverted} if spins else {}
        self.spin_row.mark({name: value for name, value in marks.items() if math.isfinite(value)})
        self.prospect.text = f"Heads for {end_in_words(end)}." if end else ""
        self._show_here()

    def _show_here(self) -> None:
        """Mark the launch on the map, if the map is of launches like it."""
        mu = getattr(self.setup.problem.friction, "mu", None)
        here = None
        if mu is not None and self.plan is not None:
            spin = self.setup.problem.launch.spin
            with suppress(InvalidInput):
                if _cell(self.plan, spin, mu) == self.setup:
                    here = (spin, mu)
        self.map.here(here)

    def _show_law(self, word: str) -> None:
        friction = self.setup.problem.friction
        shown = (word, *(getattr(friction, name) for name in controls.law_fields(word)))
        if shown == self.law_shown:
            return
        self.law_shown = shown
        self.law_numbers.clear()
        with self.law_numbers:
            for name in controls.law_fields(word):
                value = getattr(self.setup.problem.friction, name)
                if isinstance(value, float | int):
                    self._law_number(name, float(value))

    def _law_number(self, name: str, value: float) -> None:
        label = controls.LAW_NUMBERS.get(name, name)
        number = ui.number(label, value=value, format="%.6g").props('dense outlined step="any"')

        def typed() -> None:
            if number.value is not None:
                self.change({f"friction.{name}": float(number.value)})

        number.on("change", typed)

    def _preset(self, event: events.ValueChangeEventArguments[str | None]) -> None:
        if self.quiet or event.value is None:
            return
        self.go_to(self.presets[event.value])

    def _law(self, event: events.ValueChangeEventArguments[str | None]) -> None:
        if not self.quiet and event.value is not None:
            mu = getattr(self.setup.problem.friction, "mu", 0.3)
            self.change({"friction.kind": event.value, "friction.mu": mu})

    def _liftoff(self, event: events.ValueChangeEventArguments[str | None]) -> None:
        if not self.quiet and event.value is not None:
            self.change({"contact.liftoff": event.value})

    def _theme(self) -> None:
        self.dark.value = {None: True, True: False, False: None}[self.dark.value]

    def _linked(self, event: events.GenericEventArguments) -> None:
        """Say that the link is copied, or show it where the browser copies nothing: not over plain http."""
        self.link_row.set_visibility(not event.args["copied"])
        if event.args["copied"]:
            ui.notify("The link to this launch is on the clipboard.")
            return
        self.link.value = event.args["link"]
        self.link.run_method("focus")
        self.link.run_method("select")

    def _launch_cell(self, spin: float, mu: float) -> None:
        """Launch what a cell of the map shows: the rest of it may have been set otherwise since."""
        if self.plan is not None:
            try:
                self.go_to(_cell(self.plan, spin, mu))
            except InvalidInput as error:
                self.complain(str(error))

    def _press_map(self) -> None:
        if self.mapping is None:
            self._begin_map()
            return
        self.stop_map()
        self.map_button.text = "Compute again"
        self.map_note.text = "Stopped. What there is of it can be launched."

    def _begin_map(self) -> None:
        try:
            plan = plan_map(self.setup, controls.SPIN.high)
        except InvalidInput as error:
            self.map_note.text = str(error)
            return
        self.plan = plan
        spins = known_spins(self.setup.problem)
        marks = [s for s in (spins.upright, spins.inverted) if math.isfinite(s)] if spins else []
        unit = " s/m" if self.setup.problem.friction.kind == "viscous" else ""
        self.map.begin(plan.spins, plan.frictions, unit, marks)
        self._show_here()
        self.map_button.text = "Stop"
        self.progress.value = 0.0
        self.map_note.text = "The laboratory gets ready for it."

        async def work() -> None:
            followed = 0
            try:
                async for part in parts_of(plan, self.pool):
                    followed += sum(fate != Fate.IN_THE_AIR for fate in part.fates)
                    self.map.put(part)
                    self.progress.value = part.share
                    self.map_note.text = f"{followed} launches followed"
                self.progress.value = 1.0
                self.map_note.text = (
                    f"{followed} launches. Click one to see it. The map stays as it is when controls move."
                )
            except TippetopError as error:
                self.map_note.text = str(error)
            self.mapping = None
            self.map_button.text = "Compute again"

        self.mapping = background_tasks.create(work(), name="phase map")

    def stop_map(self) -> None:
        """Stop computing the map, if it is being computed."""
        if self.mapping is not None and not self.mapping.done():
            self.mapping.cancel()
        self.mapping = None


def _cell(plan: MapPlan, spin: float, mu: float) -> Setup:
    """The launch of a cell of a map."""
    return plan.setup.changed({"launch.spin": spin, "friction.mu": mu})
