"""Write the independent numbers of the reference suite: `python tests/independent_reference.py`.

They stand in `src/tippetop/engines/independent/`, one file a case; cases to write may be named.
"""

import json
import sys
from collections.abc import Sequence
from pathlib import Path

import scipy

import independent_motions
import tippetop as tt
from independent_solver import Solver, rocking
from tippetop import engines
from tippetop.engines.cases import CASES, Case

FOLDER = Path(engines.__file__).parent / "independent"

COLUMNS = (
    *(
        "axis_x",
        "axis_y",
        "axis_z",
        "angular_velocity_x",
        "angular_velocity_y",
        "angular_velocity_z",
    ),
    *("velocity_x", "velocity_y", "velocity_z", "height"),
)


OWN_METHODS = {
    "rest": (rocking, "Lagrange's equation in the tilt, DOP853"),
    "puck": (
        independent_motions.puck,
        "friction by quadrature about the instantaneous centre, DOP853",
    ),
    "ball": (independent_motions.rolling_ball, "slip, drilling and rolling of a ball, DOP853"),
    "disk-end": (
        independent_motions.ending_disk,
        "Newton and Euler in the precessing frame, its own clock, DOP853",
    ),
}
"""Functions of a problem and instants for the cases that the second solver does not follow."""


def followed(name: str, problem: tt.Problem, times: Sequence[float]) -> tuple[list, list, str]:
    """Return states (time first), events (time, kind, surface) and the method, by a case's name."""
    if name in OWN_METHODS:
        function, method = OWN_METHODS[name]
        return *function(problem, times), method
    solver = Solver(problem).follow(times)
    methods = " and ".join(sorted(solver.methods, reverse=True))
    return solver.samples, solver.events, f"Newton and Euler with multipliers, {methods}"


def computed(case: Case) -> tuple[list, list, str]:
    """Return states, events and the method of a case."""
    return followed(case.name, case.problem, case.times)


def file_of(case: Case) -> str:
    """Return the file that has the second method of a case."""
    if case.name in OWN_METHODS:
        return f"tests/{OWN_METHODS[case.name][0].__module__}.py"
    return "tests/independent_solver.py"


def write(case: Case) -> Path:
    """Compute a case and write its file."""
    states, events, method = computed(case)
    head = {
        "case": case.name,
        "method": f"{method} of SciPy {scipy.__version__}, {file_of(case)}",
        "columns": ["time", *COLUMNS],
    }
    lines = [json.dumps(head)[:-1] + ', "states": [']
    lines += [",\n".join(json.dumps([float(x) for x in row]) for row in states)]
    lines += ['], "events": [']
    lines += [",\n".join(json.dumps([float(t), kind, int(i)]) for t, kind, i in events)]
    lines += ["]}"]
    path = FOLDER / f"{case.name}.json"
    path.write_text("\n".join(lines) + "\n")
    return path


if __name__ == "__main__":
    for case in CASES:
        if case.name in sys.argv[1:] or not sys.argv[1:]:
            print(write(case), flush=True)
