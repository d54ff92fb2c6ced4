"""Fits return what made the data, with errors that are right, and say what they cannot tell."""

import json
import sys

import numpy as np
import pytest
from scipy.optimize import least_squares
from typer.testing import CliRunner

import tippetop as tt
from campaigns import among
from tippetop.cli.commands import app
from tippetop.fit.fit_result import known_together, search_of
from tippetop.fit.joint_model import JointModel
from tippetop.fit.model import Model
from tippetop.fit.residual_statistics import (
    are_correlated,
    can_be_correlated,
    correlation_time,
    durbin_watson_moments,
)
from tippetop.fit.search import Minimum, Region, Search, apart
from tippetop.fit.template_bank import SPACING, lattice, phase_metric

TRUE = tt.presets.report_problem(spin=155.0)
TIMES = np.arange(0.0, 1.0, 1.0 / 60.0)
PIXEL = 2e-4


@pytest.fixture(scope="module")
def run():
    return tt.simulate(TRUE, 1.0, times=np.append(TIMES, 1.0)).isel(time=slice(0, -1))


@pytest.fixture(scope="module")
def film(run):
    """The tip from the side, at an unknown angle, half a pixel of noise, a tenth of frames lost."""
    rng = np.random.default_rng(1)
    x, y = run["x"].values, run["height"].values
    axis = run["axis"].values
    tip = 0.026  # the report's top: radius 2 cm, centre of mass 0.6 cm below that of the sphere
    x, y = x + tip * axis[:, 0], y + tip * axis[:, 2]
    side = run["y"].values + tip * axis[:, 1]
    across = (np.cos(0.7) * x + np.sin(0.7) * side) / PIXEL + 320.0
    up = y / PIXEL + 40.0
    seen = np.stack([across, up], 1) + rng.normal(0.0, 0.5, (len(TIMES), 2))
    seen[rng.random(len(TIMES)) < 0.1] = np.nan
    return tt.Measurement.of_point(TIMES, *seen.T, "side", scale=PIXEL, noise=0.5)


GUESSED = TRUE.replace({"friction.mu": 0.27, "launch.spin": 150.0})


def test_a_film_of_the_tip_gives_friction_and_spin(film):
    fitted = tt.fit(GUESSED, film, ["friction.mu", "launch.spin"])
    truth = {"friction.mu": 0.3, "launch.spin": 155.0, "camera.angle": 0.7}
    truth |= {"camera.x": 320.0, "camera.y": 40.0}
    distance = np.array([fitted.values[name] - truth[name] for name in fitted.values])
    squared = distance @ np.linalg.solve(fitted.covariance.values, distance)
    assert squared < 20.5  # chi² of 5 degrees of freedom, one in a thousand
    assert abs(fitted.chi2 - fitted.degrees_of_freedom) < 4.0 * np.sqrt(2 * film.count)
    assert fitted.undetermined == ()
    assert fitted.cautions == ()
    low, high = fitted.interval("friction.mu", 0.95)
    assert high - low == pytest.approx(2 * 1.959964 * fitted.errors["friction.mu"], rel=1e-6)
    units = {"friction.mu": "s/m", "launch.spin": "rad/s", "camera.angle": "rad"}
    assert fitted.units == units | {"camera.x": "px", "camera.y": "px"}
    assert str(fitted).splitlines()[0].endswith(" s/m")


def test_numbers_of_each_camera_have_its_unit(run):
    """A camera without a scale measures in its own unit, whatever that of another one is."""
    x, y = run["x"].values, run["y"].values
    cameras = [
        tt.Measurement.of_point(
            TIMES, x * size, y * size, "above", point="center", scale=scale, unit=unit, noise=1.0
        )
        for size, scale, unit in ((5000.0, None, "px"), (1000.0, 1e-3, "mm"))
    ]
    units = tt.fit(TRUE, cameras, "friction.mu", starts=1).units
    assert units["0.camera.scale"] == "m/px"
    assert units["0.camera.x"] == "px"
    assert units["1.camera.x"] == "mm"
    assert units["1.camera.angle"] == "rad"


