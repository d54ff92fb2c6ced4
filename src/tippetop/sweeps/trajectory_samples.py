"""Samples of many launches: where each is at given times, until its run ends.

Executors put the states in as they pass the sample times, in natural units, one launch in the order
of time. `variables` makes those of a run of them, by the functions of a single run.
"""

import math
from collections.abc import Mapping, Sequence
from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from tippetop.contact.contact_mode import ContactMode
from tippetop.contact.flight import SIZE, TOUCHING, Flight
from tippetop.contact.mode import Event, Mode
from tippetop.contact.natural_launch import initial_mode
from tippetop.contact.readings import TOLD, Instants, instants, read_of_kind
from tippetop.integrators.base import Array
from tippetop.mechanics.contacts.branches import is_branched
from tippetop.mechanics.flight.free_motion import gap
from tippetop.mechanics.motion import along_table, axial_spin
from tippetop.mechanics.natural_units import Units
from tippetop.mechanics.quadratures import nearer_pole, turn_at_launch
from tippetop.mechanics.series import horner
from tippetop.mechanics.state import State
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Scalar, Vector
from tippetop.results.samples import OF_INSTANTS, OF_SUMS, Samples, continuous
from tippetop.results.sums import RunSums
from tippetop.sweeps.lane_sums import LaneSums
from tippetop.sweeps.launch_arrays import Indices, Launches, branched, single
from tippetop.sweeps.listed_events import ListedEvents
from tippetop.sweeps.taylor_step import SLIDING

OF_THE_AXIS = {"tilt", "azimuth", "spin", "axis", "angular_momentum", *OF_SUMS} - {"energy"}
"""Variables that follow from axis and angular momentum, and from sums, alone."""

AT_ONCE = 8192
"""Samples of which variables are computed together, about: few enough for the cache."""

Waiting: TypeAlias = list[tuple[Indices, Indices, Array]]
"""Launches, places and states of samples of which the variables are not computed yet."""


class TrajectorySamples:
    """Samples of n launches at k times.

    Parameters
    ----------
    launches
        The launches.
    units
        Their natural units, each of shape (n,).
    times
        The sample times, s, shape (k,).
    variables
        Arrays for the variables in SI, by names of `SAMPLED`, shape (m, k, ...).
    rows
        The rows of the launches in these arrays, shape (n,).
    azimuths
        Directions into which the axes lean at launch, rad, shape (n,).
    sums
        The sums that lanes carry after the numbers of the state.

    Attributes
    ----------
    events
        The events, if they are kept.
    due
        Time of the next sample of each launch in natural units, shape (n,); inf after the last.
    """

    def __init__(
        self,
        launches: Launches,
        units: Units,
        times: Array,
        variables: Mapping[str, Array],
        rows: Indices,
        azimuths: Array,
        sums: LaneSums,
    ) -> None:
        self.azimuths, self.sums = azimuths, sums
        self.events: ListedEvents | None = None
        self._launches, self._times = launches, times
        self._units = tuple(one_for_all(unit) for unit in units)
        self._numbers = [one_for_all(row) for row in launches.numbers]
        self._variables, self._rows = variables, rows
        self._next = np.zeros(len(launches), dtype=np.intp)
        self._later = np.append(times, np.inf)
        self.due = np.broadcast_to(self._later[0] / units.time, (len(launches),)).copy()
        self._waiting: dict[int, Waiting] = {SLIDING: [], SIZE: []}
        self._count = 0
        self._needs_forces = bool(set(variables) - OF_THE_AXIS)

    def put(self, launches: Indices, numbers: Array) -> None:
        """Put the numbers of some launches at their next samples: of the states, of sliding or of
        flying, and of the sums; shape (numbers, m).
        """
        places = self._next[launches]
        self._waiting[len(numbers) - self.sums.count].append((launches, places, numbers))
        self._pass(launches, places + 1)
        self._count += len(launches)
        if self._count >= AT_ONCE:
            self._compute_waiting()

    def take(self, launches: Indices, start: Array, terms: Array, until: Array) -> None:
        """Take the samples of some launches along polynomials in time.

        Their coefficients, shape (size, order + 1, m), are those from the times `start`, and the
        samples are those up to the times `until`, both of shape (m,).
        """
        which = np.flatnonzero(self.due[launches] <= until)
        while len(which):
            some = launches[which]
            offset = self.due[some] - start[which]
            self.put(some, np.array([horner(row[:, which], offset) for row in terms]))
            which = which[self.due[some] <= until[which]]

    def take_last(self, launches: Indices, state: State, time: Array, sums: Array) -> None:
        """Take the samples that are due when some launches end, in these states at these times,
        with these sums: those of launches that end as they begin, and what rounding left over.
        """
        for place in np.flatnonzero(self.due[launches] <= time).tolist():
            launch, one = launches[place : place + 1], single(state, place)
            top = self._launches.automaton(int(launch[0])).top
            touches = gap(one, top) <= TOUCHING
            flies = not touches or isinstance(initial_mode(one, top)[0], Flight)
            numbers = one.pack() if flies else along_table(one).pack()
            while self.due[launch[0]] <= time[place]:
                self.put(launch, np.array([[*numbers, *sums[:, place]]]).T)

    def times_left(self, launch: int) -> Array:
        """Return the times of the samples of a launch that are not taken, in natural units."""
        times: Array = self._times[self._next[launch] :] / self._units_of(launch).time
        return times

    def take_observed(self, launch: int, samples: Samples, top: Top) -> None:
        """Take the next samples of a launch from those of a run, in natural units."""
        first = self._next[launch]
        last = first + len(samples.times)
        observed = samples.instants, samples.sums, samples.pole
        for name, values in self._variables.items():
            in_si = variable_in_si(name, observed, top, self._units_of(launch))
            values[self._rows[launch], first:last] = in_si
        self._pass(np.array([launch]), np.array([last]))

    def take_events(self, launch: int, events: Sequence[Event]) -> None:
        """Take the next events of a launch, in natural units, if they are kept."""
        if self.events is not None:
            self.events.take(launch, events)

    def _pass(self, launches: Indices, places: Indices) -> None:
        """Let the next samples be those of these numbers."""
        self._next[launches] = places
        self.due[launches] = self._later[places] / self._units_of(launches).time

    def _units_of(self, launches: Indices | int) -> Units:
        """Return the natural units of some launches."""
        return Units(*(of_some(unit, launches) for unit in self._units))

    @property
    def is_sampled(self) -> NDArray[np.bool_]:
        """Whether each sample was taken before the end of its run, shape (n, k)."""
        reached: NDArray[np.bool_] = np.arange(len(self._times)) < self._next[:, None]
        return reached

    def finish(self) -> None:
        """Compute the variables of the samples that wait, and let those after the ends of the runs
        be no numbers.
        """
        self._compute_waiting()
        launches, places = np.nonzero(~self.is_sampled)
        for name, values in self._variables.items():
            values[self._rows[launches], places] = np.nan
            if name == "orientation":
                values[self._rows] = continuous(values[self._rows])

    def _compute_waiting(self) -> None:
        """Compute the variables of the samples that wait."""
        for waiting in self._waiting.values():
            if waiting:
                launches, places, numbers = (
                    np.concatenate(rows, axis=-1) for rows in zip(*waiting, strict=True)
                )
                self._compute(launches, places, numbers)
                waiting.clear()
        self._count = 0

    def _compute(self, launches: Indices, places: Indices, numbers: Array) -> None:
        """Compute the variables of samples of some launches, from the numbers of their states."""
        units = self._units_of(launches)
        top = self._launches.kind.top(tuple(of_some(row, launches) for row in self._numbers))
        numbers, summed = np.split(numbers, [len(numbers) - self.sums.count])
        seen = self._instants(top, numbers) if self._needs_forces else of_the_axis(top, numbers)
        observed = seen, self.sums.run_sums(summed), self.sums.pole(summed)
        flat = self._rows[launches] * len(self._times) + places
        for name, values in self._variables.items():
            by_instant = values.reshape(-1, *values.shape[2:])
            by_instant[flat] = variable_in_si(name, observed, top, units)

    def _instants(self, top: Top, numbers: Array) -> Instants:
        """Return all of `Instants` of tops from the numbers of their states."""
        mode: Mode = Flight(top)
        if len(numbers) == SLIDING:
            mode = ContactMode(top, pulls=True)
            if is_branched(top.friction):
                mode = ContactMode(branched(top, mode.state(list(numbers))), pulls=True)
        return Instants.unpack(read_of_kind(instants, mode, self._launches.kind, numbers))


