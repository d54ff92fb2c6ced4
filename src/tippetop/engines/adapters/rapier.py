"""Rapier: soft constraints solved by iterations in short substeps, in single precision."""

import math
from typing import Any

import numpy as np

from tippetop.engines.adapters.base import (
    EngineState,
    Setting,
    axis_of,
    no_drilling,
    no_film,
    no_rolling,
)
from tippetop.engines.bodies import friction_numbers, launch_state, primitives
from tippetop.engines.cases import Case

_DOCUMENTATION = "rapier.rs, Rigid-bodies and Colliders"
_UNIT = (
    "IntegrationParameters.length_unit: about the size of most dynamic bodies; lengths that the"
    " solver tolerates scale with it"
)
_ACCURATE = (
    "IntegrationParameters.num_solver_iterations: the more, the more accurate; FrictionModel: one"
    " Coulomb constraint at each point"
)
_SOFTNESS = (
    "IntegrationParameters.contact_softness: natural frequency and damping ratio of contacts"
)

MANY_ACCURATE = 32
"""Rounds of the solver, each a substep; the default is 4."""


class Rapier:
    """Rapier, by its package for Python, which is of single precision."""

    name = "Rapier"
    package = "rapier3d"
    module = "rapier3d"
    settings = (
        Setting("default", "parameters by default, without sleeping", _DOCUMENTATION, {}),
        Setting(
            "length unit",
            "a length unit of the body's size",
            _UNIT,
            {"sized": True},
        ),
        Setting(
            "32 rounds",
            "as length unit, with 32 rounds of the solver and Coulomb's law at each point",
            f"{_UNIT}; {_ACCURATE}",
            {"sized": True, "rounds": MANY_ACCURATE, "coulomb": True},
        ),
        Setting(
            "stiff",
            "as 32 rounds, with a natural frequency of 0.3/step and a damping ratio of 1",
            f"{_SOFTNESS}; {_UNIT}; {_ACCURATE}",
            {"sized": True, "rounds": MANY_ACCURATE, "coulomb": True, "per_step": 0.3},
        ),
    )

    def refusal(self, case: Case, setting: Setting) -> str | None:
        """Return why it cannot state a case at a setting; None where it can."""
        if primitives(case.problem.body, ellipsoids=False) is None:
            return "no ellipsoid"
        return no_film(case) or no_drilling(case) or no_rolling(case)

    def start(self, case: Case, step: float, setting: Setting) -> "RapierStepper":
        """Return a case at its launch, with steps of this length, s."""
        return RapierStepper(case, step, setting.options)


class RapierStepper:
    """A case under way in Rapier."""

    def __init__(self, case: Case, step: float, options: dict[str, Any]) -> None:
        import rapier3d as rapier  # noqa: PLC0415 - optional

        problem = case.problem
        body, state = problem.body, launch_state(problem)
        shapes = primitives(body, ellipsoids=False) or ()
        world = rapier.PhysicsWorld(gravity=problem.gravity_vector)
        parameters = world.integration_parameters
        parameters.dt = step
        if options.get("sized"):
            parameters.length_unit = max(shape.sizes[0] for shape in shapes)
        if "rounds" in options:
            parameters.num_solver_iterations = options["rounds"]
        if options.get("coulomb"):
            parameters.friction_model = rapier.FrictionModel.COULOMB
        if "per_step" in options:
            softness = rapier.SpringCoefficients(options["per_step"] / step, 1.0)
            parameters.contact_softness = parameters.static_contact_softness = softness
        mu, rebound = friction_numbers(problem).sliding, problem.contact.restitution

        def rubbing(builder: Any) -> Any:
            return builder.friction(mu).restitution(rebound).density(0.0)

        world.add_collider(rubbing(rapier.Collider.halfspace((0.0, 0.0, 1.0))))
        w, x, y, _ = state.quaternion
        angle = 2.0 * math.atan2(math.hypot(x, y), w)
        size = math.hypot(x, y)
        turn = (angle * x / size, angle * y / size, 0.0) if size else (0.0, 0.0, 0.0)
        inertia = rapier.MassProperties((0.0, 0.0, 0.0), body.mass, (body.I1, body.I1, body.I3))
        builder = (
            rapier.RigidBody.dynamic()
            .translation(state.position)
            .rotation(turn)
            .linvel(state.velocity)
            .angvel(state.omega)
            .can_sleep(False)
            .gyroscopic_forces(True)
            .allow_fast_rotation(True)
            .additional_mass_properties(inertia)
        )
        self.handle = world.add_body(builder)
        parts = []
        for shape in shapes:
            # Its cylinders stand along y.
            upright = rapier.Rotation3.from_scaled_axis((math.pi / 2, 0.0, 0.0))
            if shape.kind == "sphere":
                solid = rapier.SharedShape.ball(shape.sizes[0])
            else:
                radius, half = shape.sizes
                solid = rapier.SharedShape.cylinder(half, radius)
            parts.append((rapier.Isometry3((0.0, 0.0, shape.center), upright), solid))
        # One collider: where a body has several, even without mass, it takes the axes of inertia
        # in another order than their moments.
        if len(parts) == 1:
            ((place, solid),) = parts
            outside = rapier.Collider.new(solid).position(place)
        else:
            outside = rapier.Collider.compound(parts)
        world.add_collider(rubbing(outside), parent=self.handle)
        self.world = world

    def advance(self, steps: int) -> None:
        """Take a number of steps."""
        for _ in range(steps):
            self.world.step()

    def read(self) -> EngineState:
        """Return the state."""
        body = self.world.rigid_bodies[self.handle]
        x, y, z, w = _numbers(body.rotation, "ijkw")
        velocity, omega = _numbers(body.linvel, "xyz"), _numbers(body.angvel, "xyz")
        return EngineState(
            axis_of(np.array([w, x, y, z])),
            np.array(omega),
            np.array(velocity),
            float(body.translation.z),
        )

    def close(self) -> None:
        """Hold nothing."""


def _numbers(vector: Any, letters: str) -> list[float]:
    """Return the components of one of its vectors."""
    return [float(getattr(vector, letter)) for letter in letters]
