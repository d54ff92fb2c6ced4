"""`tippetop engines`: what other programs make of the reference problems."""

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from tippetop.cli.options import DRAWINGS, NUMBER, Force, Json, number_of, write_figure
from tippetop.cli.terminal import listing, show, show_json
from tippetop.support.files import place_for, require_ending
from tippetop.support.progress_bar import progress_bar

if TYPE_CHECKING:
    from collections.abc import Mapping

    from tippetop.engines.comparison import EngineVerdict


def engines(
    out: Annotated[
        Path, typer.Option(help="Folder for results; what it has is not run again.")
    ] = Path("tippetop-engines"),
    engine: Annotated[
        list[str] | None,
        typer.Option(
            help=(
                "Only this program: moreau, mujoco, pybullet, drake, exudyn, rapier or newton; or"
                " your adapter in a file, my_engine.py."
            )
        ),
    ] = None,
    case: Annotated[list[str] | None, typer.Option(help="Only this case of the suite.")] = None,
    step: Annotated[
        list[str] | None,
        typer.Option(metavar=NUMBER, help="Only this step, s, or as in '1 ms'."),
    ] = None,
    stored: Annotated[
        bool, typer.Option("--stored", help="Run nothing: show the results of the package.")
    ] = False,
    plot: Annotated[Path | None, typer.Option(help="Draw errors: .png, .svg or .pdf.")] = None,
    as_json: Json = False,
    force: Force = False,
) -> None:
    """Run the reference problems in other programs, and say how far they are from the truth.

    Programs that are not installed are left out. Without any, the results of the package are shown.
    """
    from rich.markup import escape  # noqa: PLC0415 - slow to import

    from tippetop.engines import comparison  # noqa: PLC0415 - slow to import

    if plot is not None:
        require_ending("--plot", plot, DRAWINGS)
        place_for(plot, force)
    list(comparison.tasks(engine, case))
    steps = [number_of("--step", one, "s") or 0.0 for one in step or ()] or comparison.STEPS
    comparison.check_steps(steps)
    names = comparison.installed(engine)
    remark = ""
    installed_others = set(names) - {"moreau"}
    if stored or not (installed_others or engine == ["moreau"]):
        results = comparison.stored(engine)
        if not stored:
            remark = (
                "None of the programs is installed; these are the stored results. Install them"
                " with: pip install 'tippetop[engines]'"
            )
    else:
        with progress_bar("starting") as progress:
            results = comparison.compare(out, names, case, steps, progress=progress)
    best = comparison.verdicts(results)
    if plot is not None:
        from tippetop.figures.engines import errors_figure  # noqa: PLC0415 - slow to import

        write_figure(errors_figure(results), plot, force)
    if as_json:
        verdicts = [{**verdict._asdict(), "limit": verdict.limit._asdict()} for verdict in best]
        lost = comparison.dropped(results)
        show_json({"remark": remark, "results": results, "best": verdicts, "dropped": lost})
    else:
        tables = [_table(result, best) for result in results.values()]
        lost = [f"[dim]{escape(sentence)}.[/]" for sentence in comparison.dropped(results)]
        remarks = [escape(remark)] if remark else []
        show(*remarks, *tables, _LEGEND, *lost, files=[plot] if plot else [])


_LEGEND = (
    "[dim]Each case at the setting with the least error at the shortest step. The error is that of"
    " the axis, a unit vector, and of the angular velocity over its largest value. 1 % and 0.1 %:"
    " the steps from which on it is below, in ms. Limit: what the results converge to with shorter"
    " steps - the reference, friction regularized over a slip speed, or something as far off the"
    " reference as stated. us: processor time of a step, in microseconds.[/]"
)


def _table(result: "Mapping[str, Any]", best: "list[EngineVerdict]") -> Any:
    headings = ("case", "setting", "error", "order", "1 %", "0.1 %", "limit", "us")
    rows = [
        (
            one.case,
            one.setting,
            _digits(one.error),
            _digits(one.limit.order),
            _digits(1e3 * one.step_for_1_percent, 3),
            _digits(1e3 * one.step_for_0_1_percent, 3),
            limit_text(one),
            f"{one.microseconds_per_step:.0f}",
        )
        for one in best
        if one.engine == result["engine"]
    ]
    title = f"{result['engine']} {result['version']} ({result['date']})"
    return listing(title, headings, rows, words=("case", "setting", "limit"))


def limit_text(one: "EngineVerdict") -> str:
    """Return in a few words what a program converges to in a case."""
    match one.limit.law:
        case "reference":
            return "reference"
        case "regularized":
            return f"{_digits(one.limit.width)} m/s"
        case "different":
            return f"off {_digits(one.limit.model_error)}"
    return "none seen"


def _digits(value: float, digits: int = 2) -> str:
    return "" if math.isnan(value) else f"{value:.{digits}g}"
