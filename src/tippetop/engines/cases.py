"""The cases of the reference suite: problems, how long they are followed, what they test."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

import tippetop as tt
from tippetop.mechanics.laws.contensou import ELLIPSOIDAL_RADIUS

SAMPLES = 20
"""Number of instants at which a case has its state."""


class Case(NamedTuple):
    """A problem of the suite, how long it is followed, and what it tests."""

    name: str
    """Name in files and tables."""
    title: str
    """What the case is, in a line."""
    tests: str
    """What a program needs to follow it."""
    problem: tt.Problem
    duration: float
    """Length of the run, s."""
    cut_off: float = 0.0
    """How long before its limit an infinite sequence of rebounds may be cut off, s."""
    added_up: float = 0.0
    """What errors of the second method in many events, one after the other, may add up to, s."""
    compared: int = SAMPLES
    """Number of instants up to which other programs are compared, for the sake of their time."""
    judged: int = 1
    """Number of the instant at which other programs are judged: late errors are of phase only."""

    @property
    def times(self) -> NDArray[np.float64]:
        """The instants of the states, s: evenly spaced, the last at the end."""
        return self.duration * np.arange(1, SAMPLES + 1) / SAMPLES


_AT_REST = (0.0, 0.0, 0.0)


def _report_top(friction: tt.Friction, launch: tt.Launch, **others: object) -> tt.Problem:
    """Return the report's top on friction of a kind."""
    return tt.Problem(body=tt.presets.REPORT, friction=friction, launch=launch, **others)


def _leaning(spin: float, **others: object) -> tt.Launch:
    """Return a launch that leans by 0.1 rad."""
    return tt.Launch(tilt=0.1, spin=spin, **others)


def _of_leine_and_glocker(body: tt.Body, pressure: str) -> tt.Problem:
    """Return a top of Leine and Glocker on the contact patch of their paper."""
    return tt.Problem(
        body=body,
        friction=tt.ContensouFriction(mu=0.3, patch_radius=5e-4, pressure=pressure),
        launch=tt.Launch(tilt=0.1, spin=180.0, velocity=_AT_REST),
        gravity=9.81,
    )


def _rolling_balls() -> tt.Launch:
    """Return the launch of the hurricane balls a little off their steady rolling."""
    tilt, radius, gravity = 1.3, 0.01, 9.81
    turning = math.sqrt(gravity / (radius * (0.4 - math.cos(tilt))))
    # The lower ball rolls about the centre of mass at rest: its contact is at rest.
    spin = turning * (1.0 + math.cos(tilt))
    return tt.Launch(tilt=tilt, precession=turning, spin=spin, tilt_rate=2.0)


def _uniform(mass: float, radius: float) -> tt.Body:
    """Return a solid ball."""
    inertia = 0.4 * mass * radius**2
    shape = tt.Sphere(radius=radius, center=0.0)
    return tt.Body(mass=mass, shape=shape, I1=inertia, I3=inertia)


def _flat_disk(mass: float, radius: float, thickness: float) -> tt.Body:
    """Return a solid disk with sharp edges."""
    axial, half = 0.5 * mass * radius**2, 0.5 * thickness
    edges = [tt.Ring(radius=radius, center=side) for side in (-half, half)]
    return tt.Body(mass=mass, shape=edges, I1=axial / 2 + mass * thickness**2 / 12, I3=axial)


