"""`Problem`: the complete, validated physics of a run, with its reading and writing.

A problem has a body, a friction law, a launch, rules of contact, gravity, a table and air. All
parts are frozen.
"""

import json
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Self

import numpy as np
import tomli_w
from pydantic import model_validator

from tippetop.mechanics.contacts.forces import is_set_valued
from tippetop.mechanics.contacts.slip_variables import is_slipping, size, slip_of
from tippetop.mechanics.face_motion import face_radii
from tippetop.mechanics.field import OuterField
from tippetop.mechanics.laws.coulomb import RollingResistance
from tippetop.mechanics.laws.friction import FrictionLaw
from tippetop.mechanics.motion import (
    along_table,
    angular_velocity,
    on_table,
    sliding_contact,
)
from tippetop.mechanics.state import State
from tippetop.mechanics.surfaces.hull import (
    Hull,
    acting,
    each_surface,
    has_flat_end,
    is_edge,
    sizes,
)
from tippetop.mechanics.top import Top, natural_state, natural_units
from tippetop.mechanics.vectors import Functions, Horizontal, Vector
from tippetop.mechanics.view import Angles, PoleExact, state_from_angles
from tippetop.problem.air import Air
from tippetop.problem.bodies import Body
from tippetop.problem.contact_rules import Contact
from tippetop.problem.frictions import LEAST_PATCH, Friction
from tippetop.problem.launch import Launch
from tippetop.problem.table import Table
from tippetop.support.errors import MISSING, Described, InvalidInput, require
from tippetop.support.field_paths import (
    dotted_names,
    is_place,
    numbers_of,
    part_at,
    table_at,
    with_its_list,
)
from tippetop.support.files import made_of, path_of, read_text, require_ending, written_beside
from tippetop.support.parsing import parse_json, parse_toml
from tippetop.support.suggestions import likely, unknown_field
from tippetop.support.validation import (
    OF_ITS_KIND,
    PLACES,
    NotNegative,
    Part,
    Positive,
    Quantity,
    Variant,
    declare_places,
    fields_of_kind,
    kinds_with,
)

PROFILES = (".csv", ".svg", ".dxf", ".stl", ".obj", ".ply", ".off")
"""Suffixes of files with the profile of a body, which are no problems."""

EXTREME = 1e100
"""Number, and its inverse, beyond which an overflow is blamed on a number of the problem and not
on its friction law: numbers less extreme overflow in the fourth power only.
"""


