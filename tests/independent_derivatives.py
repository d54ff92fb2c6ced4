"""Write the independent derivatives of the suite: `python tests/independent_derivatives.py`.

They are differences of runs of the second solver with a parameter a little larger and smaller, at
two steps, of which the extrapolation is stored with what the two steps differ by. They stand in
`src/tippetop/engines/independent/`, one file a case. Cases to write may be named, as may be
parameters: `stem:friction.mu,launch.spin`.
"""

import json
import sys
from pathlib import Path

import numpy as np

import independent_solver
from independent_reference import FOLDER, followed
from tippetop.engines.cases import CASES, Case
from tippetop.engines.derivatives import independent_slopes, parameters_of
from tippetop.engines.reference import COLUMNS, case_of, numbers_of

STEP = 1e-5
"""Shorter of the two steps, relative to the parameter: a run of 155 rad/s for 8 s turns by 0.01 rad
with it, of which the extrapolation leaves 1e-9.
"""

SHORTER = {"stick-slip": 2.5e-6}
"""Shorter steps of cases whose derivatives change within `STEP`: those of the last of 190 cycles of
sticking and slipping by 0.3 %, of which the extrapolation leaves 3e-5.
"""

TOLERANCE = 3e-12
"""Tolerance of the second solver at `STEP`; with shorter steps it falls as they do."""


def run_of(case: Case, name: str, factor: float) -> tuple[np.ndarray, list]:
    """Return the numbers at the end, and the events, with a parameter larger by a factor."""
    problem = case.problem.replace({name: case.problem.get(name) * factor})
    states, events, _ = followed(case.name, problem, [case.duration])
    row = np.array(states[-1:])
    numbers = numbers_of(problem, row[:, 1:4], row[:, 4:7], row[:, 7:10], row[:, 10])
    return np.array([numbers[column][0] for column in COLUMNS]), events


def slope(case: Case, name: str) -> dict:
    """Return the derivatives by a parameter, each with the change from one step to the other."""
    value, shorter = case.problem.get(name), SHORTER.get(case.name, STEP)
    independent_solver.RTOL = TOLERANCE * shorter / STEP
    states, times, kinds = [], [], []
    for step in (shorter, 2 * shorter):
        ends = [run_of(case, name, 1.0 + sign * step) for sign in (1, -1)]
        (high, high_events), (low, low_events) = ends
        kinds += [[event[1:] for event in events] for events in (high_events, low_events)]
        apart = 2.0 * step * value
        states.append((high - low) / apart)
        pairs = zip(high_events, low_events, strict=False)
        times.append(np.array([(one[0] - two[0]) / apart for one, two in pairs]))
    same = all(events == kinds[0] for events in kinds)
    return {
        "parameter": name,
        "states": extrapolated(*states),
        "events": extrapolated(*times) if same else None,
    }


def extrapolated(short: np.ndarray, long: np.ndarray) -> list:
    return [
        [float((4.0 * a - b) / 3.0), float(abs(a - b) / 3.0)]
        for a, b in zip(short, long, strict=True)
    ]


def write(case: Case, names: list[str]) -> Path:
    """Compute the derivatives of a case by parameters, and write or complete its file."""
    earlier = (independent_slopes(case) or {"parameters": []})["parameters"]
    slopes = {one["parameter"]: one for one in earlier if one["parameter"] not in names}
    slopes.update({name: slope(case, name) for name in names})
    lines = [json.dumps(slopes[name]) for name in parameters_of(case) if name in slopes]
    head = {
        "case": case.name,
        "method": "differences of the second method at two steps, tests/independent_derivatives.py",
        "step": SHORTER.get(case.name, STEP),
        "columns": list(COLUMNS),
    }
    path = FOLDER / f"{case.name}_derivatives.json"
    body = ",\n".join(lines)
    path.write_text(f'{json.dumps(head)[:-1]}, "parameters": [\n{body}\n]}}\n')
    return path


if __name__ == "__main__":
    for word in sys.argv[1:] or [case.name for case in CASES]:
        name, _, listed = word.partition(":")
        chosen = case_of(name)
        parameters = listed.split(",") if listed else parameters_of(chosen)
        print(write(chosen, parameters), flush=True)
