"""Claims of the report and of others, the values they are compared with, and the rule that
judges.
"""

import math
from collections import Counter
from collections.abc import Callable, Iterable, Mapping
from dataclasses import asdict, dataclass
from enum import Enum
from functools import partial
from typing import Any, NamedTuple, TypeAlias

import xarray as xr

from tippetop.report.tolerance import Tolerance, half_last_digit

Value: TypeAlias = float | bool
Data: TypeAlias = Mapping[str, xr.Dataset]
"""Datasets by the names of the experiments that computed them."""


class Verdict(Enum):
    """Judgement of a claim; the value states its condition."""

    REPRODUCED = "true, and what the report's own method gives"
    UPHELD = "true, although the report's own method does not give it"
    EXPLAINED = "not true, but what the report's own method gives"
    CORRECTED = "neither true nor what the report's own method gives"


RULE = (
    "Every claim is compared with the converged value, which decides whether it is true, and with"
    " the value by the report's own method, where there is one. Where the report leaves something"
    " open, both values are for one stated choice of it; a law has to be true for the report's main"
    " launch. Values agree if they differ by at most half a unit of the last printed digit, unless"
    " another tolerance is given with its reason. Claims that the report draws or codes without"
    " saying them in words are marked as implied."
)


@dataclass(frozen=True)
class Source:
    """Place of a claim in the report."""

    section: str
    figure: str | None = None
    equation: str | None = None

    @property
    def place(self) -> str:
        """The place in words."""
        section = f"section {self.section}" if self.section[0].isdigit() else self.section
        parts = (self.figure, self.equation and f"eq. {self.equation}", section)
        return ", ".join(part for part in parts if part)


@dataclass(frozen=True)
class Finding:
    """Result of examining a claim."""

    listing: Value | None
    """Value by the report's own method; None where it does not give one."""
    converged: Value
    """True value."""
    note: str
    """Explanation."""
    chosen: Value | None = None
    choice: str = ""
    """Value by the report's method for one choice of what the report leaves open, and that
    choice.
    """
    reported: float | None = None
    """Value of the report's printed formula, for a claim that is a formula."""
    news: str = ""
    """Further result that the report does not have, in a sentence; "" if there is none."""
    right: str = ""
    """Correct statement in a few words with values, for a claim that is not true; "" if
    `Claim.right` has it.
    """

    @classmethod
    def unlisted(cls, converged: Value, note: str, *choices: Any, **others: Any) -> "Finding":
        """Return a finding for which the report's own method gives no value."""
        return cls(None, converged, note, *choices, **others)


class Examiner(NamedTuple):
    """Function that examines a claim, and what it needs."""

    needs: tuple[str, ...]
    """Names of the experiments that it needs; () for the one with the name of the claim's
    figure.
    """
    tolerance: Tolerance | None
    """Largest difference that counts as agreement; None for half a unit of the last printed
    digit.
    """
    examine: Callable[..., Finding]
    """Function of the experiments' datasets, in the order of `needs`, that returns the finding."""
    takes_printed: bool = False
    """Whether the function also takes the printed number, as the keyword `printed`."""


@dataclass(frozen=True)
class Claim:
    """A statement of the report or of others, with its examiner and its figure."""

    id: str
    """Name."""
    examiner: Examiner
    """Examiner."""
    source: Source
    """Place."""
    text: str
    """The statement."""
    quote: str = ""
    """Words of the report, in its spelling; "" if the statement is not the report's."""
    printed: str = ""
    """Printed number with its unit; "" if the claim is no number or `Finding.reported` has it."""
    unit: str | None = None
    """Unit of a number that is not printed; None if there is none."""
    formula: tuple[str, ...] = ()
    """Displayed formula, in the TeX that matplotlib sets, a string per line."""
    formula_right: tuple[str, ...] = ()
    """Corrected formula; () if the formula is right."""
    figure: str | None = None
    """Name of the figure that shows the claim, or None."""
    implied: bool = False
    """Whether the report draws or codes the claim without saying it in words."""
    right: str = ""
    """Correct statement in a few words, for a claim that is not true; "" if the converged value
    says it.
    """

    @property
    def is_of_report(self) -> bool:
        """Whether the report makes the claim."""
        return bool(self.quote) or ": the report" in self.source.section

    @property
    def needs(self) -> tuple[str, ...]:
        """Names of the experiments that decide it."""
        return self.examiner.needs or tuple(filter(None, [self.figure]))

    @property
    def is_number(self) -> bool:
        """Whether it is a number; otherwise it is true or false, and the report says true."""
        return bool(self.printed) or self.unit is not None

    @property
    def number(self) -> str:
        """The number as printed, without its unit."""
        return self.printed.partition(" ")[0]

    @property
    def units(self) -> str:
        """The unit of the values; "1" for plain numbers and for what is true or false."""
        return self.unit or self.printed.partition(" ")[2] or "1"

    def judge(self, data: Data, quick: bool) -> "Judgement":
        """Return the judgement of the claim by the data of the experiments it needs."""
        datasets = [data[name] for name in self.needs]
        options = {"printed": number(self.number)} if self.examiner.takes_printed else {}
        return Judgement(self, self.examiner.examine(*datasets, **options), quick)


