"""The section "Friction": its numbers against others and limits, and verdicts that follow the
data.
"""

import math

import numpy as np
import pytest
import xarray as xr

from judging import assert_drawn, assert_judged, assert_judged_otherwise
from tippetop.mechanics.motion import angular_velocity
from tippetop.mechanics.top import natural_units
from tippetop.problem.frictions import ContensouFriction
from tippetop.problem.problem import top_of
from tippetop.report.claim import Verdict
from tippetop.report.claims.registry import CLAIMS
from tippetop.report.experiments.dry import COHEN, friction_needed, stepped
from tippetop.report.experiments.patches import CREEP, viscous_coefficient
from tippetop.report.experiments.registry import EXPERIMENTS
from tippetop.report.gallery import PLATES, Plate
from tippetop.run import simulate

NAMES = ("rolling", "cohen", "smoothed", "patch", "viscous")


@pytest.fixture(scope="module")
def computed() -> dict[str, xr.Dataset]:
    names = (*(f"dry-{name}" for name in NAMES), "run-155")
    return {name: EXPERIMENTS[name].run(quick=True) for name in names}


def test_the_friction_that_rolling_needs_is_what_an_independent_solver_finds() -> None:
    assert friction_needed(100.0, 0.1) == pytest.approx(0.029515118741412907, rel=1e-7)


def test_a_small_tilt_needs_little_friction_in_proportion() -> None:
    per_tilt = [friction_needed(155.0, tilt) / tilt for tilt in (0.02, 0.01)]
    assert per_tilt[1] == pytest.approx(per_tilt[0], rel=1e-3)


def test_the_bound_parts_rolling_from_slipping(computed: dict[str, xr.Dataset]) -> None:
    data = computed["dry-rolling"]
    assert float(data["needed_main"]) == pytest.approx(0.0299, abs=5e-5)
    assert int(data["slips_held"].sum()) == 0
    assert 0.0 < float(data["held_below"]) < 0.1
    early, late = np.split(data["tilt_slips"].values[1:], 2)
    assert np.ptp(late) > 1.1 * np.ptp(early)


def test_cohens_steps_follow_the_slide_to_fourth_order() -> None:
    """Up to where slip is about to end, and no further."""
    span = 0.02
    axis = simulate(COHEN, span, times=[span], integrator="dop853")["axis"].values[-1]
    errors = [
        np.linalg.norm(np.array(stepped(COHEN, step, span).axis)[:, -1] - axis)
        for step in (1e-3, 5e-4, 2.5e-4)
    ]
    assert np.log2(np.array(errors[:-1]) / errors[1:]) == pytest.approx([4.0, 4.0], abs=0.4)


def test_cohens_centre_of_mass_rests_at_launch_and_its_slip_ends(
    computed: dict[str, xr.Dataset],
) -> None:
    start, data = COHEN.start(), computed["dry-cohen"]
    assert np.abs(start.velocity).max() < 1e-15 * natural_units(top_of(COHEN)).speed
    turning = angular_velocity(start.axis, start.momentum, top_of(COHEN))
    assert np.linalg.norm(turning) == pytest.approx(100.0, rel=1e-14)
    assert float(data["sticks"]) == pytest.approx(0.0288, abs=5e-5)
    assert float(data["energy_kept"]) < 1e-9
    assert float(data["tilt_stepped"].sel(step=0.01).max()) > 3.0
    assert float(data["tilt_stepped"].sel(step=0.0005).max()) < 0.5


def test_smoothed_friction_takes_for_ever_in_the_limit(computed: dict[str, xr.Dataset]) -> None:
    data = computed["dry-smoothed"]
    exponents = np.diff(np.log(data["turning_time"])) / np.diff(np.log(data["eps"]))
    assert np.all(np.diff(exponents[1:]) < 0.0)
    assert -1.0 < float(data["last_exponent"]) < -0.5
    assert np.isnan(data["exact_turns"])


def test_patches_turn_tops_over_if_they_are_neither_small_nor_large(
    computed: dict[str, xr.Dataset],
) -> None:
    data = computed["dry-patch"]
    fast = data["turning_time"].isel(spin=-1)
    assert 3e-4 < float(fast["radius"][int(np.nanargmin(fast))]) < 2e-3
    assert np.isnan(fast[-1])
    assert fast[0] > 1.2 * fast.min()
    assert not np.isfinite(data["turning_time"].where(data["spin"] < data["upright_limit"])).any()
    assert float(data["least_force"]) > 0.0
    # As converged independently; Leine and Glocker print no time for it.
    assert float(data["theirs_turns"]) == pytest.approx(0.97295, abs=5e-6)


