"""Derivatives of runs: closed forms, and differences of runs over random problems."""

import numpy as np
import pytest
from scipy.optimize import brentq

import launches
import tippetop as tt
from campaigns import seeds
from tippetop.contact.natural_launch import NaturalLaunch
from tippetop.contact.slip_onset import ENDED, ONSET_OVER
from tippetop.contact.trajectory import Trajectory
from tippetop.fit.dual import Dual, duals, parts_of
from tippetop.fit.linearized_run import IntegratedLeg, LinearizedRun
from tippetop.fit.problem_numbers import Direction
from tippetop.fit.variable_slopes import Slopes, differences
from tippetop.fit.variational import followed
from tippetop.graph.derivatives import derivatives
from tippetop.graph.recording import record
from tippetop.integrators import make_integrator
from tippetop.integrators.base import Motion
from tippetop.mechanics.surfaces.surface import support_at
from tippetop.problem.presets import report_problem

CLOSED = 1e-9
"""Relative error of derivatives that have a closed form."""

BALL = tt.Body(mass=0.02, shape=tt.Sphere(radius=0.01, center=0.0), I1=8e-7, I3=8e-7)


def slope(slopes, name, field):
    """Return the derivatives of a variable with respect to a field."""
    return slopes[name].sel(parameter=field).values


def test_bouncing_ball():
    height, restitution, gravity = 0.02, 0.6, 9.8
    problem = tt.Problem(
        body=BALL,
        friction=tt.ViscousFriction(mu=0.1),
        launch=tt.Launch(tilt=0.3, spin=0.0, gap=height),
        contact=tt.Contact(liftoff="fly", restitution=restitution),
        gravity=gravity,
    )
    fields = ["launch.gap", "contact.restitution", "gravity", "body.mass"]
    slopes = tt.sensitivities(problem, 0.3, fields, samples=11)
    first = (2.0 * height / gravity) ** 0.5
    times = [first, first * (1.0 + 2.0 * restitution)]
    times.append(times[-1] + 2.0 * first * restitution**2)
    kinds = tt.simulate(problem, 0.3)["event_kind"].values.tolist()
    lands = [number for number, kind in enumerate(kinds) if kind == "impact"][:3]
    by_height = [time / (2.0 * height) for time in times]
    by_gravity = [-time / (2.0 * gravity) for time in times]
    by_restitution = [0.0, 2.0 * first, 2.0 * first + 4.0 * first * restitution]
    expected = {"launch.gap": by_height, "gravity": by_gravity, "body.mass": [0.0] * 3}
    expected["contact.restitution"] = by_restitution
    for field, numbers in expected.items():
        found = slope(slopes, "event_time", field)[lands]
        np.testing.assert_allclose(found, numbers, rtol=CLOSED, atol=1e-9)
    # The second impulse is m (1 + e) e (2 g h)^(1/2).
    speed = (2.0 * gravity * height) ** 0.5
    impulses = slope(slopes, "event_impulse", "contact.restitution")[lands]
    by_hand = [0.02 * speed * change for change in (1.0, 1.0 + 2.0 * restitution)]
    np.testing.assert_allclose(impulses[:2], by_hand, rtol=CLOSED)


def test_ball_that_slides_and_then_rolls():
    speed, mu, gravity = 0.5, 0.2, 9.8
    problem = tt.Problem(
        body=BALL,
        friction=tt.CoulombFriction(mu=mu),
        launch=tt.Launch(tilt=0.3, spin=0.0, slip=(speed, 0.0)),
        gravity=gravity,
    )
    slopes = tt.sensitivities(problem, 0.2, ["friction.mu", "gravity", "launch.slip.0"], samples=5)
    end = speed / (3.5 * mu * gravity)
    for field, expected in (
        ("friction.mu", -end / mu),
        ("gravity", -end / gravity),
        ("launch.slip.0", end / speed),
    ):
        sticks = slope(slopes, "event_time", field)[0]
        np.testing.assert_allclose(sticks, expected, rtol=CLOSED)
    moves = slope(slopes, "velocity", "launch.slip.0")[-1, 0]
    np.testing.assert_allclose(moves, 5.0 / 7.0, rtol=CLOSED)
    np.testing.assert_allclose(slope(slopes, "velocity", "friction.mu")[-1], 0.0, atol=CLOSED)
    there = slope(slopes, "event_velocity", "launch.slip.0")[0]
    np.testing.assert_allclose(there, [5.0 / 7.0, 0.0, 0.0], atol=CLOSED)


