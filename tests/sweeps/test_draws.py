"""Drawn launches: distributions, listed values and tables, and what is refused of them."""

import json

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from scipy import stats

import tippetop as tt
from tippetop.sweeps import Sweep
from tippetop.sweeps.draws import Draws

REPORT = tt.presets.report_problem()
SPIN, MU = "launch.spin", "friction.mu"


def values_of(table, count=1000, seed=3):
    draws = Draws.of(table, count, seed)
    return draws.values(np.arange(draws.count))


class Triangular:
    """Distribution that only has quantiles: those of a triangle over (0, 1) with its peak at 1."""

    def ppf(self, share):
        return np.sqrt(share)


@pytest.mark.parametrize(
    ("entry", "distribution"),
    [
        ({"distribution": "norm", "loc": 150.0, "scale": 5.0}, stats.norm(150.0, 5.0)),
        ({"distribution": "lognorm", "s": 0.2, "scale": 0.3}, stats.lognorm(0.2, scale=0.3)),
        ({"from": 10.0, "to": 30.0}, stats.uniform(10.0, 20.0)),
        ({"from": 0.1, "to": 10.0, "spacing": "log"}, stats.loguniform(0.1, 10.0)),
        (Triangular(), stats.triang(1.0)),
        (stats.gamma(3.0, loc=1.0, scale=2.0), stats.gamma(3.0, loc=1.0, scale=2.0)),
        (stats.poisson(4.0), stats.poisson(4.0)),
    ],
    ids=["norm", "lognorm", "range", "log range", "ppf alone", "gamma", "poisson"],
)
def test_draws_follow_their_distribution(entry, distribution):
    found = values_of({SPIN: entry}, count=20_000)[SPIN]
    levels = distribution.ppf([0.1, 0.5, 0.9])
    below = [float(np.mean(found <= level)) for level in levels]
    # Three standard errors of a share among 20,000 are at most 0.011.
    assert below == pytest.approx(distribution.cdf(levels), abs=0.011)


def test_a_unit_of_another_kind_is_refused_by_the_parameter():
    with pytest.raises(tt.InvalidInput, match=r"launch\.spin\.loc: 1500 mm is a length"):
        values_of({SPIN: {"distribution": "norm", "loc": "1500 mm"}}, count=3)


def test_fields_are_independent_and_follow_the_seed():
    table = {SPIN: stats.norm(100.0, 10.0), MU: stats.norm(0.3, 0.01)}
    found = values_of(table, count=20_000)
    assert abs(np.corrcoef(found[SPIN], found[MU])[0, 1]) < 0.022
    assert np.array_equal(values_of(table, count=50)[SPIN], found[SPIN][:50])
    assert not np.array_equal(values_of(table, count=50, seed=4)[SPIN], found[SPIN][:50])


@pytest.mark.parametrize("make", [list, np.array, pd.Series, xr.DataArray])
def test_listed_values_are_launched_as_they_are(make):
    found = tt.sweep(REPORT, draw={SPIN: make([50.0, 50.0, 155.0])}, duration=0.1, workers=1)
    assert found["final_tilt"].dims == ("draw",)
    assert found["spin"].values.tolist() == [50.0, 50.0, 155.0]
    assert float(found["final_tilt"][0]) == float(found["final_tilt"][1])


def test_a_table_of_launches_keeps_its_correlation():
    table = pd.DataFrame({SPIN: [50.0, 100.0, 155.0], MU: [0.1, 0.2, 0.3]})
    found = tt.sweep(REPORT, draw=table, duration=0.1, workers=1)
    for place, (spin, mu) in enumerate(zip(table[SPIN], table[MU], strict=True)):
        run = tt.simulate(REPORT.replace({SPIN: spin, MU: mu}), 0.1)
        assert float(found["final_tilt"][place]) == pytest.approx(
            float(run["final_tilt"]), abs=1e-7
        )


def test_a_sweep_of_draws_is_stored_and_read_back_with_its_seed(tmp_path):
    pytest.importorskip("zarr")
    drawn = {SPIN: stats.norm(150.0, 5.0), MU: [0.2, 0.3], "launch.tilt": Triangular()}
    asked = {"draw": drawn, "seed": 7, "duration": 0.1, "workers": 1}
    stored = tt.sweep(REPORT, out=tmp_path / "s.zarr", **asked)
    in_memory = tt.sweep(REPORT, **asked)
    assert stored.attrs["seed"] == in_memory.attrs["seed"] == 7
    assert np.array_equal(stored["spin"], in_memory["spin"])
    sweep = Sweep(**json.loads(in_memory.attrs["sweep"]))
    assert np.array_equal(sweep.grid.values(np.arange(2))[SPIN], in_memory["spin"])


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"draw": {SPIN: stats.norm(1.0, 1.0)}}, "number of draws"),
        ({"draw": {SPIN: [1.0, 2.0], MU: [0.1]}}, "one a draw: 2"),
        ({"draw": {SPIN: "normal"}, "count": 2}, "anything with a method ppf"),
        ({"draw": {SPIN: {"distribution": "norm", "mean": 1.0}}, "count": 2}, "loc, scale"),
        ({"draw": {SPIN: {"distribution": "nothing"}}, "count": 2}, "name of a distribution"),
        ({"draw": {SPIN: {"distribution": "gamma"}}, "count": 2}, "shape parameter of gamma"),
        ({"draw": {"launch.spinn": [1.0]}}, "launch.spin"),
        ({}, "one of them"),
        ({"over": {SPIN: [1.0]}, "draw": {SPIN: [1.0]}}, "one of them"),
        ({"over": {SPIN: [1.0]}, "count": 3}, "only for draw"),
        ({"over": {SPIN: [1.0]}, "seed": 0}, "only for draw"),
    ],
    ids=[
        "no count",
        "lengths",
        "word",
        "parameter",
        "distribution",
        "shape",
        "field",
        "nothing",
        "both",
        "count of a grid",
        "seed of a grid",
    ],
)
def test_draws_that_cannot_be_are_refused_in_a_sentence(arguments, words):
    with pytest.raises(tt.InvalidInput, match=words):
        tt.sweep(REPORT, duration=0.1, workers=1, **arguments)
