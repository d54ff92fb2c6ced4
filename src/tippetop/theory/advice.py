"""Least changes of a top's sizes with which it turns over and stands."""

import math
from collections.abc import Callable, Sequence
from typing import NamedTuple

from tippetop.problem.bodies import Body
from tippetop.support.errors import InvalidInput
from tippetop.theory.prospects import prospects

STEPS = 16
"""Sizes tried between the present one and either bound, before halving refines them."""

BISECTIONS = 10
"""Halvings between a size that does not suffice and the next that does."""


class Size(NamedTuple):
    """Changeable size of a top with its bounds."""

    name: str
    value: float
    low: float
    high: float


class Advice(NamedTuple):
    """Least change of one size that suffices."""

    name: str
    value: float
    spin: float
    """Least spin of launches, rad/s, with which the changed top turns over and stands."""


def standing_spin(body: Body, gravity: float = 9.8, tilt: float = 0.1) -> float:
    """Return the least spin of launches, rad/s, from which a top turns over and stands.

    A single sphere stands on its head, a body of several surfaces on the last of them, which must
    be a sphere. The result is inf if no spin is enough.
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
    """Return the least change of each single size with which a top turns over and stands.

    `reach` is the largest spin of launches, rad/s. Sizes whose change alone is not enough are
    omitted. `body_with` makes the body with another value of one size, by its name; it raises
    `InvalidInput` if there is no such body.

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

    changed = []
    for size in sizes:
        changes = [
            change
            for bound in (size.low, size.high)
            for change in _least_changes(spin_with, size, bound, reach)
        ]
        if changes:
            nearest = min(changes, key=lambda one: abs(one.value - size.value))
            changed.append(nearest)
    return changed


def _least_changes(
    spin_with: Callable[[str, float], float], size: Size, bound: float, reach: float
) -> list[Advice]:
    """Return the least sufficient change of a size towards a bound, in a list; [] without one."""
    short = size.value
    for step in range(1, STEPS + 1):
        enough = size.value + (bound - size.value) * step / STEPS
        if spin_with(size.name, enough) <= reach:
            for _ in range(BISECTIONS):
                middle = 0.5 * (short + enough)
                if spin_with(size.name, middle) <= reach:
                    enough = middle
                else:
                    short = middle
            return [Advice(size.name, enough, spin_with(size.name, enough))]
        short = enough
    return []
