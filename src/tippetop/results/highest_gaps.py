"""The highest gap in the steps of flights, from the polynomials of the state."""

import numpy as np

from tippetop.contact.block import ModeSteps
from tippetop.contact.flights import gap_at
from tippetop.contact.mode import Mode
from tippetop.integrators.base import Array
from tippetop.integrators.dense import at_fractions, chebyshev, evaluated
from tippetop.integrators.polynomials import Polynomials
from tippetop.mechanics.roots import DIVISIONS, GOLDEN
from tippetop.mechanics.surfaces.hull import Hull, is_edge

GAP_DEGREE = 20
"""Degree of the polynomials whose maximum is the highest gap of a smooth surface: in a step of
Taylor's method they leave out rounding.
"""

GAP_PROBES = 16
"""Intervals of a step at whose ends a gap with kinks is evaluated: an axis turns by a tenth of a
radian in each, so that there is one maximum about the highest of them.
"""


def highest_gaps(steps: ModeSteps) -> Array:
    """Return the highest gap in each step of flights, natural units, shape (k,)."""
    return highest_gaps_of(steps.mode, steps.terms, steps.spans)


def highest_gaps_of(mode: Mode, terms: Array, spans: Array) -> Array:
    """Return the highest gap in each of k steps, by polynomials as of `ModeSteps`, shape (k,).

    The gap of one smooth surface is fitted by polynomials. That of an edge, or of the lowest of
    several surfaces, has kinks: its maximum is found by golden section about the highest probe.
    """
    surface = mode.top.surface
    if not (isinstance(surface, Hull) or is_edge(surface)):
        places, transform, to_powers = chebyshev(GAP_DEGREE)
        gaps = gap_at(mode, at_fractions(terms, places))
        unit = to_powers @ (transform @ np.broadcast_to(gaps, (len(places), len(spans))))
        return np.asarray(-Polynomials.of_unit(-unit, spans).refined_least()[1])
    probes = np.linspace(0.0, 1.0, GAP_PROBES + 1)
    best = probes[gap_at(mode, at_fractions(terms, probes)).argmax(axis=0)]
    every = np.arange(len(best))

    def gap_of(parts: Array) -> Array:
        gaps: Array = gap_at(mode, evaluated(terms, every, parts).T)
        return gaps

    low, high = np.maximum(best - probes[1], 0.0), np.minimum(best + probes[1], 1.0)
    for _ in range(DIVISIONS):
        lower, upper = low + GOLDEN * (high - low), high - GOLDEN * (high - low)
        falls = gap_of(lower) > gap_of(upper)
        low, high = np.where(falls, low, lower), np.where(falls, upper, high)
    ends = [gap_of(parts) for parts in (best, 0.5 * (low + high))]
    return np.asarray(np.maximum(*ends))
