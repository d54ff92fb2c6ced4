"""Rolling resistance of bodies of several surfaces: what is known exactly, and what must hold."""

from typing import Any, NamedTuple

import numpy as np
import pytest
import xarray as xr
from scipy.spatial.transform import Rotation

import moreau
import tippetop as tt
from campaigns import among
from lying import R, lying, resisted
from tippetop.contact import slip_end_mode
from tippetop.contact.automaton import Automaton
from tippetop.contact.trajectory import Trajectory
from tippetop.integrators import make_integrator
from tippetop.mechanics.contacts.contact_forces import forces_on_two
from tippetop.mechanics.contacts.contact_point import contact_points
from tippetop.mechanics.contacts.pair import turning_along
from tippetop.mechanics.laws.friction import Traction
from tippetop.mechanics.motion import angular_velocity
from tippetop.mechanics.natural_units import Units
from tippetop.mechanics.top import natural, natural_state, natural_units
from tippetop.mechanics.vectors import Horizontal, Scalar, Vector
from tippetop.problem.problem import top_of

M, ARM, G = 0.015, 2e-4, 9.8
LAWS = {
    "coulomb": tt.CoulombFriction(mu=0.2),
    "ellipsoidal": tt.ContensouFriction(mu=0.3, patch_radius=1e-3, pressure="ellipsoidal"),
    "viscous": tt.ViscousFriction(mu=0.3),
}
SPHERE = tt.Sphere(radius=R, center=-0.3 * R)


def followed(problem: tt.Problem, duration: float, samples: int = 41) -> xr.Dataset:
    """By a method that needs no compiling."""
    return tt.simulate(problem, duration, samples=samples, integrator="dop853", tolerance=3e-14)


def events(run: xr.Dataset, kind: str) -> list[float]:
    found: list[float] = run["event_time"].values[run["event_kind"].values == kind].tolist()
    return found


def words(run: xr.Dataset) -> list[str]:
    return run["mode"].values.tolist()


def losses(run: xr.Dataset) -> list[float]:
    return [float(run[f"energy_lost_{name}"]) for name in ("sliding", "drilling", "rolling")]


@pytest.mark.parametrize("friction", among(list(LAWS.values()), 1), ids=lambda law: law.kind)
def test_a_surface_that_never_touches_changes_nothing(friction: tt.Friction) -> None:
    tip = tt.Sphere(radius=0.2 * R, center=R)
    alone, both = (
        followed(
            tt.Problem(
                body=tt.Body(mass=M, shape=shape, I1=0.4 * M * R * R, I3=0.42 * M * R * R),
                friction=friction,
                launch=tt.Launch(tilt=0.5, spin=40.0, gap=0.003),
                rolling_resistance=ARM,
            ),
            0.3,
        )
        for shape in ([SPHERE], [SPHERE, tip])
    )
    assert both.attrs["status"] == alone.attrs["status"]
    assert both["event_kind"].values.tolist() == alone["event_kind"].values.tolist()
    assert len(alone["event_kind"]) > 1
    for name in ("event_time", "axis", "angular_momentum", "velocity", "energy_lost_rolling"):
        size = float(abs(alone[name]).max())
        np.testing.assert_allclose(both[name], alone[name], rtol=0, atol=1e-12 * size)


MASS, BALL, HALF, MU, ACROSS, ALONG = 0.01, 0.005, 0.02, 0.3, 2e-6, 1.25e-7
ROLLED = ALONG + MASS * BALL**2
SHAPES: dict[str, Any] = {
    "balls": [tt.Sphere(radius=BALL, center=HALF), tt.Sphere(radius=BALL, center=-0.5 * HALF)],
    "edges": [tt.Ring(radius=BALL, center=HALF), tt.Ring(radius=BALL, center=-0.5 * HALF)],
}


def dumbbell(shape: str = "balls", arm: float = ARM, mu: float = MU, **launch: Any) -> tt.Problem:
    """A body that lies on two like surfaces, with its axis along x."""
    body = tt.Body(mass=MASS, shape=SHAPES[shape], I1=ACROSS, I3=ALONG)
    return tt.Problem(
        body=body,
        friction=tt.CoulombFriction(mu=mu),
        launch=tt.Launch(**{"tilt": np.pi / 2, "spin": 0.0} | launch),
        rolling_resistance=arm,
    )


