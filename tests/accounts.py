"""Launches over every law, body and ending, of which accounts are given."""

from typing import Any

import tippetop as tt

REPORT = tt.presets.report_problem(spin=155.0)
DRY = {"friction.kind": "coulomb", "friction.mu": 0.3}
PATCH = {"friction.kind": "contensou", "friction.mu": 0.3, "friction.patch_radius": 5e-4}
SMOOTHED = {"friction.kind": "regularized_coulomb", "friction.mu": 0.3, "friction.eps": 1e-3}
EGG = tt.Body(mass=0.02, shape=tt.Spheroid(across=0.015, along=0.025), I1=3.4e-6, I3=1.8e-6)
OFF_CENTRE = EGG.model_copy(update={"shape": tt.Spheroid(across=0.015, along=0.025, center=0.003)})
PUCK = tt.Body(
    mass=0.02,
    shape=[tt.Ring(radius=0.02, center=-0.0025), tt.Ring(radius=0.02, center=0.0025)],
    I1=2.0416666666666667e-6,
    I3=4e-6,
)
CYLINDER = tt.Body(
    mass=0.1,
    shape=[tt.Ring(radius=0.02, center=-0.03), tt.Ring(radius=0.02, center=0.03)],
    I1=4e-5,
    I3=2e-5,
)
RING_TOP = tt.Body(
    mass=0.01,
    shape=[tt.Sphere(radius=5e-4, center=-0.0295), tt.Ring(radius=0.1, center=0.0)],
    I1=5e-5,
    I3=1e-4,
)
TWO_BALLS = tt.Body(
    mass=0.01,
    shape=[tt.Sphere(radius=0.2, center=0.04), tt.Sphere(radius=0.04, center=0.28)],
    I1=3.2533333333333335e-4,
    I3=2.6666666666666668e-4,
)
VISCOUS, COULOMB = tt.ViscousFriction(mu=0.3), tt.CoulombFriction(mu=0.3)


def report(spin: float = 155.0, **changes: Any) -> tt.Problem:
    """Return the report's launch with another spin and other fields, dots written as `__`."""
    fields = {name.replace("__", "."): value for name, value in changes.items()}
    return REPORT.replace({"launch.spin": spin, **fields})


def of(body: tt.Body, friction: tt.Friction, **launch: Any) -> tt.Problem:
    """Return a launch of a body on a friction."""
    return tt.Problem(body=body, friction=friction, launch=tt.Launch(**launch))


LEINE = tt.presets.leine_glocker_problem()
STEM = tt.Problem(
    body=tt.presets.LEINE_GLOCKER_STEM,
    friction=tt.ContensouFriction(mu=0.3, patch_radius=5e-4, pressure="ellipsoidal"),
    launch=tt.Launch(tilt=0.1, spin=180.0, velocity=(0.0, 0.0, 0.0)),
    gravity=9.81,
)

