"""Steps of a trajectory, whatever their modes, put together so that arrays do the work."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tippetop.contact.mode import Mode, Segment
from tippetop.contact.readings import WORTH, Rates, instants, is_compiled, normal_force, read
from tippetop.integrators.base import Array
from tippetop.integrators.dense import at_fractions, evaluated
from tippetop.mechanics.quadratures import nearer_pole
from tippetop.mechanics.state import State

STEPS = 4096
"""Steps in a block, about."""

NODES, WEIGHTS = (
    0.5 * (1.0 + np.polynomial.legendre.leggauss(8)[0]),
    0.5 * np.polynomial.legendre.leggauss(8)[1],
)
"""Gauss's points and weights in [0, 1]. A step is short beside the radius of convergence: eight are
exact.
"""

FORCE = Rates._fields.index("force")
"""Place of the normal force in `Rates`."""


@dataclass(frozen=True)
class ModeSteps:
    """The steps of a block that were taken in one mode."""

    mode: Mode
    which: NDArray[np.intp]
    """Which steps of the block, shape (k,)."""
    terms: Array
    """Their polynomials, shape (k, size, degree + 1)."""
    spans: Array
    """How long they are, shape (k,)."""
    is_one_of_many: bool = False
    """Whether so many blocks are read that functions for it are compiled."""

    def total(self, count: int) -> int:
        """Return the number of instants that are read in all, where this block has `count`."""
        return max(count, WORTH if self.is_one_of_many else 0)

    @cached_property
    def nodes(self) -> Array:
        """`Rates` at Gauss's points, shape (9, 8, k)."""
        return self.at(NODES)

    @property
    def poles(self) -> Array:
        """The charts in which these have the angle about the axis, shape (k,)."""
        return poles_of_steps(Rates(*self.nodes).axis)

    def at(self, fractions: Array) -> Array:
        """`Rates` at fractions of the steps, shape (m,); of shape (9, m, k)."""
        y = at_fractions(self.terms, fractions)
        total = self.total(len(NODES) * len(self.which))
        return read(Rates.of, self.mode, y, poles_of_steps(y[2]), total=total)

    def force_at(self, fractions: Array, some: NDArray[np.intp]) -> Array:
        """Return the normal force at fractions of some steps, shape (m,); of shape (m, k)."""
        y, total = (
            at_fractions(self.terms[some], fractions),
            self.total(len(NODES) * len(self.which)),
        )
        if is_compiled(self.mode, total):  # by the function of `nodes`, which is compiled already
            force = read(Rates.of, self.mode, y, poles_of_steps(y[2]), total=total)[FORCE]
        else:
            force = read(normal_force, self.mode, y)[0]
        return np.asarray(force)

    @property
    def start_numbers(self) -> Array:
        """The numbers with which the steps begin, shape (size, k)."""
        return np.ascontiguousarray(self.terms[:, :, 0].T)


def poles_of_steps(n_z: Array) -> Array:
    """Return +1 or -1, the pole to which the axis comes nearest within each step, shape (k,).

    `n_z` are the axis's vertical components at m instants of each step, shape (m, k).
    """
    poles: Array = nearer_pole(n_z.min(axis=0) + n_z.max(axis=0))
    return poles


@dataclass(frozen=True)
class Block:
    """Segments that follow one another; there may be none."""

    segments: Sequence[Segment]
    is_one_of_many: bool = False
    """Whether so many blocks are read that functions for it are compiled."""

    @cached_property
    def lengths(self) -> NDArray[np.intp]:
        """How many steps each segment has."""
        return np.array([len(segment.solution.terms) for segment in self.segments])

    @cached_property
    def starts(self) -> Array:
        """Where the steps begin, shape (k,)."""
        return np.concatenate([[], *(segment.solution.knots[:-1] for segment in self.segments)])

    @cached_property
    def ends(self) -> Array:
        """Where the steps end, shape (k,)."""
        return np.concatenate([[], *(segment.solution.knots[1:] for segment in self.segments)])

    @property
    def spans(self) -> Array:
        """How long they are, shape (k,)."""
        return self.ends - self.starts

    @cached_property
    def groups(self) -> list[ModeSteps]:
        """The steps by mode."""
        # Laws of different makes with the same numbers are equal as tuples.
        kinds: dict[tuple[Any, ...], list[int]] = {}
        for number, segment in enumerate(self.segments):
            if len(segment.solution.terms):
                mode = segment.mode
                alike = tuple(top.kind for top in mode.tops)
                key = mode.reading_key, mode.tops, alike, segment.solution.terms.shape[1:]
                kinds.setdefault(key, []).append(number)
        first = np.concatenate([[0], np.cumsum(self.lengths)])
        spans = self.spans
        groups = []
        for numbers in kinds.values():
            which = np.concatenate([np.arange(first[n], first[n + 1]) for n in numbers])
            pieces = [self.segments[n].solution.terms for n in numbers]
            terms = pieces[0] if len(pieces) == 1 else np.concatenate(pieces)
            mode = self.segments[numbers[0]].mode
            groups.append(ModeSteps(mode, which, terms, spans[which], self.is_one_of_many))
        return groups

    def step_at(self, times: Array) -> NDArray[np.intp]:
        """Return the steps in which some times lie, the earlier one where two meet, shape (m,)."""
        return np.minimum(np.searchsorted(self.ends, times, side="left"), len(self.ends) - 1)

    def sampled(
        self, step: NDArray[np.intp], parts: Array
    ) -> Iterator[tuple[Mode, NDArray[np.intp] | slice, Array]]:
        """For every mode, which of some instants lie in it, and the numbers of `Instants` there.

        An instant is told by its step and the part of it that has passed.
        """
        for group in self.groups:
            chosen, numbers = self._within(group, step)
            if len(numbers):
                y = evaluated(group.terms, numbers, parts[chosen])
                total = group.total(len(numbers))
                yield group.mode, chosen, read(instants, group.mode, y.T, total=total)

    def until(self, step: int, part: float) -> tuple["Block", float, State]:
        """Return the block up to an instant, told by its step and the part of it that has passed.

        The time and the state of the instant are returned beside the block.
        """
        number = int(np.searchsorted(np.cumsum(self.lengths), step, side="right"))
        segment, inner = self.segments[number], step - int(self.lengths[:number].sum())
        solution = segment.solution.until(inner, part)
        numbers = segment.solution.terms[inner] @ part ** np.arange(segment.solution.terms.shape[2])
        state = segment.mode.state(numbers.tolist())
        some = list(self.segments[:number])
        if len(solution.terms):
            some.append(segment.until(solution, state))
        return Block(some), float(solution.end), state

    def _within(
        self, group: ModeSteps, step: NDArray[np.intp]
    ) -> tuple[NDArray[np.intp] | slice, NDArray[np.intp]]:
        """Return which of some steps a group has, and their numbers in it."""
        if len(self.groups) == 1:
            return slice(None), step
        place = np.full(len(self.ends), -1)
        place[group.which] = np.arange(len(group.which))
        chosen = np.flatnonzero(place[step] >= 0)
        return chosen, place[step[chosen]]


def in_blocks(segments: Iterable[Segment]) -> Iterator[Block]:
    """Segments as blocks of some thousand steps."""
    waiting: list[Segment] = []
    steps = 0
    for segment in segments:
        waiting.append(segment)
        steps += len(segment.solution.terms)
        if steps >= STEPS:
            yield Block(waiting)
            waiting, steps = [], 0
    if waiting:
        yield Block(waiting)
