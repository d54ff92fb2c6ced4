"""Write the independent numbers of the reference suite: `python tests/independent_reference.py`.

They stand in `src/tippetop/engines/independent/`, one file a case; cases to write may be named.
"""

import json
import sys
from pathlib import Path

import scipy

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


def computed(case: Case) -> tuple[list, list, str]:
    """Return states (time first), events (time, kind, surface) and the method of a case."""
    if case.name == "rest":
        return *rocking(case.problem, case.times), "Lagrange's equation in the tilt, DOP853"
    solver = Solver(case.problem).follow(case.times)
    methods = " and ".join(sorted(solver.methods))
    return solver.samples, solver.events, f"Newton and Euler with multipliers, {methods}"


def write(case: Case) -> Path:
    """Compute a case and write its file."""
    states, events, method = computed(case)
    head = {
        "case": case.name,
        "method": f"{method} of SciPy {scipy.__version__}, tests/independent_solver.py",
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
