"""The published equations: a reference model for the singularity-free form, and where they are
wrong.
"""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from campaigns import among
from strategies import angles, numbers, spheres, tops
from tippetop.mechanics.euler import published_energy, published_normal_force, published_rates
from tippetop.mechanics.invariants import energy, jellett
from tippetop.mechanics.laws.friction import RegularizedCoulombLaw, ViscousLaw
from tippetop.mechanics.motion import on_table, sliding_contact, sliding_rates
from tippetop.mechanics.state import SlidingState
from tippetop.mechanics.surfaces.surface import SphereSurface, SpheroidSurface
from tippetop.mechanics.top import Top
from tippetop.mechanics.view import Angles, state_from_angles

VISCOUS_SPHERES = tops(shapes=spheres(), friction_laws=(ViscousLaw,))
LAUNCHES = VISCOUS_SPHERES.flatmap(lambda top: st.tuples(st.just(top), angles(top)))

MASS, RADIUS = 0.02, 0.02
TIPPE_TOP = Top.of(
    MASS,
    131 / 350 * MASS * RADIUS**2,
    2 / 5 * MASS * RADIUS**2,
    SphereSurface(RADIUS, 0.3 * RADIUS),
    ViscousLaw(0.3),
    9.8,
)

CONVERGED_TILTS = {
    50.0: (
        0.044079719929,
        0.038000728951,
        0.128112074376,
        0.457767096583,
        1.243168192814,
        1.503557333885,
    ),
    155.0: (
        0.090203172662,
        0.069549411907,
        0.203285686736,
        1.804652321102,
        3.134116250457,
        3.141443639505,
    ),
}
"""Tilt (rad) at 1, 2, 4, 6, 8 and 20 s after a launch at 0.1 rad with this spin (rad/s), to 12
digits.
"""

TIMES = (1.0, 2.0, 4.0, 6.0, 8.0, 20.0)


def as_numbers(motion):
    """(theta, theta', phi, phi', omega3, v_x, v_y) of a motion."""
    return (
        motion.tilt,
        motion.tilt_rate,
        motion.azimuth,
        motion.precession,
        motion.spin,
        *motion.slip,
    )


def launch(spin):
    return Angles(0.1, 0.0, 0.0, 0.0, spin, (0.0, 0.0))


@pytest.fixture(
    scope="module", params=among([50.0, 155.0], check=1), ids=lambda spin: f"{spin:g} rad/s"
)
def spin(request):
    return request.param


@pytest.fixture(scope="module")
def published_run(spin):
    """Tilt at TIMES by the published equations."""
    run = solve_ivp(
        lambda t, y: published_rates(y.tolist(), TIPPE_TOP, math),
        (0.0, TIMES[-1]),
        as_numbers(launch(spin)),
        method="DOP853",
        t_eval=TIMES,
        rtol=1e-12,
        atol=1e-12,
    )
    return run.y[0]


@pytest.fixture(scope="module")
def sliding_run(spin):
    """Works and states at launch and at TIMES by the equations in axis, angular momentum and
    velocity.
    """
    start = state_from_angles(launch(spin), TIPPE_TOP, math)
    momentum = TIPPE_TOP.axial_inertia * spin
    size = np.array([1.0] * 3 + [momentum] * 3 + [0.1] * 2 + [0.01])

    def rates(_, y):
        state = SlidingState.unpack(y.tolist())
        power = sliding_contact(state.axis, state.momentum, state.velocity, TIPPE_TOP).power
        return (*sliding_rates(state, TIPPE_TOP).pack(), power)

    run = solve_ivp(
        rates,
        (0.0, TIMES[-1]),
        (*start.pack(), 0.0),
        method="DOP853",
        t_eval=TIMES,
        rtol=1e-13,
        atol=1e-13 * size,
    )
    return [(0.0, start), *((y[8], SlidingState.unpack(y)) for y in run.y.T.tolist())]


def tilts(run):
    return [math.atan2(math.hypot(state.axis[0], state.axis[1]), state.axis[2]) for _, state in run]


def test_published_and_singularity_free_equations_give_the_same_motion(published_run, sliding_run):
    assert tilts(sliding_run[1:]) == pytest.approx(published_run, abs=1e-9)


def test_both_give_the_converged_tilts(spin, published_run, sliding_run):
    assert published_run == pytest.approx(CONVERGED_TILTS[spin], abs=1e-10)
    assert tilts(sliding_run[1:]) == pytest.approx(CONVERGED_TILTS[spin], abs=1e-9)


