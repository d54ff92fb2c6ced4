"""`tippetop simulate`: one run, with a summary and its files."""

import math
import time
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

import tippetop as tt
from tippetop.cli.options import (
    DRAWINGS,
    NUMBER,
    Choice,
    Force,
    Json,
    number_of,
    number_option,
    of_a_problem,
    write_figure,
)
from tippetop.cli.terminal import facts, show, show_json
from tippetop.problem.problem import top_of
from tippetop.results.sample_counts import DEFAULT_SAMPLES, sample_count
from tippetop.results.time_digits import digits_left
from tippetop.support.errors import InvalidInput
from tippetop.support.files import place_for, refuse_ending_of_others, require_ending
from tippetop.support.progress_bar import progress_bar

if TYPE_CHECKING:
    import xarray as xr

FILMS = {"mp4", "gif"}
MOVING = {"glb", "html", *FILMS}
"""Kinds of files that show the motion, which needs enough samples."""

TABLES = {"events_table": "events", "flights_table": "flights"}
"""Tables of a run beside its samples, by the options that write them."""
ENDINGS = {
    "plot": DRAWINGS,
    "html": (".html", ".htm"),
    "csv": (".csv", ".xlsx"),
    **dict.fromkeys(TABLES, (".csv", ".xlsx", ".parquet")),
}
"""Accepted suffixes of files; other kinds, except `out`, have their name as suffix."""

ROWS = (
    ("simulated", "end_time", "s", ".6g", ""),
    ("final tilt", "tilt", "rad", ".7g", ""),
    ("final axial spin", "spin", "rad/s", ".7g", ""),
    ("final precession", "precession", "rad/s", ".7g", "undefined"),
    ("turns over at", "turnover_time", "s", ".7g", "not within the run"),
    ("first within 0.01 rad of its settled tilt at", "arrival_time", "s", ".7g", "not settled"),
    ("stays within 0.01 rad of it from", "settling_time", "s", ".7g", ""),
    ("largest tilt", "max_tilt_ever", "rad", ".7g", "may still rise"),
    ("least normal force", "min_normal_force", "N", ".7g", ""),
    ("energy at launch", "initial_energy", "J", ".6g", ""),
    ("energy lost", "energy_lost", "J", ".7g", ""),
    ("drift of Jellett's integral", "jellett_drift", "relative", ".1e", "undefined"),
    ("error of the energy balance", "energy_error", "relative", ".1e", "undefined"),
    ("leaves the table first at", "liftoff_time", "s", ".7g", ""),
)
"""Rows printed for a run: text, key of the summary, unit, format, and text for a missing value.

A row without a text for a missing value is then omitted.
"""

OF_THE_BALANCE = {"end_time", "initial_energy", "jellett_drift", "energy_error"}
"""Keys of the rows that are printed for a run whose numbers are not to be trusted."""

INACCURATE = 1
"""Exit code of a run whose numbers are not to be trusted."""

ROUNDING_OF_ENERGY = 1e-13
"""Energy, relative to that at launch, below which a loss is rounding: a balance is kept to less in
no run, and a real loss of one instant may be little more.
"""

USUAL_DIGITS = 7
"""Digits of a time that a minute change of the launch does not move."""

LOSS_ROWS = (
    ("of it to sliding", "energy_lost_sliding", "J", ".7g", ""),
    ("of it to drilling", "energy_lost_drilling", "J", ".7g", ""),
    ("of it to rolling resistance", "energy_lost_rolling", "J", ".7g", ""),
    ("of it to the air", "energy_lost_air", "J", ".7g", ""),
)
"""Further rows for a run that loses energy by drilling, by rolling resistance or to the air."""

FLIGHT_ROWS = (
    ("flights", "flights", "", ".7g", ""),
    ("airborne for", "airborne_time", "s", ".7g", ""),
    ("highest above the table", "max_gap", "m", ".7g", ""),
    ("energy lost in impacts", "energy_lost_impacts", "J", ".7g", ""),
)


