"""The report's printed equations, evaluated: of motion, of rotation, and of the steady state."""

import math
from typing import Any

import numpy as np
import xarray as xr
from scipy.spatial.transform import Rotation

from tippetop.integrators.base import Array
from tippetop.mechanics.euler import published_normal_force, published_parameters, published_rates
from tippetop.mechanics.motion import angular_velocity, sliding_contact
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import VERTICAL, Scalar, Vector, cross, dot, scale
from tippetop.problem.presets import REPORT, report_problem
from tippetop.problem.problem import Problem, top_of
from tippetop.problem.shapes import EccentricSphere
from tippetop.report.experiment import dataset, experiment
from tippetop.report.experiments.runs import on_table
from tippetop.report.listing import VARIABLES
from tippetop.run import simulate

_INSTANT = 5.0
_INSTANTS = np.array([1.0, 3.0, _INSTANT, 6.0, 8.0])
"""Instants at which equations of motion are compared with a run, s."""

_STEP = 3e-5
_STENCIL = np.array([1.0, -8.0, 0.0, 8.0, -1.0]) / (12.0 * _STEP)
"""Coefficients of the fourth-order difference quotient at five points, `_STEP` (s) apart."""


@experiment("printed-equations", "the equations of section 2.2 along a run", 0.3)
def _printed(quick: bool) -> xr.Dataset:
    """Return differences between the equations of section 2.2 and the main run, at several
    instants.
    """
    problem = on_table(report_problem())
    top = top_of(problem)
    times = (_INSTANTS[:, None] + _STEP * np.arange(-2, 3)).ravel()
    run = simulate(problem, float(_INSTANTS[-1]) + 1.0, times=times)
    now = run.isel(time=slice(2, None, 5))
    states = np.array([now[name].values for name in VARIABLES])
    published = np.array(published_rates(tuple(states), top, np))
    rates = np.array([_STENCIL @ run[name].values.reshape(-1, 5).T for name in VARIABLES])
    rows = {"(2.8)": 1, "(2.10)": 4, "(2.12)": 5, "(2.14)": 6}
    misses = {
        name: np.abs(published[row] - rates[row]).max() / np.abs(rates[row]).max()
        for name, row in rows.items()
    }
    force = published_normal_force(tuple(states), top, np)
    misses["(2.15)"] = np.abs(force / now["normal_force"].values - 1.0).max()
    misses["a"] = max(_arm_miss(now.isel(time=k), top) for k in range(len(_INSTANTS)))
    falling = now["velocity"].values[:, 2]
    rising = _STENCIL @ _arm_height(run["tilt"].values, top).reshape(-1, 5).T
    misses["(s + a).z = 0"] = np.abs(falling + rising).max() / np.abs(falling).max()
    return dataset(
        {"equation": list(misses)},
        {"problem": problem.to_json(), "instant_s": _INSTANT},
        miss=(list(misses.values()), "1", "largest relative difference from the run", "equation"),
        **_at_one_instant(run, states, published, rates, problem),
    )


def _at_one_instant(
    run: xr.Dataset, states: Array, published: Array, rates: Array, problem: Problem
) -> dict[str, object]:
    """Return the two misprinted equations as printed and corrected, at `_INSTANT`."""
    k, body = int(np.argmax(_INSTANTS == _INSTANT)), problem.body
    y, listed = states[:, k], published[:, k]
    c, s = math.cos(y[0]), math.sin(y[0])
    torque = _torques(run.isel(time=5 * k + 2), top_of(problem))
    turning = np.array(torque["second_axis"])
    momentum = run["angular_momentum"].values[5 * k : 5 * k + 5]
    bracket = body.I1 * listed[3] * s
    by_listing = body.I1 * listed[1] - body.I1 * y[3] ** 2 * s * c + body.I3 * y[4] * y[3] * s
    over = body.I1 / bracket / (body.I1 * s)
    read = "rate of phi' by (2.9) as printed, read as I1"
    return {
        "torque_printed": (torque["printed"], "N m", "second component of F x a, as (2.7) has it"),
        "torque_listing": (by_listing, "N m", "second component of L' by (2.8)"),
        "torque": (
            float(_STENCIL @ momentum @ turning),
            "N m",
            "second component of L' of the run",
        ),
        "torque_turned": (torque["turned"], "N m", "second component of a x F, F with the weight"),
        "torque_corrected": (torque["corrected"], "N m", "second component of a x F without it"),
        "power_printed": (torque["power_printed"], "W", "power of the contact force with F x a"),
        "power": (torque["power"], "W", "power of the contact force with a x F"),
        "precession_printed": (over, "rad s-2", f"{read} over the bracket over I1 sin(theta)"),
        "precession_printed_product": (
            body.I1 * listed[3],
            "rad s-2",
            f"{read} times the bracket over I1 sin(theta)",
        ),
        "precession_listing": (listed[3], "rad s-2", "rate of phi' by the listing"),
        "precession": (rates[3, k], "rad s-2", "d phi'/dt of the converged run"),
    }


