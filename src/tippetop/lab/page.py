"""The page: scene and controls side by side, plots and map below. One visitor's state is one `Laboratory`."""

import asyncio
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import Any
from urllib.parse import parse_qsl

from fastapi import Request
from nicegui import background_tasks, events, ui

from tippetop.errors import InvalidInput
from tippetop.export.words import end_in_words, known_end, spin_marks
from tippetop.lab import controls
from tippetop.lab.elements import Player, Plots
from tippetop.lab.launches import launches
from tippetop.lab.phase_map import MapSection
from tippetop.lab.setup import Setup, first_setup, read_query
from tippetop.lab.workers import Workers

SHOW_DELAY = 0.12
"""How long the words beside a slider wait for the picture of its run, s."""

_CSS = Path(__file__).parent / "components" / "page.css"
_FILES = {
    "nc": "NetCDF",
    "csv": "CSV",
    "toml": "TOML (the launch)",
    "glb": "3D model (.glb)",
    "html": "HTML (plays offline)",
}
_LIFTOFF = {"fly": "top flies", "stop": "run stops", "ignore": "it pulls"}


def register_page(pool: Workers, track_path: str, file_path: str) -> None:
    """Make the page the server's first; it gets runs and files from these paths."""

    @ui.page("/", dark=None)
    def page(request: Request) -> None:
        try:
            setup, trouble = read_query(request.query_params), ""
        except InvalidInput as error:
            setup, trouble = first_setup(), f"The link is not followed: {error}"
        Laboratory(pool, partial(Player, track_path, file_path), setup).complain(trouble)


class Laboratory:
    """One visitor's page."""

    def __init__(self, pool: Workers, make_player: partial[Player], setup: Setup) -> None:
        self.setup = setup
        self.quiet = self.showing = False
        ui.add_css(_CSS)
        ui.colors(primary="#1b74bd")
        self.dark = ui.dark_mode(None)
        self._header()
        with ui.element("main").classes("lab"):
            with ui.element("section").classes("lab-scene").props('aria-label="Scene"'):
                self.player = make_player()
            with ui.element("section").classes("lab-controls").props('aria-label="Launch"'):
                self._controls()
            with ui.element("div").classes("lab-below"):
                Plots()
                with ui.element("div").classes("lab-side"):
                    self.map = MapSection(
                        pool, controls.SPIN.high, lambda: self.setup, self.go_to, self.complain
                    )
                    self._files()
        self.player.on("refused", self._refused)
        self.player.on("link", self._linked)
        self.player.on("ready", lambda: self.player.launch(self.setup.query, play=True))
        self.show()
        ui.context.client.on_delete(self.map.stop)

    def _header(self) -> None:
        with ui.element("header").classes("lab-header"):
            ui.label("Tippe top laboratory").classes("lab-title").props('role="heading" aria-level="1"')
            ui.space()
            ui.button(icon="contrast", on_click=self._theme).props(
                'flat dense round aria-label="Light, dark or as the system"'
            )

    def _controls(self) -> None:
        self.presets = launches()
        self.preset = ui.select(list(self.presets), label="Start from", on_change=self._preset)
        self.trouble = ui.label().classes("lab-refused").props('role="alert"')
        self.rows: list[controls.DialRow] = []
        self._dials(controls.SPIN, controls.TILT, controls.MU)
        self.law = ui.select(controls.LAWS, label="Friction law", on_change=self._law)
        for choice in (self.preset, self.law):
            choice.props("dense outlined options-dense")
        self._dials(controls.SMOOTHED)
        self.prospect = ui.label().classes("lab-prospect")
        with ui.expansion("Table and time").props("dense").classes("lab-more"):
            ui.label("Where the table would have to pull").classes("lab-dial-name")
            self.liftoff = ui.toggle(_LIFTOFF, on_change=self._liftoff).props("dense no-caps unelevated")
            self._dials(*controls.TABLE)
        with ui.expansion("The top").props("dense").classes("lab-more"):
            self._dials(*controls.TOP)
        with ui.expansion("How it is let go").props("dense").classes("lab-more"):
            self._dials(*controls.START)

    def _dials(self, *dials: controls.Dial) -> None:
        self.rows += [controls.DialRow(dial, lambda: self.setup, self.change) for dial in dials]

    def _files(self) -> None:
        with ui.element("section").classes("lab-files").props('aria-label="Files"'):
            ui.label("Keep or share this run").classes("lab-subtitle").props('role="heading" aria-level="2"')
            with ui.element("div").classes("lab-links"):
                # In the browser: what a click has not asked for may not reach the clipboard.
                copy = ui.button("Copy link", icon="link").props("outline dense no-caps")
                copy.on("click", js_handler="() => tippetopLab.copy()")
                for kind, name in _FILES.items():
                    link = ui.element("a").classes("lab-file")
                    link.props(f'data-kind="{kind}" download="tippetop.{kind}" href="#"')
                    with link:
                        ui.label(name)
            with ui.element("div").classes("lab-link") as self.link_row:
                ui.label("The browser lets nothing onto the clipboard here. Copy the link from this field:")
                self.link = ui.input().props('dense outlined readonly aria-label="Link to this launch"')
            self.link_row.set_visibility(False)

    def change(self, changes: dict[str, Any], asked: bool = False) -> None:
        """Change the launch and show what it does, or say why it cannot be.

        Parameters
        ----------
        changes
            Fields by their names with dots.
        asked
            Whether the browser has asked for the new run already.
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
            self.player.launch(self.setup.query)
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
        self.quiet = True
        for row in self.rows:
            row.show(self.setup)
        self.law.value = problem.friction.kind
        self.liftoff.value = problem.contact.liftoff
        self.preset.value = next((name for name, setup in self.presets.items() if setup == self.setup), None)
        self.quiet = False
        self.rows[0].mark(spin_marks(problem))
        end = known_end(problem)
        self.prospect.text = f"Heads for {end_in_words(end)}." if end else ""
        self.map.show()

    def _preset(self, event: events.ValueChangeEventArguments[str | None]) -> None:
        if not self.quiet and event.value is not None:
            self.go_to(self.presets[event.value])

    def _law(self, event: events.ValueChangeEventArguments[str | None]) -> None:
        if not self.quiet and event.value is not None:
            mu = getattr(self.setup.problem.friction, "mu", 0.3)
            patch = {"friction.patch_radius": controls.PATCH} if event.value == "contensou" else {}
            self.change({"friction.kind": event.value, "friction.mu": mu, **patch})

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
