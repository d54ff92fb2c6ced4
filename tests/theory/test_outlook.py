"""What the theory says of a launch: of every launch something, and of the special ones the
truth.
"""

import itertools
import json
import math
import random
import re
import warnings

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from typer.testing import CliRunner

from campaigns import among, examples
from tippetop import presets
from tippetop.cli.commands import app
from tippetop.problem.frictions import ViscousFriction
from tippetop.problem.problem import Problem, top_of
from tippetop.support.errors import InvalidInput
from tippetop.theory.averaging import arrival_time_limit, nutation_of_launch
from tippetop.theory.groups import Group
from tippetop.theory.outlook import outlook
from tippetop.theory.prediction import steady_state_of_launch
from tippetop.theory.stability import spectrum
from tippetop.theory.steady import FASTEST, SteadyKind, precession_branch, vertical_spin

AXIAL_INERTIA = 3.2e-6


def sphere(gamma, alpha):
    shape = {"kind": "eccentric_sphere", "radius": 0.02, "eccentricity": alpha}
    return {"mass": 0.02, "shape": shape, "I1": gamma * AXIAL_INERTIA, "I3": AXIAL_INERTIA}


def spheroid(across, along):
    shape = {"kind": "spheroid", "across": across, "along": along}
    return {"mass": 0.02, "shape": shape, "I1": 4e-6, "I3": 2.6e-6}


BODIES = {
    "report": presets.REPORT.model_dump(),
    "Ia": sphere(0.6, 0.3),
    "Ib": sphere(0.9, 0.05),
    "IIa": sphere(1.0, 0.3),
    "IIb": sphere(0.75, 0.3),
    "IIc": sphere(0.975, 0.05),
    "III": sphere(1.5, 0.3),
    "between I and II": sphere(0.7, 0.3),
    "between II and III": sphere(1.3, 0.3),
    "all but centred": sphere(1.0, 1e-6),
    "all but outside": sphere(1.0, 0.999),
    "egg": spheroid(0.02, 0.03),
    "lentil": spheroid(0.02, 0.01),
    "ball": spheroid(0.02, 0.02),
}
FRICTION = [
    {"kind": kind, "mu": mu}
    for kind in ("viscous", "regularized_coulomb")
    for mu in (0.3, 1e-12, 0.0)
]
NEAR = [0.0, 1e-300, 1e-160, 1e-12, 1e-8, 1e-4]
TILTS = [
    *NEAR,
    0.1,
    1.0,
    math.pi / 2,
    2.0,
    3.1415,
    math.nextafter(math.pi, 0.0),
    *(math.pi - d for d in NEAR),
]
SPINS = [0.0, 1e-300, 1e-8, 1.0, -20.0, 50.0, 100.0, 1e3, -1e6, 1e9, 1e100, 1e308, -1e308]
RATES = [
    (0.0, 0.0),
    (5.0, 0.0),
    (0.0, 20.0),
    (0.0, -20.0),
    (-3.0, 7.0),
    (1e9, 0.0),
    (0.0, -1e8),
    (1e154, 1e200),
]


def launch_of(body, friction, tilt, spin, rates, **more):
    """The problem, or None where no problem can be so."""
    tilt_rate, precession = rates
    launch = {"tilt": tilt, "spin": spin, "tilt_rate": tilt_rate, "precession": precession, **more}
    try:
        return Problem(body=BODIES[body], friction=friction, launch=launch)
    except InvalidInput:
        return None


def said(problem):
    """What the theory says, without any warning; None where it says that nothing turns so fast."""
    launch = problem.launch
    fastest = max(abs(launch.spin), abs(launch.tilt_rate), abs(launch.precession))
    fastest *= math.sqrt(top_of(problem).surface.size / problem.gravity)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        if fastest <= FASTEST * (1.0 + 1e-12):
            return outlook(problem)
        with pytest.raises(
            InvalidInput, match=r"launch\.(spin|tilt_rate|precession): .* \(write at most"
        ):
            outlook(problem)
        return None


def check_what_is_said(problem):
    """The parts of an answer fit each other."""
    found = said(problem)
    if found is None:
        return
    assert found.critical_spins.upright > -math.inf
    assert found.critical_spins.inverted > -math.inf
    assert all(np.isfinite(judged.spectrum.eigenvalues).all() for judged in found.steady)
    if found.prediction is not None:
        assert set(found.prediction.reachable) <= set(found.prediction.stable)
        assert found.prediction.final in [judged.state for judged in found.steady]
    if found.swings is not None:
        low, high = found.swings
        assert 0.0 <= low <= problem.launch.tilt <= high <= math.pi
    if found.arrival_time is not None:
        assert found.arrival_time >= 0.0
        assert found.arrival_time_needs is None
    elif found.group is not None and found.stays is None and 0.0 < problem.launch.tilt < math.pi:
        viscous = isinstance(problem.friction, ViscousFriction) and problem.friction.mu
        assert (found.arrival_time_needs is not None) == bool(viscous)


