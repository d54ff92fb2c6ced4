"""Launches sampled from distributions or listed one by one, as the cells of a sweep.

Samples are written as a table ``{ count, seed, fields }``. A field holds ``{ values }``, one number
a sample, or a distribution of `scipy.stats` by name: ``{ distribution = "norm", loc = 150, scale =
5 }``; ``{ law = "normal", mean, std }`` and ``{ law = "lognormal", median, sigma }`` are short for
two of them.
"""

from collections.abc import Mapping
from typing import Annotated, Any, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import BeforeValidator, Field, field_serializer, model_validator

from tippetop.integrators.base import Array
from tippetop.support.errors import Described, InvalidInput
from tippetop.support.validation import Number, Whole
from tippetop.sweeps.axes import Count, Entry, Flat
from tippetop.sweeps.grid import (
    SAMPLE,
    check_fields,
    entries_by_field,
    read_fields,
    sampled_coordinates,
    shares_of,
)

MOST_NUMBERS = 10**6
"""Numbers that listed samples may have in all: they are kept in the description of a sweep."""

ACCEPTED = (
    "one number a sample, a distribution of scipy.stats, or a table such as"
    " { law = 'normal', mean = 150, std = 5 }"
)


class Column(Entry):
    """The values of one field, sample by sample."""

    field: str

    @classmethod
    def of(cls, field: str, entry: Any) -> "Column":
        """Return the column that is given as numbers, a distribution or a table."""
        if hasattr(entry, "ppf") and hasattr(entry, "dist"):
            return _frozen(field, entry)
        if hasattr(entry, "tolist") and getattr(entry, "ndim", None) == 1:
            entry = entry.tolist()  # an array, or a Series
        if isinstance(entry, list | tuple | range):
            return ListedColumn.written(field, {"values": tuple(entry)})
        if not isinstance(entry, Mapping):
            raise InvalidInput(field, entry, ACCEPTED)
        if "values" in entry:
            return ListedColumn.written(field, entry)
        return DrawnColumn.written(field, _named(field, entry))

    def at(self, first: int, last: int, seed: int, place: int) -> Array:
        """Return the values from a first sample to before a last, shape (last - first,).

        `place` is the number of the field among those that are sampled.
        """
        raise NotImplementedError


class ListedColumn(Column):
    """These values: "values" where they are written."""

    numbers: tuple[Number, ...] = Field(alias="values", min_length=1)

    def at(self, first: int, last: int, seed: int, place: int) -> Array:
        """Return the values from a first sample to before a last."""
        return np.array(self.numbers[first:last])


class DrawnColumn(Column):
    """Values drawn from a distribution of `scipy.stats`."""

    distribution: str
    """Its name in `scipy.stats`: "norm", "lognorm", "uniform", "gamma" ..."""
    shape: tuple[Number, ...] = ()
    """Its shape parameters, in their order."""
    loc: Number = 0.0
    scale: Number = 1.0

    @model_validator(mode="after")
    def _has_quantiles(self) -> Self:
        if not np.isfinite(self._quantiles(np.array([0.5]))).all():
            raise InvalidInput("shape", list(self.shape), "parameters that the distribution has")
        return self

    def _quantiles(self, shares: Array) -> Array:
        from scipy import stats  # noqa: PLC0415 - slow to import

        family: Any = getattr(stats, self.distribution, None)
        if not hasattr(family, "ppf"):
            raise InvalidInput(
                "distribution", self.distribution, "the name of a distribution in scipy.stats"
            )
        if len(self.shape) != family.numargs:
            accepted = (
                f"the shape parameters {family.shapes}" if family.numargs else "no parameters"
            )
            raise InvalidInput("shape", list(self.shape), accepted)
        # Distributions of whole numbers have no scale.
        last = (self.loc, self.scale) if hasattr(family, "pdf") else (self.loc,)
        return np.asarray(family.ppf(shares, *self.shape, *last), np.float64)

    def at(self, first: int, last: int, seed: int, place: int) -> Array:
        """Return the quantiles of shares that follow from the seed and the sample's number."""
        return self._quantiles(shares_of(seed, place, first, last))


