"""Grids: the values they hold, how they are written, and what they refuse."""

import json
import math
import re
import tomllib

import numpy as np
import pytest

from tippetop.problem.presets import report_problem
from tippetop.support.errors import FileTrouble, InvalidInput
from tippetop.sweeps import Axis, Draws, Product, Sweep
from tippetop.sweeps.axes import Spaced
from tippetop.sweeps.definition import is_sweep
from tippetop.sweeps.draws import RangeColumn
from tippetop.sweeps.grid import short_names


@pytest.mark.parametrize(
    ("entry", "values"),
    [
        ({"from": 0, "to": 250, "count": 6}, [0, 50, 100, 150, 200, 250]),
        ({"from": 0.01, "to": 1, "count": 3, "spacing": "log"}, [0.01, 0.1, 1.0]),
        ({"from": -4, "to": -1, "count": 3, "spacing": "log"}, [-4, -2, -1]),
        ({"values": [0.5, 0.1, 0.7]}, [0.5, 0.1, 0.7]),
        ([0.5, 0.1, 0.7], [0.5, 0.1, 0.7]),
        (np.array([3, 1]), [3, 1]),
        (range(3), [0, 1, 2]),
        ({"from": 3, "to": 9, "count": 1}, [3]),
    ],
)
def test_axes_are_read_as_they_are_written(entry, values):
    axis = Axis.of("launch.spin", entry)
    assert axis.values == pytest.approx(values, rel=1e-15)
    assert axis.size == len(values)


@pytest.mark.parametrize(
    ("entry", "field"),
    [
        (3.0, "a"),
        ("1:2:3", "a"),
        ([], "a.values"),
        ([1, "b"], "a.values.1"),
        ([math.nan, 1], "a.values.0"),
        ([1, 1], "a"),
        ({"from": 1, "to": 1, "count": 5}, "a"),
        ({"from": 0, "to": 1, "count": 5, "spacing": "log"}, "a"),
        ({"from": -1, "to": 1, "count": 5, "spacing": "log"}, "a"),
        ({"from": 1, "to": 2, "count": 5, "spacing": "geo"}, "a.spacing"),
        ({"from": 1, "to": 2, "count": 0}, "a.count"),
        ({"from": 1, "to": 2, "count": "3"}, "a.count"),
        ({"from": 1, "to": math.inf, "count": 3}, "a.to"),
        ({"from": 1, "count": 3}, "a.to"),
        ({"from": 1, "to": 2, "count": 3, "self": 4}, "a.self"),
    ],
)
def test_axes_that_cannot_be_are_refused_by_what_is_wrong(entry, field):
    with pytest.raises(InvalidInput, match=r"^[\w.]+(: .| is missing)") as refusal:
        Product.of({"a": entry} if not isinstance(entry, dict) else [("a", entry)])
    assert refusal.value.field == field


@pytest.mark.parametrize(
    ("entry", "field"),
    [
        (lambda: RangeColumn("launch.spin", 2, 1), "launch.spin"),
        (lambda: RangeColumn("launch.spin", 2), "launch.spin.to"),
        (lambda: RangeColumn(3, 1, 2), "field"),
        (lambda: Spaced("launch.spin", 1, 1, 2), "launch.spin"),
        (lambda: Spaced("launch.spin", 1, 2, 0), "launch.spin.count"),
        (lambda: Axis.of("launch.spin", 3), "launch.spin"),
        (lambda: Axis.of("launch.spin", ["x"]), "launch.spin.values.0"),
    ],
)
def test_an_axis_or_range_alone_is_refused_by_its_field(entry, field):
    with pytest.raises(InvalidInput) as refusal:
        entry()
    assert refusal.value.field == field


def test_fields_of_words_are_no_axes():
    with pytest.raises(InvalidInput, match=r"friction\.kind.*fields of words cannot be swept"):
        Product.of({"friction.kind": ["viscous", "coulomb"]})


