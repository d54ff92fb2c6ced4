"""Mistakes that people make in a launch: the field, what is written there, and what the sentence
says instead of it.

Each can be made in Python, in TOML, in JSON, at the command line (`--set`) and in a link of the
page; the sentence is the same in all of them.
"""

from typing import Any

import tippetop as tt


class _Lost:
    """Stands for a field that is left out."""

    def __repr__(self) -> str:
        return "left out"


LOST = _Lost()
"""Stands for a field that is left out."""

SPIN, RATE = "launch.spin", "is not an angular velocity"

Mistake = tuple[str, Any, str, str]
"""The field written, the value, the field that the sentence names, and words that it has."""

NUMBERS: list[Mistake] = [
    (field, value, field, words)
    for field, value, words in [
        # Decimal commas, thousands, and other ways to write a number.
        (SPIN, "1,55", "write 1.55"),
        (SPIN, "155,5", "write 155.5"),
        (SPIN, "-1,5", "write -1.5"),
        (SPIN, "0,5", "write 0.5"),
        (SPIN, "1.234,5", "write 1234.5"),
        (SPIN, "1,234.5", "write 1234.5"),
        (SPIN, "1,234,567", "write 1234567"),
        (SPIN, "2,200", "write 2.200, or 2200 if thousands are meant"),
        (SPIN, "2 200", "write 2200"),
        (SPIN, "2'200", "write 2200"),
        (SPIN, "2_200", "write 2200"),
        (SPIN, "155,", "write 155"),
        ("launch.tilt", "0,1", "write 0.1"),
        ("launch.tilt", "0,1 rad", "write 0.1 rad"),
        ("launch.tilt", "5,7 deg", "write 5.7 deg"),
        ("launch.tilt", "pi/2", "write 1.570796"),
        ("launch.tilt", "π/4", "write 0.7853982"),
        ("launch.tilt", "2*pi/3", "write 2.094395"),
        ("launch.tilt", "0.5 pi", "write 1.570796"),
        ("launch.tilt", "1/2", "write 0.5"),
        ("launch.tilt", "1/10 rad", "write 0.1 rad"),
        ("body.mass", "0,02", "write 0.02"),
        ("body.mass", "20,5 g", "write 20.5 g"),
        ("body.mass", "1/50", "write 0.02"),
        ("body.shape.radius", "0,02", "write 0.02"),
        ("body.shape.radius", "1/2 in", "write 0.5 in"),
        ("body.shape.eccentricity", "0,3", "write 0.3"),
        ("friction.mu", "0,3", "write 0.3"),
        ("gravity", "9,81", "write 9.81"),
        ("gravity", "9,81 m/s^2", "write 9.81 m/s^2"),
        # Words, nothing, and text where a number is meant.
        (SPIN, "fast", "write a number in rad/s, or with its unit"),
        (SPIN, "", "is not a number"),
        (SPIN, "-", "is not a number"),
        (SPIN, "one hundred", "is not a number"),
        (SPIN, "1e", "unknown unit"),
        (SPIN, "0x10", "write it in rad/s, rpm or rev/s"),
        (SPIN, "..5", "is not a number"),
        (SPIN, "~150", "is not a number"),
        (SPIN, "150-160", "write it in rad/s, rpm or rev/s"),
        (SPIN, "155 rad/s rad", "write it in rad/s"),
        (SPIN, True, "is not a number"),
        (SPIN, False, "is not a number"),
        (SPIN, [155], "is not a finite number"),
        (SPIN, [], "is not a finite number"),
        (SPIN, 10**400, "is not a finite number"),
        ("launch.tilt", True, "is not a number"),
        ("launch.tilt", "upright", "write a number in rad, or with its unit"),
        ("launch.tilt", "small", "is not a number"),
        ("body.mass", "light", "write a number in kg, or with its unit"),
        ("body.mass", [0.02], "is not a finite number"),
        ("body.I1", "sphere", "write a number in kg m^2"),
        ("friction.mu", "wood", "write a number in s/m"),
        ("friction.mu", "low", "is not a number"),
        ("gravity", "earth", "write a number in m/s^2"),
        ("gravity", "g", "is not a number"),
        ("launch.gap", "none", "is not a number"),
        ("launch.azimuth", "north", "is not a number"),
        ("contact.restitution", "elastic", "is not a number"),
        # Units of another quantity, and unknown ones.
        (SPIN, "25 Hz", "is a frequency, not an angular velocity (write 25 rev/s for turns"),
        (SPIN, "25Hz", "write 25 rev/s for turns, or 25 rad/s"),
        (SPIN, "0.5 kHz", "write it in rev/s for turns, or in rad/s"),
        (SPIN, "155 1/s", "is a frequency, not an angular velocity"),
        (SPIN, "155 s-1", "is a frequency, not an angular velocity"),
        (SPIN, "2200 deg", "is an angle, not an angular velocity"),
        (SPIN, "25 turns", "is an angle, not an angular velocity"),
        (SPIN, "25 rev", "write it in rad/s, rpm or rev/s"),
        (SPIN, "3 m/s", "is a velocity, not an angular velocity"),
        (SPIN, "3 kg", "is a mass, not an angular velocity"),
        (SPIN, "2200 rpm.", "unknown unit"),
        (SPIN, "2200 Rpm", "did you mean rpm?"),
        (SPIN, "2200 rmp", "Write it in rad/s, rpm or rev/s"),
        (SPIN, "155 rad/sek", "unknown unit"),
        (SPIN, "155 radian-s", "rad/s, rpm or rev/s"),
        (SPIN, "155 (rad/s)", "unknown unit"),
        (SPIN, "2200 U/min", "write it in rad/s, rpm or rev/s"),
        (SPIN, "155 rad/s^2", "is another quantity, not an angular velocity"),
        ("launch.tilt", "5 rpm", "is an angular velocity, not an angle"),
        ("launch.tilt", "10 %", "is a pure number, not an angle"),
        ("launch.tilt", "5 mm", "is a length, not an angle"),
        ("launch.tilt", "5 degre", "did you mean deg?"),
        ("launch.tilt", "5 gradus", "Write it in rad or deg"),
        ("launch.azimuth", "90 s", "is a time, not an angle"),
        ("launch.tilt_rate", "5 deg", "is an angle, not an angular velocity"),
        ("launch.tilt_rate", "2 Hz", "write 2 rev/s for turns, or 2 rad/s"),
        ("launch.precession", "3 Hz", "write 3 rev/s for turns, or 3 rad/s"),
        ("launch.precession", "3 s", "is a time, not an angular velocity"),
        ("launch.gap", "1 g", "is a mass, not a length"),
        ("launch.gap", "1 cmm", "Write it in m, cm, mm or in"),
        ("body.mass", "20 cm", "is a length, not a mass"),
        ("body.mass", "0.2 N", "is a force, not a mass"),
        ("body.mass", "20 gr/cm^3", "is a density, not a mass"),
        ("body.mass", "20 gm", "unknown unit"),
        ("body.mass", "20 grm", "Write it in kg or g"),
        ("body.shape.radius", "20 g", "is a mass, not a length"),
        ("body.shape.radius", "4 cm^2", "is an area, not a length"),
        ("body.shape.radius", "33 cm^3", "is a volume, not a length"),
        ("body.shape.radius", "2 zoll", "write it in m, cm, mm or in"),
        ("body.shape.radius", '0.8"', "write it in m, cm, mm or in"),
        ("body.shape.eccentricity", "6 mm", "is a length, not a pure number"),
        ("body.shape.eccentricity", "0.3 rad", "is an angle, not a pure number"),
        ("body.I1", "3e-6 kg", "is a mass, not a moment of inertia"),
        ("body.I1", "30 g cm", "write it in kg m^2 or g cm^2"),
        ("body.I3", "3e-6 m^2", "is an area, not a moment of inertia"),
        ("friction.mu", "0.3 m/s", "is a velocity, not a viscous friction coefficient"),
        ("friction.mu", "30 %", "is a pure number, not a viscous friction coefficient"),
        ("gravity", "9.81 m/s", "is a velocity, not an acceleration"),
        ("gravity", "9.81 N", "is a force, not an acceleration"),
        ("rolling_resistance", "0.1 N", "is a force, not a length"),
        ("contact.restitution", "0.5 m", "is a length, not a pure number"),
        # Numbers that are too large or too small, and degrees for radians.
        ("launch.tilt", 6, 'for 6 degrees write 0.1047, or "6 deg"'),
        ("launch.tilt", 5.7, 'for 5.7 degrees write 0.09948, or "5.7 deg"'),
        ("launch.tilt", 45, 'for 45 degrees write 0.7854, or "45 deg"'),
        ("launch.tilt", 90, 'for 90 degrees write 1.571, or "90 deg"'),
        ("launch.tilt", 180, 'for 180 degrees write 3.142, or "180 deg"'),
        ("launch.tilt", 200, "at least 0 and at most pi"),
        ("launch.tilt", "200 deg", "at least 0 and at most pi"),
        ("launch.tilt", -0.1, "at least 0 and at most pi"),
        ("launch.tilt", "-5 deg", "at least 0 and at most pi"),
        ("launch.gap", -0.01, "a number at least 0"),
        ("body.mass", 0, "a number greater than 0"),
        ("body.mass", -0.02, "a number greater than 0"),
        ("body.mass", "-20 g", "a number greater than 0"),
        ("body.I1", -3e-6, "a number greater than 0"),
        ("body.I3", 0, "a number greater than 0"),
        ("body.I3", 1e-5, "at most 2 I1"),
        ("body.shape.radius", 0, "a number greater than 0"),
        ("body.shape.radius", -0.02, "a number greater than 0"),
        ("body.shape.eccentricity", 1.2, "greater than 0 and less than 1"),
        ("body.shape.eccentricity", 30, "greater than 0 and less than 1"),
        ("body.shape.eccentricity", 0, "greater than 0 and less than 1"),
        ("body.shape.eccentricity", -0.3, "greater than 0 and less than 1"),
        ("friction.mu", -0.3, "a number at least 0"),
        ("gravity", 0, "a number greater than 0"),
        ("gravity", -9.8, "a number greater than 0"),
        ("rolling_resistance", -1e-4, "a number at least 0"),
        ("rolling_resistance", 1.0, "the size of this body"),
        ("contact.restitution", 1.5, "at least 0 and at most 1"),
        ("contact.restitution", -0.5, "at least 0 and at most 1"),
        ("contact.restitution", 50, "at least 0 and at most 1"),
        (SPIN, 1e200, "is too large to be computed with"),
        # Velocities and slips of too few or too many numbers, or in other units.
        ("launch.slip", 0.1, "is not 2 numbers"),
        ("launch.slip", [0.1], "is not 2 numbers"),
        ("launch.slip", [0.1, 0, 0], "is not 2 numbers"),
        ("launch.slip", "0.1 m/s", "is not 2 numbers"),
        ("launch.velocity", 0.1, "is not 2 or 3 numbers"),
        ("launch.velocity", [0.1], "is not 2 or 3 numbers"),
        ("launch.velocity", [0.1, 0, 0, 0], "is not 2 or 3 numbers"),
    ]
]

