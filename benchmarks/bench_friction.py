"""What dry friction of a patch costs beside viscous friction, in single runs and in sweeps, as
ratios.

The same launches of the report's top are followed under viscous friction and under Contensou's,
with the coefficient for which the two are one law at slow slip, 3 pi mu / (8 omega R) in s/m: so
tops turn over and fly much alike, and none sticks. They are not alike in all. At 0.3 to 0.5 m/s of
slip, several times the drilling, a patch grips less than viscous friction: turning over takes 8 s
instead of 3, and nutates as fast all the while, so that the motion alone takes some 1.6 times the
steps (what series of viscous friction would take along it) and 2.4 times the flights. The law takes
the rest: 1.4 times those steps, each of 1.2 to 1.7 times the operations. Near every slowest slip it
is singular at complex times, where v^2 + (rho w)^2 = 0 or kappa is 0 or 1, and polynomials of
whatever method go no farther; where Hertz's branches meet at a real time, a passage beyond it takes
some 20 steps more than its length would. So beside the ratios of what whole launches cost stand
those of a step and of a flight, and that of a launch to as many steps and flights under viscous
friction; and for patches of several radii the ratio to viscous friction that turns the top over as
late. Small patches do not turn it over in the time of the run, and nutate on; large ones stop it,
and what costs most is the end of slip.
"""

import math
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from scipy.optimize import brentq

import tippetop as tt
from benchmarks.surroundings import markdown
from tippetop.problem.presets import report_problem
from tippetop.sweeps import Axis, Product, Sweep
from tippetop.sweeps.ensemble import follow_cells

DURATION = 20.0
VISCOUS, PATCH = 0.3, 1e-3
"""Viscous coefficient, s/m, and radius of the patch, m."""

RADII = (1e-4, 3e-4, 1e-3, 3e-3, 1e-2)
"""Radii of the patch, m, over which single runs without flights are compared, too."""

SPINS = {"ignore": (130.0, 155.0), "fly": (180.0, 200.0)}
"""Launches without flights, and with them, rad/s."""

SPIN = 142.5
"""A launch without flights, rad/s."""

TARGETS = {"one by one": 2.0, "a sweep": 2.0}
"""What a launch may cost, over viscous friction."""


@dataclass(frozen=True)
class Cost:
    """What launches cost under a law, each in processor time, s, with its steps and flights.

    Attributes
    ----------
    calm, calm_steps
        A launch without flights.
    lively, lively_steps, flights
        A launch with flights.
    """

    calm: float
    calm_steps: float
    lively: float
    lively_steps: float
    flights: float

    @property
    def step(self) -> float:
        """A step."""
        return self.calm / self.calm_steps

    @property
    def flight(self) -> float:
        """A flight, with the impact at its end."""
        return (self.lively - self.step * self.lively_steps) / self.flights


def laws(radius: float = PATCH) -> dict[str, tt.Friction]:
    """Viscous friction, and that of a patch of some radius, m, for each pressure."""
    mu = VISCOUS * 8.0 * radius * 0.5 * (SPINS["ignore"][0] + SPINS["fly"][1]) / (3.0 * math.pi)
    hertz = tt.ContensouFriction(mu=mu, patch_radius=radius)
    ellipsoidal = tt.ContensouFriction(mu=mu, patch_radius=radius, pressure="ellipsoidal")
    return {"viscous": tt.ViscousFriction(mu=VISCOUS), "ellipsoidal": ellipsoidal, "hertz": hertz}


def one_by_one(problem: tt.Problem, spins: list[float]) -> tuple[float, float]:
    """Mean steps and flights of single runs."""
    runs = [
        tt.simulate(problem.replace({"launch.spin": spin}), DURATION, samples=2) for spin in spins
    ]
    counted = [(float(run["steps"]), float(run["flights"])) for run in runs]
    steps, flights = np.mean(counted, axis=0)
    return float(steps), float(flights)


def swept(problem: tt.Problem, spins: list[float]) -> tuple[float, float]:
    """The same of a sweep."""
    sweep = Sweep(problem, Product((Axis.of("launch.spin", spins),)), DURATION)
    found = follow_cells(sweep, np.arange(len(spins)))
    return float(found["steps"].mean()), float(found["flights"].mean())


def costs(method: Callable[..., tuple[float, float]], count: int, rounds: int) -> dict[str, Cost]:
    """The cost under every law: the laws take turns, and the least time of each counts."""
    least: dict[tuple[str, str], float] = {}
    counted: dict[tuple[str, str], tuple[float, float]] = {}
    for _ in range(rounds + 1):
        for name, law in laws().items():
            for liftoff, ends in SPINS.items():
                problem = report_problem().replace({"friction": law, "contact.liftoff": liftoff})
                began = time.process_time()
                counted[name, liftoff] = method(problem, np.linspace(*ends, count).tolist())
                used = (time.process_time() - began) / count
                # The first round compiles.
                least[name, liftoff] = (
                    min(used, least[name, liftoff]) if (name, liftoff) in least else math.inf
                )
    return {
        name: Cost(
            least[name, "ignore"],
            counted[name, "ignore"][0],
            least[name, "fly"],
            *counted[name, "fly"],
        )
        for name in laws()
    }


