"""File names that `tippetop simulate` refuses, before it runs and writes anything."""

import pytest

from misused import misused


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
        ("--parquet run.csv", "--parquet"),
        ("--events-table run.txt", "--events-table"),
        ("--events-table run.csv --flights-table ./run.csv", "--flights-table"),
        ("--out run.parquet", "--out"),
        ("--plot run.PNG --html ./run.png --force", "--html"),
    ],
)
def test_names_that_cannot_be_are_refused_before_anything_is_written(tmp_path, arguments, field):
    told = misused(tmp_path, "simulate", *arguments.split())
    assert told.startswith(f"tippetop: {field}: 'run")
    assert told.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


def test_a_film_that_would_be_too_long_is_refused_before_the_run_is_followed(tmp_path):
    told = misused(tmp_path, "simulate", "--duration", "4000", "--gif", "run.gif")
    assert told == "tippetop: --duration: 4000 is too long for a film (write at most 999.95 s)\n"
    assert list(tmp_path.iterdir()) == []