def test_derivatives_are_those_of_the_drop():
    # Dropped from h with restitution e the ball lands at t = sqrt(2 h/g); in the second flight its
    # height is R + e g t (T - t) - g (T - t)^2 / 2.
    ball = tt.presets.report_problem(spin=0.0).replace(
        {
            "launch.tilt": 0.0,
            "launch.gap": 0.1,
            "contact.liftoff": "fly",
            "contact.restitution": 0.8,
        }
    )
    g, h, e, late = ball.gravity, 0.1, 0.8, 0.2
    data = tt.Measurement.of_variables([0.0, 0.1, late], {"height": [0.1, 0.2, 0.3]})
    model = Model(ball, [data], ["launch.gap", "contact.restitution", "gravity"])
    jacobian = model.jacobian(model.start)[-1]
    t = np.sqrt(2 * h / g)
    since, fall = late - t, g * t
    dt = {"launch.gap": 1 / (g * t), "contact.restitution": 0.0, "gravity": -t / (2 * g)}
    upward = {"launch.gap": 0.0, "contact.restitution": fall * since, "gravity": 0.0}
    upward["gravity"] = e * t * since - 0.5 * since**2
    expected = [
        upward[name] + dt[name] * (e * g * since - e * fall + g * since) for name in model.fields
    ]
    assert jacobian == pytest.approx(expected, rel=1e-8)


def test_a_direction_without_effect_is_named():
    # Of a body without slip and friction's part only the product of mass and nothing else counts:
    # the mass cancels from the motion when inertias go with it, and the azimuth from the tilt.
    data = tt.Measurement.of_variables(TIMES[:20], {"tilt": 0.1 + 0.001 * np.arange(20)})
    fitted = tt.fit(TRUE, data, ["friction.mu", "launch.azimuth"], starts=1)
    assert fitted.errors["launch.azimuth"] == np.inf
    assert any("launch.azimuth" in direction for direction in fitted.undetermined)
    assert np.isfinite(fitted.errors["friction.mu"])


def test_unknown_noise_is_estimated(run):
    rng = np.random.default_rng(3)
    tilt = run["tilt"].values + rng.normal(0.0, 0.01, len(TIMES))
    data = tt.Measurement.of_variables(TIMES, {"tilt": tilt})
    fitted = tt.fit(TRUE, data, "friction.mu")
    assert fitted.noise[0][0] == pytest.approx(0.01, rel=4 / np.sqrt(2 * len(TIMES)))
    stated = tt.fit(TRUE, data, "friction.mu", noise=0.01)
    ratio = fitted.errors["friction.mu"] / stated.errors["friction.mu"]
    assert ratio == pytest.approx(fitted.noise[0][0] / 0.01, rel=1e-4)


def test_a_profile_agrees_where_the_model_is_linear(run):
    rng = np.random.default_rng(4)
    tilt = run["tilt"].values + rng.normal(0.0, 1e-4, len(TIMES))
    data = tt.Measurement.of_variables(TIMES, {"tilt": tilt}, noise=1e-4)
    fitted = tt.fit(TRUE, data, ["friction.mu", "launch.tilt"])
    assert fitted.profile("friction.mu") == pytest.approx(fitted.interval("friction.mu"), rel=1e-4)


@pytest.mark.slow
def test_events_alone_give_friction():
    # At small friction mu t is the same for all mu: twice the friction turns over in half the time.
    slow, fast = TRUE.replace({"friction.mu": 0.02}), TRUE.replace({"friction.mu": 0.04})
    seen = float(tt.simulate(slow, 100.0, samples=2)["turnover_time"])
    fitted = tt.fit(fast, tt.Measurement.of_events({"turnover_time": 0.6 * seen}), "friction.mu")
    assert fitted.problem.friction.mu == pytest.approx(0.02 / 0.6, rel=0.01)


def test_neighbours_of_a_better_place_of_a_grid_are_left_out():
    region = Region(np.array([0.3]), np.array([[0.06]]))
    costs = {0.24: 9.0, 0.255: 4.0, 0.27: 1.0, 0.285: 4.0, 0.3: 9.0, 0.33: 3.0, 0.345: 5.0}
    ranked = sorted((cost, np.array([mu])) for mu, cost in costs.items())
    assert [float(point[0]) for _, point in apart(ranked, region)] == [0.27, 0.33]


def test_laws_are_told_apart_or_not(run):
    rng = np.random.default_rng(5)
    dry = {"friction.kind": "regularized_coulomb", "friction.mu": 0.3}

    def compared(noise):
        tilt = run["tilt"].values + rng.normal(0.0, noise, len(TIMES))
        data = tt.Measurement.of_variables(TIMES, {"tilt": tilt}, noise=noise)
        fits = {
            "viscous": tt.fit(TRUE, data, "friction.mu"),
            "dry": tt.fit(TRUE.replace(dry), data, {"friction.mu": (0.001, 1.0)}, starts=1),
        }
        return tt.compare_fits(fits)

    assert compared(0.005).preferred == "viscous"
    unclear = compared(30.0)
    assert unclear.preferred is None
    assert "cannot tell" in unclear.verdict


