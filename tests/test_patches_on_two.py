"""Two contacts whose patches resist slip and drilling: both stick together, and then for good."""

import numpy as np
import pytest
import xarray as xr
from scipy.optimize import brentq, minimize

import tippetop as tt
from campaigns import among
from lying import R
from test_sticking_on_two import (
    ACROSS,
    BALL,
    DUMBBELL,
    HALF,
    MASS,
    MU,
    ONE_THEN_BOTH,
    SLIPS_AGAIN,
    G,
    followed_by_steps,
    lying,
    times,
)
from tippetop.contact.closed_pair import rolling_of
from tippetop.mechanics.contacts import pair_resolution
from tippetop.mechanics.contacts.contact_forces import forces_on_two
from tippetop.mechanics.contacts.contact_point import ContactPoint, contact_points
from tippetop.mechanics.contacts.pair_resolution import moments_hold, patches_begin_to_slip
from tippetop.mechanics.laws.contensou_hertz import HertzLaw
from tippetop.mechanics.top import natural, natural_state, natural_units
from tippetop.mechanics.unsolved import Unsolved
from tippetop.problem.problem import top_of

RADIUS = 0.004
"""A patch nearly as large as the dumbbell's balls: drilling counts."""
PRESSURES = ["ellipsoidal", "hertz"]


def with_patch(problem: tt.Problem, pressure: str, radius: float = RADIUS) -> tt.Problem:
    law = tt.ContensouFriction(mu=problem.friction.mu, patch_radius=radius, pressure=pressure)
    return problem.replace({"friction": law})


def words(run: xr.Dataset) -> list[str]:
    """What the body does, sample by sample."""
    return run["mode"].values.tolist()


@pytest.mark.parametrize("pressure", among(PRESSURES, check=1))
def test_what_slides_without_turning_stops_as_coulombs_friction_stops_it(pressure: str) -> None:
    dumbbell = with_patch(DUMBBELL, pressure)
    along = followed_by_steps(dumbbell.replace({"launch.velocity": (0.2, 0.0, 0.0)}), 1.0)
    assert along.attrs["status"] == "at_rest"
    assert times(along, "stick") == pytest.approx([0.2 / (MU * G)] * 2, rel=1e-13)
    across = followed_by_steps(dumbbell.replace({"launch.velocity": (0.0, 0.2, 0.0)}), 1.0)
    slowing = MU * G * (1.0 + MASS * BALL**2 / 1.25e-7)
    assert times(across, "stick") == pytest.approx([0.2 / slowing] * 2, rel=1e-12)
    assert across.attrs["status"] == "completed"
    assert words(across)[-1] == "sticking_on_0_and_1"


def couple(pressure: str) -> float:
    """Of a patch that drills at the rate w, and slips at the speed HALF w, over mu N."""
    if pressure == "ellipsoidal":
        return float(np.hypot(HALF, 3.0 * np.pi / 16.0 * RADIUS))
    k = HALF / RADIUS
    sigma, q = np.arcsin(1.0 / k), np.sqrt(k * k - 1.0)
    force = 3.0 / 16.0 * (k * (4.0 - k * k) * sigma + q * (k * k + 2.0) / k)
    torque = 3.0 / 8.0 * ((1.0 - k * k + 0.375 * k**4) * sigma + q * (0.75 - 0.375 * k * k))
    return float(HALF * force + RADIUS * torque)


@pytest.mark.parametrize("pressure", PRESSURES)
def test_what_turns_stops_under_the_couple_of_forces_and_of_drilling(pressure: str) -> None:
    turns = with_patch(DUMBBELL, pressure).replace(
        {"launch.precession": 5.0, "launch.velocity": (0, 0, 0)}
    )
    run = followed_by_steps(turns, 1.0)
    assert run.attrs["status"] == "at_rest"
    assert times(run, "stick") == pytest.approx(
        [5.0 * ACROSS / (MU * MASS * G * couple(pressure))] * 2, rel=1e-12
    )


@pytest.mark.parametrize("pressure", among(PRESSURES, check=1))
def test_slip_and_drilling_end_together_on_both_patches(pressure: str) -> None:
    problem = with_patch(lying(ONE_THEN_BOTH), pressure, 2e-3)
    run = followed_by_steps(problem, 0.2, 101)
    ends = times(run, "stick")
    assert len(ends) == 2
    assert ends[0] == ends[1]
    stuck = run["time"].values > ends[0]
    assert set(np.array(words(run))[stuck]) == {"sticking_on_0_and_1"}
    axis, momentum = run["axis"].values[stuck], run["angular_momentum"].values[stuck]
    across, along = problem.body.I1, problem.body.I3
    own = np.sum(axis * momentum, axis=1)[:, None] * axis
    turning = own / along + (momentum - own) / across
    assert np.abs(turning[:, 2]).max() < 1e-12 * np.abs(turning).max()
    assert np.ptp(np.linalg.norm(turning, axis=1)) < 1e-12 * np.abs(turning).max()
    assert float(run["energy_error"]) < 1e-12
    assert float(abs(run["gap"]).max()) < 1e-12 * 0.02


