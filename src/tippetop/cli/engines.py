"""`tippetop engines`: errors of other programs on the reference problems."""

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from tippetop.cli.options import DRAWINGS, Force, Json, write_figure
from tippetop.cli.terminal import listing, progress_bar, show, show_json
from tippetop.support.files import place_for, require_ending

if TYPE_CHECKING:
    from collections.abc import Mapping

    from tippetop.engines.comparison import EngineVerdict


def engines(
    out: Annotated[
        Path, typer.Option(help="Folder for results; runs that it has are not repeated.")
    ] = Path("tippetop-engines"),
    engine: Annotated[
        list[str] | None,
        typer.Option(help="Only this program: moreau, mujoco, pybullet, drake or exudyn."),
    ] = None,
    case: Annotated[list[str] | None, typer.Option(help="Only this case of the suite.")] = None,
    step: Annotated[list[float] | None, typer.Option(help="Only this step, s.")] = None,
    stored: Annotated[
        bool, typer.Option("--stored", help="Run nothing: show the results of the package.")
    ] = False,
    plot: Annotated[Path | None, typer.Option(help="Draw errors: .png, .svg or .pdf.")] = None,
    as_json: Json = False,
    force: Force = False,
) -> None:
    """Run the reference problems in other programs, and show their errors.

    Programs that are not installed are omitted. Without any, the stored results are shown.
    """
    from tippetop.engines import comparison  # noqa: PLC0415 - slow to import

    if plot is not None:
        require_ending("--plot", plot, DRAWINGS)
        place_for(plot, force)
    list(comparison.tasks(engine, case))
    installed = comparison.installed(engine)
    others = [name for name in installed if name != "moreau"]
    remark = ""
    if stored or not (others or engine == ["moreau"]):
        results = comparison.stored()
        if not stored:
            remark = (
                "None of the programs is installed; these are the stored results. Install them"
                " with: pip install 'tippetop[engines]'"
            )
    else:
        steps = step or comparison.STEPS
        with progress_bar("starting") as progress:
            results = comparison.compare(out, installed, case, steps, progress=progress)
    verdicts = comparison.verdicts(results)
    if plot is not None:
        from tippetop.figures.engines import errors_figure  # noqa: PLC0415 - slow to import

        write_figure(errors_figure(results), plot, force)
    if as_json:
        shown = [verdict._asdict() for verdict in verdicts]
        show_json({"remark": remark, "results": results, "best": shown})
    else:
        parts = ([remark] if remark else []) + [_table(verdicts), _versions(results)]
        show(*parts, files=[plot] if plot else [])


def _versions(results: "Mapping[str, Any]") -> str:
    versions = (f"{one['engine']} {one['version']} ({one['date']})" for one in results.values())
    return f"[dim]{'; '.join(versions)}[/]"


def _table(verdicts: "list[EngineVerdict]") -> Any:
    headings = (
        *("case", "program", "setting", "step (ms)", "early error", "order", "holds until (s)"),
        *("turns over (s)", "exactly", "energy error", "us a step"),
    )
    rows = [
        (
            one.case,
            one.engine,
            one.setting,
            f"{1e3 * one.step:.3g}",
            _digits(one.early_error),
            _digits(one.order),
            _digits(one.holds_until, 3),
            _digits(one.turns_over, 4),
            _digits(one.turns_over_exactly, 4),
            _digits(one.energy_error),
            f"{one.microseconds_per_step:.0f}",
        )
        for one in sorted(verdicts, key=lambda one: one.case)
    ]
    title = "Each program at its best setting and shortest step"
    return listing(title, headings, rows, words=("case", "program", "setting"))


def _digits(value: float, digits: int = 2) -> str:
    return "" if math.isnan(value) else f"{value:.{digits}g}"
