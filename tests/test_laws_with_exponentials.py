"""Friction laws written with `exp`, `log` and `tanh`, against equations of motion of the tests'
own.
"""

import math
import warnings

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

import tippetop as tt
from independent_solver import cross
from tippetop.extend import Horizontal, Scalar, Vector, exp, friction_law, log, sqrt, tanh

DURATION = 0.4
STILL, FAST, SLOW, SMOOTH = 0.4, 0.2, 0.05, 0.01


@friction_law(still="1", fast="1", slow="m s-1", smooth="m s-1")
def exponential_stribeck(
    slip: Horizontal,
    angular_velocity: Vector,
    still: Scalar,
    fast: Scalar,
    slow: Scalar,
    smooth: Scalar,
) -> tuple[Scalar, Scalar]:
    """Friction whose coefficient falls from `still` to `fast` with slip."""
    squared = slip[0] ** 2 + slip[1] ** 2
    mu = fast + (still - fast) * exp(-squared / slow**2)
    factor = -mu / sqrt(squared + smooth**2)
    return factor * slip[0], factor * slip[1]


@friction_law(mu="1", creep="m s-1", smooth="m s-1")
def creeping_friction(
    slip: Horizontal, angular_velocity: Vector, mu: Scalar, creep: Scalar, smooth: Scalar
) -> tuple[Scalar, Scalar]:
    """Friction that rises with slip as tanh, and then slowly as a logarithm."""
    speed = sqrt(slip[0] ** 2 + slip[1] ** 2 + smooth**2)
    factor = -mu * (tanh(speed / creep) + 0.1 * log(1.0 + speed / creep)) / speed
    return factor * slip[0], factor * slip[1]


