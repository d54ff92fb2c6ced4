"""One step of Taylor's method for many launches at once, with what happens inside it.

The equations of motion and guards of a contact mode, in plain operators, are evaluated on power
series. LLVM compiles the whole step, with its dense output, into one function that works on eight
launches an instruction; without it launches are followed one by one. Order and step size are chosen
much as by heyoka's integrators (Biscani and Izzo 2021, MNRAS 504; Jorba and Zou 2005, Experimental
Mathematics 14): the order p from the tolerance, and the step from the last two coefficients, so
that what is left out is below the tolerance. What is left out of all numbers is compared with all
of them, by the roots of their squares; so a spin or slip that is large would let the axis go
astray, and what is left out of that is compared with no more than `FAST`, and less beyond `FASTER`.
Heyoka compares the largest numbers, and in a single launch the guards with them, where
`tippetop.integrators.taylor` cuts steps that are too long for any.

A launch's step depends on nothing but its own numbers: arrays are filled up to a multiple of
`LANES`, so that every launch is computed by the same instructions wherever it stands in them.
"""

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

from tippetop.contact.guards import BRANCH
from tippetop.graph.taylor_coefficients import SharedSeries
from tippetop.integrators.base import Motion
from tippetop.integrators.polynomial_minima import (
    TINY,
    least_value,
    looked_at,
    lower_bound,
    may_fall,
)
from tippetop.integrators.polynomial_zeros import single_fall
from tippetop.mechanics.series import Arithmetic, horner, solved, unknown
from tippetop.mechanics.vectors import Scalar

PROBES, FINE_PROBES = 12, 32
"""Intervals of a step at whose ends n_z and guards are looked at, and of what may be longer than a
step.
"""

FAST = 10.0
"""Size of the state, in natural units, beyond which a top is so fast that its axis needs more care.
"""

FASTER = 1e3
"""Size beyond which it needs yet more, as the square: by so much what the axis is off changes the
force.
"""

SHORTEST, ROUNDED = 1e-13, 2.0**-52
"""Step, in natural units and over the time left, both of which it is below where a motion is
singular.
"""

SLIDING = 8
"""How many numbers the state of a sliding top has, the first of its motion."""

LANES = 16
"""Arrays are filled up to a multiple of this many launches."""


class Layout(NamedTuple):
    """Which row holds what, for a motion of some size with some guards.

    A step brings the first rows up to date: the numbers of the motion, the time that is left to go
    and the steps taken. The others tell of the step: the time it may take, whether something may
    happen in it, the least values of the first guard, of n_z and of -n_z in it, and whether it
    ended earlier, where another branch of the law takes over. Where something else may happen it
    was not taken, those values are inf, and no time is left: the launch waits.

    What to pause for is in rows after the parameters: whether each guard counts, whether the top is
    yet to turn over, and the least and the largest n_z of a band (inf and -inf for none).

    Of motions that are sampled, a further number is the time that is left at the next sample, and
    the last rows tell whether that is in a step that was taken, and have the numbers of the motion
    there.
    """

    size: int
    parameters: int
    """Numbers of the motion, and parameters."""
    remaining: int
    steps: int
    """Rows of the time left, and of the number of steps."""
    carried_rows: int
    """How many rows a step brings up to date."""
    step_time: int
    pause: int
    """Rows of the time that a step may take, and of whether something may happen in it."""
    least: slice
    """Rows of the least values of the first guard, n_z and -n_z in a step."""
    changed: int
    """Row of whether a step ended where another branch of the law takes over."""
    reached: int
    sample: slice
    """Rows of whether the next sample is reached and of the numbers there, of motions that are
    sampled.
    """
    rows: int
    """How many rows there are."""
    pauses: slice
    """Rows, after the parameters, of what to pause for."""
    counts: slice
    turns: int
    band: slice
    """Rows, after the parameters, of which guards count, of whether the top is yet to turn over,
    and of the band.
    """
    due: int
    """Row, after those, of the time left at the next sample, of motions that are sampled."""
    numbers: int
    """How many rows of parameters, of what to pause for and of samples there are."""
    branch: int | None
    """Which guard tells where another branch of the law takes over, if any does."""

    @property
    def is_sampled(self) -> bool:
        """Whether the motion is sampled."""
        return self.numbers > self.due

    @classmethod
    def of(cls, motion: Motion, *, sampled: bool = False) -> "Layout":
        """Return the layout for a motion, which may be sampled."""
        size, guards, parameters = motion.size, len(motion.guards), motion.parameters
        carried, turns = size + 2, parameters + guards
        pause, changed, due = carried + 1, carried + 5, turns + 3
        least, counts, band = (
            slice(carried + 2, changed),
            slice(parameters, turns),
            slice(turns + 1, due),
        )
        reached = changed + 1
        rows = reached + (1 + size if sampled else 0)
        sample, pauses = slice(reached + 1, rows), slice(parameters, due)
        row = (size, size + 1, carried, carried, pause, least, changed, reached, sample, rows)
        names = [guard.name for guard in motion.guards]
        branch = names.index(BRANCH) if BRANCH in names else None
        numbers = due + sampled
        return cls(size, parameters, *row, pauses, counts, turns, band, due, numbers, branch)


