"""Launches of a sweep that are followed one by one, each as a single launch is."""

import logging
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace

import numpy as np

from tippetop.contact.automaton import Automaton
from tippetop.contact.block import in_blocks
from tippetop.contact.mode import Segment, Transition
from tippetop.contact.trajectory import Trajectory
from tippetop.graph.own_parts import has_choices
from tippetop.integrators import DEFAULT, TOLERANCES, make_integrator
from tippetop.integrators.dense import DenseSolution
from tippetop.mechanics.state import State
from tippetop.mechanics.surfaces.hull import Hull, is_edge
from tippetop.mechanics.top import Top
from tippetop.results.accumulation import accumulate, before_launch, of_a_part
from tippetop.results.metrics import Ends
from tippetop.results.observables import Recorder
from tippetop.results.run_metrics import RunMetrics
from tippetop.support.errors import Unavailable
from tippetop.sweeps.launch_arrays import Launches, single
from tippetop.sweeps.trajectory_samples import SampledLaunch, TrajectorySamples
from tippetop.theory.prediction import is_held

_LOG = logging.getLogger(__name__)


SINGLE: Mapping[str, Callable[[Launches], bool]] = {
    "a body of several surfaces, because steps of many launches follow one surface, and another one"
    " may touch at any time": lambda launches: isinstance(launches.kind.example.surface, Hull),
    "a contact with rules of its own, because the steps do not know its modes": (
        lambda launches: launches.rules is not None
    ),
    "a law or surface that chooses between formulas (`tippetop.extend.where`, `abs`, `min`, `max`,"
    " and surfaces of arcs), because the steps do not see past the place where another formula"
    " takes over": lambda launches: has_choices(launches.kind.example),
}
"""What launches are followed by themselves from their start, with the reason, in the words of the
documentation (`docs/howto/sweep.md`).

Others leave the lanes later: in `transitions`, and where their motion becomes stiff
(`lane_executor`).
"""


def needs_single_launches(launches: Launches) -> bool:
    """Return whether every launch of a sweep must be followed by itself from its start."""
    return any(needs_it(launches) for needs_it in SINGLE.values())


def follow_each(
    launches: Launches,
    tolerance: float,
    settled: float | None = None,
    samples: TrajectorySamples | None = None,
) -> Ends:
    """Follow every launch to its end, or until its tilt is held within `settled`, rad; take its
    samples.

    A launch in which something raises has failed, and nothing else is known of it.
    """
    ends = before_launch(len(launches))
    for i in range(len(launches)):
        try:
            automaton, state = launches.automaton(i), single(launches.state, i)
            start, end = automaton.launch(state), float(launches.end[i])
            sampled = None
            if samples is not None:
                sampled = SampledLaunch.at_launch(samples, i, state.axis)
            begin = automaton, state, 0.0
            ended, _ = follow(begin, start, end, tolerance, settled, sampled=sampled)
        except (MemoryError, Unavailable):
            raise
        except Exception as error:  # noqa: BLE001 - whatever was raised, the others go on
            note_failure(error)
        else:
            accumulate(ends, np.array([i]), ended.state, **of_a_part(ended))
    return ends


def note_failure(error: Exception) -> None:
    """Log what was raised in a cell of a sweep, which therefore has failed."""
    _LOG.warning("a cell of the sweep failed: %s: %s", type(error).__name__, error)


def tolerance_of_steps(tolerance: float, top: Top) -> float:
    """Return the relative tolerance of the steps of one launch of a sweep.

    On an edge it is that of single runs: near its face the sine of the tilt, on which the motion
    depends, falls far below any other tolerance of the axis, to which that is relative.
    """
    has_edge = any(is_edge(contact.surface) for contact in top.body.contacts)
    return TOLERANCES[DEFAULT] if has_edge else max(tolerance, TOLERANCES[DEFAULT])


def follow(
    begin: tuple[Automaton, State, float],
    start: Transition,
    end: float,
    tolerance: float,
    settled: float | None = None,
    launched: State | None = None,
    sampled: SampledLaunch | None = None,
) -> tuple[Ends, RunMetrics]:
    """Return what a launch comes to, followed from a state, a time and what follows, or until it
    settles.

    `launched` is the state at launch, where that is another. `sampled` has the samples to take.
    """
    automaton, state, time = begin
    top = automaton.top
    method = make_integrator(None, tolerance_of_steps(tolerance, automaton.top))
    trajectory = Trajectory(automaton, start, end, method, time=time)
    run_metrics = RunMetrics(top, launched or state)
    times = np.empty(0) if sampled is None else sampled.samples.times_left(sampled.launch)
    recorder = Recorder(top, state, 0.0, times, start.energy_lost, automaton.pulls)
    if sampled is not None:
        recorder.go_on_from(float(sampled.sums.turn), sampled.pole)
    segments = trajectory.segments()
    segments = segments if settled is None else until_settled(trajectory, segments, settled)
    for block in in_blocks(segments):
        recorder.take(block)
        run_metrics.take(block)
    status = recorder.status_of(trajectory)
    if sampled is not None and np.any(times <= trajectory.time):
        sampled.take(recorder.finish(trajectory.time, trajectory.state, early=False), top)
    if sampled is not None:
        sampled.samples.take_events(sampled.launch, trajectory.events)
    return run_metrics.ends(
        trajectory.state, trajectory.time, status, trajectory.events, recorder.sums
    ), run_metrics


def until_settled(
    trajectory: Trajectory, segments: Iterator[Segment], closeness: float
) -> Iterator[Segment]:
    """Yield the segments of a trajectory up to the first step at whose start the tilt is held."""
    for segment in segments:
        knots, terms = segment.solution.knots, segment.solution.terms
        held = is_held(segment.mode.state(terms[:, :, 0].T), segment.mode.top, closeness)
        if not held.any():
            yield segment
            continue
        count = int(held.argmax())
        last = segment.mode.state(terms[count, :, 0].tolist())
        trajectory.end_at(float(knots[count]), last)
        solution = DenseSolution(knots[: count + 1], terms[:count])
        yield replace(
            segment, solution=solution, end_state=last, mode_end=None, transition=None, steps=count
        )
        return
