"""Options that several commands share, such as those that state a problem."""

import json
from collections.abc import Callable, Mapping, Sequence
from functools import wraps
from inspect import Parameter, Signature, signature
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Concatenate, NamedTuple

import typer

import tippetop as tt
from tippetop.problem.problem import fields_in
from tippetop.support.errors import MISSING, InvalidInput, is_number, short
from tippetop.support.files import made_of, written_beside
from tippetop.support.units import is_unit, number_hint, number_in

if TYPE_CHECKING:
    from matplotlib.figure import Figure

ProblemFile = Annotated[
    Path | None,
    typer.Argument(
        help=("Problem to start from, .toml, .json or MuJoCo's .xml; by default the report's top.")
    ),
]
NUMBER = "NUMBER"
"""Placeholder in the help for a number that may have a unit."""

PROBLEM_OPTIONS = {
    "keyframe": Annotated[
        str | None,
        typer.Option(
            metavar="NAME", help="Keyframe of the .xml file to launch from; by default its first."
        ),
    ],
    "preset": Annotated[
        str | None,
        typer.Option(
            help=(
                "Body by name, such as report, leine-glocker-stem, egg, coin; a wrong one lists"
                " all."
            )
        ),
    ],
    "spin": Annotated[
        str | None,
        typer.Option(metavar=NUMBER, help="Axial spin at launch, rad/s, or as in '2200 rpm'."),
    ],
    "tilt": Annotated[
        str | None,
        typer.Option(
            metavar=NUMBER, help="Tilt of the axis at launch, rad, or as in '5 deg', from 0 to pi."
        ),
    ],
    "mu": Annotated[
        str | None,
        typer.Option(
            metavar=NUMBER, help="Friction coefficient: s/m if viscous, else dimensionless."
        ),
    ],
    "liftoff": Annotated[
        str | None, typer.Option(help="When the table would have to pull: stop, ignore or fly.")
    ],
    "changes": Annotated[
        list[str] | None,
        typer.Option(
            "--set",
            metavar="FIELD=VALUE",
            help="Any other field, e.g. body.shape.radius=2cm or body.shape.eccentricity=0.2.",
        ),
    ],
}
"""Options that change the problem of a file."""

FIELDS_OF_OPTIONS = {
    "spin": "launch.spin",
    "tilt": "launch.tilt",
    "mu": "friction.mu",
    "liftoff": "contact.liftoff",
}
"""Fields of a problem that have an option."""

MJCF_ENDING = ".xml"

Json = Annotated[bool, typer.Option("--json", help="Print JSON for programs.")]
Force = Annotated[bool, typer.Option("--force", help="Overwrite results that exist.")]


DRAWINGS = (".png", ".svg", ".pdf")
"""Accepted suffixes of files with figures."""


class Choice(NamedTuple):
    """The problem that a command line states: its base, and the changes to it."""

    file: Path | None = None
    preset: str | None = None
    settings: Mapping[str, Any] = {}
    changes: Sequence[str] = ()
    keyframe: str | None = None

    def problem(self) -> "tt.Problem":
        """Return the problem of the file, or the report's, with the changes.

        Raises `InvalidInput` if there is no such problem.
        """
        return self.changed(_problem_in(self.file, self._stated(), self.keyframe))

    def changed(self, problem: "tt.Problem") -> "tt.Problem":
        """Return a problem with the changes."""
        is_mjcf = self.file is not None and self.file.suffix.lower() == MJCF_ENDING
        if self.keyframe is not None and not is_mjcf:
            raise InvalidInput(
                "--keyframe", self.keyframe, "", "is only for a file in MJCF, such as top.xml"
            )
        if self.preset is not None:
            problem = problem.model_copy(update={"body": tt.presets.body(self.preset)})
        return problem.replace(self._stated())

    def _stated(self) -> dict[str, Any]:
        """Return the values that options state, by field."""
        changes = dict(self.settings)
        for field, value in map(_parsed, self.changes):
            if field in changes:
                raise InvalidInput(
                    f"--set {field}",
                    value,
                    "one of them",
                    f"is given beside {short(changes[field])} for the same field",
                )
            changes[field] = value
        return changes


def _problem_in(file: Path | None, stated: Mapping[str, Any], keyframe: str | None) -> "tt.Problem":
    """Return the problem of a file in TOML, JSON or MJCF; the report's without one.

    Options state what a file in TOML or JSON lacks.
    """
    if file is None:
        return tt.presets.report_problem()
    if not (file.suffix or file.exists()) and is_unit(str(file)):
        fault = "is a unit, and no file"
        hint = f"write a number and its unit in quotes, as in '2200 {file}'"
        raise InvalidInput("file", str(file), "", fault, hint)
    if file.suffix.lower() == MJCF_ENDING:
        return tt.read_mjcf(file, keyframe)
    try:
        return tt.Problem.read(file)
    except InvalidInput as error:
        if error.value is not MISSING:
            raise
        fields = fields_in(file)
        filled = [name for name, value in stated.items() if _fill(fields, name, value)]
        if not filled:
            raise
    with made_of(file, {name.partition(".")[0] for name in filled}):
        return tt.Problem(**fields)


