"""Friction that turns comes to press the contact onto the table: Painleve's paradox in the midst of
slip.

A heavy core in a light sphere: the contact point answers to a normal force with the acceleration A,
which friction in some directions of slip makes less than zero. Slip that is slowed down turns
towards them.
"""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import tippetop as tt
from campaigns import among
from tippetop.contact.automaton import Automaton
from tippetop.contact.contact_mode import ContactMode
from tippetop.contact.guards import LIFT_OFF
from tippetop.contact.mode import EventKind, ModeEnd
from tippetop.mechanics.contacts.slip_variables import slip_of
from tippetop.mechanics.impacts.jamming import past_jamming, stuck_at_once
from tippetop.mechanics.invariants import energy
from tippetop.mechanics.laws.coulomb import CoulombLaw
from tippetop.mechanics.motion import (
    along_table,
    contact_swing,
    falls_by_zero,
    on_table,
    sliding_contact,
)
from tippetop.mechanics.state import SlidingState
from tippetop.mechanics.surfaces.surface import SphereSurface
from tippetop.mechanics.top import Top
from tippetop.problem.problem import top_of

M, R, OFF, INERTIA, MU, G = 0.02, 0.02, 0.001, 4e-8, 0.3, 9.81
"""Mass, radius, distance of the centres, moments of inertia, friction and gravity, SI."""


SLOW, BRISK, FAST = 0.05, 0.5, 1.0
"""Slip that is followed in a clock of its own as it jams, and slip that is not, m/s."""


def jamming(liftoff: str = "fly", slip: float = SLOW) -> tt.Problem:
    """The sphere, which slips across the direction in which it leans."""
    return tt.Problem(
        body=tt.Body(
            mass=M, shape=tt.EccentricSphere(radius=R, eccentricity=OFF / R), I1=INERTIA, I3=INERTIA
        ),
        friction=tt.CoulombFriction(mu=MU),
        launch=tt.Launch(tilt=1.2, spin=0.0, slip=(0.0, slip)),
        contact=tt.Contact(liftoff=liftoff, restitution=0.0),
        gravity=G,
    )


def on_springs(slip: float, stiffness: float, jams: float, eps: float = 1e-6) -> np.ndarray:
    """Angular velocity at the end of compression on an elastic table, without any notion of an
    impact.
    """
    start = jamming(slip=slip).start()

    def sliding_contact(y: np.ndarray) -> tuple[np.ndarray, np.ndarray, float]:
        arm = OFF * y[:3] - np.array([0.0, 0.0, R])
        return arm, y[6:9] + np.cross(y[3:6] / INERTIA, arm), -(y[9] + arm[2])

    def rates(_: float, y: np.ndarray) -> np.ndarray:
        arm, slip, depth = sliding_contact(y)
        normal = stiffness * max(depth, 0.0)
        force = np.array([*(-MU * normal * slip[:2] / np.hypot(eps, np.hypot(*slip[:2]))), normal])
        turned = np.cross(y[3:6] / INERTIA, y[:3])
        return np.array([*turned, *np.cross(arm, force), *(force / M - [0.0, 0.0, G]), y[8]])

    def rebounding(_: float, y: np.ndarray) -> float:
        return float(sliding_contact(y)[1][2])

    rebounding.direction = 1.0  # type: ignore[attr-defined]
    pressed = float(tt.simulate(jamming(slip=slip), 1e-6, samples=2)["normal_force"][0]) / stiffness
    begin = np.array([*start.axis, *start.momentum, *start.velocity, start.height - pressed])
    found = solve_ivp(
        rates, (0.0, 1.5 * jams), begin, method="LSODA", rtol=1e-8, atol=1e-14, events=rebounding
    )
    ends = [y for t, y in zip(found.t_events[0], found.y_events[0], strict=True) if t > jams]
    return np.asarray(ends[0][3:6]) / INERTIA


