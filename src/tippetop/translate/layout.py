"""Lines of JavaScript broken where they are long."""

import re
from collections.abc import Iterator
from itertools import pairwise

WIDTH = 110
"""Longer lines are broken, where they have brackets."""

TOKEN = re.compile(r'"(?:[^"\\]|\\.)*"|`(?:[^`\\]|\\.)*`|, | [+?:] |.')
"""Strings, where a line may be broken, and any other character."""


def laid_out(line: str) -> Iterator[str]:
    """Yield a line, or several: what is in its longest brackets further in, part by part."""
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
    """Where what is in them begins and ends; of brackets that are all there is in others, the inner
    ones.
    """
    opened, found = list[int](), [(0, 0)]
    for token in TOKEN.finditer(line):
        if token[0] in "([{":
            opened.append(token.end())
        elif token[0] in ")]}" and opened:
            found.append((opened.pop(), token.start()))
    begin, end = max(found, key=lambda pair: pair[1] - pair[0])
    while (begin + 1, end - 1) in found:
        begin, end = begin + 1, end - 1
    return begin, end


def _parts(text: str) -> Iterator[str]:
    """What stands between commas, or else between the signs of operations, with which a line
    begins.
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
