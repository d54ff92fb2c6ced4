"""Base classes of the parts of a problem: frozen, validated, with clear refusals."""

# translate module: by hand in part.js

import inspect
import pickle
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import partial
from typing import (
    TYPE_CHECKING,
    Annotated,
    Any,
    ClassVar,
    NamedTuple,
    Self,
    TypeAlias,
    get_args,
    get_origin,
)

import numpy as np
from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    GetCoreSchemaHandler,
    GetJsonSchemaHandler,
    ValidationError,
)
from pydantic.fields import FieldInfo
from pydantic_core import CoreSchema, PydanticCustomError, core_schema

from tippetop.support.accepted_values import refusal_of
from tippetop.support.errors import MISSING, InvalidInput, is_whole, short, within_part
from tippetop.support.field_paths import part_at
from tippetop.support.suggestions import not_one_of, unknown_field
from tippetop.support.units import DIGITS, KINDS, has_unit, in_si, number_hint


def _no_word(value: Any) -> Any:
    """Refuse texts and truth values, which pydantic would convert to numbers."""
    if isinstance(value, str):
        raise InvalidInput("", value, "a number", hint=number_hint(value))
    if isinstance(value, (bool, np.bool_, bytes)):
        raise InvalidInput("", value, "a number")
    return value


NO_WORD = BeforeValidator(_no_word)
"""Makes a field of numbers refuse truth values and texts."""

Number: TypeAlias = Annotated[float, NO_WORD]
"""Finite number; texts and truth values are refused."""

Positive: TypeAlias = Annotated[float, Field(gt=0), NO_WORD]
NotNegative: TypeAlias = Annotated[float, Field(ge=0), NO_WORD]


def _whole_number(value: Any) -> int:
    if not is_whole(value):
        raise PydanticCustomError("int_type", "a whole number")
    return int(value)


Whole: TypeAlias = Annotated[int, BeforeValidator(_whole_number)]
"""Whole number; texts, fractions and truth values are refused."""


POINTS = "a list of points [distance from the axis, height, radius]"
"""Accepted form of a profile, in words."""


def _listed(value: Any) -> Any:
    if not isinstance(value, list | tuple) or not all(
        isinstance(point, list | tuple) for point in value
    ):
        raise PydanticCustomError("points", POINTS)
    return value


Points: TypeAlias = Annotated[tuple[tuple[Number, ...], ...], BeforeValidator(_listed)]
"""Points of a profile: distance from the axis, height along it and, at the end of an arc, its
radius.
"""


def require_callback(field: str, value: object) -> None:
    """Raise `InvalidInput` unless a value can be called, or is None."""
    if not (value is None or callable(value)):
        raise InvalidInput(field, value, "a function, or None")


def require_names(field: str, value: object, example: str = "launch.spin") -> list[str]:
    """Return the names that a text, or a list of texts, holds; raise `InvalidInput` for others."""
    names = [value] if isinstance(value, str) else value
    is_listed = isinstance(names, Iterable) and not isinstance(names, Mapping | bytes)
    listed = list(names) if isinstance(names, Iterable) and is_listed else []
    if not listed or not all(isinstance(name, str) for name in listed):
        raise InvalidInput(field, value, f"a name, or a list of names, such as {example}")
    return [str(name) for name in listed]


TEXT_WITH_UNIT = rf"^\s*[+-]?{DIGITS}([eE][+-]?\d+)?\s*(?![eE][+-]?\d)[A-Za-zµ°/].*$"
"""Pattern of a number and its unit in a text."""


class Quantity(NamedTuple):
    """Physical quantity of a field: unit and name."""

    units: str
    """Its SI unit, as in CF: ``rad s-1``; "1" for a pure number."""
    long_name: str
    places: tuple[str, ...] = ()
    """Name of each number, for a field of several."""

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        """Let the field also take texts with a unit, and quantities."""
        depth = max(_depth(kind) for kind in (source, *get_args(source)))

        def convert(value: Any) -> Any:
            # A field of several numbers is not written as one text.
            return value if depth and isinstance(value, str) else self.in_si(value, depth)

        return core_schema.no_info_before_validator_function(convert, handler(source))

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        """Return the schema of the field with a text beside every number."""
        return self._or_text(handler(schema))

    def _or_text(self, schema: dict[str, Any]) -> dict[str, Any]:
        kind = KINDS.get(self.units)
        if self.units == "1" or kind is None:
            return schema
        if schema.get("type") in ("number", "integer"):
            text = {
                "type": "string",
                "pattern": TEXT_WITH_UNIT,
                "description": f"{kind.name} {kind.examples}",
            }
            common: dict[str, Any] = {
                name: schema[name] for name in ("title", "default") if name in schema
            }
            number = {name: value for name, value in schema.items() if name not in common}
            return {"anyOf": [number, text], **common}
        nested: dict[str, Any] = {
            name: [self._or_text(one) for one in schema[name]]
            for name in ("prefixItems", "anyOf")
            if name in schema
        }
        return {**schema, **nested}

    def in_si(self, value: Any, depth: int = 1) -> Any:
        """Return a value of the field, or lists of values nested `depth` deep, with numbers in
        SI.
        """
        if isinstance(value, float | int):
            return value
        if isinstance(value, list | tuple) and depth:
            numbers = [
                _placed(place, inner, partial(self.in_si, depth=depth - 1))
                for place, inner in enumerate(value)
            ]
            return numbers if isinstance(value, list) else tuple(numbers)
        return in_si(value, self.units) if has_unit(value) else value


