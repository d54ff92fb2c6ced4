"""Named bodies and problems.

"The report" is "The Dynamics of Tippe Top and Numerical Simulation", a student's project report.
"""

import math

from tippetop.problem.bodies import Body
from tippetop.problem.frictions import RegularizedCoulombFriction, ViscousFriction
from tippetop.problem.launch import Launch
from tippetop.problem.problem import Problem
from tippetop.problem.shapes import EccentricSphere, Ring, Sphere, Spheroid
from tippetop.support.suggestions import not_one_of

_MASS, _RADIUS = 0.02, 0.02
_TWO_FIFTHS = 2 / 5 * _MASS * _RADIUS**2
_TRANSVERSE = 131 / 350 * _MASS * _RADIUS**2

REPORT = Body(
    mass=_MASS,
    shape=EccentricSphere(radius=_RADIUS, eccentricity=0.3),
    I1=_TRANSVERSE,
    I3=_TWO_FIFTHS,
)
"""The top of the report "The Dynamics of Tippe Top and Numerical Simulation", a student's project
report: a sphere of 2 cm and 20 g, with the inertias of its listing, which give its results.
"""

REPORT_TABLE_1 = Body(
    mass=_MASS,
    shape=EccentricSphere(radius=_RADIUS, eccentricity=0.3),
    I1=_TWO_FIFTHS,
    I3=_TRANSVERSE,
)
"""The report's top as its Table 1 prints it, with the two inertias exchanged."""

LEINE_GLOCKER = Body(
    mass=6e-3, shape=EccentricSphere(radius=1.5e-2, eccentricity=0.2), I1=8e-7, I3=7e-7
)
"""The sphere of Leine and Glocker's top, whose centre of mass is 3 mm from the middle of 15 mm.

R. I. Leine and Ch. Glocker, "A set-valued force law for spatial Coulomb-Contensou friction",
European Journal of Mechanics A/Solids 22 (2003) 193-216. `LEINE_GLOCKER_STEM` has their second
sphere, the stem's.
"""


def _ball_with_tip(mass: float, ball: Sphere, tip: Sphere, I1: float, I3: float) -> Body:
    """Return a body of two spheres, the tip reaching out of the ball, with its profile."""
    (R, a), (r, b) = ((sphere.radius, sphere.center) for sphere in (ball, tip))
    seam = (R * R - r * r + b * b - a * a) / (2 * (b - a))
    around = math.sqrt(R * R - (seam - a) ** 2)
    profile = ((0.0, a - R), (R, a, R), (around, seam, R), (0.0, b + r, r))
    return Body(mass=mass, shape=(ball, tip), I1=I1, I3=I3, profile=profile)


_LEINE_BALL, _LEINE_TIP = Sphere(radius=1.5e-2, center=3e-3), Sphere(radius=5e-3, center=1.6e-2)

LEINE_GLOCKER_STEM = _ball_with_tip(6e-3, _LEINE_BALL, _LEINE_TIP, I1=8e-7, I3=7e-7)
"""Leine and Glocker's complete top: its sphere, and the smaller one at the end of the stem."""

FRIEDL = _ball_with_tip(6e-3, _LEINE_BALL, _LEINE_TIP, I1=9e-7, I3=7e-7)
"""Friedl's top that stops at an intermediate tilt: Leine and Glocker's with a larger I1.

C. Friedl, "Der Stehaufkreisel", thesis, University of Augsburg, 1997.
"""


def _report_with(tip: Sphere) -> Body:
    ball = Sphere(radius=_RADIUS, center=0.3 * _RADIUS)
    return _ball_with_tip(_MASS, ball, tip, I1=_TRANSVERSE, I3=_TWO_FIFTHS)


REPORT_STEM = _report_with(Sphere(radius=0.012, center=0.017))
"""The report's top with a blunt stem, on which it stands up when launched as in the report's Fig.
4.
"""

REPORT_THIN_STEM = _report_with(Sphere(radius=0.004, center=0.026))
"""The report's top with a thin stem, from which it falls back."""

COHEN = Body(
    mass=0.015, shape=EccentricSphere(radius=0.025, eccentricity=0.2), I1=3.75e-6, I3=3.75e-6
)
"""Cohen's top: I1 = I3 = 0.4 m R^2.

R. J. Cohen, "The tippe top revisited", American Journal of Physics 45 (1977) 12-17.
"""


def _bored_ball(diameter: float, bore: float, depth: float, spindle: float, height: float) -> Body:
    """Return a wooden ball with a flat bore and a spindle with a round end; lengths in inches."""
    ball, hole, stem = diameter / 2, bore / 2, spindle / 2
    mouth = math.sqrt(ball * ball - hole * hole)
    floor, end = mouth - depth, mouth + height
    outside = [(0.0, -ball), (ball, 0.0, ball), (hole, mouth, ball)]
    inside = [(hole, floor), (stem, floor), (stem, end - stem), (0.0, end, stem)]
    return Body.turned([*outside, *inside], density=720.0, unit="in")


