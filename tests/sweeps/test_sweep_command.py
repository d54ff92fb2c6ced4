"""The command `tippetop sweep` as a person uses it."""

import json
import os
import re
import signal
import sys
from pathlib import Path

import numpy as np
import pytest
import typer
import xarray as xr
from sweep_cases import wait_for_a_task
from typer.testing import CliRunner

import tippetop as tt
from campaigns import among
from children import ended, posix_only, started
from tippetop.cli import commands
from tippetop.cli.sweep import sweep as command
from tippetop.problem.presets import report_problem
from tippetop.support.errors import FileTrouble, InvalidInput
from tippetop.sweeps import Store

AXES = ["--over", "launch.spin=50:200:3", "--over", "friction.mu=0.1:1:2:log"]
SHORT = ["--tilt", "1.0", "--duration", "0.1", "--workers", "1"]


def run(*arguments):
    """What the command prints; its errors are raised."""
    app = typer.Typer()
    app.command()(command)
    result = CliRunner().invoke(app, [str(argument) for argument in arguments])
    if result.exception is not None and not isinstance(result.exception, SystemExit):
        raise result.exception
    assert result.exit_code == 0, result.output
    return result.stdout


def test_a_sweep_writes_a_store_and_maps_beside_it(tmp_path):
    out = tmp_path / "a.zarr"
    said = run(*AXES, *SHORT, "--out", out)
    assert "6 launches" in said
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        "a.final_tilt.png",
        "a.flights.png",
        "a.outcome.png",
        "a.turnover_time.png",
        "a.zarr",
    ]
    assert xr.open_zarr(out)["final_tilt"].shape == (3, 2)


def test_the_first_invalid_launch_is_reported(tmp_path):
    options = [
        "--over",
        "launch.tilt=0.1,45,90",
        *SHORT[2:],
        "--no-maps",
        "--out",
        tmp_path / "a.zarr",
    ]
    assert "The first launch that is not valid: launch.tilt: 45 is not" in run(*options)
    assert "not valid" not in run("--over", "launch.tilt=0.1,0.2", *options[2:], "--force")


def test_programs_get_json(tmp_path):
    out = tmp_path / "a.zarr"
    said = json.loads(run(*AXES, *SHORT, "--settled", "1e-3", "--out", out, "--json", "--no-maps"))
    assert said["sweep"]["settled"] == 1e-3
    assert said["cells"] == said["computed"] == sum(said["outcomes"].values()) == 6
    assert said["launches_per_second"] == pytest.approx(said["computed"] / said["seconds"])
    assert said["maps"] == []
    assert said["sweep"]["problem"]["launch"]["tilt"] == 1.0
    again = json.loads(run("--out", out, "--resume", "--json", "--no-maps"))
    assert again["computed"] == 0
    assert again["outcomes"] == said["outcomes"]


def test_draws_and_settings_reach_the_sweep(tmp_path):
    out = tmp_path / "a.zarr"
    draws = [
        "--draw",
        "launch.spin=10:20",
        "--draw",
        "friction.mu=0.1:1:log",
        "--count",
        5,
        "--seed",
        3,
    ]
    options = [
        "--set",
        "gravity=3.7",
        "--liftoff",
        "stop",
        "--preset",
        "report-table-1",
    ]
    run(*draws, *options, *SHORT, "--tolerance", "1e-8", "--out", out, "--no-maps")
    sweep = Store.resume(out).sweep
    assert sweep.grid.shape == (5,)
    assert sweep.grid.seed == 3
    assert sweep.problem.gravity == 3.7
    assert sweep.problem.contact.liftoff == "stop"
    assert sweep.problem.body.I1 > sweep.problem.body.I3
    assert sweep.tolerance == 1e-8


def test_a_problem_and_a_sweep_are_read_from_files(tmp_path):
    (tmp_path / "top.toml").write_text(report_problem(spin=77.0).to_toml())
    run(tmp_path / "top.toml", *AXES[2:], *SHORT, "--out", tmp_path / "a.zarr", "--no-maps")
    assert Store.resume(tmp_path / "a.zarr").sweep.problem.launch.spin == 77.0
    (tmp_path / "sweep.toml").write_text(
        'problem = "top.toml"\nduration = 0.1\n[over]\nlaunch.tilt = [0.2, 0.3]\n'
    )
    run(
        tmp_path / "sweep.toml",
        "--mu",
        0.7,
        "--workers",
        1,
        "--out",
        tmp_path / "b.zarr",
        "--no-maps",
    )
    sweep = Store.resume(tmp_path / "b.zarr").sweep
    assert sweep.dimensions == ("tilt",)
    assert sweep.problem.friction.mu == 0.7
    assert sweep.duration == 0.1