def test_impact_of_a_leaning_rod():
    """A spheroid falls without turning, and friction is too little to matter: p = (1 + e) m v / (1
    + m a^2 / I1), a the horizontal distance of the contact point from the centre of mass.
    """
    mass, inertia, gap, tilt, gravity, restitution = 0.01, 4e-7, 0.01, 0.7, 9.8, 0.5
    across, along = 0.004, 0.02
    problem = tt.Problem(
        body=tt.Body(mass=mass, shape=tt.Spheroid(across=across, along=along), I1=inertia, I3=1e-7),
        friction=tt.ViscousFriction(mu=1e-12),
        launch=tt.Launch(tilt=tilt, spin=0.0, gap=gap),
        contact=tt.Contact(liftoff="fly", restitution=restitution),
        gravity=gravity,
    )
    duration = 1.1 * (2.0 * gap / gravity) ** 0.5
    fields = ["body.I1", "launch.gap", "launch.tilt"]
    slopes = tt.sensitivities(problem, duration, fields, samples=5)
    place = tt.simulate(problem, duration)["event_kind"].values.tolist().index("impact")

    def impulse(inertia, gap, tilt):
        cosine, sine = np.cos(tilt), np.sin(tilt)
        height = np.sqrt((across * sine) ** 2 + (along * cosine) ** 2)
        arm = (along**2 - across**2) * sine * cosine / height
        speed = np.sqrt(2.0 * gravity * gap)
        return (1.0 + restitution) * mass * speed / (1.0 + mass * arm**2 / inertia)

    at = (inertia, gap, tilt)
    for number, field in enumerate(fields):
        step = np.zeros(3)
        step[number] = 1e-30 * at[number]
        expected = impulse(*(np.array(at) + 1j * step)).imag / step[number]
        found = slope(slopes, "event_impulse", field)[place]
        np.testing.assert_allclose(found, expected, rtol=1e-8)


def test_restitution_at_its_bound_has_no_derivative():
    problem = tt.Problem(
        body=BALL,
        friction=tt.ViscousFriction(mu=0.1),
        launch=tt.Launch(tilt=0.3, spin=0.0, gap=0.02),
        contact=tt.Contact(liftoff="fly", restitution=0.0),
    )
    slopes = tt.sensitivities(problem, 0.2, ["contact.restitution", "launch.gap"], samples=21)
    lands = (2.0 * 0.02 / problem.gravity) ** 0.5
    before = slopes["time"].values < lands
    height = slopes["height"].sel(parameter="contact.restitution").values
    assert np.all(height[before] == 0.0)
    assert np.all(np.isnan(height[~before]))
    assert slopes["reason"].values[0] != ""
    assert slopes["reason"].values[1] == ""
    assert np.all(np.isfinite(slopes["height"].sel(parameter="launch.gap").values))
    # A result whose derivatives all end early is as long as the run.
    run = tt.simulate(problem, 0.2, samples=21)
    alone = tt.sensitivities(problem, 0.2, ["contact.restitution"], samples=21)
    assert alone["time"].values.tolist() == run["time"].values.tolist()
    assert np.isnan(alone["event_time"].values).tolist() == [[True] * run.sizes["event"]]


