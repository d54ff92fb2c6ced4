"""Entry point of the command line, which handles Ctrl-C before the libraries are loaded."""

import gc
import os
import sys
from contextlib import suppress

from tippetop.support.interrupts import INTERRUPTED, let_end

GARBAGE = 50_000
"""Number of new objects between two garbage collections: imports make many objects and free few."""

UNUSED = ("dask",)
"""Packages that xarray loads if they are installed, and that only `sweep` uses."""


def main() -> None:
    """Run the command line; misuse ends with one sentence and exit code 2, Ctrl-C and signals with
    130.
    """
    let_end(at_first=True)
    gc.set_threshold(GARBAGE)
    if sys.argv[1:2] != ["sweep"]:
        for name in UNUSED:
            sys.modules.setdefault(name, None)  # type: ignore[arg-type]  # as if it were not installed
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
