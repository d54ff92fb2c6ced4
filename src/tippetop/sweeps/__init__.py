"""Sweeps: what becomes of many launches, over grids or random draws of any of a problem's numbers.

`sweep` sweeps fields of a problem over values. `Sweep` says what to compute, `compute` does it in memory, and
`fill` in a `Store`, which survives whatever happens to the program.
"""

from tippetop.catalogue import SWEPT, Ending, Fault
from tippetop.sweeps.axes import Axis
from tippetop.sweeps.definition import Sweep
from tippetop.sweeps.grid import Draws, Product, Range
from tippetop.sweeps.layout import Status
from tippetop.sweeps.run import Progress, compute, fill, sweep
from tippetop.sweeps.store import Store, read_sweep

__all__ = [
    "SWEPT",
    "Axis",
    "Draws",
    "Ending",
    "Fault",
    "Product",
    "Progress",
    "Range",
    "Status",
    "Store",
    "Sweep",
    "compute",
    "fill",
    "read_sweep",
    "sweep",
]
