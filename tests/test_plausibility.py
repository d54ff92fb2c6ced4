"""Implausible problems: what is said of them, by whom, and that it is true."""

import math
import sys
import warnings

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import linprog

import tippetop as tt
from tippetop.cli.commands import run
from tippetop.mechanics.surfaces.hull import each_surface
from tippetop.mechanics.surfaces.surface import contact_vector
from tippetop.problem.implausible import SENTENCES, sentence
from tippetop.problem.plausibility import doubts, outside_of
from tippetop.theory.outlook import outlook
from tippetop.theory.prospects import prospects

REPORT = tt.presets.report_problem()
HEAVY = REPORT.replace({"body.mass": 20.0, "body.I1": 3e-3, "body.I3": 3.2e-3})
HALF_INCH = [
    [0, -0.5],
    [0.5, 0, 0.5],
    [0.35355339, 0.35355339, 0.5],
    [0.125, 0.35355339],
    [0.125, 0.875],
    [0, 1.0, 0.125],
]
"""A ball of one inch, cut at 45 degrees, with a stem; inches."""


def sentences(problem):
    return [sentence(doubt) for doubt in doubts(problem)]


def kinds(problem):
    return [doubt.kind for doubt in doubts(problem)]


def with_body(body):
    return REPORT.model_copy(update={"body": body})


@pytest.mark.parametrize("name", tt.presets.BODIES)
def test_no_preset_is_implausible(name):
    assert sentences(with_body(tt.presets.body(name))) == []
    assert sentences(tt.presets.leine_glocker_problem()) == []


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"body.I1": 1.9, "body.I3": 2.0}, "I3 = 2 kg m^2 is above m r^2 = 7.28e-06 kg m^2, r ="),
        ({"body.I1": 7e-6}, "I1 + I3/2 = 8.6e-06 kg m^2 is above m r^2 = 7.28e-06 kg m^2, r ="),
        ({"body.I1": 2e-9, "body.I3": 2e-9}, "I3 = 2e-09 kg m^2 is less than a thousandth of"),
        (
            {"launch.tilt": 0.0, "launch.precession": 5.0},
            "a precession of 5 rad/s at launch does nothing, as the axis is vertical",
        ),
        ({"body.mass": 20.0}, "the mass is 20 kg; most tops have 0.1 g to 5 kg"),
        ({"body.mass": 5e-5}, "the mass is 0.05 g; most tops have 0.1 g to 5 kg"),
        ({"body.shape.radius": 0.4}, "the body is 800 mm across and 800 mm high"),
        ({"body.shape.radius": 15.0}, "the body is 30 m across and 30 m high"),
        ({"body.shape.radius": 4e-4}, "the body is 0.8 mm across and 0.8 mm high"),
        (
            {"friction": tt.ContensouFriction(mu=0.3, patch_radius=0.011)},
            "the contact patch has a radius of 11 mm, more than half of the body's, 20 mm",
        ),
        ({"launch.tilt": 1.8}, "the tilt at launch is 1.8 rad, above pi/2: the axis points down"),
        ({"launch.spin": -2e4}, "the spin at launch is -20000 rad/s, beyond 10000 rad/s"),
        (
            {"body.shape": tt.Sphere(radius=0.02, center=-0.001)},
            "the centre of mass is 1 mm above the ball's centre: it does not turn over",
        ),
        (
            {"body.shape": tt.Sphere(radius=0.02, center=0.023)},
            "the centre of mass is 3 mm outside the surface",
        ),
        (
            {"body.mass": 4e-4, "body.shape.radius": 0.1},
            "a mass of 0.4 g in a volume of 0.004189 m^3 floats on air",
        ),
    ],
)
def test_what_is_implausible_is_said_in_a_sentence(changes, said):
    assert any(text.startswith(said) for text in sentences(REPORT.replace(changes))), said


def test_every_kind_of_doubt_has_a_sentence_whose_gaps_are_filled():
    strange = REPORT.replace({"launch.spin": 2e4, "launch.tilt": 2.0, "body.mass": 20.0})
    assert {"core", "mass", "tilt", "spin"} == set(kinds(strange)) <= set(SENTENCES)
    assert not any("{" in text for text in sentences(strange))


def test_a_ball_cut_at_45_degrees_is_told_that_it_does_not_turn_over():
    body = tt.Body.turned(HALF_INCH, 2700.0, unit="in", whole=True)
    (said,) = sentences(with_body(body))
    assert said.startswith("the centre of mass is 0.35")
    assert said.endswith("mm above the ball's centre: it does not turn over")


