"""Plans: the errors that a fit will have, before there are data."""

import numpy as np
import pytest

import tippetop as tt

TOP = tt.presets.report_problem(spin=155.0)


def test_a_plan_foretells_the_errors_of_the_fit():
    ways = tt.plan_measurement(TOP, 1.0, ["friction.mu", "launch.tilt"], noise={"tilt": 2e-4})
    (way,) = [way for way in ways if way.duration == 1.0]
    times = np.linspace(0.0, 1.0, 61)
    tilt = tt.simulate(TOP, 1.0, times=times)["tilt"].values
    noisy = tilt + np.random.default_rng(2).normal(0.0, 2e-4, 61)
    film = tt.Measurement.of_variables(times, {"tilt": noisy}, noise=2e-4)
    fitted = tt.fit(TOP, film, ["friction.mu", "launch.tilt"])
    # One frame more than 60, and derivatives at the fit instead of the truth.
    assert way.error == pytest.approx(fitted.errors["friction.mu"] / 0.3, rel=0.05)


def test_the_frames_needed_grow_with_the_square_of_the_accuracy():
    coarse, fine = (
        tt.plan_measurement(TOP, 0.5, ["friction.mu"], accuracy=accuracy, noise={"tilt": 0.02})
        for accuracy in (0.1, 0.01)
    )
    rates = [{way.duration: way.frame_rate for way in ways} for ways in (coarse, fine)]
    for duration in (0.125, 0.25, 0.5):
        assert rates[1][duration] == pytest.approx(100.0 * rates[0][duration], rel=1e-9)


def test_what_cannot_be_seen_is_not_known_by_any_number_of_frames():
    (way, *_) = tt.plan_measurement(TOP, 0.5, ["launch.azimuth"], noise={"tilt": 0.02})
    assert way.frame_rate == np.inf


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        ({"vary": ["friction.nu"]}, "nu"),
        ({"vary": ["friction.mu"], "accuracy": 0.0}, "accuracy"),
        ({"vary": ["friction.mu"], "noise": {"colour": 1.0}}, "colour"),
        ({"vary": ["friction.mu"], "noise": {"tilt": -1.0}}, "noise.tilt"),
        ({"vary": ["friction.mu"], "noise": {"time of turning over": 0.1}}, "not to be seen"),
    ],
)
def test_wrong_plans_get_a_sentence(arguments, sentence):
    with pytest.raises(tt.InvalidInput, match=sentence):
        tt.plan_measurement(TOP, 0.1, **arguments)
