"""How far polynomials of many launches are followed, against a closer look at them."""

from dataclasses import replace

import numpy as np
import pytest

from tippetop.integrators import make_integrator
from tippetop.integrators.base import Guard, Motion
from tippetop.integrators.polynomials import Polynomials
from tippetop.problem.frictions import ContensouFriction
from tippetop.problem.presets import report_problem
from tippetop.sweeps import Axis, Product, Sweep
from tippetop.sweeps.axis_extremes import DOWN, FORCE, UP, TipMotion
from tippetop.sweeps.cells import cells_of
from tippetop.sweeps.lane_arrays import Slots
from tippetop.sweeps.lane_sums import NO_SUMS, swept_motion
from tippetop.sweeps.polynomial_arcs import Arcs, arcs
from tippetop.sweeps.taylor_stepper import stepper

COUNT = 2000


def anywhere():
    """Taylor's method for tops with a patch, and lanes on which they are anywhere, with all to
    pause for.
    """
    problem = report_problem().replace({"friction": ContensouFriction(mu=0.3, patch_radius=1e-3)})
    sweep = Sweep(problem, Product((Axis.of("friction.mu", np.linspace(0.1, 0.5, COUNT)),)), 1.0)
    cells = cells_of(sweep.problem, sweep.grid.values(np.arange(COUNT)))
    launches = cells.launches(np.arange(COUNT), 1.0)
    method = stepper(swept_motion(launches.kind, NO_SUMS), 1e-9)
    slots, random = Slots(launches, method, None), np.random.default_rng(2)
    axis = random.normal(size=(3, COUNT))
    axis /= np.linalg.norm(axis, axis=0)
    slots.rows[:8] = np.concatenate(
        (axis, random.normal(size=(3, COUNT)), 0.3 * random.normal(size=(2, COUNT)))
    )
    slots.choose_branch()
    return method, slots


def test_where_guards_fall_is_what_a_closer_look_finds():
    """Polynomials are followed far beyond where they serve, so that many guards fall."""
    method, slots = anywhere()
    counts, waits = method.layout.counts, np.arange(COUNT) % 4 < 2
    slots.numbers[counts, ::2] = 0.0
    slots.numbers[method.layout.turns] = waits
    far = 10.0 ** np.random.default_rng(3).uniform(-2.0, -0.5, COUNT)
    jet = method.jet(slots.rows, slots.numbers)
    found = arcs(jet, far, far, slots.numbers[method.layout.parameters :])
    copied = Arcs(*map(np.array, found))._replace(doubt=np.ones(COUNT))
    copied.look_closer(jet, slots.numbers[counts])
    sure = found.doubt == 0.0
    assert sure.mean() > 0.5
    assert set(found.fallen[sure]) >= {-1.0, 0.0, 2.0}, (
        "the force falls, another branch takes over, or neither"
    )
    assert np.array_equal(found.fallen[sure], copied.fallen[sure])
    assert found.span[sure] == pytest.approx(copied.span[sure], rel=1e-12)
    size = 1.0 + np.abs(copied.after)
    assert (found.after / size)[:, sure] == pytest.approx((copied.after / size)[:, sure], abs=1e-9)
    tip = TipMotion.of(COUNT)
    for which, terms in ((FORCE, jet.guards[0]), (DOWN, jet.state[2]), (UP, -jet.state[2])):
        tip.take(which, np.arange(COUNT), Polynomials(terms, copied.span))
    size = 1.0 + np.abs(tip.least)
    assert (found.least / size)[:, sure] == pytest.approx((tip.least / size)[:, sure], abs=1e-9)
    over = (tip.least[DOWN] < 0.0) & (tip.least[UP] < 0.0)
    assert not (sure & over & waits).any(), "tops that may turn over are looked at"
    assert (sure & over).any(), "unless that is not waited for"


def test_where_polynomials_end_is_where_single_launches_are():
    """As far as they serve, or to where a guard falls; the tops go on as dop853 has it."""
    method, slots = anywhere()
    slots.remaining[:] = np.inf
    jet, none = method.jet(slots.rows, slots.numbers), np.zeros(COUNT)
    pauses = slots.numbers[method.layout.parameters :]
    found = arcs(jet, none, none + np.inf, pauses)
    found.look_closer(jet, slots.numbers[method.layout.counts])
    unguarded, moves = replace(method.motion, guards=()), found.span > 0.0
    lanes = np.concatenate(
        [np.flatnonzero(moves & (found.fallen == guard))[:8] for guard in (-1.0, 0.0)]
    )
    assert len(lanes) == 16, "nothing falls, or the force does"
    for lane in lanes.tolist():
        numbers = slots.numbers[: method.layout.parameters, lane].tolist()
        start, span = slots.rows[: len(jet.state), lane], float(found.span[lane])
        *_, last = make_integrator("dop853", 1e-12).integrate(
            unguarded, numbers, (0.0, start), span
        )
        assert last.solution.end == span
        size = np.abs(start).max()
        assert found.after[:, lane] == pytest.approx(last.end_state, abs=1e-7 * size), lane


def test_guards_that_are_no_numbers_end_nothing_as_in_single_launches():
    """Beside them a guard that falls is found all the same."""
    none = [Guard(name, lambda y, _: (-1.0 - y[0] * y[0]) ** 0.5) for name in ("first", "second")]
    quarter = Guard("quarter", lambda y, _: y[0])
    for guards, ends in ((none, 3.0), ([*none, quarter], 0.5 * np.pi)):
        motion = Motion(lambda y, _: (-y[1], y[0], 0.1 * y[0], y[2]), 4, 1, tuple(guards))
        *_, arc = make_integrator(None).integrate(
            motion, [0.0], (0.0, np.array([1.0, 0.0, 0.5, 0.0])), 3.0
        )
        method, pauses = stepper(motion, 1e-12), [1.0] * len(guards) + [0.0, np.inf, -np.inf]
        layout, numbers = method.layout, np.tile(np.array([[0.0, *pauses]]).T, 16)
        before, after = np.zeros((2, layout.rows, 16))
        before[[0, 2, layout.remaining]] = np.array([[1.0], [0.5], [3.0]])
        paused = np.zeros(16)
        for _ in range(50):
            method.step(before, after, numbers)
            paused = after[layout.pause]
            if paused.any() or not after[layout.remaining].any():
                break
            before, after = after, before
        assert paused.any() == (len(guards) == 3)
        end = 3.0 - after[layout.remaining]
        if paused.any():
            jet, held = method.jet(before, numbers), after[layout.step_time]
            found = arcs(jet, held, held, numbers[layout.parameters :])
            end = 3.0 - before[layout.remaining] + found.span
            assert np.all(found.fallen == 2.0)
        assert end == pytest.approx(np.full(16, ends), rel=1e-12)
        assert arc.solution.end == pytest.approx(ends, rel=1e-9)
        assert (arc.guard, arc.failure) == ("quarter" if len(guards) == 3 else None, None)