LAUNCHES: dict[str, tuple[tt.Problem, float]] = {
    "report": (report(), 20.0),
    "report, short": (report(), 5.0),
    "report, not yet settled": (report(), 8.0),
    "little friction": (report(friction__mu=0.05), 20.0),
    "too slow": (report(20.0), 20.0),
    "just fast enough": (report(32.0), 20.0),
    "half way": (report(50.0), 20.0),
    "flies": (report(175.0), 20.0),
    "stops at lift-off": (report(175.0, contact__liftoff="stop"), 20.0),
    "table that pulls": (report(175.0, contact__liftoff="ignore"), 20.0),
    "upside down": (report(launch__tilt=3.1), 20.0),
    "comes upright": (report(10.0, launch__tilt=1.2), 20.0),
    "falls from inverted": (report(20.0, launch__tilt=3.1), 20.0),
    "exactly upright": (report(launch__tilt=0.0), 20.0),
    "exactly upright, slow": (report(20.0, launch__tilt=0.0), 20.0),
    "exactly inverted": (report(launch__tilt=3.141592653589793), 5.0),
    "no friction": (report(friction__mu=0.0), 5.0),
    "no friction, swings": (report(5.0, friction__mu=0.0, launch__tilt=1.0), 5.0),
    "on a slope": (report(table__slope=0.03), 3.0),
    "in air": (report(air__axial_linear=2e-7, air__drag_quadratic=1e-2), 5.0),
    "dry on a slope in air": (
        REPORT.replace({**DRY, "table.slope": 0.03, "air.drag_linear": 1e-3}),
        3.0,
    ),
    "dropped": (report(50.0, launch__gap=0.05, contact__restitution=0.5), 5.0),
    "in the air all along": (report(50.0, launch__gap=0.5), 0.2),
    "dry": (REPORT.replace(DRY), 20.0),
    "dry, slips first": (REPORT.replace({**DRY, "launch.velocity": (0.0, 0.0, 0.0)}), 5.0),
    "dry, little friction": (REPORT.replace({**DRY, "friction.mu": 0.02}), 20.0),
    "smoothed": (REPORT.replace(SMOOTHED), 20.0),
    "patch": (REPORT.replace(PATCH), 8.0),
    "patch, to its rest": (report(60.0).replace({**PATCH, "friction.patch_radius": 3e-3}), 40.0),
    "rises and falls back": (report(80.0).replace(PATCH), 30.0),
    "rolling resistance": (REPORT.replace({**DRY, "rolling_resistance": 1e-4}), 20.0),
    "rolling resistance, viscous": (report(rolling_resistance=1e-4), 20.0),
    "Leine and Glocker's": (LEINE, 8.0),
    "Leine and Glocker's stem": (STEM, 8.0),
    "egg": (of(EGG, VISCOUS, tilt=1.4, spin=0.0, precession=150.0), 20.0),
    "egg, slow": (of(EGG, VISCOUS, tilt=1.4, spin=0.0, precession=20.0), 20.0),
    "egg off its centre": (of(OFF_CENTRE, tt.ViscousFriction(mu=3.0), tilt=1.2, spin=0.0), 5.0),
    "egg, dry": (of(EGG, COULOMB, tilt=1.4, spin=0.0, precession=150.0), 2.0),
    "puck": (
        of(PUCK, COULOMB, tilt=0.001, spin=-100.0, precession=1400.0, velocity=(0.0, 0.0, 0.0)),
        20.0,
    ),
    "cylinder that rocks": (of(CYLINDER, tt.CoulombFriction(mu=0.9), tilt=0.1, spin=0.0), 2.0),
    "cylinder on its rim": (
        of(
            CYLINDER.model_copy(update={"I3": 1e-5}),
            tt.CoulombFriction(mu=0.9),
            tilt=0.0,
            spin=60.0,
            slip=(0.9, 0.0),
        ),
        0.5,
    ),
    "coin": (of(tt.presets.COIN, COULOMB, tilt=1.2, spin=0.0, gap=0.01), 5.0),
    "ring top": (of(RING_TOP, tt.CoulombFriction(mu=0.2), tilt=0.001, spin=50.0), 5.0),
    "ring top, falls": (of(RING_TOP, tt.ViscousFriction(mu=0.3), tilt=0.1, spin=3.0), 20.0),
    "two balls, dry": (
        of(
            TWO_BALLS,
            tt.CoulombFriction(mu=0.4),
            tilt=0.0,
            spin=200.0,
            tilt_rate=0.4,
            velocity=(0.0, 0.0, 0.0),
        ),
        20.0,
    ),
    "two balls, smoothed": (
        of(
            TWO_BALLS,
            tt.RegularizedCoulombFriction(mu=0.4, eps=1e-5),
            tilt=0.0,
            spin=200.0,
            tilt_rate=0.4,
            velocity=(0.0, 0.0, 0.0),
        ),
        20.0,
    ),
    "homogeneous ball": (
        of(
            tt.Body(mass=0.02, shape=tt.Sphere(radius=0.02, center=0.0), I1=3.2e-6, I3=3.2e-6),
            VISCOUS,
            tilt=0.5,
            spin=100.0,
        ),
        5.0,
    ),
    "hurricane balls": (of(tt.presets.HURRICANE_BALLS, VISCOUS, tilt=0.3, spin=60.0), 3.0),
    "dry ball at rest": (
        report(0.0, launch__tilt=1.0).replace({**DRY, "rolling_resistance": 1e-3}),
        5.0,
    ),
}
