"""Two dry contacts of one body: how slip ends on one or on both, what holds them then, and how it
begins.
"""

import math
from functools import cache

import numpy as np
import pytest
import xarray as xr

import tippetop as tt
from lying import lying, resisted
from tippetop.contact import slip_end_mode
from tippetop.contact.contact_mode import ContactMode, mode_on_two
from tippetop.contact.natural_launch import automaton_of
from tippetop.contact.slip_onset import SlipOnset
from tippetop.contact.trajectory import Trajectory
from tippetop.integrators import make_integrator
from tippetop.mechanics.contacts.contact_forces import forces_on_two
from tippetop.mechanics.contacts.contact_point import contact_points
from tippetop.mechanics.contacts.pair import slip_apart
from tippetop.mechanics.contacts.wrench import Wrench
from tippetop.mechanics.flight.free_motion import gap_rate
from tippetop.mechanics.laws.friction import NO_TORQUE
from tippetop.mechanics.motion import angular_velocity
from tippetop.mechanics.surfaces.surface import contact_vector
from tippetop.mechanics.top import natural, natural_state, natural_units
from tippetop.problem.problem import top_of

MASS, BALL, HALF, MU, G = 0.01, 0.005, 0.02, 0.3, 9.8
ACROSS = 2e-6
DUMBBELL = tt.Problem(
    body=tt.Body(
        mass=MASS,
        shape=[tt.Sphere(radius=BALL, center=HALF), tt.Sphere(radius=BALL, center=-HALF)],
        I1=ACROSS,
        I3=1.25e-7,
    ),
    friction=tt.CoulombFriction(mu=MU),
    launch=tt.Launch(tilt=np.pi / 2, spin=0.0),
)


def followed_by_steps(problem: tt.Problem, duration: float, samples: int = 11) -> xr.Dataset:
    """By a method that needs no compiling."""
    return tt.simulate(problem, duration, samples=samples, integrator="dop853", tolerance=3e-14)


def times(run: xr.Dataset, kind: str) -> list[float]:
    found: list[float] = run["event_time"].values[run["event_kind"].values == kind].tolist()
    return found


def test_a_dumbbell_that_slides_along_itself_stops_as_a_block() -> None:
    run = followed_by_steps(DUMBBELL.replace({"launch.velocity": (0.2, 0.0, 0.0)}), 1.0)
    assert run.attrs["status"] == "at_rest"
    assert times(run, "stick") == pytest.approx([0.2 / (MU * G)] * 2, rel=1e-13)
    assert float(run["event_time"][-1]) == pytest.approx(float(run["time"][-1]), rel=1e-13)
    assert float(run["energy_lost_sliding"]) == pytest.approx(0.5 * MASS * 0.2**2, rel=1e-13)


