"""Recorded functions as Python of floats alone, which numba compiles."""

from tippetop.emit.code import Language, Spelling, common_spellings, written
from tippetop.emit.graph import LESS, SELECT, SIZE
from tippetop.emit.recording import Recorded

PYTHON = Language(
    {
        SIZE: Spelling(("abs(", ")")),
        LESS: Spelling(("(1.0 if ", " < ", " else 0.0)")),
        SELECT: Spelling(("(", " if ", " != 0.0 else ", ")"), order=(1, 0, 2)),
    }
    | common_spellings("math"),
    head=("def ", "(y, p, out):"),
    foot="",
    local="",
    end="",
)


def python_source(recorded: Recorded, name: str) -> str:
    """A Python function `name(y, p, out)`; it needs `math`."""
    return written(recorded, name, PYTHON)
