"""The account of a run: the same clauses and numbers everywhere, and true ones."""

import json
import math
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from scipy.optimize import brentq, minimize_scalar
from typer.testing import CliRunner

import tippetop as tt
from accounts import DRY, LAUNCHES, REPORT, report
from launches import TOLERANCE, in_javascript
from tippetop.cli.commands import app
from tippetop.export.bundle import player_packed
from tippetop.export.track import pack_run, unpack_header
from tippetop.results.account_text import Account, describe
from tippetop.results.catalogue import LASTING
from tippetop.theory.prediction import predict
from tippetop.theory.thresholds import critical_spins

TEXTS = Path(__file__).parents[1] / "web" / "texts"
SLOW = {
    *("patch", "puck", "two balls, smoothed", "egg, dry", "rolling resistance, viscous"),
    *("Leine and Glocker's stem", "ring top, falls", "rolling resistance", "egg"),
}
"""Launches that take more than a second."""


@cache
def followed(name: str) -> xr.Dataset:
    problem, duration = LAUNCHES[name]
    return tt.simulate(problem, duration, samples=101, integrator="taylor", tolerance=TOLERANCE)


def named(account: Account, name: str) -> dict[str, float]:
    (found,) = [dict(clause.numbers) for clause in account.clauses if clause.name == name]
    return found


def names(account: Account) -> list[str]:
    return [clause.name for clause in account.clauses]


def test_there_are_forty_launches_over_every_law_and_ending() -> None:
    assert len(LAUNCHES) >= 40
    laws = {problem.friction.kind for problem, _ in LAUNCHES.values()}
    assert laws == {"viscous", "coulomb", "contensou", "regularized_coulomb"}


@pytest.mark.parametrize(
    "chosen",
    [list(LAUNCHES)[::20], pytest.param(list(LAUNCHES), marks=pytest.mark.slow)],
    ids=["some", "all"],
)
def test_the_page_gives_the_same_account(chosen: list[str]) -> None:
    questions = [
        {
            "problem": problem.model_dump(mode="json"),
            "duration": duration,
            "tolerance": TOLERANCE,
            "times": [0.0],
        }
        for problem, duration in map(LAUNCHES.__getitem__, chosen)
    ]
    answers = list(in_javascript(questions))
    wrong = dict[str, Any]()
    for name, answer in zip(chosen, answers, strict=True):
        ours = describe(followed(name)).plain()
        theirs = [{"name": one["name"], **one["numbers"]} for one in answer.get("account", [])]
        if not same(ours, theirs):
            wrong[name] = ours, theirs or answer
    assert not wrong


def same(ours: list[dict[str, Any]], theirs: list[dict[str, Any]]) -> bool:
    """Return whether two accounts have the same clauses, with numbers equal to a part in 10^6."""
    if [one["name"] for one in ours] != [one["name"] for one in theirs]:
        return False
    return all(
        a.keys() == b.keys()
        and all(
            a[key] == b[key]
            or (
                isinstance(a[key], float)
                and math.isclose(a[key], b[key], rel_tol=1e-6, abs_tol=1e-7)
            )
            for key in a
        )
        for a, b in zip(ours, theirs, strict=True)
    )


QUICK = ("report", "flies", "half way", "puck")


@pytest.mark.parametrize(
    "name",
    [pytest.param(name, marks=[] if name in QUICK else pytest.mark.slow) for name in LAUNCHES],
)
def test_the_command_line_and_the_page_of_a_run_give_the_same_account(
    name: str, tmp_path: Path
) -> None:
    problem, duration = LAUNCHES[name]
    (tmp_path / "launch.toml").write_text(problem.to_toml(), encoding="utf-8")
    said = CliRunner().invoke(
        app, ["simulate", str(tmp_path / "launch.toml"), "--duration", str(duration), "--json"]
    )
    assert said.exit_code == 0, said.output
    run = tt.simulate(problem, duration, samples=11)
    account = describe(run)
    assert json.loads(said.stdout)["account"] == account.plain()
    header = unpack_header(pack_run(run))
    assert header["account"] == account.plain()
    assert header["story"]["headline"].lower() == account.headline.lower()
    assert tt.summarize(run)["description"] == str(account)