def _depth(kind: Any) -> int:
    """Return how deep the tuples of a type are nested."""
    inner = get_args(kind)
    if get_origin(kind) is Annotated:
        return _depth(inner[0])
    return 1 + max(map(_depth, inner), default=0) if get_origin(kind) is tuple else 0


class Padded(NamedTuple):
    """Lets a field of several numbers omit the last one, which is then 0."""

    least: int
    """Least number of numbers."""

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        """Add the zero before the field is validated."""
        return core_schema.no_info_before_validator_function(self.padded, handler(source))

    def padded(self, value: Any) -> Any:
        """Return a list with a 0 for the omitted number."""
        lacks_one = isinstance(value, list | tuple) and len(value) == self.least
        return (*value, 0.0) if lacks_one else value


def _placed(place: int, value: Any, of: Callable[[Any], Any]) -> Any:
    """Apply a function to an item of a list; refusals name the index of the item."""
    try:
        return of(value)
    except InvalidInput as error:
        raise within_part(error, str(place)) from None


PLACES: dict[str, str] = {}
"""Full names of the fields of problems by their last names: ``{"spin": "launch.spin"}``."""


class Part(BaseModel):
    """Frozen, validated part of a problem.

    Raises
    ------
    InvalidInput
        If a field is missing, unknown, not finite or outside its range.
    """

    model_config = ConfigDict(
        frozen=True, extra="forbid", allow_inf_nan=False, validate_default=True
    )

    if not TYPE_CHECKING:  # else mypy believes that values need no names

        def __new__(cls, /, *values: Any, **_: Any) -> Self:
            """Refuse values without names, leaving the signature of `__init__` as pydantic made
            it.
            """
            if values and cls.__init__ is Part.__init__:
                raise InvalidInput(
                    cls.__name__,
                    values,
                    "",
                    "are values without names",
                    f"write its fields by name: {', '.join(_written(cls))}",
                )
            return super().__new__(cls)

    def __init__(self, /, **fields: Any) -> None:
        for name, value in fields.items():
            _refuse_keys(name, value)
        try:
            super().__init__(**fields)
        except ValidationError as error:
            raise _as_invalid_input(error, type(self), fields) from None

    def model_copy(self, *, update: Mapping[str, Any] | None = None, deep: bool = False) -> Self:
        """Copy with some fields replaced, and validated like any other."""
        for name, value in (update or {}).items():
            if "." in name:
                can_replace = hasattr(self, "replace")
                last = name if can_replace else name.rpartition(".")[2]
                shown = f"{{'{last}': {repr(value) if isinstance(value, str) else short(value)}}}"
                call = f"replace({shown})" if can_replace else f"model_copy(update={shown})"
                raise InvalidInput(name, value, "", "is a field of another part", f"write {call}")
        fields = {name: getattr(self, name) for name in type(self).model_fields}
        return type(self)(**{**fields, **(update or {})})

    if not TYPE_CHECKING:  # else mypy believes that every attribute may be set

        def __setattr__(self, name: str, value: Any) -> None:
            try:
                super().__setattr__(name, value)
            except ValidationError:
                fault, hint = "cannot be set: parts are frozen", self._copying(name, value)
                raise InvalidInput(name, value, "", fault, hint) from None

        def _copying(self, name: str, value: Any) -> str:
            """Return how to make a copy with another value of a field."""
            shown = repr(value) if isinstance(value, str) else short(value)
            copy = f"model_copy(update={{'{name}': {shown}}})"
            place = PLACES.get(name)
            if place is None:
                return f"make a changed copy by {copy}"
            of_part = f", or of this part alone by {copy}" if "." in place else ""
            return f"make a changed copy by problem.replace({{'{place}': {shown}}}){of_part}"

    def quantity(self, field: str) -> Quantity:
        """Return the quantity of a field by its dotted name; one without a unit if none is
        declared.
        """
        where, _, last = field.rpartition(".")
        part = part_at(self, where)
        if isinstance(part, tuple):
            several = self.quantity(where)
            return several._replace(long_name=f"{several.long_name} {several.places[int(last)]}")
        info = type(part).model_fields[last]
        return next(
            (item for item in info.metadata if isinstance(item, Quantity)), Quantity("", last)
        )


