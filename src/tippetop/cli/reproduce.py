"""`tippetop reproduce`: redo the report, and say what became of its claims."""

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from tippetop.cli.options import Force, Json
from tippetop.interrupts import hear

if TYPE_CHECKING:
    from rich.console import Console

    from tippetop.report.reproduce import Reproduction

_STYLES = {"reproduced": "green", "upheld": "yellow", "explained": "blue", "corrected": "magenta"}


def reproduce(
    out: Annotated[Path, typer.Option(help="Folder to write into.")] = Path("tippetop-report"),
    only: Annotated[
        str | None,
        typer.Option(metavar="ID", help="Redo one figure (fig06) or claim (fig05-flip-time) only."),
    ] = None,
    quick: Annotated[bool, typer.Option("--quick", help="Coarser sweeps: a check, not for quoting.")] = False,
    force: Force = False,
    as_json: Json = False,
) -> None:
    """Redo the report: its figures, the data behind them, and a verdict on every claim."""
    from rich.console import Console  # noqa: PLC0415 - slow to import
    from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn  # noqa: PLC0415
    from rich.progress import TimeRemainingColumn as TimeLeft  # noqa: PLC0415

    from tippetop.report import reproduce as report  # noqa: PLC0415

    console = Console(stderr=True)
    columns = (TextColumn("{task.description:<28}"), BarColumn(), TaskProgressColumn(), TimeLeft())
    with Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as bar:
        work = bar.add_task("starting", total=None)

        def advance(done: float, total: float, what: str) -> None:
            hear()
            bar.update(work, completed=done, total=total, description=what)

        result = report.reproduce(out, only=only, quick=quick, overwrite=force, progress=advance)
    if as_json:
        typer.echo(json.dumps(_plain(result), ensure_ascii=False, indent=2))
    else:
        _show(result, Console())


def _plain(result: "Reproduction") -> dict[str, object]:
    """The result for programs."""
    return {
        "folder": str(result.folder),
        "page": str(result.folder / "index.html"),
        "quick": result.quick,
        "seconds": round(result.seconds, 2),
        "figures": list(result.figures),
        "counts": result.counts,
        "claims": [judgement.record() for judgement in result.judgements],
    }


def _show(result: "Reproduction", console: "Console") -> None:
    """The result for people."""
    from rich.table import Table  # noqa: PLC0415 - slow to import

    from tippetop.report.page import worded  # noqa: PLC0415

    if result.judgements:
        table = Table(box=None, pad_edge=False)
        for heading in ("claim", "reported", "report's method", "converged", "verdict"):
            table.add_column(heading, overflow="fold")
        for judgement in result.judgements:
            words = worded(judgement)
            verdict = words["verdict"] or ""
            style = _STYLES[verdict]
            table.add_row(
                words["id"], words["reported"], words["listing"], words["converged"], f"[{style}]{verdict}[/]"
            )
        console.print(table)
    counts = ", ".join(f"{number} {name}" for name, number in result.counts.items())
    quick = " (quick run: coarse, not for quoting)" if result.quick else ""
    console.print(f"{len(result.figures)} figures; claims: {counts or 'none'}{quick}", highlight=False)
    console.print(f"{result.folder / 'index.html'}", highlight=False, soft_wrap=True)
