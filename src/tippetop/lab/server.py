"""The laboratory's server: the page, the runs it asks for, and the files of a run."""

import errno
import socket
from collections.abc import Callable
from typing import Any

from tippetop.errors import TippetopError, Unavailable
from tippetop.lab.guard import OwnPagesOnly, log_malformed_once
from tippetop.lab.setup import Setup, read_query
from tippetop.lab.turns import Turns
from tippetop.lab.workers import Workers

TRACK_PATH = "/lab/track"
FILE_PATH = "/lab/file"
FAREWELL = 3
"""How long the end of the server waits for answers under way, s."""

_TYPES = {
    "nc": "application/x-netcdf",
    "csv": "text/csv; charset=utf-8",
    "toml": "application/toml; charset=utf-8",
    "glb": "model/gltf-binary",
    "html": "text/html; charset=utf-8",
}


def serve(
    host: str = "127.0.0.1",
    port: int = 8421,
    browser: bool = True,
    workers: int | None = None,
    announce: Callable[[str], None] = print,
) -> None:
    """Serve the laboratory until interrupted.

    Parameters
    ----------
    host, port
        Where to listen.
    browser
        Whether to open the page in a browser.
    workers
        How many processes simulate; None for as many as the machine has to spare.
    announce
        Is told the address, in a sentence.

    Raises
    ------
    Unavailable
        If NiceGUI is not installed, or the port is taken.
    """
    try:
        from nicegui import app, core, ui  # noqa: PLC0415 - optional
    except ImportError:
        raise Unavailable("the laboratory needs NiceGUI: pip install 'tippetop[lab]'") from None
    from tippetop.lab.page import register_page  # noqa: PLC0415 - needs NiceGUI

    _check_free(host, port)
    pool = Workers(workers)
    _add_routes(app, pool)
    app.add_middleware(OwnPagesOnly, host=host)
    log_malformed_once(core.sio.handlers["/"], core.sio.eio.logger)
    register_page(pool, TRACK_PATH, FILE_PATH)
    app.on_startup(lambda: announce(f"the laboratory is at http://{_shown(host)}:{port}/ (Ctrl-C ends it)"))
    try:
        ui.run(
            host=host,
            port=port,
            title="Tippe top laboratory",
            favicon="🍄",
            dark=None,
            show=browser,
            reload=False,
            tailwind=False,
            show_welcome_message=False,
            message_history_length=100,
            timeout_graceful_shutdown=FAREWELL,
        )
    finally:
        pool.close()


def _check_free(host: str, port: int) -> None:
    try:
        family = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[0][0]
    except OSError as error:
        raise Unavailable(f"{host} is no address to listen at: {error.strerror}") from None
    with socket.socket(family, socket.SOCK_STREAM) as trial:
        trial.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            trial.bind((host, port))
        except OSError as error:
            if error.errno == errno.EADDRNOTAVAIL:
                raise Unavailable(f"{host} is no address of this machine; choose another") from None
            raise Unavailable(
                f"port {port} of {host} cannot be listened at ({error.strerror}); choose another"
            ) from None


def _shown(host: str) -> str:
    return f"[{host}]" if ":" in host else host


def _add_routes(app: Any, pool: Workers) -> None:
    """The runs and files by the launch in their address; nothing is kept between one request and the next."""
    from fastapi import Request, Response  # noqa: PLC0415 - comes with NiceGUI
    from nicegui.server import Server  # noqa: PLC0415

    # Files take longer, and have their own worker: pictures do not wait for them.
    runs, files = Turns(pool.count), Turns(1)

    async def answer(
        request: Request, turns: Turns, work: Callable[[Setup], bytes], kind: str, name: str | None = None
    ) -> Response:
        async def wanted() -> None:
            if Server.instance.should_exit:
                raise Unavailable("the laboratory is being closed")
            if await request.is_disconnected():
                raise Unavailable("nobody waits for this any more")

        visitor = request.client.host if request.client else ""
        try:
            setup = read_query(request.query_params)
            content = await turns.take(visitor, lambda: work(setup), wanted)
        except TippetopError as error:
            status = 503 if isinstance(error, Unavailable) else 422
            return Response(str(error), status_code=status, media_type="text/plain")
        # Numbers hardly compress; saying that they are as they are keeps them from being tried.
        headers = {"Cache-Control": "no-store", "Content-Encoding": "identity"}
        if name is not None:
            headers["Content-Disposition"] = f'attachment; filename="{name}"'
        return Response(content, media_type=kind, headers=headers)

    async def track(request: Request) -> Response:
        return await answer(request, runs, pool.track, "application/octet-stream")

    async def file(kind: str, request: Request) -> Response:
        media = _TYPES.get(kind, "text/plain")
        return await answer(request, files, lambda setup: pool.file(setup, kind), media, f"tippetop.{kind}")

    app.add_api_route(TRACK_PATH, track, methods=["GET"], response_model=None)
    app.add_api_route(FILE_PATH + "/tippetop.{kind}", file, methods=["GET"], response_model=None)
