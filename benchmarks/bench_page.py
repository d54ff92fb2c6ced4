"""The page's engine in Node beside Python's, each by its own method: single runs, and a map.

Single runs are the report's at 155 rad/s, and one at 175 rad/s with its flights, each at the
loosest tolerance at which the axis ends within 1e-8 of where Taylor's method puts it, which takes
Python's, too, at the same tolerance and without samples. Of runs repeated in one process the least
time counts: the first ones are the compilers'; how long the very first takes is told, too. The map
is of 64 spins by 32 coefficients of friction, for 20 s each, shared by two workers, at the loosest
tolerance at which n_z, which tells how a top stands, ends within 1e-5 in a launch of every cell of
a coarser map. What is wanted of both is wanted of a machine as fast as usual, and is told as that
is here (`surroundings.slowness`).
"""

import json
import shutil
import subprocess
import time
from typing import Any

import numpy as np

import tippetop as tt
from benchmarks.surroundings import markdown, rounded, slowness
from tippetop.page_engine import HERE
from tippetop.problem.presets import report_problem

DURATION = 20.0
TOLERANCES = (
    1e-5,
    3e-6,
    1e-6,
    3e-7,
    1e-7,
    3e-8,
    1e-8,
    3e-9,
    1e-9,
    3e-10,
    1e-10,
    3e-11,
    1e-11,
    3e-12,
    1e-12,
)
SINGLE = {"155 rad/s": (155.0, "ignore"), "175 rad/s, with flights": (175.0, "fly")}
SINGLE_ERROR, MAP_ERROR = 1e-8, 1e-5
"""How far from exact the axis of a run, and n_z in a map, may end."""

WORKERS = 2
TARGETS_MS = {"175 rad/s, with flights": 15.0, "map": 10e3}
"""Wanted of Node on a machine that is as fast as usual."""

FOLLOW = """
const { simulate } = await import(process.argv[1]);
const { readFileSync } = await import("node:fs");
const { problems, options, rounds } = JSON.parse(readFileSync(0, "utf8"));
const found = problems.map(() => ({ ms: [] }));
for (let round = 0; round < rounds; round += 1) {
  problems.forEach((problem, i) => {
    const begin = performance.now(), run = simulate(problem, options);
    found[i].ms.push(performance.now() - begin);
    found[i].axis = [...run.trajectory.state.axis];
    found[i].flights = run.flights.length;
  });
}
console.log(JSON.stringify(found));
"""


def in_node(problems: list[tt.Problem], tolerance: float, rounds: int = 1) -> list[dict[str, Any]]:
    """Times of runs, ms, where the axis ends and how many flights there are, problem by problem."""
    node = shutil.which("node")
    if node is None:
        raise SystemExit("page: the engine of the page needs Node: no `node` is on the PATH")
    asked = {
        "problems": [json.loads(problem.to_json()) for problem in problems],
        "options": {"duration": DURATION, "tolerance": tolerance},
        "rounds": rounds,
    }
    command = [node, "--input-type=module", "--eval", FOLLOW, (HERE / "index.js").as_uri()]
    ran = subprocess.run(
        command, input=json.dumps(asked), capture_output=True, text=True, check=True
    )
    found: list[dict[str, Any]] = json.loads(ran.stdout)
    return found


def resolving(problems: list[tt.Problem], error: float, first: int = 0) -> tuple[float, float]:
    """The loosest tolerance at which all axes, from a component on, end near enough, and how
    near.
    """
    exact = [
        tt.simulate(problem, DURATION, samples=2, integrator="taylor").axis.values[-1]
        for problem in problems
    ]
    for tolerance in TOLERANCES:
        found = [one["axis"] for one in in_node(problems, tolerance)]
        off = float(np.abs(np.array(found) - exact)[:, first:].max())
        if off <= error:
            break
    return tolerance, off


def in_python(problem: tt.Problem, tolerance: float, rounds: int) -> float:
    """The least time of a run by Taylor's method, ms."""
    times = []
    for _ in range(rounds):
        begin = time.perf_counter()
        tt.simulate(problem, DURATION, samples=2, integrator="taylor", tolerance=tolerance)
        times.append(1e3 * (time.perf_counter() - begin))
    return min(times)


def map_of(rows: int, columns: int) -> list[tt.Problem]:
    """Launches of the report's top over spin and friction."""
    return [
        report_problem().replace({"launch.spin": spin, "friction.mu": mu, "contact.liftoff": "fly"})
        for spin in np.linspace(10.0, 230.0, rows).tolist()
        for mu in np.linspace(0.05, 0.8, columns).tolist()
    ]


def measure(quick: bool) -> dict[str, Any]:
    """Find the tolerances, and take the times."""
    found: dict[str, Any] = {}
    rounds = 40 if quick else 200
    for name, (spin, liftoff) in SINGLE.items():
        problem = report_problem(spin).replace({"contact.liftoff": liftoff})
        tolerance, off = resolving([problem], SINGLE_ERROR)
        (node,) = in_node([problem], tolerance, rounds)
        found[name] = {
            "tolerance": tolerance,
            "error": off,
            "flights": node["flights"],
            "first_ms": node["ms"][0],
            "node_ms": min(node["ms"]),
            "python_ms": in_python(problem, tolerance, rounds),
        }
    tolerance, off = resolving(map_of(8, 6), MAP_ERROR, first=2)
    launches = map_of(32, 16) if quick else map_of(64, 32)
    share = 64 * 32 / len(launches) / WORKERS
    node_ms = share * sum(one["ms"][0] for one in in_node(launches, tolerance))
    found["map"] = {"tolerance": tolerance, "error": off, "node_ms": node_ms}
    slow = slowness()
    for name, wanted in TARGETS_MS.items():
        found[name] |= {"wanted_ms": slow * wanted}
    return found


def tables(found: dict[str, Any]) -> str:
    """The figures as a table."""

    def told(one: dict[str, Any], name: str) -> str:
        return rounded(one[name]) if name in one else ""

    rows = [
        [
            name,
            f"{one['tolerance']:.0e}",
            f"{one['error']:.1e}",
            told(one, "first_ms"),
            told(one, "node_ms"),
            told(one, "wanted_ms"),
            rounded(one["node_ms"] / one["python_ms"]) if "python_ms" in one else "",
        ]
        for name, one in found.items()
    ]
    heads = [
        "in Node",
        "tolerance",
        "error",
        "first, ms",
        "least, ms",
        "wanted here, ms",
        "over Python's compiled",
    ]
    return markdown(heads, rows)