class Jet(NamedTuple):
    """Coefficients of polynomials in time, in increasing order, which may be arrays of n
    launches.
    """

    state: Any
    """Those of the state, size x (order + 1)."""
    guards: Any
    """Those of the guards, guards x order."""


def expansion(
    motion: Motion,
    order: int,
    start: Sequence[Scalar],
    numbers: Sequence[Scalar],
    plain: Arithmetic,
) -> Jet:
    """Return the polynomials of a step: coefficients of the solution and of the guards."""
    parameters = numbers[: motion.parameters]
    y = solved(
        [SharedSeries(unknown, plain) for _ in start], start, lambda y: motion.rates(y, parameters)
    )
    guards = [guard.value(y, parameters) for guard in motion.guards]
    return Jet(
        [series.up_to(order)[: order + 1] for series in y],
        [guard.up_to(order - 1)[:order] for guard in guards],
    )


def stride(
    layout: Layout, jet: Jet, before: Sequence[Scalar], numbers: Sequence[Scalar], plain: Arithmetic
) -> list[Scalar]:
    """Return all rows after a step of `LaneStepper.step`, from the polynomials that start at the
    carried rows.
    """
    remaining, steps = before[layout.size :]
    counts, band = numbers[layout.counts], numbers[layout.turns : layout.due]
    state, falls = jet
    full = step_size(state[:SLIDING], remaining, plain, axis=3, sums=state[SLIDING:])
    length, changes, events = later_guards(falls, counts, (full, layout.branch), plain)
    floor, ceiling = extremes(state[2], length, plain)
    events += met(floor, ceiling, band, plain)
    pressing = looked_at(falls[0], length, PROBES)
    events += may_fall(falls[0], pressing, length, plain) * counts[0]
    moves = plain.below(0.0, length)
    pause = events * moves
    after = [*(horner(terms, length) for terms in state), remaining - length, steps + moves]
    goes = plain.below(pause, moves)
    stays = [plain.choose(goes, new, old) for old, new in zip(before, after, strict=True)]
    stays[layout.remaining] = plain.choose(pause, 0.0 * remaining, after[layout.remaining])
    force = least_value(falls[0], pressing, length, plain)
    least = [
        plain.choose(pause, math.inf + 0.0 * value, value) for value in (force, floor, -ceiling)
    ]
    samples = []
    if layout.is_sampled:
        due = numbers[layout.due]
        reached = goes * (1.0 - plain.below(due, stays[layout.remaining]))
        samples = [reached, *(horner(terms, remaining - due) for terms in state)]
    return [*stays, full, pause, *least, plain.choose(pause, 0.0 * changes, changes), *samples]


