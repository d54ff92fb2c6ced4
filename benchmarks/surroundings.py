"""Where the measurements are made: the machine, new processes of Python, and their memory."""

import importlib.metadata
import os
import platform
import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from typing import Any

import psutil

COMMAND_LINE = "-m", "tippetop"
"""Given to `python`, this is `tippetop`."""

IMPORTS, USUAL = "import numpy, xarray", 0.4
"""By how long this takes in a new process, machines are compared; and that, s, for which times are
wanted.
"""

PROCESSORS = (
    len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
)
"""How many processors may be used."""

_LIBRARIES = ("heyoka", "numpy", "scipy", "diffrax", "jax", "zarr")


def machine() -> dict[str, Any]:
    """What the figures were measured on."""
    versions = {}
    for name in _LIBRARIES:
        try:
            versions[name] = importlib.metadata.version(name)
        except importlib.metadata.PackageNotFoundError:
            continue
    return {
        "python": platform.python_version(),
        "libraries": versions,
        "processor": platform.processor() or platform.machine(),
        "processors": PROCESSORS,
        "load": os.getloadavg()[0] if hasattr(os, "getloadavg") else None,
    }


def seconds(action: Callable[[], Any]) -> float:
    """How long an action takes, s."""
    begin = time.perf_counter()
    action()
    return time.perf_counter() - begin


def new_process(*arguments: str) -> Callable[[], None]:
    """An action that runs Python in a new process, which must succeed."""

    def run() -> None:
        subprocess.run([sys.executable, *arguments], check=True, stdout=subprocess.DEVNULL)

    return run


def slowness(rounds: int = 5) -> float:
    """How many times as long as usual this machine takes at present."""
    imports = new_process("-c", IMPORTS)
    imports()  # reads from the disk
    return statistics.median(seconds(imports) for _ in range(rounds)) / USUAL


def memory_of(process: psutil.Process) -> int:
    """Memory of a process and its children, each shared page counted in parts, bytes."""
    total = 0
    for one in (process, *process.children(recursive=True)):
        try:
            full = one.memory_full_info()
            total += getattr(full, "pss", full.uss)
        except psutil.Error:  # it has just ended
            continue
    return total


def rounded(value: float) -> str:
    """A number to three digits, without a power of ten."""
    return f"{float(f'{value:.3g}'):,g}"


def markdown(heads: list[str], rows: list[list[str]]) -> str:
    """A table in Markdown; all columns but the first are numbers."""
    rule = ["---", *("---:" for _ in heads[1:])]
    return "\n".join("| " + " | ".join(cells) + " |" for cells in (heads, rule, *rows))