class Problem(Part):
    """Physics of a run.

    Attributes
    ----------
    body
        The body.
    friction
        The friction law of the table.
    launch
        The initial state.
    contact
        The rules for lift-off and impacts.
    gravity
        Acceleration of gravity, m/s^2.
    rolling_resistance
        Arm of the couple of the normal force that resists rolling, m, at most the size of the body.
        In addition to friction, the table opposes the horizontal angular velocity w_t with the
        torque N rolling_resistance, and holds w_t at zero if a smaller torque is enough.
    table
        The table, which may slope.
    air
        What air resists; none without it.

    Examples
    --------
    >>> import tippetop as tt
    >>> problem = tt.Problem(
    ...     body=tt.presets.REPORT,
    ...     friction=tt.ViscousFriction(mu=0.3),
    ...     launch=tt.Launch(tilt=0.1, spin=155.0),
    ... )
    >>> faster = problem.replace({"launch.spin": 175.0})
    >>> tt.Problem.from_toml(faster.to_toml()) == faster
    True
    """

    body: Body
    friction: Annotated[Friction, OF_ITS_KIND]
    launch: Launch
    contact: Annotated[Contact, OF_ITS_KIND] = Contact()
    gravity: Annotated[Positive, Quantity("m s-2", "acceleration of gravity")] = 9.8
    rolling_resistance: Annotated[NotNegative, Quantity("m", "rolling resistance")] = 0.0
    table: Table = Table()
    air: Air = Air()

    @model_validator(mode="after")
    def _contact_is_possible(self) -> Self:
        _require_fitting_patch(self)
        _require_face(self)
        _require_finite_friction(self)
        if not (math.isfinite(_resistance(self)) and math.isfinite(_largest_square(self))):
            raise _overflow_refusal(self)
        if self.contact.liftoff == "fly":
            return self
        if isinstance(top_of(self).surface, Hull):
            raise InvalidInput(
                "contact.liftoff", self.contact.liftoff, "'fly'", "is for bodies of one surface"
            )
        launch = self.launch
        if launch.gap or launch.velocity is not None:
            field = "gap" if launch.gap else "velocity"
            raise InvalidInput(
                f"launch.{field}",
                getattr(launch, field),
                "0",
                "lets the body leave the table, but contact.liftoff is not 'fly'",
                "omit it, or write contact.liftoff = 'fly'",
            )
        if not _resistance(self) > 0:
            raise InvalidInput(
                "launch.slip",
                self.launch.slip,
                "less slip or less friction",
                "is too much: any normal force would accelerate the contact point into the"
                " table (Painleve's paradox)",
                "write less slip or less friction, or contact.liftoff = 'fly'",
            )
        return self

    def standing(self, functions: Functions = math) -> Top:
        """Return the top with the surface active that is lowest at launch."""
        return top_of(self, functions).body.lowest_at(PoleExact(functions).cos(self.launch.tilt))

    def start(self, functions: Functions = math) -> State:
        """Return the state at launch, SI.

        `functions` has the sine and cosine for the type of the fields, such as arrays.
        """
        launch, top = self.launch, self.standing(functions)
        angles = Angles(
            launch.tilt,
            launch.tilt_rate,
            launch.azimuth,
            launch.precession,
            launch.spin,
            launch.slip,
        )
        touching = on_table(state_from_angles(angles, top, PoleExact(functions)), top)
        touches = launch.gap == 0.0
        east, north, sinking = touching.velocity
        if is_edge(top.surface):
            # The rim of a face that tilts stays on the table, and the middle rises.
            is_flat = PoleExact(functions).sin(launch.tilt) == 0.0
            sinking = sinking + is_flat * face_radii(top.surface)[1] * abs(launch.tilt_rate)
        velocity = (touches * east, touches * north, touches * sinking)
        if launch.velocity is not None:
            x, y, up = launch.velocity
            # A horizontal velocity on the table gets the vertical component that maintains contact.
            velocity = (x, y, up + (up == 0.0) * touches * sinking)
        return touching._replace(height=touching.height + launch.gap, velocity=velocity)

    @property
    def gravity_vector(self) -> Vector:
        """Acceleration of gravity along x, y and z of the table, m/s^2."""
        top = top_of(self)
        field = top.field
        east, north = (0.0, 0.0) if field is None or field.slope is None else field.slope
        return (east, north, -top.gravity)

    # translate: skip
    def replace(self, changes: Mapping[str, Any]) -> Self:
        """Return a copy with some fields replaced, by dotted names: ``{"launch.spin": 100.0}``.

        With another `kind` of a part, fields that both kinds have keep their values, and values for
        the others may be given.

        Raises
        ------
        InvalidInput
            If there is no such field, it does not accept the value, or a value is given for both a
            part and a field in it.
        """
        if not (isinstance(changes, Mapping) and all(isinstance(name, str) for name in changes)):
            raise InvalidInput("changes", changes, "a dict of values by the names of fields")
        for name in changes:
            part_name = next((outer for outer in changes if name.startswith(f"{outer}.")), None)
            if part_name is not None:
                raise InvalidInput(
                    name,
                    changes[name],
                    "",
                    f"is given beside a value of {part_name}, which contains it",
                    "omit one of them",
                )
        fields = self.model_dump()
        renewed = set()
        for name, value in changes.items():
            where, _, last = name.rpartition(".")
            part = part_at(self, where) if last == "kind" else None
            if isinstance(part, Variant) and value != getattr(part, "kind", None):
                renewed.add(where)
                table, common = table_at(fields, where), fields_of_kind(type(part), value)
                for field in table.keys() - common:
                    del table[field]
        for path, new in changes.items():
            name, value = with_its_list(fields, path, new)
            where, _, last = name.rpartition(".")
            table = table_at(fields, where)
            if last not in table and where not in renewed:
                part = part_at(self, where)
                kinds = kinds_with(type(part), last) if isinstance(part, Variant) else ()
                raise unknown_field(name, value, list(dotted_names(fields)), PLACES, kinds)
            table[last] = value
        return type(self)(**fields)

    # translate: skip
    def get(self, field: str) -> Any:
        """Return the value of a field, or a part, by its dotted name.

        The names are those of `replace` and of the fields of a sweep.

        Raises
        ------
        InvalidInput
            If there is no such field.

        Examples
        --------
        >>> import tippetop as tt
        >>> problem = tt.presets.report_problem(spin=155.0)
        >>> problem.get("launch.spin")
        155.0
        >>> problem.replace({"launch.spin": 1.1 * problem.get("launch.spin")}).launch.spin
        170.5
        """
        require("field", field, str, "the name of a field with dots, such as launch.spin")
        where, _, last = field.rpartition(".")
        part = part_at(self, where)
        if isinstance(part, Part) and last in type(part).model_fields:
            return getattr(part, last)
        if isinstance(part, tuple) and is_place(last, part):
            return part[int(last)]
        meant = likely(field, list(dotted_names(self.model_dump())), PLACES)
        hint = f"did you mean {meant}?" if meant else ""
        raise InvalidInput("field", field, "the name of a field, such as launch.spin", hint=hint)

    # translate: skip
    def to_toml(self) -> str:
        """Return the problem as a TOML text."""
        return tomli_w.dumps(json.loads(self.to_json()))

    # translate: skip
    def to_json(self) -> str:
        """Return the problem as a JSON text."""
        return self.model_dump_json(exclude_none=True)

    # translate: skip
    @classmethod
    def from_toml(cls, text: str) -> Self:
        """Return the problem that a TOML text states.

        Raises
        ------
        InvalidInput
            If the text is not TOML, or not a problem.
        """
        return cls(**parse_toml(text, "problem"))

    # translate: skip
    @classmethod
    def from_json(cls, text: str) -> Self:
        """Return the problem that a JSON text states.

        Raises
        ------
        InvalidInput
            If the text is not JSON, or not a problem.
        """
        return cls(**parse_json(text, "problem"))

    # translate: skip
    @classmethod
    def read(cls, path: Path | str) -> Self:
        """Return the problem that a .toml or .json file states.

        Raises
        ------
        FileTrouble
            If the file cannot be read.
        InvalidInput
            If it does not hold a problem.
        """
        fields = fields_in(path)
        with made_of(path):
            return cls(**fields)

    # translate: skip
    def write(self, path: Path | str, overwrite: bool = False) -> Path:
        """Write the problem as a .toml or .json file, and return its path.

        Raises
        ------
        InvalidInput
            If the name has another suffix.
        FileTrouble
            If the file exists and `overwrite` is false, or cannot be written.

        Examples
        --------
        >>> import tippetop as tt
        >>> problem = tt.presets.report_problem(spin=155.0)
        >>> tt.Problem.read(problem.write("problem.toml")) == problem
        True
        """
        place = path_of(path)
        suffix = require_ending("path", place, (".toml", ".json"))
        text = self.to_toml() if suffix == ".toml" else self.to_json() + "\n"
        with written_beside(place, overwrite) as beside:
            beside.write_text(text, encoding="utf-8")
        return place


