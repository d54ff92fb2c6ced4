"""`tippetop sweep`: many launches in a store, with maps."""

from collections import Counter
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

import tippetop as tt
from tippetop.cli.options import (
    NUMBER,
    Choice,
    Force,
    Json,
    number_of,
    number_option,
    number_or_text,
    of_a_problem,
    write_figure,
)
from tippetop.cli.terminal import facts, show, show_json
from tippetop.support.errors import MISSING, Described, FileTrouble, InvalidInput, within_part
from tippetop.support.files import in_words, place_for, read_text, require_ending
from tippetop.support.interrupts import INTERRUPTED
from tippetop.support.progress_bar import progress_bar
from tippetop.support.units import NUMBER as NUMBER_WITH_UNIT
from tippetop.support.units import begins_a_unit

if TYPE_CHECKING:
    import numpy as np
    import xarray as xr
    from numpy.typing import NDArray

    from tippetop.sweeps import Progress, Sweep


SweepFile = Annotated[
    Path | None,
    typer.Argument(
        help="Sweep (.toml with over or draw), or problem; by default the report's top."
    ),
]
Axes = Annotated[
    list[str] | None,
    typer.Option(
        metavar="FIELD=VALUES",
        help=(
            "Sweep a field over values: FIRST:LAST:COUNT, FIRST:LAST:COUNT:log or A,B,C, in SI or"
            " with a unit, as in 0:2500rpm:51. Several cross."
        ),
    ),
]
Ranges = Annotated[
    list[str] | None,
    typer.Option(
        metavar="FIELD=LOW:HIGH",
        help=(
            "Draw a field at random instead, from a range; append :log for its logarithm. Or from a"
            " distribution of scipy.stats, as in launch.spin=norm:loc=150:scale=5."
        ),
    ),
]
Count = Annotated[int | None, number_option(int, "Number of draws.")]
Seed = Annotated[int | None, number_option(int, "Seed of the random numbers; 0 by default.")]
Duration = Annotated[
    str | None,
    typer.Option(metavar=NUMBER, help="Length of every run, s, or as in '2 min'; 20 by default."),
]
Tolerance = Annotated[
    float | None, number_option(float, "Relative error per step; 1e-9 by default.")
]
Settled = Annotated[
    str | None,
    typer.Option(
        metavar=NUMBER,
        help="End a run once its tilt cannot leave this distance, rad; by default none ends.",
    ),
]
Keep = Annotated[
    list[str] | None,
    typer.Option(
        metavar="VARIABLE",
        help=(
            "Keep samples of a variable over time, such as tilt or axis, or the events; may be"
            " repeated."
        ),
    ),
]
Samples = Annotated[
    int | None, number_option(int, "Number of samples that are kept of a run; 201 by default.")
]
MostEvents = Annotated[
    int | None,
    number_option(int, "Number of events that --keep events keeps of a run; 20 by default."),
]
Processes = Annotated[
    int | None, number_option(int, "Number of processes; by default all processors.")
]
Scheduler = Annotated[
    str | None,
    typer.Option(metavar="ADDRESS", help="Compute on a running dask.distributed cluster."),
]
Out = Annotated[Path, typer.Option(help="Zarr store to write: .zarr.")]
Resume = Annotated[bool, typer.Option("--resume", help="Finish an existing store.")]
Maps = Annotated[
    bool, typer.Option(show_default=False, help="Draw maps beside the store; the default.")
]


@partial(of_a_problem, file=SweepFile)
def sweep(
    choice: Choice,
    over: Axes = None,
    draw: Ranges = None,
    count: Count = None,
    seed: Seed = None,
    duration: Duration = None,
    tolerance: Tolerance = None,
    settled: Settled = None,
    keep: Keep = None,
    samples: Samples = None,
    most_events: MostEvents = None,
    workers: Processes = None,
    scheduler: Scheduler = None,
    out: Out = Path("sweep.zarr"),
    resume: Resume = False,
    maps: Maps = True,
    as_json: Json = False,
    force: Force = False,
) -> None:
    """Simulate many launches, over crossed fields or random draws, and count their outcomes."""
    from tippetop.sweeps import Sweep  # noqa: PLC0415 - slow to import
    from tippetop.sweeps.run_sweep import shown_by  # noqa: PLC0415
    from tippetop.sweeps.store_layout import refuse_existing, stored_sweep  # noqa: PLC0415

    if resume and force:
        raise InvalidInput(
            "--force",
            Described("beside --resume"),
            "one of the two",
            "would overwrite the store that is to be resumed",
        )
    with in_words(out, "read"):
        stored = stored_sweep(out) if resume and choice.file is None else None
    limits = {
        "duration": number_of("--duration", duration, "s"),
        "tolerance": tolerance,
        "settled": number_of("--settled", settled, "rad"),
        "keep": keep,
        "samples": samples,
        "most_events": most_events,
    }
    fields = _chosen_fields(choice, stored, _chosen_grid(over, draw, count, seed), limits)
    chosen = Sweep(**fields)
    if not resume:
        require_ending("--out", out, [".zarr"])
        refuse_existing(out, force)
    pictures = _map_files(out, chosen) if maps else {}
    for path in pictures.values():
        place_for(path, force or resume)
    progress: list[Progress] = []
    try:
        with progress_bar() as tell:
            show_progress = shown_by(tell)

            def callback(now: "Progress") -> None:
                progress.append(now)
                show_progress(now)

            tt.sweep(
                **fields,
                out=out,
                overwrite=force,
                resume=resume,
                workers=workers,
                scheduler=scheduler,
                callback=callback,
            )
        names = ["is_done", "outcome", "fault", *dict.fromkeys(["flights", *pictures])]
        dataset = tt.read_sweep(out, names, decode=False)
        _draw_maps(dataset, pictures, force or resume)
    except KeyboardInterrupt:
        done = f"{progress[-1].done:,} of {progress[-1].cells:,}" if progress else "none"
        typer.echo(
            f"tippetop: interrupted; {done} cells are in {out}: continue with --resume",
            err=True,
        )
        raise typer.Exit(INTERRUPTED) from None
    summary = {
        **_summary(dataset, progress[-1]),
        "refusal": _refusal(chosen, dataset["fault"].values),
    }
    if as_json:
        files = {"out": str(out), "maps": [str(path) for path in pictures.values()]}
        show_json({**summary, **files, "sweep": chosen.to_fields()})
    else:
        show(*_sentences(summary), files=[out, *pictures.values()])


