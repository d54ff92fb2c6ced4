"""Launches that are drawn from distributions or listed one by one, as the cells of a sweep.

A field holds a list of one number a draw, a range ``{ from, to, spacing }``, or a distribution of
`scipy.stats` with its parameters by SciPy's names: ``{ distribution = "norm", loc = 150, scale = 5
}``.
"""

from collections.abc import Collection, Mapping, Sequence
from typing import Annotated, Any, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_serializer, model_validator

from tippetop.integrators.base import Array
from tippetop.support.errors import MISSING, Described, InvalidInput, within_part
from tippetop.support.suggestions import UNKNOWN
from tippetop.support.validation import Number, Part, Whole
from tippetop.sweeps.axes import Count, Entry, Flat, Spacing, between, in_si_of, listed
from tippetop.sweeps.grid import (
    DRAW,
    check_fields,
    drawn_coordinates,
    entries_by_field,
    read_fields,
    shares_of,
)

MOST_NUMBERS = 10**6
"""Numbers that may be listed in all: they are kept in the description of a sweep."""

ACCEPTED = (
    "one number a draw, a range { from, to }, or a distribution: anything with a method ppf, or a"
    " table such as { distribution = 'norm', loc = 150, scale = 5 }"
)


class Column(Entry):
    """Values of one field, draw by draw."""

    field: str

    @classmethod
    def of(cls, field: str, entry: Any) -> "Column":
        """Return the column that is stated as numbers, a distribution or a table."""
        if isinstance(entry, Column):
            return entry
        if callable(getattr(entry, "ppf", None)):
            return _distribution(field, entry)
        numbers = listed(field, entry)
        if numbers is not None:
            return ListedColumn.written(field, {"values": numbers})
        if not isinstance(entry, Mapping):
            raise InvalidInput(field, entry, ACCEPTED)
        if "values" in entry:
            return ListedColumn.written(field, entry)
        if "distribution" in entry:
            return DrawnColumn.named(field, entry)
        return RangeColumn.written(field, entry)

    def at(self, first: int, last: int, seed: int, place: int) -> Array:
        """Return the values from a first draw to before a last, shape (last - first,).

        `place` is the number of the field among those that are drawn.
        """
        raise NotImplementedError

    def resolved(self, count: int, seed: int, place: int) -> "Column":
        """Return a column that can be written: this one, unless its distribution has no name."""
        return self


class ListedColumn(Column):
    """Values that are listed: "values" where they are written."""

    numbers: tuple[Number, ...] = Field(alias="values", min_length=1)

    def at(self, first: int, last: int, seed: int, place: int) -> Array:
        """Return the values from a first draw to before a last."""
        return np.array(self.numbers[first:last])


class RangeColumn(Column):
    """Values drawn with equal probability between two, or between their logarithms."""

    low: Number = Field(alias="from")
    high: Number = Field(alias="to")
    """The ends; "from" and "to" where they are written."""
    spacing: Spacing = "linear"
    """"linear", or "log" for equal probability of equal ratios."""

    @model_validator(mode="after")
    def _can_be_drawn_from(self) -> Self:
        is_log = self.spacing == "log"
        if self.low > self.high or (is_log and self.low <= 0):
            raise InvalidInput(
                "",
                Described(f"{self.low:g} to {self.high:g}"),
                "a low and a higher end" + ", both above 0" * is_log,
                "is no range",
            )
        return self

    def at(self, first: int, last: int, seed: int, place: int) -> Array:
        """Return the values at shares that follow from the seed and the number of the draw."""
        shares = shares_of(seed, place, first, last)
        return between(self.low, self.high, shares, self.spacing == "log")


