"""Launches per second of the sweep's engine and of others, at the same measured error, in one run.

Every contender follows launches for 20 s on all processors at once, one process each: the report's
top at spins where it turns over and stays on the table. The error of each is that of its final
tilts against runs exact to rounding, the largest over the launches; a contender is timed at the
loosest of its tolerances whose error is below the target. Processor time counts beside the clock,
as other programs may be running.
"""

import json
import os
import resource
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

import tippetop as tt
from benchmarks.contenders import CONTENDERS, DURATION, ENGINE, Array, engine, problem
from benchmarks.surroundings import PROCESSORS, markdown, rounded

SPINS = (130.0, 160.0)
TARGET = 1e-9
"""Largest error of the final tilt, rad."""

TOLERANCES = (1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12)
EXACT = 2.3e-16
CHECKED, CLOSE = 8, 1e-11
"""How many launches are held against single runs, and how close they must be, rad."""

FEW = 32
"""Launches on which tolerances are tried."""

WARM = 8
"""Launches that a process follows before the clock starts."""

QUICK = 8
"""A quick contest has this many times fewer launches."""


@dataclass(frozen=True)
class Figure:
    """What was measured of a contender.

    Attributes
    ----------
    name
        Who.
    tolerance, error
        The tolerance it was given, and the error that was measured, rad.
    launches
        How many launches it followed.
    rate
        Launches per second by the clock, on all processors.
    processor_ms
        Processor time of a launch, ms.
    memory
        Largest memory of a process, MiB.
    """

    name: str
    tolerance: float
    error: float
    launches: int
    rate: float
    processor_ms: float
    memory: float


def work(name: str, spins: Array, tolerance: float) -> None:
    """Follow launches in this process: a few to warm up, and, when told to, all of them by the
    clock.
    """
    method = CONTENDERS[name].method
    # A compiler that knows the number of launches, such as jax, needs that many to warm up.
    method(spins if "vmap" in name else spins[:WARM], tolerance)
    print("ready", flush=True)
    sys.stdin.readline()
    clock, used = time.perf_counter(), _processor_time()
    found = method(spins, tolerance)
    figures = {
        "clock": time.perf_counter() - clock,
        "used": _processor_time() - used,
        "found": found.tolist(),
        "memory": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024,
    }
    print(json.dumps(figures))


def _processor_time() -> float:
    """Processor time of this process and those it waited for, s."""
    times = os.times()
    return times.user + times.system + times.children_user + times.children_system


def race(name: str, spins: Array, tolerance: float, truth: Array) -> Figure:
    """Let a contender follow launches on all processors at once."""
    running = []
    for k in range(PROCESSORS):
        job = json.dumps([name, spins[k::PROCESSORS].tolist(), tolerance])
        command = [sys.executable, "-m", "benchmarks.bench_sweep"]
        pipes: dict[str, Any] = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True}
        process = subprocess.Popen(command, env=_environment(), **pipes)
        assert process.stdin is not None
        process.stdin.write(job + "\n")
        process.stdin.flush()
        running.append(process)
    for process in running:
        assert process.stdout is not None
        if process.stdout.readline() != "ready\n":
            raise SystemExit(f"{name} failed")
    found = []
    for process in running:
        assert process.stdin is not None
        process.stdin.write("go\n")
        process.stdin.flush()
    for process in running:
        said, _ = process.communicate()
        found.append(json.loads(said))
    errors = [
        np.abs(np.array(one["found"]) - truth[k::PROCESSORS]).max() for k, one in enumerate(found)
    ]
    return Figure(
        name,
        tolerance,
        float(max(errors)),
        len(spins),
        len(spins) / max(one["clock"] for one in found),
        1e3 * sum(one["used"] for one in found) / len(spins),
        max(one["memory"] for one in found),
    )


def _environment() -> dict[str, str]:
    """One thread a process."""
    limits = dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"), "1")
    xla = {"XLA_FLAGS": "--xla_cpu_multi_thread_eigen=false intra_op_parallelism_threads=1"}
    root = str(Path(__file__).resolve().parent.parent)
    paths = os.pathsep.join(filter(None, (root, os.environ.get("PYTHONPATH"))))
    return {**os.environ, **limits, **xla, "PYTHONPATH": paths}


def exact(spins: Array) -> Array:
    """Final tilts to rounding, by the engine; some of them are held against single runs.

    Raises
    ------
    SystemExit
        If the two differ, so that there is no truth to measure errors by.
    """
    tilts = engine(spins, EXACT)
    for k in np.linspace(0, len(spins) - 1, CHECKED).astype(int):
        run = tt.simulate(problem().replace({"launch.spin": spins[k]}), DURATION, samples=2)
        if abs(tilts[k] - float(run["tilt"][-1])) > CLOSE:
            raise SystemExit(f"the engine and a single run differ at {spins[k]:g} rad/s")
    return tilts


def measure(quick: bool, say: Callable[[str], None]) -> dict[str, Any]:
    """Every contender at the loosest tolerance whose error is below the target."""
    figures, absent = [], []
    for name, contender in CONTENDERS.items():
        if not contender.here:
            absent.append(name)
            continue
        share = max(1, contender.share // (QUICK if quick else 1))
        spins = np.linspace(*SPINS, share * PROCESSORS)
        few = spins[:: max(1, len(spins) // FEW)]
        few = few[: len(few) - len(few) % PROCESSORS]
        figure, truth, truth_few = None, exact(spins), exact(few)
        for tolerance in TOLERANCES:
            tried = race(name, few, tolerance, truth_few)
            say(f"{name}: tolerance {tolerance:.0e}, error {tried.error:.1e} rad")
            if tried.error <= TARGET:
                figure = race(name, spins, tolerance, truth)
                say(f"{name}: {rounded(figure.rate)} launches/s, error {figure.error:.1e} rad")
                if figure.error <= TARGET:
                    break
        if figure is None or figure.error > TARGET:
            raise SystemExit(f"{name} does not reach an error of {TARGET:g} rad")
        figures.append(figure)
    return {
        "target_error": TARGET,
        "contenders": [asdict(figure) for figure in figures],
        "absent": absent,
    }


def tables(found: dict[str, Any]) -> str:
    """The figures for people, in Markdown."""
    figures = [Figure(**one) for one in found["contenders"]]
    ours = next(figure for figure in figures if figure.name == ENGINE)
    heads = ["", "tolerance", "error, rad", f"launches/s on {PROCESSORS} processors"]
    heads += ["processor, ms a launch", "engine's rate over its", "memory of a process, MiB"]
    rows = [
        [
            figure.name,
            f"{figure.tolerance:.0e}",
            f"{figure.error:.1e}",
            rounded(figure.rate),
            rounded(figure.processor_ms),
            rounded(ours.rate / figure.rate),
            f"{figure.memory:,.0f}",
        ]
        for figure in figures
    ]
    absent = "".join(f"\nNot installed, left out: {name}." for name in found["absent"])
    return markdown(heads, rows) + absent


if __name__ == "__main__":
    chosen_name, given, chosen_tolerance = json.loads(sys.stdin.readline())
    work(chosen_name, np.array(given), chosen_tolerance)