def _fill(fields: dict[str, Any], name: str, value: Any) -> bool:
    """Put a value into the tables of a file if they lack it, and return whether they did."""
    *tables, last = name.split(".")
    for table in tables:
        fields = fields.setdefault(table, {})
        if not isinstance(fields, dict):
            return False
    is_missing = last not in fields
    if is_missing:
        fields[last] = value
    return is_missing


def of_a_problem(
    command: Callable[Concatenate[Choice, ...], None], file: Any = ProblemFile
) -> Callable[..., None]:
    """Return a command with the options that state a problem.

    The command receives them as its first argument, a `Choice`; `file` is the annotation of the
    file's argument.
    """

    @wraps(command)
    def with_choice(**values: Any) -> None:
        stated = {name: values.pop(name, None) for name in ("file", *PROBLEM_OPTIONS)}
        settings = {
            field: stated_value(stated[name])
            for name, field in FIELDS_OF_OPTIONS.items()
            if stated[name] is not None
        }
        choice = Choice(
            stated["file"],
            stated["preset"],
            settings,
            stated["changes"] or (),
            stated["keyframe"],
        )
        command(choice, **values)

    _, *parameters = signature(command).parameters.values()
    # Arguments without a default come before the file with the problem.
    required = [one for one in parameters if one.default is Parameter.empty]
    optional = [one for one in parameters if one.default is not Parameter.empty]
    of_problem = [
        Parameter(name, Parameter.KEYWORD_ONLY, default=None, annotation=kind)
        for name, kind in {"file": file, **PROBLEM_OPTIONS}.items()
    ]
    in_order = [
        one.replace(kind=Parameter.KEYWORD_ONLY) for one in (*required, *of_problem, *optional)
    ]
    # Typer reads the options from the signature.
    with_choice.__signature__ = Signature(in_order)  # type: ignore[attr-defined]
    return with_choice


def write_figure(figure: "Figure", path: Path, force: bool) -> None:
    """Write a figure in the house style."""
    from tippetop.figures.style import save  # noqa: PLC0415 - slow to import

    with written_beside(path, force) as beside:
        save(figure, beside)


def _parsed(change: str) -> tuple[str, Any]:
    """Return field and value of `--set FIELD=VALUE`."""
    field, equals, value = change.partition("=")
    if not (field and equals):
        raise InvalidInput("--set", change, "FIELD=VALUE, such as launch.spin=155")
    return field, stated_value(value)


def stated_value(text: str) -> Any:
    """Return the value of a text: a number or list as in JSON, else the text itself.

    Numbers that are not finite stay texts, in lists too.
    """
    try:
        return json.loads(text, parse_float=number_or_text, parse_constant=str)
    except (ValueError, RecursionError):
        return text


def number_or_text(text: str) -> float | str:
    """Return the finite number of a text, else the text, so that a refusal shows it as typed."""
    try:
        number = float(text)
    except ValueError:
        return text
    return number if is_number(number) else text


def number_option(kind: type[int] | type[float], text: str) -> Any:
    """Return an option that takes a number of a kind, with its help text.

    The package reads the number itself: what typer says of a wrong one differs by its version.
    """

    def number(word: str) -> int | float:
        try:
            value = kind(word)
            if kind is int or is_number(value):
                return value
        except ValueError:
            pass
        if kind is int:
            refusal = InvalidInput("", word, "a whole number")
        else:
            refusal = InvalidInput("", word, "a finite number", hint=number_hint(word))
        raise typer.BadParameter(str(refusal)) from refusal

    metavar = "INTEGER" if kind is int else NUMBER
    return typer.Option(parser=number, metavar=metavar, help=text)


def density_option(text: str) -> Any:
    """Return an option that takes a density or the name of a material, with its help text."""
    suffix = ", kg/m^3, or as in '0.7 g/cm^3'; or a material, as in 'beech' or, printed with an"
    return typer.Option(metavar=NUMBER, help=f"{text}{suffix} infill, 'PLA 20 %'.")


def density_in(text: str | None) -> float | None:
    """Return the density of the option --density, kg/m^3, or None."""
    from tippetop.lathe.materials import material_density  # noqa: PLC0415 - slow to import

    density = material_density("--density", text)
    return density if isinstance(density, float) else number_of("--density", density, "kg m-3")


def number_of(option: str, text: str | None, units: str) -> float | None:
    """Return the number of an option in SI, converted from its unit if it has one, or None."""
    if text is None:
        return None
    number = stated_value(text)
    if is_number(number):
        return float(number)
    if not isinstance(number, str):
        raise InvalidInput(option, text, "a number")
    converted: float = number_in(option, text, units)
    return converted