@pytest.mark.parametrize(
    "law",
    among(
        [
            tt.CoulombFriction(mu=0.3),
            tt.ContensouFriction(mu=0.3, patch_radius=5e-4),
            tt.RegularizedCoulombFriction(mu=0.3, eps=0.01),
        ],
        check=1,
    ),
    ids=lambda law: law.kind,
)
def test_a_film_under_another_law_ends_as_a_fit(law):
    """Runs of the search may stick, turn over or end early: none of its numbers is not finite."""
    times = np.linspace(0.0, 0.5, 31)
    problem = tt.presets.report_problem(spin=150.0)
    tilt = tt.simulate(problem, 0.5, times=times)["tilt"].values
    noisy = tilt + np.random.default_rng(3).normal(0.0, 0.02, times.size)
    data = tt.Measurement.of_variables(times, {"tilt": noisy}, noise=0.02)
    other = problem.model_copy(update={"friction": law})
    fitted = tt.fit(other, data, ["launch.spin", "friction.mu"], starts=1)
    assert np.isfinite(list(fitted.values.values())).all()
    assert np.isfinite(fitted.chi2)


@pytest.mark.slow
def test_the_profile_of_revolutions_a_minute():
    times = np.linspace(0.0, 1.0, 21)
    problem = tt.presets.report_problem(spin=150.0).replace(
        {"friction": tt.ContensouFriction(mu=0.3, patch_radius=1e-3)}
    )
    spin = tt.simulate(problem, 1.0, times=times)["angular_velocity"].values[:, 2]
    rates = np.abs(spin) * 60.0 / (2.0 * np.pi) + np.random.default_rng(3).normal(0.0, 5.0, 21)
    data = tt.Measurement.of_spin(times, rates, noise=5.0)
    fitted = tt.fit(problem, data, ["launch.spin", "friction.mu"], starts=1)
    for name in fitted.values:
        low, high = fitted.profile(name)
        assert low < fitted.values[name] < high


@pytest.mark.slow
def test_a_sharp_minimum_is_reached(monkeypatch):
    """The frequency of a disk that wobbles down grows without bound: a thousandth of a standard
    error of its rolling resistance changes the slopes of the last data.
    """
    ring = tt.Ring(radius=0.0375, tube=0.0, center=0.0)
    disk = tt.Problem(
        body=tt.Body(mass=0.4, shape=ring, I1=1.40625e-4, I3=2.8125e-4),
        friction=tt.ViscousFriction(mu=0.3),
        rolling_resistance=5e-4,
        launch=tt.Launch(tilt=0.25, spin=0.0, precession=65.0),
    )
    end = float(tt.simulate(disk, 9.0, samples=2)["event_time"][0])
    times, fields = np.linspace(0.0, 0.985 * end, 60), ["rolling_resistance", "launch.tilt"]
    heard = tt.simulate(disk, float(times[-1]), times=times)["precession"].values
    noisy = heard + np.random.default_rng(0).normal(0.0, 0.3, 60)
    sound = tt.Measurement.of_variables(times, {"precession": noisy}, noise=0.3)
    fitted = tt.fit(disk, sound, fields, starts=1)
    search, numbers = search_of(fitted), np.array(list(fitted.values.values()))
    exact = search.jacobian(numbers)
    step = np.linalg.lstsq(exact, search.residuals(numbers))[0]
    assert np.linalg.norm(exact @ step) < 0.01
    # Where steps of Gauss and Newton come to no end, the second derivatives are taken into account.
    monkeypatch.setattr(sys.modules[Search.__module__], "MOST_STEPS", 2)
    again = tt.fit(disk.replace({"launch.tilt": 0.25001}), sound, fields, starts=1)
    assert again.chi2 < fitted.chi2 + 1e-3


def test_what_does_not_converge_is_no_fit(monkeypatch, film):
    def stopped(self, start, *_, **__):
        return Minimum(start, 1.0, False, "too many steps")

    monkeypatch.setattr(Search, "refine", stopped)
    with pytest.raises(tt.NotConverged, match="did not reach a minimum"):
        tt.fit(GUESSED, film, ["friction.mu"], starts=1)


@pytest.fixture(scope="module")
def tilt_film():
    """Return a second of the tilt, to a quarter of a degree, at 60 pictures a second."""
    times, noise = np.arange(0.0, 1.0, 1.0 / 60.0), np.radians(0.25)
    true = tt.presets.report_problem(spin=152.0, mu=0.27)
    tilt = tt.simulate(true, 1.0, times=np.append(times, 1.0))["tilt"].values[:-1]
    seen = tilt + np.random.default_rng(0).normal(0.0, noise, len(times))
    film = tt.Measurement.of_variables(times, {"tilt": seen}, noise=noise)
    return true, film


BOTH = ["friction.mu", "launch.spin"]


