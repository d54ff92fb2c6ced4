"""Progress of sweeps: in terminals and notebooks, and nowhere else."""

import os
import re
import signal
import subprocess
import sys
import time

import pytest

import tippetop as tt
from children import posix_only, signals_heard
from tippetop.support import progress_bar

SWEEP = """
import sys, time
import tippetop as tt
def one(now):
    time.sleep(0.02)
if __name__ == "__main__":
    print("begun", flush=True)
    for options in %s:
        tt.sweep(
            tt.presets.report_problem(), {"launch.spin": {"from": 50, "to": 150, "count": %d}},
            duration=%g, workers=1, **options,
        )
        print("done", flush=True)
"""
"""Sweeps with some options, one after another."""


def in_a_terminal(program, interrupt_after=None):
    """What a program writes to a terminal, and its exit code."""
    import pty  # noqa: PLC0415 - POSIX only

    parent, child = pty.openpty()
    command = [sys.executable, "-c", program]
    with signals_heard():
        process = subprocess.Popen(
            command, stdin=child, stdout=child, stderr=child, start_new_session=True
        )
    os.close(child)
    text, interrupted = b"", interrupt_after is None
    while True:
        try:
            part = os.read(parent, 65536)
        except OSError:  # the end of a terminal
            break
        if not part:
            break
        text += part
        if not interrupted and interrupt_after in text:
            interrupted = True
            time.sleep(0.1)
            os.killpg(process.pid, signal.SIGINT)
    os.close(parent)
    return text.decode(), process.wait(timeout=60)


@posix_only
def test_a_terminal_shows_progress_unless_it_is_not_wanted():
    options = "{'progress': False}, {'callback': one}, {}"
    shown, code = in_a_terminal(SWEEP % (options, 3, 1.0))
    assert code == 0
    begun, silent, alone, bar, end = re.split("begun|done", shown)
    assert (begun, silent.strip(), alone.strip(), end.strip()) == ("", "", "", "")
    assert "of 3" in bar
    assert "%" in bar


@posix_only
def test_ctrl_c_ends_a_sweep_that_shows_progress():
    shown, code = in_a_terminal(SWEEP % ("[{}]", 100000, 20.0), b"of 100,000")
    assert code in (-signal.SIGINT, 130)
    assert "KeyboardInterrupt" in shown
    assert "done\r\n" not in shown
    assert "\x1b[?25h" in shown, "the cursor is shown again"


def test_a_pipe_gets_no_progress(capfd):
    tt.sweep(tt.presets.report_problem(), {"launch.spin": [50.0, 150.0]}, duration=1.0, workers=1)
    assert capfd.readouterr() == ("", "")


class Handle:
    """A line below the cell of a notebook."""

    lines: list[str]

    def update(self, line, raw):
        self.lines.append(line["text/plain"])


def test_a_notebook_keeps_one_line_with_the_time_left(monkeypatch):
    ipython = pytest.importorskip("IPython")
    shell = type("ZMQInteractiveShell", (), {})()
    monkeypatch.setattr(ipython, "get_ipython", lambda: shell)
    handle, clock = Handle(), [0.0]
    handle.lines = []

    def display(line, raw, display_id):
        handle.update(line, raw)
        return handle

    monkeypatch.setattr("IPython.display.display", display)
    monkeypatch.setattr(progress_bar.time, "monotonic", lambda: clock[0])
    with progress_bar.progress_bar() as tell:
        for second in range(9):
            clock[0] = float(second)
            tell(20 + 10 * second, 100, f"{20 + 10 * second} of 100")
    # 20 were there before; from then on ten a second.
    assert handle.lines[0] == "40 of 100, 40 %, 6 s left"
    assert handle.lines[-1] == "100 of 100, 100 %, 8 s"
    assert len(handle.lines) == 7


@pytest.mark.parametrize(
    ("seconds", "expected"), [(12.4, "12 s"), (600.0, "10 min"), (7300.0, "2 h 2 min")]
)
def test_times_left_are_in_a_unit_that_suits_them(seconds, expected):
    line = progress_bar.line_of("", 1, 2, 0, seconds)
    assert line == f"50 %, {expected} left"
