"""Stick and slip against an independent solver, motions known exactly, and orders of
convergence.
"""

import math
from itertools import product

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from campaigns import among
from creeping import creep_rates, direction_of_slip
from dry_runs import DryRun, launched
from tippetop.contact.automaton import Automaton
from tippetop.contact.contact_mode import ContactMode
from tippetop.contact.guards import SLIP
from tippetop.contact.mode import EventKind, split
from tippetop.contact.slip_end_mode import SlipEnd
from tippetop.contact.slip_end_motion import rates_in_time
from tippetop.contact.slip_onset import SlipOnset, onset_motion
from tippetop.contact.slip_phase import follow_slip
from tippetop.contact.slip_step import SlipStep
from tippetop.contact.trajectory import Trajectory
from tippetop.contact.transient import SLIP_AND_ROLLING
from tippetop.integrators import make_integrator
from tippetop.integrators.scipy_methods import SciPy
from tippetop.mechanics.contacts.contact_point import ContactPoint
from tippetop.mechanics.contacts.forces import (
    forces_and_accelerations,
    velocity_without_slip,
    without_drilling,
)
from tippetop.mechanics.contacts.gauss_points import PARTS, STAGES
from tippetop.mechanics.contacts.onset_forces import find_onset
from tippetop.mechanics.contacts.slip_clock import (
    SlipComponent,
    SlipEndState,
    reopening_guard,
)
from tippetop.mechanics.contacts.slip_variables import (
    HORIZON,
    plus,
    scaled,
    size,
    slip_of,
    time_to_end,
    velocity_of,
)
from tippetop.mechanics.laws.contensou import ELLIPSOIDAL_RADIUS, EllipsoidalLaw
from tippetop.mechanics.laws.contensou_hertz import HertzLaw
from tippetop.mechanics.laws.coulomb import CoulombLaw, RollingResistance
from tippetop.mechanics.laws.friction import NO_TORQUE, Traction
from tippetop.mechanics.motion import angular_velocity, on_table, sliding_rates
from tippetop.mechanics.state import SlidingState
from tippetop.mechanics.surfaces.surface import SphereSurface, SpheroidSurface
from tippetop.mechanics.top import Top

SECOND = math.sqrt(9.8 / 0.02)
"""A second in units of (radius / gravity)^(1/2), for the report's top."""

DOP853 = SciPy("dop853", 1e-13)

BOTH = pytest.mark.parametrize("integrator", [None, DOP853], ids=["taylor", "dop853"])


SPHERE = SphereSurface(1.0, 0.3)


def report(law, shape=SPHERE, resistance=None):
    return Top.of(1.0, 131 / 350, 2 / 5, shape, law, 1.0, resistance)


def tilt(run):
    return math.acos(run.axis[2])


def spin(run):
    return sum(a * b for a, b in zip(run.axis, run.momentum, strict=True)) / run.top.axial_inertia


# Against an independent solver, to the 1e-9 s and 1e-8 rad that its authors vouch for
# ---------------------


@BOTH
def test_a_top_whose_centre_of_mass_rests_at_first_sticks(integrator):
    run = DryRun(*launched(report(CoulombLaw(0.3)), 0.1, 155.0 / SECOND, rests=True), integrator)
    run.follow(0.1 * SECOND)
    (stuck,) = run.times("stick")
    assert stuck / SECOND == pytest.approx(0.039324496801456346, abs=1e-11)
    assert tilt(run) == pytest.approx(0.041055632226041285, abs=1e-10)
    assert spin(run) * SECOND == pytest.approx(154.03191608427147, abs=1e-8)
    assert len(run.events) == 1


SLIPS = np.array(
    [0.009376570544231876, 0.04206575876996948, 0.07499098425096684, 0.10814670305977013]
)
STICKS = np.array([0.0, 0.031285582730557274, 0.06521018588056923, 0.09932965633952427])


def test_slips_and_sticks():
    run = DryRun(*launched(report(CoulombLaw(0.028)), 0.1, 155.0 / SECOND), DOP853).follow(
        0.05 * SECOND
    )
    assert np.array(run.times("slip")) / SECOND == pytest.approx(SLIPS[:2], abs=1e-11)
    assert np.array(run.times("stick")) / SECOND == pytest.approx(STICKS[:2], abs=1e-11)


