"""The command line: collects the commands and turns what goes wrong into one sentence and an exit code."""

import sys
from typing import Annotated, Any

import typer
from typer.core import TyperGroup

from tippetop import __version__
from tippetop.cli.body import body
from tippetop.cli.critical import critical
from tippetop.cli.lab import lab
from tippetop.cli.problem import problem
from tippetop.cli.reproduce import reproduce
from tippetop.cli.simulate import simulate
from tippetop.cli.sweep import sweep
from tippetop.errors import OTHER_OUT, OVERWRITE, RESUME, InvalidInput, TippetopError
from tippetop.interrupts import INTERRUPTED, asked_to_end, let_end, let_raise

MISUSE = 2

WORDS = {OVERWRITE: "--force", RESUME: "--resume", OTHER_OUT: "another --out"}
"""What is asked for here, by how it is asked for in Python."""


NUMBERS = {"float_parsing": "a number", "int_parsing": "a whole number"}
"""What is accepted where typer finds none."""


class Commands(TyperGroup):
    """Commands that say so when Ctrl-C ends them: typer alone ends them without a word."""

    def invoke(self, ctx: Any) -> Any:
        """Run the command asked for."""
        try:
            let_raise()
            return super().invoke(ctx)
        except typer.BadParameter as error:
            raise _in_a_sentence(error) from None
        except (KeyboardInterrupt, Exception) as error:
            if not (isinstance(error, KeyboardInterrupt) or asked_to_end()) or isinstance(error, typer.Exit):
                raise
            typer.echo("tippetop: interrupted", err=True)
            raise typer.Exit(INTERRUPTED) from None
        finally:
            let_end()


def _in_a_sentence(error: Any) -> Exception:
    """What typer says of an option that cannot be, with the value and in the words of all other sentences."""
    name: str = error.param.opts[0]
    told: list[Any] = getattr(error.__cause__, "errors", list)()
    if not told:
        return TippetopError(f"{name}: {error.message}") if error.message else error
    accepted = NUMBERS.get(told[0]["type"], told[0]["msg"].removeprefix("Input should be "))
    return InvalidInput(name, told[0]["input"], accepted)


app = typer.Typer(
    cls=Commands,
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)
for command in (simulate, reproduce, critical, sweep, lab, problem, body):
    app.command()(command)


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


def run() -> None:
    """Run the command that is asked for; misuse ends with one sentence and exit code 2."""
    try:
        app()
    except TippetopError as error:
        typer.echo(f"tippetop: {error.told(WORDS)}", err=True)
        sys.exit(MISUSE)
    except BrokenPipeError:
        # Whoever was reading has read enough (`tippetop ... | head`).
        sys.stderr.close()
