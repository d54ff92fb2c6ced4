"""The report's printed equations and table, put to numbers."""

import math

import numpy as np
import xarray as xr

from tippetop.mechanics.euler import published_normal_force, published_parameters, published_rates
from tippetop.mechanics.motion import angular_velocity, contact
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import Vector, cross, dot
from tippetop.presets import REPORT, report_problem
from tippetop.problem import Body, EccentricSphere, Problem, ViscousFriction
from tippetop.report.experiment import Experiment, variable
from tippetop.report.experiments.runs import on_table
from tippetop.run import simulate

_INSTANT = 5.0
_LONG = 400.0
_NAMES = ("theta", "theta_dot", "phi", "phi_dot", "omega3", "slip_x", "slip_y")


def _printed(quick: bool) -> xr.Dataset:
    """Torque and precession equation as printed, as listed and as they are, at an instant of the main run."""
    problem = on_table(report_problem())
    h = 1e-4
    run = simulate(problem, _INSTANT + 1.0, times=_INSTANT + h * np.arange(-2, 3))
    now = run.isel(time=2)
    y = [float(now[name]) for name in _NAMES]
    rates = published_rates(y, problem.top, math)
    stencil = np.array([1.0, -8.0, 0.0, 8.0, -1.0]) / (12.0 * h)
    bracket = rates[3] * problem.top.transverse_inertia * math.sin(y[0])
    torque = _torques(now, problem.top)
    data = {
        "torque_printed": variable(torque["printed"], "N m", "axial component of F x a, as (2.7) has it"),
        "torque_listing": variable(
            problem.body.I3 * rates[4], "N m", "I3 times the rate of omega3 by (2.10)"
        ),
        "torque": variable(
            problem.body.I3 * float(stencil @ run["omega3"].values), "N m", "I3 times d omega3/dt of the run"
        ),
        "torque_corrected": variable(torque["corrected"], "N m", "axial component of a x F"),
        "power_printed": variable(torque["power_printed"], "W", "power of the contact force with F x a"),
        "power": variable(torque["power"], "W", "power of the contact force with a x F"),
        "precession_printed": variable(
            problem.body.I1 / bracket / (problem.body.I1 * math.sin(y[0])),
            "rad s-2",
            "rate of phi' by (2.9) as printed, read as I1 over the bracket over I1 sin(theta)",
        ),
        "precession_printed_product": variable(
            problem.body.I1 * rates[3], "rad s-2", "the same read as I1 times the bracket over I1 sin(theta)"
        ),
        "precession_listing": variable(rates[3], "rad s-2", "rate of phi' by the listing"),
        "precession": variable(
            float(stencil @ run["phi_dot"].values), "rad s-2", "d phi'/dt of the converged run"
        ),
    }
    return xr.Dataset(data, attrs={"problem": problem.to_json(), "instant_s": _INSTANT})


def _torques(now: xr.Dataset, top: Top) -> dict[str, float]:
    """The contact torque by (2.7) and with its factors exchanged, and the power each would have."""
    axis, momentum, velocity = (_vector(now, name) for name in ("axis", "angular_momentum", "velocity"))
    touch = contact(axis, momentum, (velocity[0], velocity[1]), top)
    normal = touch.normal_force
    force: Vector = (normal * touch.traction.force[0], normal * touch.traction.force[1], normal)
    omega = angular_velocity(axis, momentum, top)
    printed, corrected = cross(force, touch.arm), cross(touch.arm, force)
    pushing = dot(force, velocity)
    return {
        "printed": dot(printed, axis),
        "corrected": dot(corrected, axis),
        "power_printed": pushing + dot(printed, omega),
        "power": pushing + dot(corrected, omega),
    }


def _vector(now: xr.Dataset, name: str) -> Vector:
    x, y, z = (float(value) for value in now[name].values)
    return (x, y, z)