class DrawnColumn(Column):
    """Values drawn from a distribution of `scipy.stats`, written with SciPy's parameters."""

    distribution: str
    """Its name in `scipy.stats`: "norm", "lognorm", "uniform", "gamma" ..."""
    parameters: dict[str, Number] = Field(default_factory=dict)
    """Shape parameters, loc and scale, by SciPy's names; loc is 0 and scale 1 if omitted."""

    @classmethod
    def named(cls, field: str, table: Mapping[str, Any]) -> Self:
        """Return the column of a table with the distribution's name and its parameters."""
        if "field" in table:
            return cls.written(field, table)
        numbers = dict(table)
        name = numbers.pop("distribution")
        # A number with a unit is a value of the field only where it is a location or a scale.
        for key in ("loc", "scale"):
            if key not in numbers:
                continue
            try:
                numbers[key] = in_si_of(field, numbers[key])
            except InvalidInput as error:
                raise within_part(error, f"{field}.{key}") from None
        return cls.written(field, {"distribution": name, "parameters": numbers})

    @model_validator(mode="after")
    def _has_quantiles(self) -> Self:
        family, shapes = self._family()
        # Distributions of whole numbers have no scale.
        names = [*shapes, "loc", *(["scale"] if hasattr(family, "pdf") else [])]
        for name in self.parameters:
            if name not in names:
                raise InvalidInput(
                    name, self.parameters[name], f"one of {', '.join(names)}", UNKNOWN
                )
        for name in shapes:
            if name not in self.parameters:
                raise InvalidInput(name, MISSING, f"a shape parameter of {self.distribution}")
        if not np.isfinite(self._quantiles(np.array([0.5]))).all():
            written = ", ".join(f"{name} = {value:g}" for name, value in self.parameters.items())
            accepted = "a scale above 0" if "scale" in self.parameters else "other parameters"
            stated = Described(f"{self.distribution} with {written}")
            raise InvalidInput("", stated, accepted, "is not a distribution")
        return self

    @model_serializer
    def _written(self) -> dict[str, Any]:
        return {"field": self.field, "distribution": self.distribution, **self.parameters}

    def _family(self) -> tuple[Any, list[str]]:
        """Return the distribution and the names of its shape parameters."""
        from scipy import stats  # noqa: PLC0415 - slow to import

        family: Any = getattr(stats, self.distribution, None)
        if not callable(getattr(family, "ppf", None)):
            raise InvalidInput(
                "distribution", self.distribution, "the name of a distribution in scipy.stats"
            )
        return family, shape_names(family)

    def _quantiles(self, shares: Array) -> Array:
        family, _ = self._family()
        return np.asarray(family.ppf(shares, **self.parameters), np.float64)

    def at(self, first: int, last: int, seed: int, place: int) -> Array:
        """Return the quantiles of shares that follow from the seed and the number of the draw."""
        return self._quantiles(shares_of(seed, place, first, last))


class QuantileColumn(Column):
    """Values drawn from an object with a method `ppf` that has no name in `scipy.stats`."""

    source: Any

    def resolved(self, count: int, seed: int, place: int) -> Column:
        """Return the values of all draws, listed."""
        values = self.at(0, count, seed, place)
        return ListedColumn.written(self.field, {"values": tuple(values.tolist())})

    def at(self, first: int, last: int, seed: int, place: int) -> Array:
        """Return the quantiles of shares that follow from the seed and the number of the draw."""
        shares = shares_of(seed, place, first, last)
        try:
            values = np.asarray(self.source.ppf(shares), np.float64)
            values = np.broadcast_to(values, shares.shape)
        except Exception as error:
            refusal = InvalidInput(self.field, self.source, "a method ppf that takes an array")
            raise refusal from error
        return values


