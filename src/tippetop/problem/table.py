"""The table of a problem: level, or a plane that slopes."""

import math
from typing import Annotated

from pydantic import Field

from tippetop.mechanics.vectors import Functions, Horizontal, Scalar
from tippetop.support.validation import NO_WORD, Number, Part, Quantity

Slope = Annotated[float, Field(ge=0, lt=0.5 * math.pi), NO_WORD]


class Table(Part):
    """A plane table. Its normal is z: on a slope gravity is not along z.

    Attributes
    ----------
    slope
        Angle between the table's normal and the vertical, rad, in [0, pi/2).
    azimuth
        Direction along the table in which it falls most steeply, measured from x like the azimuth
        of the axis, rad.

    Tilt, height and all other variables are those of the table: the tilt is the angle between the
    axis and the table's normal.

    Examples
    --------
    >>> import tippetop as tt
    >>> upright = tt.presets.report_problem(tilt=0.0)
    >>> sloping = upright.replace({"table.slope": "1 deg"})
    >>> run = tt.simulate(sloping, duration=2.0)
    >>> bool(run["y"][-1] < -0.05)  # it drifts across the slope, to the right of the way down
    True
    """

    slope: Annotated[Slope, Quantity("rad", "slope of the table")] = 0.0
    azimuth: Annotated[Number, Quantity("rad", "azimuth in which the table falls")] = 0.0

    @property
    def is_level(self) -> bool:
        """Whether gravity is along the table's normal."""
        return isinstance(self.slope, (int, float)) and not self.slope

    def along(self, gravity: Scalar, functions: Functions) -> Horizontal | None:
        """Return the acceleration of gravity along the table, m/s^2; None on a level one."""
        if self.is_level:
            return None
        pull = gravity * functions.sin(self.slope)
        return (pull * functions.cos(self.azimuth), pull * functions.sin(self.azimuth))

    def normal(self, gravity: Scalar, functions: Functions) -> Scalar:
        """Return the acceleration of gravity along the table's normal, m/s^2."""
        return gravity if self.is_level else gravity * functions.cos(self.slope)
