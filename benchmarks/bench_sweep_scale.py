"""What a sweep costs: by grid size, by workers, by flights, and in memory.

    python benchmarks/bench_sweep_scale.py [--quick] [--json FILE]

Spin from 0 to 250 rad/s and friction from 0.05 to 1 s/m, 20 s each, as the maps in the documentation. Memory
is the largest sum over all processes of the sweep, at half-second looks.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
import psutil

from tippetop.presets import report_problem
from tippetop.sweep import Axis, Product, Sweep
from tippetop.sweep.ensemble import follow_cells
from tippetop.sweep.tasks import processors

COMMAND = "from tippetop.cli.sweep import sweep; import typer; typer.run(sweep)"
DURATION = 20.0


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


def command(liftoff: str, side: int, workers: int) -> Cost:
    """Carry out a sweep by the command line, and watch it."""
    with tempfile.TemporaryDirectory() as folder:
        options = {
            "--axis": [f"launch.spin=0:250:{side}", f"friction.mu=0.05:1:{side}"],
            "--duration": [str(DURATION)],
            "--liftoff": [liftoff],
            "--workers": [str(workers)],
            "--out": [f"{folder}/sweep.zarr"],
        }
        words = [word for name, values in options.items() for value in values for word in (name, value)]
        call = [sys.executable, "-c", COMMAND, *words, "--json", "--no-maps"]
        before, began, peak = os.times(), time.perf_counter(), 0
        process = subprocess.Popen(call, stdout=subprocess.PIPE, text=True)
        watched = psutil.Process(process.pid)
        while process.poll() is None:
            try:
                family = (watched, *watched.children(recursive=True))
                peak = max(peak, sum(one.memory_info().rss for one in family))
            except psutil.Error:
                pass
            time.sleep(0.5)
        clock, after = time.perf_counter() - began, os.times()
        said: dict[str, Any] = json.loads(process.stdout.read() if process.stdout else "{}")
    used = after.children_user - before.children_user + after.children_system - before.children_system
    return Cost(liftoff, side, workers, clock, used, peak / 2**20, said["flights"])


def cost_of_a_flight(cells: int) -> tuple[float, float]:
    """Processor time that a flight adds to a launch, ms, and flights a launch made.

    The same launches are followed over the time in which none lifts off, which gives the cost of a step; what
    is left of the whole run is the cost of the flights.
    """
    problem = report_problem(spin=200.0)
    axis = Axis.linear("launch.spin", 190.0, 210.0, cells)
    whole = Sweep(problem, Product((axis,)), DURATION)
    calm = Sweep(problem, Product((axis,)), 5.0)
    numbers = np.arange(cells)
    follow_cells(calm, numbers[:16])
    times, found = [], []
    for sweep in (calm, whole):
        began = time.process_time()
        found.append(follow_cells(sweep, numbers))
        times.append(time.process_time() - began)
    step = times[0] / found[0]["steps"].sum()
    flights = found[1]["flights"].sum()
    return 1e3 * float((times[1] - step * found[1]["steps"].sum()) / flights), float(flights) / cells


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--quick", action="store_true", help="small grids only")
    parser.add_argument("--json", type=Path, help="write the figures here")
    options = parser.parse_args()
    flight, number = cost_of_a_flight(512 if options.quick else 2048)
    print(f"A flight adds {1e3 * flight:.3g} us to a launch (launches of {number:.3g} flights).\n")
    sides = (30, 60) if options.quick else (30, 100, 300)
    most = processors()
    costs = []
    print("| lift-off | cells | workers | clock (s) | processors (s) | ms a cell | memory (MiB) | flights |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- |", flush=True)
    for liftoff in ("stop", "fly"):
        for side in sides:
            for workers in sorted({1, most}):
                cost = command(liftoff, side, workers)
                costs.append(cost)
                print(
                    f"| {liftoff} | {side} x {side} | {workers} | {cost.clock:.3g} | {cost.used:.3g} "
                    f"| {1e3 * cost.used / side**2:.3g} | {cost.memory:.0f} | {cost.flights:,} |",
                    flush=True,
                )
    if options.json is not None:
        figures = {"flight_ms": flight, "costs": [asdict(cost) for cost in costs]}
        options.json.write_text(json.dumps(figures, indent=2))


if __name__ == "__main__":
    main()
