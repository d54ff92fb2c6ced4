"""Steady rolling: balances of momentum by hand, circles of a disk, heavy tops, and runs."""

import json
import math
from itertools import combinations

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from typer.testing import CliRunner

import tippetop as tt
from strategies import numbers
from tippetop import presets
from tippetop.cli.commands import app
from tippetop.problem.problem import top_of
from tippetop.theory.stability import spectrum as sliding_spectrum
from tippetop.theory.steady import SteadyKind, precession_branch

G = 9.81
VERTICAL = np.array([0.0, 0.0, 1.0])


def rolling(shape, mass=0.05, I1=1e-5, I3=1.5e-5, friction=None):
    body = tt.Body(mass=mass, shape=shape, I1=I1, I3=I3)
    friction = friction or tt.CoulombFriction(mu=100.0)
    return tt.Problem(body=body, friction=friction, gravity=G, launch=tt.Launch(tilt=1.5, spin=1.0))


def thin_disk(radius=0.02, mass=0.05, friction=None):
    I1 = 0.25 * mass * radius**2
    return rolling(tt.Ring(radius=radius), mass, I1, 2.0 * I1, friction)


SPHERE = tt.EccentricSphere(radius=0.02, eccentricity=0.3)
RING = tt.Ring(radius=0.02, center=-0.004)
TUBE = tt.Ring(radius=0.02, center=0.003, tube=0.006)


def arm_of(shape, tilt):
    """From the centre of mass to the lowest point, by elementary geometry."""
    axis = np.array([math.sin(tilt), 0.0, math.cos(tilt)])
    if shape is SPHERE:
        return shape.radius * shape.eccentricity * axis - shape.radius * VERTICAL
    up = np.array([-math.cos(tilt), 0.0, math.sin(tilt)])
    return shape.center * axis - shape.radius * up - shape.tube * VERTICAL


def unbalanced(problem, state):
    """Return the moment that is missing for the motion to be steady, over the largest one, and the
    radius of the centre of mass's circle.
    """
    body = problem.body
    axis = np.array([math.sin(state.tilt), 0.0, math.cos(state.tilt)])
    rate, spin = state.precession * VERTICAL, state.spin
    across = rate - (rate @ axis) * axis
    arm = arm_of(body.shape, state.tilt)
    velocity = -np.cross(across + spin * axis, arm)
    force = body.mass * (np.cross(rate, velocity) + G * VERTICAL)
    change = np.cross(rate, body.I1 * across + body.I3 * spin * axis)
    moment = np.cross(arm, force)
    scale = max(np.abs(change).max(), np.abs(moment).max(), body.mass * G * np.abs(arm).max())
    return np.abs(change - moment).max() / scale, abs(velocity[1] / state.precession)


@given(
    st.sampled_from([SPHERE, RING, TUBE]),
    numbers(0.1, 3.0),
    st.one_of(numbers(1.0, 80.0), numbers(-80.0, -1.0)),
)
def test_every_pair_of_numbers_returns_the_motion_that_balances_all_moments(shape, tilt, rate):
    problem = rolling(shape, friction=tt.CoulombFriction(mu=1e6))
    (state,) = tt.steady_states(problem, tilt=tilt, rate=rate)
    moment, radius = unbalanced(problem, state)
    assert moment < 1e-12
    assert state.radius == pytest.approx(radius, rel=1e-9, abs=1e-14)
    assert state.friction == pytest.approx(rate**2 * radius / G, rel=1e-9, abs=1e-11)
    assume(1e-3 < radius < 10.0 and abs(state.spin) > 1.0)
    every = {"tilt": tilt, "rate": abs(rate), "radius": radius, "spin": state.spin}
    if rate < 0.0:
        every["spin"] = -state.spin
    for pair in combinations(every, 2):
        found = tt.steady_states(problem, **{name: every[name] for name in pair})
        assert all(unbalanced(problem, one)[0] < 1e-8 for one in found)
        tilts = [one.tilt for one in found if abs(abs(one.precession) - abs(rate)) < 1e-5]
        assert min(abs(one - tilt) for one in tilts) < 1e-6, pair


def test_the_coin_of_the_circle_takes_0_4461_s_a_turn():
    coin = rolling(tt.Ring(radius=0.012), 0.00567, 2.0412e-7, 4.0824e-7).replace({"gravity": 9.8})
    for state in tt.steady_states(coin, rate=14.0847, spin=-36.990):
        assert 2.0 * math.pi / state.precession == pytest.approx(0.4461, abs=5e-5)
        assert state.tilt == pytest.approx(math.pi / 4, abs=1e-4)


