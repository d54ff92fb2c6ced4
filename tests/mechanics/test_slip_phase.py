"""Slip by collocation from its beginning to its end, against its clock and Runge and Kutta's
method.
"""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from dry_runs import launched
from tippetop.contact import slip_phase, slip_step
from tippetop.contact.automaton import Automaton
from tippetop.contact.contact_mode import STICKS
from tippetop.contact.mode import EventKind
from tippetop.contact.slip_onset import ENDED, SlipOnset
from tippetop.contact.slip_phase import LEAST, change_over, dips, parts_left
from tippetop.contact.trajectory import Trajectory
from tippetop.integrators import iteration, make_integrator
from tippetop.mechanics.contacts.gauss_points import PARTS, STAGES, gauss_points
from tippetop.mechanics.contacts.slip_clock import SlipComponent
from tippetop.mechanics.laws.coulomb import CoulombLaw
from tippetop.mechanics.motion import on_table, sliding_rates
from tippetop.mechanics.state import SlidingState
from tippetop.mechanics.surfaces.surface import SphereSurface, SpheroidSurface
from tippetop.mechanics.top import Top

LAUNCHES = {
    "sphere": (SphereSurface(1.0, 0.3), 0.2, 1.0, 2.2),
    "egg": (SpheroidSurface(1.0, 1.2), 0.05, 1.4, 1.5),
}
"""Surface, friction, tilt and spin of tops that stick and slip."""


def followed(name, end):
    """One of them: its segments and events."""
    shape, mu, tilt, spin = LAUNCHES[name]
    top = Top.of(1.0, 131 / 350, 2 / 5, shape, CoulombLaw(mu), 1.0)
    top, axis, momentum, velocity = launched(top, tilt, spin)
    start = on_table(SlidingState(axis, momentum, velocity), top)
    automaton = Automaton(top, "fly", 0.0)
    trajectory = Trajectory(automaton, automaton.launch(start), end, make_integrator())
    return list(trajectory.segments()), [(event.kind, event.time) for event in trajectory.events]


def told(events):
    return [kind for kind, _ in events], [time for _, time in events]


def test_the_points_are_those_of_gauss_and_integrate_what_they_should():
    points, _ = np.polynomial.legendre.leggauss(STAGES)
    made, places = gauss_points(STAGES), 0.5 + 0.5 * points
    for k in range(STAGES):
        integrals = np.array(made.integrals).T @ places**k
        assert integrals == pytest.approx(places ** (k + 1) / (k + 1), abs=3e-15)


@pytest.mark.parametrize("name", LAUNCHES)
def test_a_phase_solves_the_equations_of_sliding(name):
    """From places in it Runge and Kutta's method goes on with the same motion."""
    segments, _ = followed(name, 20.0)
    phases = [one for one in segments if isinstance(one.mode, SlipOnset)]
    assert max(one.steps for one in phases) > 1
    assert any(one.transition.next.status == STICKS for one in phases), "it is followed to its end"
    for segment in phases[:2]:
        top = segment.mode.top
        for begin, end in zip(segment.solution.knots[:-1], segment.solution.knots[1:], strict=True):
            times = begin + np.array([0.3, 0.6]) * (end - begin)
            states = [segment.mode.state(tuple(y)) for y in segment.solution(times)]
            first, last = ([*one.axis, *one.momentum, *one.velocity[:2]] for one in states)
            run = solve_ivp(
                lambda _, y, top=top: sliding_rates(SlidingState.unpack(y), top).pack(),
                times,
                first,
                method="DOP853",
                rtol=1e-11,
                atol=1e-13,
            )
            np.testing.assert_allclose(run.y[:, -1], last, rtol=0, atol=1e-10)


@pytest.mark.parametrize("name", LAUNCHES)
def test_a_first_step_and_the_clock_tell_the_same_of_it(name, monkeypatch):
    kinds, times = told(followed(name, 30.0)[1])
    assert kinds.count(EventKind.SLIP) > 1
    monkeypatch.setattr(SlipComponent, "recurs", lambda *_: False)
    others, seconds = told(followed(name, 30.0)[1])
    assert kinds == others
    assert times == pytest.approx(seconds, abs=1e-11)


def test_slip_is_followed_to_its_end_however_near_a_step_ends_before_it(monkeypatch):
    shortest = math.inf
    for length in np.linspace(0.4, 0.7, 31):
        monkeypatch.setattr(slip_phase, "FIRST_LENGTH", length)
        segments, _ = followed("sphere", 10.0)
        phases = [one for one in segments if isinstance(one.mode, SlipOnset)]
        assert len(phases) > 2
        assert {one.mode_end.cause for one in phases[:-1]} == {ENDED}
        for knots in [one.solution.knots for one in phases[:-1]]:
            shortest = min(shortest, knots[-1] - knots[-1 - PARTS])
    assert shortest < LEAST, "the last step is a short one at times"


def test_a_share_of_a_piece_is_the_same_polynomial():
    whole = np.random.default_rng(1).normal(size=(3, 3, STAGES))
    numbers = iteration.room(whole.size)
    iteration.put_from(numbers, 0, whole.ravel().tolist())
    np.testing.assert_array_equal(slip_step.pieces_of(numbers, 3, 2.0), whole[:2].ravel())
    pieces = slip_step.pieces_of(numbers, 3, 1.3)
    cut, powers = pieces.reshape(2, 3, STAGES), np.arange(1, STAGES + 1)
    np.testing.assert_array_equal(cut[0], whole[0])
    np.testing.assert_allclose(cut[1] @ 0.7**powers, whole[1] @ 0.21**powers, rtol=1e-14)
    change = whole[0].sum(axis=1) + whole[1] @ 0.3**powers
    np.testing.assert_allclose(change_over(pieces, 3), change, rtol=1e-14)


def test_the_end_of_a_polynomial_is_foreseen_and_a_dip_seen():
    # 2 - x, and (2 - x) (3 - x)
    assert parts_left([2.0, -1.0]) == pytest.approx(1.0)
    assert parts_left([6.0, -5.0, 1.0]) == pytest.approx(1.0)
    assert parts_left([1.0, 1.0]) == math.inf
    places = np.array(gauss_points(STAGES).places)
    for low, seen in ((0.5, False), (0.01, True)):
        assert dips((low + (places - 0.5) ** 2 * 4.0).tolist()) is seen
    assert not dips(places.tolist())
    assert not dips((1.0 - places).tolist())
