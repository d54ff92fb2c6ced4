"""A launch as the page knows it: a problem and how long to follow it, as a link holds them."""

import json
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from difflib import get_close_matches
from typing import Any, Self
from urllib.parse import urlencode

from tippetop.errors import InvalidInput
from tippetop.presets import report_problem
from tippetop.problem import Problem

LONGEST = 120.0
"""Longest run on the page, s."""
LONGEST_VALUE = 200
"""Longest value or name of a field in a link, letters."""

_PLAIN = {"duration", *Problem.model_fields}


@dataclass(frozen=True)
class Setup:
    """What is launched, and for how long.

    Attributes
    ----------
    problem
        The physics.
    duration
        Length of the run, s.
    """

    problem: Problem
    duration: float = 20.0

    def __post_init__(self) -> None:
        if not (math.isfinite(self.duration) and 0.0 < self.duration <= LONGEST):
            raise InvalidInput("duration", self.duration, f"a number greater than 0 and at most {LONGEST:g}")

    def changed(self, changes: Mapping[str, Any]) -> Self:
        """Copy with some fields replaced, named with dots; `duration` is one of them.

        Raises
        ------
        InvalidInput
            If there is no such field, or it cannot have such a value.
        """
        others = {name: value for name, value in changes.items() if name != "duration"}
        problem = self.problem.replace(others) if others else self.problem
        return replace(
            self, problem=problem, duration=_number("duration", changes.get("duration", self.duration))
        )

    @property
    def query(self) -> str:
        """The launch as the query of a link: every field by its name with dots."""
        fields = dict(_leaves(json.loads(self.problem.to_json())))
        return urlencode({**fields, "duration": repr(self.duration).removesuffix(".0")})


def first_setup() -> Setup:
    """What the page shows when nobody asked for anything: the report's first launch."""
    return Setup(report_problem())


def read_query(query: Mapping[str, str]) -> Setup:
    """The launch of a link; what it does not name is as in the first launch.

    Raises
    ------
    InvalidInput
        If the link names a field that does not exist, or a value that cannot be. A name unlike those of
        fields is passed over: others add utm_source and the like to links that they pass on.
    """
    fields = {name: value for name, value in query.items() if _may_be_meant(name)}
    return first_setup().changed({name: _parsed(name, value) for name, value in fields.items()})


def _may_be_meant(name: str) -> bool:
    """Whether a name in a link is, or is like, a field's."""
    return len(name) <= LONGEST_VALUE and ("." in name or bool(get_close_matches(name, _PLAIN)))


def _leaves(fields: Mapping[str, Any], prefix: str = "") -> Iterator[tuple[str, str]]:
    for name, value in fields.items():
        if isinstance(value, dict):
            yield from _leaves(value, f"{prefix}{name}.")
        else:
            yield f"{prefix}{name}", value if isinstance(value, str) else json.dumps(value)


def _parsed(name: str, value: str) -> Any:
    """A value of a link: a number or list as in JSON, or else a word."""
    if len(value) > LONGEST_VALUE:
        raise InvalidInput(name, value, f"at most {LONGEST_VALUE} letters")
    try:
        return json.loads(value)
    except (ValueError, RecursionError):
        return value


def _number(field: str, value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise InvalidInput(field, value, "a finite number")
    return float(value)