def test_a_top_that_jumps_without_loss():
    """Without friction and with full restitution nothing is lost, whatever it starts from."""
    problem = tt.presets.report_problem().replace(
        {
            "friction.mu": 0.0,
            "launch": tt.Launch(tilt=0.3, spin=50.0, gap=0.01),
            "contact": tt.Contact(liftoff="fly", restitution=1.0),
        }
    )
    fields = ["launch.tilt", "launch.gap", "launch.spin"]
    slopes = tt.sensitivities(problem, 0.3, fields, samples=5)
    assert slopes["reason"].values.tolist() == [""] * 3
    assert np.max(np.abs(slopes["energy_lost"].values)) < 1e-9

    def moved(field, change):
        nearby = problem.replace({field: problem.get(field) + change})
        return tt.simulate(nearby, 0.3, samples=2)["event_time"].values

    for field, step in (("launch.tilt", 1e-5), ("launch.gap", 1e-6), ("launch.spin", 1e-3)):
        change = (moved(field, step) - moved(field, -step)) / (2.0 * step)
        finer = (moved(field, 0.5 * step) - moved(field, -0.5 * step)) / step
        found = slope(slopes, "event_time", field)
        scale = np.max(np.abs(finer))
        np.testing.assert_allclose(found, (4.0 * finer - change) / 3.0, atol=1e-6 * scale)
    # Friction of either sign would end the impact by another condition: energy, or restitution.
    slopes = tt.sensitivities(problem, 0.3, ["friction.mu"], samples=5)
    assert "without friction and without loss" in slopes["reason"].item()
    assert np.isnan(slopes["energy_lost"].item())
    # With less restitution only restitution ends it.
    dull = problem.replace({"contact.restitution": 0.5})
    found = tt.sensitivities(dull, 0.05, ["friction.mu"], samples=5)["energy_lost"].item()
    rubbed = tt.simulate(dull.replace({"friction.mu": 1e-6}), 0.05, samples=2)["energy_lost"]
    smooth = tt.simulate(dull, 0.05, samples=2)["energy_lost"]
    assert found == pytest.approx(1e6 * float(rubbed - smooth), rel=1e-4)
    # A little friction suffices.
    little = problem.replace({"friction.mu": 1e-6})
    found = tt.sensitivities(little, 0.05, ["friction.mu"], samples=5)["energy_lost"].item()
    assert found == pytest.approx(1e6 * float(tt.simulate(little, 0.05)["energy_lost"]), rel=1e-4)


def test_a_derivative_that_is_zero_is_zero_however_rounding_has_grown():
    """An egg jumps without friction. Spins of either sign tilt it alike: without spin the
    derivatives of all that a mirror leaves as it is are zero, and rounding of them grows tenfold
    with every jump.
    """
    problem = tt.Problem(
        body=tt.Body(mass=0.05, shape=tt.Spheroid(across=0.02, along=0.03), I1=1.3e-5, I3=8e-6),
        friction=tt.ViscousFriction(mu=0.0),
        launch=tt.Launch(tilt=0.7, spin=0.0, gap=0.01),
        contact=tt.Contact(liftoff="fly", restitution=1.0),
    )
    slopes = tt.sensitivities(problem, 0.65, "launch.spin", samples=3)
    assert slopes["reason"].item() == ""
    # A spin of 1 rad/s changes them by less than half of their sixth digit.
    for name, size in (("tilt", 1.0), ("tilt_rate", 10.0), ("height", 0.03), ("event_time", 0.1)):
        assert np.all(np.abs(slopes[name].values) < 5e-7 * size)
    # The spin itself is no more than what it was.
    np.testing.assert_allclose(slopes["spin"].values, 1.0, rtol=CLOSED)


def test_only_what_two_distances_find_within_rounding_is_zero():
    def slopes(*values):
        return Slopes(np.array(values), np.zeros(len(values)), 0.0, None, is_settled=True)

    once, twice = slopes(2.0, 40.0, 2.0, 2.0), slopes(-2.0, 2.0, 40.0, 2.0)
    rounding = slopes(1.0, 0.0, 0.0, 0.0)
    # It has grown to 1, and may be 30 times that.
    assert once.zeros_beside(twice, rounding, 30.0).tolist() == [True, False, False, True]
    assert not once.zeros_beside(twice, rounding, 29.0).any()
    assert once.zeros_beside(slopes(2.0), rounding, 30.0).tolist() == [True, False, False, False]


def test_a_derivative_that_the_check_lacks_is_not_known():
    def slopes(*values):
        return Slopes(np.array(values), np.zeros(len(values)), 0.0, None, is_settled=True)

    known = slopes(1.0, 2.0, 3.0, 4.0).known_beside(slopes(1.1, 3.0, np.nan), 0.5)
    np.testing.assert_array_equal(known, [1.0, np.nan, np.nan, np.nan])
    longer = slopes(1.0).known_beside(slopes(1.1, 3.0), 0.5)
    np.testing.assert_array_equal(longer, [1.0])