def test_small_patches_stick_when_coulombs_friction_has_both_stick() -> None:
    """One of two contacts sticks first there; here it creeps, and the less the smaller its
    patch.
    """
    dry = times(followed_by_steps(lying(10), 0.2), "stick")
    off = []
    for radius in (4e-4, 1e-4):
        run = followed_by_steps(with_patch(lying(10), "hertz", radius), 0.2)
        off.append(abs(times(run, "stick")[-1] - max(dry)))
    assert off[1] < 0.3 * off[0]
    assert off[1] < 1e-4


@pytest.mark.parametrize("pressure", PRESSURES)
def test_rolling_lasts_as_long_as_friction_can_turn_the_path(pressure: str) -> None:
    """It rolls as a cone, Omega along the line of both contacts: its centre, h high, with Omega^2 h
    cot(tilt).
    """
    body = with_patch(lying(SLIPS_AGAIN), pressure)
    tilt = body.launch.tilt
    sphere = body.body.shape[0]
    height = sphere.radius - sphere.center * np.cos(tilt)
    most = np.sqrt(body.friction.mu * G * abs(np.tan(tilt)) / height)
    for part, mode in ((0.999, "sticking_on_0_and_1"), (1.01, "sliding_on_0_and_1")):
        turning = part * most
        rolls = {
            "launch.spin": turning * np.sin(tilt),
            "launch.precession": -turning / np.tan(tilt),
            "launch.velocity": None,
        }
        run = followed_by_steps(body.replace(rolls), 0.01)
        assert set(words(run)[1:]) == {mode}
        assert float(run["energy_error"]) < 1e-12


def rolling(turning: float, arm: float) -> tt.Problem:
    """A body that rolls on two patches about the line through both, while that is resisted."""
    body = with_patch(lying(8), "ellipsoidal")
    tilt = body.launch.tilt
    return body.replace(
        {
            "launch.spin": turning * np.sin(tilt),
            "launch.precession": -turning / np.tan(tilt),
            "launch.velocity": None,
            "rolling_resistance": arm,
        }
    )


