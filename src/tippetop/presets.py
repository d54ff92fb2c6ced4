"""Bodies and problems known by name."""

from tippetop.bodies import Body, EccentricSphere
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
of Mechanics A/Solids 22 (2003) 193-216. Their second sphere, the stem's, is left out.
"""

BODIES = {"report": REPORT, "report-table-1": REPORT_TABLE_1, "leine-glocker": LEINE_GLOCKER}
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
