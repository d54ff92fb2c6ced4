"""Building blocks of friction laws, surfaces, contact modes, integrators and events of your own.

Every name is imported from this module, ``from tippetop.extend import FrictionLaw, Traction``, or
used as ``tt.extend.Traction``. The page `Extend the program` shows one of each.

Laws, surfaces and equations of motion are functions in plain operators, which run on floats and
arrays and are recorded as expressions to be compiled. `where`, `abs`, `min`, `max`, `sqrt`,
`exp`, `log` and `tanh` of this module accept all of these; ``if``, Python's own ``min`` and
``max``, and functions of `math` and `numpy` do not.

The names in `__all__`, their parameters and the attributes that the documentation lists are
stable: code that uses only them keeps working within a major version. A name that must go is
deprecated first: for at least one minor version it still works, with a `DeprecationWarning` that
names its successor, and the changelog says so. Other modules of the package may change at any time.

Examples
--------
>>> import tippetop as tt
>>> tt.extend.max(1.0, 2.0), tt.extend.where(1.0 < 2.0, "slow", "fast")
(2.0, 'slow')
"""

from typing import Any

import numpy as np

from tippetop.contact.automaton import Automaton
from tippetop.contact.mode import Event, IntegratedMode, Mode, ModeEnd, Reaction, Transition
from tippetop.graph.graph import Node
from tippetop.integrators import make_integrator
from tippetop.integrators.base import Arc, Guard, Integrator, Motion
from tippetop.integrators.dense import DenseSolution
from tippetop.mechanics import elementary
from tippetop.mechanics.laws.friction import NO_TORQUE, FrictionLaw, Traction
from tippetop.mechanics.motion import (
    SlidingContact,
    axis_rate,
    on_table,
    sliding_contact,
    sliding_rates,
)
from tippetop.mechanics.natural_units import Units
from tippetop.mechanics.state import SlidingState, State
from tippetop.mechanics.surfaces.surface import Surface
from tippetop.mechanics.top import Kind, Top
from tippetop.mechanics.vectors import Horizontal, Row, Scalar, Vector, power
from tippetop.problem.contact_rules import Contact
from tippetop.problem.frictions import Friction
from tippetop.problem.function_law import friction_law
from tippetop.problem.shapes import Shape
from tippetop.results.event_functions import EventFunction
from tippetop.results.motion_state import MotionState
from tippetop.support.errors import InvalidInput
from tippetop.support.validation import NotNegative, Number, Positive, Quantity

__all__ = [
    "NO_TORQUE",
    "Arc",
    "Automaton",
    "Contact",
    "DenseSolution",
    "Event",
    "EventFunction",
    "Friction",
    "FrictionLaw",
    "Guard",
    "Horizontal",
    "IntegratedMode",
    "Integrator",
    "InvalidInput",
    "Kind",
    "Mode",
    "ModeEnd",
    "Motion",
    "MotionState",
    "NotNegative",
    "Number",
    "Positive",
    "Quantity",
    "Reaction",
    "Row",
    "Scalar",
    "Shape",
    "SlidingContact",
    "SlidingState",
    "State",
    "Surface",
    "Top",
    "Traction",
    "Transition",
    "Units",
    "Vector",
    "abs",
    "axis_rate",
    "exp",
    "friction_law",
    "log",
    "make_integrator",
    "max",
    "min",
    "on_table",
    "sliding_contact",
    "sliding_rates",
    "sqrt",
    "tanh",
    "where",
]


def where(condition: Any, a: Scalar, b: Scalar) -> Scalar:
    """Return the first number where a condition holds, else the second.

    The condition is a comparison by < or >. Taylor's method ends a step where the choice changes;
    other integrators take shorter steps there.

    Examples
    --------
    >>> import numpy as np
    >>> import tippetop as tt
    >>> slip = np.array([0.1, 2.0])
    >>> tt.extend.where(slip < 1.0, slip, 1.0)
    array([0.1, 1. ])
    """
    if isinstance(condition, Node):
        return condition.graph.select(condition, a, b)
    if isinstance(condition, np.ndarray):
        return np.where(condition, a, b)
    return a if condition else b


def abs(number: Scalar) -> Scalar:  # noqa: A001 - it takes the place of Python's
    """Return the absolute value of a number.

    Examples
    --------
    >>> import tippetop as tt
    >>> tt.extend.abs(-0.5)
    0.5
    """
    return where(number < 0.0, -number, number)


def min(a: Scalar, b: Scalar) -> Scalar:  # noqa: A001 - it takes the place of Python's
    """Return the smaller of two numbers.

    Examples
    --------
    >>> import tippetop as tt
    >>> tt.extend.min(0.5, 2)
    0.5
    """
    return where(b < a, b, a)


def max(a: Scalar, b: Scalar) -> Scalar:  # noqa: A001 - it takes the place of Python's
    """Return the larger of two numbers.

    Examples
    --------
    >>> import tippetop as tt
    >>> tt.extend.max(0.5, 2)
    2
    """
    return where(a < b, b, a)


def sqrt(number: Scalar) -> Scalar:
    """Return the square root of a number that is not negative; no number of a negative one.

    Examples
    --------
    >>> import tippetop as tt
    >>> tt.extend.sqrt(2.25)
    1.5
    """
    return power(number, 0.5)


def exp(number: Scalar) -> Scalar:
    """Return the exponential function of a number; infinity where it is larger than any float.

    Examples
    --------
    Exponential Stribeck friction: the coefficient falls from `still` to `fast` as slip grows
    beyond the speed `slow`, and the smallest slips are smoothed below the speed `smooth`.

    >>> import tippetop as tt
    >>> @tt.extend.friction_law(still="1", fast="1", slow="m s-1", smooth="m s-1")
    ... def stribeck_exponential(slip, angular_velocity, still, fast, slow, smooth):
    ...     squared = slip[0] ** 2 + slip[1] ** 2
    ...     mu = fast + (still - fast) * tt.extend.exp(-squared / slow**2)
    ...     factor = -mu / tt.extend.sqrt(squared + smooth**2)
    ...     return factor * slip[0], factor * slip[1]
    >>> tt.extend.exp(0.0)
    1.0
    """
    return elementary.exp(number)


def log(number: Scalar) -> Scalar:
    """Return the natural logarithm; minus infinity of 0, and no number of a negative one.

    Examples
    --------
    >>> import tippetop as tt
    >>> tt.extend.log(1.0)
    0.0
    """
    return elementary.log(number)


def tanh(number: Scalar) -> Scalar:
    """Return the hyperbolic tangent of a number.

    Examples
    --------
    >>> import tippetop as tt
    >>> tt.extend.tanh(0.0)
    0.0
    """
    return elementary.tanh(number)
