"""Lanes give what single runs do: sums along a run and events, on a slope and in air."""

from itertools import product
from pathlib import Path

import numpy as np
import pytest

import tippetop as tt
from tippetop.problem.presets import report_problem
from tippetop.results.catalogue import LISTED, METRICS, SAMPLED
from tippetop.sweeps import ensemble
from tippetop.sweeps.single_launches import SINGLE

ROOT = Path(__file__).resolve().parents[2]

LAWS = {
    "viscous": tt.ViscousFriction(mu=0.3),
    "regularized": tt.RegularizedCoulombFriction(mu=0.3, eps=0.01),
    "drilling": tt.ContensouFriction(mu=0.3, patch_radius=5e-4, pressure="ellipsoidal"),
    "hertz": tt.ContensouFriction(mu=0.3, patch_radius=5e-4, pressure="hertz"),
    "dry": tt.CoulombFriction(mu=0.3),
}
SLOPE = {"table": tt.Table(slope=0.1, azimuth=0.7)}
AIR = {
    "air": tt.Air(
        axial_linear=1e-7,
        axial_quadratic=1e-9,
        transverse_linear=2e-7,
        drag_linear=1e-3,
        drag_quadratic=1e-3,
    )
}
FIELDS = {"level": {}, "slope": SLOPE, "air": AIR, "both": SLOPE | AIR}
DAILY = (("drilling", "both"), ("dry", "slope"))


@pytest.fixture(autouse=True)
def no_single_launches(monkeypatch):
    """Let launches fail that a sweep follows one by one from the start."""
    monkeypatch.setattr(ensemble, "follow_each", None)


@pytest.mark.parametrize(
    ("law", "field"),
    [
        pytest.param(*case, marks=() if case in DAILY else pytest.mark.slow)
        for case in product(LAWS, FIELDS)
    ],
)
def test_metrics_variables_and_events_are_those_of_single_runs(law, field):
    """Of launches that slide, fly and strike."""
    problem = report_problem().replace({"friction": LAWS[law], **FIELDS[field]})
    spins, tilts = [60.0, 150.0, 230.0], [0.1, 1.0]
    launches = {"launch.spin": spins, "launch.tilt": tilts}
    options = {"keep": [*SAMPLED, "events"], "most_events": 60, "tolerance": 1e-12, "workers": 1}
    found = tt.sweep(problem, launches, duration=0.5, samples=7, **options)
    assert (found["event_count"] <= 60).all()
    for (i, spin), (j, tilt) in product(enumerate(spins), enumerate(tilts)):
        launched = problem.replace({"launch.spin": spin, "launch.tilt": tilt})
        run, count = tt.simulate(launched, 0.5, samples=7), int(found["event_count"][i, j])
        kinds = [kind.replace(" ", "_") for kind in run["event_kind"].values]
        assert found["event_kind"].values[i, j, :count].tolist() == kinds
        of_events = {name for name in LISTED if name.startswith("event_")} - {"event_kind"}
        for name in {*METRICS, *SAMPLED, *of_events} - {"steps"}:
            got, expected = found[name].values[i, j], run[name].values
            close = 1e-7 * max(1e-7, float(np.abs(np.nan_to_num(expected)).max(initial=0.0)))
            got = got[:count] if name in of_events else got
            np.testing.assert_allclose(got, expected, rtol=0.0, atol=close, err_msg=name)


@pytest.mark.parametrize(
    "law", [pytest.param(law, marks=pytest.mark.slow if law != "viscous" else ()) for law in LAWS]
)
def test_errors_of_sums_are_below_1e_10_times_the_condition_of_the_launch(law):
    step, duration = 1e-7, 1.0
    problem = report_problem(tilt=0.3, spin=150.0).replace({"friction": LAWS[law]})
    kept = ["x", "y", "orientation", "work"]
    options = {"duration": duration, "samples": 50}
    found = tt.sweep(problem, {"launch.spin": [150.0]}, keep=kept, workers=1, **options)
    exact = tt.simulate(problem, **options)[kept]
    condition = dict.fromkeys(kept, 0.0)
    for field in ("launch.spin", "launch.tilt", "friction.mu"):
        shifted = problem.replace({field: problem.get(field) * (1.0 + step)})
        moved = np.abs(tt.simulate(shifted, **options)[kept] - exact).max()
        condition = {name: condition[name] + float(moved[name]) / step for name in kept}
    error = np.abs(found[kept].isel(spin=0) - exact).max()
    for name in kept:
        assert float(error[name]) <= 1e-10 * condition[name], name


def test_the_documentation_says_what_is_followed_by_itself_from_the_start():
    page = " ".join((ROOT / "docs" / "howto" / "sweep.md").read_text("utf-8").split())
    assert [reason for reason in SINGLE if reason not in page] == []
