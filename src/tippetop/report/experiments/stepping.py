"""Leine and Glocker's top by time-stepping: what a fixed step finds of its impacts and its
rocking.
"""

import math

import numpy as np
import xarray as xr

from tippetop.mechanics.contensou import ELLIPSOIDAL_RADIUS
from tippetop.problem.frictions import ContensouFriction
from tippetop.report.experiment import dataset, experiment
from tippetop.report.experiments.real import EVENTS, LEINE, LEINE_WINDOW, events_of
from tippetop.report.experiments.runs import happenings
from tippetop.report.moreau import Ball, History, SphereTop, follow
from tippetop.run import simulate

STEPS = (1e-3, 5e-4, 2e-4, 1e-4, 5e-5)
"""Steps that are tried, s."""

ROCKING = (4.4, 4.75)
"""The time around the rocking that is shown, s."""


def stepped(step: float) -> History:
    """Return the top followed by time-stepping, with the friction of an ellipsoidal limit
    surface.
    """
    body, friction = LEINE.body, LEINE.friction
    assert isinstance(friction, ContensouFriction)
    balls = [Ball(shape.surface.height(0.0), -shape.surface.slope(0.0)) for shape in body.shapes]
    patch = ELLIPSOIDAL_RADIUS * friction.patch_radius
    followed = SphereTop(body.mass, body.I1, body.I3, balls, friction.mu, patch, LEINE.gravity)
    return follow(followed, LEINE.launch.tilt, LEINE.launch.spin, LEINE_WINDOW, step)


def found_in(history: History) -> dict[str, float]:
    """When things happen as far as the steps tell, s, and how many strikes make up the rocking.

    It stands on its stem for half a second at least, and rests on both where these touch for 20 ms.
    """
    step, touching = history.step, np.array(history.touching)
    times = (np.arange(len(touching)) + 0.5) * step
    sphere, stem = touching.T

    def first(where: np.ndarray) -> float:
        return float(times[where.argmax()]) if where.any() else math.nan

    touched = first(stem)
    back = first(sphere & (times > touched + 0.5))
    changes = np.diff(
        np.concatenate([[False], sphere & stem & (times >= back), [False]]).astype(int)
    )
    begins, ends = np.flatnonzero(changes == 1), np.flatnonzero(changes == -1)
    rests = np.flatnonzero((ends - begins) * step > 0.02)
    both, apart = (
        (float(times[begins[rests[0]]]), float(times[ends[rests[0]] - 1]))
        if len(rests)
        else 2 * (math.nan,)
    )
    onsets = touching[1:] & ~touching[:-1]
    strikes = int(onsets[(times[1:] >= back) & (times[1:] <= both)].sum())
    return {"stem": touched, "back": back, "both": both, "apart": apart, "strikes": strikes}


@experiment("real-stepping", "Leine and Glocker's top by time-stepping", 12.0)
def _stepping(quick: bool) -> xr.Dataset:
    """What time-stepping finds of the top, over its step, and what an exact run finds."""
    histories = [stepped(step) for step in (STEPS[:3] if quick else STEPS)]
    found = [found_in(history) for history in histories]
    samples = 8001
    run = simulate(LEINE, LEINE_WINDOW, samples=samples)
    times = run["time"].values
    exact, impacts = events_of(run), happenings(run, "impact")
    exact["strikes"] = int(((impacts >= exact["back"]) & (impacts <= exact["both"])).sum())
    shown = (times >= ROCKING[0]) & (times <= ROCKING[1])
    ends = [one.step * np.arange(1, len(one.tilts) + 1) for one in histories]
    tilts = [
        np.interp(times[shown], end, one.tilts) for end, one in zip(ends, histories, strict=True)
    ]
    last = [history.tilts[-1] for history in histories]
    meanings = {name: ("s", long) for name, long in EVENTS.items()}
    meanings["strikes"] = ("1", "strikes of the rocking")
    return dataset(
        {"step": [history.step for history in histories], "time": times[shown]},
        final_theta=(last, "rad", "tilt at the end", "step"),
        theta=(tilts, "rad", "tilt", "step", "time"),
        exact_theta=(run["theta"].values[shown], "rad", "tilt of an exact run", "time"),
        exact_final_theta=(float(run["theta"][-1]), "rad", "tilt at the end of an exact run"),
        **{name: ([one[name] for one in found], *told, "step") for name, told in meanings.items()},
        **{
            f"exact_{name}": (value, meanings[name][0], f"{name}, exactly")
            for name, value in exact.items()
        },
    )
