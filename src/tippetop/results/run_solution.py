"""Dense solution of a run: its state, and all its variables, at any time."""

from collections.abc import Sequence
from typing import Literal

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from tippetop.contact.block import Block
from tippetop.contact.mode import Segment
from tippetop.contact.natural_launch import NaturalLaunch, initial_mode
from tippetop.contact.readings import Instants, instants, read
from tippetop.integrators.base import Array
from tippetop.integrators.dense import parts_of
from tippetop.mechanics.motion import angular_velocity
from tippetop.mechanics.surfaces.hull import outer_height
from tippetop.problem.launch import Launch
from tippetop.problem.problem import Problem, top_of
from tippetop.results.catalogue import LISTED, METRICS, MONITORS
from tippetop.results.checked_times import sample_times
from tippetop.results.dataset import assemble
from tippetop.results.derived import variables_of
from tippetop.results.motion_state import MotionState, states_in
from tippetop.results.observables import Recorder
from tippetop.support.errors import InvalidInput
from tippetop.support.suggestions import not_one_of

SPACINGS = 4.0
"""Rounding of the time of an event in natural units that is turned to seconds and back, in spacings
of doubles: each turn rounds twice. With less, a state may be that on the other side of the event.
"""


class RunSolution:
    """Solution of a run at any time, as accurate as its samples.

    ``solution(t)`` is the state at a time, or at several: a `tippetop.extend.MotionState` in SI.
    `simulate` returns it with the run if ``dense=True``.

    Attributes
    ----------
    run
        The run.
    end_time
        Time at which the solution ends, s.

    Examples
    --------
    >>> import tippetop as tt
    >>> run, solution = tt.simulate(tt.presets.report_problem(), duration=20.0, dense=True)
    >>> level = solution(float(run["turnover_time"]))
    >>> bool(abs(level.axis[2]) < 1e-13)
    True
    >>> solution([1.0, 2.0]).axis.shape
    (3, 2)
    >>> solution.sample([1.0, 2.0])["tilt"].sizes["time"]
    2
    """

    def __init__(self, begin: NaturalLaunch, segments: Sequence[Segment], run: xr.Dataset) -> None:
        self.run, self.end_time = run, float(run["end_time"])
        self._begin, self._block = begin, Block(segments)

    def __call__(
        self, times: ArrayLike, *, side: Literal["left", "right"] = "right"
    ) -> MotionState:
        """Return the state at a time, s, or the states at several, shape (n,).

        Parameters
        ----------
        times
            The times.
        side
            Which of two states is returned at the time of an event at which the state jumps, such
            as an impact: that after it, "right", or that before it, "left". At the end of the run
            it is that before, in any case. Times closer than rounding to that of an event are its
            time.

        Raises
        ------
        InvalidInput
            If a time is no number, or outside the run, or the side is none.
        """
        if side not in ("left", "right"):
            raise not_one_of("side", side, ("left", "right"))
        accepted = f"a time from 0 to the end of the run, {self.end_time:g} s, or a list of them"
        try:
            seconds = np.array(times, dtype=float)
        except (TypeError, ValueError):
            raise InvalidInput("times", times, accepted) from None
        if seconds.ndim > 1 or not np.all((seconds >= 0.0) & (seconds <= self.end_time)):
            raise InvalidInput("times", times, accepted)
        with np.errstate(all="ignore"):
            states = self._states(np.atleast_1d(seconds), side)
        return next(states.each()) if seconds.ndim == 0 else states

    def _states(self, seconds: Array, side: Literal["left", "right"]) -> MotionState:
        """Return the states at times, s, shape (n,)."""
        block, begin = self._block, self._begin
        if not len(block.starts):
            mode, numbers = initial_mode(begin.state, begin.top)
            rows = read(instants, mode, np.repeat(np.array([numbers]).T, len(seconds), axis=1))
            return MotionState.of(seconds, Instants.unpack(rows), begin.units)
        times = np.minimum(seconds / begin.units.time, block.ends[-1])
        # An event's time in seconds is rounded, and so is what is made of it here.
        rounding = SPACINGS * np.spacing(times)
        after = times + rounding if side == "right" else times - rounding
        step = np.minimum(np.searchsorted(block.ends, after, side=side), len(block.ends) - 1)
        part = np.clip(parts_of(times, block.starts[step], block.ends[step]), 0.0, 1.0)
        return states_in(block, step, part, begin.units, seconds)

    def problem_at(self, time: float) -> Problem:
        """Return the problem that is launched in the state at a time, s.

        Its run continues the motion of this run. As for every launch, time begins at 0, the
        position at the origin, and the marker lies in the plane of axis and vertical.

        Raises `InvalidInput` if the time is no number, or outside the run.

        Examples
        --------
        >>> import tippetop as tt
        >>> run, solution = tt.simulate(tt.presets.report_problem(155.0), 20.0, dense=True)
        >>> later = tt.simulate(solution.problem_at(2.0), duration=18.0)
        >>> bool(abs(later["turnover_time"] + 2.0 - run["turnover_time"]) < 1e-9)
        True
        """
        state = self(time)
        if np.ndim(state.time) > 0:
            raise InvalidInput("time", time, "one time")
        problem = Problem.from_json(self.run.attrs["problem"])
        axis, top = tuple(state.axis.tolist()), top_of(problem)
        flies = state.normal_force == 0.0
        x, y, z = state.velocity.tolist()
        gap = state.height - float(outer_height(top.surface, axis[2]))
        launch = Launch.from_angular_velocity(
            angular_velocity(axis, tuple(state.angular_momentum.tolist()), top),
            tilt=state.tilt,
            azimuth=state.azimuth,
            velocity=(x, y, z if flies else 0.0),
            gap=max(gap, 0.0) if flies else 0.0,
        )
        return problem.replace({"launch": launch})

    @np.errstate(all="ignore")
    def sample(self, times: ArrayLike) -> xr.Dataset:
        """Return the run with all variables sampled at other times.

        Parameters
        ----------
        times
            Increasing times, s, from 0 to the end of the run.

        Raises
        ------
        InvalidInput
            If the times are not increasing, or outside the run.
        """
        seconds = sample_times(self.end_time, 2, np.atleast_1d(times))
        begin, block = self._begin, self._block
        end = block.ends[-1] if len(block.starts) else 0.0
        recorder = Recorder.of(begin, np.minimum(seconds / begin.units.time, end))
        recorder.take(block)
        samples = recorder.finish(end, begin.state, early=False)
        run = self.run
        return assemble(
            seconds,
            variables_of(begin, samples),
            (samples.mode, recorder.modes),
            {name: run[name].values for name in ("outcome", *METRICS, *MONITORS)},
            {name: run[name].values for name in LISTED},
            run.attrs,
        )
