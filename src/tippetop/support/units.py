"""Conversion of numbers with units, such as "2200 rpm", and of pint's quantities to SI.

A unit is a product of names with whole powers: "kg m^2", "kg*m**2", "rev/min", "rad s-1". Pint
knows the names; it is imported when the first unit is read. The page reads the same units from a
table that is made with pint (`tippetop.page_engine.tables`).
"""

# translate module: skip

import math
import re
from difflib import get_close_matches
from functools import cache
from typing import Any, NamedTuple

from tippetop.support.errors import Described, InvalidInput, is_number, short, within_part

DIGITS = r"(?:\d++(?:\.\d*+)?|\.\d++)"
"""Digits of a number, which no search gives back: texts of 100,000 digits take no time."""

NUMBER = re.compile(rf"\s*([+-]?{DIGITS}(?:[eE][+-]?\d+)?)\s*(.*?)\s*")
FACTOR = re.compile(
    r"\s*(?:(/|per(?![^\W\d]))|[*·⋅×]?)\s*([^\W\d_][^\W\d]*|°|%)\s*(?:(?:\^|\*\*)\s*)?([+-]?\d+|⁻?[¹²³])?"
)
SUPERSCRIPTS = {"¹": "1", "²": "2", "³": "3", "⁻": "-"}

BASES = {"meter": 0, "kilogram": 1, "second": 2, "radian": 3}
"""The base units, by the names that pint gives them, and their places in exponents."""

ADDED_NAMES = (
    *("turn = rev = revs = rotation = rotations", "revolutions_per_minute = RPM"),
    *("kilogram = Kg = KG", "degree = degs"),
)
"""Names that people write and pint does not have: "name = synonyms"."""


class Unit(NamedTuple):
    """Unit as a factor to SI: a number in it times `over` and divided by `under` is in SI.

    An exact decimal unit, such as the millimetre, divides by a whole number: 14.1 mm is 0.0141 m.
    """

    over: float
    under: float
    exponents: tuple[int, ...]
    """Powers of metre, kilogram, second and radian."""


PLAIN = Unit(1.0, 1.0, (0, 0, 0, 0))
"""The unit of plain numbers."""


class QuantityKind(NamedTuple):
    """Kind of quantity, in words."""

    name: str
    examples: str
    """Units that the quantity is written in."""


KINDS = {
    "1": QuantityKind("a pure number", "without a unit"),
    "m": QuantityKind("a length", "in m, cm, mm or in"),
    "kg": QuantityKind("a mass", "in kg or g"),
    "s": QuantityKind("a time", "in s, ms or min"),
    "rad": QuantityKind("an angle", "in rad or deg"),
    "rad s-1": QuantityKind("an angular velocity", "in rad/s, rpm or rev/s"),
    "m s-1": QuantityKind("a velocity", "in m/s, cm/s or mm/s"),
    "m s-2": QuantityKind("an acceleration", "in m/s^2"),
    "kg m2": QuantityKind("a moment of inertia", "in kg m^2 or g cm^2"),
    "kg m-3": QuantityKind("a density", "in kg/m^3 or g/cm^3"),
    "s m-1": QuantityKind("a viscous friction coefficient", "in s/m"),
    "s-1": QuantityKind("a frequency", "in 1/s"),
    "N": QuantityKind("a force", "in N"),
    "N m s": QuantityKind("a linear resistance to turning", "in N m s"),
    "N m s2": QuantityKind("a quadratic resistance to turning", "in N m s^2 or kg m^2"),
    "N s m-1": QuantityKind("a linear resistance to moving", "in N s/m or kg/s"),
    "N s2 m-2": QuantityKind("a quadratic resistance to moving", "in N s^2/m^2 or kg/m"),
    "J": QuantityKind("an energy", "in J"),
    "m2": QuantityKind("an area", "in m^2"),
    "m3": QuantityKind("a volume", "in m^3"),
}
"""Kinds of quantities by their SI units."""

