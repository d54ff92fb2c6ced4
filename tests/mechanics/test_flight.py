"""Free flight against its differential equations, and its end against the gap in fifty digits."""

import math
from itertools import product
from typing import NamedTuple

import mpmath as mp
import numpy as np
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from campaigns import among, examples
from free_flight import fly, highest_gap, landing
from strategies import numbers, slides, spheres, spheroids, tops
from tippetop.contact.flight import Start
from tippetop.mechanics.flight.free_motion import free_rates, gap, gap_rate
from tippetop.mechanics.invariants import energy
from tippetop.mechanics.laws.friction import ViscousLaw
from tippetop.mechanics.motion import (
    along_table,
    angular_velocity,
    axis_rate,
    on_table,
    point_velocity,
)
from tippetop.mechanics.state import State
from tippetop.mechanics.surfaces.hull import Hull
from tippetop.mechanics.surfaces.surface import (
    RingSurface,
    SphereSurface,
    SpheroidSurface,
    contact_vector,
)
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import dot, length, scale
from tippetop.mechanics.view import Angles, state_from_angles
from tumbling import EDGES, Tumbling, reach

DIGITS = 50
SHAPES = {
    "tippe top": SphereSurface(0.02, 0.006),
    "lentil": SpheroidSurface(0.02, 0.011),
    "egg": SpheroidSurface(0.02, 0.034),
}


class Bead(NamedTuple):
    """A shape that is no sphere and no spheroid: a sphere with a quadratic and a cubic bump."""

    radius: float
    bump: float

    @property
    def size(self):
        return self.radius

    @property
    def spherical(self):
        return False

    @property
    def proportions(self):
        return (self.bump,)

    @classmethod
    def from_proportions(cls, proportions):
        return cls(1.0, *proportions)

    def height(self, c):
        return self.radius * (1.0 + self.bump * (c**2 - c**3 / 5) / (3 + c))

    def slope(self, c):
        numerator = (2 * c - 3 * c**2 / 5) * (3 + c) - (c**2 - c**3 / 5)
        return self.radius * self.bump * numerator / (3 + c) ** 2

    def curvature(self, c):
        # with u = 3 + c, (c^2 - c^3/5)/u = -u^2/5 + 14 u/5 - 57/5 + 72/(5 u)
        return self.radius * self.bump * (-2 / 5 + 144 / 5 / (3 + c) ** 3)


def time_unit(top):
    return math.sqrt(top.surface.size / top.gravity)


def speed_unit(top):
    return math.sqrt(top.surface.size * top.gravity)


@st.composite
def flights(draw, top_strategy=None):
    """A top in the air: some way up, or on the table, with any velocity."""
    top, sliding = draw(slides(top_strategy))
    state = on_table(sliding, top)
    up = draw(numbers(0.0, 3.0)) * top.surface.size
    rising = draw(numbers(-2.0, 2.0)) * speed_unit(top)
    return top, state._replace(height=state.height + up, velocity=(*state.velocity[:2], rising))


def tipping(shape, tilt_rate, tilt=0.8, precession=150.0, spin=300.0):
    """A body of this shape on the table, at a tilt that changes at this rate."""
    top = Top.of(0.02, 3.0e-6, 3.3e-6, shape, ViscousLaw(0.3), 9.8)
    return top, on_table(
        state_from_angles(Angles(tilt, tilt_rate, 0.3, precession, spin, (0.1, 0.2)), top, math),
        top,
    )


