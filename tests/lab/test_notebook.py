"""The widget, and the notebook that shows it."""

import base64
import json
import os
from collections.abc import Callable
from pathlib import Path

import pytest

import tippetop as tt

pytest.importorskip(
    "anywidget", reason="anywidget shows runs in notebooks; it comes with the lab extra"
)

from tippetop.export.bundle import built
from tippetop.lab.notebook import view
from tippetop.results.account_text import describe

NOTEBOOK = Path(__file__).parents[2] / "notebooks" / "tippe_top.ipynb"

HOST = """async ([code, first, second]) => {
  const bytes = (text) => new DataView(Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer);
  const values = { track: bytes(first), height: 300, theme: "dark" };
  const calls = {};
  const model = { get: (name) => values[name], on: (name, call) => (calls[name] = call),
    off: (name) => delete calls[name] };
  const url = URL.createObjectURL(new Blob([code], { type: "text/javascript" }));
  const widget = (await import(url)).default;
  const clean = await widget.render({ model, el: document.body });
  const words = () => document.querySelector(".tt-words strong").textContent;
  const before = words();
  values.track = bytes(second);
  calls["change:track"]();
  await new Promise((done) => setTimeout(done, 300));
  const drawn = document.querySelector("canvas.tt-canvas").width;
  const after = words();
  Object.assign(values, { height: 200, theme: "light" });
  calls["change:height"]();
  calls["change:theme"]();
  const player = document.querySelector(".tt-player");
  const changed = [player.offsetHeight, player.classList.contains("tt-dark")];
  const gl = document.querySelector("canvas.tt-canvas").getContext("webgl2");
  clean();
  const left = [document.body.childElementCount, gl.isContextLost(), Object.keys(calls).length];
  return [before, after, drawn, changed, left];
}"""


def test_the_widget_plays_a_run_and_then_another(page: Path, visit: Callable) -> None:
    runs = [
        tt.simulate(tt.presets.report_problem(spin=spin), 1.0, samples=400)
        for spin in (20.0, 155.0)
    ]
    widget = view(runs[0], height=300)
    first = widget.track
    widget.show(runs[1])
    visitor = visit()
    visitor.page.goto("about:blank")
    blocks = [base64.b64encode(block).decode() for block in (first, widget.track)]
    before, after, drawn, changed, left = visitor.ask(HOST, [built("player.js"), *blocks])
    assert [before, after] == [describe(run).headline for run in runs]
    assert after != before
    assert drawn > 100
    assert changed == [200, False]
    assert left == [0, True, 0], "nothing stays, graphics least of all"
    widget.close()


def test_the_widget_refuses_what_it_cannot_be() -> None:
    run = tt.simulate(tt.presets.report_problem(), 0.1, samples=5)
    with pytest.raises(tt.InvalidInput, match="auto, light, dark"):
        view(run, theme="pink")
    with pytest.raises(tt.InvalidInput, match="height"):
        view(run, height=0)


def test_a_notebook_shows_the_figure_of_a_run_without_pyplot() -> None:
    figure = tt.plot(tt.simulate(tt.presets.report_problem(), 0.1, samples=5))
    assert figure._repr_png_().startswith(b"\x89PNG")


def test_the_notebook_runs_from_top_to_bottom(
    page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    cells = json.loads(NOTEBOOK.read_text(encoding="utf-8"))["cells"]
    names: dict[str, object] = {}
    code = ["".join(cell["source"]) for cell in cells if cell["cell_type"] == "code"]
    imports = [line for text in code for line in text.splitlines() if "import" in line]
    assert imports == ["import tippetop as tt"]
    assert all(cell["outputs"] for cell in cells if cell["cell_type"] == "code"), (
        "it shows what comes out"
    )
    assert NOTEBOOK.stat().st_size < 300_000, "its outputs are light"
    for text in code:
        exec(text, names)
    assert set(os.listdir(tmp_path)) == {
        f"flying.{suffix}" for suffix in ("html", "glb", "csv", "nc")
    }