@pytest.mark.slow
def test_slips_and_sticks_up_to_lift_off():
    run = DryRun(*launched(report(CoulombLaw(0.028)), 0.1, 155.0 / SECOND)).follow(8.0 * SECOND)
    assert np.array(run.times("slip")[:4]) / SECOND == pytest.approx(SLIPS, abs=1e-11)
    assert np.array(run.times("stick")[:4]) / SECOND == pytest.approx(STICKS, abs=1e-11)
    assert run.times("liftoff")[0] / SECOND == pytest.approx(7.858113898308634, abs=1e-9)
    assert tilt(run) == pytest.approx(1.0658142580452235, abs=1e-8)


@pytest.mark.slow
def test_slip_and_drilling_end_together_with_contensou_friction():
    law = EllipsoidalLaw(0.3, 0.05 / ELLIPSOIDAL_RADIUS)
    run = DryRun(*launched(report(law), 0.1, 100.0 / SECOND)).follow(5.0 * SECOND)
    (stuck,) = run.times("stick")
    assert stuck / SECOND == pytest.approx(4.33828884528525, abs=1e-9)
    assert tilt(run) == pytest.approx(1.7088925994636652, abs=1e-8)
    assert spin(run) * SECOND == pytest.approx(-6.842385539695942, abs=1e-7)
    assert angular_velocity(run.axis, run.momentum, run.top)[2] == pytest.approx(0.0, abs=1e-13)


# Known exactly
# ------------------------------------------------------------------------------------------


@BOTH
@pytest.mark.parametrize(
    "slip", [(0.8, 0.3), (0.008, 0.003)], ids=["far from its end", "near its end"]
)
@pytest.mark.parametrize("turning", [(0.0, 0.0, 0.0), (3.0, -2.0, 5.0)])
def test_a_uniform_ball_stops_slipping_after_two_sevenths_of_its_slip_over_mu_g(
    turning, slip, integrator
):
    """Its slip keeps its direction, v' = -(7/2) mu g; it sticks for good."""
    mu = 0.25
    ball = Top.of(1.0, 0.4, 0.4, SphereSurface(1.0, 0.0), CoulombLaw(mu), 1.0)
    axis, momentum = (0.6, 0.0, 0.8), tuple(0.4 * w for w in turning)
    velocity = velocity_of(axis, momentum, slip, ball)
    run = DryRun(ball, axis, momentum, velocity, integrator).follow(6.0)
    (stuck,) = run.times("stick")
    assert stuck == pytest.approx(size(slip) / (3.5 * mu), abs=1e-13)
    after = plus(velocity, scaled(-2.0 / 7.0, slip))
    assert velocity_of(run.axis, run.momentum, run.slip, ball) == pytest.approx(after, abs=1e-12)


class OneWay(CoulombLaw):
    """Coulomb friction of a slip that stays on one side of zero along x."""

    def traction(self, slip, angular_velocity):
        return Traction((-self.mu, 0.0), NO_TORQUE)


@BOTH
def test_slip_passes_through_zero_in_a_plane_where_it_cannot_stick(integrator):
    """The body falls over in the plane x z while it slips forward, stops, and slips back at
    once.
    """
    mu = 0.05
    top = report(CoulombLaw(mu))
    axis, momentum = (math.sin(1.2), 0.0, math.cos(1.2)), (0.0, 0.1, 0.0)
    passed = 0
    for start in (0.05, -0.02, -0.05):
        velocity = plus(velocity_without_slip(axis, momentum, top), (start, 0.0))
        run = DryRun(top, axis, momentum, velocity, integrator).follow(0.6)
        state = SlidingState(axis, momentum, velocity)
        y, time, way = np.array(state.pack()), 0.0, math.copysign(1.0, start)
        turns = 0
        while time < 0.6:
            planar = top.altered(friction=OneWay(way * mu))

            def slip(_, y):
                s = SlidingState.unpack(y.tolist())
                offset = 1e-14 * way if turns else 0.0  # noqa: B023
                return slip_of(s.axis, s.momentum, s.velocity, top)[0] + offset

            slip.terminal, slip.direction = True, -way

            def rates(_, y):
                return sliding_rates(SlidingState.unpack(y.tolist()), planar).pack()  # noqa: B023

            part = solve_ivp(rates, (time, 0.6), y, "DOP853", events=slip, rtol=1e-12, atol=1e-14)
            time, y = part.t[-1], part.y[:, -1]
            if part.status == 1:
                turns, way = turns + 1, -way
        assert turns in (0, 1)
        passed += turns
        assert run.axis == pytest.approx(tuple(y[:3]), abs=1e-9)
        assert run.momentum == pytest.approx(tuple(y[3:6]), abs=1e-9)
        assert velocity_of(run.axis, run.momentum, run.slip, top) == pytest.approx(
            tuple(y[6:8]), abs=1e-9
        )
    assert passed == 2


# Where slip goes on
# -------------------------------------------------------------------------------------


