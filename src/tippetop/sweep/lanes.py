"""Many launches followed at once, one a lane, each at its own time and with its own steps.

A lane waits before a step in which something may happen: the table may let go, the top may turn over, a band
of tilts may be reached. Every few steps the lanes that wait are looked at together, exactly, and go on: after
that step if nothing came of it, from where they land if the top flew. Lanes at their end are taken out.
"""

import numpy as np

from tippetop.integrators.base import Array
from tippetop.mechanics.flight import gap, gap_rate
from tippetop.mechanics.motion import along_table, on_table
from tippetop.mechanics.state import SlidingState, State
from tippetop.mechanics.top import Top
from tippetop.mechanics.touchdown import Start
from tippetop.phases import EventKind, Outcome, Transition, first_phase
from tippetop.phases.contact import FreeToFly
from tippetop.phases.flight import Flight
from tippetop.phases.start import TOUCHING
from tippetop.sweep.courses import OUTCOMES, Ends, Launches, Note
from tippetop.sweep.hops import Flags, collide, hop, picked, slides
from tippetop.sweep.polynomials import Polynomials
from tippetop.sweep.stepper import (
    BAND_HIGH,
    BAND_LOW,
    CARES,
    DOWN,
    LANES,
    LEFT,
    LETS_GO,
    LOW,
    PAUSE,
    ROWS,
    SIZE,
    STEPS,
    TAKEN,
    TURNS,
    UP,
    Stepper,
)
from tippetop.sweep.watch import Indices, Watch
from tippetop.theory.prediction import is_held

WAVE = 8
"""Steps between looks at the lanes that wait."""

WINDOW = 64
"""Steps between notes of the states, from which a part of the run can be done again."""

STEP_LIMIT = 2_000_000
"""Steps after which a launch is given up."""

FLIGHT_LIMIT = 50_000
"""Flights after which a launch is given up."""

SHORTEST = 1e-13
"""Step, in natural units, below which a motion counts as singular."""

CROWDED = 0.75
"""Share of lanes at work below which the others are taken out."""


