"""What a program converges to as its steps shrink, apart from the error of its steps.

Results that converge geometrically have a limit beyond the shortest step (Aitken's). What lies
between the limit and the reference is the program's model; what lies between the limit and the
shortest step's result is the error of steps. Where a setting regularizes dry friction over a slip
speed, the model is held against exact runs on friction that is regularized over it.
"""

import functools
import math
from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

import tippetop as tt
from tippetop.engines.cases import Case
from tippetop.engines.reference import case_of, judged_state, reference_state

Array = NDArray[np.float64]

SLOWEST_CONVERGENCE = 0.8
"""Ratio of successive changes above which results do not converge: order 0.3 for halved steps."""

FASTEST_ORDER = 4.0
"""Order beyond which a small ratio of changes is chance: no program here has a higher one."""

SAME = 2.0
"""Error of steps within which a limit is the reference's: the extrapolation is no surer."""

FARTHEST = 0.1
"""Error of steps beyond which a limit says nothing: the steps are too long for an order."""

LIKENESS = 0.2
"""Part of the model's error that regularized friction may leave unexplained: programs differ in the
force within the width, and the limit is extrapolated."""


class Limit(NamedTuple):
    """What a program converges to in a case at a setting."""

    case: str
    setting: str
    law: str
    """"reference", "regularized", "different", or "none" where results do not converge to what can
    be told: to the reference only where their errors become less."""
    order: float
    """Order of convergence to the limit, which is not the reference in general."""
    step_error: float
    """Distance of the state at the shortest step from the limit."""
    model_error: float
    """Distance of the limit from the reference."""
    width: float
    """Slip speed over which friction is regularized, m/s; nan for another law."""


def limit_of(
    case: Case, rows: Sequence[Mapping[str, Any]], setting_width: float | None = None
) -> Limit:
    """Return what the rows of a case at one setting converge to.

    `setting_width` is the slip speed, m/s, over which the setting regularizes friction.
    """
    rows = sorted((row for row in rows if "failure" not in row), key=lambda row: -row["step"])
    steps = [row["step"] for row in rows]
    states = [np.array(row["state"], float) for row in rows]
    setting = rows[0]["setting"] if rows else ""
    extrapolated = extrapolation(steps, states)
    if extrapolated is None:
        return Limit(case.name, setting, "none", *4 * (math.nan,))
    state, order = extrapolated
    step_error = _distance(states[-1], state)
    model_error = _distance(state, reference_state(case))
    if step_error > FARTHEST:
        return Limit(case.name, setting, "none", *4 * (math.nan,))
    law, width = "reference", math.nan
    if model_error <= SAME * step_error:
        errors = [_distance(one, reference_state(case)) for one in states[-3:]]
        if not all(b <= SLOWEST_CONVERGENCE * a for a, b in pairwise(errors)):
            return Limit(case.name, setting, "none", *4 * (math.nan,))
    else:
        law = "different"
        if setting_width is not None and isinstance(case.problem.friction, tt.CoulombFriction):
            regularized = regularized_state(case.name, setting_width)
            if _distance(state, regularized) <= LIKENESS * model_error:
                law, width = "regularized", setting_width
    return Limit(case.name, setting, law, order, step_error, model_error, width)


def extrapolation(steps: Sequence[float], states: Sequence[Array]) -> tuple[Array, float] | None:
    """Return the limit of the last three results and the order; None where they do not converge."""
    if len(steps) < 3 or not np.isfinite(states[-3:]).all():
        return None
    first, second, third = states[-3:]
    before, after = _distance(second, first), _distance(third, second)
    if not 0.0 < after <= SLOWEST_CONVERGENCE * before:
        return None
    ratio = steps[-2] / steps[-1]
    order = min(math.log(before / after) / math.log(ratio), FASTEST_ORDER)
    share = ratio**-order
    return third + share / (1.0 - share) * (third - second), order


@functools.cache
def regularized_state(name: str, width: float) -> Array:
    """Return the state of a case that is judged, on friction regularized over a width, m/s."""
    case = case_of(name)
    friction = case.problem.friction
    assert isinstance(friction, tt.CoulombFriction)
    softened = tt.RegularizedCoulombFriction(mu=friction.mu, eps=width)
    problem = case.problem.model_copy(update={"friction": softened})
    run = tt.simulate(problem, float(case.times[case.judged - 1]), samples=2)
    return judged_state(case, *[run[one].values[-1] for one in ("axis", "angular_velocity")])


def _distance(one: Array, two: Array) -> float:
    return float(np.abs(one - two).max())
