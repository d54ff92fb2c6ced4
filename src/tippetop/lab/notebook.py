"""Player of a run in a Jupyter notebook: the player of the page, as a widget."""

from functools import cache
from typing import Any

import xarray as xr

from tippetop.export.bundle import built
from tippetop.export.track import pack_run
from tippetop.results.dataset import require_run
from tippetop.support.errors import InvalidInput, Unavailable, is_whole
from tippetop.support.installation import install_command
from tippetop.support.suggestions import not_one_of

THEMES = ("auto", "light", "dark")


def view(run: xr.Dataset, height: int = 480, theme: str = "auto") -> Any:
    """Return a widget that plays a run; its method `show(run)` plays another one instead.

    Parameters
    ----------
    run
        The run, as from `tippetop.run.simulate`.
    height
        Height of the widget, pixels.
    theme
        "light", "dark", or "auto" for the preference of the browser.

    Raises
    ------
    InvalidInput
        If there is no such theme, or the height is not positive.
    Unavailable
        If anywidget is not installed, or the player is not built.

    Examples
    --------
    >>> import tippetop as tt
    >>> player = tt.view(tt.simulate(tt.presets.report_problem(), duration=1.0, samples=501))
    >>> player.show(tt.simulate(tt.presets.report_problem(spin=50.0), duration=1.0, samples=501))
    """
    require_run(run)
    if not isinstance(theme, str) or theme not in THEMES:
        raise not_one_of("theme", theme, THEMES)
    if not is_whole(height) or height <= 0:
        raise InvalidInput("height", height, "a whole number of pixels greater than 0")
    return _widget()(track=pack_run(run), height=height, theme=theme)


@cache
def _widget() -> Any:
    try:
        import anywidget  # noqa: PLC0415 - optional
        import traitlets  # noqa: PLC0415 - comes with anywidget
    except ImportError:
        raise Unavailable(
            f"a run is shown in a notebook by anywidget: {install_command('lab')}"
        ) from None

    def show(self: Any, run: xr.Dataset) -> None:
        """Play another run in this widget."""
        self.track = pack_run(run)

    members = {
        "__doc__": "A run that plays.",
        "_esm": built("player.js"),
        "track": traitlets.Bytes().tag(sync=True),
        "height": traitlets.Int(480).tag(sync=True),
        "theme": traitlets.Unicode("auto").tag(sync=True),
        "show": show,
    }
    return type("RunView", (anywidget.AnyWidget,), members)