def _arm_miss(now: xr.Dataset, top: Top) -> float:
    """Return the largest component of the report's a minus the contact vector, over R."""
    axis, momentum, velocity = (
        _vector(now, name) for name in ("axis", "angular_momentum", "velocity")
    )
    R, alpha = published_parameters(top)[3:5]
    three = np.array(axis)
    c, s = three[2], math.hypot(*axis[:2])
    one = (c * three - np.array(VERTICAL)) / s
    printed = R * (s * one + (alpha - c) * three)
    arm = sliding_contact(axis, momentum, (velocity[0], velocity[1]), top).arm
    return float(np.abs(printed - np.array(arm)).max() / R)


def _arm_height(theta: Array, top: Top) -> Array:
    """Return the vertical component of the report's a, m."""
    _, _, _, R, alpha, _, _ = published_parameters(top)
    s, c = np.sin(theta), np.cos(theta)
    # Axis 1 is perpendicular to the body's axis in its vertical plane, with height -sin(theta).
    return np.asarray(R * (-s * s + (alpha - c) * c))


def _torques(now: xr.Dataset, top: Top) -> dict[str, Any]:
    """Return contact torques about axis 2, printed and corrected, and the powers they imply."""
    axis, momentum, velocity = (
        _vector(now, name) for name in ("axis", "angular_momentum", "velocity")
    )
    touch = sliding_contact(axis, momentum, (velocity[0], velocity[1]), top)
    normal = touch.normal_force
    force: Vector = (normal * touch.traction.force[0], normal * touch.traction.force[1], normal)
    total: Vector = (force[0], force[1], normal - top.mass * top.gravity)
    second = scale(1.0 / math.hypot(*axis[:2]), cross(VERTICAL, axis))
    omega = angular_velocity(axis, momentum, top)
    driving = dot(force, velocity)
    return {
        "second_axis": second,
        "printed": dot(cross(total, touch.arm), second),
        "turned": dot(cross(touch.arm, total), second),
        "corrected": dot(cross(touch.arm, force), second),
        "power_printed": driving + dot(cross(force, touch.arm), omega),
        "power": driving + dot(cross(touch.arm, force), omega),
    }


def _vector(now: xr.Dataset, name: str) -> Vector:
    x, y, z = (float(value) for value in now[name].values)
    return (x, y, z)