@pytest.mark.slow
def test_minima_of_other_turns_of_nutation_are_passed_over(tilt_film):
    true, film = tilt_film
    guess = true.replace({"friction.mu": 0.25, "launch.spin": 143.0})
    nearest, parts = tt.fit(true, film, BOTH, starts=1), []
    fitted = tt.fit(guess, film, BOTH, callback=parts.append)
    assert fitted.chi2 < nearest.chi2 + 0.1
    # A search from the guess alone ends elsewhere, or nowhere.
    try:
        beside = tt.fit(guess, film, BOTH, starts=1).chi2
    except tt.NotConverged:
        beside = np.inf
    assert beside > nearest.chi2 + 10.0
    runs = [one.runs for one in parts]
    assert runs == sorted(runs)
    assert parts[-1].part == 1.0
    assert 0 < runs[0] < runs[-1] < fitted.runs < 2000


def test_a_search_that_is_ended_returns_its_best(tilt_film):
    true, film = tilt_film

    def interrupt(progress):
        if progress.runs > 50:
            raise KeyboardInterrupt

    ended = tt.fit(true.replace({"launch.spin": 149.0}), film, BOTH, callback=interrupt)
    assert "ended after" in ended.cautions[0]
    assert ended.runs < 80
    bounded = tt.fit(true, film, BOTH, most_runs=50)
    assert "bound of 50 runs" in bounded.cautions[0]


@pytest.mark.slow
def test_the_error_of_a_time_in_steps_is_that_of_its_noise():
    # The top turns over at a swing of its nutation, so that the time has steps of 25 ms.
    true = tt.presets.report_problem(spin=155.0, mu=0.4)

    def turned(mu):
        run = tt.simulate(
            true.replace({"friction.mu": mu}), 9.0, samples=2, until=lambda s: s.axis[2]
        )
        return float(run["end_time"])

    data, noise = turned(0.4), 0.15
    slope = (turned(0.44) - turned(0.36)) / 0.08
    clock = tt.Measurement.of_events({"turnover_time": data + 0.05}, noise=noise)
    fitted = tt.fit(true.replace({"friction.mu": 0.42}), clock, "friction.mu")
    # Both slopes are over some 0.8 s, whose ends are known to a step of at most 0.05 s.
    assert fitted.errors["friction.mu"] == pytest.approx(abs(noise / slope), rel=0.2)
    assert abs(fitted.values["friction.mu"] - 0.4) < fitted.errors["friction.mu"]
    sharp = tt.fit(fitted.problem, clock.with_noise(1e-6), "friction.mu", starts=1)
    assert sharp.errors["friction.mu"] > 0.01 / abs(slope)
    unknown = tt.fit(
        fitted.problem, tt.Measurement.of_events({"turnover_time": data}), "friction.mu"
    )
    assert np.isnan(unknown.errors["friction.mu"])
    assert "without a stated noise" in unknown.cautions[0]


def test_a_decay_of_another_kind_is_cautioned():
    """Thirteen rows of an exponential decay, fitted by drilling, whose torque is constant."""
    times = np.linspace(0.0, 3.0, 13)
    rates = 1480.0 * np.exp(-0.2 * times) + np.random.default_rng(14).normal(0.0, 1.0, 13)
    upright = TRUE.replace(
        {
            "friction": tt.ContensouFriction(mu=0.3, patch_radius=1e-3),
            "launch": tt.Launch(tilt=0.0, spin=150.0),
        }
    )
    data = tt.Measurement.of_spin(times, rates)
    fitted = tt.fit(upright, data, ["friction.mu", "launch.spin"], starts=1)
    assert any("not random" in caution for caution in fitted.cautions)


@pytest.mark.parametrize(("error", "noise"), [(0.0, None), (1e-4, 2e-3)])
def test_residuals_of_rounding_or_far_below_the_noise_are_no_sign_of_a_wrong_model(error, noise):
    """Rounding of a run, and a slow drift of a twentieth of the stated noise, have patterns."""
    times = np.linspace(0.0, 0.4, 25)
    tilt = tt.simulate(TRUE, 0.4, times=times)["tilt"].values
    film = tt.Measurement.of_variables(times, {"tilt": tilt + error * times / 0.4}, noise=noise)
    fitted = tt.fit(TRUE, film, "friction.mu", starts=1)
    assert not any("not random" in caution for caution in fitted.cautions)


def test_a_guess_may_turn_over_later_than_the_top_did():
    slow, fast = TRUE.replace({"friction.mu": 0.5}), TRUE.replace({"friction.mu": 0.6})
    seen = float(tt.simulate(fast, 9.0, samples=2)["turnover_time"])
    assert float(tt.simulate(slow, 9.0, samples=2)["turnover_time"]) > seen
    clock = tt.Measurement.of_events({"turnover_time": seen}, noise=0.1)
    fitted = tt.fit(slow, clock, "friction.mu", starts=1)
    assert abs(fitted.values["friction.mu"] - 0.6) < 2.0 * fitted.errors["friction.mu"]


