"""What every claim and every figure of the page must do, given the datasets that they are made
from.
"""

from pathlib import Path

import xarray as xr
from PIL import Image

from tippetop.report.claim import Claim, Finding, Judgement, Verdict
from tippetop.report.claims.registry import CLAIMS
from tippetop.report.gallery import PLATES, Plate
from tippetop.report.outline import STORY
from tippetop.report.page import render


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


def made_up_judgement(claim: Claim, is_true: bool) -> Judgement:
    """Judge a claim by a value that is made up: the one that is claimed, or one far off."""
    reported = None if claim.printed else 1.0
    claimed = Judgement(claim, Finding.unlisted(0.0, "", reported=reported), quick=False).reported
    value = claimed + (0.0 if is_true else 1e9) if claim.is_number else is_true
    return Judgement(claim, Finding.unlisted(value, "Made up.", reported=reported), quick=False)


def made_up_page(folder: Path) -> str:
    """The page of every claim, found true, with empty pictures for the figures of the story."""
    plates = [PLATES[part["figure"]] for part in STORY]
    for plate in plates:
        (folder / f"{plate.id}.svg").write_text("<svg/>", encoding="utf-8")
        Image.new("RGB", (160, 90)).save(folder / f"{plate.id}.png")
    judgements = [made_up_judgement(claim, is_true=True) for claim in CLAIMS.values()]
    return render(plates, judgements, folder, quick=False)


def assert_drawn(computed: dict[str, xr.Dataset], plate: Plate) -> None:
    """See that a figure is drawn, with something in each of its panels."""
    figure = plate.draw(plate.dataset(computed))
    assert figure.axes
    assert all(axes.has_data() for axes in figure.axes)