@pytest.mark.parametrize("slip", among([SLOW, FAST], check=1))
def test_a_contact_that_jams_is_struck_as_the_limit_of_elastic_ones_is(slip: float) -> None:
    run = tt.simulate(jamming(slip=slip), 2e-3 * slip / SLOW, samples=2)
    assert run["event_kind"].values.tolist() == ["impact", "stick"]
    assert float(run["event_energy_lost"][0]) > 0.0
    assert float(run["energy_error"]) < 1e-11
    jams = float(run["event_time"][0])
    # It has slipped until then, and while it sticks weight alone turns it.
    after = tt.simulate(jamming(slip=slip), 1.1 * jams, times=[0.0, jams * (1.0 + 1e-9)])
    turning = angular_velocity(after)
    off = [np.abs(on_springs(slip, stiffness, jams) - turning) for stiffness in (1e9, 1e10)]
    size = np.linalg.norm(turning)
    assert np.linalg.norm(off[1]) < 1e-4 * size
    # What gravity does meanwhile falls as the time of compression, and the rest faster.
    assert np.linalg.norm(off[1]) < 0.6 * np.linalg.norm(off[0])


def angular_velocity(run) -> np.ndarray:
    """Angular velocity of the last sample, of a body whose moments of inertia are all the same."""
    return np.asarray(run["angular_momentum"].values[-1]) / INERTIA


@pytest.mark.parametrize("slip", [SLOW, FAST])
@pytest.mark.parametrize("liftoff", ["stop", "ignore"])
def test_a_contact_that_jams_ends_a_run_without_impacts(liftoff: str, slip: float) -> None:
    run = tt.simulate(jamming(liftoff, slip), 1e-3 * slip / SLOW, samples=11)
    assert run.attrs["status"] == "failed"
    assert "no contact force is consistent" in run.attrs["message"]
    assert float(run["energy_error"]) < 1e-11
    assert float(np.hypot(run["slip_x"], run["slip_y"])[-1]) > 1e-4


@pytest.mark.parametrize("integrator", ["taylor", "dop853"])
@pytest.mark.parametrize("slip", [SLOW, BRISK, FAST])
def test_the_power_of_a_force_without_bound_adds_up(slip: float, integrator: str) -> None:
    """It grows as 1 / sqrt(time left), which no polynomial over all that time does."""
    run = tt.simulate(jamming(slip=slip), 2e-3 * slip / SLOW, samples=11, integrator=integrator)
    assert float(run["event_energy_lost"][0]) > 0.0
    assert float(run["energy_error"]) < 1e-11


@pytest.mark.parametrize("left", [1e-13, 1e-9, 1e-5, -1e-9, -1e-5])
def test_past_jamming_no_rounding_decides_whether_friction_presses_the_contact(left: float) -> None:
    """However near to zero the Delassus number is where it is told that friction jams."""
    problem = jamming()
    top, start = top_of(problem), along_table(problem.start())
    swing = contact_swing(start.axis, start.momentum, top)

    def slipping(angle: float) -> SlidingState:
        return start._replace(
            velocity=(FAST * np.cos(angle) - swing[0], FAST * np.sin(angle) - swing[1]),
        )

    def number(angle: float) -> float:
        return float(sliding_contact(*slipping(angle), top).delassus * top.mass) - left

    # What slips the way it leans is pressed onto the table, and what slips back is drawn off it.
    jams = brentq(number, 0.0, np.pi, xtol=1e-15)
    before = slipping(jams)
    found = past_jamming(on_table(before, top), top)
    assert found is not None
    state, impulse, lost = found
    assert (impulse > 0.0) == (left > -1e-7)
    assert (lost > 0.0) == (left > -1e-7)
    after = float(sliding_contact(*along_table(state), top).delassus * top.mass)
    # As much below as it was above, but for what rounding could turn round.
    assert -1.1 * max(abs(left), 1e-6) < after < -0.9 * max(abs(left), 1e-8)