class Draws(Part):
    """Draws of launches: some fields of a problem, each drawn or listed, along a dimension `draw`.

    Attributes
    ----------
    columns
        The fields and their values or distributions.
    count
        Number of draws.
    seed
        Seed of the random numbers; a draw does not depend on how many there are.
    """

    columns: tuple[Column, ...]
    count: Count
    seed: Annotated[Whole, Field(ge=0)] = 0

    @model_validator(mode="after")
    def _agree(self) -> Self:
        check_fields("draw", self.fields)
        lists = [one for one in self.columns if isinstance(one, ListedColumn)]
        for column in lists:
            if len(column.numbers) != self.count:
                raise InvalidInput(
                    column.field,
                    Described(f"{len(column.numbers)} values"),
                    f"one a draw: {self.count}",
                )
        if len(lists) * self.count > MOST_NUMBERS:
            raise InvalidInput(
                "draw", Described(f"{len(lists) * self.count} numbers"), f"at most {MOST_NUMBERS}"
            )
        return self

    @classmethod
    def of(cls, table: Any, count: int | None = None, seed: int = 0) -> "Draws":
        """Return the draws that a table of fields, or a DataFrame, states.

        Raises `InvalidInput` if the columns differ in length, or none has one and `count` is None.
        """
        if isinstance(table, cls):
            return table
        columns = columns_of(table)
        return cls(columns=columns, count=count_of(columns, count), seed=seed).resolved()

    def resolved(self) -> "Draws":
        """Return the draws with columns that can be written."""
        columns = tuple(
            column.resolved(self.count, self.seed, place)
            for place, column in enumerate(self.columns)
        )
        return self if columns == self.columns else self.model_copy(update={"columns": columns})

    @property
    def written(self) -> dict[str, Any]:
        """The fields as they are written."""
        return entries_by_field(self.columns)

    @property
    def fields(self) -> tuple[str, ...]:
        """The fields that are drawn, named with dots."""
        return tuple(column.field for column in self.columns)

    @property
    def shape(self) -> tuple[int, ...]:
        """Number of draws."""
        return (self.count,)

    def dimensions(self, reserved: Collection[str] = ()) -> tuple[str, ...]:
        """Return the one dimension: the draws."""
        return (DRAW,)

    def values(self, cells: Flat) -> dict[str, Array]:
        """Return the values of the fields in these draws."""
        first, last = int(cells.min()), int(cells.max()) + 1
        return {
            column.field: column.at(first, last, self.seed, place)[cells - first]
            for place, column in enumerate(self.columns)
        }

    def coordinates(self, reserved: Collection[str] = ()) -> dict[str, tuple[str, NDArray[Any]]]:
        """Return the number of every draw, and the values drawn, as coordinates by names that are
        not `reserved`.
        """
        return drawn_coordinates(self.values(np.arange(self.count)), self.count, reserved)


def columns_of(table: Any) -> tuple[Column, ...]:
    """Return the columns of a table of fields, or of a DataFrame."""
    if hasattr(table, "columns") and hasattr(table, "to_dict"):
        table = {str(name): table[name] for name in table.columns}
    return read_fields("draw", table, Column.of)


def count_of(columns: Sequence[Column], count: int | None) -> int:
    """Return the number of draws, by default that of the listed values."""
    if count is not None:
        return count
    lengths = {len(one.numbers) for one in columns if isinstance(one, ListedColumn)}
    if not lengths:
        raise InvalidInput("count", MISSING, "the number of draws")
    return max(lengths)


def shape_names(family: Any) -> list[str]:
    """Return the names of the shape parameters of a distribution of `scipy.stats`."""
    return [name.strip() for name in family.shapes.split(",")] if family.shapes else []


def _distribution(field: str, distribution: Any) -> Column:
    """Return the column of an object with a method `ppf`, by its name in `scipy.stats` if it is a
    frozen distribution from there.
    """
    family = getattr(distribution, "dist", None)
    name = getattr(family, "name", None)
    if name is None or not _is_in_scipy(name, family):
        return QuantileColumn.written(field, {"source": distribution})
    shapes = shape_names(family)
    positional = dict(zip([*shapes, "loc", "scale"], distribution.args, strict=False))
    parameters = {key: float(value) for key, value in (positional | distribution.kwds).items()}
    return DrawnColumn.written(field, {"distribution": name, "parameters": parameters})


def _is_in_scipy(name: str, family: Any) -> bool:
    """Return whether `scipy.stats` has a distribution of this name and class."""
    from scipy import stats  # noqa: PLC0415 - slow to import

    return type(getattr(stats, name, None)) is type(family)
