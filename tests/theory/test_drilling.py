"""What drilling does to vertical spins: creep, a slow clock, and how long a top stands, against
runs.
"""

import math

import numpy as np
import pytest
from hypothesis import given
from scipy.integrate import cumulative_simpson
from test_stability_of_steady_states import assert_same_numbers
from typer.testing import CliRunner

import tippetop as tt
from campaigns import among
from strategies import numbers
from tippetop import presets
from tippetop.cli.commands import app
from tippetop.mechanics.invariants import jellett
from tippetop.mechanics.laws.coulomb import CoulombLaw, RollingResistance
from tippetop.mechanics.laws.friction import ViscousLaw
from tippetop.mechanics.motion import along_table, angular_velocity, sliding_contact
from tippetop.mechanics.state import State
from tippetop.problem.problem import top_of
from tippetop.theory.apparent import critical_spin_from_spectrum
from tippetop.theory.drilling import spin_rate, standing_time, time_to_stand
from tippetop.theory.outlook import outlook
from tippetop.theory.prospects import prospects
from tippetop.theory.stability import (
    drilling,
    eigenvalues,
    linear_tilts,
    spectrum,
)
from tippetop.theory.steady import (
    VERTICAL_SPINS,
    SteadyKind,
    precession_branch,
    state_of,
    steady_states,
    vertical_spin,
)
from tippetop.theory.thresholds import critical_spin, critical_spins

PRESSURES = ["hertz", "ellipsoidal"]
CREEP = {"hertz": 3.0 * math.pi / 8.0, "ellipsoidal": 16.0 / (3.0 * math.pi)}
"""Force per unit mu N of a patch that drills, over kappa = v / (R omega), for little slip."""


def patch(pressure="hertz", mu=0.3, radius=5e-4, tilt=math.pi, spin=100.0):
    """The report's top with a patch, on a table that may pull."""
    problem = presets.report_problem(spin=spin, tilt=tilt).replace({"contact.liftoff": "ignore"})
    friction = {"kind": "contensou", "mu": mu, "patch_radius": radius, "pressure": pressure}
    return problem.replace({f"friction.{name}": value for name, value in friction.items()})


def poles_of(run):
    """Distance of the axis from the vertical, rad."""
    return np.hypot(run["axis"].values[:, 0], run["axis"].values[:, 1])


@pytest.mark.parametrize("pressure", PRESSURES)
@pytest.mark.parametrize("kind", VERTICAL_SPINS)
def test_about_a_vertical_spin_drilling_makes_dry_friction_viscous(pressure, kind):
    top = top_of(patch(pressure))
    for spin in (30.0, 150.0, -80.0):
        mu = 0.3 * CREEP[pressure] / (5e-4 * abs(spin))
        dry, viscous = (
            eigenvalues(vertical_spin(kind, some, spin), some)
            for some in (top, top.altered(friction=ViscousLaw(mu)))
        )
        assert dry == pytest.approx(viscous, abs=1e-13 * np.abs(viscous).max())
        assert_same_numbers(spectrum(vertical_spin(kind, top, spin), top).eigenvalues, dry[0], 1e-9)


@pytest.mark.parametrize("pressure", PRESSURES)
@pytest.mark.parametrize("kind", VERTICAL_SPINS)
def test_the_spectrum_changes_sign_where_jelletts_integral_says(pressure, kind):
    top = top_of(patch(pressure))
    assert critical_spin_from_spectrum(kind, top) == pytest.approx(
        critical_spin(kind, top), rel=1e-9
    )
    viscous = critical_spins(presets.report_problem(tilt=0.0))
    found = critical_spins(patch(pressure, tilt=0.1))
    assert found.upright == pytest.approx(viscous.upright, rel=1e-12)
    assert found.inverted == pytest.approx(critical_spin(SteadyKind.INVERTED, top), rel=1e-12)


