"""The page's method takes SciPy's steps, on every motion."""

import itertools
import math

import numpy as np
import pytest
from exact_motions import KEPLER, whole
from page_method import PageMethod

import tippetop as tt
from every_motion import CASES, states
from tippetop.integrators import Guard, Motion, dormand_prince, make_integrator, stepping
from tippetop.problem.presets import report_problem

TOLERANCE = 1e-9


def both(motion, parameters, start, end):
    """The same by SciPy's method and by the page's."""
    return (
        whole(one.integrate(motion, parameters, (0.0, start), end))
        for one in (make_integrator("dop853", TOLERANCE), PageMethod(TOLERANCE))
    )


def test_its_steps_are_those_of_scipys_method():
    scipys, own = both(KEPLER.motion, KEPLER.parameters, KEPLER.start[1], KEPLER.end)
    assert own.steps == scipys.steps
    assert abs(own.evaluations - scipys.evaluations) <= 2
    # The error of a step is known to few digits, and its eighth root makes the next.
    np.testing.assert_allclose(own.solution.knots, scipys.solution.knots, rtol=1e-7)
    np.testing.assert_allclose(own.solution.terms, scipys.solution.terms, rtol=0, atol=1e-6)


@pytest.mark.parametrize(
    "name",
    [
        "hull coulomb and rolling sliding",
        "spheroid ellipsoidal sticking",
        pytest.param("hull viscous two", marks=pytest.mark.campaign),  # a minute to compile
    ],
)
def test_motions_of_tops_end_where_scipys_do(name):
    case = next(case for case in CASES if case.name.startswith(name))
    for start in states(case.motion, 3):
        scipys, own = both(case.motion, case.parameters, start, 2.0)
        assert (own.guard, own.failure is None) == (scipys.guard, scipys.failure is None)
        assert own.solution.end == pytest.approx(scipys.solution.end, rel=1e-7)
        if own.failure is None:
            np.testing.assert_allclose(own.end_state, scipys.end_state, rtol=0, atol=1e-6)


def test_rounding_does_not_gather():
    """A hundred times around."""
    motion = Motion(lambda y, p: (y[1], -p[0] * y[0]), size=2, parameters=1)
    arc = whole(PageMethod(3e-14).integrate(motion, (1.0,), (0.0, np.array([1.0, 0.0])), 600.0))
    assert abs(math.hypot(*arc.end_state) - 1.0) < 1e-11
    assert arc.steps > 500


def pendulums(count):
    """Pendulums of frequencies 1, 2, 3 that know nothing of each other, each with a level and its
    guard.
    """

    def rates(y, p):
        return [*y[count:], *(-((1.0 + i) ** 2) * y[i] for i in range(count))]

    def guard(i):
        return Guard(f"{i} below its level", lambda y, p: y[i] - p[i])

    return Motion(rates, size=2 * count, parameters=count, guards=tuple(map(guard, range(count))))


@pytest.mark.parametrize("count", [1, 5])
def test_states_of_any_size_and_every_one_of_several_guards(count):
    """Numbers fill a row, or a part, or more than one, and levels are passed at every part of a
    step.
    """
    motion, frequencies = pendulums(count), 1.0 + np.arange(count)
    for last, side, level in itertools.product(range(count), (1.0, -1.0), (-0.9, 0.4)):
        levels = np.where(np.arange(count) == last, level, -1.5)
        start = np.repeat([side, 0.0], count)
        arc = whole(PageMethod().integrate(motion, levels, (0.0, start), 9.0))
        # What begins below its level has to rise above it first.
        phase = math.acos(level) if side > level else 2.0 * math.pi - math.acos(-level)
        assert arc.guard == motion.guards[last].name
        assert arc.solution.end == pytest.approx(phase / frequencies[last], rel=1e-11)
        angles = frequencies * arc.solution.end
        exact = side * np.concatenate([np.cos(angles), -frequencies * np.sin(angles)])
        np.testing.assert_allclose(arc.end_state, exact, rtol=0, atol=1e-10)
        for part in (0.4, 0.99):
            at = arc.solution(np.array([part * arc.solution.end]))[0]
            np.testing.assert_allclose(at[:count], side * np.cos(part * angles), rtol=0, atol=1e-9)


@pytest.mark.parametrize("count", [1, 4, 5])
def test_no_fall_is_looked_for_where_every_guard_is_far_from_zero(count, monkeypatch):
    def refused(*given):
        raise AssertionError("no guard comes near zero")

    monkeypatch.setattr(stepping, "first_fall", refused)
    motion, levels = pendulums(count), [-30.0 * 100.0**i for i in range(count)]
    start = np.repeat([1.0, 0.0], count)
    arc = whole(PageMethod().integrate(motion, levels, (0.0, start), 9.0))
    assert arc.guard is None
    assert arc.solution.end == 9.0


