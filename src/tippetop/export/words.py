"""What became of a launch, in words: what it did, and what it heads for."""

import math
from dataclasses import dataclass

import numpy as np
import xarray as xr

from tippetop.errors import InvalidInput
from tippetop.phases.base import EventKind
from tippetop.problem import EccentricSphere, Problem
from tippetop.summary import NEAR_FINAL
from tippetop.theory.prediction import Prediction, predict
from tippetop.theory.steady import Kind, SteadyState
from tippetop.theory.thresholds import CriticalSpins, critical_spins

NEAR = 0.05
"""How close to a vertical the axis must end to count as there, rad."""

SETTLED = 0.02
"""How close to a steady state the tilt must end to count as settled, rad."""


@dataclass(frozen=True)
class Story:
    """A run in words.

    Attributes
    ----------
    headline
        What became of the top, as a clause: "inverts at 7.56 s".
    details
        Sentences that say more.
    """

    headline: str
    details: tuple[str, ...]


def tell(run: xr.Dataset) -> Story:
    """The story of a run."""
    problem = Problem.from_json(run.attrs["problem"])
    spins, prediction = known_spins(problem), known_end(problem)
    clauses = [_end(run, problem, spins, prediction), *_flights(run)]
    details = [_steady(prediction)] if prediction else []
    if run.attrs["outcome"] != "completed":
        details.insert(0, run.attrs["outcome_advice"])
    return Story("; ".join(clauses), tuple(details))


def known_spins(problem: Problem) -> CriticalSpins | None:
    """The critical spins of a launch of a tippe top; None for other shapes, or where there are none."""
    if not isinstance(problem.body.shape, EccentricSphere):
        return None
    try:
        return critical_spins(problem)
    except InvalidInput:
        return None


def known_end(problem: Problem) -> Prediction | None:
    """The steady states a launch heads for; None where the theory does not hold."""
    try:
        prediction = predict(problem)
    except InvalidInput:
        return None
    return prediction if prediction.reachable else None


def steady_in_words(state: SteadyState) -> str:
    """A steady state as a phrase."""
    if state.kind is Kind.PRECESSION:
        return (
            f"precession at {math.degrees(state.tilt):.1f}° (θ = {state.tilt:.3f} rad) "
            f"with φ′ = {state.precession:.2f} and ω₃ = {state.spin:.2f} rad/s"
        )
    if state.kind is Kind.LEVEL:
        return f"level spin with φ′ = {state.precession:.2f} rad/s"
    return f"{state.kind.value} spin with ω₃ = {state.spin:.2f} rad/s"


def arrival(run: xr.Dataset) -> float:
    """When the tilt is first within 0.01 rad of its last value, s, between samples too."""
    time, theta = run["time"].values, run["theta"].values
    beyond = np.abs(theta - theta[-1]) - NEAR_FINAL
    first = int(np.argmax(beyond < 0))
    if first == 0:
        return float(time[0])
    share = beyond[first - 1] / (beyond[first - 1] - beyond[first])
    return float(time[first - 1] + share * (time[first] - time[first - 1]))


def _end(run: xr.Dataset, problem: Problem, spins: CriticalSpins | None, end: Prediction | None) -> str:
    theta = float(run["theta"].values[-1])
    start, arrives = problem.launch.tilt, arrival(run)
    if theta > math.pi - NEAR:
        return "stays inverted" if start > math.pi / 2 else f"inverts at {arrives:.2f} s"
    if theta < NEAR and start > math.pi / 2:
        return f"falls back upright at {arrives:.2f} s"
    if theta < NEAR:
        return _upright(abs(problem.launch.spin), spins)
    angle = f"{math.degrees(theta):.1f}°"
    if _settled(run, end):
        return f"settles at {angle} from {arrives:.2f} s on"
    return f"is at {angle} when the run ends, and still moving"


def _upright(spin: float, spins: CriticalSpins | None) -> str:
    if spins is None:
        return "stays upright"
    if spins.upright == math.inf:
        return "stays upright, as at any spin"
    if spin < spins.upright:
        return f"stays upright: spin below {spins.upright:.1f} rad/s"
    return f"is still upright when the run ends, though its spin is above {spins.upright:.1f} rad/s"


def _settled(run: xr.Dataset, end: Prediction | None) -> bool:
    """Whether the tilt has reached a steady state: the foretold one, or, where none is, any."""
    theta = run["theta"].values
    if end is not None:
        return any(abs(state.tilt - theta[-1]) < SETTLED for state in end.reachable)
    late = run["time"].values > 0.9 * run["time"].values[-1]
    return bool(late.any() and np.ptp(theta[late]) < SETTLED)


def _flights(run: xr.Dataset) -> list[str]:
    lift_offs = run["event_time"].values[run["event_kind"].values == EventKind.LIFT_OFF.value]
    if not len(lift_offs):
        return []
    count = run.sizes["flight"]
    if not count:
        return [f"the table would have to pull from {lift_offs[0]:.2f} s on"]
    times = "once, at" if count == 1 else f"{count} times from"
    return [f"leaves the table {times} {lift_offs[0]:.2f} s"]


def _steady(prediction: Prediction) -> str:
    first = f"It heads for {steady_in_words(prediction.reachable[0])}"
    if prediction.certain:
        return f"{first}."
    others = " or ".join(steady_in_words(state) for state in prediction.reachable[1:])
    return f"{first}, or for {others}: both are stable, and the launch's details decide."
