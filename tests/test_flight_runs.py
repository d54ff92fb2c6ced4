"""Runs that leave the table: slides, flights and impacts as one."""

import itertools
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import brentq

import tippetop as tt
from campaigns import examples
from free_flight import fly
from independent_flights import Toy, slide_and_fly
from tippetop.contact.automaton import Automaton
from tippetop.mechanics.flight.free_motion import gap
from tippetop.mechanics.motion import along_table, sliding_contact
from tippetop.problem.presets import REPORT, report_problem
from tippetop.problem.problem import top_of

FIRST_LIFT_OFF = {175.0: 5.361332, 170.0: 5.85182}
"""Converged times of the first lift-off of the report's top launched at tilt 0.1 with mu 0.3 s/m.
"""

ONSET = 165.0900
"""Converged spin beyond which that launch leaves the table, rad/s."""


def test_without_lift_off_flying_and_bilateral_contact_are_the_same_run():
    free = tt.simulate(report_problem(155.0), 20.0)
    held = tt.simulate(report_problem(155.0).replace({"contact.liftoff": "ignore"}), 20.0)
    assert free.sizes["event"] == 0
    assert np.abs(free.tilt - held.tilt).max() < 1e-11
    assert np.abs(free.spin - held.spin).max() < 1e-8


@pytest.mark.parametrize(("spin", "time"), FIRST_LIFT_OFF.items())
def test_first_lift_off(spin, time):
    run = tt.simulate(report_problem(spin), 6.0)
    assert run.event_kind[0] == "liftoff"
    assert float(run.event_time[0]) == pytest.approx(time, abs=1e-6)


def test_onset_of_lift_off():
    def leaves(spin):
        return tt.simulate(report_problem(spin), 20.0, samples=2).sizes["event"] > 0

    low, high = 160.0, 170.0
    assert leaves(high)
    assert not leaves(low)
    while high - low > 1e-5:
        middle = (low + high) / 2
        low, high = (low, middle) if leaves(middle) else (middle, high)
    assert high == pytest.approx(ONSET, abs=1e-4)


def test_an_independent_simulation_in_small_steps_flies_alike():
    before = tt.simulate(report_problem(175.0), 5.3, times=[5.3]).isel(time=-1)
    launch = {
        "tilt": float(before.tilt),
        "tilt_rate": float(before.tilt_rate),
        "precession": float(before.precession),
        "spin": float(before.spin),
        "slip": (float(before.slip_x), float(before.slip_y)),
    }
    problem = report_problem(175.0).replace(
        {f"launch.{name}": value for name, value in launch.items()}
    )
    duration = 0.45
    run = tt.simulate(problem, duration, samples=2)
    toy = Toy(m=0.02, R=0.02, alpha=0.3, I1=REPORT.I1, I3=REPORT.I3, mu=0.3, g=9.8)
    start = [
        launch["tilt"],
        launch["tilt_rate"],
        0.0,
        launch["precession"],
        launch["spin"],
        *launch["slip"],
    ]
    final, lifts, lands = slide_and_fly(toy, start, duration, 1e-5)

    kinds, times = run.event_kind.values, run.event_time.values
    assert len(lifts) > 5
    np.testing.assert_allclose(times[kinds == "liftoff"], lifts, atol=2e-8)
    np.testing.assert_allclose(times[kinds == "touchdown"], lands, atol=2e-8)
    last = run.isel(time=-1)
    ours = [float(last[name]) for name in ("tilt", "tilt_rate", "precession", "spin")]
    np.testing.assert_allclose(ours, final[[0, 1, 3, 4]], rtol=1e-5)


def thrown_across_a_gap(launch):
    """Return the launch with its slip as a velocity, where it begins above the table."""
    if not launch["launch.gap"]:
        return launch
    slip = launch.pop("launch.slip")
    return launch | {"launch.velocity": (*slip, 0.0)}


