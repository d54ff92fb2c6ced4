"""Mistakes that people make: each gets a sentence with the field, the value and what to write.

The sentence is the same in Python, in TOML, in JSON, at the command line and in the page; at the
command line the exit code is 2, and there is no traceback.
"""

import json
import re
import sys
import warnings
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import tomli_w

import tippetop as tt
from mistakes import LOST, MISTAKES, fields_with
from node import printed
from tippetop.cli.commands import run
from tippetop.page_engine import HERE
from tippetop.support.errors import short

PROBLEM = tt.presets.report_problem()
PIECE = tt.Workpiece(profile=[(0, -20), (0, 20, 20)], density=700, unit="mm")


def sentence(attempt: Callable[[], Any]) -> str:
    """What is said of an attempt, in one line."""
    with pytest.raises(tt.TippetopError) as refusal:
        attempt()
    said = str(refusal.value)
    assert "\n" not in said
    return said


def at_the_command_line(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], *words: str
) -> str:
    """What the command line says, which is all it says, with exit code 2."""
    monkeypatch.setattr(sys, "argv", ["tippetop", *words])
    with pytest.raises(SystemExit) as ending:
        run()
    out, said = capsys.readouterr()
    assert (ending.value.code, out) == (2, "")
    assert said.startswith("tippetop: ")
    assert said.count("\n") == 1
    return said.removeprefix("tippetop: ").rstrip("\n")


def test_there_are_many() -> None:
    assert len(MISTAKES) + len(OPTIONS) + len(CALLS) >= 200
    assert len({(field, repr(value)) for field, value, *_ in MISTAKES}) == len(MISTAKES)


@pytest.mark.parametrize(("field", "value", "named", "words"), MISTAKES, ids=str)
def test_a_mistake_in_a_problem(field: str, value: Any, named: str, words: str) -> None:
    fields = fields_with(field, value)
    said = sentence(lambda: tt.Problem(**fields))
    assert re.match(rf"{re.escape(named)}(: | is missing)", said)
    assert words in said
    refused = value
    for place in named.removeprefix(field).split(".")[1:]:
        refused = value[int(place)]
    assert value is LOST or short(refused) in said
    assert sentence(lambda: tt.Problem.from_toml(tomli_w.dumps(fields))) == said
    assert sentence(lambda: tt.Problem.from_json(json.dumps(fields))) == said