PARTS_OF_LISTS: list[Mistake] = [
    ("launch.slip", ["10 cm", 0], "launch.slip.0", "is a length, not a velocity"),
    ("launch.slip", [0, "0,1"], "launch.slip.1", "write 0.1"),
    ("launch.slip", [0, True], "launch.slip.1", "is not a number"),
    ("launch.velocity", [0, 0, "fast"], "launch.velocity.2", "write a number in m/s"),
    ("launch.velocity", ["1 Hz", 0, 0], "launch.velocity.0", "is a frequency, not a velocity"),
]

NAMES: list[Mistake] = [
    (field, value, field, words)
    for field, value, words in [
        # A field in the wrong place, by another name, or misspelt.
        ("spin", 155, "did you mean launch.spin?"),
        ("tilt", 0.1, "did you mean launch.tilt?"),
        ("mu", 0.3, "did you mean friction.mu?"),
        ("mass", 0.02, "did you mean body.mass?"),
        ("radius", 0.02, "did you mean body.shape.radius?"),
        ("eccentricity", 0.3, "did you mean body.shape.eccentricity?"),
        ("alpha", 0.3, "did you mean body.shape.eccentricity?"),
        ("restitution", 0.5, "did you mean contact.restitution?"),
        ("liftoff", "fly", "did you mean contact.liftoff?"),
        ("omega", 155, "did you mean launch.spin?"),
        ("theta", 0.1, "did you mean launch.tilt?"),
        ("g", 9.8, "did you mean gravity?"),
        ("launch.mu", 0.3, "did you mean friction.mu?"),
        ("launch.omega3", 155, "did you mean"),
        ("launch.theta", 0.1, "did you mean"),
        ("launch.phi", 0.1, "did you mean"),
        ("launch.phi_dot", 0.1, "did you mean"),
        ("launch.theta_dot", 0.1, "did you mean"),
        ("launch.height", 0.1, "did you mean"),
        ("launch.tlit", 0.1, "did you mean"),
        ("launch.spn", 155, "did you mean"),
        ("launch.Spin", 155, "did you mean"),
        ("launch.velocty", [1, 0, 0], "did you mean"),
        ("launch.gravity", 9.8, "did you mean gravity?"),
        ("body.m", 0.02, "did you mean"),
        ("body.weight", 0.02, "did you mean"),
        ("body.i1", 3e-6, "did you mean"),
        ("body.Ixx", 3e-6, "did you mean"),
        ("body.Izz", 3e-6, "did you mean"),
        ("body.alpha", 0.3, "did you mean body.shape.eccentricity?"),
        ("body.radius", 0.02, "did you mean body.shape.radius?"),
        ("body.shapes", 3, "did you mean"),
        ("body.I2", 3e-6, "bodies of revolution only"),
        ("density", 700.0, "a field of a workpiece; tippetop body FILE --toml"),
        ("body.Iyy", 3e-6, "bodies of revolution only"),
        ("body.shape.alpha", 0.3, "did you mean"),
        ("body.shape.r", 0.02, "did you mean"),
        ("body.shape.excentricity", 0.3, "did you mean"),
        ("body.shape.along", 0.03, "it is a field of the kind spheroid"),
        ("body.shape.tube", 0.01, "it is a field of the kind ring"),
        ("friction.mue", 0.3, "did you mean"),
        ("friction.coefficient", 0.3, "did you mean"),
        ("friction.eps", 1e-3, "it is a field of the kind regularized_coulomb"),
        ("friction.patch_radius", 1e-3, "it is a field of the kind contensou"),
        ("contact.e", 0.5, "did you mean"),
        ("contact.lift_off", "fly", "did you mean"),
        ("colour", "red", "is given for an unknown field"),
        # Words that are none of the choices.
        ("friction.kind", "coulmb", "did you mean coulomb?"),
        ("friction.kind", "Coulomb", "did you mean coulomb?"),
        ("friction.kind", "dry", "is not one of viscous"),
        ("friction.kind", 3, "is not one of viscous"),
        ("body.shape.kind", "sphre", "did you mean sphere?"),
        ("body.shape.kind", "ellipsoid", "bodies of revolution only"),
        ("body.shape.kind", "box", "bodies of revolution only"),
        ("body.shape.kind", "cube", "bodies of revolution only"),
        ("body.shape.kind", "torus", "is not one of eccentric_sphere"),
        ("contact.liftoff", "jump", "is not one of fly, stop, ignore"),
        ("contact.liftoff", "flys", "did you mean fly?"),
        # Parts that are no tables.
        ("body", 3, "is not a table of its fields"),
        ("body", "report", "is not a table of its fields"),
        ("body.shape", "sphere", "is not a table of its fields"),
        ("body.shape", 0.02, "is not a table of its fields"),
        ("friction", 0.3, "is not a table of its fields"),
        ("friction", "coulomb", "is not a table of its fields"),
        ("launch", 155, "is not a table of its fields"),
        ("contact", "fly", "is not a table of its fields"),
    ]
]

