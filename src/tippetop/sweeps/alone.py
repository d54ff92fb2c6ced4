"""Launches of a sweep that are followed one by one, each as a single launch is."""

import numpy as np

from tippetop.contact.block import in_blocks
from tippetop.contact.mode import Transition
from tippetop.contact.trajectory import Trajectory
from tippetop.integrators import default_name, make_integrator
from tippetop.mechanics.hull import Hull
from tippetop.metrics import Ends
from tippetop.sweeps.launches import Launches, single
from tippetop.tally import Tally

LEAST_SCIPY = 1e-12
"""Least tolerance of the integrator of single launches where heyoka is not installed."""


def is_alone(launches: Launches) -> bool:
    """Whether the batches know nothing of their bodies or rules."""
    example = launches.kind.example
    return launches.own is not None or isinstance(example.surface, Hull)


def follow_each(launches: Launches, tolerance: float) -> Ends:
    """Follow every launch to its end."""
    ends = Ends.unknown(len(launches))
    for i in range(len(launches)):
        start = launches.rules(i).launch(single(launches.state, i))
        trajectory, tally = follow(start, 0.0, float(launches.end[i]), tolerance)
        assert trajectory.outcome is not None, "a trajectory that has no more segments has ended"
        found = tally.ends(trajectory.state, trajectory.time, trajectory.outcome, trajectory.events)
        ends.put(np.array([i]), found)
    return ends


def follow(start: Transition, time: float, end: float, tolerance: float) -> tuple[Trajectory, Tally]:
    """Follow one launch from a transition to its end."""
    name = default_name()
    method = make_integrator(name, tolerance if name == "taylor" else max(tolerance, LEAST_SCIPY))
    trajectory, tally = Trajectory(start, end, method, time=time), Tally()
    for block in in_blocks(trajectory.segments()):
        tally.take(block)
    return trajectory, tally
