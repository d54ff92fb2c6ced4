"""Tops with a stem: impacts while the sphere touches, rocking, double contact, and what ends it."""

from functools import cache

import numpy as np
import pytest
import xarray as xr

import tippetop as tt
from tippetop.contact import automaton, touching
from tippetop.contact.automaton import Automaton
from tippetop.contact.contact_mode import sliding_on_two
from tippetop.contact.mode import EventKind, Mode
from tippetop.contact.slip_end_mode import SlipEnd
from tippetop.contact.transient import Resting
from tippetop.integrators import make_integrator
from tippetop.mechanics.contacts.contact_point import contact_points
from tippetop.mechanics.contacts.forces import normal_wrench
from tippetop.mechanics.contacts.slip_variables import slip_of
from tippetop.mechanics.contacts.system import rates_added
from tippetop.mechanics.motion import on_table
from tippetop.mechanics.state import SlidingState, State
from tippetop.mechanics.surfaces.surface import contact_vector
from tippetop.mechanics.top import natural, natural_units
from tippetop.problem.problem import top_of

LEINE_GLOCKER = tt.Problem(
    body=tt.Body(
        mass=6e-3,
        shape=[tt.Sphere(radius=1.5e-2, center=3e-3), tt.Sphere(radius=5e-3, center=1.6e-2)],
        I1=8e-7,
        I3=7e-7,
    ),
    friction=tt.ContensouFriction(mu=0.3, patch_radius=5e-4, pressure="ellipsoidal"),
    launch=tt.Launch(tilt=0.1, spin=180.0, velocity=(0.0, 0.0, 0.0)),
    gravity=9.81,
)
STEMMED = [tt.Sphere(radius=0.02, center=0.006), tt.Sphere(radius=0.004, center=0.026)]
REPORT = tt.presets.report_problem().replace(
    {"body.shape": [shape.model_dump() for shape in STEMMED]}
)


@cache
def leine_glocker() -> xr.Dataset:
    return tt.simulate(LEINE_GLOCKER, 8.0, samples=801)


@cache
def report() -> xr.Dataset:
    return tt.simulate(REPORT, 20.0, samples=801)


def times(run: xr.Dataset, kind: str) -> np.ndarray:
    found: np.ndarray = run["event_time"].values[run["event_kind"].values == kind]
    return found


def surfaces(run: xr.Dataset, kind: str) -> list[int]:
    found: list[int] = run["event_surface"].values[run["event_kind"].values == kind].tolist()
    return found


def test_leine_and_glocker_s_top_to_eight_seconds() -> None:
    """Against an independent solver of the same equations: Routh's impacts, ellipsoidal limit
    surface.
    """
    run = leine_glocker()
    touches = times(run, "touchdown")
    assert touches[0] == pytest.approx(1.37104325139, abs=1e-8)
    assert touches[1:4] == pytest.approx([4.55045294, 4.56156895, 4.63331496], abs=1e-8)
    assert surfaces(run, "touchdown")[:4] == [1, 0, 1, 0]
    assert times(run, "double contact") == pytest.approx([4.67713921], abs=1e-6)
    assert times(run, "opening")[-1] == pytest.approx(5.4664569, abs=1e-6)
    assert float(run["final_tilt"]) == pytest.approx(1.70243211, abs=1e-6)
    assert not len(times(run, "liftoff")), "one surface or the other always touches"


def test_the_report_s_top_with_a_stem() -> None:
    """Against the same solver: viscous friction; it touches twice, rocks, and falls back."""
    run = report()
    assert times(run, "touchdown")[:2] == pytest.approx([6.34894636, 6.36564926], abs=1e-8)
    assert times(run, "double contact") == pytest.approx([6.66419077], abs=1e-6)
    assert times(run, "opening")[-1] == pytest.approx(8.33507784, abs=1e-6)
    assert float(run["final_tilt"]) == pytest.approx(2.481515194, abs=1e-6)
    assert float(run["final_spin"]) == pytest.approx(-35.27884, abs=1e-5)