class ExactGap:
    """The gap during a flight in many digits, from the tip of the axis: c = A + B cos(w t) + C
    sin(w t).
    """

    def __init__(self, state, top, start):
        n, momentum = ([mp.mpf(x) for x in v] for v in (state.axis, state.momentum))
        self.shape = type(top.surface)(*map(mp.mpf, top.surface))
        square = sum(x * x for x in momentum)
        self.w = mp.sqrt(square) / mp.mpf(top.transverse_inertia)
        square = square or mp.mpf(1)
        self.mean = momentum[2] * sum(a * b for a, b in zip(momentum, n, strict=True)) / square
        self.cosine = n[2] - self.mean
        self.sine = (momentum[0] * n[1] - momentum[1] * n[0]) / mp.sqrt(square)
        self.parabola = [mp.mpf(state.height), mp.mpf(state.velocity[2]), -mp.mpf(top.gravity) / 2]
        self.support = mp.taylor(self.height, 0, 4)
        self.parabola[:start] = self.support[:start]

    def height(self, t):
        tip = self.mean + self.cosine * mp.cos(self.w * t) + self.sine * mp.sin(self.w * t)
        return self.shape.height(tip)

    def __call__(self, t):
        t = mp.mpf(t)
        return self.parabola[0] + t * (self.parabola[1] + t * self.parabola[2]) - self.height(t)

    def derivative(self, order):
        """A derivative of the gap at the start."""
        return math.factorial(order) * (
            (self.parabola[order] if order < 3 else 0) - self.support[order]
        )


def check_landing(state, top, start, horizon, precision=1e-7):
    """The answer is a root of the exact gap, the first one, and there is none if the answer is
    none.
    """
    time = landing(state, top, horizon, start)
    with mp.workdps(DIGITS):
        exact = ExactGap(state, top, start)
        leading = next(
            exact.derivative(order) for order in range(start, 5) if exact.derivative(order)
        )
        if time == 0.0:
            assert leading <= 0 or (start == Start.AIRBORNE and leading <= 1e-15 * top.surface.size)
            return time
        assert leading > 0
        end = horizon if time is None else time
        fraction = [k / 300 for k in range(1, 300)] + [10 ** (-k / 15) for k in range(1, 120)]
        gaps = [exact(end * f) for f in fraction]
        peak = max(abs(g) for g in gaps)
        fuzz = precision * peak + 1e-15 * (top.surface.size + abs(state.height))
        assert min(gaps) > 0 or min(gaps) > -fuzz
        assert min(gaps[: int(299 * 0.98)]) > -1e-15 * top.surface.size
        if time is not None:
            assert abs(exact(time)) < fuzz
    return time


# Flight
# -----------------------------------------------------------------------------------------------


@settings(max_examples=25)
@given(flights(), numbers(0.0, 3.0))
def test_flight_solves_the_equations_of_free_motion(case, multiple):
    top, state = case
    elapsed = multiple * time_unit(top)

    def rates(_, y):
        return free_rates(State.unpack(y), top).pack()

    solution = solve_ivp(
        rates, (0.0, elapsed), state.pack(), method="DOP853", rtol=1e-12, atol=1e-13
    )
    there, expected = fly(state, elapsed, top, math), State.unpack(solution.y[:, -1])
    assert there.momentum == state.momentum
    for name in ("axis", "velocity", "height"):
        assert getattr(there, name) == pytest.approx(getattr(expected, name), rel=1e-9, abs=1e-9)


@given(flights(), numbers(0.0, 5.0), numbers(0.0, 5.0))
def test_flights_add_up_and_conserve(case, first, second):
    top, state = case
    t1, t2 = first * time_unit(top), second * time_unit(top)
    there, stopover = fly(state, t1 + t2, top, math), fly(fly(state, t1, top, math), t2, top, math)
    scales = State(
        1.0, length(state.momentum) + 1e-300, 10 * speed_unit(top), 60 * top.surface.size
    )
    for name, size in zip(State._fields, scales, strict=True):
        here = getattr(there, name)
        assert here == pytest.approx(getattr(stopover, name), rel=1e-12, abs=1e-12 * max(1.0, size))
    assert length(there.axis) == pytest.approx(1.0, rel=1e-14)
    assert dot(there.axis, there.momentum) == pytest.approx(
        dot(state.axis, state.momentum), abs=1e-13 * length(state.momentum)
    )
    fuzz = 1e-13 * top.mass * (top.gravity * 100 * top.surface.size + 100 * speed_unit(top) ** 2)
    assert energy(there, top) == pytest.approx(energy(state, top), rel=1e-13, abs=fuzz)


def test_arrays_fly_as_floats_do():
    top, state = tipping(SHAPES["egg"], 20.0)
    times = np.linspace(0.0, 0.3, 7).reshape(7, 1)
    together = fly(state, times, top, np)
    assert all(np.shape(x) == times.shape for x in together.pack())
    alone = [fly(state, float(t), top, math).pack() for t in times.ravel()]
    np.testing.assert_allclose(np.array(together.pack())[:, :, 0].T, alone, rtol=1e-14, atol=1e-15)


