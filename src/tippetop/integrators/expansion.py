"""Taylor coefficients of a motion's solution and of its guards, from a state on."""

# translate module: by hand in dense.js

from collections.abc import Sequence

from tippetop.integrators.base import Array, Motion

Terms = list[list[float]]
"""Coefficients in increasing powers of time of several functions."""


def expanded(
    motion: Motion, parameters: Sequence[float], state: Array
) -> tuple[Terms, Terms, Terms]:
    """Return the coefficients of the state's numbers, of the guards, which have one less, and of
    the margins of choices (see `tippetop.graph.llvm_series.with_choices`).
    """
    from tippetop.integrators.taylor import coefficients_at  # noqa: PLC0415 - slow to import

    return coefficients_at(motion, parameters, state)
