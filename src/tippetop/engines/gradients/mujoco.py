"""Derivatives in MuJoCo: differences of every step (`mjd_transitionFD`), multiplied."""

import functools
from typing import Any

import numpy as np

from tippetop.engines.adapters import adapter
from tippetop.engines.adapters.base import Setting
from tippetop.engines.bodies import launch_state
from tippetop.engines.cases import Case
from tippetop.engines.gradients.base import PART, Array, Gradients, by_runs, steps_of
from tippetop.engines.reference import judged_state
from tippetop.support.errors import Unavailable

PERTURBATIONS = (1e-6, 1e-8)
"""Changes of a state in `mjd_transitionFD`: that of MuJoCo's examples, and a smaller one. A contact
that is less deep than the change opens within it."""

ORIENTATION = slice(3, 6)
"""Where the change of orientation is in a change of MuJoCo's state, in the body's axes."""


class MuJoCoLaunch:
    """A case in MuJoCo with steps of a length, and changes of its launch."""

    def __init__(self, case: Case, step: float, setting: Setting) -> None:
        try:
            import mujoco  # noqa: PLC0415 - optional
        except ImportError:
            raise Unavailable("MuJoCo is not installed: pip install 'tippetop[engines]'") from None
        self.mujoco, self.case = mujoco, case
        self.count, length = steps_of(case, step)
        stepper: Any = adapter("mujoco").start(case, length, setting)
        self.model, self.data = stepper.model, stepper.data

    def change(self, parameter: str) -> Array:
        """Return the change of MuJoCo's state at launch, by a number of the launch."""
        value = self.case.problem.get(parameter)
        ends = []
        for sign in (1.0, -1.0):
            problem = self.case.problem.replace({parameter: value * (1.0 + sign * PART)})
            state = launch_state(problem)
            ends.append(
                (
                    np.array([*state.position, *state.quaternion]),
                    np.array([*state.velocity, *state.omega_body]),
                )
            )
        (high, fast), (low, slow) = ends
        turned = np.zeros(6)
        self.mujoco.mj_differentiatePos(self.model, turned, 2.0 * PART * value, low, high)
        return np.concatenate([turned, (fast - slow) / (2.0 * PART * value)])

    def carried(self, change: Array, perturbation: float) -> Array:
        """Return the change of the judged state that a change at launch becomes, step by step, by
        differences with a change of the state.
        """
        mujoco, model, data = self.mujoco, self.model, self.data
        size = 2 * model.nv
        matrix = np.zeros((size, size))
        for _ in range(self.count):
            mujoco.mjd_transitionFD(model, data, perturbation, True, matrix, None, None, None)
            change = matrix @ change
            mujoco.mj_step(model, data)
        return self.judged(change, np.array(data.qpos), np.array(data.qvel))

    def judged(self, change: Array, place: Array, motion: Array) -> Array:
        """Return the change of the judged state by that of MuJoCo's state at the end."""
        entries = np.zeros(9)
        self.mujoco.mju_quat2Mat(entries, place[3:7])
        turn = entries.reshape(3, 3)
        turned, spun = change[ORIENTATION], change[9:12]
        axis = turn @ np.cross(turned, [0.0, 0.0, 1.0])
        omega = turn @ (np.cross(turned, motion[3:6]) + spun)
        return judged_state(self.case, axis, omega)


def gradients(case: Case, step: float) -> Gradients:
    """Yield method, setting and function of a parameter for MuJoCo."""
    made = adapter("mujoco")
    for setting in made.settings:
        if made.refusal(case, setting):
            continue
        differences = functools.partial(by_runs, "mujoco", case, step, setting, PART)
        yield "differences of runs", setting.name, differences
        if setting.options.get("integrator") == "RK4":
            continue  # mjd_transitionFD refuses it.
        for perturbation in PERTURBATIONS:
            yield (
                f"mjd_transitionFD, eps {perturbation:g}",
                setting.name,
                functools.partial(_stepwise, case, step, setting, perturbation),
            )


def _stepwise(
    case: Case, step: float, setting: Setting, perturbation: float, parameter: str
) -> Array:
    """Return the derivative of the judged state by `mjd_transitionFD` at every step."""
    launch = MuJoCoLaunch(case, step, setting)
    return launch.carried(launch.change(parameter), perturbation)