def test_a_body_without_momentum_falls_without_turning():
    top, state = tipping(SHAPES["egg"], 0.0)
    there = fly(state._replace(momentum=(0.0, 0.0, 0.0)), 0.5, top, math)
    assert there.axis == state.axis
    assert there.height == pytest.approx(
        state.height + state.velocity[2] * 0.5 - 9.8 / 8, rel=1e-15
    )


@pytest.mark.parametrize("tiny", [1e-20, 1e-100, 1e-300])
def test_slow_turning_is_exact_to_the_last_digit(tiny):
    """Rotation by a tiny angle is addition of the angle times the rate, whatever the size of the
    momentum.
    """
    top, state = tipping(SHAPES["egg"], 0.0)
    slow = state._replace(momentum=scale(tiny, state.momentum), axis=(1.0, 0.0, 0.0))
    there = fly(slow, 0.5, top, math)
    expected = scale(0.5, axis_rate(slow.axis, slow.momentum, top))
    assert there.axis[1:] == pytest.approx(expected[1:], rel=1e-11, abs=0.0)


@given(flights())
def test_the_gap_opens_at_the_vertical_velocity_of_the_lowest_point(case):
    top, state = case
    arm = contact_vector(state.axis, top.surface)
    omega = angular_velocity(state.axis, state.momentum, top)
    assert gap(state, top) == pytest.approx(state.height + arm[2], rel=1e-12, abs=1e-15)
    swing = length(omega) * length(arm) + length(state.velocity)
    rate = point_velocity(state.velocity, omega, arm)[2]
    assert gap_rate(state, top) == pytest.approx(rate, rel=1e-12, abs=1e-14 * swing)


@given(slides())
def test_a_body_on_the_table_has_no_gap_and_opens_none(slide):
    top, sliding = slide
    state = on_table(sliding, top)
    assert (gap(state, top), gap_rate(state, top)) == (0.0, 0.0)


# Touchdown: exact answers
# ------------------------------------------------------------------------------


@pytest.mark.parametrize("spin", [0.0, 1e-8, 300.0])
@pytest.mark.parametrize("shape", SHAPES.values(), ids=SHAPES)
class TestUprightBodies:
    """A body with a vertical axis that spins about it, or not at all, flies like a point."""

    def upright(self, shape, spin, up=0.0, rising=0.0):
        top = Top.of(0.02, 3.0e-6, 3.3e-6, shape, ViscousLaw(0.3), 9.8)
        momentum = (0.0, 0.0, top.axial_inertia * spin)
        return top, State((0.0, 0.0, 1.0), momentum, (0.0, 0.0, rising), shape.height(1.0) + up)

    @pytest.mark.parametrize("fall", [1e-3, 0.01, 1.0])
    def test_a_fall(self, shape, spin, fall):
        top, state = self.upright(shape, spin, up=4.9 * fall**2)
        assert landing(state, top, math.inf) == pytest.approx(fall, rel=1e-9)

    @pytest.mark.parametrize("lasting", [1e-12, 1e-6, 1e-3, 1.0])
    def test_a_rebound(self, shape, spin, lasting):
        top, state = self.upright(shape, spin, rising=4.9 * lasting)
        assert landing(state, top, math.inf, Start.REBOUND) == pytest.approx(lasting, rel=1e-12)
        assert landing(state, top, 0.999 * lasting, Start.REBOUND) is None

    @pytest.mark.parametrize("start", list(Start))
    def test_a_body_that_rests_touches_at_once(self, shape, spin, start):
        top, state = self.upright(shape, spin)
        assert landing(state, top, 1.0, start) == 0.0

    def test_a_body_below_the_table_touches_at_once(self, shape, spin):
        top, state = self.upright(shape, spin, up=-1e-9, rising=1.0)
        assert landing(state, top, 1.0) == 0.0


