"""What is summed up along a run: the catalogue of its integrals."""

# translate module: numbers

from typing import NamedTuple

from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Scalar

INTEGRALS = 7
"""How many of the sums, from the first on, are integrals. Their rates are at the same places in
`tippetop.contact.readings.Rates`; the other sums change in impacts alone.
"""


class RunSums(NamedTuple):
    """What is summed up along a run from launch on, in natural units."""

    x: Scalar
    y: Scalar
    """Horizontal position of the centre of mass."""
    turn: Scalar
    """Angle psi about the axis, in the chart of a pole (see `tippetop.mechanics.quadratures`)."""
    work: Scalar
    """Work of the contact force, impacts included."""
    drilling: Scalar
    rolling: Scalar
    """Work of drilling and of rolling friction, which are not positive."""
    air: Scalar
    """Work of air, which is not positive."""
    struck: Scalar
    """Energy lost in impacts."""

    @classmethod
    def at_launch(cls, turn: float, lost: float) -> "RunSums":
        """Return the sums at launch, for the angle there and the energy lost in an impact there."""
        return cls(0.0, 0.0, turn, -lost, 0.0, 0.0, 0.0, lost)

    @property
    def losses(self) -> tuple[Scalar, Scalar, Scalar]:
        """Energy lost to drilling, to rolling and to air."""
        return 0.0 - self.drilling, 0.0 - self.rolling, 0.0 - self.air

    def descent_work(self, top: Top) -> Scalar:
        """Work of gravity along the table; of a top in the same units."""
        if top.field is None or top.field.slope is None:
            return 0.0
        return top.mass * (top.field.slope[0] * self.x + top.field.slope[1] * self.y)

    def total_work(self, top: Top) -> Scalar:
        """Work of all forces but the weight along the table's normal, impacts included."""
        return self.work if top.field is None else self.work + self.air + self.descent_work(top)
