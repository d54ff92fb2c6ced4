"""Claims about the end of Fig. 5, and the inertias of Table 1, which it decides."""

import xarray as xr

from tippetop.presets import REPORT, REPORT_TABLE_1
from tippetop.report.claim import Finding, examines
from tippetop.report.experiments.runs import likely_end
from tippetop.report.quoted import END_OF_FIG_5
from tippetop.report.tolerance import Tolerance

_DISPLAYED = Tolerance(
    0.00055, "half a unit of the last printed digit, of a number read with the four decimals MATLAB displays"
)


@examines("fig05-end", "run-50", "run-50-windows", "run-50-table-1", tolerance=_DISPLAYED)
def _(run: xr.Dataset, windows: xr.Dataset, other: xr.Dataset) -> Finding:
    chosen = likely_end(windows)
    every = float(windows["window"].diff("window")[0])
    tried = f"from {windows['window'][0]:g} to {windows['window'][-1]:g} s in steps of {every:g} s"
    end = {key: float(run[f"end_{key}"]) for key in END_OF_FIG_5}
    then = {key: float(chosen[f"{key}_after"]) for key in END_OF_FIG_5}
    other_end = {key: float(other[f"end_{key}"]) for key in END_OF_FIG_5}
    duration = float(run["time"][-1])
    return Finding(
        _miss({key: float(run[f"end_{key}_listing"]) for key in END_OF_FIG_5}),
        _miss(end),
        "The report does not say when its end was, and the top has not settled then: of runs "
        f"{tried}, the one of {chosen['window']:g} s comes nearest to all three numbers by its method. "
        f"Converged they are {_triple(then)} at {chosen['window']:g} s, so that the report's are right to "
        f"{_miss(then):.4f}, and {_triple(end)} after {duration:.0f} s. With the inertias of Table 1 as "
        f"printed they would be {_triple(other_end)}.",
        _miss({key: float(chosen[f"{key}_after_listing"]) for key in END_OF_FIG_5}),
        f"the run was cut short at {chosen['window']:g} s",
        right=f"cut short at {chosen['window']:g} s; the end, after {duration:.0f} s, is {_triple(end)}",
    )


def _miss(state: dict[str, float]) -> float:
    """The largest difference of a state from the one that is printed of Fig. 5, rad and rad/s."""
    return max(abs(state[key] - value) for key, value in END_OF_FIG_5.items())


def _triple(state: dict[str, float]) -> str:
    return "(" + ", ".join(f"{value:.4f}" for value in state.values()) + ")"


@examines("table-1-inertia", "run-50", "run-50-table-1", tolerance=Tolerance(1e-6, "fractions are exact"))
def _(run: xr.Dataset, other: xr.Dataset) -> Finding:
    unit = REPORT.mass * float(REPORT.surface.size) ** 2
    runs = {"listing": (run, REPORT), "table": (other, REPORT_TABLE_1)}
    misses = {
        name: max(abs(float(run[f"end_{key}"]) - value) for key, value in END_OF_FIG_5.items())
        for name, (run, _) in runs.items()
    }
    right = min(misses, key=lambda name: misses[name])
    return Finding(
        REPORT.I1 / unit,
        runs[right][1].I1 / unit,
        "The value is the one whose converged end state is nearest to Fig. 5's: the largest difference in "
        f"(theta, phi', omega) is {misses['listing']:.3f} with the listing's inertias "
        f"and {misses['table']:.3f} with those of the table.",
        reported=REPORT_TABLE_1.I1 / unit,
    )
