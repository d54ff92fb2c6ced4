"""`tippetop problem`: write a problem file, or the schema of one."""

import json
from typing import Annotated

import typer

from tippetop.cli.options import Changes, Json, LiftOff, Mu, Preset, ProblemFile, Spin, Tilt, chosen_problem


def problem(
    file: ProblemFile = None,
    preset: Preset = None,
    spin: Spin = None,
    tilt: Tilt = None,
    mu: Mu = None,
    liftoff: LiftOff = None,
    changes: Changes = None,
    as_json: Json = False,
    schema: Annotated[bool, typer.Option("--schema", help="Print the JSON Schema of problems.")] = False,
) -> None:
    """Print a problem as TOML, to be edited and given to the other commands."""
    from tippetop.problem import Problem  # noqa: PLC0415 - slow to import

    if schema:
        typer.echo(json.dumps(Problem.model_json_schema(), indent=2))
        return
    settings = {"launch.spin": spin, "launch.tilt": tilt, "friction.mu": mu, "contact.liftoff": liftoff}
    chosen = chosen_problem(file, preset, settings, changes)
    typer.echo(chosen.to_json() if as_json else chosen.to_toml().rstrip())
