"""Bullet through PyBullet: sequential impulses on rigid contacts."""

from typing import Any

import numpy as np

from tippetop.engines.adapters.base import EngineState, Setting, axis_of, no_film
from tippetop.engines.bodies import friction_numbers, launch_state, primitives
from tippetop.engines.cases import Case

_GUIDE = "PyBullet Quickstart Guide, setPhysicsEngineParameter"
_LIMIT = "bulletphysics/bullet3 issue 1890: maxJointVelocity raises the limit of 100"
_SIZE = (
    "Bullet User Manual, General Tips: objects that move are 0.2 units at least, or have shorter"
    " steps"
)
_MARGIN = "PyBullet Quickstart Guide, changeDynamics: collisionMargin, by its words unsupported"

FASTEST = 1e9
"""Limit of velocities, rad/s and m/s: by default Bullet cuts them off at 100."""

BREAKING_THRESHOLD = 0.02
"""Bullet's default of contactBreakingThreshold, part of the size of a shape. A variable of the
process has it, not a world, so that a run that did not set it would have that of the one before."""

_ROUNDS = {
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
            "500 rounds, no residual at which it stops, rebounds from 1 mm/s",
            f"{_GUIDE}: numSolverIterations, solverResidualThreshold; {_LIMIT}",
            _ROUNDS,
        ),
        Setting(
            "thin contacts",
            "as 500 rounds, with contactBreakingThreshold 1e-4 of the size of a shape",
            f"{_GUIDE}: contactBreakingThreshold; {_LIMIT}",
            {**_ROUNDS, "contactBreakingThreshold": 1e-4},
        ),
        Setting(
            "decimetres",
            "as 500 rounds, with lengths in decimetres",
            f"{_SIZE}; {_LIMIT}",
            {**_ROUNDS, "units_per_metre": 10.0},
        ),
        Setting(
            "thin margin",
            "as 500 rounds, with the margin of a cylinder 0.01 mm in place of 1 mm",
            f"{_MARGIN}; {_LIMIT}",
            {**_ROUNDS, "margin": 1e-5},
        ),
    )

    def refusal(self, case: Case, setting: Setting) -> str | None:
        """Return why it cannot state a case at a setting; None where it can."""
        shapes = primitives(case.problem.body, ellipsoids=False)
        if shapes is None:
            return "no ellipsoid"
        if "margin" in setting.options and shapes[0].kind == "sphere":
            return "spheres have no margin"
        return no_film(case)

    def start(self, case: Case, step: float, setting: Setting) -> "PyBulletStepper":
        """Return a case at its launch, with steps of this length, s."""
        return PyBulletStepper(case, step, setting.options)


class PyBulletStepper:
    """A case under way in Bullet."""

    def __init__(self, case: Case, step: float, options: dict[str, Any]) -> None:
        import pybullet  # noqa: PLC0415 - optional

        parameters = {"contactBreakingThreshold": BREAKING_THRESHOLD, **options}
        self.units = units = parameters.pop("units_per_metre", 1.0)
        margin = parameters.pop("margin", None)
        if "restitutionVelocityThreshold" in parameters:
            parameters["restitutionVelocityThreshold"] *= units
        self.bullet = pybullet
        self.client = pybullet.connect(pybullet.DIRECT)
        on = {"physicsClientId": self.client}
        problem = case.problem
        body, friction, state = problem.body, friction_numbers(problem), launch_state(problem)
        pybullet.setGravity(*(part * units for part in problem.gravity_vector), **on)
        pybullet.setPhysicsEngineParameter(fixedTimeStep=step, numSubSteps=0, **parameters, **on)
        plane = pybullet.createCollisionShape(pybullet.GEOM_PLANE, planeNormal=[0, 0, 1], **on)
        table = pybullet.createMultiBody(0.0, plane, **on)
        shapes = primitives(body, ellipsoids=False) or ()
        if shapes[0].kind == "cylinder":
            radius, half = shapes[0].sizes
            shape = pybullet.createCollisionShape(
                pybullet.GEOM_CYLINDER, radius=radius * units, height=2.0 * half * units, **on
            )
        else:
            shape = pybullet.createCollisionShapeArray(
                shapeTypes=[pybullet.GEOM_SPHERE] * len(shapes),
                radii=[shape.sizes[0] * units for shape in shapes],
                collisionFramePositions=[[0.0, 0.0, shape.center * units] for shape in shapes],
                **on,
            )
        w, x, y, z = state.quaternion
        self.top = pybullet.createMultiBody(
            body.mass,
            shape,
            basePosition=[units * length for length in state.position],
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
        if margin is not None:
            quiet["collisionMargin"] = margin * units
        pybullet.changeDynamics(
            self.top,
            -1,
            localInertiaDiagonal=[units**2 * one for one in (body.I1, body.I1, body.I3)],
            lateralFriction=friction.sliding,
            spinningFriction=friction.torsional * units,
            rollingFriction=friction.rolling * units,
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
        velocity = [units * one for one in state.velocity]
        pybullet.resetBaseVelocity(self.top, velocity, state.omega, **on)

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
        velocity, height = np.array(velocity) / self.units, float(position[2]) / self.units
        return EngineState(axis, np.array(omega), velocity, height)

    def close(self) -> None:
        """Give back the world."""
        self.bullet.disconnect(physicsClientId=self.client)
