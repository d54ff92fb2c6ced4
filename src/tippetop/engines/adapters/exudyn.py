"""Exudyn: penalty contact of spheres with a triangulated plane, regularized friction."""

import math
from typing import Any

import numpy as np

from tippetop.engines.adapters.base import (
    EngineState,
    Setting,
    dry_only,
    no_rebound,
    no_rolling,
)
from tippetop.engines.bodies import friction_numbers, launch_state, primitives
from tippetop.engines.cases import Case

_EXAMPLE = (
    "Examples/tippeTop.py, by its own words only a demonstration of GeneralContact, whose soft"
    " contact may need other parameters"
)
_SOLVERS = "exudyn.DynamicSolverType: explicit solvers, without constraints"
_ZONE = "GeneralContact.frictionProportionalZone: 1e-3 by default, oscillations if very small"


class Exudyn:
    """Exudyn's GeneralContact, as its own example of a tippe top sets it."""

    name = "Exudyn"
    package = "exudyn"
    module = "exudyn"
    settings = (
        Setting(
            "its example",
            "stiffness (316/s)^2 m, damping 1 ms of it, friction zone 1e-5 m/s, explicit Euler",
            _EXAMPLE,
            {"frequency": 316.0, "damping": 1e-3, "solver": "ExplicitEuler"},
        ),
        Setting(
            "stiff",
            "stiffness (0.3/step)^2 m, damping ratio 0.2, zone 1e-5 m/s, explicit midpoint",
            f"{_SOLVERS}; zone of its example",
            {"per_step": 0.3, "ratio": 0.2, "solver": "ExplicitMidpoint"},
        ),
        Setting(
            "RK44",
            "stiffness (0.3/step)^2 m, damping ratio 0.2, friction zone 1e-3 m/s, RK44",
            f"{_SOLVERS}; {_ZONE}",
            {"per_step": 0.3, "ratio": 0.2, "solver": "RK44", "zone": 1e-3},
        ),
    )

    def refusal(self, case: Case) -> str | None:
        """Return why it cannot state a case; None where it can."""
        shapes = primitives(case.problem.body, ellipsoids=False)
        if shapes is None or any(shape.kind != "sphere" for shape in shapes):
            return "only spheres"
        return dry_only(case) or no_rolling(case) or no_rebound(case)

    def start(self, case: Case, step: float, setting: Setting) -> "ExudynStepper":
        """Return a case at its launch, with steps of this length, s."""
        return ExudynStepper(case, step, setting.options)


class ExudynStepper:
    """A case in Exudyn, which is followed to its end at the first advance."""

    def __init__(self, case: Case, step: float, options: dict[str, Any]) -> None:
        self.case, self.step, self.options = case, step, options
        self.at, self.rows = 0, np.zeros((0, 0))

    def advance(self, steps: int) -> None:
        """Take a number of steps."""
        if not len(self.rows):
            self.every = steps
            self.rows = self._followed(steps)
        self.at += steps

    def read(self) -> EngineState:
        """Return the state."""
        row = self.rows[min(self.at // self.every, len(self.rows) - 1)]
        matrix, place, velocity, omega = row[:9].reshape(3, 3), row[9:12], row[12:15], row[15:18]
        return EngineState(matrix[:, 2], omega, velocity, float(place[2]))

    def close(self) -> None:
        """Hold nothing."""

    def _followed(self, every: int) -> Any:
        import exudyn as exu  # noqa: PLC0415 - optional
        from exudyn import itemInterface, utilities  # noqa: PLC0415

        marker_on, sensor_of = itemInterface.MarkerBodyRigid, itemInterface.SensorBody
        problem, options = self.case.problem, self.options
        body, state = problem.body, launch_state(problem)
        frequency = options.get("frequency") or options["per_step"] / self.step
        stiffness = 2.0 * body.mass * frequency**2  # two springs in a row
        damping = (
            stiffness * options["damping"]
            if "damping" in options
            else 4.0 * options["ratio"] * frequency * body.mass
        )
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
            gravity=[0.0, 0.0, -problem.gravity],
        )
        contact = system.AddGeneralContact()
        contact.verboseMode = 0
        contact.frictionProportionalZone = options.get("zone", 1e-5)
        strength = {"contactStiffness": stiffness, "contactDamping": damping}
        for shape in primitives(body, ellipsoids=False) or ():
            marker = system.AddMarker(
                itemInterface.MarkerBodyRigid(
                    bodyNumber=top, localPosition=[0.0, 0.0, shape.center]
                )
            )
            contact.AddSphereWithMarker(
                marker, radius=shape.sizes[0], frictionMaterialIndex=0, **strength
            )
        ground = system.AddObject(itemInterface.ObjectGround())
        marker = system.AddMarker(marker_on(bodyNumber=ground))
        half = 5.0
        contact.AddTrianglesRigidBodyBased(
            rigidBodyMarkerIndex=marker,
            frictionMaterialIndex=0,
            pointList=[[-half, -half, 0], [half, -half, 0], [half, half, 0], [-half, half, 0]],
            triangleList=[[0, 1, 2], [0, 2, 3]],
            **strength,
        )
        contact.SetFrictionPairings(friction_numbers(problem).sliding * np.eye(1))
        contact.SetSearchTreeCellSize(numberOfCells=[1, 1, 1])
        kinds = exu.OutputVariableType
        outputs = (kinds.RotationMatrix, kinds.Position, kinds.Velocity, kinds.AngularVelocity)
        sensors = [
            system.AddSensor(
                sensor_of(bodyNumber=top, storeInternal=True, outputVariableType=output)
            )
            for output in outputs
        ]
        system.Assemble()
        settings = exu.SimulationSettings()
        count = round(float(self.case.times[self.case.compared - 1]) / self.step)
        settings.timeIntegration.numberOfSteps = count
        settings.timeIntegration.endTime = count * self.step
        settings.timeIntegration.verboseMode = 0
        settings.solution.file.write = False
        settings.solution.sensors.writePeriod = every * self.step * (1.0 - 1e-9)
        settings.show.computationTime = False
        solver = getattr(exu.DynamicSolverType, options["solver"])
        system.SolveDynamic(settings, solverType=solver, showHints=False)
        parts = [np.array(system.GetSensorStoredData(sensor))[:, 1:] for sensor in sensors]
        rows = np.hstack(parts)
        assert math.isfinite(float(rows.sum())), "no number is left"
        return rows
