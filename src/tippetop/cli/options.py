"""The options that several commands share: how a problem is put together on the command line."""

import json
import math
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from tippetop.errors import InvalidInput

if TYPE_CHECKING:
    from rich.table import Table

    from tippetop.problem import Problem

ProblemFile = Annotated[
    Path | None, typer.Argument(help="Problem to start from, .toml or .json; the report's top if left out.")
]
Preset = Annotated[
    str | None,
    typer.Option(help="Body by name, such as report, leine-glocker-stem, egg, coin; a wrong one lists all."),
]
Spin = Annotated[float | None, typer.Option(help="Axial spin at launch, rad/s.")]
Tilt = Annotated[float | None, typer.Option(help="Tilt of the axis at launch, rad, from 0 to pi.")]
Mu = Annotated[float | None, typer.Option(help="Friction coefficient: s/m if viscous, else dimensionless.")]
LiftOff = Annotated[str | None, typer.Option(help="When the table would have to pull: stop, ignore or fly.")]
Changes = Annotated[
    list[str] | None,
    typer.Option("--set", metavar="FIELD=VALUE", help="Any other field, e.g. body.shape.eccentricity=0.2."),
]
Json = Annotated[bool, typer.Option("--json", help="Print JSON for programs.")]
Force = Annotated[bool, typer.Option("--force", help="Overwrite results that exist.")]


def chosen_problem(
    file: Path | None,
    preset: str | None,
    settings: dict[str, Any],
    changes: list[str] | None,
) -> "Problem":
    """The problem of a file (or the report's), with a preset body and some fields changed.

    Raises
    ------
    InvalidInput, FileTrouble
        If the file, the preset or a field is not what it should be.
    """
    from tippetop import presets  # noqa: PLC0415 - slow to import, and not needed for --help
    from tippetop.problem import Problem  # noqa: PLC0415

    problem = presets.report_problem() if file is None else Problem.read(file)
    return changed_problem(problem, preset, settings, changes)


def changed_problem(
    problem: "Problem", preset: str | None, settings: dict[str, Any], changes: list[str] | None
) -> "Problem":
    """A problem with a preset body and some fields changed.

    Raises
    ------
    InvalidInput
        If the preset or a field is not what it should be.
    """
    from tippetop import presets  # noqa: PLC0415 - slow to import, and not needed for --help

    if preset is not None:
        problem = problem.model_copy(update={"body": presets.body(preset)})
    given = {field: value for field, value in settings.items() if value is not None}
    given.update(_parsed(change) for change in changes or [])
    return problem.replace(given)


def facts(rows: Iterable[Sequence[str]]) -> "Table":
    """What is told, a name, a number and perhaps a remark to a row, as a table."""
    from rich.table import Table  # noqa: PLC0415 - slow to import

    table = Table(box=None, show_header=False, padding=(0, 2, 0, 0))
    table.add_column(style="dim")
    table.add_column(justify="right", style="bold")
    table.add_column()
    for row in rows:
        table.add_row(*row)
    return table


def finite(value: float) -> float | None:
    """The number as JSON takes it: None where it is infinite or undefined."""
    return value if math.isfinite(value) else None


def _parsed(change: str) -> tuple[str, Any]:
    """Field and value of a `--set FIELD=VALUE`: a number or list as in JSON, or else a word."""
    field, equals, value = change.partition("=")
    if not equals:
        raise InvalidInput("--set", change, "FIELD=VALUE")
    try:
        return field, json.loads(value)
    except (ValueError, RecursionError):
        return field, value
