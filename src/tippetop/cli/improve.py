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
from tippetop.support.errors import MISSING, Described, InvalidInput
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
        str | None, density_option("Density of the material (by default the file's, or 700)")
    ] = None,
    mass: Annotated[
        str | None, typer.Option(metavar=NUMBER, help="Largest mass, kg, or as in '20 g'.")
    ] = None,
    radius: Annotated[
        str | None,
        typer.Option(metavar=NUMBER, help="Radius of the ball, m, or as in '15 mm'; the body's."),
    ] = None,
    wall: Annotated[
        str, typer.Option(metavar=NUMBER, help="Least thickness of the bowl, m or with a unit.")
    ] = "1 mm",
    stem: Annotated[
        str, typer.Option(metavar=NUMBER, help="Least radius of the stem, m or with a unit.")
    ] = "1.5 mm",
    completed: Annotated[
        bool, typer.Option("--whole", help="Accept incomplete surfaces as if they were complete.")
    ] = False,
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
    from tippetop.fit.standing import drilling_launch  # noqa: PLC0415 - slow to import

    if as_toml and as_json:
        raise InvalidInput(
            "--toml", Described("beside --json"), "one of the two", "asks for two formats"
        )
    files = dict[str, Path]()
    for kind, path, endings in (("plot", plot, DRAWINGS), ("stl", stl, (".stl",))):
        if path is not None:
            require_ending(f"--{kind}", path, endings)
            place_for(path, force)
            files[kind] = path
    material = density_in(density)
    body = _body(file, preset, material)
    if material is None:
        material = body.density if isinstance(body, tt.Workpiece) else 700.0
    better = tt.improve(
        body,
        goal,  # type: ignore[arg-type]
        spin=number_of("--spin", spin, "rad s-1"),
        density=material,
        mass=number_of("--mass", mass, "kg"),
        radius=number_of("--radius", radius, "m"),
        wall=number_of("--wall", wall, "m") or 0.0,
        stem=number_of("--stem", stem, "m") or 0.0,
        whole=completed,
        trials=trials,
    )
    if plot is not None:
        from tippetop.figures.section import section  # noqa: PLC0415 - slow to import

        write_figure(section(better.workpiece), plot, force)
    if stl is not None:
        tt.write_solid(better.workpiece, stl, force)
    if as_toml:
        # From the least spin the last part of the rise takes for ever.
        spins = (better.launch_spin, 1.3 * better.spin)
        launch = drilling_launch(better.body, next(filter(math.isfinite, spins), 155.0))
        typer.echo(commented_toml(launch).rstrip())
    elif as_json:
        names = [one.name for one in fields(better) if one.name not in ("body", "workpiece")]
        numbers = {name: getattr(better, name) for name in names}
        paths = {kind: str(path) for kind, path in files.items()}
        show_json({**numbers, "mass": better.body.mass, "body": better.body, "files": paths})
    else:
        show(str(better), facts(_rows(better)), files=files.values())


def _body(file: Path | None, preset: str | None, density: float | None) -> Any:
    """Return the body to begin with: of a file, or a preset."""
    from tippetop.lathe.files import read_with_remarks  # noqa: PLC0415 - slow to import

    if (file is None) == (preset is None):
        shown = MISSING if file is None else str(file)
        raise InvalidInput("file", shown, "the file of a body, or --preset with its name")
    if file is None:
        return tt.presets.body(str(preset))
    stated: dict[str, Any] = {} if density is None else {"density": density}
    return read_with_remarks(file, **stated)[0]


def _rows(better: "tt.ImprovedTop") -> Iterator[tuple[str, str, str]]:
    """Yield name, number and unit of the sizes."""
    for name, size in better.sizes.items():
        yield name, f"{1e3 * size:.5g}", "mm"
    yield "mass", f"{1e3 * better.body.mass:.4g}", "g"
