"""Exudyn: penalty contact of spheres with a triangulated plane, regularized friction."""

import math
from typing import Any

import numpy as np

import tippetop as tt
from tippetop.engines.adapters.base import (
    Array,
    EngineState,
    Setting,
    no_drilling,
    no_rebound,
    no_rolling,
)
from tippetop.engines.bodies import friction_numbers, launch_state, primitives
from tippetop.engines.cases import Case

_EXAMPLE = (
    "Examples/tippeTop.py, by its own words only a demonstration of GeneralContact, whose soft"
    " contact may need other parameters"
)
_EXPLICIT = "exudyn.DynamicSolverType: explicit solvers, without constraints"
_DEFAULT_SOLVER = "SolveDynamic: GeneralizedAlpha is the default"
_IN_DEVELOPMENT = (
    "Contact problems: GeneralContact, and more so with implicit solvers, is still under"
    " development, consider with care"
)
_ZONE = "GeneralContact.frictionProportionalZone: 1e-3 by default, oscillations if very small"
_TRIANGLE = (
    "ObjectContactSphereTriangle: impactModel 2 is much more accurate regarding the coefficient of"
    " restitution, and contactDamping is added to it"
)

ZONE_PER_STEP = 5.0
"""Friction zone over the step where it goes with the step, m/s^2: explicit solvers are stable."""

VISCOUS_ZONE = 10.0
"""Friction zone for viscous friction, m/s: it is above every slip, and friction is linear in it."""

_CORNERS = [[-15.0, -5.0, 0.0], [15.0, -5.0, 0.0], [0.0, 15.0, 0.0]]
"""Corners of the table, m: one triangle, as at an edge between two a sphere touches both."""


class Exudyn:
    """Exudyn's contact of spheres with triangles, in GeneralContact or as an object of its own."""

    name = "Exudyn"
    package = "exudyn"
    module = "exudyn"
    settings = (
        Setting(
            "its example",
            "GeneralContact, stiffness (224/s)^2 m, damping 1 ms of it, friction zone 1e-5 m/s,"
            " explicit Euler",
            _EXAMPLE,
            {"frequency": 224.0, "damping": 1e-3, "zone": 1e-5, "solver": "ExplicitEuler"},
            width=1e-5,
        ),
        Setting(
            "RK44",
            "GeneralContact, stiffness (0.3/step)^2 m, damping ratio 0.2, zone 1e-3 m/s, RK44",
            f"{_EXPLICIT}; {_ZONE}",
            {"per_step": 0.3, "ratio": 0.2, "zone": 1e-3, "solver": "RK44"},
            width=1e-3,
        ),
        Setting(
            "RK67",
            "GeneralContact, stiffness (0.3/step)^2 m, damping ratio 0.2, zone 5 m/s^2 times the"
            " step, RK67",
            f"{_EXPLICIT}; {_ZONE}",
            {"per_step": 0.3, "ratio": 0.2, "solver": "RK67"},
        ),
        Setting(
            "implicit",
            "GeneralContact, stiffness (0.3/step)^2 m, damping ratio 0.2, zone 1e-5 m/s,"
            " GeneralizedAlpha",
            f"{_DEFAULT_SOLVER}; {_IN_DEVELOPMENT}; zone of its example",
            {"per_step": 0.3, "ratio": 0.2, "zone": 1e-5, "solver": "GeneralizedAlpha"},
            width=1e-5,
        ),
        Setting(
            "triangle",
            "ObjectContactSphereTriangle, stiffness (0.3/step)^2 m, damping ratio 0.7 or, for"
            " rebounds, impactModel 2, zone 1e-5 m/s, GeneralizedAlpha",
            f"{_TRIANGLE}; {_DEFAULT_SOLVER}; zone of its example",
            {
                "contact": "triangle",
                "per_step": 0.3,
                "ratio": 0.7,
                "zone": 1e-5,
                "solver": "GeneralizedAlpha",
            },
            width=1e-5,
        ),
    )

    def refusal(self, case: Case, setting: Setting) -> str | None:
        """Return why it cannot state a case at a setting; None where it can."""
        reason = no_drilling(case) or no_rolling(case)
        shapes = primitives(case.problem.body, ellipsoids=False) or ()
        if reason is None and {shape.kind for shape in shapes} != {"sphere"}:
            reason = "only spheres on a plane"
        return reason or (None if "contact" in setting.options else no_rebound(case))

    def start(self, case: Case, step: float, setting: Setting) -> "ExudynStepper":
        """Return a case at its launch, with steps of this length, s."""
        return ExudynStepper(case, step, setting.options)


