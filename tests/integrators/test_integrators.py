"""Every integrator against motions that are known exactly."""

import math
import re

import numpy as np
import pytest
from exact_motions import (
    AXIS,
    CLASSICAL,
    DEFAULTS,
    ECCENTRICITY,
    EXACT,
    FALL,
    FREE_TOP,
    FREQUENCY,
    GRAVITY,
    KEPLER,
    LOOSE,
    MOMENTUM,
    OSCILLATOR,
    follow,
    followed,
    whole,
)

from tippetop.integrators import (
    NAMES,
    Guard,
    Motion,
    make_integrator,
    sampling,
    stepping,
    taylor,
)
from tippetop.support.errors import InvalidInput

every_method = pytest.mark.parametrize("method", DEFAULTS, ids=lambda method: method.label)
every_method_also_loose = pytest.mark.parametrize(
    "method", [*DEFAULTS, *LOOSE], ids=lambda method: method.label
)


def test_every_integrator_is_tested():
    assert [method.integrator.name for method in DEFAULTS] == [*NAMES, "page"]


# --- exact solutions
# ----------------------------------------------------------------------------------------


@every_method_also_loose
@pytest.mark.parametrize("exact", EXACT, ids=lambda exact: exact.label)
def test_motion_ends_where_the_exact_solution_does(method, exact):
    arc = followed(method, exact)
    assert arc.failure is None
    assert arc.guard is None
    assert arc.solution.end == exact.end
    np.testing.assert_allclose(
        arc.end_state, exact.state(exact.end), rtol=0, atol=method.allowed(arc, exact)
    )


@every_method
@pytest.mark.parametrize("exact", EXACT, ids=lambda exact: exact.label)
def test_solution_is_the_exact_one_at_any_time(method, exact):
    """At times within the steps, whatever these are, and at their ends."""
    arc = followed(method, exact)
    times = np.union1d(np.linspace(0.0, exact.end, 997), arc.solution.knots)
    # Within a step the solution is interpolated, for which an order of accuracy may be lost.
    allowed = 10 * method.allowed(arc, exact)
    np.testing.assert_allclose(arc.solution(times), exact.states(times), rtol=0, atol=allowed)


@every_method_also_loose
def test_no_guard_is_so_large_that_steps_leave_out_more(method):
    arc = follow(method, FREE_TOP, [Guard("far", lambda n, p: 1e13 + n[0])])
    exact = FREE_TOP.state(FREE_TOP.end)
    np.testing.assert_allclose(arc.end_state, exact, rtol=0, atol=method.allowed(arc, FREE_TOP))


@every_method
def test_energy_angular_momentum_and_perihelion_are_conserved(method):
    arc = followed(method, KEPLER)
    x, y, u, v = arc.solution(np.linspace(0.0, KEPLER.end, 57)).T
    allowed = 10 * method.allowed(arc, KEPLER)
    e = ECCENTRICITY
    np.testing.assert_allclose((u**2 + v**2) / 2 - 1 / np.hypot(x, y), -0.5, rtol=0, atol=allowed)
    np.testing.assert_allclose(x * v - y * u, np.sqrt(1 - e**2), rtol=0, atol=allowed)
    np.testing.assert_allclose(v * (x * v - y * u) - x / np.hypot(x, y), e, rtol=0, atol=allowed)


@every_method
def test_free_top_keeps_its_length_and_its_angle_to_the_momentum(method):
    arc = followed(method, FREE_TOP)
    axes = arc.solution(np.linspace(0.0, FREE_TOP.end, 57))
    allowed = 10 * method.allowed(arc, FREE_TOP)
    np.testing.assert_allclose(np.linalg.norm(axes, axis=1), 1.0, rtol=0, atol=allowed)
    np.testing.assert_allclose(axes @ MOMENTUM, AXIS @ MOMENTUM, rtol=0, atol=allowed)