COMMON = (
    *(
        "m",
        "cm",
        "mm",
        "um",
        "in",
        "inch",
        "ft",
        "kg",
        "g",
        "mg",
        "lb",
        "oz",
        "s",
        "ms",
        "min",
        "h",
    ),
    *("rad", "mrad", "deg", "turn", "rev", "rpm", "rps", "N", "J", "Hz"),
)
"""Names of units that a misspelt one is compared with."""


def has_unit(value: object) -> bool:
    """Return whether a value is a text, which may have a unit, or a quantity such as pint's."""
    if isinstance(value, float | int):
        return False
    return isinstance(value, str) or is_quantity(value)


def is_quantity(value: object) -> bool:
    """Return whether a value has a magnitude and convertible units, as pint's quantities do."""
    try:
        return all(hasattr(value, name) for name in ("magnitude", "units")) and callable(
            getattr(value, "to", None)
        )
    except Exception:  # noqa: BLE001 - attributes of foreign objects may raise anything
        return False


def in_si(value: Any, units: str) -> Any:
    """Return a number in an SI unit from a text with a number and a unit, or from a quantity.

    The magnitude of a quantity may be an array; then a list is returned. Raises `InvalidInput`,
    which names no field, if the value is no number or its unit is missing or of another dimension.
    """
    if isinstance(value, str):
        number, text = _number_and_unit(value, units)
        return converted(number, unit_of(text, value, units))
    text = "" if str(value.units) == "dimensionless" else str(value.units)
    magnitude = value.magnitude
    try:
        shown = Described(f"{magnitude} {text}")
        unit = unit_of(text, shown, units) if text else PLAIN
    except InvalidInput as error:
        if error.fault != UNKNOWN_UNIT:
            raise
        magnitude, unit = _converted_by_itself(value, error, units), PLAIN
    numbers = getattr(magnitude, "tolist", lambda: magnitude)()
    if isinstance(numbers, list | tuple):
        return [converted(number, unit) for number in numbers]
    return converted(numbers, unit)


def number_in(field: str, value: Any, units: str) -> Any:
    """Return a field's number in an SI unit from a text or a quantity; other values unchanged."""
    if not has_unit(value):
        return value
    try:
        return in_si(value, units)
    except InvalidInput as error:
        raise within_part(error, field) from None


def positive_in(field: str, value: Any, units: str) -> float:
    """Return a field's number in an SI unit; raise `InvalidInput` unless it is greater than 0."""
    number = number_in(field, value, units)
    if not (is_number(number) and number > 0.0):
        raise InvalidInput(field, value, "a number greater than 0")
    return float(number)


def converted(number: Any, unit: Unit) -> Any:
    """Return a number of a unit in SI; other values unchanged."""
    return number * unit.over / unit.under if is_number(number) else number


UNKNOWN_UNIT = "has an unknown unit"


def unit_of(text: str, value: object, units: str) -> Unit:
    """Return a unit by its text, which must measure the same as an SI unit.

    Raises `InvalidInput` about the value otherwise.
    """
    expected = KINDS.get(units, QuantityKind(f"a quantity in {units}", f"in {written(units)}"))
    factors = factors_of(text)
    units_by_name = [(name, named_unit(name), power) for name, power in factors or ()]
    strange = next((name for name, unit, _ in units_by_name if unit is None), None)
    if not factors or strange is not None:
        near = [
            name
            for name in get_close_matches(strange or "", COMMON, 3, 0.5)
            if len(factors or ()) > 1 or exponents_of(units) == _exponents_of_name(name)
        ]
        hint = f"write it {expected.examples}"
        if near and strange:
            hint = f"did you mean {near[0]}? {hint[0].upper()}{hint[1:]}"
        raise InvalidInput("", value, expected.name, UNKNOWN_UNIT, hint)
    unit = product([(unit, power) for _, unit, power in units_by_name if unit is not None])
    asked = exponents_of(units)
    if unit.exponents == asked:
        return unit
    if asked == exponents_of("rad s-1") and unit.exponents == exponents_of("s-1"):
        number = NUMBER.match(value if isinstance(value, str) else short(value))
        hint = "write it in rev/s for turns, or in rad/s"
        if number and unit.over == unit.under:
            hint = f"write {number[1]} rev/s for turns, or {number[1]} rad/s"
        raise InvalidInput(
            "", value, expected.name, "is a frequency, not an angular velocity", hint
        )
    kind = next(
        (kind.name for si, kind in KINDS.items() if exponents_of(si) == unit.exponents),
        "another quantity",
    )
    fault = f"is {kind}, not {expected.name}"
    raise InvalidInput("", value, expected.name, fault, f"write it {expected.examples}")


