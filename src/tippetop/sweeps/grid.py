"""What a sweep goes over: axes that cross, or draws at random, over fields of a problem.

Both are written as tables by fields, the same in TOML, in JSON and on the command line; draws are a
table ``{ count, seed, fields }`` with ranges ``{ from, to, law }``.
"""

import math
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Annotated, Any, Literal, Self, TypeVar

import numpy as np
from numpy.typing import NDArray
from pydantic import BeforeValidator, Field, field_serializer, model_serializer, model_validator

from tippetop.integrators.base import Array
from tippetop.results.catalogue import SWEPT
from tippetop.support.errors import Described, InvalidInput
from tippetop.support.parsing import DEEPEST
from tippetop.support.validation import Number, Whole
from tippetop.sweeps.axes import MOST_CELLS, Axis, Count, Entry, between
from tippetop.sweeps.axes import Flat as Flat

_Kind = TypeVar("_Kind")

ENTRIES = {"from", "to", "values", "law", "distribution"}
"""Keys of which a table that states the values of a field has one, and no other table."""

SAMPLE = "sample"
"""The dimension of launches that are drawn or sampled."""


class Product(Entry):
    """Every combination of the values of some axes; the last axis changes fastest."""

    axes: tuple[Axis, ...]

    def __init__(self, /, *axes: Iterable[Axis], **fields: Any) -> None:
        # Said again for mypy, which takes it that values need names.
        super().__init__(*axes, **fields)

    @model_validator(mode="after")
    def _crosses(self) -> Self:
        check_fields("axes", self.fields)
        if math.prod(self.shape) > MOST_CELLS:
            raise InvalidInput(
                "axes",
                Described(" x ".join(map(str, self.shape)) + " cells"),
                f"at most {MOST_CELLS:,}",
                "are too many",
            )
        return self

    @classmethod
    def of(cls, table: Any) -> "Product":
        """Return the product of a table of axes by their fields, or of pairs."""
        return table if isinstance(table, cls) else cls(read_fields("axes", table, Axis.of))

    @model_serializer
    def _written(self) -> dict[str, Any]:
        return entries_by_field(self.axes)

    @property
    def shape(self) -> tuple[int, ...]:
        """How many cells along every dimension."""
        return tuple(axis.size for axis in self.axes)

    @property
    def fields(self) -> tuple[str, ...]:
        """The fields, named with dots."""
        return tuple(axis.field for axis in self.axes)

    @property
    def dimensions(self) -> tuple[str, ...]:
        """The names of the dimensions: short ones of the fields."""
        return tuple(short_names(self.fields).values())

    def values(self, cells: Flat) -> dict[str, Array]:
        """Return the values of the fields in these cells."""
        places = np.unravel_index(cells, self.shape)
        return {axis.field: axis.at(place) for axis, place in zip(self.axes, places, strict=True)}

    def coordinates(self) -> dict[str, tuple[str, NDArray[Any]]]:
        """Return the coordinates: the dimension and the values of each, by name."""
        return {
            name: (name, axis.values) for name, axis in zip(self.dimensions, self.axes, strict=True)
        }


class Range(Entry):
    """Where the values of a field are drawn from.

    Attributes
    ----------
    field
        Which, with dots.
    low
        The lower end of the range; "from" where it is written.
    high
        The upper end of the range; "to" where it is written.
    law
        "uniform" or "log-uniform".

    Examples
    --------
    >>> import tippetop as tt
    >>> tt.Range("friction.mu", 0.05, 1.0, "log-uniform").law
    'log-uniform'
    """

    field: str
    low: Number = Field(alias="from")
    high: Number = Field(alias="to")
    law: Literal["uniform", "log-uniform"] = "uniform"

    @model_validator(mode="after")
    def _can_be_drawn_from(self) -> Self:
        ends, logarithmic = f"{self.low:g} to {self.high:g}", self.law == "log-uniform"
        if self.low > self.high or (logarithmic and self.low <= 0):
            raise InvalidInput(
                "",
                Described(ends),
                "a low and a higher end" + ", both above 0" * logarithmic,
                "is no range",
            )
        return self

    @classmethod
    def of(cls, field: str, entry: Any) -> "Range":
        """Return the range of a field that is written as a table."""
        if not isinstance(entry, Mapping):
            raise InvalidInput(field, entry, "a table { from, to, law }")
        return cls.written(field, entry)


