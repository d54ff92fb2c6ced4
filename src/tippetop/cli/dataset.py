"""`tippetop dataset`: many runs of random problems, for those who learn from motion."""

from pathlib import Path
from typing import Annotated

import typer

from tippetop.cli.options import NUMBER, Force, Json, number_of, number_option
from tippetop.cli.terminal import show, show_json
from tippetop.support.files import require_ending
from tippetop.support.progress_bar import progress_bar


def dataset(
    out: Annotated[Path, typer.Option(help="Zarr store to write: .zarr.")],
    count: Annotated[int, number_option(int, "Number of problems.")] = 20_000,
    seed: Annotated[int, number_option(int, "Seed of the random numbers.")] = 0,
    duration: Annotated[
        str, typer.Option(metavar=NUMBER, help="Length of every run, s, or as in '4 s'.")
    ] = "4",
    samples: Annotated[int, number_option(int, "Number of equal times of the states.")] = 200,
    workers: Annotated[
        int | None, number_option(int, "Number of processes; by default all processors.")
    ] = None,
    force: Force = False,
    as_json: Json = False,
) -> None:
    """Write runs of random problems as a data set: states, modes, events and derivatives.

    Problems are of six families, with parts for training, validation and test. A data card is
    written beside the store. The same seed gives the same bytes.
    """
    from tippetop.engines.dataset import write_dataset  # noqa: PLC0415 - slow to import

    require_ending("--out", out, (".zarr",))
    seconds = number_of("--duration", duration, "s")
    with progress_bar("simulating") as progress:
        place = write_dataset(
            out,
            count,
            seed,
            duration=seconds,
            samples=samples,
            overwrite=force,
            workers=workers,
            progress=progress,
        )
    card = place.with_suffix(".md")
    if as_json:
        show_json({"out": str(place), "card": str(card), "count": count, "seed": seed})
    else:
        show(f"{count:,} problems of seed {seed}.", files=[place, card])
