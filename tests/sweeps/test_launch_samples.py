"""Sampled launches: distributions, listed values and tables, and what is refused of them."""

import json

import numpy as np
import pandas as pd
import pytest
from scipy import stats

import tippetop as tt
from tippetop.sweeps import Sweep
from tippetop.sweeps.launch_samples import LaunchSamples

REPORT = tt.presets.report_problem()
SPIN, MU = "launch.spin", "friction.mu"


def values_of(table, n=1000, seed=3):
    samples = LaunchSamples.of(table, n, seed)
    return samples.values(np.arange(samples.count))


@pytest.mark.parametrize(
    ("entry", "distribution"),
    [
        ({"law": "normal", "mean": 150.0, "std": 5.0}, stats.norm(150.0, 5.0)),
        ({"law": "lognormal", "median": 0.3, "sigma": 0.2}, stats.lognorm(0.2, scale=0.3)),
        (stats.gamma(3.0, loc=1.0, scale=2.0), stats.gamma(3.0, loc=1.0, scale=2.0)),
        (stats.poisson(4.0), stats.poisson(4.0)),
    ],
    ids=["normal", "lognormal", "gamma", "poisson"],
)
def test_samples_follow_their_distribution(entry, distribution):
    found = values_of({SPIN: entry}, n=20_000)[SPIN]
    levels = distribution.ppf([0.1, 0.5, 0.9])
    below = [float(np.mean(found <= level)) for level in levels]
    # Three standard errors of a share among 20,000 are at most 0.011.
    assert below == pytest.approx(distribution.cdf(levels), abs=0.011)


def test_fields_are_independent_and_follow_the_seed():
    table = {SPIN: stats.norm(100.0, 10.0), MU: stats.norm(0.3, 0.01)}
    found = values_of(table, n=20_000)
    assert abs(np.corrcoef(found[SPIN], found[MU])[0, 1]) < 0.022
    assert np.array_equal(values_of(table, n=50)[SPIN], found[SPIN][:50])
    assert not np.array_equal(values_of(table, n=50, seed=4)[SPIN], found[SPIN][:50])


@pytest.mark.parametrize("make", [list, np.array, pd.Series], ids=["list", "array", "series"])
def test_listed_values_are_launched_as_they_are(make):
    found = tt.sweep(REPORT, samples={SPIN: make([50.0, 50.0, 155.0])}, duration=0.1, workers=1)
    assert found["final_theta"].dims == ("sample",)
    assert found["spin"].values.tolist() == [50.0, 50.0, 155.0]
    assert float(found["final_theta"][0]) == float(found["final_theta"][1])


def test_a_table_of_launches_keeps_its_correlation():
    table = pd.DataFrame({SPIN: [50.0, 100.0, 155.0], MU: [0.1, 0.2, 0.3]})
    found = tt.sweep(REPORT, samples=table, duration=0.1, workers=1)
    for place, (spin, mu) in enumerate(zip(table[SPIN], table[MU], strict=True)):
        run = tt.simulate(REPORT.replace({SPIN: spin, MU: mu}), 0.1)
        assert float(found["final_theta"][place]) == pytest.approx(
            float(run["final_theta"]), abs=1e-7
        )


def test_a_sweep_of_samples_is_stored_and_read_back_with_its_seed(tmp_path):
    pytest.importorskip("zarr")
    samples = {SPIN: stats.norm(150.0, 5.0), MU: [0.2, 0.3]}
    asked = {"samples": samples, "seed": 7, "duration": 0.1, "workers": 1}
    stored = tt.sweep(REPORT, out=tmp_path / "s.zarr", **asked)
    in_memory = tt.sweep(REPORT, **asked)
    assert stored.attrs["seed"] == in_memory.attrs["seed"] == 7
    assert np.array_equal(stored["spin"], in_memory["spin"])
    sweep = Sweep(**json.loads(in_memory.attrs["sweep"]))
    assert np.array_equal(sweep.grid.values(np.arange(2))[SPIN], in_memory["spin"])


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"samples": {SPIN: stats.norm(1.0, 1.0)}}, "how many samples"),
        ({"samples": {SPIN: [1.0, 2.0], MU: [0.1]}}, "one a sample: 2"),
        ({"samples": {SPIN: "normal"}, "n": 2}, "distribution of scipy.stats"),
        ({"samples": {SPIN: {"law": "cauchy"}}, "n": 2}, "'normal' or 'lognormal'"),
        ({"samples": {SPIN: {"law": "normal", "mean": 1.0}}, "n": 2}, "mean and std"),
        ({"samples": {SPIN: {"distribution": "nothing"}}, "n": 2}, "name of a distribution"),
        ({"samples": {SPIN: {"distribution": "gamma"}}, "n": 2}, "shape parameters a"),
        ({"samples": {"launch.spinn": [1.0]}}, "launch.spin"),
        ({}, "one of them"),
        ({"over": {SPIN: [1.0]}, "samples": {SPIN: [1.0]}}, "one of them"),
        ({"over": {SPIN: [1.0]}, "n": 2}, "n: 2 is for samples, and over is given"),
        ({"over": {SPIN: [1.0]}, "seed": 0}, "seed: 0 is for samples, and over is given"),
    ],
    ids=[
        "no count",
        "lengths",
        "word",
        "law",
        "numbers of a law",
        "distribution",
        "shape",
        "field",
        "nothing",
        "both",
        "number of axes",
        "seed of axes",
    ],
)
def test_samples_that_cannot_be_are_refused_in_a_sentence(arguments, words):
    with pytest.raises(tt.InvalidInput, match=words):
        tt.sweep(REPORT, duration=0.1, workers=1, **arguments)
