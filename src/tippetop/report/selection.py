"""Selection of what to redo: everything, or one figure or claim with the experiments it needs."""

import re
from dataclasses import dataclass
from difflib import get_close_matches
from itertools import chain

from tippetop.report.claim import Claim
from tippetop.report.claims.registry import CLAIMS
from tippetop.report.experiment import Experiment
from tippetop.report.experiments.registry import EXPERIMENTS
from tippetop.report.gallery import PLATES, Plate
from tippetop.support.errors import InvalidInput


@dataclass(frozen=True)
class Selection:
    """Figures and claims."""

    plates: tuple[Plate, ...]
    claims: tuple[Claim, ...]

    @property
    def experiments(self) -> tuple[Experiment, ...]:
        """Experiments that the figures and claims need, in the order of the page."""
        needs = chain(
            *(plate.needs for plate in self.plates), *(claim.needs for claim in self.claims)
        )
        return tuple(EXPERIMENTS[name] for name in dict.fromkeys(needs))


def select(only: str | None = None) -> Selection:
    """Return everything, or `only` the figure (fig06; 6 will do) or claim of this name.

    A figure is selected with the claims that can be decided from its data; a claim with the figure
    that shows it, if the figure needs no further experiment. Raises `InvalidInput` if there is no
    such figure or claim.
    """
    if only is None:
        return Selection(tuple(PLATES.values()), tuple(CLAIMS.values()))
    name = _figure_name(only)
    if name in PLATES:
        plate = PLATES[name]
        shown = (claim for claim in CLAIMS.values() if claim.figure == name)
        return Selection(
            (plate,), tuple(claim for claim in shown if set(claim.needs) <= set(plate.needs))
        )
    if name in CLAIMS:
        claim = CLAIMS[name]
        shown_in = PLATES.get(claim.figure or "")
        fitting = shown_in is not None and set(shown_in.needs) <= set(claim.needs)
        return Selection((shown_in,) if shown_in is not None and fitting else (), (claim,))
    raise InvalidInput("--only", only, _accepted(name))


def _accepted(name: str) -> str:
    """Return the names closest to a wrong one, or all names if none is close."""
    close = get_close_matches(name, [*PLATES, *CLAIMS], n=4, cutoff=0.5)
    if close:
        return "the name of a figure or claim, such as " + ", ".join(close)
    return "a figure (" + ", ".join(PLATES) + ") or a claim (" + ", ".join(CLAIMS) + ")"


def _figure_name(name: str) -> str:
    """Return a figure's name from the forms in which people write it: 6, fig6, Fig. 6."""
    match = re.fullmatch(r"(?:fig(?:ure)?\.?\s*)?0*(\d{1,2})", name.strip(), flags=re.IGNORECASE)
    return f"fig{int(match[1]):02d}" if match else name.strip()
