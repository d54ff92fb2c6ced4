"""Keep xarray from importing pint, which takes a third of a second, before pint is used.

xarray imports pint to ask of every coordinate whether it is a quantity of pint. No coordinate can
be one before pint has been imported elsewhere.
"""

import sys
from typing import Any

from xarray.namedarray import pycompat


class _PintOnceImported:
    """Entry of xarray's table of array modules: pint, if it has been imported."""

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
    """Let xarray look for quantities of pint only once pint has been imported."""
    # Versions of xarray without this table still import pint by themselves.
    modules: dict[str, Any] = getattr(pycompat, "_cached_duck_array_modules", {})
    modules.setdefault("pint", _PintOnceImported())