@pytest.mark.parametrize("shape", SHAPES)
def test_what_rolls_straight_on_two_surfaces_slows_down_evenly_and_rests(shape: str) -> None:
    """(I_3 + m r^2) w' = -m g arm; a ball's N is in the ratio of the other one's distance."""
    spin = 20.0
    problem = dumbbell(shape, spin=spin, velocity=(0.0, -spin * BALL, 0.0))
    run = followed(problem, 2.0, 101)
    rests, kinetic = spin * ROLLED / (MASS * G * ARM), 0.5 * ROLLED * spin**2
    assert run.attrs["status"] == "at_rest"
    assert float(run["end_time"]) == pytest.approx(rests, rel=1e-12)
    assert events(run, "rolling stops") == pytest.approx([rests, rests], rel=1e-12)
    early = run["time"].values < rests
    np.testing.assert_allclose(
        run["spin"].values[early],
        spin * (1 - run["time"].values[early] / rests),
        atol=1e-12 * spin,
    )
    np.testing.assert_allclose(run["contact_torque"].values[early, 0], -ARM * MASS * G, rtol=1e-12)
    assert float(run["y"][-1]) == pytest.approx(-BALL * spin * rests / 2, rel=1e-12)
    assert losses(run) == pytest.approx([0.0, 0.0, kinetic], rel=1e-12, abs=1e-13 * kinetic)
    start = problem.start()
    found = forces_on_two(
        contact_points(start.axis, start.momentum, top_of(problem).body.contacts), (None, None), 1.0
    )
    couples = [wrench.torque[0] for wrench in found.wrenches]
    assert couples == pytest.approx([-ARM * MASS * G / 3, -ARM * MASS * G * 2 / 3], rel=1e-12)


def test_what_slides_across_begins_to_roll_sticks_and_rests() -> None:
    """m v' = -mu m g and I_3 w' = (mu r - arm) m g until v = r w, and then as what rolls
    straight.
    """
    run = followed(dumbbell(velocity=(0.0, -0.2, 0.0)), 2.0)
    quicker = MASS * G * (MU * BALL - ARM) / ALONG
    sticks = 0.2 / (MU * G + BALL * quicker)
    rests = sticks + quicker * sticks * ROLLED / (MASS * G * ARM)
    assert events(run, "rolling starts") == [0.0, 0.0]
    assert events(run, "stick") == pytest.approx([sticks] * 2, rel=1e-12)
    assert events(run, "rolling stops") == pytest.approx([rests] * 2, rel=1e-12)
    assert run.attrs["status"] == "at_rest"
    rolled = ARM * MASS * G * (0.5 * quicker * sticks * rests)
    assert losses(run) == pytest.approx([0.5 * MASS * 0.2**2 - rolled, 0.0, rolled], rel=1e-11)


@pytest.mark.parametrize("velocity", [(0.0, 0.2, 0.0), (0.2, 0.0, 0.0)])
def test_what_is_held_on_two_surfaces_slides_as_a_block(
    velocity: tuple[float, float, float],
) -> None:
    """Across, the couple of friction is mu r < arm; along, there is none."""
    mu = 0.5 * ARM / BALL
    run = followed(dumbbell(mu=mu, velocity=velocity), 2.0)
    assert run.attrs["status"] == "at_rest"
    assert events(run, "stick") == pytest.approx([0.2 / (mu * G)] * 2, rel=1e-12)
    assert not events(run, "rolling starts")
    assert set(words(run)) == {
        "sliding_without_rolling_on_0_and_1",
        "sticking_without_rolling_on_0_and_1",
    }
    assert losses(run) == pytest.approx([0.5 * MASS * 0.2**2, 0.0, 0.0], rel=1e-12)
    couple = ARM * MASS * G * 0.5 if velocity[1] else 0.0
    np.testing.assert_allclose(
        run["contact_torque"].values[:-2, 0], couple, atol=1e-12 * ARM * MASS * G
    )


def test_it_rolls_once_friction_needs_more_than_the_resistance_can() -> None:
    """It slides along itself at first, and turns across its way."""
    launch = {"precession": 20.0, "velocity": (0.5, 0.0, 0.0)}
    run = followed(dumbbell(**launch), 0.1, 401)
    (starts, _), time = events(run, "rolling starts"), run["time"].values
    assert 0.01 < starts < 0.05
    assert set(np.array(words(run))[time < starts]) == {"sliding_without_rolling_on_0_and_1"}
    along = run["axis"].values[:, :2] / np.hypot(*run["axis"].values[:, :2].T)[:, None]
    signed = np.sum(run["contact_torque"].values[:, :2] * along, axis=1)
    couple = np.abs(signed)
    assert np.all(couple <= ARM * run["normal_force"].values * (1 + 1e-12))
    assert np.unique(np.sign(np.diff(signed[time < starts]))).size == 1
    np.testing.assert_allclose(couple[time > starts], ARM * MASS * G, rtol=1e-12)
    assert couple[time < starts][-1] > 0.98 * ARM * MASS * G
    assert float(run["energy_error"]) < 1e-12


