"""The picture of the torque has the numbers of the mechanics."""

import json
import math

import numpy as np
import pytest

import tippetop as tt
from bundled import WEB
from node import printed


@pytest.mark.parametrize("tilt", [0.2, 0.7, 1.3])
def test_the_torque_is_what_changes_the_angular_momentum(tilt):
    """The change over a short time, in the plane of the axis and the vertical at its start."""
    spin, step = 155.0, 1e-5
    launch = tt.Launch(spin=spin, tilt=tilt, velocity=(0.0, 0.0))
    problem = tt.presets.report_problem().model_copy(update={"launch": launch})
    module = json.dumps((WEB / "src" / "lab" / "torque.js").as_uri())
    asked = json.dumps(problem.model_dump(mode="json"))
    found = json.loads(
        printed(
            f"import {{ torqueAt }} from {module};\n"
            f"console.log(JSON.stringify(torqueAt({asked}, {spin}, {tilt})));\n"
        )
    )
    run = tt.simulate(problem, 2.0 * step, times=[0.0, step, 2.0 * step])
    axis = run["axis"].values[0]
    plane = np.array([axis[0], axis[1]]) / math.hypot(axis[0], axis[1])
    momentum = run["angular_momentum"].values

    def in_plane(vector):
        return [float(plane @ vector[:2]), float(vector[2])]

    assert found["momentum"] == pytest.approx(in_plane(momentum[0]), rel=1e-9)
    # What the first order of the step adds is twice as much in twice the step.
    change = (2.0 * (momentum[1] - momentum[0]) - 0.5 * (momentum[2] - momentum[0])) / step
    normal = float(run["normal_force"].values[0])
    weight = problem.body.mass * problem.gravity
    # The picture shows friction under the weight; the table pushes a little more or less.
    expected = [torque * normal / weight for torque in found["torque"]]
    assert in_plane(change) == pytest.approx(expected, rel=1e-4)
