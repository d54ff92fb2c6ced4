"""Impacts of two surfaces at one instant, or beside a closed one, in runs and by themselves."""

import math

import numpy as np
import pytest

import tippetop as tt
from tippetop.contact.automaton import Automaton
from tippetop.contact.contact_mode import ContactMode
from tippetop.contact.impact import impact
from tippetop.contact.mode import EventKind
from tippetop.contact.natural_launch import NaturalLaunch
from tippetop.mechanics.contacts.slip_variables import slip_of
from tippetop.mechanics.flight.free_motion import gap_rate
from tippetop.mechanics.laws.contensou import EllipsoidalLaw
from tippetop.mechanics.laws.coulomb import CoulombLaw, RollingResistance
from tippetop.mechanics.laws.friction import RegularizedCoulombLaw, ViscousLaw
from tippetop.mechanics.motion import along_table, on_table
from tippetop.mechanics.state import SlidingState, State
from tippetop.mechanics.surfaces.hull import Hull
from tippetop.mechanics.surfaces.surface import SphereSurface
from tippetop.mechanics.top import Top

FRICTIONS = {
    "viscous": tt.ViscousFriction(mu=0.3),
    "coulomb": tt.CoulombFriction(mu=0.3),
    "contensou": tt.ContensouFriction(mu=0.3, patch_radius=5e-4),
}


@pytest.mark.parametrize("restitution", [0.0, 0.5, 1.0])
@pytest.mark.parametrize("friction", FRICTIONS.values(), ids=FRICTIONS)
def test_a_symmetric_dumbbell_that_is_dropped_level_stays_level(friction, restitution):
    """Both ends strike at once, whichever is first by rounding, and turning about the vertical
    changes nothing.
    """
    ends = [tt.Sphere(radius=0.005, center=0.02), tt.Sphere(radius=0.005, center=-0.02)]
    problem = tt.Problem(
        body=tt.Body(mass=0.01, shape=ends, I1=2e-6, I3=1.25e-7),
        friction=friction,
        launch=tt.Launch(
            tilt=math.pi / 2, spin=0.0, gap=0.01, precession=5.0, velocity=(0.0, 0.0, 0.0)
        ),
        contact=tt.Contact(liftoff="fly", restitution=restitution),
    )
    run = tt.simulate(problem, 0.2, samples=101)
    assert run.attrs["status"] in ("completed", "at_rest")
    assert np.abs(run["tilt"].values - math.pi / 2).max() < 1e-10
    hits = run["event_kind"].values == "impact"
    if restitution == 1.0:
        fall = math.sqrt(2.0 * problem.gravity * 0.01)
        assert run["event_impulse"].values[hits] == pytest.approx(2.0 * 0.01 * fall, rel=1e-9)
    instants = run["event_time"].values[hits]
    assert len(set(instants.tolist())) == len(instants), "no impacts in turns"


def rod(law, centers=(2.0, -3.0), resistance=None):
    hull = Hull.of(tuple(SphereSurface(1.0, center) for center in centers))
    return Top.of(1.0, 1.5, 0.5, hull, law, 1.0, resistance)


@pytest.mark.parametrize("restitution", [0.0, 0.4, 1.0])
@pytest.mark.parametrize("turning", [0.0, 0.02, -0.03])
def test_without_friction_both_ends_rebound_by_their_own_compression(turning, restitution):
    """Lambda = A^-1 (-v) where both are positive, and each end gets (1 + e) Lambda: v+ = -e v-."""
    top = rod(ViscousLaw(0.0))
    velocity = (0.1, -0.2, -1.0)
    state = State((1.0, 0.0, 0.0), (0.2, -1.5 * turning, 0.3), velocity, 1.0)
    before = np.array([gap_rate(state, one) for one in top.body.contacts])
    slopes = np.array([-2.0, 3.0])
    matrix = 1.0 + np.outer(slopes, slopes) / 1.5
    compression = np.linalg.solve(matrix, -before)
    assert np.all(compression > 0.0)
    for order in (top.body.contacts, top.body.contacts[::-1]):
        found = impact(state, restitution, *order)
        after = np.array([gap_rate(found.state, one) for one in top.body.contacts])
        assert after == pytest.approx(-restitution * before, abs=1e-13)
        full = (1.0 + restitution) * compression.sum()
        assert found.impulse == pytest.approx(full, rel=1e-13)
        lost = 0.5 * (1.0 - restitution**2) * before @ compression * -1.0
        assert found.energy_lost == pytest.approx(lost, abs=1e-13)


def test_an_end_that_the_other_opens_has_no_impulse():
    """A_12 > 0: the impulse of the end that sinks fast lifts the slow one more than it needs."""
    top = rod(ViscousLaw(0.0), (2.0, 0.5))
    state = State((1.0, 0.0, 0.0), (0.0, 0.9, 0.0), (0.0, 0.0, 0.2), 1.0)
    before = np.array([gap_rate(state, one) for one in top.body.contacts])
    assert before == pytest.approx([-1.0, -0.1], abs=1e-14)
    slopes = np.array([-2.0, -0.5])
    matrix = 1.0 + np.outer(slopes, slopes) / 1.5
    single = before + matrix[:, 0] / matrix[0, 0]
    assert single[1] > 0.0
    found = impact(state, 0.0, *top.body.contacts)
    after = np.array([gap_rate(found.state, one) for one in top.body.contacts])
    assert after == pytest.approx(single, abs=1e-13)


