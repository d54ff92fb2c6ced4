"""What every claim and every figure of the page must do, given the datasets that they are made
from.
"""

import xarray as xr

from tippetop.report.claim import Verdict
from tippetop.report.claims.registry import CLAIMS
from tippetop.report.gallery import PLATES, Plate


def assert_judged(computed: dict[str, xr.Dataset], name: str, verdict: Verdict) -> None:
    """See that a claim is judged so, in words without gaps, and shown in a figure that there is."""
    claim = CLAIMS[name]
    found = claim.judge(computed, quick=True)
    assert found.verdict is verdict
    assert claim.figure in PLATES
    assert "nan" not in found.finding.note + found.finding.right + found.finding.news


def assert_judged_otherwise(
    computed: dict[str, xr.Dataset],
    name: str,
    experiment: str,
    change: dict[str, float],
    verdict: Verdict,
) -> None:
    """See that a claim is judged so where some variables of an experiment have other values."""
    data = computed[experiment]
    other = data.assign(
        {variable: xr.full_like(data[variable], value, float) for variable, value in change.items()}
    )
    assert CLAIMS[name].judge(computed | {experiment: other}, quick=True).verdict is verdict


def assert_drawn(computed: dict[str, xr.Dataset], plate: Plate) -> None:
    """See that a figure is drawn, with something in each of its panels."""
    figure = plate.draw(plate.dataset(computed))
    assert figure.axes
    assert all(axes.has_data() for axes in figure.axes)
