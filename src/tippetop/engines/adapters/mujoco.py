"""MuJoCo: convex, regularized contact with elliptic limits for sliding, drilling and rolling."""

import math
from typing import Any

import numpy as np
from scipy.optimize import brentq

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

_DIRECT = (
    "Modeling, Solver parameters and Restitution: solref of two non-positive numbers is stiffness"
    " and damping, which allows control over restitution in particular"
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
        Setting(
            "rebounds",
            "RK4, impratio 100, solref by stiffness (0.3/step)^2 and the damping that gives the"
            " coefficient of restitution, solimp 0.999 0.999",
            _DIRECT,
            {"impratio": 100.0, "tolerance": 1e-15, "integrator": "RK4", "rebound_per_step": 0.3},
        ),
    )

    def refusal(self, case: Case, setting: Setting) -> str | None:
        """Return why it cannot state a case at a setting; None where it can."""
        if "rebound_per_step" not in setting.options:
            return no_film(case) or no_rebound(case)
        return None if case.problem.contact.restitution else "a solref for rebounds"

    def start(self, case: Case, step: float, setting: Setting) -> "MuJoCoStepper":
        """Return a case at its launch, with steps of this length, s."""
        return MuJoCoStepper(case, step, setting.options)


def rebound_of(damping_ratio: float) -> float:
    """Return the coefficient of restitution of a spring and damper that only push.

    Contact ends where their force, not their length, is zero (Schwager and Poeschel 2007). The
    damping ratio is below 1.
    """
    swing = math.sqrt(1.0 - damping_ratio**2)
    duration = math.pi - math.atan2(2.0 * damping_ratio * swing, swing**2 - damping_ratio**2)
    return math.exp(-damping_ratio / swing * duration)


def damping_ratio(restitution: float) -> float:
    """Return the damping ratio whose `rebound_of` is a coefficient of restitution, 0.15 to 1."""
    return float(brentq(lambda ratio: rebound_of(ratio) - restitution, 0.0, 0.99))


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
        if per_step := options.get("rebound_per_step"):
            frequency = per_step / step
            ratio = damping_ratio(case.problem.contact.restitution)
            model.pair_solref[:] = (-(frequency**2), -2.0 * ratio * frequency)
            model.pair_solimp[:] = (0.999, 0.999, 1e-6, 0.5, 2.0)
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