def _chosen_fields(
    choice: Choice,
    stored: "Sweep | None",
    grid: dict[str, Any],
    limits: dict[str, Any],
) -> dict[str, Any]:
    """Return the fields of the sweep of the file, or of the store to be resumed, with the
    options.
    """
    from tippetop.sweeps import Sweep  # noqa: PLC0415 - slow to import

    file = choice.file
    base = Sweep.read(file) if file is not None and _holds_sweep(file) else stored
    stated = {name: limit for name, limit in limits.items() if limit is not None}
    if base is None:
        problem = choice.problem()
        if not {"over", "draw"} & set(grid):
            raise InvalidInput(
                "--over",
                MISSING,
                "a field, such as --over launch.spin=0:250:51, or --draw, or a sweep's file",
            )
        return {"problem": problem, **grid, **stated}
    fields = base.to_fields() | {"problem": choice.changed(base.problem)}
    if "samples" in stated:
        fields.pop("times", None)
    if grid:
        for name in ("over", "draw", "count", "seed"):
            fields.pop(name, None)
    return fields | grid | stated


def _chosen_grid(
    over: list[str] | None, draw: list[str] | None, count: int | None, seed: int | None
) -> dict[str, Any]:
    """Return what the options say of the launches, by the names of a sweep's fields."""
    from tippetop.sweeps.draws import columns_of  # noqa: PLC0415 - slow to import
    from tippetop.sweeps.grid import Product  # noqa: PLC0415

    if over and draw:
        raise InvalidInput("--draw", draw[0], "one of the two", "is given beside --over")
    for name, number in (("--count", count), ("--seed", seed)):
        if number is not None and not draw:
            raise InvalidInput(name, number, "", "is only for --draw", "omit it")
    if over:
        axes = [_axis(text) for text in over]
        try:
            return {"over": Product.of(axes)}
        except InvalidInput as error:
            raise _of_option("over", error) from None
    if draw:
        if count is None:
            raise InvalidInput("--count", MISSING, "the number of draws")
        columns = [_range(text) for text in draw]
        try:
            ranges = columns_of(columns)
        except InvalidInput as error:
            raise _of_option("draw", error) from None
        return {"draw": ranges, "count": count, "seed": seed or 0}
    return {}


def _of_option(option: str, error: InvalidInput) -> InvalidInput:
    """Return a refusal of a part of an option, or of all of it, by the option's name."""
    return error if error.field == option else within_part(error, option)


def _axis(text: str) -> tuple[str, Any]:
    """Return an axis of the command line in the form of a sweep's file."""
    field, equals, values = text.partition("=")
    try:
        match values.split(":"):
            case [numbers] if field and equals:
                return field.strip(), _numbers(numbers.split(","))
            case [first, last, count, *spacing] if field and equals and len(spacing) < 2:
                low, high = _numbers([first, last])
                axis: dict[str, Any] = {"from": low, "to": high, "count": int(count)}
                if spacing:
                    axis["spacing"] = spacing[0].strip()
                return field.strip(), axis
    except ValueError:
        pass
    raise InvalidInput(
        "--over", text, "FIELD=FIRST:LAST:COUNT, FIELD=FIRST:LAST:COUNT:log, or FIELD=A,B,C"
    )


def _range(text: str) -> tuple[str, Any]:
    """Return a draw of the command line in the form of a sweep's file."""
    field, equals, values = text.partition("=")
    name, *parameters = values.split(":")
    if field and equals and name.strip().isidentifier():
        return field.strip(), {"distribution": name.strip(), **_parameters(text, parameters)}
    low, _, high = values.removesuffix(":log").partition(":")
    spacing = "log" if values.endswith(":log") else "linear"
    try:
        if field and equals:
            first, last = _numbers([low, high])
            return field.strip(), {"from": first, "to": last, "spacing": spacing}
    except ValueError:
        pass
    raise InvalidInput("--draw", text, DRAWS)