def test_cells_of_a_product_are_counted_row_by_row():
    grid = Product((Axis.of("launch.spin", [1, 2]), Axis.of("friction.mu", [0.1, 0.2, 0.3])))
    values = grid.values(np.arange(6))
    assert values["launch.spin"].tolist() == [1, 1, 1, 2, 2, 2]
    assert values["friction.mu"].tolist() == [0.1, 0.2, 0.3] * 2


def test_draws_follow_from_their_seed_and_not_from_their_number():
    ranges = {
        "launch.spin": {"from": 10, "to": 20},
        "friction.mu": {"from": 0.01, "to": 1, "spacing": "log"},
    }
    few, many = Draws.of(ranges, 10, 7), Draws.of(ranges, 10_000, 7)
    other = Draws.of(ranges, 10, 8)
    first = np.arange(10)
    for field in ("launch.spin", "friction.mu"):
        assert few.values(first)[field].tolist() == many.values(first)[field].tolist()
        assert few.values(first)[field].tolist() != other.values(first)[field].tolist()
    everything = many.values(np.arange(10_000))
    assert np.mean(everything["launch.spin"]) == pytest.approx(15, abs=0.15)
    assert np.mean(np.log10(everything["friction.mu"])) == pytest.approx(-1, abs=0.03)
    assert np.corrcoef(everything["launch.spin"], everything["friction.mu"])[0, 1] == pytest.approx(
        0, abs=0.04
    )


@pytest.mark.parametrize(
    ("entry", "field"),
    [
        ([1, 2], "a"),
        (3.0, "a"),
        ({"from": 1}, "a.to"),
        ({"from": 1, "to": 2, "spacing": "lin"}, "a.spacing"),
        ({"from": 2, "to": 1}, "a"),
        ({"from": 0, "to": 1, "spacing": "log"}, "a"),
        ({"from": 1, "to": math.nan}, "a.to"),
    ],
)
def test_draws_that_cannot_be_are_refused_by_what_is_wrong(entry, field):
    with pytest.raises(InvalidInput, match=r"^[\w.]+(: .| is missing)") as refusal:
        Draws.of({"a": entry}, count=3)
    assert refusal.value.field == field


@pytest.mark.parametrize(
    "grid",
    [
        Product((Spaced("friction.mu", 0.1, 1, 5, "log"), Axis.of("launch.tilt", [0.1, 0.2]))),
        Draws.of({"launch.spin": {"from": 0, "to": 1}}, 5, 3),
        Draws.of({"launch.spin": {"distribution": "gamma", "a": 3.0, "scale": 2.0}}, 5, 3),
    ],
)
def test_sweeps_come_back_from_their_description(grid):
    sweep = Sweep(report_problem(), grid, 3.0, 1e-8, 1e-4)
    again = Sweep(**json.loads(json.dumps(sweep.to_fields())))
    assert again == sweep
    assert again.grid == grid
    assert again.to_fields() == sweep.to_fields()


def test_what_is_written_is_what_is_described():
    tables = {
        "problem": json.loads(report_problem().to_json()),
        "over": {"launch.spin": {"from": 0.0, "to": 9.0, "count": 2, "spacing": "linear"}},
        "duration": 3.0,
        "tolerance": 1e-8,
    }
    assert Sweep(**tables).to_fields() == tables


@pytest.mark.parametrize("shape", [(1,), (7,), (1000, 1000), (3, 1, 50, 2), (100_000,), (20, 20)])
def test_tasks_part_the_grid(shape):
    fields = ("launch.spin", "friction.mu", "launch.tilt", "gravity")
    axes = tuple(Spaced(field, 0.1, 1, size) for field, size in zip(fields, shape, strict=False))
    sweep = Sweep(report_problem(), Product(axes))
    seen = np.zeros(shape, dtype=int)
    numbers = np.arange(seen.size).reshape(shape)
    for task in sweep.tasks:
        region = sweep.region(task)
        seen[region] += 1
        assert np.array_equal(sweep.numbers(region), numbers[region])
        assert sweep.numbers(region).size <= 4096
    assert np.all(seen == 1)