@every_method
def test_clock_may_start_anywhere(method):
    times = np.linspace(3.0, 4.0, 11)
    start = (3.0, OSCILLATOR.state(0.0))
    arc = whole(method.integrator.integrate(OSCILLATOR.motion, OSCILLATOR.parameters, start, 4.0))
    allowed = 10 * method.allowed(arc, OSCILLATOR)
    np.testing.assert_allclose(
        arc.solution(times), OSCILLATOR.states(times - 3.0), rtol=0, atol=allowed
    )
    assert (arc.solution.knots[0], arc.solution.end) == (3.0, 4.0)


@every_method
def test_classical_or_adaptive_work_is_counted(method):
    short, long = follow(method, OSCILLATOR, end=2.0), follow(method, OSCILLATOR, end=4.0)
    assert 0 < short.steps < long.steps
    assert short.evaluations < long.evaluations
    assert long.evaluations >= long.steps


# --- steps and arcs
# -----------------------------------------------------------------------------------------


@every_method
@pytest.mark.parametrize("exact", [OSCILLATOR, KEPLER], ids=lambda exact: exact.label)
def test_solution_goes_from_start_to_end_step_by_step(method, exact):
    arc = followed(method, exact)
    knots, terms = arc.solution.knots, arc.solution.terms
    assert (knots[0], knots[-1]) == (0.0, exact.end)
    assert np.all(np.diff(knots) > 0)
    assert terms.shape[:2] == (len(knots) - 1, exact.motion.size)
    assert arc.steps == len(terms)
    np.testing.assert_allclose(terms[0, :, 0], exact.start[1], rtol=0, atol=joint(method, exact))
    np.testing.assert_allclose(
        arc.solution(knots[-1:])[0], arc.end_state, rtol=0, atol=joint(method, exact)
    )


def joint(method, exact):
    """How far apart a step may begin from where the one before it ended, numbers of the size 1.

    Methods that use several steps put their polynomial through all of them, and none of them
    exactly; steps of the classical method are polynomials but for the terms of the series from
    (rate h)^6 / 6! on.
    """
    if method.step:
        return (exact.rate * method.step) ** 6 / 720
    return method.tolerance if method.integrator.name in ("bdf", "lsoda") else 1e-14


@every_method
def test_steps_join(method):
    """Each begins where the one before it ended, however inexact both are."""
    solution = followed(method, OSCILLATOR).solution
    ends, starts = solution(solution.knots[1:-1]), solution.terms[1:, :, 0]
    np.testing.assert_allclose(ends, starts, rtol=0, atol=joint(method, OSCILLATOR))


CUTS = {
    "taylor": (taylor, {"STEPS_PER_ARC": 4}),
    "page": (stepping, {"FEW": 4, "MANY": 7}),
}
"""What decides into how many arcs a solution is cut, and smaller numbers of it."""


@every_method
def test_how_a_solution_is_cut_into_arcs_does_not_show(method, monkeypatch):
    uncut = followed(method, KEPLER)
    module, smaller = CUTS.get(method.integrator.name) or (sampling, {"ARC_STEPS": 7})
    for name, number in smaller.items():
        monkeypatch.setattr(module, name, number)
    arcs = list(
        method.integrator.integrate(KEPLER.motion, KEPLER.parameters, KEPLER.start, KEPLER.end)
    )
    assert len(arcs) > 3
    assert max(arc.steps for arc in arcs) == max(smaller.values())
    cut, allowed = whole(arcs), method.allowed(uncut, KEPLER)
    assert cut.steps == uncut.steps
    assert cut.evaluations == uncut.evaluations
    times = np.linspace(0.0, KEPLER.end, 57)
    np.testing.assert_allclose(
        cut.solution(times), uncut.solution(times), rtol=0, atol=min(allowed, 1e-12)
    )


# --- guards
# -------------------------------------------------------------------------------------------------

QUARTER_TURN = math.pi / 2 / FREQUENCY
AT_MINOR_AXIS = math.pi / 2 - ECCENTRICITY
LANDING = math.sqrt(2 * 3.0 / GRAVITY)

POSITION = Guard("position", lambda y, _: y[0])
NEARER_THAN_MEAN = Guard(
    "nearer than the mean distance", lambda y, _: 1.0 - (y[0] ** 2 + y[1] ** 2) ** 0.5
)

