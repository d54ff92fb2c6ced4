"""Launches that leave the table: the onset, what is read off the flights, and what is said of
them.
"""

import math

import numpy as np
import pytest
import xarray as xr

from tippetop.problem.presets import report_problem
from tippetop.report.claim import Judgement, Verdict
from tippetop.report.claims.registry import CLAIMS
from tippetop.report.experiment import variable
from tippetop.report.experiments.flights import first_onset, followed, leaves_at
from tippetop.report.experiments.registry import EXPERIMENTS
from tippetop.report.experiments.runs import comparison
from tippetop.report.gallery import PLATES
from tippetop.run import simulate


@pytest.fixture(scope="module")
def computed() -> dict[str, xr.Dataset]:
    tilts = {"final_tilt_flight": variable([math.pi, 3.1], "rad", "tilt", "spin_flight")}
    return {
        "run-175": EXPERIMENTS["run-175"].run(quick=True),
        "flights": followed((160.0, 175.0, 200.0), 0.0),
        "flights-bouncing": followed((175.0,), 0.5),
        "final-tilt": xr.Dataset(
            {
                **tilts,
                "final_tilt": ("spin", [math.pi, 3.14, 0.4]),
                "lift_off_onset": 165.1,
                "lost": 169.0,
            },
            {"spin": [100.0, 165.0, 210.0], "spin_flight": [165.0, 210.0]},
            {"window_s": 20.0},
        ),
        "final-tilt-listing": xr.Dataset(
            {"final_tilt_listing": ("spin_listing", [0.5, 3.14, 0.4])},
            {"spin_listing": [60.0, 100.0, 175.0]},
        ),
        "listing-capped": xr.Dataset(
            {"final_tilt": ("spin", [3.14, 0.7]), "final_tilt_capped": ("spin", [3.14, 3.13])},
            {"spin": [165.0, 175.0]},
        ),
    }


@pytest.fixture(scope="module")
def onsets() -> dict[str, xr.Dataset]:
    return {"onset-mu": onset_data("mu", 132.0), "onset-tilt": onset_data("tilt", 120.0)}


def onset_data(name: str, least: float) -> xr.Dataset:
    """A scan of two values, the report's own tilt and one that never leaves the table."""
    return xr.Dataset(
        {
            "liftoff_time": ((name, "spin"), [[math.nan, 3.0, 2.0], [math.nan] * 3]),
            "onset": (("window", name), [[least, math.nan]]),
        },
        {"spin": [100.0, 200.0, 300.0], "window": [20.0], name: [0.1, 1.3]},
        {"tilt_rad": 0.1, "mu_s_per_m": 0.3},
    )


def judge(data: dict[str, xr.Dataset], name: str) -> Judgement:
    return CLAIMS[name].judge(data, quick=True)


def test_onset_is_where_the_first_scanned_spin_that_lifts_says() -> None:
    # Lift-off at 37 and more, except from 52 to 78: the scan sees 40, 50 and 80, and takes the
    # first.
    def times(spin: float) -> float:
        return 1.0 if spin >= 37.0 and not 52.0 < spin < 78.0 else math.nan

    spins = np.arange(10.0, 90.0, 10.0)
    scanned = np.array([times(spin) for spin in spins])
    assert first_onset(times, spins, scanned, 5.0, 0.01) == pytest.approx(37.0, abs=0.01)
    assert math.isnan(first_onset(times, spins[:3], scanned[:3], 5.0, 0.01))
    assert math.isnan(first_onset(times, spins[3:], scanned[3:], 5.0, 0.01))
    assert math.isnan(first_onset(times, spins, scanned, 0.5, 0.01))


def test_lift_off_at_175_does_not_depend_on_the_window() -> None:
    problem = report_problem(175.0)
    assert leaves_at(problem, 20.0) == pytest.approx(5.361332, abs=2e-6)
    assert leaves_at(problem, 6.0) == pytest.approx(leaves_at(problem, 20.0), abs=1e-9)
    assert math.isnan(leaves_at(problem, 5.0))


def test_readings_are_those_of_the_flights(computed: dict[str, xr.Dataset]) -> None:
    run = simulate(report_problem(175.0), 20.0, samples=2001)
    both = computed["flights"].sel(restitution=0.0, spin=175.0)
    assert int(both["flights"]) == run.sizes["flight"]
    assert float(both["airborne_time"]) == pytest.approx(
        float((run["flight_end"] - run["flight_start"]).sum())
    )
    assert float(both["last_touchdown"]) == pytest.approx(float(run["flight_end"][-1]))
    lost = run["event_energy_lost"].values
    assert float(both["energy_in_impacts"]) == pytest.approx(lost.sum())
    theta = np.interp(float(both["turning_time"]), run["time"], run["tilt"])
    assert theta == pytest.approx(math.pi / 2, abs=0.02)


def test_a_launch_below_the_onset_has_no_flights(computed: dict[str, xr.Dataset]) -> None:
    slow = computed["flights"].sel(restitution=0.0, spin=160.0)
    assert int(slow["flights"]) == 0
    assert (
        float(slow["airborne_time"])
        == float(slow["last_touchdown"])
        == float(slow["max_gap"])
        == 0.0
    )
    assert math.isnan(float(slow["liftoff_time"]))


def test_comparison_goes_on_in_flight_only_where_there_is_one(
    computed: dict[str, xr.Dataset],
) -> None:
    run = computed["run-175"]
    before = run.sel(time=slice(None, float(run["lift_off_time"])))
    for name in ("tilt", "normal_force", "energy"):
        assert before[f"{name}_flight"].values == pytest.approx(before[name].values, rel=1e-6)
        assert run[f"{name}_flight"].attrs["units"] == run[name].attrs["units"]
    assert float(run["normal_force_flight"].min()) == 0.0
    assert float(run["normal_force"].min()) < 0.0
    assert {"turning_time", "energy_in_impacts", "final_tilt_flight"} <= set(run.data_vars)
    assert "tilt_flight" not in comparison(report_problem(20.0), quick=True)


