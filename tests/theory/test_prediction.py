"""The final state predicted from lambda and the energy against full runs."""

import math
import re

import numpy as np
import pytest
from full_runs import full_run, sphere_problem, tilts_of

from tippetop import presets
from tippetop.mechanics.invariants import energy
from tippetop.mechanics.surfaces.hull import Hull
from tippetop.mechanics.surfaces.surface import RingSurface, SphereSurface, SpheroidSurface
from tippetop.problem.problem import top_of
from tippetop.run import simulate
from tippetop.support.errors import InvalidInput
from tippetop.theory.prediction import predict, touching_tilts
from tippetop.theory.steady import SteadyKind, jellett_of_launch, precession_branch

SETTLING = [
    (0.6, 0.3, 0.1, 70.0, 100.0),
    (0.6, 0.3, 3.0, -60.0, 200.0),
    (131 / 140, 0.3, 0.1, 100.0, 60.0),
    (131 / 140, 0.3, 0.1, 50.0, 400.0),
    (131 / 140, 0.3, 0.1, 20.0, 200.0),
    (0.75, 0.3, 0.1, 100.0, 60.0),
    (1.5, 0.3, 0.1, 90.0, 200.0),
    (1.5, 0.3, 2.8, -90.0, 200.0),
]


@pytest.mark.parametrize(("gamma", "alpha", "tilt", "spin", "duration"), SETTLING)
def test_runs_end_in_the_predicted_state(gamma, alpha, tilt, spin, duration):
    problem = sphere_problem(gamma, alpha, tilt, spin)
    prediction = predict(problem)
    axis, momentum, velocity = full_run(problem, [0.0, duration])
    assert prediction.is_certain
    assert tilts_of(axis)[-1] == pytest.approx(prediction.final.tilt, abs=1e-6)
    spin_at_end = momentum[-1] @ axis[-1] / top_of(problem).axial_inertia
    assert spin_at_end == pytest.approx(prediction.final.spin, rel=1e-5)
    assert np.abs(velocity[-1]).max() < 1e-6


def test_the_prediction_has_the_lambda_of_the_launch():
    problem = presets.report_problem(spin=50.0)
    prediction = predict(problem)
    assert prediction.jellett == jellett_of_launch(problem)
    assert prediction.final.jellett == prediction.jellett


def test_where_two_states_are_stable_energy_bars_one_from_a_gentle_launch():
    """Group Ia: the upright spin and a tilted state. Set down upright, the top cannot climb the
    barrier.
    """
    upright = predict(sphere_problem(0.6, 0.3, 0.05, 60.0))
    assert len(upright.stable) == 2
    assert upright.is_certain
    assert upright.final.kind is SteadyKind.UPRIGHT
    assert upright.stable[0].energy <= upright.stable[1].energy


def test_where_energy_does_not_decide_both_are_left_and_the_run_ends_in_one():
    problem = sphere_problem(0.6, 0.3, 1.0, 150.0, mu=0.1)
    prediction = predict(problem)
    assert not prediction.is_certain
    assert prediction.reachable == prediction.stable
    axis, _, _ = full_run(problem, [0.0, 300.0])
    final = tilts_of(axis)[-1]
    assert min(abs(final - state.tilt) for state in prediction.reachable) < 1e-6


def test_a_launch_on_a_precession_stays_there():
    top = top_of(presets.report_problem())
    branch = precession_branch(top, np.array([2.0]))
    problem = presets.report_problem(tilt=2.0).replace(
        {"launch.precession": float(branch.precession[0]), "launch.spin": float(branch.spin[0])}
    )
    assert predict(problem).final.tilt == pytest.approx(2.0, abs=1e-9)


def test_other_shapes_are_refused():
    problem = presets.report_problem().replace(
        {"body.shape": {"kind": "spheroid", "across": 0.02, "along": 0.03}}
    )
    with pytest.raises(InvalidInput, match="Jellett"):
        predict(problem)
    assert math.isfinite(jellett_of_launch(problem))


STEMMED = presets.report_problem().replace({"body": presets.REPORT_THIN_STEM})


@pytest.mark.parametrize("spin", [20.0, 40.0])
def test_a_stem_out_of_reach_changes_nothing(spin):
    alone = predict(presets.report_problem(spin=spin))
    for order in (1, -1):
        shapes = STEMMED.body.shapes[::order]
        prediction = predict(STEMMED.replace({"launch.spin": spin, "body.shape": shapes}))
        assert prediction.final.tilt == pytest.approx(alone.final.tilt, abs=1e-9)
        assert prediction.stable == prediction.reachable, (
            "what lies beyond the stem's touch is no end"
        )
    run = simulate(STEMMED.replace({"launch.spin": spin}), 30.0, samples=2)
    assert set(run["event_kind"].values) == set()
    assert float(run["tilt"][-1]) == pytest.approx(alone.final.tilt, abs=1e-4)


