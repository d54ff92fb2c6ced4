"""Text that is no problem, however it is meant, is refused in one sentence: in files and
options.
"""

import json

import pytest

import tippetop as tt
from misused import misused
from tippetop.cli.options import Choice
from tippetop.support.errors import short
from tippetop.support.files import LONGEST_TEXT
from tippetop.sweeps import Sweep

PROBLEM = tt.presets.report_problem()
FIELDS = json.loads(PROBLEM.to_json())


def nested(depth):
    return "[" * depth + "1" + "]" * depth


def told(refused, *arguments):
    """What a user is told, which is one sentence on one line."""
    with pytest.raises(tt.TippetopError) as trouble:
        refused(*arguments)
    text = str(trouble.value)
    assert text.isprintable()
    assert len(text) < 600
    return text


def with_option(change):
    return Choice(changes=[change]).changed(PROBLEM)


def with_key(table, key):
    """A problem's JSON with one more key in one of its tables."""
    fields = json.loads(PROBLEM.to_json())
    home = fields
    for name in filter(None, table.split(".")):
        home = home[name]
    home[key] = 1
    return json.dumps(fields)


@pytest.mark.parametrize("table", ["", "body", "body.shape", "friction", "launch", "contact"])
@pytest.mark.parametrize("key", ["self", "cls", "fields", "__class__", "a\nb", "\0", "k" * 300])
def test_a_key_that_python_means_otherwise_is_a_key_like_any(table, key):
    assert "is given for an unknown field" in told(tt.Problem.from_json, with_key(table, key))
    home = f"[{table}]\n" if table else ""
    toml = tt.Problem.from_json(json.dumps(FIELDS)).to_toml()
    line = f"{json.dumps(key)} = 1\n"
    placed = toml.replace(home, home + line, 1) if table else line + toml
    assert "is given for an unknown field" in told(tt.Problem.from_toml, placed)
    told(with_option, f"{table}.{key}=1" if table else f"{key}=1")


@pytest.mark.parametrize("depth", [30, 300, 900, 1000, 5000, 20_000])
def test_what_is_nested_deep_is_refused(depth):
    for text in (f'{{"gravity": {nested(depth)}}}', nested(depth)):
        assert "20 deep" in told(tt.Problem.from_json, text)
    assert "20 deep" in told(tt.Problem.from_toml, f"gravity = {nested(depth)}")
    told(tt.Problem.from_toml, f"[{'.'.join('a' * depth)}]")
    told(with_option, f"gravity={nested(depth)}")
    told(with_option, f"{'.'.join('a' * depth)}=1")
    value = 1.0
    for _ in range(depth):
        value = [value]
    told(lambda: tt.Launch(tilt=value, spin=1.0))
    told(lambda: PROBLEM.replace({"gravity": value}))


@pytest.mark.parametrize("digits", [400, 4300, 4301, 5000, 100_000])
def test_numbers_of_thousands_of_digits_are_refused(digits):
    number = "1" * digits
    told(with_option, f"gravity={number}")
    told(tt.Problem.from_json, json.dumps(FIELDS | {"gravity": "X"}).replace('"X"', number))
    told(tt.Problem.from_toml, f"gravity = {number}")
    told(tt.Problem.from_toml, f"gravity = 0x{number}")
    told(lambda: PROBLEM.replace({"gravity": 10**digits}))


def test_any_value_can_be_shown():
    deep = []
    for _ in range(100_000):
        deep = [deep]
    assert "nested" in short(deep)
    assert "too long" in short(10**5000)


@pytest.mark.parametrize("name", ["a\0b", "n" * 300, "\ud800", "folder/" * 1000, ""])
def test_names_that_no_file_can_have_are_refused(name):
    for read in (tt.Problem.read, Sweep.read, tt.read_run):
        assert "cannot be read" in told(read, name)
    for write in (tt.write_run,):
        told(lambda write=write: write(tt.simulate(PROBLEM, 0.01, samples=2), name, overwrite=True))


def test_files_are_not_read_past_what_a_text_can_have(tmp_path):
    path = tmp_path / "huge.toml"
    with path.open("wb") as file:
        file.truncate(2**43)
    for read in (tt.Problem.read, Sweep.read):
        assert f"more than {LONGEST_TEXT:,} bytes" in told(read, path)
        assert "more than" in told(read, "/dev/zero")


@pytest.mark.parametrize(
    "change",
    [
        {"launch.slip": [1e308, 0.0]},
        {"launch.slip": [0.0, -1e200]},
        {"launch.velocity": [1e308, 0.0, 1e308]},
        {"launch.gap": 1e308},
        {"launch.spin": 1e308},
        {"launch.tilt_rate": 1e200},
    ],
    ids=str,
)
def test_numbers_too_large_to_reckon_with_are_refused(change):
    """Warnings are errors in these tests: nothing is reckoned with such numbers first."""
    ((name, _),) = change.items()
    assert name in told(PROBLEM.replace, change)


@pytest.mark.parametrize(
    "arguments",
    [
        ["--set", f"gravity={'1' * 5000}"],
        ["--set", f"gravity={nested(1000)}"],
        ["--set", "self=1"],
        ["--set", "launch.self=1"],
        ["--set", f"{'n' * 300}=1"],
        ["--set", "launch.slip=[1e308,0]"],
        ["--out", "n" * 300],
        ["n" * 300],
        ["--samples", "1" * 30],
    ],
    ids=lambda arguments: arguments[-1][:20],
)
def test_the_command_line_says_one_sentence(tmp_path, arguments):
    told = misused(tmp_path, "simulate", *arguments)
    assert told.startswith("tippetop: ")
    assert told.count("\n") == 1
    assert list(tmp_path.iterdir()) == []
