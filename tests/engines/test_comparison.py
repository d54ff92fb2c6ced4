"""Other programs against the suite: their limits, results that resume, and what is stored."""

import json
import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from typer.testing import CliRunner

import tippetop as tt
from tippetop.cli.commands import app
from tippetop.engines import comparison, limits
from tippetop.engines.adapters import ADAPTERS, adapter
from tippetop.engines.adapters.base import refusals, settings_of
from tippetop.engines.adapters.mujoco import damping_ratio
from tippetop.engines.cases import CASES
from tippetop.engines.reference import case_of, judged_state, reference_state

STEPS = (2e-3, 1e-3, 5e-4)

PLAIN_ROW = {
    "holds_until": 0.0,
    "turnover_time": None,
    "turnover_time_exactly": None,
    "energy_error": None,
    "jellett_error": None,
    "microseconds_per_step": 1.0,
}
"""Numbers of a row that a test does not ask for."""


def rows_of(case, states):
    return [
        {"case": case.name, "setting": "s", "step": step, "state": list(state)}
        for step, state in zip(STEPS, states, strict=True)
    ]


@pytest.mark.parametrize("order", [0.5, 1.0, 2.0])
def test_an_extrapolation_finds_limit_and_order_of_a_geometric_sequence(order):
    limit, error = np.array([0.3, -0.2, 0.9]), np.array([0.4, 1.0, -0.3])
    states = [limit + error * step**order for step in STEPS]
    reached, observed = limits.extrapolation(STEPS, states)
    assert reached == pytest.approx(limit, abs=1e-14)
    assert observed == pytest.approx(order, abs=1e-9)


def test_results_that_do_not_converge_have_no_limit():
    case = case_of("coulomb-roll")
    states = [reference_state(case) + shift for shift in (0.0, 1e-3, -1e-3)]
    assert limits.limit_of(case, rows_of(case, states)).law == "none"


def test_a_width_is_stated_where_the_limit_is_of_friction_regularized_over_it():
    case, width = case_of("coulomb-roll"), 2e-3
    softened = tt.RegularizedCoulombFriction(mu=case.problem.friction.mu, eps=width)
    problem = case.problem.model_copy(update={"friction": softened})
    run = tt.simulate(problem, float(case.times[0]), samples=2)
    state = judged_state(case, run["axis"].values[-1], run["angular_velocity"].values[-1])
    slope = np.linspace(0.5, 1.0, 6)
    rows = rows_of(case, [state + 0.1 * step * slope for step in STEPS])
    soft = limits.limit_of(case, rows, width)
    assert (soft.law, soft.width) == ("regularized", width)
    assert soft.step_error == pytest.approx(0.1 * STEPS[-1], rel=1e-6)
    for unlike in (None, 0.7 * width, 1.4 * width):
        assert limits.limit_of(case, rows, unlike).law == "different", "of another width, or none"
    exact = reference_state(case)
    rows = rows_of(case, [exact + 0.1 * step * slope for step in STEPS])
    hard = limits.limit_of(case, rows, width)
    assert (hard.law, hard.model_error < 1e-12) == ("reference", True)
    shifted = [exact + 0.05 + 0.1 * step * slope for step in STEPS]
    assert limits.limit_of(case, rows_of(case, shifted)).law == "different"


def test_time_stepping_converges_to_the_set_valued_law_at_first_order():
    task = next(iter(comparison.tasks(["moreau"], ["coulomb-roll"])))
    short = task.case._replace(compared=1)
    reference = comparison.exact(short)
    rows = [
        comparison.measure(task._replace(case=short), step, reference, drawn=False)
        for step in STEPS
    ]
    errors = [row["error"] for row in rows]
    assert comparison.order_of(STEPS, errors) == pytest.approx(1.3, abs=0.35)
    assert errors[-1] < 1e-3
    assert [row["step"] for row in rows] == pytest.approx(STEPS, rel=1e-12)


