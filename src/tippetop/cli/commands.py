"""All commands, and the report of errors as one sentence with an exit code."""

import os
import re
import sys
import warnings
from collections.abc import Callable
from inspect import cleandoc
from typing import Annotated, Any, TextIO

import typer
from typer.core import TyperCommand, TyperGroup

from tippetop import __version__
from tippetop.cli.body import body
from tippetop.cli.critical import critical
from tippetop.cli.dataset import dataset
from tippetop.cli.engines import engines
from tippetop.cli.fit import fit
from tippetop.cli.improve import improve
from tippetop.cli.lab import lab
from tippetop.cli.options import FIELDS_OF_OPTIONS
from tippetop.cli.problem import problem
from tippetop.cli.reference import reference
from tippetop.cli.reproduce import reproduce
from tippetop.cli.simulate import simulate
from tippetop.cli.steady import steady
from tippetop.cli.sweep import sweep
from tippetop.support.errors import (
    MISSING,
    OR_NONE,
    OTHER_OUT,
    OVERWRITE,
    RESUME,
    InvalidInput,
    TippetopError,
    in_file,
    renamed,
    reworded,
    within_part,
)
from tippetop.support.interrupts import INTERRUPTED, is_interrupted, let_end, let_raise
from tippetop.support.units import is_unit

UNEXPECTED = re.compile(r"unexpected extra argument(?:s|\(s\))? \((\S+)\)")
"""What typer says of an argument that a command does not take."""

OPTIONS_OF_FILES = {
    "noise",
    "scale",
    "track",
    "start",
    "view",
    "point",
    "frame_rate",
    "unit",
    "density",
}
"""Options that say how a file is read: a refusal that names the file is of them."""

MISUSE = 2
"""Exit code of a command line that is not accepted."""

WORDS = {OVERWRITE: "--force", RESUME: "--resume", OTHER_OUT: "another --out", OR_NONE: ""}
"""Options of the command line, by the arguments of Python that messages of the package name."""

UsageError: Any = typer.BadParameter.__base__
"""Error of typer for a command line that it does not accept."""


class Commands(TyperGroup):
    """Group of commands that reports an interruption, on which typer alone ends silently."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Parse the arguments before the command; turn errors of typer into sentences."""
        try:
            return super().parse_args(ctx, args)
        except UsageError as error:
            raise _in_a_sentence(error) from None

    def invoke(self, ctx: Any) -> Any:
        """Run the command; report an interruption, and turn errors of typer into sentences."""
        try:
            let_raise()
            return super().invoke(ctx)
        except UsageError as error:
            raise _in_a_sentence(error) from None
        except (KeyboardInterrupt, Exception) as error:
            if not (isinstance(error, KeyboardInterrupt) or is_interrupted()) or isinstance(
                error, typer.Exit
            ):
                raise
            typer.echo("tippetop: interrupted", err=True)
            raise typer.Exit(INTERRUPTED) from None
        finally:
            let_end()


class Command(TyperCommand):
    """Command whose refusals name its options, and not the arguments of Python."""

    def invoke(self, ctx: Any) -> Any:
        """Run the command."""
        try:
            return super().invoke(ctx)
        except InvalidInput as error:
            names = [self._option(field, error, ctx.params) for field in error.field.split(", ")]
            if None in names:
                raise
            raise renamed(in_file(error, ""), ", ".join(map(str, names))) from None

    def _option(self, field: str, error: InvalidInput, stated: dict[str, Any]) -> str | None:
        """Return the option that states a refused field, if it was stated or is missing.

        A column or a key of a file may have the name of an option.
        """
        name, _, part = field.partition(".")
        for option, stated_field in FIELDS_OF_OPTIONS.items():
            if field == stated_field and stated.get(option) is not None:
                name, part = option, ""
        is_stated = error.value is MISSING or stated.get(name) is not None
        if not is_stated or (error.file and name not in OPTIONS_OF_FILES):
            return None
        options = [one.opts[0] for one in self.params if one.name == name]
        return f"{options[0]} {part}".rstrip() if options else None


def _in_a_sentence(error: Any) -> Exception:
    """Return typer's error as one of the package's; help texts stay as they are."""
    cause = error.__cause__
    if isinstance(cause, InvalidInput):
        return within_part(cause, error.param.opts[0])
    message: str = error.format_message()
    extra = UNEXPECTED.search(message)
    if extra and is_unit(extra[1]):
        hint = f"write a number and its unit in quotes, as in '2200 {extra[1]}'"
        return TippetopError(f"{extra[1]} is a unit, and no argument ({hint})")
    if message:
        return TippetopError(message[0].lower() + message[1:].removesuffix("."))
    help_text: Exception = error
    return help_text


def _help(command: Callable[..., None]) -> str:
    """Return the help text of a command: its docstring, each paragraph in one line."""
    paragraphs = cleandoc(command.__doc__ or "").split("\n\n")
    return "\n\n".join(" ".join(paragraph.split()) for paragraph in paragraphs)


app = typer.Typer(
    cls=Commands,
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)
for command in (
    simulate,
    reproduce,
    critical,
    steady,
    sweep,
    fit,
    lab,
    problem,
    body,
    improve,
    reference,
    engines,
    dataset,
):
    app.command(cls=Command, help=_help(command))(command)


def _print_version(asked: bool) -> None:
    if asked:
        typer.echo(f"tippetop {__version__}")
        raise typer.Exit


@app.callback()
def tippetop(
    _version: Annotated[
        bool,
        typer.Option("--version", callback=_print_version, is_eager=True, help="Show the version."),
    ] = False,
) -> None:
    """Simulate the tippe top, the toy that turns itself upside down."""


def _show_warning(
    message: Warning | str,
    category: type[Warning],
    filename: str,
    lineno: int,
    file: TextIO | None = None,
    line: str | None = None,
) -> None:
    """Print a warning in one line, without the place in the code."""
    typer.echo(f"tippetop: {message}", err=True)


def run() -> None:
    """Run the command line; misuse ends with one sentence and exit code 2."""
    warnings.showwarning = _show_warning
    try:
        try:
            app()
        finally:
            sys.stdout.flush()
    except TippetopError as error:
        typer.echo(f"tippetop: {reworded(error, WORDS)}", err=True)
        sys.exit(MISUSE)
    except BrokenPipeError:
        # The reader has closed the pipe, as in `tippetop ... | head`.
        sys.stderr.close()
    except OSError as error:
        # Errors of files are sentences already: this one is of the output.
        typer.echo(f"tippetop: the output cannot be written: {error.strerror or error}", err=True)
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
        sys.exit(MISUSE)