@pytest.mark.parametrize("rise", [1e-3, 1e-6])
def test_a_hop_far_shorter_than_a_step_ends_where_it_lands(rise):
    """A guard that starts at zero, rises and is back before any look: thrown up, it falls as
    long.
    """
    guards = (Guard("landing", lambda y, p: y[0]),)
    # The first step is chosen by the largest number.
    motion = Motion(lambda y, p: (y[1], -p[0], 0.0 * y[2]), size=3, parameters=1, guards=guards)
    _, own = both(motion, (1.0,), np.array([0.0, rise, 1.0]), 50.0)
    assert own.guard == "landing"
    assert own.solution.end == pytest.approx(2.0 * rise, rel=1e-9)


def dipping(part):
    return 1.0 + 0.3 * part - 3.0 * math.exp(-(((part - 0.375) / 0.05) ** 2))


LOOKED_AT = {
    "hardly varies": (lambda part: 1.0 + 0.24 * part, 1e-8, 2, False),
    "varies by a quarter": (lambda part: 1.0 + 0.25 * part, 1e-8, 8, False),
    "dips": (dipping, 1e-8, 8, True),
    "dips where steps are long": (lambda part: math.cos(4.0 * math.pi * part), 1e-3, 8, True),
    "is no number in the middle": (lambda part: math.nan if part == 0.5 else 1.0, 1e-8, 8, False),
    "is no number at the end": (lambda part: math.nan if part == 1.0 else 1.0, 1e-8, 8, False),
    "is negative": (lambda part: -1.0, 1e-8, 8 + 37, False),
    "is infinite": (lambda part: math.inf, 1e-8, 8, False),
    "falls to zero": (lambda part: 1.0 - part, 1e-8, 8, True),
}
"""Guards along a step, a tolerance, in how many places they are looked at, and whether they may
fall.
"""


@pytest.mark.parametrize("name", LOOKED_AT)
def test_a_guard_is_looked_at_closely_unless_it_hardly_varies(name):
    along, tolerance, most, may_fall = LOOKED_AT[name]
    looks = []

    def guards(y, p, out):
        looks.append(y[0])
        out[0] = along(y[0])

    terms = np.zeros(dormand_prince.POWERS)
    values = np.zeros((dormand_prince.GUARD_INTERVALS + 2, 1))
    terms[1], values[0] = 1.0, along(0.0)
    room, tight = np.zeros(0), tolerance <= dormand_prince.TIGHT
    end, place = np.ones(1), np.zeros(1)
    assert dormand_prince.suspect(guards, (), terms, 0, end, place, values, room, tight) == may_fall
    assert len(looks) == most
    assert len(set(looks)) == most


def test_a_trial_is_a_single_step(monkeypatch):
    """It is no longer than one that was taken, so that it needs no search for how long the first
    may be.
    """
    landed, trials = stepping.Stepping.landed, []

    def seen(other, time, state, end):
        before = other.calls
        found = landed(other, time, state, end)
        trials.append(other.calls - before)
        return found

    monkeypatch.setattr(stepping.Stepping, "landed", seen)
    problem = report_problem(175.0).replace({"contact.liftoff": "fly"})
    run = tt.simulate(problem, 8.0, samples=2, integrator=PageMethod(1e-8))
    assert run.sizes["event"] > 10
    assert len(trials) > 20
    assert set(trials) == {2 + 12 + 3}, (
        "rates for the first step, of one try at its stages, and for its polynomials"
    )


def test_the_reports_run_is_that_of_the_other_integrators():
    own, scipys = (
        tt.simulate(report_problem(), 0.3, samples=21, integrator=one)
        for one in (PageMethod(), "dop853")
    )
    np.testing.assert_allclose(own.tilt, scipys.tilt, rtol=0, atol=1e-9)


@pytest.mark.parametrize("name", ["page", "taylor", "collocation", "dop853"])
@pytest.mark.parametrize("kind", [tuple, np.array])
def test_whole_numbers_are_numbers(name, kind):
    """A motion of a user's own may be given parameters, and a start, in integers."""
    touches = Guard("touches", lambda y, p: y[0] + p[1])
    motion = Motion(
        lambda y, p: (y[1], -p[0] + 0.0 * y[0]), size=2, parameters=2, guards=(touches,)
    )
    method = PageMethod() if name == "page" else make_integrator(name)
    *_, arc = method.integrate(motion, kind([2, 0]), (0, np.array([4, 0])), 7)
    assert arc.guard == "touches"
    assert arc.solution.end == pytest.approx(2.0, rel=1e-12)
    assert arc.end_state == pytest.approx([0.0, -4.0], abs=1e-11)


@pytest.mark.parametrize("tight", [False, True])
def test_a_guard_that_is_negative_in_the_state_at_the_end_may_fall(tight):
    """The polynomials of the step end beside that state, by rounding."""

    def guards(y, p, out):
        out[0] = y[0]

    terms = np.zeros(dormand_prince.POWERS)
    values = np.zeros((dormand_prince.GUARD_INTERVALS + 2, 1))
    terms[0] = values[0] = 1e-17
    for end, falls in ((1e-17, False), (-1e-17, True)):
        state, place, room = np.array([end]), np.zeros(1), np.zeros(0)
        assert (
            dormand_prince.suspect(guards, (), terms, 0, state, place, values, room, tight) == falls
        )