def foreign_kinds(part: Part) -> set[type[Part]]:
    """Return the classes of a part and its parts that are defined outside this package."""
    is_foreign = type(part).__module__.partition(".")[0] != _PACKAGE
    kinds: set[type[Part]] = {type(part)} if is_foreign else set()
    values = [getattr(part, name) for name in type(part).model_fields]
    several = [
        inner for value in values for inner in (value if isinstance(value, tuple) else (value,))
    ]
    return kinds.union(*(foreign_kinds(value) for value in several if isinstance(value, Part)))


_PACKAGE = __name__.partition(".")[0]


def in_order(
    part: type[Part], names: Iterable[str], values: Sequence[Any], fields: Mapping[str, Any]
) -> dict[str, Any]:
    """Return the fields of a part by name, the first of which may be passed by position.

    Raises `InvalidInput` for too many values, and for a field passed both ways.
    """
    names = list(names)
    if len(values) > len(names):
        raise InvalidInput(
            part.__name__,
            values,
            "",
            "are too many values",
            f"write at most these, in order: {', '.join(names)}",
        )
    ordered = dict(zip(names, values, strict=False))
    aliases = {info.alias: name for name, info in part.model_fields.items()}
    for name, value in fields.items():
        if aliases.get(name, name) in ordered:
            raise InvalidInput(
                name, value, "", "is given twice", "write it in its place, or by its name"
            )
    return ordered | dict(fields)


def _refuse_keys(field: str, value: object) -> None:
    """Refuse a table whose keys are no texts."""
    if isinstance(value, Mapping) and not all(isinstance(key, str) for key in value):
        raise InvalidInput(field, value, "a table of fields by their names")


def declared_fields(part: type[Part], prefix: str = "") -> Iterator[tuple[str, FieldInfo]]:
    """Yield the fields of a part and of all kinds of the parts in it, with their dotted names."""
    for name, info in part.model_fields.items():
        inner = [info.annotation, *get_args(info.annotation)]
        parts = [one for one in inner if inspect.isclass(one) and issubclass(one, Part)]
        yield f"{prefix}{name}", info
        for one in parts:
            kinds = one.kinds.values() if issubclass(one, Variant) else ()
            for kind in (one, *kinds):
                yield from declared_fields(kind, f"{prefix}{name}.")


def declare_places(part: type[Part]) -> dict[str, str]:
    """Return the dotted names of the fields of a part, and of its parts, by their last names.

    Refusals of unknown fields suggest them.
    """
    for name, _ in declared_fields(part):
        last = name.rpartition(".")[2]
        if last != "kind":
            PLACES.setdefault(last, name)
    return PLACES


_receiving = list[bool]()
"""Not empty while classes of another process are unpickled."""


class Variant(Part):
    """Part with several kinds: its subclasses, distinguished by their field `kind`.

    A ``class Mine(Shape)`` with a field ``kind: Literal["mine"] = "mine"`` is a kind of `Shape`
    wherever it is defined, and every field of type `Shape` accepts it. A class that is defined
    again, as in a notebook, replaces the earlier one.

    Attributes
    ----------
    kinds
        The defined kinds, by the value of their field `kind`.
    """

    kinds: ClassVar[dict[str, type[Part]]]

    @classmethod
    def __pydantic_init_subclass__(cls, **keywords: Any) -> None:
        super().__pydantic_init_subclass__(**keywords)
        if _receiving:  # cloudpickle makes a class before it has its fields
            return
        if Variant in cls.__bases__:
            cls.kinds = {}
            return
        info = cls.model_fields.get("kind")
        if info is None or not isinstance(info.default, str):
            raise TypeError(f'{cls.__name__} needs a word: kind: Literal["word"] = "word"')
        same = cls.kinds.get(info.default)
        if same and (same.__module__, same.__qualname__) != (cls.__module__, cls.__qualname__):
            raise TypeError(
                f"{cls.__name__} needs another word: {info.default!r} is {same.__name__}"
            )
        cls.kinds[info.default] = cls