def extremes(tip: Sequence[Scalar], length: Scalar, plain: Arithmetic) -> tuple[Scalar, Scalar]:
    """Return the least and the largest n_z in a step, from its polynomial."""
    heights, upside = looked_at(tip, length, PROBES), [-term for term in tip]
    floor = least_value(tip, heights, length, plain)
    return floor, -least_value(upside, [-height for height in heights], length, plain)


def met(floor: Scalar, ceiling: Scalar, band: Sequence[Scalar], plain: Arithmetic) -> Scalar:
    """Return whether n_z passes zero, if the top is yet to turn over, or reaches a band: see
    `Layout`.
    """
    turns, low, high = band
    over = plain.below(floor, 0.0) * plain.below(0.0, ceiling) * turns
    return over + (1.0 - plain.below(high, floor)) * (1.0 - plain.below(ceiling, low))


def later_guards(
    falls: Sequence[Sequence[Scalar]],
    counts: Sequence[Scalar],
    step: tuple[Scalar, int | None],
    plain: Arithmetic,
) -> tuple[Scalar, Scalar, Scalar]:
    """Limit the length of a step by all guards but the first.

    `step` is the longest length that is allowed, and the index of the guard of the law's branch, or
    None. Return the length that is taken, whether it ends at a change of the law's branch (1 or 0),
    and a number that is positive if another guard may fall in the step or is undecided. The guard
    of the branch is searched only where it comes near zero.
    """
    full, branch = step
    none = 0.0 * full
    length, changes, events = full, none, none
    for number, (terms, count) in enumerate(zip(falls[1:], counts[1:], strict=True), start=1):
        near = plain.below(lower_bound(terms, full, plain), TINY)
        if number != branch:
            events += near * count
            continue
        need, (change, doubt) = (
            near * plain.below(0.0, full),
            single_fall(terms, full, plain),
        )
        shorter, usual = (
            (plain.least(change, full), plain.below(change, full), doubt),
            (full, none, none),
        )
        length, changes, doubt = (
            plain.rarely(need, a, b) for a, b in zip(shorter, usual, strict=True)
        )
        events += doubt
    return length, changes, events


def step_size(
    state: Sequence[Sequence[Scalar]],
    remaining: Scalar,
    plain: Arithmetic,
    axis: int = 0,
    sums: Sequence[Sequence[Scalar]] = (),
) -> Scalar:
    """Step for which the last terms of the polynomials are below the tolerance, or all that is
    left.

    They, and those of sums along the motion, are compared with the state; the first, as many as are
    of the axis, with `FAST` at most, and with less beyond `FASTER`. The step is 0 where they are no
    numbers.
    """
    order = len(state[0]) - 1

    def square(terms: Sequence[Scalar]) -> Scalar:
        return plain.total([term * term for term in terms])

    def ratio(k: int) -> Scalar:
        # Of fast motion the last terms are so large that their squares are no numbers.
        scale = 1.0 / (plain.total([plain.size(series[k]) for series in every]) + TINY)
        terms = [scale * series[k] for series in every]
        others = square(terms[axis:])
        left_out = size / others
        if axis:
            squares = square(terms[:axis])
            left_out = plain.least(bounded / squares, size / (squares + others))
        return scale * left_out**0.5

    every = [*state, *sums]
    size = square([series[0] for series in state])
    bounded = size
    if axis:
        most = FAST * FASTER * FASTER / size
        bounded = plain.least(plain.least(size, FAST * FAST), most * most)
    radius = plain.least(*(ratio(k) ** (1.0 / k) for k in (order - 1, order)))
    safety = math.exp(-2.0 - 0.7 / (order - 1))
    return plain.choose(
        plain.below(0.0, radius), plain.least(safety * radius, remaining), 0.0 * remaining
    )


def is_singular(step: Any, remaining: Any) -> Any:
    """Return whether steps, of arrays of one shape, are so short that a motion is singular."""
    return (step < SHORTEST) & (step < ROUNDED * remaining)


def order_for(tolerance: float) -> int:
    """Degree of the polynomials for a tolerance, as heyoka chooses it."""
    return max(2, math.ceil(1.0 - 0.5 * math.log(tolerance)))
