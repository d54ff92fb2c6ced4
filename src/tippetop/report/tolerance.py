"""What counts as agreement, and why that."""

from typing import NamedTuple

from tippetop.report.readings import SETTLED, SHOWN


class Tolerance(NamedTuple):
    """What counts as agreement, and why that."""

    value: float
    reason: str


READ = Tolerance(
    0.25,
    "1 % of the 20 s of the plot that the time is read off, and half a unit of the last printed"
    " digit",
)
ARRIVED = Tolerance(SETTLED, f"the report's own measure of having arrived, {SETTLED:g} rad")
PLOTTED = Tolerance(SHOWN, "1 %: what a plot can show")
TRANSCRIBED = "The report is read in a transcription here, which may have lost or moved a mark."
"""What to say of misprints that may not be the report's own."""

STEADY = Tolerance(1e-5, "far below the 1e-3 of the report's method, far above rounding")
ROUNDING = Tolerance(1e-6, "far above rounding")
WHOLE = Tolerance(1e-6, "the power is a whole number")


def half_last_digit(printed: str) -> Tolerance:
    """Half a unit of the last digit of a printed number: 0.05 for "7.4", 0.5 for "170"."""
    decimals = len(printed.partition(".")[2])
    return Tolerance(0.5 * 10.0**-decimals, "half a unit of the last printed digit")


def rounded(value: float) -> str:
    """The size of a small difference for people, or 0 where there is none."""
    return "0" if abs(value) < 1e-17 else f"{abs(value):.0e}"
