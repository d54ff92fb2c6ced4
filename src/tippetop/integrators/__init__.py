"""Integrators by name: compiled by heyoka and by numba, collocation, SciPy's, and Runge and Kutta's."""

from importlib.util import find_spec

import numpy as np

from tippetop.errors import MISSING, InvalidInput, Unavailable, is_number, one_of
from tippetop.integrators.base import Arc, Guard, Integrator, Motion
from tippetop.interrupts import import_heard

__all__ = [
    "NAMES",
    "Arc",
    "Guard",
    "Integrator",
    "Motion",
    "default_name",
    "has_llvm",
    "has_numba",
    "has_taylor",
    "make_integrator",
    "relieved",
]

SCIPY_TOLERANCES = {"dop853": 1e-12, "rk45": 1e-10, "radau": 1e-9, "bdf": 1e-9, "lsoda": 1e-11}
"""SciPy's methods, with the relative error per step that each is given where nobody says."""

COMPILED_TOLERANCE = 1e-13
"""The relative error per step of the method that numba compiles, where nobody says."""

LEAST_SCIPY_TOLERANCE = 2.3e-14
"""Below this SciPy's solvers do not honour a relative tolerance."""

NAMES = ["taylor", "collocation", "compiled", *SCIPY_TOLERANCES, "rk4"]
"""The integrators by the names users give."""


def has_taylor() -> bool:
    """Whether heyoka, which compiles Taylor's method, is installed."""
    return find_spec("heyoka") is not None


def has_numba() -> bool:
    """Whether numba, which compiles Dormand and Prince's method, is installed."""
    return find_spec("numba") is not None


def has_llvm() -> bool:
    """Whether llvmlite, which compiles Taylor's method for many launches at once, is installed."""
    return find_spec("llvmlite") is not None


def default_name() -> str:
    """The best integrator that is installed."""
    if has_taylor():
        return "taylor"
    return "compiled" if has_numba() else "dop853"


def make_integrator(
    name: object = None,
    tolerance: float | None = None,
    step: float | None = None,
    time_unit: float = 1.0,
) -> Integrator:
    """Make an integrator.

    Parameters
    ----------
    name
        One of `NAMES`; None for the best installed, which "collocation" relieves where the motion is stiff.
    tolerance
        Relative error per step; None for the integrator's own default. Not for "rk4".
    step
        Step size of "rk4", s; for no other.
    time_unit
        The motion's unit of time, s.

    Raises
    ------
    InvalidInput
        If there is no such integrator, or it cannot have such a tolerance or step.
    Unavailable
        If it is not installed.
    """
    if name is None:
        return relieved(make_integrator(default_name(), tolerance, step, time_unit))
    if not isinstance(name, str) or name not in NAMES:
        raise InvalidInput("integrator", name, one_of(name, NAMES))
    if name == "rk4":
        if tolerance is not None:
            raise InvalidInput("tolerance", tolerance, "none with rk4, whose error follows from its step")
        if step is None or not (is_number(step) and step > 0):
            raise InvalidInput(
                "step",
                MISSING if step is None else step,
                "a step size in seconds greater than 0, which rk4 needs",
            )
        return _classical(step / time_unit)
    if step is not None:
        raise InvalidInput("step", step, f"none with {name}, which chooses its own")
    least = np.finfo(float).eps if name == "taylor" else LEAST_SCIPY_TOLERANCE
    if tolerance is not None and not (is_number(tolerance) and least <= tolerance < 1):
        raise InvalidInput("tolerance", tolerance, f"a number from {least:.2g} to 1 with {name}")
    if name == "taylor":
        return _taylor(tolerance)
    if name == "collocation":
        return _collocation(tolerance)
    if name == "compiled":
        return _compiled(COMPILED_TOLERANCE if tolerance is None else tolerance)
    return _scipy(name, SCIPY_TOLERANCES[name] if tolerance is None else tolerance)


def relieved(integrator: Integrator) -> Integrator:
    """The method, relieved by "collocation" where the motion is stiff."""
    from tippetop.integrators.relief import Relieved  # noqa: PLC0415 - it imports from here

    return integrator if isinstance(integrator, Relieved) else Relieved(integrator)


def _collocation(tolerance: float | None) -> Integrator:
    from tippetop.integrators.collocation import Collocation  # noqa: PLC0415 - slow to import

    return Collocation() if tolerance is None else Collocation(tolerance)


def _taylor(tolerance: float | None) -> Integrator:
    if not has_taylor():
        raise _missing("taylor", "heyoka")
    import_heard("tippetop.integrators.taylor")
    from tippetop.integrators.taylor import Taylor  # noqa: PLC0415 - optional, and slow to import

    return Taylor() if tolerance is None else Taylor(tolerance)


def _compiled(tolerance: float) -> Integrator:
    if not has_numba():
        raise _missing("compiled", "numba")
    from tippetop.integrators.compiled_runge_kutta import CompiledRungeKutta  # noqa: PLC0415 - optional

    return CompiledRungeKutta(tolerance)


def _missing(name: str, package: str) -> Unavailable:
    others = ", ".join(other for other in NAMES if other != name)
    return Unavailable(f"the integrator {name} needs {package}, which is not installed; accepted: {others}")


def _scipy(name: str, tolerance: float) -> Integrator:
    from tippetop.integrators.scipy_methods import SciPy  # noqa: PLC0415 - slow to import

    return SciPy(name, tolerance)


def _classical(step: float) -> Integrator:
    from tippetop.integrators.classical import ClassicalRK4  # noqa: PLC0415 - slow to import

    return ClassicalRK4(step)