@pytest.mark.parametrize("run", [leine_glocker, report], ids=["leine-glocker", "report"])
def test_energy_balances_and_nothing_sinks_in(run) -> None:
    found = run()
    assert found.attrs["status"] == "completed"
    assert float(found["energy_error"]) < 1e-12
    size = 0.02
    assert float(found["gap"].min()) > -1e-12 * size
    assert float(found["gap"].max()) < 1e-12 * size
    assert float(found["normal_force"].min()) > 0.0
    lost = found["event_energy_lost"].values
    assert (lost >= 0.0).all()
    assert float(found["energy_lost_impacts"]) == pytest.approx(lost.sum())


@pytest.mark.parametrize("run", [leine_glocker, report], ids=["leine-glocker", "report"])
def test_modes_name_the_surfaces_that_touch(run) -> None:
    found = run()
    words = found["mode"].values
    on_two = words == "sliding_on_0_and_1"
    time = found["time"].values
    begin, end = times(found, "double contact")[0], times(found, "opening")[-1]
    assert (on_two == ((time > begin) & (time < end))).all()
    # There both spheres touch: r_0 - zeta_0 c = r_1 - zeta_1 c.
    shapes = tt.Problem.from_json(found.attrs["problem"]).body.shapes
    (r0, z0), (r1, z1) = ((shape.surface.radius, shape.surface.center) for shape in shapes)
    both = np.arccos((r1 - r0) / (z1 - z0))
    assert found["tilt"].values[on_two] == pytest.approx(both, abs=1e-12)
    standing = found["tilt"].values > both
    assert (words[standing & ~on_two] == "sliding_on_1").all()
    assert (words[~standing & ~on_two] == "sliding_on_0").all()


def test_the_end_of_rocking_converges_at_first_order(monkeypatch: pytest.MonkeyPatch) -> None:
    bounds = np.array([1e-4, 1e-5, 1e-6])
    ends, tilts = [], []
    for bound in (*bounds, touching.SLOWEST_ROCKING):
        for module in (touching, automaton):
            monkeypatch.setattr(module, "SLOWEST_ROCKING", bound)
        run = tt.simulate(LEINE_GLOCKER, 5.0, samples=11)
        ends.append(times(run, "double contact")[0])
        tilts.append(float(run["final_spin"]))
    errors = np.abs(np.array(ends[:-1]) - ends[-1])
    orders = np.diff(np.log(errors)) / np.diff(np.log(bounds))
    assert orders == pytest.approx(1.0, abs=0.25)
    assert np.abs(np.array(tilts[:-1]) - tilts[-1]).max() < 1e-3 * np.abs(tilts[-1])


def test_rocking_shrinks_by_what_the_inverse_masses_say() -> None:
    """Of two plastic impacts, p_i = v_i / A_ii and v_j = A_ji p_i: a cycle is A_12 A_21 / (A_11
    A_22).
    """
    run = leine_glocker()
    rebounds = np.diff(times(run, "touchdown"))[4:]
    cycles = rebounds[:-1:2][:26] + rebounds[1::2][:26]
    here = run.sel(time=times(run, "double contact")[0] + 1e-3, method="nearest")
    vectors = (
        tuple(here[name].values.tolist()) for name in ("axis", "angular_momentum", "velocity")
    )
    axis, momentum, velocity = vectors
    state = SlidingState(axis, momentum, velocity[:2])
    tops = top_of(LEINE_GLOCKER).body.contacts
    pair = contact_points(axis, momentum, tops)
    slips = [slip_of(*state, top) for top in tops]
    units = [normal_wrench(point, slip) for point, slip in zip(pair, slips, strict=True)]
    added = [rates_added(pair, number, unit).points for number, unit in enumerate(units)]
    (a, c), (b, d) = ([point[2] for point in points] for points in added)
    expected = b * c / (a * d)
    assert 0.7 < expected < 0.8
    assert (cycles[1:] / cycles[:-1])[18:24] == pytest.approx(expected, abs=2e-3)


