"""The page's own elements: the player, the plots and the map. What they do is in `components`."""

from collections.abc import Callable
from pathlib import Path

# The first two make ECharts and three.js importable on the page.
import nicegui.elements.echart
import nicegui.elements.scene  # noqa: F401
from nicegui import events
from nicegui.element import Element

from tippetop.export.bundle import PLAYER

_COMPONENTS = Path(__file__).parent / "components"


class Player(
    Element,
    component=_COMPONENTS / "lab_player.js",
    esm={"tippetop-player": str(PLAYER), "tippetop-lab": str(_COMPONENTS)},
):
    """The scene with its clock."""

    def __init__(self, track_path: str, file_path: str) -> None:
        super().__init__()
        self._props["track-path"] = track_path
        self._props["file-path"] = file_path
        self.asked = 0
        """How many launches the browser was told to show."""

    def launch(self, query: str, play: bool = False) -> None:
        """Show a launch, given as the query of a link, from the start if it is to `play`."""
        self.asked += 1
        self.run_method("launch", query, play, self.asked)


class Plots(Element, component=_COMPONENTS / "lab_plots.js"):
    """The linked plots of the run that the player shows."""


class PhaseMap(Element, component=_COMPONENTS / "lab_map.js"):
    """A map of final tilts; `on_launch` is called with the spin and friction of a chosen cell."""

    def __init__(self, on_launch: Callable[[float, float], None]) -> None:
        super().__init__()

        def chosen(event: events.GenericEventArguments) -> None:
            on_launch(float(event.args["spin"]), float(event.args["mu"]))

        self.on("launch", chosen)
