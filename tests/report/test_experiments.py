"""The cheap experiments: independent ways to the same number agree, and misprints do not."""

import math

import numpy as np
import pytest
import xarray as xr

from tippetop.problem.presets import report_problem
from tippetop.report.claim import Verdict
from tippetop.report.claims.registry import CLAIMS
from tippetop.report.experiments.methods import effort
from tippetop.report.experiments.registry import EXPERIMENTS
from tippetop.report.printed_numbers import END_OF_FIG_5
from tippetop.run import simulate


@pytest.fixture(scope="module")
def computed() -> dict[str, xr.Dataset]:
    names = (
        "printed-equations",
        "rotation",
        "steady-bodies",
        "units",
        "block",
        "order",
        "run-50",
        "run-50-table-1",
        "run-50-windows",
        "slow-spins",
        "run-mu-100",
    )
    return {name: EXPERIMENTS[name].run(quick=True) for name in names}


def verdict(computed: dict[str, xr.Dataset], name: str) -> Verdict:
    return CLAIMS[name].judge(computed, quick=True).verdict


def test_torque_of_2_7_has_the_wrong_sign_and_counts_the_weight(
    computed: dict[str, xr.Dataset],
) -> None:
    check = computed["printed-equations"]
    assert float(check["torque"]) == pytest.approx(float(check["torque_corrected"]), rel=1e-6)
    assert float(check["torque_listing"]) == pytest.approx(
        float(check["torque_corrected"]), rel=1e-9
    )
    assert float(check["torque_printed"]) == pytest.approx(
        -float(check["torque_turned"]), rel=1e-12
    )
    # The weight alone parts the second component of a x F from the torque: its arm is alpha R
    # sin(theta).
    state = simulate(report_problem(), 5.0, samples=2).isel(time=-1)
    moment = 0.02 * 9.8 * 0.3 * 0.02 * math.sin(float(state["tilt"]))
    assert abs(float(check["torque_turned"] - check["torque_corrected"])) == pytest.approx(
        moment, rel=1e-6
    )
    assert float(check["power"]) < 0 < float(check["power_printed"])
    assert verdict(computed, "eq-2.7") is Verdict.CORRECTED


def test_equation_2_9_is_right_in_the_listing_only(computed: dict[str, xr.Dataset]) -> None:
    check = computed["printed-equations"]
    assert float(check["precession_listing"]) == pytest.approx(float(check["precession"]), rel=1e-6)
    assert verdict(computed, "eq-2.9") is Verdict.CORRECTED


def test_steady_states_obey_2_16_and_2_17_for_every_body(computed: dict[str, xr.Dataset]) -> None:
    steady = computed["steady-bodies"]
    assert np.all((steady["tilt"] > 0.05) & (steady["tilt"] < math.pi - 0.05))
    assert len(np.unique(steady["tilt"].round(3))) == steady.sizes["body"]
    everything = computed | {"run-155": computed["run-50"]}
    for name in ("eq-2.16", "eq-2.17-any-body", "eq-2.17", "sec2-no-slip"):
        assert verdict(everything, name) is Verdict.REPRODUCED
    for left, name in (
        ("azimuth_ddot", "eq-2.16"),
        ("residual_216", "eq-2.16"),
        ("slip_rate", "sec2-no-slip"),
    ):
        spoilt = everything | {"steady-bodies": steady.assign({left: steady[left] + 1e-4})}
        assert verdict(spoilt, name) is Verdict.CORRECTED
    assert verdict(computed, "eq-2.16-third") is Verdict.CORRECTED
    still = computed | {"steady-bodies": steady.assign(precession=0.0 * steady["precession"])}
    assert verdict(still, "eq-2.16-third") is Verdict.REPRODUCED


@pytest.mark.parametrize(
    ("name", "experiment"),
    [("eq-2.1", "rotation"), ("eq-2.6", "rotation"), ("eq-2.8", "printed-equations")],
)
def test_equations_that_hold_are_told_from_those_that_do_not(
    computed: dict[str, xr.Dataset], name: str, experiment: str
) -> None:
    assert verdict(computed, name) is Verdict.REPRODUCED
    wrong = computed[experiment].assign(miss=computed[experiment]["miss"] + 1e-3)
    assert verdict(computed | {experiment: wrong}, name) is Verdict.CORRECTED


def test_only_s_per_m_keeps_the_motion_when_metres_become_centimetres(
    computed: dict[str, xr.Dataset],
) -> None:
    check = computed["units"]
    misses = abs(check["tilt_in_centimetres"] - check["tilt"])
    assert float(misses.sel(power_of_length=-1)) < 1e-12
    assert float(misses.sel(power_of_length=1)) > 1e-3


def test_only_s_to_the_minus_2_keeps_it_when_seconds_become_tenths(
    computed: dict[str, xr.Dataset],
) -> None:
    check = computed["units"]
    misses = abs(check["tilt_in_tenths"] - check["tilt"])
    assert float(misses.sel(power_of_time=-2)) < 1e-12
    assert float(misses.sel(power_of_time=2)) > 1e-3
    for name in ("table-1-mu-unit", "table-1-g-unit"):
        assert verdict(computed, name) is Verdict.CORRECTED
    assert verdict(computed, "eq-2.7-mu-unit") is Verdict.REPRODUCED, "section 2.2 has it right"


