"""Painleve's paradox on two contacts: several sets of forces are consistent, or none is."""

from collections import Counter
from collections.abc import Iterator

import numpy as np
import pytest
from scipy.optimize import brentq

from independent_solver import cross
from tippetop.contact.automaton import Automaton, opens_by_zero
from tippetop.contact.closed_pair import Before
from tippetop.contact.contact_mode import ContactMode, sliding_on_two
from tippetop.contact.flight import Flight
from tippetop.contact.guards import OPENING, SLIP
from tippetop.contact.impact import begins_without_approach
from tippetop.contact.mode import EventKind, ModeEnd, Status, Transition
from tippetop.contact.trajectory import Trajectory
from tippetop.integrators import make_integrator
from tippetop.mechanics.contacts.branches import off_branch
from tippetop.mechanics.contacts.contact_point import ContactPoint
from tippetop.mechanics.contacts.pair import Tops
from tippetop.mechanics.contacts.wrench import Wrench
from tippetop.mechanics.invariants import energy
from tippetop.mechanics.laws.coulomb import CoulombLaw
from tippetop.mechanics.motion import along_table, on_table, sliding_contact
from tippetop.mechanics.state import SlidingState, State
from tippetop.mechanics.surfaces.hull import Hull
from tippetop.mechanics.surfaces.surface import SphereSurface
from tippetop.mechanics.top import Top, natural, natural_state, natural_units

SETS = {(True, True): "both", (True, False): "first", (False, True): "second", (False, False): ""}


def drawn(random: np.random.Generator) -> tuple[Tops, State] | None:
    """Two spheres of a slender body that slide on rough ground in a turn about the vertical."""
    (r1, r2), (z1, z2) = random.uniform(0.2, 1.0, 2), random.uniform(-1.0, 1.0, 2)
    if abs(r1 - r2) >= abs(z1 - z2):
        return None
    c = (r1 - r2) / (z1 - z2)
    if r1 - z1 * c <= 0.0:
        return None
    across = 10.0 ** random.uniform(-3.0, -0.3)
    along, mu = across * 10.0 ** random.uniform(-2.0, 0.25), 10.0 ** random.uniform(-1.0, 0.7)
    hull = Hull.of((SphereSurface(r1, z1), SphereSurface(r2, z2)))
    top = Top.of(1.0, across, along, hull, CoulombLaw(mu), 1.0)
    axis, (a, b) = np.array([(1.0 - c * c) ** 0.5, 0.0, c]), random.normal(size=2)
    turning = across * 10.0 ** random.uniform(-1.0, 1.5) * (a * axis + np.array([0.0, 0.0, b]))
    velocity = random.normal(size=2) * 10.0 ** random.uniform(-1.0, 1.0)
    start = SlidingState(tuple(axis.tolist()), tuple(turning.tolist()), tuple(velocity.tolist()))
    first, second = top.body.contacts
    return (first, second), on_table(start, first)


def draws(seed: int, count: int) -> Iterator[tuple[Tops, State]]:
    """Draw so often, and leave out what is no body on two spheres."""
    random = np.random.default_rng(seed)
    for _ in range(count):
        case = drawn(random)
        if case is not None:
            yield case