@pytest.mark.parametrize("offset", [0.0, 0.3, -0.6])
def test_in_a_sphere_every_bound_is_that_of_the_shell_through_the_centre_of_mass(offset):
    outside = outside_of(tt.Sphere(radius=0.02, center=offset * 0.02).surface)
    exact = pytest.approx(0.02**2 * (1.0 - offset**2), rel=1e-14)
    assert (outside.mean_width, outside.mean_square, outside.mean_length) == (exact,) * 3


@pytest.mark.parametrize("name", ["leine-glocker-stem", "wooden", "coin", "hurricane-balls", "egg"])
def test_bounds_are_the_optima_of_a_linear_program_over_all_masses(name):
    """The independent formulation: masses at many points, chosen by a solver."""
    surface = tt.presets.body(name).surface
    points = []
    for one in each_surface(surface):
        for tilt in np.linspace(1e-4, math.pi - 1e-4, 400):
            axis = (math.sin(tilt), 0.0, math.cos(tilt))
            arm = contact_vector(axis, one)
            points.append((np.linalg.norm(np.cross(axis, arm)), np.dot(axis, arm)))
    r, z = np.array(points).T
    outside = outside_of(surface)
    for bound, f in (
        (outside.mean_width, r**2),
        (outside.mean_square, r**2 + z**2),
        (outside.mean_length, z**2),
    ):
        best = linprog(-f * 1e4, A_eq=[np.ones_like(z), z * 1e2], b_eq=[1.0, 0.0])
        assert bound == pytest.approx(-best.fun / 1e4, rel=0.01)


@given(
    st.lists(st.tuples(*3 * [st.floats(0.01, 0.99)]), min_size=1, max_size=4),
    st.sampled_from([(0.02, 0.02), (0.02, 0.04), (0.03, 0.01)]),
)
def test_no_mass_inside_the_surface_is_doubted(rings, axes):
    """Whatever rings of mass are put inside a spheroid, the moments they have are possible."""
    across, along = axes
    weights, heights, shares = np.array(rings).T
    z = along * (2.0 * heights - 1.0)
    r = shares * across * np.sqrt(np.maximum(1.0 - (z / along) ** 2, 0.0))
    mass = 0.02
    parts = mass * weights / weights.sum()
    middle = float(parts @ z) / mass
    z = z - middle
    I1, I3 = float(parts @ (r**2 / 2 + z**2)), float(parts @ r**2)
    shape = tt.Spheroid(across=across, along=along, center=-middle)
    body = tt.Body(mass=mass, shape=shape, I1=I1 * (1.0 + 1e-12), I3=I3)
    assert not {"moment", "centre"} & set(kinds(with_body(body)))


def test_a_moment_a_tenth_above_its_bound_is_doubted():
    shape = tt.Spheroid(across=0.02, along=0.03, center=0.005)
    outside = outside_of(shape.surface)
    for name, I1, I3 in (
        ("I3", 0.02 * outside.mean_width * 1.1, 0.02 * outside.mean_width * 1.1),
        ("I1 + I3/2", 0.02 * outside.mean_square, 0.02 * outside.mean_square * 0.2),
    ):
        body = tt.Body(mass=0.02, shape=shape, I1=I1, I3=I3)
        assert sentences(with_body(body))[0].startswith(f"{name} = ")


def test_numbers_too_large_to_compute_with_are_no_reason_to_fail():
    shape = tt.Ring(radius=1e150, center=0.0)
    assert isinstance(sentences(with_body(tt.Body(mass=1.0, shape=shape, I1=1.0, I3=1.0))), list)


def warned(action):
    """The warnings of an action, with every one shown."""
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        action()
    return [one for one in said if one.category is tt.Implausible]


def test_nothing_is_said_when_a_problem_is_stated():
    assert warned(lambda: tt.Problem.from_toml(HEAVY.to_toml())) == []


@pytest.mark.parametrize(
    "action",
    [
        lambda: tt.simulate(HEAVY, 0.01),
        lambda: tt.predict(HEAVY),
        lambda: tt.critical_spins(HEAVY),
        lambda: tt.sweep(HEAVY, {"launch.spin": [1.0, 2.0]}, duration=0.01, workers=1),
    ],
    ids=["simulate", "predict", "critical_spins", "sweep"],
)
def test_who_computes_with_a_problem_warns_once_and_in_the_callers_line(action):
    (said,) = warned(action)
    assert "the mass is 20 kg" in str(said.message)
    assert said.filename == __file__


