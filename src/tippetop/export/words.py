"""What became of a launch, in words: what it did, and what it heads for."""

import math
from typing import NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from tippetop.mechanics.top import natural_units
from tippetop.problem.problem import Problem
from tippetop.support.errors import InvalidInput
from tippetop.theory.prediction import Prediction, predicted
from tippetop.theory.steady import SteadyKind, SteadyState
from tippetop.theory.thresholds import CriticalSpins, stability_limits

NEAR = 0.05
"""How close to a vertical the axis must end to count as there, rad."""

AROUND = 0.3
"""How close to a vertical the axis must be all along to have stayed there, rad."""

SETTLED = 0.02
"""How close to a steady state the tilt must stay at the end to count as settled, rad."""

LATE = 0.1
"""Share of a run that counts as its end."""

SWINGS = 20.0
"""How long the end must be at least, in natural units of time: a few swings of the tilt."""


class Story(NamedTuple):
    """A run in words: what became of the top, as a clause ("inverts at 7.56 s"), and sentences
    beside it.
    """

    headline: str
    details: tuple[str, ...]


def tell(run: xr.Dataset) -> Story:
    """The story of a run."""
    problem = Problem.from_json(run.attrs["problem"])
    prediction = known_end(problem)
    clauses = [_end(run, problem, prediction), *_flights(run)]
    details = [f"It heads for {end_in_words(prediction)}."] if prediction else []
    if problem.friction.vanishes:
        details.append("There is no friction: nothing makes it settle.")
    if run.attrs["outcome"] != "completed":
        details.insert(0, run.attrs["outcome_advice"])
    return Story("; ".join(clauses), tuple(details))


def known_spins(problem: Problem) -> CriticalSpins | None:
    """The critical spins of a launch; None where Jellett's integral is not conserved, or there are
    none.
    """
    if not problem.top.conserves_jellett:
        return None
    try:
        return stability_limits(problem)
    except InvalidInput:
        return None


def known_end(problem: Problem) -> Prediction | None:
    """The steady states a launch heads for; None where the theory does not hold, or nothing takes
    energy.
    """
    if problem.friction.vanishes:
        return None
    try:
        prediction = predicted(problem)
    except InvalidInput:
        return None
    return prediction if prediction.reachable else None


def end_in_words(prediction: Prediction) -> str:
    """All that a launch may head for, as a phrase: "inverted spin with ω₃ = −82.87 rad/s"."""
    states = " or for ".join(steady_in_words(state) for state in prediction.reachable)
    return (
        states
        if prediction.certain
        else f"{states}: each is stable, and the launch's details decide"
    )


def steady_in_words(state: SteadyState[float]) -> str:
    """A steady state as a phrase."""
    precession, spin = (_number(value) for value in (state.precession, state.spin))
    if state.kind is SteadyKind.PRECESSION:
        return (
            f"precession at {math.degrees(state.tilt):.1f}° (θ = {state.tilt:.3f} rad) "
            f"with φ′ = {precession} and ω₃ = {spin} rad/s"
        )
    if state.kind is SteadyKind.LEVEL:
        return f"level spin with φ′ = {precession} rad/s"
    return f"{state.kind.value} spin with ω₃ = {spin} rad/s"


def _number(value: float) -> str:
    """A number with a true minus sign, and none before zero."""
    text = f"{value:.2f}"
    return text.replace("-", "−") if float(text) else text.lstrip("-")


def _end(run: xr.Dataset, problem: Problem, end: Prediction | None) -> str:
    theta = run["theta"].values
    if theta[-1] < NEAR and np.all(theta < AROUND):
        return _upright(problem)
    if theta[-1] > math.pi - NEAR and np.all(theta > math.pi - AROUND):
        return "stays inverted"
    swings = _late(run, problem, 0.0)
    unstable = end is not None and all(
        state.kind is not SteadyKind.UPRIGHT for state in end.reachable
    )
    if np.all(theta[swings] < NEAR) and not unstable:
        comes = "falls back" if problem.launch.tilt > math.pi / 2 else "comes"
        return f"{comes} upright at {_since(run, theta >= NEAR):.2f} s"
    # Where it can end nowhere else, being there once is enough.
    foretold = end is not None and end.certain and end.final.kind is SteadyKind.INVERTED
    if theta[-1] > math.pi - NEAR and (foretold or np.all(theta[swings] > math.pi - NEAR)):
        return f"inverts at {float(run['arrives']):.2f} s"
    angle = f"{math.degrees(theta[-1]):.1f}°"
    if run.attrs["outcome"] == "at_rest":
        return f"comes to rest at {angle} after {float(run['end_time']):.2f} s"
    since = _settled(run, problem, end)
    if since is None:
        return f"is at {angle} when the run ends, and still moving"
    return f"settles at {angle} from {since:.2f} s on" if since else f"stays at {angle}"


def _upright(problem: Problem) -> str:
    spin, spins = abs(problem.launch.spin), known_spins(problem)
    if spins is None or problem.friction.vanishes:
        return "stays upright"
    if spins.upright == math.inf:
        return "stays upright, as at any spin"
    if spin < spins.upright:
        return f"stays upright: spin below {spins.upright:.1f} rad/s"
    return f"is still upright when the run ends, though its spin is above {spins.upright:.1f} rad/s"


def _late(run: xr.Dataset, problem: Problem, share: float) -> NDArray[np.bool_]:
    """The samples of the end of a run: a share of it, and a few swings at least."""
    time = run["time"].values
    swings = SWINGS * float(natural_units(problem.top).time)
    return np.asarray(time >= time[-1] - max(share * time[-1], swings))


def _settled(run: xr.Dataset, problem: Problem, end: Prediction | None) -> float | None:
    """Since when the tilt is at a steady state, s: at a foretold one, or, where none is, at any."""
    theta = run["theta"].values
    late = _late(run, problem, LATE)
    if run.attrs["outcome"] != "completed" or late[0]:
        return None
    for tilt in [state.tilt for state in end.reachable] if end else [theta[-1]]:
        off = np.abs(theta - tilt) > SETTLED
        if not np.any(off & late):
            return _since(run, off) if np.any(off) else 0.0
    return None


def _since(run: xr.Dataset, off: NDArray[np.bool_]) -> float:
    """When the tilt arrives for good, s: one that swings passes its last value before."""
    return max(float(run["arrives"]), float(run["time"].values[off][-1]))


def _flights(run: xr.Dataset) -> list[str]:
    times, starts = run["event_time"].values, run["flight_start"].values
    lift_offs = times[run["event_kind"].values == "lift-off"]
    clauses = []
    if len(starts) and starts[0] == 0 and not np.any(lift_offs == 0):  # let go above the table
        if not np.any(run["event_kind"].values == "touchdown"):
            return ["never touches the table"]
        clauses.append(f"comes down on the table at {run['flight_end'].values[0]:.2f} s")
        starts = starts[1:]
    if len(starts):
        often = "once, at" if len(starts) == 1 else f"{len(starts)} times from"
        clauses.append(f"leaves the table {often} {starts[0]:.2f} s")
    if run.attrs["outcome"] == "lifted_off":
        clauses.append(f"the table would have to pull from {lift_offs[-1]:.2f} s on")
    return clauses
