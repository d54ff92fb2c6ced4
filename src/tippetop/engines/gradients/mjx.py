"""Derivatives in MJX: its steps, differentiated by JAX."""

import functools
from typing import Any

import numpy as np

from tippetop.engines.adapters import adapter
from tippetop.engines.bodies import launch_state
from tippetop.engines.cases import Case
from tippetop.engines.gradients.base import Array, Gradients
from tippetop.engines.gradients.mujoco import ORIENTATION, MuJoCoLaunch


def gradients(case: Case, step: float) -> Gradients:
    """Yield method, setting and function of a parameter for MJX, by forward mode of JAX.

    MJX has no noslip solver.
    """
    made = adapter("mujoco")
    for setting in made.settings:
        if made.refusal(case, setting) or setting.options.get("noslip_iterations"):
            continue
        launch = MuJoCoLaunch(case, step, setting)
        yield "forward mode of JAX", setting.name, functools.partial(_by_jax, launch)


def _by_jax(launch: MuJoCoLaunch, parameter: str) -> Array:
    """Return the derivative of the judged state by a parameter in MJX."""
    from mujoco import mjx  # noqa: PLC0415 - optional

    multiply, follow = launch.mujoco.mju_mulQuat, _following()
    state = launch_state(launch.case.problem)
    place = np.array([*state.position, *state.quaternion])
    motion = np.array([*state.velocity, *state.omega_body])
    change, rotated = launch.change(parameter), np.zeros(4)
    multiply(rotated, place[3:7], np.concatenate([[0.0], change[ORIENTATION]]))
    shift = np.concatenate([change[:3], 0.5 * rotated])
    model, data = mjx.put_model(launch.model), mjx.put_data(launch.model, launch.data)
    ends, changes = follow(model, data, launch.count, place, motion, shift, change[6:])
    place, motion, moved, sped = (np.array(one) for one in (*ends, *changes))
    back, inverse = np.zeros(4), place[3:7] * (1.0, -1.0, -1.0, -1.0)
    multiply(back, inverse / (inverse @ inverse), moved[3:7])
    end = np.concatenate([moved[:3], 2.0 * back[1:], sped])
    return launch.judged(end, place, motion)


@functools.cache
def _following() -> Any:
    """Return a compiled function that follows a launch in MJX, and a change of it."""
    import jax  # noqa: PLC0415 - optional
    from mujoco import mjx  # noqa: PLC0415 - optional

    jax.config.update("jax_enable_x64", True)

    def stepped(model: Any, data: Any) -> Any:
        """Return data after a step, with the same types: in double precision, MJX widens some."""
        after = mjx.step(model, data)
        return jax.tree_util.tree_map(
            lambda new, old: jax.numpy.asarray(new, old.dtype), after, data
        )

    def follow(model: Any, data: Any, count: Any, place: Any, motion: Any, *change: Any) -> Any:
        def last(place: Any, motion: Any) -> Any:
            moved = data.replace(qpos=place, qvel=motion)
            end = jax.lax.fori_loop(0, count, lambda _, one: stepped(model, one), moved)
            return end.qpos, end.qvel

        return jax.jvp(last, (place, motion), change)

    return jax.jit(follow)
