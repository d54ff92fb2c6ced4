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
from tippetop.support.errors import FileTrouble, InvalidInput
from tippetop.sweeps import Axis, Draws, Product, Range, Sweep, compute, sweep
from tippetop.sweeps.cells import numeric_fields

OVER = {"launch.spin": np.linspace(50, 200, 3), "friction.mu": [0.1, 0.3]}


def test_fields_and_their_values_are_a_sweep():
    problem = report_problem(tilt=1.0)
    axes = Axis.of("launch.spin", [50, 125, 200]), Axis.of("friction.mu", [0.1, 0.3])
    found = sweep(problem, OVER, duration=0.1, tolerance=1e-8, workers=1)
    xr.testing.assert_identical(found, compute(Sweep(problem, Product(axes), 0.1, 1e-8)))
    xr.testing.assert_identical(found, sweep(problem, Product(axes), duration=0.1, tolerance=1e-8))


def test_tables_and_draws_are_sweeps_too():
    problem = report_problem(tilt=1.0)
    geometric = {"launch.spin": {"from": 10, "to": 160, "count": 3, "spacing": "geometric"}}
    found = sweep(problem, geometric, duration=0.05)
    assert found["launch.spin"].values == pytest.approx([10, 40, 160])
    draws = sweep(problem, Draws((Range("launch.spin", 10, 20),), 4), duration=0.05)
    assert draws["final_theta"].dims == ("sample",)


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
        ({"launch.spin": np.ones((2, 2))}, {}, "launch.spin.values.0"),
        ({"launch.spin": 3.0}, {}, "launch.spin"),
        ({}, {}, "axes"),
        ("launch.spin", {}, "axes"),
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
    assert {name: found[name].attrs["units"] for name in found.coords} == UNITS
    assert found["launch.spin"].attrs["long_name"] == "axial spin at launch"
    assert len({found[name].attrs["long_name"] for name in UNITS}) == len(UNITS)


def number_of(problem, field):
    value = problem
    for step in field.split("."):
        value = value[int(step)] if step.isdecimal() else getattr(value, step)
    return value


def test_draws_carry_units_too():
    ranges = Range("friction.mu", 0.1, 0.2), Range("friction.eps", 1e-3, 1e-2)
    dry = report_problem().model_copy(update={"friction": RegularizedCoulombFriction(mu=0.1)})
    found = sweep(dry, Draws(ranges, 2), duration=0.01)
    assert [found[name].attrs["units"] for name in ("sample", "friction.mu", "friction.eps")] == [
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