@pytest.mark.slow
@pytest.mark.parametrize("noise", [1.5, None])
def test_a_fast_film_from_the_side_ends_as_near_as_a_search_from_the_truth(noise):
    """A second of the tip at 240 pictures, to 0.3 mm: SciPy's own search from the truth, by the
    residuals alone, ends no nearer.
    """
    true = tt.presets.report_problem(spin=140.0)
    times = np.arange(0.0, 1.0, 1.0 / 240.0)
    run = tt.simulate(true, 1.0, times=np.append(times, 1.0)).isel(time=slice(0, -1))
    axis = 0.026 * run["axis"].values
    seen = np.stack([run["x"].values + axis[:, 0], run["height"].values + axis[:, 2]], 1) / PIXEL
    seen += np.random.default_rng(15).normal(0.0, 1.5, seen.shape)
    film = tt.Measurement.of_point(times, *seen.T, "side", scale=PIXEL, noise=noise)
    fitted = tt.fit(true.replace({"launch.spin": 144.0, "friction.mu": 0.29}), film, BOTH)
    search = search_of(fitted)
    truth = np.array([0.3, 140.0, 0.0, 0.0, 0.0])
    reached = least_squares(search.residuals, truth, x_scale=search.model.scales(truth))
    variance = 1.0 if noise else 2.0 * reached.cost / fitted.degrees_of_freedom
    assert fitted.cost < 2.0 * reached.cost + 0.1 * variance
    assert abs(fitted.values["launch.spin"] - 140.0) < 4.0 * fitted.errors["launch.spin"]
    assert fitted.cautions == ()


def test_several_launches_are_one_fit():
    # Of launches with own spins and a common friction the information on friction adds up.
    times, random = np.arange(0.0, 0.5, 1.0 / 120.0), np.random.default_rng(12)
    pairs, alone = [], []
    for spin in (140.0, 150.0):
        true = tt.presets.report_problem(spin=spin)
        tilt = tt.simulate(true, 0.5, times=np.append(times, 0.5))["tilt"].values[:-1]
        seen = tilt + random.normal(0.0, 1e-3, len(times))
        film = tt.Measurement.of_variables(times, {"tilt": seen}, noise=1e-3)
        pairs.append((true, film))
        alone.append(tt.fit(true, film, BOTH, starts=1))
    fitted = tt.fit(pairs, vary=BOTH, shared=["friction.mu"], starts=1)
    assert list(fitted.values) == ["friction.mu", "0.launch.spin", "1.launch.spin"]
    information = sum(one.errors["friction.mu"] ** -2 for one in alone)
    assert fitted.errors["friction.mu"] == pytest.approx(information**-0.5, rel=0.02)
    mean = sum(one.values["friction.mu"] * one.errors["friction.mu"] ** -2 for one in alone)
    assert fitted.values["friction.mu"] == pytest.approx(mean / information, rel=0.02)
    spins = [fitted.values["0.launch.spin"], fitted.values["1.launch.spin"]]
    assert [one.launch.spin for one in fitted.problems] == spins
    with pytest.raises(tt.InvalidInput, match="pairs"):
        tt.fit([TRUE], vary=BOTH)


@pytest.mark.slow
def test_a_table_of_launches_is_one_fit(tmp_path):
    table, problem = tmp_path / "launches.csv", tmp_path / "mine.toml"
    true = tt.presets.report_problem(mu=0.6)
    spins = (140.0, 160.0)
    seen = [
        float(tt.simulate(true.replace({"launch.spin": spin}), 9.0, samples=2)["turnover_time"])
        for spin in spins
    ]
    rows = [f"{spin};{time:.2f}".replace(".", ",") for spin, time in zip(spins, seen, strict=True)]
    table.write_text("\n".join(["launch.spin (rad/s);dreht sich um (s)", *rows]))
    problem.write_text(true.replace({"friction.mu": 0.55}).to_toml())
    command = ["fit", str(table), str(problem), "--vary", "friction.mu", "--noise", "0.1", "--json"]
    told = json.loads(CliRunner().invoke(app, command, catch_exceptions=False).stdout)
    assert told["degrees_of_freedom"] == 1
    assert abs(told["values"]["friction.mu"] - 0.6) < 2.0 * told["errors"]["friction.mu"] < 0.06


def test_noise_that_is_not_stated_has_no_chi2(run):
    noise = np.random.default_rng(8).normal(0.0, 0.01, len(TIMES))
    data = tt.Measurement.of_variables(TIMES, {"tilt": run["tilt"].values + noise})
    fitted = tt.fit(TRUE, data, "friction.mu", starts=1)
    assert np.isnan(fitted.chi2)
    assert fitted.summary()["chi2"] is None
    assert "noise was not stated" in str(fitted)