@pytest.mark.parametrize("pressure", PRESSURES)
def test_a_small_tilt_grows_as_the_spectrum_says(pressure):
    """With so small a patch and so little friction that drilling takes next to no spin
    meanwhile.
    """
    problem = patch(pressure, mu=1e-5, radius=1e-6, tilt=1e-9)
    top, times = top_of(problem), np.linspace(0.0, 10.0, 2001)
    steady = vertical_spin(SteadyKind.UPRIGHT, top, 100.0)
    run = tt.simulate(problem, 10.0, times=times)
    lost = 100.0 - float(run["spin"][-1])
    assert 0.0 < lost < 1e-5
    linear = linear_tilts(steady, top, along_table(problem.start()), times[::200])
    assert poles_of(run)[::200] == pytest.approx(linear, rel=1e-5)
    late = times > 6.0
    rate = np.polyfit(times[late], np.log(poles_of(run)[late]), 1)[0]
    assert rate == pytest.approx(spectrum(steady, top).growth_rate, rel=1e-3)


@pytest.mark.parametrize("pressure", among(PRESSURES, check=1))
def test_jelletts_integral_changes_by_the_torque_times_the_height_whatever_the_motion(pressure):
    problem = patch(pressure, tilt=0.1).replace({"launch.slip": (0.2, 0.1)})
    run = tt.simulate(problem, 2.0, samples=40_001)
    rows = [*run["axis"].values.T, *run["angular_momentum"].values.T]
    integral = jellett(State.unpack([*rows, 0.0, 0.0, 0.0, 0.0]), top_of(problem))
    rate = run["contact_torque"].values[:, 2] * run["height"].values
    taken = cumulative_simpson(rate, x=run["time"].values, initial=0.0)
    assert integral[-1] < 0.9 * integral[0]
    assert integral - integral[0] == pytest.approx(taken, abs=1e-7 * integral[0])


@pytest.mark.parametrize("pressure", PRESSURES)
def test_a_steady_state_loses_jelletts_integral_at_one_rate_per_height(pressure):
    """(3 pi / 16) mu m g R, whatever turns."""
    top = top_of(patch(pressure))
    for integral in (4e-6, -1.9e-6):
        for steady in steady_states(top, integral):
            height = top.surface.height(math.cos(steady.tilt))
            torque = 3.0 * math.pi / 16.0 * 0.3 * 0.02 * 9.8 * 5e-4
            expected = -math.copysign(torque * height, integral)
            axis, momentum, velocity = state_of(steady, top)
            turning = angular_velocity(axis, momentum, top)[2]
            touch = sliding_contact(axis, momentum, velocity, drilling(top, np.array([turning])))
            assert -touch.torque[2] * touch.arm[2] == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("pressure", PRESSURES)
@pytest.mark.parametrize("tilt", [0.0, math.pi])
def test_a_vertical_spin_loses_spin_at_a_constant_rate_until_it_stops(pressure, tilt):
    problem = patch(pressure, radius=2e-3, tilt=tilt, spin=20.0)
    kind = SteadyKind.INVERTED if tilt else SteadyKind.UPRIGHT
    rate = spin_rate(vertical_spin(kind, top_of(problem), 20.0), top_of(problem))
    run = tt.simulate(problem, 2.0, samples=501)
    assert run["spin"].values == pytest.approx(20.0 + rate * run["time"].values, abs=1e-9)
    stop = run["event_time"].values[run["event_kind"].values == "stick"]
    assert stop == pytest.approx([20.0 / -rate], rel=1e-9)
    assert run.attrs["status"] == "at_rest"
    assert float(run["time"][-1]) == pytest.approx(20.0 / -rate, rel=1e-9)
    assert float(run["spin"][-1]) == pytest.approx(0.0, abs=1e-15)


@pytest.mark.parametrize("pressure", PRESSURES)
def test_a_top_stands_until_it_has_too_little_spin(pressure):
    """Launched beside it in the motion that is to grow, it comes closer until then, and leaves from
    then on.

    The patch is so small that the spin changes by little while that motion decays or grows.
    """
    problem = patch(pressure, mu=6e-3, radius=6e-5, tilt=math.pi - 1e-8, spin=42.3)
    top, standing = top_of(problem), standing_time(problem.replace({"launch.tilt": math.pi}))
    limit = critical_spin(SteadyKind.INVERTED, top)
    rate = spin_rate(vertical_spin(SteadyKind.INVERTED, top, 42.3), top)
    assert standing == pytest.approx((42.3 - limit) / abs(rate), rel=1e-12)
    turning = eigenvalues(vertical_spin(SteadyKind.INVERTED, top, limit), top)[0, 0].imag
    launch = problem.replace({"launch.precession": -abs(turning)})
    run = tt.simulate(launch, 2.0 * standing, samples=8001)
    late = run["time"].values > 0.2 * standing
    bend, slope, _ = np.polyfit(run["time"].values[late], np.log(poles_of(run)[late]), 2)
    assert bend > 0.0
    assert -slope / (2.0 * bend) == pytest.approx(standing, rel=0.01)