def test_rolling_that_slip_held_up_begins_when_that_ends(monkeypatch: pytest.MonkeyPatch) -> None:
    """However soon before its end the rest of slip is taken in one step."""
    body = lying(1083)
    turning = -5.7625
    launch = {
        "launch.spin": turning * np.cos(body.launch.tilt),
        "launch.precession": turning,
        "launch.velocity": None,
        "launch.slip": (0.009413, 0.003374),
        "rolling_resistance": 0.00402,
    }
    found = []
    for horizon in (3e-8, 1e-11):
        monkeypatch.setattr(slip_end_mode, "LAST_STEPS", (horizon, 1e-16))
        run = followed(body.replace(launch), 0.004)
        (sticks,), (*_, one, other) = events(run, "stick"), events(run, "rolling starts")
        assert one == other == sticks
        assert run["event_time"].values.tolist() == sorted(run["event_time"].values)
        found.append(sticks)
    assert found[1] == pytest.approx(found[0], abs=1e-14)


class SmoothedLaw(NamedTuple):
    """Coulomb's friction and a resistance to rolling, both smoothed: an equation of sliding on
    two.
    """

    mu: Scalar
    eps: Scalar
    arm: Scalar
    slow: Scalar

    @property
    def torque_free(self) -> bool:
        return False

    def traction(self, slip: Horizontal, angular_velocity: Vector) -> Traction:
        x, y, _ = angular_velocity
        force = -self.mu * (slip[0] ** 2 + slip[1] ** 2 + self.eps**2) ** -0.5
        couple = -self.arm * (x * x + y * y + self.slow**2) ** -0.5
        return Traction((force * slip[0], force * slip[1]), (couple * x, couple * y, 0.0 * x))

    def coefficients(self, units: Units) -> tuple[Scalar, ...]:
        return (self.mu, self.eps / units.speed, self.arm / units.length, self.slow * units.time)


def ends(
    problem: tt.Problem, duration: float, law: SmoothedLaw | None = None
) -> tuple[np.ndarray, set[str]]:
    """Axis, angular momentum and velocity at the end, in natural units, and in which modes it went
    there.
    """
    units, top = natural_units(top_of(problem)), top_of(problem)
    top = natural(top if law is None else top.altered(friction=law, rolling_resistance=None))
    automaton = Automaton(top, "fly", 0.0)
    start = automaton.launch(natural_state(problem.start(), units))
    method = make_integrator("dop853", 3e-14) if law is None else make_integrator("collocation")
    run = Trajectory(automaton, start, duration / units.time, method)
    modes = {segment.mode.label for segment in run.segments()}
    assert run.status is not None
    return np.array([*run.state.axis, *run.state.momentum, *run.state.velocity]), modes


SEEDS = {
    "sticks, and stops": (56, 0.14),
    "stops, and sticks": (31, 0.2),
    "starts again": (64, 0.06),
}
"""Launches and how long they are followed."""


@pytest.mark.parametrize(("seed", "duration"), among(list(SEEDS.values()), check=1))
def test_losses_add_up_and_no_couple_is_more_than_the_resistance_can(
    seed: int, duration: float
) -> None:
    problem = resisted(seed)
    run = followed(problem, duration, 201)
    assert events(run, "rolling stops")
    assert bool(events(run, "rolling starts")) is (seed == 64)
    assert float(run["energy_error"]) < 1e-12
    # The tilt stays as accelerations have it stay: its drift goes as the tolerance of steps.
    assert float(abs(run["gap"]).max()) < 1e-11 * R
    assert sum(losses(run)) == pytest.approx(float(run["energy_lost"]), rel=1e-12)
    axis, momentum, normal = (
        run[name].values for name in ("axis", "angular_momentum", "normal_force")
    )
    along = np.hypot(*axis[:, :2].T)
    couple = np.sum(run["contact_torque"].values[:, :2] * axis[:, :2], axis=1) / along
    limit = problem.rolling_resistance * normal
    # The torque is about the first contact point, from which the second is off by the drift of the
    # gap.
    first, second = (
        np.array([top.surface.height(c) for c in axis[:, 2].tolist()])
        for top in top_of(problem).body.contacts
    )
    lifted = np.abs(first - second) * np.hypot(*run["contact_force"].values[:, :2].T)
    assert np.all(np.abs(couple) <= limit * (1 + 1e-12) + 2 * lifted)
    held = np.array(["without_rolling" in word for word in words(run)])
    assert held.any()
    np.testing.assert_allclose(np.abs(couple[~held]), limit[~held], rtol=1e-9)
    for n, spin in zip(axis[held], momentum[held], strict=True):
        pair = contact_points(tuple(n), tuple(spin), top_of(problem).body.contacts)
        assert abs(turning_along(pair)) < 1e-11 * (G / R) ** 0.5


