"""Page of a run: one HTML file that plays it without a network."""

import html
from pathlib import Path

import xarray as xr

from tippetop import __version__
from tippetop.export.bundle import LOADER, packed, player_notices, player_packed
from tippetop.export.track import pack_run, unpack_header
from tippetop.results.dataset import require_run
from tippetop.support.files import written_beside

_PAGE = Path(__file__).with_name("run.html")


def write_html(run: xr.Dataset, path: Path | str, overwrite: bool = False) -> Path:
    """Write a run as a self-contained HTML file that plays it in any browser, offline.

    Raises
    ------
    FileTrouble
        If the file exists and `overwrite` is false, or cannot be written.
    InvalidInput
        If `run` is no run, or the path is no name of a file.
    Unavailable
        If the player is not built (`make page`).

    Examples
    --------
    >>> import tippetop as tt
    >>> run = tt.simulate(tt.presets.report_problem(), duration=1.0, samples=501)
    >>> tt.write_html(run, "run.html").name  # open it in any browser, on any machine
    'run.html'
    """
    require_run(run)
    with written_beside(path, overwrite) as beside:
        block = pack_run(run)
        page = _PAGE.read_text(encoding="utf-8").format(
            version=__version__,
            title=html.escape(f"Tippe top: {unpack_header(block)['story']['headline']}"),
            run=packed(block),
            player=player_packed(),
            loader=LOADER,
            notices=player_notices(),
        )
        beside.write_text(page, encoding="utf-8")
    return Path(path)
