"""Recorded functions as Python of floats alone, which numba compiles."""

from tippetop.emit.code import Language, Spelling, written
from tippetop.emit.graph import (
    DIFFERENCE,
    FUNCTIONS,
    LESS,
    NEGATIVE,
    POWER,
    PRODUCT,
    QUOTIENT,
    ROOT,
    SELECT,
    SIZE,
    SUM,
)
from tippetop.emit.recording import Recorded

PYTHON = Language(
    {
        SUM: Spelling(("", " + ", ""), 1),
        DIFFERENCE: Spelling(("", " - ", ""), 1),
        PRODUCT: Spelling(("", " * ", ""), 2),
        QUOTIENT: Spelling(("", " / ", ""), 2),
        NEGATIVE: Spelling(("-", ""), 3),
        POWER: Spelling(("math.pow(", ", ", ")")),
        ROOT: Spelling(("math.sqrt(", ")")),
        SIZE: Spelling(("abs(", ")")),
        LESS: Spelling(("(1.0 if ", " < ", " else 0.0)")),
        SELECT: Spelling(("(", " if ", " != 0.0 else ", ")"), order=(1, 0, 2)),
    }
    | {name: Spelling((f"math.{name}(", *[", "] * (count - 1), ")")) for name, count in FUNCTIONS.items()},
    head=("def ", "(y, p, out):"),
    foot="",
    local="",
    end="",
)


def python_source(recorded: Recorded, name: str) -> str:
    """A Python function `name(y, p, out)`; it needs `math`."""
    return written(recorded, name, PYTHON)
