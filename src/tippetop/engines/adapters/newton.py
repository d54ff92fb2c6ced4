"""Newton: contact by projections of positions, or by springs and dampers, in single precision."""

from collections.abc import Callable
from importlib import import_module
from typing import Any

import numpy as np

from tippetop.engines.adapters.base import (
    EngineState,
    Setting,
    axis_of,
    no_drilling,
    no_film,
    no_rebound,
    no_rolling,
)
from tippetop.engines.bodies import friction_numbers, launch_state, primitives
from tippetop.engines.cases import Case

_MATERIAL = "newton, Solvers: Contact Material Support"
_TUNING = "newton, Simulation Tuning, Solver-Specific Knobs"
_CHECKS = f"{_TUNING} and Contact Stiffness Sanity Checks"

STIFFNESS_PER_STEP = 0.1
"""Natural frequency of the stiff contact times the step: that of a body whose centre of mass is not
above the contact is some times higher, and its limit of stability is 2."""

FRICTION_PER_STEP = 0.1
"""Gain of the stiff contact's friction times the step, over the mass."""


class Newton:
    """Newton, by two of its solvers on the processor, with contacts found anew at every step.

    Newton takes the mean of the coefficients of two bodies: body and table have the same ones.
    """

    name = "Newton"
    package = "newton"
    module = "newton"
    settings = (
        Setting("XPBD", "SolverXPBD with 2 rounds, its default", _MATERIAL, {"solver": "XPBD"}),
        Setting(
            "XPBD, 20 rounds",
            "SolverXPBD with 20 rounds",
            f"{_TUNING}: more iterations reduce the residual error",
            {"solver": "XPBD", "iterations": 20},
        ),
        Setting(
            "springs",
            "SolverSemiImplicit without angular damping, shapes as stiff as by default",
            _MATERIAL,
            {"solver": "SemiImplicit"},
        ),
        Setting(
            "stiff springs",
            "as springs, with a natural frequency of 0.1/step, a damping ratio of 1, and a friction"
            " gain of 0.1 mass/step",
            f"{_CHECKS}: as stiff as the step supports",
            {"solver": "SemiImplicit", "stiff": True},
        ),
    )

    def refusal(self, case: Case, setting: Setting) -> str | None:
        """Return why it cannot state a case at a setting; None where it can."""
        if setting.options["solver"] == "XPBD":
            return no_film(case)
        return no_film(case) or no_drilling(case) or no_rolling(case) or no_rebound(case)

    def start(self, case: Case, step: float, setting: Setting) -> "NewtonStepper":
        """Return a case at its launch, with steps of this length, s."""
        return NewtonStepper(case, step, setting.options)


class NewtonWorld:
    """A case as a model of Newton, at its launch."""

    def __init__(
        self, case: Case, step: float, options: dict[str, Any], *, requires_grad: bool = False
    ) -> None:
        warp: Any = import_module("warp")
        warp.config.log_level = warp.LOG_ERROR  # It warns of a machine without a GPU.
        newton: Any = import_module("newton")
        self.warp, self.newton, self.step = warp, newton, step
        problem = case.problem
        body, friction, state = problem.body, friction_numbers(problem), launch_state(problem)
        material = {
            "density": 0.0,
            "mu": friction.sliding,
            "mu_torsional": friction.torsional,
            "mu_rolling": friction.rolling,
            "restitution": problem.contact.restitution,
        }
        if options.get("stiff"):
            frequency = STIFFNESS_PER_STEP / step
            material["ke"] = body.mass * frequency**2
            material["kd"] = 2.0 * body.mass * frequency
            material["kf"] = FRICTION_PER_STEP * body.mass / step
        shape = newton.ModelBuilder.ShapeConfig(**material)
        builder = newton.ModelBuilder(gravity=problem.gravity_vector)
        w, x, y, z = state.quaternion
        top = builder.add_body(
            xform=warp.transform(state.position, (x, y, z, w)),
            mass=body.mass,
            com=(0.0, 0.0, 0.0),
            inertia=warp.mat33(np.diag([body.I1, body.I1, body.I3])),
            lock_inertia=True,
        )
        add: dict[str, Callable[..., int]] = {
            "sphere": lambda place, radius: builder.add_shape_sphere(
                top, xform=place, radius=radius, cfg=shape
            ),
            "ellipsoid": lambda place, a, b, c: builder.add_shape_ellipsoid(
                top, xform=place, rx=a, ry=b, rz=c, cfg=shape
            ),
            "cylinder": lambda place, radius, half: builder.add_shape_cylinder(
                top, xform=place, radius=radius, half_height=half, cfg=shape
            ),
        }
        for one in primitives(body, ellipsoids=True) or ():
            place = warp.transform((0.0, 0.0, one.center), (0.0, 0.0, 0.0, 1.0))
            add[one.kind](place, *one.sizes)
        builder.add_ground_plane(cfg=shape)
        self.model = builder.finalize(device="cpu", requires_grad=requires_grad)
        self.solver = self._solver(options, bool(problem.contact.restitution))
        self.pipeline = newton.CollisionPipeline(self.model)
        self.control = self.model.control()
        self.launched = np.array([[*state.velocity, *state.omega]])

    def _solver(self, options: dict[str, Any], rebounds: bool) -> Any:
        """Return the solver of a setting."""
        if options["solver"] == "XPBD":
            rounds = {"iterations": options["iterations"]} if "iterations" in options else {}
            return self.newton.solvers.SolverXPBD(self.model, enable_restitution=rebounds, **rounds)
        return self.newton.solvers.SolverSemiImplicit(self.model, angular_damping=0.0)

    def state(self) -> Any:
        """Return a new state, at the launch."""
        state = self.model.state()
        state.body_qd.assign(self.launched.astype(np.float32))
        return state

    def follow(self, before: Any, after: Any, contacts: Any) -> None:
        """Take a step from a state into another one, with contacts that are found anew."""
        before.clear_forces()
        self.pipeline.collide(before, contacts)
        self.solver.step(before, after, self.control, contacts, self.step)


class NewtonStepper:
    """A case under way in Newton."""

    def __init__(self, case: Case, step: float, options: dict[str, Any]) -> None:
        world = NewtonWorld(case, step, options)
        self.warp, self.state, after = world.warp, world.state(), world.state()
        contacts = world.pipeline.contacts()
        # Kernels are loaded and arrays made by a step that is not recorded.
        world.follow(world.state(), after, contacts)
        with self.warp.ScopedCapture(device="cpu") as capture:
            world.follow(self.state, after, contacts)
            self.warp.copy(self.state.body_q, after.body_q)
            self.warp.copy(self.state.body_qd, after.body_qd)
        self.world, self.arrays, self.graph = world, (after, contacts), capture.graph

    def advance(self, steps: int) -> None:
        """Take a number of steps."""
        for _ in range(steps):
            self.warp.capture_launch(self.graph)

    def read(self) -> EngineState:
        """Return the state."""
        place = self.state.body_q.numpy()[0].astype(float)
        motion = self.state.body_qd.numpy()[0].astype(float)
        x, y, z, w = place[3:]
        return EngineState(axis_of(np.array([w, x, y, z])), motion[3:], motion[:3], place[2])

    def close(self) -> None:
        """Hold nothing."""