def acceleration(state: State, top: Top, force: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Second derivatives of the gaps of both surfaces, m/s^2, under a force and gravity, by
    differentiating z - r + zeta n_z twice.
    """
    n, L = np.array(state.axis), np.array(state.momentum)
    pull = force[2] / top.mass - top.gravity
    turned = cross(cross(at, force), n) + cross(L, cross(L, n)) / top.transverse_inertia
    return np.array(
        [
            pull + one.surface.slope(0.0) * -turned[2] / top.transverse_inertia
            for one in top.body.contacts
        ]
    )


def delassus(tops: Tops, state: State) -> np.ndarray:
    """Accelerations of both gaps per unit normal force of each contact, friction included."""
    columns, top = [], tops[0]
    n, L = np.array(state.axis), np.array(state.momentum)
    excess = (1.0 / top.axial_inertia - 1.0 / top.transverse_inertia) * (L @ n)
    omega = L / top.transverse_inertia + excess * n
    free = acceleration(state, top, np.zeros(3), np.zeros(3))
    for one in tops:
        slope, height = one.surface.slope(n[2]), one.surface.height(n[2])
        arm = -slope * (n - np.array([0.0, 0.0, n[2]])) - np.array([0.0, 0.0, height])
        slip = (np.array(state.velocity) + cross(omega, arm))[:2]
        force = np.array([*(-top.friction.mu * slip / np.hypot(*slip)), 1.0])
        columns.append(acceleration(state, top, force, arm) - free)
    return np.array(columns).T


def consistent_sets(tops: Tops, state: State) -> Counter[str]:
    """All sets of contacts with positive forces beside which no other gap closes."""
    free = acceleration(state, tops[0], np.zeros(3), np.zeros(3))
    matrix, sets = delassus(tops, state), Counter[str]()
    for closed, name in SETS.items():
        which, normal = np.flatnonzero(closed), np.zeros(2)
        normal[which] = np.linalg.solve(matrix[np.ix_(which, which)], -free[which])
        opening = (matrix @ normal + free)[~np.array(closed)]
        if np.all(normal[which] > 0.0) and np.all(opening >= 0.0):
            sets[name] += 1
    return sets


def resolved(tops: Tops, state: State, choice: str) -> Transition:
    """What follows on the two contacts."""
    return Automaton(tops[0], "fly", 0.0, choice).resolve_two(0.0, state, tops, Before(), 0.0)


def test_two_contacts_report_whether_their_forces_are_unique() -> None:
    """By an enumeration of its own: more sets than one are reported, none is an impact."""
    random, counts = np.random.default_rng(5), Counter[int]()
    while min(counts[0], counts[2]) < 6:
        case = drawn(random)
        if case is None:
            continue
        tops, state = case
        sets = consistent_sets(tops, state)
        if counts[min(len(sets), 2)] >= 12:
            continue
        counts[min(len(sets), 2)] += 1
        after = {choice: resolved(tops, state, choice) for choice in ("impact", "liftoff")}
        for following in after.values():
            kinds = [event.kind for event in following.events]
            single = len(sets) == 1 and sets.keys() <= {"first", "second"}
            if not single:  # One contact alone may be indeterminate by itself.
                assert (EventKind.INDETERMINATE in kinds) == (len(sets) > 1), (sets, kinds)
            if len(sets) != 1:
                assert following.next is not Status.FAILED or {"first", "second"} <= sets.keys()
                struck = EventKind.IMPACT in kinds
                assert struck or "" in sets or following.next is Status.FAILED
                if struck:
                    assert energy(following.state, tops[0]) < energy(state, tops[0])
        if "" in sets and len(sets) > 1:
            assert isinstance(after["liftoff"].next, Flight)
            assert after["liftoff"].state == state


def indeterminate(random: np.random.Generator) -> tuple[Tops, State]:
    """Draw two contacts that may let go, but need not."""
    while True:
        case = drawn(random)
        if case is not None:
            sets = consistent_sets(*case)
            if "" in sets and len(sets) > 1:
                return case


@pytest.mark.parametrize("choice", ["impact", "liftoff"])
def test_where_tops_cannot_fly_indeterminate_forces_end_the_run(choice: str) -> None:
    tops, state = indeterminate(np.random.default_rng(8))
    automaton = Automaton(tops[0], "stop", 0.0, choice)
    after = automaton.resolve_two(0.0, state, tops, Before(), 0.0)
    if choice == "liftoff":
        assert after.next is Status.LIFTED_OFF
    else:
        assert after.next is Status.FAILED
        assert "contact.indeterminate names needs contact.liftoff = fly" in after.detail


def grows_on_springs(matrix: np.ndarray, stiffness: tuple[float, float]) -> bool:
    """Whether two contacts on springs that only press can sink ever faster, in a fixed ratio.

    With depths w exp(t sqrt(rate)): a contact that sinks has -(A K w)_i = rate w_i, one that opens
    has w_j = 0 and (A K w)_j >= 0.
    """
    for i, j in ((0, 1), (1, 0)):
        if matrix[i, i] < 0.0 <= matrix[j, i]:
            return True
    rates, ways = np.linalg.eig(-matrix * np.array(stiffness))
    for rate, way in zip(rates, ways.T, strict=True):
        if np.isreal(rate) and rate.real > 0.0 and way.real.min() * way.real.max() > 0.0:
            return True
    return False


def test_what_begins_an_impact_without_approach_sinks_on_springs() -> None:
    """A contact that jams, and presses another that lifts it again, does not sink where that other
    is stiff: then both stay closed, or let go.
    """
    random, counts = np.random.default_rng(4), Counter[str]()
    while min(counts["lifted"], counts["both jam"], counts["struck"]) < 2:
        case = drawn(random)
        if case is None:
            continue
        tops, state = case
        matrix = delassus(tops, state)
        lifts = [
            matrix[i, i] < 0.0 and matrix[j, i] < 0.0 < matrix[j, j] and np.linalg.det(matrix) > 0.0
            for i, j in ((0, 1), (1, 0))
        ]
        begins = [
            begins_without_approach(on_table(along_table(state), one), one, other)
            for one, other in (tops, tops[::-1])
        ]
        if any(lifts):
            counts["lifted"] += 1
            assert not any(begins)
            stiff = (1.0, 1e9) if lifts[0] else (1e9, 1.0)
            assert not grows_on_springs(matrix, stiff)
        elif matrix[0, 0] < 0.0 and matrix[1, 1] < 0.0:
            counts["both jam"] += 1
            assert any(begins)
        if any(begins):
            counts["struck"] += 1
            stiff = (1.0, 1e9) if begins[0] else (1e9, 1.0)
            assert grows_on_springs(matrix, stiff)


def test_both_stay_closed_where_one_jams_and_the_other_lifts_it() -> None:
    """Its forces are the other possibility beside lift-off, and nothing is struck."""
    random, count = np.random.default_rng(1), 0
    while count < 1:
        case = drawn(random)
        if case is None:
            continue
        tops, state = case
        if np.linalg.det(matrix := delassus(tops, state)) < 0.0 or matrix.diagonal().min() > 0.0:
            continue
        sets = consistent_sets(tops, state)
        if len(sets) == 3 and {"", "both"} <= sets.keys():
            count += 1
            after = resolved(tops, state, "impact")
            assert [event.kind for event in after.events] == [EventKind.INDETERMINATE]
            assert isinstance(after.next, ContactMode)
            assert not after.next.is_single


def test_a_normal_force_of_two_falls_by_zero_or_by_infinity() -> None:
    """It is zero where weight alone does not press the contact, and has no bound where the
    determinant of the Delassus matrix is zero.
    """
    random, counts = np.random.default_rng(2), Counter[bool]()

    def mode(gravity: float, mu: float, tops: Tops, state: State) -> ContactMode:
        law = CoulombLaw(mu)
        return sliding_on_two(
            state, tuple(one.altered(gravity=gravity, friction=law) for one in tops), 0.0
        )

    while min(counts[True], counts[False]) < 3:
        case = drawn(random)
        if case is None:
            continue
        state = case[1]

        def normal(gravity: float, case: tuple[Tops, State] = case) -> float:
            one = mode(gravity, 0.1, *case)
            return float(one.contacts(one.numbers(case[1])).normal(0))

        def determinant(mu: float, case: tuple[Tops, State] = case) -> float:
            tops = tuple(one.altered(friction=CoulombLaw(mu)) for one in case[0])
            return float(np.linalg.det(delassus(tops, case[1])))

        ends = []
        if normal(0.01) * normal(100.0) < 0.0:
            ends.append((True, mode(brentq(normal, 0.01, 100.0) * (1.0 + 1e-9), 0.1, *case)))
        if determinant(0.0) * determinant(10.0) < 0.0:
            ends.append((False, mode(1.0, brentq(determinant, 0.0, 10.0) * (1.0 + 1e-9), *case)))
        for by_zero, one in ends:
            counts[by_zero] += 1
            end = ModeEnd(OPENING, state, 0)
            assert opens_by_zero(one, end, one.top) == by_zero


def test_two_contacts_that_let_go_lift_off_though_friction_would_jam_one_alone() -> None:
    """Without forces both gaps open, and the first contact alone would close the second."""
    seen = 0
    for smoother, state in draws(9, 2000):
        tops = tuple(one.altered(friction=CoulombLaw(8.0)) for one in smoother)
        touch = sliding_contact(*along_table(state), tops[0])
        alone = consistent_sets(tops, state).keys() == {""}
        if not (alone and touch.delassus < 0.0 < touch.free_acceleration):
            continue
        seen += 1
        after = resolved(tops, state, "impact")
        assert isinstance(after.next, Flight)
        assert after.state == state
        assert [event.kind for event in after.events] == [EventKind.LIFT_OFF]
    assert seen


def test_a_contact_that_friction_alone_holds_closed_opens_at_the_limit_of_friction() -> None:
    """It would open without a force; slip would begin against itself, as A < 0 along it."""
    seen = 0
    for others, start in draws(1, 400):
        tops = tuple(one.altered(friction=CoulombLaw(4.0)) for one in others)
        if consistent_sets(tops, start):
            continue
        top, state = natural(tops[0]), natural_state(start, natural_units(tops[0]))
        automaton = Automaton(top, "fly", 0.0)
        run = Trajectory(automaton, automaton.launch(state), 0.2, make_integrator("taylor"))
        for segment in run.segments():
            mode, end = segment.mode, segment.mode_end
            if not (isinstance(mode, ContactMode) and end.cause == SLIP and mode.is_single):
                continue
            contact, state = off_branch(mode.top), end.state
            force = np.array(mode.contacts(mode.numbers(state)).forces.wrenches[0].force)
            level = np.hypot(*force[:2])
            assert level == pytest.approx(4.0 * force[2], rel=1e-9)
            along = ContactPoint.of(state.axis, state.momentum, contact).response(
                Wrench(tuple(force / force[2]), (0.0, 0.0, 0.0))
            )
            free = ContactPoint.of(state.axis, state.momentum, contact).free.point[2]
            assert (along.point[2] < 0.0) == (free > 0.0)
            if free > 0.0:
                seen += 1
                after = automaton.follow(mode, end, 0.0)
                assert isinstance(after.next, Flight)
                assert after.state == state
        if seen >= 2:
            break
    assert seen >= 2
