"""Processes that tests start: they hear signals, and none outlives the test that starts it."""

import os
import signal
import subprocess
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from typing import Any

import psutil
import pytest

posix_only = pytest.mark.skipif(
    os.name == "nt", reason="Windows has no such signals, links, owners and scripts"
)
OF_SHELLS = [getattr(signal, name) for name in ("SIGINT", "SIGHUP") if hasattr(signal, name)]
"""Signals that a shell in the background, or nohup, has its processes ignore."""
RUN = "TIPPETOP_TEST_RUN"
"""The environment variable that marks all processes of one run of the tests."""
TEST = "PYTEST_CURRENT_TEST"
"""The environment variable in which pytest names the test that is running."""
LONGEST = 600.0
"""How long a process that should end may go on before it counts as one that hangs, s."""
PATIENCE = 10.0
"""How long processes may take to end after the tests, s."""


@contextmanager
def signals_heard() -> Iterator[None]:
    """Hear Ctrl-C and a closed terminal, though the shell that started the tests ignores them.

    A process that is started meanwhile hears them too: it inherits only what is ignored.
    """
    handlers = {number: signal.getsignal(number) for number in OF_SHELLS}
    for number in OF_SHELLS:
        is_ctrl_c = number == signal.SIGINT
        signal.signal(number, signal.default_int_handler if is_ctrl_c else signal.SIG_DFL)
    try:
        yield
    finally:
        for number, handler in handlers.items():
            signal.signal(number, handler)


@contextmanager
def started(command: Sequence[Any], **options: Any) -> Iterator[subprocess.Popen[Any]]:
    """Start a process that hears signals, in a session of its own, and kill the session at the end.

    The options are those of `Popen`; both outputs are pipes of text unless they say otherwise.
    """
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
    with (
        signals_heard(),
        subprocess.Popen(command, start_new_session=True, **(pipes | options)) as process,
    ):
        try:
            yield process
        finally:
            _kill_session(process.pid)


def _kill_session(leader: int) -> None:
    """Kill a process and what it has started: on Windows, which has no sessions, its children."""
    with suppress(ProcessLookupError, psutil.Error):
        if hasattr(os, "killpg"):
            os.killpg(leader, signal.SIGKILL)
            return
        for process in (*psutil.Process(leader).children(recursive=True), psutil.Process(leader)):
            process.kill()


def ended(process: subprocess.Popen[Any]) -> tuple[Any, Any, int]:
    """Wait until a process ends, and return both its outputs and its exit code."""
    out, said = process.communicate(timeout=LONGEST)
    return out, said, process.returncode


def end_leftovers(run: str) -> list[str]:
    """End what the tests of a run left running, and return the test and the command of each."""
    ours = {psutil.Process(), *psutil.Process().parents()}
    trackers = [
        child for child in psutil.Process().children() if "resource_tracker" in _command(child)
    ]
    marked = [
        process
        for process in psutil.process_iter()
        if process not in ours and process not in trackers and _variable(process, RUN) == run
    ]
    left = [
        (process, f"{_variable(process, TEST)}: {_command(process)[:200]}")
        for process in psutil.wait_procs(marked, timeout=PATIENCE)[1]
    ]
    for process, _ in left:
        with suppress(psutil.Error):
            process.kill()
    return [description for _, description in left]


def _variable(process: psutil.Process, name: str) -> str | None:
    with suppress(psutil.Error):
        return process.environ().get(name)
    return None


def _command(process: psutil.Process) -> str:
    with suppress(psutil.Error):
        return " ".join(process.cmdline())
    return ""
