"""The section "Why": what the theory says agrees with runs, and the claims are judged by it."""

import math
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from judging import assert_drawn, assert_judged
from tippetop.problem.presets import REPORT
from tippetop.report.claim import Verdict
from tippetop.report.claims.registry import CLAIMS
from tippetop.report.experiment import variable
from tippetop.report.experiments.registry import EXPERIMENTS
from tippetop.report.gallery import PLATES, Plate
from tippetop.report.page import render

NAMES = ("critical", "bifurcation", "groups", "collapse", "exponent", "diagnostics")


@pytest.fixture(scope="module")
def computed() -> dict[str, xr.Dataset]:
    data = {f"why-{name}": EXPERIMENTS[f"why-{name}"].run(quick=True) for name in NAMES}
    data["critical-spins"] = _thresholds_of_runs()
    data["final-tilt-listing"] = xr.Dataset(
        {"final_tilt_listing": ("spin_listing", [0.0, 0.5, 2.5, math.pi, 0.7])},
        {"spin_listing": [20.0, 40.0, 70.0, 100.0, 175.0]},
    )
    data["flip-times-wide"] = xr.Dataset(
        {"small_exponent": ("spin_wide", [-0.999])}, {"spin_wide": [100.0]}
    )
    return data


def _thresholds_of_runs() -> xr.Dataset:
    """What the sweeps for Fig. 6 find, in short: they take too long to be run here."""
    return xr.Dataset(
        {
            "upright_by_window": variable([27.04, 27.76], "rad s-1", "first", "window"),
            "inverted_by_window": variable([78.46, 77.27], "rad s-1", "second", "window"),
            "upright_by_margin": variable([24.49, 27.04, 29.89], "rad s-1", "first", "margin"),
            "inverted_by_margin": variable([79.45, 78.46, 77.33], "rad s-1", "second", "margin"),
        },
        {"window": [20.0, 200.0], "margin": [0.001, 0.01, 0.1]},
    )


def test_critical_spins_are_the_closed_forms(computed: dict[str, xr.Dataset]) -> None:
    alpha, gamma = 0.3, REPORT.I1 / REPORT.I3
    unit = math.sqrt(REPORT.mass * 9.8 * 0.02 * alpha / REPORT.I3)
    first = unit * (1 - alpha) / math.sqrt(alpha + gamma - 1)
    second = unit * (1 + alpha) / math.sqrt(1 + alpha - gamma)
    theory = computed["why-critical"]
    assert theory["critical_formula"].values == pytest.approx([first, second], rel=1e-12)
    assert theory["critical_spectrum"].values == pytest.approx([first, second], rel=1e-9)
    tilted = math.cos(0.1) - alpha
    launches = [first * (1 - alpha) / tilted, second * (1 + alpha) / tilted]
    assert theory["critical_launch"].values == pytest.approx(launches, rel=1e-12)


def test_growth_rates_change_sign_at_the_critical_spins(computed: dict[str, xr.Dataset]) -> None:
    theory = computed["why-critical"]
    spins, rates = theory["growth_spin"].values, theory["growth_rate"].values
    upright, inverted = theory["critical_launch"].values
    assert np.array_equal(rates[0] > 0, spins > upright)
    assert np.array_equal(rates[1] < 0, spins > inverted)


def test_growth_rates_alone_give_what_runs_of_20_s_show(computed: dict[str, xr.Dataset]) -> None:
    theory, runs = computed["why-critical"], computed["critical-spins"]
    for least in (0.001, 0.01):
        seen = theory.sel(visible=least)
        read = runs.sel(margin=least)
        assert float(seen["apparent_upright"]) == pytest.approx(
            float(read["upright_by_margin"]), abs=0.03
        )
        assert float(seen["apparent_inverted"]) <= float(read["inverted_by_margin"])
    assert float(seen["apparent_inverted"]) == pytest.approx(
        float(read["inverted_by_margin"]), abs=0.2
    )


def test_two_launches_of_one_spin_end_apart_beyond_a_fold(computed: dict[str, xr.Dataset]) -> None:
    states = computed["why-bifurcation"]
    both = states["run_stable_jump"].values == 2
    low, high = states["run_end_jump"].values[both].reshape(-1, 2).T
    assert np.all(low < 0.01)
    assert np.all(high > 0.5)
    alone = ~both
    assert states["run_end_jump"].values[alone] == pytest.approx(
        states["run_predicted_jump"].values[alone], abs=1e-6
    )


def test_precessions_are_unstable_below_the_fold_only(computed: dict[str, xr.Dataset]) -> None:
    states = computed["why-bifurcation"]
    assert float(states["branch_growth"].isel(branch_tilt=slice(1, -1)).max()) < 0
    inside = states.isel(branch_tilt_jump=slice(1, -1))
    rising = np.gradient(inside["branch_spin_jump"].values) > 0
    stable = inside["branch_growth_jump"].values < 0
    assert np.array_equal(stable[2:-2], rising[2:-2])


