"""What to change in a top so that it turns over and stands at spins within reach."""

import math
from collections.abc import Callable, Sequence
from typing import NamedTuple

from tippetop.problem.bodies import Body
from tippetop.support.errors import InvalidInput
from tippetop.theory.prospects import prospects

STEPS = 16
"""Sizes tried between the present one and either bound; nearer ones are found by halving."""

HALVINGS = 10
"""Halvings between a size that does not do and the next that does."""


class Size(NamedTuple):
    """A size of a top that may be changed."""

    name: str
    value: float
    low: float
    high: float


class Advice(NamedTuple):
    """One size to change, by the least that does."""

    name: str
    value: float
    spin: float
    """Least spin of launches, rad/s, that turn over and stand with it."""


def standing_spin(body: Body, gravity: float = 9.8, tilt: float = 0.1) -> float:
    """Return the least spin of launches, rad/s, from which a top turns over and stands on its other
    end; inf if no spin is enough.

    A sphere alone stands on its head; a body of several surfaces on the last of them, a sphere.
    """
    ahead = prospects(body, list(body.shapes), gravity, tilt)
    if ahead is None or not ahead.group.leaves_upright:
        return math.inf
    if len(body.shapes) == 1:
        return ahead.critical_spins.inverted if ahead.group.inverts else math.inf
    if ahead.stem is None or not math.isfinite(ahead.stem.launch):
        return math.inf
    return ahead.stem.launch


def advice(
    body_with: Callable[[str, float], Body],
    sizes: Sequence[Size],
    reach: float,
    gravity: float = 9.8,
    tilt: float = 0.1,
) -> list[Advice]:
    """Return the least change of each size alone with which a top stands at spins up to a reach,
    rad/s; sizes that cannot do it alone are left out.

    `body_with` makes the body with one size, by its name, of another value; where it raises
    `InvalidInput`, there is none.

    Examples
    --------
    >>> import tippetop as tt
    >>> body = tt.presets.report_problem().body
    >>> def with_eccentricity(name, value):
    ...     shape = tt.EccentricSphere(radius=0.02, eccentricity=value)
    ...     return body.model_copy(update={"shape": shape})
    >>> low = Size("eccentricity", 0.05, 0.01, 0.5)
    >>> [round(one.value, 2) for one in advice(with_eccentricity, [low], 150.0)]
    [0.06]
    """

    def spin_with(name: str, value: float) -> float:
        try:
            return standing_spin(body_with(name, value), gravity, tilt)
        except InvalidInput:
            return math.inf

    found = []
    for size in sizes:
        changes = [
            change
            for bound in (size.low, size.high)
            for change in _least_changes(spin_with, size, bound, reach)
        ]
        if changes:
            nearest = min(changes, key=lambda one: abs(one.value - size.value))
            found.append(nearest)
    return found


def _least_changes(
    spin_with: Callable[[str, float], float], size: Size, bound: float, reach: float
) -> list[Advice]:
    """Return the least change of a size towards a bound that does, or none."""
    short = size.value
    for step in range(1, STEPS + 1):
        enough = size.value + (bound - size.value) * step / STEPS
        if spin_with(size.name, enough) <= reach:
            for _ in range(HALVINGS):
                middle = 0.5 * (short + enough)
                if spin_with(size.name, middle) <= reach:
                    enough = middle
                else:
                    short = middle
            return [Advice(size.name, enough, spin_with(size.name, enough))]
        short = enough
    return []
