"""What `tippetop improve` prints, writes and refuses."""

import json
from math import cos, sin

import pytest
from typer.testing import CliRunner

import tippetop as tt
from tippetop.cli.commands import app

PIECE = tt.Workpiece(profile=[(0.0, -0.015), (0.0, 0.015, 0.015)], density=720.0)
SIZES = {"radius": 0.015, "wall": 1e-3, "stem": 1.5e-3, "tip": 0.02}
BETTER = tt.ImprovedTop(tt.Body.turned(PIECE), PIECE, "lowest spin", 150.0, float("inf"), SIZES)


@pytest.fixture
def asked(monkeypatch, tmp_path):
    """Return what the search is asked for; it takes minutes, and is not followed."""
    stated = {}

    def improved(body, goal, **options):
        stated.update(body=body, goal=goal, **options)
        return BETTER

    monkeypatch.setattr(tt, "improve", improved)
    monkeypatch.chdir(tmp_path)
    return stated


def said(*words):
    done = CliRunner().invoke(
        app, ["improve", *words], env={"COLUMNS": "200", "TERM": "dumb"}, catch_exceptions=False
    )
    assert done.exit_code == 0
    return done.stdout


def test_people_and_programs_are_told_what_was_claimed(asked):
    lines = said("--preset", "friedl", "--goal", "fastest", "--spin", "1500 rpm", "--trials", "3")
    assert str(BETTER).splitlines()[0] in lines
    assert asked["body"] == tt.presets.FRIEDL
    assert asked["goal"] == "fastest"
    assert asked["spin"] == pytest.approx(157.07963, rel=1e-7)
    assert asked["trials"] == 3
    told = json.loads(said("--preset", "friedl", "--plot", "a.png", "--json"))
    assert told["spin"] == 150.0
    assert told["before"] is None
    assert told["sizes"] == SIZES
    assert tt.Body(**told["body"]) == BETTER.body
    assert told["files"] == {"plot": "a.png"}


def test_a_file_states_the_material_unless_it_is_named(asked, tmp_path):
    (tmp_path / "a.toml").write_text(
        'unit = "mm"\ndensity = 800\nprofile = [[0, -20], [0, 20, 20]]'
    )
    problem = tmp_path / "better.toml"
    problem.write_text(said("a.toml", "--toml"))
    assert tt.Problem.read(problem).body == BETTER.body
    assert asked["density"] is None
    assert asked["body"].density == 800.0
    assert asked["wall"] == 1e-3
    said("a.toml", "--density", "PLA 20 %", "--mass", "20 g")
    assert asked["density"] == pytest.approx(248.0)
    assert asked["mass"] == 0.02


def test_a_file_is_read_as_body_reads_it(asked, tmp_path):
    (tmp_path / "a.csv").write_text("r,z\n0,-20\n0,20,20")
    words = ("a.csv", "--density", "beech")
    with pytest.warns(tt.Implausible, match="the body is 40 m across and 40 m high"):
        said(*words)
    said(*words, "--unit", "mm", "--tolerance", "0.01", "--upside-down")
    assert (asked["body"].unit, asked["body"].tolerance) == ("mm", 0.01)
    points = "\n".join(f"{20 * sin(x / 20)},{-20 * cos(x / 20)}" for x in range(63))
    (tmp_path / "b.csv").write_text(f"r (mm),z (mm)\n{points}\n0,20")
    words = ("b.csv", "--density", "beech")
    remark = "arcs and lines for the 63 edges of the profile"
    assert remark in said(*words)
    assert remark in json.loads(said(*words, "--json"))["remarks"][0]
    lines = CliRunner().invoke(app, ["body", *words, "--no-runs"], env={"COLUMNS": "200"}).stdout
    assert remark in lines


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        ("", "the file of a body, or --preset"),
        ("--preset friedl --goal nicest", "goal: 'nicest'"),
        ("--preset friedl --density mahogny", "--density: 'mahogny'"),
        ("--preset friedl --wall 1s", "--wall"),
        ("--preset friedl --plot a.txt", "--plot: 'a.txt'"),
        ("--preset friedl --json --toml", "--toml: beside --json"),
        ("--preset coin", "ring"),
        ("a.csv", "^--density is missing .write a number in kg/m.3 or a material such as beech"),
        ("none.toml --preset report", "file: 'none.toml' is stated beside --preset"),
        ("--preset report --unit mm", "--unit: 'mm' is only for a file"),
        ("--preset report --goal fastest --spin -5", "^--spin: -5 is not"),
        ("--preset report --spin 150", "^--spin: 150 has no effect where the goal is the lowest"),
        ("--preset report --wall 0", "^--wall: 0 is not"),
        ("--preset report --wall 100mm", "^--wall, --stem: "),
        ("--preset report --trials -1", "^--trials: -1 is not"),
        ("--preset report --mass -1", "^--mass: -1 is not"),
    ],
)
def test_misuse_gets_a_sentence(words, sentence, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "a.csv").write_text("r,z\n0,-20\n0,20,20")
    with pytest.raises(tt.InvalidInput, match=sentence):
        CliRunner().invoke(app, ["improve", *words.split()], catch_exceptions=False)
