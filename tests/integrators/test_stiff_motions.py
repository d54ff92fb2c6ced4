"""Stiff motions: the implicit method of high order, and where it relieves the explicit one."""

import math
import re

import numpy as np
import pytest
from exact_motions import whole

import tippetop as tt
from tippetop.integrators import Motion, make_integrator
from tippetop.integrators.base import Guard
from tippetop.integrators.collocation import STAGES, Collocation, Step, solved
from tippetop.integrators.rates import RightHandSide
from tippetop.integrators.relief import STEPS_PER_ARC, Relieved, is_stiff


def following(y, numbers):
    """A number that is damped towards a coordinate of a point on a circle (Prothero and Robinson
    1974).
    """
    followed, x, z = y
    return (-numbers[0] * (followed - x) - z, -z, x)


FOLLOWING = Motion(following, 3, 1)
START = 0.0, np.array([1.0, 1.0, 0.0])


def exact(times):
    return np.stack([np.cos(times), np.cos(times), np.sin(times)], axis=1)


@pytest.mark.parametrize("damping", [1e3, 1e6, 1e9])
def test_damping_neither_costs_steps_nor_digits(damping):
    arc = whole(make_integrator("collocation").integrate(FOLLOWING, (damping,), START, 20.0))
    times = np.linspace(0.0, 20.0, 1001)
    assert arc.failure is None
    assert arc.steps < 200
    assert np.abs(arc.solution(times) - exact(times)).max() < 1e-12


def test_rounding_that_no_shorter_step_lessens_costs_no_steps():
    """What drives the motion is known to 14 digits, as slip is that is a difference of
    velocities.
    """

    def rounded(y, numbers):
        followed, x, z = y
        apart = ((followed + numbers[1]) - (x + 0.7 * numbers[1])) - 0.3 * numbers[1]
        return (-numbers[0] * apart - z, -z, x)

    arc = whole(Collocation().integrate(Motion(rounded, 3, 2), (1e6, 256.0), START, 20.0))
    times = np.linspace(0.0, 20.0, 1001)
    assert arc.failure is None
    assert arc.steps < 200
    assert np.abs(arc.solution(times) - exact(times)).max() < 1e-12


@pytest.mark.parametrize("rate", [-1.0, -1.0 + 5.0j, 3.0j])
def test_a_step_is_the_approximation_of_pade_that_vanishes_far_left(rate):
    """For y' = rate y a step of Radau's method is Pade's (s - 1, s), of order 2 s - 1 (Ehle
    1969).
    """
    s = STAGES

    def stepped(span):
        def turning(y, _):
            return (rate.real * y[0] - rate.imag * y[1], rate.imag * y[0] + rate.real * y[1])

        rates = RightHandSide(Motion(turning, 2, 0), ())
        end = solved(rates, np.array([1.0, 0.0]), span, np.tile([1.0, 0.0], (s, 1)))[-1]
        return complex(*end)

    def pade(z):
        above = below = term = other = 1.0
        for k in range(1, s + 1):
            term = term * (s - k) / (2 * s - k) * z / k
            other = other * (s + 1 - k) / (2 * s - k) * -z / k
            above, below = above + term, below + other
        return above / below

    for span in (0.5, 20.0, 300.0):
        assert stepped(span) == pytest.approx(pade(rate * span), abs=1e-11)
    if rate.real:
        assert abs(stepped(1e6)) < 1e-4


def test_a_guard_within_a_long_step_is_found_to_rounding():
    """Steps of the solution are longer than what the guard takes to fall and rise again."""
    dip = Guard("dip", lambda y, _: y[1] + 0.9)
    arc = whole(
        make_integrator("collocation").integrate(
            Motion(following, 3, 1, guards=(dip,)), (1e6,), START, 20.0
        )
    )
    assert arc.guard == "dip"
    assert arc.solution.end == pytest.approx(np.arccos(-0.9), abs=1e-13)
    assert arc.end_state == pytest.approx(exact(np.array([arc.solution.end]))[0], abs=1e-13)


def test_a_step_that_does_not_settle_is_not_taken():
    """A solution that ends in a pole is followed up to it, and no further."""
    pole = Motion(lambda y, _: (y[0] * y[0],), 1, 0)
    arc = whole(Collocation().integrate(pole, (), (0.0, np.array([1.0])), 2.0))
    assert arc.failure is not None
    assert 0.999 < arc.solution.end < 1.0
    assert arc.solution(np.array([0.99]))[0, 0] == pytest.approx(100.0, rel=1e-9)


