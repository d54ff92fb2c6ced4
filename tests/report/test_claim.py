"""The rule that decides claims, and the records it is written down in."""

import json
import math

import pytest

from tippetop.report.claim import (
    Claim,
    Examiner,
    Finding,
    Judgement,
    Source,
    Verdict,
    decide,
    number,
)
from tippetop.report.claims.registry import CLAIMS, EXAMINERS
from tippetop.report.experiments.registry import EXPERIMENTS
from tippetop.report.gallery import DRAWN, PLATES
from tippetop.report.outline import OWN, PICTURES, SECTIONS, section_of
from tippetop.report.tolerance import Tolerance, half_last_digit

FIELDS = {"id", "source", "statement", "reported", "listing", "converged", "unit", "verdict", "note"}


def judged(finding: Finding, printed: str = "", tolerance: Tolerance | None = None) -> Judgement:
    source = Source("1", "Fig. 1", "(1)")
    unit = "s" if tolerance else None
    examiner = Examiner((), tolerance, lambda: finding)
    claim = Claim("a-claim", examiner, source, "It is so.", printed=printed, unit=unit)
    return claim.judge({}, quick=False)


@pytest.mark.parametrize(
    ("printed", "half"), [("7.4", 0.05), ("170", 0.5), ("-0.985", 0.0005), ("5.62", 0.005), ("0", 0.5)]
)
def test_tolerance_is_half_of_the_last_printed_digit(printed: str, half: float) -> None:
    assert half_last_digit(printed).value == pytest.approx(half)
    assert judged(Finding(None, 0.0, ""), printed).tolerance == half_last_digit(printed)


@pytest.mark.parametrize(
    ("listing", "converged", "chosen", "verdict"),
    [
        (None, 7.44, None, Verdict.REPRODUCED),
        (7.41, 7.36, None, Verdict.REPRODUCED),
        (9.0, 7.36, 7.41, Verdict.REPRODUCED),
        (9.0, 7.36, None, Verdict.UPHELD),
        (9.0, 7.36, 8.0, Verdict.UPHELD),
        (7.41, 7.5, None, Verdict.EXPLAINED),
        (9.0, 8.0, 7.43, Verdict.EXPLAINED),
        (None, 8.0, 7.44, Verdict.EXPLAINED),
        (9.0, 8.0, 7.5, Verdict.CORRECTED),
        (None, 8.0, None, Verdict.CORRECTED),
        (math.nan, math.nan, None, Verdict.CORRECTED),
    ],
)
def test_rule_for_numbers(
    listing: float | None, converged: float, chosen: float | None, verdict: Verdict
) -> None:
    assert decide(7.4, listing, converged, 0.05, chosen) is verdict


@pytest.mark.parametrize(
    ("listing", "converged", "verdict"),
    [
        (None, True, Verdict.REPRODUCED),
        (False, True, Verdict.UPHELD),
        (True, False, Verdict.EXPLAINED),
        (False, False, Verdict.CORRECTED),
    ],
)
def test_rule_for_what_is_true_or_false(listing: bool | None, converged: bool, verdict: Verdict) -> None:
    assert decide(True, listing, converged, None) is verdict


def test_half_a_digit_is_still_agreement_in_binary() -> None:
    # 7.45 - 7.4 is a little more than 0.05 in floating point.
    assert decide(7.4, None, 7.45, half_last_digit("7.4").value) is Verdict.REPRODUCED


def test_record_is_json_and_says_all() -> None:
    finding = Finding(math.nan, 7.42, "A note.", 7.0, "what is left open")
    record = judged(finding, "7.4 s").record()
    assert set(record) >= FIELDS
    again = json.loads(json.dumps(record, allow_nan=False))
    assert again["source"] == {"figure": "Fig. 1", "equation": "(1)", "section": "1"}
    assert again["reported"] == 7.4
    assert again["reported_as"] == "7.4"
    assert again["listing"] is None
    assert (again["listing_chosen"], again["listing_choice"]) == (7.0, "what is left open")
    assert again["verdict"] == "upheld"


def test_formula_is_compared_by_what_it_evaluates_to() -> None:
    finding = Finding(1.0, 1.0, "", reported=2.0)
    judgement = judged(finding, tolerance=Tolerance(1e-3, "small"))
    assert judgement.reported == 2.0
    assert judgement.verdict is Verdict.CORRECTED


@pytest.mark.parametrize("claim", CLAIMS.values(), ids=CLAIMS)
def test_claims_are_complete(claim: Claim) -> None:
    assert claim.needs
    assert set(claim.needs) <= set(EXPERIMENTS)
    assert claim.figure is None or claim.figure in PLATES
    assert claim.source.section
    assert claim.printed or not claim.unit or claim.examiner.tolerance
    assert claim.formula != claim.formula_right or not claim.formula
    if claim.printed:
        assert math.isfinite(number(claim.number))
    if claim.examiner.tolerance is not None:
        assert claim.examiner.tolerance.reason
    assert section_of(claim.source.section)


def test_every_statement_of_the_report_is_quoted() -> None:
    """Claims of the page's own sections quote nothing, for the report has no such section."""
    for claim in CLAIMS.values():
        assert bool(claim.quote) is (section_of(claim.source.section) not in OWN)
        assert len(claim.quote) < 160


def test_all_that_is_told_is_examined_or_drawn_and_the_other_way_round() -> None:
    assert set(EXAMINERS) == set(CLAIMS)
    assert set(DRAWN) == set(PLATES)


def test_constants_stand_in_what_is_told_of_them() -> None:
    assert CLAIMS["fig10-fall"].text == "The work of the weight in a fall by 15 radii is 0.06 J."
    assert CLAIMS["fig05-reversal"].printed == "1.1 s"
    assert not any("{" in plate.caption for plate in PLATES.values())


def test_figures_stand_in_sections_of_the_page() -> None:
    order = list(SECTIONS)
    assert order[-3:] == list(OWN)
    for plate in PLATES.values():
        assert section_of(plate.section) == plate.section
        assert plate.finding or plate.id.startswith("fig") or plate.section not in ("Why",)
    assert all(PLATES[name].finding for name in PICTURES)
    assert section_of("Appendix A.1, line 22") == "Appendix A"
    assert section_of("3.1") == "3.1"
    with pytest.raises(LookupError):
        section_of("Elsewhere")


def test_every_figure_of_the_report_is_there() -> None:
    assert {f"fig{number:02d}" for number in range(1, 17)} <= set(PLATES)
    assert {name for plate in PLATES.values() for name in plate.needs} <= set(EXPERIMENTS)