launches = st.fixed_dictionaries(
    {
        "launch.tilt": st.floats(0.0, math.pi),
        "launch.spin": st.floats(-300.0, 300.0),
        "launch.tilt_rate": st.floats(-30.0, 30.0),
        "launch.precession": st.floats(-100.0, 100.0),
        "launch.slip": st.tuples(st.floats(-1.0, 1.0), st.floats(-1.0, 1.0)),
        "launch.gap": st.one_of(st.just(0.0), st.floats(1e-6, 0.05)),
        "contact.restitution": st.sampled_from([0.0, 0.3, 0.8, 1.0]),
        "friction.mu": st.floats(0.0, 1.0),
    }
).map(thrown_across_a_gap)
bodies = st.one_of(
    st.builds(
        lambda e: tt.Body(
            mass=0.02, shape=tt.EccentricSphere(radius=0.02, eccentricity=e), I1=3e-6, I3=3.2e-6
        ),
        st.floats(0.05, 0.6),
    ),
    st.builds(
        lambda b: tt.Body(mass=0.02, shape=tt.Spheroid(across=0.02, along=b), I1=4e-6, I3=3.2e-6),
        st.floats(0.01, 0.04),
    ),
)


@settings(max_examples=examples(check=60, claim=3000))
@given(bodies, launches)
def test_what_must_hold_through_slides_flights_and_impacts(body, launch):
    problem = tt.Problem(
        body=body, friction=tt.ViscousFriction(mu=0.3), launch=tt.Launch(tilt=0.1, spin=1.0)
    ).replace(launch)
    run = tt.simulate(problem, 1.0, samples=200, mode_limit=150)
    assert run.status in {"completed", "too_many_modes"}
    energy = run.energy.values
    assert np.abs(energy - energy[0] - run.work.values).max() < 1e-10 * energy[0]
    losses = run.event_energy_lost.values
    assert (losses >= 0).all()
    assert (np.diff(run.work.values) <= 1e-13 * energy[0]).all()
    assert run.gap.values.min() > -1e-12
    sliding = run.mode.values == "sliding"
    assert (run.normal_force.values[sliding] > -1e-12).all()
    if isinstance(body.shape, tt.EccentricSphere):
        moment = np.linalg.norm(run.angular_momentum.values[0]) * 2 * body.shape.radius
        assert np.ptp(run.jellett.values) <= 1e-11 * max(moment, 1e-9)


def test_samples_inside_a_flight_lie_on_the_flight():
    problem = report_problem(100.0, tilt=1.0).replace(
        {"launch.gap": 0.05, "launch.velocity": (0.1, -0.2, 0.3)}
    )
    run = tt.simulate(problem, 0.1, samples=50)
    assert (run.mode == "flight").all()
    t = run.time.values
    np.testing.assert_allclose(run.height, run.height[0].item() + 0.3 * t - 4.9 * t**2, rtol=1e-12)
    np.testing.assert_allclose(run.x, 0.1 * t, atol=1e-15)
    np.testing.assert_allclose(
        run.angular_momentum, np.broadcast_to(run.angular_momentum[0], (50, 3))
    )
    assert (run.normal_force == 0).all()


def test_a_dropped_top_falls_and_bounces_back_by_its_restitution():
    drop, restitution = 0.02, 0.6
    problem = report_problem(0.0, tilt=0.0).replace(
        {"launch.gap": drop, "contact.restitution": restitution}
    )
    run = tt.simulate(problem, 1.0)
    falls = math.sqrt(2 * drop / 9.8)
    touchdowns = run.event_time.values[run.event_kind.values == "touchdown"]
    assert touchdowns[0] == pytest.approx(falls, rel=1e-12)
    assert touchdowns[1] - touchdowns[0] == pytest.approx(2 * restitution * falls, rel=1e-9)
    assert touchdowns[2] - touchdowns[1] == pytest.approx(2 * restitution**2 * falls, rel=1e-9)
    rest = falls * (1 + 2 * restitution / (1 - restitution))
    assert touchdowns[-1] == pytest.approx(rest, abs=1e-5)
    assert run.mode.values[-1] == "sliding"
    weight = 0.02 * 9.8
    assert run.event_energy_lost.values.sum() == pytest.approx(weight * drop, rel=1e-9)
    assert float(run.flight_max_gap[1]) == pytest.approx(drop * restitution**2, rel=1e-6)


def test_a_perfectly_elastic_bounce_never_ends_and_loses_nothing():
    problem = report_problem(0.0, tilt=0.0).replace(
        {"launch.gap": 0.001, "contact.restitution": 1.0}
    )
    run = tt.simulate(problem, 10.0, mode_limit=100)
    assert run.status == "too_many_modes"
    assert "mode_limit" in run.message
    assert run.sizes["flight"] == 100
    assert run.energy.values[-1] == pytest.approx(run.energy.values[0], rel=1e-12)