def test_block_slides_as_viscous_friction_has_it(computed: dict[str, xr.Dataset]) -> None:
    assert float(computed["block"]["distance"]) == pytest.approx(1.0 / (100.0 * 9.8), rel=1e-9)


def test_orders_are_those_of_the_textbooks(computed: dict[str, xr.Dataset]) -> None:
    order = computed["order"]
    assert float(order["order_rk4_in_all"]) == pytest.approx(4.0, abs=0.1)
    assert float(order["order_rk4_in_a_step"]) == pytest.approx(5.0, abs=0.1)
    assert float(order["order_ode45_in_all"]) == pytest.approx(5.0, abs=0.4)


def test_b1_as_printed_is_of_first_order_and_mended_of_fourth(
    computed: dict[str, xr.Dataset],
) -> None:
    order = computed["order"]
    assert float(order["order_printed_in_all"]) == pytest.approx(1.0, abs=0.1)
    assert float(order["order_printed_in_a_step"]) == pytest.approx(2.0, abs=0.1)
    assert float(order["order_printed_mended_in_all"]) == pytest.approx(4.0, abs=0.1)
    assert verdict(computed, "eq-b.1") is Verdict.CORRECTED
    assert verdict(computed, "appendix-b-order") is Verdict.REPRODUCED
    right = order.assign(order_printed_in_a_step=order["order_printed_mended_in_a_step"])
    assert verdict(computed | {"order": right}, "eq-b.1") is Verdict.REPRODUCED


def test_ode45_is_a_pair_of_orders_4_and_5(computed: dict[str, xr.Dataset]) -> None:
    order = computed["order"]
    assert float(order["order_companion_in_all"]) == pytest.approx(4.0, abs=0.3)
    assert verdict(computed, "section-3-method") is Verdict.REPRODUCED
    alone = order.assign(order_companion_in_all=order["order_ode45_in_all"])
    assert verdict(computed | {"order": alone}, "section-3-method") is Verdict.CORRECTED


def test_only_the_inertias_of_the_listing_give_the_end_of_fig_5(
    computed: dict[str, xr.Dataset],
) -> None:
    assert verdict(computed, "table-1-inertia") is Verdict.CORRECTED
    run, other = computed["run-50"], computed["run-50-table-1"]
    assert abs(float(run["end_spin"] - other["end_spin"])) > 1.0


def test_both_methods_are_in_a_comparison(computed: dict[str, xr.Dataset]) -> None:
    run = computed["run-50"]
    for name in ("tilt", "spin", "precession", "slip_x", "normal_force", "energy"):
        assert run[name].attrs["units"] == run[f"{name}_listing"].attrs["units"]
        assert "report" in run[f"{name}_listing"].attrs["long_name"]
    assert run.attrs["quick"] == 1


def test_evaluations_count_those_for_jacobians() -> None:
    # 7 variables: every Jacobian by differences costs 7 evaluations more than the solver itself
    # reports.
    problem = report_problem(10.0, mu=100.0)
    made = {method: effort(problem, method, 0.05) for method in ("radau", "bdf", "ode45")}
    assert made["radau"].evaluations > 0
    assert made["ode45"].evaluations > 2 * made["bdf"].evaluations > 0
    true = float(simulate(problem, 0.05, samples=2)["final_tilt"])
    assert made["bdf"].tilt == pytest.approx(true, abs=1e-3)


def test_the_end_of_fig_5_is_one_of_a_run_cut_short(computed: dict[str, xr.Dataset]) -> None:
    judged = CLAIMS["fig05-end"].judge(computed, quick=True)
    assert judged.verdict is Verdict.EXPLAINED
    assert "cut short at 12 s" in judged.finding.right
    run, windows = computed["run-50"], computed["run-50-windows"]
    ended = run.assign({f"end_{key}": value for key, value in END_OF_FIG_5.items()})
    assert verdict(computed | {"run-50": ended}, "fig05-end") is Verdict.REPRODUCED
    never = windows.isel(window=slice(1, None))
    assert verdict(computed | {"run-50-windows": never}, "fig05-end") is Verdict.CORRECTED


def test_what_the_report_calls_nutation_is_the_growth_of_the_tilt(
    computed: dict[str, xr.Dataset],
) -> None:
    assert verdict(computed, "sec3-no-nutation") is Verdict.REPRODUCED
    slow = computed["slow-spins"]
    assert (slow["swings"] > 1).all(), "in the usual sense it nutates"
    for name in ("highest", "final"):
        grown = slow.assign({name: slow[name] + 0.05 * (slow["spin"] > 20.0)})
        assert verdict(computed | {"slow-spins": grown}, "sec3-no-nutation") is Verdict.EXPLAINED


