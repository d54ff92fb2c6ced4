"""Texts of accounts: the facts of a run, and the English sentences with their numbers."""

import json
import math
from collections.abc import Mapping
from functools import lru_cache
from importlib import resources
from typing import Any, NamedTuple

import xarray as xr

from tippetop.contact.mode import Event, EventKind, Status
from tippetop.problem.problem import Problem
from tippetop.results.account import Clause, Facts, account_of
from tippetop.results.catalogue import METRICS
from tippetop.results.dataset import require_run
from tippetop.results.time_digits import time_digits, usual_digits

MILLISECONDS, METRE = 0.01, 1.0
"""Times below the first, s, are written in milliseconds, distances below the second, m, in
millimetres."""


class Account(NamedTuple):
    """Account of a run as clauses; `str` gives English sentences.

    Examples
    --------
    >>> import tippetop as tt
    >>> account = tt.describe(tt.simulate(tt.presets.report_problem(spin=155.0), duration=8.0))
    >>> len(account.clauses) > 1
    True
    """

    clauses: tuple[Clause, ...]
    uncertainties: Mapping[str, float] = {}
    """How far a minute change of the launch moves the times, s, by the names of their clauses."""

    def rounded(self, uncertainties: Mapping[str, float]) -> "Account":
        """Return the account with no more digits of its times than `time_uncertainties` leaves."""
        return self._replace(uncertainties=dict(uncertainties))

    def _phrase(self, clause: Clause) -> str:
        return phrase(clause, self.uncertainties.get(clause.name, 0.0))

    def __str__(self) -> str:
        sentences = [self._phrase(clause) for clause in self.clauses]
        subjects = [_english()["subject"], *[_english()["pronoun"]] * len(sentences)]
        return " ".join(
            f"{subject} {text}." for subject, text in zip(subjects, sentences, strict=False)
        )

    @property
    def headline(self) -> str:
        """Motion and end, as one phrase without a subject."""
        clauses = [clause for clause in self.clauses if clause.part in ("motion", "end")]
        return "; ".join(map(self._phrase, clauses))

    @property
    def details(self) -> tuple[str, ...]:
        """Launch and theory, as sentences."""
        pronoun = _english()["pronoun"]
        clauses = [clause for clause in self.clauses if clause.part in ("launch", "theory")]
        return tuple(f"{pronoun} {self._phrase(clause)}." for clause in clauses)

    def plain(self) -> list[dict[str, Any]]:
        """Return the clauses as plain dictionaries of name and numbers."""
        return [{"name": clause.name, **clause.numbers} for clause in self.clauses]


def describe(run: xr.Dataset) -> Account:
    """Return the account of a run: its launch, motion and end, and what theory says of them.

    Raises `InvalidInput` if the argument is no run.

    Examples
    --------
    >>> import tippetop as tt
    >>> account = tt.describe(tt.simulate(tt.presets.report_problem(spin=155.0), duration=20.0))
    >>> [clause.name for clause in account.clauses]
    ['starts_without_slip', 'turns_over', 'settles_inverted']
    >>> print(account.headline.partition(";")[0])
    turns over: its axis passes the horizontal at 5.88 s
    """
    require_run(run)
    return Account(tuple(account_of(facts_of(run))))


def facts_of(run: xr.Dataset) -> Facts:
    """Return the facts of a run that its account uses; events of users' functions are left out."""
    times, impulses = run["event_time"].values, run["event_impulse"].values
    rows = zip(
        run["event_kind"].values,
        times.tolist(),
        impulses.tolist(),
        run["event_energy_lost"].values.tolist(),
        run["event_surface"].values.tolist(),
        strict=True,
    )
    kinds = {kind.value for kind in EventKind}
    events = [Event(EventKind(kind), *numbers) for kind, *numbers in rows if kind in kinds]
    flights = zip(
        run["flight_start"].values.tolist(), run["flight_end"].values.tolist(), strict=True
    )
    return Facts(
        Problem.from_json(run.attrs["problem"]),
        Status[run.attrs["status"].upper()],
        {name: run[name].item() for name in METRICS},
        (run["max_tilt"].item(), run["max_tilt_time"].item()),
        run["settling_time"].item(),
        events,
        list(flights),
    )


def phrase(clause: Clause, uncertainty: float = 0.0) -> str:
    """Return a clause in English, without its subject, its time to an uncertainty, s."""
    texts = _english()
    gaps = {name: written(name, value, texts["units"]) for name, value in clause.numbers.items()}
    if "time" in gaps and uncertainty > 0.0:
        gaps["time"] = written_time(clause.numbers["time"], uncertainty, texts["units"])
    return str(texts["clauses"][clause.name].format(**gaps))


@lru_cache
def _english() -> dict[str, Any]:
    text = resources.files("tippetop.results").joinpath("account_en.json").read_text("utf-8")
    texts: dict[str, Any] = json.loads(text)
    return texts


def written(gap: str, value: float, units: Mapping[str, str]) -> str:
    """Return a number for people, with the unit for its placeholder in a text."""
    match gap:
        case "time" | "duration":
            if 0.0 < value < MILLISECONDS:
                return f"{_digits(1e3 * value, 3)} {units['short']}"
            return f"{_digits(value, usual_digits(value))} {units['time']}"
        case "about":
            return f"{_digits(value, 2)} {units['time']}"
        case "tilt" | "highest":
            return f"{_digits(round(math.degrees(value), 1), 4)}°"
        case "force":
            return f"{_digits(value, 3)} {units['force']}"
        case "spin" | "precession":
            return f"{_digits(value, 4)} {units['spin']}"
        case "height" | "length" | "other_length":
            return f"{_digits(1e3 * value, 4)} {units['length']}"
        case "distance":
            if value < METRE:
                return f"{_digits(1e3 * value, 3)} {units['length']}"
            return f"{_digits(value, 3)} {units['distance']}"
        case "energy":
            return f"{_digits(1e6 * value, 4)} {units['energy']}"
        case "speed":
            return f"{_digits(value, 3)} {units['speed']}"
    return f"{value:.0f}"


def written_time(time: float, uncertainty: float, units: Mapping[str, str]) -> str:
    """Return a time without the digits that an uncertainty takes from it, both in s."""
    digits = time_digits(time, uncertainty)
    size, unit = (1e3, "short") if time < MILLISECONDS else (1.0, "time")
    return f"{_digits(size * time, digits)} {units[unit]}" if digits else str(_english()["chance"])


def _digits(value: float, count: int) -> str:
    """Return a number with `count` digits, a true minus sign, and no sign before zero."""
    rounded = float(f"{value:.{count}g}")
    if abs(rounded) < ZERO:
        return "0"
    text = f"{rounded:.{count}g}"
    text = f"{rounded:f}".rstrip("0").rstrip(".") if "e" in text and abs(rounded) < 1e6 else text
    return text.replace("-", "−")


ZERO = 1e-4
"""Size below which a number for people is written as 0, in its unit: it is rounding."""