def holding(problem: tt.Problem, turning: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """What holds it, as a force along and across and a moment about the vertical, the normal
    forces, and where they act; from m V' and L' of a body that rolls at this rate.
    """
    body, tilt = problem.body, problem.launch.tilt
    s, c = np.sin(tilt), np.cos(tilt)
    spheres = [shape.surface for shape in body.shapes]
    height = spheres[0].radius - spheres[0].center * c
    along, upwards = body.I1 * c * c + body.I3 * s * s, (body.I3 - body.I1) * s * c
    slowing = -problem.rolling_resistance * body.mass * G / (along + body.mass * height**2)
    way_round = -turning * c / s
    forces = body.mass * height * np.array([turning * way_round, -slowing])
    places = s * np.array([sphere.center for sphere in spheres])
    moment = -height * forces[0] - turning * along * way_round
    normal = np.linalg.solve([[1.0, 1.0], places], [body.mass * G, moment])
    return np.array([*forces, slowing * upwards]), normal, places


def spared(problem: tt.Problem, turning: float) -> float:
    """How many times what holds it both patches can exert, less 1, by the least of a convex
    function.

    A motion in which they slip, and in which what holds it has the power 1, loses this to friction
    at least.
    """
    wrench, normal, places = holding(problem, turning)
    scaled = wrench / (1.0, 1.0, R)
    first, others = scaled / (scaled @ scaled), np.linalg.svd(scaled[None])[2][1:]
    drilled = 3.0 * np.pi / 16.0 * problem.friction.patch_radius

    def loss(parts: np.ndarray) -> float:
        along, across, turned = first + parts @ others
        slips = np.hypot(along, across + turned / R * places)
        return float(problem.friction.mu * normal @ np.hypot(slips, drilled * turned / R))

    starts = ([0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0])
    return (
        min(minimize(loss, start, method="BFGS", options={"gtol": 1e-13}).fun for start in starts)
        - 1.0
    )


def test_moments_of_drilling_hold_what_forces_alone_do_not() -> None:
    """It rolls until that ends, though across the line one contact would need more than its mu
    N.
    """
    problem = rolling(6.0, 0.0076)
    wrench, normal, places = holding(problem, 0.0)
    across = np.linalg.solve([[1.0, 1.0], places], wrench[1:])
    assert (np.abs(across) > problem.friction.mu * normal).any()
    assert min(spared(problem, turning) for turning in (1e-6, 1.0, 3.0, 6.0)) > 0.0
    run = followed_by_steps(problem, 0.2, 101)
    assert run.attrs["status"] == "at_rest"
    assert not times(run, "slip")
    assert set(words(run)[1:]) == {"sticking_on_0_and_1", "sticking_without_rolling_on_0_and_1"}
    assert float(run["energy_error"]) < 1e-12


def test_patches_slip_when_rolling_has_become_too_slow_for_what_holds_them() -> None:
    """The fewer it presses one contact with, of which the needed force across the line stays the
    same.
    """
    problem = rolling(10.0, 0.00775)
    held = brentq(lambda turning: spared(problem, turning), 0.5, 10.0, xtol=1e-12)
    assert 1.0 < held < 9.0
    sphere = problem.body.shape[0].surface
    height = sphere.radius - sphere.center * np.cos(problem.launch.tilt)
    (_, across, _), _, _ = holding(problem, held)
    expected = (10.0 - held) * problem.body.mass * height / across
    run = followed_by_steps(problem, expected + 1e-4)
    assert times(run, "slip") == pytest.approx([expected] * 2, rel=1e-7)
    assert float(run["energy_error"]) < 1e-11


def resting_pair(problem: tt.Problem) -> tuple[tuple[ContactPoint, ...], float]:
    """Both contacts at launch, in natural units, and which way the body rolls."""
    top = natural(top_of(problem))
    state = natural_state(problem.start(), natural_units(top_of(problem)))
    return contact_points(state.axis, state.momentum, top.body.contacts), rolling_of(state, top)


@pytest.mark.parametrize(
    ("turning", "arm"), [(6.0, 0.0076), (9.0, 0.00775), (0.5, 0.00775), (1.0, 0.0076)]
)
def test_what_moments_of_drilling_can_hold_follows_from_virtual_power(
    turning: float, arm: float
) -> None:
    """Against the least of the same function, found in other coordinates by another method."""
    problem = rolling(turning, arm)
    pair, rolls = resting_pair(problem)
    held = forces_on_two(pair, (None, None), rolls)
    assert moments_hold(held) is (spared(problem, turning) > 0.0)


def test_a_search_that_fails_does_not_prove_that_patches_are_held(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def fail(*_: object) -> None:
        raise Unsolved("no direction is found")

    monkeypatch.setattr(pair_resolution, "both_begin_to_slip", fail)
    assert spared(rolling(0.5, 0.00775), 0.5) < 0.0
    with pytest.raises(Unsolved):
        patches_begin_to_slip(*resting_pair(rolling(0.5, 0.00775)))
    assert patches_begin_to_slip(*resting_pair(rolling(6.0, 0.0076))) is None


def test_what_holds_hertz_s_patch_without_drilling_is_an_expression():
    """Two contacts that stick and roll ask for it with a normal force that is a symbol."""
    heyoka = pytest.importorskip("heyoka")
    law = HertzLaw(0.3, 0.002)
    normal = heyoka.make_vars("n")
    found = law.reserve(normal, (0.1, 0.0), 0.0)
    value = heyoka.cfunc([found], [normal])([2.0])[0]
    assert value == pytest.approx(law.reserve(2.0, (0.1, 0.0), 0.0), rel=1e-14)


@pytest.mark.parametrize(
    ("mu", "launch"),
    [
        pytest.param(
            1.5506065568155263,
            tt.Launch(
                tilt=1.2920733759451828,
                spin=52.41267965979179,
                precession=-2.106238954529296,
                tilt_rate=2.67910701178515,
                slip=(0.2782247755752787, -0.5639138835596632),
            ),
            marks=pytest.mark.slow,
        ),
        (
            2.3245753197486803,
            tt.Launch(
                tilt=0.9140875735578099,
                spin=-46.39089017667182,
                precession=25.421234302475554,
                tilt_rate=-4.859790179379005,
                slip=(-0.26004687289698464, -0.07174661181128668),
            ),
        ),
    ],
)
def test_a_ball_comes_down_in_the_last_moments_of_slip_on_the_other(
    mu: float, launch: tt.Launch
) -> None:
    """Where slip and drilling end together, as power series tell, within milliseconds of the
    touch.
    """
    law = tt.ContensouFriction(mu=mu, patch_radius=5e-4, pressure="ellipsoidal")
    balls = tt.presets.BODIES["hurricane-balls"]
    run = tt.simulate(tt.Problem(body=balls, friction=law, launch=launch), 0.3, samples=1001)
    assert run.attrs["status"] == "completed"
    assert float(run["gap"].min()) > -1e-12
