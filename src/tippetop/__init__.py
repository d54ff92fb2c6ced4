"""tippetop: a laboratory for the tippe top.

`Problem` and its parts state the physics, `simulate` runs it, and the result is an
`xarray.Dataset`, which `summarize`, `plot` and `view` show and `write_run` keeps. `sweep` follows
many launches at once; `predict`, `critical_spins` and `steady_states` say what is known of a launch
without a run.
"""

import lazy_loader

__version__ = "0.1.0"

# Names are fetched when first used, so that the command line answers before the libraries are
# loaded.
__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
