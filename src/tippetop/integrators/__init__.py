"""Integrators by name: compiled by heyoka and by numba, collocation, SciPy's, and Runge and
Kutta's.
"""

from importlib.util import find_spec

from tippetop.integrators.base import TOLERANCES as TOLERANCES
from tippetop.integrators.base import Arc as Arc
from tippetop.integrators.base import Guard as Guard
from tippetop.integrators.base import Integrator as Integrator
from tippetop.integrators.base import Motion as Motion
from tippetop.integrators.base import require_tolerance
from tippetop.support.errors import MISSING, InvalidInput, Unavailable, is_number
from tippetop.support.interrupts import import_heard
from tippetop.support.suggestions import not_one_of

NAMES = [*TOLERANCES, "rk4"]
"""The integrators by the names users give."""


def has_taylor() -> bool:
    """Whether heyoka, which compiles Taylor's method, is installed."""
    return has_llvm()


def has_numba() -> bool:
    """Whether numba, which compiles Dormand and Prince's method, is installed."""
    return find_spec("numba") is not None


def has_llvm() -> bool:
    """Whether llvmlite, which compiles Taylor's method for many launches at once, is installed."""
    return find_spec("llvmlite") is not None


def default_name(analytic: bool = True) -> str:
    """The best integrator that is installed, for motions that are `analytic` or are not."""
    if analytic and has_taylor():
        return "taylor"
    return "compiled" if has_numba() else "dop853"


def make_integrator(
    name: object = None,
    tolerance: float | None = None,
    step: float | None = None,
    time_unit: float = 1.0,
    analytic: bool = True,
) -> Integrator:
    """Make an integrator.

    Parameters
    ----------
    name
        One of `NAMES`; None for the best installed, which "collocation" relieves where the motion
        is stiff.
    tolerance
        Relative error per step; None for the integrator's own default. Not for "rk4".
    step
        Step size of "rk4", s; for no other.
    time_unit
        The motion's unit of time, s.
    analytic
        Whether power series stand for the motions: not where a law chooses by the numbers.

    Raises
    ------
    InvalidInput
        If there is no such integrator, or it cannot have such a tolerance or step.
    Unavailable
        If it is not installed.
    """
    if name is None:
        from tippetop.integrators.relief import Relieved  # noqa: PLC0415 - slow to import

        return Relieved(make_integrator(default_name(analytic), tolerance, step, time_unit))
    if not isinstance(name, str) or name not in NAMES:
        raise not_one_of("integrator", name, NAMES)
    if name == "taylor" and not analytic:
        others = ", ".join(other for other in NAMES if other != name)
        fault = "does not see past the choices of the law or the surface"
        raise InvalidInput("integrator", name, f"one of {others}", fault)
    if name == "rk4":
        if tolerance is not None:
            raise InvalidInput(
                "tolerance",
                tolerance,
                "none",
                "is for other integrators than rk4, whose error follows from its step",
                "leave it out",
            )
        if step is None or not (is_number(step) and step > 0):
            raise InvalidInput(
                "step",
                MISSING if step is None else step,
                "a step size in seconds greater than 0, which rk4 needs",
            )
        from tippetop.integrators.classical import ClassicalRK4  # noqa: PLC0415 - slow to import

        return ClassicalRK4(step / time_unit)
    if step is not None:
        raise InvalidInput(
            "step", step, "none", f"is for rk4 alone: {name} chooses its own steps", "leave it out"
        )
    if tolerance is not None:
        require_tolerance(tolerance, name)
    return _adaptive(name, TOLERANCES[name] if tolerance is None else float(tolerance))


def _adaptive(name: str, tolerance: float) -> Integrator:
    """An integrator that chooses its steps; they are imported when asked for, which is slow."""
    for needing, package, there in (
        ("taylor", "llvmlite", has_taylor),
        ("compiled", "numba", has_numba),
    ):
        if name == needing and not there():
            others = ", ".join(other for other in NAMES if other != name)
            raise Unavailable(
                f"the integrator {name} needs {package}, which is not installed (write one of"
                f" {others})"
            )
    match name:
        case "taylor":
            import_heard("tippetop.integrators.taylor")
            from tippetop.integrators.taylor import Taylor  # noqa: PLC0415

            return Taylor(tolerance)
        case "collocation":
            from tippetop.integrators.collocation import Collocation  # noqa: PLC0415

            return Collocation(tolerance)
        case "compiled":
            from tippetop.integrators.compiled_runge_kutta import CompiledRungeKutta  # noqa: PLC0415

            return CompiledRungeKutta(tolerance)
    from tippetop.integrators.scipy_methods import SciPy  # noqa: PLC0415

    return SciPy(name, tolerance)
