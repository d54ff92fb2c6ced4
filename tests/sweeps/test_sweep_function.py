"""Sweeps as they are asked for in Python, and what their datasets say of themselves."""

import numpy as np
import pytest
import xarray as xr

from tippetop.problem.bodies import Body
from tippetop.problem.frictions import RegularizedCoulombFriction, ViscousFriction
from tippetop.problem.launch import Launch
from tippetop.problem.presets import report_problem
from tippetop.problem.problem import Problem
from tippetop.problem.shapes import EccentricSphere, Spheroid
from tippetop.results.cf_flags import decoded, encoded
from tippetop.results.dataframes import to_dataframe
from tippetop.support.errors import FileTrouble, InvalidInput
from tippetop.sweeps import (
    Axis,
    Outcome,
    Product,
    Store,
    Sweep,
    compute,
    read_sweep,
    sweep,
)
from tippetop.sweeps.cells import numeric_fields

OVER = {"launch.spin": np.linspace(50, 200, 3), "friction.mu": [0.1, 0.3]}


def test_fields_and_their_values_are_a_sweep():
    problem = report_problem(tilt=1.0)
    axes = Axis.of("launch.spin", [50, 125, 200]), Axis.of("friction.mu", [0.1, 0.3])
    found = sweep(problem, OVER, duration=0.1, tolerance=1e-8, workers=1)
    computed = compute(Sweep(problem, Product(axes), 0.1, 1e-8))
    xr.testing.assert_identical(found, decoded(computed))
    xr.testing.assert_identical(found, sweep(problem, Product(axes), duration=0.1, tolerance=1e-8))


def test_tables_and_draws_are_sweeps_too():
    problem = report_problem(tilt=1.0)
    geometric = {"launch.spin": {"from": 10, "to": 160, "count": 3, "spacing": "log"}}
    found = sweep(problem, geometric, duration=0.05)
    assert found["spin"].values == pytest.approx([10, 40, 160])
    draws = sweep(problem, draw={"launch.spin": {"from": 10, "to": 20}}, count=4, duration=0.05)
    assert draws["final_tilt"].dims == ("draw",)


def test_a_sweep_is_kept_where_it_is_told_to(tmp_path):
    problem = report_problem(tilt=1.0)
    kept = sweep(problem, OVER, duration=0.1, out=tmp_path / "a.zarr", workers=1)
    xr.testing.assert_identical(kept.load(), sweep(problem, OVER, duration=0.1, workers=1))
    with pytest.raises(FileTrouble, match="exists"):
        sweep(problem, OVER, duration=0.1, out=tmp_path / "a.zarr")
    sweep(problem, OVER, duration=0.1, out=tmp_path / "a.zarr", overwrite=True, workers=1)
    with pytest.raises(InvalidInput, match=r"^overwrite: True .* resume=True"):
        sweep(problem, OVER, duration=0.1, out=tmp_path / "a.zarr", overwrite=True, resume=True)


@pytest.mark.parametrize(
    ("over", "options", "field"),
    [
        ({"launch.spn": [1]}, {}, "launch.spn"),
        ({"launch.spin": [1, 1]}, {}, "launch.spin"),
        ({"launch.spin": np.array([1.0, np.nan])}, {}, "launch.spin.values.1"),
        ({"launch.spin": np.ones((2, 2))}, {}, "launch.spin"),
        ({"launch.spin": 3.0}, {}, "launch.spin"),
        ({}, {}, "over"),
        ("launch.spin", {}, "over"),
        (OVER, {"duration": -1}, "duration"),
        (OVER, {"settled": 1}, "settled"),
        (OVER, {"workers": 0, "duration": 0.1}, "workers"),
    ],
)
def test_what_cannot_be_is_refused_by_what_is_wrong(over, options, field):
    with pytest.raises(InvalidInput, match=r"^[\w.]+(: .| is missing)") as refusal:
        sweep(report_problem(), over, **options)
    assert refusal.value.field == field


UNITS = {
    "launch.spin": "rad s-1",
    "launch.tilt": "rad",
    "launch.slip.0": "m s-1",
    "friction.mu": "s m-1",
    "body.mass": "kg",
    "body.I1": "kg m2",
    "body.shape.radius": "m",
    "body.shape.eccentricity": "1",
    "contact.restitution": "1",
    "gravity": "m s-2",
}


