"""Derivatives of the last state by the launch, as programs that offer gradients give them.

Run as ``python -m tippetop.engines.gradients``, it measures every number anew in the programs that
are installed and prints it; with ``--write`` it stores them, which the page about it shows.

A state that is judged (`reference.judged_state`) is differentiated by a number of the launch.
MuJoCo differs each step by all of its state (`mjd_transitionFD`); the product of these matrices
carries the change of the launch to the end. MJX differentiates its steps by JAX, Newton by Warp.
Beside them stands what the same program gives where whole runs are differed: a gradient may be true
to its program, or to the problem, or to neither.
"""

import functools
import itertools
import math
import sys
from collections.abc import Callable, Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

import tippetop as tt
from tippetop.engines.adapters import adapter
from tippetop.engines.adapters.base import Setting, axis_of, settings_of
from tippetop.engines.bodies import launch_state
from tippetop.engines.cases import Case
from tippetop.engines.comparison import STEPS
from tippetop.engines.measurements import Measurements
from tippetop.engines.reference import case_of, judged_state
from tippetop.support.errors import Unavailable

Array = NDArray[np.float64]

GRADIENTS = "gradients.json"
"""File of this package that has what is measured."""

DIFFERENTIATED = ("coulomb-roll", "drilling", "puck", "peg", "slope")
"""Cases whose launch is differentiated."""

PARAMETERS = ("launch.spin", "launch.tilt")
"""Numbers of the launch."""

PART = 1e-5
"""Change of a number of the launch in differences of whole runs, relative."""

PART_IN_SINGLE_PRECISION = 1e-3
"""The same in a program of single precision, whose rounding a smaller change would show."""

PERTURBATIONS = (1e-6, 1e-8)
"""Changes of a state in `mjd_transitionFD`: that of MuJoCo's examples, and a smaller one. A contact
that is less deep than the change opens within it."""

ORIENTATION = slice(3, 6)
"""Where the change of orientation is in a change of MuJoCo's state, in the body's axes."""


class LaunchGradient(NamedTuple):
    """A derivative of a judged state by a number of the launch, in a program."""

    program: str
    method: str
    setting: str
    case: str
    parameter: str
    step: float
    """Length of the steps, s."""
    error: float
    """Largest difference from the exact derivative, over its largest component; nan where the
    program gives no number."""


def exact_gradient(case: Case, parameter: str) -> Array:
    """Return the exact derivative of the judged state of a case by a number of its launch."""
    until = float(case.times[case.judged - 1])
    slopes = tt.sensitivities(case.problem, until, [parameter], times=[0.0, until])
    last = slopes.isel(parameter=0, time=-1)
    # A judged state is linear in axis and angular velocity.
    return judged_state(case, last["axis"].values, last["angular_velocity"].values)


def steps_of(case: Case, step: float) -> tuple[int, float]:
    """Return how many steps of about a length lead to the judged state, and their length, s."""
    until = float(case.times[case.judged - 1])
    count = math.ceil(until / step * (1.0 - 1e-9))
    return count, until / count


def _by_runs(
    name: str, case: Case, step: float, setting: Setting, part: float, parameter: str
) -> Array:
    """Return the derivative of the judged state in a program by differences of whole runs."""
    count, length = steps_of(case, step)
    value, ends = case.problem.get(parameter), []
    for sign in (1.0, -1.0):
        problem = case.problem.replace({parameter: value * (1.0 + sign * part)})
        run = adapter(name).start(case._replace(problem=problem), length, setting)
        run.advance(count)
        state = run.read()
        ends.append(judged_state(case, state.axis, state.omega))
    slope: Array = (ends[0] - ends[1]) / (2.0 * part * value)
    return slope


def _error(gradient: Array, exact: Array) -> float:
    """Return the largest difference over the largest component; nan without a number."""
    error = float(np.abs(gradient - exact).max() / np.abs(exact).max())
    return error if math.isfinite(error) else math.nan


# MuJoCo


