"""The page draws toys as Python describes them."""

import json
from pathlib import Path

from tippetop.figures import looks

GENERATED = Path(__file__).parents[2] / "web" / "src" / "generated" / "looks.json"


def test_the_pages_looks_are_those_of_figures() -> None:
    assert json.loads(GENERATED.read_text(encoding="utf-8")) == json.loads(looks.as_json())
