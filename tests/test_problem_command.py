"""`tippetop problem`: what it writes reads back as it was, with every number explained."""

import re

import pytest
from hypothesis import given
from typer.testing import CliRunner

import tippetop as tt
from strategies import problems
from tippetop.cli.commands import app
from tippetop.cli.problem import commented_toml
from tippetop.problem.presets import report_problem

NUMBER = re.compile(r"(\w+ = )?-?\d\S*,?(  # .+)?", re.ASCII)


@given(problems())
def test_comments_change_nothing(problem):
    assert tt.Problem.from_toml(commented_toml(problem)) == problem


@given(problems())
def test_every_number_is_explained(problem):
    numbers = [
        line.strip() for line in commented_toml(problem).splitlines() if NUMBER.match(line.strip())
    ]
    assert len(numbers) >= 8
    assert [line for line in numbers if "  # " not in line] == []


@pytest.mark.parametrize("body", tt.presets.BODIES.values(), ids=tt.presets.BODIES)
def test_every_body_that_is_known_is_written_with_its_profile(body):
    problem = report_problem().model_copy(update={"body": body})
    text = commented_toml(problem)
    assert tt.Problem.from_toml(text) == problem
    assert not [line for line in text.splitlines() if line.strip("[], ").startswith("#")]


def test_units_are_those_of_the_fields():
    text = commented_toml(report_problem())
    assert "gravity = 9.8  # m/s^2: acceleration of gravity\n" in text
    assert "mu = 0.3  # s/m: friction coefficient\n" in text
    assert re.search(
        r"I1 = \S+  # kg m\^2: moment of inertia transverse to the axis of symmetry\n", text
    )
    assert (
        "eccentricity = 0.3  # distance of the centre of mass from the centre, in radii\n" in text
    )
    assert 'liftoff = "fly"  # "fly" or "stop" or "ignore"\n' in text


def test_both_components_of_slip_say_which_they_are():
    slip = commented_toml(report_problem()).partition("slip = [")[2].splitlines()[1:3]
    assert "along the direction" in slip[0]
    assert "90 degrees to the left" in slip[1]


def test_the_command_prints_it():
    printed = CliRunner().invoke(app, ["problem", "--spin", "90"])
    assert printed.exit_code == 0
    assert printed.stdout.rstrip() == commented_toml(report_problem(spin=90.0)).rstrip()
    assert "spin = 90.0  # rad/s: axial spin at launch" in printed.stdout