CROSSINGS = [
    # motion, guard, when it falls through zero, and how fast
    pytest.param(OSCILLATOR, POSITION, QUARTER_TURN, FREQUENCY, id="oscillator"),
    pytest.param(FALL, POSITION, LANDING, GRAVITY * LANDING, id="landing"),
    pytest.param(KEPLER, NEARER_THAN_MEAN, AT_MINOR_AXIS, ECCENTRICITY, id="Kepler"),
]


@every_method_also_loose
@pytest.mark.parametrize(("exact", "guard", "when", "slope"), CROSSINGS)
def test_guard_is_located_to_the_accuracy_of_the_motion(method, exact, guard, when, slope):
    arc = follow(method, exact, [guard])
    allowed = method.allowed(arc, exact)
    assert arc.guard == guard.name
    assert arc.failure is None
    assert abs(arc.solution.end - when) <= allowed / slope + 4e-16 * when
    np.testing.assert_allclose(arc.end_state, exact.state(when), rtol=0, atol=2 * allowed)
    # Where the arc ends, the guard is zero, however good the motion up to there is.
    assert abs(guard.value(arc.end_state, exact.parameters)) <= 1e-13


@every_method
def test_solution_stops_at_the_guard(method):
    arc = follow(method, OSCILLATOR, [POSITION])
    times = np.union1d(np.linspace(0.0, arc.solution.end, 201), arc.solution.knots)
    allowed = 10 * method.allowed(arc, OSCILLATOR)
    np.testing.assert_allclose(arc.solution(times), OSCILLATOR.states(times), rtol=0, atol=allowed)
    np.testing.assert_allclose(arc.solution(times[-1:])[0], arc.end_state, rtol=0, atol=allowed)


@every_method
def test_rising_through_zero_is_no_end(method):
    """The speed of the oscillator starts by falling, so that it rises through zero half a turn
    later.
    """
    speed = Guard("speed", lambda y, _: y[1])
    later = OSCILLATOR.state(QUARTER_TURN)
    arc = follow(method, OSCILLATOR, [speed], state=lambda _: later, end=2 * QUARTER_TURN)
    assert arc.guard is None
    assert arc.solution.end == 2 * QUARTER_TURN


@every_method
@pytest.mark.parametrize("first", [0, 1, 2])
def test_earliest_of_several_guards_ends_the_motion(method, first):
    """All three fall in the same quarter turn, a few hundredths of it apart."""
    levels = [0.30, 0.25, 0.20]
    levels.insert(first, levels.pop(0))
    guards = [Guard(f"below {level}", lambda y, _, level=level: y[0] - level) for level in levels]
    arc = follow(method, OSCILLATOR, guards)
    assert arc.guard == "below 0.3"
    allowed = method.allowed(arc, OSCILLATOR)
    assert abs(arc.solution.end - math.acos(0.30) / FREQUENCY) <= allowed


DIP = Guard("dip", lambda y, p: y[0] + p[1])
CLEARANCE = Motion(OSCILLATOR.motion.rates, size=2, parameters=2, guards=(DIP,))
"""Falls through zero where the oscillator is lower than minus the second parameter."""


def dive(method, depth, phase):
    """Follow a swing through a dip of this depth, begun at this phase; return the arc and the true
    time.
    """
    begin = np.array([math.cos(phase), -math.sin(phase)])
    arc = whole(method.integrator.integrate(CLEARANCE, (1.0, 1.0 - depth), (0.0, begin), 5.0))
    return arc, math.acos(depth - 1.0) - phase


@every_method
def test_shallow_dip_below_zero_is_found_wherever_in_a_step_it_is(method):
    depth = 1e-3
    for phase in np.linspace(0.0, 2.9, 7):
        arc, when = dive(method, depth, phase)
        assert arc.guard == "dip", f"missed the dip begun at phase {phase}"
        # At the edge of the dip the guard falls at the rate sqrt(2 depth).
        allowed = method.allowed(arc, OSCILLATOR) / math.sqrt(2 * depth)
        assert abs(arc.solution.end - when) <= allowed