class Recorded:
    """An explicit method that says how often it was asked."""

    def __init__(self):
        self.method, self.asked = make_integrator("taylor"), []

    name, caution = "recorded", ""
    tolerance = 2.3e-16

    def integrate(self, motion, parameters, start, end):
        self.asked.append(start[0])
        return self.method.integrate(motion, parameters, start, end)


def test_the_explicit_method_follows_what_is_not_stiff_however_fast():
    quick = Motion(lambda y, n: (n[0] * y[1], -n[0] * y[0]), 2, 1)
    explicit = Recorded()
    arcs = list(Relieved(explicit).integrate(quick, (1e4,), (0.0, np.array([1.0, 0.0])), 2.0))
    assert sum(arc.steps for arc in arcs) > 2 * STEPS_PER_ARC
    assert [arc.method for arc in arcs] == [None] * len(arcs)
    assert explicit.asked == [0.0]
    assert arcs[-1].end_state == pytest.approx([np.cos(2e4), -np.sin(2e4)], abs=1e-9)


def test_the_implicit_method_relieves_what_is_stiff_and_not_the_rest():
    """Van der Pol's oscillator creeps, stiffly, and leaps, within 1e-5 of the time."""

    def oscillator(y, numbers):
        return (y[1], ((1.0 - y[0] * y[0]) * y[1] - y[0]) * numbers[0])

    explicit, start = Recorded(), (0.0, np.array([2.0, -2.0 / 3.0]))
    motion = Motion(oscillator, 2, 1)
    arcs = list(Relieved(explicit).integrate(motion, (1e5,), start, 2.0))
    assert {None if arc.method is None else arc.method.name for arc in arcs} == {
        None,
        "collocation",
    }
    assert len(explicit.asked) > 2
    found = whole(arcs)
    assert found.failure is None
    # By Taylor's method alone it would be 300,000.
    assert found.steps < 10 * STEPS_PER_ARC
    alone = whole(Collocation(1e-12).integrate(motion, (1e5,), start, 2.0))
    assert found.end_state == pytest.approx(alone.end_state, abs=1e-8)


@pytest.mark.filterwarnings("ignore:Conversion of an array:DeprecationWarning")  # NumPy before 2.4
def test_a_law_that_takes_no_complex_numbers_is_left_to_the_explicit_method():
    """Derivatives are taken along imaginary steps."""
    motion = Motion(lambda y, _: (-1e6 * math.sin(y[0]),), 1, 0)
    assert not is_stiff(motion, (), np.ones((1, 1)), np.ones(1))[0]
    assert np.isnan(RightHandSide(motion, ()).linearized(np.ones((1, 1)))[0]).all()


def test_a_root_of_a_negative_number_is_no_rate():
    motion = Motion(lambda y, p: (y[0] ** -0.5, 1.0), 2, 0)
    assert RightHandSide(motion, ())(0.0, np.array([4.0, 0.0])).tolist() == [0.5, 1.0]
    found = RightHandSide(motion, ())(0.0, np.array([-4.0, 0.0]))
    assert found.dtype == float
    assert np.isnan(found).all()


def test_the_best_method_is_relieved_and_one_by_name_is_not():
    assert make_integrator() == Relieved(make_integrator("taylor"))


def test_what_polynomials_say_beyond_a_step_is_what_they_say_within_it():
    terms = np.zeros((STAGES + 1, 1))
    terms[:3, 0] = 1.0, 0.5, 0.25
    step = Step(1.0, 3.0, terms, np.array([1.75]))
    assert step.beyond(np.array([3.0, 5.0])).ravel().tolist() == [
        step(3.0)[0],
        1.0 + 1.5 + 0.25 * 17.0,
    ]


def stiff(mu, **changes):
    """The report's top on a table of so much viscous friction, which lets it hardly slip."""
    return tt.presets.report_problem(spin=155.0, mu=mu).replace(changes)


@pytest.fixture(scope="module")
def rolling():
    """The same top under dry friction that it never overcomes: it rolls."""
    problem = stiff(0.3, friction=tt.CoulombFriction(mu=50.0))
    run = tt.simulate(problem, 1.0, samples=101)
    assert set(run["mode"].values.tolist()) == {"sticking"}
    return run