def test_half_the_friction_takes_twice_the_time():
    times = [standing_time(patch(mu=mu)) for mu in (0.3, 0.15)]
    radii = [standing_time(patch(radius=radius)) for radius in (5e-4, 2.5e-4)]
    assert times[1] == pytest.approx(2.0 * times[0], rel=1e-12)
    assert radii == pytest.approx(times, rel=1e-12)


@given(numbers(1.0, 500.0), numbers(0.05, 1.0))
def test_a_launch_that_leans_is_told_the_time_of_the_inverted_spin_with_its_integral(spin, tilt):
    problem = patch(spin=spin, tilt=tilt)
    inverted = -spin * (math.cos(tilt) - 0.3) / 1.3
    here, there = standing_time(problem), standing_time(patch(spin=inverted))
    assert here == pytest.approx(there, rel=1e-9)
    assert (here == 0.0) == (abs(inverted) < critical_spin(SteadyKind.INVERTED, top_of(problem)))


def test_a_slow_upright_spin_stands_until_it_stops_and_a_fast_one_not_at_all():
    slow, fast = (patch(tilt=0.0, spin=spin) for spin in (20.0, 40.0))
    rate = spin_rate(vertical_spin(SteadyKind.UPRIGHT, top_of(slow), 20.0), top_of(slow))
    assert standing_time(slow) == pytest.approx(20.0 / abs(rate), rel=1e-12)
    assert standing_time(fast) == 0.0


def test_what_does_not_drill_stands_for_ever_or_not_at_all():
    for spin, time in ((100.0, math.inf), (30.0, 0.0)):
        assert standing_time(presets.report_problem(spin=spin, tilt=math.pi)) == time


def test_a_top_stands_on_its_stem_until_its_spin_is_the_least_that_holds_it():
    """Upside down it stands on the tip, whose radius and place count, and not on the sphere."""
    body = presets.REPORT_STEM
    problem = patch(spin=150.0).replace({"body": body, "contact.liftoff": "fly"})
    time = standing_time(problem)
    run = tt.simulate(problem, time, samples=2)
    tip = top_of(problem.replace({"body": body.model_copy(update={"shape": body.shapes[-1]})}))
    least = critical_spin(SteadyKind.INVERTED, tip)
    assert abs(float(run["final_spin"])) == pytest.approx(least, rel=1e-9)
    torque = 3.0 * math.pi / 16.0 * 0.3 * body.mass * problem.gravity * 5e-4
    assert time == pytest.approx((150.0 - least) * body.I3 / torque, rel=1e-12)
    # Launched on its sphere it comes onto the tip with less, and the least spin that does is 0 s.
    ahead = prospects(body, list(body.shapes)).stem
    for factor in (1.0 + 1e-9, 1.3):
        launched = problem.replace(
            {"launch.tilt": 0.1, "launch.spin": factor * ahead.launch, "contact.liftoff": "fly"}
        )
        inverted = standing_time(problem.replace({"launch.spin": factor * ahead.spin}))
        assert standing_time(launched) == pytest.approx(inverted, rel=1e-6, abs=1e-7)
    weak = problem.replace({"launch.tilt": 0.1, "launch.spin": 0.99 * ahead.launch})
    assert standing_time(weak) == 0.0
    ring = tt.Ring(radius=0.0195, center=0.013)
    ringed = body.model_copy(update={"shape": (*body.shapes, ring)})
    with pytest.raises(tt.InvalidInput, match="touches first"):
        standing_time(problem.replace({"body": ringed, "launch.tilt": 0.1}))