@pytest.mark.parametrize("name", [name for name in ADAPTERS if name != "moreau"])
def test_a_program_comes_nearer_to_the_reference_with_shorter_steps(name):
    made = adapter(name)
    pytest.importorskip(made.module, reason=f"{made.name} is not installed")
    case = case_of("coulomb-roll")._replace(compared=1)
    reference = comparison.exact(case)
    best = []
    for step in (2e-3, 2.5e-4):
        tasks = [comparison.EngineTask(made, case, setting) for setting in settings_of(made, case)]
        rows = [comparison.measure(task, step, reference, drawn=False) for task in tasks]
        best.append(min(row["error"] for row in rows))
    assert best[1] < 0.5 * best[0]
    assert best[1] < 0.01


@pytest.mark.parametrize("name", [name for name in ADAPTERS if name != "moreau"])
def test_a_run_does_not_depend_on_the_runs_before_it(name):
    made = adapter(name)
    pytest.importorskip(made.module, reason=f"{made.name} is not installed")
    # Where a program can state it, rolling friction shows best how near a contact begins.
    case = case_of("rest" if settings_of(made, case_of("rest")) else "coulomb-roll")
    short, exact = case._replace(compared=1), comparison.exact(case)
    tasks = [comparison.EngineTask(made, short, one) for one in settings_of(made, case)]
    states = {}
    for task in [*tasks, *reversed(tasks)]:
        row = comparison.measure(task, 1e-3, exact, drawn=False)
        states.setdefault(task.setting.name, []).append(row["state"])
    for setting, (first, second) in states.items():
        assert first == second, setting


def test_interrupted_results_go_on_where_they_ended(tmp_path, monkeypatch):
    measure, calls = comparison.measure, []

    def interrupted(task, step, *rest):
        calls.append(step)
        if len(calls) == 3:
            raise KeyboardInterrupt
        return measure(task, step, *rest)

    monkeypatch.setattr(comparison, "measure", interrupted)
    with pytest.raises(KeyboardInterrupt):
        comparison.compare(tmp_path, ["moreau"], ["restitution"], STEPS)
    begun = json.loads((tmp_path / "moreau.json").read_text())
    assert [row["asked_step"] for row in begun["rows"]] == [2e-3, 1e-3]
    results = comparison.compare(tmp_path, ["moreau"], ["restitution"], STEPS)
    assert calls == [2e-3, 1e-3, 5e-4, 5e-4], "what is done is not run again"
    rows = results["moreau"]["rows"]
    assert rows[:2] == begun["rows"]
    assert len(results["moreau"]["limits"]) == 1
    assert results["moreau"] == json.loads((tmp_path / "moreau.json").read_text())
    comparison.compare(tmp_path, ["moreau"], ["restitution"], STEPS)
    assert len(calls) == 4


def test_results_of_other_options_are_run_again(tmp_path):
    done = comparison.compare(tmp_path, ["moreau"], ["restitution"], STEPS[:1])["moreau"]
    (setting,) = done["settings"]
    setting["options"] = {"rounds": 3}
    done["rows"][0]["error"] = 1.0
    (tmp_path / "moreau.json").write_text(json.dumps(done))
    again = comparison.compare(tmp_path, ["moreau"], ["restitution"], STEPS[:1])["moreau"]
    assert [row["error"] < 1.0 for row in again["rows"]] == [True]


def test_a_folder_that_cannot_be_made_is_said(tmp_path):
    (tmp_path / "file").write_text("mine")
    with pytest.raises(tt.InvalidInput, match="folder"):
        comparison.compare(tmp_path / "file", ["moreau"], ["restitution"], STEPS)
    with pytest.raises(tt.FileTrouble, match="cannot be written"):
        comparison.compare(tmp_path / "file" / "inside", ["moreau"], ["restitution"], STEPS)
    assert (tmp_path / "file").read_text() == "mine"


