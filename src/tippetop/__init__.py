"""tippetop: a laboratory for the tippe top.

Problem and its parts state the physics, `simulate` runs it, and the result is an `xarray.Dataset`.
"""

import sys
from importlib import import_module
from types import ModuleType
from typing import TYPE_CHECKING, Any

__version__ = "0.1.0"

if TYPE_CHECKING:
    from tippetop import presets
    from tippetop.errors import FileTrouble, InvalidInput, TippetopError, Unavailable
    from tippetop.netcdf import read_run, write_run
    from tippetop.phases import Outcome
    from tippetop.problem import (
        Body,
        Contact,
        EccentricSphere,
        Launch,
        Problem,
        RegularizedCoulombFriction,
        Spheroid,
        ViscousFriction,
    )
    from tippetop.simulate import simulate

__all__ = [
    "Body",
    "Contact",
    "EccentricSphere",
    "FileTrouble",
    "InvalidInput",
    "Launch",
    "Outcome",
    "Problem",
    "RegularizedCoulombFriction",
    "Spheroid",
    "TippetopError",
    "Unavailable",
    "ViscousFriction",
    "__version__",
    "presets",
    "read_run",
    "simulate",
    "write_run",
]

_HOMES = {
    "errors": ("FileTrouble", "InvalidInput", "TippetopError", "Unavailable"),
    "netcdf": ("read_run", "write_run"),
    "phases": ("Outcome",),
    "problem": (
        "Body",
        "Contact",
        "EccentricSphere",
        "Launch",
        "Problem",
        "RegularizedCoulombFriction",
        "Spheroid",
        "ViscousFriction",
    ),
    "simulate": ("simulate",),
}
_HOME_OF = {name: home for home, names in _HOMES.items() for name in names}


def __getattr__(name: str) -> Any:
    # Names are fetched when first used, so that the command line answers before the libraries are loaded.
    if name in _HOME_OF:
        return getattr(import_module(f"tippetop.{_HOME_OF[name]}"), name)
    if name == "presets":
        return import_module("tippetop.presets")
    raise AttributeError(f"module 'tippetop' has no attribute {name!r}")


class _Package(ModuleType):
    """A package whose attribute `simulate` is the function, never the module of the same name."""

    def __setattr__(self, name: str, value: object) -> None:
        if not (name == "simulate" and isinstance(value, ModuleType)):
            super().__setattr__(name, value)


sys.modules[__name__].__class__ = _Package


def __dir__() -> list[str]:
    return sorted(__all__)
