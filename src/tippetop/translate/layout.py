"""Line breaks in generated JavaScript."""

import re
from collections.abc import Iterator
from itertools import pairwise

WIDTH = 110
"""Length above which a line with brackets is broken."""

TOKEN = re.compile(r'"(?:[^"\\]|\\.)*"|`(?:[^`\\]|\\.)*`|, | [+?:] |.')
"""Strings, places where a line may be broken, and any other character."""


def laid_out(line: str) -> Iterator[str]:
    """Yield the lines of a line: the contents of its longest brackets are indented, a part a
    line.
    """
    begin, end = _longest_brackets(line)
    if len(line) <= WIDTH or begin == end or line.lstrip().startswith("/**"):
        yield line
        return
    margin = " " * (len(line) - len(line.lstrip()))
    yield from laid_out(line[:begin])
    for part in _parts(line[begin:end]):
        yield from laid_out(f"{margin}  {part.strip()}")
    yield from laid_out(margin + line[end:])


def _longest_brackets(line: str) -> tuple[int, int]:
    """Return the begin and the end of the contents of a line's longest brackets.

    Of brackets that contain only other brackets, the inner ones count.
    """
    opened, spans = list[int](), [(0, 0)]
    for token in TOKEN.finditer(line):
        if token[0] in "([{":
            opened.append(token.end())
        elif token[0] in ")]}" and opened:
            spans.append((opened.pop(), token.start()))
    begin, end = max(spans, key=lambda pair: pair[1] - pair[0])
    while (begin + 1, end - 1) in spans:
        begin, end = begin + 1, end - 1
    return begin, end


def _parts(text: str) -> Iterator[str]:
    """Yield the parts of a text between commas.

    Without commas, these are the parts between operators, each with the operator before it.
    """
    depth, commas, signs = 0, list[int](), list[int]()
    for token in TOKEN.finditer(text):
        depth += (token[0] in "([{") - (token[0] in ")]}")
        if depth == 0 and token[0] == ", ":
            commas.append(token.end())
        elif depth == 0 and token[0] in (" + ", " ? ", " : "):
            signs.append(token.start())
    places = [0, *(commas or signs), len(text)]
    yield from (text[begin:end] for begin, end in pairwise(places))
