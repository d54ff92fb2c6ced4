"""Grids: the values they hold, how they are written, and what they refuse."""

import json
import tomllib

import numpy as np
import pytest

from tippetop.errors import FileTrouble, InvalidInput
from tippetop.presets import report_problem
from tippetop.sweep import Axis, Draws, Product, Range, Sweep
from tippetop.sweep.definition import is_sweep, sweep_from
from tippetop.sweep.grid import grid_from


@pytest.mark.parametrize(
    ("text", "values"),
    [
        ("launch.spin=0:250:6", [0, 50, 100, 150, 200, 250]),
        ("friction.mu=0.01:1:3:geo", [0.01, 0.1, 1.0]),
        ("friction.mu=0.5,0.1,0.7", [0.5, 0.1, 0.7]),
        ("launch.spin=3:9:1", [3]),
        ("launch.spin=-1e2", [-100]),
    ],
)
def test_axes_are_read_as_they_are_written(text, values):
    assert Axis.parse(text).values == pytest.approx(values, rel=1e-15)


@pytest.mark.parametrize(
    "text",
    [
        *["launch.spin", "launch.spin=", "launch.spin=1:2", "launch.spin=1:2:3:log", "launch.spin=1:2:x"],
        *["a=1,b", "a=1:1:5", "a=0:1:5:geo", "a=-1:1:5:geo", "a=1:2:0", "a=nan,1", "a=1,1", "a=1:inf:3"],
    ],
)
def test_axes_that_cannot_be_are_refused(text):
    with pytest.raises(InvalidInput, match="accepted"):
        Axis.parse(text)


def test_cells_of_a_product_are_counted_row_by_row():
    grid = Product((Axis.listed("launch.spin", [1, 2]), Axis.listed("friction.mu", [0.1, 0.2, 0.3])))
    values = grid.values(np.arange(6))
    assert values["launch.spin"].tolist() == [1, 1, 1, 2, 2, 2]
    assert values["friction.mu"].tolist() == [0.1, 0.2, 0.3] * 2


def test_draws_follow_from_their_seed_and_not_from_their_number():
    ranges = (Range("launch.spin", 10, 20), Range("friction.mu", 0.01, 1, "log-uniform"))
    few, many, other = Draws(ranges, 10, 7), Draws(ranges, 10_000, 7), Draws(ranges, 10, 8)
    first = np.arange(10)
    for field in few.fields:
        assert few.values(first)[field].tolist() == many.values(first)[field].tolist()
        assert few.values(first)[field].tolist() != other.values(first)[field].tolist()
    everything = many.values(np.arange(10_000))
    assert np.mean(everything["launch.spin"]) == pytest.approx(15, abs=0.15)
    assert np.mean(np.log10(everything["friction.mu"])) == pytest.approx(-1, abs=0.03)
    assert np.corrcoef(everything["launch.spin"], everything["friction.mu"])[0, 1] == pytest.approx(
        0, abs=0.04
    )


@pytest.mark.parametrize("text", ["a", "a=1", "a=1:2:lin", "a=2:1", "a=0:1:log", "a=1:x"])
def test_draws_that_cannot_be_are_refused(text):
    with pytest.raises(InvalidInput, match="accepted"):
        Range.parse(text)


@pytest.mark.parametrize(
    "grid",
    [
        Product((Axis.geometric("friction.mu", 0.1, 1, 5), Axis.listed("launch.tilt", [0.1, 0.2]))),
        Draws((Range("launch.spin", 0, 1),), 5, 3),
    ],
)
def test_sweeps_come_back_from_their_description(grid):
    sweep = Sweep(report_problem(), grid, 3.0, 1e-8, 1e-4)
    assert grid_from(json.loads(json.dumps(grid.describe()))) == grid
    assert sweep_from(json.loads(json.dumps(sweep.describe()))) == sweep


@pytest.mark.parametrize("shape", [(1,), (7,), (1000, 1000), (3, 1, 50, 2), (100_000,), (20, 20)])
def test_tasks_part_the_grid(shape):
    fields = ("launch.spin", "friction.mu", "launch.tilt", "gravity")
    axes = tuple(Axis.linear(field, 0.1, 1, size) for field, size in zip(fields, shape, strict=False))
    sweep = Sweep(report_problem(), Product(axes))
    seen = np.zeros(shape, dtype=int)
    numbers = np.arange(seen.size).reshape(shape)
    for task in sweep.tasks:
        region = sweep.region(task)
        seen[region] += 1
        assert np.array_equal(sweep.numbers(task), numbers[region])
        assert sweep.numbers(task).size <= 4096
    assert np.all(seen == 1)


SWEEP = """
problem = "top.toml"
duration = 2.5
tolerance = 1e-8
settled = 1e-3
[axes]
launch.spin = { from = 0, to = 100, count = 3 }
"friction.mu" = { from = 0.1, to = 1, count = 2, spacing = "geometric" }
body.shape.eccentricity = [0.2, 0.3]
"""


def test_a_sweep_is_read_from_one_file(tmp_path):
    (tmp_path / "top.toml").write_text(report_problem(mu=0.2).to_toml())
    (tmp_path / "sweep.toml").write_text(SWEEP)
    grid = Product(
        (
            Axis.linear("launch.spin", 0, 100, 3),
            Axis.geometric("friction.mu", 0.1, 1, 2),
            Axis.listed("body.shape.eccentricity", [0.2, 0.3]),
        )
    )
    assert Sweep.read(tmp_path / "sweep.toml") == Sweep(report_problem(mu=0.2), grid, 2.5, 1e-8, 1e-3)


