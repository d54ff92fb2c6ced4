"""What the theory says of launches, in the page: the same as Python's."""

from collections.abc import Callable
from dataclasses import asdict
from typing import Any

import pytest

import tippetop as tt
from campaigns import seed_ranges
from launches import in_javascript, launch_of
from tippetop.problem.plausibility import doubts
from tippetop.theory.prospects import prospects


def told(ask: Callable[[], Any]) -> Any:
    """What Python answers as plain data, with words for what JSON does not know; of a refusal the
    field.
    """
    try:
        found = ask()
    except tt.InvalidInput as refusal:
        return {"refused": refusal.field}
    return plain(asdict(found) if found is not None else None)


def plain(value: Any) -> Any:
    if isinstance(value, dict):
        return {name: plain(one) for name, one in value.items()}
    if isinstance(value, list | tuple):
        return [plain(one) for one in value]
    return "inf" if value == float("inf") else value


def assert_alike(theirs: Any, ours: Any, where: str) -> None:
    """Same numbers to 1e-9, relative or to 1; tilts near a fold or a pole to its square root."""
    if isinstance(ours, dict):
        assert theirs.keys() >= ours.keys(), where
        for name in ours:
            assert_alike(theirs[name], ours[name], f"{where} {name}")
    elif isinstance(ours, list):
        assert len(theirs) == len(ours), where
        for number, (one, other) in enumerate(zip(theirs, ours, strict=True)):
            assert_alike(one, other, f"{where} {number}")
    elif isinstance(ours, float):
        assert theirs == pytest.approx(ours, rel=1e-9, abs=1e-12), where
    else:
        assert theirs == ours, where


@pytest.mark.parametrize("seeds", seed_ranges(check=300, sample=300, claim=1000, size=350))
def test_what_is_foreseen_is_the_same(seeds: range) -> None:
    launches = [launch_of(seed) for seed in seeds]
    answers = in_javascript([{"problem": fields, "theory": True} for fields in launches])
    refused = ends = stems = doubtful = 0
    for seed, fields, theirs in zip(seeds, launches, answers, strict=True):
        try:
            problem = tt.Problem(**fields)
        except tt.InvalidInput:
            continue
        body = problem.body
        ours = {
            "predict": told(lambda problem=problem: tt.predict(problem)),
            "critical": told(lambda problem=problem: tt.critical_spins(problem)),
            "prospects": told(lambda body=body: prospects(body, list(body.shapes))),
            "doubts": [{"kind": doubt.kind, "gaps": dict(doubt.gaps)} for doubt in doubts(problem)],
        }
        assert_alike(theirs, ours, f"seed {seed}:")
        ends += "stable" in ours["predict"]
        refused += "refused" in ours["predict"]
        doubtful += bool(ours["doubts"])
        stems += bool(ours["prospects"] and ours["prospects"].get("stem"))
    assert ends > len(seeds) / 15
    assert refused > len(seeds) / 3
    assert stems > 0
    assert doubtful > len(seeds) / 15
