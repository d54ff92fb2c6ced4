"""Integrators by name: Taylor's method, collocation, SciPy's, and Runge and Kutta's."""

from tippetop.integrators.base import TOLERANCES as TOLERANCES
from tippetop.integrators.base import Arc as Arc
from tippetop.integrators.base import Guard as Guard
from tippetop.integrators.base import Integrator as Integrator
from tippetop.integrators.base import Motion as Motion
from tippetop.integrators.base import require_tolerance
from tippetop.support.errors import MISSING, InvalidInput, is_number
from tippetop.support.interrupts import import_interruptibly
from tippetop.support.suggestions import not_one_of

NAMES = [*TOLERANCES, "rk4"]
"""The integrators by the names users give."""

DEFAULT = "taylor"
"""The integrator where nobody names one."""


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
        One of `NAMES`; None for `DEFAULT`, which "collocation" relieves where the motion is stiff.
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
    """
    if name is None:
        from tippetop.integrators.relief import Relieved  # noqa: PLC0415 - slow to import

        return Relieved(make_integrator(DEFAULT, tolerance, step, time_unit))
    if not isinstance(name, str) or name not in NAMES:
        raise not_one_of("integrator", name, NAMES)
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
    """Make an integrator that chooses its steps; its module is imported only now, which is slow."""
    match name:
        case "taylor":
            import_interruptibly("tippetop.integrators.taylor")
            from tippetop.integrators.taylor import Taylor  # noqa: PLC0415

            return Taylor(tolerance)
        case "collocation":
            from tippetop.integrators.collocation import Collocation  # noqa: PLC0415

            return Collocation(tolerance)
    from tippetop.integrators.scipy_methods import SciPy  # noqa: PLC0415

    return SciPy(name, tolerance)