def test_draws_are_read_from_a_file(tmp_path):
    text = f"[problem]\n{report_problem().to_toml()}"
    problem = text.replace("[body", "[problem.body").replace("[friction", "[problem.friction")
    problem = problem.replace("[launch", "[problem.launch").replace("[contact", "[problem.contact")
    draws = '\n[draws]\ncount = 4\nseed = 9\nfields.launch.spin = { from = 1, to = 2, law = "log-uniform" }\n'
    (tmp_path / "sweep.toml").write_text(problem + draws)
    wanted = Sweep(report_problem(), Draws((Range("launch.spin", 1, 2, "log-uniform"),), 4, 9))
    assert Sweep.read(tmp_path / "sweep.toml") == wanted


@pytest.mark.parametrize(
    ("change", "field"),
    [
        (("duration = 2.5", "duration = -1"), "duration"),
        (("duration = 2.5", "duraton = 1"), "sweep"),
        (("tolerance = 1e-8", "tolerance = 1e-20"), "tolerance"),
        (("settled = 1e-3", "settled = 0.1"), "settled"),
        (("settled = 1e-3", "settled = nan"), "settled"),
        (("launch.spin", "launch.spn"), "axis"),
        (("count = 3", "count = 3.5"), "axes.launch.spin.count"),
        (("count = 3", "count = true"), "axes.launch.spin.count"),
        (("[0.2, 0.3]", "{ values = 3 }"), "axes.body.shape.eccentricity"),
        (("[0.2, 0.3]", "[1" + 400 * "0" + "]"), "body.shape.eccentricity"),
        (("[0.2, 0.3]", 3000 * "[" + 3000 * "]"), "sweep"),
        (("[axes]", "[axes]\n'launch.spin' = [1]"), "axes"),
        (("count = 3", "cout = 3"), "axes"),
        (('problem = "top.toml"', ""), "problem"),
        (("[0.2, 0.3]", '["a"]'), "body.shape.eccentricity"),
        (("[axes]", "[axis]"), "sweep"),
        (("[axes]", "[axes"), "sweep"),
    ],
)
def test_files_that_cannot_be_are_refused_by_the_field(tmp_path, change, field):
    (tmp_path / "top.toml").write_text(report_problem().to_toml())
    (tmp_path / "sweep.toml").write_text(SWEEP.replace(*change))
    with pytest.raises(InvalidInput) as refusal:
        Sweep.read(tmp_path / "sweep.toml")
    assert refusal.value.field.startswith(field)


def test_values_of_some_cells_are_made_without_the_others():
    laws = ("spin", "lin"), ("tilt", "geo")
    axes = tuple(Axis.parse(f"launch.{name}=0.1:7:10000:{law}") for name, law in laws)
    some = Product(axes).values(np.array([0, 10**4, 10**8 - 1]))
    assert some["launch.spin"].tolist() == [0.1, axes[0].values[1], 7.0]
    assert some["launch.tilt"].tolist() == [0.1, 0.1, 7.0]
    assert axes[0].values == pytest.approx(np.linspace(0.1, 7, 10**4), rel=1e-15)
    assert axes[1].values == pytest.approx(np.geomspace(0.1, 7, 10**4), rel=1e-13)
    draws = Draws((Range("launch.spin", 10, 20), Range("launch.tilt", 1, 2, "log-uniform")), 10**6, 4)
    everything = draws.coordinates()
    for name, values in draws.values(np.array([999_999, 999_990])).items():
        assert values.tolist() == everything[name][1][[999_999, 999_990]].tolist()


def test_a_slip_is_no_axis_where_the_velocity_is_given():
    thrown = report_problem().replace({"launch.velocity": (0.1, 0.0, 0.0)})
    with pytest.raises(InvalidInput, match="velocity"):
        Sweep(thrown, Product((Axis.listed("launch.slip.0", [0.1, 0.2]),)))


def test_a_misspelt_sweep_is_not_taken_for_a_problem(tmp_path):
    (tmp_path / "top.toml").write_text(report_problem().to_toml())
    (tmp_path / "sweep.toml").write_text("\ufeff" + SWEEP)
    assert Sweep.read(tmp_path / "sweep.toml").cells == 12
    assert is_sweep({"problem": "top.toml", "draw": {}})
    assert not is_sweep(tomllib.loads(report_problem().to_toml()))


def test_a_file_that_is_not_there_is_said_to_be_missing(tmp_path):
    with pytest.raises(FileTrouble, match="No such file"):
        Sweep.read(tmp_path / "sweep.toml")


def test_a_sweep_over_nothing_or_over_a_field_twice_is_refused():
    with pytest.raises(InvalidInput):
        Product(())
    with pytest.raises(InvalidInput):
        Product((Axis.listed("launch.spin", [1]), Axis.listed("launch.spin", [2])))
    with pytest.raises(InvalidInput, match="cells"):
        Product((Axis.linear("launch.spin", 0, 1, 10**6), Axis.linear("friction.mu", 0, 1, 10**6)))