class SampledLaunch(NamedTuple):
    """A launch that is sampled, and its sums at the start of a part that is followed by itself."""

    samples: TrajectorySamples
    launch: int
    """Number of the launch in the samples."""
    sums: RunSums
    pole: float
    """Pole of the chart of the angle about the axis."""

    @classmethod
    def at_launch(cls, samples: TrajectorySamples, launch: int, axis: Vector) -> "SampledLaunch":
        """Return a launch from its start on, where its axis is this one."""
        pole = float(nearer_pole(axis[2]))
        turn = turn_at_launch(float(samples.azimuths[launch]), pole)
        sums = RunSums.at_launch(turn, 0.0)
        return cls(samples, launch, sums, pole)

    def take(self, samples: Samples, top: Top) -> None:
        """Take the samples of the part, whose sums but the angle begin at zero."""
        added = [a + b for a, b in zip(self.sums, samples.sums, strict=True)]
        sums = RunSums(*added)._replace(turn=samples.sums.turn)
        self.samples.take_observed(self.launch, samples._replace(sums=sums), top)


def variable_in_si(
    name: str, observed: tuple[Instants, RunSums, Scalar], top: Top, units: Units
) -> Array:
    """Return a variable over time in SI from what is observed of it in natural units."""
    if name in OF_INSTANTS:
        return OF_INSTANTS[name](observed[0], top, units)
    return OF_SUMS[name](*observed, top, units)


def of_the_axis(top: Top, numbers: Array) -> Instants:
    """Return `Instants` with axis, angular momentum and spin; the others are no numbers."""
    axis, momentum = (numbers[0], numbers[1], numbers[2]), (numbers[3], numbers[4], numbers[5])
    rows: list[Scalar] = [math.nan] * TOLD
    rows[:6] = [*axis, *momentum]
    unknown = Instants.unpack(rows)
    return unknown._replace(spin=axial_spin(axis, momentum, top))


def one_for_all(numbers: Array) -> Scalar:
    """Return numbers, shape (n,), as one number if all are the same."""
    return float(numbers[0]) if len(numbers) and np.all(numbers == numbers[0]) else numbers


def of_some(numbers: Scalar, launches: Indices | int) -> Scalar:
    """Return the numbers of some launches, of which there may be one number for all."""
    return numbers[launches] if isinstance(numbers, np.ndarray) else numbers
