"""Those who follow the same launches of the report's top: this package's engine, and others.

Each takes launch spins, rad/s, and a tolerance, and gives the tilts at the end, rad.
"""

import importlib
import math
import subprocess
from collections.abc import Callable
from functools import cache
from importlib.util import find_spec
from shutil import which
from typing import Any, NamedTuple

import heyoka as hy
import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from tippetop.mechanics.euler import published_rates
from tippetop.mechanics.motion import sliding_contact, sliding_rates
from tippetop.mechanics.state import SlidingState
from tippetop.problem.presets import report_problem
from tippetop.problem.problem import Problem, top_of
from tippetop.sweeps import Axis, Product, Sweep
from tippetop.sweeps.cells import cells_of
from tippetop.sweeps.ensemble import follow_cells

Array = NDArray[np.float64]
Method = Callable[[Array, float], Array]

DURATION = 20.0


def problem() -> Problem:
    """The report's top, which stops where it would leave the table."""
    return report_problem().replace({"contact.liftoff": "stop"})


def engine(spins: Array, tolerance: float) -> Array:
    """The engine of sweeps, with all observables."""
    axis = Axis.of("launch.spin", spins.tolist())
    sweep = Sweep(problem(), Product((axis,)), DURATION, tolerance)
    found: Array = follow_cells(sweep, np.arange(len(spins)))["final_tilt"].astype(float)
    return found


class Starts(NamedTuple):
    """Launches in natural units.

    Attributes
    ----------
    states
        Sliding states, shape (8, n).
    numbers
        Dimensionless numbers of the tops, shape (k, n).
    end
        Length of the runs.
    kind
        The kind of top.
    """

    states: Array
    numbers: Array
    end: float
    kind: Any


def starts(spins: Array) -> Starts:
    """The launches with these spins."""
    cells = cells_of(problem(), {"launch.spin": spins})
    launches = cells.launches(np.arange(len(spins)), DURATION)
    state = launches.state
    rows = np.array([*state.axis, *state.momentum, *state.velocity[:2]])
    return Starts(rows, launches.numbers, float(launches.end[0]), launches.kind)


def sliding_state(y: Any) -> SlidingState:
    """The state of eight numbers: axis, angular momentum and horizontal velocity."""
    return SlidingState.unpack(y)


def eight(rate: SlidingState) -> list[Any]:
    """The rates of these eight numbers."""
    return [*rate.axis, *rate.momentum, *rate.velocity]


def tilts(rows: Array) -> Array:
    """Tilts of states, shape (8, n)."""
    return np.asarray(np.arctan2(np.hypot(rows[0], rows[1]), rows[2]))


@cache
def _batch_integrator(kind: Any, tolerance: float) -> Any:
    lanes = hy.recommended_simd_size()
    y = hy.make_vars(*(f"y{i}" for i in range(8)))
    top = kind.top(tuple(hy.par[i] for i in range(kind.numbers)))
    state = sliding_state(y)
    rates = [hy.expression(rate) for rate in eight(sliding_rates(state, top))]
    force = sliding_contact(state.axis, state.momentum, state.velocity, top).normal_force
    return hy.taylor_adaptive_batch(
        list(zip(y, rates, strict=True)),
        np.zeros((8, lanes)),
        pars=np.ones((kind.numbers, lanes)),
        tol=tolerance,
        t_events=[hy.t_event_batch(force, direction=hy.event_direction.negative)],
    )


def bare_batch(spins: Array, tolerance: float) -> Array:
    """The batch integrator of heyoka with the event that the table lets go, and its final state
    alone.
    """
    given = starts(spins)
    run, lanes = _batch_integrator(given.kind, tolerance), hy.recommended_simd_size()
    found = np.empty_like(given.states)
    for first in range(0, found.shape[1], lanes):
        some = slice(first, first + lanes)
        run.set_time(0.0)
        run.state[:] = given.states[:, some]
        run.pars[:] = given.numbers[:, some]
        run.reset_cooldowns()
        run.propagate_until(given.end)
        found[:, some] = run.state
    return tilts(found)


@cache
def _diffrax_solver(kind: Any, end: float, tolerance: float) -> Any:
    jax: Any = importlib.import_module("jax")
    diffrax: Any = importlib.import_module("diffrax")
    jax.config.update("jax_enable_x64", True)

    def rates(_: Any, y: Any, numbers: Any) -> Any:
        return jax.numpy.stack(eight(sliding_rates(sliding_state(y), kind.top(tuple(numbers)))))

    def one(y: Any, numbers: Any) -> Any:
        return diffrax.diffeqsolve(
            diffrax.ODETerm(rates),
            diffrax.Dopri8(),
            0.0,
            end,
            None,
            y,
            numbers,
            saveat=diffrax.SaveAt(t1=True),
            stepsize_controller=diffrax.PIDController(rtol=tolerance, atol=tolerance),
            max_steps=None,
        ).ys[0]

    return jax.jit(jax.vmap(one))


def diffrax_vmap(spins: Array, tolerance: float) -> Array:
    """diffrax, all launches at once, on this package's equations."""
    given = starts(spins)
    solve = _diffrax_solver(given.kind, given.end, tolerance)
    return tilts(np.asarray(solve(given.states.T, given.numbers.T)).T)


def scipy_published(spins: Array, tolerance: float) -> Array:
    """SciPy's DOP853 on the published equations."""
    top = top_of(problem())
    found = []

    def rates(_: float, y: Array) -> Array:
        return np.array(published_rates(y.tolist(), top, math))

    for spin in spins:
        start = np.array([problem().launch.tilt, 0.0, 0.0, 0.0, spin, 0.0, 0.0])
        run = solve_ivp(
            rates, (0.0, DURATION), start, method="DOP853", rtol=tolerance, atol=tolerance
        )
        found.append(_wrapped(run.y[0, -1]))
    return np.array(found)


_OCTAVE = """
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
"""The published equations in Octave's language, without which its ode45 has nothing to integrate.
"""


def octave(spins: Array, tolerance: float) -> Array:
    """Octave's ode45, the method of the report's listing, without its jump of theta at the
    poles.
    """
    code = _OCTAVE % (tolerance, tolerance, " ".join(f"{spin:.17g}" for spin in spins))
    command = ["octave", "--no-gui", "--quiet", "--eval", code]
    said = subprocess.run(command, capture_output=True, text=True, check=True)
    return np.array([_wrapped(float(line)) for line in said.stdout.split()])


def _wrapped(theta: float) -> float:
    """The tilt of an angle that ran past a pole."""
    return math.atan2(abs(math.sin(theta)), math.cos(theta))


class Contender(NamedTuple):
    """One who competes.

    Attributes
    ----------
    method
        What it does.
    share
        How many launches each process follows: fewer for the slow.
    here
        Whether it is installed.
    """

    method: Method
    share: int
    here: bool = True


ENGINE = "this engine, all observables"

CONTENDERS = {
    ENGINE: Contender(engine, 8192),
    "heyoka's batch integrator, bare": Contender(bare_batch, 8192),
    "diffrax Dopri8, vmap": Contender(diffrax_vmap, 1024, find_spec("diffrax") is not None),
    "SciPy DOP853, published equations": Contender(scipy_published, 4),
    "Octave ode45, the listing's method": Contender(octave, 2, which("octave") is not None),
}
"""All of them by name, the engine first."""
