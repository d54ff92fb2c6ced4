"""Poses of a toy between the samples of a run converge to the run at fourth order."""

import numpy as np
import pytest
import xarray as xr
from scipy.spatial.transform import Rotation

import tippetop as tt
from tippetop.export import poses
from tippetop.results import sample_counts


def angle_between(found: poses.Poses, run: xr.Dataset) -> np.ndarray:
    exact = Rotation.from_quat(run["orientation"].values, scalar_first=True)
    return (found.turns.inv() * exact).magnitude()


@pytest.mark.parametrize(
    ("spin", "tilt"), [(20.0, 0.1), (50.0, 0.1), (155.0, 0.1), (-155.0, 0.1), (90.0, 3.0)]
)
def test_poses_between_samples_are_those_of_a_simulation_there(spin: float, tilt: float) -> None:
    problem = tt.presets.report_problem(spin=spin, tilt=tilt)
    times = np.sort(np.random.default_rng(1).uniform(0.0, 10.0, 300))
    run = tt.simulate(problem, 10.0, samples=sample_counts.sample_count(problem, 10.0))
    exact = tt.simulate(problem, 10.0, times=times)
    found = poses.poses_at(run, times)
    assert angle_between(found, exact).max() < 5e-3
    position = exact[["x", "y", "height"]].to_array().values.T
    assert np.abs(found.positions - position).max() < 1e-4 * problem.body.shape.radius


def test_the_error_between_samples_is_of_fourth_order() -> None:
    problem = tt.presets.report_problem(spin=155.0)
    times = np.sort(np.random.default_rng(3).uniform(0.0, 6.0, 2000))
    exact = tt.simulate(problem, 6.0, times=times)
    errors = [
        angle_between(poses.poses_at(tt.simulate(problem, 6.0, samples=count), times), exact).max()
        for count in (1601, 3201)
    ]
    assert errors[0] / errors[1] > 12


def test_poses_at_the_samples_are_the_samples(flying: xr.Dataset) -> None:
    found = poses.poses_at(flying, flying["time"].values)
    assert angle_between(found, flying).max() < 1e-6


def test_turns_that_are_more_than_half_are_not_lost() -> None:
    problem = tt.presets.report_problem(spin=155.0, tilt=0.0)
    run = tt.simulate(problem, 1.0, samples=21)  # the body turns 7.75 rad between samples
    middle = poses.poses_at(run, [0.5 / 20])
    marker = middle.turns.apply([1.0, 0.0, 0.0])[0]
    assert marker == pytest.approx([np.cos(155.0 / 40), np.sin(155.0 / 40), 0.0], abs=1e-6)


def test_the_shortest_rotation_carries_one_direction_to_the_other() -> None:
    rng = np.random.default_rng(2)
    start, end = (v / np.linalg.norm(v, axis=1)[:, None] for v in rng.normal(size=(2, 50, 3)))
    start[:3], end[:3] = np.eye(3), -np.eye(3)
    rotation = poses.shortest(start, end)
    assert rotation.apply(start) == pytest.approx(end, abs=1e-12)