CASES = (
    Case(
        "viscous",
        "A tippe top on a viscous film",
        "smooth friction, the turning over, and Jellett's integral",
        _report_top(tt.ViscousFriction(mu=0.3), _leaning(155.0)),
        8.0,
    ),
    Case(
        "coulomb-roll",
        "A top on dry friction slips, sticks and rolls",
        "the end of slip, and rolling without loss",
        _report_top(tt.CoulombFriction(mu=0.3), _leaning(155.0, velocity=_AT_REST)),
        2.0,
    ),
    Case(
        "stick-slip",
        "A top on slippery dry friction sticks and slips 190 times",
        "many beginnings and ends of slip",
        _report_top(tt.CoulombFriction(mu=0.02985), _leaning(155.0)),
        6.0,
        # Some 5e-13 s in each of 190 cycles; other steps of the program move its events by 6e-13 s.
        added_up=2e-10,
        compared=5,
    ),
    Case(
        "drilling",
        "A top on a contact patch turns over (ellipsoidal limit surface)",
        "slipping and drilling at once",
        _report_top(
            tt.ContensouFriction(
                mu=0.3, patch_radius=1e-3 / ELLIPSOIDAL_RADIUS, pressure="ellipsoidal"
            ),
            _leaning(100.0),
        ),
        4.0,
    ),
    Case(
        "drilling-hertz",
        "Leine and Glocker's ball on a contact patch turns over (pressure of Hertz)",
        "slipping and drilling at once, with two branches of the law",
        _of_leine_and_glocker(tt.presets.LEINE_GLOCKER, "hertz"),
        1.3,
    ),
    Case(
        "flights",
        "A fast top leaves the table and comes down",
        "lift-off, flights and impacts without rebound",
        _report_top(tt.ViscousFriction(mu=0.3), _leaning(175.0)),
        6.0,
    ),
    Case(
        "restitution",
        "A spinning ball is dropped and rebounds",
        "impacts with friction and restitution",
        _report_top(
            tt.CoulombFriction(mu=0.1),
            tt.Launch(tilt=0.6, spin=120.0, gap=0.02, velocity=_AT_REST),
            contact=tt.Contact(restitution=0.8),
        ),
        0.3,
        judged=SAMPLES,
    ),
    Case(
        "stem",
        "Leine and Glocker's top strikes the table with its stem, stands on it and falls back",
        "impacts of a second surface, infinite rocking, and contact in two points",
        _of_leine_and_glocker(tt.presets.LEINE_GLOCKER_STEM, "ellipsoidal"),
        8.0,
        cut_off=1e-6,
        compared=8,
    ),
    Case(
        "egg",
        "A spinning egg stands up",
        "a contact whose curvature changes",
        tt.Problem(
            body=tt.presets.EGG,
            friction=tt.ContensouFriction(
                mu=0.2, patch_radius=1e-3 / ELLIPSOIDAL_RADIUS, pressure="ellipsoidal"
            ),
            launch=tt.Launch(tilt=1.5, spin=0.0, precession=100.0),
            gravity=9.81,
        ),
        3.0,
    ),
    Case(
        "disk",
        "Euler's disk rolls down with rolling resistance",
        "a sharp edge, and a motion that grows ever faster",
        tt.Problem(
            body=tt.presets.EULER_DISK,
            friction=tt.CoulombFriction(mu=0.4),
            launch=tt.Launch(tilt=0.35, spin=3.5, precession=55.0),
            gravity=9.81,
            rolling_resistance=5e-4,
        ),
        1.4,
    ),
    Case(
        "hurricane",
        "Hurricane balls roll about their centre",
        "rolling without loss for many turns",
        tt.Problem(
            body=tt.presets.HURRICANE_BALLS,
            friction=tt.CoulombFriction(mu=0.5),
            launch=_rolling_balls(),
            gravity=9.81,
        ),
        2.0,
    ),
    Case(
        "rest",
        "A ball with its centre of mass off the middle rocks to rest",
        "rolling resistance that holds",
        _report_top(
            tt.CoulombFriction(mu=0.3),
            tt.Launch(tilt=1.0, spin=0.0),
            rolling_resistance=5e-4,
        ),
        1.6,
    ),
    Case(
        "painleve",
        "Slip turns until friction jams the contact",
        "Painleve's paradox: an impact without approach",
        tt.Problem(
            body=tt.Body(
                mass=0.02,
                shape=tt.EccentricSphere(radius=0.02, eccentricity=0.05),
                I1=4e-8,
                I3=4e-8,
            ),
            friction=tt.CoulombFriction(mu=0.3),
            launch=tt.Launch(tilt=1.2, spin=0.0, slip=(0.0, 0.05)),
            gravity=9.81,
        ),
        2e-3,
        judged=SAMPLES,
    ),
    Case(
        "puck",
        "A puck slides and spins on its face until both end at once",
        "friction of a face that slides and spins, and rest",
        tt.Problem(
            body=_flat_disk(mass=0.05, radius=0.02, thickness=0.005),
            friction=tt.CoulombFriction(mu=0.3),
            launch=tt.Launch(tilt=0.0, spin=25.0, slip=(0.5, 0.3)),
            gravity=9.81,
        ),
        0.3,
    ),
    Case(
        "ball",
        "A ball slips, rolls to a stop, and drills to its rest",
        "rolling resistance and drilling that end one after the other",
        tt.Problem(
            body=_uniform(mass=0.1, radius=0.02),
            friction=tt.ContensouFriction(mu=0.2, patch_radius=2e-3, pressure="hertz"),
            launch=tt.Launch(tilt=0.5, spin=40.0, precession=30.0, slip=(0.2, 0.1)),
            gravity=9.81,
            rolling_resistance=5e-4,
        ),
        3.2,
    ),
    Case(
        "peg",
        "A peg top slips on its tip, sticks, and precesses",
        "the end of slip on a tip of half a millimetre, and nutation for many periods",
        tt.Problem(
            body=tt.Body(
                mass=0.05,
                shape=[tt.Sphere(radius=5e-4, center=-0.03), tt.Sphere(radius=0.02, center=0.0)],
                I1=1e-5,
                I3=1.4e-5,
            ),
            friction=tt.CoulombFriction(mu=0.3),
            launch=tt.Launch(tilt=0.3, spin=250.0, velocity=_AT_REST),
            gravity=9.81,
        ),
        2.0,
    ),
    Case(
        "slope",
        "A ball is thrown across a slope, slips, and rolls down",
        "gravity that is not across the table, and slip that turns round",
        tt.Problem(
            body=_uniform(mass=0.1, radius=0.02),
            friction=tt.CoulombFriction(mu=0.2),
            launch=tt.Launch(tilt=0.5, spin=-40.0, precession=30.0, slip=(0.6, -0.3)),
            gravity=9.81,
            table=tt.Table(slope=0.15, azimuth=0.7),
        ),
        1.0,
    ),
    Case(
        "disk-end",
        "Euler's disk wobbles down to its end on a film, and spins on upon its face",
        "a precession without bound, and what comes after it",
        tt.Problem(
            body=tt.presets.EULER_DISK,
            friction=tt.ViscousFriction(mu=2.0),
            launch=tt.Launch(tilt=0.1, spin=15.0, precession=100.0),
            gravity=9.81,
            rolling_resistance=2e-3,
        ),
        1.0,
    ),
)
"""The suite, in the order of its files."""