def factors_of(text: str) -> list[tuple[str, int]] | None:
    """Return the names of units in a product, with their powers; None if the text is no product."""
    text = re.sub(r"^1\s*(?=/)", "", text)
    factors, place = [], 0
    while place < len(text):
        match = FACTOR.match(text, place)
        if match is None:
            return None
        over, name, power = match.groups()
        for mark, digit in SUPERSCRIPTS.items():
            power = power and power.replace(mark, digit)
        factors.append((name, (-1 if over else 1) * int(power or "1")))
        if abs(factors[-1][1]) > MOST_POWER:
            return None
        place = match.end()
    return factors


def product(factors: list[tuple[Unit, int]]) -> Unit:
    """Return the product of powers of units."""
    over, under, exponents = 1.0, 1.0, [0, 0, 0, 0]
    for unit, power in factors:
        for _ in range(abs(power)):
            over *= unit.over if power > 0 else unit.under
            under *= unit.under if power > 0 else unit.over
        for place, exponent in enumerate(unit.exponents):
            exponents[place] += power * exponent
    return Unit(over, under, tuple(exponents))


MOST_POWER = 9
"""Largest power of a unit in a product: no quantity has a larger one."""


@cache
def exponents_of(units: str) -> tuple[int, ...]:
    """Return the powers of metre, kilogram, second and radian in an SI unit such as "kg m2"."""
    exponents = [0, 0, 0, 0]
    for name, power in factors_of(units) or ():
        for place, exponent in enumerate(_SI_EXPONENTS[name]):
            exponents[place] += power * exponent
    return tuple(exponents)


_SI_EXPONENTS = {
    "m": (1, 0, 0, 0),
    "kg": (0, 1, 0, 0),
    "s": (0, 0, 1, 0),
    "rad": (0, 0, 0, 1),
    "N": (1, 1, -2, 0),
    "J": (2, 1, -2, 0),
}


@cache
def named_unit(name: str) -> Unit | None:
    """Return the unit of a name by pint; None if it is unknown or has dimensions not of
    mechanics.
    """
    try:
        quantity = registry().Quantity(1.0, registry().parse_units(name)).to_base_units()
        powers = dict(quantity.unit_items())
    except Exception:  # noqa: BLE001 - pint's parser may raise anything
        return None
    exponents = [0, 0, 0, 0]
    for unit, power in powers.items():
        if unit not in BASES or not float(power).is_integer():
            return None
        exponents[BASES[unit]] = int(power)
    over, under = float(quantity.magnitude), 1.0
    inverse = round(1.0 / over) if 0.0 < over < 1.0 else 1
    if inverse > 1 and math.isclose(over * inverse, 1.0, rel_tol=1e-14):
        over, under = 1.0, float(inverse)
    return Unit(over, under, tuple(exponents))


@cache
def registry() -> Any:
    """Return pint's registry of units with `ADDED_NAMES`."""
    import pint  # noqa: PLC0415 - slow to import

    units: Any = pint.UnitRegistry()
    for names in ADDED_NAMES:
        units.define(f"@alias {names}")
    return units


def quantity_of(values: Any, units: str) -> Any:
    """Return values in an SI unit as a quantity of pint's application registry."""
    import pint  # noqa: PLC0415 - slow to import

    application: Any = pint.get_application_registry()  # type: ignore[no-untyped-call]
    unit = application.dimensionless
    for name, power in factors_of(units) or ():
        if name != "1":
            unit = unit * application.parse_units(name) ** power
    return application.Quantity(values, unit)


