"""Launches per second of the sweep's engine and of others, at the same measured error, in one run.

    python benchmarks/bench_sweep.py [--quick] [--python-with-diffrax PATH]

Every contender follows the same launches for 20 s on all processors at once, one process each: the report's
top at spins where it turns over and stays on the table. The error of each is that of the final tilt against
runs exact to rounding, the largest over the launches; a contender is timed at the loosest of its tolerances
whose error is below the target. Processor time counts beside the clock, as other programs may be running.
"""

import argparse
import json
import math
import os
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass
from importlib.util import find_spec
from pathlib import Path
from shutil import which
from typing import Any

import heyoka as hy
import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from tippetop.integrators.compile_cache import use_compile_cache
from tippetop.mechanics.euler import published_rates
from tippetop.mechanics.motion import contact, sliding_rates
from tippetop.mechanics.state import SlidingState
from tippetop.presets import report_problem
from tippetop.problem import Problem
from tippetop.sweep import Axis, Product, Sweep
from tippetop.sweep.cells import cells_of
from tippetop.sweep.ensemble import follow_cells

Array = NDArray[np.float64]

DURATION = 20.0
SPINS = (130.0, 160.0)
TARGET = 1e-9
"""Largest error of the final tilt, rad."""

TOLERANCES = (1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12)
PROCESSORS = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1

Method = Callable[[Array, float], Array]
"""From launch spins and a tolerance to final tilts."""


@dataclass(frozen=True)
class Figure:
    """What was measured of a contender.

    Attributes
    ----------
    name
        Who.
    tolerance, error
        The tolerance it was given, and the error that was measured, rad.
    launches
        How many launches it followed.
    rate
        Launches per second by the clock, on all processors.
    processor_time
        Processor time of a launch, ms.
    memory
        Largest memory of a process, MiB.
    """

    name: str
    tolerance: float
    error: float
    launches: int
    rate: float
    processor_time: float
    memory: float


def problem() -> Problem:
    """The report's top, which stops where it would leave the table."""
    return report_problem().replace({"contact.liftoff": "stop"})


def engine(spins: Array, tolerance: float) -> Array:
    """The engine of sweeps, with all observables."""
    axis = Axis.listed("launch.spin", spins.tolist())
    sweep = Sweep(problem(), Product((axis,)), DURATION, tolerance)
    found: Array = follow_cells(sweep, np.arange(len(spins)))["final_theta"].astype(float)
    return found


def starts(spins: Array) -> tuple[Array, Array, float, Any]:
    """Sliding states (8, n) and numbers (q, n) in natural units, the end, and the kind of top."""
    cells = cells_of(problem(), {"launch.spin": spins})
    launches = cells.launches(np.arange(len(spins)), DURATION)
    state = launches.state
    rows = np.array([*state.axis, *state.momentum, *state.velocity[:2]])
    return rows, launches.numbers, float(launches.end[0]), launches.kind


def tilts(rows: Array) -> Array:
    return np.asarray(np.arctan2(np.hypot(rows[0], rows[1]), rows[2]))


_COMPILED: dict[float, Any] = {}


def bare_batch(spins: Array, tolerance: float) -> Array:
    """The batch integrator of heyoka with the same event, its final state and nothing else: the limit."""
    rows, numbers, end, kind = starts(spins)
    lanes = hy.recommended_simd_size()
    if tolerance not in _COMPILED:
        use_compile_cache()
        y = hy.make_vars(*(f"y{i}" for i in range(8)))
        top = kind.top(tuple(hy.par[i] for i in range(kind.numbers)))
        state = SlidingState(tuple(y[0:3]), tuple(y[3:6]), tuple(y[6:8]), (0.0, 0.0), (0.0,) * 3, 0.0)
        rate = sliding_rates(state, top)
        force = contact(state.axis, state.momentum, state.velocity, top).normal_force
        rates = [hy.expression(r) for r in (*rate.axis, *rate.momentum, *rate.velocity)]
        _COMPILED[tolerance] = hy.taylor_adaptive_batch(
            list(zip(y, rates, strict=True)),
            np.zeros((8, lanes)),
            pars=np.ones((kind.numbers, lanes)),
            tol=tolerance,
            t_events=[hy.t_event_batch(force, direction=hy.event_direction.negative)],
        )
    run = _COMPILED[tolerance]
    found = np.empty_like(rows)
    for first in range(0, rows.shape[1], lanes):
        run.set_time(0.0)
        run.state[:] = rows[:, first : first + lanes]
        run.pars[:] = numbers[:, first : first + lanes]
        run.reset_cooldowns()
        run.propagate_until(end)
        found[:, first : first + lanes] = run.state
    return tilts(found)