def test_the_time_of_a_guard_that_nearly_grazes_goes_as_a_square_root():
    """Where the normal force dips to zero and no more, the time of lift-off is t - C (p - q)^(1/2),
    and its derivative to the power of -2 is linear in p and zero at q.
    """

    def thrown(rate):
        launch = tt.Launch(tilt=1.0, tilt_rate=rate, spin=155.0)
        return tt.presets.report_problem().replace({"launch": launch, "contact.liftoff": "stop"})

    def lifts_off(rate):
        return tt.simulate(thrown(rate), 0.1, samples=2).attrs["status"] == "lifted_off"

    low, high = 10.0, 20.0
    for _ in range(28):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if lifts_off(middle) else (middle, high)
    inverse_squares = []
    for beyond in (1e-4, 2e-4):
        vary = ["launch.tilt_rate"]
        slopes = tt.sensitivities(thrown(high + beyond), 0.1, vary, samples=2)
        inverse_squares.append(slopes["end_time"].item() ** -2)
    near, far = inverse_squares
    zero = high + 1e-4 - 1e-4 * near / (far - near)
    assert abs(zero - high) < 1e-6  # A hundredth of the distance: so large is the next term.
    assert tt.sensitivities(thrown(low - 1e-4), 0.1, vary, samples=2)["reason"].item() == ""


@pytest.mark.parametrize(
    ("vary", "word"),
    [
        ("friction.nu", "nu"),
        ([], "list"),
        (3, "list"),
        (["friction.nu"], "nu"),
        (["contact"], "number"),
    ],
)
def test_wrong_fields_are_refused(vary, word):
    with pytest.raises(tt.InvalidInput, match=word):
        tt.sensitivities(tt.presets.report_problem(), 0.1, vary)


FIELDS = (
    *("friction.mu", "friction.patch_radius", "rolling_resistance", "contact.restitution"),
    *("launch.spin", "launch.tilt", "gravity", "body.mass", "body.I1"),
)

NAMES = ("tilt", "spin", "normal_force", "x", "energy", "velocity", "event_time", "end_time")


def random_case(seed):
    """Return a random problem, a duration and a field; None where the problem is refused."""
    try:
        problem = tt.Problem.model_validate(launches.launch_of(seed))
    except (ValueError, tt.InvalidInput):
        return None
    random = np.random.default_rng(1000 + seed)
    duration = float(random.uniform(0.1, 1.0))

    def varies(name):
        try:
            return isinstance(problem.get(name), float) and problem.get(name) != 0.0
        except tt.InvalidInput:
            return False

    return problem, duration, str(random.choice([name for name in FIELDS if varies(name)]))


def richardson(problem, times, field, kinds):
    """Return derivatives by differences extrapolated twice, and an estimate of their error; None
    where the runs have other events.

    The estimate is what the last extrapolation changes, and what rounding of a variable to double
    precision makes of the differences: eps / (2 part step) of its size, times the weights of the
    extrapolation (1.42 of the last, 0.44 and 0.02), 3.3 eps / step in all. Derivatives that are
    zero are known to that only.
    """
    value, step = float(problem.get(field)), 1e-5 * abs(float(problem.get(field)))
    rows = []
    for part in (1.0, 0.5, 0.25):
        ends = []
        for sign in (-1.0, 1.0):
            beside = problem.replace({field: value + sign * part * step})
            run = tt.simulate(beside, times[-1], times=times)
            if run["event_kind"].values.tolist() != kinds:
                return None
            ends.append(run)
        rows.append(
            {n: (ends[1][n].values - ends[0][n].values) / (2.0 * part * step) for n in NAMES}
        )
    found = {}
    for name in NAMES:
        if len({row[name].shape for row in rows}) == 1:
            first, second = ((4.0 * rows[k + 1][name] - rows[k][name]) / 3.0 for k in (0, 1))
            best = (16.0 * second - first) / 15.0
            rounding = 3.3 * np.finfo(float).eps * np.max(np.abs(run[name].values), initial=0.0)
            found[name] = best, np.max(np.abs(second - first), initial=0.0) + rounding / step
    return found


