"""Sweeps: what becomes of many launches, over grids or random draws of any of a problem's numbers.

`sweep` sweeps fields of a problem over values. `Sweep` says what to compute, `compute` does it in
memory, and `fill` in a `Store`, which survives whatever happens to the program.
"""

from tippetop.results.catalogue import SWEPT as SWEPT
from tippetop.results.catalogue import Fault as Fault
from tippetop.results.catalogue import Outcome as Outcome
from tippetop.sweeps.axes import Axis as Axis
from tippetop.sweeps.definition import Sweep as Sweep
from tippetop.sweeps.draws import Draws as Draws
from tippetop.sweeps.grid import Product as Product
from tippetop.sweeps.run_sweep import Progress as Progress
from tippetop.sweeps.run_sweep import compute as compute
from tippetop.sweeps.run_sweep import fill as fill
from tippetop.sweeps.run_sweep import sweep as sweep
from tippetop.sweeps.store import Store as Store
from tippetop.sweeps.store import read_sweep as read_sweep