def lifting_off(shape, tilt_rate):
    """A body at lift-off: gravity is what makes the acceleration of its gap vanish."""
    top, state = tipping(shape, tilt_rate)
    with mp.workdps(DIGITS):
        exact = ExactGap(state, top, Start.LIFT_OFF)
        gravity = float(-2 * exact.support[2])
        jerk, snap = exact.derivative(3), exact.derivative(4)
    return top.altered(gravity=gravity), state, float(jerk), float(snap)


@pytest.mark.parametrize("tilt_rate", [1e-5, 1e-4, 1e-3, 1e-2, 1e-1])
@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize(
    "shape", [SHAPES["tippe top"], SHAPES["lentil"]], ids=["tippe top", "lentil"]
)
def test_a_short_hop_lasts_four_times_the_jerk_over_the_snap(shape, sign, tilt_rate):
    """The gap is J t^3/6 + S t^4/24 near lift-off; with J < 0 the table would have to be
    penetrated.
    """
    top, state, jerk, snap = lifting_off(shape, sign * tilt_rate)
    time = landing(state, top, 1.0, Start.LIFT_OFF)
    if jerk < 0.0:
        assert time == 0.0
    else:
        assert snap < 0.0
        assert time == pytest.approx(-4.0 * jerk / snap, rel=1e-3)
    assert (jerk < 0.0) != (lifting_off(shape, -sign * tilt_rate)[2] < 0.0)


# Touchdown: many digits
# --------------------------------------------------------------------------------


@pytest.mark.parametrize("tilt_rate", [0.3, 1.0, 3.0, 10.0, 30.0, 100.0])
@pytest.mark.parametrize(
    "shape", [SHAPES["tippe top"], SHAPES["lentil"]], ids=["tippe top", "lentil"]
)
def test_hops_of_all_lengths_after_lift_off(shape, tilt_rate):
    sign = 1.0 if lifting_off(shape, tilt_rate)[2] > 0.0 else -1.0
    top, state, _, _ = lifting_off(shape, sign * tilt_rate)
    assert check_landing(state, top, Start.LIFT_OFF, 1.0) > 0.0


@pytest.mark.parametrize("miss", [1e-3, 1e-6])
@pytest.mark.parametrize(
    "shape", [SHAPES["tippe top"], SHAPES["lentil"]], ids=["tippe top", "lentil"]
)
def test_a_rebound_that_just_clears_the_table_is_told_from_one_that_does_not(shape, miss):
    """Under a bit more weight than lift-off allows, the gap is v t - a t^2/2 + J t^3/6: it dips at
    3a/2J.
    """
    sign = 1.0 if lifting_off(shape, 10.0)[2] > 0.0 else -1.0
    top, state, jerk, _ = lifting_off(shape, sign * 10.0)
    soon = 0.05 * top.transverse_inertia / length(state.momentum)
    top = top.altered(gravity=top.gravity + jerk * soon / 1.5)
    with mp.workdps(DIGITS):
        still = ExactGap(state, top, Start.REBOUND)
        sinking = mp.diff(still.height, 0)
        still.parabola[1] = sinking
        dip = mp.findroot(lambda t: mp.diff(lambda s: still(s) / s, t), soon)
        needed = -still(dip) / dip
        assert needed > 0.0
        assert dip == pytest.approx(soon, rel=0.5)
        clears, touches = (float(sinking + (1 + m) * needed) for m in (miss, -miss))
    clear = state._replace(velocity=(0.0, 0.0, clears))
    touch = state._replace(velocity=(0.0, 0.0, touches))
    assert check_landing(touch, top, Start.REBOUND, 1.0) == pytest.approx(
        float(dip), rel=3.0 * miss**0.5
    )
    assert check_landing(clear, top, Start.REBOUND, 1.0) > 1.2 * dip


@st.composite
def lift_offs(draw):
    """A body at lift-off, from the gravity that this takes; most flights are short, some very
    short.
    """
    top = draw(tops(st.one_of(spheres(), spheroids())))
    unit = 1.0 / time_unit(top)
    tilt_rate = draw(st.sampled_from([-1.0, 1.0])) * 10.0 ** draw(numbers(-6.0, 0.7)) * unit
    tilt, precession, spin = (
        draw(numbers(0.05, 3.1)),
        draw(numbers(-8.0, 8.0)),
        draw(numbers(-15.0, 15.0)),
    )
    motion = Angles(tilt, tilt_rate, 0.3, precession * unit, spin * unit, (0.0, 0.0))
    state = on_table(state_from_angles(motion, top, math), top)
    with mp.workdps(DIGITS):
        gravity = float(-2 * ExactGap(state, top, Start.LIFT_OFF).support[2])
    assume(gravity > 1e-3 * top.gravity)
    return top.altered(gravity=gravity), state


