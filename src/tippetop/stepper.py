"""A run in steps of one's own, for learning environments and controllers: `Stepper`."""

from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from tippetop.contact.block import Block, in_blocks
from tippetop.contact.contact_mode import ContactMode
from tippetop.contact.flight import Flight, Start
from tippetop.contact.mode import Mode, Status, Transition
from tippetop.contact.natural_launch import NaturalLaunch
from tippetop.contact.trajectory import LONGEST_RUN, Trajectory
from tippetop.graph.own_parts import require_recordable
from tippetop.integrators import make_integrator
from tippetop.integrators.base import Array
from tippetop.mechanics.quadratures import nearer_pole, orientation, turn_at_launch
from tippetop.mechanics.vectors import add
from tippetop.problem.problem import Problem, require_problem, top_of
from tippetop.results.motion_state import MotionState
from tippetop.results.observables import Recorder
from tippetop.results.samples import Samples
from tippetop.support.errors import InvalidInput, is_number
from tippetop.support.units import number_in


class StepState(NamedTuple):
    """Where a top is after a step, in SI units.

    Examples
    --------
    >>> import tippetop as tt
    >>> stepper = tt.Stepper(tt.presets.report_problem())
    >>> after = stepper.step(0.01)
    >>> after.mode, after.status.name, bool(after.state.tilt > 0.09)
    ('sliding', 'COMPLETED', True)
    """

    time: float
    """Time since the reset, s."""
    state: MotionState
    """Axis, angular momentum, velocity and what follows from them; its `time` is that above."""
    position: Array
    """Position of the centre of mass, m, shape (3,): x and y are 0 at the reset."""
    orientation: Array
    """Orientation as a unit quaternion, scalar first, shape (4,): it turns vectors from the body
    frame to the table's.
    """
    mode: str
    """The contact mode at the end of the step."""
    events: tuple[tuple[float, str], ...]
    """Times, s, and kinds of the events in the step."""
    status: Status
    """`Status.COMPLETED` while the top moves; else why it does not go on."""