def by_hand_stribeck(slip: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the force of `exponential_stribeck` per unit normal force, by `math`."""
    squared = float(slip @ slip)
    mu = FAST + (STILL - FAST) * math.exp(-squared / SLOW**2)
    return -mu * slip / math.hypot(*slip, SMOOTH)


def by_hand_creeping(slip: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the force of `creeping_friction` per unit normal force, by `math`."""
    speed = math.hypot(*slip, SMOOTH)
    return -0.15 * (math.tanh(speed / 0.03) + 0.1 * math.log1p(speed / 0.03)) / speed * slip


REPORT = tt.presets.report_problem(spin=155.0, tilt=0.3)
LAWS = {
    "exp": (
        exponential_stribeck(still=STILL, fast=FAST, slow=SLOW, smooth=SMOOTH),
        by_hand_stribeck,
    ),
    "tanh and log": (creeping_friction(mu=0.15, creep=0.03, smooth=SMOOTH), by_hand_creeping),
}


def by_scipy(problem: tt.Problem, law) -> NDArray[np.float64]:
    """Return tilt and spin at the end of a run of an eccentric sphere, by Newton's and Euler's
    equations in axis, angular momentum and velocity.
    """
    body = problem.body
    centre = body.shape.eccentricity * body.shape.radius
    up = np.array([0.0, 0.0, 1.0])

    def rates(time: float, y: NDArray[np.float64]) -> NDArray[np.float64]:
        axis, momentum, velocity = y[:3], y[3:6], np.array([*y[6:], 0.0])
        turning = cross(momentum, axis) / body.I1
        omega = momentum / body.I1 + (1.0 / body.I3 - 1.0 / body.I1) * (momentum @ axis) * axis
        arm = centre * axis - body.shape.radius * up
        velocity[2] = -centre * turning[2]
        slip = (velocity + cross(omega, arm))[:2]
        force = np.array([*law(slip), 1.0])
        # The height of the centre of mass, radius - centre c, has the acceleration N / m - g.
        of_force = cross(cross(arm, force), axis)[2]
        of_motion = cross(momentum, turning)[2]
        factor = centre / body.I1
        normal = (problem.gravity - factor * of_motion) / (1.0 / body.mass + factor * of_force)
        moment = normal * cross(arm, force)
        return np.concatenate([turning, moment, normal * force[:2] / body.mass])

    start = tt.simulate(problem, duration=1e-6, samples=2).isel(time=0)
    first = [
        *start["axis"].values,
        *start["angular_momentum"].values,
        *start["velocity"].values[:2],
    ]
    ended = solve_ivp(rates, (0.0, DURATION), first, method="DOP853", rtol=1e-11, atol=1e-14)
    axis, momentum = ended.y[:3, -1], ended.y[3:6, -1]
    return np.array([math.acos(axis[2]), momentum @ axis / body.I3])


@pytest.mark.parametrize("name", LAWS)
def test_a_run_is_that_of_equations_of_ones_own(name: str) -> None:
    law, by_hand = LAWS[name]
    problem = REPORT.replace({"friction": law})
    run = tt.simulate(problem, DURATION, samples=3)
    assert run.attrs["integrator"] == "taylor"
    assert run["flights"] == 0, "equations of contact serve throughout"
    assert float(run["energy_error"]) < 1e-13
    ended = run.isel(time=-1)
    np.testing.assert_allclose(
        [ended["tilt"], ended["spin"]], by_scipy(problem, by_hand), rtol=1e-8
    )


@pytest.mark.parametrize(
    ("name", "field"),
    [("exp", "friction.slow"), ("exp", "launch.spin"), ("tanh and log", "friction.creep")],
)
def test_derivatives_are_differences_of_runs(name: str, field: str) -> None:
    problem = REPORT.replace({"friction": LAWS[name][0]})
    slopes = tt.sensitivities(problem, DURATION, [field], samples=3)
    value = problem.get(field)
    step = 1e-4 * value
    tilts = [
        float(
            tt.simulate(problem.replace({field: value + k * step}), DURATION, samples=3)["tilt"][-1]
        )
        for k in (-2, -1, 1, 2)
    ]
    difference = (tilts[0] - 8.0 * tilts[1] + 8.0 * tilts[2] - tilts[3]) / (12.0 * step)
    found = float(slopes["tilt"].sel(parameter=field)[-1])
    assert found == pytest.approx(difference, rel=1e-7)


@pytest.mark.parametrize(
    ("function", "expected"),
    [
        (exp, [0.0, math.exp(-1.5), math.inf, math.nan]),
        (log, [math.nan, math.nan, math.log(1e3), math.nan]),
        (tanh, [-1.0, math.tanh(-1.5), 1.0, math.nan]),
    ],
)
def test_floats_and_arrays_have_the_same_values(function, expected) -> None:
    numbers = np.array([-1e4, -1.5, 1e3, np.nan])
    with np.errstate(over="ignore", invalid="ignore"):
        of_array = function(numbers)
    np.testing.assert_allclose(of_array, expected, rtol=1e-15)
    np.testing.assert_allclose(
        [function(number) for number in numbers.tolist()], expected, rtol=1e-15
    )
    assert log(0.0) == -math.inf


def test_a_law_without_a_force_at_the_launch_is_told_as_that() -> None:
    """It divides 0 by 0 where nothing slips."""

    @friction_law(mu="1")
    def undefined_at_rest(
        slip: Horizontal, angular_velocity: Vector, mu: Scalar
    ) -> tuple[Scalar, Scalar]:
        speed = sqrt(slip[0] ** 2 + slip[1] ** 2)
        return -mu * slip[0] / speed, -mu * slip[1] / speed

    with pytest.raises(tt.InvalidInput, match="has no finite force at the slip speed") as caught:
        REPORT.replace({"launch.slip": (0.0, 0.0), "friction": undefined_at_rest(mu=0.3)})
    assert caught.value.field == "friction"
    assert "sqrt(v^2 + s^2)" in caught.value.hint
    moving = REPORT.replace({"launch.slip": (0.1, 0.0), "friction": undefined_at_rest(mu=0.3)})
    run = tt.simulate(moving, 5.0, samples=2)
    assert float(run["end_time"]) < 0.1, "its slip ends"
    assert "The law undefined_at_rest has no finite force at zero slip" in run.attrs["message"]


def test_a_law_of_numpy_functions_without_a_force_is_refused_without_warnings() -> None:
    """NumPy warns where it divides 0 by 0; the refusal says so in a sentence, and once."""

    @friction_law(mu="1")
    def undefined_by_numpy(
        slip: Horizontal, angular_velocity: Vector, mu: Scalar
    ) -> tuple[Scalar, Scalar]:
        speed = np.sqrt(slip[0] ** 2 + slip[1] ** 2)
        return -mu * slip[0] / speed, -mu * slip[1] / speed

    with (
        warnings.catch_warnings(action="error"),
        pytest.raises(tt.InvalidInput, match="has no finite force") as caught,
    ):
        REPORT.replace({"launch.slip": (0.0, 0.0), "friction": undefined_by_numpy(mu=0.3)})
    assert "if it divides by the slip speed" in caught.value.hint