@pytest.mark.parametrize("body", among(list(BODIES), check=4))
def test_every_launch_gets_an_answer_or_a_refusal(body):
    """A part of all combinations, the same in every run, and all that are set down without
    rates.
    """
    combinations = list(itertools.product([body], FRICTION, TILTS, SPINS, RATES))
    plain = [some for some in combinations if some[-1] == RATES[0] and some[1]["mu"] != 1e-12]
    count = examples(check=12, claim=30)
    chosen = [random.Random(body).sample(launches, count) for launches in (combinations, plain)]
    for some in itertools.chain(*chosen):
        problem = launch_of(*some)
        if problem is not None:
            check_what_is_said(problem)


@settings(max_examples=examples(check=10, claim=600), deadline=None)
@given(
    st.sampled_from(list(BODIES)),
    st.sampled_from(FRICTION),
    st.floats(0.0, math.pi),
    st.floats(allow_nan=False, allow_infinity=False),
    st.tuples(st.floats(-1e9, 1e9), st.floats(-1e9, 1e9)),
)
def test_any_launch_gets_an_answer_or_a_refusal(body, friction, tilt, spin, rates):
    problem = launch_of(body, friction, tilt, spin, rates)
    if problem is not None:
        check_what_is_said(problem)


@pytest.mark.parametrize(
    ("group", "body"), [(Group(name), name) for name in BODIES if name in tuple(Group)]
)
def test_there_is_a_body_of_every_group(group, body):
    assert outlook(launch_of(body, FRICTION[0], 0.1, 100.0, (0.0, 0.0))).group is group


@pytest.mark.parametrize("body", ["report", "III"])
@pytest.mark.parametrize(
    ("pole", "kind"), [(0.0, SteadyKind.UPRIGHT), (math.pi, SteadyKind.INVERTED)]
)
def test_the_time_to_leave_a_pole_grows_as_the_logarithm_of_the_distance(body, pole, kind):
    """By a growth rate that is the one of the spectrum, and proportional to little friction."""
    spin, mu = 60.0, 1e-6
    top = top_of(launch_of(body, {"kind": "viscous", "mu": mu}, pole, spin, (0.0, 0.0)))
    rate = spectrum(vertical_spin(kind, top, spin), top).growth_rate / mu
    if rate < 0.0:
        pytest.skip("there it does not leave")
    distances = [1e-5, 1e-8, 1e-12] + ([1e-300] if pole == 0.0 else [])
    times = [
        arrival_time_limit(launch_of(body, FRICTION[0], abs(pole - d), spin, (0.0, 0.0)))
        for d in distances
    ]
    logs = -np.log([abs(pole - abs(pole - d)) for d in distances])
    assert np.diff(times) / np.diff(logs) == pytest.approx(1.0 / rate, rel=1e-3)


@pytest.mark.parametrize(("body", "spin"), [("report", 300.0), ("Ia", -60.0), ("III", 20.0)])
def test_theory_at_a_pole_is_the_limit_of_theory_near_it(body, spin):
    for pole, beside in ((0.0, 1e-7), (math.pi, math.pi - 1e-7)):
        there, near = (
            outlook(launch_of(body, FRICTION[0], tilt, spin, (0.0, 0.0))) for tilt in (pole, beside)
        )
        assert there.prediction.final.tilt == pytest.approx(near.prediction.final.tilt, abs=1e-5)
        assert there.critical_spins.upright == pytest.approx(near.critical_spins.upright, rel=1e-9)
        assert there.critical_spins.inverted == pytest.approx(
            near.critical_spins.inverted, rel=1e-9
        )


@pytest.mark.parametrize("mu", [0.0, 0.3])
@pytest.mark.parametrize("body", ["report", "egg"])
@pytest.mark.parametrize(
    ("tilt", "kind"), [(0.0, SteadyKind.UPRIGHT), (math.pi, SteadyKind.INVERTED)]
)
def test_a_launch_exactly_on_a_vertical_spin_stays_there(mu, body, tilt, kind):
    problem = launch_of(body, {"kind": "viscous", "mu": mu}, tilt, 100.0, (0.0, 20.0))
    found = outlook(problem)
    assert (found.stays.state.kind, found.stays.state.spin) == (kind, 100.0)
    assert found.arrival_time is None
    for field, value in (
        ("tilt_rate", 1e-6),
        ("slip", (1e-6, 0.0)),
        ("gap", 1e-6),
        ("velocity", (0.0, 0.0, 1e-6)),
        ("tilt", abs(tilt - 1e-6)),
    ):
        assert steady_state_of_launch(problem.replace({f"launch.{field}": value})) is None


