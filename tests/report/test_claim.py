"""The rule that decides claims, and the records it is written down in."""

import json
import math
import re
from functools import partial
from inspect import Parameter, signature
from typing import get_type_hints

import pytest
import xarray as xr
from matplotlib.axes import Axes

from tippetop.figures.annotation import drawn
from tippetop.report.claim import (
    Claim,
    Examiner,
    Finding,
    Judgement,
    Source,
    Verdict,
    count_verdicts,
    examines,
    in_words,
    number,
)
from tippetop.report.claims.registry import CLAIMS, EXAMINERS
from tippetop.report.experiment import dataset, experiment
from tippetop.report.experiments.registry import EXPERIMENTS
from tippetop.report.gallery import DRAWN, PLATES
from tippetop.report.outline import ADDED_SECTIONS, SECTIONS, STORY, UNCHECKED, section_of
from tippetop.report.tolerance import Tolerance, half_last_digit

COARSER = {
    "fig04-flip-time": "around",
    "fig05-flip-time": "around",
    "fig06-a": "around",
    "fig06-c1": "scan in such steps",
    "fig06-c2": "scan in such steps",
    "real-leine-stem": "read off a plot",
    "real-leine-back": "read off a plot",
    "real-leine-both": "read off a plot",
    "real-leine-apart": "read off a plot",
}
"""Claims that need not be true to half of their last digit, and the words that say why."""

IN_WORDS = {
    "eq-2.7-mu-unit",
    "table-1-mu-unit",
    "eq-b.1",
    "section-5-small-mu",
    "dry-viscous-limit",
}
"""Claims whose number the sentence does not print: powers, and a ratio of one."""

BY_OTHER_RUNS = {
    *(
        "sec3-no-nutation",
        "sec3-friction",
        "fig08-settles",
        "fig08-block",
        "eq-2.16",
        "eq-2.16-third",
    ),
    "why-flip-law",
}
"""Claims that are decided by other runs than those of the figure that they stand beside."""

BESIDE_ANOTHER = {"sec3-no-nutation", "table-1-inertia", "summary-large-mu", "sec4-may-fly"}
"""Claims beside another figure than the one that the report makes them of."""

FIELDS = {
    "id",
    "source",
    "statement",
    "reported",
    "listing",
    "converged",
    "unit",
    "verdict",
    "note",
}


def judged(finding: Finding, printed: str = "", tolerance: Tolerance | None = None) -> Judgement:
    source = Source("1", "Fig. 1", "(1)")
    unit = "s" if tolerance else None
    examiner = Examiner((), tolerance, lambda: finding)
    claim = Claim("a-claim", examiner, source, "It is so.", printed=printed, unit=unit)
    return claim.judge({}, quick=False)


