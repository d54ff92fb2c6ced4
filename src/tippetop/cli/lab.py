"""`tippetop lab`: the laboratory's page in the browser."""

from pathlib import Path
from typing import Annotated

import typer

from tippetop.cli.options import Force, number_option
from tippetop.support.errors import InvalidInput

LAST_PORT = 65535
"""Largest number of a port of TCP."""


def lab(
    host: Annotated[
        str | None,
        typer.Option(help="Serve the page at this address; 0.0.0.0 lets other devices in."),
    ] = None,
    port: Annotated[int, number_option(int, "Port to serve it at; 0 for a free one.")] = 8421,
    out: Annotated[Path | None, typer.Option(help="Write the page into this file instead.")] = None,
    browser: Annotated[
        bool,
        typer.Option(show_default=False, help="Open the page in a browser; the default."),
    ] = True,
    force: Force = False,
) -> None:
    """Open a page in the browser on which anyone can launch the top and see why it turns over."""
    from tippetop.lab.serve import page_path, serve  # noqa: PLC0415 - slow to import

    if not 0 <= port <= LAST_PORT:
        raise InvalidInput("--port", port, f"a number at least 0 and at most {LAST_PORT}")
    if out is not None:
        _write(out, force)
    elif host is not None:
        serve(host, port, browser, announce=typer.echo)
    else:
        path = page_path()
        typer.echo(f"The laboratory is {path.as_uri()}")
        if browser:
            typer.launch(path.as_uri())


def _write(path: Path, force: bool) -> None:
    from tippetop.export.bundle import built  # noqa: PLC0415
    from tippetop.lab.serve import PAGE  # noqa: PLC0415
    from tippetop.support.files import require_ending, written_beside  # noqa: PLC0415

    require_ending("--out", path, (".html", ".htm"))
    with written_beside(path, force) as beside:
        beside.write_text(built(PAGE), encoding="utf-8")
    typer.echo(f"wrote {path}")