def test_the_catalogues_have_the_same_texts() -> None:
    import tippetop.results as room  # noqa: PLC0415 - for its place

    folder = Path(str(room.__file__)).parent
    english = json.loads((folder / "account_en.json").read_text("utf-8"))
    german = json.loads((TEXTS / "de.json").read_text("utf-8"))["account"]
    assert english["clauses"].keys() == german["clauses"].keys()
    assert english["units"].keys() == german["units"].keys()
    for name, text in english["clauses"].items():
        gaps = {part.partition("}")[0] for part in text.split("{")[1:]}
        others = {part.partition("}")[0] for part in german["clauses"][name].split("{")[1:]}
        assert gaps == others, name


def test_every_clause_of_the_launches_has_a_text() -> None:
    for name in [name for name in LAUNCHES if name not in SLOW][::3]:
        account = describe(followed(name))
        assert "{" not in str(account)
        assert "nan" not in str(account), account


def test_a_run_that_is_too_short_does_not_say_never() -> None:
    for name in ("report, short", "little friction"):
        account = describe(followed(name))
        assert "not_yet_over" in names(account)
        assert "heads_for_inverted" in names(account)
        assert "never" not in str(account)


def test_a_dry_top_is_told_to_stick() -> None:
    account = describe(followed("dry, slips first"))
    run = followed("dry, slips first")
    times = run["event_time"].values[run["event_kind"].values == "stick"]
    assert named(account, "sticks")["time"] == times[-1]
    assert "sticking_explained" in names(account)


def test_a_top_that_falls_back_is_told_from_one_that_turns_over() -> None:
    problem = REPORT.replace(
        {"friction.kind": "contensou", "friction.patch_radius": 5e-4, "launch.spin": 80.0}
    )
    run = tt.simulate(problem, 30.0, samples=30_001)
    told = named(describe(run), "falls_back")
    theta, time = run["tilt"].values, run["time"].values
    assert told["highest"] == pytest.approx(theta.max(), abs=1e-5)
    assert told["time"] == pytest.approx(time[theta.argmax()], abs=2e-3)
    assert told["tilt"] == pytest.approx(theta[-1], rel=1e-12)


def test_a_disk_lies_down_and_goes_on_upon_its_face() -> None:
    run = followed("puck")
    down = float(run["event_time"].values[run["event_kind"].values == "lies down"][0])
    account = describe(run)
    assert named(account, "lies_down") == {"time": down}
    assert named(account, "comes_to_rest_on_face")["time"] == float(run["end_time"]) > down + 0.1


def test_a_cylinder_rocks_on_its_rim_until_it_lies() -> None:
    run = followed("cylinder that rocks")
    kinds = run["event_kind"].values
    (down,) = run["event_time"].values[kinds == "lies down"].tolist()
    told = named(describe(run), "rocks_on_rim")
    assert told == {"count": int((kinds == "impact").sum()), "time": down}


def test_a_cylinder_that_drills_comes_to_roll_on_its_rim() -> None:
    run = followed("cylinder on its rim")
    kinds, when = run["event_kind"].values.tolist(), run["event_time"].values.tolist()
    times = dict(zip(kinds, when, strict=True))
    account = describe(run)
    assert named(account, "pressed_at_rim") == {"time": times["pressure at the rim"]}
    assert named(account, "rolls_on_rim") == {"time": times["rolls on its rim"]}
    ended = {"time": float(run["end_time"]), "spin": float(run["final_spin"])}
    assert named(account, "rolls_flat") == ended
    assert "lies_flat_and_spins" not in names(account)


def test_two_balls_stand_on_the_ball_that_touches() -> None:
    told = named(describe(followed("two balls, dry")), "stands_on_sphere")
    assert told == {"surface": 0, "length": 0.2}
    assert "on its sphere of radius 200 mm" in str(describe(followed("two balls, dry")))