@dataclass(frozen=True)
class Judgement:
    """A claim with its finding."""

    claim: Claim
    finding: Finding
    quick: bool

    @property
    def reported(self) -> Value:
        """Value that the report states."""
        if not self.claim.is_number:
            return True
        return number(self.claim.number) if self.finding.reported is None else self.finding.reported

    @property
    def tolerance(self) -> Tolerance | None:
        """Largest difference that counts as agreement; None for a claim that is true or false."""
        if not self.claim.is_number:
            return None
        return self.claim.examiner.tolerance or half_last_digit(self.claim.number)

    @property
    def verdict(self) -> Verdict:
        """Verdict by `RULE`."""
        values = (self.finding.listing, self.finding.chosen)
        by_method = [value for value in values if value is not None]
        method_agrees = any(map(self._agrees_with, by_method))
        if self._agrees_with(self.finding.converged):
            return Verdict.REPRODUCED if method_agrees or not by_method else Verdict.UPHELD
        return Verdict.EXPLAINED if method_agrees else Verdict.CORRECTED

    def _agrees_with(self, value: Value) -> bool:
        """Return whether the report's value agrees with this one."""
        if self.tolerance is None:
            return bool(self.reported) == bool(value)
        # Rounding must not decide at the bound itself: 7.4 and 7.45 differ by half a digit.
        return abs(self.reported - value) <= self.tolerance.value * (1.0 + 1e-9)

    def record(self) -> dict[str, object]:
        """Return the judgement as plain data."""
        claim, finding = self.claim, self.finding
        tolerance = self.tolerance
        return {
            "id": claim.id,
            "source": asdict(claim.source),
            "statement": claim.text,
            "implied": claim.implied,
            "reported": _plain(self.reported),
            "reported_as": claim.number or None,
            "listing": _plain(finding.listing),
            "listing_chosen": _plain(finding.chosen),
            "listing_choice": finding.choice or None,
            "converged": _plain(finding.converged),
            "unit": claim.units,
            "tolerance": tolerance and tolerance.value,
            "tolerance_from": tolerance and tolerance.reason,
            "verdict": self.verdict.name.lower(),
            "note": finding.note,
            "shown_in": claim.figure,
            "experiments": list(claim.needs),
            "quick": self.quick,
        }


def count_verdicts(judgements: Iterable[Judgement]) -> dict[str, int]:
    """Return the number of judgements of each verdict, by its name in lower case, zeros
    included.
    """
    counts = Counter(judgement.verdict for judgement in judgements)
    return {verdict.name.lower(): counts[verdict] for verdict in Verdict}


def in_words(counts: Mapping[str, int]) -> str:
    """Return the number of all claims as text, with the verdicts that occur in brackets."""
    verdicts = ", ".join(f"{number} {name}" for name, number in counts.items() if number)
    return f"{sum(counts.values())}" + (f" ({verdicts})" if verdicts else "")


EXAMINERS: dict[str, Examiner] = {}
"""Examiners by the names of their claims; `tippetop.report.claims.registry` registers all of
them.
"""


def examines(
    claim: str,
    *needs: str,
    tolerance: Tolerance | None = None,
    takes_printed: bool = False,
    **options: Any,
) -> Callable[[Callable[..., Finding]], Callable[..., Finding]]:
    """Return a decorator that registers a function as the examiner of a claim.

    See `Examiner` for the arguments; `options` are further keywords of the function. Raises
    `ValueError` if the claim has an examiner already.
    """

    def register(examine: Callable[..., Finding]) -> Callable[..., Finding]:
        if claim in EXAMINERS:
            raise ValueError(f"the claim {claim} is examined twice")
        EXAMINERS[claim] = Examiner(needs, tolerance, partial(examine, **options), takes_printed)
        return examine

    return register


def both(run: xr.Dataset, name: str) -> tuple[float, float]:
    """Return a number by the report's method, and converged."""
    return float(run[f"{name}_listing"]), float(run[name])


def listed(template: str, *columns: Iterable[object], between: str = ", ") -> str:
    """Return a text of rows, each formatted by the template from the values of the columns."""
    return between.join(template.format(*row) for row in zip(*columns, strict=True))


def number(printed: str) -> float:
    """Return a number as printed, pi included."""
    return math.pi if printed == "pi" else float(printed)


def _plain(value: Value | None) -> float | bool | None:
    """Return a value as JSON can hold it: None if it is not finite."""
    if value is None or isinstance(value, bool):
        return value
    return float(value) if math.isfinite(value) else None
