"""Friction laws that a user writes as one function."""

import inspect
from collections.abc import Callable
from typing import Annotated, Any, ClassVar, Literal, Self

from pydantic import create_model

from tippetop.mechanics.laws.friction import NO_TORQUE, FrictionLaw, Traction
from tippetop.mechanics.natural_units import Units
from tippetop.mechanics.vectors import Horizontal, Scalar, Vector
from tippetop.problem.frictions import Friction
from tippetop.support.errors import Described, InvalidInput
from tippetop.support.suggestions import not_one_of
from tippetop.support.units import KINDS, exponents_of
from tippetop.support.validation import Number, Quantity

Force = Callable[..., tuple[Scalar, Scalar]]
"""Function of the slip velocity, the angular velocity and the coefficients that returns the
friction force per unit normal force.
"""

RESERVED_NAMES = {"kind", "law", *dir(Friction)}
"""Names that no coefficient can have."""


class FunctionLaw(tuple[Scalar, ...]):
    """Law whose force is a function: a tuple of its coefficients."""

    force: ClassVar[Force]
    exponents: ClassVar[dict[str, tuple[int, ...]]]
    """Powers of metre, kilogram and second in the unit of each coefficient, by its name."""

    torque_free = True

    def __new__(cls, *coefficients: Scalar) -> Self:
        """Make the law from its coefficients, in their order."""
        return super().__new__(cls, coefficients)

    def traction(self, slip: Horizontal, angular_velocity: Vector) -> Traction:
        """Return the force and torque per unit normal force."""
        coefficients = dict(zip(self.exponents, self, strict=True))
        x, y = type(self).force(slip, angular_velocity, **coefficients)
        return Traction((x, y), NO_TORQUE)

    def coefficients(self, units: Units) -> tuple[Scalar, ...]:
        """Return the coefficients in these units."""
        return tuple(
            value / (units.length**length * units.mass**mass * units.time**time)
            for value, (length, mass, time, _) in zip(self, self.exponents.values(), strict=True)
        )


def friction_law(**units: str) -> Callable[[Force], type[Friction]]:
    """Return a decorator that makes a kind of friction without torque from a function.

    The function takes the slip velocity of the contact point, m/s, as its two horizontal
    components, the angular velocity, rad/s, as three, and the coefficients of the law by their
    names. It returns the two components of the friction force per unit normal force. Its name is
    the `kind` of the friction. A law with a torque is a class: see `tippetop.extend.FrictionLaw`.
    Apart from arithmetic and powers by numbers it may use `where`, `abs`, `min`, `max`, `sqrt`,
    `exp`, `log` and `tanh` of `tippetop.extend`: it is recorded as expressions, which are compiled.

    Parameters
    ----------
    units
        The SI unit of every coefficient, by its name: "1" for a pure number, "m s-1" for a speed.

    Raises
    ------
    InvalidInput
        If the function does not take these coefficients, or a unit or a name is not accepted.

    Examples
    --------
    >>> import tippetop as tt
    >>> @tt.extend.friction_law(mu="1", full="m s-1")
    ... def ramp(slip, angular_velocity, mu, full):
    ...     speed = tt.extend.sqrt(slip[0] ** 2 + slip[1] ** 2)
    ...     factor = -mu / tt.extend.max(speed, full)
    ...     return factor * slip[0], factor * slip[1]
    >>> problem = tt.presets.report_problem().replace({"friction": ramp(mu=0.3, full=0.01)})
    >>> problem.friction.kind, problem.friction.full
    ('ramp', 0.01)
    """
    for name, unit in units.items():
        if name in RESERVED_NAMES or name.startswith("_"):
            raise InvalidInput(name, Described("this name"), "another name for a coefficient")
        if unit not in KINDS:
            raise not_one_of(name, unit, list(KINDS))

    def kind_of(force: Force) -> type[Friction]:
        names = [*inspect.signature(force).parameters][2:]
        word = force.__name__
        if set(names) != set(units):
            shown = Described(f"a function of the coefficients {', '.join(names) or 'none'}")
            raise InvalidInput(word, shown, f"those with a unit: {', '.join(units) or 'none'}")
        home = {"__module__": force.__module__, "__qualname__": force.__qualname__}
        exponents = {name: exponents_of(unit) for name, unit in units.items()}
        law = type(
            word,
            (FunctionLaw,),
            {**home, "force": staticmethod(force), "exponents": exponents},
        )
        fields: dict[str, Any] = {"kind": (Literal[word], word)}
        fields |= {
            name: (Annotated[Number, Quantity(unit, name)], ...) for name, unit in units.items()
        }

        def make_law(friction: Friction) -> FrictionLaw:
            made: FrictionLaw = law(*(getattr(friction, name) for name in units))
            return made

        shell = type(word, (), {"law": property(make_law)})
        make: Any = create_model  # its signature is for fields that a type checker knows
        kind: type[Friction] = make(
            word,
            __base__=(shell, Friction),
            __module__=force.__module__,
            __doc__=force.__doc__,
            **fields,
        )
        kind.__qualname__ = force.__qualname__
        return kind

    return kind_of