def test_the_whole_motion_keeps_jelletts_integral_and_loses_the_energy_that_friction_takes(
    sliding_run,
):
    (_, start), *later = ((work, on_table(state, TIPPE_TOP)) for work, state in sliding_run)
    for work, state in later:
        assert jellett(state, TIPPE_TOP) == pytest.approx(jellett(start, TIPPE_TOP), rel=1e-10)
        lost = energy(start, TIPPE_TOP) - energy(state, TIPPE_TOP)
        assert lost > 0.0
        assert lost == pytest.approx(-work, abs=1e-10 * energy(start, TIPPE_TOP))


def test_the_whole_motion_keeps_the_axis_of_unit_length(sliding_run):
    for _, state in sliding_run:
        assert math.hypot(*state.axis) == pytest.approx(1.0, abs=1e-9)


@given(LAUNCHES)
def test_the_published_energy_is_the_energy_without_slip(case):
    top, motion = case
    motion = motion._replace(slip=(0.0, 0.0))
    whole = on_table(state_from_angles(motion, top, math), top)
    assert published_energy(as_numbers(motion), top, math) == pytest.approx(
        energy(whole, top), rel=1e-12
    )


@given(LAUNCHES)
def test_the_published_energy_leaves_out_the_energy_of_slipping(case):
    """What (4.1) lacks is m (v^2 / 2 + R theta' (1 - alpha c) v_x - R s (omega3 + phi' (alpha - c))
    v_y).
    """
    top, motion = case
    radius, center = top.surface
    alpha = center / radius
    s, c = math.sin(motion.tilt), math.cos(motion.tilt)
    slip_x, slip_y = motion.slip
    lacking = top.mass * (
        0.5 * (slip_x**2 + slip_y**2)
        + radius * motion.tilt_rate * (1.0 - alpha * c) * slip_x
        - radius * s * (motion.spin + motion.precession * (alpha - c)) * slip_y
    )
    true = energy(on_table(state_from_angles(motion, top, math), top), top)
    assert true - published_energy(as_numbers(motion), top, math) == pytest.approx(
        lacking, abs=1e-12 * true
    )


@given(LAUNCHES)
def test_a_sphere_that_nods_without_spin_or_friction_presses_by_weight_and_swing(case):
    """z = R (1 - alpha c), I1 theta'' = -N R alpha s and m (z'' + g) = N, solved for N."""
    top, motion = case
    radius, center = top.surface
    alpha = center / radius
    s, c = math.sin(motion.tilt), math.cos(motion.tilt)
    swing = top.mass * radius * alpha * c * motion.tilt_rate**2
    compliance = top.mass * (radius * alpha * s) ** 2 / top.transverse_inertia
    expected = (top.mass * top.gravity + swing) / (1.0 + compliance)
    smooth = top.altered(friction=ViscousLaw(0.0))
    y = (motion.tilt, motion.tilt_rate, 0.0, 0.0, 0.0, 0.0, 0.0)
    assert published_normal_force(y, smooth, math) == pytest.approx(
        expected, rel=1e-12, abs=1e-12 * abs(swing)
    )


@given(VISCOUS_SPHERES, numbers(-1.0, 1.0))
def test_taking_the_tilt_modulo_pi_makes_the_equations_jump_at_the_inverted_pole(top, slip_x):
    """theta'' is m g R mu v_x (1 + alpha) / I1 before theta = pi, and that with 1 - alpha after
    it.
    """
    radius, center = top.surface
    alpha = center / radius
    lever = top.mass * top.gravity * radius * top.friction.mu * slip_x / top.transverse_inertia
    unit = 1e-6 * (abs(lever) + top.mass * top.gravity * radius / top.transverse_inertia)

    def nodding(tilt, wrap):
        return published_rates((tilt, 0.0, 0.0, 0.0, 0.0, slip_x, 0.0), top, math, wrap)[1]

    for wrap in (None, math.pi):
        assert nodding(math.pi - 1e-9, wrap) == pytest.approx(lever * (1.0 + alpha), abs=unit)
    assert nodding(math.pi + 1e-9, None) == pytest.approx(lever * (1.0 + alpha), abs=unit)
    assert nodding(math.pi + 1e-9, math.pi) == pytest.approx(lever * (1.0 - alpha), abs=unit)


@pytest.mark.parametrize(
    "top",
    [
        TIPPE_TOP.altered(surface=SpheroidSurface(0.02, 0.03)),
        TIPPE_TOP.altered(friction=RegularizedCoulombLaw(0.3, 0.01)),
    ],
    ids=["spheroid", "Coulomb friction"],
)
@pytest.mark.parametrize("function", [published_rates, published_normal_force, published_energy])
def test_the_published_equations_refuse_what_they_do_not_hold_for(top, function):
    with pytest.raises(TypeError, match="eccentric sphere with viscous friction"):
        function(as_numbers(launch(100.0)), top, math)
