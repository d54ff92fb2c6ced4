"""What is summed up along a run: the catalogue of its integrals."""

# translate module: numbers

from typing import NamedTuple

from tippetop.mechanics.vectors import Scalar

INTEGRALS = 6
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
    struck: Scalar
    """Energy lost in impacts."""

    @classmethod
    def at_launch(cls, turn: float, lost: float) -> "RunSums":
        """Return the sums at launch, for the angle there and the energy lost in an impact there."""
        return cls(0.0, 0.0, turn, -lost, 0.0, 0.0, lost)

    @property
    def losses(self) -> tuple[Scalar, Scalar]:
        """Energy lost to drilling and to rolling."""
        return 0.0 - self.drilling, 0.0 - self.rolling
