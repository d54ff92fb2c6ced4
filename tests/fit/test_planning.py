"""Plans: the errors that a fit will have, before there are data."""

import numpy as np
import pytest

import tippetop as tt

TOP = tt.presets.report_problem(spin=155.0)


def test_a_plan_foretells_the_scatter_of_fits():
    (way,) = tt.plan_measurement(TOP, 0.5, ["friction.mu"], noise={"tilt": 3e-4}, accuracy=0.02)
    assert way.error <= 0.02
    times = np.arange(0.0, way.duration, 1.0 / way.frame_rate)
    tilt = tt.simulate(TOP, float(times[-1]), times=times)["tilt"].values
    random, values = np.random.default_rng(2), []
    for _ in range(16):
        seen = tilt + random.normal(0.0, 3e-4, len(times))
        film = tt.Measurement.of_variables(times, {"tilt": seen}, noise=3e-4)
        values.append(tt.fit(TOP, film, ["friction.mu"], starts=1).values["friction.mu"])
    # Of 16 fits the scatter is known to 18 %.
    assert 1.0 / 1.5 < np.std(values, ddof=1) / (0.3 * way.error) < 1.5


def test_plans_can_be_filmed():
    ways = tt.plan_measurement(TOP, 1.0, ["friction.mu"], accuracy=0.3)
    nutation = TOP.body.I3 * 155.0 / TOP.body.I1 / (2.0 * np.pi)
    assert len({way.quantity for way in ways}) == len(ways) > 1
    for way in ways:
        assert way.frame_rate in (30.0, 60.0, 120.0, 240.0)
        assert way.frame_rate > 2.0 * nutation
        assert way.frame_rate * way.duration >= 2.0
        assert way.error <= 0.45
    pictures = [way.frame_rate * way.duration for way in ways]
    assert pictures == sorted(pictures)


def test_what_cannot_be_seen_has_no_plan():
    with pytest.raises(tt.InvalidInput, match="nothing at best"):
        tt.plan_measurement(TOP, 0.5, ["launch.azimuth"], noise={"tilt": 0.02})


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
