"""What `tippetop improve` prints, writes and refuses."""

import json

import pytest
from typer.testing import CliRunner

import tippetop as tt
from tippetop.cli.commands import app

PIECE = tt.design_bowl(radius=0.015, density=720.0, eccentricity=0.15, inertia_ratio=1.2)
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
    assert asked["density"] == 800.0
    assert asked["wall"] == 1e-3
    said("a.toml", "--density", "PLA 20 %", "--mass", "20 g")
    assert asked["density"] == pytest.approx(248.0)
    assert asked["mass"] == 0.02


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
    ],
)
def test_misuse_gets_a_sentence(words, sentence):
    with pytest.raises(tt.InvalidInput, match=sentence):
        CliRunner().invoke(app, ["improve", *words.split()], catch_exceptions=False)