def test_jellett_has_no_relative_error_where_it_is_zero_at_launch():
    assert math.isnan(comparison.exact(case_of("painleve")).jellett)
    assert comparison.exact(case_of("restitution")).jellett != 0.0


def test_a_failure_names_no_object_of_the_process(monkeypatch):
    def failing(*_):
        raise RuntimeError("A value is not finite. It came from source id 311191.")

    monkeypatch.setattr(comparison, "measure", failing)
    task = next(iter(comparison.tasks(["moreau"], ["painleve"])))
    row = comparison._tried(task, 1e-3, comparison.exact(task.case), False)
    assert row["failure"] == "A value is not finite"


@pytest.mark.parametrize("restitution", [0.2, 0.5, 0.8, 1.0])
def test_a_spring_and_damper_rebound_with_the_restitution_asked_for(restitution):
    ratio = damping_ratio(restitution)

    def force(_, state):
        return -state[0] - 2.0 * ratio * state[1]

    def let_go(time, state):
        return force(time, state) if time > 0.0 else 1.0

    let_go.terminal = True
    # A body comes down at unit speed on a spring of unit frequency, which only pushes.
    run = solve_ivp(
        lambda time, state: [state[1], force(time, state)],
        (0.0, 10.0),
        [0.0, -1.0],
        events=let_go,
        rtol=1e-10,
        atol=1e-12,
    )
    assert run.status == 1
    assert run.y[1, -1] == pytest.approx(restitution, abs=1e-8)


def test_a_ball_without_spin_rebounds_in_mujoco_with_the_restitution_asked_for():
    pytest.importorskip("mujoco", reason="MuJoCo is not installed")
    made, case = adapter("mujoco"), case_of("restitution")
    dropped = case._replace(problem=case.problem.replace({"launch.tilt": 0.0, "launch.spin": 0.0}))
    (setting,) = settings_of(made, dropped)
    run = made.start(dropped, 1e-4, setting)
    speeds = []
    for _ in range(1000):
        run.advance(1)
        speeds.append(run.read().velocity[2])
    assert max(speeds) / -min(speeds) == pytest.approx(0.8, abs=0.02)


def test_a_recorded_step_of_newton_is_its_step():
    pytest.importorskip("newton", reason="Newton is not installed")
    made, case = adapter("newton"), case_of("peg")
    for setting in settings_of(made, case)[1:3]:
        run = made.start(case, 1e-3, setting)
        world = run.world
        before, after, contacts = world.state(), world.state(), world.pipeline.contacts()
        for _ in range(3):
            run.advance(1)
            world.follow(before, after, contacts)
            before, after = after, before
        assert run.state.body_q.numpy().tolist() == before.body_q.numpy().tolist()
        assert run.state.body_qd.numpy().tolist() == before.body_qd.numpy().tolist()


def test_a_damaged_file_of_results_is_said(tmp_path):
    (tmp_path / "moreau.json").write_text("{")
    with pytest.raises(tt.InvalidInput, match="file of results"):
        comparison.compare(tmp_path, ["moreau"], ["restitution"], STEPS)


@pytest.mark.parametrize("name", ADAPTERS)
def test_stored_results_are_of_every_case_setting_and_step(name):
    stored, made = comparison.stored([name])[name], adapter(name)
    assert stored["suite"] == comparison.SUITE_VERSION
    assert stored["settings"] == [setting._asdict() for setting in made.settings]
    assert stored["refused"] == refusals(made, CASES)
    done = {(row["case"], row["setting"], row["asked_step"]) for row in stored["rows"]}
    asked = {
        (case.name, setting.name, step)
        for case in CASES
        for setting in settings_of(made, case)
        for step in comparison.STEPS
    }
    assert done == asked
    assert len(stored["limits"]) == len(asked) / len(comparison.STEPS)