@pytest.mark.parametrize("numbers", [{"radius": 0.06, "tilt": 1.2}, {"radius": 0.2, "rate": 4.0}])
def test_a_run_of_a_circle_keeps_its_tilt_and_its_radius(numbers):
    disk = thin_disk()
    state = tt.steady_states(disk, **numbers)[0]
    launch = {"tilt": state.tilt, "precession": state.precession, "spin": state.spin}
    turn = 2.0 * math.pi / abs(state.precession)
    run = tt.simulate(disk.replace({"launch": launch}), duration=3.0 * turn)
    assert float(abs(run.tilt - state.tilt).max()) < 1e-9
    across = [float(run[name].max() - run[name].min()) for name in ("x", "y")]
    assert across == pytest.approx([2.0 * numbers["radius"]] * 2, rel=1e-4)
    assert set(run.mode.values.tolist()) == {"sticking"}


def nutation_of_a_disk(body, state):
    """Return the square of the frequency of small oscillations of a rolling disk, 1/s^2.

    About the contact point (Routh 1905): with p = phi' s, (I1 + m a^2) theta'' = I1 p^2 c / s - (I3
    + m a^2) p omega3 - m g a c, I1 dp/dtheta = I3 omega3 - I1 p c / s and (I3 + m a^2) domega3 /
    dtheta = m a^2 p, of which the total derivative by the tilt is taken.
    """
    a, spin = body.shape.radius, state.spin
    lever, I1, I3 = body.mass * a**2, body.I1, body.I3
    s, c = math.sin(state.tilt), math.cos(state.tilt)
    p = state.precession * s
    p_rate, spin_rate = (I3 * spin - I1 * p * c / s) / I1, lever * p / (I3 + lever)
    total = (
        I1 * (2.0 * p * p_rate * c / s - p**2 / s**2)
        - (I3 + lever) * (p_rate * spin + p * spin_rate)
        + body.mass * G * a * s
    )
    return -total / (I1 + lever)


@given(numbers(0.3, 1.57), numbers(0.5, 60.0), numbers(0.51, 0.95))
def test_the_spectrum_of_a_circle_is_that_of_rouths_equations(tilt, rate, ratio):
    disk = rolling(tt.Ring(radius=0.02), 0.05, 5e-6, 5e-6 / ratio)
    state = tt.steady_states(disk, tilt=tilt, rate=rate)[0]
    first, second = tt.spectrum(disk, state).eigenvalues
    square = nutation_of_a_disk(disk.body, state)
    scale = rate**2 + state.spin**2 + G / 0.02
    assert -(first**2).real == pytest.approx(square, abs=1e-9 * scale)
    assert first + second == pytest.approx(0.0, abs=1e-9 * scale**0.5)


def test_a_thin_disk_rolls_straight_above_the_textbooks_spin():
    disk = thin_disk(radius=0.01163)
    least = tt.least_straight_spin(disk)
    assert least == pytest.approx(math.sqrt(G / (3.0 * 0.01163)), rel=1e-9)
    for share, lasts in ((0.99, False), (1.01, True)):
        (state,) = tt.steady_states(disk, rate=0.0, spin=share * least)
        assert (state.kind, state.radius) == (SteadyKind.STRAIGHT, math.inf)
        assert tt.spectrum(disk, state).unstable is not lasts


@given(numbers(1e-6, 2e-5), numbers(0.55, 1.9))
def test_any_disk_rolls_straight_above_the_spin_in_closed_form(I1, ratio):
    disk = rolling(tt.Ring(radius=0.02), 0.05, I1, ratio * I1)
    I3, lever = ratio * I1, 0.05 * 0.02**2
    least = math.sqrt(I1 * 0.05 * G * 0.02 / (I3 * (I3 + lever)))
    assert tt.least_straight_spin(disk) == pytest.approx(least, rel=1e-9)


def test_a_disturbed_disk_oscillates_at_the_frequency_of_its_spectrum():
    disk = thin_disk()
    (state,) = tt.steady_states(disk, tilt=1.3, rate=5.0)
    frequency = float(abs(tt.spectrum(disk, state).eigenvalues[0].imag))
    launch = {"tilt": 1.3, "precession": 5.0, "spin": state.spin, "tilt_rate": 1e-5}
    run = tt.simulate(disk.replace({"launch": launch}), duration=3.0 * math.pi / frequency)
    expected = 1.3 + 1e-5 / frequency * np.sin(frequency * run.time)
    assert float(abs(run.tilt - expected).max()) < 1e-4 * 1e-5 / frequency


