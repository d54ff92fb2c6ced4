"""Output of the commands on a terminal: tables, sentences, JSON and progress."""

import json
import math
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

if TYPE_CHECKING:
    from rich.table import Table


def facts(rows: Iterable[Sequence[str]]) -> "Table":
    """Return a table of rows: a name, a number and perhaps a remark."""
    from rich.table import Table  # noqa: PLC0415 - slow to import, as are those below

    table = Table(box=None, show_header=False, padding=(0, 2, 0, 0), pad_edge=False)
    table.add_column(style="dim")
    table.add_column(justify="right", style="bold")
    table.add_column()
    for row in rows:
        table.add_row(*row)
    return table


def spelled(value: float, digits: int = 6) -> str:
    """Return a number as text, or "never" for an infinite time or spin."""
    return f"{value + 0.0:.{digits}g}" if math.isfinite(value) else "never"


def listing(
    title: str | None, headings: Sequence[str], rows: Iterable[Sequence[str]], words: Sequence[str]
) -> "Table":
    """Return a table of numbers under headings; columns in `words` are aligned to the left."""
    from rich.table import Table  # noqa: PLC0415

    table = Table(title=title, title_justify="left", title_style="bold", box=None)
    for heading in headings:
        table.add_column(heading, justify="left" if heading in words else "right", overflow="fold")
    for row in rows:
        table.add_row(*row)
    return table


def show(*parts: Any, files: Iterable[Path] = ()) -> None:
    """Print sentences (with rich's markup), tables, and the names of files that were written."""
    from rich.console import Console  # noqa: PLC0415

    console = Console(highlight=False)
    for part in parts:
        console.print(part)
    for path in files:
        console.print(f"wrote {path}", markup=False, soft_wrap=True)


def show_json(value: Any) -> None:
    """Print a value as JSON; infinite and undefined numbers are null."""
    from pydantic_core import to_jsonable_python  # noqa: PLC0415 - slow to import

    typer.echo(json.dumps(to_jsonable_python(value, inf_nan_mode="null"), indent=2))
