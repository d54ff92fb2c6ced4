"""Bodies and problems known by name."""

from tippetop.bodies import Body, EccentricSphere, Ring, Shape, Sphere, Spheroid
from tippetop.errors import InvalidInput, one_of
from tippetop.frictions import RegularizedCoulombFriction, ViscousFriction
from tippetop.problem import Launch, Problem

_MASS, _RADIUS = 0.02, 0.02
_TWO_FIFTHS = 2 / 5 * _MASS * _RADIUS**2
_OTHER = 131 / 350 * _MASS * _RADIUS**2

REPORT = Body(mass=_MASS, shape=EccentricSphere(radius=_RADIUS, eccentricity=0.3), I1=_OTHER, I3=_TWO_FIFTHS)
"""The report's top with the inertias of its listing, which are the ones that give its results."""

REPORT_TABLE_1 = Body(
    mass=_MASS, shape=EccentricSphere(radius=_RADIUS, eccentricity=0.3), I1=_TWO_FIFTHS, I3=_OTHER
)
"""The report's top as its Table 1 prints it, with the two inertias exchanged."""

LEINE_GLOCKER = Body(mass=6e-3, shape=EccentricSphere(radius=1.5e-2, eccentricity=0.2), I1=8e-7, I3=7e-7)
"""The sphere of Leine and Glocker's top, whose centre of mass is 3 mm from the middle of 15 mm.

R. I. Leine and Ch. Glocker, "A set-valued force law for spatial Coulomb-Contensou friction", European Journal
of Mechanics A/Solids 22 (2003) 193-216. `LEINE_GLOCKER_STEM` has their second sphere, the stem's.
"""

_WITH_STEM = (Sphere(radius=1.5e-2, center=3e-3), Sphere(radius=5e-3, center=1.6e-2))

LEINE_GLOCKER_STEM = Body(mass=6e-3, shape=_WITH_STEM, I1=8e-7, I3=7e-7)
"""The whole of Leine and Glocker's top: its sphere, and the smaller one at the end of the stem."""

FRIEDL = Body(mass=6e-3, shape=_WITH_STEM, I1=9e-7, I3=7e-7)
"""Friedl's top that hangs at a tilt between: Leine and Glocker's, which is his, with more inertia across.

C. Friedl, "Der Stehaufkreisel", thesis, University of Augsburg, 1997.
"""


def _report_with(stem: Shape) -> Body:
    return Body(
        mass=_MASS, shape=(Sphere(radius=_RADIUS, center=0.3 * _RADIUS), stem), I1=_OTHER, I3=_TWO_FIFTHS
    )


REPORT_STEM = _report_with(Sphere(radius=0.012, center=0.017))
"""The report's top with a stem so blunt that it stands up on it when launched as in the report's Fig. 4."""

REPORT_THIN_STEM = _report_with(Sphere(radius=0.004, center=0.026))
"""The report's top with a stem so thin that it falls back from it."""

COHEN = Body(mass=0.015, shape=EccentricSphere(radius=0.025, eccentricity=0.2), I1=3.75e-6, I3=3.75e-6)
"""Cohen's top: I1 = I3 = 0.4 m R^2.

R. J. Cohen, "The tippe top revisited", American Journal of Physics 45 (1977) 12-17.
"""


def _cylinder(mass: float, radius: float, thickness: float) -> Body:
    """A solid cylinder with sharp edges, which a disk, a coin or a rod are."""
    edges = tuple(Ring(radius=radius, center=side * thickness / 2) for side in (-1, 1))
    return Body(
        mass=mass, shape=edges, I1=mass * (3 * radius**2 + thickness**2) / 12, I3=mass * radius**2 / 2
    )


EULER_DISK = _cylinder(0.4, 0.0375, 0.0125)
"""Euler's disk, the toy, as large and heavy as in H. K. Moffatt, Nature 404 (2000) 833-834; 12.5 mm thick."""

COIN = _cylinder(7.5e-3, 0.023_25 / 2, 2.33e-3)
"""A coin of one euro by its specification: 7.5 g, 23.25 mm across, 2.33 mm thick, as if of one metal.

Diameter and mass stand in Council Regulation (EC) No 975/98; that it is of one metal all through is assumed.
"""

_BALL = 0.032

HURRICANE_BALLS = Body(
    mass=2 * _BALL,
    shape=(Sphere(radius=0.01, center=-0.01), Sphere(radius=0.01, center=0.01)),
    I1=2 * (2 / 5 + 1) * _BALL * 0.01**2,
    I3=2 * 2 / 5 * _BALL * 0.01**2,
)
"""Two balls of steel, 20 mm across and 32 g each, welded together.

Typical dimensions, assumed: how they roll depends on the radius alone.
"""

EGG = Body(
    mass=0.057,
    shape=Spheroid(across=0.022, along=0.028),
    I1=0.057 * (0.022**2 + 0.028**2) / 5,
    I3=2 / 5 * 0.057 * 0.022**2,
)
"""A hard-boiled hen's egg of common size, as a spheroid that is the same all through.

Typical dimensions, assumed: 44 by 56 mm, and a mass within the European class M of 53 to 63 g.
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
    "euler-disk": EULER_DISK,
    "coin": COIN,
    "hurricane-balls": HURRICANE_BALLS,
    "egg": EGG,
}
"""The bodies by the names used on the command line."""


def body(name: str) -> Body:
    """The body of this name.

    Raises
    ------
    InvalidInput
        If there is no such preset.
    """
    try:
        return BODIES[name]
    except KeyError:
        raise InvalidInput("preset", name, one_of(name, list(BODIES))) from None


def report_problem(spin: float = 155.0, tilt: float = 0.1, mu: float = 0.3) -> Problem:
    """The report's top and table, launched at rest in tilt: spin in rad/s, tilt in rad, mu in s/m."""
    return Problem(body=REPORT, friction=ViscousFriction(mu=mu), launch=Launch(tilt=tilt, spin=spin))


def leine_glocker_problem(spin: float = 180.0, tilt: float = 0.1, mu: float = 0.3) -> Problem:
    """Leine and Glocker's top on dry friction, without drilling: spin in rad/s, tilt in rad, mu a number.

    See `LEINE_GLOCKER` for the reference.
    """
    return Problem(
        body=LEINE_GLOCKER,
        friction=RegularizedCoulombFriction(mu=mu),
        launch=Launch(tilt=tilt, spin=spin),
        gravity=9.81,
    )
