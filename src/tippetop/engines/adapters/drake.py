"""Drake: compliant contact with Hunt and Crossley's normal force and regularized friction."""

import math
from typing import Any

import numpy as np

import tippetop as tt
from tippetop.engines.adapters.base import (
    EngineState,
    Setting,
    axis_of,
    no_rebound,
    no_rolling,
)
from tippetop.engines.bodies import friction_numbers, launch_state, primitives
from tippetop.engines.cases import Case

_APPROXIMATION = "pydrake, DiscreteContactApproximation: How to choose an approximation"
_TOLERANCE = "MultibodyPlant.set_stiction_tolerance"
_CONTINUOUS = (
    "pydrake, MultibodyPlant (continuous, time_step 0), which recommends integrators with control"
    " of their error: fixed steps are this comparison's"
)
_HYDROELASTIC = (
    "pydrake, Contact Modeling: hydroelastic pressure is integrated to force and moment, whereas"
    " torsional friction is lost in point contact"
)

TOLERANCE = 5.0
"""Stiction tolerance over the step where it goes with the step, m/s^2: Runge-Kutta is stable."""

FACETS_ACROSS_PATCH = 2.0
"""Facets of a ball's mesh across its patch: with fewer the patch is that of a plane facet; with
twice as many the error is no smaller, and contact takes four times as long."""

SLAB = 0.01
"""Thickness of the elastic table, m: far above the depth of patches, and otherwise without effect,
as pressure goes with modulus times depth over thickness."""


class Drake:
    """Drake's MultibodyPlant: spheres and cylinders on a half space."""

    name = "Drake"
    package = "drake"
    module = "pydrake"
    settings = (
        Setting(
            "default",
            "discrete, lagged approximation, stiffness, dissipation and tolerance by default",
            f"{_APPROXIMATION}: lagged is preferred",
            {},
            width=1e-4,
        ),
        Setting(
            "lagged",
            "discrete, lagged approximation, stiffness and dissipation by default, stiction"
            " tolerance 1e-6 m/s",
            f"{_APPROXIMATION}: lagged is preferred; {_TOLERANCE}",
            {"stiction_tolerance": 1e-6},
            width=1e-6,
        ),
        Setting(
            "lagged, stiff",
            "discrete, lagged approximation, stiffness 2 (0.3/step)^2 m, 1 s/m, stiction tolerance"
            " 1e-6 m/s",
            f"{_APPROXIMATION}: lagged is preferred; {_TOLERANCE}",
            {"stiffness_per_step": 0.3, "dissipation": 1.0, "stiction_tolerance": 1e-6},
            width=1e-6,
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
            width=1e-6,
        ),
        Setting(
            "SAP",
            "discrete, SAP, 1e6 N/m, relaxation time of a step, near-rigid threshold 1e-3",
            "MultibodyPlant.set_sap_near_rigid_threshold: 0, or for example 1e-3, where contact is"
            " softer than meant",
            {
                "discrete_contact_approximation": "sap",
                "sap_near_rigid_threshold": 1e-3,
                "stiffness": 1e6,
                "relaxation": True,
            },
        ),
        Setting(
            "RK3",
            "continuous, runge_kutta3 at fixed steps, stiffness 2 (0.3/step)^2 m, 1 s/m,"
            " stiction tolerance 5 m/s^2 times the step",
            f"{_CONTINUOUS}; {_TOLERANCE}",
            {"scheme": "runge_kutta3", "stiffness_per_step": 0.3, "dissipation": 1.0},
        ),
        Setting(
            "hydroelastic",
            "discrete, lagged approximation, a rigid ball on an elastic table whose modulus gives"
            " the arm of drilling, 0.5 s/m",
            f"{_HYDROELASTIC}; {_APPROXIMATION}",
            {"contact_model": "hydroelastic_with_fallback", "dissipation": 0.5},
            width=1e-4,
        ),
        Setting(
            "hydro, similar",
            "as hydroelastic, similar approximation",
            f"{_HYDROELASTIC}; {_APPROXIMATION}",
            {
                "contact_model": "hydroelastic_with_fallback",
                "discrete_contact_approximation": "similar",
                "dissipation": 0.5,
            },
            width=1e-4,
        ),
    )

    def refusal(self, case: Case, setting: Setting) -> str | None:
        """Return why it cannot state a case at a setting; None where it can."""
        problem, has_patch = case.problem, "contact_model" in setting.options
        if isinstance(problem.friction, tt.ViscousFriction):
            return "viscous friction only by mu = 300 and a stiction tolerance of 1000 m/s"
        reason = no_rolling(case) or no_rebound(case)
        if reason is None and isinstance(problem.friction, tt.ContensouFriction):
            shapes = primitives(problem.body, ellipsoids=False) or ()
            if not has_patch or [shape.kind for shape in shapes] != ["sphere"]:
                reason = "drilling friction only of a single ball, by a hydroelastic patch"
        elif has_patch:
            reason = reason or "a patch is for drilling friction"
        return reason

    def start(self, case: Case, step: float, setting: Setting) -> "DrakeStepper":
        """Return a case at its launch, with steps of this length, s."""
        return DrakeStepper(case, step, dict(setting.options))


