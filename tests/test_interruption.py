"""Ctrl-C at the command line: one line, the exit code of shells, and no half-written file.

TIPPETOP_INTERRUPTS=50 asks for as many random moments instead of the few that every check takes.
"""

import os
import random
import signal
import subprocess
import sys
import time

import pytest

SAID = "tippetop: interrupted\n"
MOMENTS = int(os.environ.get("TIPPETOP_INTERRUPTS", "2"))
MAIN = "from tippetop.cli.main import main; print('begun', flush=True); main()"


@pytest.mark.parametrize("moment", range(MOMENTS))
@pytest.mark.parametrize(
    ("arguments", "longest"),
    [
        ("simulate --duration 1e5 --integrator rk4 --step 1e-5 --out run.nc --csv run.csv", 3.0),
        ("reproduce --quick --out report", 5.0),
    ],
    ids=["simulate", "reproduce"],
)
def test_interrupted_command_says_so_and_leaves_nothing(tmp_path, arguments, longest, moment):
    """Whenever it is: while modules are imported, while processes start, and while they work."""
    wait = random.Random(f"{arguments}{moment}").uniform(0.0, longest)
    process = subprocess.Popen(
        [sys.executable, "-c", MAIN, *arguments.split()],
        cwd=tmp_path,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    assert process.stdout is not None
    assert process.stdout.readline() == "begun\n"
    time.sleep(wait)
    os.killpg(process.pid, signal.SIGINT)
    out, said = process.communicate(timeout=60)
    assert (out, said, process.returncode) == ("", SAID, 130), f"after {wait} s"
    assert list(tmp_path.rglob("*")) == []
