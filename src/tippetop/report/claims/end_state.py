"""Claims about the end of Fig. 5, and the inertias of Table 1, which it decides."""

import numpy as np
import xarray as xr

from tippetop.presets import REPORT, REPORT_TABLE_1
from tippetop.report.claim import Chapter, Finding, Source
from tippetop.report.quoted import END_OF_FIG_5
from tippetop.report.tolerance import Tolerance

CHAPTER = Chapter()

_DISPLAYED = Tolerance(
    0.00055, "half a unit of the last printed digit, of a number read with the four decimals MATLAB displays"
)


def _end_of_run_50(name: str, symbol: str, unit: str) -> None:
    short, printed = name.replace("_", "-"), f"{END_OF_FIG_5[name]:.3f}"

    @CHAPTER.claim(
        f"fig05-end-{short}",
        Source("3.1", "Fig. 5"),
        f"Launched at 50 rad/s the top ends with {symbol} = {printed}.",
        f"{printed} {unit}",
        tolerance=_DISPLAYED,
        needs=("run-50", "run-50-windows", "run-50-table-1"),
        figure="fig05",
    )
    def _(run: xr.Dataset, windows: xr.Dataset, other: xr.Dataset) -> Finding:
        chosen = likely_end(windows)
        every = float(windows["window"].diff("window")[0])
        tried = f"from {windows['window'][0]:g} to {windows['window'][-1]:g} s in steps of {every:g} s"
        return Finding(
            float(run[f"end_{name}_listing"]),
            float(chosen[name]),
            f"The report does not say when the end was. Of runs {tried} the one of "
            f"{chosen['window']:g} s comes nearest to all three numbers by its method; converged it has "
            f"{chosen[name]:.5f} {unit} then, and {run[f'end_{name}']:.5f} {unit} after 20 s. With the "
            f"inertias of Table 1 as printed it would be {other[f'end_{name}']:.4f} {unit}.",
            float(chosen[f"{name}_listing"]),
            f"the run ends at {chosen['window']:g} s",
        )


def likely_end(windows: xr.Dataset) -> xr.Dataset:
    """The end, among runs of several lengths, that comes nearest to what is printed of Fig. 5."""
    misses = [abs(windows[f"{key}_listing"].values - value) for key, value in END_OF_FIG_5.items()]
    return windows.isel(window=int(np.argmin(np.max(misses, axis=0))))


_end_of_run_50("theta", "theta", "rad")
_end_of_run_50("phi_dot", "phi'", "rad/s")
_end_of_run_50("omega3", "omega", "rad/s")


@CHAPTER.claim(
    "table-1-inertia",
    Source("3", "Table 1"),
    "Table 1: I1 = 2/5 m R^2 and I3 = 131/350 m R^2 (the value is I1 / (m R^2)).",
    unit="1",
    tolerance=Tolerance(1e-6, "fractions are exact"),
    needs=("run-50", "run-50-table-1"),
    figure="fig05",
    right="I1 = 131/350 m R^2 and I3 = 2/5 m R^2, as in the listing",
)
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
