"""A sweep: a base problem, the cells over it, and how they are computed."""

import math
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import cached_property
from pathlib import Path
from typing import Annotated, Any, Self, TypeAlias

import numpy as np
from numpy.typing import NDArray
from pydantic import BeforeValidator, Field, model_validator

from tippetop.graph.own_parts import require_recordable
from tippetop.integrators.base import Array
from tippetop.problem.problem import Problem, top_of
from tippetop.results.catalogue import SAMPLED
from tippetop.results.checked_times import listed_times, sample_times
from tippetop.support.errors import MISSING, Described, InvalidInput
from tippetop.support.files import made_of, read_text
from tippetop.support.parsing import parse_toml
from tippetop.support.suggestions import not_one_of
from tippetop.support.validation import (
    Number,
    Part,
    Positive,
    Quantity,
    Whole,
    in_order,
    require_names,
)
from tippetop.sweeps.axes import Count
from tippetop.sweeps.cells import cells_of
from tippetop.sweeps.draws import Column, Draws, columns_of
from tippetop.sweeps.grid import Product
from tippetop.theory.requirements import require_jellett

DEFAULT_TOLERANCE = 1e-9
SAMPLED_TOLERANCE = 1e-11
"""Relative error per step where samples are kept, if nobody says what it is: phases gather errors,
and with 1e-10 fast tops are off by more than 1e-10 times the condition of their launches.
"""

SETTLED_RANGE = (1e-6, 1e-2)
"""Tilts, rad, that may count as settled: above rounding, and small enough that nothing more
happens.
"""
LEAST_TOLERANCE = float(np.finfo(float).eps)

DEFAULT_KEPT_SAMPLES = 201
"""Number of samples that are kept of a run if nobody says how many."""

EVENTS = "events"
"""Name under which the events of every launch are kept."""

DEFAULT_MOST_EVENTS = 20
"""Number of events that are kept of a run at most if nobody says how many."""

MOST_COMPONENTS = 3
"""Most components of a variable that is kept."""

NUMBERS_OF_AN_EVENT = 5
"""How many numbers are kept of an event."""

MOST_NUMBERS_A_TASK = 2**23
"""Numbers of samples in a task, about, at most: 64 MB."""

MOST_CELLS_A_TASK = 4096
LEAST_CELLS_A_TASK = 256
TASKS = 16
"""A task is a chunk of the store: about a 16th of the cells, within these bounds."""


GRIDS = ("over", "draw")
"""The ways to state the cells of a sweep, by the names that they are written under."""

Task: TypeAlias = tuple[int, ...]
"""The place of a task among those along every dimension."""


def _names(value: Any) -> Any:
    """Return names of variables, of which there may be one, or none."""
    return () if value is None or value == () else tuple(require_names("keep", value, "tilt"))


def _seconds(value: Any) -> Any:
    """Return listed times in s, or None."""
    return None if value is None else tuple(listed_times(value).tolist())