@pytest.mark.parametrize(
    ("printed", "half"),
    [("7.4", 0.05), ("170", 0.5), ("-0.985", 0.0005), ("5.62", 0.005), ("0", 0.5)],
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
    assert judged(Finding(listing, converged, "", chosen), "7.4").verdict is verdict


@pytest.mark.parametrize(
    ("listing", "converged", "verdict"),
    [
        (None, True, Verdict.REPRODUCED),
        (False, True, Verdict.UPHELD),
        (True, False, Verdict.EXPLAINED),
        (False, False, Verdict.CORRECTED),
    ],
)
def test_rule_for_what_is_true_or_false(
    listing: bool | None, converged: bool, verdict: Verdict
) -> None:
    assert judged(Finding(listing, converged, "")).verdict is verdict


def test_half_a_digit_is_still_agreement_in_binary() -> None:
    # 7.45 - 7.4 is a little more than 0.05 in floating point.
    assert judged(Finding(None, 7.45, ""), "7.4").verdict is Verdict.REPRODUCED


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
    assert isinstance(claim.implied, bool)
    assert not re.search("[{}]", claim.text + claim.quote + claim.printed + claim.right)
    if claim.examiner.tolerance is not None:
        assert claim.examiner.tolerance.reason
        assert claim.is_number
    assert section_of(claim.source.section)


NUMBERS = {name: claim for name, claim in CLAIMS.items() if claim.is_number}


@pytest.mark.parametrize("claim", NUMBERS.values(), ids=NUMBERS)
def test_a_tolerance_is_half_of_the_last_digit_or_has_a_reason(claim: Claim) -> None:
    own = claim.examiner.tolerance
    if claim.number in ("", "0", "pi"):
        assert own, "no digit says how accurate the number is"
    elif own and own.value > half_last_digit(claim.number).value:
        assert COARSER[claim.id] in own.reason
        assert COARSER[claim.id] != "around" or "around" in claim.quote
    else:
        assert claim.id not in COARSER


def test_verdicts_are_counted_and_put_in_words() -> None:
    judgements = [judged(Finding(None, value, ""), "7.4") for value in (7.4, 8.0, 7.41)]
    counts = count_verdicts(judgements)
    assert counts == {"reproduced": 2, "upheld": 0, "explained": 0, "corrected": 1}
    assert in_words(counts) == "3 (2 reproduced, 1 corrected)"
    assert in_words(count_verdicts([])) == "0"


@pytest.mark.parametrize("claim", CLAIMS.values(), ids=CLAIMS)
def test_a_printed_number_stands_in_the_sentence(claim: Claim) -> None:
    """But for what the sentence says in words: that it is nothing, or that the axis is turned
    over.
    """
    if claim.number not in ("", "0", "pi") and claim.id not in IN_WORDS:
        assert re.search(
            rf"(?<![\d.]){re.escape(claim.number)}(?![\d.]*\d)", claim.quote or claim.text
        )


@pytest.mark.parametrize(
    "claim", [claim for claim in CLAIMS.values() if claim.figure], ids=lambda one: one.id
)
def test_a_figure_shows_what_decides_the_claims_beside_it(claim: Claim) -> None:
    needs = PLATES[str(claim.figure)].needs
    assert (not needs or not set(needs).isdisjoint(claim.needs)) is (claim.id not in BY_OTHER_RUNS)
    drawn = re.fullmatch(r"fig(\d+)", str(claim.figure))
    if drawn and claim.source.figure:
        numbers = map(int, re.findall(r"\d+", claim.source.figure))
        assert (int(drawn[1]) in numbers) is (claim.id not in BESIDE_ANOTHER)


def test_every_statement_of_the_report_is_quoted() -> None:
    """Claims of the page's own sections quote nothing, for the report has no such section."""
    for claim in CLAIMS.values():
        assert bool(claim.quote) is (section_of(claim.source.section) not in ADDED_SECTIONS)
        assert len(claim.quote) < 160


def test_all_that_is_told_is_examined_or_drawn_and_the_other_way_round() -> None:
    assert set(EXAMINERS) == set(CLAIMS)
    assert set(DRAWN) == set(PLATES)


def test_no_name_is_registered_twice() -> None:
    told, done = next(iter(EXAMINERS)), next(iter(EXPERIMENTS))
    known = EXAMINERS[told], EXPERIMENTS[done]
    with pytest.raises(ValueError, match=told):
        examines(told)(lambda: Finding.unlisted(True, ""))
    with pytest.raises(ValueError, match=done):
        experiment(done, "", 0.0)(lambda quick: dataset({}))
    assert (EXAMINERS[told], EXPERIMENTS[done]) == known


def test_every_figure_tells_that_it_is_drawn_from_data_and_not_into_panels() -> None:
    for draw in DRAWN.values():
        first, *others = (told.annotation for told in signature(draw).parameters.values())
        assert first in {xr.Dataset, Parameter.empty}
        assert Axes not in others
        function = draw.func if isinstance(draw, partial) else draw
        assert Axes not in get_type_hints(function).values()


@pytest.mark.parametrize(("rows", "columns"), [(1, 1), (2, 2)])
def test_what_draws_into_other_panels_than_there_are_is_refused(rows: int, columns: int) -> None:
    def two(left: Axes, right: Axes, data: xr.Dataset) -> None: ...

    with pytest.raises(
        TypeError, match=f"two draws into 2 panels, and the figure has {rows * columns}"
    ):
        drawn(3.0, rows, columns)(two)


def test_words_have_no_unit() -> None:
    found = dataset(
        {"top": ["a", "b"]},
        group=(["I", "II"], None, "group", "top"),
        size=([1.0, 2.0], "m", "size", "top"),
    )
    assert found["group"].attrs == {"long_name": "group"}
    assert found["size"].attrs["units"] == "m"


def test_constants_stand_in_what_is_told_of_them() -> None:
    assert CLAIMS["fig10-fall"].text == "The work of the weight in a fall by 15 radii is 0.06 J."
    assert CLAIMS["fig05-reversal"].printed == "1.1 s"
    assert not any(
        re.search("[{}]", plate.title + plate.caption + plate.finding) for plate in PLATES.values()
    )


def test_figures_stand_in_sections_of_the_page() -> None:
    order = list(SECTIONS)
    assert order[-3:] == list(ADDED_SECTIONS)
    for name, (title, _) in SECTIONS.items():
        assert title.startswith(name)
    for plate in PLATES.values():
        assert section_of(plate.section) == plate.section
        drawn = re.fullmatch(r"fig(\d+)", plate.id)
        assert plate.title.startswith(f"Figure {int(drawn[1])}: " if drawn else "")
        assert plate.title
        assert plate.caption
        assert plate.finding or plate.id.startswith("fig") or plate.section not in ("Why",)
    assert len(STORY) == 5
    assert {part["figure"] for part in STORY} <= set(PLATES)
    assert section_of("Appendix A.1, line 22") == "Appendix A"
    assert section_of("3.1") == "3.1"
    with pytest.raises(LookupError):
        section_of("Elsewhere")


def test_what_is_not_judged_is_said_with_its_place_and_its_reason() -> None:
    order = ["Abstract", *SECTIONS]
    places = [one["place"].removeprefix("section ").partition(",")[0] for one in UNCHECKED]
    assert places == sorted(places, key=order.index)
    for one in UNCHECKED:
        assert one.keys() == {"place", "statement", "reason"}
        assert all(one.values())


def test_every_figure_of_the_report_is_there() -> None:
    assert {f"fig{number:02d}" for number in range(1, 17)} <= set(PLATES)
    assert {name for plate in PLATES.values() for name in plate.needs} <= set(EXPERIMENTS)