class MuJoCoLaunch:
    """A case in MuJoCo with steps of a length, and changes of its launch."""

    def __init__(self, case: Case, step: float, setting: Setting) -> None:
        try:
            import mujoco  # noqa: PLC0415 - optional
        except ImportError:
            raise Unavailable("MuJoCo is not installed: pip install 'tippetop[engines]'") from None
        self.mujoco, self.case = mujoco, case
        self.count, length = steps_of(case, step)
        stepper: Any = adapter("mujoco").start(case, length, setting)
        self.model, self.data = stepper.model, stepper.data

    def change(self, parameter: str) -> Array:
        """Return the change of MuJoCo's state at launch, by a number of the launch."""
        value = self.case.problem.get(parameter)
        ends = []
        for sign in (1.0, -1.0):
            problem = self.case.problem.replace({parameter: value * (1.0 + sign * PART)})
            state = launch_state(problem)
            ends.append(
                (
                    np.array([*state.position, *state.quaternion]),
                    np.array([*state.velocity, *state.omega_body]),
                )
            )
        (high, fast), (low, slow) = ends
        turned = np.zeros(6)
        self.mujoco.mj_differentiatePos(self.model, turned, 2.0 * PART * value, low, high)
        return np.concatenate([turned, (fast - slow) / (2.0 * PART * value)])

    def carried(self, change: Array, perturbation: float) -> Array:
        """Return the change of the judged state that a change at launch becomes, step by step, by
        differences with a change of the state.
        """
        mujoco, model, data = self.mujoco, self.model, self.data
        size = 2 * model.nv
        matrix = np.zeros((size, size))
        for _ in range(self.count):
            mujoco.mjd_transitionFD(model, data, perturbation, True, matrix, None, None, None)
            change = matrix @ change
            mujoco.mj_step(model, data)
        return self.judged(change, np.array(data.qpos), np.array(data.qvel))

    def judged(self, change: Array, place: Array, motion: Array) -> Array:
        """Return the change of the judged state by that of MuJoCo's state at the end."""
        entries = np.zeros(9)
        self.mujoco.mju_quat2Mat(entries, place[3:7])
        turn = entries.reshape(3, 3)
        turned, spun = change[ORIENTATION], change[9:12]
        axis = turn @ np.cross(turned, [0.0, 0.0, 1.0])
        omega = turn @ (np.cross(turned, motion[3:6]) + spun)
        return judged_state(self.case, axis, omega)


def _mujoco(case: Case, step: float) -> Iterator[tuple[str, str, Callable[[str], Array]]]:
    """Yield method, setting and function of a parameter for MuJoCo."""
    made = adapter("mujoco")
    for setting in made.settings:
        if made.refusal(case, setting):
            continue
        by_runs = functools.partial(_by_runs, "mujoco", case, step, setting, PART)
        yield "differences of runs", setting.name, by_runs
        if setting.options.get("integrator") == "RK4":
            continue  # mjd_transitionFD refuses it.
        for perturbation in PERTURBATIONS:
            yield (
                f"mjd_transitionFD, eps {perturbation:g}",
                setting.name,
                functools.partial(_stepwise, case, step, setting, perturbation),
            )


def _stepwise(
    case: Case, step: float, setting: Setting, perturbation: float, parameter: str
) -> Array:
    """Return the derivative of the judged state by `mjd_transitionFD` at every step."""
    launch = MuJoCoLaunch(case, step, setting)
    return launch.carried(launch.change(parameter), perturbation)


# MJX


def _mjx(case: Case, step: float) -> Iterator[tuple[str, str, Callable[[str], Array]]]:
    """Yield method, setting and function of a parameter for MJX, by forward mode of JAX.

    MJX has no noslip solver.
    """
    made = adapter("mujoco")
    for setting in made.settings:
        if made.refusal(case, setting) or setting.options.get("noslip_iterations"):
            continue
        launch = MuJoCoLaunch(case, step, setting)
        yield "forward mode of JAX", setting.name, functools.partial(_by_jax, launch)


def _by_jax(launch: MuJoCoLaunch, parameter: str) -> Array:
    """Return the derivative of the judged state by a parameter in MJX."""
    from mujoco import mjx  # noqa: PLC0415 - optional

    multiply, follow = launch.mujoco.mju_mulQuat, _following()
    state = launch_state(launch.case.problem)
    place = np.array([*state.position, *state.quaternion])
    motion = np.array([*state.velocity, *state.omega_body])
    change, rotated = launch.change(parameter), np.zeros(4)
    multiply(rotated, place[3:7], np.concatenate([[0.0], change[ORIENTATION]]))
    shift = np.concatenate([change[:3], 0.5 * rotated])
    model, data = mjx.put_model(launch.model), mjx.put_data(launch.model, launch.data)
    ends, changes = follow(model, data, launch.count, place, motion, shift, change[6:])
    place, motion, moved, sped = (np.array(one) for one in (*ends, *changes))
    back, inverse = np.zeros(4), place[3:7] * (1.0, -1.0, -1.0, -1.0)
    multiply(back, inverse / (inverse @ inverse), moved[3:7])
    end = np.concatenate([moved[:3], 2.0 * back[1:], sped])
    return launch.judged(end, place, motion)


@functools.cache
def _following() -> Any:
    """Return a compiled function that follows a launch in MJX, and a change of it."""
    import jax  # noqa: PLC0415 - optional
    from mujoco import mjx  # noqa: PLC0415 - optional

    jax.config.update("jax_enable_x64", True)

    def stepped(model: Any, data: Any) -> Any:
        """Return data after a step, with the same types: in double precision, MJX widens some."""
        after = mjx.step(model, data)
        return jax.tree_util.tree_map(
            lambda new, old: jax.numpy.asarray(new, old.dtype), after, data
        )

    def follow(model: Any, data: Any, count: Any, place: Any, motion: Any, *change: Any) -> Any:
        def last(place: Any, motion: Any) -> Any:
            moved = data.replace(qpos=place, qvel=motion)
            end = jax.lax.fori_loop(0, count, lambda _, one: stepped(model, one), moved)
            return end.qpos, end.qvel

        return jax.jvp(last, (place, motion), change)

    return jax.jit(follow)


# Newton


