"""Launches stated by Euler angles or an angular velocity, and horizontal velocities."""

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import tippetop as tt
from tippetop.mechanics.motion import angular_velocity, axial_spin
from tippetop.problem.problem import top_of
from tippetop.support.errors import InvalidInput

RATES = st.floats(min_value=-500.0, max_value=500.0)
TILTS = st.floats(min_value=0.01, max_value=math.pi - 0.01)
ANGLES = st.floats(min_value=-math.pi, max_value=math.pi)
LAUNCHES = st.builds(
    tt.Launch, tilt=TILTS, azimuth=ANGLES, tilt_rate=RATES, precession=RATES, spin=RATES
)
PROBLEM = tt.presets.report_problem()


def numbers(launch: "tt.Launch") -> list[float]:
    return [launch.tilt, launch.azimuth, launch.tilt_rate, launch.precession, launch.spin]


@given(LAUNCHES)
def test_euler_angles_state_the_same_launch(launch: "tt.Launch") -> None:
    again = tt.Launch.from_euler(**launch.euler())
    assert numbers(again) == pytest.approx(numbers(launch), rel=1e-14, abs=1e-12)


@given(LAUNCHES, st.sampled_from(["table", "body"]))
def test_an_angular_velocity_states_the_same_launch(launch: "tt.Launch", frame: Any) -> None:
    omega = launch.angular_velocity(frame)
    again = tt.Launch.from_angular_velocity(
        omega, tilt=launch.tilt, azimuth=launch.azimuth, frame=frame
    )
    # Near the vertical, a precession follows from a small part of omega.
    within = 1e-12 / math.sin(launch.tilt)
    assert numbers(again) == pytest.approx(numbers(launch), rel=within, abs=1e3 * within)


@given(LAUNCHES)
def test_the_angular_velocity_is_that_of_the_mechanics(launch: "tt.Launch") -> None:
    problem = PROBLEM.replace({"launch": launch})
    start, top = problem.start(), top_of(problem)
    found = angular_velocity(start.axis, start.momentum, top)
    assert found == pytest.approx(launch.angular_velocity(), rel=1e-12, abs=1e-10)
    first, second, third = launch.frame
    assert start.axis == pytest.approx(third, abs=1e-15)
    assert np.cross(first, second) == pytest.approx(third, abs=1e-15)
    own = [float(np.dot(found, direction)) for direction in (first, second, third)]
    assert own == pytest.approx(launch.angular_velocity("body"), rel=1e-11, abs=1e-9)


@given(
    st.tuples(RATES, RATES, RATES), st.sampled_from([0.0, math.pi]), ANGLES, st.sampled_from("tb")
)
def test_a_vertical_axis_leans_where_the_angular_velocity_takes_it(
    omega: tuple[float, float, float], tilt: float, azimuth: float, frame: str
) -> None:
    frames: dict[str, Any] = {"t": "table", "b": "body"}
    launch = tt.Launch.from_angular_velocity(omega, tilt=tilt, azimuth=azimuth, frame=frames[frame])
    given_there = tt.Launch(tilt=tilt, azimuth=azimuth, spin=0.0).frame
    wanted = (
        np.array(omega)
        if frame == "t"
        else sum(part * np.array(way) for part, way in zip(omega, given_there, strict=True))
    )
    assert launch.angular_velocity() == pytest.approx(wanted, rel=1e-12, abs=1e-10)


def test_a_steady_turn_about_the_vertical() -> None:
    """The whole body turning about z: the axis precesses, and spins by its cosine."""
    launch = tt.Launch.from_angular_velocity((0, 0, "10 rev/s"), tilt="60 deg", azimuth=1.0)
    turn = 20.0 * math.pi
    assert launch.precession == pytest.approx(turn, rel=1e-14)
    assert launch.spin == pytest.approx(0.5 * turn, rel=1e-14)
    assert launch.tilt_rate == pytest.approx(0.0, abs=1e-12)


def rising(**launch: Any) -> float:
    """How fast the gap to the table grows at launch, m/s, from positions alone."""
    problem = PROBLEM.replace({"launch": tt.Launch(**launch)})
    start = problem.start()
    swing = np.cross(start.momentum, start.axis) / problem.body.I1
    surface, step = problem.body.surface, 1e-7
    heights = [
        surface.height(float((np.array(start.axis) + sign * step * swing)[2])) for sign in (1, -1)
    ]
    return float(start.velocity[2] - (heights[0] - heights[1]) / (2.0 * step))


