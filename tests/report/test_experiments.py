"""The cheap experiments: independent ways to the same number agree, and misprints do not."""

import math

import numpy as np
import pytest
import xarray as xr

from tippetop.presets import report_problem
from tippetop.report.claim import Verdict
from tippetop.report.claims.registry import CLAIMS
from tippetop.report.experiments.methods import evaluations
from tippetop.report.experiments.registry import EXPERIMENTS
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
    )
    return {name: EXPERIMENTS[name].run(quick=True) for name in names}


def verdict(computed: dict[str, xr.Dataset], name: str) -> Verdict:
    return CLAIMS[name].judge(computed, quick=True).verdict


def test_torque_of_2_7_has_the_wrong_sign_and_counts_the_weight(computed: dict[str, xr.Dataset]) -> None:
    check = computed["printed-equations"]
    assert float(check["torque"]) == pytest.approx(float(check["torque_corrected"]), rel=1e-6)
    assert float(check["torque_listing"]) == pytest.approx(float(check["torque_corrected"]), rel=1e-9)
    assert float(check["torque_printed"]) == pytest.approx(-float(check["torque_turned"]), rel=1e-12)
    # The weight alone parts the second component of a x F from the torque: its arm is alpha R sin(theta).
    state = simulate(report_problem(), 5.0, samples=2).isel(time=-1)
    moment = 0.02 * 9.8 * 0.3 * 0.02 * math.sin(float(state["theta"]))
    assert abs(float(check["torque_turned"] - check["torque_corrected"])) == pytest.approx(moment, rel=1e-6)
    assert float(check["power"]) < 0 < float(check["power_printed"])
    assert verdict(computed, "eq-2.7") is Verdict.CORRECTED


def test_equation_2_9_is_right_in_the_listing_only(computed: dict[str, xr.Dataset]) -> None:
    check = computed["printed-equations"]
    assert float(check["precession_listing"]) == pytest.approx(float(check["precession"]), rel=1e-6)
    assert verdict(computed, "eq-2.9") is Verdict.CORRECTED


def test_steady_states_obey_2_16_and_2_17_for_every_body(computed: dict[str, xr.Dataset]) -> None:
    steady = computed["steady-bodies"]
    assert np.all((steady["theta"] > 0.05) & (steady["theta"] < math.pi - 0.05))
    assert len(np.unique(steady["theta"].round(3))) == steady.sizes["body"]
    for name in ("eq-2.16", "eq-2.17-any-body", "eq-2.17"):
        assert verdict(computed, name) is Verdict.REPRODUCED
    assert verdict(computed, "eq-2.16-third") is Verdict.CORRECTED
    still = computed | {"steady-bodies": steady.assign(phi_dot=0.0 * steady["phi_dot"])}
    assert verdict(still, "eq-2.16-third") is Verdict.REPRODUCED


@pytest.mark.parametrize(
    ("name", "experiment"), [("eq-2.1", "rotation"), ("eq-2.6", "rotation"), ("eq-2.8", "printed-equations")]
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
    misses = abs(check["theta_in_centimetres"] - check["theta"])
    assert float(misses.sel(power_of_length=-1)) < 1e-12
    assert float(misses.sel(power_of_length=1)) > 1e-3


def test_only_s_to_the_minus_2_keeps_it_when_seconds_become_tenths(computed: dict[str, xr.Dataset]) -> None:
    check = computed["units"]
    misses = abs(check["theta_in_tenths"] - check["theta"])
    assert float(misses.sel(power_of_time=-2)) < 1e-12
    assert float(misses.sel(power_of_time=2)) > 1e-3
    for name in ("table-1-mu-unit", "table-1-g-unit"):
        assert verdict(computed, name) is Verdict.CORRECTED


def test_block_slides_as_viscous_friction_has_it(computed: dict[str, xr.Dataset]) -> None:
    assert float(computed["block"]["distance"]) == pytest.approx(1.0 / (100.0 * 9.8), rel=1e-9)


def test_orders_are_those_of_the_textbooks(computed: dict[str, xr.Dataset]) -> None:
    order = computed["order"]
    assert float(order["order_rk4_in_all"]) == pytest.approx(4.0, abs=0.1)
    assert float(order["order_rk4_in_a_step"]) == pytest.approx(5.0, abs=0.1)
    assert float(order["order_ode45_in_all"]) == pytest.approx(5.0, abs=0.4)


def test_b1_as_printed_is_of_first_order_and_mended_of_fourth(computed: dict[str, xr.Dataset]) -> None:
    order = computed["order"]
    assert float(order["order_printed_in_all"]) == pytest.approx(1.0, abs=0.1)
    assert float(order["order_printed_in_a_step"]) == pytest.approx(2.0, abs=0.1)
    assert float(order["order_printed_mended_in_all"]) == pytest.approx(4.0, abs=0.1)
    assert verdict(computed, "appendix-b-order") is Verdict.CORRECTED


def test_only_the_inertias_of_the_listing_give_the_end_of_fig_5(computed: dict[str, xr.Dataset]) -> None:
    assert verdict(computed, "table-1-inertia") is Verdict.CORRECTED
    run, other = computed["run-50"], computed["run-50-table-1"]
    assert abs(float(run["end_omega3"] - other["end_omega3"])) > 1.0


def test_both_methods_are_in_a_comparison(computed: dict[str, xr.Dataset]) -> None:
    run = computed["run-50"]
    for name in ("theta", "omega3", "phi_dot", "slip_x", "normal_force", "energy"):
        assert run[name].attrs["units"] == run[f"{name}_listing"].attrs["units"]
        assert "report" in run[f"{name}_listing"].attrs["long_name"]
    assert run.attrs["quick"] == 1


def test_evaluations_count_those_for_jacobians() -> None:
    # 7 variables: every Jacobian by differences costs 7 evaluations more than the solver itself reports.
    problem = report_problem(10.0, mu=100.0)
    assert evaluations(problem, "radau", 0.05) > 0
    assert evaluations(problem, "ode45", 0.05) > 2 * evaluations(problem, "bdf", 0.05) > 0
