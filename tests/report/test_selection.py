"""What is redone when only a part is asked for."""

import pytest

from tippetop.report.claims.registry import CLAIMS
from tippetop.report.experiments.registry import EXPERIMENTS
from tippetop.report.gallery import PLATES
from tippetop.report.selection import select
from tippetop.support.errors import InvalidInput


def test_everything_by_default() -> None:
    chosen = select()
    assert len(chosen.plates) == len(PLATES)
    assert len(chosen.claims) == len(CLAIMS)
    assert len(chosen.experiments) == len(EXPERIMENTS)


@pytest.mark.parametrize("name", PLATES)
def test_figure_needs_its_own_experiments_only(name: str) -> None:
    chosen = select(name)
    assert [plate.id for plate in chosen.plates] == [name]
    assert {experiment.id for experiment in chosen.experiments} == set(PLATES[name].needs)
    assert all(claim.figure == name for claim in chosen.claims)


@pytest.mark.parametrize("name", CLAIMS)
def test_claim_needs_its_own_experiments_only(name: str) -> None:
    chosen = select(name)
    assert [claim.id for claim in chosen.claims] == [name]
    assert {experiment.id for experiment in chosen.experiments} == set(CLAIMS[name].needs)


@pytest.mark.parametrize("given", ["6", "fig6", "fig06", "Fig. 6", "figure 6"])
def test_figures_have_many_names(given: str) -> None:
    assert select(given).plates[0].id == "fig06"


@pytest.mark.parametrize(
    ("given", "meant"), [("fig05-fliptime", "fig05-flip-time"), ("eq-2-7", "eq-2.7")]
)
def test_unknown_name_is_refused_with_the_likeliest_one(given: str, meant: str) -> None:
    with pytest.raises(InvalidInput, match=f"such as {meant}") as refused:
        select(given)
    assert refused.value.field == "--only"


def test_name_like_no_other_is_answered_with_all_of_them() -> None:
    with pytest.raises(InvalidInput) as refused:
        select("zzzz")
    assert all(name in refused.value.accepted for name in (*PLATES, *CLAIMS))