def _steady(quick: bool) -> xr.Dataset:
    """Where several bodies end up between upright and inverted, and how well (2.16) and (2.17) hold there."""
    m, R = REPORT.mass, float(REPORT.shape.surface.size)
    tops = [
        ("the report's", REPORT, 50.0),
        ("three times as heavy", REPORT.model_copy(update={"mass": 3 * m}), 50.0),
        ("I1 larger by a tenth", REPORT.model_copy(update={"I1": 1.1 * REPORT.I1}), 60.0),
        ("I3 smaller by a tenth", REPORT.model_copy(update={"I3": 0.9 * REPORT.I3}), 60.0),
        (
            "less eccentric",
            REPORT.model_copy(update={"shape": EccentricSphere(radius=R, eccentricity=0.2)}),
            45.0,
        ),
    ]
    rows = []
    for _, body, spin in tops:
        problem = on_table(report_problem(spin).replace({"body": body.model_dump()}))
        end = simulate(problem, _LONG, samples=2).isel(time=-1)
        y = [float(end[name]) for name in _NAMES]
        rows.append((y[0], y[3], y[4], *_residuals(y, problem.top)))
    table = np.array(rows).T
    names = {
        "theta": ("rad", "tilt"),
        "phi_dot": ("rad s-1", "precession"),
        "omega3": ("rad s-1", "axial spin"),
        "residual_217": ("rad s-1", "omega3 - phi' (cos theta - alpha), equation (2.17)"),
        "residual_216": ("1", "largest of the lines of (2.16), each over the largest of its terms"),
    }
    data = {
        name: variable(table[i], units, long_name, ("body",))
        for i, (name, (units, long_name)) in enumerate(names.items())
    }
    return xr.Dataset(data, {"body": [name for name, _, _ in tops]}, {"duration_s": _LONG})


def _residuals(y: list[float], top: Top) -> tuple[float, float]:
    """What is left of (2.17), rad/s, and of (2.16), relative to its terms, in this state."""
    theta, _, _, precession, spin, _, _ = y
    _, I1, I3, R, alpha, _, _ = published_parameters(top)
    c, s = math.cos(theta), math.sin(theta)
    normal = published_normal_force(y, top, math)
    first = (I1 * precession**2 * c, -I3 * spin * precession, -R * alpha * normal)
    fourth = (
        precession * spin * (I3 * (1 - alpha * c) - I1),
        normal * R * alpha * (1 - alpha * c),
        -I1 * alpha * precession**2 * s**2,
    )
    left = max(abs(sum(line)) / max(abs(term) for term in line) for line in (first, fourth))
    return spin - precession * (c - alpha), left


def _unit_of_mu(quick: bool) -> xr.Dataset:
    """The same launch in metres and in centimetres, with mu converted as s/m and as m/s."""
    report = report_problem()
    seconds = 2.0
    powers = np.array([-1, 1])
    tilts = [_tilt_after(_in_centimetres(report, int(power)), seconds) for power in powers]
    return xr.Dataset(
        {
            "theta_in_metres": variable(_tilt_after(report, seconds), "rad", "tilt after 2 s, in metres"),
            "theta_in_centimetres": variable(
                np.array(tilts), "rad", "tilt after 2 s, in centimetres", ("power",)
            ),
        },
        {"power": variable(powers, "1", "power of the length in the unit of mu", ("power",))},
    )


def _in_centimetres(problem: Problem, power: int) -> Problem:
    """The problem with every length in centimetres, if mu has this power of length in its unit."""
    body, unit = problem.body, 100.0
    shape = body.shape
    assert isinstance(shape, EccentricSphere)
    assert isinstance(problem.friction, ViscousFriction)
    return Problem(
        body=Body(
            mass=body.mass,
            shape=EccentricSphere(radius=shape.radius * unit, eccentricity=shape.eccentricity),
            I1=body.I1 * unit**2,
            I3=body.I3 * unit**2,
        ),
        friction=ViscousFriction(mu=problem.friction.mu * unit**power),
        launch=problem.launch,
        contact=problem.contact,
        gravity=problem.gravity * unit,
    )


def _tilt_after(problem: Problem, duration: float) -> float:
    return float(simulate(on_table(problem), duration, samples=2)["theta"].values[-1])


def _block(quick: bool) -> xr.Dataset:
    """How far a block slides on the table of Fig. 8 when it starts with 1 m/s."""
    mu, gravity = 100.0, report_problem().gravity
    law = ViscousFriction(mu=mu).law
    # Equal steps of speed: dx = v dv / v', exact by the midpoint rule because v' is proportional to v.
    edges = np.linspace(1.0, 0.0, 1001)
    speeds = 0.5 * (edges[:-1] + edges[1:])
    slowing = gravity * np.array([law.traction((v, 0.0), (0.0, 0.0, 0.0)).force[0] for v in speeds])
    distance = float(np.sum(speeds * np.diff(edges) / slowing))
    return xr.Dataset(
        {"distance": variable(distance, "m", "distance to rest")},
        attrs={"mu_s_per_m": mu, "speed_m_per_s": 1.0},
    )


EXPERIMENTS = [
    Experiment("printed-equations", "equations (2.7) and (2.9) at an instant", 0.3, _printed),
    Experiment("steady-bodies", "steady states of several bodies", 0.5, _steady),
    Experiment("unit-of-mu", "the unit of the friction coefficient", 0.3, _unit_of_mu),
    Experiment("block", "a block on the table of Fig. 8", 0.1, _block),
]
"""What the report's printed equations and table are checked by."""
