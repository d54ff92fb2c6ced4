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

_CONFIG = "Doxygen, MultibodyPlantConfig and Compliant Contact in Drake"


class Drake:
    """Drake's MultibodyPlant in discrete time, spheres and cylinders on a half space."""

    name = "Drake"
    package = "drake"
    module = "pydrake"
    settings = (
        Setting(
            "default",
            "lagged convex approximation, stiffness and dissipation by the plant's defaults",
            _CONFIG,
            {"discrete_contact_approximation": "lagged"},
        ),
        Setting(
            "similar, stiff",
            "similar approximation, 1e6 N/m, stiction tolerance 1e-6 m/s, dissipation 10 s/m",
            _CONFIG,
            {
                "discrete_contact_approximation": "similar",
                "stiction_tolerance": 1e-6,
                "stiffness": 1e6,
                "dissipation": 10.0,
            },
        ),
        Setting(
            "SAP, near rigid",
            "SAP approximation, 1e6 N/m, relaxation time of a step, near-rigid threshold 0.01",
            _CONFIG,
            {
                "discrete_contact_approximation": "sap",
                "sap_near_rigid_threshold": 0.01,
                "stiffness": 1e6,
                "relaxation": True,
            },
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
        from pydrake.systems.analysis import Simulator  # noqa: PLC0415
        from pydrake.systems.framework import DiagramBuilder  # noqa: PLC0415

        problem = case.problem
        body, state = problem.body, launch_state(problem)
        stiffness, dissipation = options.pop("stiffness", None), options.pop("dissipation", None)
        relaxation = step if options.pop("relaxation", False) else None
        builder = DiagramBuilder()
        config = MultibodyPlantConfig(time_step=step, contact_model="point", **options)
        plant, _ = AddMultibodyPlant(config, builder)
        plant.mutable_gravity_field().set_gravity_vector([0.0, 0.0, -problem.gravity])
        I1, I3 = body.I1 / body.mass, body.I3 / body.mass
        inertia = SpatialInertia(body.mass, [0.0, 0.0, 0.0], UnitInertia(I1, I1, I3))
        top = plant.AddRigidBody("top", inertia)
        mu = friction_numbers(problem).sliding

        def material() -> Any:
            properties = ProximityProperties()
            told = {"friction": CoulombFriction(mu, mu)}
            if stiffness is not None:
                told["point_stiffness"] = stiffness
            if dissipation is not None:
                told["dissipation"] = dissipation
            AddContactMaterial(properties=properties, **told)
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
        context = self.simulator.get_mutable_context()
        self.context = plant.GetMyMutableContextFromRoot(context)
        self.plant, self.step, self.diagram, self.time = plant, step, diagram, 0
        plant.SetPositions(self.context, [*state.quaternion, *state.position])
        plant.SetVelocities(self.context, [*state.omega, *state.velocity])
        self.simulator.Initialize()

    def advance(self, steps: int) -> None:
        """Take a number of steps."""
        self.time += steps
        # Half a step later: the step at that instant is taken, and no other.
        self.simulator.AdvanceTo((self.time - 0.5) * self.step)

    def read(self) -> EngineState:
        """Return the state."""
        q = np.array(self.plant.GetPositions(self.context))
        v = np.array(self.plant.GetVelocities(self.context))
        return EngineState(axis_of(q[:4]), v[:3], v[3:6], float(q[6]))

    def close(self) -> None:
        """Hold nothing."""
