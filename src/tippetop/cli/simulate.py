"""`tippetop simulate`: one run, its summary, its files."""

import json
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from tippetop.cli.options import (
    Changes,
    Force,
    Json,
    LiftOff,
    Mu,
    Preset,
    ProblemFile,
    Spin,
    Tilt,
    chosen_problem,
)

if TYPE_CHECKING:
    import xarray as xr

    from tippetop.problem import Problem

DEFAULT_SAMPLES = 2001
ENDINGS = {
    "plot": [".png", ".svg", ".pdf"],
    "csv": [".csv"],
    "glb": [".glb"],
    "html": [".html", ".htm"],
    "mp4": [".mp4"],
    "gif": [".gif"],
}
"""How the names of the files of each kind may end."""


def simulate(
    file: ProblemFile = None,
    preset: Preset = None,
    spin: Spin = None,
    tilt: Tilt = None,
    mu: Mu = None,
    liftoff: LiftOff = None,
    changes: Changes = None,
    duration: Annotated[float, typer.Option(help="Length of the run, s.")] = 20.0,
    samples: Annotated[
        int | None, typer.Option(help="Number of samples; 2001, or what a moving picture needs.")
    ] = None,
    integrator: Annotated[
        str | None, typer.Option(help="taylor, dop853, rk45, radau, bdf, lsoda or rk4; the best installed.")
    ] = None,
    tolerance: Annotated[float | None, typer.Option(help="Relative error per step.")] = None,
    step: Annotated[float | None, typer.Option(help="Step of rk4, s.")] = None,
    out: Annotated[Path | None, typer.Option(help="Write the run as NetCDF.")] = None,
    plot: Annotated[Path | None, typer.Option(help="Draw the run as .png, .svg or .pdf.")] = None,
    csv: Annotated[Path | None, typer.Option(help="Write every variable as CSV.")] = None,
    glb: Annotated[Path | None, typer.Option(help="Write the moving top as an animated .glb.")] = None,
    html: Annotated[Path | None, typer.Option(help="Write a page that plays the run offline.")] = None,
    mp4: Annotated[Path | None, typer.Option(help="Write a film; needs ffmpeg.")] = None,
    gif: Annotated[Path | None, typer.Option(help="Write a film as an animated picture.")] = None,
    as_json: Json = False,
    force: Force = False,
) -> None:
    """Simulate one launch and say what becomes of the top."""
    from tippetop.files import place_for, written_beside  # noqa: PLC0415
    from tippetop.netcdf import write_run  # noqa: PLC0415 - slow to import
    from tippetop.simulate import simulate as run_problem  # noqa: PLC0415
    from tippetop.summary import summarize  # noqa: PLC0415

    settings = {"launch.spin": spin, "launch.tilt": tilt, "friction.mu": mu, "contact.liftoff": liftoff}
    chosen = chosen_problem(file, preset, settings, changes)
    moving = {"glb": glb, "html": html, "mp4": mp4, "gif": gif}
    files = {"out": out, "plot": plot, "csv": csv, **moving}
    wanted = {kind: path for kind, path in files.items() if path is not None}
    _check_names(wanted)
    for path in wanted.values():
        place_for(path, force)
    if mp4 is not None:
        from tippetop.export.movie import ffmpeg  # noqa: PLC0415 - slow to import

        ffmpeg()
    if samples is None:
        samples = _samples(chosen, duration) if any(moving.values()) else DEFAULT_SAMPLES
    began = time.perf_counter()
    run = run_problem(
        chosen, duration, samples=samples, integrator=integrator, tolerance=tolerance, step=step
    )
    elapsed = time.perf_counter() - began
    if out is not None:
        write_run(run, out, overwrite=force)
    if plot is not None:
        from tippetop.figures.overview import overview  # noqa: PLC0415 - slow to import
        from tippetop.figures.style import save  # noqa: PLC0415

        with written_beside(plot, force) as beside:
            save(overview(run), beside)
    for kind in wanted:
        _export(run, kind, wanted[kind], force)
    summary = summarize(run)
    if as_json:
        written = {kind: path and str(path) for kind, path in files.items()}
        typer.echo(json.dumps({**summary, **written, "problem": chosen.model_dump()}, indent=2))
    else:
        _print_summary(summary, elapsed, list(wanted.values()))


def _samples(problem: "Problem", duration: float) -> int:
    """How many samples a run that is to be played is given where nobody says."""
    from tippetop.export.track import sample_count  # noqa: PLC0415 - slow to import

    return max(DEFAULT_SAMPLES, sample_count(problem, duration))


