"""Bodies and problems known by name."""

from tippetop.errors import InvalidInput, one_of
from tippetop.problem import Body, EccentricSphere, Launch, Problem, ViscousFriction

_MASS, _RADIUS = 0.02, 0.02
_TWO_FIFTHS = 2 / 5 * _MASS * _RADIUS**2
_OTHER = 131 / 350 * _MASS * _RADIUS**2

REPORT = Body(mass=_MASS, shape=EccentricSphere(radius=_RADIUS, eccentricity=0.3), I1=_OTHER, I3=_TWO_FIFTHS)
"""The report's top with the inertias of its listing, which are the ones that give its results."""

REPORT_TABLE_1 = Body(
    mass=_MASS, shape=EccentricSphere(radius=_RADIUS, eccentricity=0.3), I1=_TWO_FIFTHS, I3=_OTHER
)
"""The report's top as its Table 1 prints it, with the two inertias exchanged."""

BODIES = {"report": REPORT, "report-table-1": REPORT_TABLE_1}
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
