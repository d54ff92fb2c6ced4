"""Extremes of the motion of many launches, to rounding.

A step is looked at in places, and its second derivatives say how far below the looks it may go. Steps that
may go below everything seen so far are kept until somebody searches them, by Newton's method.
"""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from tippetop.integrators.base import Array
from tippetop.integrators.polynomials import Polynomials
from tippetop.sweeps.launches import Indices
from tippetop.sweeps.stride import Jet

FORCE, DOWN, UP = range(3)
"""What is least: the value of the first guard, which is the normal force; n_z; and -n_z."""


@dataclass
class Extremes:
    """Least values of the normal force, n_z and -n_z of n launches.

    Attributes
    ----------
    found
        The least values, shape (3, n); inf before there are any, and complete after a search.
    seen
        The least values that were looked at, shape (3, n).
    lately
        Those since they were last forgotten, shape (3, n).
    """

    found: Array
    seen: Array
    lately: Array
    _kept: list[tuple[Indices, Indices, Array, Array, Array]] = field(default_factory=list)

    @classmethod
    def of(cls, count: int) -> "Extremes":
        """Nothing seen yet."""
        found, seen, lately = (np.full((3, count), np.inf) for _ in range(3))
        return cls(found, seen, lately)

    def forget(self) -> None:
        """Forget what was seen lately."""
        self.lately[:] = np.inf

    def look(self, looks: Array, slack: Array, step: Array, start: Array) -> None:
        """Take in a step of every launch.

        Parameters
        ----------
        looks, slack
            Least values looked at, inf for launches that took no step, and how far below them the step may
            go, of shape (3, n).
        step, start
            How long it took, shape (n,), and the numbers of the motion at its start, shape (size, n).
        """
        bounds = looks - slack
        which, lanes = (bounds < self.seen).nonzero()
        if len(lanes):
            self._kept.append((which, lanes, bounds[which, lanes], step[lanes], start[:, lanes]))
        np.fmin(self.seen, looks, out=self.seen)
        np.fmin(self.lately, looks, out=self.lately)

    def take(self, which: int, lanes: Indices, pieces: Polynomials) -> None:
        """Take in what may be least on some lanes; a lane may be there several times."""
        for known in (self.seen, self.lately):
            np.fmin.at(known[which], lanes, pieces.lowest)
        lower = np.flatnonzero(pieces.floor <= self.seen[which, lanes])
        if len(lower):
            least = pieces.some(lower).refined_least()[1]
            np.fmin.at(self.found[which], lanes[lower], least)

    def search(self, jet: Callable[[Array, Indices], Jet]) -> None:
        """Search the steps that were kept; `jet` gives the polynomials from starts, of shape (size, k)."""
        if not self._kept:
            return
        which, lanes, bounds, step, start = (
            np.concatenate(each, axis=-1) for each in zip(*self._kept, strict=True)
        )
        self._kept = []
        lower = np.flatnonzero(bounds <= self.seen[which, lanes])
        which, lanes, step = which[lower], lanes[lower], step[lower]
        found = jet(start[:, lower], lanes)
        for number, terms in enumerate((found.guards[0], found.state[2], -found.state[2])):
            here = np.flatnonzero(which == number)
            self.take(number, lanes[here], Polynomials(terms[:, here], step[here]))

    def some(self, which: Indices) -> "Extremes":
        """Those of some of the launches; nothing may be kept."""
        assert not self._kept, "the lanes of steps that wait to be searched would be wrong"
        return Extremes(self.found[:, which], self.seen[:, which], self.lately[:, which])