@pytest.mark.parametrize("method", LOOSE, ids=lambda method: method.label)
def test_shallow_dip_is_found_in_the_long_steps_of_a_loose_tolerance(method):
    missed = [
        phase for phase in np.linspace(0.0, 2.9, 16) if dive(method, 1e-3, phase)[0].guard is None
    ]
    assert missed == []


@every_method
@pytest.mark.parametrize("phase", [0.0, 1.3, 2.6])
def test_guard_that_comes_close_to_zero_and_turns_back_ends_nothing(method, phase):
    begin = np.array([math.cos(phase), -math.sin(phase)])
    arc = whole(method.integrator.integrate(CLEARANCE, (1.0, 1.0 + 1e-3), (0.0, begin), 5.0))
    assert arc.guard is None
    assert arc.solution.end == 5.0


@every_method
@pytest.mark.parametrize("speed", [1e-1, 1e-3])
def test_throw_much_shorter_than_a_step_ends_though_it_starts_below_zero_by_rounding(method, speed):
    """A throw upwards from just below the ground comes back after 2 v / g."""
    ground = Guard("ground", lambda y, _: y[0])
    arc = follow(method, FALL, [ground], state=lambda _: np.array([-1e-16, speed]))
    assert arc.guard == "ground"
    allowed = method.allowed(arc, FALL) / speed
    assert arc.solution.end == pytest.approx(2.0 * speed / GRAVITY, abs=allowed)


# --- motions that cannot go on
# ------------------------------------------------------------------------------


class TooMuchWork(AssertionError):
    """Raised by an equation of motion that has been evaluated absurdly often."""


def limited(rates, budget=200_000):
    """The same rates, as long as they are not asked for too often."""
    calls = 0

    def count(y, p):
        nonlocal calls
        calls += 1
        if calls > budget:
            raise TooMuchWork(f"more than {budget} evaluations and no end")
        return rates(y, p)

    return count


SINGULAR = {
    # rates, when the motion ceases to exist, and methods; tight tolerances creep up to
    # the end of the first, loose ones leap over the singularity of the others
    "blows up": (lambda y, _: (y[0] ** 2, y[0]), 1.0, [*LOOSE, CLASSICAL]),
    "overflows": (lambda y, _: (y[0] ** 50, y[0]), 1 / 49, DEFAULTS),
    "falls into a singularity": (lambda y, _: (-1.0 / y[0], y[0]), 0.5, DEFAULTS),
}


@pytest.mark.parametrize(
    ("method", "rates", "last"),
    [
        pytest.param(method, rates, last, id=f"{name}-{method.label}")
        for name, (rates, last, methods) in SINGULAR.items()
        for method in methods
    ],
)
def test_motion_that_ceases_to_exist_is_a_failure_and_no_exception(method, rates, last):
    if method.step and rates((1.0, 0.0), ())[0] < 0:
        pytest.skip("fixed steps leap over the singularity")
    arc = whole(
        method.integrator.integrate(
            Motion(limited(rates), 2, 0), (), (0.0, np.array([1.0, 0.0])), 2.0
        )
    )
    assert arc.failure
    assert "\n" not in arc.failure
    assert arc.guard is None
    # What was computed before stays, and ends with something finite.
    times = np.union1d(np.linspace(0.0, arc.solution.end, 41), arc.solution.knots)
    assert np.all(np.isfinite(arc.solution(times)))
    assert np.all(np.isfinite(arc.end_state))
    assert abs(arc.solution.end - last) <= 0.1


@every_method
def test_motion_that_is_singular_from_the_start_is_a_failure_and_no_exception(method):
    motion = Motion(limited(lambda y, _: (1.0 / y[0], y[0])), 2, 0)
    begin = np.array([0.0, 1.0])
    arc = whole(method.integrator.integrate(motion, (), (0.0, begin), 1.0))
    assert arc.failure
    assert arc.guard is None
    assert arc.solution.end == 0.0
    np.testing.assert_array_equal(arc.end_state, begin)
    np.testing.assert_array_equal(arc.solution.knots, [0.0])
    assert arc.solution.terms.shape[:2] == (0, 2)
    assert arc.steps == 0


