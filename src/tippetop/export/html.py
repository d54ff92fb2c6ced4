"""A run as one HTML file that plays it without a network."""

import html
from pathlib import Path

import xarray as xr

from tippetop import __version__
from tippetop.export.bundle import LOADER, packed, player_packed
from tippetop.export.track import pack_run, unpack_header
from tippetop.files import place_for, written_beside

_PAGE = """<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<meta name="generator" content="tippetop {version}">
<title>{title}</title>
<style>
  html, body {{ height: 100%; margin: 0; }}
  #stage {{ height: 100%; }}
</style>
</head>
<body>
<div id="stage"></div>
<noscript>This page plays a run of a tippe top; it needs JavaScript.</noscript>
<script type="text/plain" id="player-code">{player}</script>
<script type="text/plain" id="run">{run}</script>
<script type="module">
{loader}
const player = createPlayer(document.getElementById("stage"), {{ theme: "auto" }});
player.load(await unzip("run").arrayBuffer());
player.toggle(!stillness());
globalThis.tippetopPlayer = player;
</script>
</body>
</html>
"""


def html_page(run: xr.Dataset) -> str:
    """The page of a run; `Unavailable` if the player is not built: see `tippetop.export.bundle`."""
    block = pack_run(run)
    return _PAGE.format(
        version=__version__,
        title=html.escape(f"Tippe top: {unpack_header(block)['story']['headline']}"),
        run=packed(block),
        player=player_packed(),
        loader=LOADER,
    )


def write_html(run: xr.Dataset, path: Path | str, overwrite: bool = False) -> Path:
    """Write a run as a self-contained HTML file that plays it in any browser, offline.

    Raises
    ------
    FileTrouble
        If the file exists and `overwrite` is false, or cannot be written.
    Unavailable
        If the player is not built: see `tippetop.export.bundle`.

    Examples
    --------
    >>> import tippetop as tt
    >>> run = tt.simulate(tt.presets.report_problem(), duration=1.0, samples=501)
    >>> tt.write_html(run, "run.html").name  # open it in any browser, on any machine
    'run.html'
    """
    path = Path(path)
    place_for(path, overwrite)
    page = html_page(run)
    with written_beside(path, overwrite) as beside:
        beside.write_text(page, encoding="utf-8")
    return path