@given(numbers(0.3, 1.4), numbers(200.0, 500.0))
def test_a_sharp_tip_has_the_precessions_and_the_nutation_of_the_heavy_top(tilt, spin):
    """I1' phi'^2 cos(theta) - I3 omega3 phi' + m g l = 0, and the nutation of textbooks."""
    length = 0.03
    top = rolling(tt.Sphere(radius=0.0, center=-length), 0.05, 1e-5, 2e-5)
    pivot, c = 1e-5 + 0.05 * length**2, math.cos(tilt)
    weight, momentum = 0.05 * G * length, 2e-5 * spin
    root = math.sqrt(momentum**2 - 4.0 * pivot * c * weight)
    slow, fast = ((momentum - root) / (2.0 * pivot * c), (momentum + root) / (2.0 * pivot * c))
    states = tt.steady_states(top, tilt=tilt, spin=spin)
    rates = sorted(state.precession for state in states)
    assert rates == pytest.approx([slow, fast][: len(rates)], rel=1e-9)
    for state in states:
        assert state.radius == pytest.approx(length * math.sin(tilt), rel=1e-12)
        rate = state.precession
        square = rate**2 - 2.0 * weight * c / pivot + (weight / (pivot * rate)) ** 2
        found = tt.spectrum(top, state).eigenvalues[0]
        assert -(found**2).real == pytest.approx(square, rel=1e-8)


def test_hurricane_balls_lean_by_the_closed_form_at_a_rate():
    """cos(theta) = 2/5 - g / (Omega^2 R) of the ball that is lifted, and its mirror image."""
    problem = rolling(presets.HURRICANE_BALLS.shape).replace({"body": presets.HURRICANE_BALLS})
    radius = presets.HURRICANE_BALLS.shapes[0].radius
    tilts = [state.tilt for state in tt.steady_states(problem, rate=80.0)]
    expected = math.acos(0.4 - G / (80.0**2 * radius))
    assert tilts == pytest.approx([expected, math.pi - expected], rel=1e-9)
    slowest = math.sqrt(2.5 * G / radius)
    assert tt.steady_states(problem, rate=0.99 * slowest) == []


def test_a_cylinder_rolls_straight_on_its_edge_with_its_centre_above_it():
    rings = tuple(tt.Ring(radius=0.02, center=side * 0.03) for side in (-1, 1))
    cylinder = rolling(rings, 0.1, 4e-5, 2e-5)
    states = tt.steady_states(cylinder, rate=0.0, spin=100.0)
    leaning = math.atan2(0.02, 0.03)
    assert [one.tilt for one in states] == pytest.approx([leaning, math.pi - leaning], rel=1e-9)
    low = cylinder.replace({"launch.tilt": leaning})
    least = tt.least_straight_spin(low)
    for share, lasts in ((0.999, False), (1.001, True)):
        state = tt.steady_states(cylinder, rate=0.0, spin=share * least)[0]
        assert tt.spectrum(cylinder, state).unstable is not lasts


@pytest.mark.parametrize("tilt", [1.0, 1.4])
def test_centres_that_rest_are_the_states_of_every_law_on_sliding_contacts_too(tilt):
    problem = rolling(SPHERE, I1=1.2e-5, I3=1e-5, friction=tt.ViscousFriction(mu=0.3))
    top = top_of(problem)
    (state,) = tt.steady_states(problem, tilt=tilt)
    branch = precession_branch(top, np.array([tilt]))
    assert state.precession == pytest.approx(float(branch.precession[0]), rel=1e-12)
    assert state.spin == pytest.approx(float(branch.spin[0]), rel=1e-12)
    found, expected = tt.spectrum(problem, state), sliding_spectrum(state, top)
    assert np.array_equal(found.eigenvalues, expected.eigenvalues)


def test_a_disk_that_wobbles_about_its_centre_has_a_spectrum_on_a_contact_that_slides():
    """Rolling keeps it for ever; slip that creeps makes a spinning disk lie down."""
    viscous = thin_disk(friction=tt.ViscousFriction(mu=1e3))
    (state,) = tt.steady_states(viscous, tilt=0.5)
    assert state.precession == pytest.approx(math.sqrt(4.0 * G / (0.02 * math.sin(0.5))), rel=1e-12)
    held = tt.spectrum(thin_disk(), state)
    creeping = tt.spectrum(viscous, state)
    nearest = min(creeping.eigenvalues, key=lambda value: abs(value - held.eigenvalues[0]))
    assert nearest == pytest.approx(held.eigenvalues[0], rel=1e-2)


