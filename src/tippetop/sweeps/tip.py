"""How the tip of the axis moves on the way: how far it moves, when it turns over, when it reaches a band."""

from dataclasses import dataclass, field

import numpy as np

from tippetop.integrators.base import Array
from tippetop.integrators.polynomials import Polynomials
from tippetop.metrics import arrival_time, turning_time
from tippetop.sweeps.extremes import DOWN, UP, Extremes
from tippetop.sweeps.launches import Indices


@dataclass
class TipMotion:
    """The motion of the tip of the axis, n_z, for n launches."""

    turned: Array
    """First time at which n_z falls through zero, which is when the top turns over; nan before. A top that
    starts beyond a right angle turns over when it passes it from below."""
    low: Array
    high: Array
    """A band of n_z that is waited for, or nan."""
    reached: Array = field(init=False)
    """First time at which n_z is in the band; nan before."""
    extremes: Extremes = field(init=False)
    """Least normal force, and least and largest n_z, exactly."""

    def __post_init__(self) -> None:
        self.reached = np.full(self.low.shape, np.nan)
        self.extremes = Extremes.of(len(self.low))

    @classmethod
    def of(cls, count: int) -> "TipMotion":
        """That of launches that wait for no band."""
        nothing = np.full(count, np.nan)
        return cls(*(nothing.copy() for _ in range(3)))

    def see(self, launches: Indices, time: Array, tip: Polynomials) -> None:
        """Take in n_z as polynomials in time since `time`, shape (n,)."""
        self.extremes.take(DOWN, launches, tip)
        self.extremes.take(UP, launches, tip.negative())
        some = np.flatnonzero(np.isnan(self.turned[launches]) & (tip.values.min(axis=0) < 0.0))
        if len(some):
            self.turned[launches[some]] = time[some] + turning_time(tip.some(some))
        some = np.flatnonzero(np.isnan(self.reached[launches]) & ~np.isnan(self.low[launches]))
        if len(some):
            low, high = self.low[launches[some]], self.high[launches[some]]
            self.reached[launches[some]] = time[some] + arrival_time(tip.some(some), low, high)

    def some(self, which: Indices) -> "TipMotion":
        """That of some of the launches."""
        arrays = (self.turned, self.low, self.high)
        motion = TipMotion(*(array[which] for array in arrays))
        motion.reached, motion.extremes = self.reached[which], self.extremes.some(which)
        return motion
