"""What a sweep costs: by grid size, by workers, by flights, and in memory.

Spin from 0 to 250 rad/s and friction from 0.05 to 1 s/m, 20 s each, by the command line, as the
maps in the documentation. Memory is the largest of all processes of the sweep together, looked at
twice a second.
"""

import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
import psutil

from benchmarks.surroundings import COMMAND_LINE, PROCESSORS, markdown, memory_of, rounded
from tippetop.problem.presets import report_problem
from tippetop.sweeps import Axis, Product, Sweep
from tippetop.sweeps.ensemble import follow_cells

DURATION = 20.0
QUICK_SIDES, SIDES, WHOLE = (30, 60), (30, 100, 300), 1000
"""Cells along each axis; the whole maps are done on all processors only."""


@dataclass(frozen=True)
class Cost:
    """What a sweep took.

    Attributes
    ----------
    liftoff
        What was done where the table would have to pull.
    side, workers
        Cells along each of the two axes, and processes.
    clock, used
        Time by the clock and of all processors, s.
    memory
        Largest memory of all processes together, MiB.
    flights
        How many flights there were.
    """

    liftoff: str
    side: int
    workers: int
    clock: float
    used: float
    memory: float
    flights: int


def sweep_by_command(liftoff: str, side: int, workers: int) -> Cost:
    """Carry out a sweep by the command line, and watch it."""
    with tempfile.TemporaryDirectory() as folder:
        axes = ["--over", f"launch.spin=0:250:{side}", "--over", f"friction.mu=0.05:1:{side}"]
        limits = ["--duration", str(DURATION), "--liftoff", liftoff, "--workers", str(workers)]
        call = [sys.executable, *COMMAND_LINE, "sweep", *axes, *limits]
        call += ["--out", f"{folder}/sweep.zarr", "--json", "--no-maps"]
        before, began, peak = os.times(), time.perf_counter(), 0
        process = subprocess.Popen(call, stdout=subprocess.PIPE, text=True)
        watched = psutil.Process(process.pid)
        while process.poll() is None:
            peak = max(peak, memory_of(watched))
            time.sleep(0.5)
        clock, after = time.perf_counter() - began, os.times()
        said: dict[str, Any] = json.loads(process.stdout.read() if process.stdout else "{}")
    used = (
        after.children_user - before.children_user + after.children_system - before.children_system
    )
    return Cost(liftoff, side, workers, clock, used, peak / 2**20, said["flights"])


def cost_of_a_flight(cells: int) -> tuple[float, float]:
    """Processor time that a flight adds to a launch, ms, and flights a launch made.

    The same launches are followed over the time in which none lifts off, which gives the cost of a
    step; what is left of the whole run is the cost of the flights.
    """
    problem = report_problem(spin=200.0)
    axis = Axis.of("launch.spin", {"from": 190.0, "to": 210.0, "count": cells})
    whole = Sweep(problem, Product((axis,)), DURATION)
    calm = Sweep(problem, Product((axis,)), 5.0)
    numbers = np.arange(cells)
    follow_cells(whole, numbers[:16])
    times, found = [], []
    for sweep in (calm, whole):
        began = time.process_time()
        found.append(follow_cells(sweep, numbers))
        times.append(time.process_time() - began)
    if found[0]["flights"].any():
        raise SystemExit("some of the calm launches fly: the cost of a step cannot be told")
    step = times[0] / found[0]["steps"].sum()
    flights = found[1]["flights"].sum()
    return (
        1e3 * float((times[1] - step * found[1]["steps"].sum()) / flights),
        float(flights) / cells,
    )


def measure(quick: bool, whole: bool, say: Callable[[str], None]) -> dict[str, Any]:
    """All costs; with those of the whole maps, a million launches each, if asked for."""
    flight, number = cost_of_a_flight(512 if quick else 2048)
    plans = [
        (side, workers) for side in (QUICK_SIDES if quick else SIDES) for workers in {1, PROCESSORS}
    ]
    plans += [(WHOLE, PROCESSORS)] if whole else []
    costs = []
    for liftoff in ("stop", "fly"):
        for side, workers in plans:
            costs.append(sweep_by_command(liftoff, side, workers))
            say(f"{liftoff}, {side} x {side} on {workers}: {costs[-1].clock:.3g} s")
    most = [cost for cost in costs if cost.liftoff == "fly" and cost.workers == PROCESSORS]
    least, largest = most[0], most[-1]
    a_cell = (largest.memory - least.memory) * 2**20 / (largest.side**2 - least.side**2)
    return {
        "flight_ms": flight,
        "flights_a_launch": number,
        "bytes_a_cell": a_cell,
        "costs": [asdict(cost) for cost in costs],
    }


def tables(found: dict[str, Any]) -> str:
    """The figures for people, in Markdown."""
    heads = ["cells", "where the table would pull", "workers", "clock, s", "processors, s"]
    heads += ["launches/s", "memory in all, MiB", "flights"]
    rows = [
        [
            f"{cost.side}×{cost.side}",
            cost.liftoff,
            f"{cost.workers}",
            rounded(cost.clock),
            rounded(cost.used),
            rounded(cost.side**2 / cost.clock),
            f"{cost.memory:,.0f}",
            f"{cost.flights:,}",
        ]
        for cost in (Cost(**one) for one in found["costs"])
    ]
    return (
        f"{markdown(heads, rows)}\n\nA flight adds {1e3 * found['flight_ms']:.3g} microseconds of a"
        f" processor to a launch (measured on launches of {found['flights_a_launch']:.3g} flights),"
        f" a cell {found['bytes_a_cell']:.3g} bytes."
    )
