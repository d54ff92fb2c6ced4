"""A conical stem, friction of a grooved table and a third surface, defined here alone."""

from typing import Annotated, Literal, NamedTuple, Self

import numpy as np
import pytest

import tippetop as tt
from tippetop.extend import (
    NO_TORQUE,
    FrictionLaw,
    Horizontal,
    Positive,
    Quantity,
    Scalar,
    Surface,
    Traction,
    Units,
    Vector,
)

ROUNDED = 0.02
"""Half-axis of the base of the cone along the axis, and rounding of its side, in base radii."""


class ConeSurface(NamedTuple):
    """A rounded cone: the smooth maximum of the support functions of its base and of its tip.

    h = (a + b)/2 + sqrt((a - b)^2/4 + d^2) with a = sqrt(r^2 s^2 + d^2 c^2) - base c and
    b = t - tip c, where d = `ROUNDED` r: convex, as a maximum of convex functions is.
    """

    radius: Scalar
    """Radius r of the base, m."""
    base: Scalar
    tip: Scalar
    """Heights of the base and of the tip's centre above the centre of mass, along the axis, m."""
    tip_radius: Scalar
    """Radius t of the tip, m."""

    def height(self, c: Scalar) -> Scalar:
        total, difference = self._parts(c)[0]
        return 0.5 * (total + self._root(difference))

    def slope(self, c: Scalar) -> Scalar:
        (_, difference), (total1, difference1), _ = self._parts(c)
        return 0.5 * (total1 + difference * difference1 / self._root(difference))

    def curvature(self, c: Scalar) -> Scalar:
        (_, difference), (_, difference1), second = self._parts(c)
        root = self._root(difference)
        across = 2.0 * ROUNDED * self.radius * difference1
        return 0.5 * (second + difference * second / root + across * across / root**3)

    def _root(self, difference: Scalar) -> Scalar:
        """sqrt((a - b)^2 + 4 d^2)."""
        return (difference * difference + (2.0 * ROUNDED * self.radius) ** 2) ** 0.5

    def _parts(self, c: Scalar) -> tuple[tuple[Scalar, Scalar], tuple[Scalar, Scalar], Scalar]:
        """a + b and a - b, their derivatives, and the second one, which they have in common."""
        small = ROUNDED * ROUNDED
        disk = self.radius * (1.0 - (1.0 - small) * c * c) ** 0.5
        disk1 = -self.radius * self.radius * (1.0 - small) * c / disk
        disk2 = -(self.radius**4) * (1.0 - small) / disk**3
        one, other = disk - self.base * c, self.tip_radius - self.tip * c
        one1, other1 = disk1 - self.base, -self.tip
        return (one + other, one - other), (one1 + other1, one1 - other1), disk2

    @property
    def spherical(self) -> bool:
        return False

    @property
    def size(self) -> Scalar:
        return self.radius

    @property
    def proportions(self) -> tuple[Scalar, ...]:
        return tuple([number / self.radius for number in self[1:]])

    @classmethod
    def from_proportions(cls, proportions: tuple[Scalar, ...]) -> Self:
        return cls(1.0, *proportions)


class Cone(tt.Shape):
    kind: Literal["cone"] = "cone"
    radius: Positive
    base: float
    tip: float
    tip_radius: Positive

    @property
    def surface(self) -> Surface:
        return ConeSurface(self.radius, self.base, self.tip, self.tip_radius)


class GroovedLaw(NamedTuple):
    """Viscous friction that differs along x and y: f = -(mu_x v_x, mu_y v_y)."""

    mu_x: Scalar
    mu_y: Scalar

    @property
    def torque_free(self) -> bool:
        return True

    def traction(self, slip: Horizontal, angular_velocity: Vector) -> Traction:
        return Traction((-self.mu_x * slip[0], -self.mu_y * slip[1]), NO_TORQUE)

    def coefficients(self, units: Units) -> tuple[Scalar, ...]:
        return (self.mu_x * units.speed, self.mu_y * units.speed)


class GroovedFriction(tt.Friction):
    kind: Literal["grooved"] = "grooved"
    mu_x: Annotated[Positive, Quantity("s/m", "friction coefficient along x")]
    mu_y: Annotated[Positive, Quantity("s/m", "friction coefficient along y")]

    @property
    def law(self) -> FrictionLaw:
        return GroovedLaw(self.mu_x, self.mu_y)


class PearSurface(NamedTuple):
    """A sphere with a blunt end: h = r - bump c^3."""

    radius: Scalar
    """Radius r, m."""
    bump: Scalar
    """Height of the blunt end, m."""

    def height(self, c: Scalar) -> Scalar:
        return self.radius - self.bump * c**3

    def slope(self, c: Scalar) -> Scalar:
        return -3.0 * self.bump * c**2

    def curvature(self, c: Scalar) -> Scalar:
        return -6.0 * self.bump * c

    @property
    def spherical(self) -> bool:
        return False

    @property
    def size(self) -> Scalar:
        return self.radius

    @property
    def proportions(self) -> tuple[Scalar, ...]:
        return (self.bump / self.radius,)

    @classmethod
    def from_proportions(cls, proportions: tuple[Scalar, ...]) -> Self:
        return cls(1.0, *proportions)


class Pear(tt.Shape):
    kind: Literal["pear"] = "pear"
    radius: Positive
    bump: float

    @property
    def surface(self) -> Surface:
        return PearSurface(self.radius, self.bump)


