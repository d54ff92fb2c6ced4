"""Recorded functions as JavaScript."""

from tippetop.emit.code import Language, Spelling, common_spellings, written
from tippetop.emit.graph import LESS, SELECT, SIZE
from tippetop.emit.recording import Recorded

JAVASCRIPT = Language(
    {
        SIZE: Spelling(("Math.abs(", ")")),
        LESS: Spelling(("(", " < ", " ? 1 : 0)")),
        SELECT: Spelling(("(", " !== 0 ? ", " : ", ")")),
    }
    | common_spellings("Math"),
    head=("function ", "(y, p, out) {"),
    foot="}\n",
    local="const ",
    end=";",
)


def javascript_source(recorded: Recorded, name: str) -> str:
    """A JavaScript function `name(y, p, out)`."""
    return written(recorded, name, JAVASCRIPT)