def test_a_launch_that_the_table_would_have_to_hold_starts_in_flight():
    # Above the centre of the sphere, the centre of mass needs a downward pull to swing round it so
    # fast.
    problem = report_problem(0.0, tilt=2.5).replace({"launch.tilt_rate": 60.0})
    held = tt.simulate(problem.replace({"contact.liftoff": "ignore"}), 1e-4, samples=2)
    assert float(held.normal_force[0]) < 0
    run = tt.simulate(problem, 0.01)
    assert float(run.event_time[0]) == 0.0
    assert run.event_kind[0] == "liftoff"
    assert float(run.flight_start[0]) == 0.0
    assert float(run.gap[1]) > 0
    stopped = tt.simulate(problem.replace({"contact.liftoff": "stop"}), 0.01)
    assert stopped.status == "lifted_off"
    assert stopped.time.values.tolist() == [0.0]


def test_a_launch_in_painleves_paradox_starts_with_an_impact():
    paradox = report_problem(0.0, tilt=1.5, mu=100.0).replace({"launch.slip": (10.0, 0.0)})
    run = tt.simulate(paradox, 0.01)
    assert run.event_kind[0] == "impact"
    assert float(run.event_impulse[0]) > 0
    assert float(run.event_energy_lost[0]) > 0
    assert np.hypot(run.slip_x, run.slip_y).values[0] <= 10.0
    with pytest.raises(tt.InvalidInput, match="Painleve"):
        paradox.replace({"contact.liftoff": "stop"})


def test_an_indeterminate_contact_force_is_reported_and_what_follows_can_be_chosen():
    """A < 0 < b: the contact opens without a force, or is struck, and both are consistent."""
    paradox = report_problem(100.0, tilt=1.5, mu=100.0).replace(
        {"launch.slip": (10.0, 0.0), "launch.precession": 60.0}
    )
    touch = sliding_contact(*along_table(paradox.start()), top_of(paradox))
    assert touch.delassus < 0.0 < touch.free_acceleration
    struck = tt.simulate(paradox, 1e-4)
    assert struck.event_kind[:2].values.tolist() == ["indeterminate force", "impact"]
    assert float(struck.event_impulse[1]) > 0
    opened = tt.simulate(paradox.replace({"contact.indeterminate": "liftoff"}), 1e-4, samples=3)
    assert opened.event_kind.values.tolist() == ["indeterminate force", "liftoff"]
    rise = 0.5 * float(touch.free_acceleration) * opened.time.values**2
    assert opened.gap.values == pytest.approx(rise, rel=1e-2)
    for run in (struck, opened):
        assert "indeterminate" in run.attrs["message"]
    without_flights = Automaton(top_of(paradox), "stop", 0.0, "impact")
    transition = without_flights.resting(top_of(paradox), 0.0, paradox.start())
    assert transition.next is tt.Status.FAILED
    assert "needs contact.liftoff = fly" in transition.detail


def test_a_force_that_friction_makes_inconsistent_is_not_called_indeterminate():
    paradox = report_problem(0.0, tilt=1.5, mu=100.0).replace({"launch.slip": (10.0, 0.0)})
    touch = sliding_contact(*along_table(paradox.start()), top_of(paradox))
    assert touch.delassus < 0.0
    assert touch.free_acceleration < 0.0
    for choice in ("impact", "liftoff"):
        run = tt.simulate(paradox.replace({"contact.indeterminate": choice}), 1e-4)
        assert run.event_kind[0] == "impact"
        assert "indeterminate" not in run.attrs["message"]