@pytest.mark.parametrize("tilt", [1.9, 2.5])
def test_a_launch_exactly_on_a_precession_stays_there(tilt):
    top = top_of(presets.report_problem())
    branch = precession_branch(top, np.array([tilt]))
    on = {"launch.precession": float(branch.precession[0]), "launch.spin": float(branch.spin[0])}
    problem = presets.report_problem(tilt=tilt).replace(on)
    found = outlook(problem)
    assert found.stays.state.kind is SteadyKind.PRECESSION
    assert found.stays.spectrum.stable
    assert found.prediction.final.tilt == pytest.approx(tilt, abs=1e-9)
    for field in on:
        assert steady_state_of_launch(problem.replace({field: on[field] * (1.0 + 1e-8)})) is None


def test_an_egg_on_its_side_stays_there():
    problem = launch_of("egg", FRICTION[0], math.pi / 2, 0.0, (0.0, 30.0))
    assert steady_state_of_launch(problem).kind is SteadyKind.LEVEL
    assert steady_state_of_launch(problem.replace({"launch.spin": 1.0})) is None


@pytest.mark.parametrize("kind", ["viscous", "regularized_coulomb"])
def test_without_friction_nothing_ends_and_the_tilt_swings(kind):
    found = outlook(launch_of("report", {"kind": kind, "mu": 0.0}, 0.3, 40.0, (0.0, 5.0)))
    assert found.prediction is None
    assert found.mu_arrival_time is None
    assert found.arrival_time is None
    problem = launch_of("report", FRICTION[0], 0.3, 40.0, (0.0, 5.0))
    assert found.swings == nutation_of_launch(problem).tilts
    assert 0.3 in (
        pytest.approx(found.swings[0], abs=1e-9),
        pytest.approx(found.swings[1], abs=1e-9),
    )
    assert outlook(problem).swings is None


def critical(*options, columns=80):
    result = CliRunner().invoke(app, ["critical", *options], env={"COLUMNS": str(columns)})
    assert result.exit_code == 0, result.output
    return result.output


def test_the_command_tells_what_stays_what_swings_and_what_its_spins_are_for():
    assert "0.2 rad" in critical("--tilt", "0.2")
    stays = critical("--tilt", "0", "--spin", "100")
    assert "stays exactly on" in stays
    assert "until disturbed" in stays
    assert "and then ends as" in stays
    assert "ends as" not in critical("--tilt", "0", "--spin", "20")
    smooth = critical("--mu", "0", "--tilt", "0.2")
    assert "swings for ever" in smooth
    assert "ends as" not in smooth


SEVERAL = ("--set", "body.I1=2e-6", "--set", "launch.tilt_rate=1")
"""Of a top of group I that two stable spins are within reach of."""


@pytest.mark.parametrize("options", [(), ("--tilt", "0"), SEVERAL], ids=str)
def test_no_row_is_broken_on_a_terminal_of_80_columns(options):
    found = [critical(*options, columns=columns).splitlines() for columns in (80, 200)]
    narrow, wide = (
        [line.split() for line in lines if re.search(r"\S {2,}\S", line)] for lines in found
    )
    assert narrow == wide
    assert ("of several" in str(found)) is (options == SEVERAL)


def test_no_spin_is_no_less_than_none():
    assert " -0 " not in critical("--spin", "0")


def test_the_command_tells_programs_the_same():
    stays = json.loads(critical("--tilt", "0", "--spin", "100", "--json"))
    assert (stays["stays"], stays["final"]["kind"], stays["final_certain"]) == (
        "until disturbed",
        "upright",
        True,
    )
    smooth = json.loads(critical("--mu", "0", "--tilt", "0.2", "--json"))
    assert (smooth["stays"], smooth["final"], smooth["final_certain"]) == (None, None, None)
    assert smooth["swings"][0] <= 0.2 <= smooth["swings"][1] + 1e-9
    assert smooth["omega_c_tilt"] == 0.2


def test_eigenvalues_of_a_smooth_table_have_no_real_parts_to_be_read():
    """Without friction nothing grows or decays: what is computed of it is rounding."""
    told = CliRunner().invoke(app, ["critical", "--mu", "0"]).stdout
    lines = [line for line in told.splitlines() if line.startswith(("upright: ", "inverted: "))]
    assert len(lines) == 2
    values = ", ".join(line.partition(": ")[2] for line in lines).split(", ")
    assert all(value.split(" ± ")[0] == "0" for value in values)
    assert sum("±" in value for value in values) == 4


def test_the_command_refuses_in_a_sentence_what_the_theory_cannot_tell():
    result = CliRunner().invoke(app, ["critical", "--spin", "1e100"])
    assert isinstance(result.exception, InvalidInput)
    assert "--spin: 1e+100" in str(result.exception)