@pytest.mark.parametrize(
    ("numbers", "field", "said"),
    [
        ({"radius": 0.1}, "radius", "0.1 leaves the steady states open"),
        ({"tilt": 1.0, "rate": 2.0, "spin": 3.0}, "tilt, rate, spin", "1, 2, 3 do not determine"),
        ({"tilt": 4.0}, "tilt", "less than pi"),
        ({"radius": -0.1, "tilt": 1.0}, "radius", "0 or more"),
        ({"rate": 0.0}, "spin", "rolls straight"),
        ({"radius": math.inf}, "spin", "rolls straight"),
        ({"radius": math.inf, "rate": 3.0}, "rate", "3 does not go with an infinite radius"),
        ({"radius": math.inf, "rate": 3.0, "spin": 5.0}, "rate", "write 0, or a finite radius"),
        ({"tilt": 0.3, "rate": "fast"}, "rate", "a number"),
        ({"tilt": 0.3, "radius": 0.3}, "friction", "of the weight"),
    ],
)
def test_numbers_that_determine_nothing_are_refused(numbers, field, said):
    with pytest.raises(tt.InvalidInput) as refusal:
        tt.steady_states(thin_disk(friction=tt.CoulombFriction(mu=0.3)), **numbers)
    assert refusal.value.field == field
    assert said in str(refusal.value)


def test_circles_need_friction_that_sticks():
    for friction in (tt.ViscousFriction(mu=0.3), tt.RegularizedCoulombFriction(mu=0.3, eps=1e-3)):
        with pytest.raises(tt.InvalidInput, match="dry friction of a point"):
            tt.steady_states(thin_disk(friction=friction), tilt=1.2, radius=0.1)
    with pytest.raises(tt.InvalidInput, match="no rolling resistance"):
        tt.steady_states(thin_disk().replace({"rolling_resistance": 1e-5}), tilt=1.2)


def test_the_command_says_from_which_spin_a_body_rolls_straight():
    """An egg on its waist has its centre of mass at its lowest; a coin on its edge has not."""
    said = {
        name: CliRunner().invoke(app, ["steady", "--preset", name]).stdout
        for name in ("egg", "coin")
    }
    assert said["egg"].split()[-6:] == ["rolls", "straight", "stably", "at", "any", "spin"]
    spin = tt.least_straight_spin(tt.presets.report_problem().replace({"body": tt.presets.COIN}))
    row = said["coin"].split()[-6:]
    assert row == ["rolls", "straight", "stably", "above", f"{spin:.6g}", "rad/s"]
    assert "No steady motion is known that this launch ends in" in " ".join(said["coin"].split())


def test_the_command_shows_a_circle_with_units(tmp_path):
    file = tmp_path / "disk.json"
    file.write_text(thin_disk().model_dump_json())
    arguments = ["steady", str(file), "--at", "tilt=70deg", "--at", "radius=10cm"]
    shown = CliRunner().invoke(app, arguments)
    assert shown.exit_code == 0, shown.output
    assert "circle" in shown.output
    found = json.loads(CliRunner().invoke(app, [*arguments, "--json"]).output)
    (state,) = tt.steady_states(thin_disk(), tilt="70 deg", radius="10 cm")
    assert found["steady_states"][0]["precession"] == state.precession
    assert found["least_straight_spin"] == tt.least_straight_spin(thin_disk())


@given(numbers(5.0, 200.0))
def test_a_vertical_spin_on_a_contact_that_rolls_has_the_spectrum_of_the_sleeping_top(spin):
    """A nu^2 - G omega nu - m g zeta = 0 for p ~ exp(i nu t), A = I1 + m l^2, G = I3 + m l r."""
    shape = tt.Sphere(radius=0.01, center=-0.015)
    top = rolling(shape, 0.05, 1e-5, 1.5e-5)
    height, mass = 0.025, 0.05
    inertia, gyration = 1e-5 + mass * height**2, 1.5e-5 + mass * height * 0.01
    roots = np.roots([inertia, -gyration * spin, mass * G * 0.015])
    (state,) = [
        one
        for one in tt.steady_states(top.replace({"launch": {"tilt": 0.0, "spin": spin}}))
        if one.kind is SteadyKind.UPRIGHT
    ]
    found = tt.spectrum(top, state).eigenvalues
    assert len(found) == 4
    for root in roots:
        assert min(abs(found - 1j * root)) < 1e-7 * (abs(root) + spin)
