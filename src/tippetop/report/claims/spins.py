"""Claims about the final tilt as a function of the spin: Fig. 6."""

import xarray as xr

from tippetop.report.claim import Chapter, Finding, Source
from tippetop.report.experiments.spins import MARGINS, TURNED
from tippetop.report.quoted import ABNORMAL_SPIN, CRITICAL_SPINS

CHAPTER = Chapter()

_NEEDS = ("final-tilt-listing", "critical-spins")


def _critical(symbol: str, name: str, printed: str, text: str) -> None:
    @CHAPTER.claim(
        f"fig06-{symbol}",
        Source("3.2", "Fig. 6"),
        text,
        f"{printed} rad/s",
        needs=_NEEDS,
        figure="fig06",
    )
    def _(listing: xr.Dataset, sweep: xr.Dataset) -> Finding:
        theirs = listing[f"critical_{name}_listing"].values
        by_window = sweep[f"{name}_by_window"]
        windows = ", ".join(
            f"{value:.2f} in {window:g} s"
            for window, value in zip(by_window["window"], by_window, strict=True)
        )
        return Finding(
            float(theirs[1]),
            float(by_window[-1]),
            f"The threshold moves with the length of the runs: {windows}. The report's runs last 20 s, too "
            "short for a launch near the threshold to settle; it does not say which tilt counted as settled.",
            (float(theirs.min()), float(theirs.max())),
            f"what counts as settled after 20 s, {MARGINS[0]:g} to {MARGINS[-1]:g} rad",
        )


_FIRST, _SECOND = CRITICAL_SPINS
_critical(
    "c1",
    "upright",
    _FIRST,
    f"Below omega_c1 = {_FIRST} rad/s the top stays upright, above it begins to tilt.",
)
_critical("c2", "inverted", _SECOND, f"Above omega_c2 = {_SECOND} rad/s the top turns over completely.")


@CHAPTER.claim(
    "fig06-a",
    Source("3.2", "Fig. 6"),
    f"An abnormal point occurs around omega_a = {ABNORMAL_SPIN} rad/s.",
    f"{ABNORMAL_SPIN} rad/s",
    needs=("final-tilt-listing", "final-tilt"),
    figure="fig06",
)
def _(listing: xr.Dataset, sweep: xr.Dataset) -> Finding:
    onset, lost = float(sweep["lift_off_onset"]), float(sweep["lost"])
    return Finding(
        float(listing["lost_listing"]),
        onset,
        "The value is the spin from which the table would have to pull within 20 s. If it does pull, "
        f"launches still end within {TURNED:g} rad of pi below {lost:g} rad/s, and by the report's method "
        f"below {listing['lost_listing']:g} rad/s: what Fig. 6 shows begins later than its cause.",
    )