@settings(max_examples=examples(check=15, claim=400))
@given(lift_offs())
def test_the_first_touch_after_lift_off(case):
    top, state = case
    check_landing(state, top, Start.LIFT_OFF, 30.0 * time_unit(top))


@settings(max_examples=examples(check=15, claim=400))
@given(flights())
def test_the_first_touch_after_a_throw(case):
    top, state = case
    assume(gap(state, top) > 0.0)
    assert landing(state, top, math.inf) is not None
    check_landing(state, top, Start.AIRBORNE, 30.0 * time_unit(top))


@settings(max_examples=examples(check=15, claim=400))
@given(flights(), numbers(-9.0, 1.0), st.sampled_from([Start.REBOUND, Start.RELEASE]))
def test_the_first_touch_after_a_rebound_or_a_release(case, magnitude, start):
    top, state = case
    at_rest = on_table(along_table(state), top)
    leap = 10.0**magnitude * speed_unit(top) if start == Start.REBOUND else 0.0
    leaping = at_rest._replace(velocity=(*at_rest.velocity[:2], at_rest.velocity[2] + leap))
    check_landing(leaping, top, start, 30.0 * time_unit(top))


@pytest.mark.parametrize("rising", [0.0, 0.05, 1.0, 5.0])
@pytest.mark.parametrize("shape", [*SHAPES.values(), Bead(0.02, 2.0)], ids=[*SHAPES, "bead"])
def test_hops_of_bodies_that_turn_many_times(shape, rising):
    top, state = tipping(shape, 30.0)
    state = state._replace(velocity=(0.0, 0.0, state.velocity[2] + rising))
    start = Start.REBOUND if rising else Start.RELEASE
    time = check_landing(state, top, start, math.inf if rising else 1.0)
    assert rising < 5.0 or rising / 9.8 < time < 3.0 * rising / 9.8


@pytest.mark.parametrize("shape", [*SHAPES.values(), Bead(0.02, 2.0)], ids=[*SHAPES, "bead"])
@pytest.mark.parametrize("miss", [1e-5, 1e-9, 1e-12])
def test_a_graze_is_told_from_a_miss(shape, miss):
    """A body thrown so that its gap has a minimum first: there it just touches the table, or just
    not.
    """
    top, state = tipping(shape, 100.0, precession=250.0)
    high = state._replace(height=state.height + shape.size, velocity=(0.0, 0.0, 0.3))
    looks = np.linspace(0.0, 0.2, 20001)
    gaps = gap(fly(high, looks, top, np), top)
    dips = [k for k in range(1, 20000) if gaps[k] < min(gaps[k - 1], gaps[k + 1])]
    k = next(k for k in dips if gaps[k] < min(gaps[:k]))
    with mp.workdps(DIGITS):
        exact = ExactGap(high, top, Start.AIRBORNE)
        dip = mp.findroot(
            lambda t: mp.diff(exact, t), (looks[k - 1], looks[k + 1]), solver="anderson"
        )
        lowest = float(exact(dip))
    for sign in (1, -1):
        low = high._replace(height=high.height - lowest + sign * miss * shape.size)
        time = check_landing(low, top, Start.AIRBORNE, 0.2)
        if sign < 0:
            assert time == pytest.approx(float(dip), abs=3.0 * math.sqrt(miss) / 30.0)
            assert time < dip
        else:
            assert time is None or time > float(dip) + 1e-4


@given(flights(), numbers(0.05, 3.0))
@example(tipping(SHAPES["egg"], 20.0), 1.0)
def test_the_horizon_hides_what_lies_beyond_it_and_nothing_else(case, part):
    top, state = case
    assume(gap(state, top) > 1e-6 * top.surface.size)
    time = landing(state, top, math.inf)
    assume(abs(part - 1.0) > 1e-9)
    seen = landing(state, top, part * time)
    assert (seen is None) == (part < 1.0)
    assert seen is None or seen == pytest.approx(time, rel=1e-9)


