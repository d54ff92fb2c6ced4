"""Air that brakes a body, as users state it, and its estimate for a body of some size and rate."""

import math
from typing import Annotated, Any, Self

from tippetop.mechanics.field import Resistance
from tippetop.mechanics.surfaces.hull import each_surface, is_edge
from tippetop.mechanics.vectors import Scalar
from tippetop.problem.bodies import Body
from tippetop.support.errors import Described, InvalidInput, is_number, require
from tippetop.support.units import number_in, positive_in
from tippetop.support.validation import NotNegative, Part, Quantity

# translate: skip
COCHRAN = 1.94
"""Torque on both sides of a rotating disk over R^4 sqrt(rho^2 nu omega^3): half of the moment
coefficient 3.87 / sqrt(Re) (Cochran 1934).
"""

# translate: skip
DRAG_COEFFICIENT = 0.44
"""Drag coefficient of a sphere at Reynolds numbers u 2R / nu from 1e3 to 2e5 (Newton)."""

# translate: skip
LAMINAR_DISK, LAMINAR_SPHERE = 3e5, 5e4
"""Reynolds numbers omega R^2 / nu up to which the air beside a disk, or a sphere, is laminar."""


class Air(Part):
    """Air that brakes a body: it resists turning and moving, linearly and quadratically.

    The couple is ``-(linear + quadratic |w|) w`` for the part w of the angular velocity along the
    axis, and across it, and the force ``-(linear + quadratic |u|) u`` for the velocity u of the
    centre of mass.

    Attributes
    ----------
    axial_linear, axial_quadratic
        Resistance to the angular velocity about the axis, N m s and N m s^2.
    transverse_linear, transverse_quadratic
        Resistance to the angular velocity across the axis, N m s and N m s^2.
    drag_linear, drag_quadratic
        Resistance to the velocity of the centre of mass, N s/m and N s^2/m^2.

    Examples
    --------
    >>> import tippetop as tt
    >>> top = tt.presets.report_problem(spin=155.0)
    >>> braked = tt.Air.from_decay(top.body, time="60 s")  # its spin falls to 1/e in a minute
    >>> run = tt.simulate(top.replace({"air": braked.model_dump()}), duration=1.0)
    >>> bool(run["energy_lost_air"] > 0)
    True
    """

    axial_linear: Annotated[
        NotNegative, Quantity("N m s", "linear resistance of air to the spin about the axis")
    ] = 0.0
    axial_quadratic: Annotated[
        NotNegative, Quantity("N m s2", "quadratic resistance of air to the spin about the axis")
    ] = 0.0
    transverse_linear: Annotated[
        NotNegative, Quantity("N m s", "linear resistance of air to turning across the axis")
    ] = 0.0
    transverse_quadratic: Annotated[
        NotNegative, Quantity("N m s2", "quadratic resistance of air to turning across the axis")
    ] = 0.0
    drag_linear: Annotated[
        NotNegative, Quantity("N s m-1", "linear resistance of air to the velocity")
    ] = 0.0
    drag_quadratic: Annotated[
        NotNegative, Quantity("N s2 m-2", "quadratic resistance of air to the velocity")
    ] = 0.0

    @property
    def axial(self) -> Resistance | None:
        """Resistance to the angular velocity about the axis; None where there is none."""
        return _resistance(self.axial_linear, self.axial_quadratic)

    @property
    def transverse(self) -> Resistance | None:
        """Resistance to the angular velocity across the axis; None where there is none."""
        return _resistance(self.transverse_linear, self.transverse_quadratic)

    @property
    def drag(self) -> Resistance | None:
        """Resistance to the velocity; None where there is none."""
        return _resistance(self.drag_linear, self.drag_quadratic)

    # translate: skip
    @classmethod
    def from_decay(cls, body: Body, time: Any) -> Self:
        """Return the air that lets a body's spin about its axis decay exponentially.

        Parameters
        ----------
        body
            The body.
        time
            Time in which the spin falls to 1/e = 37 %, s: its half-life over ln 2.

        Notes
        -----
        That is the linear resistance I3 / time about the axis, as on a bearing without friction. A
        top on a table is braked by the table, too.

        Examples
        --------
        >>> import tippetop as tt
        >>> tt.Air.from_decay(tt.presets.REPORT, time="20 s").axial_linear
        1.6e-07
        """
        require("body", body, Body, "a Body, such as presets.REPORT")
        duration = number_in("time", time, "s")
        if not (is_number(duration) and duration > 0.0):
            raise InvalidInput("time", time, "a time greater than 0 s")
        return cls(axial_linear=body.I3 / duration)

    # translate: skip
    @classmethod
    def estimated(
        cls, body: Body, spin: Any, *, density: Any = 1.2, viscosity: Any = 1.8e-5
    ) -> Self:
        """Return an estimate of the air for a body of its size that spins at some rate.

        Parameters
        ----------
        body
            The body. One with an edge counts as a thin disk, any other as a sphere, of the radius R
            of the largest circle about the axis on which it can touch the table. Nothing else of
            its shape counts: of a tall body the air beside its side is left out, and so are stems,
            grooves and the table, which slows the air under the body.
        spin
            Angular velocity, rad/s, at which the torques and their slopes are met.
        density, viscosity
            Density rho, kg/m^3, and dynamic viscosity eta = rho nu, Pa s, of air.

        Raises
        ------
        InvalidInput
            If a number is not positive, or the air would be turbulent: beyond spin R^2 / nu = 3e5
            beside a disk, and 5e4 beside a sphere.

        Notes
        -----
        A disk has the torque 1.94 R^4 sqrt(rho^2 nu spin^3) on both sides together (Cochran 1934),
        to a few per cent from spin R^2 / nu = 1e3 on; much below, (32/3) eta R^3 spin. A sphere has
        the torque (6.45 Re^-1/2 + 32.1 Re^-1) rho R^5 spin^2 / 2 with Re = spin R^2 / nu (Dennis,
        Singh and Ingham 1980, for Re from 20 to 1000; beyond, it is within 2 % of boundary-layer
        theory), and 8 pi eta R^3 spin at small Re (Stokes). The same torque stands for turning
        across the axis, where that of a disk is not known better than by its order. The force is
        the sum of Stokes's, 6 pi eta R u, and Newton's, 0.22 pi rho R^2 u^2: within some per cent
        for u 2R / nu below 1 or from 1e3 to 2e5, and 40 % too small in between.

        Examples
        --------
        >>> import tippetop as tt
        >>> air = tt.Air.estimated(tt.presets.REPORT, spin=155.0)
        >>> torque = air.axial_linear * 155.0 + air.axial_quadratic * 155.0**2
        >>> f"{torque:.2g} N m"
        '5e-06 N m'
        """
        require("body", body, Body, "a Body, such as presets.REPORT")
        rate = number_in("spin", spin, "rad s-1")
        if not (is_number(rate) and rate != 0.0):
            raise InvalidInput("spin", spin, "a number other than 0")
        rate = abs(float(rate))
        rho = positive_in("density", density, "kg m-3")
        eta = positive_in("viscosity", viscosity, "Pa s")
        surfaces = each_surface(body.surface)
        is_disk = any(is_edge(surface) for surface in surfaces)
        radius = max(_widest(surface) for surface in surfaces)
        if not radius > 0.0:
            raise InvalidInput(
                "body",
                Described("one of sharp tips alone"),
                "one with a surface of some size, beside which the air moves",
            )
        reynolds = rate * radius**2 * rho / eta
        limit = LAMINAR_DISK if is_disk else LAMINAR_SPHERE
        if reynolds > limit:
            most = limit * eta / (rho * radius**2)
            raise InvalidInput(
                "spin",
                spin,
                f"at most {most:.4g} rad/s",
                "is so fast that the air beside this body is turbulent, for which there is no"
                " estimate",
            )
        stokes = (32.0 / 3.0 if is_disk else 8.0 * math.pi) * eta * radius**3 * rate
        root = math.sqrt(rho * eta * rate**3)
        if is_disk:  # torque of a boundary layer, and the part of it that is linear in the rate
            layer, linear = COCHRAN * radius**4 * root, 0.0
        else:
            layer, linear = 3.225 * radius**4 * root, 16.05 * eta * radius**3 * rate
        if stokes >= layer + linear:
            layer, linear = 0.0, stokes
        # The torque t w^(3/2) has the value and the slope of (t / 2) (w / w0 + (w / w0)^2) at w0.
        torque = (0.5 * layer + linear) / rate
        square = 0.5 * layer / rate**2
        return cls(
            axial_linear=torque,
            axial_quadratic=square,
            transverse_linear=torque,
            transverse_quadratic=square,
            drag_linear=6.0 * math.pi * eta * radius,
            drag_quadratic=0.5 * DRAG_COEFFICIENT * math.pi * rho * radius**2,
        )


def _resistance(linear: Scalar, quadratic: Scalar) -> Resistance | None:
    """Return a resistance with these coefficients; None where both are zero."""
    if _is_none(quadratic):
        return None if _is_none(linear) else Resistance(linear)
    return Resistance(linear, quadratic)


def _is_none(number: Scalar) -> bool:
    """Return whether a coefficient is the number zero, and no array."""
    return isinstance(number, (int, float)) and not number


# translate: skip
def _widest(surface: Any) -> float:
    """Return the radius of the largest circle of a surface about its axis, m."""
    return float(surface.height(0.0))
