"""Keeps xarray from importing pint, which takes a third of a second, before anybody uses it.

xarray asks of every coordinate whether it is a quantity of pint, and imports pint for that. Nothing
is one before somebody else has imported pint.
"""

import sys
from typing import Any

from xarray.namedarray import pycompat


class _PintOnceImported:
    """What xarray asks of pint, of the module that is imported by now if there is one."""

    @property
    def module(self) -> Any:
        return sys.modules.get("pint")

    @property
    def available(self) -> bool:
        return self.module is not None

    @property
    def type(self) -> tuple[Any, ...]:
        quantity = getattr(self.module, "Quantity", None)
        return () if quantity is None else (quantity,)


def leave_pint_alone() -> None:
    """Let xarray look for quantities of pint only once pint is imported."""
    # An xarray without this table imports pint as it likes.
    known: dict[str, Any] = getattr(pycompat, "_cached_duck_array_modules", {})
    known.setdefault("pint", _PintOnceImported())