def test_noise_stated_too_large_or_too_small_is_named(run):
    noise = np.random.default_rng(9).normal(0.0, 0.01, len(TIMES))
    data = tt.Measurement.of_variables(TIMES, {"tilt": run["tilt"].values + noise})
    for stated, word in ((0.02, "smaller than"), (0.005, "larger than")):
        fitted = tt.fit(TRUE, data, "friction.mu", starts=1, noise=stated)
        assert any(word in caution for caution in fitted.cautions), stated


@pytest.mark.parametrize(("count", "numbers"), [(8, 4), (10, 4), (12, 3), (20, 4), (60, 5)])
def test_residuals_of_a_fit_are_told_from_noise_as_often_as_promised(count, numbers):
    """The fit takes the slow part away, and what is left of white noise alternates more."""
    columns = np.vander(np.linspace(-1.0, 1.0, count), numbers, increasing=True)
    fitted = np.linalg.qr(columns)[0]
    tables = np.random.default_rng(18).normal(size=(1000, count))
    residuals = tables - tables @ fitted @ fitted.T
    assert np.mean([are_correlated(one, fitted) for one in residuals]) < 0.02
    mean, deviation = durbin_watson_moments(fitted)
    ratios = np.sum(np.diff(residuals) ** 2, axis=1) / np.sum(residuals**2, axis=1)
    assert abs(ratios.mean() - mean) < 4.0 * deviation / 1000**0.5
    assert ratios.std() == pytest.approx(deviation, rel=0.1)


def test_of_several_columns_each_has_moments_of_its_own():
    """A column's rows of the directions of a whole table make no projection."""
    random = np.random.default_rng(19)
    fitted = np.linalg.qr(random.normal(size=(24, 3)).cumsum(axis=0))[0]
    tables = random.normal(size=(4000, 24))
    column = (tables - tables @ fitted @ fitted.T)[:, ::2]
    ratios = np.sum(np.diff(column) ** 2, axis=1) / np.sum(column**2, axis=1)
    mean, deviation = durbin_watson_moments(fitted[::2])
    assert ratios.mean() == pytest.approx(mean, abs=0.05)
    assert ratios.std() == pytest.approx(deviation, rel=0.1)


def test_residuals_that_alternate_do_not_make_errors_too_small(run):
    alternating = 0.01 * (-1.0) ** np.arange(len(TIMES))
    slow = 0.01 * np.cos(4.0 * TIMES)
    for error, is_small in ((alternating, False), (slow, True)):
        data = tt.Measurement.of_variables(TIMES, {"tilt": run["tilt"].values + error}, noise=0.01)
        cautions = tt.fit(TRUE, data, "friction.mu", starts=1).cautions
        caution = next(one for one in cautions if "not random" in one)
        assert "may lack something" in caution
        assert "of 1000 tables" in caution or "Durbin-Watson" in caution
        assert ("errors are too small" in caution) is is_small


@pytest.mark.parametrize("period", [2.0, 3.0, 4.0, 5.0, 9.0])
def test_a_swing_of_the_residuals_is_named_with_its_period(run, period):
    """A swing as fast as that hardly moves what is fitted, and makes no error too small."""
    error = 0.01 * np.cos(2.0 * np.pi * np.arange(len(TIMES)) / period + 0.3)
    data = tt.Measurement.of_variables(TIMES, {"tilt": run["tilt"].values + error}, noise=0.01)
    cautions = tt.fit(TRUE, data, "friction.mu", starts=1).cautions
    caution = next(one for one in cautions if "not random" in one)
    words = caution.split("they swing ")[1]
    if words.startswith("from one value to the next"):
        assert period < 3.0
    else:
        assert float(words.split("period of ")[1].split()[0]) == pytest.approx(period, rel=0.05)
    assert ("errors are too small" in caution) is (period > 6.0)


@pytest.mark.parametrize(("count", "is_few"), [(5, True), (25, False)])
def test_data_too_few_to_show_whether_the_model_fits_say_so(count, is_few):
    times = np.linspace(0.0, 0.4, count)
    tilt = tt.simulate(TRUE, 0.4, times=times)["tilt"].values
    film = tt.Measurement.of_variables(times, {"tilt": tilt}, noise=0.01)
    cautions = tt.fit(TRUE, film, "friction.mu", starts=1).cautions
    assert any("too few to show whether the model fits" in one for one in cautions) is is_few