def swinging(top):
    """A body at rest at its contact point that will not stick if friction is weak."""
    axis, momentum = (0.48, 0.64, 0.6), (0.2, -0.1, 0.4)
    if len(slip_of(axis, momentum, (0.0, 0.0), top)) == 3:
        momentum = without_drilling(axis, momentum, top)
    return axis, momentum


def stuck_reserve(axis, momentum, top):
    """Positive while the table can hold the contact, and the body rolls as it does."""
    [slip] = [
        guard for guard in ContactMode(top, sticks=(True,)).motion.guards if guard.name == SLIP
    ]
    return slip.value((*axis, *momentum), top.numbers)


RESISTANCE = RollingResistance(0.01)

WEAK = [
    report(CoulombLaw(0.02)),
    report(EllipsoidalLaw(0.02, 0.1)),
    report(HertzLaw(0.02, 0.1)),
    report(CoulombLaw(0.02), resistance=RESISTANCE),
    report(EllipsoidalLaw(0.02, 0.1), resistance=RESISTANCE),
]


@pytest.mark.parametrize("top", WEAK, ids=repr)
def test_what_cannot_stick_slips_the_way_it_is_accelerated(top):
    axis, momentum = swinging(top)
    assert stuck_reserve(axis, momentum, top) < 0.0
    direction, rate = direction_of_slip(axis, momentum, top)
    acceleration = creep_rates(axis, momentum, direction, top).slip
    assert rate > 0.01
    assert acceleration == pytest.approx(scaled(rate, direction), abs=1e-12)


def at_the_limit(family, shape=SPHERE):
    """That body, with as much friction as it needs to stick at this instant, and less than it needs
    later.
    """
    for sign in (1.0, -1.0):
        axis, momentum = swinging(family(1.0, shape))
        momentum = scaled(sign, momentum)
        low, high = 0.0, 1.0
        for _ in range(200):
            middle = 0.5 * (low + high)
            held = stuck_reserve(axis, momentum, family(middle, shape)) >= 0.0
            low, high = (low, middle) if held else (middle, high)
        top = family(high, shape)
        direction, _ = direction_of_slip(axis, momentum, top)
        if began(top, axis, momentum, direction, 1e-6).least_speed > 0.0:
            return top, axis, momentum
    raise AssertionError("it comes to its limit, and does not leave it")


def began(top, axis, momentum, direction, length):
    """A step of slip that begins in a direction."""
    motion = beginning(top, (SlipComponent(slip=True),))
    step, none = SlipStep(motion, top.numbers), [0.0 for _ in direction]
    velocity = velocity_without_slip(axis, momentum, top)
    assert step.solve([*axis, *momentum, *velocity, *none], [direction], length)
    return step


def beginning(top, components):
    """The equations of motion of velocities of a sliding top that begin, on a table that pulls."""
    return onset_motion(ContactMode(top, pulls=True).without_tops(), (top.kind,), components)


def starting(family, power, shape=SPHERE):
    """A body of a family whose slip begins as this power of time."""
    if power == 2:
        return at_the_limit(FAMILIES[family], shape)
    top = FAMILIES[family](0.02, shape)
    return top, *swinging(top)


FAMILIES = {
    "coulomb": lambda mu, shape: report(CoulombLaw(mu), shape),
    "ellipsoidal": lambda mu, shape: report(EllipsoidalLaw(mu, 0.5), shape),
    "resisted": lambda mu, shape: report(CoulombLaw(mu), shape, RESISTANCE),
    "resisted ellipsoidal": lambda mu, shape: report(EllipsoidalLaw(mu, 0.5), shape, RESISTANCE),
}


class Followed:
    """The first step of velocities that begin, as functions of time, and its direction."""

    def __init__(self, top, axis, momentum, directions, begins):
        motion = beginning(top, begins)
        none = [0.0 for way in directions for _ in way]
        velocity = velocity_without_slip(axis, momentum, top)
        self.begin = np.array([*axis, *momentum, *velocity, *none])
        start = self.begin.tolist(), directions
        phase = follow_slip(motion, top, start, 1e9, numbers=top.numbers)
        assert len(phase.knots) == PARTS + 1
        self.end, self.last = phase.knots[-1], phase.last
        self.terms = phase.rows[0].reshape(PARTS, len(self.begin), STAGES)

    def __call__(self, part):
        """Numbers and rates at a part of the step."""
        place = PARTS * part
        whole = min(int(place), PARTS - 1)
        powers = (place - whole) ** np.arange(STAGES + 1)
        numbers = self.begin + self.terms[:whole].sum(axis=(0, 2))
        rates = self.terms[whole] @ (powers[:-1] * np.arange(1, STAGES + 1))
        return numbers + self.terms[whole] @ powers[1:], rates * PARTS / self.end