@pytest.mark.slow
@pytest.mark.parametrize(("seed", "duration"), SEEDS.values(), ids=SEEDS)
def test_dry_rolling_is_the_limit_of_smoothed_friction(seed: int, duration: float) -> None:
    """Where nothing sticks and no rolling stops, and two contacts that slip are all there is."""
    problem = resisted(seed)
    dry, modes = ends(problem, duration)
    assert any("without_rolling" in mode for mode in modes)
    off = []
    for part in (1e-3, 1e-4):
        speed, rate = part, part / R
        law = SmoothedLaw(problem.friction.mu, speed, problem.rolling_resistance, rate)  # type: ignore[attr-defined]
        smooth, modes = ends(problem, duration, law)
        assert modes == {"sliding_on_0_and_1"}
        off.append(float(np.abs(smooth - dry).max()))
    assert off[1] < 0.3 * off[0]
    assert off[1] < 1e-2


@pytest.mark.parametrize(("seed", "duration"), among([(31, 0.1), (64, 0.055)], check=1))
def test_time_stepping_converges_to_our_runs_at_first_order(seed: int, duration: float) -> None:
    """Which shares no equation with them: rolling stops in both, and starts again in the second."""
    problem = resisted(seed)
    run = followed(problem, duration, 3)
    assert bool(events(run, "rolling starts")) is (seed == 64)
    body, start = problem.body, problem.start()
    rotation = Rotation.from_euler("y", problem.launch.tilt).as_matrix()
    turning = angular_velocity(start.axis, start.momentum, top_of(problem))
    spheres = [(shape.surface.radius, shape.surface.center) for shape in body.shapes]
    numbers = (body.mass, body.I1, body.I3, problem.gravity), spheres, problem.friction.mu  # type: ignore[attr-defined]
    errors = []
    for step in (2e-4, 1e-4):
        other = moreau.OnSpheres(
            *numbers, problem.rolling_resistance, rotation, turning, np.array(start.velocity)
        )
        for _ in range(round(duration / step)):
            other.step(step)
        momentum = other.rotation.apply(other.inertia @ other.turning)
        errors.append(momentum - run["angular_momentum"].values[-1])
    sizes = [np.linalg.norm(error) / np.linalg.norm(start.momentum) for error in errors]
    assert sizes[0] < 3e-3
    assert sizes[0] / sizes[1] == pytest.approx(2.0, rel=0.1)


@pytest.mark.parametrize("tolerance", [None, pytest.param(1e-14, marks=pytest.mark.slow), 1e-12])
def test_straight_slip_on_two_ends_when_friction_has_taken_it(tolerance: float | None) -> None:
    """At v / (mu g): a step may lead beyond, as nothing of straight motion tells it to be short."""
    for speed in np.linspace(0.05, 0.4, 6):
        problem = dumbbell(velocity=(0.0, float(speed), 0.0)).replace({"rolling_resistance": 2e-3})
        run = tt.simulate(problem, 1.0, samples=2, tolerance=tolerance)
        assert run.attrs["status"] == "at_rest"
        friction = float(getattr(problem.friction, "mu", 0.0))
        assert float(run["end_time"]) == pytest.approx(
            speed / (friction * problem.gravity), rel=1e-12
        )


@pytest.mark.parametrize(
    ("precession", "along", "across"),
    among([(0.2293, 0.01033, -0.003323), (-0.1138, 0.002861, -0.002138)], check=1),
)
def test_rolling_may_begin_while_slip_on_two_contacts_ends(
    precession: float, along: float, across: float
) -> None:
    """Two balls on a stick, lying: what friction takes is what is lost, and in the end nothing
    moves.
    """
    shape = [tt.Sphere(radius=0.005, center=0.02), tt.Sphere(radius=0.005, center=-0.01)]
    launch = tt.Launch(
        tilt=np.pi / 2, spin=0.0, precession=precession, velocity=(along, across, 0.0)
    )
    problem = tt.Problem(
        body=tt.Body(mass=0.01, shape=shape, I1=2e-6, I3=1.25e-7),
        friction=tt.CoulombFriction(mu=0.2215),
        rolling_resistance=5.3272e-4,
        launch=launch,
    )
    run = followed(problem, 0.5, samples=2)
    assert run.attrs["status"] == "at_rest"
    begins, ends = events(run, "rolling starts"), events(run, "stick")
    assert begins[0] < ends[-1]
    taken = sum(losses(run)) + float(run["energy_lost_impacts"])
    lost = float(run["energy"][0] - run["energy"][-1])
    assert taken == pytest.approx(lost, abs=1e-12 * float(run["energy"][0]))