# --- the order of the classical method
# ----------------------------------------------------------------------


def classical_run(exact, step, end):
    method = make_integrator("rk4", step=step)
    return whole(method.integrate(exact.motion, exact.parameters, exact.start, end))


def errors_of_classical_method(end, steps):
    errors = []
    for count in steps:
        arc = classical_run(KEPLER, end / count, end)
        assert arc.steps == count
        errors.append(np.linalg.norm(arc.end_state - KEPLER.state(end)))
    return np.array(errors)


def test_classical_method_converges_as_fast_between_its_steps():
    times = np.linspace(0.0, 3.0, 333)
    arcs = [classical_run(KEPLER, 3.0 / count, 3.0) for count in (400, 800, 1600)]
    errors = np.array([np.linalg.norm(arc.solution(times) - KEPLER.states(times)) for arc in arcs])
    assert np.log2(errors[:-1] / errors[1:]) == pytest.approx(4.0, abs=0.1)


def test_classical_method_converges_with_the_fourth_power_of_its_step():
    counts = np.array([400, 800, 1600])
    errors = errors_of_classical_method(3.0, counts)
    assert np.log2(errors[:-1] / errors[1:]) == pytest.approx(4.0, abs=0.1)


def test_one_step_of_the_classical_method_errs_by_the_fifth_power_of_its_length():
    steps = np.array([0.02, 0.01, 0.005])
    errors = np.concatenate([errors_of_classical_method(step, [1]) for step in steps])
    assert np.log2(errors[:-1] / errors[1:]) == pytest.approx(5.0, abs=0.1)


def test_step_that_does_not_divide_the_time_is_shortened_at_the_end():
    arc = classical_run(OSCILLATOR, 0.3, 1.0)
    assert arc.steps == 4
    assert arc.solution.end == 1.0
    np.testing.assert_allclose(arc.end_state, OSCILLATOR.state(1.0), atol=1e-2)


# --- asking for one
# -----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "name", [method.integrator.name for method in LOOSE if method.integrator.name in NAMES]
)
def test_integrator_is_made_with_the_tolerance_asked_for(name):
    assert make_integrator(name, 1e-7).tolerance == 1e-7


def test_step_is_given_in_seconds():
    assert make_integrator("rk4", step=0.002, time_unit=0.04).step == pytest.approx(0.05)


@pytest.mark.parametrize(
    ("field", "arguments"),
    [
        ("integrator", {"name": "euler"}),
        ("integrator", {"name": ""}),
        ("tolerance", {"name": "taylor", "tolerance": 0.0}),
        ("tolerance", {"name": "taylor", "tolerance": 1e-16}),
        ("tolerance", {"name": "dop853", "tolerance": 1e-15}),
        ("tolerance", {"name": "bdf", "tolerance": 1.0}),
        ("tolerance", {"name": "bdf", "tolerance": -1e-6}),
        ("tolerance", {"name": "lsoda", "tolerance": math.nan}),
        ("tolerance", {"name": "lsoda", "tolerance": math.inf}),
        ("tolerance", {"name": "rk4", "step": 0.1, "tolerance": 1e-6}),
        ("step", {"name": "rk4"}),
        ("step", {"name": "rk4", "step": 0.0}),
        ("step", {"name": "rk4", "step": -0.1}),
        ("step", {"name": "rk4", "step": math.nan}),
        ("step", {"name": "rk4", "step": math.inf}),
        ("step", {"name": "taylor", "step": 0.1}),
        ("step", {"name": "rk45", "step": 0.1}),
    ],
)
def test_integrator_that_cannot_be_is_refused_in_one_line_that_names_the_field(field, arguments):
    with pytest.raises(InvalidInput) as refusal:
        make_integrator(**arguments)
    assert refusal.value.field == field
    assert str(refusal.value).startswith(field)
    assert re.search(r" is not | is for | has |\(write ", str(refusal.value))
    assert "\n" not in str(refusal.value)


def test_misspelt_integrator_is_told_the_nearest():
    with pytest.raises(InvalidInput, match="did you mean radau"):
        make_integrator("raddau")
