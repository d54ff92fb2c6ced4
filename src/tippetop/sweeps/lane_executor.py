"""Many launches followed at once, one a lane, each at its own time and with its own steps.

A lane waits before a step in which something may happen: a guard may fall through zero, the top may
turn over, a band of tilts may be reached. When waiting has cost enough, the lanes that wait are
looked at together, exactly, and go on: after that step if nothing came of it, else where
`tippetop.sweeps.transitions` leads. Lanes at their end are taken out.
"""

import numpy as np

from tippetop.contact.mode import Status
from tippetop.contact.trajectory import STEP_LIMIT
from tippetop.integrators.base import Array
from tippetop.integrators.polynomials import Polynomials
from tippetop.integrators.relief import is_stiff
from tippetop.integrators.taylor import STEPS_PER_ARC
from tippetop.results.metrics import Ends
from tippetop.sweeps.axis_extremes import FORCE
from tippetop.sweeps.lane_arrays import Slots
from tippetop.sweeps.launch_arrays import Checkpoint, Flags, Indices, Launches, picked
from tippetop.sweeps.polynomial_arcs import arcs
from tippetop.sweeps.taylor_step import LANES, is_singular
from tippetop.sweeps.taylor_stepper import LaneStepper
from tippetop.sweeps.trajectory_samples import TrajectorySamples
from tippetop.sweeps.transitions import LaneTransitions
from tippetop.theory.prediction import is_held

LOST = 4.0
"""Steps of all lanes that are lost to waiting, in all, before the lanes that wait are looked at: to
look at some costs Python as much as several steps of all.
"""

WINDOW = 64
"""Steps between checkpoints of the states, from which a part of the run can be done again."""

CROWDED = 0.75
"""Share of lanes at work below which the others are taken out."""