# translate: drop
def fields_in(path: Path | str) -> dict[str, Any]:
    """Return the fields that a .toml or .json file with a problem states.

    Raises `FileTrouble` if the file cannot be read, and `InvalidInput` if it is not TOML or JSON.
    """
    place = path_of(path)
    suffix = place.suffix.lower()
    if suffix in PROFILES:
        accepted = "a problem in TOML or JSON, which tippetop body makes of a profile with --toml"
        raise InvalidInput("problem", str(place), accepted)
    text = read_text(place, "a problem in TOML or JSON")
    parse = parse_json if suffix == ".json" else parse_toml
    return parse(text, "problem", place.name)


def top_of(problem: Problem, functions: Functions = math) -> Top:
    """Return the numbers of a problem in the form that the mechanics uses, SI.

    `functions` has the sine and cosine for the type of the fields, such as arrays.
    """
    body, arm = problem.body, problem.rolling_resistance
    resistance = None if isinstance(arm, (int, float)) and not arm else RollingResistance(arm)
    return Top.of(
        body.mass,
        body.I1,
        body.I3,
        body.surface,
        problem.friction.law,
        problem.table.normal(problem.gravity, functions),
        resistance,
        field_of(problem, functions),
    )


def field_of(problem: Problem, functions: Functions = math) -> OuterField | None:
    """Return gravity along the table, and air, SI; None on a level table without air."""
    air = problem.air
    slope = problem.table.along(problem.gravity, functions)
    field = OuterField(slope, air.axial, air.transverse, air.drag)
    return field if field.has_air or field.slope is not None else None


# translate: skip
FULL_NAMES = declare_places(Problem)
"""Full names of all fields by their last names, to suggest the right place of a field."""


# translate: drop
def require_problem(problem: object) -> None:
    """Raise `InvalidInput` unless a value is a problem."""
    require("problem", problem, Problem, "a Problem, such as presets.report_problem() makes")


def _require_face(problem: Problem) -> None:
    """Raise `InvalidInput` for a body that lies on the flat end of a surface of arcs."""
    if problem.launch.gap > 0.0 or not any(map(has_flat_end, each_surface(problem.body.surface))):
        return
    surface = problem.standing().surface
    arcs: Any = acting(surface)
    if has_flat_end(surface) and arcs.end_guard(problem.start().axis) <= 0.0:
        raise InvalidInput(
            "launch.tilt",
            problem.launch.tilt,
            "a tilt at which the body stands on an edge",
            "lays it on the flat end of a surface of arcs, on which no motion is simulated",
        )


