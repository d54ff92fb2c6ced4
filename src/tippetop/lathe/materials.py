"""Densities of materials by name, and of printed parts by their infill."""

# translate module: skip

import re
from typing import Any

from pydantic import BeforeValidator

from tippetop.support.errors import InvalidInput, within_part
from tippetop.support.suggestions import likely

DENSITIES = {
    **{"balsa": 160.0, "spruce": 450.0, "pine": 520.0, "cherry": 630.0, "walnut": 650.0},
    **{"maple": 700.0, "oak": 710.0, "beech": 720.0, "ash": 690.0, "ebony": 1100.0, "cork": 200.0},
    **{"abs": 1040.0, "nylon": 1140.0, "acrylic": 1180.0, "pla": 1240.0, "petg": 1270.0},
    **{"polycarbonate": 1200.0, "pom": 1410.0, "pvc": 1400.0, "ptfe": 2200.0, "glass": 2500.0},
    **{"aluminium": 2700.0, "titanium": 4500.0, "zinc": 7140.0, "steel": 7850.0, "iron": 7870.0},
    **{"brass": 8500.0, "bronze": 8800.0, "copper": 8960.0, "lead": 11340.0, "tungsten": 19250.0},
}
"""Usual densities at room temperature, kg/m^3; of wood, air-dry at 12 % moisture, where trees of
one kind differ by a tenth and more. Wood Handbook, Forest Products Laboratory 2021, chapter 5, and
data sheets of makers.
"""

SYNONYMS = {
    **{"aluminum": "aluminium", "perspex": "acrylic", "plexiglass": "acrylic", "teflon": "ptfe"},
    **{"delrin": "pom", "acetal": "pom", "wood": "beech", "kork": "cork", "buche": "beech"},
    **{"eiche": "oak", "ahorn": "maple", "fichte": "spruce", "kiefer": "pine", "esche": "ash"},
    **{"kirsche": "cherry", "nussbaum": "walnut", "holz": "beech", "stahl": "steel"},
    **{"messing": "brass", "kupfer": "copper", "blei": "lead", "eisen": "iron"},
}
"""Other names of materials."""

PERCENT = r"(\d+(?:[.,]\d+)?)\s*%"
INFILL = re.compile(
    rf"\s*(?:{PERCENT}\s+)?([A-Za-z]+)(?:\s*,)?(?:\s+(?:at|with))?(?:\s+infill)?"
    rf"(?:\s*{PERCENT}(?:\s+infill)?)?\s*"
)
"""Name of a material, with the share of the volume that it fills: "PLA 20 %", "PLA at 20 % infill"
or "20 % PLA".
"""


def density_of(value: Any) -> Any:
    """Return the density of a material by name, kg/m^3; other values unchanged.

    A share in percent is that of the volume which is filled, as of a printed part by its infill:
    the mean density, walls not counted. Raises `InvalidInput` for an unknown name or share.

    Examples
    --------
    >>> density_of("brass"), density_of("PLA 20 %"), density_of(700.0)
    (8500.0, 248.0, 700.0)
    """
    if not isinstance(value, str) or (re.match(r"\s*[+-]?[\d.]", value) and "%" not in value):
        return value
    match = INFILL.fullmatch(value)
    names = sorted(DENSITIES)
    if match is None:
        accepted = 'a number, or a material such as "beech" or "PLA 20 %"'
        raise InvalidInput("", value, accepted, hint=f"known are {', '.join(names)}")
    name = match[2].lower()
    name = SYNONYMS.get(name, name)
    if name not in DENSITIES:
        meant = likely(name, names, {})
        hint = f"did you mean {meant}?" if meant else f"known are {', '.join(names)}"
        raise InvalidInput("", value, "a number, or a material", "is no known material", hint)
    share = match[1] or match[3]
    percent = float(share.replace(",", ".")) if share else 100.0
    if not 0.0 < percent <= 100.0:
        raise InvalidInput("", value, "a share of the volume above 0 % and up to 100 %")
    return DENSITIES[name] * percent / 100.0


def material_density(field: str, value: Any) -> Any:
    """Return the density of a material by name, kg/m^3, as `density_of`; a refusal has the field's
    name.
    """
    try:
        return density_of(value)
    except InvalidInput as error:
        raise within_part(error, field) from None


MATERIAL = BeforeValidator(density_of)
"""Lets a field of a density take the name of a material."""