class Lanes:
    """Launches under way, by Taylor's method for sliding tops of their kind, and otherwise alone.

    The tolerance is that of the integrator of launches that are followed alone: relative error per
    step. A launch ends when n_z reaches its own `band`, the least and the largest of shape (n,),
    and once its tilt is held within `settled`, rad. Launches that are not at the start are
    `resumed`: numbers of the motion and times left, shape (size + 1, n). The launches are sampled
    into `samples`, by a stepper for motions that are sampled.
    """

    def __init__(
        self,
        launches: Launches,
        stepper: LaneStepper,
        tolerance: float,
        band: tuple[Array, Array] | None = None,
        resumed: Array | None = None,
        settled: float | None = None,
        samples: TrajectorySamples | None = None,
    ) -> None:
        self.tolerance, self.banded, self.settled = tolerance, band is not None, settled
        self.slots = slots = Slots(launches, stepper, band, samples)
        self.transitions, self.checkpoints = (
            LaneTransitions(slots, tolerance, band is not None),
            list[Checkpoint](),
        )
        self._launched = slots.alive.copy()
        if resumed is None:
            lanes = np.arange(len(slots.cell))
            slots.place(lanes, picked(launches.state, slots.cell), np.zeros(len(lanes)))
            slots.remaining[~slots.alive] = 0.0
            slots.begin_sums()
            self.transitions.launch(lanes[: len(launches)], launches.state)
            slots.look_ahead(lanes)
        else:
            slots.rows[: stepper.layout.remaining + 1] = resumed[:, slots.cell]
            slots.choose_branch()
            slots.remaining[~slots.alive] = 0.0
        slots.numbers[stepper.layout.turns] = np.isnan(slots.tip.turned)

    def run(self) -> Ends:
        """Follow every launch to its end."""
        # Launches that ended in the flight they began with are recorded in the first window.
        recorded, slots = self._launched, self.slots
        while recorded.any():
            window_start, lost, waiting = slots.rows[: slots.layout.carried_rows].copy(), 0, 0
            bearable = LOST * np.count_nonzero(recorded)
            for _ in range(WINDOW):
                waiting += self._stride()
                lost += waiting
                if lost >= bearable:
                    self._resume_waiting()
                    lost = waiting = 0
            self._resume_waiting()
            self._close(recorded, window_start)
            recorded = slots.alive.copy()
        return slots.ends

    def _stride(self) -> int:
        """Take a step on every lane that does not wait; return how many wait from here on."""
        slots, layout = self.slots, self.slots.layout
        slots.to_nearer_pole()
        before, after = slots.rows, slots.spare
        self.slots.stepper.step(before, after, slots.numbers)
        if slots.samples is not None and layout.is_sampled:
            self._sample(slots.samples, before, after)
        waiting = after[layout.pause].nonzero()[0]
        if len(waiting):
            slots.held[waiting] = after[layout.step_time, waiting]
            slots.before[waiting] = before[layout.remaining, waiting]
        slots.tip.put(after[layout.least])
        slots.rows, slots.spare = after, before
        changed = after[layout.changed].nonzero()[0]
        if len(changed):
            slots.change_branch(changed)
        return len(waiting)

    def _sample(self, samples: TrajectorySamples, before: Array, after: Array) -> None:
        """Take the samples within a step of every lane that took one."""
        slots, layout = self.slots, self.slots.layout
        lanes = (after[layout.reached] != 0.0).nonzero()[0]
        if not len(lanes):
            return
        samples.put(slots.cell[lanes], after[layout.sample].take(lanes, axis=1))
        several = slots.look_ahead(lanes) >= after[layout.remaining][lanes]
        if several.any():
            lanes = lanes[several]
            start, end = (
                slots.end[lanes] - rows[layout.remaining, lanes] for rows in (before, after)
            )
            jet = slots.stepper.jet(before[:, lanes], slots.numbers[:, lanes])
            samples.take(slots.cell[lanes], start, jet.state, end)
            slots.look_ahead(lanes)

    def _resume_waiting(self) -> None:
        """Find what happens in the lanes that wait, and let them go on."""
        slots, layout = self.slots, self.slots.layout
        lanes = np.flatnonzero(slots.held > 0.0)
        if not len(lanes):
            return
        remaining, numbers = slots.before[lanes], slots.numbers[:, lanes]
        start = slots.end[lanes] - remaining
        held = slots.held[lanes]
        jet = slots.stepper.jet(slots.rows[:, lanes], numbers)
        followed = arcs(jet, held, held, numbers[layout.pauses])
        closer = followed.look_closer(jet, numbers[layout.counts])
        if len(closer):
            pressing, tip = (
                Polynomials(terms[:, closer], followed.span[closer])
                for terms in (jet.guards[0], jet.state[2])
            )
            slots.tip.take(FORCE, lanes[closer], pressing)
            slots.tip.see(lanes[closer], start[closer], tip)
            followed.least[:, closer] = np.nan
        slots.tip.put_of(lanes, followed.least)
        slots.rows[: layout.size, lanes], span = followed.after, followed.span
        slots.rows[layout.remaining, lanes] = remaining - span
        if slots.samples is not None:
            slots.samples.take(slots.cell[lanes], start, jet.state, slots.time(lanes))
        slots.rows[layout.step_time, lanes] = held
        slots.rows[layout.steps, lanes] += 1
        slots.held[lanes] = 0.0
        some = followed.fallen >= 0.0
        if some.any():
            self.transitions.fall(
                lanes[some], start[some] + span[some], followed.fallen[some].astype(np.intp)
            )
        slots.numbers[layout.turns, lanes] = np.isnan(slots.tip.turned[lanes])
        if slots.samples is not None:
            slots.look_ahead(lanes)
        if self.banded:
            slots.rows[layout.remaining, ~np.isnan(slots.tip.reached)] = 0.0

    def _close(self, recorded: Flags, window_start: Array) -> None:
        """End a window: record it, take out what has ended, and close ranks."""
        slots, layout = self.slots, self.slots.layout
        cells, (_, down, up) = slots.cell[recorded], slots.tip.lately[:, recorded]
        if not self.banded:
            self.checkpoints.append(
                Checkpoint(cells, window_start[: layout.remaining + 1, recorded], down, -up)
            )
        slots.tip.put_aside()
        ended = np.flatnonzero(slots.alive & (slots.remaining <= 0.0))
        if len(ended):
            slots.retire(ended, slots.states(ended), slots.end[ended], Status.COMPLETED)
        singular = is_singular(slots.rows[layout.step_time], slots.remaining)
        many = slots.rows[layout.steps] >= STEP_LIMIT
        for lost, status in (
            (singular, Status.FAILED),
            (~singular & many, Status.TOO_MANY_STEPS),
        ):
            which = np.flatnonzero(slots.alive & lost)
            slots.retire(which, slots.states(which), slots.time(which), status)
        if self.settled is not None:
            self._end_the_settled(self.settled)
        self._relieve(np.flatnonzero(recorded & slots.alive), window_start)
        working = np.flatnonzero(slots.alive)
        if len(working) and len(working) + LANES < CROWDED * len(slots.alive):
            slots.keep(working)

    def _relieve(self, lanes: Indices, window_start: Array) -> None:
        """Have launches whose motion is stiff, which is looked at now and then, followed alone."""
        slots, layout = self.slots, self.slots.layout
        steps = slots.rows[layout.steps, lanes]
        steps_taken = steps - window_start[layout.steps, lanes]
        arc_ends = steps // STEPS_PER_ARC > (steps - steps_taken) // STEPS_PER_ARC
        lanes, steps_taken = lanes[arc_ends], steps_taken[arc_ends]
        if not len(lanes):
            return
        step = (window_start[layout.remaining, lanes] - slots.remaining[lanes]) / steps_taken
        motion, numbers = self.transitions.motion, slots.numbers[: layout.parameters, lanes]
        stiff = is_stiff(motion, list(numbers), slots.rows[: motion.size, lanes].T, step)
        self.transitions.follow_alone(lanes[stiff])

    def _end_the_settled(self, closeness: float) -> None:
        """End the launches whose tilt is held."""
        slots = self.slots
        lanes = np.flatnonzero(slots.alive)
        if not len(lanes):
            return
        state = slots.states(lanes)
        held = is_held(state, slots.launches.tops(slots.cell[lanes]), closeness)
        slots.retire(lanes[held], picked(state, held), slots.time(lanes[held]), Status.COMPLETED)


def arrivals(followed: Lanes, band: tuple[Array, Array]) -> Array:
    """First times at which n_z is in a band, shape (n,); nan where it never is while a lane slides
    or flies.

    The window in which that happens is known from the checkpoints; it is done again, up to that
    moment.
    """
    slots = followed.slots
    launches, size = slots.launches, slots.layout.size
    count = len(launches)
    window = np.full(count, -1)
    rows = np.zeros((size + 1, count))
    low, high = band
    for index, checkpoint in enumerate(followed.checkpoints):
        meets = (checkpoint.down <= high[checkpoint.cells]) & (
            checkpoint.up >= low[checkpoint.cells]
        )
        fresh = meets & (window[checkpoint.cells] < 0)
        window[checkpoint.cells[fresh]] = index
        rows[:, checkpoint.cells[fresh]] = checkpoint.rows[:, fresh]
    times = np.full(count, np.nan)
    for first in (True, False):
        which = np.flatnonzero((window == 0) if first else (window > 0))
        if len(which):
            again = launches.some(which)
            edges, resumed = (low[which], high[which]), None if first else rows[:, which]
            lanes = Lanes(again, slots.stepper, followed.tolerance, edges, resumed)
            times[which] = lanes.run().arrived
    return times
