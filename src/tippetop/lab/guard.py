"""What the laboratory's server lets in, and what it lets its pages do: theirs is one machine, this one.

A page of any other site may send requests here from a visitor's browser. Those that were asked for under a
name that is not this machine's, or by a page of another origin, are refused; those of the laboratory itself
are told to load nothing from elsewhere.
"""

import functools
import inspect
import ipaddress
import logging
import socket
from collections.abc import Awaitable, Callable, MutableMapping
from typing import Any
from urllib.parse import urlsplit

Message = MutableMapping[str, Any]
Send = Callable[[Message], Awaitable[None]]
Receive = Callable[[], Awaitable[Message]]
Application = Callable[[Message, Receive, Send], Awaitable[None]]

HEADERS = {
    # NiceGUI puts its pages together in the browser, from scripts in the page.
    "content-security-policy": "default-src 'self'; script-src 'self' 'unsafe-inline' 'unsafe-eval' blob:; "
    "style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; font-src 'self' data:; "
    "worker-src 'self' blob:; object-src 'none'; base-uri 'self'; form-action 'none'; frame-ancestors 'none'",
    "x-content-type-options": "nosniff",
    "referrer-policy": "same-origin",
}

_LOG = logging.getLogger(__name__)


class Guard:
    """An application in front of another, which lets through what this machine was asked by its own pages.

    Parameters
    ----------
    app
        The application behind.
    host
        The name or address at which it listens.
    """

    def __init__(self, app: Application, host: str) -> None:
        self.app = app
        self.names = {"localhost", host.lower(), socket.gethostname().lower()}

    async def __call__(self, scope: Message, receive: Receive, send: Send) -> None:
        """Answer a request, or hand it on; see ASGI."""
        if scope["type"] not in ("http", "websocket"):
            await self.app(scope, receive, send)
            return
        headers = {
            name.decode("latin-1").lower(): value.decode("latin-1") for name, value in scope["headers"]
        }
        lets_in = self._is_own(headers.get("host", "")) and _same_origin(headers)
        if scope["type"] == "websocket":
            if lets_in:
                await self.app(scope, receive, send)
            else:
                await send({"type": "websocket.close", "code": 1008})
            return

        async def send_with_headers(message: Message) -> None:
            if message["type"] == "http.response.start":
                added = [(name.encode(), value.encode()) for name, value in HEADERS.items()]
                message["headers"] = [*message.get("headers", []), *added]
            await send(message)

        if lets_in:
            await self.app(scope, receive, send_with_headers)
            return
        sentence = b"The laboratory answers only its own pages, under an address or the name of this machine."
        await send_with_headers(
            {"type": "http.response.start", "status": 403, "headers": [(b"content-type", b"text/plain")]}
        )
        await send({"type": "http.response.body", "body": sentence})

    def _is_own(self, host: str) -> bool:
        """Whether a request was for this machine: names of other sites may lead here, addresses do not."""
        try:
            name = urlsplit(f"//{host}").hostname or ""
        except ValueError:
            return False
        try:
            ipaddress.ip_address(name)
        except ValueError:
            return name in self.names
        return True


def _same_origin(headers: MutableMapping[str, str]) -> bool:
    """Whether a request comes from a page of the server it goes to, or from no page."""
    origin = headers.get("origin")
    if origin is None:
        return True
    try:
        return urlsplit(origin).netloc.lower() == headers.get("host", "").lower()
    except ValueError:
        return False


def log_malformed_once(
    handlers: MutableMapping[str, Callable[..., Any]], transport: logging.Logger | None = None
) -> None:
    """Have messages that no page sends dropped: each kind is logged once, in one line, without a traceback.

    Parameters
    ----------
    handlers
        What is done with messages, by their names; each is replaced.
    transport
        Where the errors are logged of what is not even a message.
    """
    seen: set[tuple[str, type[Exception]]] = set()

    def note(name: str, error: Exception) -> None:
        if (name, type(error)) not in seen:
            seen.add((name, type(error)))
            _LOG.warning("a malformed message %r is passed over (%s)", name, type(error).__name__)

    def guarded(name: str, handler: Callable[..., Any]) -> Callable[..., Any]:
        @functools.wraps(handler)
        async def handle(*arguments: Any) -> Any:
            try:
                result = handler(*arguments)
                return await result if inspect.isawaitable(result) else result
            except Exception as error:  # noqa: BLE001 - whatever a stranger's message makes of it
                note(name, error)
                return False

        return handle

    def pass_over(record: logging.LogRecord) -> bool:
        error = record.exc_info[1] if record.exc_info else None
        if not isinstance(error, Exception):
            return True
        note("?", error)
        return False

    if transport is not None:
        transport.addFilter(pass_over)
    for name, handler in list(handlers.items()):
        if name not in ("connect", "disconnect"):
            handlers[name] = guarded(name, handler)
