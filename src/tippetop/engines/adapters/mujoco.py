"""MuJoCo: convex, regularized contact with elliptic limits for sliding, drilling and rolling."""

from typing import Any

import numpy as np

from tippetop.engines.adapters.base import EngineState, Setting, axis_of, no_film, no_rebound
from tippetop.engines.bodies import mjcf
from tippetop.engines.cases import Case

_FREE_BODY = "Computation, Numerical integration (implicitfast, RK4) and Gyroscopic derivatives"
_NO_SLIP = (
    "Modeling, Solver settings: elliptic cones, large impratio, Newton with very small tolerance;"
    f" if that is not sufficient, the noslip solver. {_FREE_BODY}"
)
_STIFF = (
    "Modeling, Solver parameters: timeconst at least twice the time step, impedance up to 0.9999."
)


class MuJoCo:
    """MuJoCo, from the MJCF that `tippetop body --mjcf` writes."""

    name = "MuJoCo"
    package = "mujoco"
    module = "mujoco"
    settings = (
        Setting(
            "default",
            "as installed, with elliptic cones: Euler, solref 0.02 1, solimp 0.9 0.95",
            "Modeling, Solver settings: elliptic cones are recommended",
            {},
        ),
        Setting(
            "no slip",
            "implicitfast, impratio 100, Newton with tolerance 1e-15, 3 rounds of noslip",
            _NO_SLIP,
            {
                "impratio": 100.0,
                "tolerance": 1e-15,
                "noslip_iterations": 3,
                "integrator": "implicitfast",
            },
        ),
        Setting(
            "stiff",
            "as no slip, with solref of 2 steps and solimp 0.99 0.999",
            f"{_STIFF} {_NO_SLIP}",
            {
                "impratio": 100.0,
                "tolerance": 1e-15,
                "noslip_iterations": 3,
                "integrator": "implicitfast",
                "stiff": True,
            },
        ),
        Setting(
            "RK4, stiff",
            "RK4, impratio 100, solref of 2 steps, solimp 0.99 0.999",
            f"{_STIFF} {_FREE_BODY}: RK4 where energy is to be conserved for long",
            {"impratio": 100.0, "tolerance": 1e-15, "integrator": "RK4", "stiff": True},
        ),
    )

    def refusal(self, case: Case, setting: Setting) -> str | None:
        """Return why it cannot state a case at a setting; None where it can."""
        return no_film(case) or no_rebound(case)

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
            "implicitfast": mujoco.mjtIntegrator.mjINT_IMPLICITFAST,
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
