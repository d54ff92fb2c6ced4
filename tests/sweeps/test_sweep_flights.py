"""Flights and impacts of many tops against those of one, and against what must hold."""

import math
from itertools import product

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from campaigns import among, examples
from free_flight import fly, highest_gap, landing
from strategies import slides, spheres, spheroids, tops
from tippetop.contact.collision import collision
from tippetop.contact.flight import SIZE, Start
from tippetop.contact.impact import impact
from tippetop.mechanics.contacts.branches import on_other_branch
from tippetop.mechanics.flight.free_motion import gap_rate
from tippetop.mechanics.invariants import energy, jellett
from tippetop.mechanics.laws.contensou_hertz import HertzLaw
from tippetop.mechanics.laws.friction import ViscousLaw
from tippetop.mechanics.motion import along_table, on_table, sliding_contact
from tippetop.mechanics.state import State
from tippetop.mechanics.surfaces.surface import SphereSurface, SpheroidSurface
from tippetop.mechanics.top import Top, natural_state, natural_units
from tippetop.sweeps import polynomial_arcs
from tippetop.sweeps.axis_extremes import DOWN, UP, TipMotion
from tippetop.sweeps.flight_steps import GIVEN, LEFT, VANISHING, WANTED, flight_steps
from tippetop.sweeps.flights import fly_all, look_closer
from tippetop.sweeps.flights import slides as goes_on
from tippetop.sweeps.impacts import collide
from tippetop.sweeps.launch_arrays import branched, single
from tumbling import EDGES, Tumbling

VISCOUS = tops(friction_laws=(ViscousLaw,))


def many(state, count=2):
    return State.unpack([np.full(count, float(number)) for number in state.pack()])


def natural(top, sliding):
    kind, numbers = top.kind, tuple(float(n) for n in top.numbers)
    return kind, numbers, natural_state(on_table(sliding, top), natural_units(top))


def flown(kind, numbers, state, vanishing, horizon=50.0):
    column = np.repeat(np.array(numbers)[:, None], 2, axis=1)
    tip = TipMotion.of(2)
    here = np.arange(2)
    return fly_all(
        many(state),
        kind,
        column,
        np.full(2, horizon),
        np.full(2, vanishing),
        (tip, here, np.zeros(2)),
    ), tip


@pytest.mark.filterwarnings("ignore::RuntimeWarning")  # a sweep ignores what is no number
@settings(max_examples=examples(check=20, claim=600))
@given(slides(tops()), st.floats(0.01, 5.0), st.floats(-3.0, 3.0))
def test_a_throw_lands_when_a_single_one_does(slide, gap, rise):
    kind, numbers, state = natural(*slide)
    u, v, w = state.velocity
    state = state._replace(height=state.height + gap, velocity=(u, v, w + rise))
    top = kind.top(numbers)
    found, _ = flown(kind, numbers, state, 0)
    touch = landing(state, top, 50.0, Start.AIRBORNE)
    assert found.landed.all()
    assert found.duration[0] == found.duration[1]
    # A body that sinks in again at once touches at one of several times, which rounding tells
    # apart.
    last = fly(state, touch, top, math)
    assume(abs(gap_rate(last, top)) > 1e-4)
    assert found.duration[0] == pytest.approx(touch, rel=1e-10)


@pytest.mark.filterwarnings("ignore::RuntimeWarning")  # a sweep ignores what is no number
@settings(max_examples=examples(check=20, claim=600))
@given(slides(VISCOUS), st.floats(1e-4, 2.0))
def test_a_rebound_lands_when_a_single_one_does(slide, rise):
    kind, numbers, state = natural(*slide)
    u, v, w = state.velocity
    state = state._replace(velocity=(u, v, w + rise))
    found, _ = flown(kind, numbers, state, 1)
    touch = landing(state, kind.top(numbers), 50.0, Start.REBOUND)
    last = fly(state, touch, kind.top(numbers), math)
    assume(abs(gap_rate(last, kind.top(numbers))) > 1e-4)
    assert found.duration[0] == pytest.approx(touch, rel=1e-9)


