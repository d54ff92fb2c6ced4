"""What a sweep goes over: axes that cross, and the names of fields, coordinates and dimensions.

Axes are written as a table by fields, the same in TOML, in JSON and on the command line.
"""

import math
from collections import Counter
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from typing import Any, Self, TypeVar

import numpy as np
from numpy.typing import NDArray
from pydantic import model_serializer, model_validator

from tippetop.integrators.base import Array
from tippetop.results.catalogue import SWEPT
from tippetop.support.errors import Described, InvalidInput
from tippetop.support.parsing import DEEPEST
from tippetop.sweeps.axes import MOST_CELLS, Axis, Entry
from tippetop.sweeps.axes import Flat as Flat

_Kind = TypeVar("_Kind")

ENTRIES = {"from", "to", "values", "distribution"}
"""Keys of which a table that states the values of a field has one, and no other table."""

DRAW = "draw"
"""The dimension of launches that are drawn."""


class Product(Entry):
    """Every combination of the values of some axes; the last axis changes fastest."""

    axes: tuple[Axis, ...]

    def __init__(self, /, *axes: Iterable[Axis], **fields: Any) -> None:
        # Said again for mypy, which takes it that values need names.
        super().__init__(*axes, **fields)

    @model_validator(mode="after")
    def _crosses(self) -> Self:
        check_fields("over", self.fields)
        if math.prod(self.shape) > MOST_CELLS:
            raise InvalidInput(
                "over",
                Described(" x ".join(map(str, self.shape)) + " cells"),
                f"at most {MOST_CELLS:,}",
                "are too many",
            )
        return self

    @classmethod
    def of(cls, table: Any) -> "Product":
        """Return the product of a table of axes by their fields, or of pairs."""
        return table if isinstance(table, cls) else cls(read_fields("over", table, Axis.of))

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

    def dimensions(self, reserved: Collection[str] = ()) -> tuple[str, ...]:
        """Return the names of the dimensions: short ones of the fields, but those `reserved`."""
        return tuple(short_names(self.fields, reserved).values())

    def values(self, cells: Flat) -> dict[str, Array]:
        """Return the values of the fields in these cells."""
        places = np.unravel_index(cells, self.shape)
        return {axis.field: axis.at(place) for axis, place in zip(self.axes, places, strict=True)}

    def coordinates(self, reserved: Collection[str] = ()) -> dict[str, tuple[str, NDArray[Any]]]:
        """Return the coordinates, by names that are not `reserved`: the dimension and the values of
        each.
        """
        names = zip(self.dimensions(reserved), self.axes, strict=True)
        return {name: (name, axis.values) for name, axis in names}


RESERVED_NAMES = {DRAW, "is_done", *SWEPT}
"""Names in a sweep's dataset that no coordinate of a field may have."""


def short_names(fields: Sequence[str], reserved: Collection[str] = ()) -> dict[str, str]:
    """Return the names of coordinates by the fields that they hold.

    A name is the last word of the field, spin of launch.spin, where no other field has the same,
    it is not `reserved` by a variable and it can be written in a query; elsewhere it is the whole
    field.
    """
    reserved = {*RESERVED_NAMES, *reserved}
    words = {field: field.rpartition(".")[2] for field in fields}
    counts = Counter(words.values())
    return {
        field: word if counts[word] == 1 and word.isidentifier() and word not in reserved else field
        for field, word in words.items()
    }


def field_paths(fields: Sequence[str], reserved: Collection[str] = ()) -> dict[str, str]:
    """Return fields, named with dots, by the names of their coordinates."""
    return {name: field for field, name in short_names(fields, reserved).items()}


def drawn_coordinates(
    values: Mapping[str, Array], count: int, reserved: Collection[str] = ()
) -> dict[str, tuple[str, NDArray[Any]]]:
    """Return the number of every draw, and the values of its fields, as coordinates."""
    coordinates: dict[str, tuple[str, NDArray[Any]]] = {DRAW: (DRAW, np.arange(count))}
    names = short_names(list(values), reserved)
    return coordinates | {names[field]: (DRAW, drawn) for field, drawn in values.items()}


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
    """Return what is written of axes or columns, by their fields."""
    tables = {entry.field: entry.model_dump(by_alias=True) for entry in entries}
    for table in tables.values():
        del table["field"]
    return tables


def read_fields(name: str, table: Any, of: Callable[[str, Any], _Kind]) -> tuple[_Kind, ...]:
    """Return the axes or columns of a table, or of pairs of a field and an entry."""
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
