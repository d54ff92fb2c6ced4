"""`tippetop reproduce`: the report redone, with a verdict on each of its claims."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from tippetop.cli.options import Force, Json
from tippetop.cli.terminal import listing, show, show_json
from tippetop.support.progress_bar import progress_bar

if TYPE_CHECKING:
    from tippetop.report.reproduce import Reproduction

_STYLES = {"reproduced": "green", "upheld": "yellow", "explained": "blue", "corrected": "magenta"}


def reproduce(
    out: Annotated[Path, typer.Option(help="Folder to write into.")] = Path("tippetop-report"),
    only: Annotated[
        str | None,
        typer.Option(metavar="ID", help="Redo one figure (fig06) or claim (fig05-flip-time) only."),
    ] = None,
    quick: Annotated[
        bool, typer.Option("--quick", help="Coarser sweeps: a check, not for quoting.")
    ] = False,
    force: Force = False,
    as_json: Json = False,
) -> None:
    """Redo the report "The Dynamics of Tippe Top and Numerical Simulation", a student's project.

    Writes its figures, their data, and a verdict on every claim.
    """
    from tippetop.report import reproduce as report  # noqa: PLC0415 - slow to import

    with progress_bar("starting") as progress:
        result = report.reproduce(out, only=only, quick=quick, overwrite=force, progress=progress)
    if as_json:
        show_json(_plain(result))
    else:
        _show(result)


def _plain(result: "Reproduction") -> dict[str, object]:
    """Return the result as plain data."""
    return {
        "folder": str(result.folder),
        "page": str(result.folder / "index.html"),
        "quick": result.quick,
        "seconds": round(result.seconds, 2),
        "figures": list(result.figures),
        "counts": result.counts,
        "counts_of_others": result.counts_of_others,
        "claims": [judgement.record() for judgement in result.judgements],
    }


def _show(result: "Reproduction") -> None:
    """Print the result."""
    from tippetop.report.claim import in_words  # noqa: PLC0415 - slow to import
    from tippetop.report.page import worded  # noqa: PLC0415 - slow to import

    headings = ("claim", "reported", "report's method", "converged", "verdict")
    rows = []
    for claim in map(worded, result.judgements):
        verdict = f"[{_STYLES[claim['verdict']]}]{claim['verdict']}[/]"
        rows.append((claim["id"], claim["reported"], claim["listing"], claim["converged"], verdict))
    quick = " (quick run: coarse, not for quoting)" if result.quick else ""
    show(
        *([listing(None, headings, rows, words=headings)] if rows else []),
        f"{len(result.figures)} figures{quick}",
        f"statements of the report: {in_words(result.counts)}",
        f"statements of others: {in_words(result.counts_of_others)}",
        files=[result.folder / "index.html"],
    )
