"""Derivatives of the last state by the launch, as programs that offer gradients give them.

Run as ``python -m tippetop.engines.gradients``, it measures every number anew in the programs that
are installed and prints it; with ``--write`` it stores them, which the page about it shows.

A state that is judged (`reference.judged_state`) is differentiated by a number of the launch, in
one file for each program: MuJoCo differs each step by all of its state, MJX differentiates its
steps by JAX, Newton by Warp. Beside them stands what the same program gives where whole runs are
differed (`base`): a gradient may be true to its program, or to the problem, or to neither.
"""

import math
from collections.abc import Callable, Iterator, Mapping
from typing import NamedTuple

import numpy as np

from tippetop.engines.cases import Case
from tippetop.engines.comparison import STEPS
from tippetop.engines.gradients import mjx, mujoco, newton
from tippetop.engines.gradients.base import Array, Gradients, exact_gradient
from tippetop.engines.measurements import Measurements
from tippetop.engines.reference import case_of

GRADIENTS = "gradients.json"
"""File of `tippetop.engines` that has what is measured."""

DIFFERENTIATED = ("coulomb-roll", "drilling", "puck", "peg", "slope")
"""Cases whose launch is differentiated."""

PARAMETERS = ("launch.spin", "launch.tilt")
"""Numbers of the launch."""


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


PROGRAMS: Mapping[str, Callable[[Case, float], Gradients]] = {
    "MuJoCo": mujoco.gradients,
    "MJX": mjx.gradients,
    "Newton": newton.gradients,
}
"""How programs give derivatives of a case at a step."""

CASES_OF = {
    "MuJoCo": DIFFERENTIATED,
    "MJX": ("coulomb-roll", "slope"),
    "Newton": ("coulomb-roll", "slope"),
}
"""Cases that are measured: MJX is compiled for a minute or more for each setting, and Newton takes
as long for a thousand steps forth and back."""


def _error(gradient: Array, exact: Array) -> float:
    """Return the largest difference over the largest component; nan without a number."""
    error = float(np.abs(gradient - exact).max() / np.abs(exact).max())
    return error if math.isfinite(error) else math.nan


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