@experiment("steady-bodies", "steady states of several bodies", 0.5)
def _steady(quick: bool) -> xr.Dataset:
    """Return final states of several bodies between upright and inverted, and residuals of (2.16),
    (2.17).
    """
    m, R = REPORT.mass, float(REPORT.surface.size)
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
    duration = 150.0 if quick else 400.0
    rows = []
    for _, body, spin in tops:
        problem = on_table(report_problem(spin).replace({"body": body.model_dump()}))
        end = simulate(problem, duration, samples=2).isel(time=-1)
        y = [float(end[name]) for name in VARIABLES]
        rates = published_rates(y, top_of(problem), math)
        speed = float(body.surface.size) * abs(y[4])
        slip = [
            math.hypot(*pair) / size
            for pair, size in ((y[5:], speed), (rates[5:], speed * abs(y[3])))
        ]
        turning = abs(rates[3]) / y[3] ** 2, abs(y[1] / y[3])
        rows.append(
            (y[0], y[3], y[4], *_residuals(y, top_of(problem)), abs(rates[4]), *turning, *slip)
        )
    table = np.array(rows).T
    names = {
        "tilt": ("rad", "tilt"),
        "precession": ("rad s-1", "precession"),
        "spin": ("rad s-1", "axial spin"),
        "residual_217": ("rad s-1", "omega3 - phi' (cos theta - alpha), equation (2.17)"),
        "residual_216": ("1", "largest of the lines of (2.16), each over the largest of its terms"),
        "spin_rate": ("rad s-2", "rate of the axial spin"),
        "azimuth_ddot": ("1", "rate of the precession, over its square"),
        "tilt_rate": ("1", "rate of the tilt, over the precession"),
        "slip": ("1", "slip speed, over R omega3"),
        "slip_rate": ("1", "rates of its components, over R omega3 phi'"),
    }
    return dataset(
        {"body": [name for name, _, _ in tops]},
        {"duration_s": duration},
        **{
            name: (row, *meaning, "body")
            for row, (name, meaning) in zip(table, names.items(), strict=True)
        },
    )


def _residuals(y: list[float], top: Top) -> tuple[float, float]:
    """Return the residuals of (2.17), rad/s, and of (2.16), relative to its terms, in a state."""
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
    residual = max(abs(sum(line)) / max(abs(term) for term in line) for line in (first, fourth))
    return residual_of_217(theta, precession, spin, alpha), residual


def residual_of_217(tilt: Scalar, precession: Scalar, spin: Scalar, alpha: float) -> Scalar:
    """Return the residual of (2.17), omega3 = phi' (cos(theta) - alpha), rad/s."""
    return spin - precession * (np.cos(tilt) - alpha)


@experiment("rotation", "the equations of section 2.1 at random states", 0.1)
def _rotation(quick: bool) -> xr.Dataset:
    """Return errors of the equations of section 2.1 at random states: (2.1), (2.2) and (2.6)."""
    random = np.random.default_rng(1)
    misses = [
        _rotation_misses(random.uniform(0.3, 1.3, 3), random.normal(size=3), random.normal(size=3))
        for _ in range(20)
    ]
    return dataset(
        {"equation": ["(2.1)", "(2.2)", "(2.6)"]},
        miss=(np.max(misses, axis=0), "1", "largest relative difference", "equation"),
    )


def _rotation_misses(angles: Array, rates: Array, torque: Array) -> tuple[float, float, float]:
    """Return the relative errors of (2.1), (2.2) and (2.6) for Euler angles, their rates and a
    torque.
    """
    h, inertia = 1e-4, np.array([2.0, 3.0, 4.0])

    def turned(time: float) -> Rotation:
        return Rotation.from_euler("ZXZ", angles + time * rates)

    omega = (turned(-h).inv() * turned(h)).as_rotvec() / (2.0 * h)
    z, nodes = np.eye(3)[2], Rotation.from_euler("Z", angles[0]).apply(np.eye(3)[0])
    by_axes = (
        turned(0.0).inv().apply(rates[0] * z + rates[1] * nodes + rates[2] * turned(0.0).apply(z))
    )
    (_, sb, sc), (_, cb, cc) = np.sin(angles), np.cos(angles)
    by_components = (
        rates[1] * cc + rates[0] * sb * sc,
        -rates[1] * sc + rates[0] * sb * cc,
        rates[2] + rates[0] * cb,
    )
    one, two, three = inertia
    couplings = (
        (two - three) * omega[1] * omega[2],
        (three - one) * omega[2] * omega[0],
        (one - two) * omega[0] * omega[1],
    )
    faster = (torque + np.array(couplings)) / inertia

    def momentum(time: float) -> Array:
        turn = Rotation.from_rotvec(time * (omega + 0.5 * time * faster))
        return np.asarray(turn.apply(inertia * (omega + time * faster)))

    gained = (momentum(h) - momentum(-h)) / (2.0 * h)
    return (
        _relative_size(by_axes - omega, omega),
        _relative_size(np.array(by_components) - omega, omega),
        _relative_size(gained - torque, torque),
    )


def _relative_size(difference: Array, total: Array) -> float:
    return float(np.abs(difference).max() / np.abs(total).max())