ENDS_ON_TWO = (55, 80, 534)
"""Seeds in which slip ends on two contacts, with a direction of which few digits are known."""

LINGER = (187, 200)
"""Seeds in which slip is about to end for long before it does."""

LONG = (1, 21)
"""Seeds that take a while."""

FAST_FORCES = (51, 462)
"""Seeds whose normal force changes fast beside a sample."""


WHOLE = (2, 11, 16, 20, 164)
"""Seeds of which no derivative is missing."""


@pytest.mark.parametrize(
    "seed",
    seeds(
        check=0,
        sample=25,
        claim=600,
        always=[2, 16, 20],
        sampled=[11, 164, 233, *LINGER, *LONG, *ENDS_ON_TWO, *FAST_FORCES],
    ),
)
@pytest.mark.filterwarnings("ignore::tippetop.Implausible")
def test_random_problems_agree_with_differences(seed):
    """Where surfaces strike in turns ever sooner, so that rounding grows from event to event (25,
    and some events of 113, 240 and 250), or the last events depend on the sizes of ever smaller
    motion (251), derivatives are missing, and a reason says why.
    """
    case = random_case(seed)
    if case is None:
        return
    problem, duration, field = case
    times = np.linspace(0.0, duration, 41)
    kinds = tt.simulate(problem, duration, times=times)["event_kind"].values.tolist()
    slopes = tt.sensitivities(problem, duration, [field], times=times)
    beside = richardson(problem, times, field, kinds)
    if beside is None:
        return
    reason = slopes["reason"].values[0]
    assert reason == "" or seed not in WHOLE
    for name, (expected, error) in beside.items():
        found = slope(slopes, name, field)
        assert reason or np.isfinite(found).all()
        largest = max(np.max(np.abs(expected), initial=0.0), 1e-300)
        off = np.nanmax(np.abs(found - expected), initial=0.0)
        assert off <= 10.0 * error + 1e-6 * largest, (
            name,
            off / largest,
            error / largest,
        )


def test_a_metric_that_the_run_does_not_have_says_why_it_has_no_derivative():
    """A top that hardly spins does not turn over, and has no time at which it does."""
    slopes = tt.sensitivities(tt.presets.report_problem(spin=5.0), 0.2, ["friction.mu"], samples=2)
    assert np.isnan(slopes["turnover_time"].item())
    assert "first rises past a right angle" in slopes["turnover_time"].attrs["reason"]
    assert slopes["reason"].item() == ""
    assert "reason" not in slopes["final_tilt"].attrs


def known_by_differences(problem, field, steps, numbers):
    """Return the derivatives of numbers of runs, by differences extrapolated twice."""
    value, rows = problem.get(field), []
    for step in steps:
        ends = [numbers(problem.replace({field: value + sign * step})) for sign in (-1.0, 1.0)]
        rows.append((ends[1] - ends[0]) / (2.0 * step))
    first, second = ((4.0 * rows[k + 1] - rows[k]) / 3.0 for k in (0, 1))
    return (16.0 * second - first) / 15.0


def test_slip_has_its_derivatives_however_it_is_followed():
    """A loaded ball slips for a while and then rolls: the first moments of slip, which may last to
    its end, are followed in one way, and longer slip in three. Just where that changes, runs beside
    the run are followed in another way than the run.
    """

    def launched(mu):
        return tt.Problem(
            body=tt.Body(mass=0.02, shape=tt.Sphere(radius=0.01, center=0.003), I1=8e-7, I3=8e-7),
            friction=tt.CoulombFriction(mu=mu),
            launch=tt.Launch(tilt=1.0, spin=0.0),
        )

    def has_long_slip(mu):
        launch = NaturalLaunch.of(launched(mu))
        run = Trajectory(launch.automaton, launch.first, 2.6, make_integrator(None))
        causes = [one.mode_end.cause for one in run.segments() if one.mode_end is not None]
        assert causes[0] in (ONSET_OVER, ENDED)
        return causes[0] == ONSET_OVER

    def numbers(problem):
        run = tt.simulate(problem, 0.09, samples=2)
        assert run["event_kind"].values.tolist() == ["stick"]
        return np.array([run["event_time"].values[0], run["tilt"].values[-1], run["x"].values[-1]])

    long, short = 0.14, 0.15
    assert has_long_slip(long)
    assert not has_long_slip(short)
    while short - long > 1e-10:
        middle = 0.5 * (long + short)
        long, short = (middle, short) if has_long_slip(middle) else (long, middle)
    for mu in (long, short):
        problem = launched(mu)
        slopes = tt.sensitivities(problem, 0.09, "launch.tilt", samples=2)
        assert slopes["reason"].item() == ""
        found = [slopes[name].values.ravel()[-1] for name in ("event_time", "tilt", "x")]
        steps = (1e-3, 5e-4, 2.5e-4)
        expected = known_by_differences(problem, "launch.tilt", steps, numbers)
        np.testing.assert_allclose(found, expected, rtol=1e-9)


