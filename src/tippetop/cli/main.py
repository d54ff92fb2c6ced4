"""Entry point of the command line, which handles Ctrl-C before the libraries are loaded."""

import codecs
import gc
import os
import sys
from contextlib import suppress
from io import TextIOWrapper

from tippetop.support.interrupts import INTERRUPTED, let_end

GARBAGE = 50_000
"""Number of new objects between two garbage collections: imports make many objects and free few."""

PLAIN = {
    "\N{MINUS SIGN}": "-",
    "\N{EN DASH}": "-",
    "\N{DEGREE SIGN}": " deg",
    "\N{MICRO SIGN}": "u",
}
"""What is printed for characters that the output cannot show; ? for all others."""


def _print_what_can_be_printed() -> None:
    """Let outputs that are not UTF-8 have plain characters for those that they cannot show."""

    def plain(error: UnicodeError) -> tuple[str, int]:
        assert isinstance(error, UnicodeEncodeError)
        characters = error.object[error.start : error.end]
        return "".join(PLAIN.get(one, "?") for one in characters), error.end

    codecs.register_error("plain", plain)
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, TextIOWrapper):
            stream.reconfigure(errors="plain")


def main() -> None:
    """Run the command line; misuse ends with one sentence and exit code 2, Ctrl-C and signals with
    130.
    """
    let_end(at_first=True)
    _print_what_can_be_printed()
    gc.set_threshold(GARBAGE)
    from tippetop.cli.commands import run  # noqa: PLC0415 - slow; Ctrl-C is heard meanwhile

    try:
        run()
    except SystemExit as ending:
        if ending.code == INTERRUPTED:
            # Everything has been cleaned up: there is no need to wait for the compiler, or for the
            # libraries to be unloaded.
            with suppress(OSError, ValueError):
                sys.stdout.flush()
                sys.stderr.flush()
            os._exit(INTERRUPTED)
        raise
