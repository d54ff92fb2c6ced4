"""The values of one field that a sweep goes over: in equal steps, in equal ratios, or one by one.

An axis is written as a list of values or as a table ``{ from, to, count, spacing }``.
"""

import math
from collections.abc import Mapping
from functools import cache
from typing import Annotated, Any, Literal, Self, TypeAlias

import numpy as np
from numpy.typing import NDArray
from pydantic import BeforeValidator, ConfigDict, Field, model_validator
from pydantic_core import PydanticCustomError

from tippetop.integrators.base import Array
from tippetop.problem.problem import Problem
from tippetop.support.errors import Described, InvalidInput, within_part
from tippetop.support.units import is_quantity
from tippetop.support.validation import Number, Part, Quantity, Whole, declared_fields, in_order

MOST_CELLS = 10**8
"""Cells a sweep may have."""

NUMBERS = {"from", "to", "first", "last", "low", "high", "values", "numbers"}
"""The fields of entries that are numbers of the field that is swept."""

Flat = NDArray[np.int64]
Count = Annotated[Whole, Field(ge=1, le=MOST_CELLS)]


Spacing: TypeAlias = Literal["linear", "log"]
"""Equal steps, or equal ratios."""


def _no_word(value: Any) -> Any:
    if isinstance(value, str):
        raise PydanticCustomError("word", "a finite number: fields of words cannot be swept")
    return value


@cache
def units_of(field: str) -> tuple[str, ...]:
    """Return the SI units that a field of problems may have, those of all kinds of its part."""
    plain = ".".join(name for name in field.split(".") if not name.isdigit())
    return tuple(
        dict.fromkeys(
            item.units
            for name, info in declared_fields(Problem)
            if name == plain
            for item in info.metadata
            if isinstance(item, Quantity)
        )
    )


def in_si_of(field: str, value: Any) -> Any:
    """Return a number, or a list of them, for a field in SI; what has no unit as it is."""
    units = units_of(field)
    for place, unit in enumerate(units):
        try:
            return Quantity(unit, field).in_si(value)
        except InvalidInput:
            if place == len(units) - 1:
                raise
    return value


def listed(field: str, entry: Any) -> tuple[Any, ...] | None:
    """Return the values of a list, an array, a Series, a DataArray or a quantity of one dimension.

    Return None for everything else.
    """
    if is_quantity(entry):
        return tuple(in_si_of(field, entry)) if np.ndim(entry.magnitude) == 1 else None
    if isinstance(entry, list | tuple | range):
        return tuple(entry)
    if getattr(entry, "ndim", None) == 1 and hasattr(entry, "dtype"):
        return tuple(np.asarray(entry))
    return None


class Entry(Part):
    """A part of a grid: its fields may also be given in their order, and by the names they have in
    Python.
    """

    model_config = ConfigDict(populate_by_name=True)

    def __init__(self, /, *values: Any, **fields: Any) -> None:
        fields = in_order(type(self), type(self).model_fields, values, fields)
        named: Any = fields.get("field")
        for name in [*fields] if isinstance(named, str) else ():
            if name not in NUMBERS:
                continue
            try:
                fields[name] = in_si_of(named, fields[name])
            except InvalidInput as error:
                raise within_part(error, f"{named}.{name}") from None
        try:
            super().__init__(**fields)
        except InvalidInput as error:
            raise within_part(error, named if isinstance(named, str) else "") from None

    @classmethod
    def written(cls, field: str, table: Mapping[str, Any]) -> Self:
        """Return the entry of a field, from the table of its other keys."""
        if "field" in table:
            raise InvalidInput(
                f"{field}.field",
                table["field"],
                "",
                "is the name of the table already",
                "leave it out",
            )
        return cls(**{"field": field} | dict(table))


class Axis(Entry):
    """Values of one field, named with dots: ``launch.spin``."""

    field: str

    @classmethod
    def of(cls, field: str, entry: Any) -> "Axis":
        """Return the axis that is written as a list, an array or a table."""
        values = listed(field, entry)
        if values is not None:
            entry = {"values": values}
        if not isinstance(entry, Mapping):
            raise InvalidInput(field, entry, "a list of values, or { from, to, count, spacing }")
        return (Listed if "values" in entry else Spaced).written(field, entry)

    @property
    def size(self) -> int:
        """How many values there are."""
        raise NotImplementedError

    def at(self, places: Flat) -> Array:
        """Return the values at some places, without making the others."""
        raise NotImplementedError

    @property
    def values(self) -> Array:
        """All values, shape (size,)."""
        return self.at(np.arange(self.size))


class Spaced(Axis):
    """Values from a first to a last, in equal steps or in equal ratios."""

    first: Number = Field(alias="from")
    last: Number = Field(alias="to")
    """The ends, both among the values; "from" and "to" where they are written."""
    count: Count
    """How many values there are."""
    spacing: Spacing = "linear"
    """"linear" for equal steps, or "log" for equal ratios."""

    @model_validator(mode="after")
    def _has_values(self) -> Self:
        ends = f"{self.first:g} to {self.last:g}"
        if self.count > 1 and self.first == self.last:
            raise InvalidInput(
                "", Described(ends), "", "gives one value many times", "write ends that differ"
            )
        if self.spacing == "log":
            if not (self.first > 0 < self.last or self.first < 0 > self.last):
                raise InvalidInput(
                    "", Described(ends), "ends of one sign, neither 0", "cannot be in equal ratios"
                )
            apart = max(self.last / self.first, self.first / self.last)
        else:
            apart = self.last - self.first
        if not math.isfinite(apart):
            raise InvalidInput(
                "", Described(ends), "ends that are closer", "reaches too far for numbers"
            )
        return self

    @property
    def size(self) -> int:
        """How many values there are."""
        return self.count

    def at(self, places: Flat) -> Array:
        """Return the values at some places, without making the others."""
        inner = between(
            self.first, self.last, places / max(self.count - 1, 1), self.spacing == "log"
        )
        return np.where((places == self.count - 1) & (self.count > 1), self.last, inner)


def between(first: float, last: float, shares: Array, is_log: bool) -> Array:
    """Numbers between two after these shares of the way, by their ratio or by their difference."""
    return first * (last / first) ** shares if is_log else first + (last - first) * shares


class Listed(Axis):
    """These values: "values" where they are written."""

    numbers: tuple[Annotated[Number, BeforeValidator(_no_word)], ...] = Field(
        alias="values", min_length=1
    )

    @model_validator(mode="after")
    def _differ(self) -> Self:
        if len(set(self.numbers)) < len(self.numbers):
            raise InvalidInput("", list(self.numbers), "every value once", "has a value twice")
        return self

    @property
    def size(self) -> int:
        """How many values there are."""
        return len(self.numbers)

    def at(self, places: Flat) -> Array:
        """Return the values at some places."""
        return np.array(self.numbers)[places]