def test_what_the_theory_cannot_tell_is_refused_in_a_sentence():
    problem, top = patch(), top_of(patch())
    still = vertical_spin(SteadyKind.INVERTED, top, 0.0)
    leaning = steady_states(top, 4e-6)[0]
    branch = precession_branch(top, np.array([1.5]))
    egg = problem.replace(
        {"body.shape.kind": "spheroid", "body.shape.across": 0.02, "body.shape.along": 0.03}
    )
    asks = [
        ("spin: 0 .* without drilling", lambda: time_to_stand(still, top)),
        ("spin: 0 .* without drilling", lambda: outlook(problem.replace({"launch.spin": 0.0}))),
        ("friction: .* without torque", lambda: eigenvalues(branch, top)),
        (
            "rolling_resistance: 1e-05",
            lambda: eigenvalues(branch, _on(ViscousLaw(0.3), RollingResistance(1e-5))),
        ),
        ("friction: .* without torque", lambda: tt.predict(problem)),
        (
            "friction: .*may roll for ever",
            lambda: spectrum(leaning, _on(CoulombLaw(0.3))),
        ),
        (
            "rolling_resistance: 1e-05",
            lambda: spectrum(leaning, _on(ViscousLaw(0.3), RollingResistance(1e-5))),
        ),
        ("body.shape", lambda: standing_time(egg.replace({"launch.tilt": 0.1}))),
        ("kind: 'precession'", lambda: time_to_stand(steady_states(top, 1.9e-6)[1], top)),
    ]
    for sentence, ask in asks:
        with pytest.raises(tt.InvalidInput, match=sentence):
            ask()


@pytest.mark.parametrize("pressure", PRESSURES)
def test_one_ball_on_top_of_the_other_stands_no_time(pressure):
    """Inverted on one ball the centre of mass is on the table, and no spin has the lambda of a
    launch.
    """
    balls = patch(pressure).replace({"contact.liftoff": "fly", "body": presets.HURRICANE_BALLS})
    for problem in (balls, balls.replace({"launch.tilt": 0.5})):
        assert standing_time(problem) == outlook(problem).standing_time == 0.0
    lower = balls.replace({"body.shape": presets.HURRICANE_BALLS.shapes[0], "launch.tilt": 0.5})
    assert standing_time(lower) == 0.0


def _on(law, resistance=None):
    return top_of(patch()).altered(friction=law, rolling_resistance=resistance)


def test_the_outlook_of_a_top_that_drills_ends_nowhere_and_stands_a_while():
    for tilt in (0.0, 0.1, math.pi):
        found = outlook(patch(tilt=tilt))
        assert not found.conserved
        assert (found.stays, found.prediction, found.arrival_time, found.group) == (
            None,
            None,
            None,
            None,
        )
        assert found.standing_time == standing_time(patch(tilt=tilt))
        assert [judged.state.kind for judged in found.steady] == list(VERTICAL_SPINS)
    assert outlook(presets.report_problem()).conserved
    assert outlook(presets.report_problem()).standing_time is None


def test_the_command_line_says_how_long_it_stands():
    changes = ["--set", "friction.kind=contensou", "--set", "friction.patch_radius=5e-4", "--tilt"]
    told = CliRunner().invoke(app, ["critical", *changes, str(math.pi), "--spin", "100"])
    assert f"drilling lets it stand {standing_time(patch()):.6g} s".split() == next(
        line.split() for line in told.stdout.splitlines() if "lets it stand" in line
    )
    assert "not conserved" in told.stdout
    assert "would stand" in CliRunner().invoke(app, ["critical", *changes, "0.1"]).stdout


@pytest.mark.parametrize("pressure", among(PRESSURES, check=1))
def test_while_drilling_takes_the_spin_a_small_tilt_grows_as_one_over_it(pressure):
    """Times its decay by the spectrum: the vertical torque leaves the horizontal angular momentum
    alone.
    """
    body = {"mass": 0.02, "shape": {"kind": "spheroid", "across": 0.02, "along": 0.0232}}
    problem = tt.Problem(
        body={**body, "I1": 2.88e-6, "I3": 3.2e-6},
        friction={"kind": "contensou", "mu": 0.3, "patch_radius": 1e-3, "pressure": pressure},
        launch={"tilt": 1e-5, "spin": 300.0},
    )
    run = tt.simulate(problem, 2.0, samples=3)
    spins = run["spin"].values
    upright = vertical_spin(SteadyKind.UPRIGHT, top_of(problem), spins)
    decay = math.exp(
        (eigenvalues(upright, top_of(problem))[:, 0].real * [1.0, 4.0, 1.0]).sum() / 3.0
    )
    assert decay < 1.0
    growth = run["tilt"].values[-1] / run["tilt"].values[0]
    assert growth == pytest.approx(decay * spins[0] / spins[-1], rel=5e-3)
    assert growth > 1.05