DRAWS = "FIELD=LOW:HIGH, FIELD=LOW:HIGH:log, or FIELD=norm:loc=150:scale=5"


def _parameters(text: str, parameters: list[str]) -> dict[str, float | str]:
    """Return the parameters of a distribution of the command line, which may have units."""
    numbers: dict[str, float | str] = {}
    for parameter in parameters:
        name, equals, number = parameter.partition("=")
        if name.strip() in numbers:
            fault = f"has the parameter {name.strip()} twice"
            raise InvalidInput("--draw", text, "", fault, "write every parameter once")
        try:
            (numbers[name.strip()],) = _numbers([number]) if equals else []
        except ValueError:
            raise InvalidInput("--draw", text, DRAWS) from None
    return numbers


def _numbers(texts: list[str]) -> list[float | str]:
    """Return numbers, or texts of numbers with units; the last unit holds for those without one.

    Raises `ValueError` for other texts.
    """
    parts = [NUMBER_WITH_UNIT.fullmatch(text) for text in texts]
    pairs = [
        (part[1], part[2]) for part in parts if part and (not part[2] or begins_a_unit(part[2]))
    ]
    if len(pairs) < len(texts):
        raise ValueError(texts)
    last_unit = pairs[-1][1]
    numbers: list[float | str] = []
    for number, unit in pairs:
        unit_of_number = unit or last_unit
        numbers.append(f"{number} {unit_of_number}" if unit_of_number else number_or_text(number))
    return numbers


def _holds_sweep(file: Path) -> bool:
    """Return whether a file holds a sweep rather than a problem."""
    from tippetop.support.parsing import parse_toml  # noqa: PLC0415
    from tippetop.sweeps.definition import is_sweep  # noqa: PLC0415 - slow to import

    try:
        return file.suffix != ".json" and is_sweep(
            parse_toml(read_text(file, "a sweep or a problem"), "")
        )
    except (FileTrouble, ValueError):
        return False


def _map_files(out: Path, chosen: "Sweep") -> dict[str, Path]:
    """Return the files of the maps beside a store, by variable.

    Raises `InvalidInput` for axes that cannot be drawn.
    """
    from tippetop.figures.maps import MAPPED, require_drawable  # noqa: PLC0415 - slow to import
    from tippetop.sweeps.grid import field_paths  # noqa: PLC0415

    paths = field_paths(chosen.grid.fields, chosen.keep)
    coordinates = chosen.coordinates().items()
    require_drawable({paths.get(name, name): values for name, (_, values) in coordinates})
    return {name: out.with_name(f"{out.name.removesuffix('.zarr')}.{name}.png") for name in MAPPED}


def _draw_maps(dataset: "xr.Dataset", files: dict[str, Path], overwrite: bool) -> None:
    """Draw the maps beside a store."""
    from tippetop.figures.maps import phase_map  # noqa: PLC0415 - slow to import

    for name, path in files.items():
        write_figure(phase_map(dataset, name), path, overwrite)


def _summary(dataset: "xr.Dataset", progress: "Progress") -> dict[str, Any]:
    groups = Counter(int(value) for value in dataset["outcome"].values.ravel())
    return {
        "cells": progress.cells,
        "computed": progress.done - progress.before,
        "seconds": progress.elapsed,
        "launches_per_second": progress.rate,
        "outcomes": {
            outcome.name.lower(): groups[outcome] for outcome in tt.Outcome if groups[outcome]
        },
        "flights": int(dataset["flights"].where(dataset["flights"] >= 0, 0).sum()),
    }


def _refusal(sweep: "Sweep", faults: "NDArray[np.int8]") -> str | None:
    """Return the refusal of the first launch that is not valid; None if all are."""
    from tippetop.sweeps.cells import put, single_part  # noqa: PLC0415 - slow to import

    bad = faults.ravel().nonzero()[0][:1]
    try:
        if len(bad):
            single_part(put(sweep.problem, sweep.grid.values(bad)), 0)
    except InvalidInput as error:
        return str(error)
    return None


def _sentences(summary: dict[str, Any]) -> Iterator[Any]:
    from rich.markup import escape  # noqa: PLC0415 - slow to import

    rows = [(name.replace("_", " "), f"{number:,}") for name, number in summary["outcomes"].items()]
    if summary["flights"]:
        rows.append(("flights", f"{summary['flights']:,}"))
    yield f"[bold]{summary['cells']:,} launch{'' if summary['cells'] == 1 else 'es'}[/]"
    yield facts(rows)
    if summary["refusal"]:
        yield escape(f"The first launch that is not valid: {summary['refusal']}")
    yield (
        f"[dim]{summary['computed']:,} computed in {summary['seconds']:.3g} s, "
        f"{summary['launches_per_second']:,.0f} a second[/]"
    )
