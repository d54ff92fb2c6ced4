"""`tippetop improve`: a top like a body that turns over at less spin, sooner, or stands longer."""

import math
from collections.abc import Iterator
from dataclasses import fields
from pathlib import Path
from typing import Annotated, Any

import typer

import tippetop as tt
from tippetop.cli.options import (
    DRAWINGS,
    NUMBER,
    Force,
    Json,
    density_in,
    density_option,
    number_of,
    number_option,
    write_figure,
)
from tippetop.cli.problem import commented_toml
from tippetop.cli.terminal import facts, show, show_json
from tippetop.cli.workpieces import (
    SPIN,
    Axis,
    Frame,
    Tolerance,
    Unit,
    UpsideDown,
    Whole,
    require_one_format,
    workpiece_in,
)
from tippetop.support.errors import MISSING, InvalidInput
from tippetop.support.files import place_for, require_ending


def improve(
    file: Annotated[
        Path | None, typer.Argument(help="Workpiece or profile, as `tippetop body` reads it.")
    ] = None,
    preset: Annotated[
        str | None, typer.Option(help="Body by name in place of a file, such as friedl.")
    ] = None,
    goal: Annotated[
        str, typer.Option(help="'lowest spin', 'fastest' or 'stands longest'.")
    ] = "lowest spin",
    spin: Annotated[
        str | None,
        typer.Option(
            metavar=NUMBER,
            help="Spin of the launches of the other two goals, rad/s, or as in '1500 rpm'; by"
            " default 1.3 times the least.",
        ),
    ] = None,
    density: Annotated[
        str | None,
        density_option("Density of the material (by default the file's; 700 for a preset)"),
    ] = None,
    unit: Unit = None,
    axis: Axis = None,
    frame: Frame = None,
    upside_down: UpsideDown = False,
    tolerance: Tolerance = None,
    mass: Annotated[
        str | None, typer.Option(metavar=NUMBER, help="Largest mass, kg, or as in '20 g'.")
    ] = None,
    radius: Annotated[
        str | None,
        typer.Option(
            metavar=NUMBER, help="Radius of the ball, m, or as in '15 mm'; by default the body's."
        ),
    ] = None,
    wall: Annotated[
        str, typer.Option(metavar=NUMBER, help="Least thickness of the bowl, m or with a unit.")
    ] = "1 mm",
    stem: Annotated[
        str, typer.Option(metavar=NUMBER, help="Least radius of the stem, m or with a unit.")
    ] = "1.5 mm",
    completed: Whole = False,
    trials: Annotated[
        int, number_option(int, "Most bodies that are tried by runs; 0 for theory alone.")
    ] = 20,
    plot: Annotated[Path | None, typer.Option(help="Draw the section: .png, .svg or .pdf.")] = None,
    stl: Annotated[Path | None, typer.Option(help="Write the solid for printing, mm.")] = None,
    as_toml: Annotated[
        bool, typer.Option("--toml", help="Print a problem with the better body as TOML.")
    ] = False,
    as_json: Json = False,
    force: Force = False,
) -> None:
    """Find a bowl with a stem that turns over at less spin, sooner, or stands longer.

    What is shown was seen in runs: a minute or two of them.
    """
    from rich.markup import escape  # noqa: PLC0415 - slow to import

    from tippetop.fit.standing import drilling_launch  # noqa: PLC0415

    require_one_format(as_toml, as_json)
    files = dict[str, Path]()
    for kind, path, endings in (("plot", plot, DRAWINGS), ("stl", stl, (".stl",))):
        if path is not None:
            require_ending(f"--{kind}", path, endings)
            place_for(path, force)
            files[kind] = path
    material = density_in(density)
    body, remarks = _body(
        file,
        preset,
        completed,
        {
            "density": material,
            "unit": unit,
            "axis": axis,
            "frame": frame,
            "upside_down": upside_down,
            "tolerance": tolerance,
        },
    )
    if not (as_json or as_toml):
        # The search takes minutes: a file that was misread is seen before.
        show(*map(escape, remarks))
    stated = {
        "spin": number_of("--spin", spin, "rad s-1"),
        "density": material,
        "mass": number_of("--mass", mass, "kg"),
        "radius": number_of("--radius", radius, "m"),
        "wall": number_of("--wall", wall, "m"),
        "stem": number_of("--stem", stem, "m"),
        "trials": trials,
    }
    better = tt.improve(body, goal, whole=completed, **stated)  # type: ignore[arg-type]
    if plot is not None:
        from tippetop.figures.section import section  # noqa: PLC0415 - slow to import

        write_figure(section(better.workpiece), plot, force)
    if stl is not None:
        tt.write_solid(better.workpiece, stl, force)
    if as_toml:
        # From the least spin the last part of the rise takes for ever.
        spins = (better.launch_spin, 1.3 * better.spin)
        launch = drilling_launch(better.body, next(filter(math.isfinite, spins), SPIN))
        typer.echo(commented_toml(launch, remarks).rstrip())
    elif as_json:
        names = [one.name for one in fields(better) if one.name not in ("body", "workpiece")]
        numbers = {name: getattr(better, name) for name in names}
        paths = {kind: str(path) for kind, path in files.items()}
        top = {"mass": better.body.mass, "body": better.body}
        show_json({"remarks": remarks, **numbers, **top, "files": paths})
    else:
        show(str(better), facts(_rows(better)), files=files.values())


def _body(
    file: Path | None, preset: str | None, completed: bool, options: dict[str, Any]
) -> tuple[Any, list[str]]:
    """Return the body to begin with, of a file or a preset, and remarks on how a file was read."""
    from tippetop.fit.standing import drilling_launch  # noqa: PLC0415 - slow to import
    from tippetop.problem.implausible import warn_if_implausible  # noqa: PLC0415

    if file is not None and preset is not None:
        raise InvalidInput("file", str(file), "one of the two", "is stated beside --preset")
    if file is not None:
        workpiece, remarks = workpiece_in(file, **options)
        warn_if_implausible(drilling_launch(tt.Body.turned(workpiece, whole=completed), SPIN))
        return workpiece, remarks
    if preset is None:
        raise InvalidInput("file", MISSING, "the file of a body, or --preset with its name")
    for name, value in options.items():
        if name != "density" and value not in (None, False):
            option = f"--{name.replace('_', '-')}"
            raise InvalidInput(option, value, "", "is only for a file", "leave it out")
    return tt.presets.body(preset), []


def _rows(better: "tt.ImprovedTop") -> Iterator[tuple[str, str, str]]:
    """Yield name, number and unit of the sizes."""
    for name, size in better.sizes.items():
        yield name, f"{1e3 * size:.5g}", "mm"
    yield "mass", f"{1e3 * better.body.mass:.4g}", "g"