def test_a_stored_result_comes_again(tmp_path):
    pytest.importorskip("mujoco", reason="MuJoCo is not installed")
    stored = comparison.stored()["mujoco"]
    again = comparison.compare(tmp_path, ["mujoco"], ["painleve"], STEPS)["mujoco"]
    if again["version"] != stored["version"]:
        pytest.skip("the stored results are of another version")
    before = {(row["case"], row["setting"], row["asked_step"]): row for row in stored["rows"]}
    for row in again["rows"]:
        earlier = before[row["case"], row["setting"], row["asked_step"]]
        for name in ("error", "energy_error", "tilt_error"):
            assert row[name] == pytest.approx(earlier[name], rel=1e-6, abs=1e-12)


def test_stored_limits_are_regularized_over_the_width_of_their_setting_alone():
    regularized = []
    for name, stored in comparison.stored().items():
        widths = {one["name"]: one["width"] for one in stored["settings"]}
        for limit in stored["limits"]:
            if limit["law"] == "regularized":
                assert limit["width"] == widths[limit["setting"]]
                regularized.append((name, limit["setting"], limit["case"]))
    assert ("exudyn", "RK44", "coulomb-roll") in regularized, "its friction zone is 1e-3 m/s"


def test_the_best_setting_holds_at_the_shortest_step_and_is_the_first_of_equals():
    def row(setting, step, error):
        result = {"failure": "lost"} if error is None else {"step": step, "error": error}
        return {"case": "painleve", "setting": setting, "asked_step": step, **result}

    def best_of(*rows):
        rows = [{**PLAIN_ROW, **one} for one in rows]
        (verdict,) = comparison.verdicts({"x": {"engine": "X", "limits": [], "rows": rows}})
        return verdict.setting, verdict.error

    fails = [row("fails", 1e-3, 1e-6), row("fails", 5e-4, None)]
    assert best_of(*fails, row("holds", 1e-3, 0.2), row("holds", 5e-4, 0.1)) == ("holds", 0.1)
    assert best_of(*fails) == ("fails", 1e-6)
    assert best_of(row("plain", 1e-3, 0.1002), row("rare", 1e-3, 0.1001)) == ("plain", 0.1002)


def test_without_any_program_the_stored_results_are_shown_in_80_columns(monkeypatch):
    monkeypatch.setattr(comparison, "installed", lambda *_: ["moreau"])
    monkeypatch.setenv("COLUMNS", "80")
    shown = CliRunner().invoke(app, ["engines"])
    assert shown.exit_code == 0
    shown_text = " ".join(shown.output.split())
    assert "None of the programs is installed" in shown_text
    assert "pip install 'tippetop[engines]'" in shown_text
    lines = shown.output.splitlines()
    assert max(map(len, lines)) <= 80
    for name, stored in comparison.stored().items():
        title = f"{stored['engine']} {stored['version']} ({stored['date']})"
        assert title in shown.output, name
    verdicts = comparison.verdicts(comparison.stored())
    begun = [
        line
        for line in lines
        if line.split()[:1] and line.split()[0] in {case.name for case in CASES}
    ]
    assert len(begun) == len(verdicts), "each case is one line"


def test_unknown_programs_and_steps_are_refused(tmp_path):
    result = CliRunner().invoke(app, ["engines", "--engine", "unreal"])
    assert isinstance(result.exception, tt.InvalidInput)
    assert "mujoco" in str(result.exception)
    for step in (0.0, 1e-12, math.nan, 1.0):
        with pytest.raises(tt.InvalidInput, match="step"):
            comparison.compare(tmp_path, ["moreau"], None, [step])


def test_figures_of_stored_results_show_every_program():
    from tippetop.figures.engines import errors_figure, launch_figure  # noqa: PLC0415

    stored = comparison.stored()
    names = {one["engine"] for one in stored.values()}
    legend = errors_figure(stored).legends[0]
    assert {text.get_text() for text in legend.get_texts()} == names
    panel, apart = launch_figure(stored, "coulomb-roll").axes
    labels = [line.get_label() for line in panel.lines]
    assert labels[0] == "exact"
    assert all(any(label.startswith(name) for label in labels) for name in names)
    assert len(apart.lines) == len(labels) - 1