def test_the_abnormal_point_is_not_one_of_the_top(computed: dict[str, xr.Dataset]) -> None:
    verdicts = {
        "fig09-two-motions": Verdict.REPRODUCED,
        "fig10-fall": Verdict.REPRODUCED,
        "fig10-by-falling": Verdict.CORRECTED,
        "fig10-gain": Verdict.EXPLAINED,
        "fig10-impossible": Verdict.REPRODUCED,
        "fig12-stop-time": Verdict.CORRECTED,
        "sec2-large-spin": Verdict.REPRODUCED,
        "sec4-may-fly": Verdict.REPRODUCED,
        "sec4-energy-falls": Verdict.UPHELD,
        "sum-abnormal": Verdict.REPRODUCED,
        "sum-turns-over": Verdict.REPRODUCED,
    }
    for name, verdict in verdicts.items():
        judged = judge(computed, name)
        assert judged.verdict is verdict, name
        assert "nan" not in judged.finding.note
    assert "28 flights" in judge(computed, "sec4-may-fly").finding.note


@pytest.mark.parametrize("sweep", ["flights", "flights-bouncing", "final-tilt"])
def test_one_launch_that_does_not_turn_over_would_be_seen(
    computed: dict[str, xr.Dataset], sweep: str
) -> None:
    spoilt = dict(computed)
    spoilt[sweep] = computed[sweep].copy(deep=True)
    spoilt[sweep]["final_tilt_flight"][..., -1] = 0.8
    judged = judge(spoilt, "sum-abnormal")
    assert judged.verdict is Verdict.EXPLAINED
    assert "still" in judged.finding.note


def test_what_the_listing_leaves_out_is_told_as_news_if_it_cures(
    computed: dict[str, xr.Dataset],
) -> None:
    assert "commented out" in judge(computed, "sum-abnormal").finding.news
    lines = computed["listing-capped"]
    useless = computed | {"listing-capped": lines.assign(final_tilt_capped=lines["final_tilt"])}
    assert judge(useless, "sum-abnormal").finding.news == ""


def test_a_rise_of_the_energy_would_be_seen(computed: dict[str, xr.Dataset]) -> None:
    spoilt = computed | {"flights": computed["flights"].copy(deep=True)}
    spoilt["flights"]["energy_rise"][..., 1] = 1e-9
    assert judge(spoilt, "sec4-energy-falls").verdict is Verdict.CORRECTED
    run = computed["run-175"]
    rising = run.assign(energy=run["energy"] + 0.1 * run["time"])
    assert judge(computed | {"run-175": rising}, "fig10-impossible").verdict is Verdict.CORRECTED


def test_a_top_that_falls_keeps_its_energy(computed: dict[str, xr.Dataset]) -> None:
    run = computed["run-175"]
    assert judge(computed, "fig10-gain").finding.converged == 0.0, (
        "a table that only pushes adds nothing"
    )
    assert "changes the energy by nothing" in judge(computed, "fig10-by-falling").finding.right
    weightless = run.assign(energy_flight=run["energy_flight"] + 1e-6 * run["time"])
    judged = judge(computed | {"run-175": weightless}, "fig10-by-falling")
    assert judged.verdict is Verdict.REPRODUCED


def test_a_stop_before_lift_off_would_be_accepted(computed: dict[str, xr.Dataset]) -> None:
    later = computed["run-175"].assign(lift_off_time=5.9, zero_of_force_listing=5.8)
    assert judge(computed | {"run-175": later}, "fig12-stop-time").verdict is Verdict.REPRODUCED


def test_the_report_stops_between_the_first_pull_of_its_method_and_what_a_plot_shows(
    computed: dict[str, xr.Dataset],
) -> None:
    run = computed["run-175"]
    assert float(run["zero_of_force_listing"]) < 5.62 < float(run["visible_pull_listing"])


def test_a_top_that_hardly_rises_does_not_fly(computed: dict[str, xr.Dataset]) -> None:
    low = computed["run-175"].assign(max_gap=1e-6)
    assert judge(computed | {"run-175": low}, "sec4-may-fly").verdict is Verdict.CORRECTED


def test_huge_spins_are_judged_at_the_reports_own_launch(
    computed: dict[str, xr.Dataset], onsets: dict[str, xr.Dataset]
) -> None:
    judged = judge(computed | onsets, "sec4-huge-spin")
    assert judged.verdict is Verdict.REPRODUCED
    for words in ("165.10 rad/s", "120 rad/s", "132 rad/s", "From a tilt of 1.30 rad on"):
        assert words in judged.finding.note
    scan = onsets["onset-tilt"].copy(deep=True)
    scan["liftoff_time"][0, 1] = math.nan
    assert (
        judge(computed | onsets | {"onset-tilt": scan}, "sec4-huge-spin").verdict
        is Verdict.EXPLAINED
    )


@pytest.mark.parametrize(
    "name", ["fig09", "fig10", "fig11", "fig12", "onset-mu", "onset-tilt", "flights"]
)
def test_figures_can_be_drawn(
    computed: dict[str, xr.Dataset], onsets: dict[str, xr.Dataset], name: str
) -> None:
    plate = PLATES[name]
    axes = plate.draw(plate.dataset(computed | onsets)).axes
    colors = {line.get_color() for panel in axes for line in panel.get_lines()}
    assert ("#109B60" in colors) != name.startswith("onset")
