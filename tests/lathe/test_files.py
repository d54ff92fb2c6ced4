"""Workpieces in TOML, and profiles in CSV and SVG; see `test_drawings` for drawings."""

import math

import pytest

import tippetop as tt
from tippetop.lathe.files import read_workpiece

SVG = '<svg xmlns="http://www.w3.org/2000/svg" viewBox="-1 -1 2 2"><g><path d="{}"/></g></svg>'
MASS = 700.0 * 4 / 3 * math.pi * 0.02**3


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("ball.csv", "r, z, radius\n0,-20\n20,0,20\n\n0,20,20\n"),
        ("ball.csv", "0,20,\n0,-20,-20"),
        ("ball.csv", "# mm\nr;z;radius\n0;-20\n20;0;20\n0;20;20\n;;\n"),
        ("ball.csv", '"r"\t"z"\t"radius"\n0\t-20\n20\t0\t20\n0\t20\t20\n'),
        ("ball.csv", "0 -20\n20   0 20 # the widest place\n0 20 20"),
        ("ball.svg", SVG.format("M 0 20 A 20 20 0 0 0 0 -20 z")),
        ("ball.svg", SVG.format("M0,-20 a20,20 0 1 1 0,40")),
        ("ball.svg", SVG.format("M0-20A20 20 0 0 1 20 0 20 20 0 0 1 0 20")),
        ("ball.toml", 'density = 700\nunit = "mm"\nprofile = [[0, -20], [0, 20, 20]]'),
    ],
)
def test_a_ball_is_read(tmp_path, name, text):
    (tmp_path / name).write_text(text)
    fields = {} if name.endswith("toml") else {"density": 700.0, "unit": "mm"}
    piece = read_workpiece(tmp_path / name, **fields)
    assert piece.mass_properties.mass == pytest.approx(MASS, rel=1e-12)
    assert piece.hull.zones[0][:3] == pytest.approx((0.0, 0.0, 0.02), abs=1e-12)
    assert tt.Body.turned(tmp_path / name, **fields).mass == piece.mass_properties.mass


def test_up_is_up_and_large_arcs_are_large(tmp_path):
    (tmp_path / "ring.svg").write_text(SVG.format("M 20 0 A 5 5 0 1 1 25 -5 L 20 -5 Z"))
    ring = read_workpiece(tmp_path / "ring.svg", density=1.0, unit="m", axis="x=0").mass_properties
    # Three quarters of a disk: by Pappus, with the moment of the quarter below and outside that is
    # missing.
    assert ring.mass == pytest.approx(2 * math.pi * (20 * 75 / 4 * math.pi - 5**3 / 3), rel=1e-12)
    assert ring.center > 5.0
    (tmp_path / "cone.svg").write_text(SVG.format("M 0 0 L 10 -10 H 0"))
    assert read_workpiece(
        tmp_path / "cone.svg", density=1.0, unit="m"
    ).mass_properties.center == pytest.approx(7.5)


def test_profiles_may_be_in_files_beside(tmp_path):
    (tmp_path / "ball.csv").write_text("0,-20\n0,20,20\n")
    (tmp_path / "hole.csv").write_text("0,-10\n0,10,10\n")
    (tmp_path / "mine.toml").write_text(
        'density = 700\nunit = "mm"\nprofile = "ball.csv"\n[[inserts]]\nprofile ='
        ' "hole.csv"\ndensity = 0\n'
    )
    found = read_workpiece(tmp_path / "mine.toml", density=1400.0)
    assert found.mass_properties.mass == pytest.approx(2 * 7 / 8 * MASS, rel=1e-12)


def test_inserts_given_are_left_as_they_were(tmp_path):
    (tmp_path / "ball.csv").write_text("0,-20\n0,20,20\n")
    (tmp_path / "hole.csv").write_text("0,-10\n0,10,10\n")
    inserts = [{"profile": "hole.csv", "density": 0}]
    for _ in range(2):
        found = read_workpiece(tmp_path / "ball.csv", density=700.0, unit="mm", inserts=inserts)
        assert found.mass_properties.mass == pytest.approx(7 / 8 * MASS, rel=1e-12)
    assert inserts == [{"profile": "hole.csv", "density": 0}]


def test_spreadsheets_that_write_decimal_commas_are_read(tmp_path):
    (tmp_path / "comma.csv").write_text("0;0\n1,5;2\n0;3\n")
    (tmp_path / "point.csv").write_text("0,0\n1.5,2\n0,3\n")
    comma, point = (
        read_workpiece(tmp_path / f"{name}.csv", density=700.0) for name in ("comma", "point")
    )
    assert comma.profile == point.profile