WOODEN = _bored_ball(diameter=1.25, bore=0.875, depth=0.382, spindle=0.25, height=0.49)
"""A common wooden tippe top by a turner's measures: a ball of 31.75 mm, bored, with a spindle of
6.35 mm.

E. Pfau's table for balls of 1 1/4 inches (Waxhaw Woodturners, August 2011): spindle 1/4,
counterbore 7/8 and 0.382 deep, spindle 0.490 above it. The table does not say from where depth and
height are measured; here it is the counterbore's edge. The height over the diameter is then 1.249;
that of a sold top of 36 by 29 mm (Curious Minds, "Flip Over Top") is 1.241. Assumed are the round
end of the spindle and one wood for both parts, beech or hard maple of 720 kg/m^3. Mass, centre of
mass and inertias follow from the profile.
"""


def _cylinder(mass: float, radius: float, thickness: float) -> Body:
    """Return a solid cylinder with sharp edges, such as a disk, a coin or a rod."""
    edges = tuple(Ring(radius=radius, center=side * thickness / 2) for side in (-1, 1))
    return Body(
        mass=mass,
        shape=edges,
        I1=mass * (3 * radius**2 + thickness**2) / 12,
        I3=mass * radius**2 / 2,
    )


EULER_DISK = _cylinder(0.4, 0.0375, 0.0125)
"""Euler's disk, the toy, with the size and mass of H. K. Moffatt, Nature 404 (2000) 833-834.

A thickness of 12.5 mm and sharp edges are assumed; steel of 7,850 kg/m^3 would be 11.5 mm thick.
"""

COIN = _cylinder(7.5e-3, 0.023_25 / 2, 2.33e-3)
"""Coin of one euro by its specification: 7.5 g, 23.25 mm across, 2.33 mm thick.

Diameter and mass are those of Council Regulation (EC) No 975/98, the thickness that of the European
Central Bank's list of euro coins. A uniform density, flat faces and sharp edges are assumed.
"""

_BALL, _BALL_RADIUS = 0.032, 0.01


def _welded(radius: float, weld: float) -> tuple[tuple[float, ...], ...]:
    """Return the profile of two balls that are welded together at the centre of mass."""
    seam = radius - math.sqrt(radius**2 - weld**2)
    lower = ((0.0, -2 * radius), (radius, -radius, radius), (weld, -seam, radius))
    return (*lower, (weld, seam), (radius, radius, radius), (0.0, 2 * radius, radius))


HURRICANE_BALLS = Body(
    mass=2 * _BALL,
    shape=tuple(Sphere(radius=_BALL_RADIUS, center=side * _BALL_RADIUS) for side in (-1, 1)),
    I1=2 * (2 / 5 + 1) * _BALL * _BALL_RADIUS**2,
    I3=2 * 2 / 5 * _BALL * _BALL_RADIUS**2,
    profile=_welded(_BALL_RADIUS, weld=0.0015),
)
"""Two balls of steel, 20 mm across and 32 g each, welded together.

They are those of D. P. Jackson, D. Mertens and B. J. Pearson, American Journal of Physics 83 (2015)
959-968, except for their size, which is assumed, and the weld, which is only drawn: their rolling
depends on the radius alone.
"""

EGG = Body(
    mass=0.057,
    shape=Spheroid(across=0.022, along=0.028),
    I1=0.057 * (0.022**2 + 0.028**2) / 5,
    I3=2 / 5 * 0.057 * 0.022**2,
)
"""Hard-boiled hen's egg of common size, as a homogeneous spheroid.

Typical dimensions are assumed: 44 by 56 mm, and a mass within the class M of 53 to 63 g of
Commission Regulation (EC) No 589/2008. A real egg is blunter at one end, and not quite homogeneous.
"""

BODIES = {
    "report": REPORT,
    "report-table-1": REPORT_TABLE_1,
    "report-stem": REPORT_STEM,
    "report-thin-stem": REPORT_THIN_STEM,
    "leine-glocker": LEINE_GLOCKER,
    "leine-glocker-stem": LEINE_GLOCKER_STEM,
    "friedl": FRIEDL,
    "cohen": COHEN,
    "wooden": WOODEN,
    "euler-disk": EULER_DISK,
    "coin": COIN,
    "hurricane-balls": HURRICANE_BALLS,
    "egg": EGG,
}
"""The bodies by the names used on the command line."""


def body(name: str) -> Body:
    """Return the body of this name; raise `InvalidInput` if there is no such preset."""
    try:
        return BODIES[name]
    except (KeyError, TypeError):
        raise not_one_of("preset", name, list(BODIES)) from None


def report_problem(spin: float = 155.0, tilt: float = 0.1, mu: float = 0.3) -> Problem:
    """Return the report's problem, without tilt rate: spin in rad/s, tilt in rad, mu in s/m.

    The report is "The Dynamics of Tippe Top and Numerical Simulation", a student's project report.
    """
    return Problem(
        body=REPORT, friction=ViscousFriction(mu=mu), launch=Launch(tilt=tilt, spin=spin)
    )


def leine_glocker_problem(spin: float = 180.0, tilt: float = 0.1, mu: float = 0.3) -> Problem:
    """Return Leine and Glocker's top on regularized dry friction without drilling.

    Spin in rad/s, tilt in rad, mu a pure number. See `LEINE_GLOCKER` for the reference.
    """
    return Problem(
        body=LEINE_GLOCKER,
        friction=RegularizedCoulombFriction(mu=mu),
        launch=Launch(tilt=tilt, spin=spin),
        gravity=9.81,
    )
