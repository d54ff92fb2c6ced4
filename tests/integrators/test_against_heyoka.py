"""Random launches have the same events by the package's Taylor method and by heyoka's."""

from typing import Any

import numpy as np
import pytest

import tippetop as tt
from campaigns import seeds
from launches import ROUNDINGS, launch_of, nudged

DURATION = 1.0
SAME_TIME = 1e-10
"""Difference of event times, s, that rounding in two methods makes."""


def followed(fields: dict[str, Any], integrator: Any) -> Any:
    """Return the run of a launch, or None if the problem is refused."""
    try:
        problem = tt.Problem(**fields)
    except tt.InvalidInput:
        return None
    return tt.simulate(problem, DURATION, times=[0.0], integrator=integrator)


@pytest.mark.parametrize("seed", seeds(check=2, sample=20, claim=500))
def test_random_launches_have_the_events_that_heyoka_finds(seed):
    pytest.importorskip("heyoka")
    from heyoka_taylor import Heyoka  # noqa: PLC0415 - heyoka may not be installed

    fields = launch_of(seed)
    run = followed(fields, "taylor")
    if run is None:
        return
    same = followed(fields, Heyoka())
    assert same.attrs["outcome"] == run.attrs["outcome"]
    assert same["event_kind"].values.tolist() == run["event_kind"].values.tolist()
    apart = np.abs(same["event_time"].values - run["event_time"].values)
    if np.max(apart, initial=0.0) > SAME_TIME:
        # A launch may multiply a rounding by more than the bound allows.
        beside = followed(nudged(fields), "taylor")
        assert beside["event_kind"].values.tolist() == run["event_kind"].values.tolist()
        moved = np.abs(beside["event_time"].values - run["event_time"].values)
        assert np.all(apart <= np.maximum(SAME_TIME, ROUNDINGS * np.max(moved)))