@pytest.mark.parametrize(
    "sideways", [-0.5, 0.0, -1.0, 1.0], ids=["both drill", "first", "second", "neither"]
)
def test_two_patches_which_each_drill_or_slide_move_a_body_as_newton_and_euler_say(
    sideways: float,
) -> None:
    """Two normal forces, with Hertz's law at each patch, give all rates, and keep both contacts
    closed.

    The patches slip across their line, at velocities of which the second exceeds the first by what
    they turn.
    """
    problem = LEINE_GLOCKER.replace({"friction.pressure": "hertz", "friction.patch_radius": 5e-3})
    top, unit = natural(top_of(problem)), natural_units(top_of(problem)).length
    tops, (low, high), law = tuple(top.body.contacts), problem.body.shapes, problem.friction.law
    c = (high.radius - low.radius) / (high.center - low.center)
    axis, turning = np.array([np.sqrt(1.0 - c * c), 0.0, c]), np.array([-0.5, 0.0, 2.0])
    inertia, apart = (
        (top.transverse_inertia, top.axial_inertia),
        (high.center - low.center) / unit * axis[0],
    )
    momentum = inertia[0] * turning + (inertia[1] - inertia[0]) * (turning @ axis) * axis
    arms = [np.array(contact_vector(tuple(axis), one.surface)) for one in tops]
    slips = [np.array([0.0, (sideways + k) * apart * turning[2], 0.0]) for k in (0, 1)]
    velocity = slips[0] - np.cross(turning, arms[0])
    sliding = SlidingState(*(tuple(v.tolist()) for v in (axis, momentum, velocity[:2])))

    mode = sliding_on_two(on_table(sliding, tops[0]), tops, 0.0)
    rates = np.array(mode.motion.rates(sliding.pack(), mode.parameters))

    tractions = [
        law._replace(patch_radius=law.patch_radius / unit).traction(tuple(slip[:2]), tuple(turning))
        for slip in slips
    ]
    forces = [np.array([*traction.force, 1.0]) for traction in tractions]
    wrenches = [
        [*force, *(np.cross(arm, force) + traction.torque)]
        for arm, force, traction in zip(arms, forces, tractions, strict=True)
    ]
    told = np.array([*rates[6:], 1.0, *rates[3:6]])
    normal, *_ = np.linalg.lstsq(np.array(wrenches).T, told, rcond=None)
    assert (normal > 0.0).all()
    assert np.array(wrenches).T @ normal == pytest.approx(told, abs=1e-14)

    def tilting(y: np.ndarray) -> float:
        return np.cross(y[3:6], y[:3])[2] / inertia[0]

    y, step = np.array(sliding.pack()), 1e-4
    assert tilting(y) == pytest.approx(0.0, abs=1e-15)
    assert tilting(y + step * rates) - tilting(y - step * rates) == pytest.approx(0.0, abs=1e-15)


def test_a_body_of_one_surface_in_a_list_is_that_surface() -> None:
    one = tt.Sphere(radius=0.01, center=0.002)
    alone, listed = (tt.Body(mass=0.01, shape=shape, I1=4e-7, I3=4e-7) for shape in (one, [one]))
    assert alone == listed


def test_several_surfaces_go_into_text_and_come_back() -> None:
    assert tt.Problem.from_toml(LEINE_GLOCKER.to_toml()) == LEINE_GLOCKER
    assert tt.Problem.from_json(LEINE_GLOCKER.to_json()) == LEINE_GLOCKER
    longer = LEINE_GLOCKER.replace({"body.shape.1.center": 0.017})
    assert longer.body.shapes[1] == tt.Sphere(radius=5e-3, center=0.017)
    assert LEINE_GLOCKER.quantity("body.shape.1.center").units == "m"


