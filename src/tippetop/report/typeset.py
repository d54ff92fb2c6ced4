"""Formulas in the plain words of claims and captions, set for a page: letters, indices and powers."""

import re

from markupsafe import Markup, escape

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
# A name by itself, not inside a longer word or a name with dashes, with its index, primes and power.
_SYMBOL = re.compile(
    rf"(?<![\w.-])(?P<name>{_NAMES})(?P<index>\d|_\w+)?(?P<primes>'{{0,2}})(?:\^(?P<power>-?[\d.]*\d))?(?![\w'-])"
)


def typeset(text: str) -> Markup:
    """The text as HTML, with its formulas in letters, indices and powers."""
    return Markup(_SYMBOL.sub(_symbol, _escaped(text)))


def _escaped(text: str) -> str:
    # An apostrophe is a prime here, and harmless in the text of a page.
    return str(escape(text)).replace("&#39;", "'").replace(" x ", " × ")


def _symbol(found: re.Match[str]) -> str:
    name, index, primes, power = (found[part] or "" for part in ("name", "index", "primes", "power"))
    if name not in _LETTERS and not (index or power):
        return found[0]
    letter = _LETTERS.get(name, name)
    mark = ("", "′", "″")[len(primes)]
    below = f"<sub>{index.removeprefix('_')}</sub>" if index else ""
    above = f"<sup>{power.replace('-', '−')}</sup>" if power else ""
    return f"{letter}{mark}{below}{above}"
