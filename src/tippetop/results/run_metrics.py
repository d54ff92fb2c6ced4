"""Accumulation of the metrics of one launch from the dense solution, block by block."""

import math
from collections.abc import Callable, Sequence

import numpy as np

from tippetop.contact.block import Block, ModeSteps
from tippetop.contact.contact_mode import STICKS
from tippetop.contact.flights import Flights
from tippetop.contact.mode import Event, IntegratedMode, Status
from tippetop.contact.readings import Rates
from tippetop.integrators.base import Array, Integrator
from tippetop.integrators.dense import chebyshev
from tippetop.integrators.polynomials import Least, Polynomials, least_of_each
from tippetop.mechanics.motion import axis_rate
from tippetop.mechanics.state import State
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Scalar
from tippetop.results.highest_gaps import highest_gaps
from tippetop.results.metrics import (
    STATUSES,
    Ends,
    Flags,
    arrival_time,
    last_outside,
    settled_band,
    turning_time,
)
from tippetop.results.settling import settled_tilt_of_one, spins_for_ever
from tippetop.results.sums import RunSums

AT_ONCE = 4
"""Steps in the first batch of a search for the first time of an event; the factor by which batches
grow.
"""

END_SPACINGS = 4.0
"""Rounding of the time of an event, in spacings of doubles: of the time within a step, and of its
sum with the start of the step. With 0, a run that ends as the top turns over might not count as
turned over; with many, a run that ends before might.
"""

FORCE_DEGREE = 20
"""Degree of the polynomials whose minimum is the least normal force."""


