"""Times of a run, of the bare integration inside it, of an import and of the command line.

The run is the report's top at 155 rad/s over 20 s with every variable of the result at 2001
samples. Beside it stands the bare integration of the eight numbers that drive the motion, by heyoka
at the same tolerance. The two are timed in turns, so that whatever else the machine
does touches both.
"""

import cProfile
import os
import pstats
import statistics
from collections.abc import Callable, Sequence
from typing import Any

import heyoka as hy

import tippetop as tt
from benchmarks.surroundings import COMMAND_LINE, IMPORTS, markdown, new_process, seconds
from tippetop.mechanics.top import natural_units
from tippetop.problem.presets import report_problem
from tippetop.problem.problem import top_of

SPIN, DURATION, SAMPLES = 155.0, 20.0, 2001
TOLERANCE = 2e-16
TARGET_RATIO = 2.2
"""A run may take this many times the bare integration."""

TARGET_IMPORTS = 1.8
"""How many times as long as `IMPORTS` `tippetop simulate` may take, which cannot do without them.
"""


def cross(a: Sequence[Any], b: Sequence[Any]) -> tuple[Any, Any, Any]:
    """Vector product."""
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def equations() -> list[tuple[Any, Any]]:
    """Equations of motion of the sphere on viscous friction, in units of its mass, its radius and
    gravity.

    They are stated from the laws of mechanics, not by the package: what makes its own equations
    cheaper is its merit, and does not move what it is measured by. The parameters are I1, I3,
    eccentricity and friction.
    """
    n, momentum, (ux, uy) = (
        hy.make_vars("nx", "ny", "nz"),
        hy.make_vars("Lx", "Ly", "Lz"),
        hy.make_vars("ux", "uy"),
    )
    transverse, axial, eccentricity, mu = (hy.par[i] for i in range(4))
    spin = sum(a * b for a, b in zip(momentum, n, strict=True)) / axial
    along = (transverse - axial) / transverse * spin
    omega = [a / transverse + along * b for a, b in zip(momentum, n, strict=True)]
    tilting = [a / transverse for a in cross(momentum, n)]
    arm = (eccentricity * n[0], eccentricity * n[1], eccentricity * n[2] - 1.0)
    x, y, _ = cross(omega, arm)
    friction = -mu * (ux + x), -mu * (uy + y)
    moment = cross(arm, (*friction, 1.0))
    lever = -eccentricity / transverse
    free = 1.0 + lever * cross(momentum, tilting)[2]
    normal = free / (1.0 - lever * cross(moment, n)[2])
    rates = (*tilting, *(normal * part for part in moment), *(normal * part for part in friction))
    return list(zip((*n, *momentum, ux, uy), map(hy.expression, rates), strict=True))


def bare_integration(problem: tt.Problem, duration: float) -> Callable[[], tuple[float, int]]:
    """The integration alone, of axis, angular momentum and horizontal velocity, in natural units.

    Returns a function that integrates and returns the final tilt's cosine and the steps.
    """
    numbers, units = top_of(problem).numbers, natural_units(top_of(problem))
    integrator = hy.taylor_adaptive(equations(), [0.0] * 8, pars=[1.0] * 4, tol=TOLERANCE)

    first = tt.simulate(problem, duration, times=[0.0])
    start = [
        *first.axis.values[0],
        *(first.angular_momentum.values[0] / units.angular_momentum),
        *(first.velocity.values[0, :2] / units.speed),
    ]
    end = duration / units.time

    def integrate() -> tuple[float, int]:
        integrator.time = 0.0
        integrator.state[:] = start
        integrator.pars[:] = numbers
        _, _, _, steps, *_ = integrator.propagate_until(end)
        return float(integrator.state[2]), int(steps)

    return integrate


def in_turns(actions: dict[str, Callable[[], Any]], rounds: int) -> dict[str, list[float]]:
    """Times of several actions, each once a round."""
    times: dict[str, list[float]] = {name: [] for name in actions}
    for _ in range(rounds):
        for name, action in actions.items():
            times[name].append(seconds(action))
    return times