def test_slip_that_ends_beside_at_other_sizes_keeps_its_digits():
    """The radius changes the slip at which its end is followed in another way, and runs beside are
    to change there at the slip of their own size.
    """
    sphere = tt.EccentricSphere(radius=0.02544, eccentricity=0.1273)
    problem = tt.presets.report_problem(spin=118.498).replace(
        {
            "body.shape": sphere,
            "friction": tt.CoulombFriction(mu=0.4748),
            "launch.tilt": 0.7986,
            "launch.tilt_rate": 4.3996,
            "launch.slip": (-0.4933, 0.0),
        }
    )

    def numbers(problem):
        run = tt.simulate(problem, 0.4, samples=2)
        return run["orientation"].values[-1]

    slopes = tt.sensitivities(problem, 0.4, "body.shape.radius", samples=2)
    assert slopes["reason"].item() == ""
    expected = known_by_differences(problem, "body.shape.radius", (2e-6, 1e-6, 5e-7), numbers)
    np.testing.assert_allclose(slopes["orientation"].values[0, -1], expected, rtol=3e-8)


def test_slip_that_nearly_ends_on_a_slope_has_the_derivatives_of_its_hodograph():
    """The slip of a ball that goes up a slope is v' = a - k v / |v|, a and k the rates by gravity
    and by friction. With x = ln tan (theta / 2), theta the angle of v to a, |v| = C exp(k x / a)
    cosh x, and |v| (k - a tanh x) grows by a^2 - k^2 in a unit of time. Here it falls to a tenth of
    a millimetre a second, and so close to its end is followed in other ways.
    """
    slope, gravity, mu, duration = 0.02, 9.8, 0.0028, 0.2
    pull = gravity * np.sin(slope)

    def velocity(along, across, mu):
        """Return the velocity after the duration: less than slip by what friction has turned."""
        rub, speed = 3.5 * mu * gravity * np.cos(slope), (along**2 + across**2) ** 0.5
        ratio, start = rub / pull, np.log((speed - along) / across)
        size = speed / (np.exp(ratio * start) * np.cosh(start))
        end = speed * (rub - pull * np.tanh(start)) + (pull**2 - rub**2) * duration

        def excess(x):
            return size * np.exp(ratio * x) * (rub * np.cosh(x) - pull * np.sinh(x)) - end

        x = brentq(lambda x: excess(x).real, -40.0, 10.0, xtol=1e-15) + 0j
        for _ in range(4):
            curve = size * np.exp(ratio * x) * (rub * np.sinh(x) - pull * np.cosh(x))
            x -= excess(x) / (ratio * (excess(x) + end) + curve)
        speed = size * np.exp(ratio * x) * np.cosh(x)
        gained = -speed * np.tanh(x) - along, speed / np.cosh(x) - across
        return np.array(
            [
                along + pull * duration - (pull * duration - gained[0]) / 3.5,
                across + gained[1] / 3.5,
            ]
        )

    problem = tt.Problem(
        body=BALL,
        friction=tt.CoulombFriction(mu=mu),
        launch=tt.Launch(tilt=0.3, spin=0.0, slip=(-0.005, 5e-4)),
        gravity=gravity,
        table=tt.Table(slope=slope),
    )
    fields = ["launch.slip.0", "launch.slip.1", "friction.mu"]
    slopes = tt.sensitivities(problem, duration, fields, samples=2)
    assert slopes["reason"].values.tolist() == [""] * 3
    for number, field in enumerate(fields):
        start = np.array([-0.005, 5e-4, mu], dtype=complex)
        start[number] += 1e-30j
        expected = velocity(*start).imag / 1e-30
        found = slopes["velocity"].sel(parameter=field).values[-1, :2]
        np.testing.assert_allclose(found, expected, rtol=0.0, atol=CLOSED * abs(expected).max())