def test_the_theory_of_one_surface_does_not_doubt_the_whole_body():
    """A ball whose stem is long has moments that no mass inside the ball alone has."""
    ball, tip = tt.Sphere(radius=0.02, center=0.006), tt.Sphere(radius=0.004, center=0.06)
    body = tt.Body(mass=0.02, shape=(ball, tip), I1=1e-5, I3=3e-6)
    problem = with_body(body)
    alone = body.model_copy(update={"shape": ball})
    assert kinds(problem) == []
    assert kinds(with_body(alone)) == ["moment"]
    asked = (
        lambda: outlook(problem),
        lambda: prospects(body, [ball, tip]),
    )
    for ask in asked:
        assert warned(ask) == []


def test_a_warning_is_switched_off_as_any_other():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.filterwarnings("ignore", category=tt.Implausible)
        tt.simulate(HEAVY, 0.01)


def test_a_plausible_problem_runs_without_a_word():
    assert warned(lambda: tt.simulate(REPORT, 0.01)) == []
    axes = {"launch.spin": [10.0, 155.0], "body.shape.eccentricity": [0.2, 0.3]}
    assert warned(lambda: tt.sweep(REPORT, axes, duration=0.01, workers=1)) == []


@pytest.mark.parametrize(
    ("over", "count", "said"),
    [
        ({"launch.spin": [1.0, 1.1e4, -2e4]}, "2 of 3 cells", "the spin at launch is 11000 rad/s"),
        ({"body.shape.eccentricity": [0.3, 0.9]}, "1 of 2 cells", "I3 ="),
        ({"launch.tilt": [0.1, 2.0], "body.mass": [0.02, 20.0, 30.0]}, "5 of 6 cells", "I3 ="),
        (
            {"draw": {"launch.spin": {"from": 1.2e4, "to": 2e4}}, "count": 5, "seed": 1},
            "5 of 5 cells",
            "the spin at launch is",
        ),
    ],
)
def test_a_sweep_counts_its_implausible_cells(over, count, said):
    cells = over if "draw" in over else {"over": over}
    (warning,) = warned(lambda: tt.sweep(REPORT, **cells, duration=0.001, workers=1))
    assert str(warning.message).startswith(f"{count} are implausible; the first: {said}")


def test_a_sweep_of_more_cells_than_are_looked_at_says_so(monkeypatch):
    monkeypatch.setattr("tippetop.sweeps.implausible_cells.CELLS_EXAMINED", 10)
    spins = {"launch.spin": {"from": 0.0, "to": 2e4, "count": 100}}
    (warning,) = warned(lambda: tt.sweep(REPORT, spins, duration=0.001, workers=1))
    assert str(warning.message).startswith("5 of 10 cells looked at are implausible; the first:")


@pytest.fixture
def at_the_command_line(monkeypatch, capsys):
    """Runs a command; gives what it says beside its answer, under a filter of warnings."""

    def command(*arguments, action="default"):
        monkeypatch.setattr(sys, "argv", ["tippetop", *arguments])
        with warnings.catch_warnings():
            warnings.simplefilter(action)
            with pytest.raises(SystemExit, match="0"):
                run()
        return capsys.readouterr().err

    return command


def test_the_command_line_warns_in_a_line(at_the_command_line):
    options = ["--set", "body.mass=20", "--set", "body.I1=3e-3", "--set", "body.I3=3.2e-3"]
    said = "tippetop: the mass is 20 kg; most tops have 0.1 g to 5 kg\n"
    assert at_the_command_line("simulate", *options, "--duration", "0.01") == said
    assert at_the_command_line("critical", *options) == said
    assert at_the_command_line("critical", *options, action="ignore") == ""


def test_the_command_line_counts_the_cells_of_a_sweep(at_the_command_line, tmp_path):
    out = tmp_path / "sweep.zarr"
    options = ["--over", "launch.spin=0:20000:4", "--duration", "0.001", "--out", str(out)]
    said = at_the_command_line("sweep", *options, "--workers", "1", "--no-maps")
    assert said.startswith("tippetop: 2 of 4 cells are implausible; the first: the spin at launch")
    assert said.count("\n") == 1
