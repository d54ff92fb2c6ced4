"""Extremes of the motion of many launches, to rounding."""

from dataclasses import dataclass

import numpy as np

from tippetop.integrators.base import Array
from tippetop.integrators.polynomials import Polynomials
from tippetop.sweeps.launches import Indices

FORCE, DOWN, UP = range(3)
"""What is least: the value of the first guard, which is the normal force; n_z; and -n_z."""


@dataclass
class Extremes:
    """Least values of the normal force, n_z and -n_z of n launches."""

    early: Array
    lately: Array
    """The least values before they were last put aside, and since, shape (3, n); inf where there are none."""

    @classmethod
    def of(cls, count: int) -> "Extremes":
        """Nothing seen yet."""
        return cls(np.full((3, count), np.inf), np.full((3, count), np.inf))

    @property
    def least(self) -> Array:
        """The least values, shape (3, n)."""
        found: Array = np.fmin(self.early, self.lately)
        return found

    def put_aside(self) -> None:
        """Begin anew with what is found lately."""
        self.early = self.least
        self.lately[:] = np.inf

    def put(self, least: Array) -> None:
        """Take in the least values of a step of every launch, shape (3, n); inf for those that took none."""
        np.fmin(self.lately, least, out=self.lately)

    def take(self, which: int, lanes: Indices, course: Polynomials) -> None:
        """Take in the course of what may be least on some lanes; a lane may be there several times."""
        np.fmin.at(self.lately[which], lanes, course.lowest)
        lower = np.flatnonzero(course.floor <= self.least[which, lanes])
        if len(lower):
            np.fmin.at(self.lately[which], lanes[lower], course.some(lower).refined_least()[1])

    def some(self, which: Indices) -> "Extremes":
        """Those of some of the launches."""
        return Extremes(self.early[:, which], self.lately[:, which])
