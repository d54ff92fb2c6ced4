"""File names that `tippetop simulate` refuses, before it runs and writes anything."""

import subprocess
import sys

import pytest


@pytest.mark.parametrize(
    ("arguments", "field"),
    [
        ("--out run.nc --csv run.txt", "--csv"),
        ("--plot run.nc", "--plot"),
        ("--gif run.mp4", "--gif"),
        ("--mp4 run", "--mp4"),
        ("--glb run.html", "--glb"),
        ("--html run.glb", "--html"),
        ("--out run.csv", "--out"),
        ("--csv run.csv --out run.csv", "--out"),
        ("--plot run.PNG --html ./run.png --force", "--html"),
    ],
)
def test_names_that_cannot_be_are_refused_before_anything_is_written(tmp_path, arguments, field):
    done = subprocess.run(
        [sys.executable, "-m", "tippetop", "simulate", *arguments.split()],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert (done.stdout, done.returncode) == ("", 2)
    assert done.stderr.startswith(f"tippetop: {field} = 'run")
    assert done.stderr.count("\n") == 1
    assert list(tmp_path.iterdir()) == []