@pytest.mark.parametrize(
    ("mu", "launch"),
    [
        (
            2.635022678354613,
            tt.Launch(
                tilt=0.1260644689490918,
                spin=-25.814386659165045,
                precession=-14.559744171017421,
                tilt_rate=-3.8728300827713005,
                slip=(-0.00248107772950266, 0.1679454954010388),
            ),
        ),
        (
            2.5763813306579597,
            tt.Launch(
                tilt=0.6152806721131737,
                spin=-20.524167556093076,
                precession=3.161732715794763,
                tilt_rate=-2.8494222036190644,
                slip=(-0.6502876830993077, -0.10602306995446242),
            ),
        ),
    ],
)
def test_a_ball_jams_beside_another_that_has_just_opened(mu: float, launch: tt.Launch) -> None:
    """Where that was so near that rounding was all that told which way the contact accelerates."""
    run = tt.simulate(
        tt.Problem(
            body=tt.presets.BODIES["hurricane-balls"],
            friction=tt.CoulombFriction(mu=mu),
            launch=launch,
            contact=tt.Contact(liftoff="fly"),
        ),
        1.0,
    )
    assert run.attrs["status"] == "completed"


@pytest.mark.slow
def test_motion_that_leads_to_where_no_force_is_told_ends_there() -> None:
    """The Delassus number and the acceleration it is to balance vanish together, and the force is
    finite.
    """
    problem = tt.Problem(
        body=tt.presets.BODIES["coin"],
        friction=tt.ContensouFriction(mu=2.1580557528878686, patch_radius=0.00034573999501228336),
        rolling_resistance=0.00032948797199892167,
        launch=tt.Launch(
            tilt=0.9547888712102552,
            spin=72.6751369431422,
            precession=17.420219048483283,
            tilt_rate=-4.491285326734969,
            slip=(0.03615965922258063, -0.04230135698976169),
        ),
        contact=tt.Contact(liftoff="fly"),
    )
    run = tt.simulate(problem, 0.2, samples=101)
    assert run.attrs["status"] == "inaccurate"  # the force at the end itself is 0 / 0
    assert "rigid bodies do not tell" in run.attrs["message"]
    last = {name: run[name].values[-1] for name in ("axis", "angular_momentum", "velocity")}
    touch = sliding_contact(
        last["axis"], last["angular_momentum"], last["velocity"][:2], top_of(problem)
    )
    weight = problem.body.mass * problem.gravity
    # Slip is followed until a part of 1e-8 of it is left; the force at the end itself is 0 / 0.
    assert abs(touch.delassus) * problem.body.mass < 1e-8
    assert abs(touch.free_acceleration) < 1e-8 * problem.gravity
    assert 0.01 * weight < float(run["normal_force"].values[-2]) < 100.0 * weight


def heavy_core(
    radius: float, off: float, inertia: tuple[float, float], mu: float, launch: tt.Launch
) -> tt.Problem:
    """A sphere of little inertia that rubs hard."""
    return tt.Problem(
        body=tt.Body(
            mass=M,
            shape=tt.EccentricSphere(radius=radius, eccentricity=off),
            I1=inertia[0],
            I3=inertia[1],
        ),
        friction=tt.CoulombFriction(mu=mu),
        launch=launch,
        contact=tt.Contact(liftoff="fly", restitution=0.0),
    )


def test_power_adds_up_to_where_the_time_that_is_left_is_rounding() -> None:
    launch = tt.Launch(tilt=0.344, spin=19.1, tilt_rate=1.74, slip=(0.362, 0.394))
    run = tt.simulate(heavy_core(0.0257, 0.487, (1.27e-6, 7.96e-7), 1.75, launch), 0.05, samples=5)
    assert "impact" in run["event_kind"].values
    assert float(run["energy_error"]) < 1e-10


HARDLY_SLIPPING = (
    heavy_core(
        0.012825668208193558,
        0.17387865364221777,
        (3.656265133049883e-08, 3.619950265465189e-08),
        1.9308496240415416,
        tt.Launch(
            tilt=2.2439256554626468,
            spin=-33.1929138450625,
            tilt_rate=0.9270315701869958,
            slip=(-0.4940630559968975, 0.34667097584517437),
        ),
    ),
    heavy_core(
        0.024522520999270797,
        0.13309776428816816,
        (7.94480974634293e-08, 9.104498160745062e-08),
        1.9654419219846964,
        tt.Launch(
            tilt=1.134105914090758,
            spin=10.680028516526859,
            tilt_rate=-2.3897441807935573,
            slip=(-0.46940436818002873, 0.09348584975117358),
        ),
    ).replace({"rolling_resistance": 0.00018500667863262965}),
)
"""Launches whose slip is less than 1e-8 m/s where it jams, and where rounding then lets nothing
strike: of launches a few units in the last place beside them, some strike.
"""


