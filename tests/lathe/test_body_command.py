"""What `tippetop body` prints, writes and refuses."""

import json
import math
from importlib import import_module

import pytest
from typer.testing import CliRunner

import tippetop as tt
from misused import misused
from tippetop.cli.commands import app
from tippetop.figures.section import section

TOP = """
unit = "mm"
density = 700
profile = [[0, -15], [15, 0, 15], [9, 12, 15], [2.5, 12], [2.5, 16], [0, 18.5, 2.5]]
inserts = [{profile = [[0, 2], [11, 3], [7, 10.5], [0, 10.5]], density = 0}]
"""
BALL = (
    'unit = "mm"\ndensity = 700\nprofile = [[0, -20], [0, 20, 20]]\n'
    "inserts = [{profile = [[0, 2], [0, 18, 8]], density = 0}]"
)


@pytest.fixture
def files(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "top.toml").write_text(TOP)
    (tmp_path / "ball.toml").write_text(BALL)
    (tmp_path / "bowl.csv").write_text("0,-20\n20,0,20\n0,0\n")
    return tmp_path


def said(*words, code=0):
    done = CliRunner().invoke(app, ["body", *words], env={"COLUMNS": "200", "TERM": "dumb"})
    assert done.exit_code == code, done.output
    return done.stdout


def test_programs_are_told_what_the_theory_and_the_profile_say(files):
    told = json.loads(said("ball.toml", "--json", "--no-runs"))
    body = tt.Body.turned(files / "ball.toml")
    assert [told["mass"], told["I1"], told["I3"]] == [body.mass, body.I1, body.I3]
    assert told["eccentricity"] == pytest.approx(body.shape.eccentricity, rel=1e-12)
    launch = tt.Launch(tilt=told["omega_c_tilt"], spin=1.0)
    spins = tt.critical_spins(
        tt.Problem(body=body, friction=tt.ViscousFriction(mu=0.1), launch=launch)
    )
    assert told["omega_c1"] == (
        None if spins.upright == float("inf") else pytest.approx(spins.upright)
    )
    assert told["omega_c2"] == pytest.approx(spins.inverted)
    assert told["trouble"] is None
    assert told["stem"] is told["stands_from"] is None
    (surface,) = told["surfaces"]
    assert surface["kind"] == "sphere"


def test_people_are_told_too(files):
    lines = said("top.toml", "--no-runs")
    assert "Cannot be simulated" not in lines
    assert lines.startswith("Group ")
    for text in (
        "mass",
        "stands on its stem above",
        "comes down to the table",
        "touches in two points or a line at tilt",
        "2.46746",
    ):
        assert text in lines
    assert "upright spin unstable above" in lines
    assert "inverted spin stable above" not in lines, "the top stands on its stem there"
    assert "inverted spin stable above" in said("ball.toml", "--no-runs")
    cut_off = said("bowl.csv", "--density", "700", "--unit", "mm", code=2)
    assert "Cannot be simulated: profile: a sphere of which only tilts" in cut_off
    assert "--whole" in cut_off
    assert "lies flat" in cut_off
    assert "up to a tilt of 1.5708" in cut_off
    assert "Cannot be simulated" not in said(
        "bowl.csv", "--density", "700", "--unit", "mm", "--whole", "--no-runs"
    )


@pytest.mark.slow
def test_a_top_that_theory_has_stand_and_drilling_does_not_let_is_told_by_runs(files):
    told = json.loads(said("top.toml", "--json"))
    assert told["stem"]["least_launch_spin"] < 300.0, "without loss while both touch it would stand"
    assert told["stands_from"] is None
    assert "no spin" in " ".join(said("top.toml").split())
    body = tt.Body.turned(files / "top.toml")

    def highest(spin):
        patch = tt.ContensouFriction(mu=0.3, patch_radius=5e-4)
        launch = tt.Launch(tilt=0.1, spin=spin)
        run = tt.simulate(tt.Problem(body=body, friction=patch, launch=launch), 20.0, samples=2)
        return float(run["max_tilt"])

    assert max(map(highest, (150.0, 300.0, 600.0))) < math.pi - 0.1


def test_the_problem_is_one_that_is_simulated(files):
    written = said("ball.toml", "--toml")
    assert "  # kg: mass of the body\n" in written
    (files / "problem.toml").write_text(written)
    assert tt.Problem.read(files / "problem.toml").body == tt.Body.turned(files / "ball.toml")


