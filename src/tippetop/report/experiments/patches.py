"""Contact patches that slip and drill: times of turning over, and equivalent viscous friction."""

import math

import numpy as np
import xarray as xr

from tippetop.mechanics.laws.contensou import ELLIPSOIDAL_RADIUS
from tippetop.problem.frictions import ContensouFriction, ViscousFriction
from tippetop.problem.hertz_patch import MATERIALS, hertz_patch_radius
from tippetop.problem.presets import LEINE_GLOCKER, report_problem
from tippetop.problem.problem import top_of
from tippetop.report import printed_numbers
from tippetop.report.experiment import dataset, experiment
from tippetop.report.experiments.dry import turning_time, with_friction
from tippetop.report.experiments.real import LEINE
from tippetop.run import simulate
from tippetop.theory.stability import vertical_growth_rates
from tippetop.theory.steady import VERTICAL_SPINS, SteadyKind
from tippetop.theory.thresholds import critical_spin

MU = 0.3
"""Friction coefficient of the map."""

CREEP = {"hertz": 3.0 * math.pi / 8.0, "ellipsoidal": 1.0 / ELLIPSOIDAL_RADIUS}
"""Viscous coefficient of a drilling patch in units of mu / (R omega), by its pressure."""

MAP_WINDOW = 6.0
"""Length of the runs of the map, s."""

SPIN = 100.0
"""Spin of the launches that are compared with viscous friction, rad/s."""

PATCH_FRICTIONS = (0.1, 0.2, 0.4)
"""Friction coefficients of the patches that are compared with viscous friction."""

ALONE = LEINE.replace({"body": LEINE_GLOCKER.model_dump()})
"""Launch of Leine and Glocker's top without its stem."""


def patch(mu: float, radius: float) -> ContensouFriction:
    """Return the friction of a patch whose limit surface is an ellipsoid."""
    return ContensouFriction(mu=mu, patch_radius=radius, pressure="ellipsoidal")


def viscous_coefficient(mu: float, radius: float, spin: float) -> float:
    """Return the viscous coefficient of a drilling patch for small slip, s/m: mu / (rho omega)."""
    return CREEP["ellipsoidal"] * mu / (radius * spin)


@experiment("dry-patch", "turning over by patch radius and spin", 5.0)
def _map(quick: bool) -> xr.Dataset:
    """Return the times of turning over against patch radius and spin."""
    radii = np.geomspace(2e-4, 6e-3, 5) if quick else np.geomspace(1e-4, 6e-3, 12)
    spins = np.linspace(25.0, 115.0, 4) if quick else np.linspace(34.0, 115.0, 10)
    grid = [
        [with_friction(report_problem(float(s)), patch(MU, float(r))) for s in spins] for r in radii
    ]
    runs = [[simulate(one, MAP_WINDOW, samples=2, mode_limit=1) for one in row] for row in grid]
    times = [[float(run["turnover_time"]) for run in row] for row in runs]
    least = min(float(run["min_normal_force"]) for row in runs for run in row)
    theirs = float(simulate(ALONE, 3.0, samples=2)["turnover_time"])
    limit = critical_spin(SteadyKind.UPRIGHT, top_of(report_problem()))
    return dataset(
        {"radius": (radii, "m", "radius of the contact patch"), "spin": spins},
        {"mu": MU, "window_s": MAP_WINDOW, "tilt_rad": printed_numbers.TILT},
        turning_time=(times, "s", "first tilt of more than pi/2", "radius", "spin"),
        least_force=(least, "N", "least normal force of all"),
        upright_limit=(limit, "rad s-1", "spin below which the upright spin is stable"),
        theirs_turns=(theirs, "s", "when Leine and Glocker's top turns over"),
    )


@experiment("dry-viscous", "patches against viscous friction", 2.0)
def _viscous(quick: bool) -> xr.Dataset:
    """Return the times of turning over on patches and on the equivalent viscous friction."""
    coefficients = np.geomspace(1.0, 40.0, 4 if quick else 10)
    base = report_problem(SPIN)

    def turning(friction: object) -> float:
        return turning_time(with_friction(base, friction), MAP_WINDOW)

    times = [
        [turning(patch(mu, viscous_coefficient(mu, float(c), SPIN))) for c in coefficients]
        for mu in PATCH_FRICTIONS
    ]
    smooth = [turning(ViscousFriction(mu=float(c))) for c in coefficients]
    load, radius = base.body.mass * base.gravity, float(top_of(base).surface.size)
    radii = [
        hertz_patch_radius(load, radius, material, material) for material in MATERIALS.values()
    ]
    at_launch = f"viscous coefficient of that patch at {printed_numbers.SPIN:g} rad/s"
    creep = [CREEP["hertz"] * MU / (r * printed_numbers.SPIN) for r in radii]
    ratios = "growth rate of a patch over that of viscous friction"
    return dataset(
        {
            "mu": (list(PATCH_FRICTIONS), "1", "friction coefficient of the patch"),
            "coefficient": (coefficients, "s m-1", "viscous coefficient at launch"),
            "material": list(MATERIALS),
            "pressure": list(CREEP),
        },
        {"spin_rad_per_s": SPIN, "window_s": MAP_WINDOW},
        patch_time=(times, "s", "first tilt of more than pi/2, patch", "mu", "coefficient"),
        viscous_time=(smooth, "s", "first tilt of more than pi/2, viscous", "coefficient"),
        growth_ratio=(_growth_ratios(), "1", ratios, "pressure", "pole"),
        hertz_radius=(radii, "m", "patch of the report's top on its own material", "material"),
        hertz_coefficient=(creep, "s m-1", at_launch, "material"),
    )


def _growth_ratios() -> list[list[float]]:
    """Return growth rates of the vertical spins on a patch of 0.5 mm over those on viscous
    friction.
    """
    ratios = []
    for pressure, creep in CREEP.items():
        frictions = (
            ContensouFriction(mu=MU, patch_radius=5e-4, pressure=pressure),
            ViscousFriction(mu=creep * MU / (5e-4 * SPIN)),
        )
        tops = [top_of(with_friction(report_problem(), law)) for law in frictions]
        dry, viscous = (
            [
                float(vertical_growth_rates(kind, top, np.array([SPIN]))[0])
                for kind in VERTICAL_SPINS
            ]
            for top in tops
        )
        ratios.append([on_patch / on_film for on_patch, on_film in zip(dry, viscous, strict=True)])
    return ratios