class HydroelasticPatch:
    """The elastic table under a rigid ball, whose drilling friction has the arm of a case.

    Where a ball of radius R sinks in by d, the pressure falls from the middle of a patch of radius
    sqrt(2 R d) to its edge as 1 - r^2: its arm of drilling is 8/15 of the radius.
    """

    def __init__(self, case: Case) -> None:
        problem = case.problem
        (ball,) = primitives(problem.body, ellipsoids=False) or ()
        friction = friction_numbers(problem)
        radius = 15.0 / 8.0 * friction.torsional / friction.sliding
        self.depth = radius**2 / (2.0 * ball.sizes[0])
        """How deep the ball sinks in at rest, m."""
        weight = problem.body.mass * problem.gravity
        self.modulus = 2.0 * weight * SLAB / (math.pi * radius**2 * self.depth)
        """Modulus of the table, Pa."""
        self.facet = 2.0 * radius / FACETS_ACROSS_PATCH
        """Size of the facets of the ball, m."""


class DrakeStepper:
    """A case under way in Drake."""

    def __init__(self, case: Case, step: float, options: dict[str, Any]) -> None:
        from pydrake.geometry import (  # noqa: PLC0415 - optional
            AddCompliantHydroelasticPropertiesForHalfSpace,
            AddContactMaterial,
            AddRigidHydroelasticProperties,
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
        shapes = primitives(body, ellipsoids=False) or ()
        stiffness, dissipation = options.pop("stiffness", None), options.pop("dissipation", None)
        relaxation = step if options.pop("relaxation", False) else None
        scheme = options.pop("scheme", None)
        patch = HydroelasticPatch(case) if "contact_model" in options else None
        frequency = options.pop("stiffness_per_step", None)
        if frequency:
            stiffness = 2.0 * problem.body.mass * (frequency / step) ** 2  # two springs in a row
        if scheme:
            options["stiction_tolerance"] = TOLERANCE * step
        builder = DiagramBuilder()
        config = MultibodyPlantConfig(
            **{"time_step": 0.0 if scheme else step, "contact_model": "point", **options}
        )
        plant, _ = AddMultibodyPlant(config, builder)
        plant.mutable_gravity_field().set_gravity_vector(list(problem.gravity_vector))
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

        elastic, rigid = material(), material()
        if patch:
            AddCompliantHydroelasticPropertiesForHalfSpace(
                slab_thickness=SLAB, hydroelastic_modulus=patch.modulus, properties=elastic
            )
            AddRigidHydroelasticProperties(resolution_hint=patch.facet, properties=rigid)
        world, placed = plant.world_body(), RigidTransform
        plant.RegisterCollisionGeometry(world, placed(), HalfSpace(), "table", elastic)
        for number, shape in enumerate(shapes):
            solid = (
                Sphere(shape.sizes[0])
                if shape.kind == "sphere"
                else Cylinder(shape.sizes[0], 2.0 * shape.sizes[1])
            )
            center = placed([0.0, 0.0, shape.center])
            plant.RegisterCollisionGeometry(top, center, solid, f"surface{number}", rigid)
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
        place = np.array(state.position)
        if patch:
            place[2] -= patch.depth
        plant.SetPositions(self.context, [*state.quaternion, *place])
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