@pytest.mark.parametrize(
    ("changes", "field", "words"),
    [
        ({"body.shape.1.center": 0.01}, "body.shape.1", "is enclosed by the others"),
        ({"body.shape.1.radius": -1.0}, "body.shape.1.radius", "a number at least 0"),
        ({"body.shape": []}, "body.shape", "a table of its fields"),
        ({"contact.liftoff": "ignore"}, "contact.liftoff", "is for bodies of one surface"),
    ],
)
def test_what_cannot_be_is_refused_in_a_sentence(changes, field, words) -> None:
    with pytest.raises(tt.InvalidInput) as caught:
        LEINE_GLOCKER.replace(changes)
    assert caught.value.field == field
    assert words in str(caught.value)


def test_jellett_s_integral_is_that_of_the_surface_that_touches_in_whatever_order_they_are() -> (
    None
):
    """The sphere of the report's top does not let its stem touch before 0.9 s."""
    shapes = list(REPORT.body.shape)
    for order in (shapes, shapes[::-1]):
        problem = REPORT.replace({"body.shape": order})
        run = tt.simulate(problem, 0.3, samples=31)
        assert set(run["event_kind"].values) == set()
        assert float(run["jellett_drift"]) < 1e-13
        assert float(run["jellett_change"]) < 1e-13


ROD = tt.Problem(
    body=tt.Body(
        mass=0.01,
        shape=[tt.Sphere(radius=0.005, center=0.02), tt.Sphere(radius=0.005, center=-0.02)],
        I1=2e-6,
        I3=1.25e-7,
    ),
    friction=tt.ViscousFriction(mu=1.0),
    launch=tt.Launch(tilt=1.3, spin=5.0, gap=0.01),
)


@pytest.mark.parametrize("restitution", [0.0, 0.5])
def test_a_rod_falls_on_its_ends_in_turn_and_comes_to_lie(restitution: float) -> None:
    """Either end presses the other onto the table: both stay, and carry half of the weight each."""
    run = tt.simulate(ROD.replace({"contact.restitution": restitution}), 1.0, samples=101)
    assert run.attrs["status"] == "completed"
    assert float(run["energy_error"]) < 1e-12
    assert float(run["gap"].min()) > -1e-14
    assert run["event_kind"].values[-1] == "double contact"
    assert float(run["final_tilt"]) == pytest.approx(np.pi / 2, abs=1e-10)
    assert float(run["normal_force"][-1]) == pytest.approx(0.01 * 9.8, rel=1e-12)
    touches = surfaces(run, "touchdown")
    assert set(touches) == {0, 1}
    assert restitution or touches == [1, 0], "at rest at once, and no rocking"


def test_two_balls_that_friction_holds_rock_to_rest() -> None:
    """Their angular momentum about what strikes is I1 omega before, and (I1 + 2 m r^2) omega after.

    That is 7/5 and 17/5 m r^2 omega. Friction this strong would tip them over if they slid.
    """
    launch, contact = tt.Launch(tilt=1.4, spin=0.0), tt.Contact(liftoff="fly")
    balls, friction = tt.presets.HURRICANE_BALLS, tt.CoulombFriction(mu=2.0)
    problem = tt.Problem(body=balls, friction=friction, launch=launch, contact=contact)
    run = tt.simulate(problem, 0.5, times=[0.0, 0.5], integrator="dop853", step_limit=2000)
    impulses = run["event_impulse"].values[run["event_kind"].values == "impact"]
    assert impulses[1:10] / impulses[:9] == pytest.approx(np.full(9, 7 / 17), rel=1e-6)
    assert run.attrs["status"] == "at_rest"
    assert times(run, "stick")[-2:] == pytest.approx(
        np.full(2, times(run, "double contact")[0]), rel=1e-9
    )