def scipy_published(spins: Array, tolerance: float) -> Array:
    """SciPy's DOP853 on the published equations."""
    top = problem().top
    found = []

    def rates(_: float, y: Array) -> Array:
        return np.array(published_rates(y.tolist(), top, math))

    for spin in spins:
        start = np.array([problem().launch.tilt, 0.0, 0.0, 0.0, spin, 0.0, 0.0])
        run = solve_ivp(
            rates,
            (0.0, DURATION),
            start,
            method="DOP853",
            rtol=tolerance,
            atol=tolerance,
        )
        theta = run.y[0, -1]
        found.append(math.atan2(abs(math.sin(theta)), math.cos(theta)))
    return np.array(found)


OCTAVE = """
1;
function d = tip(t, y)
  m = 0.02; R = 0.02; a = 0.3; I3 = 2/5*m*R^2; I1 = 131/350*m*R^2; mu = 0.3; g = 9.8;
  s = sin(y(1)); c = cos(y(1));
  N = (m*g*I1 + m*R*a*(I1*c*(y(4)^2*s^2 + y(2)^2) - I3*y(4)*y(5)*s^2)) ...
      / (I1 + m*R^2*a^2*s^2 - m*R^2*a*s*(1 - a*c)*mu*y(6));
  d = zeros(7, 1);
  d(1) = y(2);
  d(2) = s/I1*(I1*y(4)^2*c - I3*y(5)*y(4) - R*a*N) + R*mu*N*y(6)/I1*(1 - a*c);
  d(3) = y(4);
  d(4) = (I3*y(2)*y(5) - 2*I1*y(2)*y(4)*c - mu*N*y(7)*R*(a - c))/(I1*s);
  d(5) = -mu*N*y(7)*R*s/I3;
  d(6) = R*s/I1*(y(4)*y(5)*(I3*(1 - a*c) - I1) + N*R*a*(1 - a*c) - I1*a*(y(2)^2 + y(4)^2*s^2)) ...
      - mu*N*y(6)/m/I1*(I1 + m*R^2*(1 - a*c)^2) + y(4)*y(7);
  d(7) = -mu*N*y(7)/m/I1/I3*(I1*I3 + m*R^2*I3*(a - c)^2 + m*R^2*I1*s^2) ...
      + y(5)*y(2)*R/I1*(I3*(a - c) + I1*c) - y(4)*y(6);
end
opts = odeset("RelTol", %g, "AbsTol", %g);
spins = [%s];
for spin = spins
  [t, y] = ode45(@tip, [0, 20], [0.1; 0; 0; 0; spin; 0; 0], opts);
  printf("%%.17g\\n", y(end, 1));
end
"""


def octave(spins: Array, tolerance: float) -> Array:
    """Octave's ode45, the method of the report's listing, without its jump of theta at the poles."""
    code = OCTAVE % (tolerance, tolerance, " ".join(f"{spin:.17g}" for spin in spins))
    said = subprocess.run(
        ["octave", "--no-gui", "--quiet", "--eval", code], capture_output=True, text=True, check=True
    )
    theta = np.array([float(line) for line in said.stdout.split()])
    return np.asarray(np.arctan2(np.abs(np.sin(theta)), np.cos(theta)))


METHODS: dict[str, Method] = {
    "this engine, all observables": engine,
    "heyoka batch, bare": bare_batch,
    "SciPy DOP853, published": scipy_published,
    "Octave ode45": octave,
}
DIFFRAX = "diffrax Dopri8, vmap"
SHARE = {"this engine, all observables": 4096, "heyoka batch, bare": 4096, DIFFRAX: 512}
"""Launches that every process follows; the slow ones fewer."""

SLOW = 2


def work(method: Method, spins: Array, tolerance: float, start: float, warm: int) -> dict[str, Any]:
    """Follow launches in this process, a few to warm up, and then all of them by the clock."""
    method(spins[:warm], tolerance)
    time.sleep(max(0.0, start - time.time()))
    clock, used = time.perf_counter(), processor_time()
    found = method(spins, tolerance)
    return {
        "found": found.tolist(),
        "clock": time.perf_counter() - clock,
        "used": processor_time() - used,
        "memory": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024,
    }


def processor_time() -> float:
    """Processor time of this process and those it waited for, s."""
    times = os.times()
    return times.user + times.system + times.children_user + times.children_system


