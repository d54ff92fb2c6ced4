"""The section "Real tops": its numbers against other solvers and closed forms, and verdicts that
follow.
"""

import math

import numpy as np
import pytest
import xarray as xr

from judging import assert_drawn, assert_judged, assert_judged_otherwise
from tippetop.problem.bodies import Body
from tippetop.problem.launch import Launch
from tippetop.problem.presets import EULER_DISK, HURRICANE_BALLS
from tippetop.problem.problem import Problem, top_of
from tippetop.problem.shapes import Spheroid
from tippetop.report.claim import Verdict
from tippetop.report.claims.registry import CLAIMS
from tippetop.report.experiments.real import ROUGH, rolling, with_stem
from tippetop.report.experiments.registry import EXPERIMENTS
from tippetop.report.gallery import PLATES, Plate
from tippetop.theory.resting_center import resting_center
from tippetop.theory.stem import least_jellett_to_stand

pytestmark = pytest.mark.slow  # its experiments take eight seconds

NAMES = ("leine", "stepping", "stems", "egg", "rolling")


@pytest.fixture(scope="module")
def computed() -> dict[str, xr.Dataset]:
    return {f"real-{name}": EXPERIMENTS[f"real-{name}"].run(quick=True) for name in NAMES}


def test_the_top_with_a_stem_does_what_an_independent_solver_finds(
    computed: dict[str, xr.Dataset],
) -> None:
    data = computed["real-leine"].isel(pressure=0)
    assert float(data["stem"]) == pytest.approx(1.37104325139, abs=1e-8)
    assert float(data["back"]) == pytest.approx(4.55045294, abs=1e-8)
    assert float(data["both"]) == pytest.approx(4.67713921, abs=1e-6)
    assert float(data["apart"]) == pytest.approx(5.4664569, abs=1e-6)
    assert float(data["energy_error"]) < 1e-12


def test_time_stepping_comes_to_our_run_at_first_order(computed: dict[str, xr.Dataset]) -> None:
    """It shares no equation with the runs; before the rocking its errors are as long as its
    steps.
    """
    data = computed["real-stepping"]
    for name, most in (("stem", 15.0), ("back", 300.0)):
        off = np.abs(data[name].values - float(data[f"exact_{name}"]))[1:]
        assert (off < most * data["step"].values[1:]).all(), name
        assert off[0] / off[1] == pytest.approx(2.5, rel=0.2), name
    assert (data["both"] < float(data["exact_both"])).all(), "strikes closer than a step are missed"
    assert (data["strikes"] < 5).all()
    assert int(data["exact_strikes"]) > 20


def test_stems_are_stood_upon_above_the_least_jellett(computed: dict[str, xr.Dataset]) -> None:
    data = computed["real-stems"]
    assert least_jellett_to_stand(with_stem(0.004)) == pytest.approx(1.12145e-05, rel=1e-5)
    stands = data["final_tilt"].values > math.pi - 0.1
    assert stands.any()
    assert not stands.all()
    assert np.array_equal(stands, (data["jellett"] > data["jellett_needed"]).values)


def test_an_egg_rises_if_it_is_spun_fast(computed: dict[str, xr.Dataset]) -> None:
    final = computed["real-egg"]["tilt"].isel(time=-1).values
    assert final[0] < 2.6
    assert final[-1] > 3.1


def test_rolling_around_the_centre_is_known_for_disks_and_balls() -> None:
    disk = Problem(body=EULER_DISK, friction=ROUGH, launch=Launch(tilt=0.3, spin=0.0), gravity=9.81)
    found = resting_center(0.3, top_of(disk))
    assert found == pytest.approx((59.96600573975, 2.95352773481), rel=1e-11)
    balls = top_of(disk.replace({"body": HURRICANE_BALLS}))
    for tilt in (1.2, 1.5, 1.57):
        rate = math.sqrt(9.81 / (0.01 * (2 / 5 - math.cos(tilt))))
        assert resting_center(tilt, balls) == pytest.approx(
            (rate, rate * (1 + math.cos(tilt))), rel=1e-11
        )
    assert resting_center(1.0, balls) is None, "their tilt is never as small"


