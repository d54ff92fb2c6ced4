"""Ctrl-C at the command line: one line, the exit code of shells, no half-written file, and no
waiting.
"""

import os
import random
import signal
import sys
import time

import pytest

from campaigns import among, seeds
from children import ended, posix_only, started

SAID = "tippetop: interrupted\n"
MAIN = "from tippetop.cli.main import main; print('begun', flush=True); main()"


@posix_only
@pytest.mark.parametrize("moment", seeds(check=1, sample=4, claim=50))
@pytest.mark.parametrize(
    ("arguments", "longest"),
    [
        ("simulate --duration 1e5 --integrator rk4 --step 1e-5 --out run.nc --csv run.csv", 3.0),
        pytest.param("reproduce --quick --out report", 5.0, marks=pytest.mark.slow),
    ],
    ids=["simulate", "reproduce"],
)
def test_interrupted_command_says_so_and_leaves_nothing(tmp_path, arguments, longest, moment):
    """Whenever it is: while modules are imported, while processes start, and while they work."""
    wait = random.Random(f"{arguments}{moment}").uniform(0.0, longest)
    with started([sys.executable, "-c", MAIN, *arguments.split()], cwd=tmp_path) as process:
        assert process.stdout.readline() == "begun\n"
        time.sleep(wait)
        os.killpg(process.pid, signal.SIGINT)
        assert ended(process) == ("", SAID, 130), f"after {wait} s"
    assert list(tmp_path.rglob("*")) == []


MASKED = """
import os, signal, sys
from importlib import abc

class Finder(abc.MetaPathFinder):
    def find_spec(self, name, *_):
        if name == "tippetop.run":
            try:
                os.kill(os.getpid(), signal.SIGINT)
            except KeyboardInterrupt:
                if {lost}:
                    return
                raise ImportError("initialization failed") from None

sys.meta_path.insert(0, Finder())
"""
"""An import that makes another error of Ctrl-C, or none, as those of some extensions do."""


@posix_only
@pytest.mark.parametrize("lost", among([False, True], check=1))
def test_ctrl_c_of_which_an_import_makes_something_else_is_still_ctrl_c(tmp_path, lost):
    program = MASKED.format(lost=lost) + MAIN
    command = [sys.executable, "-c", program, "simulate", "--out", "run.nc"]
    with started(command, cwd=tmp_path) as process:
        assert ended(process) == ("begun\n", SAID, 130)
    assert list(tmp_path.iterdir()) == []


DEAF = """
import hashlib, os
import {module}

def compiler(*_, **__):
    print("begun", flush=True)
    while not os.path.exists("enough"):
        hashlib.pbkdf2_hmac("sha256", b"", b"", 1_000_000)
    print("done", flush=True)

{module}.{name} = compiler
"""
"""A compiler that hears nothing, and has not done before there is a file."""


@posix_only
def test_a_compiler_does_not_keep_ctrl_c_waiting(tmp_path):
    program = DEAF.format(module="llvmlite.binding", name="parse_assembly") + MAIN
    command = [sys.executable, "-c", program, "simulate"]
    environment = {**os.environ, "TIPPETOP_CACHE": str(tmp_path / "cache")}
    with started(command, cwd=tmp_path, env=environment) as process:
        assert [process.stdout.readline() for _ in range(2)] == ["begun\n"] * 2
        os.killpg(process.pid, signal.SIGINT)
        assert ended(process) == ("", SAID, 130)