class LaunchSamples(Entry):
    """Samples of launches: some fields of a problem, each sampled, and one dimension `sample`.

    Attributes
    ----------
    columns
        The fields and their values or distributions; a table "fields" where they are written.
    count
        How many samples; left out where values are listed.
    seed
        What draws follow from; a sample does not depend on how many there are.
    """

    columns: Annotated[
        tuple[Column, ...], BeforeValidator(lambda table: read_fields("fields", table, Column.of))
    ] = Field(alias="fields")
    count: Count
    seed: Annotated[Whole, Field(ge=0)] = 0

    @model_validator(mode="after")
    def _agree(self) -> Self:
        check_fields("fields", self.fields)
        listed = [one for one in self.columns if isinstance(one, ListedColumn)]
        for column in listed:
            if len(column.numbers) != self.count:
                raise InvalidInput(
                    column.field,
                    Described(f"{len(column.numbers)} values"),
                    f"one a sample: {self.count}",
                )
        if len(listed) * self.count > MOST_NUMBERS:
            raise InvalidInput(
                "samples",
                Described(f"{len(listed) * self.count} numbers"),
                f"at most {MOST_NUMBERS}",
            )
        return self

    @classmethod
    def of(cls, table: Any, count: int | None, seed: int) -> "LaunchSamples":
        """Return the samples that a table of fields, or a DataFrame, states.

        Raises `InvalidInput` if the columns differ in length, or none has one and `count` is None.
        """
        if hasattr(table, "columns") and hasattr(table, "to_dict"):
            table = {str(name): table[name] for name in table.columns}
        columns = read_fields("samples", table, Column.of)
        if count is None:
            lengths = {len(one.numbers) for one in columns if isinstance(one, ListedColumn)}
            if not lengths:
                raise InvalidInput("n", count, "how many samples to draw")
            count = max(lengths)
        return cls(columns=columns, count=count, seed=seed)

    @field_serializer("columns")
    def _written(self, columns: tuple[Column, ...]) -> dict[str, Any]:
        return entries_by_field(columns)

    @property
    def fields(self) -> tuple[str, ...]:
        """The fields that are sampled."""
        return tuple(column.field for column in self.columns)

    @property
    def shape(self) -> tuple[int, ...]:
        """How many samples."""
        return (self.count,)

    @property
    def dimensions(self) -> tuple[str, ...]:
        """One dimension: the samples."""
        return (SAMPLE,)

    def values(self, cells: Flat) -> dict[str, Array]:
        """Return the values of the fields in these samples."""
        first, last = int(cells.min()), int(cells.max()) + 1
        return {
            column.field: column.at(first, last, self.seed, place)[cells - first]
            for place, column in enumerate(self.columns)
        }

    def coordinates(self) -> dict[str, tuple[str, NDArray[Any]]]:
        """Return the number of every sample, and the values sampled."""
        return sampled_coordinates(self.values(np.arange(self.count)), self.count)


def _frozen(field: str, distribution: Any) -> DrawnColumn:
    """Return the column of a frozen distribution of `scipy.stats`."""
    family = distribution.dist
    shapes = [name.strip() for name in family.shapes.split(",")] if family.shapes else []
    positional = dict(zip([*shapes, "loc", "scale"], distribution.args, strict=False))
    numbers = {"loc": 0.0, "scale": 1.0, **positional, **distribution.kwds}
    table = {
        "distribution": family.name,
        "shape": tuple(float(numbers[name]) for name in shapes),
        "loc": float(numbers["loc"]),
        "scale": float(numbers["scale"]),
    }
    return DrawnColumn.written(field, table)


def _named(field: str, entry: Mapping[str, Any]) -> dict[str, Any]:
    """Return a table with the law's own numbers as those of a distribution of `scipy.stats`."""
    table = dict(entry)
    law = table.pop("law", None)
    if law is None:
        if "distribution" not in table:
            raise InvalidInput(field, entry, ACCEPTED)
        return table
    names = {"normal": ("mean", "std"), "lognormal": ("median", "sigma")}.get(str(law))
    if names is None:
        raise InvalidInput(f"{field}.law", law, "'normal' or 'lognormal'; others by distribution")
    if set(table) != set(names):
        raise InvalidInput(field, entry, f"{names[0]} and {names[1]} beside law = {law!r}")
    first, second = (table[name] for name in names)
    if law == "normal":
        return {"distribution": "norm", "loc": first, "scale": second}
    return {"distribution": "lognorm", "shape": (second,), "scale": first}
