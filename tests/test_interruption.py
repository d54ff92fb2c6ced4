"""Ctrl-C at the command line: one line, the exit code of shells, and no half-written file."""

import os
import signal
import subprocess
import sys
import time

import pytest

SAID = "tippetop: interrupted\n"


@pytest.mark.parametrize("wait", [1.0, 4.0], ids=["soon", "later"])
@pytest.mark.parametrize(
    "arguments",
    [
        "simulate --duration 1e5 --integrator rk4 --step 1e-5 --out run.nc --csv run.csv",
        "reproduce --quick --out report",
    ],
    ids=["simulate", "reproduce"],
)
def test_interrupted_command_says_so_and_leaves_nothing(tmp_path, arguments, wait):
    process = subprocess.Popen(
        [sys.executable, "-c", "from tippetop.cli.main import main; main()", *arguments.split()],
        cwd=tmp_path,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    time.sleep(wait)
    os.killpg(process.pid, signal.SIGINT)
    out, said = process.communicate(timeout=60)
    assert (out, said, process.returncode) == ("", SAID, 130)
    assert list(tmp_path.rglob("*")) == []
