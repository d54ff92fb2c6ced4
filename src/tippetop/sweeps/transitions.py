"""What follows on lanes where a guard falls through zero, a flight ends or a launch begins.

Lift-off, flights and impacts without restitution, the bulk of it, are done for all lanes at once,
with the equations of a single launch. Everything else goes through the transitions of a single
launch, lane by lane; a lane that enters a mode which only a single launch knows is followed alone
to its end.
"""

import numpy as np

from tippetop.contact.contact_mode import ContactMode, sliding_motion
from tippetop.contact.flight import TOUCHING, Flight, Start
from tippetop.contact.guards import BRANCH, LIFT_OFF
from tippetop.contact.mode import EventKind, Mode, ModeEnd, Status, Transition
from tippetop.contact.surfaces import lands_flat, lies_flat
from tippetop.integrators.base import Array
from tippetop.mechanics.flight.free_motion import gap, gap_rate
from tippetop.mechanics.invariants import energy
from tippetop.mechanics.motion import along_table, falls_by_zero, sliding_contact
from tippetop.mechanics.state import State
from tippetop.mechanics.surfaces.hull import is_edge
from tippetop.results.accumulation import accumulate, of_a_part
from tippetop.results.metrics import STATUSES
from tippetop.sweeps.flights import fly_all, rolls, slides, slips
from tippetop.sweeps.impacts import collide
from tippetop.sweeps.lane_arrays import HELD_BY_LANES, Slots
from tippetop.sweeps.launch_arrays import Indices, picked, single
from tippetop.sweeps.single_launches import follow
from tippetop.sweeps.trajectory_samples import SampledLaunch

FLIGHT_LIMIT = 50_000
"""Flights after which a launch is given up."""