@given(LAUNCHES, st.floats(-1.0, 1.0), st.floats(-1.0, 1.0))
def test_a_horizontal_velocity_keeps_contact(launch: "tt.Launch", x: float, y: float) -> None:
    fields = launch.model_dump(exclude={"slip", "velocity"})
    for velocity in ((x, y), (x, y, 0.0), (x, y, -0.0)):
        assert rising(**fields, velocity=velocity) == pytest.approx(0.0, abs=1e-6)
        start = PROBLEM.replace({"launch": tt.Launch(**fields, velocity=velocity)}).start()
        assert start.velocity[:2] == (x, y)


def test_any_other_third_number_is_meant() -> None:
    thrown = {"tilt": 0.5, "spin": 100.0, "tilt_rate": 3.0, "velocity": (0.1, 0.0, 0.25)}
    problem = PROBLEM.replace({"launch": tt.Launch(**thrown)})
    assert problem.start().velocity == (0.1, 0.0, 0.25)
    dropped = PROBLEM.replace(
        {"launch": tt.Launch(**thrown | {"velocity": (0.1, 0.0), "gap": 0.01})}
    )
    assert dropped.start().velocity == (0.1, 0.0, 0.0), "off the table, nothing keeps contact"


def test_a_horizontal_launch_does_not_begin_with_an_impact() -> None:
    launch = tt.Launch(tilt=0.5, spin=100.0, tilt_rate=3.0, velocity=(0.1, 0.0))
    run = tt.simulate(PROBLEM.replace({"launch": launch}), 0.01, samples=3)
    assert "impact" not in run["event_kind"].values[run["event_time"].values == 0.0]
    assert tt.Launch(tilt=0.1, spin=1.0, velocity=(0.1, 0.0)).velocity == (0.1, 0.0, 0.0)
    falling = PROBLEM.replace({"launch.tilt_rate": 3.0, "launch.velocity": (0.1, 0.0, -0.3)})
    struck = tt.simulate(falling, 0.01, samples=3)
    assert "impact" in struck["event_kind"].values[struck["event_time"].values == 0.0]


@pytest.mark.parametrize("ratio", [1.0, 1e3, 1e6, 1e9, 1e12])
@pytest.mark.parametrize("tilt", [0.1, 1.0, 2.5])
def test_the_spin_of_a_launch_keeps_its_digits(ratio: float, tilt: float) -> None:
    """However slender the body: L is put together from its parts across and along the axis."""
    changes = {"body.I1": 3e-6 * max(ratio, 1.0), "body.I3": 3e-6, "launch.tilt": tilt}
    problem = PROBLEM.replace(changes)
    start = problem.start()
    assert axial_spin(start.axis, start.momentum, top_of(problem)) == pytest.approx(
        155.0, rel=1e-15
    )


def test_what_is_no_angular_velocity_is_refused() -> None:
    for wrong in (3.0, "x", (1.0, 2.0), (1.0, 2.0, math.nan), None, ("1 m", 0, 0)):
        with pytest.raises(InvalidInput) as refusal:
            tt.Launch.from_angular_velocity(wrong, tilt=0.1)
        assert refusal.value.field.startswith("omega")


@pytest.mark.parametrize("tilt", [0.3, 1.4])
def test_what_is_dropped_falls_from_rest(tilt: float) -> None:
    problem = tt.presets.report_problem(spin=155.0, tilt=tilt)
    dropped = problem.replace({"launch.gap": 0.05, "launch.precession": 20.0})
    run = tt.simulate(dropped, duration=0.09)
    assert abs(run["velocity"].values[0]).max() == 0.0
    assert float(run["height"][-1]) == pytest.approx(float(run["height"][0]) - 4.9 * 0.09**2)
    assert abs(run["x"].values).max() == abs(run["y"].values).max() == 0.0


def test_nothing_slips_across_a_gap() -> None:
    problem = tt.presets.report_problem().replace({"launch.gap": 0.05})
    with pytest.raises(tt.InvalidInput, match=r"slip: .*stands beside a gap"):
        problem.replace({"launch.slip": (0.1, 0.0)})
    swept = tt.sweep(
        tt.presets.report_problem(),
        {"launch.gap": [0.0, 0.01], "launch.slip.0": [0.0, 0.1]},
        duration=0.01,
    )
    assert (swept["fault"].values == "none").tolist() == [[True, True], [True, False]]
