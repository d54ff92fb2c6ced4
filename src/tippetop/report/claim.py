"""Claims: what the report says, what its own method gives, what is true, and the rule that
decides.
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
"""Datasets by the name of the experiment that made them."""


class Verdict(Enum):
    """What became of a claim; the value says when."""

    REPRODUCED = "true, and what the report's own method gives"
    UPHELD = "true, although the report's own method does not give it"
    EXPLAINED = "not true, but what the report's own method gives"
    CORRECTED = "neither true nor what the report's own method gives"


RULE = (
    "Every claim is compared with the converged value, which says whether it is true, and with what"
    " the report's own method gives, where it gives anything: directly, or for one stated choice of"
    " what the report leaves open; what is true is taken for the same choice, but a law has to be"
    " true for the report's main launch. They agree within half a unit of the last printed digit"
    " unless another tolerance is given, with its reason. What the report does not say in words,"
    " but draws or codes, is marked as implied."
)


@dataclass(frozen=True)
class Source:
    """Where the report makes a claim."""

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
    """What a run finds about a claim."""

    listing: Value | None
    """What the report's own method gives; None where it has nothing to say."""
    converged: Value
    """What is true."""
    note: str
    """What else there is to know."""
    chosen: Value | None = None
    choice: str = ""
    """What the report's method gives for one choice of what the report leaves open, and which
    choice.
    """
    reported: float | None = None
    """What the report's printed formula evaluates to, where the claim is a formula."""
    news: str = ""
    """What else is found that the report could not know, in a sentence; "" for nothing."""
    right: str = ""
    """What is right where the claim is not, in a few words with values; "" where the claim says
    it.
    """

    @classmethod
    def unlisted(cls, converged: Value, note: str, *choices: Any, **others: Any) -> "Finding":
        """Return a finding where the report's own method has nothing to say."""
        return cls(None, converged, note, *choices, **others)


class Examiner(NamedTuple):
    """How a claim is examined."""

    needs: tuple[str, ...]
    """Names of the experiments that decide it; () for the one called as its figure."""
    tolerance: Tolerance | None
    """What counts as agreement where the printed digits do not say it."""
    examine: Callable[..., Finding]
    """Computes the finding from the experiments' datasets, given in the order of `needs`."""


@dataclass(frozen=True)
class Claim:
    """What the report says, how to examine it, and which figure shows it."""

    id: str
    """Its name."""
    examiner: Examiner
    """How it is examined."""
    source: Source
    """Where it stands."""
    text: str
    """What is claimed."""
    quote: str = ""
    """What the report says, word for word and in its spelling; "" where it is not the report that
    says it.
    """
    printed: str = ""
    """The number as printed, with its unit; "" where the claim is not a number or
    `Finding.reported` has it.
    """
    unit: str | None = None
    """Unit of a number that is not printed; None if there is none."""
    formula: tuple[str, ...] = ()
    """A formula as the report sets it apart, in TeX as far as matplotlib sets it, a string a
    line.
    """
    formula_right: tuple[str, ...] = ()
    """What it should be; () where it is right."""
    figure: str | None = None
    """Name of our figure that shows it, or None."""
    implied: bool = False
    """Whether the report does not say it in words."""
    right: str = ""
    """What is right where the claim is not, in a few words; "" where the converged value says
    it.
    """

    @property
    def is_of_report(self) -> bool:
        """Whether the report makes the claim; otherwise someone else does."""
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
        """Examine the claim by the experiments it needs."""
        return Judgement(self, self.examiner.examine(*(data[name] for name in self.needs)), quick)


@dataclass(frozen=True)
class Judgement:
    """A claim that was examined."""

    claim: Claim
    finding: Finding
    quick: bool

    @property
    def reported(self) -> Value:
        """What the report says, as a value."""
        if not self.claim.is_number:
            return True
        return number(self.claim.number) if self.finding.reported is None else self.finding.reported

    @property
    def tolerance(self) -> Tolerance | None:
        """What counts as agreement; None for claims that are true or false."""
        if not self.claim.is_number:
            return None
        return self.claim.examiner.tolerance or half_last_digit(self.claim.number)

    @property
    def verdict(self) -> Verdict:
        """What the values say; see `RULE`."""
        given = [
            value for value in (self.finding.listing, self.finding.chosen) if value is not None
        ]
        theirs = any(map(self._agrees_with, given))
        if self._agrees_with(self.finding.converged):
            return Verdict.REPRODUCED if theirs or not given else Verdict.UPHELD
        return Verdict.EXPLAINED if theirs else Verdict.CORRECTED

    def _agrees_with(self, found: Value) -> bool:
        if self.tolerance is None:
            return bool(self.reported) == bool(found)
        # A bound that rounding alone decides is met: 7.4 and 7.45 differ by half a digit.
        return abs(self.reported - found) <= self.tolerance.value * (1.0 + 1e-9)

    def record(self) -> dict[str, object]:
        """Return the claim as plain data."""
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
    """Return the number of judgements of each verdict, by its name in lower case; 0 included."""
    counts = Counter(judgement.verdict for judgement in judgements)
    return {verdict.name.lower(): counts[verdict] for verdict in Verdict}


def in_words(counts: Mapping[str, int]) -> str:
    """Return the sum of the counts of verdicts, with those that are not 0 in brackets."""
    verdicts = ", ".join(f"{number} {name}" for name, number in counts.items() if number)
    return f"{sum(counts.values())}" + (f" ({verdicts})" if verdicts else "")


EXAMINERS: dict[str, Examiner] = {}
"""How claims are examined, by their names: those registered so far; take all from
`tippetop.report.claims.registry`.
"""


def examines(
    claim: str, *needs: str, tolerance: Tolerance | None = None, **options: Any
) -> Callable[[Callable[..., Finding]], Callable[..., Finding]]:
    """Register the decorated function, with some options, as what alone examines a claim; see
    `Examiner`.
    """

    def register(examine: Callable[..., Finding]) -> Callable[..., Finding]:
        if claim in EXAMINERS:
            raise ValueError(f"the claim {claim} is examined twice")
        EXAMINERS[claim] = Examiner(needs, tolerance, partial(examine, **options))
        return examine

    return register


def both(run: xr.Dataset, name: str) -> tuple[float, float]:
    """Return a number by the report's method and converged."""
    return float(run[f"{name}_listing"]), float(run[name])


def listed(template: str, *columns: Iterable[object], between: str = ", ") -> str:
    """Return the rows of some columns in words, each as the template says."""
    return between.join(template.format(*row) for row in zip(*columns, strict=True))


def number(printed: str) -> float:
    """Return a number as printed, pi included."""
    return math.pi if printed == "pi" else float(printed)


def _plain(value: Value | None) -> float | bool | None:
    """Return a value as JSON can have it: no numbers of other kinds, and nothing that is not
    finite.
    """
    if value is None or isinstance(value, bool):
        return value
    return float(value) if math.isfinite(value) else None
