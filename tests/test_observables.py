"""What is integrated along a run, and read off it, against integrations and closed forms beside
it.
"""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

import tippetop as tt
from tippetop.contact import readings
from tippetop.mechanics.motion import along_table, angular_velocity, sliding_contact, sliding_rates
from tippetop.mechanics.quadratures import orientation
from tippetop.mechanics.state import SlidingState
from tippetop.problem.presets import report_problem
from tippetop.problem.problem import top_of
from tippetop.results.samples import continuous

RANDOM = np.random.default_rng(2).normal(size=(1000, 4))
HALF_TURNS = np.hstack((np.zeros((100, 1)), RANDOM[:100, 1:]))
NEARLY_HALF_TURNS = np.hstack((np.full((100, 1), 1e-9), RANDOM[:100, 1:]))


def seen(turned):
    """The quaternions, made from axis and angle, of bodies turned so, each in the chart of its
    pole.
    """
    axis, marker = turned.apply([0.0, 0.0, 1.0]), turned.apply([1.0, 0.0, 0.0])
    pole = np.where(axis[:, 2] >= 0.0, 1.0, -1.0)
    normal = np.cross(np.stack([0.0 * pole, 0.0 * pole, pole], axis=1), axis)
    sine = np.linalg.norm(normal, axis=1)
    least = Rotation.from_rotvec(
        (np.arctan2(sine, pole * axis[:, 2]) / np.where(sine > 0.0, sine, 1.0))[:, None] * normal
    )
    over = Rotation.from_rotvec(
        np.where(pole > 0.0, 0.0, np.pi)[:, None] * np.array([0.0, 1.0, 0.0])
    )
    x, y, _ = (least * over).inv().apply(marker).T
    return np.stack(orientation(tuple(axis.T), np.arctan2(y, x), pole, np), axis=1)


@pytest.mark.parametrize(
    "quaternions",
    [RANDOM, HALF_TURNS, NEARLY_HALF_TURNS, np.eye(4)],
    ids=["any", "half turns", "nearly half turns", "about the axes"],
)
def test_orientation_turns_the_body_to_where_it_is(quaternions):
    turned = Rotation.from_quat(quaternions, scalar_first=True)
    found = continuous(seen(turned))
    np.testing.assert_allclose(np.linalg.norm(found, axis=1), 1.0, rtol=0, atol=1e-15)
    again = Rotation.from_quat(found, scalar_first=True)
    np.testing.assert_allclose(again.as_matrix(), turned.as_matrix(), rtol=0, atol=4e-15)


def test_orientation_does_not_jump_from_sample_to_sample():
    angles = np.linspace(0.0, 20.0, 400)
    turned = Rotation.from_rotvec(angles[:, None] * np.array([0.6, 0.0, 0.8]))
    steps = np.diff(continuous(seen(turned)), axis=0)
    assert np.abs(steps).max() < angles[1]


ACROSS_THE_EQUATOR = report_problem(spin=100.0, tilt=1.5).replace(
    {
        "launch.tilt_rate": 30.0,
        "launch.azimuth": 0.7,
        "launch.slip": (0.1, -0.2),
        "contact.liftoff": "ignore",
    }
)


def test_place_orientation_and_work_of_a_run_are_those_of_an_integration_beside_it():
    """A marker moved by k' = omega x k, in SI; the run is in natural units and goes through the
    equator.
    """
    problem, top = ACROSS_THE_EQUATOR, top_of(ACROSS_THE_EQUATOR)
    times = np.linspace(0.0, 0.3, 61)
    run = tt.simulate(problem, 0.3, times=times)
    assert run.attrs["status"] == "completed"
    assert run.axis.values[:, 2].min() < -0.05 < 0.05 < run.axis.values[:, 2].max()

    def rates(_, y):
        state = SlidingState.unpack(y[:8].tolist())
        omega = angular_velocity(state.axis, state.momentum, top)
        power = sliding_contact(state.axis, state.momentum, state.velocity, top).power
        return [*sliding_rates(state, top).pack(), *state.velocity, power, *np.cross(omega, y[11:])]

    start = along_table(problem.start())
    launch = problem.launch
    marker = Rotation.from_euler("ZYZ", [launch.azimuth, launch.tilt, 0.0]).apply([1.0, 0.0, 0.0])
    begin = [*start.pack(), 0.0, 0.0, 0.0, *marker]
    size = np.array([1.0] * 3 + [1e-4] * 3 + [0.1] * 2 + [0.1] * 2 + [1e-2] + [1.0] * 3)
    exact = solve_ivp(
        rates, (0.0, 0.3), begin, method="DOP853", t_eval=times, rtol=1e-13, atol=1e-13 * size
    ).y
    np.testing.assert_allclose(run.axis, exact[:3].T, rtol=0, atol=1e-9)
    np.testing.assert_allclose(run.x, exact[8], rtol=0, atol=1e-10)
    np.testing.assert_allclose(run.y, exact[9], rtol=0, atol=1e-10)
    np.testing.assert_allclose(run.work, exact[10], rtol=0, atol=1e-9 * float(run.energy[0]))
    turned = Rotation.from_quat(run.orientation.values, scalar_first=True)
    np.testing.assert_allclose(turned.apply([1.0, 0.0, 0.0]), exact[11:].T, rtol=0, atol=1e-8)
    np.testing.assert_allclose(turned.apply([0.0, 0.0, 1.0]), run.axis, rtol=0, atol=1e-14)


