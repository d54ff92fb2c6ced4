"""Server of the laboratory's page for other devices: one file over HTTP, read-only."""

import socket
import webbrowser
from collections.abc import Callable
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from importlib.util import find_spec
from io import BytesIO, StringIO
from pathlib import Path

from tippetop.export.bundle import BUILT, built
from tippetop.support.errors import InvalidInput

PAGE = "lab.html"

ALL_INTERFACES = ("0.0.0.0", "")
"""Addresses at which a server listens in all networks of this machine, by IPv4."""

PATIENCE = 10.0
"""Time within which a device must send its request, s."""


def page_path() -> Path:
    """Return the file of the page; raise `Unavailable` if it is not built."""
    built(PAGE)
    return BUILT / PAGE


class PageHandler(SimpleHTTPRequestHandler):
    """Handler of requests, which serves only the page."""

    timeout = PATIENCE
    server_version = "tippetop"
    sys_version = ""

    def send_head(self) -> BytesIO | None:
        """Send the headers of the page; return its content, or None for another path."""
        if self.path.partition("?")[0] not in ("/", f"/{PAGE}"):
            self.send_error(404)
            return None
        content = built(PAGE).encode()
        self.send_response(200)
        self.send_header("Content-Type", "text/html; charset=utf-8")
        self.send_header("Content-Length", str(len(content)))
        self.send_header("Cache-Control", "no-cache")
        self.send_header("X-Content-Type-Options", "nosniff")
        self.end_headers()
        return BytesIO(content)

    def log_message(self, format: str, *arguments: object) -> None:  # noqa: A002 - the library's name
        """Write no log."""


def serve(host: str, port: int, browser: bool, announce: Callable[[str], None]) -> None:
    """Serve the page until interrupted, at an address and a port; 0.0.0.0 lets other devices in.

    `browser` says whether to open the page on this machine. `announce` is called with the address,
    and with a code to scan. Raises `InvalidInput` if the address is not free, and `Unavailable` if
    the page is not built.
    """
    page_path()
    try:
        server = ThreadingHTTPServer((host, port), PageHandler)
    except (OSError, OverflowError) as error:
        raise InvalidInput(
            "host",
            f"{host}:{port}",
            "the address of a free port of this machine",
            f"cannot be served at ({error})",
            "choose another --port, or for --host an address of this machine, such as 127.0.0.1",
        ) from None
    name = _own_address() if host in ALL_INTERFACES else host
    address = f"http://{name}:{server.server_port}/"
    announce(f"The laboratory is at {address} until Ctrl+C.")
    if host != "127.0.0.1" and (code := qr_code(address)):
        announce(code)
    if browser:
        webbrowser.open(address)
    with server:
        try:
            server.serve_forever()
        except KeyboardInterrupt:
            announce("")


def qr_code(text: str) -> str:
    """Return a text as a QR code drawn in letters; "" if segno is not installed."""
    if find_spec("segno") is None:
        return ""
    import segno  # noqa: PLC0415 - optional

    drawing = StringIO()
    segno.make(text, micro=False).terminal(drawing, compact=True)
    return drawing.getvalue()


def _own_address() -> str:
    """Return the address of this machine in its network; nothing is sent to determine it."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as trial:
        try:
            trial.connect(("192.0.2.1", 9))
        except OSError:
            return "localhost"
        return str(trial.getsockname()[0])