class LaneTransitions:
    """Transitions of launches under way, which end when they reach a band of n_z if they are
    `banded`.

    The tolerance is that of the integrator of launches that are followed alone: relative error per
    step.
    """

    def __init__(self, slots: Slots, tolerance: float, banded: bool) -> None:
        self.slots, self.tolerance, self.banded = slots, tolerance, banded
        self.motion = sliding_motion(slots.launches.kind, guarded=True)

    def launch(self, lanes: Indices, state: State) -> None:
        """Let the launches begin: those that do not simply slide are followed apart."""
        launches = self.slots.launches
        singly = launches.unresisted
        for i in np.flatnonzero(singly).tolist():
            one = single(state, i)
            self._follow_alone(int(lanes[i]), 0.0, one, launches.automaton(i).launch(one))
        plain = slips(state, launches.top, far=True) & rolls(state, launches.top)
        plain &= ~np.asarray(lies_flat(launches.top, state.axis))
        if launches.liftoff != "ignore":
            plain &= slides(state, launches.top)
        if launches.liftoff == "fly":
            plain &= gap(state, launches.top) <= TOUCHING
            plain &= np.abs(gap_rate(state, launches.top)) <= TOUCHING
        others = np.flatnonzero(~plain & ~singly)
        transitions = [launches.automaton(i).launch(single(state, i)) for i in others.tolist()]
        self._enter(lanes[others], np.zeros(len(others)), picked(state, others), transitions)

    def fall(self, lanes: Indices, time: Array, guards: Indices) -> None:
        """Put lanes of which a guard fell into the mode that follows, or end them."""
        names = np.array([guard.name for guard in self.motion.guards])[guards]
        on_branch, free = names == BRANCH, names == LIFT_OFF
        if free.any():
            states = self.slots.states(lanes)
            tops = self.slots.tops(lanes)
            with np.errstate(divide="ignore"):
                normal = sliding_contact(*along_table(states), tops).normal_force
            free &= falls_by_zero(normal, states.axis, states.momentum, tops)
        ending = ~(on_branch | free)
        if ending.any():
            cells, state = self.slots.cell[lanes[ending]], self.slots.states(lanes[ending])
            launches = self.slots.launches
            ends = [
                ModeEnd.by_guard(str(name), single(state, i))
                for i, name in enumerate(names[ending])
            ]
            transitions = [
                launches.automaton(int(cell)).follow(
                    launches.sliding(int(cell), end.state), end, float(moment)
                )
                for cell, end, moment in zip(cells, ends, time[ending], strict=True)
            ]
            self._enter(lanes[ending], time[ending], state, transitions)
        if on_branch.any():
            self.slots.change_branch(lanes[on_branch])
        self._let_go(lanes[free], time[free])

    def _let_go(self, lanes: Indices, time: Array) -> None:
        """Let lanes fly, or stop, whose normal force fell to zero."""
        slots = self.slots
        cells, state = slots.cell[lanes], slots.states(lanes)
        accumulate(slots.ends, cells, lift_off=time)
        self._list_events(cells, EventKind.LIFT_OFF, time)
        if slots.launches.liftoff == "stop":
            slots.retire(lanes, state, time, Status.LIFTED_OFF)
        else:
            self._fly(lanes, state, time, np.full(len(lanes), int(Start.LIFT_OFF), dtype=np.intp))

    def _fly(self, lanes: Indices, state: State, time: Array, vanishing: Indices) -> None:
        """Fly, collide, and fly again, until the tops slide or their runs end."""
        slots = self.slots
        ends, launches = slots.ends, slots.launches
        while len(lanes):
            cells = slots.cell[lanes]
            horizon = slots.end[lanes] - time
            numbers = launches.numbers[:, cells]
            sampled = None if slots.samples is None else (slots.samples, cells)
            seen = slots.tip, lanes, time
            carried = slots.stepper.sums, slots.sums[:, lanes]
            flown = fly_all(
                state, launches.kind, numbers, horizon, vanishing, seen, sampled, carried
            )
            slots.sums[:, lanes] = flown.sums
            accumulate(
                ends,
                cells,
                flights=1,
                airborne=flown.duration,
                highest_gap=flown.highest_gap,
                highest=flown.highest,
            )
            slots.rows[slots.layout.steps, lanes] += flown.steps
            over = ~flown.landed & (flown.duration >= horizon)
            time = np.where(over, slots.end[lanes], time + flown.duration)
            slots.retire(lanes[over], picked(flown.state, over), time[over], Status.COMPLETED)
            slots.retire(
                lanes[flown.lost], picked(flown.state, flown.lost), time[flown.lost], Status.FAILED
            )
            endless = ~over & ~flown.lost & ~flown.landed
            bounced = flown.landed & (ends.flights[cells] >= FLIGHT_LIMIT)
            for which, status in (
                (endless, Status.TOO_MANY_STEPS),
                (bounced, Status.TOO_MANY_MODES),
            ):
                slots.retire(lanes[which], picked(flown.state, which), time[which], status)
            landed = flown.landed & ~bounced
            lanes, time, state = lanes[landed], time[landed], picked(flown.state, landed)
            lanes, state, time, vanishing = self._land(lanes, state, time)

    def _land(self, lanes: Indices, state: State, time: Array) -> "Flying":
        """Collide with the table; return the lanes that fly again, as `_fly` takes them."""
        slots = self.slots
        cells, launches = slots.cell[lanes], slots.launches
        top = launches.tops(cells)
        after, struck, rebounds, impulse = collide(state, top, launches.restitution[cells])
        struck &= ~np.asarray(lands_flat(top, state.axis)) & slips(after, top, far=True)
        rebounds &= struck
        sliding = struck & ~rebounds & slides(after, top)
        slots.place(lanes[sliding], picked(after, sliding), time[sliding])
        settled = sliding | rebounds
        lost = np.broadcast_to(energy(state, top) - energy(after, top), settled.shape)
        slots.strike(lanes[settled], lost[settled])
        self._list_events(cells[settled], EventKind.TOUCHDOWN, time[settled])
        effects = impulse[settled], lost[settled]
        self._list_events(cells[settled], EventKind.IMPACT, time[settled], *effects)
        others = np.flatnonzero(~settled)
        transitions = []
        for i in others.tolist():
            automaton, one = launches.automaton(int(cells[i])), single(state, i)
            transitions.append(automaton.touchdown(automaton.top, float(time[i]), one))
        entered = self._enter(
            lanes[others], time[others], picked(state, others), transitions, fly=False
        )
        again = np.flatnonzero(rebounds)
        starts = np.full(len(again), int(Start.REBOUND), dtype=np.intp)
        return joined((lanes[again], picked(after, again), time[again], starts), entered)

    def _enter(
        self,
        lanes: Indices,
        time: Array,
        state: State,
        transitions: list[Transition],
        fly: bool = True,
    ) -> "Flying":
        """Put lanes where transitions lead from their states.

        Those that fly do so, or are returned as `_fly` takes them.
        """
        again, starts, states = [], [], []
        for i, transition in enumerate(transitions):
            self._note(lanes[i], float(time[i]), transition)
            if not isinstance(transition.next, Status) and not is_for_lanes(transition):
                self._follow_alone(int(lanes[i]), float(time[i]), single(state, i), transition)
                continue
            self.slots.strike(lanes[i : i + 1], np.array([transition.energy_lost]))
            if self.slots.samples is not None:
                self.slots.samples.take_events(int(self.slots.cell[lanes[i]]), transition.events)
            if isinstance(transition.next, Flight):
                again.append(i)
                starts.append(int(transition.next.start))
                states.append(transition.state.pack())
            else:
                self._settle(lanes[i : i + 1], transition, time[i : i + 1])
        which = np.array(again, dtype=np.intp)
        thrown = State.unpack(list(np.array(states, dtype=float).reshape(-1, 10).T.copy()))
        flying = lanes[which], thrown, time[which], np.array(starts, dtype=np.intp)
        if fly:
            self._fly(*flying)
        return flying

    def _note(self, lane: int, time: float, transition: Transition) -> None:
        """Note a lift-off."""
        if any(event.kind is EventKind.LIFT_OFF for event in transition.events):
            accumulate(self.slots.ends, self.slots.cell[lane], lift_off=time)

    def _list_events(
        self,
        cells: Indices,
        kind: EventKind,
        time: Array,
        impulse: Array | float = 0.0,
        energy_lost: Array | float = 0.0,
    ) -> None:
        """List an event of some launches, if events are kept."""
        samples = self.slots.samples
        if samples is not None and samples.events is not None:
            samples.events.put(cells, kind, time, impulse, energy_lost)

    def _settle(self, lane: Indices, transition: Transition, time: Array) -> None:
        """Let a top slide, or end its run."""
        state = State.unpack(
            [np.array([number], dtype=float) for number in transition.state.pack()]
        )
        if isinstance(transition.next, Status):
            self.slots.retire(lane, state, time, transition.next)
        else:
            self.slots.place(lane, state, time)

    def follow_alone(self, lanes: Indices) -> None:
        """Follow launches that slide as single launches are, from where they are."""
        state, time = self.slots.states(lanes), self.slots.time(lanes)
        for i, lane in enumerate(lanes.tolist()):
            one = single(state, i)
            automaton = self.slots.launches.automaton(int(self.slots.cell[lane]))
            mode = automaton.mode_for(automaton.top, one, slips=True)
            self._follow_alone(lane, float(time[i]), one, Transition((), mode, one))

    def _follow_alone(self, lane: int, time: float, state: State, transition: Transition) -> None:
        """Follow one launch from a transition in a state to its end as a single launch is."""
        slots, ends, cell, where = (
            self.slots,
            self.slots.ends,
            self.slots.cell[[lane]],
            np.array([lane]),
        )
        number = int(slots.cell[lane])
        begin = slots.launches.automaton(number), state, time
        launched = single(slots.launches.state, number)
        sampled = None
        if slots.samples is not None:
            carried, sums = slots.stepper.sums, slots.sums[:, lane].tolist()
            sampled = SampledLaunch(
                slots.samples, number, carried.run_sums(sums), carried.pole(sums)
            )
        ended, run_metrics = follow(
            begin,
            transition,
            float(slots.end[lane]),
            self.tolerance,
            launched=launched,
            sampled=sampled,
        )
        parts = of_a_part(ended)
        accumulate(ends, cell, **{name: parts[name] for name in parts if name not in HELD_BY_LANES})
        tip = slots.tip
        tip.turned[where] = np.fmin(tip.turned[where], ended.turned)
        arrived = ended.arrived
        if self.banded:
            arrived = run_metrics.arrival(tip.low[where], tip.high[where])
        tip.reached[where] = np.fmin(tip.reached[where], arrived)
        slots.rows[slots.layout.steps, where] += ended.steps
        slots.retire(where, ended.state, ended.time, STATUSES[ended.status])


Flying = tuple[Indices, State, Array, Indices]
"""Lanes that fly, their states and times at the start, and how many coefficients of the gap vanish
there.
"""


def joined(first: Flying, second: Flying) -> Flying:
    """Return lanes that fly together with others."""
    lanes, state, time, vanishing = first
    others, others_state, others_time, others_vanishing = second
    pairs = zip(state.pack(), others_state.pack(), strict=True)
    return (
        np.concatenate((lanes, others)),
        State.unpack([np.concatenate(pair) for pair in pairs]),
        np.concatenate((time, others_time)),
        np.concatenate((vanishing, others_vanishing)),
    )


def is_for_lanes(transition: Transition) -> bool:
    """Return whether lanes go on from a transition: not where a body flies with its face level, of
    which an edge's gap is zero twice.
    """
    mode, (x, y, _) = transition.next, transition.state.axis
    if isinstance(mode, Flight):
        edges = any(is_edge(contact.surface) for contact in mode.top.body.contacts)
        return not edges or x != 0.0 or y != 0.0
    return isinstance(mode, Mode) and is_plain(mode)


def is_plain(mode: Mode) -> bool:
    """Return whether lanes slide as in this mode."""
    return isinstance(mode, ContactMode) and mode.slides_freely and not mode.near
