"""`tippetop lab`: the laboratory in the browser."""

from typing import Annotated

import typer


def lab(
    host: Annotated[str, typer.Option(help="Address to listen at; 0.0.0.0 lets others in.")] = "127.0.0.1",
    port: Annotated[int, typer.Option(min=1, max=65535, help="Port to listen at.")] = 8421,
    browser: Annotated[
        bool, typer.Option(show_default=False, help="Open the page in a browser; opened if left out.")
    ] = True,
    workers: Annotated[
        int | None, typer.Option(min=1, help="Processes that simulate; as many as there are cores to spare.")
    ] = None,
) -> None:
    """Open a page in the browser where anyone can launch the top and see why it turns over."""
    from tippetop.lab.server import serve  # noqa: PLC0415 - slow to import

    serve(host, port, browser, workers, announce=typer.echo)