@given(slides(), numbers(-6.0, 0.5))
def test_no_look_at_a_hop_is_higher_than_its_highest_gap(slide, decades):
    """Flights of tops that are let go on the table, where gap and rate are zero at first, however
    short.
    """
    top, sliding = slide
    state = on_table(sliding, top)
    duration = 10.0**decades * math.sqrt(top.surface.size / top.gravity)
    touch = landing(state, top, duration, Start.RELEASE)
    assume(touch != 0.0)
    duration = duration if touch is None else touch
    highest = highest_gap(state, top, duration, Start.RELEASE)
    times = np.linspace(0.0, duration, 4001)
    gaps = gap(fly(state, times, top, np), top) + 0.0 * times
    fuzz = 1e-14 * (top.surface.size + abs(state.height) + duration * length(state.velocity))
    assert gaps.max() - fuzz <= highest
    bend = np.abs(np.diff(gaps, 2)).max()
    assert highest <= max(gaps.max(), 0.0) + bend + fuzz


# Through flat
# ------------------------------------------------------------------------------------------


@st.composite
def tumbling(draw):
    """Flights whose axis passes the poles, in any vertical plane; most pass one or several."""
    shape = draw(st.sampled_from([*EDGES.values(), *SHAPES.values()]))
    azimuth = draw(st.sampled_from([0.0, 0.3, -2.0]))
    rate = draw(st.sampled_from([-1.0, 1.0])) * draw(numbers(1.0, 200.0))
    return Tumbling(
        shape,
        draw(numbers(0.1, 3.0)),
        rate,
        draw(numbers(1e-3, 0.1)),
        draw(numbers(-1.0, 1.5)),
        azimuth,
    )


@settings(max_examples=examples(check=20, claim=600))
@given(tumbling())
@example(Tumbling(EDGES["edge"], 1.2, -40.0, 0.01, 0.5, 0.0))
@example(Tumbling(EDGES["edge of a face"], 1.0, 25.0, 0.01, 0.5, 0.3))
@example(Tumbling(EDGES["tube"], 2.0, -200.0, 0.1, 1.5, -2.0))
def test_a_body_that_tumbles_through_flat_lands_when_its_lowest_point_does(flight):
    top, state = flight.thrown
    touch = flight.landing
    sinking = (flight.gap(touch) - flight.gap(touch - 1e-7)) / 1e-7
    assume(
        touch > 1e-5
        and abs(sinking) > 1e-2
        and abs(math.sin(flight.tilt + flight.rate * touch)) > 1e-3
    )
    assert landing(state, top, math.inf) == pytest.approx(touch, rel=1e-9)
    assert landing(state, top, 0.999 * touch) is None
    assert highest_gap(state, top, touch) == pytest.approx(flight.highest, abs=3e-7)


@pytest.mark.parametrize("rise", [0.3, 0.8])
@pytest.mark.parametrize("shape", EDGES.values(), ids=EDGES)
def test_an_edge_that_rebounds_through_flat_lands_when_its_lowest_point_does(shape, rise):
    rate = -60.0
    sinking = rate * (reach(shape, 1.2 + 1e-6) - reach(shape, 1.2 - 1e-6)) / 2e-6
    flight = Tumbling(shape, 1.2, rate, 0.0, float(sinking) + rise, 0.0)
    top, state = flight.thrown
    assert 1.2 + rate * flight.landing < 0.0
    assert landing(state, top, math.inf, Start.REBOUND) == pytest.approx(flight.landing, rel=1e-9)


