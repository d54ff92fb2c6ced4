"""The physics of a run, complete and validated: body, friction, launch, contact and gravity.

Every part is frozen, refuses what cannot be, and reads and writes TOML and JSON.
"""

import json
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Self

import tomli_w
from pydantic import model_validator

from tippetop.mechanics.contacts.forces import is_set_valued
from tippetop.mechanics.contacts.slip_variables import is_slipping, size
from tippetop.mechanics.laws.coulomb import RollingResistance
from tippetop.mechanics.motion import along_table, contact, on_table
from tippetop.mechanics.state import State
from tippetop.mechanics.surfaces.hull import Hull, is_edge, lowest_surface, sizes
from tippetop.mechanics.surfaces.surface import POLE
from tippetop.mechanics.top import Top, natural_state, natural_units
from tippetop.mechanics.vectors import Functions
from tippetop.mechanics.view import Angles, PoleExact, state_from_angles
from tippetop.problem.bodies import Body
from tippetop.problem.contact_rules import Contact
from tippetop.problem.frictions import LEAST_PATCH, Friction
from tippetop.problem.launch import Launch
from tippetop.support.errors import MISSING, InvalidInput, require
from tippetop.support.field_paths import (
    dotted_names,
    is_place,
    numbers_of,
    part_at,
    table_at,
    with_its_list,
)
from tippetop.support.files import made_of, read_text
from tippetop.support.parsing import parse_json, parse_toml
from tippetop.support.suggestions import likely, unknown_field
from tippetop.support.validation import (
    OF_ITS_KIND,
    NotNegative,
    Part,
    Positive,
    Quantity,
    Variant,
    declare_places,
)


