"""Events of many launches, the first ones of each, in arrays of one row a launch."""

from collections.abc import Mapping, Sequence

import numpy as np

from tippetop.contact.mode import Event, EventKind
from tippetop.integrators.base import Array
from tippetop.mechanics.natural_units import Units
from tippetop.sweeps.launch_arrays import Indices

KINDS = tuple(EventKind)
"""Kinds of events, by the numbers that stand for them."""


class ListedEvents:
    """Events of n launches, put in as they happen: of one launch in the order of time.

    Parameters
    ----------
    variables
        Arrays for the variables of the events in SI, by name, of shape (m, places), and for their
        number, of shape (m,).
    rows
        The rows of the launches in these arrays, shape (n,).
    units
        The natural units of the launches, each of shape (n,).
    """

    def __init__(self, variables: Mapping[str, Array], rows: Indices, units: Units) -> None:
        self._variables, self._rows, self._units = variables, rows, units
        variables["event_count"][rows] = 0

    def put(
        self,
        launches: Indices,
        kind: EventKind,
        time: Array | float,
        impulse: Array | float = 0.0,
        energy_lost: Array | float = 0.0,
        surface: int = 0,
    ) -> None:
        """Put in an event of some launches, of shape (k,), with numbers in natural units."""
        rows, units = self._rows[launches], Units(*(unit[launches] for unit in self._units))
        places = self._variables["event_count"][rows]
        self._variables["event_count"][rows] += 1
        is_listed = places < self._variables["event_time"].shape[1]
        values = {
            "event_time": time * units.time,
            "event_kind": KINDS.index(kind),
            "event_impulse": impulse * units.mass * units.speed,
            "event_energy_lost": energy_lost * units.energy,
            "event_surface": surface,
        }
        for name, value in values.items():
            listed = np.broadcast_to(value, rows.shape)[is_listed]
            self._variables[name][rows[is_listed], places[is_listed]] = listed

    def take(self, launch: int, events: Sequence[Event]) -> None:
        """Take the next events of a launch."""
        one = np.array([launch])
        for event in events:
            self.put(one, event.kind, event.time, event.impulse, event.energy_lost, event.surface)
