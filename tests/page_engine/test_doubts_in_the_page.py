"""The page finds none of its own launches implausible."""

import json
from pathlib import Path

import tippetop as tt
from node import printed
from tippetop.page_engine import HERE
from tippetop.problem.plausibility import doubts

WEB = Path(__file__).parents[2] / "web"


def test_no_launch_of_the_page_is_implausible(tmp_path: Path) -> None:
    for name in ("presets", "setup"):
        code = (WEB / "src" / "lab" / f"{name}.js").read_text(encoding="utf-8")
        for part in ("tables", "units"):
            code = code.replace(f'"engine-{part}"', json.dumps((HERE / f"{part}.js").as_uri()))
        (tmp_path / f"{name}.mjs").write_text(code.replace("setup.js", "setup.mjs"), "utf-8")
    presets = json.dumps((tmp_path / "presets.mjs").as_uri())
    told = printed(
        f"import {{ PRESETS, TABLES }} from {presets};\n"
        f"console.log(JSON.stringify({{ PRESETS, TABLES }}));\n"
    )
    found = json.loads(told)
    problems = [tt.Problem(**one["setup"]["problem"]) for one in found["PRESETS"]]
    for table in found["TABLES"].values():
        problems += [problem.replace({"friction": table}) for problem in problems[:12]]
    assert len(problems) > 30
    assert [doubt for problem in problems for doubt in doubts(problem)] == []