def test_a_problem_has_the_remarks_on_its_file_in_comments(files):
    places = [(20.0 * math.sin(x / 20.0), -20.0 * math.cos(x / 20.0)) for x in range(63)]
    points = "\n".join(f"{r},{z}" for r, z in places)
    (files / "points.csv").write_text(f"r (mm),z (mm)\n{points}\n0,20")
    options = ("points.csv", "--density", "beech")
    remarks = json.loads(said(*options, "--json", "--no-runs"))["remarks"]
    assert remarks
    written = said(*options, "--toml")
    assert all(f"# {line}\n" in written for remark in remarks for line in remark.splitlines())
    (files / "problem.toml").write_text(written)
    assert tt.Problem.read(files / "problem.toml").body.mass > 0.0


def test_body_and_improve_look_at_one_launch(files, monkeypatch):
    """Of what is written, at the spin that is written: not of a body that hardly spins."""
    seen = []
    implausible = import_module("tippetop.problem.implausible")
    monkeypatch.setattr(implausible, "warn_if_implausible", seen.append)
    monkeypatch.setattr(tt, "improve", misused)
    said("ball.toml", "--json", "--no-runs")
    CliRunner().invoke(app, ["improve", "ball.toml"])
    of_body, of_improve = seen
    assert of_body == of_improve
    assert of_body.launch.spin == 155.0


def test_the_problem_is_the_one_of_its_runs(files, monkeypatch):
    """What is written is what is followed to say from which spin a body stands."""
    followed = []

    def least(problem):
        followed.append(problem)
        return 100.0

    monkeypatch.setattr(import_module("tippetop.fit.standing"), "least_standing_spin", least)
    assert json.loads(said("top.toml", "--json"))["stands_from"] == 100.0
    (files / "problem.toml").write_text(said("top.toml", "--toml"))
    written = tt.Problem.read(files / "problem.toml")
    assert written.replace({"launch.spin": followed[0].launch.spin}) == followed[0]


def test_files_are_written_once(files):
    pytest.importorskip(
        "trimesh", reason="solids are written with trimesh; it comes with the lathe extra"
    )
    names = ["--no-runs", "--plot", "a.png", "--stl", "a.stl", "--3mf", "a.3mf"]
    assert said("top.toml", *names).count("wrote ") == 3
    sizes = {path.name: path.stat().st_size for path in files.glob("a.*")}
    assert set(sizes) == {"a.png", "a.stl", "a.3mf"}
    assert min(sizes.values()) > 1000
    assert json.loads(said("top.toml", *names, "--json", "--force"))["files"]["3mf"] == "a.3mf"


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        ("top.toml --plot a.txt", "--plot: 'a.txt' is not"),
        ("top.toml --stl a.3mf", "--stl: 'a.3mf' is not"),
        ("top.toml --stl ball.toml.stl --json --toml", "--toml: beside --json asks for two"),
        ("bowl.csv", "--density is missing"),
        ("bowl.csv --density 700 --unit ft", "--unit: 'ft' is not"),
        ("bowl.csv --density -1", "--density: -1 is not"),
        ("bowl.csv --density 700 --toml", "profile: a sphere of which only tilts"),
        ("none.toml", "none.toml cannot be read"),
        ("top.toml --plot taken.png", "taken.png exists"),
    ],
)
def test_misuse_is_refused_in_one_sentence_and_nothing_is_written(files, words, sentence):
    (files / "taken.png").write_text("mine")
    before = sorted(files.iterdir())
    done = CliRunner().invoke(app, ["body", *words.split()])
    assert isinstance(done.exception, tt.TippetopError)
    assert str(done.exception).startswith(sentence)
    assert "\n" not in str(done.exception)
    assert done.stdout == ""
    assert sorted(files.iterdir()) == before


def test_misuse_ends_with_exit_code_2(files):
    (files / "taken.png").write_text("mine")
    told = misused(".", "body", "top.toml", "--plot", "taken.png")
    assert told == "tippetop: taken.png exists; it is overwritten only with --force\n"


def test_a_section_shows_every_surface(files):
    piece = tt.Workpiece(
        unit="mm", density=1.0, profile=[(0, 0), (18, 0), (20, 2, 2), (20, 10), (0, 10)]
    )
    (legend,) = section(piece).legends
    assert [text.get_text().split(",")[0] for text in legend.get_texts()] == ["ring", "edge"]
    axes = section(piece).axes[0]
    low, high = axes.get_xlim()
    assert low < -20 < 20 < high


TOP_HEAVY = """
unit = "in"
density = 2700
profile = [
  [0, -0.5], [0.5, 0, 0.5], [0.35355339, 0.35355339, 0.5],
  [0.125, 0.35355339], [0.125, 0.875], [0, 1.0, 0.125],
]
"""


def test_a_top_heavy_body_is_said_not_to_turn_over(files):
    (files / "heavy.toml").write_text(TOP_HEAVY)
    with pytest.warns(tt.Implausible, match="above the ball's centre: it does not turn over"):
        done = CliRunner().invoke(app, ["body", "heavy.toml", "--no-runs"])
    assert done.exit_code == 0