OWN = """
from tippetop.engines.adapters.base import Setting
from tippetop.engines.adapters.moreau import Moreau as Base, MoreauStepper

class Mine:
    name = "Mine"
    version = "3"
    settings = (Setting("only", "all I have", "my manual", {}),)

    def refusal(self, case, setting):
        return None if case.name in ("painleve", "restitution") else "cannot"

    def start(self, case, step, setting):
        if case.name == "restitution":
            raise KeyError("no such body")
        return MoreauStepper(case.problem, step)
"""


def test_an_adapter_in_a_file_is_compared_and_its_failures_are_named(tmp_path, monkeypatch):
    monkeypatch.setenv("COLUMNS", "200")
    file = tmp_path / "mine.py"
    file.write_text(OWN)
    words = ["engines", "--engine", str(file), "--out", str(tmp_path / "out")]
    words += ["--case", "painleve", "--case", "restitution"]
    done = CliRunner().invoke(app, [*words, "--step", "1 ms", "--step", "2 ms"])
    assert done.exit_code == 0, done.output
    assert "Mine 3, file" in done.output
    assert "Mine, restitution, only at 1 ms failed: KeyError: 'no such body'" in done.output
    stored = json.loads((tmp_path / "out" / "mine.json").read_text())
    ours = comparison.compare(tmp_path / "ours", ["moreau"], ["painleve"], [1e-3, 2e-3])["moreau"]
    mine = [row["error"] for row in stored["rows"] if row["case"] == "painleve"]
    assert mine == [row["error"] for row in ours["rows"]]
    file.write_text(OWN.replace('raise KeyError("no such body")', "pass"))
    again = CliRunner().invoke(app, [*words, "--step", "1 ms"])
    assert "failed" not in again.output, "another file is another version"


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("x = 1 / 0\n", "raises ZeroDivisionError in line 1: division by zero"),
        ("x = (\n", "raises SyntaxError"),
        ("x = 1\n", "has 0 classes with settings and start"),
        ("class A:\n    settings = ()\n    start = 1\n", "has a class without name, refusal"),
        (
            OWN.replace("return None if", "return spam if"),
            "raises NameError in line 11: name 'spam' is not defined",
        ),
    ],
)
def test_an_adapter_that_cannot_be_used_is_a_sentence(text, sentence, tmp_path):
    file = tmp_path / "mine.py"
    file.write_text(text)
    with pytest.raises(tt.InvalidInput, match=sentence):
        comparison.compare(tmp_path / "out", [str(file)])
    with pytest.raises(tt.FileTrouble, match=r"absent.py"):
        comparison.compare(tmp_path / "out", [str(tmp_path / "absent.py")])


def test_programs_whose_results_would_be_one_file_are_refused(tmp_path):
    files = [tmp_path / "one" / "mine.py", tmp_path / "two" / "mine.py", tmp_path / "moreau.py"]
    for file in files:
        file.parent.mkdir(exist_ok=True)
        file.write_text(OWN)
    for names in (files[:2], files[2:]):
        with pytest.raises(tt.InvalidInput, match="has results of the same name as"):
            comparison.compare(tmp_path / "out", list(map(str, names)))
    assert not (tmp_path / "out").exists()


def test_a_run_that_would_take_too_long_is_named(tmp_path):
    results = comparison.compare(tmp_path, ["moreau"], ["restitution"], STEPS, longest=1e-9)
    assert [one["asked_step"] for one in results["moreau"]["left_out"]] == list(STEPS[1:])
    (first, _) = comparison.dropped(results)
    assert first.startswith("Moreau, restitution, textbook at 1 ms would take")
    results = comparison.compare(tmp_path, ["moreau"], ["restitution"], STEPS)
    assert comparison.dropped(results) == []
