"""What friction laws, surfaces and events of one's own are made of.

Every name is imported from here: ``from tippetop.extend import FrictionLaw, Traction``, or used as
``tt.extend.Traction``. The page `Extend the program` shows one of each.

Laws and surfaces are functions in plain operators, which are run on floats and arrays and recorded
as expressions that are compiled. `where`, `abs`, `min`, `max` and `sqrt` of this module take all of
these; ``if``, Python's own ``min`` and ``max``, and functions of `math` and `numpy` do not.

Examples
--------
>>> import tippetop as tt
>>> tt.extend.max(1.0, 2.0), tt.extend.where(1.0 < 2.0, "slow", "fast")
(2.0, 'slow')
"""

from typing import Any

import numpy as np

from tippetop.graph.graph import Node
from tippetop.mechanics.laws.friction import NO_TORQUE as NO_TORQUE
from tippetop.mechanics.laws.friction import FrictionLaw as FrictionLaw
from tippetop.mechanics.laws.friction import Traction as Traction
from tippetop.mechanics.surfaces.surface import Surface as Surface
from tippetop.mechanics.units import Units as Units
from tippetop.mechanics.vectors import Horizontal as Horizontal
from tippetop.mechanics.vectors import Scalar as Scalar
from tippetop.mechanics.vectors import Vector as Vector
from tippetop.mechanics.vectors import power
from tippetop.problem.contact_rules import Contact as Contact
from tippetop.problem.frictions import Friction as Friction
from tippetop.problem.function_law import friction_law as friction_law
from tippetop.problem.shapes import Shape as Shape
from tippetop.results.event_functions import EventFunction as EventFunction
from tippetop.results.motion_state import MotionState as MotionState
from tippetop.support.errors import InvalidInput as InvalidInput
from tippetop.support.validation import NotNegative as NotNegative
from tippetop.support.validation import Number as Number
from tippetop.support.validation import Positive as Positive
from tippetop.support.validation import Quantity as Quantity


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
