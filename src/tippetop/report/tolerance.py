"""Tolerances within which a value agrees with the report, and their reasons."""

from typing import NamedTuple

from tippetop.report.readings import SETTLED, SHOWN


class Tolerance(NamedTuple):
    """Largest difference that counts as agreement."""

    value: float
    reason: str
    """Reason for the value: a clause that follows "a difference of at most ...:"."""


AROUND = Tolerance(
    0.25,
    "the report says around; this is 1 % of the 20 s of its plot, the least that can be read from"
    " it, and half a unit of the last printed digit",
)
ARRIVED = Tolerance(SETTLED, f"the report counts a top as arrived within {SETTLED:g} rad")
PLOTTED = Tolerance(SHOWN, "1 % of the range of a plot, the least that it can show")
TRANSCRIBED = "The report is read in a transcription here, which may have lost or moved a mark."
"""Remark on misprints that may come from the transcription."""

STEADY = Tolerance(
    1e-5,
    "the report's method is a hundred times less accurate (1e-3), and the computation here a"
    " hundred times more accurate or better",
)
ROUNDING = Tolerance(
    1e-6,
    "a wrong formula is off by far more, and the computation itself by a tenth of that or less",
)


def half_last_digit(printed: str) -> Tolerance:
    """Return half a unit of the last digit of a printed number: 0.05 for "7.4", 0.5 for "170"."""
    decimals = len(printed.partition(".")[2])
    return Tolerance(0.5 * 10.0**-decimals, "half a unit of the last printed digit")


def rounded(value: float) -> str:
    """Return the order of magnitude of a small difference as text; "0" for rounding errors."""
    return "0" if abs(value) < 1e-17 else f"{abs(value):.0e}"