@pytest.mark.parametrize("power", [1, 2])
@pytest.mark.parametrize(
    ("family", "shape"),
    among(list(product(FAMILIES, (SphereSurface(1.0, 0.3), SpheroidSurface(1.0, 1.4)))), check=5),
)
def test_the_beginning_of_slip_solves_the_equations(family, power, shape):
    """At any instant, in long steps and short ones; slip grows with its power of time."""
    top, axis, momentum = starting(family, power, shape)
    direction, rate = direction_of_slip(axis, momentum, top)
    assert (rate < 1e-12) is (power == 2)
    begun = Followed(top, axis, momentum, [direction], (SlipComponent(slip=True),))
    assert begun.end > 0.01
    for part in (1e-3, 0.02, 0.3, 0.5, 0.77, 0.99):
        numbers, rates = begun(part)
        n, L, u, zeta = (tuple(row.tolist()) for row in np.split(numbers, [3, 6, 8]))
        true = creep_rates(n, L, zeta, top)
        drawn = np.split(rates, [6, 8])
        assert [*drawn[0], *drawn[2]] == pytest.approx(
            [*true.axis, *true.momentum, *true.slip], abs=1e-8
        )
        assert u == pytest.approx(velocity_of(n, L, zeta, top), abs=1e-14)
        slip = size(zeta)
        assert slip / size(begun(2.0 * part if part < 0.01 else part)[0][8:].tolist()) == (
            pytest.approx(0.5**power, rel=0.1 if power == 2 else 0.05) if part < 0.01 else 1.0
        )


@pytest.mark.parametrize(
    "family", ["resisted", pytest.param("resisted ellipsoidal", marks=pytest.mark.slow)]
)
def test_slip_and_rolling_begin_together(family):
    """Each in its direction, by the equations; the rolling beside the momentum is its own."""
    top = FAMILIES[family](0.02, SPHERE).altered(rolling_resistance=RollingResistance(1e-3))
    axis, momentum = (0.48, 0.64, 0.6), (0.0, 0.0, 0.0)
    point = ContactPoint.of(axis, momentum, top)
    begin = find_onset(point, None, None, (True, True))
    begun = Followed(top, axis, momentum, [begin.slip, begin.rolling], SLIP_AND_ROLLING)
    count = len(begin.slip)
    for part in (1e-3, 0.1, 0.5, 0.9):
        numbers, rates = begun(part)
        n, L, _, zeta, rolling = (
            tuple(row.tolist()) for row in np.split(numbers, [3, 6, 8, 8 + count])
        )
        assert rolling == pytest.approx(angular_velocity(n, L, top)[:2], abs=1e-15)
        here = ContactPoint.of(n, L, top)
        wrench, acceleration = forces_and_accelerations(here, zeta, rolling)
        change = SlipComponent(slip=True).rate(acceleration, top)
        drawn = scaled(1.0 / top.mass, wrench.force[:2])
        assert rates[3:] == pytest.approx(
            [*here.moment(wrench), *drawn, *change, *acceleration.turning[:2]], abs=1e-9
        )


@pytest.mark.parametrize("mode", [SlipEnd, SlipOnset], ids=["clock", "phase"])
def test_the_last_moments_of_slip_are_told_up_to_its_end(mode, monkeypatch):
    """Beyond the end of the clock too: the slip goes to zero in a straight line, and what goes with
    it.
    """
    if mode is SlipEnd:
        monkeypatch.setattr(SlipComponent, "recurs", lambda *_: False)
    top, axis, momentum, velocity = launched(report(CoulombLaw(0.2)), 1.0, 50.0 / SECOND)
    start = on_table(SlidingState(axis, momentum, velocity), top)
    automaton = Automaton(top, "ignore", 0.0)
    trajectory = Trajectory(automaton, automaton.launch(start), 0.4 * SECOND, make_integrator())
    segment, *_ = (one for one in trajectory.segments() if isinstance(one.mode, mode))
    assert [event.kind for event in segment.transition.events] == [EventKind.STICK]
    solution = segment.solution
    left = np.geomspace(1e-1, 1e-12, 23) * (solution.end - solution.knots[0])
    numbers = solution(np.append(solution.end - left, solution.end))
    slip = np.hypot(*numbers[:, 8:].T)
    times = solution.end - np.append(solution.end - left, solution.end)
    near = times < 1e-8
    assert near.sum() > 5
    rate = size(
        creep_rates(*split(numbers[-1]), tuple(numbers[near][0, 8:] / slip[near][0]), top).slip
    )
    assert slip[near] == pytest.approx(rate * times[near], rel=1e-6, abs=1e-15)
    last = segment.end_state
    numbers_at_end = (*last.axis, *last.momentum, *last.velocity[:2])
    np.testing.assert_allclose(numbers[-1, :8], numbers_at_end, rtol=0, atol=1e-15)