@pytest.mark.parametrize(
    ("field", "value", "named", "words"),
    [mistake for mistake in MISTAKES if mistake[1] is not LOST],
    ids=str,
)
def test_a_mistake_at_the_command_line(
    field: str,
    value: Any,
    named: str,
    words: str,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    text = value if isinstance(value, str) else json.dumps(value)
    said = at_the_command_line(monkeypatch, capsys, "problem", "--set", f"{field}={text}")
    assert said.startswith(f"{named}: ")
    assert words in said


def test_the_page_says_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    for part in (tt.Friction, tt.Shape):  # without the kinds that other tests define
        built_in = {
            word: kind
            for word, kind in part.kinds.items()
            if kind.__module__.startswith("tippetop.")
        }
        monkeypatch.setattr(part, "kinds", built_in)
    asked = [fields_with(field, value) for field, value, *_ in MISTAKES]
    script = f"""
        import * as m from "{(HERE / "mechanics.js").as_uri()}";
        const said = (fields) => {{
          try {{
            return JSON.stringify(new m.Problem(fields));
          }} catch (error) {{
            return error instanceof m.InvalidInput ? error.message : error.stack;
          }}
        }};
        console.log(JSON.stringify({json.dumps(asked)}.map(said)));
    """
    theirs = json.loads(printed(script))
    ours = [sentence(lambda fields=fields: tt.Problem(**fields)) for fields in asked]
    # There, 10**400 is infinite.
    pairs = [
        (mine, their)
        for mine, their, (_, value, *_) in zip(ours, theirs, MISTAKES, strict=True)
        if value != 10**400
    ]
    assert [their for _, their in pairs] == [mine for mine, _ in pairs]


OPTIONS = [
    ("simulate --spin fast", "--spin: 'fast' is not a number"),
    ("simulate --spin 1,55", "--spin: 1,55 is not a number (write 1.55)"),
    ("simulate --spin 25Hz", "--spin: 25Hz is a frequency, not an angular velocity"),
    ("simulate --tilt 90", "--tilt: 90 is not a number at least 0 and at most pi (for 90"),
    ("simulate --tilt 90rpm", "--tilt: 90rpm is an angular velocity, not an angle"),
    ("simulate --mu 0,3", "--mu: 0,3 is not a number (write 0.3)"),
    ("simulate --mu -1", "--mu: -1 is not a number at least 0"),
    ("simulate --duration long", "--duration: 'long' is not a number (write a number in s"),
    ("simulate --duration 20kg", "--duration: 20kg is a mass, not a time (write it in s"),
    ("simulate --duration 1,5", "--duration: 1,5 is not a number (write 1.5)"),
    ("simulate --duration 0", "--duration: 0 is not a number of seconds greater than 0"),
    ("simulate --duration -1s", "--duration: -1 is not a number of seconds greater than 0"),
    ("simulate --step 1m --integrator rk4", "--step: 1m is a length, not a time"),
    ("simulate --samples 2.5", "--samples: 2.5 is not a whole number"),
    ("simulate --integrator rk5", "--integrator: 'rk5' is not one of"),
    ("simulate --integrator rk4", "--step is missing (write a step size"),
    ("simulate --samples -3", "--samples: -3 is not a whole number"),
    ("simulate --tolerance 0", "--tolerance: 0 is not a number at least 2.2e-16 and less than 1"),
    ("simulate --spin 1e400", "--spin: 1e400 is not a number (write a number nearer to 1)"),
    ("simulate --duration 1e400", "--duration: 1e400 is not a number (write a number nearer to 1)"),
    ("simulate --tolerance 1e400", "--tolerance: 1e400 is not a finite number (write a number"),
    ("simulate --set launch.slip=[1e400,0]", "launch.slip.0: 1e400 is not a number (write a"),
    ("simulate --set launch.spin=Infinity", "launch.spin: 'Infinity' is not a number"),
    ("simulate --set =3", "--set: '=3' is not FIELD=VALUE"),
    ("simulate --preset reprot", "--preset: 'reprot' is not one of"),
    ("simulate --liftoff jump", "--liftoff: 'jump' is not one of fly, stop, ignore"),
    ("simulate --set spin", "--set: 'spin' is not FIELD=VALUE, such as launch.spin=155"),
    ("simulate --spin 1 --set launch.spin=2", "--set launch.spin: 2 is given beside 1"),
    ("simulate --out run.csv", "--out: 'run.csv' is not a file name that ends in .nc"),
    ("simulate --nope", "no such option"),
    ("simulat", "no such command"),
    ("critical --spin 25Hz", "--spin: 25Hz is a frequency"),
    ("sweep --over launch.spin", "--over: 'launch.spin' is not FIELD=FIRST:LAST:COUNT"),
    ("sweep --over launch.spin=a:b:3", "--over: 'launch.spin=a:b:3' is not FIELD="),
    ("sweep --over launch.spin=1:2:x", "--over: 'launch.spin=1:2:x' is not FIELD="),
    ("sweep --over spin=1:2:3", "spin: what is swept is given for an unknown field (did you mean"),
    ("sweep --over launch.spin=1:2:0", "--over launch.spin.count: 0 is not a whole number"),
    ("sweep --draw launch.spin=2:1 --count 3", "--draw launch.spin: 2 to 1 is no range"),
    ("sweep --over launch.spin=1:25Hz:3", "--over launch.spin.from: 1 Hz is a frequency"),
    ("sweep --over launch.tilt=0:90kg:3", "--over launch.tilt.from: 0 kg is a mass, not an angle"),
    ("sweep --over launch.spin=5rpm,5rpm", "--over launch.spin: [0.5235987755982988, 0.5235"),
    ("sweep --draw launch.spin=1:2 --count 3 --over friction.mu=1,2", "--draw: 'launch.spin=1:2'"),
    ("sweep none.toml", "none.toml cannot be read"),
    ("sweep .", ". cannot be read: Is a directory"),
    ("sweep --over body=1,2", "body: what is swept is given for a field that is not a number"),
    (
        "sweep --over launch.slip=1,2",
        "launch.slip: what is swept is given for a field that is not a number (write one of"
        " launch.slip.0, launch.slip.1)",
    ),
    (
        "sweep --draw friction.mu=norm:scale=-1 --count 3",
        "--draw friction.mu: norm with scale = -1 is not a distribution (write a scale above 0)",
    ),
    (
        "sweep --draw friction.mu=beta:a=-1:b=2 --count 3",
        "--draw friction.mu: beta with a = -1, b = 2 is not a distribution (write other",
    ),
    ("sweep --over =1,2", "--over: '=1,2' is not FIELD="),
    ("sweep --over =1:2:3", "--over: '=1:2:3' is not FIELD="),
    ("sweep --draw =1:2 --count 3", "--draw: '=1:2' is not FIELD="),
    ("sweep --draw =norm:loc=3 --count 3", "--draw: '=norm:loc=3' is not FIELD="),
    ("sweep --over launch.spin=1e400:2:3", "--over launch.spin.from: 1e400 is not a number"),
    ("sweep --over launch.spin=1,1e400", "--over launch.spin.values.1: 1e400 is not a number"),
    ("sweep --draw launch.spin=1:1e400 --count 3", "--draw launch.spin.to: 1e400 is not a number"),
    ("sweep --count 3", "--count: 3 is only for --draw (omit it)"),
    ("sweep --over launch.spin=1:2:3 --duration 3m", "--duration: 3m is a length, not a time"),
    ("sweep --over launch.spin=1:2:3 --tolerance 0", "--tolerance: 0 is not a number"),
    ("sweep --over launch.spin=1:2:3 --most-events -3", "--most-events: -3 is not a whole"),
    ("sweep --over launch.spin=1:2:3 --workers 0", "--workers: 0 is not a whole number"),
    ("sweep --draw launch.spin=1:2 --count 3 --seed -1", "--seed: -1 is not a whole number"),
    ("steady --at tilt=9", "--at tilt: 9 is not more than 0"),
    ("steady --at tilt=1e400", "--at tilt: 1e400 is not a number (write a number nearer to 1)"),
    (
        "steady --at tilt=1 --at rate=2 --at radius=20cm --at spin=3",
        "--at tilt, rate, radius, spin: 1, 2, 20cm, 3 do not determine steady states (write two",
    ),
    ("steady --at tilt=400deg", "--at tilt: 400deg is not more than 0 and less than pi rad"),
    ("steady --at tilt=1 --at radius=-1cm", "--at radius: -1cm is not 0 or more, in m"),
    ("steady --at tilt=1 --at rate=0", "--at spin is missing"),
    ("steady --at tilt=1 --at radius=0.2", "friction: this law lets the contact slip, and a"),
    ("improve --preset friedl --goal far", "--goal: 'far' is not one of"),
    ("dataset --count 1 --out runs", "--out: 'runs' is not a file name that ends in .zarr"),
    ("engines --step -1", "--step: -1 is not a time from 1e-06 to"),
    ("dataset --count 0 --out a.zarr", "--count: 0 is not"),
    ("dataset --workers 0 --out a.zarr", "--workers: 0 is not"),
    ("sweep --over launch.spin=1:2:3 --settled 1s", "--settled: 1s is a time, not an angle"),
]
"""Mistakes in options of the command line, and how the sentence begins."""


@pytest.mark.parametrize(("command", "begin"), OPTIONS)
def test_a_mistake_in_an_option(
    command: str,
    begin: str,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    tmp_path: Any,
) -> None:
    monkeypatch.chdir(tmp_path)
    said = at_the_command_line(monkeypatch, capsys, *command.split())
    assert said.startswith(begin)
    assert list(tmp_path.iterdir()) == []


FIT_OPTIONS = [
    ("--starts 0", "--starts: 0 is not a whole number, at least 1"),
    ("--noise -1", "--noise: -1 is not a number greater than 0 in the unit of column tilt"),
    ("--most-runs 0", "--most-runs: 0 is not a whole number, at least 1"),
    ("--vary friction.mu=2:1", "--vary friction.mu: 2 to 1 is not a range"),
    ("--vary friction.nu=2:3", "--vary: 'friction.nu' is not the name of a field"),
    ("--vary friction.mu=2rad:1", "--vary friction.mu: 2rad is an angle"),
    ("--track two", "--track: 'two' is no track of this file"),
    ("--frame-rate 1e400", "--frame-rate: 1e400 is not a finite number (write a number nearer"),
    ("--frame-rate 60", "--frame-rate: 60 is only for a column of frames"),
    ("--noise 1kg", "--noise: 1kg is a mass, not an angle (write it in rad or deg)"),
]
"""The same of the options of a fit to a file."""


FILM_OPTIONS = [
    ("--scale 0.1mm", "--scale: 0.1mm is the size of a pixel, and column x is in mm (leave it"),
    ("--point nose", "--point: 'nose' is not 'tip', 'center'"),
]
"""The same of a film whose columns have units."""


TILTS = "time (s),tilt (rad)\n0,0.1\n0.1,0.12\n0.2,0.14\n"
POINTS = "t,x (mm),y (mm)\n0,1,1\n0.1,2,1\n0.2,3,1\n"


@pytest.mark.parametrize(
    ("table", "options", "begin"),
    [
        *((TILTS, options, begin) for options, begin in FIT_OPTIONS),
        *((POINTS, f"--view above {options}", begin) for options, begin in FILM_OPTIONS),
    ],
)
def test_a_mistake_in_an_option_of_a_fit(
    table: str,
    options: str,
    begin: str,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    tmp_path: Any,
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "film.csv").write_text(table)
    command = ["fit", "film.csv", "--vary", "friction.mu", *options.split()]
    said = at_the_command_line(monkeypatch, capsys, *command)
    assert said.startswith(begin)
    assert "None" not in said


def test_a_column_without_numbers_is_refused_without_warnings(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Any
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "film.csv").write_text("t,tilt\n0,nan\n0.1,nan\n0.2,nan\n")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        said = at_the_command_line(monkeypatch, capsys, "fit", "film.csv", "--vary", "friction.mu")
    assert said == "tilt in film.csv: 0 numbers is not at least two"


def test_a_column_with_the_name_of_an_option_stays_one(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Any
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "film.csv").write_text("time (s),tilt (rad)\n0,0.1\n0.1,high\n0.2,0.14\n")
    command = ["fit", "film.csv", "--vary", "friction.mu", "--tilt", "0.1"]
    said = at_the_command_line(monkeypatch, capsys, *command)
    assert "film.csv" in said
    assert "--tilt" not in said


class Unspeakable:
    """An object whose repr raises."""

    def __repr__(self) -> str:
        raise RuntimeError("no words")


def swept(over: Any) -> Any:
    return tt.sweep(PROBLEM, over, duration=0.1, workers=1)


def bowl(**changes: Any) -> Any:
    fields = {"radius": 0.02, "density": 700.0, "eccentricity": 0.15, "inertia_ratio": 1.2}
    return tt.design_bowl(**(fields | changes))


def insert(**changes: Any) -> Any:
    return tt.design_insert(PIECE, **({"eccentricity": 0.1, "inertia_ratio": 0.95} | changes))


CALLS: list[tuple[Callable[[], Any], str]] = [
    (lambda: tt.simulate(PROBLEM, "long"), "duration: 'long' is not a number"),
    (lambda: tt.simulate(PROBLEM, "3 m"), "duration: 3 m is a length, not a time"),
    (lambda: tt.simulate(PROBLEM, "20"), "duration: 20 is not a number (write 20 without quotes"),
    (lambda: tt.simulate(PROBLEM, None), "duration: None is not a number of seconds"),
    (lambda: tt.simulate(PROBLEM, Unspeakable()), "duration: (Unspeakable, which cannot be shown)"),
    (lambda: tt.simulate(Unspeakable(), 1.0), "problem: (Unspeakable, which cannot be shown)"),
    (lambda: tt.simulate(PROBLEM, 1.0, times=[10**400]), "times: [1000"),
    (lambda: tt.simulate(PROBLEM, 1.0, samples=2.5), "samples: 2.5 is not a whole number"),
    (lambda: tt.Launch(0.1, 155.0), "Launch: (0.1, 155) are values without names"),
    (lambda: tt.Launch(tilt=Unspeakable(), spin=1.0), "tilt: (Unspeakable, which cannot be shown)"),
    (lambda: tt.Launch(tilt=0.1, spin=1.0, mu=0.3), "mu: 0.3 is given for an unknown field (did"),
    (lambda: tt.Problem(body={1: 2}), "body: {1: 2} is not a table of fields by their names"),
    (lambda: PROBLEM.replace({"body.shape": {1: 2}}), "body.shape: {1: 2} is not a table of"),
    (lambda: PROBLEM.replace({"spin": 1.0}), "spin: 1 is given for an unknown field (did you mean"),
    (lambda: swept({"launch.spin": ["1,5"]}), "launch.spin.values.0: 1,5 is not a number (write"),
    (lambda: swept({"launch.spin": ["25 Hz"]}), "launch.spin.values.0: 25 Hz is a frequency"),
    (lambda: swept({"friction.mu": ["3 kg"]}), "friction.mu.values.0: 3 kg is a mass"),
    (lambda: swept({"launch.omega": [1.0]}), "launch.omega: what is swept is given for an unknown"),
    (lambda: swept({"launch.spin": Unspeakable()}), "launch.spin: (Unspeakable, which cannot"),
    (lambda: bowl(radius="x"), "radius: 'x' is not a number"),
    (lambda: bowl(radius=None), "radius: None is not a finite number"),
    (lambda: bowl(radius="2 kg"), "radius: 2 kg is a mass, not a length"),
    (lambda: bowl(density=5e-324), "density: 5e-324 is not a number at least"),
    (lambda: bowl(density=-1), "density: -1 is not a number greater than 0"),
    (lambda: bowl(eccentricity=[]), "eccentricity: [] is not a finite number"),
    (lambda: bowl(inertia_ratio=1j), "inertia_ratio: 1j is not a finite number"),
    (lambda: bowl(stem=Unspeakable()), "stem: (Unspeakable, which cannot be shown)"),
    (lambda: bowl(wall=float("nan")), "wall: nan is not a finite number"),
    (lambda: insert(eccentricity="x"), "eccentricity: 'x' is not a number"),
    (lambda: insert(inertia_ratio=None), "inertia_ratio: None is not a finite number"),
    (lambda: insert(density=True), "density: True is not a finite number"),
    (lambda: insert(wall=10**400), "wall: 1000"),
    (lambda: tt.write_solid(PIECE, "a.stl", facets=10**400), "facets: 1000"),
    (lambda: tt.view(short_run(), theme=np.array([1, 2])), "theme: array([1, 2]) is not one of"),
    (lambda: tt.write_movie(short_run(), "a.gif", speed=5e-324), "speed: 5e-324 is too slow"),
    (
        lambda: tt.write_movie(short_run(), "a.gif", frame_rate=5e-324),
        "frame_rate: 5e-324 is not a number at",
    ),
    (lambda: tt.Launch.from_euler(theta=90), "tilt: 90 is not a number at least 0 and at most pi"),
    (lambda: tt.Launch.from_euler(theta=0.1, psi_dot="5 Hz"), "psi_dot: 5 Hz is a frequency"),
    (lambda: tt.Launch.from_angular_velocity((1, 2), tilt=0.1), "omega: (1, 2) is not 3 finite"),
    (
        lambda: tt.Launch.from_angular_velocity((0, 0, 1), tilt=0.1, frame="space"),
        "frame: 'space' is not one of table, body",
    ),
]
"""Mistakes in calls of Python, and how the sentence begins."""


def short_run() -> Any:
    return tt.simulate(PROBLEM, 0.1, samples=5)


@pytest.mark.parametrize("number", range(len(CALLS)))
def test_a_mistake_in_a_call(number: int, tmp_path: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    call, begin = CALLS[number]
    monkeypatch.chdir(tmp_path)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert sentence(call).startswith(begin)
    assert list(tmp_path.iterdir()) == []
