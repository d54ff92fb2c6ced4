"""Recorded functions as JavaScript."""

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

JAVASCRIPT = Language(
    {
        SUM: Spelling(("", " + ", ""), 1),
        DIFFERENCE: Spelling(("", " - ", ""), 1),
        PRODUCT: Spelling(("", " * ", ""), 2),
        QUOTIENT: Spelling(("", " / ", ""), 2),
        NEGATIVE: Spelling(("-", ""), 3),
        POWER: Spelling(("Math.pow(", ", ", ")")),
        ROOT: Spelling(("Math.sqrt(", ")")),
        SIZE: Spelling(("Math.abs(", ")")),
        LESS: Spelling(("(", " < ", " ? 1 : 0)")),
        SELECT: Spelling(("(", " !== 0 ? ", " : ", ")")),
    }
    | {name: Spelling((f"Math.{name}(", *[", "] * (count - 1), ")")) for name, count in FUNCTIONS.items()},
    head=("function ", "(y, p, out) {"),
    foot="}\n",
    local="const ",
    end=";",
)


def javascript_source(recorded: Recorded, name: str) -> str:
    """A JavaScript function `name(y, p, out)`."""
    return written(recorded, name, JAVASCRIPT)