def test_a_file_of_draws_is_swept_resumed_and_swept_over_fields_instead(tmp_path):
    (tmp_path / "top.toml").write_text(report_problem(spin=77.0).to_toml())
    (tmp_path / "sweep.toml").write_text(
        'problem = "top.toml"\nduration = 0.1\ncount = 3\nseed = 4\n[draw]\n'
        'launch.spin = { distribution = "norm", loc = 150, scale = 5 }\n'
        "friction.mu = [0.1, 0.2, 0.3]\n"
    )
    alone = ("--workers", 1, "--no-maps", "--out")
    run(tmp_path / "sweep.toml", *alone, tmp_path / "a.zarr")
    stored = tt.read_sweep(tmp_path / "a.zarr")
    assert stored["mu"].values.tolist() == [0.1, 0.2, 0.3]
    spins = tt.sweep(
        report_problem(),
        draw={"launch.spin": {"distribution": "norm", "loc": 150, "scale": 5}},
        count=3,
        seed=4,
        duration=0.01,
        workers=1,
    )["spin"]
    assert stored["spin"].values.tolist() == spins.values.tolist()
    whole = json.loads(run(*alone, tmp_path / "a.zarr", "--resume", "--json"))
    assert (whole["cells"], whole["computed"]) == (3, 0)
    run(tmp_path / "sweep.toml", "--over", "launch.spin=10,20", *alone, tmp_path / "b.zarr")
    sweep = Store.resume(tmp_path / "b.zarr").sweep
    assert sweep.draw is None
    assert sweep.grid.shape == (2,)


def test_stems_are_swept_from_a_file_and_from_the_command_as_in_python(tmp_path):
    """Where a stem strikes, and after how long it does, by its length and the launch."""
    problem = report_problem(tilt=2.3, spin=40.0).replace({"body": tt.presets.REPORT_STEM})
    lengths, spins = [0.016, 0.018, 0.02], [40.0, 100.0]
    axes = {"body.shape.1.center": lengths, "launch.spin": spins}
    expected = tt.sweep(problem, axes, duration=0.3, workers=1)
    assert len(np.unique(expected["final_tilt"])) == 6
    (tmp_path / "stem.toml").write_text(problem.to_toml())
    written = ["body.shape.1.center=0.016:0.02:3", "launch.spin=40,100"]
    options = [part for text in written for part in ("--over", text)]
    run(
        tmp_path / "stem.toml",
        *options,
        "--duration",
        0.3,
        "--workers",
        1,
        "--out",
        tmp_path / "a.zarr",
        "--no-maps",
    )
    (tmp_path / "sweep.toml").write_text(
        'problem = "stem.toml"\nduration = 0.3\n[over]\n'
        '"body.shape.1.center" = { from = 0.016, to = 0.02, count = 3 }\n'
        "launch.spin = [40.0, 100.0]\n"
    )
    run(tmp_path / "sweep.toml", "--workers", 1, "--out", tmp_path / "b.zarr", "--no-maps")
    for name in ("a.zarr", "b.zarr"):
        found = xr.open_zarr(tmp_path / name)
        assert found["center"].values == pytest.approx(lengths)
        assert found["center"].attrs["units"] == "m"
        for metric in ("final_tilt", "final_spin", "energy_lost"):
            assert found[metric].values == pytest.approx(expected[metric].values, rel=1e-10), (
                name,
                metric,
            )


@pytest.mark.parametrize("name", ["x.txt", "x", "x.zarr.nc"])
def test_the_name_of_a_store_ends_in_zarr(tmp_path, name):
    with pytest.raises(InvalidInput, match=r"is not a file name that ends in \.zarr"):
        run(*AXES, *SHORT, "--out", tmp_path / name)
    assert list(tmp_path.iterdir()) == []


UNREADABLE = {
    "--over": [
        "launch.spin",
        "launch.spin=",
        "launch.spin=1:2",
        "launch.spin=1:2:x",
        "launch.spin=1,b",
    ],
    "--draw": ["launch.spin", "launch.spin=1", "launch.spin=1:2:lin", "launch.spin=1:x"],
}


