"""MuJoCo: convex, regularized contact with elliptic limits for sliding, drilling and rolling."""

from typing import Any

import numpy as np

from tippetop.engines.adapters.base import EngineState, Setting, axis_of, no_rebound
from tippetop.engines.bodies import friction_numbers, mjcf
from tippetop.engines.cases import Case

_SLIP = "modeling.rst, Solver settings and Preventing slip; XMLreference.rst, option/impratio"


class MuJoCo:
    """MuJoCo, from the MJCF that `tippetop body --mjcf` writes."""

    name = "MuJoCo"
    package = "mujoco"
    module = "mujoco"
    settings = (
        Setting("default", "as installed, with its elliptic cone", "XMLreference.rst, option", {}),
        Setting(
            "no slip",
            "impratio 100, Newton with tolerance 1e-15, 3 rounds of the noslip solver",
            _SLIP,
            {"impratio": 100.0, "tolerance": 1e-15, "noslip_iterations": 3},
        ),
        Setting(
            "implicit, stiff",
            "as no slip, implicit integrator, solref of 2 steps, dampratio 1, solimp 0.99 0.999",
            "modeling.rst, Solver parameters: timeconst at least twice the time step",
            {
                "impratio": 100.0,
                "tolerance": 1e-15,
                "noslip_iterations": 3,
                "integrator": "implicit",
                "stiff": True,
            },
        ),
        Setting(
            "Runge-Kutta, stiff",
            "RK4, impratio 100, solref of 2 steps, solimp 0.99 0.999",
            "computation/index.rst, Numerical integration: RK4 for systems that conserve energy",
            {"impratio": 100.0, "tolerance": 1e-15, "integrator": "RK4", "stiff": True},
        ),
    )

    def refusal(self, case: Case) -> str | None:
        """Return why it cannot state a case; None where it can."""
        if not friction_numbers(case.problem).sliding:
            return "no friction in proportion to slip and normal force"
        return no_rebound(case)

    def start(self, case: Case, step: float, setting: Setting) -> "MuJoCoStepper":
        """Return a case at its launch, with steps of this length, s."""
        return MuJoCoStepper(case, step, setting.options)


class MuJoCoStepper:
    """A case under way in MuJoCo."""

    def __init__(self, case: Case, step: float, options: dict[str, Any]) -> None:
        import mujoco  # noqa: PLC0415 - optional

        self.mujoco = mujoco
        text, _ = mjcf(case.problem, step)
        model = mujoco.MjModel.from_xml_string(text)
        model.opt.timestep = step
        model.opt.impratio = options.get("impratio", 1.0)
        model.opt.tolerance = options.get("tolerance", model.opt.tolerance)
        model.opt.noslip_iterations = options.get("noslip_iterations", 0)
        integrators = {
            "implicit": mujoco.mjtIntegrator.mjINT_IMPLICIT,
            "RK4": mujoco.mjtIntegrator.mjINT_RK4,
        }
        model.opt.integrator = integrators.get(options.get("integrator", ""), model.opt.integrator)
        if options.get("stiff"):
            model.pair_solref[:] = (2.0 * step, 1.0)
            model.pair_solimp[:] = (0.99, 0.999, 1e-6, 0.5, 2.0)
        self.model, self.data = model, mujoco.MjData(model)
        mujoco.mj_resetDataKeyframe(model, self.data, 0)
        mujoco.mj_forward(model, self.data)

    def advance(self, steps: int) -> None:
        """Take a number of steps."""
        self.mujoco.mj_step(self.model, self.data, nstep=steps)

    def read(self) -> EngineState:
        """Return the state."""
        qpos, qvel = np.array(self.data.qpos), np.array(self.data.qvel)
        matrix = np.zeros(9)
        self.mujoco.mju_quat2Mat(matrix, qpos[3:7])
        omega = matrix.reshape(3, 3) @ qvel[3:6]
        return EngineState(axis_of(qpos[3:7]), omega, qvel[:3], float(qpos[2]))

    def close(self) -> None:
        """Hold nothing."""