def test_times_of_many_launches_show_whether_the_model_fits():
    """Ten times that miss by more the later they are drift, in whatever order the launches are."""
    random = np.random.default_rng(4)
    times, scatter = random.permutation(np.linspace(2.0, 8.0, 10)), random.normal(0.0, 0.01, 10)
    launches = [
        Model(TRUE, [tt.Measurement.of_events({"turnover_time": time}, 0.01)], ["friction.mu"])
        for time in times
    ]
    model = JointModel(launches, ["friction.mu"])
    search = Search(model, np.full(10, 0.01), np.array([0.0]), np.array([np.inf]))
    slopes = times[:, None]
    for error, is_drift in ((scatter, False), (scatter + 0.02 * (times - 5.0), True)):
        shown = times + error
        (column,) = search.columns((shown - times) / 0.01, slopes)
        assert np.allclose(column.residuals, (error / 0.01)[np.argsort(shown)])
        assert column.is_correlated == is_drift
        assert can_be_correlated(column.fitted)


@pytest.mark.parametrize(("count", "numbers"), [(5, 1), (8, 4), (12, 8)])
def test_with_four_degrees_of_freedom_no_pattern_is_named(count, numbers):
    """Durbin and Watson's statistic of the purest drift or swing is within 2.6 deviations."""
    columns = np.vander(np.linspace(-1.0, 1.0, count), numbers, increasing=True)
    fitted = np.linalg.qr(columns)[0]
    assert not can_be_correlated(fitted)
    tables = np.random.default_rng(20).normal(size=(2000, count))
    residuals = tables - tables @ fitted @ fitted.T
    assert not any(are_correlated(one, fitted) for one in residuals)
    assert can_be_correlated(np.linalg.qr(columns[:, :1])[0]) is (count > 5)


def test_drifts_are_told_from_noise():
    drift = np.cos(np.linspace(0.0, 2.0 * np.pi, 13))
    assert are_correlated(drift)
    random = np.random.default_rng(10)
    wrong = np.mean([are_correlated(random.normal(size=13)) for _ in range(2000)])
    assert wrong < 0.02
    # Of an autoregression of first order rho the sum of the autocorrelation is (1 + rho)/(1 - rho).
    series = [0.0]
    for step in random.normal(size=8000):
        series.append(0.8 * series[-1] + step)
    assert correlation_time(np.array(series)) == pytest.approx(9.0, rel=0.2)
    white = random.normal(size=8000)
    assert not are_correlated(white)
    assert correlation_time(white) == pytest.approx(1.0, abs=0.2)


def test_oscillations_are_told_from_noise():
    """A quarter of a turn from one picture to the next leaves Durbin and Watson's statistic at 2,
    and nearly half a turn raises it.
    """
    random, places = np.random.default_rng(16), np.arange(60)
    for turns in (0.25, 0.45):
        oscillation = np.cos(2.0 * np.pi * turns * places)
        assert are_correlated(oscillation + 0.7 * random.normal(size=60)), turns
    wrong = np.mean([are_correlated(random.normal(size=60)) for _ in range(2000)])
    assert wrong < 0.02
    assert not are_correlated(np.zeros(60))
    assert are_correlated(np.ones(60))


def test_numbers_that_are_known_only_together_are_named():
    """Nutation shows I3/I1 times the spin; without their product's other factors known, a spin and
    a moment of inertia are free.
    """
    times, random = np.linspace(0.0, 0.4, 25), np.random.default_rng(17)
    tilt = tt.simulate(TRUE, 0.4, times=times)["tilt"].values + random.normal(0.0, 0.002, 25)
    film = tt.Measurement.of_variables(times, {"tilt": tilt}, noise=0.002)
    fitted = tt.fit(TRUE, film, ["launch.spin", "body.I1"], starts=1)
    relative = np.array(list(fitted.errors.values())) / list(fitted.values.values())
    together = next(one for one in fitted.cautions if "known only together" in one)
    assert "launch.spin · body.I1^-" in together
    percent = float(together.rsplit(" to ")[1].split()[0])
    assert 0.01 * percent < 0.1 * relative.min()
    alone = tt.fit(TRUE, film, BOTH, starts=1)
    assert not any("known only together" in one for one in alone.cautions)


@pytest.mark.parametrize(("correlation", "sign"), [(0.9999, "\N{MINUS SIGN}"), (-0.9999, "+")])
def test_a_sum_that_is_known_alone_is_written_with_its_sign_and_unit(correlation, sign):
    """Errors 3 and 2 with the correlation 0.9999: the sum a -+ 1.5 b has the error 0.042."""
    names, units = ["launch.spin", "launch.precession"], ["rad/s", "rad/s"]
    covariance = np.array([[9.0, 6.0 * correlation], [6.0 * correlation, 4.0]])
    (words,) = known_together(names, np.array([150.0, -0.1]), covariance, units)
    assert words.endswith(f"launch.spin {sign} 1.5 · launch.precession to 0.042 rad/s")