@settings(max_examples=examples(check=20, claim=600))
@given(
    slides(tops(st.one_of(spheres(), spheroids()), (ViscousLaw,))),
    st.floats(0.01, 5.0),
    st.sampled_from([0.0, 0.3, 0.9, 1.0]),
)
def test_an_impact_is_the_single_one(slide, speed, elasticity):
    kind, numbers, state = natural(*slide)
    u, v, w = state.velocity
    state = state._replace(velocity=(u, v, w - speed))
    top = kind.top(numbers)
    restitution = np.full(2, elasticity)
    after, struck, rebounds, _ = collide(
        many(state), kind.top(tuple(np.full(2, n) for n in numbers)), restitution
    )
    one, bounces = collision(state, elasticity, top)
    assume(struck.all())
    assert rebounds.tolist() == [bounces, bounces]
    for ours, theirs in zip(after.pack()[:9], one.state.pack()[:9], strict=True):
        assert ours[0] == pytest.approx(theirs, rel=1e-12, abs=1e-12 * (1.0 + speed))
        assert ours[0] == ours[1]


@pytest.mark.parametrize("surface", [SphereSurface(1.0, 0.3), SpheroidSurface(1.0, 0.9, 0.2)])
def test_steps_of_flights_are_what_a_closer_look_finds_and_rarely_need_it(surface):
    random, count = np.random.default_rng(4), 3000
    kind = Top.of(1.0, 0.45, 0.38, surface, ViscousLaw(0.3), 1.0).kind
    numbers = np.repeat(
        np.array(Top.of(1.0, 0.45, 0.38, surface, ViscousLaw(0.3), 1.0).numbers)[:, None], count, 1
    )
    axis = random.normal(size=(3, count))
    axis /= np.linalg.norm(axis, axis=0)
    sliding = State(tuple(axis), tuple(3.0 * random.normal(size=(3, count))), (0.0, 0.0, 0.0), 0.0)
    state = on_table(along_table(sliding), kind.top(tuple(numbers)))
    # Thrown up, rebounding, let go, and lifted off with something that is left of the gap's
    # acceleration.
    vanishing = random.integers(0, 4, count).astype(float)
    rise = np.where(vanishing < 2, 0.2 * random.exponential(size=count), 0.0)
    thrown = state._replace(
        velocity=(*random.normal(size=(2, count)), state.velocity[2] + rise),
        height=state.height + np.where(vanishing == 0, random.exponential(size=count), 0.0),
    )
    given = np.empty((GIVEN, count))
    given[:SIZE], given[VANISHING] = np.array(np.broadcast_arrays(*thrown.pack())), vanishing
    given[LEFT] = 10.0 ** random.uniform(-3.0, 1.0, count)
    tip, lanes = TipMotion.of(count), np.arange(count)
    tip.turned[:] = 0.0
    given[WANTED] = tip.pauses(lanes)
    found, looked = (flight_steps(kind, given, numbers) for _ in range(2))
    look_closer(looked, lanes, kind, (given, numbers), (tip, lanes, np.zeros(count)))
    sure = found.doubt == 0.0
    assert sure[vanishing < 2].mean() > 0.9
    assert np.count_nonzero(found.touches[sure]) > 100
    assert np.array_equal(found.touches[sure], looked.touches[sure])
    for mine, theirs in (
        (found.span, looked.span),
        (found.highest_gap, looked.highest_gap),
        (found.highest, looked.highest),
        (found.floor, tip.least[DOWN]),
        (found.ceiling, -tip.least[UP]),
    ):
        np.testing.assert_allclose(mine[sure], theirs[sure], rtol=1e-11, atol=1e-14)