@pytest.mark.parametrize("pressure", CREEP)
def test_the_coefficient_of_a_patch_is_the_slope_of_its_law(pressure: str) -> None:
    law = ContensouFriction(mu=0.3, patch_radius=5e-4, pressure=pressure).law
    slip, spin = 1e-8, 80.0
    slope = -law.traction((slip, 0.0), (0.0, 0.0, spin)).force[0] / slip
    assert CREEP[pressure] * 0.3 / (5e-4 * spin) == pytest.approx(slope, rel=1e-12)
    if pressure == "ellipsoidal":
        assert viscous_coefficient(0.3, 5e-4, spin) == pytest.approx(slope, rel=1e-12)


def test_a_patch_creeps_as_viscous_friction_and_turns_over_nearly_so(
    computed: dict[str, xr.Dataset],
) -> None:
    data = computed["dry-viscous"]
    assert data["growth_ratio"].values == pytest.approx(1.0, rel=1e-9)
    misses = abs(np.log(data["patch_time"] / data["viscous_time"])).mean("coefficient")
    assert float(misses.sel(mu=0.4)) < float(misses.sel(mu=0.1))
    assert np.all(data["hertz_coefficient"] > 10.0)


@pytest.mark.parametrize(
    ("name", "verdict"),
    [
        ("dry-tilting-rate", Verdict.CORRECTED),
        ("dry-cohen-inversion", Verdict.EXPLAINED),
        ("dry-cohen-sliding", Verdict.EXPLAINED),
        ("dry-coulomb-weaker", Verdict.EXPLAINED),
        ("dry-patch-inversion", Verdict.REPRODUCED),
        ("dry-viscous-limit", Verdict.REPRODUCED),
        ("dry-normal-mu", Verdict.REPRODUCED),
        ("dry-rough-mu", Verdict.REPRODUCED),
    ],
)
def test_verdicts(computed: dict[str, xr.Dataset], name: str, verdict: Verdict) -> None:
    assert_judged(computed, name, verdict)


@pytest.mark.parametrize(
    ("name", "experiment", "change", "verdict"),
    [
        ("dry-tilting-rate", "dry-rolling", {"slips_held": 3.0}, Verdict.REPRODUCED),
        ("dry-cohen-inversion", "dry-cohen", {"tilt": 2.0}, Verdict.REPRODUCED),
        ("dry-cohen-inversion", "dry-cohen", {"tilt_stepped": 0.1}, Verdict.CORRECTED),
        ("dry-cohen-sliding", "dry-cohen", {"slips_again": 4.0}, Verdict.REPRODUCED),
        ("dry-coulomb-weaker", "dry-smoothed", {"exact_turns": 3.0}, Verdict.REPRODUCED),
        ("dry-patch-inversion", "dry-patch", {"theirs_turns": math.nan}, Verdict.CORRECTED),
        ("dry-viscous-limit", "dry-viscous", {"growth_ratio": 1.001}, Verdict.CORRECTED),
        ("dry-normal-mu", "run-155", {"largest_slip": 3.0}, Verdict.EXPLAINED),
        ("dry-rough-mu", "dry-viscous", {"hertz_coefficient": 150.0}, Verdict.CORRECTED),
    ],
)
def test_verdicts_follow_the_data(
    computed: dict[str, xr.Dataset],
    name: str,
    experiment: str,
    change: dict[str, float],
    verdict: Verdict,
) -> None:
    assert_judged_otherwise(computed, name, experiment, change, verdict)


FRICTION = [plate for plate in PLATES.values() if plate.section == "Friction"]


@pytest.mark.parametrize("plate", FRICTION, ids=lambda plate: plate.id)
def test_every_figure_is_drawn_from_quick_data(
    computed: dict[str, xr.Dataset], plate: Plate
) -> None:
    assert_drawn(computed, plate)


def test_the_section_comes_after_why_and_has_its_claims() -> None:
    sections = list(dict.fromkeys(plate.section for plate in PLATES.values()))
    assert sections.index("Friction") == sections.index("Why") + 1
    ours = [claim for claim in CLAIMS.values() if claim.source.section.startswith("Friction: ")]
    assert {claim.figure for claim in ours} == {plate.id for plate in FRICTION}
