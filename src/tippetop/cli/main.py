"""The command line: collects the commands and turns what goes wrong into one sentence and an exit code."""

import gc
import signal
import sys
from typing import Annotated, Any

import typer
from typer.core import TyperGroup

from tippetop import __version__
from tippetop.cli.body import body
from tippetop.cli.critical import critical
from tippetop.cli.lab import lab
from tippetop.cli.options import INTERRUPTED
from tippetop.cli.problem import problem
from tippetop.cli.reproduce import reproduce
from tippetop.cli.simulate import simulate
from tippetop.cli.sweep import sweep
from tippetop.errors import OTHER_OUT, OVERWRITE, RESUME, TippetopError
from tippetop.interrupts import ENDINGS

MISUSE = 2

WORDS = {OVERWRITE: "--force", RESUME: "--resume", OTHER_OUT: "another --out"}
"""What is asked for here, by how it is asked for in Python."""


class Commands(TyperGroup):
    """Commands that say so when Ctrl-C ends them: typer alone ends them without a word."""

    def invoke(self, ctx: Any) -> Any:
        """Run the command asked for."""
        try:
            return super().invoke(ctx)
        except KeyboardInterrupt:
            typer.echo("tippetop: interrupted", err=True)
            raise typer.Exit(INTERRUPTED) from None


app = typer.Typer(
    cls=Commands,
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)
app.command()(simulate)
app.command()(reproduce)
app.command()(critical)
app.command()(sweep)
app.command()(lab)
app.command()(problem)
app.command()(body)

GARBAGE = 50_000
"""Objects made between two looks for garbage: importing the libraries makes many, and drops hardly one."""

UNUSED = ("dask", "sympy")
"""What xarray and heyoka load wherever it is installed, and no command but `sweep` uses."""


def _print_version(asked: bool) -> None:
    if asked:
        typer.echo(f"tippetop {__version__}")
        raise typer.Exit


@app.callback()
def tippetop(
    _version: Annotated[
        bool, typer.Option("--version", callback=_print_version, is_eager=True, help="Show the version.")
    ] = False,
) -> None:
    """A laboratory for the tippe top, the toy that turns itself upside down."""


def main() -> None:
    """Run the command line; misuse ends with one sentence and exit code 2, Ctrl-C and its like with 130."""
    gc.set_threshold(GARBAGE)
    if sys.argv[1:2] != ["sweep"]:
        for name in UNUSED:
            sys.modules.setdefault(name, None)  # type: ignore[arg-type]  # as if it were not installed
    for number in ENDINGS:
        # What is not heard at all, as Ctrl-C by programs in the background, stays so.
        if signal.getsignal(number) == signal.SIG_DFL:
            signal.signal(number, signal.default_int_handler)
    try:
        app()
    except TippetopError as error:
        typer.echo(f"tippetop: {error.told(WORDS)}", err=True)
        sys.exit(MISUSE)
    except BrokenPipeError:
        # Whoever was reading has read enough (`tippetop ... | head`).
        sys.stderr.close()