def test_a_flying_body_turns_as_a_free_symmetric_top_does():
    """R(t) = exp(t L/I1) R(0) exp(t (1/I3 - 1/I1) L.n z), through the equator again and again."""
    problem = report_problem(spin=60.0, tilt=1.3).replace(
        {
            "launch.tilt_rate": 80.0,
            "launch.azimuth": -2.0,
            "launch.gap": 1.0,
            "launch.velocity": (0.3, -0.2, 0.1),
            "contact.liftoff": "fly",
        }
    )
    top, start, times = top_of(problem), problem.start(), np.linspace(0.0, 0.4, 101)
    run = tt.simulate(problem, 0.4, times=times)
    assert (np.diff(np.sign(run.axis.values[:, 2])) != 0).sum() > 5
    along = np.dot(start.momentum, start.axis) * (
        1.0 / top.axial_inertia - 1.0 / top.transverse_inertia
    )
    precession = np.array(start.momentum) / top.transverse_inertia
    begin = Rotation.from_euler("ZYZ", [problem.launch.azimuth, problem.launch.tilt, 0.0])
    expected = (
        Rotation.from_rotvec(times[:, None] * precession)
        * begin
        * Rotation.from_rotvec(times[:, None] * np.array([0.0, 0.0, along]))
    )
    found = Rotation.from_quat(run.orientation.values, scalar_first=True)
    # Within a step the rate of the angle is interpolated: steps are half a radian, Gauss's points
    # eight.
    np.testing.assert_allclose(found.as_matrix(), expected.as_matrix(), rtol=0, atol=1e-10)
    np.testing.assert_allclose(run.x, 0.3 * times, rtol=0, atol=1e-14)
    np.testing.assert_allclose(run.y, -0.2 * times, rtol=0, atol=1e-14)
    assert not run.work.values.any()


def test_the_highest_place_of_a_flight_is_its_apex():
    """A body that does not turn is thrown up by v: it rises by v^2 / 2g, between samples and
    steps.
    """
    problem = report_problem(spin=0.0, tilt=0.0).replace(
        {"launch.velocity": (0.0, 0.0, 1.0), "contact.liftoff": "fly"}
    )
    start = problem.start()
    run = tt.simulate(problem, 0.15, samples=2)
    assert float(run.max_height) == pytest.approx(
        start.height + 1.0 / (2.0 * problem.gravity), rel=1e-12
    )


def test_what_an_impact_at_launch_takes_is_work_of_the_table():
    problem = report_problem(spin=100.0, tilt=0.3).replace(
        {"launch.velocity": (0.1, 0.0, -0.5), "contact.liftoff": "fly"}
    )
    run = tt.simulate(problem, 0.1, samples=11)
    assert float(run.energy_lost_impacts) > 0.1 * 0.5 * 0.02 * 0.5**2
    lost = float(run.initial_energy) + run.work.values - run.energy.values
    np.testing.assert_allclose(lost, 0.0, rtol=0, atol=1e-12 * float(run.initial_energy))
    assert float(run.energy_error) < 1e-12
    assert math.isclose(float(run.energy_lost), -float(run.work[-1]), rel_tol=1e-10)


@pytest.mark.parametrize(
    ("friction", "shape"),
    [
        (tt.ViscousFriction(mu=0.3), tt.presets.REPORT.shape),
        (tt.RegularizedCoulombFriction(mu=0.3, eps=0.1), tt.presets.EGG.shape),
        (tt.ContensouFriction(mu=0.3, patch_radius=5e-4), tt.presets.REPORT.shape),
    ],
    ids=["sphere", "egg", "drilling"],
)
def test_what_is_compiled_reads_what_arrays_read(monkeypatch, friction, shape):
    asked = []
    compiled = readings.compiled_evaluation
    monkeypatch.setattr(
        readings, "compiled_evaluation", lambda *given: asked.append(given) or compiled(*given)
    )
    problem = report_problem(spin=120.0, tilt=0.3).replace({"contact.liftoff": "ignore"})
    problem = problem.model_copy(
        update={"friction": friction, "body": problem.body.model_copy(update={"shape": shape})}
    )
    quick = tt.simulate(problem, 10.0)
    assert len(asked) >= 2
    monkeypatch.setattr(readings, "compiled_evaluation", lambda *given: None)
    plain = tt.simulate(problem, 10.0)
    assert quick.steps == plain.steps
    for name, values in plain.data_vars.items():
        if "time" in values.dims and name != "mode":
            scale = float(np.abs(values).max()) + (name in ("orientation", "azimuth")) * 3.0
            np.testing.assert_allclose(
                quick[name], values, rtol=0, atol=1e-12 * scale, err_msg=name
            )