@pytest.mark.slow
@pytest.mark.parametrize(("seed", "duration", "contacts"), [(56, 0.1, 2), (31, 0.2, 1)])
def test_the_end_of_slip_on_two_converges_as_its_last_moments_are_followed_nearer(
    seed: int, duration: float, contacts: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """On both contacts at the same instant, and on one."""
    found = []
    for horizon in (1e-6, 3e-8, 1e-10):
        monkeypatch.setattr(slip_end_mode, "LAST_STEPS", (horizon, 1e-16))
        run = followed_by_steps(resisted(seed), duration)
        found.append([*times(run, "stick"), *run["angular_momentum"].values[-1] * 1e3])
        assert len(times(run, "stick")) == contacts
    np.testing.assert_allclose(found[1], found[2], rtol=0, atol=1e-12)
    np.testing.assert_allclose(found[0], found[2], rtol=0, atol=1e-11)


def test_a_dumbbell_that_turns_stops_under_the_couple_of_both_ends() -> None:
    """I_1 w' = -mu m g HALF."""
    run = tt.simulate(
        DUMBBELL.replace({"launch.precession": 5.0, "launch.velocity": (0.0, 0.0, 0.0)}),
        1.0,
        samples=11,
    )
    assert run.attrs["status"] == "at_rest"
    assert times(run, "stick") == pytest.approx(
        [5.0 * ACROSS / (MU * MASS * G * HALF)] * 2, rel=1e-12
    )


def test_a_dumbbell_that_slides_across_comes_to_roll() -> None:
    """As a cylinder: the slip falls with mu g (1 + m r^2 / I_3), and then it rolls on for ever."""
    run = followed_by_steps(DUMBBELL.replace({"launch.velocity": (0.0, 0.2, 0.0)}), 1.0)
    slowing = MU * G * (1.0 + MASS * BALL**2 / 1.25e-7)
    assert times(run, "stick") == pytest.approx([0.2 / slowing] * 2, rel=1e-12)
    assert run.attrs["status"] == "completed"
    rolls = 0.2 - MU * G * 0.2 / slowing
    assert run["velocity"].values[-1] == pytest.approx([0.0, rolls, 0.0], abs=1e-13)
    assert run["mode"][-1] == "sticking_on_0_and_1"


ONE_THEN_BOTH, SLIPS_AGAIN, BEYOND_THE_LIMIT = 8, 11, 13
"""Of the first both contacts stick in turn; of the others one sticks, and slips again: of the last
as soon as the other has stopped.
"""
DURATION = {ONE_THEN_BOTH: 0.12, SLIPS_AGAIN: 0.3, BEYOND_THE_LIMIT: 0.0826}


@cache
def followed(seed: int):
    """The segments of such a body."""
    problem = lying(seed)
    units = natural_units(top_of(problem))
    automaton = automaton_of(problem.contact, natural(top_of(problem)), units)
    start = automaton.launch(natural_state(problem.start(), units))
    run = Trajectory(
        automaton, start, DURATION[seed] / units.time, make_integrator("dop853", 3e-14)
    )
    return list(run.segments())


def states(segment, count=5):
    """Numbers and states within a segment."""
    knots = segment.solution.knots
    for time in np.linspace(knots[0], knots[-1], count):
        y = [float(number) for number in segment.solution(np.array([time]))[0]]
        yield y, segment.mode.state(y)


@pytest.mark.parametrize("seed", [ONE_THEN_BOTH, pytest.param(SLIPS_AGAIN, marks=pytest.mark.slow)])
def test_sticking_contacts_do_not_slip_and_stay_within_the_friction_cone(seed: int) -> None:
    seen = set()
    for segment in followed(seed):
        mode = segment.mode
        if not (isinstance(mode, ContactMode) and len(mode.tops) == 2 and any(mode.sticks)):
            continue
        seen.add((mode.sticks, mode.sense))
        for y, state in states(segment):
            omega = np.array(angular_velocity(state.axis, state.momentum, mode.top))
            slips = [
                np.array(state.velocity) + np.cross(omega, contact_vector(state.axis, top.surface))
                for top in mode.tops
            ]
            stuck = slips if all(mode.sticks) else slips[:1]
            assert np.abs(stuck).max() < 1e-12
            assert abs(gap_rate(state, mode.beside[0])) < 1e-12
            pair = contact_points(state.axis, state.momentum, mode.tops)
            force = mode.reaction(y).force
            if all(mode.sticks):
                found = forces_on_two(pair, (None, None), 0.0)
                assert min(found.normal) > 0.0
                assert (
                    min(found.sticking_reserve(0), found.sticking_reserve(1), found.both_reserve)
                    >= 0.0
                )
            else:
                across = mode.sense * np.array([-state.axis[1], state.axis[0]])
                found = forces_on_two(pair, (None, tuple(across)), 0.0)
                assert min(found.normal) > 0.0
                assert found.reserve(0) >= -1e-12
                assert mode.sense * slip_apart(pair) >= -1e-12
            assert force == pytest.approx(found.force, abs=1e-12)
    assert ((True, False), -1.0) in seen


def test_force_across_the_line_reduces_the_reserve_along_it() -> None:
    """Against many ways to share the force out between both contacts."""
    segment = next(s for s in followed(ONE_THEN_BOTH) if s.mode.label == "sticking_on_0_and_1")
    (_, state), *_ = states(segment)
    held = forces_on_two(
        contact_points(state.axis, state.momentum, segment.mode.tops), (None, None), 0.0
    )
    limits = segment.mode.top.friction.mu * np.array(held.normal)
    e = np.array([*state.axis[:2], 0.0]) / np.hypot(*state.axis[:2])
    t, across = np.array([-e[1], e[0], 0.0]), limits * (0.3, -0.7)
    shares = np.linspace(-2.0, 2.0, 40001)
    seen = set()
    for along in np.linspace(0.0, 2.0, 41) * limits.sum():
        forces = across[0] * t + along * e, across[1] * t
        wrenches = [
            Wrench((f[0], f[1], n), NO_TORQUE) for f, n in zip(forces, held.normal, strict=True)
        ]
        motion = held._replace(wrenches=tuple(wrenches))
        fits = np.hypot(shares, across[0]) <= limits[0]
        fits &= np.hypot(along - shares, across[1]) <= limits[1]
        assert (motion.both_reserve >= 0.0) == fits.any(), along
        seen.add(bool(fits.any()))
    assert seen == {False, True}


def test_a_cone_that_rolls_on_a_slope_slips_once_friction_no_longer_holds_it_along_itself() -> None:
    """It turns downhill until the weight along the line is all that both contacts can hold, though
    each could hold more across it.
    """
    shape = [tt.Sphere(radius=0.005, center=0.02), tt.Sphere(radius=0.004, center=-0.02)]
    problem = tt.Problem(
        body=tt.Body(mass=MASS, shape=shape, I1=2e-6, I3=1.25e-7),
        friction=tt.CoulombFriction(mu=0.2),
        launch=tt.Launch(tilt=math.acos(0.001 / 0.04), spin=0.0),
        table=tt.Table(slope=0.19, azimuth=0.3),
    )
    run = tt.simulate(problem, 0.6, samples=2)
    assert run.attrs["status"] == "completed"
    assert [times(run, kind)[:1] for kind in ("stick", "slip")] == [[0.0], times(run, "slip")[1:]]
    units = natural_units(top_of(problem))
    automaton = automaton_of(problem.contact, natural(top_of(problem)), units)
    start = automaton.launch(natural_state(problem.start(), units))
    method = make_integrator("dop853", 3e-14)
    held = next(iter(Trajectory(automaton, start, 0.6 / units.time, method).segments()))
    end = held.end_state
    forces = forces_on_two(
        contact_points(end.axis, end.momentum, held.mode.tops), (None, None), 0.0
    )
    assert held.end_time * units.time == pytest.approx(times(run, "slip")[0], rel=1e-9)
    assert forces.both_reserve == pytest.approx(0.0, abs=1e-9)
    assert min(forces.sticking_reserve(0), forces.sticking_reserve(1)) > 1e-3


@pytest.mark.slow
@pytest.mark.parametrize(("seed", "near"), [(ONE_THEN_BOTH, 1e-3), (SLIPS_AGAIN, 1e-2)])
def test_sticking_on_two_is_the_limit_of_smoothed_friction(seed, near) -> None:
    """With f = -mu v / sqrt(v^2 + eps^2) both contacts creep, by the equations of sliding on
    two.
    """
    problem, duration, names = lying(seed), DURATION[seed], ["axis", "angular_momentum", "velocity"]
    dry = followed_by_steps(problem, duration)[names]
    off = []
    for eps in (1e-3, 1e-4):
        friction = {"kind": "regularized_coulomb", "mu": problem.friction.mu, "eps": eps}
        creeps = problem.replace({"friction": friction})
        run = tt.simulate(creeps, duration, samples=11, integrator="collocation")[names]
        off.append(max(float((abs(dry - run).max() / abs(dry).max())[name]) for name in names))
    assert off[1] < 0.3 * off[0]
    assert off[1] < near


def test_energy_balances_over_all_transitions_and_stays_while_both_stick() -> None:
    run = followed_by_steps(lying(ONE_THEN_BOTH), DURATION[ONE_THEN_BOTH], 101)
    assert run.attrs["status"] == "completed"
    assert float(run["energy_error"]) < 1e-12
    assert float(abs(run["gap"]).max()) < 1e-12 * 0.02
    stuck = run["mode"].values == "sticking_on_0_and_1"
    assert stuck.sum() > 10
    assert np.ptp(run["energy"].values[stuck]) < 1e-12 * float(abs(run["energy"]).max())


def test_slip_that_begins_at_the_limit_grows_with_the_square_of_time() -> None:
    segments = followed(SLIPS_AGAIN)
    number = next(i for i, s in enumerate(segments) if isinstance(s.mode, SlipOnset))
    begin, before = segments[number], segments[number - 1]
    assert before.mode.sticks == (True, False)
    start = begin.solution.knots[0]
    after = np.array([2e-3, 4e-3, 8e-3])
    speeds = np.hypot(*begin.solution(start + after).T[8:10])
    assert speeds[1:] / speeds[:-1] == pytest.approx([4.0, 4.0], rel=0.02)


@pytest.mark.parametrize("seed", [SLIPS_AGAIN, BEYOND_THE_LIMIT])
def test_slip_that_begins_solves_the_equations_of_sliding(seed: int) -> None:
    """From early in its first step on, by an implicit method and in other numbers."""
    begin = next(segment for segment in followed(seed) if isinstance(segment.mode, SlipOnset))
    knots = begin.solution.knots
    early, late = (knots[0] + part * (knots[-1] - knots[0]) for part in (0.3, 0.9))
    mode, (first, last) = begin.mode, begin.solution(np.array([early, late])).tolist()
    slides = mode_on_two(mode.tops, mode.contact_mode.rolls)
    start = early, np.array(slides.numbers(mode.state(first)))
    (arc,) = make_integrator("collocation").integrate(slides.motion, slides.parameters, start, late)
    assert arc.end_state == pytest.approx(slides.numbers(mode.state(last)), abs=1e-11)
    part = (late - knots[-2]) / (knots[-1] - knots[-2])
    (component,), count = mode.components, mode.contact_mode.count
    velocities = mode.split_velocities(last[count:])
    rate = mode.contacts(last[:count], velocities, velocities).rate_of(component)
    assert rate == pytest.approx(
        [
            np.polynomial.polynomial.polyval(part, np.polynomial.polynomial.polyder(row))
            / (knots[-1] - knots[-2])
            for row in begin.solution.terms[-1, count:]
        ],
        abs=1e-10,
    )


def test_slip_that_begins_on_the_contact_that_sticks_goes_on_and_sticks_again() -> None:
    """Slip begins on either surface; the body then slides on both, and not on one of them twice."""
    shape = (
        tt.Sphere(radius=0.0121534314, center=-0.00423612465),
        tt.Sphere(radius=0.0150357072, center=0.0241527012),
    )
    touching = (shape[0].radius - shape[1].radius) / (shape[0].center - shape[1].center)
    launch = tt.Launch(
        tilt=math.acos(touching), spin=-38.64, azimuth=0.06, precession=2.95,
        velocity=(0.2977, -0.2258, 0.0),
    )  # fmt: skip
    body = tt.Body(mass=0.02, shape=shape, I1=7.283e-6, I3=8.0905e-6)
    friction = tt.CoulombFriction(mu=0.343)
    problem = tt.Problem(body=body, friction=friction, launch=launch, gravity=9.81)
    run = followed_by_steps(problem, 0.35)
    assert run.attrs["status"] == "completed"
    assert times(run, "stick")[1] == pytest.approx(0.3327, abs=1e-4)
    assert float(run["energy_error"]) < 1e-12