def hot_spots(
    action: Callable[[], Any], repeats: int = 20, count: int = 15
) -> list[dict[str, Any]]:
    """Where the time of an action goes: the functions with most time of their own."""
    profile = cProfile.Profile()
    profile.enable()
    for _ in range(repeats):
        action()
    profile.disable()
    entries: dict[Any, Any] = pstats.Stats(profile).stats  # type: ignore[attr-defined]
    spots = [
        {
            "function": f"{os.path.relpath(file) if file.startswith('/') else file}:{line}({name})",
            "calls": calls / repeats,
            "own_ms": 1e3 * own / repeats,
            "total_ms": 1e3 * total / repeats,
        }
        for (file, line, name), (_, calls, own, total, _) in entries.items()
    ]
    return sorted(spots, key=lambda spot: -spot["own_ms"])[:count]


def measure(quick: bool, profile: bool) -> dict[str, Any]:
    """Take all times, and see where they go if asked to."""
    rounds, processes = (21, 3) if quick else (101, 7)
    problem = report_problem(SPIN).replace({"contact.liftoff": "stop"})
    bare = bare_integration(problem, DURATION)

    def run() -> Any:
        return tt.simulate(problem, DURATION, samples=SAMPLES)

    result, (cosine, steps) = run(), bare()
    if abs(cosine - float(result.axis[-1, 2])) > 1e-9 or result.attrs["integrator"] != "taylor":
        raise SystemExit("the two integrations do not end alike: nothing to compare")
    warm = in_turns({"simulate": run, "bare integration": bare}, rounds)
    ratios = [a / b for a, b in zip(warm["simulate"], warm["bare integration"], strict=True)]

    commands: dict[str, tuple[str, ...]] = {
        "python": ("-c", ""),
        "import tippetop": ("-c", "import tippetop"),
        IMPORTS: ("-c", IMPORTS),
        "import and one run": (
            "-c",
            "import tippetop as tt; from tippetop.problem.presets import report_problem;"
            f"tt.simulate(report_problem({SPIN}), {DURATION})",
        ),
        "tippetop --help": (*COMMAND_LINE, "--help"),
        "tippetop simulate": (*COMMAND_LINE, "simulate", "--json"),
    }
    actions = {name: new_process(*arguments) for name, arguments in commands.items()}
    for action in actions.values():
        action()  # fills the caches
    cold = in_turns(actions, processes)

    def median_ms(values: list[float]) -> float:
        return 1e3 * statistics.median(values)

    found = {
        "run": {"spin": SPIN, "duration": DURATION, "samples": SAMPLES, "steps": steps},
        "warm_ms": {name: median_ms(values) for name, values in warm.items()},
        "best_ms": {name: 1e3 * min(values) for name, values in warm.items()},
        "ratio": statistics.median(ratios),
        "target_ratio": TARGET_RATIO,
        "process_ms": {name: median_ms(values) for name, values in cold.items()},
        "rounds": rounds,
    }
    return found | {"profile": hot_spots(run)} if profile else found


def tables(found: dict[str, Any]) -> str:
    """The figures for people, in Markdown."""
    verdict = "within" if found["ratio"] <= TARGET_RATIO else "over"
    rows = [
        [name, f"{value:.2f}", f"{found['best_ms'][name]:.2f}"]
        for name, value in found["warm_ms"].items()
    ]
    rows.append(["ratio", f"{found['ratio']:.2f}", f"{verdict} {TARGET_RATIO:g}"])
    processes = found["process_ms"]
    rows += [[f"new process: {name}", f"{value:.0f}", ""] for name, value in processes.items()]
    imports = processes["tippetop simulate"] / processes[IMPORTS]
    rows.append(
        ["tippetop simulate over these imports", f"{imports:.2f}", f"at most {TARGET_IMPORTS:g}"]
    )
    heads = [
        f"{SPIN:g} rad/s, {DURATION:g} s, {SAMPLES} samples, all variables",
        "median, ms",
        "best, ms",
    ]
    if "profile" not in found:
        return markdown(heads, rows)
    spots = [
        [spot["function"], f"{spot['calls']:g}", f"{spot['own_ms']:.2f}", f"{spot['total_ms']:.2f}"]
        for spot in found["profile"]
    ]
    where = markdown(
        ["under a profiler, which adds to every call", "calls", "own, ms", "total, ms"], spots
    )
    return f"{markdown(heads, rows)}\n\n{where}"
