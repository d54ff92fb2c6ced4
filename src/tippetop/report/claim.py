"""Claims: what the report says, what its own method gives, what is true, and the rule that decides."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import Enum
from typing import TypeAlias

import xarray as xr

Value: TypeAlias = float | bool
Data: TypeAlias = Mapping[str, xr.Dataset]
"""Datasets by the name of the experiment that made them."""


class Verdict(Enum):
    """What became of a claim; the value says when."""

    REPRODUCED = "the converged value agrees with the reported one"
    EXPLAINED = "the converged value does not, but the report's own method gives the reported one"
    CORRECTED = "neither the converged value nor the report's own method gives the reported one"


RULE = (
    "A claim is reproduced if the converged value agrees with the reported one within the tolerance; "
    "explained if it does not, but the report's own method does (directly, or for some choice that the "
    "report leaves open); corrected otherwise. The tolerance is half a unit of the last printed digit unless "
    "the record says otherwise."
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
class Statement:
    """What the report says.

    Attributes
    ----------
    id
        Name of the claim.
    source
        Where it stands.
    text
        What is claimed.
    printed
        The number as printed, or "" where the claim is not a number or `Finding.reported` has it.
    unit
        Its unit.
    holds
        For a claim that is true or false: what the report says. None for a number.
    tolerance, tolerance_from
        What counts as agreement where the printed digits do not say it, and why that.
    """

    id: str
    source: Source
    text: str
    printed: str = ""
    unit: str = "1"
    holds: bool | None = None
    tolerance: float | None = None
    tolerance_from: str = ""


@dataclass(frozen=True)
class Finding:
    """What a run finds about a claim.

    Attributes
    ----------
    listing
        What the report's own method gives; None where it has nothing to say.
    converged
        What is true.
    note
        What else there is to know.
    listing_range, range_over
        What the report's method gives over the choices that the report leaves open, and which they are.
    reported
        What the report's printed formula evaluates to, where the claim is a formula.
    """

    listing: Value | None
    converged: Value
    note: str
    listing_range: tuple[float, float] | None = None
    range_over: str = ""
    reported: float | None = None


@dataclass(frozen=True)
class Claim:
    """A statement, how to examine it, and which figure shows it.

    Attributes
    ----------
    statement
        What the report says.
    needs
        Names of the experiments that decide it.
    figure
        Name of our figure that shows it, or None.
    examine
        Computes the finding from the experiments' datasets.
    """

    statement: Statement
    needs: tuple[str, ...]
    figure: str | None
    examine: Callable[[Data], Finding]

    @property
    def id(self) -> str:
        """Name of the claim."""
        return self.statement.id


@dataclass(frozen=True)
class Judgement:
    """A claim that was examined."""

    claim: Claim
    finding: Finding
    quick: bool

    @property
    def reported(self) -> Value:
        """What the report says, as a value."""
        statement = self.claim.statement
        if statement.holds is not None:
            return statement.holds
        return number(statement.printed) if self.finding.reported is None else self.finding.reported

    @property
    def tolerance(self) -> float | None:
        """What counts as agreement; None for claims that are true or false."""
        statement = self.claim.statement
        if statement.holds is not None:
            return None
        if statement.tolerance is not None:
            return statement.tolerance
        return half_last_digit(statement.printed)

    @property
    def verdict(self) -> Verdict:
        """What the values say."""
        finding = self.finding
        return decide(
            self.reported, finding.listing, finding.converged, self.tolerance, finding.listing_range
        )

    def record(self) -> dict[str, object]:
        """The claim as plain data."""
        statement, finding = self.claim.statement, self.finding
        source = statement.source
        span = finding.listing_range
        return {
            "id": self.claim.id,
            "source": {"figure": source.figure, "equation": source.equation, "section": source.section},
            "statement": statement.text,
            "reported": _plain(self.reported),
            "reported_as": statement.printed or None,
            "listing": _plain(finding.listing),
            "listing_range": [_plain(bound) for bound in span] if span else None,
            "listing_range_over": finding.range_over or None,
            "converged": _plain(finding.converged),
            "unit": statement.unit,
            "tolerance": self.tolerance,
            "tolerance_from": statement.tolerance_from
            or (None if self.tolerance is None else "half a unit of the last printed digit"),
            "verdict": self.verdict.name.lower(),
            "note": finding.note,
            "shown_in": self.claim.figure,
            "experiments": list(self.claim.needs),
            "quick": self.quick,
        }


class Chapter:
    """Collects the claims of a module."""

    def __init__(self) -> None:
        self.claims: list[Claim] = []

    def claim(
        self, statement: Statement, *, needs: tuple[str, ...], figure: str | None = None
    ) -> Callable[[Callable[[Data], Finding]], Callable[[Data], Finding]]:
        """Register the decorated function as what examines a statement."""

        def register(examine: Callable[[Data], Finding]) -> Callable[[Data], Finding]:
            self.claims.append(Claim(statement, needs, figure, examine))
            return examine

        return register


def decide(
    reported: Value,
    listing: Value | None,
    converged: Value,
    tolerance: float | None,
    listing_range: tuple[float, float] | None = None,
) -> Verdict:
    """The verdict on a claim; see `RULE`.

    Parameters
    ----------
    reported, listing, converged
        What the report says, what its method gives (None: nothing) and what is true.
    tolerance
        Largest difference that counts as agreement; None for values that are true or false.
    listing_range
        Least and greatest value of the report's method over the choices it leaves open.
    """
    if _agree(reported, converged, tolerance):
        return Verdict.REPRODUCED
    if listing is not None and _agree(reported, listing, tolerance):
        return Verdict.EXPLAINED
    if listing_range is not None and tolerance is not None:
        low, high = listing_range
        if low - tolerance <= reported <= high + tolerance:
            return Verdict.EXPLAINED
    return Verdict.CORRECTED


def _agree(reported: Value, found: Value, tolerance: float | None) -> bool:
    if tolerance is None:
        return bool(reported) == bool(found)
    # A bound that rounding alone decides is met: 7.4 and 7.45 differ by half a digit.
    return abs(reported - found) <= tolerance * (1.0 + 1e-9)


def number(printed: str) -> float:
    """A number as printed, pi included."""
    return math.pi if printed == "pi" else float(printed)


def half_last_digit(printed: str) -> float:
    """Half a unit of the last digit of a printed number: 0.05 for "7.4", 0.5 for "170"."""
    decimals = len(printed.partition(".")[2])
    return 0.5 * 10.0**-decimals


def _plain(value: Value | None) -> float | bool | None:
    """A value as JSON can have it: no numbers of other kinds, and nothing that is not finite."""
    if value is None or isinstance(value, bool):
        return value
    return float(value) if math.isfinite(value) else None