LAWS = {
    "coulomb": (CoulombLaw(0.6), None),
    "patch": (EllipsoidalLaw(0.6, 0.3), None),
    "regularized": (RegularizedCoulombLaw(0.6, 1e-4), None),
    "rolling": (CoulombLaw(0.6), RollingResistance(1e-3)),
    "viscous and rolling": (ViscousLaw(0.6), RollingResistance(1e-3)),
}


@pytest.mark.parametrize("restitution", [0.0, 0.5])
@pytest.mark.parametrize(("law", "resistance"), LAWS.values(), ids=LAWS)
def test_a_rod_that_falls_flat_without_slip_keeps_its_velocity_along_the_table(
    law, resistance, restitution
):
    """Nothing slips, turns or tilts: friction holds that, and both ends rebound alike."""
    top = rod(law, (2.0, -2.0), resistance)
    falling = State((1.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, -1.0), 1.0)
    found = impact(falling, restitution, *top.body.contacts)
    assert found.state.velocity == pytest.approx((0.0, 0.0, restitution), abs=1e-13)
    assert found.state.momentum == pytest.approx((0.0, 0.0, 0.0), abs=1e-13)
    assert found.impulse == pytest.approx(1.0 + restitution, rel=1e-13)


@pytest.mark.parametrize("mu", [0.5, 2.2, 3.0])
@pytest.mark.parametrize("law", [CoulombLaw, lambda mu: EllipsoidalLaw(mu, 0.2)])
def test_slip_that_ends_on_two_contacts_is_held(law, mu):
    """Where both ends stick, both stand still: the body turns at most about the line through both.

    The second end strikes, and presses the first.
    """
    stuck = 0
    random = np.random.default_rng(11)
    for _ in range(12):
        top = rod(law(mu))
        first, second = top.body.contacts
        turning = random.uniform(0.5, 1.0)
        momentum = (0.1, -1.5 * turning, 0.05 * random.normal())
        slip = 0.1 * random.normal(size=2)
        state = on_table(SlidingState((1.0, 0.0, 0.0), momentum, tuple(slip)), first)
        assert gap_rate(state, second) < -1.0
        found = impact(state, 0.0, second, first)
        assert gap_rate(found.state, second) == pytest.approx(0.0, abs=1e-13)
        assert gap_rate(found.state, first) >= -1e-13
        slips = [slip_of(*along_table(found.state), one) for one in top.body.contacts]
        if max(math.hypot(*slip) for slip in slips) < 1e-12:
            stuck += 1
            assert found.state.velocity[2] == pytest.approx(0.0, abs=1e-12)
        assert found.energy_lost > 0.0
    assert stuck > (0 if mu < 1.0 else 6)


PRESSING = tt.Problem(
    body=tt.Body(
        mass=0.02,
        shape=[
            tt.Sphere(radius=0.018463811627989064, center=-0.004163555423512806),
            tt.Spheroid(
                across=0.003840202630606464,
                along=0.01724373062303097,
                center=0.025190944904910778,
            ),
        ],
        I1=2.623978851513451e-6,
        I3=2.4279328787963386e-6,
    ),
    friction=tt.ContensouFriction(
        mu=0.5000212642951266, patch_radius=0.0003367242957653369, pressure="ellipsoidal"
    ),
    launch=tt.Launch(
        tilt=1.9570269865220522,
        spin=-42.67814675827212,
        azimuth=-1.9936331136203693,
        tilt_rate=-80.87257557231102,
        precession=29.881432388991957,
        slip=(0.5591050686375173, 0.5895356337310476),
        gap=0.0,
    ),
    contact=tt.Contact(liftoff="fly"),
)
"""A body that touches with both surfaces, of which the first strikes and presses the second."""


@pytest.mark.filterwarnings("ignore::tippetop.Implausible")
def test_an_impact_that_presses_another_contact_meanwhile_counts_both():
    """With both contacts integrated over the impulse in 30,000 steps the second slips so, and not
    by (1.0886, -0.4877) m/s, as on the first alone.
    """
    launch = NaturalLaunch.of(PRESSING)
    state, speed = launch.first.state, launch.units.speed
    assert [event.kind for event in launch.first.events][:1] == [EventKind.IMPACT]
    slip = slip_of(*along_table(state), launch.top.body.contacts[1])
    assert [speed * part for part in slip[:2]] == pytest.approx((0.6965, -0.3121), abs=1e-4)
    assert gap_rate(state, launch.top.body.contacts[1]) > 0.0


def test_what_touches_without_an_impulse_sticks_only_if_friction_can_hold_it():
    """A ball that rolls in narrow circles needs far more than mu N to do so."""
    top = Top.of(1.0, 0.45, 0.38, SphereSurface(1.0, 0.3), CoulombLaw(0.1), 1.0)
    axis = (math.sin(1.0), 0.0, math.cos(1.0))
    sliding = SlidingState(axis, (300.0, 100.0, 200.0), (0.0, 0.0))
    slip = slip_of(*sliding, top)
    state = on_table(sliding._replace(velocity=(-slip[0], -slip[1])), top)
    x, y, z = state.velocity
    state = state._replace(velocity=(x, y, z - 2e-12))
    assert gap_rate(state, top) < -1e-12
    following = Automaton(top, "fly", 0.0).touchdown(top, 0.0, state)
    assert EventKind.IMPACT not in [event.kind for event in following.events]
    assert not (isinstance(following.next, ContactMode) and following.next.sticks[0])