class Sweep(Part):
    """What to compute, over a `grid` of cells: the axes of `over`, or `draw`.

    Raises `InvalidInput` if a field is none, the duration is not positive, or the tolerance is out
    of range; or if runs are to end when they have settled, and the tops do not conserve Jellett's
    integral.
    """

    problem: Problem
    """The problem whose fields are changed."""
    over: Annotated[Product, BeforeValidator(Product.of)] | None = None
    """The cells as axes that cross."""
    draw: Annotated[tuple[Column, ...], BeforeValidator(columns_of)] | None = None
    """The cells as fields and how the values of each are drawn."""
    count: Count | None = None
    """Number of draws; by default that of listed values."""
    seed: Annotated[Whole, Field(ge=0)] | None = None
    """Seed of random draws; 0 by default."""
    duration: Annotated[Positive, Quantity("s", "length of every run")] = 20.0
    """Length of every run, s."""
    tolerance: Annotated[Number, Field(ge=LEAST_TOLERANCE, le=1e-3)] = DEFAULT_TOLERANCE
    """Relative error per step; `SAMPLED_TOLERANCE` by default where samples are kept."""
    settled: Annotated[
        Number | None,
        Field(ge=SETTLED_RANGE[0], le=SETTLED_RANGE[1]),
        Quantity("rad", "tilt that a settled run keeps within"),
    ] = None
    """A run ends once its energy holds the tilt within this for good, rad (see
    `tippetop.theory.prediction.is_held`); None to follow every run for its whole duration.
    """
    keep: Annotated[tuple[str, ...], BeforeValidator(_names)] = ()
    """Variables over time of which samples are kept, of `SAMPLED`; and `EVENTS`."""
    samples: Annotated[Whole, Field(ge=2)] | None = None
    """Number of equally spaced samples from launch to the duration; 201 by default."""
    times: Annotated[tuple[Number, ...], BeforeValidator(_seconds)] | None = None
    """Sample times instead, s."""
    most_events: Annotated[Whole, Field(ge=1)] | None = None
    """Number of events that are kept of a run, the first ones; 20 by default."""

    def __init__(self, /, *values: Any, **fields: Any) -> None:
        fields = in_order(
            type(self), ("problem", "grid", "duration", "tolerance", "settled"), values, fields
        )
        if fields.get("keep"):
            fields.setdefault("tolerance", SAMPLED_TOLERANCE)
        grid = fields.pop("grid", None)
        if grid is not None:
            stated = (
                {"draw": grid.columns, "count": grid.count, "seed": grid.seed}
                if isinstance(grid, Draws)
                else {"over": grid}
            )
            for name in [name for name in stated if fields.get(name, name) is None]:
                del fields[name]
            fields = in_order(type(self), stated, tuple(stated.values()), fields)
        super().__init__(**fields)

    @model_validator(mode="after")
    def _can_be_computed(self) -> Self:
        chosen = [name for name in GRIDS if getattr(self, name) is not None]
        if len(chosen) != 1:
            stated = Described(" and ".join(chosen)) if chosen else MISSING
            fault = "are given together" if chosen else ""
            raise InvalidInput(", ".join(GRIDS), stated, "one of them", fault)
        if self.draw is None:
            self._refuse("draw", ("count", "seed"))
        self._require_samples()
        require_recordable(top_of(self.problem))
        if self.settled is not None:
            require_jellett(top_of(self.problem))
            for name in self.grid.fields:
                if name.startswith(("table.", "air.")):
                    raise InvalidInput(
                        "settled",
                        self.settled,
                        "",
                        f"holds where Jellett's integral does, and {name} is swept",
                        "omit it",
                    )
        with _only_refusals():
            cells_of(self.problem, self.grid.values(np.arange(1)))
        return self

    def _refuse(self, required: str, names: Sequence[str]) -> None:
        """Refuse fields that are only for another field, which is not given."""
        for name in names:
            value = getattr(self, name)
            if value is not None:
                raise InvalidInput(name, value, "", f"is only for {required}", "omit it")

    def _require_samples(self) -> None:
        """Refuse samples that cannot be kept."""
        if not self.sampled:
            self._refuse("samples of variables in keep", ("samples", "times"))
        if EVENTS not in self.keep:
            self._refuse('"events" in keep', ("most_events",))
        for name in self.keep:
            if name not in (*SAMPLED, EVENTS):
                raise not_one_of("keep", name, [*SAMPLED, EVENTS])
        if len(set(self.keep)) < len(self.keep):
            raise InvalidInput("keep", list(self.keep), "every variable once")
        if self.samples is not None and self.times is not None:
            raise InvalidInput("samples", self.samples, "", "is given beside times", "omit one")
        _ = self.sample_times

    @property
    def sampled(self) -> tuple[str, ...]:
        """Names of the variables of which samples are kept."""
        return tuple(name for name in self.keep if name != EVENTS)

    @property
    def event_places(self) -> int:
        """How many events of every launch are kept at most; 0 if none are."""
        return (self.most_events or DEFAULT_MOST_EVENTS) if EVENTS in self.keep else 0

    @property
    def sample_times(self) -> Array:
        """Times of the samples that are kept, s, shape (k,); none if nothing is kept."""
        if not self.sampled:
            return np.empty(0)
        return sample_times(self.duration, self.samples or DEFAULT_KEPT_SAMPLES, self.times)

    @property
    def dimensions(self) -> tuple[str, ...]:
        """Names of the dimensions of the launches."""
        return self.grid.dimensions(self.keep)

    def coordinates(self) -> dict[str, tuple[str, NDArray[Any]]]:
        """Return the coordinates of the launches: the dimension and the values of each, by name."""
        return self.grid.coordinates(self.keep)

    @cached_property
    def grid(self) -> Product | Draws:
        """The cells."""
        if self.over is not None:
            return self.over
        assert self.draw is not None
        return Draws.of(self.draw, self.count, self.seed or 0)

    @property
    def cells(self) -> int:
        """How many cells there are."""
        return math.prod(self.grid.shape)

    @cached_property
    def chunk(self) -> tuple[int, ...]:
        """How many cells of every dimension make a task; it does not depend on who computes
        them.
        """
        target = min(max(self.cells // TASKS, LEAST_CELLS_A_TASK), MOST_CELLS_A_TASK)
        numbers = len(self.sample_times) * len(self.sampled) * MOST_COMPONENTS
        numbers += self.event_places * NUMBERS_OF_AN_EVENT
        target = min(target, max(MOST_NUMBERS_A_TASK // max(numbers, 1), 1))
        chunk = list(self.grid.shape)
        while math.prod(chunk) > target and max(chunk) > 1:
            longest = chunk.index(max(chunk))
            chunk[longest] = -(-chunk[longest] // 2)
        return tuple(chunk)

    @property
    def tasks(self) -> list[Task]:
        """The places of all tasks, row by row."""
        counts = [-(-size // part) for size, part in zip(self.grid.shape, self.chunk, strict=True)]
        return [tuple(int(k) for k in place) for place in np.ndindex(*counts)]

    def region(self, task: Task) -> tuple[slice, ...]:
        """Return the cells of a task along every dimension."""
        parts = zip(task, self.chunk, self.grid.shape, strict=True)
        return tuple(slice(k * part, min((k + 1) * part, size)) for k, part, size in parts)

    def numbers(self, region: tuple[slice, ...]) -> Any:
        """Return the numbers of the cells of a region, counted row by row over the sweep, in its
        shape.
        """
        ranges = [np.arange(part.start, part.stop) for part in region]
        return np.ravel_multi_index(np.ix_(*ranges), self.grid.shape)

    def to_fields(self) -> dict[str, Any]:
        """Return the sweep as plain numbers and words, as in a file: ``Sweep(**fields)`` is the
        sweep.
        """
        grid = self.grid
        fields = self.model_dump(
            mode="json", by_alias=True, exclude_none=True, exclude={"draw", "count", "seed"}
        )
        if not self.keep:
            del fields["keep"]
        if isinstance(grid, Draws):
            fields |= {"draw": grid.written, "count": grid.count, "seed": grid.seed}
        return fields

    @classmethod
    def read(cls, path: Path | str) -> "Sweep":
        """Read a sweep from a TOML file.

        Raises `FileTrouble` if the file cannot be read; `InvalidInput` if it does not hold a sweep.
        """
        fields = parse_toml(read_text(path, "a sweep in TOML"), "sweep", Path(path).name)
        if isinstance(fields.get("problem"), str):
            fields["problem"] = Problem.read(Path(path).parent / fields["problem"])
        with made_of(path):
            return cls(**fields)


@contextmanager
def _only_refusals() -> Iterator[None]:
    """Let fields that cannot be swept be refused; whatever else the first cell raises is its
    outcome.
    """
    try:
        yield
    except (InvalidInput, MemoryError):
        raise
    except Exception:  # noqa: BLE001 - whatever was raised
        return


def is_sweep(fields: Mapping[str, Any]) -> bool:
    """Return whether the tables of a TOML file are those of a sweep rather than of a problem."""
    return bool({*GRIDS, "duration"} & set(fields)) or isinstance(fields.get("problem"), dict | str)
