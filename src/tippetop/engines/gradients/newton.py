"""Derivatives in Newton: its steps, followed backwards by Warp."""

import functools
import itertools
from typing import Any

import numpy as np

from tippetop.engines.adapters import adapter
from tippetop.engines.adapters.base import Setting, axis_of, settings_of
from tippetop.engines.bodies import launch_state
from tippetop.engines.cases import Case
from tippetop.engines.gradients.base import PART, Array, Gradients, by_runs, steps_of
from tippetop.engines.reference import judged_state

PART_IN_SINGLE_PRECISION = 1e-3
"""Change of a number of the launch in differences of whole runs, relative: Newton is of single
precision, whose rounding a smaller one would show.
"""


def gradients(case: Case, step: float) -> Gradients:
    """Yield method, setting and function of a parameter for Newton.

    By its documentation, of the solvers here SolverSemiImplicit alone is differentiable.
    """
    made = adapter("newton")
    for setting in settings_of(made, case):
        differences = functools.partial(
            by_runs, "newton", case, step, setting, PART_IN_SINGLE_PRECISION
        )
        yield "differences of runs", setting.name, differences
        if setting.options["solver"] == "SemiImplicit":
            yield "reverse mode of Warp", setting.name, NewtonTape(case, step, setting).carried


class NewtonTape:
    """The steps of a case in Newton, recorded to be followed backwards."""

    def __init__(self, case: Case, step: float, setting: Setting) -> None:
        from tippetop.engines.adapters.newton import NewtonWorld  # noqa: PLC0415 - optional

        self.case = case
        count, length = steps_of(case, step)
        world = NewtonWorld(case, length, setting.options, requires_grad=True)
        self.warp, self.states = world.warp, [world.state() for _ in range(count + 1)]
        self.tape = self.warp.Tape()
        with self.tape:
            for before, after in itertools.pairwise(self.states):
                # Steps that shared their contacts would be followed back with those of the last.
                world.follow(before, after, world.pipeline.contacts())

    def _launch(self, parameter: str, sign: float) -> Array:
        """Return Newton's numbers of place and motion at a launch beside that of the case."""
        value = self.case.problem.get(parameter) * (1.0 + sign * PART)
        state = launch_state(self.case.problem.replace({parameter: value}))
        w, x, y, z = state.quaternion
        return np.array([*state.position, x, y, z, w, *state.velocity, *state.omega])

    @functools.cached_property
    def matrix(self) -> Array:
        """Derivatives of orientation and angular velocity at the end by the numbers at launch."""
        first, last = self.states[0], self.states[-1]
        rows = []
        for number in (*range(3, 7), *range(10, 13)):
            seed = np.zeros(13, np.float32)
            seed[number] = 1.0
            self.tape.zero()
            self.tape.backward(
                grads={
                    last.body_q: self._array(seed[None, :7], last.body_q),
                    last.body_qd: self._array(seed[None, 7:], last.body_qd),
                }
            )
            rows.append([*first.body_q.grad.numpy()[0], *first.body_qd.grad.numpy()[0]])
        return np.array(rows)

    def _array(self, values: Any, alike: Any) -> Any:
        return self.warp.array(values, dtype=alike.dtype, device=alike.device)

    def carried(self, parameter: str) -> Array:
        """Return the derivative of the judged state by a number of the launch."""
        apart = 2.0 * PART * self.case.problem.get(parameter)
        change = (self._launch(parameter, 1.0) - self._launch(parameter, -1.0)) / apart
        turned, spun = np.split(self.matrix @ change, [4])
        x, y, z, w = self.states[-1].body_q.numpy()[0].astype(float)[3:]
        quaternion = np.array([w, x, y, z])
        ahead, behind = (
            axis_of(quaternion + sign * PART * np.roll(turned, 1)) for sign in (1.0, -1.0)
        )
        return judged_state(self.case, (ahead - behind) / (2.0 * PART), spun)