def _newton(case: Case, step: float) -> Iterator[tuple[str, str, Callable[[str], Array]]]:
    """Yield method, setting and function of a parameter for Newton.

    By its documentation, of the solvers here SolverSemiImplicit alone is differentiable.
    """
    made = adapter("newton")
    for setting in settings_of(made, case):
        by_runs = functools.partial(
            _by_runs, "newton", case, step, setting, PART_IN_SINGLE_PRECISION
        )
        yield "differences of runs", setting.name, by_runs
        if setting.options["solver"] == "SemiImplicit":
            yield "reverse mode of Warp", setting.name, NewtonTape(case, step, setting).carried


class NewtonTape:
    """The steps of a case in Newton, recorded to be followed backwards."""

    def __init__(self, case: Case, step: float, setting: Setting) -> None:
        from tippetop.engines.adapters.newton import NewtonWorld  # noqa: PLC0415 - optional

        self.case = case
        count, length = steps_of(case, step)
        world = NewtonWorld(case, length, setting.options, requires_grad=True)
        self.warp, self.states = world.warp, [world.state() for _ in range(count + 1)]
        self.tape = self.warp.Tape()
        with self.tape:
            for before, after in itertools.pairwise(self.states):
                # Steps that shared their contacts would be followed back with those of the last.
                world.follow(before, after, world.pipeline.contacts())

    def _launch(self, parameter: str, sign: float) -> Array:
        """Return Newton's numbers of place and motion at a launch beside that of the case."""
        value = self.case.problem.get(parameter) * (1.0 + sign * PART)
        state = launch_state(self.case.problem.replace({parameter: value}))
        w, x, y, z = state.quaternion
        return np.array([*state.position, x, y, z, w, *state.velocity, *state.omega])

    @functools.cached_property
    def matrix(self) -> Array:
        """Derivatives of orientation and angular velocity at the end by the numbers at launch."""
        first, last = self.states[0], self.states[-1]
        rows = []
        for number in (*range(3, 7), *range(10, 13)):
            seed = np.zeros(13, np.float32)
            seed[number] = 1.0
            self.tape.zero()
            self.tape.backward(
                grads={
                    last.body_q: self._array(seed[None, :7], last.body_q),
                    last.body_qd: self._array(seed[None, 7:], last.body_qd),
                }
            )
            rows.append([*first.body_q.grad.numpy()[0], *first.body_qd.grad.numpy()[0]])
        return np.array(rows)

    def _array(self, values: Any, alike: Any) -> Any:
        return self.warp.array(values, dtype=alike.dtype, device=alike.device)

    def carried(self, parameter: str) -> Array:
        """Return the derivative of the judged state by a number of the launch."""
        apart = 2.0 * PART * self.case.problem.get(parameter)
        change = (self._launch(parameter, 1.0) - self._launch(parameter, -1.0)) / apart
        turned, spun = np.split(self.matrix @ change, [4])
        x, y, z, w = self.states[-1].body_q.numpy()[0].astype(float)[3:]
        quaternion = np.array([w, x, y, z])
        ahead, behind = (
            axis_of(quaternion + sign * PART * np.roll(turned, 1)) for sign in (1.0, -1.0)
        )
        return judged_state(self.case, (ahead - behind) / (2.0 * PART), spun)


# What is measured and stored

PROGRAMS: Mapping[str, Callable[[Case, float], Iterator[tuple[str, str, Any]]]] = {
    "MuJoCo": _mujoco,
    "MJX": _mjx,
    "Newton": _newton,
}
"""How programs give derivatives of a case at a step."""

CASES_OF = {
    "MuJoCo": DIFFERENTIATED,
    "MJX": ("coulomb-roll", "slope"),
    "Newton": ("coulomb-roll", "slope"),
}
"""Cases that are measured: MJX is compiled for a minute or more for each setting, and Newton takes
as long for a thousand steps forth and back."""


def measured(program: str) -> Iterator[LaunchGradient]:
    """Yield the derivatives that a program gives now."""
    for name in CASES_OF[program]:
        case = case_of(name)
        for parameter in PARAMETERS:
            if not case.problem.get(parameter):
                continue
            exact = exact_gradient(case, parameter)
            for step in STEPS:
                for method, setting, function in PROGRAMS[program](case, step):
                    with np.errstate(over="ignore", invalid="ignore"):
                        error = _error(function(parameter), exact)
                    yield LaunchGradient(program, method, setting, name, parameter, step, error)


def _line(row: LaunchGradient) -> str:
    return (
        f"{row.case:<14}{row.parameter:<13}{1e3 * row.step:>6g} ms  {row.setting:<16}"
        f"{row.method:<30}{row.error:.2g}"
    )


LAUNCH_GRADIENTS = Measurements(
    about="Errors of derivatives by the launch in the programs that are installed.",
    file=GRADIENTS,
    row=LaunchGradient,
    packages={"MuJoCo": "mujoco", "MJX": "mujoco-mjx", "Newton": "newton"},
    measure=measured,
    program_of=lambda row: row.program,
    line=_line,
)


if __name__ == "__main__":
    LAUNCH_GRADIENTS.run(sys.argv[1:])