def _require_fitting_patch(problem: Problem) -> None:
    """Raise `InvalidInput` for a patch or an arm larger than the body, or a far too small patch."""
    size = max(sizes(problem.body.surface))
    if not problem.friction.fits(size):
        accepted = f"a radius from {_inside(LEAST_PATCH * size, 1.0)} to {_inside(size, -1.0)} m"
        raise InvalidInput(
            "friction.patch_radius",
            getattr(problem.friction, "patch_radius", MISSING),
            accepted,
            "does not fit this body",
            f"write {accepted}; for a point contact use the kind coulomb",
        )
    if problem.rolling_resistance > size:
        raise InvalidInput(
            "rolling_resistance",
            problem.rolling_resistance,
            f"a length from 0 to {_inside(size, -1.0)} m, the size of this body",
        )


def _resistance(problem: Problem) -> float:
    """Return the inverse effective mass of the contact at launch; nan if arithmetic overflows."""
    try:
        start, top = along_table(problem.start()), problem.standing()
        if is_set_valued(problem.friction.law) and not is_slipping(*start, top):
            return 1.0 + 0.0 * size(start.momentum)
        touch = sliding_contact(start.axis, start.momentum, start.velocity, top)
        return float(touch.delassus + 0.0 * touch.free_acceleration)
    except ArithmeticError:
        return math.nan


def _require_finite_friction(problem: Problem) -> None:
    """Raise `InvalidInput` for a law without a finite force at the launch, such as one that divides
    0 by 0 where nothing slips, if no number of the problem is so extreme as to be the reason.
    """
    numbers = [abs(number) for _, number in numbers_of(problem.model_dump()) if number]
    if min(numbers) < 1.0 / EXTREME or max(numbers) > EXTREME:
        return
    (axis, momentum, velocity), top = along_table(problem.start()), problem.standing()
    if is_set_valued(top.friction):
        return
    slip = slip_of(axis, momentum, velocity, top)[:2]
    if not is_slipping(axis, momentum, velocity, top):
        slip = (0.0, 0.0)
    if has_force_at(top.friction, slip, angular_velocity(axis, momentum, top)):
        return
    raise InvalidInput(
        "friction",
        Described(f"the law {problem.friction.kind}"),
        "",
        f"has no finite force at the slip speed of the launch, {size(slip):.4g} m/s",
        FORCE_AT_REST,
    )


FORCE_AT_REST = (
    "let the law have one at every slip, and be 0 without slip: if it divides by the slip speed v,"
    " divide by sqrt(v^2 + s^2) instead, with a small speed s"
)
"""What a user's law lacks that divides 0 by 0 where nothing slips."""


def has_force_at(law: FrictionLaw, slip: Horizontal, turning: Vector) -> bool:
    """Return whether a law of friction has a finite force and torque at a slip, m/s."""
    try:
        with np.errstate(all="ignore"):  # laws of NumPy functions warn where they divide 0 by 0
            traction = law.traction(slip, turning)
            return math.isfinite(sum([*traction.force, *traction.torque]))
    except ArithmeticError:
        return False


# translate: skip
def force_missing_at_rest(problem: Problem) -> str:
    """Return a sentence on a law of friction without a finite force at zero slip; empty for others.

    Where dry friction of a point holds, slip ends by the law's set of forces instead.
    """
    start, top = along_table(problem.start()), problem.standing()
    turning = angular_velocity(start[0], start[1], top)
    if is_set_valued(top.friction) or has_force_at(top.friction, (0.0, 0.0), turning):
        return ""
    return f"The law {problem.friction.kind} has no finite force at zero slip: {FORCE_AT_REST}."


def _largest_square(problem: Problem) -> float:
    """Return the largest square of the launch's numbers, natural and SI; nan if it overflows."""
    try:
        units = natural_units(top_of(problem))
        start = natural_state(problem.start(), units)
        largest = float(max(map(abs, (*start.momentum, *start.velocity, start.height))))
        return largest**2 * max(
            1.0, float(units.energy), float(problem.body.mass * problem.gravity)
        )
    except ArithmeticError:
        return math.nan


def _overflow_refusal(problem: Problem) -> InvalidInput:
    """Return the refusal of numbers that overflow, about the one furthest from 1."""
    numbers = {name: value for name, value in numbers_of(problem.model_dump()) if value}
    distance = {name: abs(math.log(abs(value))) for name, value in numbers.items()}
    worst = max(distance, key=lambda name: distance[name])
    others = sum(2 * value > distance[worst] for value in distance.values()) - 1
    fault = (
        "is too large to be computed with"
        if abs(numbers[worst]) > 1.0
        else "is too close to 0 to be computed with"
    )
    return InvalidInput(worst, numbers[worst], "a number nearer to 1", fault, others=others)


def _inside(bound: float, side: float) -> str:
    """Return a bound in three digits, rounded up if the side is 1 and down if it is -1."""
    near = float(f"{bound:.3g}")
    if (near - bound) * side < 0.0:
        near += side * 10.0 ** (math.floor(math.log10(bound)) - 2)
    return f"{near:.3g}"