def test_a_search_of_the_nearest_minimum_alone_says_so(tilt_film):
    true, film = tilt_film
    fitted = tt.fit(true, film, "friction.mu", starts=1)
    assert any("one start" in one for one in fitted.cautions)
    assert not any("one start" in one for one in tt.fit(true, film, "friction.mu").cautions)


def test_templates_cover_a_region_in_phase():
    # The phase of cos((w + d) t) is d t: its mean square over a time T is d^2 T^2 / 3.
    times, rate = np.linspace(0.0, 4.0, 8001), 60.0
    values, slopes = np.cos(rate * times), -times * np.sin(rate * times)
    metric = phase_metric(np.diff(np.stack([values, slopes], 1), n=2, axis=0))
    assert metric[0, 0] == pytest.approx(16.0 / 3.0, rel=0.01)
    random = np.random.default_rng(11)
    shape = random.normal(size=(3, 3)) * [20.0, 3.0, 0.1]
    metric, reach = shape.T @ shape, np.diag([1.0, 0.5, 2.0])
    points = lattice(reach, metric)
    for place in random.uniform(-1.0, 1.0, (200, 3)) @ reach:
        apart = (points - place) @ shape.T
        # Half the diagonal of a cell.
        assert np.linalg.norm(apart, axis=1).min() < 0.5 * SPACING * 3.0**0.5


WRONG = {
    "no such field": ({"vary": "friction.nu"}, "nu"),
    "a word": ({"vary": "friction.kind"}, "vary"),
    "a range upside down": ({"vary": {"friction.mu": (0.5, 0.1)}}, "range"),
    "no fields": ({"vary": []}, "names of fields"),
    "a noise of zero": ({"vary": "friction.mu", "noise": 0.0}, "noise"),
    "no starts": ({"vary": "friction.mu", "starts": 0}, "starts"),
}


@pytest.mark.parametrize(("arguments", "sentence"), WRONG.values(), ids=WRONG)
def test_wrong_arguments_get_a_sentence(film, arguments, sentence):
    with pytest.raises(tt.InvalidInput, match=sentence):
        tt.fit(TRUE, film, **arguments)


def test_fewer_data_than_numbers_are_refused():
    data = tt.Measurement.of_events({"turnover_time": 3.0})
    with pytest.raises(tt.InvalidInput, match="at least 2"):
        tt.fit(TRUE, data, ["friction.mu", "launch.spin"])


def test_a_run_without_the_events_is_refused():
    data = tt.Measurement.of_events({"turnover_time": 0.1})
    with pytest.raises(tt.InvalidInput, match="does not show all that was measured"):
        tt.fit(TRUE, data, ["friction.mu"])


def test_the_command_fits_a_file(tmp_path, run):
    data, problem, drawn = (tmp_path / name for name in ("film.csv", "mine.toml", "fit.png"))
    tilt = np.degrees(run["tilt"].values) + np.random.default_rng(6).normal(0, 0.5, len(TIMES))
    rows = [f"{t:.4f};{d:.3f}".replace(".", ",") for t, d in zip(TIMES, tilt, strict=True)]
    data.write_text("\n".join(["t (s);tilt (deg)", *rows]))
    problem.write_text(TRUE.replace({"friction.mu": 0.27}).to_toml())
    command = ["fit", str(data), str(problem), "--vary", "friction.mu", "--json"]
    answer = CliRunner().invoke(app, [*command, "--plot", str(drawn)], catch_exceptions=False)
    told = json.loads(answer.stdout)
    assert abs(told["values"]["friction.mu"] - 0.3) < 4 * told["errors"]["friction.mu"]
    assert told["problem"]["friction"]["mu"] == told["values"]["friction.mu"]
    assert drawn.read_bytes()[:4] == b"\x89PNG"


COMMANDS = {
    "no fields": ([], "--vary"),
    "a range of one end": (["--vary", "friction.mu=3"], "LOW:HIGH"),
    "noise of a word": (["--vary", "friction.mu", "--noise", "much"], "--noise: 'much'"),
    "a drawing of another kind": (["--vary", "friction.mu", "--plot", "fit.txt"], "--plot"),
    "an unknown field": (["--vary", "friction.nu"], "vary: 'friction.nu'"),
}


@pytest.mark.parametrize(("options", "sentence"), COMMANDS.values(), ids=COMMANDS)
def test_the_command_refuses_in_a_sentence(tmp_path, options, sentence):
    data = tmp_path / "film.csv"
    data.write_text("t,tilt\n0,0.1\n0.1,0.12\n0.2,0.2\n")
    with pytest.raises(tt.InvalidInput, match=sentence) as refusal:
        CliRunner().invoke(app, ["fit", str(data), *options], catch_exceptions=False)
    assert "\n" not in str(refusal.value)