MISSING: list[Mistake] = [
    ("launch.spin", LOST, "launch.spin", "is missing (write a number in rad/s)"),
    ("launch.tilt", LOST, "launch.tilt", "is missing (write a number in rad)"),
    ("body.mass", LOST, "body.mass", "is missing (write a number in kg)"),
    ("body.I1", LOST, "body.I1", "is missing (write a number in kg m^2)"),
    ("body.shape", LOST, "body.shape", "is missing"),
    ("body", LOST, "body", "is missing (write a table of its fields)"),
    ("friction", LOST, "friction", "is missing"),
    ("friction.kind", LOST, "friction.kind", "is missing (write one of viscous"),
    ("friction.mu", LOST, "friction.mu", "is missing (write a number in s/m)"),
    ("launch", LOST, "launch", "is missing"),
]

MISTAKES = [*NUMBERS, *PARTS_OF_LISTS, *NAMES, *MISSING]


def fields_with(field: str, value: Any) -> dict[str, Any]:
    """The fields of the report's problem with one mistake."""
    fields = tt.presets.report_problem().model_dump(mode="json", exclude_none=True)
    *around, last = field.split(".")
    table = fields
    for name in around:
        table = table[name]
    if value is LOST:
        del table[last]
    else:
        table[last] = value
    return fields