def receive_kinds(content: bytes) -> None:
    """Register kinds that another process has sent, pickled by cloudpickle."""
    _receiving.append(True)
    try:
        kinds = pickle.loads(content)
    finally:
        _receiving.pop()
    for kind in kinds:
        kind.kinds[kind.model_fields["kind"].default] = kind


def kinds_with(variant: type[Variant], field: str) -> list[str]:
    """Return the names of the kinds of a variant that have a field."""
    return [word for word, kind in variant.kinds.items() if field in kind.model_fields]


def fields_of_kind(variant: type[Variant], kind: Any) -> set[str]:
    """Return the names of the fields of a kind of a variant; of the variant's own if it is
    unknown.
    """
    base = next(part for part in variant.__mro__ if Variant in part.__bases__)
    kinds: Any = base.kinds  # type: ignore[attr-defined]
    chosen = kinds.get(kind, variant) if isinstance(kind, str) else variant
    return set(chosen.model_fields)


class _OfItsKind:
    """Makes a field accept every kind of a variant, with the fields of that kind.

    If there may be `several`, a list of them is accepted too; a list of one becomes that one.
    """

    def __init__(self, *, several: bool = False) -> None:
        self.several = several

    def __get_pydantic_core_schema__(self, base: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        if self.several:
            base = next(part for part in get_args(base) if inspect.isclass(part))

        def chosen(value: Any) -> Any:
            if isinstance(value, base):
                return value
            if not isinstance(value, Mapping):
                raise PydanticCustomError("model_type", "a table of its fields")
            _refuse_keys("", value)
            kind = value.get("kind", MISSING)
            if not inspect.isabstract(base) and (kind is MISSING or not base.kinds):
                return base(**value)
            if kind is MISSING:
                raise InvalidInput("kind", kind, f"one of {', '.join(base.kinds)}")
            if not isinstance(kind, str) or kind not in base.kinds:
                raise not_one_of("kind", kind, list(base.kinds))
            part = base.kinds[kind](**value)
            assert isinstance(part, base)
            return part

        def chosen_each(value: Any) -> Any:
            if not isinstance(value, list | tuple):
                return chosen(value)
            parts = []
            for place, inner in enumerate(value):
                try:
                    parts.append(chosen(inner))
                except InvalidInput as error:
                    raise within_part(error, str(place)) from None
            if not parts:
                raise PydanticCustomError("model_type", "a table of its fields")
            return tuple(parts) if len(parts) > 1 else parts[0]

        validate = chosen_each if self.several else chosen
        return core_schema.no_info_plain_validator_function(validate, metadata={"base": base})

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        base: Any = schema["metadata"]["base"]
        kinds = [*([] if inspect.isabstract(base) else [base]), *base.kinds.values()]
        one = {"oneOf": [handler(kind.__pydantic_core_schema__) for kind in kinds]}
        return (
            {"anyOf": [one, {"type": "array", "items": one, "minItems": 1}]}
            if self.several
            else one
        )


OF_ITS_KIND = _OfItsKind()
ONE_OR_SEVERAL = _OfItsKind(several=True)


def _as_invalid_input(
    error: ValidationError, part: type[Part], fields: Mapping[str, Any]
) -> InvalidInput:
    """Return the refusal that a user reads: that of the most telling detail of an error."""
    details = sorted(error.errors(), key=lambda detail: detail["type"] != "extra_forbidden")
    first, others = details[0], len(details) - 1
    if first["type"] == "missing" and len(first["loc"]) > 1:  # a list of too few is one mistake
        others = sum(detail["loc"][:1] != first["loc"][:1] for detail in details)
    field = ".".join(str(step) for step in first["loc"])
    cause = first.get("ctx", {}).get("error")
    if isinstance(cause, InvalidInput):
        return within_part(
            cause, "" if f"{cause.field}.".startswith(f"{field}.") else field, others
        )
    if first["type"] == "extra_forbidden":
        kinds = kinds_with(part, field) if issubclass(part, Variant) else ()
        refusal = unknown_field(field, first["input"], list(_written(part)), PLACES, kinds)
        return within_part(refusal, "", others)
    if has_unit(fields.get(field)):  # the message shows the number as it was written, not in SI
        first["input"] = fields[field]
    return within_part(refusal_of(first, _written(part)), "", others)


def _written(part: type[Part]) -> dict[str, FieldInfo]:
    """Return the fields of a part by the names that users write."""
    return {info.alias or name: info for name, info in part.model_fields.items()}
