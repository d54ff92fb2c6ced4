"""Measure what is promised of speed and memory; print tables, and keep the figures as JSON.

A measurement is `simulate` (a run against the bare integration inside it, by heyoka), `page` (the
page's engine in Node against Python's), `sweep` (the sweep's engine against other programs at the
same error), `scale` (what sweeps cost by size, workers and flights) or `friction` (what friction of
a patch costs beside viscous friction).
"""

import argparse
import json
import sys
from pathlib import Path

from rich.console import Console
from rich.markdown import Markdown

from benchmarks import (
    bench_friction,
    bench_page,
    bench_simulate,
    bench_sweep,
    bench_sweep_scale,
)
from benchmarks.surroundings import machine

MEASUREMENTS = ("simulate", "page", "sweep", "scale", "friction")


def main() -> None:
    """Measure; exit with 1 if a run takes too many times the bare integration."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description=__doc__)
    parser.add_argument(
        "what", nargs="*", metavar="WHAT", help=f"{', '.join(MEASUREMENTS)}; all if left out"
    )
    parser.add_argument("--quick", action="store_true", help="fewer and smaller")
    parser.add_argument(
        "--whole", action="store_true", help="scale: also a million launches, twice"
    )
    parser.add_argument(
        "--profile", action="store_true", help="simulate: also show where the time goes"
    )
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the figures here")
    options = parser.parse_args()
    unknown = [name for name in options.what if name not in MEASUREMENTS]
    if unknown:
        parser.error(f"WHAT is {unknown[0]}; write one of {', '.join(MEASUREMENTS)}")

    console, progress = Console(), Console(stderr=True, style="dim", highlight=False)
    found, figures = {}, {"machine": machine()}
    for name in options.what or MEASUREMENTS:
        if name == "simulate":
            found = bench_simulate.measure(options.quick, options.profile)
            table = bench_simulate.tables(found)
        elif name == "page":
            found = bench_page.measure(options.quick)
            table = bench_page.tables(found)
        elif name == "sweep":
            found = bench_sweep.measure(options.quick, progress.print)
            table = bench_sweep.tables(found)
        elif name == "friction":
            found = bench_friction.measure(options.quick)
            table = bench_friction.tables(found)
        else:
            found = bench_sweep_scale.measure(options.quick, options.whole, progress.print)
            table = bench_sweep_scale.tables(found)
        figures[name] = found
        if console.is_terminal:
            console.print(Markdown(table))
        else:
            print(table, flush=True)
        print()
    if options.json is not None:
        options.json.write_text(json.dumps(figures, indent=2), encoding="utf-8")
    ratio = figures.get("simulate", {}).get("ratio", 0.0)
    sys.exit(0 if ratio <= bench_simulate.TARGET_RATIO else 1)


if __name__ == "__main__":
    main()