def test_balls_are_scanned_while_only_one_of_them_touches(computed: dict[str, xr.Dataset]) -> None:
    whole = {"real-rolling": EXPERIMENTS["real-rolling"].run(quick=False)}
    for data in (computed, whole):
        assert data["real-rolling"]["balls_tilt"].max() < math.pi / 2
        assert_judged(data, "real-hurricane-balls", Verdict.REPRODUCED)


def test_any_body_rolls_so_in_a_run() -> None:
    """A flat spheroid, of which no formula was printed."""
    body = Body(mass=0.02, shape=Spheroid(across=0.02, along=0.008), I1=2e-6, I3=3.2e-6)
    rolls = rolling(body, 0.7)
    assert rolls is not None
    motion, run = rolls
    np.testing.assert_allclose(run["tilt"], 0.7, rtol=0, atol=1e-9)
    np.testing.assert_allclose(run["precession"], motion.precession, rtol=1e-9)
    assert np.abs(run["velocity"]).max() < 1e-9


@pytest.mark.parametrize(
    ("name", "verdict"),
    [
        ("real-leine-stem", Verdict.REPRODUCED),
        ("real-leine-back", Verdict.REPRODUCED),
        ("real-leine-both", Verdict.REPRODUCED),
        ("real-leine-apart", Verdict.REPRODUCED),
        ("real-leine-stepping", Verdict.REPRODUCED),
        ("real-stem-test", Verdict.REPRODUCED),
        ("real-egg-rises", Verdict.REPRODUCED),
        ("real-egg-jumps", Verdict.REPRODUCED),
        ("real-disk-rate", Verdict.REPRODUCED),
        ("real-hurricane-balls", Verdict.REPRODUCED),
    ],
)
def test_verdicts(computed: dict[str, xr.Dataset], name: str, verdict: Verdict) -> None:
    assert_judged(computed, name, verdict)


@pytest.mark.parametrize(
    ("name", "experiment", "change"),
    [
        ("real-leine-stem", "real-leine", {"stem": 1.1}),
        ("real-leine-back", "real-leine", {"back": 4.8}),
        ("real-leine-both", "real-leine", {"both": 4.3}),
        ("real-leine-apart", "real-leine", {"apart": 5.8}),
        ("real-leine-stepping", "real-stepping", {"both": 4.2}),
        ("real-stem-test", "real-stems", {"final_tilt": 3.1}),
        ("real-egg-rises", "real-egg", {"tilt": 2.0}),
        ("real-egg-jumps", "real-egg", {"liftoff": math.nan}),
        ("real-disk-rate", "real-rolling", {"disk_measured": 70.0}),
        ("real-hurricane-balls", "real-rolling", {"balls_measured": 70.0}),
    ],
)
def test_verdicts_follow_the_data(
    computed: dict[str, xr.Dataset], name: str, experiment: str, change: dict[str, float]
) -> None:
    assert_judged_otherwise(computed, name, experiment, change, Verdict.CORRECTED)


REAL = [plate for plate in PLATES.values() if plate.section == "Real tops"]


@pytest.mark.parametrize("plate", REAL, ids=lambda plate: plate.id)
def test_every_figure_is_drawn_from_quick_data(
    computed: dict[str, xr.Dataset], plate: Plate
) -> None:
    assert_drawn(computed, plate)


def test_the_section_comes_last_and_has_its_claims() -> None:
    assert list(dict.fromkeys(plate.section for plate in PLATES.values()))[-1] == "Real tops"
    ours = [claim for claim in CLAIMS.values() if claim.source.section.startswith("Real tops: ")]
    assert {claim.figure for claim in ours} == {plate.id for plate in REAL}