@pytest.mark.parametrize("family", FAMILIES)
def test_the_table_pulls_from_the_first_instant_on_as_it_does_where_slip_begins(family):
    """However small slip and drilling still are: as small as rounding, and nothing at all."""
    top, axis, momentum = starting(family, 1)
    velocity = velocity_without_slip(axis, momentum, top)
    state = on_table(SlidingState(axis, momentum, velocity), top)
    point = ContactPoint.of(axis, momentum, top)
    begin = find_onset(point, None, point.turning[:2], (True, False))
    true = begin.wrench
    onset = SlipOnset.of(ContactMode(top, pulls=True), (SlipComponent(slip=True),), (begin.slip,))
    (segment,) = onset.segments(0.0, state, 1.0, make_integrator())
    y = segment.solution(np.array([0.0, 1e-14, 1e-11, 1e-9]))
    found = segment.mode.reaction(y.T)
    for i in range(3):
        assert np.broadcast_to(found.force[i], 4) == pytest.approx(true.force[i], abs=1e-7)
        assert np.broadcast_to(found.torque[i], 4) == pytest.approx(true.torque[i], abs=1e-7)


def test_the_clock_of_slips_end_is_left_where_slip_outlasts_twice_what_it_begins_at():
    """And slip that is rounding is not left to a state, which has no direction of it."""
    random, top, ending = (
        np.random.default_rng(3),
        report(CoulombLaw(0.3)),
        SlipComponent(slip=True),
    )
    counts = {"begins": 0, "leaves": 0, "rounding": 0}
    for _ in range(2000):
        angle, speed = random.uniform(0.0, 2.0 * np.pi), 10.0 ** random.uniform(-17.0, -1.0)
        tilt, momentum = random.uniform(0.1, 3.0), tuple(random.normal(size=3))
        axis, direction = (
            (math.sin(tilt), 0.0, math.cos(tilt)),
            (math.cos(angle), math.sin(angle)),
        )
        velocity = velocity_of(axis, momentum, scaled(speed, direction), top)
        now = SlipEndState((*axis, *momentum, *velocity), direction, speed, 0.0)
        rates = rates_in_time(now, ContactMode(top), ending)
        left = time_to_end(scaled(speed, direction), rates.xi)
        guard = reopening_guard(now, rates)
        if left < HORIZON:
            counts["begins"] += 1
            assert guard > 0.0
        if speed < 1e-12:
            counts["rounding"] += 1
            assert guard > 0.0
        if left > 2.0 * HORIZON and speed > 1e-4:
            counts["leaves"] += 1
            assert guard < 0.0
    assert min(counts.values()) > 100


def test_slip_starts_against_the_force_that_held_it():
    top, axis, momentum = starting("coulomb", 2)
    direction, _ = direction_of_slip(axis, momentum, top)
    force = forces_and_accelerations(ContactPoint.of(axis, momentum, top), None)[0].force[:2]
    assert direction == pytest.approx(scaled(-1.0 / size(force), force), abs=1e-12)
    # Slip grows as t^2: twice the time, four times the slip.
    short, long = (size(began(top, axis, momentum, direction, t).changes[8:]) for t in (1e-6, 2e-6))
    assert long / short == pytest.approx(4.0, rel=1e-5)


def test_where_the_first_step_ends_does_not_matter():
    """An integrator that takes over sooner, or later, comes to the same slip."""
    top, axis, momentum = starting("coulomb", 2)
    direction, _ = direction_of_slip(axis, momentum, top)
    ends = []
    for length in (0.02, 0.05, 0.1):
        step = began(top, axis, momentum, direction, length)
        changes = np.delete(step.changes, [6, 7])
        begin = np.array([*axis, *momentum, 0.0, 0.0]) + changes

        def rates(_, y):
            r = creep_rates(tuple(y[:3]), tuple(y[3:6]), tuple(y[6:]), top)
            return [*r.axis, *r.momentum, *r.slip]

        run = solve_ivp(rates, (length, 0.2), begin, "DOP853", rtol=1e-12, atol=1e-15)
        ends.append(run.y[:, -1])
    assert ends[1] == pytest.approx(ends[0], abs=1e-11)
    assert ends[2] == pytest.approx(ends[0], abs=1e-11)
