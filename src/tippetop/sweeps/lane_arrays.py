"""The arrays of launches under way: one lane a launch."""

import numpy as np

from tippetop.contact.mode import Status
from tippetop.integrators.base import Array
from tippetop.mechanics.contacts.branches import is_branched
from tippetop.mechanics.motion import along_table, on_table
from tippetop.mechanics.state import SlidingState, State
from tippetop.mechanics.top import Top
from tippetop.results.accumulation import accumulate, before_launch
from tippetop.results.metrics import STATUSES
from tippetop.sweeps.axis_extremes import TipMotion
from tippetop.sweeps.launch_arrays import Flags, Indices, Launches, branched
from tippetop.sweeps.taylor_step import LANES, SLIDING
from tippetop.sweeps.taylor_stepper import LaneStepper
from tippetop.sweeps.trajectory_samples import TrajectorySamples

HELD_BY_LANES = {"time", "status", "steps", "turned", "arrived"}
"""Quantities that lanes hold themselves until their launches end."""


class Slots:
    """Lanes, and what is kept of each; all of shape (n,) or (rows, n).

    Attributes
    ----------
    ends
        How the launches ended.
    cell
        Which launch is on the lane.
    alive
        Whether it is under way: lanes beyond the launches only fill up.
    end
        When its run ends.
    numbers
        The parameters of the motion and what to pause for.
    rows, spare
        What a step brings up to date, and room for the next.
    held, before
        The step that a lane waits before, 0 if it does not wait, and the time left before it.
    tip
        How the tip of the axis moves.
    samples
        The samples of the launches, if they are sampled.
    """

    def __init__(
        self,
        launches: Launches,
        stepper: LaneStepper,
        band: tuple[Array, Array] | None,
        samples: TrajectorySamples | None = None,
    ) -> None:
        count, layout = len(launches), stepper.layout
        lanes = count + -count % LANES
        self.launches, self.stepper, self.layout = launches, stepper, layout
        self.samples = samples
        self.ends, self.tip = before_launch(count), TipMotion.of(lanes)
        self.cell: Indices = np.minimum(np.arange(lanes), count - 1)
        self.alive, self.end = np.arange(lanes) < count, launches.end[self.cell]
        pauses = np.zeros((layout.numbers - layout.parameters, lanes))
        self.numbers = np.concatenate((launches.numbers[:, self.cell], pauses))
        self.numbers[layout.counts], self.numbers[layout.turns] = 1.0, 1.0
        # The first guard is of lift-off.
        self.numbers[layout.counts.start] = float(launches.liftoff != "ignore")
        self.numbers[layout.band] = np.array([[np.inf], [-np.inf]])
        if band is not None:
            self.tip.low, self.tip.high = band[0][self.cell], band[1][self.cell]
            self.numbers[layout.band] = self.tip.low, self.tip.high
        self.look_ahead(np.arange(lanes))
        self.rows, self.spare = np.zeros((2, layout.rows, lanes))
        self.held, self.before = np.zeros((2, lanes))

    @property
    def remaining(self) -> Array:
        """The time left."""
        times: Array = self.rows[self.layout.remaining]
        return times

    @property
    def sums(self) -> Array:
        """The numbers of the sums, a view of shape (sums, n)."""
        sums: Array = self.rows[SLIDING : self.layout.size]
        return sums

    def begin_sums(self) -> None:
        """Let the sums begin at launch."""
        if self.samples is not None:
            azimuth = self.samples.azimuths[self.cell]
            self.stepper.sums.begin(self.rows, self.sums, azimuth)

    def to_nearer_pole(self) -> None:
        """Take the angles about the axis to the chart of the nearer pole."""
        self.stepper.sums.to_nearer_pole(self.rows, self.sums)

    def strike(self, lanes: Indices, lost: Array) -> None:
        """Take in the energy that some lanes lose in impacts, shape (k,)."""
        accumulate(self.ends, self.cell[lanes], struck=lost)
        self.stepper.sums.strike(self.sums, lanes, lost)

    def time(self, lanes: Indices | Flags) -> Array:
        """Return the time of some lanes."""
        times: Array = self.end[lanes] - self.remaining[lanes]
        return times

    def look_ahead(self, lanes: Indices) -> Array:
        """Put down and return the times left at the next samples of some lanes."""
        due = np.inf if self.samples is None else self.samples.due[self.cell[lanes]]
        time_left: Array = self.end[lanes] - due
        if self.layout.is_sampled:
            self.numbers[self.layout.due][lanes] = time_left
        return time_left

    def keep(self, working: Indices) -> None:
        """Keep the lanes at work, and as many others as fill them up."""
        missing = -len(working) % LANES
        retained = np.concatenate((working, np.full(missing, working[-1], dtype=np.intp)))
        self.alive = np.arange(len(retained)) < len(working)
        for name in ("cell", "end", "held", "before"):
            setattr(self, name, getattr(self, name)[retained])
        for name in ("numbers", "rows"):
            setattr(self, name, np.ascontiguousarray(getattr(self, name)[:, retained]))
        self.rows[self.layout.remaining] *= self.alive
        self.spare = np.zeros_like(self.rows)
        self.tip = self.tip.some(retained)

    def tops(self, lanes: Indices | Flags) -> Top:
        """Return some of the tops, with arrays for numbers."""
        return self.launches.kind.top(tuple(self.numbers[: self.layout.parameters, lanes]))

    def states(self, lanes: Indices | Flags) -> State:
        """Whole states of sliding tops."""
        numbers = self.rows[: self.layout.size, lanes]
        return on_table(SlidingState.unpack(numbers), self.tops(lanes))

    def place(self, lanes: Indices, state: State, time: Array) -> None:
        """Let tops slide from these states on."""
        for row, number in enumerate(along_table(state).pack()):
            self.rows[row, lanes] = number
        self.rows[self.layout.remaining, lanes] = self.end[lanes] - time
        self.rows[self.layout.step_time, lanes] = np.inf
        if is_branched(self.launches.kind.example.friction):
            self._put(lanes, branched(self.tops(lanes), state))

    def choose_branch(self) -> None:
        """Let tops that slide on somewhere on their way follow the branch of their law that holds
        there.
        """
        if is_branched(self.launches.kind.example.friction):
            lanes = np.arange(len(self.cell))
            self._put(lanes, branched(self.tops(lanes), self.states(lanes)))

    @property
    def branch(self) -> int:
        """Row of the number, 0 or 1, that tells the branch of the law."""
        return self.launches.kind.body_count

    def change_branch(self, lanes: Indices) -> None:
        """Let tops slide on along the other branch of their law."""
        branches = self.numbers[self.branch]
        branches[lanes] = 1.0 - branches[lanes]

    def _put(self, lanes: Indices, top: Top) -> None:
        """Let tops on some lanes have these tops' law."""
        for row, number in enumerate(top.branch_numbers, start=self.branch):
            self.numbers[row, lanes] = number

    def retire(self, lanes: Indices, state: State, time: Array, status: Status) -> None:
        """Put down how launches ended."""
        if not len(lanes):
            return
        ends, cells = self.ends, self.cell[lanes]
        if self.samples is not None:
            self.samples.take_last(cells, state, time, self.sums[:, lanes])
        fine = np.all(np.isfinite(np.array(np.broadcast_arrays(*state.pack()))), axis=0)
        stayed = np.isnan(ends.lift_off[cells]) & (ends.flights[cells] == 0)
        force, down, up = self.tip.least[:, lanes]
        accumulate(
            ends,
            cells,
            state,
            time=time,
            status=np.where(fine, STATUSES.index(status), STATUSES.index(Status.FAILED)),
            steps=self.rows[self.layout.steps, lanes],
            turned=self.tip.turned[lanes],
            arrived=self.tip.reached[lanes],
            least_force=np.where(stayed, force, 0.0),
            down=down,
            up=-up,
        )
        if self.stepper.sums.count:
            sums = self.stepper.sums.run_sums(self.sums[:, lanes])
            drilled, rolled, braked = sums.losses
            descended = sums.descent_work(self.tops(lanes))
            parts = {"drilled": drilled, "rolled": rolled, "braked": braked}
            accumulate(ends, cells, **parts, descended=descended)
        self.rows[self.layout.remaining, lanes] = 0.0
        self.alive[lanes] = False
