"""What is read off a state, where a run does not reach every case of it."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tippetop.mechanics.state import State
from tippetop.observables import orientation

RANDOM = np.random.default_rng(2).normal(size=(1000, 4))
HALF_TURNS = np.hstack((np.zeros((100, 1)), RANDOM[:100, 1:]))
NEARLY_HALF_TURNS = np.hstack((np.full((100, 1), 1e-9), RANDOM[:100, 1:]))


def standing(turned):
    """States whose bodies are turned so."""
    zeros = tuple(np.zeros((3, len(turned))))
    marker, axis = turned.apply([1.0, 0.0, 0.0]).T, turned.apply([0.0, 0.0, 1.0]).T
    return State(tuple(axis), zeros, zeros, zeros, tuple(marker), zeros[0])


@pytest.mark.parametrize(
    "quaternions",
    [RANDOM, HALF_TURNS, NEARLY_HALF_TURNS, np.eye(4)],
    ids=["any", "half turns", "nearly half turns", "about the axes"],
)
def test_orientation_turns_the_body_to_where_it_is(quaternions):
    turned = Rotation.from_quat(quaternions, scalar_first=True)
    found = orientation(standing(turned))
    np.testing.assert_allclose(np.linalg.norm(found, axis=1), 1.0, rtol=0, atol=1e-15)
    again = Rotation.from_quat(found, scalar_first=True)
    np.testing.assert_allclose(again.as_matrix(), turned.as_matrix(), rtol=0, atol=4e-15)


def test_orientation_does_not_jump_from_sample_to_sample():
    angles = np.linspace(0.0, 20.0, 400)
    turned = Rotation.from_rotvec(angles[:, None] * np.array([0.6, 0.0, 0.8]))
    steps = np.diff(orientation(standing(turned)), axis=0)
    assert np.abs(steps).max() < angles[1]