@pytest.mark.parametrize(
    ("name", "text", "sentence"),
    [
        ("a.csv", "0,0\n1,x\n0,1\n", ": 1,x is not two or three"),
        ("a.csv", "r,z\n0,0\n1,,2\n0,1\n", ": 1,,2 is not"),
        ("a.csv", "0,O\n1,2\n0,1\n", ": 0,O is not"),
        ("a.csv", "O,-2O\n1,2\n0,1\n", ": 'O,-2O' is not"),
        ("a.csv", "0;0\n1,5 mm;2\n0;3\n", "1.5 mm,2"),
        ("a.csv", "", "0 points"),
        ("a.svg", "<svg", "is not XML"),
        ("a.svg", "<html/>", "a file whose outermost element is <svg>"),
        ("a.svg", "<svg/>", "a drawing without lines"),
        ("a.svg", SVG.format("rubbish"), "a drawing without lines"),
        (
            "a.svg",
            SVG.format("M 0 0 L 1 1 L 5 7"),
            "profile: an open line from (0, 0) to (1.32292",
        ),
        ("a.svg", SVG.format("M 0 0 L 5 1 L 7 9 Z"), "two sides that differ by"),
        (
            "a.svg",
            SVG.format("M 0 0 h 4 v 4 h -4 z M 9 0 h 4 v 4 h -4 z"),
            "which is beside path 1",
        ),
        ("a.toml", "profile = [", "workpiece: 'a.toml' is not TOML ("),
        ("a.toml", "profile = 'b.csv'", "b.csv cannot be read"),
        ("a.toml", "density = 700", "profile in a.toml is missing"),
        (
            "a.toml",
            "density = 700\nprofile = [[0, 0], [1, 1], [0, 1]]\ncolour = 'red'",
            "colour in a.toml: 'red' is given",
        ),
        ("a.txt", "0,0", ".toml, .csv, .svg, .dxf, .stl, .obj, .ply or .off"),
    ],
)
def test_what_cannot_be_read_is_refused(tmp_path, name, text, sentence):
    (tmp_path / name).write_text(text)
    fields = {} if name.endswith("toml") else {"density": 700.0}
    with pytest.raises(tt.TippetopError) as refusal:
        read_workpiece(tmp_path / name, **fields)
    assert sentence in str(refusal.value)


def test_what_is_given_beside_a_file_is_not_said_to_be_in_it(tmp_path):
    (tmp_path / "a.csv").write_text("0,0\n1,1\n0,1\n")
    with pytest.raises(tt.InvalidInput, match=r"^density: -1 is not"):
        read_workpiece(tmp_path / "a.csv", density=-1.0)
    with pytest.raises(tt.InvalidInput, match=r"^density is missing "):
        read_workpiece(tmp_path / "a.csv")


@pytest.mark.parametrize(
    ("bad", "sentence"),
    [
        ("hole.csv", "inserts.0.profile.1.0 in hole.csv: -1 is not"),
        ("ball.csv", "profile.1.0 in ball.csv: -1 is not"),
    ],
)
def test_the_file_of_the_points_is_named_where_they_cannot_be(tmp_path, bad, sentence):
    (tmp_path / "ball.csv").write_text("0,-20\n0,20,20\n")
    (tmp_path / "hole.csv").write_text("0,-10\n0,10,10\n")
    (tmp_path / bad).write_text("0,-10\n-1,0\n0,10\n")
    beside = 'profile = "{}"\ndensity = {}\n[[inserts]]\nprofile = "{}"\ndensity = 0\n'
    (tmp_path / "mine.toml").write_text(beside.format("ball.csv", 700, "hole.csv"))
    with pytest.raises(tt.InvalidInput, match=f"^{sentence}"):
        read_workpiece(tmp_path / "mine.toml")
    (tmp_path / "mine.toml").write_text(beside.format("ball.csv", -1, "hole.csv"))
    with pytest.raises(tt.InvalidInput, match=r"^density in mine.toml: -1 is not"):
        read_workpiece(tmp_path / "mine.toml")


def test_what_is_not_installed_is_said(tmp_path, monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "ezdxf", None)
    (tmp_path / "a.dxf").write_text("")
    with pytest.raises(tt.Unavailable, match=r"\[lathe\]"):
        read_workpiece(tmp_path / "a.dxf", density=1.0)