class Draws(Entry):
    """Independent draws at random.

    Attributes
    ----------
    ranges
        The fields and where their values are drawn from; a table "fields" where they are written.
    count
        How many draws.
    seed
        What the draws follow from; a draw does not depend on how many there are.

    Examples
    --------
    >>> import tippetop as tt
    >>> draws = tt.Draws((tt.Range("launch.spin", 10.0, 200.0),), count=3, seed=1)
    >>> tt.sweep(tt.presets.report_problem(), draws, duration=0.1).sizes["sample"]
    3
    """

    ranges: Annotated[
        tuple[Range, ...], BeforeValidator(lambda table: read_fields("fields", table, Range.of))
    ] = Field(alias="fields")
    count: Count
    seed: Annotated[Whole, Field(ge=0)] = 0

    @model_validator(mode="after")
    def _differ(self) -> Self:
        check_fields("fields", self.fields)
        return self

    @field_serializer("ranges")
    def _written(self, ranges: tuple[Range, ...]) -> dict[str, Any]:
        return entries_by_field(ranges)

    @property
    def shape(self) -> tuple[int, ...]:
        """How many draws."""
        return (self.count,)

    @property
    def fields(self) -> tuple[str, ...]:
        """The fields, named with dots."""
        return tuple(entry.field for entry in self.ranges)

    @property
    def dimensions(self) -> tuple[str, ...]:
        """One dimension: the draws, which are samples."""
        return (SAMPLE,)

    def values(self, cells: Flat) -> dict[str, Array]:
        """Return the values of the fields in these draws."""
        first = int(cells.min())
        drawn = self._drawn(first, int(cells.max()) + 1)
        return {field: values[cells - first] for field, values in drawn.items()}

    def coordinates(self) -> dict[str, tuple[str, NDArray[Any]]]:
        """Return the number of every draw, and the values drawn, as coordinates."""
        return sampled_coordinates(self._drawn(0, self.count), self.count)

    def _drawn(self, first: int, last: int) -> dict[str, Array]:
        """Return the draws from first to before last, without making those before."""
        drawn = {}
        for place, entry in enumerate(self.ranges):
            shares = shares_of(self.seed, place, first, last)
            drawn[entry.field] = between(entry.low, entry.high, shares, entry.law == "log-uniform")
        return drawn


RESERVED_NAMES = {SAMPLE, "status", *SWEPT}
"""Names in a sweep's dataset that no coordinate of a field may have."""


def short_names(fields: Sequence[str]) -> dict[str, str]:
    """Return the names of coordinates by the fields that they hold.

    A name is the last word of the field, spin of launch.spin, where no other field has the same
    and it can be written in a query; elsewhere it is the whole field.
    """
    words = {field: field.rpartition(".")[2] for field in fields}
    counts = Counter(words.values())
    return {
        field: word
        if counts[word] == 1 and word.isidentifier() and word not in RESERVED_NAMES
        else field
        for field, word in words.items()
    }


def field_paths(fields: Sequence[str]) -> dict[str, str]:
    """Return fields, named with dots, by the names of their coordinates."""
    return {name: field for field, name in short_names(fields).items()}


def sampled_coordinates(
    values: Mapping[str, Array], count: int
) -> dict[str, tuple[str, NDArray[Any]]]:
    """Return the number of every sample, and the values of its fields, as coordinates."""
    coordinates: dict[str, tuple[str, NDArray[Any]]] = {SAMPLE: (SAMPLE, np.arange(count))}
    names = short_names(list(values))
    return coordinates | {names[field]: (SAMPLE, sampled) for field, sampled in values.items()}


def shares_of(seed: int, place: int, first: int, last: int) -> Array:
    """Return uniform random numbers in (0, 1) of the draws from a first to before a last.

    They follow from the seed, the number of the field (`place`) and that of the draw alone.
    """
    source = np.random.PCG64([seed, place]).advance(first)
    return np.random.Generator(source).random(last - first) + 0.5**54


def check_fields(name: str, fields: Sequence[str]) -> None:
    """Raise `InvalidInput` unless there are fields, and none of them twice."""
    if not fields or len(set(fields)) < len(fields):
        raise InvalidInput(name, list(fields), "at least one field, and none of them twice")


def entries_by_field(entries: Iterable[Any]) -> dict[str, Any]:
    """Return what is written of axes, ranges or columns, by their fields."""
    return {entry.field: entry.model_dump(by_alias=True, exclude={"field"}) for entry in entries}


def read_fields(name: str, table: Any, of: Callable[[str, Any], _Kind]) -> tuple[_Kind, ...]:
    """Return the axes, ranges or columns of a table, or of pairs of a field and an entry."""
    if isinstance(table, tuple):
        return table
    if not (_pairs(table) or isinstance(table, Mapping)):
        raise InvalidInput(name, table, "a table of fields")
    fields = _flattened(name, table) if isinstance(table, Mapping) else table
    return tuple(of(field, entry) for field, entry in fields)


def _pairs(table: Any) -> bool:
    several = isinstance(table, list) and all(isinstance(one, tuple | list) for one in table)
    return several and all(len(one) == 2 and isinstance(one[0], str) for one in table)


def _flattened(name: str, table: Mapping[str, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    """Fields and what stands there, in their order: keys may be dotted keys of TOML, or strings
    with dots.
    """
    for key, value in table.items():
        field = f"{prefix}{key}"
        if "" in field.split("."):
            raise InvalidInput(name, field, "a name with single dots, such as launch.spin")
        if isinstance(value, Mapping) and not ENTRIES & set(value):
            if field.count(".") >= DEEPEST:
                raise InvalidInput(
                    name, value, f"at most {DEEPEST} tables deep", "is nested too deep"
                )
            yield from _flattened(name, value, f"{field}.")
        else:
            yield field, value
