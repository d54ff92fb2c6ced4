"""Handling of Ctrl-C and other signals to end, and their delay while work must not be cut."""

import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import Future
from contextlib import contextmanager, suppress
from importlib import import_module
from types import FrameType
from typing import TypeVar

ENDINGS = [
    getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)
]
"""Signals that ask a program to end: Ctrl-C, that of the system, and that of a closed terminal."""
INTERRUPTED = 130
"""Exit code of a program that a signal ended."""
CHECK_INTERVAL = 0.1
"""Time between checks for signals while uninterruptible work runs, s: without such checks some
systems would not deliver Ctrl-C before the work ends; shorter intervals cost time."""

Made = TypeVar("Made")


def let_end(at_first: bool = False) -> None:
    """Let signals end the process at once with a line, without cleaning up: while nothing is to be
    undone.

    The handlers that do so replace Python's own with `at_first`, and without it those of
    `let_raise`. Signals that are ignored stay so.
    """
    replaced = (signal.SIG_DFL, signal.default_int_handler) if at_first else (_raise,)
    for number in ENDINGS:
        # Ignored signals stay ignored, as Ctrl-C is for programs in the background.
        if signal.getsignal(number) in replaced:
            signal.signal(number, _end)


def let_raise() -> None:
    """Let signals that would end the process raise a `KeyboardInterrupt` instead."""
    for number in ENDINGS:
        if signal.getsignal(number) is _end:
            signal.signal(number, _raise)


def _end(number: int, frame: FrameType | None) -> None:
    with suppress(OSError):
        os.write(2, b"tippetop: interrupted\n")
    os._exit(INTERRUPTED)


_raised: list[int] = []


def _raise(number: int, frame: FrameType | None) -> None:
    _raised.append(number)
    raise KeyboardInterrupt


def is_interrupted() -> bool:
    """Return whether a signal has raised a `KeyboardInterrupt`, which imports may have
    swallowed.
    """
    return bool(_raised)


@contextmanager
def deferred() -> Iterator[None]:
    """Delay signals to end until the block ends; only the main thread receives signals."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    arrived: list[int] = []

    def record(number: int, frame: FrameType | None) -> None:
        arrived.append(number)

    before = {number: signal.signal(number, record) for number in ENDINGS}
    try:
        yield
    finally:
        for number, handler in reversed(before.items()):  # Ctrl-C last: it may raise at once
            signal.signal(number, handler or signal.SIG_DFL)
        if arrived:
            signal.raise_signal(arrived[0])


def reraise_interrupt() -> None:
    """Raise `KeyboardInterrupt` again if a signal raised one that an import swallowed."""
    if is_interrupted():
        raise KeyboardInterrupt


def import_interruptibly(name: str) -> None:
    """Import a module completely even if Ctrl-C comes meanwhile, which is then raised
    afterwards.
    """
    if name not in sys.modules:
        run_interruptibly(lambda: import_module(name))


def run_interruptibly(work: Callable[[], Made]) -> Made:
    """Return the result of work that does not react to signals, such as compiled code.

    Another thread works while the main thread waits and receives signals. An interrupted wait does
    not end the work, and the interpreter does not exit before the work ends.
    """
    if threading.current_thread() is not threading.main_thread():
        return work()
    made: Future[Made] = Future()
    done = threading.Event()

    def do() -> None:
        try:
            made.set_result(work())
        except BaseException as error:  # noqa: BLE001 - handed over, not swallowed
            made.set_exception(error)
        finally:
            done.set()

    threading.Thread(target=do, name="tippetop compiler").start()
    # The thread is not joined: after an interrupted join Python 3.11 believes it has ended.
    while not done.wait(CHECK_INTERVAL):
        pass
    return made.result()
