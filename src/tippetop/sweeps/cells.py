"""The cells of a sweep as arrays of launches, and which of them cannot be.

No problem is built for a cell: the fields that change are put into the base problem as arrays, and
the mechanics makes arrays of them. What a problem would refuse is refused here by the same limits,
cell by cell.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any, TypeVar, cast

import numpy as np
from numpy.typing import NDArray

from tippetop.contact.natural_launch import automaton_of
from tippetop.contact.trajectory import LONGEST_RUN
from tippetop.integrators.base import Array
from tippetop.mechanics.motion import along_table, sliding_contact
from tippetop.mechanics.natural_units import Units
from tippetop.mechanics.state import State
from tippetop.mechanics.surfaces.hull import Hull, sizes
from tippetop.mechanics.surfaces.surface import support_at
from tippetop.mechanics.top import Top, natural_state, natural_units
from tippetop.problem.contact_rules import Contact
from tippetop.problem.problem import Problem, top_of
from tippetop.results.catalogue import Fault
from tippetop.support.errors import Described, InvalidInput, within_part
from tippetop.support.suggestions import unknown_field
from tippetop.support.validation import PLACES, Part
from tippetop.sweeps.flights import slips
from tippetop.sweeps.launch_arrays import Launches, Own, branched

PartType = TypeVar("PartType", bound=Part)


@dataclass(frozen=True)
class Cells:
    """Cells of a sweep."""

    fault: NDArray[np.int8]
    """Numbers of `Fault`, shape (n,)."""
    top: Top
    units: Units
    """The tops in SI, and their natural units; arrays of shape (n,), or one number for all."""
    start: State
    """States at launch in natural units, every number of shape (n,)."""
    problem: Problem
    """The problem whose fields are arrays of shape (n,) where they change."""

    def launches(self, which: NDArray[np.intp], duration: float) -> Launches:
        """Return some of the cells as launches."""
        count = len(self.fault)
        numbers = [spread(number, count)[which] for number in self.top.numbers]
        contact_rule = self.problem.contact
        return Launches(
            self.top.kind,
            np.array(numbers),
            State.unpack([number[which] for number in self.start.pack()]),
            np.minimum(duration / spread(self.units.time, count), LONGEST_RUN)[which],
            contact_rule.liftoff,
            spread(contact_rule.restitution, count)[which],
            contact_rule.indeterminate,
            contact_rule.face_pressure,
            self._own_rules(which),
        )

    def _own_rules(self, which: NDArray[np.intp]) -> Own | None:
        """Return the function that makes the rules of some of the cells, if their contact has its
        own.
        """
        contact_rule = self.problem.contact
        if type(contact_rule).rules is Contact.rules:
            return None
        units = [spread(unit, len(self.fault)) for unit in self.units]
        makers = np.empty(len(which), dtype=object)
        for place, cell in enumerate(which.tolist()):
            cell_units = Units(*(float(unit[cell]) for unit in units))
            makers[place] = partial(automaton_of, single_part(contact_rule, cell), units=cell_units)
        return makers


def _not_swept(problem: Problem, field: str, numeric: list[str]) -> InvalidInput:
    """Return the refusal of a swept field that does not exist, or is not a number."""
    swept = Described("what is swept")
    try:
        problem.get(field)
    except InvalidInput:
        return unknown_field(field, swept, numeric, PLACES)
    inside = [name for name in numeric if name.startswith(f"{field}.")]
    beside = [name for name in numeric if name.startswith(f"{field.rpartition('.')[0]}.")]
    accepted = f"one of {', '.join(inside or beside or numeric)}"
    return InvalidInput(field, swept, accepted, "is given for a field that is not a number")


def cells_of(problem: Problem, values: Mapping[str, Array]) -> Cells:
    """Return the cells that put these values, each of shape (n,), into a problem.

    Raises `InvalidInput` if a field is none, or not a number.
    """
    numeric = dict(numeric_fields(problem))
    for field in values:
        if field not in numeric:
            raise _not_swept(problem, field, list(numeric))
    if problem.launch.velocity is not None and any(
        field.startswith("launch.slip.") for field in values
    ):
        raise InvalidInput(
            "launch.slip",
            Described("what is swept"),
            "",
            "is determined by launch.velocity",
            "leave out one",
        )
    count = len(next(iter(values.values())))
    filled = put(problem, values)
    fault = np.full(count, Fault.NONE, dtype=np.int8)
    with np.errstate(all="ignore"):
        start = launch_state(filled, fault)
        top = branched(top_of(filled, np), start)
        if filled.contact.liftoff != "fly":
            sliding = along_table(start)
            touch = sliding_contact(*sliding, top)
            lifted = spread(filled.launch.gap, count) > 0.0
            fault[(~(touch.delassus > 0.0) & slips(start, top)) | lifted] = Fault.NO_CONTACT_FORCE
        fault[~(spread(filled.body.I3, count) <= 2.0 * spread(filled.body.I1, count))] = (
            Fault.NO_SUCH_BODY
        )
        for field, numbers in values.items():
            fault[~allowed(numbers, numeric[field])] = Fault.VALUE_OUT_OF_RANGE
        slipping = (spread(filled.launch.slip[0], count) != 0.0) | (
            spread(filled.launch.slip[1], count) != 0.0
        )
        fault[slipping & (spread(filled.launch.gap, count) > 0.0)] = Fault.VALUE_OUT_OF_RANGE
        for part in (*filled.body.shapes, filled.friction, filled.contact):
            fault[refused(part, count)] = Fault.VALUE_OUT_OF_RANGE
        size = np.max([spread(size, count) for size in sizes(filled.body.surface)], axis=0)
        fits = filled.friction.fits(size) & (filled.rolling_resistance <= size)
        fault[~np.broadcast_to(fits, (count,))] = Fault.VALUE_OUT_OF_RANGE
        if not isinstance(top.surface, Hull):
            fault[~np.isfinite(support_at(start.axis, top.surface)[1])] = Fault.VALUE_OUT_OF_RANGE
        units = natural_units(top)
        return Cells(fault, top, units, natural_state(start, units), filled)


def numeric_fields(part: Part, prefix: str = "") -> Iterator[tuple[str, list[Any]]]:
    """Names of all fields that are numbers, with dots, and the limits that each was declared
    with.
    """
    for name, info in type(part).model_fields.items():
        for path, value in _each(getattr(part, name), f"{prefix}{name}").items():
            if isinstance(value, Part):
                yield from numeric_fields(value, f"{path}.")
            elif isinstance(value, float):
                yield path, info.metadata


def put(part: PartType, values: Mapping[str, Array], prefix: str = "") -> PartType:
    """Return a part with arrays for some of its numbers: not validated, but with all its
    properties.
    """
    fields: dict[str, Any] = {}
    for name in type(part).model_fields:
        value = getattr(part, name)
        made = [
            put(inner, values, f"{path}.") if isinstance(inner, Part) else values.get(path, inner)
            for path, inner in _each(value, f"{prefix}{name}").items()
        ]
        fields[name] = tuple(made) if isinstance(value, tuple) else made[0]
    return cast(PartType, type(part).model_construct(**fields))


def _each(value: Any, path: str) -> dict[str, Any]:
    """Return a field by its name with dots, or the fields inside it by their names if it is a
    tuple.
    """
    return (
        {f"{path}.{k}": one for k, one in enumerate(value)}
        if isinstance(value, tuple)
        else {path: value}
    )


def single_part(part: PartType, cell: int) -> PartType:
    """Return the part of one cell, from one with arrays for some of its numbers.

    Raises `InvalidInput` if there is no such part.
    """

    def single(value: Any, name: str) -> Any:
        match value:
            case Part():
                try:
                    return single_part(value, cell)
                except InvalidInput as error:
                    raise within_part(error, name) from None
            case tuple():
                return tuple(single(one, f"{name}.{k}") for k, one in enumerate(value))
            case np.ndarray():
                return float(value[cell])
        return value

    return type(part)(
        **{name: single(getattr(part, name), name) for name in type(part).model_fields}
    )


def refused(part: Part, count: int) -> NDArray[np.bool_]:
    """Return the cells that a part refuses by rules of its own, beyond its numbers' limits, shape
    (count,).
    """
    is_refused = np.zeros(count, dtype=bool)
    rules = type(part).__pydantic_decorators__
    changes = any(isinstance(getattr(part, name), np.ndarray) for name in type(part).model_fields)
    if changes and (rules.model_validators or rules.field_validators):
        for cell in range(count):
            try:
                single_part(part, cell)
            except InvalidInput:
                is_refused[cell] = True
    return is_refused


def allowed(values: Array, limits: list[Any]) -> NDArray[np.bool_]:
    """Return which values a field may have."""
    fine = np.isfinite(values)
    for limit in limits:
        for name, holds in _LIMITS.items():
            bound = getattr(limit, name, None)
            if bound is not None:
                fine &= holds(values, bound)
    return fine


_LIMITS = {"gt": np.greater, "ge": np.greater_equal, "lt": np.less, "le": np.less_equal}


def launch_state(problem: Problem, fault: NDArray[np.int8]) -> State:
    """Return the states at launch in SI of a problem with arrays for fields, every number of shape
    (count,).

    Of a body of several surfaces, another one may be lowest in every cell: those are launched one
    by one, and the ones that are refused get a fault.
    """
    count = len(fault)
    if not isinstance(problem.body.surface, Hull):
        return State.unpack([spread(number, count).copy() for number in problem.start(np).pack()])
    rows = np.zeros((10, count))
    for cell in range(count):
        try:
            rows[:, cell] = single_part(problem, cell).start().pack()
        except InvalidInput:
            fault[cell] = Fault.VALUE_OUT_OF_RANGE
    return State.unpack(list(rows))


def spread(number: Any, count: int) -> Array:
    """Return a number, or an array of them, as an array of shape (count,)."""
    return np.broadcast_to(np.asarray(number, dtype=float), (count,))
