"""Formulas for a page: plain ones in texts as HTML, and TeX as drawings."""

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
# A symbol with its index, primes and power, not inside a longer word or a name with dashes.
_SYMBOL = re.compile(
    rf"(?<![\w.-])(?P<name>{_NAMES})(?P<index>\d|_\w+)?(?P<primes>'{{0,2}})(?:\^(?P<power>-?[\d.]*\d))?(?![\w'-])"
)

_EXPONENT = re.compile(r"(?<![\w.])(?P<digits>\d[\d.]*)e(?P<power>[+-]\d+)(?!\w)")
"""Pattern of a number with a power of ten as Python writes it."""


def typeset(text: str) -> Markup:
    """Return a text as HTML, with Greek letters, indices and powers in its formulas."""
    # Escaping hides apostrophes, which are primes here; in the text of a page they do no harm.
    escaped = str(escape(text)).replace("&#39;", "'").replace(" x ", " × ")
    return Markup(_EXPONENT.sub(_power_of_ten, _SYMBOL.sub(_symbol, escaped)))


def _power_of_ten(match: re.Match[str]) -> str:
    """Return the HTML of a matched number with a power of ten."""
    factor = "" if match["digits"] == "1" else f"{match['digits']} × "
    power = str(int(match["power"])).replace("-", "−")
    return f"{factor}10<sup>{power}</sup>"


def _symbol(match: re.Match[str]) -> str:
    """Return the HTML of a matched symbol."""
    name, index, primes, power = (
        match[part] or "" for part in ("name", "index", "primes", "power")
    )
    if name not in _LETTERS and not (index or power):
        return match[0]
    letter = _LETTERS.get(name, name)
    mark = ("", "′", "″")[len(primes)]
    below = f"<sub>{index.removeprefix('_')}</sub>" if index else ""
    above = f"<sup>{power.replace('-', '−')}</sup>" if power else ""
    return f"{letter}{mark}{below}{above}"


_SIZE = 16.0
"""Font size of formulas, in units of their drawings."""

# Path commands of SVG.
_PENS = {
    int(Path.MOVETO): "M",
    int(Path.LINETO): "L",
    int(Path.CURVE3): "Q",
    int(Path.CURVE4): "C",
    int(Path.CLOSEPOLY): "Z",
}


def formula(lines: Sequence[str]) -> Markup:
    """Return lines of TeX, of the subset that matplotlib sets, as SVG in the colour of the text."""
    return Markup("").join(_line(line) for line in lines)


@cache
def _line(tex: str) -> Markup:
    """Return a line of TeX as SVG."""
    with house_style():
        outline = TextPath((0, 0), f"${tex}$", size=_SIZE)
    box = outline.get_extents()
    x, bottom, width, height = box.x0 - 1, box.y0 - 1, box.width + 2, box.height + 2
    strokes = []
    for points, code in outline.iter_segments(simplify=False):
        numbers = " ".join(f"{value:.4g}" for value in points * np.resize([1.0, -1.0], len(points)))
        strokes.append(_PENS[int(code)] + (numbers if int(code) != Path.CLOSEPOLY else ""))
    return Markup(
        '<svg class="formula" role="img" aria-label="{}" viewBox="{:.1f} {:.1f} {:.1f} {:.1f}" '
        'style="width:{:.2f}em"><path d="{}"/></svg>'
    ).format(tex, x, -bottom - height, width, height, width / _SIZE, "".join(strokes))