CONE = ConeSurface(0.006, 0.012, 0.026, 0.001)
BODY = tt.Body(
    mass=0.02,
    I1=3.6e-6,
    I3=3.2e-6,
    shape=[
        tt.Sphere(radius=0.015, center=0.003),
        Cone(radius=0.006, base=0.012, tip=0.026, tip_radius=0.001),
        tt.Ring(radius=0.0145, center=0.006, tube=0.0005),
    ],
)
FALLING = tt.Problem(
    body=BODY,
    friction=GroovedFriction(mu_x=0.1, mu_y=0.4),
    launch=tt.Launch(tilt=1.9, spin=30.0),
)


def test_the_support_function_of_the_cone() -> None:
    """It reaches its tip and its base, and has the derivatives that difference quotients have."""
    assert CONE.height(-1.0) == pytest.approx(0.027, rel=1e-2)
    assert CONE.height(0.0) == pytest.approx(0.006, rel=1e-2)
    c, step = np.linspace(-0.9, 0.9, 41), 1e-6
    for value, derivative in ((CONE.height, CONE.slope), (CONE.slope, CONE.curvature)):
        quotient = (value(c + step) - value(c - step)) / (2.0 * step)
        np.testing.assert_allclose(derivative(c), quotient, rtol=0, atol=1e-7)
    # The sum of the radii of curvature h + h'' s^2 - h' c, of the generator, is positive.
    assert (CONE.height(c) + CONE.curvature(c) * (1 - c * c) - CONE.slope(c) * c).min() > 0.0


def test_all_three_surfaces_touch_and_energy_balances() -> None:
    run = tt.simulate(FALLING, 1.0, samples=201)
    assert run.attrs["status"] == "completed"
    assert set(run["event_surface"].values.tolist()) == {0, 1, 2}
    assert float(run["gap"].min()) > -1e-12 * 0.015
    assert float(run["energy_error"]) < 1e-10
    assert float(run["energy_lost"]) > 0.0


def test_friction_is_that_of_the_grooved_table() -> None:
    """The contact force over the normal force is -(mu_x v_x, mu_y v_y) while one surface slides."""
    run = tt.simulate(FALLING.replace({"launch.tilt": 0.4}), 0.2, samples=51)
    slides = run["mode"].values == "sliding_on_0"
    assert slides.sum() > 10
    n, spin = run["axis"].values[slides], run["angular_momentum"].values[slides]
    along = (1.0 / BODY.I3 - 1.0 / BODY.I1) * np.sum(n * spin, axis=1)
    omega = spin / BODY.I1 + along[:, None] * n
    arm = 0.003 * n - [0.0, 0.0, 0.015]
    slip = (run["velocity"].values[slides] + np.cross(omega, arm))[:, :2]
    force = run["contact_force"].values[slides]
    np.testing.assert_allclose(
        force[:, :2], -force[:, 2:] * [0.1, 0.4] * slip, rtol=1e-9, atol=1e-9
    )


@pytest.mark.parametrize("upwards", [0.0, 0.1])
def test_whole_powers_are_smooth_where_the_axis_is_level(upwards: float) -> None:
    """The axis is level at launch, on the table or thrown upwards: c = 0 divides nothing."""
    problem = tt.Problem(
        body=tt.Body(mass=0.02, I1=3.5e-6, I3=3.2e-6, shape=Pear(radius=0.02, bump=1e-3)),
        friction=tt.ViscousFriction(mu=0.3),
        launch=tt.Launch(
            tilt=np.pi / 2, spin=20.0, precession=3.0, tilt_rate=-8.0, velocity=(0.01, 0.0, upwards)
        ),
    )
    run = tt.simulate(problem, 0.1, samples=11)
    assert run.attrs["status"] == "completed", run.attrs["message"]
    assert float(run["energy_error"]) < 1e-12
    assert float(run["gap"].min()) > -1e-14
    assert int(run["flights"]) >= (upwards > 0.0)


def test_a_surface_with_a_whole_power_flies_from_level_as_its_gap_says() -> None:
    """Thrown up off the table without turning, it lands after 2 u / g; and as a single launch in a
    sweep.
    """
    body = tt.Body(mass=0.02, I1=3e-6, I3=3e-6, shape=Pear(radius=0.02, bump=1e-3))
    launch = tt.Launch(tilt=np.pi / 2, spin=0.0, velocity=(0.0, 0.0, 0.5))
    problem = tt.Problem(body=body, friction=tt.ViscousFriction(mu=0.3), launch=launch)
    run = tt.simulate(problem, 0.15)
    assert run.attrs["status"] == "completed"
    touch = 2 * 0.5 / problem.gravity
    assert float(run.event_time[0]) == pytest.approx(touch, rel=1e-12)
    turning = problem.replace({"launch.tilt_rate": 20.0, "contact.restitution": 0.4})
    runs = tt.simulate(turning, 0.15, samples=3)
    swept = tt.sweep(turning, {"gravity": [problem.gravity]}, duration=0.15, tolerance=1e-12)
    assert swept.outcome.values[0] in ("moving_tilted", "moving_upright", "moving_inverted")
    for name in ("airborne_time", "max_gap", "final_tilt"):
        assert float(swept[name][0]) == pytest.approx(float(runs[name]), rel=1e-8), name