@pytest.mark.parametrize(
    ("arguments", "field"),
    [
        ([], "--over"),
        (["--over", "launch.spn=1,2"], "launch.spn"),
        *(([word, text], word) for word, texts in UNREADABLE.items() for text in texts),
        (["--over", "launch.spin=1:2:3:geo"], "over.launch.spin.spacing"),
        (["--over", "launch.spin=1:2:0"], "over.launch.spin.count"),
        (["--over", "launch.spin=nan,1"], "--over"),
        (["--over", "launch.spin=1:1:3"], "over.launch.spin"),
        (["--over", "launch.spin=1,2", "--over", "launch.spin=3,4"], "over"),
        (["--draw", "launch.spin=0:1:log", "--count", "3"], "draw.launch.spin"),
        (["--draw", "launch.spin=1:2"], "--count"),
        (["--draw", "launch.spin=1:2", "--over", "friction.mu=1,2"], "--draw"),
        ([*AXES, "--resume", "--force"], "--force"),
        ([*AXES, "--workers", "0"], "workers"),
        ([*AXES, "--duration", "0"], "duration"),
        ([*AXES, "--settled", "1"], "settled"),
        ([*AXES, "--count", "5"], "--count"),
        ([*AXES, "--seed", "5"], "--seed"),
        (["--draw", "launch.spin=1:2", "--count", "3", "--seed", "-1"], "seed"),
    ],
)
def test_misuse_is_refused_by_what_is_wrong(tmp_path, arguments, field):
    count = ["--count", "3"] if arguments and arguments[0] == "--draw" and field == "--draw" else []
    with pytest.raises(InvalidInput) as refusal:
        run(*arguments, *count, "--out", tmp_path / "a.zarr")
    assert refusal.value.field == field


def test_a_foreign_picture_is_not_overwritten(tmp_path):
    (tmp_path / "a.flights.png").write_text("a holiday")
    with pytest.raises(FileTrouble, match=r"a\.flights\.png exists"):
        run(*AXES, *SHORT, "--out", tmp_path / "a.zarr")
    assert [path.name for path in tmp_path.iterdir()] == ["a.flights.png"]
    run(*AXES, *SHORT, "--out", tmp_path / "a.zarr", "--force")
    run("--out", tmp_path / "a.zarr", "--resume")
    assert (tmp_path / "a.flights.png").read_bytes().startswith(b"\x89PNG")


def test_a_store_is_not_overwritten_or_mixed_with_another(tmp_path):
    out = tmp_path / "a.zarr"
    run(*AXES, *SHORT, "--out", out, "--no-maps")
    with pytest.raises(
        FileTrouble, match=r"a\.zarr exists; it is finished with .*, and overwritten only"
    ):
        run(*AXES, *SHORT, "--out", out)
    with pytest.raises(FileTrouble, match=r"problem\.friction\.mu is 0\.3 in it, and 0\.9 here"):
        run("--mu", 0.9, "--resume", "--out", out)
    run(*AXES, *SHORT, "--mu", 0.9, "--force", "--out", out, "--no-maps")


def test_messages_name_options_at_the_command_line_and_arguments_in_python(
    tmp_path, monkeypatch, capsys
):
    out = tmp_path / "a.zarr"
    run(*AXES, *SHORT, "--out", out, "--no-maps")
    problem = report_problem()
    for options, wanted in (
        ([*AXES], "a.zarr exists; it is finished with --resume, and overwritten only with --force"),
        (["--mu", "0.9", "--resume"], "choose another --out, or start afresh with --force"),
    ):
        monkeypatch.setattr(sys, "argv", ["tippetop", "sweep", *options, *SHORT, "--out", str(out)])
        with pytest.raises(SystemExit) as ended:
            commands.run()
        assert ended.value.code == 2
        assert wanted in capsys.readouterr().err
    over = {"launch.spin": [1.0]}
    with pytest.raises(
        FileTrouble, match="with resume=True, and overwritten only with overwrite=True"
    ):
        tt.sweep(problem, over, out=out)
    with pytest.raises(
        FileTrouble, match="choose another out, or start afresh with overwrite=True"
    ):
        tt.sweep(problem, over, out=out, resume=True)
    package = Path(tt.__file__).parent
    for file in package.rglob("*.py"):
        if "cli" not in file.parts:
            assert not re.search(
                r"--(force|resume|out)(?![-\w])", file.read_text(encoding="utf-8")
            ), file


