"""Suggestions of the names that were likely meant by unknown ones."""

# translate module: by hand in suggestions.js

from collections.abc import Collection, Iterable, Mapping
from difflib import get_close_matches
from itertools import groupby

from tippetop.support.errors import InvalidInput

OTHER_NAMES = {
    **dict.fromkeys(("alpha", "offset", "ecc"), "eccentricity"),
    **dict.fromkeys(("omega", "omega3", "omega_3", "w", "rpm", "spin_rate", "rate"), "spin"),
    **dict.fromkeys(("theta", "angle", "inclination", "lean"), "tilt"),
    **dict.fromkeys(("theta_dot", "dtheta", "theta_rate"), "tilt_rate"),
    **dict.fromkeys(("phi_dot", "phi_rate", "dphi"), "precession"),
    **dict.fromkeys(("phi", "heading"), "azimuth"),
    **dict.fromkeys(("g", "grav"), "gravity"),
    **dict.fromkeys(("m", "weight"), "mass"),
    **dict.fromkeys(("r", "R", "rad"), "radius"),
    **dict.fromkeys(("mu_k", "coefficient", "coeff", "friction_coefficient"), "mu"),
    **dict.fromkeys(("e", "bounce", "epsilon"), "restitution"),
    **dict.fromkeys(("A", "Ixx", "I_1", "i1", "I11", "transverse_inertia"), "I1"),
    **dict.fromkeys(("C", "Izz", "I_3", "i3", "I33", "axial_inertia"), "I3"),
    **dict.fromkeys(("v", "v0"), "velocity"),
    **dict.fromkeys(("height", "drop", "z"), "gap"),
    **dict.fromkeys(("law", "type", "model"), "kind"),
}
"""Names of the fields of problems by those that they have elsewhere."""

REVOLUTION = "bodies of revolution only"
"""Part of the hints about bodies that are no bodies of revolution."""

HINTS_BY_NAME = {
    **dict.fromkeys(
        ("I2", "I_2", "i2", "Iyy", "I22", "B"),
        f"{REVOLUTION}: they have two equal moments I1, and I3 about the axis",
    ),
    **dict.fromkeys(
        ("ellipsoid", "triaxial", "triaxial_ellipsoid"),
        f"{REVOLUTION}: an ellipsoid with two equal semi-axes is a spheroid",
    ),
    **dict.fromkeys(
        ("box", "cuboid", "cube", "block", "brick", "prism", "polyhedron", "tetrahedron", "mesh"),
        f"{REVOLUTION}: their surfaces are spheres, rings and spheroids",
    ),
    **dict.fromkeys(
        ("profile", "density", "inserts"),
        "it is a field of a workpiece; tippetop body FILE --toml makes a problem of one",
    ),
}
"""Hints for unknown names: those of other bodies, and fields of workpieces."""


def unknown_field(
    name: str,
    value: object,
    names: Collection[str],
    places: Mapping[str, str],
    kinds: Collection[str] = (),
) -> InvalidInput:
    """Return the refusal of a value for a field that a part does not have.

    Parameters
    ----------
    name, value
        The name, without those of the parts around it, and the value.
    names
        The names of the fields that the part has.
    places
        The full names of the fields of all parts by their last names.
    kinds
        The other kinds of the part that have the field.
    """
    hint = HINTS_BY_NAME.get(name.rpartition(".")[2], "")
    if kinds:
        hint = f"it is a field of the kind {' or '.join(kinds)}"
    if not hint and (meant := likely(name, names, places)):
        hint = f"did you mean {meant}?"
    return InvalidInput(name, value, f"one of {_listed(names)}", UNKNOWN, hint)


def _listed(names: Iterable[str]) -> str:
    """Return a list of full names, with the part said once that several have in common."""
    groups = []
    for part, group in groupby(names, lambda name: name.partition(".")[0]):
        inside = [name.removeprefix(f"{part}.") for name in group]
        if len(inside) > 1:
            groups.append(f"{part}.{{{', '.join(inside)}}}")
        else:
            groups.append(part if inside == [part] else f"{part}.{inside[0]}")
    return ", ".join(groups)


UNKNOWN = "is given for an unknown field"


def not_one_of(field: str, value: object, choices: Collection[str]) -> InvalidInput:
    """Return the refusal of a word that is not one of the choices, with the one likely meant."""
    word = value if isinstance(value, str) else ""
    meant = likely(word, choices, {})
    hint = HINTS_BY_NAME.get(word, f"did you mean {meant}?" if meant else "")
    return InvalidInput(field, value, f"one of {', '.join(choices)}", hint=hint)


LONGEST_GUESSED = 60
"""Longest name for which a likely one is sought, letters; longer ones are no slips of typing."""


def likely(name: str, names: Iterable[str], places: Mapping[str, str]) -> str:
    """Return the name that was likely meant, among `names` and those of all places; "" without one.

    The same name in another place, and synonyms of a field, are preferred to similar names.
    """
    if len(name) > LONGEST_GUESSED:
        return ""
    names, last = list(names), name.rpartition(".")[2]
    word = OTHER_NAMES.get(last, OTHER_NAMES.get(last.lower(), last))
    exact = [choice for choice in names if choice.rpartition(".")[2] == word]
    if exact:
        return exact[0]
    if word in places:
        return places[word]
    near = get_close_matches(name, names, 1) or get_close_matches(
        last, [choice.rpartition(".")[2] for choice in names], 1
    )
    if near:
        return next(choice for choice in names if near[0] in (choice, choice.rpartition(".")[2]))
    near = get_close_matches(last, list(places), 1)
    return places[near[0]] if near else ""