def test_the_axis_goes_round_the_pole_before_it_passes_beside_it(
    computed: dict[str, xr.Dataset],
) -> None:
    for name in ("fig08-around-pi", "fig08-rapid"):
        assert verdict(computed, name) is Verdict.REPRODUCED
    run = computed["run-mu-100"]
    backwards = run.assign(
        precession=-run["precession"], precession_listing=-run["precession_listing"]
    )
    assert verdict(computed | {"run-mu-100": backwards}, "fig08-around-pi") is Verdict.CORRECTED
    assert "11 a second" in CLAIMS["fig08-rapid"].judge(computed, quick=True).finding.note


def stiffness(ratios: list[float], miss: float) -> xr.Dataset:
    """Two launches at the report's friction and two on that of its Fig. 8."""
    return xr.Dataset(
        {
            "stiffness": ("launch", ratios),
            "bdf_miss": ("launch", [1.0, 1.0, 0.0, miss]),
            "launch_spin": ("launch", [10.0, 155.0, 10.0, 155.0]),
            "launch_tilt": ("launch", [0.1, 1e-6, 0.1, 0.1]),
            "launch_mu": ("launch", [0.3, 0.3, 100.0, 100.0]),
        },
        attrs={"span_s": 3.0},
    )


@pytest.mark.parametrize(
    ("ratios", "miss", "verdicts"),
    [
        ([0.8, 1.1, 7.0, 1.6], 0.004, "RRR"),
        ([0.8, 3.0, 1.0, 1.0], 0.004, "RRR"),
        ([0.8, 1.1, 7.0, 7.0], 0.004, "RCR"),
        ([0.8, 1.1, 1.5, 1.5], 0.004, "CCR"),
        ([0.8, 1.1, 7.0, 1.6], 0.04, "RRC"),
    ],
)
def test_stiffness_its_cause_and_its_cure_are_judged_apart(
    ratios: list[float], miss: float, verdicts: str
) -> None:
    data = {"stiffness": stiffness(ratios, miss)}
    found = [verdict(data, f"section-5-{name}").name[0] for name in ("stiff", "cause", "ode15s")]
    assert "".join(found) == verdicts


def times_over_mu(power: float, other: float) -> dict[str, xr.Dataset]:
    """Flip times that go as powers of mu at the main spin and at another one; the time to the
    horizontal goes as 1/mu at both.
    """
    mu = np.linspace(0.2, 1.0, 9)

    def of(exponent: float) -> dict[str, object]:
        flip, turning = ("mu", mu**exponent), ("mu", 1.0 / mu)
        rows = {"flip_time": flip, "turning_time": turning}
        return {f"{name}{suffix}": row for name, row in rows.items() for suffix in ("", "_listing")}

    main = xr.Dataset(
        {**of(power), "exponent": power, "exponent_listing": power},
        {"mu": mu},
        {"spin_rad_per_s": 155.0},
    )
    others = xr.Dataset(of(other), {"mu": mu}).expand_dims(spin=[130.0])
    return {"flip-times": main, "flip-times-spins": others}


@pytest.mark.parametrize(
    ("main", "other", "exponent", "inverse"),
    [
        (-0.7, -0.9852, Verdict.EXPLAINED, Verdict.EXPLAINED),
        (-0.7, -0.987, Verdict.CORRECTED, Verdict.EXPLAINED),
        (-0.985, -0.5, Verdict.REPRODUCED, Verdict.REPRODUCED),
        (-0.95, -0.5, Verdict.CORRECTED, Verdict.REPRODUCED),
        (-0.7, -0.8, Verdict.CORRECTED, Verdict.CORRECTED),
    ],
)
def test_a_power_and_a_proportion_are_judged_by_the_same_times(
    main: float, other: float, exponent: Verdict, inverse: Verdict
) -> None:
    data = times_over_mu(main, other)
    assert verdict(data, "fig07-exponent") is exponent
    assert verdict(data, "fig07-inverse") is inverse


@pytest.mark.parametrize(
    ("start", "expected"), [(3.26, Verdict.REPRODUCED), (3.19, Verdict.CORRECTED)]
)
def test_a_time_printed_without_around_is_true_to_its_digit(
    start: float, expected: Verdict
) -> None:
    times = {"quiet_start": start, "quiet_start_listing": start}
    run = xr.Dataset({**times, "reversals": 40.0, "last_reversal": 19.0})
    assert verdict({"run-155": run}, "fig04-first-reversal") is expected


def test_one_threshold_serves_for_both_times_of_turning_over() -> None:
    def run(name: str, times: list[float]) -> xr.Dataset:
        both = {f"arrivals{suffix}": ("within", times) for suffix in ("", "_listing")}
        return xr.Dataset(
            {**both, "arrival_time": times[0]}, {"within": [0.01, 0.05]}, {"experiment": name}
        )

    data = {"run-155": run("run-155", [7.6, 7.2]), "run-50": run("run-50", [9.8, 9.0])}
    for name in ("fig04-flip-time", "fig05-flip-time"):
        assert verdict(data, name) is Verdict.REPRODUCED
    data["run-50"] = run("run-50", [9.8, 9.3])
    assert verdict(data, "fig04-flip-time") is Verdict.REPRODUCED
    assert verdict(data, "fig05-flip-time") is Verdict.CORRECTED