def test_runs_fall_onto_the_averaged_flow(computed: dict[str, xr.Dataset]) -> None:
    flow = computed["why-collapse"]
    middle = 0.5 * (flow["flow_low"] + flow["flow_high"])
    away = abs(0.5 * (flow["run_low"] + flow["run_high"]) - middle).max("mu_time").values
    assert away[-1] < 0.03
    assert away[0] > 5 * away[-1]
    assert float(flow["flip_limit"]) == pytest.approx(2.3437, abs=1e-4)


def test_times_are_in_order_and_tend_to_their_limits(computed: dict[str, xr.Dataset]) -> None:
    times = computed["why-exponent"]
    assert np.all(times["crossing_time"] < times["arrival_time_end"])
    assert np.all(times["arrival_time_end"] <= times["settling_time"])
    least = times.isel(mu_flip=0)
    for name, limit in (("crossing_time", "limit_crossing"), ("arrival_time_end", "limit_arrival")):
        assert float(least["mu_flip"] * least[name]) == pytest.approx(float(times[limit]), rel=1e-3)
    assert float(times["settling_time"].max() / times["crossing_time"].min()) > 10


def test_nutation_stays_between_its_turning_points(computed: dict[str, xr.Dataset]) -> None:
    run = computed["why-diagnostics"]
    slack = 0.02
    assert np.all(run["tilt_diagnosed"] > run["envelope_low"] - slack)
    assert np.all(run["tilt_diagnosed"] < run["envelope_high"] + slack)
    for k in range(run.sizes["instant"] - 1):
        well = np.interp(float(run["instant_tilt"][k]), run["well_tilt"], run["potential"][k])
        assert well <= float(run["level"][k]) * (1 + 1e-3)
    assert np.all(np.diff(run["level"]) < 0)
    assert float(run["balance_ratio"][0]) == pytest.approx(-1.0, abs=1e-9)
    assert float(abs(run["balance_ratio"].sel(time_diagnosed=slice(6.2, 6.8))).max()) < 0.1


@pytest.mark.parametrize(
    ("name", "verdict"),
    [
        ("why-final-tilt", Verdict.REPRODUCED),
        ("why-regimes", Verdict.REPRODUCED),
        ("why-flip-law", Verdict.REPRODUCED),
        ("section-5-small-mu", Verdict.REPRODUCED),
        ("why-only-simulation", Verdict.CORRECTED),
        ("eq-2.17-range", Verdict.REPRODUCED),
    ],
)
def test_verdicts(computed: dict[str, xr.Dataset], name: str, verdict: Verdict) -> None:
    assert_judged(computed, name, verdict)


def test_claims_follow_the_data(computed: dict[str, xr.Dataset]) -> None:
    states = computed["why-bifurcation"].copy()
    states["run_end"] = states["run_end"] + 0.02
    spoilt = computed | {"why-bifurcation": states}
    assert CLAIMS["why-final-tilt"].judge(spoilt, quick=True).verdict is Verdict.CORRECTED
    off = computed["why-bifurcation"].assign(
        run_left=computed["why-bifurcation"]["run_left"] + 1e-4
    )
    assert (
        CLAIMS["eq-2.17-range"].judge({"why-bifurcation": off}, quick=True).verdict
        is Verdict.CORRECTED
    )
    assert CLAIMS["why-regimes"].judge(spoilt, quick=True).verdict is Verdict.EXPLAINED
    other = computed["final-tilt-listing"].copy(deep=True)
    other["final_tilt_listing"][0] = 0.5
    spoilt["final-tilt-listing"] = other
    assert CLAIMS["why-regimes"].judge(spoilt, quick=True).verdict is Verdict.CORRECTED


WHY = [plate for plate in PLATES.values() if plate.section == "Why"]


@pytest.mark.parametrize("plate", WHY, ids=lambda plate: plate.id)
def test_every_figure_is_drawn_from_quick_data(
    computed: dict[str, xr.Dataset], plate: Plate
) -> None:
    assert_drawn(computed, plate)


def test_the_page_has_a_section_of_its_own(tmp_path: Path) -> None:
    plates = [PLATES["fig01"], PLATES["why-groups"], PLATES["order"]]
    for plate in plates:
        (tmp_path / f"{plate.id}.svg").write_bytes(b"<svg/>")
    page = render(plates, [], tmp_path, quick=False)
    marks = ("section-1", "fig01", "section-appendix-b", "order", "section-why", "why-groups")
    places = [page.index(f'id="{mark}"') for mark in marks]
    assert places == sorted(places)
    assert "Which tops turn over</a>" in page[: page.index('id="section-1"')], (
        "what the report could not know"
    )
    assert "section-2.1" not in page
    assert "section-friction" not in page