def test_a_body_on_two_surfaces_is_told_which_they_are() -> None:
    """A ring top that fell touches with its ball and its rim, hurricane balls with both."""
    told = named(describe(followed("ring top, falls")), "stands_on_sphere_and_edge")
    assert told == {"surface": 0, "second": 1, "length": 5e-4, "other_length": 0.1}
    told = named(describe(followed("hurricane balls")), "stands_on_spheres")
    assert told["length"] == told["other_length"] == 0.01


def test_dry_friction_is_told_to_hold_the_top_or_not() -> None:
    """Dry friction of 0.3 holds the report's top at launch, that of 0.02 does not."""
    held, slips = (describe(followed(name)) for name in ("dry", "dry, little friction"))
    assert names(held)[0] == "never_slips"
    assert "slip_missing" in names(held)
    assert names(slips)[0] == "starts_to_slip"


def test_a_tilt_within_the_distance_of_its_end_is_not_told_as_far_from_it() -> None:
    for name in ("report, not yet settled", "upside down"):
        account = describe(followed(name))
        assert math.pi - float(followed(name)["final_tilt"]) < 0.01
        assert "is_inverted" in names(account)
        assert "has not settled" not in str(account)


def test_a_swing_is_not_told_as_a_fall() -> None:
    account = describe(followed("table that pulls"))
    assert "is_highest" in names(account)
    assert "down to" not in str(account)
    assert "just then" in str(account)


def test_rocking_beyond_the_horizontal_is_no_turning_over() -> None:
    for name in ("egg off its centre", "hurricane balls"):
        assert math.isfinite(float(followed(name)["turnover_time"]))
        assert not {"turns_over", "passes_the_horizontal"} & set(names(describe(followed(name))))


def test_a_top_that_comes_upright_is_not_told_to_stay() -> None:
    told = named(describe(followed("too slow")), "comes_upright")
    assert told == {"tilt": 0.1}
    assert "stays_upright" in names(describe(followed("exactly upright, slow")))


def test_of_a_flight_without_touching_no_steady_state_is_told() -> None:
    assert names(describe(followed("in the air all along"))) == [
        *("drops", "never_touches", "still_flies"),
    ]


def test_slow_tops_are_told_why_they_stay() -> None:
    account = describe(followed("too slow"))
    spins = critical_spins(report(20.0))
    assert named(account, "too_slow_to_rise") == {"spin": spins.upright}


def test_a_moving_top_is_told_where_it_heads() -> None:
    account = describe(followed("just fast enough"))
    final = predict(report(32.0)).final
    told = named(account, "heads_for_precession")
    assert told == {"tilt": final.tilt, "spin": final.spin, "precession": final.precession}


DOUBLED = [
    *("report", "report, not yet settled", "little friction", "too slow", "half way", "flies"),
    *("comes upright", "falls from inverted", "exactly upright, slow", "no friction", "dry"),
    *("dropped", "smoothed", "patch, to its rest", "egg, slow", "Leine and Glocker's"),
    *("coin", "ring top", "two balls, dry", "dry ball at rest"),
    *("ring top, falls", "egg off its centre", "upside down", "stops at lift-off", "puck"),
]
SETTLES = {"report", "half way", "flies", "ring top, falls", "egg off its centre"}


@pytest.mark.parametrize("name", DOUBLED)
def test_a_longer_run_changes_no_number_that_is_said_to_last(name: str) -> None:
    problem, duration = LAUNCHES[name]
    told = set[str]()
    before = tt.simulate(problem, duration, samples=2)
    after = tt.simulate(problem, 2.0 * duration, samples=2)
    for number in LASTING:
        if math.isfinite(float(before[number])):
            told.add(number)
            assert float(after[number]) == pytest.approx(float(before[number]), rel=0, abs=1e-9), (
                number
            )
    if name in SETTLES:
        assert {"arrival_time", "max_tilt_ever"} <= told