def test_slow_impacts_of_tops_that_slip_fast_need_no_closer_look(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The normal impulse is then a small part of what the contact point's velocity would give."""
    top = Top.of(1.0, 0.45, 0.38, SphereSurface(1.0, 0.3), ViscousLaw(0.3), 1.0)
    sinking = np.geomspace(1e-4, 1e-2, 20)
    resting = on_table(
        along_table(State((0.6, 0.0, 0.8), (1.0, 0.5, 3.0), (1.0, 0.5, 0.0), 0.0)), top
    )
    states = many(resting, len(sinking))
    u, v, w = states.velocity
    tops = top.kind.top(tuple(np.full(len(sinking), number) for number in top.numbers))
    monkeypatch.setattr(polynomial_arcs, "Polynomials", None)
    after = collide(states._replace(velocity=(u, v, w - sinking)), tops, np.full(len(sinking), 0.5))
    assert after.struck.all()
    for number, speed in enumerate(sinking):
        x, y, z = resting.velocity
        one, _ = collision(resting._replace(velocity=(x, y, z - speed)), 0.5, top)
        ours = [row[number] for row in np.broadcast_arrays(*after.state.pack())[:9]]
        assert ours == pytest.approx(one.state.pack()[:9], rel=1e-13, abs=1e-13)


def test_impacts_are_rarely_left_out():
    spheres_struck = []

    @settings(max_examples=examples(check=33, claim=1000), database=None)
    @given(slides(VISCOUS))
    def look(slide):
        kind, numbers, state = natural(*slide)
        u, v, w = state.velocity
        state = state._replace(velocity=(u, v, w - 0.5))
        spheres_struck.append(
            bool(
                collide(
                    many(state), kind.top(tuple(np.full(2, n) for n in numbers)), np.zeros(2)
                ).struck.all()
            )
        )

    look()
    assert np.mean(spheres_struck) > 0.9


@settings(max_examples=30)
@given(slides(tops(spheres(), (ViscousLaw,))))
def test_flights_and_impacts_keep_what_must_be_kept(slide):
    kind, numbers, state = natural(*slide)
    state = state._replace(height=state.height + 0.5)
    top = kind.top(numbers)
    found, tip = flown(kind, numbers, state, 0)
    size = 1.0 + abs(energy(state, top))
    assert energy(found.state, top)[0] == pytest.approx(energy(state, top), abs=1e-10 * size)
    assert found.highest[0] >= state.height - 1e-12
    _, down, up = tip.least[:, 0]
    assert down <= min(state.axis[2], found.state.axis[2][0]) + 1e-12
    assert -up >= max(state.axis[2], found.state.axis[2][0]) - 1e-12
    tops_of_two = kind.top(tuple(np.full(2, n) for n in numbers))
    after, struck, *_ = collide(found.state, tops_of_two, np.zeros(2))
    assume(struck.all())
    assert energy(after, top)[0] <= energy(found.state, top)[0] + 1e-10 * size
    before = jellett(found.state, top)[0]
    assert jellett(after, top)[0] == pytest.approx(before, abs=1e-10 * (1 + abs(before)))
    assert gap_rate(after, top)[0] == pytest.approx(0.0, abs=1e-9 * size)
    touch = sliding_contact(
        tuple(n[0] for n in after.axis),
        tuple(n[0] for n in after.momentum),
        [n[0] for n in after.velocity[:2]],
        top,
    )
    assert goes_on(after, top)[0] == (touch.delassus > 0 and touch.free_acceleration < 0)


def test_a_flight_that_outlasts_its_horizon_ends_there():
    @settings(max_examples=10, database=None)
    @given(slides(VISCOUS))
    def look(slide):
        kind, numbers, state = natural(*slide)
        state = state._replace(height=state.height + 50.0)
        found, _ = flown(kind, numbers, state, 0, 0.25)
        assert not found.landed.any()
        assert found.duration.tolist() == [0.25, 0.25]

    look()


def test_impacts_of_patches_go_on_where_another_branch_takes_over() -> None:
    """They are what they are alone, though the tops come on the branch that does not hold."""
    random, count = np.random.default_rng(3), 150
    axis = random.normal(size=(3, count))
    axis /= np.linalg.norm(axis, axis=0)
    law = HertzLaw(np.full(count, 0.3), random.uniform(0.02, 0.6, count))
    top = Top.of(1.0, 0.45, 0.38, SphereSurface(1.0, 0.3), law, 1.0)
    velocity, momentum = random.normal(size=(2, 3, count))
    momentum[:, :9] = 0.0  # without rotation, drilling's branch would mean infinite friction
    state = State(tuple(axis), tuple(momentum), tuple(velocity), 1.0 - 0.3 * axis[2])
    after, struck, *_ = collide(state, on_other_branch(branched(top, state)), np.zeros(count))
    changed = 0
    for i in np.flatnonzero(struck).tolist():
        mine = single(state, i)
        alone = top.altered(friction=HertzLaw(0.3, float(law.patch_radius[i])))
        hit = impact(mine, 0.0, alone)
        before, then = (float(branched(alone, one).friction.drills) for one in (mine, hit.state))
        changed += before != then
        assert single(after, i).momentum == pytest.approx(hit.state.momentum, abs=1e-13)
    assert changed > 10, "on many the other branch should take over"
    assert struck.sum() > 0.9 * np.sum(gap_rate(state, top) < 0.0)


@pytest.mark.parametrize(
    ("azimuth", "rate", "shape"),
    among(list(product([0.0, -2.0], [-25.0, 40.0, 200.0], EDGES.values())), check=7),
)
def test_edges_that_tumble_through_flat_land_when_their_lowest_point_does(shape, rate, azimuth):
    flight = Tumbling(shape, 1.0, rate, 0.01, 1.0, azimuth)
    top, thrown = flight.thrown
    units = natural_units(top)
    found, tip = flown(top.kind, top.numbers, natural_state(thrown, units), 0)
    assert abs(1.0 + rate * flight.landing - math.pi / 2) > math.pi / 2, "it is to pass flat"
    assert found.landed.all()
    assert found.duration[0] * units.time == pytest.approx(flight.landing, rel=1e-9)
    looks = np.linspace(0.0, flight.landing, 20_001)
    assert found.highest_gap[0] * units.length == pytest.approx(flight.highest, abs=3e-7)
    heights = np.cos(1.0 + rate * looks)
    assert tip.least[DOWN, 0] == pytest.approx(heights.min(), abs=1e-5)
    assert -tip.least[UP, 0] == pytest.approx(heights.max(), abs=1e-5)


@pytest.mark.parametrize(
    ("surface", "turns"),
    [
        (SphereSurface(1.0, 0.3), 3.0),
        (SphereSurface(1.0, 0.3), 30.0),
        (SpheroidSurface(1.0, 0.9, 0.2), 3.0),
        pytest.param(SpheroidSurface(1.0, 0.9, 0.2), 30.0, marks=pytest.mark.slow),
    ],
)
def test_flights_of_many_turns_are_those_of_single_launches(surface, turns):
    top = Top.of(1.0, 0.45, 0.38, surface, ViscousLaw(0.3), 1.0)
    swing = 2.0 * math.pi * turns * top.transverse_inertia
    for height, rise in ((3.0, 4.0), (40.0, 0.0), (3.0, 0.01)):
        state = State((0.6, 0.0, 0.8), (0.0, 0.9 * swing, 0.3 * swing), (0.1, 0.2, rise), height)
        found, tip = flown(top.kind, top.numbers, state, 0)
        touch = landing(state, top, 50.0)
        assert found.landed.all()
        assert found.duration[0] == pytest.approx(touch, rel=1e-10)
        assert found.highest_gap[0] == pytest.approx(
            highest_gap(state, top, touch), abs=1e-13 * (turns + 100.0)
        )
        for short in (0.4 * touch, 0.9 * touch):
            some, _ = flown(top.kind, top.numbers, state, 0, short)
            assert some.duration.tolist() == [short, short]
            assert some.highest_gap[0] == pytest.approx(
                highest_gap(state, top, short), abs=1e-13 * (turns + 100.0)
            )
        # The axis goes round the momentum: as near to the vertical as the two lean from each other.
        momentum, axis = math.atan2(0.9, 0.3), math.acos(0.3 * 0.8 / math.hypot(0.9, 0.3))
        assert -tip.least[UP, 0] == pytest.approx(math.cos(momentum - axis), abs=1e-12)
        assert tip.least[DOWN, 0] == pytest.approx(math.cos(momentum + axis), abs=1e-12)
