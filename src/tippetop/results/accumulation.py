"""Catalogue of the quantities that are accumulated over the parts of a run, and how.

A run of a sweep is followed in parts: in steps of many launches at once, in flights, and alone. For
every quantity of `tippetop.results.metrics.Ends` but the state, `ACCUMULATED` has its value before
the first part, and how that of a part is joined to it.
"""

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tippetop.contact.mode import Status
from tippetop.mechanics.state import State
from tippetop.results.metrics import STATUSES, Ends


class Accumulation(NamedTuple):
    """How a quantity is accumulated over the parts of a run."""

    begin: float
    """Value before the first part."""
    join: Callable[[Any, Any], Any]
    """From the value before a part and that of the part to the value after it."""
    dtype: str = "float64"
    """NumPy type."""


def last(_: Any, part: Any) -> Any:
    """Return the value of a part, whatever the value before it."""
    return part


SUM, COUNT = Accumulation(0.0, np.add), Accumulation(0, np.add, "int64")
EARLIEST, LEAST, LARGEST = (Accumulation(np.nan, join) for join in (np.fmin, np.fmin, np.fmax))
HIGHEST, LAST = Accumulation(0.0, np.fmax), Accumulation(np.nan, last)

ACCUMULATED: Mapping[str, Accumulation] = {
    "time": LAST,
    "status": Accumulation(STATUSES.index(Status.FAILED), last, "int8"),
    "steps": Accumulation(0, last, "int64"),
    "flights": COUNT,
    "least_force": LEAST,
    "lift_off": EARLIEST,
    "struck": SUM,
    "drilled": SUM,
    "rolled": SUM,
    "braked": SUM,
    "descended": SUM,
    "airborne": SUM,
    "highest_gap": HIGHEST,
    "highest": HIGHEST,
    "down": LEAST,
    "up": LARGEST,
    "turned": EARLIEST,
    "settled": LAST,
    "arrived": EARLIEST,
    "rolls": Accumulation(0.0, last),
}
"""Quantities of `Ends`, but the state, which is that at the end."""


def before_launch(count: int) -> Ends:
    """Return the ends of so many launches that have not been followed yet."""
    quantities: dict[str, Any] = {
        name: np.full(count, rule.begin, dtype=rule.dtype) for name, rule in ACCUMULATED.items()
    }
    return Ends(state=State.unpack([np.full(count, np.nan) for _ in range(10)]), **quantities)


def accumulate(
    ends: Ends, launches: NDArray[np.intp], state: State | None = None, **parts: Any
) -> None:
    """Join quantities of a part of some launches to those before it.

    Parameters
    ----------
    ends
        What the quantities are joined to.
    launches
        Numbers of the launches, each of them once, shape (k,), or one number.
    state
        Their states at the end, if they have ended.
    parts
        Quantities of the part by name, of shape (k,), or one number for all.
    """
    for name, part in parts.items():
        quantity = getattr(ends, name)
        quantity[launches] = ACCUMULATED[name].join(quantity[launches], part)
    if state is not None:
        for stored, number in zip(ends.state.pack(), state.pack(), strict=True):
            stored[launches] = number


def of_a_part(ends: Ends) -> dict[str, Any]:
    """Return the quantities of a part by name, without the state."""
    return {name: getattr(ends, name) for name in ACCUMULATED}