SWEEP = """
problem = "top.toml"
duration = 2.5
tolerance = 1e-8
settled = 1e-3
[over]
launch.spin = { from = 0, to = 100, count = 3 }
"friction.mu" = { from = 0.1, to = 1, count = 2, spacing = "log" }
body.shape.eccentricity = [0.2, 0.3]
"""


def test_a_sweep_is_read_from_one_file(tmp_path):
    (tmp_path / "top.toml").write_text(report_problem(mu=0.2).to_toml())
    (tmp_path / "sweep.toml").write_text(SWEEP)
    grid = Product(
        (
            Spaced("launch.spin", 0, 100, 3),
            Spaced("friction.mu", 0.1, 1, 2, "log"),
            Axis.of("body.shape.eccentricity", [0.2, 0.3]),
        )
    )
    assert Sweep.read(tmp_path / "sweep.toml") == Sweep(
        report_problem(mu=0.2), grid, 2.5, 1e-8, 1e-3
    )


def test_draws_are_read_from_a_file(tmp_path):
    text = f"[problem]\n{report_problem().to_toml()}"
    problem = re.sub(r"^\[(?!problem\])", "[problem.", text, flags=re.MULTILINE)
    spins = '\n[draw]\nlaunch.spin = { from = 1, to = 2, spacing = "log" }\n'
    (tmp_path / "sweep.toml").write_text("count = 4\nseed = 9\n" + problem + spins)
    draws = Draws.of({"launch.spin": {"from": 1, "to": 2, "spacing": "log"}}, 4, 9)
    wanted = Sweep(report_problem(), draws)
    assert Sweep.read(tmp_path / "sweep.toml") == wanted


@pytest.mark.parametrize(
    ("change", "field"),
    [
        (("duration = 2.5", "duration = -1"), "duration"),
        (("duration = 2.5", "duraton = 1"), "duraton"),
        (("tolerance = 1e-8", "tolerance = 1e-20"), "tolerance"),
        (("settled = 1e-3", "settled = 0.1"), "settled"),
        (("settled = 1e-3", "settled = nan"), "settled"),
        (("launch.spin", "launch.spn"), "launch.spn"),
        (("count = 3", "count = 3.5"), "over.launch.spin.count"),
        (("count = 3", "count = true"), "over.launch.spin.count"),
        (("[0.2, 0.3]", "{ values = 3 }"), "over.body.shape.eccentricity"),
        (("[0.2, 0.3]", "[1" + 400 * "0" + "]"), "over.body.shape.eccentricity.values.0"),
        (("[0.2, 0.3]", 3000 * "[" + 3000 * "]"), "sweep"),
        (("[over]", "[over]\n'launch.spin' = [1]"), "over"),
        (("count = 3", "cout = 3"), "over"),
        (('problem = "top.toml"', ""), "problem"),
        (("[0.2, 0.3]", '["a"]'), "over.body.shape.eccentricity.values.0"),
        (("[over]", "[axis]"), "axis"),
        (("[over]", "[axes"), "sweep"),
        (("duration = 2.5", "self = 2.5"), "self"),
        (("[over]", "[over]\nself = [1]"), "self"),
        (("[over]", "[draw]\nself = 3\n[over]"), "draw.self"),
        (("duration = 2.5", "count = 3"), "count"),
        (("[over]", "[over]\n" + "a." * 2000 + "b = [1]"), "sweep"),
        (("[0.2, 0.3]", "{ count = " + 300 * "[" + 300 * "]" + ", from = 1, to = 2 }"), "sweep"),
        (('"top.toml"', "'" + 300 * "x" + "'"), None),
        (('"top.toml"', '"a\\u0000b"'), None),
    ],
)
def test_files_that_cannot_be_are_refused_by_the_field(tmp_path, change, field):
    (tmp_path / "top.toml").write_text(report_problem().to_toml())
    (tmp_path / "sweep.toml").write_text(SWEEP.replace(*change))
    with pytest.raises(InvalidInput if field else FileTrouble) as refusal:
        Sweep.read(tmp_path / "sweep.toml")
    assert field is None or (
        refusal.value.field.startswith(field) and "sweep.toml" in str(refusal.value)
    )
    assert len(str(refusal.value)) < 1000


