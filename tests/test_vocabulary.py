"""One name for one thing: over public names, results, files, options and the page's fields.

The names that are chosen stand in the table of the glossary, and the names that are not used for
the same things in its last column and in `REPLACED`.
"""

import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import typer

import tippetop as tt
from tippetop.cli.commands import app
from tippetop.engines.reference import COLUMNS, SCHEMA
from tippetop.problem.problem import Problem
from tippetop.results.catalogue import DERIVED, LISTED, METRICS, MONITORS, SAMPLED, SWEPT
from tippetop.results.summary import summarize
from tippetop.support.validation import declared_fields
from tippetop.sweeps import Sweep
from tippetop.sweeps.store_layout import CONTENTS

ROOT = Path(__file__).parents[1]
GLOSSARY = ROOT / "docs" / "glossary.md"
SURFACE = ROOT / "tests" / "public_surface.txt"

REPLACED = {
    "theta": "tilt",
    "theta_dot": "tilt_rate",
    "phi": "azimuth",
    "phi_dot": "precession",
    "omega3": "spin",
    "omega": "angular_velocity",
    "lift_off": "liftoff",
    "highest": "max_",
    "peak": "max_",
    "least": "min_",
    "arrives": "arrival_time",
    "turns_over": "turnover_time",
    "flip_time": "turnover_time or arrival_time",
    "geometric": "log",
    "geo": "log",
    "lognormal": "lognorm",
    "axes": "over",
    "wrt": "vary",
    "fps": "frame_rate",
    "phase": "mode",
    "phases": "mode",
    "ending": "outcome",
    "advice": "message",
    "lambda": "jellett",
}
"""Names that are not used, and the ones that are."""

PLAIN_ENGLISH = {
    "tt.least_jellett_to_stand",
    "tt.least_straight_spin",
    "tt.Launch.from_euler",
    "tt.extend.Automaton.lift_off",
}
"""Names with one of these words in another meaning: the least of all numbers that suffice, Euler's
angles, and the verb."""


def public_names() -> Iterator[str]:
    """Return every public name, attribute and parameter."""
    for line in SURFACE.read_text(encoding="utf-8").splitlines():
        name, _, parameters = line.partition("(")
        if not name.startswith("tt.") or name in PLAIN_ENGLISH:
            continue
        yield name.rpartition(".")[2].strip()
        yield from re.findall(r"\w+", parameters.removesuffix(")"))


def result_names() -> Iterator[str]:
    """Return the names in runs, sweeps, stores, summaries and the reference suite."""
    for table in (SAMPLED, DERIVED, METRICS, MONITORS, LISTED, SWEPT, CONTENTS, COLUMNS):
        yield from table
    run = tt.simulate(tt.presets.report_problem(), 0.01, samples=2)
    summary = summarize(run)
    yield from (str(name) for name in (*run.variables, *run.dims, *run.attrs))
    yield from (*summary, *summary["final"])
    yield from SCHEMA["properties"]
    yield from (word for kind in (tt.Outcome, tt.Status) for word in (one.name for one in kind))


def file_names() -> Iterator[str]:
    """Return the fields of problems and sweeps as files state them."""
    for name, _ in (*declared_fields(Problem), *declared_fields(Sweep)):
        yield from name.split(".")
    schema = json.dumps(Problem.model_json_schema())
    yield from re.findall(r'"(\w+)":', schema)


def option_names() -> Iterator[str]:
    """Return the options of every command."""
    command: Any = typer.main.get_command(app)
    for one in command.commands.values():
        for parameter in one.params:
            yield from (option.lstrip("-").replace("-", "_") for option in parameter.opts)