def measure(name: str, spins: Array, tolerance: float, truth: Array, python: str, warm: float) -> Figure:
    """Run a contender on all processors at once."""
    start = time.time() + warm
    running = []
    parts = [spins[k::PROCESSORS] for k in range(PROCESSORS)]
    for part in parts:
        with tempfile.NamedTemporaryFile("w", suffix=".json", delete=False) as file:
            json.dump({"name": name, "spins": part.tolist(), "tolerance": tolerance, "start": start}, file)
        script = Path(__file__).with_name("bench_sweep_diffrax.py") if name == DIFFRAX else Path(__file__)
        command = [python, str(script), "--work", file.name]
        running.append((file.name, subprocess.Popen(command, stdout=subprocess.PIPE, env=_environment())))
    found = []
    for file_name, process in running:
        said, _ = process.communicate()
        Path(file_name).unlink()
        if process.returncode:
            raise SystemExit(f"{name} failed")
        found.append(json.loads(said))
    errors = [np.abs(np.array(one["found"]) - truth[k::PROCESSORS]).max() for k, one in enumerate(found)]
    return Figure(
        name,
        tolerance,
        float(max(errors)),
        len(spins),
        len(spins) / max(one["clock"] for one in found),
        1e3 * sum(one["used"] for one in found) / len(spins),
        max(one["memory"] for one in found),
    )


def _environment() -> dict[str, str]:
    source = str(Path(__file__).resolve().parent.parent / "src")
    limits = dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"), "1")
    xla = {"XLA_FLAGS": "--xla_cpu_multi_thread_eigen=false intra_op_parallelism_threads=1"}
    paths = os.pathsep.join(filter(None, (source, os.environ.get("PYTHONPATH"))))
    return {**os.environ, **limits, **xla, "PYTHONPATH": paths}


def contest(quick: bool, python: str | None) -> list[Figure]:
    """Every contender at the loosest tolerance whose error is below the target."""
    figures = []
    for name in (*list(METHODS)[:2], DIFFRAX, *list(METHODS)[2:]):
        own = python if name == DIFFRAX else sys.executable
        if own is None or (name.startswith("Octave") and which("octave") is None):
            print(f"{name}: not installed, left out", flush=True)
            continue
        share = SHARE.get(name, SLOW) // (8 if quick and name in SHARE else 1)
        spins = np.linspace(*SPINS, share * PROCESSORS)
        few = spins if name not in SHARE else spins[:: max(1, share * PROCESSORS // 32)]
        few = few[: len(few) - len(few) % PROCESSORS]
        with tempfile.TemporaryDirectory() as folder:
            rows, numbers, end, _ = starts(spins)
            os.environ["TIPPETOP_STARTS"] = f"{folder}/starts.npz"
            np.savez(os.environ["TIPPETOP_STARTS"], rows=rows, numbers=numbers, end=end, spins=spins)
            truth, truth_few = engine(spins, 2.3e-16), engine(few, 2.3e-16)
            chosen = TOLERANCES[-1]
            for tolerance in TOLERANCES:
                tried = measure(name, few, tolerance, truth_few, own, 0.0)
                print(f"  {name}: {tolerance:.0e} -> error {tried.error:.1e}", flush=True)
                if tried.error <= TARGET:
                    chosen = tolerance
                    break
            warm = 30.0 if name == DIFFRAX else 10.0
            figures.append(measure(name, spins, chosen, truth, own, warm))
    return figures


def table(figures: list[Figure]) -> str:
    """The figures as a table in Markdown."""
    ours = figures[0]
    lines = [
        f"| method | tolerance | error (rad) | launches/s on {PROCESSORS} processors "
        "| ms of processor each | times ours | MiB |",
        "| --- | --- | --- | --- | --- | --- | --- |",
    ]
    for figure in figures:
        ratio = figure.processor_time / ours.processor_time
        lines.append(
            f"| {figure.name} | {figure.tolerance:.0e} | {figure.error:.1e} | {figure.rate:,.3g} "
            f"| {figure.processor_time:.3g} | {ratio:,.3g} | {figure.memory:,.0f} |"
        )
    return "\n".join(lines)


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--quick", action="store_true", help="an eighth of the launches")
    parser.add_argument("--python-with-diffrax", default=sys.executable if find_spec("diffrax") else None)
    parser.add_argument("--json", type=Path, help="write the figures here")
    parser.add_argument("--work", type=Path, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.work is not None:
        job = json.loads(options.work.read_text())
        method, spins = METHODS[job["name"]], np.array(job["spins"])
        print(json.dumps(work(method, spins, job["tolerance"], job["start"], 8)))
        return
    figures = contest(options.quick, options.python_with_diffrax)
    print(table(figures))
    if options.json is not None:
        options.json.write_text(json.dumps([asdict(figure) for figure in figures], indent=2))


if __name__ == "__main__":
    main()
