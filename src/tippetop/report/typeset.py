"""Formulas set for a page: those in the plain words of claims and captions, and those that stand
apart.
"""

import re
from collections.abc import Sequence
from functools import cache

import numpy as np
from markupsafe import Markup, escape
from matplotlib.path import Path
from matplotlib.textpath import TextPath

from tippetop.figures.style import house_style

_LETTERS = {
    "alpha": "α",
    "gamma": "γ",
    "lambda": "λ",
    "mu": "μ",
    "omega": "ω",
    "phi": "φ",
    "pi": "π",
    "theta": "θ",
}
_NAMES = "|".join((*_LETTERS, "xi", "I", "R", "Y", "f", "g", "t", "m", "s", "v"))
# A name by itself, not inside a longer word or a name with dashes, with its index, primes and
# power.
_SYMBOL = re.compile(
    rf"(?<![\w.-])(?P<name>{_NAMES})(?P<index>\d|_\w+)?(?P<primes>'{{0,2}})(?:\^(?P<power>-?[\d.]*\d))?(?![\w'-])"
)

_EXPONENT = re.compile(r"(?<![\w.])(?P<digits>\d[\d.]*)e(?P<power>[+-]\d+)(?!\w)")
"""A number as Python writes it, with a power of ten."""


def typeset(text: str) -> Markup:
    """Return the text as HTML, with its formulas in letters, indices and powers."""
    # An apostrophe is a prime here, and harmless in the text of a page.
    escaped = str(escape(text)).replace("&#39;", "'").replace(" x ", " × ")
    return Markup(_EXPONENT.sub(_power_of_ten, _SYMBOL.sub(_symbol, escaped)))


def _power_of_ten(found: re.Match[str]) -> str:
    factor = "" if found["digits"] == "1" else f"{found['digits']} × "
    power = str(int(found["power"])).replace("-", "−")
    return f"{factor}10<sup>{power}</sup>"


def _symbol(found: re.Match[str]) -> str:
    name, index, primes, power = (
        found[part] or "" for part in ("name", "index", "primes", "power")
    )
    if name not in _LETTERS and not (index or power):
        return found[0]
    letter = _LETTERS.get(name, name)
    mark = ("", "′", "″")[len(primes)]
    below = f"<sub>{index.removeprefix('_')}</sub>" if index else ""
    above = f"<sup>{power.replace('-', '−')}</sup>" if power else ""
    return f"{letter}{mark}{below}{above}"


_SIZE = 16.0
"""Size at which formulas are outlined, in units of their drawing."""

_PENS = {
    int(Path.MOVETO): "M",
    int(Path.LINETO): "L",
    int(Path.CURVE3): "Q",
    int(Path.CURVE4): "C",
    int(Path.CLOSEPOLY): "Z",
}


def formula(lines: Sequence[str]) -> Markup:
    """Return lines of TeX, as far as matplotlib sets it, as drawings in the color of the text
    around them.
    """
    return Markup("").join(_line(line) for line in lines)


@cache
def _line(tex: str) -> Markup:
    with house_style():
        outline = TextPath((0, 0), f"${tex}$", size=_SIZE)
    box = outline.get_extents()
    left, bottom, width, height = box.x0 - 1, box.y0 - 1, box.width + 2, box.height + 2
    pieces = []
    for points, code in outline.iter_segments(simplify=False):
        numbers = " ".join(f"{value:.4g}" for value in points * np.resize([1.0, -1.0], len(points)))
        pieces.append(_PENS[int(code)] + (numbers if int(code) != Path.CLOSEPOLY else ""))
    return Markup(
        '<svg class="formula" role="img" aria-label="{}" viewBox="{:.1f} {:.1f} {:.1f} {:.1f}" '
        'style="width:{:.2f}em"><path d="{}"/></svg>'
    ).format(tex, left, -bottom - height, width, height, width / _SIZE, "".join(pieces))
