"""Taylor coefficients by compiled code against power series of plain numbers."""

import numpy as np
import pytest

from campaigns import among
from every_motion import CASES, states
from tippetop.extend import abs as absolute
from tippetop.extend import exp, log, tanh, where
from tippetop.graph.llvm_series import with_choices
from tippetop.graph.recording import record
from tippetop.integrators.base import Guard, Motion
from tippetop.integrators.taylor import SeriesExpansion, Taylor
from tippetop.mechanics.series import PLAIN, Series, solved, unknown

ORDER, ROUNDINGS = 20, 1e3


def recorded(motion):
    """Rates and guards of a motion as a graph."""

    def values(y, p):
        return [*motion.rates(y, p), *[guard.value(y, p) for guard in motion.guards]]

    return record(values, motion.size, motion.parameters)


def compiled(motion, order=ORDER):
    """A function that expands a motion in compiled code: state, and guards."""
    jet = SeriesExpansion(with_choices(recorded(motion)), order)
    room, out = jet.room(), np.zeros(jet.coefficients)

    def expand(state, parameters):
        arrays = np.array(state, dtype=float), np.array([*parameters, 0.0]), room, out
        jet.expand(*[numbers.ctypes.data for numbers in arrays])
        parts = np.split(out, [motion.size * (order + 1)])
        return parts[0].reshape(-1, order + 1).copy(), parts[1].reshape(-1, order).copy()

    return expand


def by_series(motion, state, parameters, order=ORDER):
    """The same by series of floats."""
    y = solved(
        [Series(unknown, PLAIN) for _ in state], list(state), lambda y: motion.rates(y, parameters)
    )
    guards = [guard.value(y, parameters).up_to(order - 1)[:order] for guard in motion.guards]
    return np.array([one.up_to(order)[: order + 1] for one in y]), np.array(guards)


def roundings(random, size, count):
    """Signs of roundings of a state: of all its numbers alike, and of each by itself."""
    return np.vstack([np.ones(size), random.choice([-1.0, 1.0], (count - 1, size))])


def assert_same(found, exact, *rounded):
    """Every coefficient is the same beside the largest of its order, or no farther off than where
    floats add up in another way, or the state is another by roundings.

    What grows faster than the solution multiplies roundings from order to order; from the order on
    in which they leave nothing of the coefficients, nothing is compared.
    """
    for ours, theirs, *others in zip(found, exact, *rounded, strict=True):
        largest = np.maximum(np.abs(theirs).max(axis=0, initial=0.0), 1e-280)
        apart = [np.abs(one - theirs).max(axis=0, initial=0.0) for one in others]
        grown = ROUNDINGS * np.maximum.accumulate(np.max(apart, axis=0) / largest)
        off = np.abs(ours - theirs).max(axis=0, initial=0.0) / largest
        assert (off <= 1e-12 + grown)[grown < 1.0].all(), (off, grown)


@pytest.mark.parametrize("part", among(range(4), check=1))
def test_coefficients_of_every_motion_are_those_of_power_series(part):
    random, compared = np.random.default_rng(part), 0
    for case in random.permutation(np.array(CASES, dtype=object))[:3]:
        _, motion, parameters = case
        expand = compiled(motion)
        for state in states(motion, 2):
            states_beside = state * (1.0 + 1e-15 * roundings(random, len(state), 4))
            try:
                exact = by_series(motion, state.astype(np.longdouble), parameters)
                rounded = [
                    by_series(motion, one.tolist(), parameters) for one in (state, *states_beside)
                ]
            except (TypeError, ArithmeticError):  # a choice, or a root of a negative number
                continue
            if all(np.isfinite(one).all() for one in rounded[0]):
                assert_same(expand(state, parameters), exact, *rounded)
                compared += 1
    assert compared > 0


@pytest.mark.parametrize("order", [2, 7, 9, 10, 17, 25])
def test_every_operation_has_its_rule_at_every_order(order):
    def rates(y, p):
        a, b = y[0], y[1]
        return (
            a * b - b / a + p[0] * a,
            (a * a + b * b) ** 0.5 + 1.0 / b,
            (a + 2.0) ** 0.3 - (b + 3.0) ** -1.7 + p[0] ** 1.5,
            exp(-a * b) + log(a + b) * exp(p[0]) + log(p[0]),
            tanh(a - b) * tanh(b) + tanh(p[0]),
        )

    guards = (Guard("mixed", lambda y, p: y[0] ** 3 - y[1] * y[2] / p[0] + 1.0),)
    motion = Motion(rates, size=5, parameters=1, guards=guards)
    expand = compiled(motion, order)
    for state in np.random.default_rng(1).uniform(0.5, 1.5, (5, 5)):
        # What is left from one state does not show in the next.
        exact = by_series(motion, state.astype(np.longdouble), (0.7,), order)
        rounded = by_series(motion, (state * (1.0 + 1e-15)).tolist(), (0.7,), order)
        assert_same(expand(state, (0.7,)), exact, rounded)


@pytest.mark.parametrize(("function", "inverse"), [(exp, np.exp), (log, np.log), (tanh, np.tanh)])
def test_coefficients_of_elementary_functions_sum_to_them(function, inverse) -> None:
    """f(1 + t) is the sum of its coefficients within its circle of convergence."""
    motion = Motion(lambda y, p: (1.0, function(y[0])), 2, 0)
    found, _ = compiled(motion, 30)([1.0, 0.0], [])
    rates = found[1, 1:] * np.arange(1, 31)
    for time in (-0.2, 0.1, 0.25):
        assert np.polyval(rates[::-1], time) == pytest.approx(inverse(1.0 + time), rel=1e-14)


def test_where_a_law_has_another_branch_a_step_ends():
    """A ball on a spring that pulls harder than it pushes: half a period of each."""
    stiff, soft = 9.0, 1.0

    def rates(y, p):
        return y[1], -where(y[0] > 0.0, stiff * y[0], soft * y[0]) - 0.0 * absolute(y[1])

    motion = Motion(rates, size=2, parameters=0)
    period = np.pi / stiff**0.5 + np.pi / soft**0.5
    *_, arc = Taylor().integrate(motion, (), (0.0, np.array([0.0, 1.0])), 25.0 * period)
    np.testing.assert_allclose(arc.end_state, [0.0, 1.0], rtol=0, atol=1e-11)
    for time in np.pi / stiff**0.5 + period * np.arange(25):
        assert np.abs(arc.solution.knots - time).min() < 1e-11


def test_a_whole_power_of_a_number_that_passes_zero_has_coefficients() -> None:
    """y = t and z' = y^18 from zero: z = t^19 / 19, where the recurrence would divide by y."""
    motion = Motion(lambda y, p: (1.0, y[0] ** 18), 2, 0)
    found, _ = compiled(motion)([0.0, 0.0], [])
    expected = np.zeros((2, ORDER + 1))
    expected[0, 1], expected[1, 19] = 1.0, 1.0 / 19.0
    np.testing.assert_allclose(found, expected, rtol=1e-15)
