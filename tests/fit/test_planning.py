"""Plans: the errors that a fit will have, before there are data."""

import sys
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import pytest

import made_data
import tippetop as tt
from campaigns import seeds
from tippetop.fit.planning import CAMERA, planned_measurements

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


NOISES = {**made_data.NOISES, "tip from the side": 5e-4, "tip from above": 5e-4}


@pytest.mark.parametrize("seed", seeds(check=0, sample=0, claim=30))
def test_the_errors_of_plans_are_the_scatter_of_fits(seed):
    """The scatter of 30 fits is known to 13 %."""
    random = np.random.default_rng(500 + seed)
    quantity = list(NOISES)[seed % len(NOISES)]
    noise, mu = NOISES[quantity], float(random.uniform(0.2, 0.4))
    top = tt.presets.report_problem(spin=float(random.uniform(100.0, 160.0)))
    top = top.replace({"friction": made_data.rising_law(seed // len(NOISES), mu)})
    is_clock = quantity == "time of turning over"
    fields = ["friction.mu"] if is_clock or seed % 2 else ["friction.mu", "launch.spin"]
    longest = 20.0 if is_clock else float(random.choice([1.0, 2.0, 4.0]))
    try:
        (plan,) = tt.plan_measurement(top, longest, fields, noise={quantity: noise}, accuracy=0.3)
    except tt.InvalidInput:
        pytest.skip("no plan reaches the accuracy")
    exact = exact_data(top, plan, longest, noise)
    values = [
        tt.fit(top, exact.noisy(random), fields, starts=1).values["friction.mu"] for _ in range(30)
    ]
    assert 1.0 / 1.5 < np.std(values, ddof=1) / (mu * plan.error) < 1.5


class ExactData(NamedTuple):
    """What a planned measurement shows of a top, without noise."""

    measurement: tt.Measurement
    noise: float

    def noisy(self, random):
        """Return it with noise."""
        values = self.measurement.values
        return replace(
            self.measurement, values=values + random.normal(0.0, self.noise, values.shape)
        )


def exact_data(top, plan, longest, noise):
    """Return what a plan measures of a top."""
    (planned,) = planned_measurements(top, longest, {plan.quantity: noise}).values()
    if plan.frame_rate:
        times = np.arange(0.0, plan.duration, 1.0 / plan.frame_rate)
        run = tt.simulate(top, float(times[-1]), times=times)
        planned = replace(planned, times=times, values=planned.observation(run, CAMERA))
    return ExactData(planned, noise)


def test_a_plan_has_the_accuracy_that_is_asked_for_in_fits_of_made_data():
    """A film whose error is within it by its derivatives only is passed over."""
    noise = {"tip from the side": 5e-4}
    for accuracy in (0.0325, 0.05):
        ways = tt.plan_measurement(TOP, 1.0, ["friction.mu"], noise=noise, accuracy=accuracy)
        assert all(way.error <= accuracy for way in ways)


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


def test_a_plan_that_made_data_do_not_confirm_is_refused(monkeypatch):
    module = sys.modules[planned_measurements.__module__]
    monkeypatch.setattr(module, "_confirmed", lambda *arguments: None)
    with pytest.raises(tt.InvalidInput, match="made data do not confirm"):
        tt.plan_measurement(TOP, 0.5, ["friction.mu"], noise={"tilt": 3e-4}, accuracy=0.05)


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