@pytest.mark.parametrize("name", ["x" * 300, "x" * 250])
@pytest.mark.parametrize("options", [AXES, [*AXES, "--no-maps"], [*AXES, "--force"], ["--resume"]])
def test_names_that_no_file_can_have_are_told_in_a_sentence(tmp_path, name, options):
    with pytest.raises(FileTrouble, match=r"cannot be (written|read)"):
        run(*options, *SHORT, "--out", tmp_path / f"{name}.zarr")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    "text",
    [
        "[over]\nself = [1]",
        "self = 1\nduration = 1.0",
        "[over]\n" + 1000 * "a." + "b = [1]",
        "a = " + 5000 * "[",
    ],
)
def test_files_that_hold_no_sweep_are_refused_in_a_sentence(tmp_path, text):
    (tmp_path / "sweep.toml").write_text('problem = "top.toml"\n' + text)
    (tmp_path / "top.toml").write_text(report_problem().to_toml())
    with pytest.raises(InvalidInput) as refusal:
        run(tmp_path / "sweep.toml", "--out", tmp_path / "a.zarr")
    assert len(str(refusal.value)) < 1000
    assert not (tmp_path / "a.zarr").exists()


INTERRUPTED = """
import typer
from tippetop.cli.sweep import sweep
if __name__ == "__main__":
    app = typer.Typer()
    app.command()(sweep)
    app()
"""


@posix_only
@pytest.mark.parametrize("workers", among([1, 2], check=1))
def test_ctrl_c_leaves_a_line_and_a_store_that_resumes(tmp_path, workers):
    script, out = tmp_path / "run.py", tmp_path / "a.zarr"
    script.write_text(INTERRUPTED)
    options = ["--over", "launch.spin=1:250:60", "--over", "friction.mu=0.1:1:100", "--no-maps"]
    options += ["--duration", "1"]
    command = [sys.executable, script, *options, "--workers", str(workers), "--out", out]
    with started(command) as process:
        wait_for_a_task(out, process)
        os.killpg(process.pid, signal.SIGINT)
        _, said, code = ended(process)
    assert code == 130
    assert "interrupted" in said
    assert "--resume" in said
    assert "Traceback" not in said
    assert 0 < len(Store.resume(out).remaining()) < len(Store.resume(out).sweep.tasks)


def test_fields_are_drawn_from_distributions_with_units(tmp_path):
    options = ("--count", 40, "--duration", 0.01, "--workers", 1, "--no-maps")
    drawn = "launch.spin=norm:loc=1500rpm:scale=5"
    run("--draw", drawn, *options, "--seed", 3, "--out", tmp_path / "a.zarr")
    same_draws = tt.sweep(
        tt.presets.report_problem(),
        draw={"launch.spin": {"distribution": "norm", "loc": "1500 rpm", "scale": 5.0}},
        count=40,
        seed=3,
        duration=0.01,
        workers=1,
    )
    spins = tt.read_sweep(tmp_path / "a.zarr")["spin"].values
    assert spins.tolist() == same_draws["spin"].values.tolist()
    assert abs(spins.mean() - 50.0 * np.pi) < 5.0 * 5.0 / np.sqrt(40)


@pytest.mark.parametrize(
    "draw", ["launch.spin=norm:loc", "launch.spin=norm:loc=a", "launch.spin=gaussian:loc=3"]
)
def test_a_distribution_that_is_none_is_refused(tmp_path, draw):
    with pytest.raises(InvalidInput):
        run("--draw", draw, "--count", 3, "--out", tmp_path / "a.zarr")
    assert not list(tmp_path.iterdir())


def test_trajectories_are_kept_by_an_option(tmp_path):
    kept = ("--keep", "tilt", "--keep", "axis", "--keep", "x", "--keep", "events")
    counts = ("--samples", 5, "--most-events", 3)
    run(*AXES, *SHORT, *kept, *counts, "--out", tmp_path / "a.zarr", "--no-maps")
    found = tt.read_sweep(tmp_path / "a.zarr")
    assert found["event_time"].shape == (3, 2, 3)
    assert (found["event_count"] == 3 * found["flights"]).all()
    assert (found["x"].values[:, :, 0] == 0.0).all()
    assert found["axis"].shape == (3, 2, 5, 3)
    assert found["tilt"].values[:, :, 0] == pytest.approx(np.ones((3, 2)))
    run("--resume", "--out", tmp_path / "a.zarr", "--no-maps")