@pytest.mark.parametrize("mu", [1e6])
def test_strong_friction_ends_within_the_budget_and_is_nearly_rolling(mu, rolling):
    run = tt.simulate(stiff(mu), 1.0, samples=101)
    assert run.attrs["status"] == "completed"
    assert run.attrs["integrator"] == "taylor, collocation"
    assert run.attrs["tolerance"] == Collocation().tolerance
    assert run["steps"].item() < 2 * STEPS_PER_ARC
    assert run["energy_error"].item() < 1e-12
    assert run["jellett_drift"].item() < 1e-12
    # Creep takes the top from where it would be if it rolled, in proportion to 1 / mu.
    twice = tt.simulate(stiff(2.0 * mu), 1.0, samples=101)
    away = (run["tilt"] - rolling["tilt"]).values
    assert 0.0 < np.abs(away).max() < 1.0 / mu
    assert (twice["tilt"] - rolling["tilt"]).values == pytest.approx(away / 2.0, abs=1e-3 / mu)


def test_strong_friction_is_the_same_by_taylor_alone():
    problem = stiff(1e4)
    alone = tt.simulate(problem, 0.5, samples=101, integrator="taylor")
    usual = tt.simulate(problem, 0.5, samples=101)
    assert alone.attrs["integrator"] == "taylor"
    assert alone["steps"].item() > 2 * usual["steps"].item()
    for name in ("tilt", "spin", "slip_x", "x", "work", "normal_force"):
        size = np.abs(alone[name].values).max()
        assert usual[name].values == pytest.approx(alone[name].values, abs=1e-10 * size), name


def test_drilling_that_dies_on_a_small_patch_is_followed():
    friction = tt.ContensouFriction(mu=0.3, patch_radius=1e-7, pressure="ellipsoidal")
    problem = tt.presets.report_problem(tilt=0.3, spin=20.0).replace({"friction": friction})
    run = tt.simulate(problem, 1.0, samples=101)
    assert run.attrs["status"] == "completed"
    assert run["steps"].item() < 4 * STEPS_PER_ARC
    assert run["energy_error"].item() < 1e-12
    # It loses little by drilling, and creeps little: nearly a top that rolls.
    rolls = tt.simulate(problem.replace({"friction": tt.CoulombFriction(mu=0.3)}), 1.0, samples=101)
    assert run["tilt"].values == pytest.approx(rolls["tilt"].values, abs=1e-3)


def test_a_run_of_too_many_steps_names_the_time_in_which_friction_damps_slip():
    """Slip of a top whose axis is steep changes by f (1 / m + h^2 / I1) under a friction force
    f.
    """
    problem, mu = stiff(1e4), 1e4
    run = tt.simulate(problem, 1.0, samples=2, integrator="taylor", step_limit=1000)
    assert run.attrs["status"] == "too_many_steps"
    named = re.search("friction damps slip within ([^ ]*) s", run.attrs["message"])
    body = problem.body
    height = problem.start().height
    rate = mu * problem.gravity * (1.0 + body.mass * height**2 / body.I1)
    assert float(named[1]) == pytest.approx(1.0 / rate, rel=0.05)


LYING = tt.Problem(
    body=tt.Body(mass=0.02, shape=tt.Ring(radius=0.04, center=-0.005), I1=1e-5, I3=1.6e-5),
    friction=tt.CoulombFriction(mu=0.3),
    launch=tt.Launch(tilt=0.0, spin=20.0, slip=(0.4, 0.2)),
)

NOT_STIFF = {
    "a top that spins fast": (stiff(0.3, **{"launch.spin": 1e5}), {"step_limit": 1000}),
    "a disk on its face": (LYING, {"step_limit": 5}),
    "implicit steps": (stiff(1e4), {"step_limit": 20, "integrator": "collocation"}),
}


@pytest.mark.parametrize(("problem", "limits"), NOT_STIFF.values(), ids=NOT_STIFF)
def test_a_run_whose_steps_damping_does_not_bound_names_none(problem, limits):
    run = tt.simulate(problem, 3.0, samples=2, **limits)
    assert run.attrs["status"] == "too_many_steps"
    assert "Reason" not in run.attrs["message"]
