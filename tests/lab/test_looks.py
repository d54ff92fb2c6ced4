"""The page draws toys as Python describes them."""

import json
import subprocess
from pathlib import Path

import numpy as np
import pytest

import tippetop as tt
from node import NODE
from tippetop.figures import appearance
from tippetop.page_engine import HERE

WEB = Path(__file__).parents[2] / "web" / "src"
GENERATED = WEB / "generated" / "looks.json"

LOOSE = tt.presets.WOODEN.model_copy(update={"shape": tt.presets.REPORT_STEM.shape})
BACKWARDS = tt.presets.REPORT_STEM.model_copy(
    update={
        "profile": [
            (0.0, 0.029),
            (0.012, 0.017, -0.012),
            (0.02, 0.006, -0.06),
            (0.0, -0.014, -0.02),
        ]
    }
)
BODIES = {**tt.presets.BODIES, "another shape": LOOSE, "from above": BACKWARDS}


def test_the_pages_looks_are_those_of_figures() -> None:
    assert json.loads(GENERATED.read_text(encoding="utf-8")) == json.loads(appearance.as_json())


def test_the_page_draws_each_body_as_films_do(tmp_path: Path) -> None:
    engine = json.dumps((HERE / "index.js").as_uri())
    for name in ("looks", "arc"):
        code = (WEB / "run" / f"{name}.js").read_text(encoding="utf-8").replace('"engine"', engine)
        data = f"const looks = {appearance.as_json()};"
        code = code.replace('import looks from "../generated/looks.json";', data)
        (tmp_path / f"{name}.mjs").write_text(
            code.replace("./arc.js", "./arc.mjs"), encoding="utf-8"
        )
    bodies = [body.model_dump(mode="json", exclude_none=True) for body in BODIES.values()]
    (tmp_path / "print.mjs").write_text(
        'import { sizeOf, toyParts } from "./looks.mjs";\n'
        f"const bodies = {json.dumps(bodies)};\n"
        "console.log(JSON.stringify(bodies.map((body) => [sizeOf(body), toyParts(body)])));\n",
        encoding="utf-8",
    )
    drawn = json.loads(
        subprocess.check_output([NODE, "print.mjs"], cwd=tmp_path, text=True, timeout=60)
    )
    for (name, body), (size, parts) in zip(BODIES.items(), drawn, strict=True):
        assert size == pytest.approx(appearance.size(body), rel=1e-8), name
        expected = appearance.toy_parts(body)
        assert [part["name"] for part in parts] == [part.name for part in expected], name
        for part, other in zip(parts, expected, strict=True):
            assert part["colours"] == list(other.colours)
            assert np.array(part["profile"]) == pytest.approx(other.profile, abs=1e-6), name
