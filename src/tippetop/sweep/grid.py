"""What a sweep goes over: axes that cross, or draws at random, over fields of a problem."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from tippetop.errors import InvalidInput, one_of
from tippetop.integrators.base import Array

LINEAR, GEOMETRIC, LISTED = "linear", "geometric", "listed"
UNIFORM, LOG_UNIFORM = "uniform", "log-uniform"

MOST_CELLS = 10**8
"""Cells a sweep may have."""

Flat = NDArray[np.int64]


class Grid(Protocol):
    """The cells of a sweep, numbered row by row."""

    @property
    def shape(self) -> tuple[int, ...]:
        """How many cells along every dimension."""

    @property
    def dimensions(self) -> tuple[str, ...]:
        """The names of the dimensions."""

    @property
    def fields(self) -> tuple[str, ...]:
        """The fields that change from cell to cell."""

    def values(self, cells: Flat) -> dict[str, Array]:
        """The values of the fields in these cells, each of shape (n,)."""

    def coordinates(self) -> dict[str, tuple[str, NDArray[Any]]]:
        """The coordinates: by name, the dimension they lie along, and their values."""

    def describe(self) -> dict[str, Any]:
        """The grid as plain numbers and words, from which `grid_from` makes it again."""


@dataclass(frozen=True)
class Axis:
    """Values of one field.

    Attributes
    ----------
    field
        Which, with dots: ``launch.spin``.
    numbers
        The first and the last value of a linear or geometric axis; all values of a listed one.
    count
        How many values there are.
    spacing
        "linear", "geometric" or "listed".
    """

    field: str
    numbers: tuple[float, ...]
    count: int
    spacing: str = LINEAR

    def __post_init__(self) -> None:
        given = ", ".join(f"{number:g}" for number in self.numbers)
        if self.spacing not in (LINEAR, GEOMETRIC, LISTED):
            choices = one_of(self.spacing, [LINEAR, GEOMETRIC, LISTED])
            raise InvalidInput(f"axis {self.field}", self.spacing, choices)
        if not self.numbers or not all(math.isfinite(number) for number in self.numbers):
            raise InvalidInput(f"axis {self.field}", given, "finite numbers")
        if self.count < 1:
            raise InvalidInput(f"axis {self.field}", self.count, "at least one value")
        if self.spacing == LISTED:
            if len(set(self.numbers)) < len(self.numbers):
                raise InvalidInput(f"axis {self.field}", given, "values that differ from one another")
        elif len(self.numbers) != 2 or (self.count > 1 and self.numbers[0] == self.numbers[1]):
            raise InvalidInput(f"axis {self.field}", given, "a first and a last value that differ")
        if self.spacing == GEOMETRIC and self.numbers[0] * self.numbers[1] <= 0:
            raise InvalidInput(f"axis {self.field}", given, "ends of one sign, neither 0, if geometric")

    @classmethod
    def linear(cls, field: str, first: float, last: float, count: int) -> "Axis":
        """Equally spaced values, both ends among them."""
        return cls(field, (float(first), float(last)), count, LINEAR)

    @classmethod
    def geometric(cls, field: str, first: float, last: float, count: int) -> "Axis":
        """Values in equal ratios, both ends among them."""
        return cls(field, (float(first), float(last)), count, GEOMETRIC)

    @classmethod
    def listed(cls, field: str, values: Sequence[float]) -> "Axis":
        """These values."""
        return cls(field, tuple(float(value) for value in values), len(values), LISTED)

    @classmethod
    def parse(cls, text: str) -> "Axis":
        """Read FIELD=FIRST:LAST:COUNT, FIELD=FIRST:LAST:COUNT:geo, or FIELD=A,B,C.

        Raises
        ------
        InvalidInput
            If the text is none of these.
        """
        form = "FIELD=FIRST:LAST:COUNT, FIELD=FIRST:LAST:COUNT:geo, or FIELD=A,B,C"
        field, equals, rest = text.partition("=")
        parts = rest.split(":")
        try:
            if equals and len(parts) == 1:
                return cls.listed(field.strip(), [float(value) for value in rest.split(",")])
            if equals and len(parts) in (3, 4):
                spacing = _spacing(parts[3]) if len(parts) == 4 else LINEAR
                return cls(field.strip(), (float(parts[0]), float(parts[1])), int(parts[2]), spacing)
        except (ValueError, KeyError) as error:
            if isinstance(error, InvalidInput):
                raise
        raise InvalidInput("--axis", text, form)

    @property
    def values(self) -> Array:
        """All values, shape (count,)."""
        return self.at(np.arange(self.count))

    def at(self, places: Flat) -> Array:
        """Some of the values, by their places, without making the others."""
        if self.spacing == LISTED:
            return np.array(self.numbers)[places]
        first, last = self.numbers
        share = places / max(self.count - 1, 1)
        inner = first + (last - first) * share if self.spacing == LINEAR else first * (last / first) ** share
        return np.where(places == self.count - 1, last if self.count > 1 else first, inner)


def _spacing(word: str) -> str:
    return {"geo": GEOMETRIC, "geometric": GEOMETRIC, "lin": LINEAR, "linear": LINEAR}[word.strip()]


@dataclass(frozen=True)
class Product:
    """Every combination of the values of some axes; the last axis changes fastest."""

    axes: tuple[Axis, ...]

    def __post_init__(self) -> None:
        names = [axis.field for axis in self.axes]
        if not names:
            raise InvalidInput("axes", names, "at least one axis")
        if len(set(names)) < len(names):
            raise InvalidInput("axes", ", ".join(names), "fields that differ from one another")
        _check_count(math.prod(self.shape))

    @property
    def shape(self) -> tuple[int, ...]:
        """How many cells along every dimension."""
        return tuple(axis.count for axis in self.axes)

    @property
    def dimensions(self) -> tuple[str, ...]:
        """The names of the dimensions: the fields."""
        return tuple(axis.field for axis in self.axes)

    @property
    def fields(self) -> tuple[str, ...]:
        """The fields that change from cell to cell."""
        return self.dimensions

    def values(self, cells: Flat) -> dict[str, Array]:
        """The values of the fields in these cells."""
        places = np.unravel_index(cells, self.shape)
        return {axis.field: axis.at(place) for axis, place in zip(self.axes, places, strict=True)}

    def coordinates(self) -> dict[str, tuple[str, NDArray[Any]]]:
        """The coordinates."""
        return {axis.field: (axis.field, axis.values) for axis in self.axes}

    def describe(self) -> dict[str, Any]:
        """The grid as plain numbers and words."""
        return {"axes": [_plain(vars(axis)) for axis in self.axes]}


@dataclass(frozen=True)
class Range:
    """Where the values of a field are drawn from.

    Attributes
    ----------
    field
        Which, with dots.
    low, high
        The ends of the range.
    law
        "uniform" or "log-uniform".
    """

    field: str
    low: float
    high: float
    law: str = UNIFORM

    def __post_init__(self) -> None:
        if self.law not in (UNIFORM, LOG_UNIFORM):
            raise InvalidInput(f"draw {self.field}", self.law, one_of(self.law, [UNIFORM, LOG_UNIFORM]))
        least = 0.0 if self.law == LOG_UNIFORM else -math.inf
        if not (math.isfinite(self.low) and math.isfinite(self.high) and least < self.low <= self.high):
            accepted = "a range of finite numbers" + (" above 0" if self.law == LOG_UNIFORM else "")
            raise InvalidInput(f"draw {self.field}", f"{self.low:g} to {self.high:g}", accepted)

    @classmethod
    def parse(cls, text: str) -> "Range":
        """Read FIELD=LOW:HIGH or FIELD=LOW:HIGH:log.

        Raises
        ------
        InvalidInput
            If the text is neither.
        """
        field, equals, rest = text.partition("=")
        parts = rest.split(":")
        if equals and (len(parts) == 2 or parts[2:] == ["log"]):
            try:
                low, high = float(parts[0]), float(parts[1])
            except ValueError:
                pass
            else:
                return cls(field.strip(), low, high, LOG_UNIFORM if len(parts) == 3 else UNIFORM)
        raise InvalidInput("--draw", text, "FIELD=LOW:HIGH, or FIELD=LOW:HIGH:log")


@dataclass(frozen=True)
class Draws:
    """Independent draws at random.

    Attributes
    ----------
    ranges
        The fields and where their values are drawn from.
    count
        How many draws.
    seed
        What the draws follow from; a draw does not depend on how many there are.
    """

    ranges: tuple[Range, ...]
    count: int
    seed: int = 0

    def __post_init__(self) -> None:
        names = [entry.field for entry in self.ranges]
        if not names or len(set(names)) < len(names):
            raise InvalidInput("draws", ", ".join(names), "at least one field, none of them twice")
        if self.seed < 0:
            raise InvalidInput("seed", self.seed, "a whole number, at least 0")
        _check_count(self.count)

    @property
    def shape(self) -> tuple[int, ...]:
        """How many draws."""
        return (self.count,)

    @property
    def dimensions(self) -> tuple[str, ...]:
        """One dimension: the draws."""
        return ("draw",)

    @property
    def fields(self) -> tuple[str, ...]:
        """The fields that change from draw to draw."""
        return tuple(entry.field for entry in self.ranges)

    def values(self, cells: Flat) -> dict[str, Array]:
        """The values of the fields in these draws."""
        first = int(cells.min())
        drawn = self._drawn(first, int(cells.max()) + 1)
        return {field: values[cells - first] for field, values in drawn.items()}

    def coordinates(self) -> dict[str, tuple[str, NDArray[Any]]]:
        """The number of every draw, and the values drawn."""
        found: dict[str, tuple[str, NDArray[Any]]] = {"draw": ("draw", np.arange(self.count))}
        found |= {field: ("draw", values) for field, values in self._drawn(0, self.count).items()}
        return found

    def _drawn(self, first: int, last: int) -> dict[str, Array]:
        """The draws from first to before last, without making those before."""
        found = {}
        for place, entry in enumerate(self.ranges):
            source = np.random.PCG64([self.seed, place]).advance(first)
            shares = np.random.Generator(source).random(last - first)
            if entry.law == LOG_UNIFORM:
                found[entry.field] = entry.low * (entry.high / entry.low) ** shares
            else:
                found[entry.field] = entry.low + (entry.high - entry.low) * shares
        return found

    def describe(self) -> dict[str, Any]:
        """The grid as plain numbers and words."""
        return {
            "draws": {
                "count": self.count,
                "seed": self.seed,
                "ranges": [_plain(vars(entry)) for entry in self.ranges],
            }
        }


def grid_from(description: Mapping[str, Any]) -> Product | Draws:
    """The grid of a description; see `Grid.describe`."""
    if "axes" in description:
        axes = (
            Axis(entry["field"], tuple(entry["numbers"]), entry["count"], entry["spacing"])
            for entry in description["axes"]
        )
        return Product(tuple(axes))
    draws = description["draws"]
    return Draws(tuple(Range(**entry) for entry in draws["ranges"]), draws["count"], draws["seed"])


def _plain(fields: Mapping[str, Any]) -> dict[str, Any]:
    return {name: list(value) if isinstance(value, tuple) else value for name, value in fields.items()}


def _check_count(count: int) -> None:
    if not 1 <= count <= MOST_CELLS:
        raise InvalidInput("sweep", count, f"from 1 to {MOST_CELLS} cells")