@pytest.mark.parametrize("friction", [tt.ViscousFriction(mu=0.3), tt.CoulombFriction(mu=0.3)])
@pytest.mark.parametrize("azimuth", [0.0, 0.7])
def test_a_coin_tossed_without_spin_tumbles_on_its_edges_until_it_lies_flat(friction, azimuth):
    """Between impacts it turns uniformly in one plane, its centre of mass on a parabola."""
    problem = tt.Problem(
        body=tt.presets.COIN,
        friction=friction,
        launch=tt.Launch(tilt=1.2, spin=0.0, gap=0.01, azimuth=azimuth),
        contact=tt.Contact(restitution=0.5),
    )
    run = tt.simulate(problem, 0.3, samples=20_001)
    assert run.attrs["status"] == ("at_rest" if friction.kind == "coulomb" else "completed")
    (down,) = run.event_time.values[run.event_kind.values == "lies down"]
    run = run.sel(time=slice(0.0, float(down)))
    touchdowns = run.event_time.values[run.event_kind.values == "touchdown"]
    assert touchdowns[0] == pytest.approx(math.sqrt(2 * 0.01 / 9.8), rel=1e-12)
    assert float(run.energy_error) < 1e-12
    radius, half = 0.023_25 / 2, 2.33e-3 / 2
    times, tilts, heights = run.time.values, run.tilt.values, run.height.values
    gaps = heights - radius * np.sin(tilts) - half * np.abs(np.cos(tilts))
    turned = 0
    for begin, end in itertools.pairwise(touchdowns[:8]):
        flight = (times > begin) & (times < end)
        t = times[flight] - begin
        assert gaps[flight].min() > 0.0
        fall = np.polynomial.Polynomial.fit(t, heights[flight], 2)
        assert np.abs(heights[flight] - fall(t)).max() < 1e-13
        assert fall.deriv(2)(0.0) == pytest.approx(-9.8, rel=1e-5)
        # Beyond a pole the tilt comes back: as a polynomial in time its cosine is that of a
        # straight line.
        rates = np.diff(tilts[flight]) / np.diff(t)
        assert np.ptp(np.abs(rates[[0, -1]])) < 1e-6 * np.abs(rates[0])
        turned += rates[0] * rates[-1] < 0.0
        # At the touchdown the gap has just closed.
        closing = fall(end - begin) - (
            radius * np.sin(tilts[flight][-1] + rates[-1] * (end - times[flight][-1]))
        )
        assert closing == pytest.approx(half * abs(math.cos(tilts[flight][-1])), abs=1e-6)
    assert turned, "it is to pass flat on its way"


def test_a_flight_that_is_cut_short_rose_no_higher_than_it_was_followed():
    """It rises as its centre of mass does, whose height is a parabola in time, to within its
    size.
    """
    launch = tt.Launch(tilt=1.2, spin=1e6, tilt_rate=1e6 / 3, gap=0.05, velocity=(0.0, 0.0, 3000.0))
    problem = tt.Problem(body=tt.presets.COIN, friction=tt.CoulombFriction(mu=0.3), launch=launch)
    run = tt.simulate(problem, 0.05, samples=11, step_limit=5000)
    assert run.attrs["status"] == "too_many_steps"
    flown = float(run["end_time"])
    rise = float(run["velocity"][0, 2]) * flown - 0.5 * problem.gravity * flown**2
    highest = float(run["max_gap"])
    assert rise > 1.0
    assert abs(highest - 0.05 - rise) < 0.024
    assert highest == float(run["flight_max_gap"][-1])


def test_a_body_with_two_maxima_of_its_support_function_lands_at_its_first_touch():
    """It turns past the second maximum while it has fallen by little; in one run and in a sweep."""
    radius, part = 0.02, 0.06
    support = [radius * (1 + part), 0.0, -8 * part * radius, 0.0, 8 * part * radius]
    inertia = 0.4 * 0.02 * radius**2
    problem = tt.Problem(
        body=tt.Body(
            mass=0.02, shape=tt.Oval(support=support + [0.0] * 12), I1=inertia, I3=inertia
        ),
        friction=tt.ViscousFriction(mu=0.3),
        launch=tt.Launch(
            tilt=math.acos(0.8),
            spin=188.0,
            precession=-188 * 0.8 / 0.36,
            gap=5e-4,
            velocity=(0, 0, 0),
        ),
    )
    top, state = top_of(problem), problem.start()

    def gap_at(time):
        return gap(fly(state, time, top, np), top)

    looks = np.linspace(0.0, 0.02, 200_001)
    first = int(np.flatnonzero(gap_at(looks) <= 0.0)[0])
    touch = brentq(lambda time: float(gap_at(time)), looks[first - 1], looks[first], xtol=1e-18)
    assert touch == pytest.approx(2.90750839e-3, abs=1e-11)
    run = tt.simulate(problem, 0.05)
    assert run.event_kind.values[0] == "touchdown"
    assert float(run.event_time[0]) == pytest.approx(touch, abs=1e-14)
    assert float(run.gap.min()) > -1e-12 * radius
    swept = tt.sweep(problem, {"gravity": [9.8]}, duration=0.05, workers=1, tolerance=1e-12)
    assert float(swept.final_tilt[0]) == pytest.approx(float(run.final_tilt), abs=1e-8)
    airborne = tt.sweep(problem, {"gravity": [9.8]}, duration=3.1e-3, workers=1)
    assert float(airborne.airborne_time[0]) == pytest.approx(touch, abs=1e-12)