def _exponents_of_name(name: str) -> tuple[int, ...] | None:
    unit = named_unit(name)
    return unit.exponents if unit else None


def written(units: str) -> str:
    """Return an SI unit as people write it: "rad/s" for "rad s-1"."""
    over, under = list[str](), list[str]()
    for name, power in factors_of(units) or ():
        (over if power > 0 else under).append(name + (f"^{abs(power)}" if abs(power) > 1 else ""))
    return "/".join([" ".join(over) or "1", *under])


def _converted_by_itself(value: Any, refusal: InvalidInput, units: str) -> Any:
    """Return the magnitude of a quantity that only its own registry can convert."""
    try:
        return value.to("" if units == "1" else written(units)).magnitude
    except Exception:  # noqa: BLE001 - foreign quantities raise errors of their own
        raise refusal from None


def _number_and_unit(text: str, units: str) -> tuple[float, str]:
    """Return the number and the unit of a text; raise `InvalidInput` unless it has both."""
    match = NUMBER.fullmatch(text)
    if match is None or not match[2] or not begins_a_unit(match[2]):
        raise InvalidInput("", text, "a number", hint=number_hint(text, units))
    return float(match[1]), match[2]


def is_unit(text: str) -> bool:
    """Return whether a word is a unit that the package knows, such as rpm or rad/s."""
    return named_unit(text) is not None


def begins_a_unit(text: str) -> bool:
    """Return whether what follows a number may be a unit; "1/s" may, other digits may not."""
    if re.match(r"1\s*/", text):
        return True
    return not re.match(r"[0-9,.'_:]|/\s*\d|[*·]?\s*(pi|π)(?![^\W\d])", text)


LONGEST_HINT = 60
"""Longest text that is repeated in a hint, letters."""


def number_hint(text: str, units: str = "") -> str:
    """Return what to write instead of a text that is no number; "" if that cannot be guessed."""
    text = text.strip()
    if len(text) > LONGEST_HINT:
        return ""
    shown = "" if units in ("", "1") else f' or with its unit, "{text} {written(units)}"'
    if re.fullmatch(rf"[+-]?{DIGITS}(?:[eE][+-]?\d+)?", text):
        if not is_number(float(text)):
            return "write a number nearer to 1"
        return f"write {text} without quotes{',' * bool(shown)}{shown}"
    if match := re.fullmatch(r"([+-]?)(\d[\d.,' _]*)(?<![ ])(.*)", text):
        sign, number, ending = match.groups()
        plain = re.sub(r"[' _]", "", number)
        if plain.endswith((",", ".")):
            plain = plain[:-1]
        if re.fullmatch(r"[1-9]\d{0,2},\d{3}", plain):
            thousands, point = plain.replace(",", ""), plain.replace(",", ".")
            return (
                f"write {sign}{point}{ending}, or {sign}{thousands}{ending} if thousands are meant"
            )
        if plain.count(",") == 1 and plain.rfind(",") > plain.rfind("."):
            plain = plain.replace(".", "").replace(",", ".")
        plain = plain.replace(",", "")
        if number != plain and re.fullmatch(DIGITS, plain):
            return f"write {sign}{plain}{ending}"
    match = re.fullmatch(rf"([+-]?)({DIGITS})\s*/\s*({DIGITS})(.*)", text)
    if match and float(match[3]):
        return f"write {match[1]}{float(match[2]) / float(match[3]):.7g}{match[4]}"
    if match := re.fullmatch(rf"([+-]?)({DIGITS})?\s*\*?\s*(?:pi|π)\s*(?:/\s*({DIGITS}))?", text):
        number = float(match[2] or 1.0) * math.pi / (float(match[3] or 1.0) or 1.0)
        return f"write {match[1]}{number:.7g}"
    return "" if units in ("", "1") else f"write a number in {written(units)}, or with its unit"
