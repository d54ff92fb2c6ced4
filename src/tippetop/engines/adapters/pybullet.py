"""Bullet through PyBullet: sequential impulses on rigid contacts."""

from typing import Any

import numpy as np

import tippetop as tt
from tippetop.engines.adapters.base import EngineState, Setting, axis_of, dry_only
from tippetop.engines.bodies import friction_numbers, launch_state, primitives
from tippetop.engines.cases import Case

_GUIDE = "PyBullet Quickstart Guide, setPhysicsEngineParameter"
_LIMIT = "bulletphysics/bullet3 issue 1890: maxJointVelocity raises the limit of 100"

FASTEST = 1e9
"""Limit of velocities, rad/s and m/s: by default Bullet cuts them off at 100."""


_ROUNDS = {
    "enableConeFriction": 1,
    "numSolverIterations": 500,
    "solverResidualThreshold": 0.0,
    "restitutionVelocityThreshold": 1e-3,
}


class PyBullet:
    """Bullet, as a base without joints, without damping, sleeping and limits of velocity.

    Bullet multiplies the sliding coefficients of two bodies. A drilling or rolling arm is the arm
    of one body times the sliding coefficient of the other, and the same with the bodies exchanged
    (`btManifoldResult`): the table has a sliding coefficient of 1, and no arms.
    """

    name = "Bullet"
    package = "pybullet"
    module = "pybullet"
    settings = (
        Setting("default", "50 rounds of its solver", f"{_GUIDE}; {_LIMIT}", {}),
        Setting(
            "500 rounds",
            "friction cone, 500 rounds, no residual at which it stops, rebounds from 1 mm/s",
            f"{_GUIDE}: numSolverIterations, solverResidualThreshold, enableConeFriction; {_LIMIT}",
            _ROUNDS,
        ),
        Setting(
            "thin contacts",
            "as 500 rounds, with contactBreakingThreshold 0.1 mm, of bodies of 15 mm to 40 mm",
            f"{_GUIDE}: contactBreakingThreshold; {_LIMIT}",
            {**_ROUNDS, "contactBreakingThreshold": 1e-4},
        ),
    )

    def refusal(self, case: Case) -> str | None:
        """Return why it cannot state a case; None where it can."""
        if isinstance(case.problem.friction, tt.ContensouFriction):
            return None if primitives(case.problem.body, ellipsoids=False) else "no ellipsoid"
        return dry_only(case)

    def start(self, case: Case, step: float, setting: Setting) -> "PyBulletStepper":
        """Return a case at its launch, with steps of this length, s."""
        return PyBulletStepper(case, step, setting.options)


class PyBulletStepper:
    """A case under way in Bullet."""

    def __init__(self, case: Case, step: float, options: dict[str, Any]) -> None:
        import pybullet  # noqa: PLC0415 - optional

        self.bullet = pybullet
        self.client = pybullet.connect(pybullet.DIRECT)
        on = {"physicsClientId": self.client}
        problem = case.problem
        body, friction, state = problem.body, friction_numbers(problem), launch_state(problem)
        pybullet.setGravity(0.0, 0.0, -problem.gravity, **on)
        pybullet.setPhysicsEngineParameter(fixedTimeStep=step, numSubSteps=0, **options, **on)
        plane = pybullet.createCollisionShape(pybullet.GEOM_PLANE, planeNormal=[0, 0, 1], **on)
        table = pybullet.createMultiBody(0.0, plane, **on)
        shapes = primitives(body, ellipsoids=False) or ()
        if shapes[0].kind == "cylinder":
            radius, half = shapes[0].sizes
            shape = pybullet.createCollisionShape(
                pybullet.GEOM_CYLINDER, radius=radius, height=2.0 * half, **on
            )
        else:
            shape = pybullet.createCollisionShapeArray(
                shapeTypes=[pybullet.GEOM_SPHERE] * len(shapes),
                radii=[shape.sizes[0] for shape in shapes],
                collisionFramePositions=[[0.0, 0.0, shape.center] for shape in shapes],
                **on,
            )
        w, x, y, z = state.quaternion
        self.top = pybullet.createMultiBody(
            body.mass,
            shape,
            basePosition=state.position,
            baseOrientation=[x, y, z, w],
            **on,
        )
        quiet = {
            "linearDamping": 0.0,
            "angularDamping": 0.0,
            "jointDamping": 0.0,
            "activationState": pybullet.ACTIVATION_STATE_DISABLE_SLEEPING,
            "maxJointVelocity": FASTEST,
        }
        pybullet.changeDynamics(
            self.top,
            -1,
            localInertiaDiagonal=[body.I1, body.I1, body.I3],
            lateralFriction=friction.sliding,
            spinningFriction=friction.torsional,
            rollingFriction=friction.rolling,
            restitution=problem.contact.restitution,
            **quiet,
            **on,
        )
        pybullet.changeDynamics(
            table,
            -1,
            lateralFriction=1.0,
            spinningFriction=0.0,
            rollingFriction=0.0,
            restitution=1.0,
            **on,
        )
        pybullet.resetBaseVelocity(self.top, state.velocity, state.omega, **on)

    def advance(self, steps: int) -> None:
        """Take a number of steps."""
        for _ in range(steps):
            self.bullet.stepSimulation(physicsClientId=self.client)

    def read(self) -> EngineState:
        """Return the state."""
        on = {"physicsClientId": self.client}
        position, (x, y, z, w) = self.bullet.getBasePositionAndOrientation(self.top, **on)
        velocity, omega = self.bullet.getBaseVelocity(self.top, **on)
        axis = axis_of(np.array([w, x, y, z]))
        return EngineState(axis, np.array(omega), np.array(velocity), float(position[2]))

    def close(self) -> None:
        """Give back the world."""
        self.bullet.disconnect(physicsClientId=self.client)