@of_a_problem
def simulate(
    choice: Choice,
    duration: Annotated[
        str, typer.Option(metavar=NUMBER, help="Length of the run, s, or as in '2 min'.")
    ] = "20",
    samples: Annotated[
        int | None,
        number_option(
            int, f"Number of samples; by default {DEFAULT_SAMPLES}, or as many as a film needs."
        ),
    ] = None,
    integrator: Annotated[
        str | None,
        typer.Option(
            help=(
                "taylor, collocation, dop853, rk45, radau, bdf, lsoda, rk4; by default taylor, and"
                " collocation where friction is stiff."
            )
        ),
    ] = None,
    tolerance: Annotated[float | None, number_option(float, "Relative error per step.")] = None,
    step: Annotated[
        str | None, typer.Option(metavar=NUMBER, help="Step of rk4, s, or as in '1 ms'.")
    ] = None,
    out: Annotated[Path | None, typer.Option(help="Write the run as NetCDF.")] = None,
    plot: Annotated[Path | None, typer.Option(help="Draw the run as .png, .svg or .pdf.")] = None,
    csv: Annotated[
        Path | None,
        typer.Option(help="Write every variable as CSV, or as a workbook: .csv or .xlsx."),
    ] = None,
    parquet: Annotated[
        Path | None, typer.Option(help="Write every variable as Parquet; needs pyarrow.")
    ] = None,
    events_table: Annotated[
        Path | None, typer.Option(help="Write the events as .csv, .xlsx or .parquet.")
    ] = None,
    flights_table: Annotated[
        Path | None, typer.Option(help="Write the flights as .csv, .xlsx or .parquet.")
    ] = None,
    glb: Annotated[
        Path | None, typer.Option(help="Write the moving top as an animated .glb.")
    ] = None,
    html: Annotated[
        Path | None, typer.Option(help="Write a page that plays the run offline.")
    ] = None,
    mp4: Annotated[Path | None, typer.Option(help="Write a film; needs ffmpeg.")] = None,
    gif: Annotated[Path | None, typer.Option(help="Write a film as an animated picture.")] = None,
    as_json: Json = False,
    force: Force = False,
) -> None:
    """Simulate one launch, and describe the motion in words and numbers.

    The exit code is 1 if the numbers do not keep what the motion keeps, so that they tell nothing.
    """
    chosen, seconds = choice.problem(), number_of("--duration", duration, "s") or 0.0
    files = {
        "out": out,
        "plot": plot,
        "csv": csv,
        "parquet": parquet,
        "events_table": events_table,
        "flights_table": flights_table,
        "glb": glb,
        "html": html,
        "mp4": mp4,
        "gif": gif,
    }
    requested = {kind: path for kind, path in files.items() if path is not None}
    _check_files(requested, force, seconds)
    if samples is None:
        samples = _sample_count(chosen, seconds, requested)
    began = time.perf_counter()
    with progress_bar("simulating") as progress:
        run = tt.simulate(
            chosen,
            seconds,
            samples=samples,
            integrator=integrator,
            tolerance=tolerance,
            step=number_of("--step", step, "s"),
            callback=lambda part: progress(part, 1.0),
        )
    elapsed = time.perf_counter() - began
    for kind, path in requested.items():
        _write(run, kind, path, force)
    uncertainties = tt.time_uncertainties(run)
    account = tt.describe(run).rounded(uncertainties)
    summary = {**tt.summarize(run), "description": str(account), "uncertainties": uncertainties}
    is_inaccurate = summary["status"] == "inaccurate"
    if as_json:
        written = {kind: path and str(path) for kind, path in files.items()}
        show_json({**summary, **written, "problem": chosen.model_dump()})
    else:
        advice = f"{summary['status'].replace('_', ' ')}: {summary['message']}"
        show(
            summary["description"],
            *(() if summary["status"] == "completed" else (f"[bold]{advice}[/]",)),
            facts(_rows(summary, top_of(chosen).conserves_jellett)),
            f"[dim]{summary['steps']} steps of {summary['integrator']} in {elapsed:.3g} s[/]",
            files=requested.values(),
        )
    if is_inaccurate:
        raise typer.Exit(INACCURATE)


def _sample_count(problem: "tt.Problem", duration: float, requested: Iterable[str]) -> int:
    """Return the number of samples that the requested files need, at least the default."""
    if not (MOVING & set(requested) and math.isfinite(duration)):
        return DEFAULT_SAMPLES
    return max(DEFAULT_SAMPLES, sample_count(problem, duration))


def _write(run: "xr.Dataset", kind: str, path: Path, force: bool) -> None:
    """Write one of the files of a run."""
    match kind:
        case "out":
            tt.write_run(run, path, force)
        case "plot":
            write_figure(tt.plot(run), path, force)
        case "csv" | "parquet" | "events_table" | "flights_table":
            write = tt.write_parquet if path.suffix.lower() == ".parquet" else tt.write_csv
            write(run, path, force, table=TABLES.get(kind))
        case "glb":
            tt.write_glb(run, path, force)
        case "html":
            tt.write_html(run, path, force)
        case _:
            with progress_bar(f"drawing {path.name}") as progress:
                tt.write_movie(run, path, force, progress=progress)


def _check_files(requested: dict[str, Path], force: bool, duration: float) -> None:
    """Raise an error if a file cannot be written.

    Its suffix must fit, no two options may name one file, a file may be replaced only if `force`,
    and films, Parquet and workbooks need their programs.
    """
    places = dict[Path, str]()
    for kind, path in requested.items():
        option = f"--{kind.replace('_', '-')}"
        if kind != "out":
            require_ending(option, path, ENDINGS.get(kind, (f".{kind}",)))
        else:
            refuse_ending_of_others("--out", path)
        place = place_for(path, force)
        if place in places:
            raise InvalidInput(option, str(path), f"another file than that of {places[place]}")
        places[place] = option
        if path.suffix.lower() in (".parquet", ".xlsx"):
            from tippetop.export.tables import need_parquet, need_workbook  # noqa: PLC0415 - slow

            need_parquet() if path.suffix.lower() == ".parquet" else need_workbook()
        if kind in FILMS:
            from tippetop.export.movie import require_film  # noqa: PLC0415 - slow to import

            require_film(f".{kind}", duration)


def _rows(summary: dict[str, Any], jellett_conserved: bool) -> list[tuple[str, str, str]]:
    numbers = {**summary, **summary["final"]}
    resisted = any(summary[f"energy_lost_{part}"] for part in ("drilling", "rolling", "air"))
    shown = [*ROWS, *(LOSS_ROWS if resisted else ()), *(FLIGHT_ROWS if summary["flights"] else ())]
    if summary["status"] == "inaccurate":
        shown = [row for row in ROWS if row[1] in OF_THE_BALANCE]
    least = ROUNDING_OF_ENERGY * summary["initial_energy"]
    rows = []
    for text, key, unit, form, missing in shown:
        if key == "jellett_drift" and not jellett_conserved:
            continue
        value = numbers[key]
        if unit == "J" and value is not None and abs(value) < least:
            value = 0.0
        if value is not None and key in summary["uncertainties"]:
            digits = digits_left(value, summary["uncertainties"][key], USUAL_DIGITS)
            rows.append((text, f"{value:.{digits}g}" if digits else "chance decides", unit))
        elif value is not None:
            rows.append((text, format(value, form), unit))
        elif missing:
            rows.append((text, missing, ""))
    return rows
