"""Drake: point contact with Hunt and Crossley's normal force and regularized friction."""

from typing import Any

import numpy as np

from tippetop.engines.adapters.base import (
    EngineState,
    Setting,
    axis_of,
    dry_only,
    no_rebound,
    no_rolling,
)
from tippetop.engines.bodies import friction_numbers, launch_state, primitives
from tippetop.engines.cases import Case

_APPROXIMATION = "pydrake, DiscreteContactApproximation: How to choose an approximation"
_TOLERANCE = "MultibodyPlant.set_stiction_tolerance"
_CONTINUOUS = "pydrake, MultibodyPlant (continuous, time_step 0) and SimulatorConfig"

STIFFNESS = 0.3
"""Natural frequency of the contact times the step, where stiffness goes with the step."""

TOLERANCE = 5.0
"""Stiction tolerance over the step where it goes with the step, m/s^2: Runge-Kutta is stable."""


class Drake:
    """Drake's MultibodyPlant: spheres and cylinders on a half space, contact at points."""

    name = "Drake"
    package = "drake"
    module = "pydrake"
    settings = (
        Setting(
            "default",
            "discrete, lagged approximation, stiffness, dissipation and tolerance by default",
            f"{_APPROXIMATION}: lagged is preferred",
            {},
        ),
        Setting(
            "similar",
            "discrete, similar approximation, 1e6 N/m, 10 s/m, stiction tolerance 1e-6 m/s",
            f"{_APPROXIMATION}: similar where strong transients are to be resolved; {_TOLERANCE}",
            {
                "discrete_contact_approximation": "similar",
                "stiction_tolerance": 1e-6,
                "stiffness": 1e6,
                "dissipation": 10.0,
            },
        ),
        Setting(
            "SAP",
            "discrete, SAP, 1e6 N/m, relaxation time of a step, near-rigid threshold 0.01",
            "MultibodyPlant.set_sap_near_rigid_threshold: small where contact is softer than meant",
            {
                "discrete_contact_approximation": "sap",
                "sap_near_rigid_threshold": 0.01,
                "stiffness": 1e6,
                "relaxation": True,
            },
        ),
        Setting(
            "RK3",
            "continuous, runge_kutta3 at fixed steps, stiffness 2 (0.3/step)^2 m, 1 s/m,"
            " stiction tolerance 5 m/s^2 times the step",
            f"{_CONTINUOUS}; {_TOLERANCE}",
            {"scheme": "runge_kutta3", "dissipation": 1.0},
        ),
    )

    def refusal(self, case: Case) -> str | None:
        """Return why it cannot state a case; None where it can."""
        return dry_only(case) or no_rolling(case) or no_rebound(case)

    def start(self, case: Case, step: float, setting: Setting) -> "DrakeStepper":
        """Return a case at its launch, with steps of this length, s."""
        return DrakeStepper(case, step, dict(setting.options))


class DrakeStepper:
    """A case under way in Drake."""

    def __init__(self, case: Case, step: float, options: dict[str, Any]) -> None:
        from pydrake.geometry import (  # noqa: PLC0415 - optional
            AddContactMaterial,
            Cylinder,
            HalfSpace,
            ProximityProperties,
            Sphere,
        )
        from pydrake.math import RigidTransform  # noqa: PLC0415
        from pydrake.multibody.plant import (  # noqa: PLC0415
            AddMultibodyPlant,
            CoulombFriction,
            MultibodyPlantConfig,
        )
        from pydrake.multibody.tree import (  # noqa: PLC0415
            SpatialInertia,
            UnitInertia,
        )
        from pydrake.systems.analysis import (  # noqa: PLC0415
            ResetIntegratorFromFlags,
            Simulator,
        )
        from pydrake.systems.framework import DiagramBuilder  # noqa: PLC0415

        problem = case.problem
        body, state = problem.body, launch_state(problem)
        stiffness, dissipation = options.pop("stiffness", None), options.pop("dissipation", None)
        relaxation = step if options.pop("relaxation", False) else None
        scheme = options.pop("scheme", None)
        if scheme:
            stiffness = 2.0 * problem.body.mass * (STIFFNESS / step) ** 2  # two springs in a row
            options["stiction_tolerance"] = TOLERANCE * step
        builder = DiagramBuilder()
        config = MultibodyPlantConfig(
            time_step=0.0 if scheme else step, contact_model="point", **options
        )
        plant, _ = AddMultibodyPlant(config, builder)
        plant.mutable_gravity_field().set_gravity_vector([0.0, 0.0, -problem.gravity])
        I1, I3 = body.I1 / body.mass, body.I3 / body.mass
        inertia = SpatialInertia(body.mass, [0.0, 0.0, 0.0], UnitInertia(I1, I1, I3))
        top = plant.AddRigidBody("top", inertia)
        mu = friction_numbers(problem).sliding

        def material() -> Any:
            properties = ProximityProperties()
            numbers = {"friction": CoulombFriction(mu, mu)}
            if stiffness is not None:
                numbers["point_stiffness"] = stiffness
            if dissipation is not None:
                numbers["dissipation"] = dissipation
            AddContactMaterial(properties=properties, **numbers)
            if relaxation is not None:
                properties.AddProperty("material", "relaxation_time", relaxation)
            return properties

        world, placed = plant.world_body(), RigidTransform
        plant.RegisterCollisionGeometry(world, placed(), HalfSpace(), "table", material())
        for number, shape in enumerate(primitives(body, ellipsoids=False) or ()):
            solid = (
                Sphere(shape.sizes[0])
                if shape.kind == "sphere"
                else Cylinder(shape.sizes[0], 2.0 * shape.sizes[1])
            )
            place = placed([0.0, 0.0, shape.center])
            plant.RegisterCollisionGeometry(top, place, solid, f"surface{number}", material())
        plant.Finalize()
        diagram = builder.Build()
        self.simulator = Simulator(diagram)
        if scheme:
            ResetIntegratorFromFlags(self.simulator, scheme, step).set_fixed_step_mode(True)
        context = self.simulator.get_mutable_context()
        self.context = plant.GetMyMutableContextFromRoot(context)
        self.plant, self.step, self.diagram, self.time = plant, step, diagram, 0
        # Half a step later a discrete plant has taken the step at that instant, and no other.
        self.late = 0.0 if scheme else -0.5
        plant.SetPositions(self.context, [*state.quaternion, *state.position])
        plant.SetVelocities(self.context, [*state.omega, *state.velocity])
        self.simulator.Initialize()

    def advance(self, steps: int) -> None:
        """Take a number of steps."""
        self.time += steps
        self.simulator.AdvanceTo((self.time + self.late) * self.step)

    def read(self) -> EngineState:
        """Return the state."""
        q = np.array(self.plant.GetPositions(self.context))
        v = np.array(self.plant.GetVelocities(self.context))
        return EngineState(axis_of(q[:4]), v[:3], v[3:6], float(q[6]))

    def close(self) -> None:
        """Hold nothing."""
