"""`tippetop fit`: fit of numbers of a problem to data of a real top."""

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
    stated_value,
    write_figure,
)
from tippetop.cli.terminal import listing, show, show_json
from tippetop.support.errors import InvalidInput
from tippetop.support.files import place_for, require_ending
from tippetop.support.progress_bar import progress_bar

if TYPE_CHECKING:
    from tippetop.fit.fit_result import FitResult
    from tippetop.fit.search import FitProgress


@of_a_problem
def fit(
    choice: Choice,
    data: Annotated[Path, typer.Argument(help="Table of data: t and tilt, t, x and y, rpm, ...")],
    vary: Annotated[
        str,
        typer.Option(
            metavar="FIELDS",
            help="Fields to fit, with commas: friction.mu,launch.spin; or with ranges: "
            "friction.mu=0.1:0.5, or launch.spin='140rpm:160rpm'.",
        ),
    ] = "",
    noise: Annotated[
        str | None,
        typer.Option(
            help="Standard deviation of each column, in its unit or as in '0.3 mm', with commas."
        ),
    ] = None,
    view: Annotated[
        str | None, typer.Option(help="Where pictures were taken from: above or side.")
    ] = None,
    point: Annotated[str, typer.Option(help="What x and y are of: tip or center.")] = "tip",
    scale: Annotated[
        str | None, typer.Option(metavar=NUMBER, help="Metres a pixel, or as in '0.2 mm'.")
    ] = None,
    frame_rate: Annotated[float | None, number_option(float, "Pictures a second.")] = None,
    start: Annotated[
        str | None, typer.Option(metavar=NUMBER, help="Time of the launch in the data, s.")
    ] = None,
    y_down: Annotated[
        bool, typer.Option("--y-down", help="y grows downwards in pictures.")
    ] = False,
    track: Annotated[str | None, typer.Option(help="Track, of several in a file.")] = None,
    starts: Annotated[
        int | None,
        number_option(int, "Points that are followed to minima; 1: the problem's own, no scan."),
    ] = None,
    most_runs: Annotated[
        int | None, number_option(int, "Runs after which the search ends with its best fit.")
    ] = None,
    plot: Annotated[
        Path | None, typer.Option(help="Draw data and fit as .png, .svg or .pdf.")
    ] = None,
    out: Annotated[Path | None, typer.Option(help="Write the fitted problem as .toml.")] = None,
    as_json: Json = False,
    force: Force = False,
) -> None:
    """Fit numbers of a problem to data of a real top, and show them with their errors."""
    if not vary:
        raise InvalidInput("--vary", vary, "fields with commas, such as friction.mu,launch.spin")
    for option, path, endings in (("--plot", plot, DRAWINGS), ("--out", out, (".toml",))):
        if path is not None:
            require_ending(option, path, endings)
            place_for(path, force)
    noises = None if noise is None else [part.strip() for part in noise.split(",")]
    launches = tt.read_launches(data, choice.problem(), noise=noises)
    measurement: Any = launches or tt.read_measurement(
        data,
        view=view,  # type: ignore[arg-type]
        point=point,
        scale=scale if scale is None else stated_value(scale),
        noise=noises,
        frame_rate=frame_rate,
        start=number_of("--start", start, "s"),
        y_down=y_down,
        track=track,
    )
    with progress_bar() as tell:

        def callback(now: "FitProgress") -> None:
            tell(now.part, 1.0, f"{now.runs:,} runs, {now.part:.0%} of the data")

        limit: dict[str, Any] = {} if most_runs is None else {"most_runs": most_runs}
        subject: Any = launches or choice.problem()
        seen = None if launches else measurement
        result = tt.fit(subject, seen, _vary(vary), starts=starts, callback=callback, **limit)
    if plot is not None:
        from tippetop.figures.fits import plot_fit  # noqa: PLC0415 - slow to import

        write_figure(plot_fit(result), plot, force)
    if out is not None:
        result.problem.write(out, force)
    if as_json:
        show_json({**result.summary(), "plot": plot and str(plot), "out": out and str(out)})
        return
    show(*_lines(result), files=[path for path in (plot, out) if path is not None])


def _lines(result: "FitResult") -> list[Any]:
    """Return the fit as tables and sentences."""
    units = result.units
    rows = [
        (name, f"{value:.5g}", "±", f"{result.errors[name]:.2g}", units[name])
        for name, value in result.values.items()
    ]
    words = [f"[bold]not determined:[/] {direction}" for direction in result.undetermined]
    headings = ("number", "value", "", "standard error", "unit")
    return [
        listing(None, headings, rows, words=("number", "", "unit")),
        result.goodness,
        *words,
        *result.cautions,
    ]


def _vary(text: str) -> dict[str, tuple[Any, Any] | None]:
    """Return fields and ranges from "friction.mu=0.1:0.5,launch.spin"."""
    fields = dict[str, tuple[Any, Any] | None]()
    for part in text.split(","):
        field, equals, ends = part.strip().partition("=")
        low, colon, high = ends.partition(":")
        if equals and not colon:
            raise InvalidInput("--vary", part, "FIELD or FIELD=LOW:HIGH")
        fields[field] = (stated_value(low), stated_value(high)) if equals else None
    return fields
