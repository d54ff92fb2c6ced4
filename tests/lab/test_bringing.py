"""Files that people bring to the page are the same bodies there as in Python."""

import json
from collections.abc import Callable
from pathlib import Path

import pytest

import tippetop as tt
from browsing import DROP, Visit
from drawings import SVG
from tippetop.lathe.files import read_with_remarks
from tippetop.lathe.workpiece import Workpiece

Lab = Callable[..., Visit]

WHAT_IS = """(text) => tippetopLab.whatIs({ svg: text }, { density: 700 }).catch(
  ({ message }) => ({ refusal: { message } }))"""

BALL = "r,z,radius\n0,-15,\n15,0,15\n0,15,15\n"

STEM = """gravity = 9.81
[body]
mass = "20 g"
I1 = 3.0e-6
I3 = 3.2e-6
shape = [
  { kind = "sphere", radius = "2 cm", center = 0.006 },
  { kind = "sphere", radius = 0.004, center = 0.034 },
]
[friction]
kind = "viscous"
mu = 0.3
[launch]
tilt = "6 deg"
spin = "1500 rpm"
"""


def flat(value: object, name: str = "") -> dict[str, float]:
    """The numbers in a table by their names with dots."""
    if isinstance(value, dict):
        items = list(value.items())
    elif isinstance(value, list | tuple):
        items = [(str(k), one) for k, one in enumerate(value)]
    else:
        return {name: float(value)} if isinstance(value, float | int) else {}
    return {k: v for key, one in items for k, v in flat(one, f"{name}.{key}").items()}


def turned(piece: Workpiece) -> tuple[str, tt.Body | None]:
    """The body that a workpiece is, or the sentence that refuses it."""
    try:
        return "", tt.Body.turned(piece)
    except tt.InvalidInput as error:
        return str(error), None


def test_drawings_are_the_same_bodies_as_in_python(lab: Lab, tmp_path: Path) -> None:
    visitor = lab("tab=own")
    bodies = ovals = 0
    for name, (_, text) in SVG.items():
        (tmp_path / "a.svg").write_text(text)
        piece, remarks = read_with_remarks(tmp_path / "a.svg", density=700.0)
        found = visitor.ask(WHAT_IS, text)
        assert found["remarks"] == remarks, name
        size = piece.outline.size
        for quantity in ("mass", "I1", "I3"):
            ours = getattr(piece.mass_properties, quantity)
            assert found["weight"][quantity] == pytest.approx(ours, rel=1e-6), name
        assert found["weight"]["center"] == pytest.approx(
            piece.mass_properties.center, abs=1e-6 * size
        )
        sentence, body = turned(piece)
        if body is None:
            assert found["refusal"]["message"] == sentence, name
            continue
        ovals += "oval" in json.dumps(body.model_dump())
        ours = flat(body.model_dump(exclude={"profile"}))
        theirs = flat({k: v for k, v in found["body"].items() if k != "profile"})
        assert theirs == pytest.approx(ours, rel=1e-5, abs=1e-5 * size), name
        bodies += 1
    assert bodies >= 8
    assert ovals >= 1


def test_files_are_dropped_on_the_page(lab: Lab) -> None:
    visitor = lab("tab=own")
    page = visitor.page
    visitor.ask(DROP, ["ball.svg", SVG["inkscape-bored"][1]])
    page.get_by_text("Brought: ball.svg").wait_for()
    page.get_by_role("button", name="Spin it").click()
    visitor.launched("problem.body.profile?.length > 4")
    page.get_by_role("button", name="Back to the sliders").click()
    visitor.ask(DROP, ["points.csv", BALL])
    page.get_by_text("Brought: points.csv").wait_for()
    assert page.get_by_label("Numbers are in").input_value() == "mm", "as most people measure"
    piece = Workpiece(profile=[[0, -15], [0, 15, 15]], density=720, unit="mm")
    mass = 1e3 * piece.mass_properties.mass
    page.locator(".facts", has_text=f"{mass:.4g} g").wait_for()
    visitor.ask(DROP, ["top.toml", STEM])
    visitor.launched("Math.abs(problem.launch.spin - 1500 * Math.PI / 30) < 1e-9")
    assert tt.Problem(**visitor.ask("() => tippetopLab.track.header.problem")).body.mass == 0.02
    visitor.ask(DROP, ["scan.stl", "solid"])
    page.get_by_text("tippetop body scan.stl --toml").wait_for()
    visitor.ask(DROP, ["wrong.toml", "[body]\nmass = = 1\n"])
    page.get_by_text("wrong.toml, line 2").wait_for()
