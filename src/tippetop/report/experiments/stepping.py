"""Leine and Glocker's top by time-stepping: its impacts and its rocking at several steps."""

import math

import numpy as np
import xarray as xr

from tippetop.mechanics.laws.contensou import ELLIPSOIDAL_RADIUS
from tippetop.problem.frictions import ContensouFriction
from tippetop.report.experiment import dataset, experiment
from tippetop.report.experiments.real import EVENTS, LEINE, LEINE_WINDOW, contact_events
from tippetop.report.experiments.runs import event_times
from tippetop.report.moreau import Ball, History, SphereTop, follow
from tippetop.run import simulate

STEPS = (1e-3, 5e-4, 2e-4, 1e-4, 5e-5)
"""Lengths of the steps, s."""

ROCKING = (4.4, 4.75)
"""Span of time around the rocking that is shown, s."""


def stepped(step: float) -> History:
    """Return the top's history by time-stepping, with the friction of an ellipsoidal limit
    surface.
    """
    body, friction = LEINE.body, LEINE.friction
    assert isinstance(friction, ContensouFriction)
    balls = [Ball(shape.surface.height(0.0), -shape.surface.slope(0.0)) for shape in body.shapes]
    patch = ELLIPSOIDAL_RADIUS * friction.patch_radius
    followed = SphereTop(body.mass, body.I1, body.I3, balls, friction.mu, patch, LEINE.gravity)
    return follow(followed, LEINE.launch.tilt, LEINE.launch.spin, LEINE_WINDOW, step)


def events_in_steps(history: History) -> dict[str, float]:
    """Return the times of `EVENTS`, s, and the number of strikes in the rocking, as the steps show
    them.

    The fall back is the first touch of the sphere more than half a second after that of the stem;
    double contact is a time of 20 ms or more in which both surfaces have impulses.
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
    both, apart = math.nan, math.nan
    if len(rests):
        both, apart = float(times[begins[rests[0]]]), float(times[ends[rests[0]] - 1])
    onsets = touching[1:] & ~touching[:-1]
    strikes = int(onsets[(times[1:] >= back) & (times[1:] <= both)].sum())
    return {"stem": touched, "back": back, "both": both, "apart": apart, "strikes": strikes}


@experiment("real-stepping", "Leine and Glocker's top by time-stepping", 12.0)
def _stepping(quick: bool) -> xr.Dataset:
    """Return events and tilts by time-stepping with several steps, and by an exact run."""
    histories = [stepped(step) for step in (STEPS[:3] if quick else STEPS)]
    events = [events_in_steps(history) for history in histories]
    samples = 8001
    run = simulate(LEINE, LEINE_WINDOW, samples=samples)
    times = run["time"].values
    exact, impacts = contact_events(run), event_times(run, "impact")
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
        final_tilt=(last, "rad", "tilt at the end", "step"),
        tilt=(tilts, "rad", "tilt", "step", "time"),
        exact_tilt=(run["tilt"].values[shown], "rad", "tilt of an exact run", "time"),
        exact_final_tilt=(float(run["tilt"][-1]), "rad", "tilt at the end of an exact run"),
        **{
            name: ([each[name] for each in events], *meaning, "step")
            for name, meaning in meanings.items()
        },
        **{
            f"exact_{name}": (value, meanings[name][0], f"{name}, exactly")
            for name, value in exact.items()
        },
    )