def page_names() -> Iterator[str]:
    """Return the fields of the page: those that links, texts and the packed run name."""
    for language in ("en", "de"):
        texts = json.loads((ROOT / "web" / "texts" / f"{language}.json").read_text("utf-8"))
        for part in ("quantities", "metrics", "statuses"):
            yield from (name.rpartition(".")[2] for name in texts[part])
    for file in ("run/pack.js", "lab/units.js", "lab/plots.js", "lab/steps.js", "lab/compare.jsx"):
        text = (ROOT / "web" / "src" / file).read_text("utf-8")
        yield from re.findall(r'"([a-z_0-9]+)"', text)
        yield from re.findall(r'^  ([a-z_0-9]+): "', text, re.MULTILINE)


@pytest.mark.parametrize(
    "names", [public_names, result_names, file_names, option_names, page_names]
)
def test_no_name_is_used_that_another_has_replaced(names: Any) -> None:
    found = {name.lower() for name in names()}
    assert len(found) > 10, "the names are not where this test looks for them"
    wrong = {
        name: REPLACED[word]
        for name in found
        for word in REPLACED
        if re.search(rf"(^|_){word}(_|$)", name)
    }
    assert not wrong


def test_the_same_quantity_has_the_same_name_in_launch_run_steady_state_and_reference() -> None:
    launch = set(tt.Launch.model_fields)
    shared = {"tilt", "azimuth", "tilt_rate", "precession", "spin", "gap", "velocity"}
    assert shared <= launch
    assert shared <= set(SAMPLED)
    assert {"tilt", "precession", "spin"} <= set(tt.SteadyState.__dataclass_fields__)
    assert {"tilt", "azimuth", "tilt_rate", "precession", "spin"} <= set(
        tt.extend.MotionState._fields
    )
    assert {name for name in COLUMNS if "_" not in name} <= set(SAMPLED)


def test_what_is_named_after_a_variable_is_its_value_at_an_instant() -> None:
    for name in METRICS | MONITORS:
        prefix, _, variable = name.partition("_")
        if prefix in ("initial", "final", "max", "min") and not name.endswith(("_time", "_ever")):
            assert variable in SAMPLED, name
            assert (METRICS | MONITORS)[name].units == SAMPLED[variable].units


def test_truth_values_are_booleans_and_say_so() -> None:
    run = tt.simulate(tt.presets.report_problem(), 0.01, samples=2)
    swept = tt.sweep(tt.presets.report_problem(), {"launch.spin": [1.0]}, duration=0.01, workers=1)
    for dataset in (run, swept):
        for name, variable in dataset.variables.items():
            is_named = str(name).startswith(("is_", "has_", "can_"))
            assert (variable.dtype == bool) == is_named, name
    assert bool(swept["is_done"].all())
    assert not bool(swept["is_settled"].any())


def test_the_glossary_lists_the_names_that_are_used() -> None:
    rows = [
        line.split("|") for line in GLOSSARY.read_text("utf-8").splitlines() if line[:3] == "| `"
    ]
    listed = {name for row in rows for name in re.findall(r"`([a-z_0-9]+)`", row[1] + row[2])}
    known = {
        *(name.lower() for names in (public_names, result_names, file_names) for name in names()),
        *(
            "from",
            "to",
            "spacing",
            "distribution",
            "parameter",
            "draw",
            "space",
            "path",
            "is_sampled",
        ),
        *(one.name.lower() for kind in (tt.Outcome, tt.Status) for one in kind),
        *(
            "sliding",
            "sticking",
            "flight",
            "sliding_flat",
            "rolling_flat",
            "resting_flat",
            "sliding_on_1",
        ),
    }
    assert len(listed) > 40
    assert {outcome.name.lower() for outcome in tt.Outcome} <= listed
    assert listed <= known, listed - known
    elsewhere = {word.strip() for row in rows for word in row[3].split(",")}
    assert not elsewhere & listed


def test_options_of_a_sweep_are_the_words_of_its_function_and_its_file() -> None:
    words = {"over", "draw", "count", "seed", "duration", "tolerance", "settled"}
    assert words <= set(Sweep.model_fields)
    assert words <= set(tt.sweep.__annotations__)
    command: Any = typer.main.get_command(app)
    options = {option for one in command.commands["sweep"].params for option in one.opts}
    assert {f"--{word}" for word in words} <= options
