"""The catalogues of the page have the same texts, with the same gaps, in each language."""

import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from tippetop.problem.implausible import SENTENCES

ROOT = Path(__file__).parents[2]
TEXTS = ROOT / "web" / "texts"
ACCOUNT = ROOT / "src" / "tippetop" / "results" / "account_en.json"


def read(path: Path) -> dict[str, Any]:
    return dict(json.loads(path.read_text(encoding="utf-8")))


def gaps_by_name(texts: Any, name: str = "") -> Iterator[tuple[str, set[str]]]:
    """Yield the name of each text of a catalogue, and the names of its gaps."""
    match texts:
        case dict():
            parts = texts.items()
        case list():
            parts = enumerate(texts)
        case _:
            yield name, set(re.findall(r"{(\w+)}", str(texts)))
            return
    for key, inner in parts:
        yield from gaps_by_name(inner, f"{name}/{key}")


def test_german_has_the_texts_and_the_gaps_of_english() -> None:
    english = read(TEXTS / "en.json") | {"account": read(ACCOUNT), "doubts": dict(SENTENCES)}
    german = read(TEXTS / "de.json")
    del german["refusals"]  # of the engine, which is in English
    assert dict(gaps_by_name(german)) == dict(gaps_by_name(english))