class Problem(Part):
    """Everything physical about a run.

    Attributes
    ----------
    body
        What spins.
    friction
        The law of the table.
    launch
        How it is set going.
    contact
        What becomes of a contact that would have to pull, and of impacts.
    gravity
        Acceleration of gravity, m/s^2.
    rolling_resistance
        Arm of the normal force's couple against rolling beside any law of friction, m, no longer
        than the body is large: the table resists the horizontal angular velocity w_t with the
        torque N rolling_resistance, and holds it at zero where less is enough for that.

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

    @model_validator(mode="after")
    def _contact_is_possible(self) -> Self:
        _refuse_what_does_not_fit(self)
        if _lies_flat(self):
            raise InvalidInput(
                "launch.tilt",
                self.launch.tilt,
                "a tilt at which the body does not lie flat",
                "lays the body flat on its face",
            )
        if not (math.isfinite(_resistance(self)) and math.isfinite(_largest_square(self))):
            raise _out_of_reach(self)
        if self.contact.liftoff == "fly":
            return self
        if isinstance(self.top.surface, Hull):
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
                "starts off the table, or leaves it, where contact.liftoff is not 'fly'",
                "leave it out, or let the body fly",
            )
        if not _resistance(self) > 0:
            raise InvalidInput(
                "launch.slip",
                self.launch.slip,
                "less slip or less friction",
                "is too much: here any push of the table would drag the body further into it"
                " (Painleve's paradox)",
                "write less slip or less friction, or contact.liftoff = 'fly'",
            )
        return self

    @property
    def top(self) -> Top:
        """The problem's numbers as the mechanics takes them, SI."""
        body, arm = self.body, self.rolling_resistance
        resistance = None if isinstance(arm, (int, float)) and not arm else RollingResistance(arm)
        return Top(
            body.mass, body.I1, body.I3, body.surface, self.friction.law, self.gravity, resistance
        )

    def standing(self, functions: Functions = math) -> Top:
        """The top on the surface that reaches lowest at launch."""
        top, cosine = self.top, PoleExact(functions).cos(self.launch.tilt)
        if not isinstance(top.surface, Hull):
            return top
        return top._replace(surface=lowest_surface(top.surface, cosine))

    def start(self, functions: Functions = math) -> State:
        """The state at launch, SI; with sine and cosine for whatever the fields are, such as
        arrays.
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
        velocity = touching.velocity
        if launch.velocity is not None:
            x, y, up = launch.velocity
            # A horizontal velocity on the table has the vertical part that keeps contact.
            velocity = (x, y, up + (up == 0.0) * (launch.gap == 0.0) * velocity[2])
        return touching._replace(height=touching.height + launch.gap, velocity=velocity)

    # translate: skip
    def replace(self, changes: Mapping[str, Any]) -> Self:
        """Copy with some fields replaced, named with dots: ``problem.replace({"launch.spin":
        100.0})``.

        Another `kind` of a part keeps the fields that the new one has too, and may be given the
        rest.

        Raises
        ------
        InvalidInput
            If there is no such field, it cannot have such a value, or is given again within
            another's.
        """
        if not (isinstance(changes, Mapping) and all(isinstance(name, str) for name in changes)):
            raise InvalidInput("changes", changes, "a dict of values by the names of fields")
        for name in changes:
            whole = next((other for other in changes if name.startswith(f"{other}.")), None)
            if whole is not None:
                raise InvalidInput(
                    name,
                    changes[name],
                    "",
                    f"stands beside a value of {whole}, which holds it",
                    "leave out one",
                )
        fields = self.model_dump()
        renewed = set()
        for name, value in changes.items():
            where, _, last = name.rpartition(".")
            part = part_at(self, where) if last == "kind" else None
            if isinstance(part, Variant) and value != getattr(part, "kind", None):
                renewed.add(where)
                table, kept = table_at(fields, where), part.fields_of(value)
                for field in table.keys() - kept:
                    del table[field]
        for given, new in changes.items():
            name, value = with_its_list(fields, given, new)
            where, _, last = name.rpartition(".")
            table = table_at(fields, where)
            if last not in table and where not in renewed:
                part = part_at(self, where)
                kinds = part.kinds_with(last) if isinstance(part, Variant) else ()
                raise unknown_field(name, value, list(dotted_names(fields)), self.places, kinds)
            table[last] = value
        return type(self)(**fields)

    # translate: skip
    def to_toml(self) -> str:
        """Write the problem as TOML."""
        return tomli_w.dumps(json.loads(self.to_json()))

    # translate: skip
    def to_json(self) -> str:
        """Write the problem as JSON."""
        return self.model_dump_json(exclude_none=True)

    # translate: skip
    @classmethod
    def from_toml(cls, text: str) -> Self:
        """Read a problem from TOML text.

        Raises
        ------
        InvalidInput
            If the text is not TOML, or not a problem.
        """
        return cls(**parse_toml(text, "problem"))

    # translate: skip
    @classmethod
    def from_json(cls, text: str) -> Self:
        """Read a problem from JSON text.

        Raises
        ------
        InvalidInput
            If the text is not JSON, or not a problem.
        """
        return cls(**parse_json(text, "problem"))

    # translate: skip
    @classmethod
    def read(cls, path: Path | str) -> Self:
        """Read a problem from a .toml or .json file.

        Raises
        ------
        FileTrouble
            If the file cannot be read.
        InvalidInput
            If it does not hold a problem.
        """
        text = read_text(path, "a problem in TOML or JSON")
        parse = parse_json if Path(path).suffix.lower() == ".json" else parse_toml
        fields = parse(text, "problem", Path(path).name)
        with made_of(path):
            return cls(**fields)


# translate: skip
PLACES = declare_places(Problem)
"""The full names of all fields by their last names, for whoever writes a field elsewhere."""


# translate: skip
def get(problem: Problem, path: str) -> Any:
    """Return the value of a field of a problem, or a part of it, named with dots.

    The paths are those of `Problem.replace` and of the axes of a sweep.

    Raises
    ------
    InvalidInput
        If there is no such field.

    Examples
    --------
    >>> import tippetop as tt
    >>> problem = tt.presets.report_problem(spin=155.0)
    >>> tt.get(problem, "launch.spin")
    155.0
    >>> problem.replace({"launch.spin": 1.1 * tt.get(problem, "launch.spin")}).launch.spin
    170.5
    """
    require_problem(problem)
    require("path", path, str, "the name of a field with dots, such as launch.spin")
    where, _, last = path.rpartition(".")
    whole = part_at(problem, where)
    if isinstance(whole, Part) and last in type(whole).model_fields:
        return getattr(whole, last)
    if isinstance(whole, tuple) and is_place(last, whole):
        return whole[int(last)]
    meant = likely(path, list(dotted_names(problem.model_dump())), problem.places)
    hint = f"did you mean {meant}?" if meant else ""
    raise InvalidInput("path", path, "the name of a field, such as launch.spin", hint=hint)


# translate: drop
def require_problem(problem: object) -> None:
    """Refuse what is no problem, with `InvalidInput`."""
    require("problem", problem, Problem, "a Problem, such as presets.report_problem() makes")


def _refuse_what_does_not_fit(problem: Problem) -> None:
    """Refuse a patch, or an arm, that is larger than the body, or a patch that is but a point."""
    size = max(sizes(problem.body.surface))
    if not problem.friction.fits(size):
        accepted = f"a radius from {_inside(LEAST_PATCH * size, 1.0)} to {_inside(size, -1.0)} m"
        raise InvalidInput(
            "friction.patch_radius",
            getattr(problem.friction, "patch_radius", MISSING),
            accepted,
            "does not fit this body",
            f"write {accepted}; for a smaller patch, a point, there is coulomb",
        )
    if problem.rolling_resistance > size:
        raise InvalidInput(
            "rolling_resistance",
            problem.rolling_resistance,
            f"a length from 0 to {_inside(size, -1.0)} m, the size of this body",
        )


def _resistance(problem: Problem) -> float:
    """The resistance of the contact at launch; nan where its arithmetic breaks down."""
    try:
        start, top = along_table(problem.start()), problem.standing()
        if is_set_valued(problem.friction.law) and not is_slipping(*start, top):
            return 1.0 + 0.0 * size(start.momentum)
        touch = contact(start.axis, start.momentum, start.velocity, top)
        return float(touch.delassus + 0.0 * touch.free_acceleration)
    except ArithmeticError:
        return math.nan


def _largest_square(problem: Problem) -> float:
    """The largest square among the numbers of the launch in natural units, and in SI; nan without
    one.
    """
    try:
        units = natural_units(problem.top)
        start = natural_state(problem.start(), units)
        largest = float(max(map(abs, (*start.momentum, *start.velocity, start.height))))
        return largest**2 * max(
            1.0, float(units.energy), float(problem.body.mass * problem.gravity)
        )
    except ArithmeticError:
        return math.nan


def _lies_flat(problem: Problem) -> bool:
    """Whether the top is launched on a ring that is parallel to the table, all around."""
    try:
        edge = is_edge(problem.standing().surface)
    except ArithmeticError:
        return False
    return edge and PoleExact(math).sin(problem.launch.tilt) ** 2 <= POLE


def _out_of_reach(problem: Problem) -> InvalidInput:
    """The refusal of numbers with which no computer can reckon, about the one furthest from 1."""
    numbers = {name: value for name, value in numbers_of(problem.model_dump()) if value}
    distance = {name: abs(math.log(abs(value))) for name, value in numbers.items()}
    worst = max(distance, key=lambda name: distance[name])
    others = sum(2 * other > distance[worst] for other in distance.values()) - 1
    fault = (
        "is too large to be computed with"
        if abs(numbers[worst]) > 1.0
        else "is too close to 0 to be computed with"
    )
    return InvalidInput(worst, numbers[worst], "a number nearer to 1", fault, others=others)


def _inside(bound: float, side: float) -> str:
    """A bound in three digits, not beyond it: no less if the side is 1, and no more if it is -1."""
    near = float(f"{bound:.3g}")
    if (near - bound) * side < 0.0:
        near += side * 10.0 ** (math.floor(math.log10(bound)) - 2)
    return f"{near:.3g}"
