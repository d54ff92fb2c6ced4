"""How far polynomials of many launches are followed: until a guard falls through zero, or they
serve no more.

LLVM compiles what is usual of it. It knows nothing of what moves, so that it serves all motions of
a size.
"""

from collections.abc import Callable, Sequence
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from tippetop.integrators.base import Array
from tippetop.integrators.polynomial_minima import least_value, looked_at
from tippetop.integrators.polynomial_zeros import single_fall
from tippetop.integrators.polynomials import Polynomials
from tippetop.mechanics.series import Arithmetic, horner
from tippetop.mechanics.vectors import Scalar
from tippetop.sweeps.launch_arrays import Indices
from tippetop.sweeps.taylor_step import FINE_PROBES, LANES, Jet, extremes, met, step_size
from tippetop.sweeps.taylor_stepper import NODES, compiled, padded


class Arcs(NamedTuple):
    """What becomes of n launches."""

    after: Array
    """States at the end, shape (size, n)."""
    least: Array
    """Least values of the first guard, of the third number of the state, and of minus that, shape
    (3, n).
    """
    full_step: Array
    span: Array
    """How far the polynomials serve, and how far they are followed, shape (n,)."""
    fallen: Array
    """Which guard falls through zero at the end; -1 for none."""
    doubt: Array
    """Not 0 where that is not sure, or happens what is waited for."""

    def look_closer(self, jet: Jet, counts: Array) -> Indices:
        """Find out where there is doubt, by guards that count, shape (guards, n); return where that
        is.
        """
        which = np.flatnonzero(self.doubt)
        if len(which):
            full = self.full_step[which]
            span, fallen = full, np.full(full.shape, -1.0)
            for number, terms in enumerate(jet.guards):
                fall = Polynomials(terms[:, which], full).first_fall()
                earlier = (counts[number, which] != 0.0) & (fall <= span)
                fallen[earlier], span = number, np.where(earlier, fall, span)
            self.span[which], self.fallen[which] = span, fallen
            self.after[:, which] = [horner(terms[:, which], span) for terms in jet.state]
        return which


def arcs(jet: Jet, step: Array, longest: Array, pauses: Array) -> Arcs:
    """Follow polynomials of n launches as far as they serve, `step`, shape (n,).

    Where that is 0 it is found, `longest` at most. What to pause for, shape (guards + 3, n): see
    `Layout`.
    """
    (size, terms, count), guards = jet.state.shape, len(jet.guards)
    rows = np.concatenate(
        (jet.state.reshape(-1, count), jet.guards.reshape(-1, count), [step, longest])
    )
    results = np.empty((size + 7, count + -count % LANES))
    _code(size, terms - 1, guards)(padded(rows), padded(pauses), results)
    return Arcs(*np.split(results[:, :count], (size, size + 3))[:2], *results[size + 3 :, :count])


@lru_cache(maxsize=16)
def _code(size: int, order: int, guards: int) -> Callable[..., None]:
    cut = size * (order + 1)

    def rows(numbers: Sequence[Scalar], pauses: Sequence[Scalar]) -> list[Scalar]:
        state = [numbers[k : k + order + 1] for k in range(0, cut, order + 1)]
        falls = [numbers[k : k + order] for k in range(cut, cut + guards * order, order)]
        return arc(Jet(state, falls), numbers[-2:], pauses, NODES)

    return compiled(rows, cut + guards * order + 2, guards + 3, effort=0)


def arc(
    jet: Jet, steps: Sequence[Scalar], pauses: Sequence[Scalar], plain: Arithmetic
) -> list[Scalar]:
    """Return the result of `arcs` for one launch."""
    (state, falls), (step, longest) = jet, steps
    full = plain.choose(plain.below(0.0, step), step, step_size(state, longest, plain))
    span, fallen, doubt = full, 0.0 * full - 1.0, 0.0 * full
    for number, (terms, count) in enumerate(zip(falls, pauses, strict=False)):
        fall, unsure = single_fall(terms, full, plain)
        earlier = (1.0 - plain.below(span, fall)) * count
        span, fallen = (
            plain.choose(earlier, fall, span),
            plain.choose(earlier, float(number), fallen),
        )
        doubt += unsure * count
    after = [horner(terms, span) for terms in state]
    floor, ceiling = extremes(state[2], span, plain)
    doubt += met(floor, ceiling, pauses[len(falls) :], plain)
    force = least_value(falls[0], looked_at(falls[0], span, FINE_PROBES), span, plain)
    return [*after, force, floor, -ceiling, full, span, fallen, doubt]