def _export(run: "xr.Dataset", kind: str, path: Path, force: bool) -> None:
    """Write one of the moving pictures or the table of a run."""
    match kind:
        case "csv":
            from tippetop.export.csv import write_csv  # noqa: PLC0415

            write_csv(run, path, overwrite=force)
        case "glb":
            from tippetop.export.glb import write_glb  # noqa: PLC0415

            write_glb(run, path, overwrite=force)
        case "html":
            from tippetop.export.html import write_html  # noqa: PLC0415

            write_html(run, path, overwrite=force)
        case "mp4" | "gif":
            from tippetop.export.movie import write_movie  # noqa: PLC0415

            with _progress(f"drawing {path.name}") as watcher:
                write_movie(run, path, overwrite=force, watcher=watcher)


@contextmanager
def _progress(what: str) -> Iterator[Callable[[int, int], None]]:
    """A watcher that shows on a terminal how far something is, and how long it still takes."""
    from rich.console import Console  # noqa: PLC0415
    from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn  # noqa: PLC0415
    from rich.progress import TimeRemainingColumn as TimeLeft  # noqa: PLC0415

    columns = (TextColumn(what), BarColumn(), TaskProgressColumn(), TimeLeft())
    silent = not sys.stderr.isatty()
    with Progress(*columns, console=Console(stderr=True), disable=silent, transient=True) as bar:
        shown = bar.add_task(what)
        yield lambda done, count: bar.update(shown, total=count, completed=done)


def _check_names(wanted: dict[str, Path]) -> None:
    """Refuse names that promise another kind of file, or that are given twice."""
    from tippetop.errors import InvalidInput  # noqa: PLC0415

    taken: dict[Path, str] = {}
    for kind, path in wanted.items():
        endings = ENDINGS.get(kind)
        if endings and path.suffix.lower() not in endings:
            raise InvalidInput(f"--{kind}", str(path), f"a file name that ends in {' or '.join(endings)}")
        if path.resolve() in taken:
            raise InvalidInput(f"--{kind}", str(path), f"a file other than that of --{taken[path.resolve()]}")
        taken[path.resolve()] = kind


def _print_summary(summary: dict[str, Any], elapsed: float, files: list[Path]) -> None:
    from rich.console import Console  # noqa: PLC0415
    from rich.table import Table  # noqa: PLC0415

    console = Console()
    table = Table(box=None, show_header=False, padding=(0, 2, 0, 0))
    table.add_column(style="dim")
    table.add_column(justify="right", style="bold")
    table.add_column()
    for name, value, unit in _rows(summary):
        table.add_row(name, value, unit)
    console.print(f"[bold]{summary['outcome'].replace('_', ' ')}[/]: {summary['advice']}")
    console.print(table)
    console.print(
        f"[dim]{summary['steps']} steps of {summary['integrator']} in {elapsed:.3g} s[/]", highlight=False
    )
    for path in files:
        console.print(f"wrote {path}", highlight=False)


def _rows(summary: dict[str, Any]) -> list[tuple[str, str, str]]:
    final = summary["final"]
    rows = [
        ("simulated", f"{summary['duration']:.6g}", "s"),
        ("final tilt", _shown(final["theta"]), "rad"),
        ("final axial spin", _shown(final["omega3"]), "rad/s"),
        ("final precession", _shown(final["phi_dot"]), "rad/s"),
        ("turns over at", _shown(summary["turns_over"], "never"), "s" if summary["turns_over"] else ""),
        ("within 0.01 rad of its final tilt at", _shown(summary["arrives"]), "s"),
        ("least normal force", _shown(summary["least_normal_force"]), "N"),
        ("energy lost", _shown(summary["energy_lost"]), f"J of {summary['energy_start']:.6g}"),
        ("drift of Jellett's integral", f"{summary['jellett_drift']:.1e}", "relative"),
        ("error of the energy balance", f"{summary['energy_error']:.1e}", "relative"),
    ]
    lift_offs = [event["time"] for event in summary["events"] if event["kind"] == "lift-off"]
    if lift_offs:
        rows.append(("leaves the table first at", _shown(lift_offs[0]), "s"))
    if summary["flights"]:
        rows += [
            ("flights", str(summary["flights"]), ""),
            ("airborne for", _shown(summary["airborne_time"]), "s"),
            ("highest above the table", _shown(summary["highest_gap"]), "m"),
            ("energy lost in impacts", _shown(summary["impact_energy_lost"]), "J"),
        ]
    return rows


def _shown(value: float | None, otherwise: str = "undefined") -> str:
    return otherwise if value is None else f"{value:.7g}"
