"""Cells as arrays are the same launches as problems, and are refused where problems are."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from campaigns import examples
from strategies import problems
from tippetop.mechanics.top import natural_state, natural_units
from tippetop.problem.frictions import ContensouFriction
from tippetop.problem.presets import REPORT_THIN_STEM, WOODEN, report_problem
from tippetop.problem.problem import top_of
from tippetop.results.catalogue import Fault, Outcome
from tippetop.support.errors import InvalidInput
from tippetop.sweeps import Product, Sweep, compute
from tippetop.sweeps.cells import cells_of, numeric_fields

EDGES = {
    "launch.tilt": [-0.1, 0.0, 1.0, math.pi, 3.2, math.nan],
    "body.I3": [-1e-6, 0.0, 3e-6, 5.98e-6, 6.0e-6, math.inf],
    "friction.mu": [-0.1, 0.0, 1e9],
    "body.shape.eccentricity": [0.0, 0.5, 1.0],
    "launch.slip.1": [0.0, -3.0, math.nan],
    "launch.slip.0": [0.0, 9.0, 40.0, -40.0],
    "contact.restitution": [-0.1, 0.0, 1.0, 1.1],
    "launch.gap": [-1e-3, 0.0, 1e-3],
    "gravity": [0.0, 9.8],
}


def as_problem(problem, field, value):
    """The problem with one number changed, or None where there is no such problem."""
    *parents, last = field.split(".")
    try:
        if not last.isdigit():
            return problem.replace({field: value})
        numbers = list(getattr(problem.launch, parents[-1]))
        numbers[int(last)] = value
        return problem.replace({".".join(parents): tuple(numbers)})
    except InvalidInput:
        return None


@settings(max_examples=examples(check=15, claim=400))
@given(
    problems(),
    st.sampled_from(["body.mass", "body.I1", "launch.tilt", "launch.spin", "friction.mu"]),
)
def test_cells_start_as_their_problems_do(problem, field):
    value = float(dict(_flat(problem.model_dump()))[field])
    values = np.array([value, 0.5 * value, value])
    cells = cells_of(problem, {field: values})
    for index, number in enumerate(values):
        one = as_problem(problem, field, float(number))
        assert (one is None) == (cells.fault[index] != Fault.NONE)
        if one is None:
            continue
        launches = cells.launches(np.array([index]), 3.0)
        units = natural_units(top_of(one))
        numbers = np.array(top_of(one).numbers)
        assert launches.numbers[:, 0] == pytest.approx(numbers, rel=1e-14)
        start = np.array(launches.state.pack())[:, 0]
        wanted = np.array(natural_state(one.start(), units).pack())
        assert start == pytest.approx(wanted, rel=1e-12, abs=1e-13 * max(1.0, np.abs(wanted).max()))
        assert launches.end[0] == pytest.approx(3.0 / units.time, rel=1e-14)


def _flat(table, prefix=""):
    for name, value in table.items():
        if isinstance(value, dict):
            yield from _flat(value, f"{prefix}{name}.")
        else:
            yield f"{prefix}{name}", value


@pytest.mark.parametrize("liftoff", ["fly", "stop", "ignore"])
@pytest.mark.parametrize("field", EDGES)
def test_cells_are_refused_where_problems_are(field, liftoff):
    problem = report_problem(spin=100.0, tilt=1.0, mu=0.5).replace({"contact.liftoff": liftoff})
    cells = cells_of(problem, {field: np.array(EDGES[field])})
    refused = [as_problem(problem, field, value) is None for value in EDGES[field]]
    assert (cells.fault != Fault.NONE).tolist() == refused


def test_cells_whose_patch_does_not_fit_the_body_are_refused():
    patch = {"friction.kind": "contensou", "friction.mu": 0.3, "friction.patch_radius": 1e-3}
    problem = report_problem(tilt=1.0).replace(patch)
    wanted = [Fault.NONE, Fault.VALUE_OUT_OF_RANGE]
    assert (
        list(cells_of(problem, {"friction.patch_radius": np.array([1e-4, 1e-12])}).fault) == wanted
    )
    radius = {"body.shape.radius": np.array([0.02, 1e-4])}
    assert list(cells_of(problem, radius).fault) == wanted
    arms = {"rolling_resistance": np.array([0.02, 1e200])}
    assert list(cells_of(problem, arms).fault) == wanted


def test_cells_compare_a_patch_with_the_largest_surface():
    patch = {"friction.kind": "contensou", "friction.mu": 0.3, "friction.patch_radius": 1e-3}
    problem = report_problem(tilt=1.0).replace({**patch, "body": REPORT_THIN_STEM})
    stem, *others = problem.body.shapes[::-1]
    radii = np.array([1e-12, 0.015, 0.021])
    for body in (problem, problem.replace({"body.shape": [stem, *others]})):
        refused = [as_problem(body, "friction.patch_radius", radius) is None for radius in radii]
        assert refused == [True, False, True]
        assert (
            cells_of(body, {"friction.patch_radius": radii}).fault != Fault.NONE
        ).tolist() == refused


def test_a_cell_is_labelled_with_what_is_wrong_with_it():
    problem = report_problem(tilt=1.0).replace({"contact.liftoff": "stop"})
    assert cells_of(problem, {"launch.tilt": np.array([4.0])}).fault == [Fault.VALUE_OUT_OF_RANGE]
    assert cells_of(problem, {"body.I3": np.array([1.0])}).fault == [Fault.NO_SUCH_BODY]
    assert cells_of(problem, {"launch.slip.0": np.array([40.0])}).fault == [Fault.NO_CONTACT_FORCE]


def test_every_number_of_a_problem_can_be_swept():
    fields = [name for name, _ in numeric_fields(report_problem())]
    assert {
        "launch.spin",
        "friction.mu",
        "body.shape.eccentricity",
        "launch.slip.1",
        "gravity",
    } <= set(fields)
    problem = report_problem()
    for field in fields:
        assert cells_of(problem, {field: np.array([0.3, 0.4])}).fault.shape == (2,)


def test_points_of_a_picture_are_no_numbers_to_sweep():
    problem = report_problem().model_copy(update={"body": WOODEN})
    assert isinstance(problem.body.profile[0], tuple)
    refused = r"body\.profile\.0: what is swept is given for a field that is not a number"
    with pytest.raises(InvalidInput, match=refused):
        cells_of(problem, {"body.profile.0": np.array([1.0])})


def test_a_field_that_is_none_is_refused_with_the_likeliest_meant():
    with pytest.raises(InvalidInput, match=r"did you mean launch\.spin"):
        cells_of(report_problem(), {"launch.spim": np.array([1.0])})


@pytest.mark.parametrize(
    "axes",
    [
        {"launch.spin": [50.0, 1e150, 1e300], "friction.mu": [1e-300, 0.3, 1e200]},
        {"body.mass": [1e-300, 1.0, 1e300], "body.I1": [1e-300, 1e-6, 1e300]},
    ],
)
def test_numbers_that_are_too_large_are_outcomes_and_no_warnings(axes):
    assert compute(Sweep(report_problem(tilt=1.0), Product.of(axes), 0.1))["outcome"].shape == (
        3,
        3,
    )


def test_rolling_that_overflows_is_an_outcome():
    problem = report_problem(spin=100.0, tilt=1.0).replace({"contact.liftoff": "fly"})
    axes = {"launch.spin": [50.0, 1e200], "rolling_resistance": [1e-4, 1e10]}
    outcomes = compute(Sweep(problem, Product.of(axes), 0.1))["outcome"].values
    assert outcomes[0, 0] != Outcome.FAILED
    assert set(outcomes[1]) <= {Outcome.FAILED, Outcome.INVALID}


def test_whether_there_is_a_contact_force_is_told_by_the_branch_of_the_law_at_launch():
    """On drilling's branch friction at this slip would be a thousand times the normal force."""
    patch = ContensouFriction(mu=0.3, patch_radius=1e-3, pressure="hertz")
    changes = {"friction": patch, "contact.liftoff": "stop"}
    slipping = report_problem(tilt=1.0, spin=10.0).replace(changes)
    slips = np.array([-1.0, 1e-3, 1.0])
    cells = cells_of(slipping, {"launch.slip.0": slips})
    assert np.all(cells.fault == Fault.NONE)
