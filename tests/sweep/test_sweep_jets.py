"""How far polynomials of many launches are followed, against a closer look at them."""

import numpy as np
import pytest

from tippetop.frictions import ContensouFriction
from tippetop.integrators import has_llvm
from tippetop.integrators.polynomials import Polynomials
from tippetop.presets import report_problem
from tippetop.sweeps import Axis, Product, Sweep
from tippetop.sweeps.arcs import Arcs, arcs
from tippetop.sweeps.cells import cells_of
from tippetop.sweeps.ensemble import swept_motion
from tippetop.sweeps.slots import Slots
from tippetop.sweeps.stepper import stepper
from tippetop.sweeps.tip import DOWN, FORCE, UP, TipMotion


@pytest.mark.skipif(not has_llvm(), reason="llvmlite is not installed")
def test_where_guards_fall_is_what_a_closer_look_finds():
    """Polynomials are followed far beyond where they serve, so that many guards fall."""
    problem = report_problem().replace({"friction": ContensouFriction(mu=0.3, patch_radius=1e-3)})
    sweep = Sweep(problem, Product((Axis.of("friction.mu", np.linspace(0.1, 0.5, 2000)),)), 1.0)
    launches = cells_of(sweep.problem, sweep.grid.values(np.arange(2000))).launches(np.arange(2000), 1.0)
    method = stepper(swept_motion(launches.kind), 1e-9)
    slots, counts = Slots(launches, method, None), method.layout.counts
    random = np.random.default_rng(2)
    axis = random.normal(size=(3, 2000))
    axis /= np.linalg.norm(axis, axis=0)
    slots.rows[:8] = np.concatenate(
        (axis, random.normal(size=(3, 2000)), 0.3 * random.normal(size=(2, 2000)))
    )
    slots.choose_branch()
    slots.numbers[counts, ::2] = 0.0
    slots.numbers[method.layout.turns] = 0.0
    far = 10.0 ** random.uniform(-2.0, -0.5, len(slots.cell))
    jet = method.jet(slots.rows, slots.numbers)
    found = arcs(jet, far, far, slots.numbers[method.layout.parameters :])
    copied = Arcs(*map(np.array, found))._replace(doubt=np.ones(len(far)))
    copied.look_closer(jet, slots.numbers[counts])
    sure = found.doubt == 0.0
    assert sure.mean() > 0.5
    assert set(found.fallen[sure]) >= {-1.0, 0.0, 2.0}, (
        "the force falls, another branch takes over, or neither"
    )
    assert np.array_equal(found.fallen[sure], copied.fallen[sure])
    assert found.span[sure] == pytest.approx(copied.span[sure], rel=1e-12)
    tip = TipMotion.of(len(far))
    for which, terms in ((FORCE, jet.guards[0]), (DOWN, jet.state[2]), (UP, -jet.state[2])):
        tip.take(which, np.arange(len(far)), Polynomials(terms, copied.span))
    size = 1.0 + np.abs(tip.least)
    assert (found.least / size)[:, sure] == pytest.approx((tip.least / size)[:, sure], abs=1e-9)