@pytest.mark.parametrize("where", ["memory", "store"])
def test_coordinates_carry_their_units(tmp_path, where):
    problem = report_problem(tilt=1.0)
    at_base = {field: [number_of(problem, field)] for field in UNITS}
    found = sweep(
        problem, at_base, duration=0.01, out=tmp_path / "a.zarr" if where == "store" else None
    )
    told = [found[name].attrs for name in found.coords]
    assert {one["path"]: one["units"] for one in told} == UNITS
    assert found["spin"].attrs["long_name"] == "axial spin at launch"
    assert len({one["long_name"] for one in told}) == len(UNITS)


def number_of(problem, field):
    value = problem
    for step in field.split("."):
        value = value[int(step)] if step.isdecimal() else getattr(value, step)
    return value


def test_draws_carry_units_too():
    ranges = {
        "friction.mu": {"from": 0.1, "to": 0.2},
        "friction.eps": {"from": 0.001, "to": 0.01},
    }
    dry = report_problem().model_copy(update={"friction": RegularizedCoulombFriction(mu=0.1)})
    found = sweep(dry, draw=ranges, count=2, duration=0.01)
    assert [found[name].attrs["units"] for name in ("draw", "mu", "eps")] == [
        "1",
        "1",
        "m s-1",
    ]


PROBLEMS = [
    Problem(
        body=Body(mass=0.02, shape=shape, I1=1e-6, I3=1e-6),
        friction=friction,
        launch=Launch(tilt=0.1, spin=1.0, velocity=velocity),
    )
    for shape in (EccentricSphere(radius=0.02, eccentricity=0.1), Spheroid(across=0.02, along=0.03))
    for friction in (ViscousFriction(mu=0.1), RegularizedCoulombFriction(mu=0.1))
    for velocity in (None, (0.0, 0.0, 0.0))
]


@pytest.mark.parametrize("problem", PROBLEMS)
def test_every_number_of_a_problem_has_a_unit_and_a_name_of_its_own(problem):
    kinds = [problem.quantity(field) for field, _ in numeric_fields(problem)]
    assert all(kind.units for kind in kinds)
    assert len({kind.long_name for kind in kinds}) == len(kinds)


@pytest.mark.parametrize("where", ["memory", "store"])
def test_flags_are_words_or_numbers_as_asked(tmp_path, where):
    out = tmp_path / "a.zarr" if where == "store" else None
    over = {"launch.spin": [10.0, 155.0], "launch.tilt": [0.1, 4.0]}
    options = {"duration": 20.0, "workers": 1, "out": out}
    words = sweep(report_problem(), over, **options)
    numbers = sweep(report_problem(), over, decode=False, overwrite=out is not None, **options)
    assert (words["outcome"] == "inverted").values.tolist() == [[False, False], [True, False]]
    assert (words["fault"] == "value_out_of_range").values.tolist() == [[False, True]] * 2
    assert numbers["outcome"].dtype == np.int8
    assert list(numbers["outcome"].attrs["flag_values"]) == list(map(int, Outcome))
    expected = [[Outcome(n).name.lower() for n in row] for row in numbers["outcome"].values]
    assert words["outcome"].values.tolist() == expected
    numbers = numbers.load()
    xr.testing.assert_identical(decoded(numbers), words.load())
    xr.testing.assert_identical(encoded(words), numbers)
    if out is not None:
        xr.testing.assert_identical(read_sweep(out), words)
        xr.testing.assert_identical(read_sweep(out, decode=False), numbers)


def test_what_is_not_computed_yet_has_no_outcome(tmp_path):
    chosen = Sweep(report_problem(), Product.of({"launch.spin": [10.0, 20.0]}), 0.1)
    Store.create(tmp_path / "a.zarr", chosen)
    empty = read_sweep(tmp_path / "a.zarr")
    assert empty["outcome"].values.tolist() == ["", ""]
    assert empty["is_done"].values.tolist() == [False, False]
    assert encoded(empty)["outcome"].values.tolist() == [-1, -1]


def test_cells_are_picked_by_short_names_and_by_queries():
    found = sweep(report_problem(), {"launch.spin": [50.0, 155.0], "friction.mu": [0.1, 0.3]})
    assert found["spin"].attrs["path"] == "launch.spin"
    assert found.sel(spin=50).sizes == {"mu": 2}
    assert found.query(spin="spin > 100").sizes == {"spin": 1, "mu": 2}
    table = to_dataframe(found)
    turned = table.query("spin > 100 and outcome == 'inverted'")
    assert set(turned["mu"]) == set(
        found["mu"].values[found["outcome"].sel(spin=155.0) == "inverted"]
    )
    assert len(turned) > 0