def test_values_of_some_cells_are_made_without_the_others():
    axes = Spaced("launch.spin", 0.1, 7, 10**4), Spaced("launch.tilt", 0.1, 7, 10**4, "log")
    some = Product(axes).values(np.array([0, 10**4, 10**8 - 1]))
    assert some["launch.spin"].tolist() == [0.1, axes[0].values[1], 7.0]
    assert some["launch.tilt"].tolist() == [0.1, 0.1, 7.0]
    assert axes[0].values == pytest.approx(np.linspace(0.1, 7, 10**4), rel=1e-15)
    assert axes[1].values == pytest.approx(np.geomspace(0.1, 7, 10**4), rel=1e-13)
    ranges = {
        "launch.spin": {"from": 10, "to": 20},
        "launch.tilt": {"from": 1, "to": 2, "spacing": "log"},
    }
    draws = Draws.of(ranges, 10**6, 4)
    everything = draws.coordinates()
    for field, values in draws.values(np.array([999_999, 999_990])).items():
        assert (
            values.tolist()
            == everything[short_names(draws.fields)[field]][1][[999_999, 999_990]].tolist()
        )


def test_a_slip_is_no_axis_where_the_velocity_is_given():
    thrown = report_problem().replace({"launch.velocity": (0.1, 0.0, 0.0)})
    with pytest.raises(InvalidInput, match="velocity"):
        Sweep(thrown, Product((Axis.of("launch.slip.0", [0.1, 0.2]),)))


def test_a_misspelt_sweep_is_not_taken_for_a_problem(tmp_path):
    (tmp_path / "top.toml").write_text(report_problem().to_toml())
    (tmp_path / "sweep.toml").write_text("\ufeff" + SWEEP)
    assert Sweep.read(tmp_path / "sweep.toml").cells == 12
    assert is_sweep({"problem": "top.toml", "drow": {}})
    assert not is_sweep(tomllib.loads(report_problem().to_toml()))


def test_a_file_that_is_not_there_is_said_to_be_missing(tmp_path):
    with pytest.raises(FileTrouble, match="No such file"):
        Sweep.read(tmp_path / "sweep.toml")


def test_a_sweep_over_nothing_or_over_a_field_twice_is_refused():
    with pytest.raises(InvalidInput):
        Product(())
    with pytest.raises(InvalidInput):
        Product((Axis.of("launch.spin", [1]), Axis.of("launch.spin", [2])))
    with pytest.raises(InvalidInput, match="cells"):
        Product((Spaced("launch.spin", 0, 1, 10**6), Spaced("friction.mu", 0, 1, 10**6)))


def test_axes_nested_without_end_or_without_a_name_are_refused_in_a_sentence():
    deep = {"launch": {}}
    inner = deep["launch"]
    for _ in range(3000):
        inner["launch"] = inner = {}
    with pytest.raises(InvalidInput, match="is nested too deep") as refusal:
        Product.of(deep)
    assert len(str(refusal.value)) < 500
    for nameless in (
        {".launch.spin": [1.0, 2.0]},
        {"": {"launch.spin": [1.0, 2.0]}},
        {"launch": {"": [1.0]}},
    ):
        with pytest.raises(InvalidInput, match="is not a name with single dots"):
            Product.of(nameless)


@pytest.mark.parametrize(
    ("fields", "names"),
    [
        (["launch.spin", "friction.mu", "gravity"], ["spin", "mu", "gravity"]),
        (
            ["body.shape.0.radius", "body.shape.1.radius", "body.shape.1.center"],
            ["body.shape.0.radius", "body.shape.1.radius", "center"],
        ),
        (
            ["launch.slip.0", "law.flights", "law.draw"],
            ["launch.slip.0", "law.flights", "law.draw"],
        ),
    ],
)
def test_a_coordinate_has_the_last_word_of_its_field_where_nothing_else_has(fields, names):
    assert short_names(fields) == dict(zip(fields, names, strict=True))
