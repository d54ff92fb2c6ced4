"""How a top is set on the table, as users state it, validated."""

import math
from typing import Annotated, Self

from pydantic import Field, model_validator

from tippetop.support.errors import InvalidInput
from tippetop.support.validation import NO_WORD, NotNegative, Number, Part, Quantity

Tilt = Annotated[float, Field(ge=0, le=math.pi), NO_WORD]

LEANING = (
    "along the direction into which the axis leans",
    "90 degrees to the left of the direction into which the axis leans",
)


class Launch(Part):
    """How the top is set on the table.

    Attributes
    ----------
    tilt
        Angle theta between the axis and the vertical, rad, in [0, pi].
    spin
        Axial spin omega3, rad/s.
    azimuth
        Direction phi into which the axis leans, rad.
    tilt_rate
        theta', rad/s.
    precession
        phi', rad/s.
    slip
        Slip velocity of the contact point, m/s: along the direction into which the axis leans, and
        90 degrees to the left of it.
    gap
        Height of the lowest point above the table, m: more than 0 for a top that is dropped or
        thrown.
    velocity
        Velocity of the centre of mass along x, y and z, m/s; it takes the place of `slip`. Without
        it the lowest point moves with the slip velocity and neither up nor down.

    Examples
    --------
    >>> import tippetop as tt
    >>> tt.Launch(tilt=0.1, spin=155.0).slip
    (0.0, 0.0)
    >>> dropped = tt.Launch(tilt=0.1, spin=155.0, gap=0.01)  # from 1 cm
    """

    tilt: Annotated[Tilt, Quantity("rad", "tilt of the axis at launch")]
    spin: Annotated[Number, Quantity("rad s-1", "axial spin at launch")]
    azimuth: Annotated[Number, Quantity("rad", "azimuth of the axis at launch")] = 0.0
    tilt_rate: Annotated[Number, Quantity("rad s-1", "rate of the tilt at launch")] = 0.0
    precession: Annotated[Number, Quantity("rad s-1", "precession at launch")] = 0.0
    slip: Annotated[
        tuple[Number, Number], Quantity("m s-1", "slip velocity at launch", LEANING)
    ] = (0.0, 0.0)
    gap: Annotated[NotNegative, Quantity("m", "height of the lowest point at launch")] = 0.0
    velocity: Annotated[
        tuple[Number, Number, Number] | None,
        Quantity(
            "m s-1", "velocity of the centre of mass at launch", ("along x", "along y", "along z")
        ),
    ] = None

    @model_validator(mode="after")
    def _moves_one_way(self) -> Self:
        if self.velocity is not None and self.slip != (0.0, 0.0):
            raise InvalidInput("slip", self.slip, "0 where velocity is given, which determines it")
        return self