class ExudynStepper:
    """A case under way in Exudyn.

    Each advance is a run of its solver with a fixed number of steps, as implicit solvers shorten
    steps that fail, and would not come to an instant between.
    """

    def __init__(self, case: Case, step: float, options: dict[str, Any]) -> None:
        import exudyn as exu  # noqa: PLC0415 - optional
        from exudyn import itemInterface, utilities  # noqa: PLC0415

        marker_on, problem = itemInterface.MarkerBodyRigid, case.problem
        body, state = problem.body, launch_state(problem)
        frequency = options.get("frequency") or options["per_step"] / step
        stiffness = body.mass * frequency**2
        damping = stiffness * options.get("damping", 2.0 * options.get("ratio", 0.0) / frequency)
        rebound = problem.contact.restitution
        zone = options.get("zone", ZONE_PER_STEP * step)
        mu = friction_numbers(problem).sliding
        if isinstance(problem.friction, tt.ViscousFriction):
            zone, mu = VISCOUS_ZONE, problem.friction.mu * VISCOUS_ZONE
        exu.config.printToConsole = False
        container = exu.SystemContainer()
        system = container.AddSystem()
        w, x, y, z = state.quaternion
        matrix = np.array(
            [
                [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
            ]
        )
        inertia = utilities.RigidBodyInertia(
            mass=body.mass, inertiaTensor=np.diag([body.I1, body.I1, body.I3]), com=np.zeros(3)
        )
        top = system.CreateRigidBody(
            inertia=inertia,
            nodeType=exu.NodeType.RotationRotationVector,
            referencePosition=list(state.position),
            referenceRotationMatrix=matrix,
            initialVelocity=list(state.velocity),
            initialAngularVelocity=list(state.omega),
            gravity=list(problem.gravity_vector),
        )
        ground = system.AddObject(itemInterface.ObjectGround())
        table = system.AddMarker(marker_on(bodyNumber=ground))
        balls = [
            (
                system.AddMarker(marker_on(bodyNumber=top, localPosition=[0.0, 0.0, shape.center])),
                shape.sizes[0],
            )
            for shape in primitives(body, ellipsoids=False) or ()
        ]
        if "contact" in options:
            law = {
                "contactStiffness": stiffness,
                "contactDamping": 0.0 if rebound else damping,
                "dynamicFriction": mu,
                "frictionProportionalZone": zone,
                "impactModel": 2 if rebound else 0,
                "restitutionCoefficient": rebound or 1.0,
            }
            self._add_triangle_contacts(system, balls, table, law)
        else:
            self._add_general_contact(system, balls, table, stiffness, damping, mu, zone)
        system.Assemble()
        # The container holds the system, and must live as long.
        self.exu, self.container, self.system, self.top = exu, container, system, top
        self.step, self.count = step, 0
        self.solver = getattr(exu.DynamicSolverType, options["solver"])
        self.settings = exu.SimulationSettings()
        self.settings.timeIntegration.verboseMode = 0
        self.settings.solution.file.write = False
        self.settings.show.computationTime = False

    def advance(self, steps: int) -> None:
        """Take a number of steps."""
        time = self.settings.timeIntegration
        time.startTime = self.count * self.step
        self.count += steps
        time.endTime, time.numberOfSteps = self.count * self.step, steps
        self.system.SolveDynamic(
            self.settings, solverType=self.solver, showHints=False, updateInitialValues=True
        )

    def read(self) -> EngineState:
        """Return the state."""
        kinds = self.exu.OutputVariableType

        def output(kind: Any) -> Array:
            return np.array(self.system.GetObjectOutputBody(self.top, kind, [0.0, 0.0, 0.0]))

        axis = output(kinds.RotationMatrix).reshape(3, 3)[:, 2]
        assert math.isfinite(float(axis.sum())), "no number is left"
        omega, velocity = output(kinds.AngularVelocity), output(kinds.Velocity)
        return EngineState(axis, omega, velocity, float(output(kinds.Position)[2]))

    def close(self) -> None:
        """Hold nothing."""

    def _add_triangle_contacts(self, system: Any, balls: Any, table: int, law: Any) -> None:
        """Let each ball, a marker and a radius, touch the table by an object of its own."""
        import exudyn as exu  # noqa: PLC0415 - optional
        from exudyn import itemInterface  # noqa: PLC0415

        for center, radius in balls:
            apart = itemInterface.NodeGenericData(
                initialCoordinates=[radius, 0.0, 0.0, 0.0], numberOfDataCoordinates=4
            )
            contact = itemInterface.ObjectContactSphereTriangle(
                markerNumbers=[center, table],
                nodeNumber=system.AddNode(apart),
                sphereRadius=radius,
                trianglePoints=exu.Vector3DList(_CORNERS),
                includeEdges=0,
                **law,
            )
            system.AddObject(contact)

    def _add_general_contact(
        self,
        system: Any,
        balls: Any,
        table: int,
        stiffness: float,
        damping: float,
        mu: float,
        zone: float,
    ) -> None:
        """Let balls, each a marker and a radius, touch the table in GeneralContact."""
        contact = system.AddGeneralContact()
        contact.verboseMode = 0
        contact.frictionProportionalZone = zone
        # Each side of a pair has a spring and a damper, which are two in a row.
        strength = {"contactStiffness": 2.0 * stiffness, "contactDamping": 2.0 * damping}
        for center, radius in balls:
            contact.AddSphereWithMarker(center, radius=radius, frictionMaterialIndex=0, **strength)
        contact.AddTrianglesRigidBodyBased(
            rigidBodyMarkerIndex=table,
            frictionMaterialIndex=0,
            pointList=_CORNERS,
            triangleList=[[0, 1, 2]],
            **strength,
        )
        contact.SetFrictionPairings(mu * np.eye(1))
        contact.SetSearchTreeCellSize(numberOfCells=[1, 1, 1])
