"""The integrator where nobody has named one."""

# translate module: by hand in compile.js

from functools import lru_cache

from tippetop.integrators.base import Integrator


@lru_cache(maxsize=1)
def unnamed_integrator() -> Integrator:
    """Return the integrator that runs have unless they name another one."""
    from tippetop.integrators import make_integrator  # noqa: PLC0415 - imports this package

    return make_integrator()
