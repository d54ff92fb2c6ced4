"""The report's run by heyoka, by numba and by SciPy at the same error, in turns.

heyoka is timed at the loosest tolerance at which its error is no larger than that of numba by
default: the largest of the axis at 2001 samples over 20 s, against heyoka at its least tolerance.
SciPy's method takes numba's steps at the same tolerance; a run of 4 s shows how much longer it
takes over them. Times are of the processor: those of other programs are not in them.
"""

import statistics
import time
from typing import Any

import numpy as np

import tippetop as tt
from benchmarks.surroundings import markdown, rounded
from tippetop.integrators import TOLERANCES as DEFAULTS
from tippetop.problem.presets import report_problem

DURATION, PART, SAMPLES = 20.0, 4.0, 2001
TOLERANCES = (1e-9, 1e-10, 1e-11, 1e-12, 1e-13, 1e-14)


def run(name: str, tolerance: float | None, duration: float = DURATION) -> Any:
    """The report's run."""
    return tt.simulate(
        report_problem(), duration, samples=SAMPLES, integrator=name, tolerance=tolerance
    )


def processor_ms(name: str, tolerance: float | None, duration: float = DURATION) -> float:
    """Processor time of a run, ms."""
    begin = time.process_time()
    run(name, tolerance, duration)
    return 1e3 * (time.process_time() - begin)


def measure(quick: bool) -> dict[str, Any]:
    """Find the tolerances, and take the times."""
    exact = run("taylor", None).axis.values

    def error(name: str, tolerance: float | None) -> float:
        return float(np.abs(run(name, tolerance).axis.values - exact).max())

    own = error("compiled", None)
    for tolerance in TOLERANCES:
        heyokas = error("taylor", tolerance)
        if heyokas <= own:
            break
    ways = {
        "heyoka": ("taylor", tolerance, DURATION),
        "numba": ("compiled", DEFAULTS["compiled"], DURATION),
        "numba, 4 s": ("compiled", DEFAULTS["compiled"], PART),
        "SciPy, 4 s": ("dop853", DEFAULTS["compiled"], PART),
    }
    times: dict[str, list[float]] = {name: [] for name in ways}
    for _ in range(3 if quick else 21):
        for name, way in ways.items():
            times[name].append(processor_ms(*way))
    found: dict[str, Any] = {
        name: {"tolerance": way[1], "ms": statistics.median(times[name])}
        for name, way in ways.items()
    }
    errors = {"heyoka": heyokas, "numba": own}
    return {name: figure | {"error": errors.get(name)} for name, figure in found.items()}


def tables(found: dict[str, Any]) -> str:
    """The figures as a table."""
    rows = [
        [
            name,
            f"{one['tolerance']:.0e}",
            f"{one['error']:.1e}" if one["error"] else "",
            rounded(one["ms"]),
        ]
        for name, one in found.items()
    ]
    first = found["numba"]["ms"] / found["heyoka"]["ms"]
    second = found["SciPy, 4 s"]["ms"] / found["numba, 4 s"]["ms"]
    rows += [
        ["numba over heyoka", "", "", rounded(first)],
        ["SciPy over numba", "", "", rounded(second)],
    ]
    return markdown(["the report's run", "tolerance", "error", "processor, ms"], rows)
