"""How the tip of the axis moves on the way, and how hard the table presses: first times, and least
values.
"""

from dataclasses import dataclass, fields

import numpy as np

from tippetop.integrators.base import Array
from tippetop.integrators.polynomials import Polynomials
from tippetop.results.metrics import arrival_time, turning_time
from tippetop.sweeps.launch_arrays import Indices

FORCE, DOWN, UP = range(3)
"""What is least: the value of the first guard, which is the normal force; n_z; and -n_z."""


@dataclass
class TipMotion:
    """The motion of the tip of the axis, n_z, and the normal force, for n launches."""

    turned: Array
    """First time at which n_z falls through zero, which is when the top turns over; nan before. A
    top that starts beyond a right angle turns over when it passes it from below.
    """
    low: Array
    high: Array
    """A band of n_z that is waited for, or nan."""
    reached: Array
    """First time at which n_z is in the band; nan before."""
    early: Array
    lately: Array
    """The least values before they were last put aside, and since, shape (3, n); inf where there
    are none.
    """

    @classmethod
    def of(cls, count: int) -> "TipMotion":
        """Return the extremes of launches that wait for no band."""
        return cls(*np.full((4, count), np.nan), *np.full((2, 3, count), np.inf))

    @property
    def least(self) -> Array:
        """The least values, shape (3, n)."""
        least: Array = np.fmin(self.early, self.lately)
        return least

    def put_aside(self) -> None:
        """Begin anew with what is found lately."""
        self.early = self.least
        self.lately[:] = np.inf

    def pauses(self, launches: Indices) -> Array:
        """Return whether some are yet to turn over, and the band that they are yet to reach, shape
        (3, n).

        Of no band the least n_z is inf and the largest -inf.
        """
        waits = np.isnan(self.reached[launches]) & ~np.isnan(self.low[launches])
        low, high = (
            np.where(waits, edge[launches], far)
            for edge, far in ((self.low, np.inf), (self.high, -np.inf))
        )
        return np.array([np.isnan(self.turned[launches]), low, high])

    def put(self, least: Array) -> None:
        """Take in the least values of a step of every launch, shape (3, n); inf for those that took
        none.
        """
        np.fmin(self.lately, least, out=self.lately)

    def put_of(self, launches: Indices, least: Array) -> None:
        """Put the extremes of some launches; nan where there is none, or it is taken in already."""
        self.lately[:, launches] = np.fmin(self.lately[:, launches], least)

    def take(self, which: int, lanes: Indices, polynomials: Polynomials) -> None:
        """Take in polynomials of what may be least on some lanes; a lane may be there several
        times.
        """
        np.fmin.at(self.lately[which], lanes, polynomials.lowest)
        lower = np.flatnonzero(polynomials.floor <= self.least[which, lanes])
        if len(lower):
            np.fmin.at(self.lately[which], lanes[lower], polynomials.some(lower).refined_least()[1])

    def see(self, launches: Indices, time: Array, tip: Polynomials) -> None:
        """Take in n_z as polynomials in time since `time`, shape (n,)."""
        self.take(DOWN, launches, tip)
        self.take(UP, launches, tip.negative())
        some = np.flatnonzero(np.isnan(self.turned[launches]) & (tip.values.min(axis=0) < 0.0))
        if len(some):
            self.turned[launches[some]] = time[some] + turning_time(tip.some(some))
        some = np.flatnonzero(np.isnan(self.reached[launches]) & ~np.isnan(self.low[launches]))
        if len(some):
            low, high = self.low[launches[some]], self.high[launches[some]]
            self.reached[launches[some]] = time[some] + arrival_time(tip.some(some), low, high)

    def some(self, which: Indices) -> "TipMotion":
        """Return the extremes of some of the launches."""
        return TipMotion(*(getattr(self, field.name)[..., which] for field in fields(self)))
