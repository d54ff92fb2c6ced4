"""`tippetop problem`: a problem as TOML, or the JSON Schema of problems."""

import re
from collections.abc import Sequence
from typing import Annotated, Literal, get_args, get_origin

import typer

import tippetop as tt
from tippetop.cli.options import Choice, Json, of_a_problem
from tippetop.cli.terminal import show_json
from tippetop.results.catalogue import written_unit
from tippetop.support.field_paths import part_at

TABLE, FIELD, ITEM = re.compile(r"\[(.+)]"), re.compile(r"([\w-]+) = "), re.compile(r"    -?[\d.]")
"""Patterns of lines of TOML: the head of a table, a field, an item of a list."""


@of_a_problem
def problem(
    choice: Choice,
    as_json: Json = False,
    schema: Annotated[
        bool, typer.Option("--schema", help="Print the JSON Schema of problems.")
    ] = False,
) -> None:
    """Print a problem as TOML with its units, to be edited and passed to the other commands."""
    if schema:
        show_json(tt.Problem.model_json_schema())
        return
    chosen = choice.problem()
    typer.echo(chosen.to_json() if as_json else commented_toml(chosen).rstrip())


def commented_toml(problem: "tt.Problem", remarks: Sequence[str] = ()) -> str:
    """Return a problem as TOML, with the unit and the meaning of every number in comments, and
    before it remarks.
    """
    table = name = ""
    place = 0
    lines = [f"# {line}" for remark in remarks for line in remark.splitlines()]
    for line in problem.to_toml().splitlines():
        if head := TABLE.fullmatch(line):
            table = f"{head[1]}."
        field = FIELD.match(line)
        if field:
            name, place = table + field[1], 0
        if line.endswith(" = ["):
            remark = ""
        elif ITEM.match(line):
            remark, place = _remark(problem, f"{name}.{place}"), place + 1
        else:
            remark = _remark(problem, name) if field else ""
        lines.append(f"{line}  # {remark}" if remark else line)
    return "\n".join(lines) + "\n"


def _remark(problem: "tt.Problem", name: str) -> str:
    """Return the comment beside a field: unit and meaning of a number, or the accepted words."""
    where, _, field = name.rpartition(".")
    part = part_at(problem, where)
    fields = getattr(type(part), "model_fields", {})
    if field in fields:
        kinds = getattr(part, "kinds", {}) if field == "kind" else {}
        choice = fields[field].annotation
        words = list(kinds) or (list(get_args(choice)) if get_origin(choice) is Literal else [])
        if words:
            return " or ".join(map(repr, words)).replace("'", '"')
    try:
        units, meaning, _ = problem.quantity(name)
    except (KeyError, AttributeError):
        return ""
    unit = "" if units == "1" else f"{written_unit(units)}: "
    return unit + meaning if units else ""
