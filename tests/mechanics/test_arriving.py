"""Slip that ends on a small patch, where friction has long turned it into the direction in which it
ends.
"""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from dry_runs import DryRun
from tippetop.contact.automaton import Automaton
from tippetop.contact.collocated_end import collocated_end
from tippetop.contact.contact_mode import ContactMode
from tippetop.contact.mode import EventKind
from tippetop.contact.slip_end_mode import SlipEnd
from tippetop.contact.slip_end_motion import pack_clock, rates_in_time, unpack_clock
from tippetop.contact.slip_onset import onset_motion
from tippetop.contact.trajectory import Trajectory
from tippetop.integrators import make_integrator
from tippetop.integrators.scipy_methods import SciPy
from tippetop.mechanics.contacts.slip_clock import SlipComponent, slip_end_rates
from tippetop.mechanics.contacts.slip_variables import scaled, size, velocity_of
from tippetop.mechanics.laws.contensou import EllipsoidalLaw
from tippetop.mechanics.laws.contensou_hertz import HertzDrillingLaw, HertzLaw
from tippetop.mechanics.laws.coulomb import RollingResistance
from tippetop.mechanics.surfaces.surface import SphereSurface
from tippetop.mechanics.top import Top
from tippetop.mechanics.vectors import dot

SLIP = SlipComponent(slip=True)

FREE = 8
"""How many numbers of the clock come before the direction: axis, angular momentum, velocity."""

EXACT = 2.0**-52
"""Tolerance of an integrator that is exact to rounding."""


def in_its_clock(top, start, until):
    """The numbers of a top that slips less and less, by an implicit method."""

    def rates(_, y):
        state = unpack_clock(y.tolist(), FREE)
        return pack_clock(slip_end_rates(state, rates_in_time(state, ContactMode(top), SLIP)))

    return solve_ivp(rates, (0.0, until), start, "Radau", rtol=1e-9, atol=1e-13).y[:, -1].tolist()


def slipping(law, speed=1e-3):
    """A top that slips and drills, and its numbers in the clock."""
    top = Top.of(1.0, 131 / 350, 2 / 5, SphereSurface(1.0, 0.3), law, 1.0)
    way = (0.6, 0.0, 0.8)
    axis, momentum = (math.sin(1.1), 0.0, math.cos(1.1)), (0.05, 0.02, 0.0)
    momentum = (*momentum[:2], spin_for(top, axis, momentum, speed * way[2] / law.slip_length))
    velocity = velocity_of(axis, momentum, scaled(speed, way), top)
    return top, [*axis, *momentum, *velocity, *way, speed, 0.0]


def collocated(top, state, tolerance):
    """The end of slip by collocation."""
    mode = ContactMode(top)
    motion = onset_motion(mode.without_tops(), (top.kind,), (SLIP,))
    rates = rates_in_time(state, mode, SLIP)
    return collocated_end(state, rates, motion, mode.parameters, tolerance)


def spin_for(top, axis, momentum, rate):
    """The vertical angular momentum with which a top drills at this rate."""
    excess = (top.transverse_inertia - top.axial_inertia) / (
        top.transverse_inertia * top.axial_inertia
    )
    along = excess * axis[2]
    return (rate - along * dot(axis, momentum)) / (1.0 / top.transverse_inertia + along * axis[2])


@pytest.mark.parametrize("law", [EllipsoidalLaw(0.4, 0.1), HertzDrillingLaw(0.4, 0.1)])
def test_the_end_of_slip_by_collocation_agrees_with_an_implicit_method(law):
    top, start = slipping(law)
    assert collocated(top, unpack_clock(start, FREE), EXACT) is None, "its direction is not at rest"
    settled = in_its_clock(top, start, 1.0)
    found = collocated(top, unpack_clock(settled, FREE), EXACT)
    assert found is not None
    end = in_its_clock(top, settled, 25.0)
    assert settled[-1] + found.time_left == pytest.approx(end[-1], rel=1e-8)
    assert found.at(0.0)[:FREE] == pytest.approx(end[:FREE], abs=1e-9)
    assert found.at(0.0)[FREE:] == [0.0, 0.0, 0.0]
    solution = found.solution(2.0)
    for part in (1.0, 0.7, 0.5, 1e-6):
        time = np.array([2.0 + (1.0 - part) * found.time_left])
        assert solution(time)[0].tolist() == pytest.approx(found.at(part), abs=1e-15)
    assert size(found.at(0.5)[FREE:]) < 0.6 * settled[-2]


def test_a_top_on_a_small_patch_sticks_when_an_implicit_method_says():
    law = HertzLaw(0.4, 0.02)
    top, start = slipping(law)
    end = in_its_clock(top.altered(friction=HertzDrillingLaw(*law)), start, 25.0)
    axis, momentum, slip = (
        tuple(start[:3]),
        tuple(start[3:6]),
        [start[-2] * e for e in start[FREE:11]],
    )
    run = DryRun(top, axis, momentum, velocity_of(axis, momentum, slip, top)).follow(1.5 * end[-1])
    assert run.times("stick") == pytest.approx([end[-1]], rel=1e-7)


@pytest.mark.parametrize(
    ("integrator", "resists"),
    [
        (make_integrator(), True),
        pytest.param(SciPy("dop853", 1e-12), False, marks=pytest.mark.slow),
    ],
    ids=["best-rolling", "dop853"],
)
def test_friction_that_turns_slip_much_faster_than_it_ends_takes_few_steps(integrator, resists):
    """Its direction is at rest soon: explicit steps as short as it is turned then go no farther."""
    top, start = slipping(EllipsoidalLaw(0.4, 0.02), 5e-6)
    top = top.altered(rolling_resistance=RollingResistance(1e-3) if resists else None)
    end = in_its_clock(top, start, 25.0)
    axis, momentum, slip = (
        tuple(start[:3]),
        tuple(start[3:6]),
        [start[-2] * e for e in start[FREE:11]],
    )
    velocity = velocity_of(axis, momentum, slip, top)
    run = DryRun(top, axis, momentum, velocity, integrator)
    automaton = Automaton(top, "ignore", 0.0)
    segments = Trajectory(
        automaton, automaton.launch(run.start), 1.5 * end[-1], integrator
    ).segments()
    first = next(segments)
    assert isinstance(first.mode, SlipEnd)
    assert first.transition.events[0].kind is EventKind.STICK
    assert first.end_time == pytest.approx(end[-1], rel=1e-8)
    assert first.solution(np.array([first.end_time]))[0, :6] == pytest.approx(end[:6], abs=1e-9)
    assert first.steps < 1000


@pytest.mark.parametrize("law", [EllipsoidalLaw(0.4, 0.1), HertzDrillingLaw(0.4, 0.1)])
def test_a_slip_direction_counts_as_at_rest_within_the_tolerance(law):
    top, start = slipping(law)
    exact = unpack_clock(in_its_clock(top, start, 1.0), FREE)
    x, y, z = exact.direction
    off = 3e-10 / math.hypot(x, z)
    rough = exact._replace(direction=(x + off * z, y, z - off * x))
    assert collocated(top, rough, EXACT) is None
    found, known = collocated(top, rough, 1e-10), collocated(top, exact, EXACT)
    assert found is not None
    assert known is not None
    assert found.time_left == pytest.approx(known.time_left, abs=1e-12)
    assert found.at(0.0)[:FREE] == pytest.approx(known.at(0.0)[:FREE], abs=1e-12)