@pytest.mark.slow
def test_slip_that_is_about_to_end_for_long_keeps_its_derivatives():
    """A patch creeps, and the time left to the end of slip hardly changes for a while."""
    problem, duration, field = random_case(200)
    times = [0.0, 0.5 * duration, duration]
    kinds = tt.simulate(problem, duration, times=times)["event_kind"].values.tolist()
    slopes = tt.sensitivities(problem, duration, [field], times=times)
    beside = richardson(problem, times, field, kinds)
    for name in ("tilt", "spin", "x", "energy", "event_time"):
        expected, error = beside[name]
        off = np.abs(slope(slopes, name, field) - expected)
        assert np.all(off <= 10.0 * error + 1e-7 * np.max(np.abs(expected)))


def test_motion_that_ends_where_it_begins_keeps_its_derivatives():
    oscillator = Motion(lambda y, p: (y[1], -p[0] * y[0]), 2, 1)
    parameters, start = np.array([[1.0], [0.5]]), np.array([[0.3, 0.1], [2.0, -1.0]])
    solved = followed(oscillator, parameters, (0.7, start), 0.7, make_integrator(None))
    assert solved is not None
    assert solved[0].knots.tolist() == [0.7]
    np.testing.assert_array_equal(solved[1], start)


def test_rules_of_the_graph_are_those_of_dual_numbers():
    """Both differentiate one function with every operation, by themselves."""

    def function(y, p):
        a, b, c = y
        quotient = (a - b) / (1.0 + c * c)
        powers = abs(a) ** 1.5 + b**3 - c**-2 + (a * a + 1.0) ** 0.25 + (b * b) ** 0.3
        return [quotient * p[0] - powers, -(a * c) + 2.0 / b, p[0] ** 0.5]

    y, p = (0.3, -1.2, 0.7), (1.9,)
    parts = np.random.default_rng(3).normal(size=(2, 4))
    by_duals = function(duals(y, parts[:, :3]), duals(p, parts[:, 3:]))

    def tangent(y, p):
        outputs = function(y[:3], p[:1])
        seeds = {y[k].place: (y[3 + k], y[6 + k]) for k in range(3)}
        seeds[p[0].place] = (p[1], p[2])
        return [number for one in derivatives(outputs, seeds) for number in one]

    recorded = record(tangent, 9, 3)
    values = evaluated(recorded, [*y, *parts[0, :3], *parts[1, :3]], [*p, *parts[:, 3]])
    expected = np.concatenate([parts_of(one, 2) for one in by_duals])
    np.testing.assert_allclose(values, expected, rtol=1e-13)
    assert Dual(2.0, np.ones(1)) > 1.0


@pytest.mark.parametrize("restitution", [0.0, 1.0])
def test_the_end_of_a_range_is_named(restitution):
    problem = tt.presets.report_problem(mu=0.0).replace(
        {"contact.liftoff": "fly", "contact.restitution": restitution, "launch.gap": 0.02}
    )
    slopes = tt.sensitivities(problem, 0.2, ["contact.restitution", "launch.gap"], samples=3)
    assert "end of its range" in slopes["reason"].values[0]
    assert np.isnan(slopes["final_tilt"].values[0])
    assert np.isfinite(slopes["final_tilt"].values[1])


def evaluated(recorded, y, p):
    """Return the outputs of a recorded function, node by node."""
    values = {}
    for node in recorded.nodes:
        operands = [values[operand.place] for operand in node.operands]
        values[node.place] = {
            "y": lambda o, n=node: y[int(n.value)],
            "p": lambda o, n=node: p[int(n.value)],
            "constant": lambda o, n=node: n.value,
            "+": lambda o: o[0] + o[1],
            "-": lambda o: o[0] - o[1],
            "*": lambda o: o[0] * o[1],
            "/": lambda o: o[0] / o[1],
            "negative": lambda o: -o[0],
            "less": lambda o: float(o[0] < o[1]),
            "select": lambda o: o[1] if o[0] else o[2],
            "abs": lambda o: abs(o[0]),
            "sqrt": lambda o: o[0] ** 0.5,
            "pow": lambda o: o[0] ** o[1],
        }[node.name](operands)
    return [values[output.place] for output in recorded.outputs]