class Lanes:
    """Launches under way.

    Parameters
    ----------
    launches
        What is launched.
    stepper
        Taylor's method for tops of their kind.
    band
        Least and largest n_z of a band, each of shape (n,); a launch ends when it reaches its own.
    resumed
        States and times left, shape (SIZE + 1, n), where the launches are not at their beginning.
    settled
        A launch ends once its tilt is held within this, rad; None for none.
    """

    def __init__(
        self,
        launches: Launches,
        stepper: Stepper,
        band: tuple[Array, Array] | None = None,
        resumed: Array | None = None,
        settled: float | None = None,
    ) -> None:
        count = len(launches)
        lanes = count + -count % LANES
        filled = np.minimum(np.arange(lanes), count - 1)
        self.launches, self.stepper, self.banded = launches, stepper, band is not None
        self.settled = settled
        self.ends = Ends.unknown(count)
        self.notes: list[Note] = []
        self.cell = filled
        self.alive = np.arange(lanes) < count
        self.launched = self.alive.copy()
        self.numbers = np.concatenate((launches.numbers[:, filled], np.full((CARES, lanes), np.nan)))
        self.end = launches.end[filled]
        self.rows, self.spare = np.zeros((ROWS, lanes)), np.zeros((ROWS, lanes))
        self.held, self.kept = np.zeros(lanes), np.zeros(lanes)
        self.low_step, self.low_from = np.zeros(lanes), np.zeros((SIZE, lanes))
        self.reached = np.full(count, np.nan)
        self.watch = Watch.of(lanes)
        if band is not None:
            self.watch.low, self.watch.high = band[0][filled], band[1][filled]
        self.rows[LOW], self.rows[DOWN], self.rows[UP] = np.inf, np.inf, -np.inf
        self.cares[LETS_GO], self.cares[TURNS] = self.leaves, 1.0
        self.cares[BAND_LOW], self.cares[BAND_HIGH] = np.inf, -np.inf
        if self.banded:
            self.cares[BAND_LOW], self.cares[BAND_HIGH] = self.watch.low, self.watch.high
        if resumed is not None:
            self.rows[: LEFT + 1] = resumed[:, filled]
            self.rows[LEFT] *= self.alive
        else:
            state = picked(launches.state, filled)
            self._place(np.arange(lanes), state, np.zeros(lanes))
            self.rows[LEFT] *= self.alive
            self._begin(np.flatnonzero(self.alive), picked(state, self.alive))
        self.low_from[:] = self.rows[:SIZE]
        self.cares[TURNS] = np.isnan(self.watch.turned)

    @property
    def cares(self) -> Array:
        """What the lanes pause for, shape (CARES, n)."""
        return self.numbers[self.launches.kind.numbers :]

    @property
    def leaves(self) -> bool:
        """Whether the table lets go."""
        return self.launches.liftoff != "ignore"

    def run(self) -> Ends:
        """Follow every launch to its end."""
        # Launches that ended in the flight they began with are noted in the first window.
        noted = self.launched
        while noted.any():
            begun = self.rows[: LEFT + 1].copy()
            for _ in range(WINDOW // WAVE):
                for _ in range(WAVE):
                    self._stride()
                self._look()
            self._close(noted, begun)
            noted = self.alive.copy()
        return self.ends

    def _stride(self) -> None:
        """Take a step on every lane that does not wait."""
        before, after = self.rows, self.spare
        self.stepper.step(before, after, self.numbers)
        waiting = after[PAUSE].nonzero()[0]
        if len(waiting):
            self.held[waiting], self.kept[waiting] = after[TAKEN, waiting], before[LEFT, waiting]
        lower = (after[LOW] < before[LOW]).nonzero()[0]
        if len(lower):
            self.low_step[lower], self.low_from[:, lower] = after[TAKEN, lower], before[:SIZE, lower]
        self.rows, self.spare = after, before

    def _look(self) -> None:
        """Look at the lanes that wait, and let them go on."""
        lanes = np.flatnonzero(self.held > 0.0)
        if not len(lanes):
            return
        span, left = self.held[lanes], self.kept[lanes]
        begun = self.end[lanes] - left
        jet = self.stepper.jet(self.rows[:, lanes], self.numbers[:, lanes])
        off = np.zeros(len(lanes), dtype=bool)
        if self.leaves:
            fall = Polynomials(jet.force, span).first_fall()
            off = ~np.isnan(fall)
            span = np.where(off, fall, span)
        least = Polynomials(jet.force, span).least()
        lower = least < self.rows[LOW, lanes]
        self.rows[LOW, lanes[lower]], self.low_step[lanes[lower]] = least[lower], span[lower]
        self.low_from[:, lanes[lower]] = self.rows[:SIZE, lanes[lower]]
        self.watch.see(lanes, begun, Polynomials(jet.state[2], span))
        self.rows[:SIZE, lanes] = jet.at(span)
        self.rows[LEFT, lanes], self.rows[TAKEN, lanes] = left - span, self.held[lanes]
        self.rows[STEPS, lanes] += 1
        self.held[lanes] = 0.0
        if off.any():
            self._let_go(lanes[off], begun[off] + span[off])
        self.cares[TURNS, lanes] = np.isnan(self.watch.turned[lanes])
        if self.banded:
            self.rows[LEFT, ~np.isnan(self.watch.reached)] = 0.0

    def _let_go(self, lanes: Indices, time: Array) -> None:
        """What follows where the normal force falls to zero."""
        cells = self.cell[lanes]
        self.ends.lift_off[cells] = np.fmin(self.ends.lift_off[cells], time)
        state = self._whole(lanes)
        if self.launches.liftoff == "stop":
            self._retire(lanes, state, time, Outcome.LIFTED_OFF)
        else:
            self._fly(lanes, state, time, np.full(len(lanes), int(Start.LIFT_OFF), dtype=np.intp))

    def _fly(self, lanes: Indices, state: State, time: Array, vanishing: Indices) -> None:
        """Fly, collide, and fly again, until the tops slide or their runs end."""
        ends, kind = self.ends, self.launches.kind
        while len(lanes):
            cells = self.cell[lanes]
            horizon = self.end[lanes] - time
            numbers = self.numbers[: kind.numbers, lanes]
            flown = hop(state, kind, numbers, horizon, vanishing, (self.watch, lanes, time))
            ends.flights[cells] += 1
            ends.airborne[cells] += flown.duration
            ends.highest_gap[cells] = np.fmax(ends.highest_gap[cells], flown.highest_gap)
            ends.highest[cells] = np.fmax(ends.highest[cells], flown.highest)
            over = ~flown.landed & (flown.duration >= horizon)
            time = np.where(over, self.end[lanes], time + flown.duration)
            self._retire(lanes[over], picked(flown.state, over), time[over], Outcome.COMPLETED)
            spent = ~over & (~flown.landed | (ends.flights[cells] >= FLIGHT_LIMIT))
            self._retire(lanes[spent], picked(flown.state, spent), time[spent], Outcome.TOO_MANY_PHASES)
            landed = flown.landed & ~spent
            lanes, time, state = lanes[landed], time[landed], picked(flown.state, landed)
            lanes, state, time, vanishing = self._land(lanes, state, time)

    def _land(self, lanes: Indices, state: State, time: Array) -> tuple[Indices, State, Array, Indices]:
        """Collide with the table; return the lanes that fly again, as `_fly` takes them."""
        kind, restitution = self.launches.kind, self.launches.restitution[self.cell[lanes]]
        top = self._top(lanes)
        after, struck = collide(state, top)
        sliding = struck & (restitution == 0.0) & slides(after, top)
        self._place(lanes[sliding], picked(after, sliding), time[sliding])
        again: list[int] = []
        starts: list[int] = []
        for i in np.flatnonzero(~sliding):
            rule = FreeToFly(
                kind, tuple(self.numbers[: kind.numbers, lanes[i]].tolist()), float(restitution[i])
            )
            here = np.array(picked(state, np.array([i])).pack())[:, 0]
            transition = rule.touchdown(float(time[i]), here)
            if self._enter(lanes[i], float(time[i]), transition):
                again.append(int(i))
                starts.append(int(transition.then.start))  # type: ignore[union-attr]
                for number, value in zip(state.pack(), transition.state, strict=True):
                    number[i] = value
        which = np.array(again, dtype=np.intp)
        return lanes[which], picked(state, which), time[which], np.array(starts, dtype=np.intp)

    def _begin(self, lanes: Indices, state: State) -> None:
        """Sort the launches out that do not simply slide from the start."""
        if not self.leaves:
            return
        launches, kind, top = self.launches, self.launches.kind, self.launches.top
        plain = slides(state, top)
        if launches.liftoff == "fly":
            plain &= (gap(state, top) <= TOUCHING) & (np.abs(gap_rate(state, top)) <= TOUCHING)
        again, starts, states = [], [], []
        for i in np.flatnonzero(~plain):
            numbers = tuple(self.numbers[: kind.numbers, lanes[i]].tolist())
            here = np.array(picked(state, np.array([i])).pack())[:, 0]
            restitution = float(launches.restitution[i])
            transition = first_phase(kind, numbers, here, launches.liftoff, restitution)
            if self._enter(lanes[i], 0.0, transition):
                again.append(lanes[i])
                starts.append(int(transition.then.start))  # type: ignore[union-attr]
                states.append(transition.state)
        if again:
            which = np.array(again, dtype=np.intp)
            thrown = State.unpack(list(np.array(states).T.copy()))
            self._fly(which, thrown, np.zeros(len(which)), np.array(starts, dtype=np.intp))

    def _enter(self, lane: int, time: float, transition: Transition) -> bool:
        """Put a lane where a transition leads; return whether that is into the air."""
        if any(event.kind is EventKind.LIFT_OFF for event in transition.events):
            cell = self.cell[lane]
            self.ends.lift_off[cell] = np.fmin(self.ends.lift_off[cell], time)
        if isinstance(transition.then, Flight):
            return True
        where = np.array([lane], dtype=np.intp)
        state = State.unpack(list(transition.state[:, None].copy()))
        if isinstance(transition.then, Outcome):
            self._retire(where, state, np.array([time]), transition.then)
        else:
            self._place(where, state, np.array([time]))
        return False

    def _top(self, lanes: Indices | Flags) -> Top:
        """The tops on some lanes."""
        kind = self.launches.kind
        return kind.top(tuple(self.numbers[: kind.numbers, lanes]))

    def _whole(self, lanes: Indices | Flags) -> State:
        """Whole states of sliding tops."""
        n = self.rows[:SIZE, lanes]
        zero = np.zeros(n.shape[1])
        still = (zero, zero.copy()), (zero.copy(), zero.copy(), zero.copy()), zero.copy()
        sliding = SlidingState((n[0], n[1], n[2]), (n[3], n[4], n[5]), (n[6], n[7]), *still)
        return on_table(sliding, self._top(lanes))

    def _place(self, lanes: Indices, state: State, time: Array) -> None:
        """Let tops slide from these states on."""
        sliding = along_table(state)
        for row, number in enumerate((*sliding.axis, *sliding.momentum, *sliding.velocity)):
            self.rows[row, lanes] = number
        self.rows[LEFT, lanes] = self.end[lanes] - time
        self.rows[TAKEN, lanes] = np.inf

    def _retire(self, lanes: Indices, state: State, time: Array, outcome: Outcome) -> None:
        """Put down how launches ended."""
        if not len(lanes):
            return
        ends, cells = self.ends, self.cell[lanes]
        for kept, number in zip(ends.state.pack(), state.pack(), strict=True):
            kept[cells] = number
        fine = np.all(np.isfinite(np.array(np.broadcast_arrays(*state.pack()))), axis=0)
        ends.time[cells] = time
        failed = OUTCOMES.index(Outcome.FAILED)
        ends.outcome[cells] = np.where(fine, OUTCOMES.index(outcome), failed)
        ends.steps[cells] = self.rows[STEPS, lanes]
        ends.turned[cells] = self.watch.turned[lanes]
        self.reached[cells] = self.watch.reached[lanes]
        self.rows[LEFT, lanes] = 0.0
        self.alive[lanes] = False
        if not self.banded:
            least = self._least_force(lanes)
            stayed = np.isnan(ends.lift_off[cells]) & (ends.flights[cells] == 0)
            ends.least_force[cells] = np.where(stayed, least, 0.0)

    def _least_force(self, lanes: Indices) -> Array:
        """Least normal force, refined within the step in which it was seen."""
        rows = np.zeros((ROWS, len(lanes)))
        rows[:SIZE] = self.low_from[:, lanes]
        jet = self.stepper.jet(rows, self.numbers[:, lanes])
        return Polynomials(jet.force, self.low_step[lanes]).refined_least()[1]

    def _close(self, noted: Flags, begun: Array) -> None:
        """End a window: note it, take out what has ended, and close ranks."""
        down = np.fmin(self.rows[DOWN], self.watch.down)[noted]
        up = np.fmax(self.rows[UP], self.watch.up)[noted]
        cells = self.cell[noted]
        self.ends.down[cells] = np.fmin(self.ends.down[cells], down)
        self.ends.up[cells] = np.fmax(self.ends.up[cells], up)
        if not self.banded:
            self.notes.append(Note(cells, begun[:, noted], down, up))
        self.watch.set_back()
        self.rows[DOWN], self.rows[UP] = np.inf, -np.inf
        left = self.rows[LEFT]
        ended = np.flatnonzero(self.alive & (left <= 0.0))
        if len(ended):
            self._retire(ended, self._whole(ended), self.end[ended], Outcome.COMPLETED)
        stuck = (self.rows[TAKEN] < SHORTEST) | (self.rows[STEPS] > STEP_LIMIT)
        lost = np.flatnonzero(self.alive & (left > 0.0) & stuck)
        if len(lost):
            self._retire(lost, self._whole(lost), (self.end - left)[lost], Outcome.FAILED)
        if self.settled is not None:
            self._end_the_settled(self.settled)
        working = np.flatnonzero(self.alive)
        if len(working) and len(working) + LANES < CROWDED * len(self.alive):
            self._close_ranks(working)

    def _end_the_settled(self, closeness: float) -> None:
        """End the launches whose tilt is held."""
        lanes = np.flatnonzero(self.alive)
        if not len(lanes):
            return
        state = self._whole(lanes)
        held = is_held(state, self._top(lanes), closeness)
        time = self.end[lanes] - self.rows[LEFT, lanes]
        self._retire(lanes[held], picked(state, held), time[held], Outcome.COMPLETED)

    def _close_ranks(self, working: Indices) -> None:
        """Keep the lanes at work, and as many others as fill them up."""
        missing = -len(working) % LANES
        keep = np.concatenate((working, np.full(missing, working[-1], dtype=np.intp)))
        self.alive = np.arange(len(keep)) < len(working)
        self.cell, self.end = self.cell[keep], self.end[keep]
        self.held, self.kept = self.held[keep], self.kept[keep]
        self.low_step = self.low_step[keep]
        self.low_from = self.low_from[:, keep]
        self.numbers = np.ascontiguousarray(self.numbers[:, keep])
        self.rows = np.ascontiguousarray(self.rows[:, keep])
        self.rows[LEFT] *= self.alive
        self.spare = np.zeros_like(self.rows)
        self.watch = self.watch.some(keep)


def arrivals(launches: Launches, stepper: Stepper, notes: list[Note], band: tuple[Array, Array]) -> Array:
    """First times at which n_z is in a band, shape (n,); nan where it never is.

    The window in which that happens is known from the notes; it is done again, up to that moment.
    """
    count = len(launches)
    window = np.full(count, -1)
    rows = np.zeros((LEFT + 1, count))
    low, high = band
    for index, note in enumerate(notes):
        meets = (note.down <= high[note.cells]) & (note.up >= low[note.cells])
        fresh = meets & (window[note.cells] < 0)
        window[note.cells[fresh]] = index
        rows[:, note.cells[fresh]] = note.rows[:, fresh]
    found = np.full(count, np.nan)
    for first in (True, False):
        which = np.flatnonzero((window == 0) if first else (window > 0))
        if len(which):
            again = launches.some(which)
            edges = low[which], high[which]
            lanes = Lanes(again, stepper, edges, None if first else rows[:, which])
            lanes.run()
            found[which] = lanes.reached
    return found