@pytest.mark.parametrize(
    ("miss", "shape"),
    among(list(product([1e-2, 1e-4, 1e-7, 1e-8, 1e-10, 1e-13], EDGES.values())), check=10),
)
def test_an_edge_that_almost_turns_through_flat_lands_as_the_rotation_of_its_axis_says(shape, miss):
    """The axis turns about a momentum off the horizontal by an angle: so near it comes to the
    pole.
    """
    top, state = Tumbling(shape, 1.2, -60.0, 0.02, 0.4, 0.0).thrown
    size = length(state.momentum)
    along = (0.0, -math.cos(miss), math.sin(miss))
    turned = state._replace(axis=(math.sin(1.2), 0.0, math.cos(1.2)), momentum=scale(size, along))

    def gap_at(time):
        # Rodrigues' formula, in the parts of the axis along the momentum and across it.
        angle = 60.0 * time
        axis, pole = np.array(turned.axis), np.array(along)
        n = axis * np.cos(angle) + np.cross(pole, axis) * np.sin(angle)
        n += pole * (pole @ axis) * (1.0 - np.cos(angle))
        height = shape.tube + shape.radius * np.hypot(n[0], n[1]) - shape.center * n[2]
        return turned.height + 0.4 * time - 4.9 * time**2 - height

    looks = np.linspace(1e-6, 0.3, 5_001)
    first = next(k for k, time in enumerate(looks) if gap_at(time) <= 0.0)
    expected = brentq(gap_at, looks[first - 1], looks[first], xtol=1e-16)
    assert 60.0 * expected > 1.3
    assert landing(turned, top, math.inf) == pytest.approx(expected, rel=1e-9)


def test_a_disk_that_falls_flat_all_the_way_lands_flat():
    top, state = Tumbling(EDGES["edge"], 1.2, 0.0, 0.02, 0.4, 0.0).thrown
    for axis in [(0.0, 0.0, 1.0), (1e-9, 0.0, 1.0), (0.0, -1e-7, -1.0)]:
        flat = state._replace(axis=axis, height=0.02, momentum=(0.0, 0.0, 1e-5))
        falls = (0.4 + math.sqrt(0.16 + 4 * 4.9 * 0.02)) / 9.8
        assert landing(flat, top, math.inf) == pytest.approx(falls, rel=1e-6)


# Many turns
# --------------------------------------------------------------------------------------------


@pytest.mark.parametrize("turns", [10.0, 300.0])
@pytest.mark.parametrize("shape", [*SHAPES.values(), *EDGES.values()], ids=[*SHAPES, *EDGES])
def test_flights_of_many_turns_end_at_their_first_touch(shape, turns):
    """It is within the first turn of the axis in which the centre of mass is low enough: there by
    looks.
    """
    top, state = Tumbling(shape, 1.2, 2.0 * math.pi * turns, 0.3, 4.0, 0.0).thrown
    spinning = state._replace(
        momentum=(state.momentum[0], state.momentum[1], 0.3 * state.momentum[1])
    )
    time = landing(spinning, top, math.inf)
    period = 2.0 * math.pi * top.transverse_inertia / length(spinning.momentum)
    gaps = gap(fly(spinning, np.linspace(time - 1.5 * period, time, 30_001)[:-1], top, np), top)
    # Of the phase, time has no more digits than this.
    lost = 3e-15 * turns * top.surface.size + 1e-14
    assert gaps.min() > -lost
    assert abs(gap(fly(spinning, time, top, math), top)) < lost
    summit = spinning.velocity[2] / top.gravity
    gaps = gap(fly(spinning, summit + np.linspace(-1.0, 1.0, 30_001) * period, top, np), top)
    highest = highest_gap(spinning, top, time)
    assert gaps.max() - lost <= highest <= gaps.max() + 3e-7 * top.surface.size + lost


def test_the_highest_gap_of_a_body_of_many_edges_is_over_the_face_that_is_cut_deepest():
    """In a step it passes four faces between its edges, over each of which the gap is highest; the
    first is cut deepest.
    """
    angles, radii = 1.0 + 0.11 * np.arange(5), 0.02 * np.array([0.998, 0.999, 1.0, 1.0, 1.0])
    edges = zip(radii * np.sin(angles), -radii * np.cos(angles), strict=True)
    body = Hull.of(tuple(RingSurface(radius, center) for radius, center in edges))
    flight, duration = Tumbling(body, 1.02, 300.0, 0.05, 0.0, 0.3), 0.4 / 300.0
    highest = flight.gap(np.linspace(0.0, duration, 40_001)).max()
    assert flight.gap(np.linspace(0.5 * duration, duration, 40_001)).max() < highest - 1e-5
    top, state = flight.thrown
    assert highest_gap(state, top, duration) == pytest.approx(highest, abs=1e-8)
