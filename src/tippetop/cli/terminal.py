"""What the commands show people: tables, sentences, and how far they are."""

import json
import math
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from tippetop.support.interrupts import hear

if TYPE_CHECKING:
    from rich.table import Table


def facts(rows: Iterable[Sequence[str]]) -> "Table":
    """What is told, a name, a number and perhaps a remark to a row, as a table."""
    from rich.table import Table  # noqa: PLC0415 - slow to import, like what follows

    table = Table(box=None, show_header=False, padding=(0, 2, 0, 0), pad_edge=False)
    table.add_column(style="dim")
    table.add_column(justify="right", style="bold")
    table.add_column()
    for row in rows:
        table.add_row(*row)
    return table


def spelled(value: float, digits: int = 10) -> str:
    """Return a number, or that what it is of never comes."""
    return f"{value + 0.0:.{digits}g}" if math.isfinite(value) else "never"


def listing(
    title: str | None, headings: Sequence[str], rows: Iterable[Sequence[str]], words: Sequence[str]
) -> "Table":
    """Return rows of numbers under headings, but for the columns of words."""
    from rich.table import Table  # noqa: PLC0415

    table = Table(title=title, title_justify="left", title_style="bold", box=None)
    for heading in headings:
        table.add_column(heading, justify="left" if heading in words else "right", overflow="fold")
    for row in rows:
        table.add_row(*row)
    return table


def show(*parts: Any, files: Iterable[Path] = ()) -> None:
    """Print sentences, with rich's markup, and tables, and which files were written."""
    from rich.console import Console  # noqa: PLC0415

    console = Console(highlight=False)
    for part in parts:
        console.print(part)
    for path in files:
        console.print(f"wrote {path}", markup=False, soft_wrap=True)


def show_json(told: Any) -> None:
    """Print what is told for programs; what is infinite or undefined is null."""
    from pydantic_core import to_jsonable_python  # noqa: PLC0415 - slow to import

    typer.echo(json.dumps(to_jsonable_python(told, inf_nan_mode="null"), indent=2))


@contextmanager
def progress_bar(what: str = "") -> Iterator[Callable[..., None]]:
    """Show on a terminal how far something is, how long it still takes, and how long it has taken.

    Given is what is to be told of it: how much is done, of how much, and, if that changes, what it
    is at.
    """
    if not sys.stderr.isatty():
        yield lambda *_: hear()
        return
    from rich.console import Console  # noqa: PLC0415
    from rich.markup import escape  # noqa: PLC0415
    from rich.progress import Progress, TimeElapsedColumn  # noqa: PLC0415

    columns = (*Progress.get_default_columns(), TimeElapsedColumn())
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task(escape(f"{what:<28}"), total=None)

        def tell(done: float, total: float, now: str = what) -> None:
            hear()
            bar.update(task, completed=done, total=total, description=escape(f"{now:<28}"))

        yield tell