def lying(law: str, centers: tuple[float, float], velocity: float) -> tuple[Automaton, State]:
    """A body on two like spheres, whose axis lies along x and which moves along it, in natural
    units.
    """
    shapes = [tt.Sphere(radius=0.005, center=center) for center in centers]
    body = tt.Body(mass=0.01, shape=shapes, I1=2e-6, I3=1.25e-7)
    launch = tt.Launch(tilt=1.3, spin=5.0, gap=0.01)
    problem = tt.Problem(body=body, friction={"kind": law, "mu": 0.3}, launch=launch)
    top = natural(top_of(problem))
    top = top.body.contacts[1]
    state = on_table(SlidingState((1.0, 0.0, 0.0), (0.0, 0.0, 0.0), (velocity, 0.0)), top)
    return Automaton(top, "fly", 0.0), state


@pytest.mark.parametrize("velocity", [0.0, 1e-12, 1e-10])
def test_what_hardly_slips_on_two_surfaces_rests(velocity: float) -> None:
    automaton, state = lying("coulomb", (-0.02, 0.02), velocity)
    following, end = automaton.resting(automaton.top, 0.0, state), 0.0
    if velocity:
        mode, method = following.next, make_integrator("dop853", 3e-14)
        assert isinstance(mode, SlipEnd)
        (segment,) = mode.segments(0.0, following.state, 1.0, method)
        assert segment.mode_end is not None
        end = segment.solution.end
        following = automaton.follow(mode, segment.mode_end, end)
    assert isinstance(following.next, Resting)
    assert end == pytest.approx(velocity / 0.3, rel=1e-12)


def test_what_slips_on_two_surfaces_goes_on() -> None:
    automaton, state = lying("coulomb", (-0.02, 0.02), 1e-8)
    assert len(automaton.resting(automaton.top, 0.0, state).next.tops) == 2


def test_the_farther_of_two_surfaces_beside_the_centre_of_mass_opens_and_is_named() -> None:
    """The body is about to tip over the nearer one."""
    automaton, state = lying("viscous", (0.01, 0.02), 0.0)
    found = automaton.resting(automaton.top, 0.0, state)
    assert [(event.kind, event.surface) for event in found.events] == [(EventKind.OPENING, 1)]
    assert isinstance(found.next, Mode)
    assert found.next.label == "sliding_on_0"


@pytest.mark.parametrize(
    ("mu", "launch"),
    [
        (
            1.5081334867200606,
            {
                "tilt": 0.0549151128704677,
                "spin": 45.91477793050741,
                "precession": -20.361931902467283,
                "tilt_rate": -3.5751979423749294,
                "slip": (-0.11997142274630551, -0.17284242294733398),
            },
        ),
        (
            1.9870328414506437,
            {
                "tilt": 1.3479679314123594,
                "spin": 58.730575477736636,
                "precession": -39.54220565012708,
                "tilt_rate": 0.21720104498975434,
                "slip": (0.30669173245653214, -0.024886961248926254),
            },
        ),
    ],
    ids=["first", "second"],
)
def test_a_surface_that_has_just_opened_is_drawn_back_where_the_other_sticks(mu, launch) -> None:
    """By rounding it touches still; what slip let rise, sticking draws to the table, and not
    through it.
    """
    problem = tt.Problem(
        body=tt.presets.HURRICANE_BALLS,
        friction=tt.CoulombFriction(mu=mu),
        launch=tt.Launch(**launch),
        contact=tt.Contact(liftoff="fly", restitution=0.5),
    )
    run = tt.simulate(problem, 2.0, samples=401)
    assert run.attrs["status"] == "completed"
    assert (run["event_kind"] == "double contact").any()
    heights = [
        ball.radius - ball.center * run["axis"].values[:, 2]
        for ball in tt.presets.HURRICANE_BALLS.shapes
    ]
    assert np.all(run["height"] >= np.max(heights, axis=0) - 1e-13)
