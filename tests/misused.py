"""What `tippetop` says where it is misused."""

import contextlib
import io
import sys
from pathlib import Path
from unittest import mock

import pytest

from tippetop.cli.commands import run


def misused(folder: Path | str, *arguments: str) -> str:
    """Return what the command says in a folder, all of it to standard error, with exit code 2."""
    out, said = io.StringIO(), io.StringIO()
    with (
        contextlib.chdir(folder),
        contextlib.redirect_stdout(out),
        contextlib.redirect_stderr(said),
        mock.patch.object(sys, "argv", ["tippetop", *arguments]),
        pytest.raises(SystemExit) as ending,
    ):
        run()
    assert (out.getvalue(), ending.value.code) == ("", 2), said.getvalue()
    return said.getvalue()
