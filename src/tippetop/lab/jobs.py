"""What the worker processes of the laboratory do: a run for the page, or a file of it."""

from pathlib import Path

import xarray as xr

from tippetop.export.csv import write_csv
from tippetop.export.glb import write_glb
from tippetop.export.html import write_html
from tippetop.export.track import pack_run, sample_count
from tippetop.lab.setup import Setup, first_setup
from tippetop.netcdf import write_run
from tippetop.run import simulate

PHASES = 4000
"""Slides and flights a run on the page may go through."""

_WRITERS = {"nc": write_run, "csv": write_csv, "glb": write_glb, "html": write_html}
KINDS = ("nc", "csv", "toml", "glb", "html")
"""The files there are of a run, by their suffix."""


def run_of(setup: Setup) -> xr.Dataset:
    """The run of a launch, with samples enough to play it at any speed."""
    count = sample_count(setup.problem, setup.duration)
    return simulate(setup.problem, setup.duration, samples=count, phase_limit=PHASES)


def track_of(setup: Setup) -> bytes:
    """The run of a launch as the player takes it."""
    return pack_run(run_of(setup))


def file_of(setup: Setup, kind: str, folder: Path) -> bytes:
    """The run of a launch as a file of one of the `KINDS`, written in a folder that the caller removes."""
    if kind == "toml":
        return setup.problem.to_toml().encode()
    return _WRITERS[kind](run_of(setup), folder / f"run.{kind}").read_bytes()


def warm_up() -> None:
    """Load the libraries and compile the equations: then a worker's first run is as fast as the next."""
    track_of(first_setup().changed({"duration": 0.1}))
