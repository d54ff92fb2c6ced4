"""tippetop: a laboratory for the tippe top.

`Problem` and its parts state the physics, `simulate` runs it, and the result is an `xarray.Dataset`, which
`summarize`, `plot` and `view` show and `write_run` keeps. `sweep` follows many launches at once; `predict`,
`critical_spins` and `steady_states` say what is known of a launch without a run.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

__version__ = "0.1.0"

if TYPE_CHECKING:
    from tippetop import presets
    from tippetop.catalogue import Ending
    from tippetop.contact.mode import Outcome
    from tippetop.errors import FileTrouble, InvalidInput, TippetopError, Unavailable
    from tippetop.export.csv import write_csv
    from tippetop.export.glb import write_glb
    from tippetop.export.html import write_html
    from tippetop.export.movie import write_movie
    from tippetop.figures.overview import plot
    from tippetop.lab.notebook import view
    from tippetop.netcdf import read_run, write_run
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
    from tippetop.run import simulate
    from tippetop.summary import summarize
    from tippetop.sweeps.run import sweep
    from tippetop.theory.overview import steady_states
    from tippetop.theory.prediction import predict
    from tippetop.theory.thresholds import critical_spins

_HOMES = {
    "catalogue": ("Ending",),
    "contact.mode": ("Outcome",),
    "errors": ("FileTrouble", "InvalidInput", "TippetopError", "Unavailable"),
    "export.csv": ("write_csv",),
    "export.glb": ("write_glb",),
    "export.html": ("write_html",),
    "export.movie": ("write_movie",),
    "figures.overview": ("plot",),
    "lab.notebook": ("view",),
    "netcdf": ("read_run", "write_run"),
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
    "run": ("simulate",),
    "summary": ("summarize",),
    "sweeps.run": ("sweep",),
    "theory.overview": ("steady_states",),
    "theory.prediction": ("predict",),
    "theory.thresholds": ("critical_spins",),
}
_HOME_OF = {name: home for home, names in _HOMES.items() for name in names}

__all__ = [  # noqa: PLE0604 - the names of the table above
    "__version__",
    "presets",
    *_HOME_OF,
]
__all__.sort()


def __getattr__(name: str) -> Any:
    # Names are fetched when first used, so that the command line answers before the libraries are loaded.
    if name in _HOME_OF:
        return getattr(import_module(f"tippetop.{_HOME_OF[name]}"), name)
    if name == "presets":
        return import_module("tippetop.presets")
    raise AttributeError(f"module 'tippetop' has no attribute {name!r}")


def __dir__() -> list[str]:
    return __all__