def alone(laws: list[tt.Friction], rounds: int) -> list[tuple[float, float, float]]:
    """Processor time, s, steps and time of turning over, s, of a launch without flights: laws take
    turns.
    """
    problem = report_problem().replace({"contact.liftoff": "ignore", "launch.spin": SPIN})
    least, told = [math.inf] * len(laws), [(math.nan, math.nan)] * len(laws)
    for turn in range(rounds + 1):
        for i, law in enumerate(laws):
            began = time.process_time()
            run = tt.simulate(problem.replace({"friction": law}), DURATION, samples=2)
            # The first turn compiles.
            least[i] = min(least[i], time.process_time() - began if turn else math.inf)
            told[i] = float(run["steps"]), float(run["turnover_time"])
    return [(used, *more) for used, more in zip(least, told, strict=True)]


def as_late(turning: float) -> tt.Friction | None:
    """Viscous friction under which the top turns over as late, s; None where it does not, or none
    is.
    """
    if not math.isfinite(turning):
        return None

    def later(mu: float) -> float:
        found = alone([tt.ViscousFriction(mu=mu)], 0)[0][2]
        return (found if math.isfinite(found) else DURATION) - turning

    ends = 0.1 * VISCOUS, 4.0 * VISCOUS
    if later(ends[0]) * later(ends[1]) > 0.0:
        return None
    return tt.ViscousFriction(mu=float(brentq(later, *ends, rtol=1e-3)))


def over_radii(rounds: int) -> list[dict[str, Any]]:
    """What a single launch costs under laws of patches of all radii, over viscous friction.

    And over one under which the top turns over as late, if it does: it nutates for as long.
    """
    rows = []
    for radius in RADII:
        viscous, *patches = laws(radius).values()
        beside = [as_late(turning) for _, _, turning in alone(patches, 0)]
        for patch, late in zip(patches, beside, strict=True):
            (used, steps, turning), (usual, fewer, _), slow = alone(
                [patch, viscous, late or viscous], rounds
            )
            row: dict[str, Any] = {"radius": radius, "pressure": getattr(patch, "pressure", "")}
            row |= {"a launch": used / usual, "steps": steps / fewer}
            row |= {
                "turns over, s": turning,
                "over one as late": used / slow[0],
                "its steps": steps / slow[1],
            }
            if late is None:
                row |= dict.fromkeys(list(row)[-3:])
            rows.append(row)
    return rows


def ratios(cost: Cost, viscous: Cost) -> dict[str, float]:
    """A law's cost over the viscous one's."""
    alike = viscous.step * cost.lively_steps + viscous.flight * cost.flights
    return {
        "without flights": cost.calm / viscous.calm,
        "a step": cost.step / viscous.step,
        "with flights": cost.lively / viscous.lively,
        "a flight": cost.flight / viscous.flight,
        "as many steps and flights": cost.lively / alike,
        "steps": cost.calm_steps / viscous.calm_steps,
        "flights": cost.flights / viscous.flights,
    }


def measure(quick: bool) -> dict[str, Any]:
    """All ratios, of launches one by one and in a sweep."""
    found: dict[str, Any] = {}
    plans = {
        "one by one": (one_by_one, 6 if quick else 12),
        "a sweep": (swept, 512 if quick else 2048),
    }
    for way, (method, count) in plans.items():
        known = costs(method, count, 2 if quick else 5)
        found[way] = {
            name: ratios(cost, known["viscous"]) | {"costs": asdict(cost)}
            for name, cost in known.items()
            if name != "viscous"
        }
    found["over radii"] = over_radii(3 if quick else 10)
    return found


def tables(found: dict[str, Any]) -> str:
    """The figures for people, in Markdown."""
    names = [name for name in next(iter(found["a sweep"].values())) if name != "costs"]
    rows = [
        [f"{law}, {way}", *(f"{values[name]:.2f}" for name in names)]
        for way in TARGETS
        for law, values in found[way].items()
    ]
    targets = ", ".join(f"{way} {target:g}" for way, target in TARGETS.items())
    told = [name for name in found["over radii"][0] if name not in ("radius", "pressure")]
    radii = [
        [
            f"{row['pressure']}, {row['radius']:g} m",
            *(f"{row[name]:.2f}" if row[name] else "-" for name in told),
        ]
        for row in found["over radii"]
    ]
    return (
        f"{markdown(['over viscous friction', *names], rows)}\n\nWanted of a launch at most:"
        f" {targets}.\n\n{markdown(['one by one without flights, by patch', *told], radii)}"
    )
