"""Progress of long work with the time left: in a terminal, and below the cell of a notebook."""

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from importlib import import_module
from typing import Any, TypeAlias

from tippetop.support.interrupts import reraise_interrupt

Tell: TypeAlias = Callable[..., None]
"""Function of the work done, the work in total and, if it changes, the text shown."""

NOTEBOOK_DELAY = 2.0
"""Time before a notebook shows progress, s: less would leave lines below cells that soon end."""

NOTEBOOK_INTERVAL = 0.5
"""Time between two lines of progress in a notebook, s: every line is a message to a browser."""


@contextmanager
def progress_bar(label: str = "") -> Iterator[Tell]:
    """Yield a callback that shows progress, remaining and elapsed time.

    It shows nothing where standard error is neither a terminal nor that of a notebook.
    """
    if is_notebook():
        yield _line_of_a_notebook(label)
    elif sys.stderr.isatty():
        with _bar_of_a_terminal(label) as tell:
            yield tell
    else:
        yield lambda *_: reraise_interrupt()


def is_notebook() -> bool:
    """Return whether the program runs in the kernel of a notebook."""
    shell = getattr(sys.modules.get("IPython"), "get_ipython", lambda: None)()
    return type(shell).__name__ == "ZMQInteractiveShell"


@contextmanager
def _bar_of_a_terminal(label: str) -> Iterator[Tell]:
    from rich.console import Console  # noqa: PLC0415 - slow to import
    from rich.markup import escape  # noqa: PLC0415
    from rich.progress import Progress, TimeElapsedColumn  # noqa: PLC0415

    columns = (*Progress.get_default_columns(), TimeElapsedColumn())
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task(escape(f"{label:<28}"), total=None)

        def tell(done: float, total: float, now: str = label) -> None:
            reraise_interrupt()
            bar.update(task, completed=done, total=total, description=escape(f"{now:<28}"))

        yield tell


def _line_of_a_notebook(label: str) -> Tell:
    """Return a callback that keeps one line below the cell of a notebook."""
    display: Any = import_module("IPython.display").display
    began = shown = time.monotonic()
    first: float | None = None
    handle = None

    def tell(done: float, total: float, now: str = label) -> None:
        nonlocal first, handle, shown
        reraise_interrupt()
        first = done if first is None else first
        at, is_done = time.monotonic(), done >= total
        if handle is None and (at - began < NOTEBOOK_DELAY or is_done):
            return
        if handle is not None and at - shown < NOTEBOOK_INTERVAL and not is_done:
            return
        line = {"text/plain": line_of(now, done, total, first, at - began)}
        shown = at
        if handle is None:
            handle = display(line, raw=True, display_id=True)
        else:
            handle.update(line, raw=True)

    return tell


def line_of(text: str, done: float, total: float, first: float, elapsed: float) -> str:
    """Return a line of progress; `first` was done before, and the rest since took `elapsed`, s."""
    head = f"{text.strip()}, " if text.strip() else ""
    if done >= total:
        return f"{head}100 %, {_duration(elapsed)}"
    remaining = elapsed * (total - done) / (done - first) if done > first else None
    ending = "" if remaining is None else f", {_duration(remaining)} left"
    return f"{head}{done / total:.0%}{ending}".replace("%", " %")


def _duration(seconds: float) -> str:
    """Return a duration in seconds, or minutes and hours."""
    if seconds < 100.0:
        return f"{seconds:.0f} s"
    minutes = round(seconds / 60.0)
    return f"{minutes} min" if minutes < 100 else f"{minutes // 60} h {minutes % 60} min"