class RunMetrics:
    """Metrics accumulated while a run is integrated."""

    def __init__(self, top: Top, start: State) -> None:
        self._top, self._start, self._rolls = top, start, False
        self._tips: list[tuple[Polynomials, Array, Array, Array]] = []
        self.flights = Flights()
        self._lowest, self._highest, self._raised, self._pressed = (
            list[Polynomials]() for _ in range(4)
        )
        self._lowest_begin = list[Array]()
        self._turned = np.nan
        self.steps = self.evaluations = 0
        self.methods = dict[str, Integrator | None]()
        """Who took the steps of equations of motion, by name: None, by "", who was asked to."""
        self.peak = self._tilt_at(float(start.axis[2])), 0.0
        """Largest tilt, rad, and its first time; set by `ends`."""
        self.settling_time = math.nan
        """Time since which n_z stays in the band where it settles, or nan; set by `ends`."""

    def take(self, block: Block) -> None:
        """Accumulate the metrics of a block."""
        self.steps += sum(segment.steps for segment in block.segments)
        self.evaluations += sum(segment.evaluations for segment in block.segments)
        for segment in block.segments:
            if isinstance(segment.mode, IntegratedMode):
                method = segment.method
                self.methods.setdefault("" if method is None else method.name, method)
        for segment in block.segments[-1:]:
            mode = segment.mode
            self._rolls = mode.status == STICKS and spins_for_ever(mode.top)
        self._take_flights(block)
        for group in block.groups:
            self._take_tip(group, block.starts[group.which])
            if not group.mode.touching:
                self._take_height(group)
                continue
            if not self.flights.rows:
                self._take_force(group)

    def _take_tip(self, group: ModeSteps, starts: Array) -> None:
        """Accumulate the extremes of n_z and the time of turning over."""
        tip = Polynomials.of_unit(np.ascontiguousarray(group.terms[:, 2].T), group.spans)
        seen = Rates(*group.nodes).axis
        least, most, sag = seen.min(axis=0), seen.max(axis=0), tip.sag
        low, high = least - sag, most + sag
        self._tips.append((tip, starts, low, high))
        highest = np.flatnonzero(high >= np.fmax.reduce(most))
        self._highest.append(tip.some(highest, sign=-1.0))
        lowest = np.flatnonzero(low <= np.fmin.reduce(least))
        self._lowest.append(tip.some(lowest))
        self._lowest_begin.append(starts[lowest])
        self._turned = _first(self._turned, tip, starts, (low <= 0.0) & (high >= 0.0), turning_time)

    def _take_flights(self, block: Block) -> None:
        """Accumulate the flights, with the highest gap of each."""
        flying = [segment for segment in block.segments if not segment.mode.touching]
        if not flying:
            return
        highest = np.zeros(len(block.starts))
        for group in block.groups:
            if not group.mode.touching:
                highest[group.which] = highest_gaps(group)
        first = np.concatenate([[0], np.cumsum(block.lengths)])
        for number, segment in enumerate(block.segments):
            if not segment.mode.touching:
                in_segment = highest[first[number] : first[number + 1]]
                self.flights.take(segment, float(in_segment.max(initial=0.0)))

    def _take_height(self, group: ModeSteps) -> None:
        """Accumulate the height of the centre of mass in flights."""
        self._raised.append(Polynomials.of_unit(-group.terms[:, 9].T, group.spans))

    def _take_force(self, group: ModeSteps) -> None:
        """Accumulate the normal force."""
        force = Rates(*group.nodes).force
        least = force.min(axis=0)
        # Between and beyond Gauss's points the force is lower by at most a small part of its range
        # at them.
        near = np.flatnonzero(least - 0.2 * (force.max(axis=0) - least) <= least.min())
        places, transform, to_powers = chebyshev(FORCE_DEGREE)
        unit = to_powers @ (transform @ group.force_at(places, near))
        self._pressed.append(Polynomials.of_unit(unit, group.spans[near]))

    def ends(
        self, state: State, time: float, status: Status, events: Sequence[Event], sums: RunSums
    ) -> Ends:
        """Return the accumulated `Ends` of a launch with this last state, time and status, and
        these sums.
        """
        last = State.unpack([np.float64(number) for number in state.pack()])
        leasts = least_of_each(self._pressed, self._lowest, self._highest, self._raised)
        self._take_peak(leasts[1])
        if math.isnan(self._turned) and self._is_turning_at(state, time):
            self._turned = time
        settled = settled_tilt_of_one(status, state, self._start, self._top)
        self.settling_time = self._since(*settled_band(settled))
        return Ends.of_one(
            last,
            np.float64(time),
            STATUSES.index(status),
            events,
            self.flights,
            self.steps,
            sums,
            sums.descent_work(self._top),
            [least.value for least in leasts],
            (self._turned, settled, self.arrival(*settled_band(settled))),
            float(self._rolls),
        )

    def _is_turning_at(self, state: State, end: float) -> bool:
        """Return whether n_z falls through 0 at the end of the run, to the rounding of its time.

        A run that an event ends there ends on either side of it.
        """
        rate = axis_rate(state.axis, state.momentum, self._top)[2]
        off = END_SPACINGS * np.spacing(end) * abs(rate)
        return bool(end > 0.0 > rate and abs(state.axis[2]) <= off)

    def _take_peak(self, least: Least) -> None:
        """Set `peak` from the least n_z of the motion, unless the launch has a lower one."""
        if least.value < self._start.axis[2]:
            begin = np.concatenate(self._lowest_begin)[least.row]
            self.peak = self._tilt_at(least.value), float(begin + least.time)

    @staticmethod
    def _tilt_at(cosine: float) -> float:
        """Return the tilt, rad, for n_z = `cosine`."""
        return math.atan2(math.sqrt(max(1.0 - cosine**2, 0.0)), cosine)

    def arrival(self, low: Scalar, high: Scalar) -> float:
        """Return the first time at which n_z is between `low` and `high`; nan if it never is."""
        first = float(np.nan)
        if np.isnan(low):
            return first
        for tip, starts, least, most in self._tips:
            near = (least <= high) & (most >= low)
            first = _first(first, tip, starts, near, lambda some: arrival_time(some, low, high))
        return first

    def _since(self, low: Scalar, high: Scalar) -> float:
        """Return the time since which n_z stays between `low` and `high`; nan if these are nan."""
        since = math.nan if np.isnan(low) else 0.0
        for tip, starts, least, most in self._tips:
            outside = np.flatnonzero((least < low) | (most > high))
            latest, count = outside[np.argsort(-starts[outside], kind="stable")], AT_ONCE
            while len(latest) and starts[latest[0]] + tip.span[latest[0]] > since:
                which, latest, count = latest[:count], latest[count:], AT_ONCE * count
                times = last_outside(tip.some(which), low, high) + starts[which]
                if not np.all(np.isnan(times)):
                    since = max(since, float(np.fmax.reduce(times)))
                    break
        return since


def _first(
    earliest: float,
    tip: Polynomials,
    starts: Array,
    near: Flags,
    find: Callable[[Polynomials], Array],
) -> float:
    """Return the first time that `find` returns for the steps marked in `near`, or `earliest`."""
    which, count = np.flatnonzero(near & ~(starts > earliest)), AT_ONCE
    while len(which):
        some, which, count = which[:count], which[count:], AT_ONCE * count
        times = find(tip.some(some)) + starts[some]
        if not np.all(np.isnan(times)):
            return float(np.fmin(earliest, np.fmin.reduce(times)))
    return earliest