class Stepper:
    """A top that is followed in steps, each as accurate as a run.

    A step carries position, orientation and time over from the one before. It is the motion of a
    run, whose events are found within steps of any length. The first step compiles the equations.

    Parameters
    ----------
    problem
        The problem, whose launch is that of `reset`.
    tolerance
        Relative error per step of the integration; by default that of `simulate`.

    Raises
    ------
    InvalidInput
        If the problem is none, or the tolerance is out of range.

    Examples
    --------
    >>> import tippetop as tt
    >>> stepper = tt.Stepper(tt.presets.report_problem(spin=155.0))
    >>> start = stepper.reset()
    >>> for _ in range(100):
    ...     now = stepper.step(0.01)
    >>> run = tt.simulate(stepper.problem, duration=1.0, samples=2)
    >>> bool(abs(now.state.tilt - run["tilt"][-1]) < 1e-9)
    True
    >>> round(now.time, 12), now.mode, now.position.shape
    (1.0, 'sliding', (3,))
    >>> pushed = stepper.step(0.01, nudge=(1e-3, 0.0, 0.0))  # N s, along x
    """

    def __init__(self, problem: Problem, *, tolerance: float | None = None) -> None:
        require_problem(problem)
        require_recordable(top_of(problem))
        self._integrator = make_integrator(None, tolerance)
        self.reset(problem)

    @property
    def problem(self) -> Problem:
        """The problem whose launch `reset` begins with."""
        return self._problem

    def reset(self, problem: Problem | None = None) -> StepState:
        """Begin anew with the launch of the problem, or of another one, and return it."""
        if problem is not None:
            require_problem(problem)
            require_recordable(top_of(problem))
            self._problem = problem
        self._launch = launch = NaturalLaunch.of(self._problem)
        self._next, self._state, self._time = launch.first, launch.state, 0.0
        self._pole = float(nearer_pole(launch.state.axis[2]))
        self._turn, self._place = turn_at_launch(launch.azimuth, self._pole), (0.0, 0.0)
        recorder = self._recorder(0.0)
        return self._step_state(recorder.finish(0.0, launch.state, early=True), recorder, (), 0.0)

    @np.errstate(all="ignore")
    def step(
        self, dt: float, *, nudge: ArrayLike | None = None, twist: ArrayLike | None = None
    ) -> StepState:
        """Follow the top for a time, and return where it is then.

        Parameters
        ----------
        dt
            The time, s.
        nudge
            Impulse on the centre of mass at the beginning of the step, N s, shape (3,) in the
            table's frame; none if omitted.
        twist
            Angular impulse about the centre of mass then, N m s, shape (3,); none if omitted.

        Raises
        ------
        InvalidInput
            If the time is not positive, or an impulse is no three numbers.
        """
        seconds = number_in("dt", dt, "s")
        units = self._launch.units
        if not (is_number(seconds) and 0.0 < seconds < LONGEST_RUN * units.time):
            raise InvalidInput("dt", dt, "a number of seconds greater than 0")
        if nudge is not None or twist is not None:
            self._push(nudge, twist)
        begin, end = self._time, self._time + float(seconds) / units.time
        start = Transition((), self._next.next, self._state)
        events = list(self._next.events)
        if not isinstance(start.next, Mode):  # At rest a top stays, until it is pushed.
            self._time = end
            recorder = self._recorder(end)
            samples = recorder.finish(end, self._state, early=True)
            return self._step_state(samples, recorder, (), end)
        trajectory = Trajectory(self._launch.automaton, start, end, self._integrator, time=begin)
        recorder = self._recorder(end)
        last: Mode = start.next
        for block in in_blocks(trajectory.segments()):
            recorder.take(Block(block.segments, is_one_of_many=True))
            last = block.segments[-1].mode
        status = recorder.status_of(trajectory)
        early = status is not Status.COMPLETED
        samples = recorder.finish(trajectory.time, trajectory.state, early)
        self._state, self._time = trajectory.state, end
        self._next = Transition((), status, self._state) if early else self._continued(last)
        reported = [*events, *trajectory.events]
        kinds = tuple((event.time * units.time, event.kind.value) for event in reported)
        return self._step_state(samples, recorder, kinds, end)

    def _push(self, nudge: ArrayLike | None, twist: ArrayLike | None) -> None:
        """Change the velocity and the angular momentum, and launch the top from there."""
        units, state = self._launch.units, self._state
        impulse = _vector("nudge", nudge) / (units.mass * units.speed)
        torque = _vector("twist", twist) / units.angular_momentum
        velocity = add(state.velocity, tuple(impulse / self._launch.top.mass))
        self._state = state._replace(velocity=velocity, momentum=add(state.momentum, tuple(torque)))
        follows = self._launch.automaton.launch(self._state)
        events = tuple(replace(event, time=self._time) for event in follows.events)
        self._next, self._state = Transition(events, follows.next, follows.state), follows.state

    def _continued(self, mode: Mode) -> Transition:
        """Return how the next step begins after one that ended in a mode."""
        if isinstance(mode, ContactMode):
            return Transition((), mode, self._state)
        if isinstance(mode, Flight):
            return Transition((), Flight(mode.top, Start.AIRBORNE), self._state)
        follows = self._launch.automaton.launch(self._state)
        return Transition((), follows.next, follows.state)  # its events have been told

    def _recorder(self, end: float) -> Recorder:
        """Return a recorder that goes on from where the last one ended, with a sample at `end`."""
        pulls = self._launch.automaton.pulls
        recorder = Recorder(self._launch.top, self._state, 0.0, np.array([end]), pulls=pulls)
        recorder.go_on_from(self._turn, self._pole)
        return recorder

    def _step_state(
        self,
        samples: Samples,
        recorder: Recorder,
        events: tuple[tuple[float, str], ...],
        time: float,
    ) -> StepState:
        """Return what is observed in the last sample, from which the next step goes on."""
        units, instants = self._launch.units, samples.instants
        state = list(
            MotionState.of(samples.times * 0.0 + time * units.time, instants, units).each()
        )
        sums = recorder.sums
        turned = orientation(instants.state.axis, samples.sums.turn, samples.pole, np)
        self._place = self._place[0] + sums.x, self._place[1] + sums.y
        self._turn, self._pole = sums.turn, recorder.pole
        place = [*(units.length * number for number in self._place), state[-1].height]
        following = self._next.next
        status = following if isinstance(following, Status) else Status.COMPLETED
        return StepState(
            time * units.time,
            state[-1],
            np.array(place),
            np.array([part[-1] for part in turned]),
            recorder.modes[int(samples.mode[-1])],
            events,
            status,
        )


def _vector(field: str, value: Any) -> Array:
    """Return an impulse, shape (3,); zero for None."""
    try:
        vector = np.array((0.0, 0.0, 0.0) if value is None else value, dtype=float)
    except (TypeError, ValueError):
        raise InvalidInput(field, value, "three finite numbers") from None
    if vector.shape != (3,) or not np.all(np.isfinite(vector)):
        raise InvalidInput(field, value, "three finite numbers")
    return vector