def test_a_body_rests_leaning_where_its_centre_of_mass_is_lowest() -> None:
    """Of a spheroid h = sqrt(across^2 s^2 + along^2 c^2) - center c; on two surfaces h is equal."""
    egg = minimize_scalar(
        lambda tilt: (
            math.hypot(0.015 * math.sin(tilt), 0.025 * math.cos(tilt)) - 0.003 * math.cos(tilt)
        ),
        bounds=(1.0, 2.0),
        options={"xatol": 1e-10},
    )
    ring = brentq(lambda tilt: 5e-4 + 0.0295 * math.cos(tilt) - 0.1 * math.sin(tilt), 0.1, 1.0)
    for name, tilt in {"egg off its centre": egg.x, "ring top, falls": ring}.items():
        run = followed(name)
        assert run["is_settled"]
        assert named(describe(run), "settles_at")["tilt"] == pytest.approx(tilt, abs=5e-3)
        theta, time = run["tilt"].values, run["time"].values
        near = abs(theta - tilt) < 0.01
        assert time[near][0] >= float(run["arrival_time"]) - 1e-9


def test_the_time_of_a_weak_theory_is_that_of_a_longer_run() -> None:
    told = named(describe(followed("little friction")), "is_there_after")
    run = tt.simulate(LAUNCHES["little friction"][0], 60.0, samples=2)
    assert told["about"] == pytest.approx(float(run["arrival_time"]), rel=0.01)
    assert "after about 45 s" in str(describe(followed("little friction")))


def test_a_swing_through_its_end_has_not_settled_before_it_stays() -> None:
    """A damped swing enters the tilts near its end, leaves and enters again: seen in samples."""
    for name in ("report", "comes upright", "egg, slow", "half way"):
        problem, duration = LAUNCHES[name]
        run = tt.simulate(problem, duration, samples=100_001)
        (settled,) = [clause for clause in describe(run).clauses if "settles" in clause.name]
        time, theta = run["time"].values, run["tilt"].values
        ends = {"comes upright": 0.0, "egg, slow": 0.5 * math.pi, "report": math.pi}
        end = ends.get(name, theta[-1])
        outside = np.flatnonzero(abs(theta - end) > 0.01)
        assert settled.numbers["time"] == pytest.approx(time[outside[-1]], abs=2.0 * time[1]), name
        if name == "comes upright":
            assert settled.numbers["time"] > 1.1 * float(run["arrival_time"])


def test_what_settles_stays_near_where_it_settled() -> None:
    """The tilt of a run that is settled half-way is within twice 0.01 rad of its last one since."""
    for name in ("report", "half way", "too slow", "comes upright", "falls from inverted", "flies"):
        problem, duration = LAUNCHES[name]
        for share in (0.25, 0.5, 0.75):
            part = tt.simulate(problem, share * duration, samples=2)
            if part["is_settled"]:
                run = tt.simulate(problem, duration, samples=20_001)
                later = run["tilt"].values[run["time"].values >= share * duration]
                assert np.ptp(later) <= 0.02
                assert abs(later[0] - float(part["final_tilt"])) < 1e-6


def test_settled_ends_are_apart_from_moving_ones_in_sweeps() -> None:
    spins = {"launch.spin": [20.0, 50.0, 155.0]}
    short, long = (tt.sweep(REPORT, spins, duration=end, workers=1) for end in (2.0, 20.0))
    assert long["outcome"].values.tolist() == ["upright", "tilted", "inverted"]
    assert short["outcome"].values[1:].tolist() == ["moving_upright"] * 2
    assert long["is_settled"].all()
    dry = tt.sweep(REPORT.replace(DRY), spins, duration=2.0, workers=1)
    assert (dry["outcome"] == "rolling").all()


def test_sweeps_tell_tops_that_fell_back() -> None:
    problem = REPORT.replace({"friction.kind": "contensou", "friction.patch_radius": 5e-4})
    swept = tt.sweep(problem, {"launch.spin": [10.0, 80.0]}, duration=30.0, workers=1)
    assert (swept["outcome"] == "fell_back").values.tolist() == [False, True]


def test_a_run_s_page_has_the_account(tmp_path: Path) -> None:
    assert player_packed()
    run = followed("report")
    page = tt.write_html(run, tmp_path / "run.html").read_text("utf-8")
    assert describe(run).headline[1:].split(";")[0] in page
