"""What `tippetop` says where it is misused."""

import contextlib
import io
import sys
from pathlib import Path
from unittest import mock

import pytest

from tippetop.cli.commands import run


def commanded(folder: Path | str, *arguments: str) -> tuple[str, str, int]:
    """Return what the command prints in a folder and what it says to standard error, and its exit
    code; it runs in this process.
    """
    out, said = io.StringIO(), io.StringIO()
    with (
        contextlib.chdir(folder),
        contextlib.redirect_stdout(out),
        contextlib.redirect_stderr(said),
        mock.patch.object(sys, "argv", ["tippetop", *arguments]),
        pytest.raises(SystemExit) as ending,
    ):
        run()
    return out.getvalue(), said.getvalue(), ending.value.code


def misused(folder: Path | str, *arguments: str) -> str:
    """Return what the command says in a folder, all of it to standard error, with exit code 2."""
    out, said, code = commanded(folder, *arguments)
    assert (out, code) == ("", 2), said
    return said
