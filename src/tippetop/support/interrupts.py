"""Ctrl-C and its like, which wait while something must not be cut short."""

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
"""The signals that ask a program to end: Ctrl-C, the system's, and that of a terminal that is
closed.
"""
INTERRUPTED = 130
"""Exit code of a program that they ended."""
GLANCE = 0.1
"""How often one who waits for deaf work listens where a system does not wake those who wait, s."""

Made = TypeVar("Made")


def let_end(at_first: bool = False) -> None:
    """Let signals to end do so at once, with a word: for where nothing is begun that would have to
    be undone.

    Later than `at_first` it undoes `let_raise`.
    """
    replaced = (signal.SIG_DFL, signal.default_int_handler) if at_first else (_raise,)
    for number in ENDINGS:
        # What is not heard at all, as Ctrl-C by programs in the background, stays so.
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


def asked_to_end() -> bool:
    """Whether a signal has raised a `KeyboardInterrupt`; imports may have made another error of
    it.
    """
    return bool(_raised)


@contextmanager
def deferred() -> Iterator[None]:
    """Let signals to end wait until the block ends; they come to the main thread alone."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    arrived: list[int] = []

    def note(number: int, frame: FrameType | None) -> None:
        arrived.append(number)

    before = {number: signal.signal(number, note) for number in ENDINGS}
    try:
        yield
    finally:
        for number, handler in reversed(before.items()):  # Ctrl-C last: it may raise at once
            signal.signal(number, handler or signal.SIG_DFL)
        if arrived:
            signal.raise_signal(arrived[0])


def hear() -> None:
    """Raise again the `KeyboardInterrupt` of a signal that was lost, as some imports swallow it."""
    if asked_to_end():
        raise KeyboardInterrupt


def import_heard(name: str) -> None:
    """Import a module, if it is not, of which an interrupted import would leave pieces and another
    error.
    """
    if name not in sys.modules:
        heard(lambda: import_module(name))


def heard(work: Callable[[], Made]) -> Made:
    """What comes of work that is deaf to signals, as a compiler is; they are heard meanwhile.

    The main thread waits while another one works. Where it is interrupted the work still goes to
    its end, and the interpreter does not end before.
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
    # Not by joining it: Python 3.11 takes a thread for ended if that is interrupted.
    while not done.wait(GLANCE):
        pass
    return made.result()