def test_what_may_touch_with_its_stem_is_refused_where_the_stem_touches():
    """Both spheres, 0.02 and 0.004 across their radii, are as low where 0.016 = 0.02 |cos|."""
    tilt = math.acos(-0.016 / 0.02)
    assert list(touching_tilts(top_of(STEMMED).surface, 0.1)) == pytest.approx([tilt], abs=1e-12)
    with pytest.raises(
        InvalidInput, match=rf"surface 1 can touch, at a tilt of {tilt:.4g} rad.*simulate it"
    ):
        predict(STEMMED)


def test_a_rim_that_hardly_reaches_out_of_the_ball_is_not_overlooked():
    """A sharp rim 1e-6 radii outside of the ball, in the direction psi from its middle, touches
    near psi.
    """
    radius, center, psi, reach = 0.02, 0.006, 1.5, 1.0 + 1e-6
    shapes = [
        {"kind": "sphere", "radius": radius, "center": center},
        {
            "kind": "ring",
            "radius": radius * reach * math.sin(psi),
            "center": center - radius * reach * math.cos(psi),
        },
    ]
    problem = presets.report_problem().replace({"body.shape": shapes})
    for tilt, sign in ((0.1, -1.0), (3.0, 1.0)):
        around = psi + sign * math.acos(1.0 / reach)
        assert list(touching_tilts(top_of(problem).surface, tilt)) == pytest.approx(
            [around], abs=1e-9
        )
    with pytest.raises(InvalidInput, match=r"surface 1 can touch, at a tilt of 1\.499 rad"):
        predict(problem)


@pytest.mark.parametrize(
    "pair",
    [
        (SphereSurface(0.02, 0.006), SphereSurface(0.02, 0.006 * (1.0 - 2e-16))),
        (SpheroidSurface(0.02, 1e-9), RingSurface(0.02)),
    ],
)
def test_surfaces_that_are_one_but_for_rounding_touch_nowhere_in_particular(pair):
    assert pair[0] != pair[1]
    assert touching_tilts(Hull.of(pair), 0.5) == {}


def test_the_energy_that_is_named_is_what_decides():
    """Just above the least spin that is refused, the launch has hardly more than it takes."""
    accepted, refused = 40.0, 155.0
    while refused - accepted > 1e-3:
        middle = 0.5 * (accepted + refused)
        try:
            predict(STEMMED.replace({"launch.spin": middle}))
            accepted = middle
        except InvalidInput as error:
            refused, told = middle, str(error)
    needed, available = (float(number) for number in re.findall(r"(\S+) J\b", told))
    assert available == pytest.approx(needed, rel=1e-3)
    start = STEMMED.replace({"launch.spin": refused})
    assert available == pytest.approx(float(energy(start.start(), start.standing())), rel=1e-3)


@pytest.mark.parametrize(
    ("name", "tilt", "spin", "surface"),
    [
        ("report-stem", 0.1, 30.0, 0),
        ("report-stem", 3.0, 250.0, 1),
        ("leine-glocker-stem", 0.1, 30.0, 0),
        ("leine-glocker-stem", 3.0, 250.0, 1),
        ("friedl", 0.1, 30.0, 0),
        ("wooden", 0.1, 40.0, 0),
        ("wooden", 3.0, 250.0, 1),
    ],
)
def test_runs_end_on_the_predicted_surface(name, tilt, spin, surface):
    launch = {
        "launch.tilt": tilt,
        "launch.spin": spin,
        "friction.mu": 1.0,
        "body": presets.body(name),
    }
    problem = presets.report_problem().replace(launch)
    prediction = predict(problem)
    assert prediction.is_certain
    assert prediction.surface == surface
    run = simulate(problem, 100.0, samples=2)
    assert float(run["tilt"][-1]) == pytest.approx(prediction.final.tilt, abs=1e-4)
    assert run["mode"][-1] == f"sliding_on_{surface}"


@pytest.mark.parametrize(("tilt", "precession"), [(0.1, 0.0), (1.3, 60.0), (1.9, -60.0)])
def test_balls_whose_other_one_may_touch_are_refused_in_a_sentence(tilt, precession):
    """Inverted on one ball alone the centre of mass would be on the table, and no spin has any
    lambda.
    """
    launch = {"launch.tilt": tilt, "launch.precession": precession, "body": presets.HURRICANE_BALLS}
    problem = presets.report_problem().replace(launch)
    with pytest.raises(InvalidInput, match=r"can touch, at a tilt of 1\.571 rad"):
        predict(problem)
    alone = problem.replace({"body.shape": problem.body.shapes[0]})
    states = predict(alone).stable
    assert states
    assert all(math.isfinite(state.energy) for state in states)