@pytest.mark.parametrize("problem", HARDLY_SLIPPING)
def test_slip_that_has_all_but_ended_where_it_jams_sticks(problem: tt.Problem) -> None:
    """By rounding nothing strikes then, and slip that goes on would jam again, and again."""
    kinds = []
    for units in range(-3, 4):
        tilt = problem.launch.tilt * (1.0 + units * np.finfo(float).eps)
        beside = problem.replace({"launch.tilt": tilt})
        run = tt.simulate(beside, 0.05, samples=5, mode_limit=300)
        kinds.append(run["event_kind"].values.tolist())
        assert float(run["energy_error"]) < 1e-13
        assert float(np.hypot(run["slip_x"], run["slip_y"])[-1]) < 1e-14
    # Rounding decides of which of them something strikes.
    assert ["stick"] in kinds
    assert all(each in (["stick"], ["impact", "stick"]) for each in kinds)


@pytest.mark.parametrize("law", [{}, {"friction.kind": "contensou", "friction.patch_radius": 1e-3}])
def test_what_sticks_at_once_takes_the_energy_of_its_slip_and_does_not_open(
    law: dict[str, object],
) -> None:
    lost = []
    for part in (1e-3, 1e-2):
        problem = jamming(slip=part * SLOW).replace({**law, "launch.spin": 40.0 * part})
        before = problem.start()
        after = stuck_at_once(before, top_of(problem))
        assert np.abs(slip_of(*along_table(after), top_of(problem))).max() < 1e-16
        assert after.velocity[2] == pytest.approx(
            on_table(along_table(after), top_of(problem)).velocity[2], abs=1e-17
        )
        lost.append(energy(before, top_of(problem)) - energy(after, top_of(problem)))
    assert lost[0] > 0.0
    assert lost[1] == pytest.approx(100.0 * lost[0], rel=1e-6)


@pytest.mark.parametrize("near", [1e-9, -1e-9])
def test_a_force_falls_by_zero_or_by_infinity_however_weak_what_presses(near: float) -> None:
    """Near A = 0 friction has no bound, though but 1e-4 of what the acceleration b is made of
    presses.
    """
    random, count = np.random.default_rng(2), 0
    while count < 20:
        surface, way = SphereSurface(1.0, random.uniform(-0.9, 0.9)), random.normal(size=3)
        axis, momentum = tuple(way / np.linalg.norm(way)), tuple(random.normal(size=3))
        velocity = tuple(random.normal(size=2))
        free = Top.of(1.0, 0.05, 0.04, surface, CoulombLaw(0.0), 0.0)
        lifting = sliding_contact(axis, momentum, velocity, free).free_acceleration
        ready, rough = (
            sliding_contact(axis, momentum, velocity, free.altered(friction=CoulombLaw(mu)))
            for mu in (0.0, 1.0)
        )
        jams_at = ready.delassus / (ready.delassus - rough.delassus)
        if lifting <= 0.0 or not 0.0 < jams_at < 10.0:
            continue
        count += 1
        jammed, opened = (
            free.altered(friction=CoulombLaw(mu), gravity=gravity)
            for mu, gravity in (
                (jams_at * (1.0 + near), lifting * (1.0 + 1e-4)),
                (0.5 * jams_at, lifting * (1.0 + near)),
            )
        )
        for top, by_zero in ((jammed, False), (opened, True)):
            normal = sliding_contact(axis, momentum, velocity, top).normal_force
            assert falls_by_zero(normal, axis, momentum, top) == by_zero
            state = on_table(SlidingState(axis, momentum, velocity), top)
            end = ModeEnd(LIFT_OFF, state)
            after = Automaton(top, "fly", 0.0).lift_off(top, 0.0, ContactMode(top), end)
            kinds = [event.kind for event in after.events[:1]]
            assert (kinds == [EventKind.LIFT_OFF]) == by_zero
