"""The page of a run in a real browser."""

from collections.abc import Callable
from pathlib import Path

import pytest

import tippetop as tt
from tippetop.export.bundle import BUILT

INKED = """() => { const { strip } = tippetopPlayer, across = Math.ceil(strip.width / 10);
  const { data } = strip.getContext("2d").getImageData(0, 0, across, strip.height);
  return data.filter((value, i) => i % 4 === 3 && value > 0).length; }"""
"""How many points of the first tenth of the strip are drawn on."""


def test_a_part_of_a_run_plays_from_where_it_begins(tmp_path: Path, visit: Callable) -> None:
    if not (BUILT / "player.js").exists():
        pytest.skip("the player is not built (make page)")
    problem = tt.presets.report_problem(spin=175.0).replace({"contact.liftoff": "fly"})
    run = tt.simulate(problem, duration=6.5, samples=6501)
    assert run["flight_start"].values.min() > 5.0
    whole, part = (tmp_path / f"{name}.html" for name in ("whole", "part"))
    tt.write_html(run, whole)
    tt.write_html(run.sel(time=slice(5.0, 6.5)), part)
    visitor = visit().open(part.as_uri(), "globalThis.tippetopPlayer?.frames > 0")
    visitor.wait("() => tippetopPlayer.time > 5.05")
    visitor.ask("() => { tippetopPlayer.toggle(false); tippetopPlayer.seek(0); }")
    assert visitor.ask("tippetopPlayer.time") == 5.0
    visitor.page.locator("canvas").first.press("End")
    assert visitor.ask("tippetopPlayer.time") == 6.5
    visitor.page.locator("canvas").first.press("Home")
    assert visitor.ask("tippetopPlayer.time") == 5.0
    visitor.wait("() => !tippetopPlayer.stale && Number(tippetopPlayer.range.value) === 5")
    assert visitor.ask("[tippetopPlayer.range.min, tippetopPlayer.range.max]") == ["5", "6.5"]
    assert visitor.ask(INKED) > 0, "the strip is as long as the part"