def test_derivatives_of_which_few_digits_are_known_are_missing():
    """A top on two surfaces that strike in turns, ever sooner: the last events' times have fewer
    digits than six, and what comes before them has them.
    """
    problem, duration, field = random_case(25)
    slopes = tt.sensitivities(problem, duration, [field], samples=41)
    assert "fewer than six digits" in slopes["reason"].item()
    assert np.isfinite(slope(slopes, "event_time", field)[:80]).all()
    assert np.isnan(slope(slopes, "event_time", field)[-1])
    assert np.isfinite(slope(slopes, "x", field)[:26]).all()
    assert np.isnan(slope(slopes, "x", field)[-1])


def test_a_rebound_begins_at_the_table_whatever_varies():
    """To rounding of the gap, not of the differences across the impact, which are 1e-12 off."""
    problem = report_problem(tilt=0.5, spin=100.0).replace(
        {"launch.gap": 0.002, "contact.restitution": 0.7}
    )
    directions = [Direction.of(problem, field) for field in ("launch.spin", "launch.tilt")]
    run = LinearizedRun(problem, 0.06, np.array([0.0, 0.06]), directions)
    rebounds = 0
    for leg in run.legs:
        if not isinstance(leg, IntegratedLeg) or leg.visit.time == 0.0:
            continue
        numbers = leg.visit.mode.numbers(leg.visit.state)
        height, change_by_axis, _ = support_at(numbers[:3], leg.visit.mode.top.surface)
        assert numbers[9] == pytest.approx(height, abs=1e-15)
        (solution,) = leg.solutions
        rows = np.reshape(solution.rows(np.array([leg.visit.time])), (-1, len(numbers)))
        gaps = rows[1:, 9] - change_by_axis * rows[1:, 2]
        assert np.abs(rows[1:, 9]).max() > 1e-3, "the height at the impact depends on the launch"
        assert np.abs(gaps).max() < 1e-15
        rebounds += 1
    assert rebounds > 1


def test_bounces_that_die_away_have_the_derivatives_of_their_series():
    """A ball dropped from h rests after (2 h / g)^(1/2) (1 + e) / (1 - e), and lands at parts of
    that, which go as the root of h.
    """
    height, restitution, gravity = 0.02, 0.5, 9.8
    problem = tt.Problem(
        body=BALL,
        friction=tt.ViscousFriction(mu=0.1),
        launch=tt.Launch(tilt=0.3, spin=3.0, gap=height),
        contact=tt.Contact(liftoff="fly", restitution=restitution),
        gravity=gravity,
    )
    slopes = tt.sensitivities(problem, 0.25, ["launch.gap"], samples=3)
    assert slopes["reason"].item() == ""
    run = tt.simulate(problem, 0.25, samples=3)
    times = run["event_time"].values
    assert len(times) > 40
    found = slope(slopes, "event_time", "launch.gap")
    np.testing.assert_allclose(found, times / (2.0 * height), rtol=1e-8)


def test_runs_beside_may_differ_by_a_sample_and_an_event():
    """Where derivatives end, one of both may reach further; what both have is compared."""
    problem = report_problem(spin=175.0)
    fields = [Direction.of(problem, "launch.spin")]
    run = LinearizedRun(problem, 6.0, np.linspace(0.0, 6.0, 5), fields)
    whole = run.read()
    assert len(whole.variables["event_time"]) > 1
    cut = whole.run.isel(time=slice(-1), event=slice(-1))
    shorter = whole._replace(run=cut, states=whole.states[:-1])
    slopes = differences([whole, shorter, whole, shorter], 1.0)
    for name in ("tilt", "event_time", "axis"):
        assert len(slopes[name].values) == len(whole.variables[name]) - 1
        np.testing.assert_array_equal(slopes[name].values, 0.0)
