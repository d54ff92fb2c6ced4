"""`tippetop body`: what a body turned on a lathe weighs, stands on and will do."""

import json
import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from tippetop.cli.options import Force, Json, facts, finite, listing
from tippetop.errors import InvalidInput
from tippetop.files import place_for, require_ending, written_beside

if TYPE_CHECKING:
    from tippetop.lathe.workpiece import Workpiece

ENDINGS = {"plot": (".png", ".svg", ".pdf"), "stl": (".stl",), "3mf": (".3mf",)}
"""How the names of files may end."""


def body(
    file: Annotated[Path, typer.Argument(help="Workpiece (.toml), or its profile (.csv or .svg).")],
    density: Annotated[float | None, typer.Option(help="Density, kg/m^3.")] = None,
    unit: Annotated[str | None, typer.Option(help="Unit of the profile: m, cm, mm or in.")] = None,
    whole: Annotated[
        bool, typer.Option("--whole", help="Take surfaces that are cut off as if they were whole.")
    ] = False,
    plot: Annotated[Path | None, typer.Option(help="Draw the section: .png, .svg or .pdf.")] = None,
    stl: Annotated[Path | None, typer.Option(help="Write the solid for printing, mm.")] = None,
    three_mf: Annotated[Path | None, typer.Option("--3mf", help="Write all parts for printing, mm.")] = None,
    as_toml: Annotated[bool, typer.Option("--toml", help="Print a problem with this body as TOML.")] = False,
    as_json: Json = False,
    force: Force = False,
) -> None:
    """Say what a body turned on a lathe weighs, what it stands on, and whether it turns over."""
    from tippetop.lathe.files import read_workpiece  # noqa: PLC0415 - slow to import

    wanted = {"plot": plot, "stl": stl, "3mf": three_mf}
    files = {kind: path for kind, path in wanted.items() if path is not None}
    for kind, path in files.items():
        require_ending(f"--{kind}", path, ENDINGS[kind])
        place_for(path, force)
    given = {"density": density, "unit": unit}
    piece = read_workpiece(file, **{name: value for name, value in given.items() if value is not None})
    if as_toml and as_json:
        raise InvalidInput("--toml", "with --json", "one of the two")
    told = _problem(piece, whole) if as_toml else _told(piece, whole)
    for path in files.values():
        _write(piece, path, force)
    if isinstance(told, str):
        typer.echo(told.rstrip())
    elif as_json:
        written = {kind: str(path) for kind, path in files.items()}
        typer.echo(json.dumps({**told, "files": written}, indent=2))
    else:
        _print(told, list(files.values()))


def _problem(piece: "Workpiece", whole: bool) -> str:
    from tippetop.bodies import Body  # noqa: PLC0415 - slow to import
    from tippetop.presets import report_problem  # noqa: PLC0415

    return report_problem().model_copy(update={"body": Body.turned(piece, whole=whole)}).to_toml()


def _told(piece: "Workpiece", whole: bool) -> dict[str, Any]:
    """What is told of a body; what it cannot be simulated for is the trouble with it."""
    mass, center, I1, I3 = piece.mass_properties
    hull = piece.hull
    told: dict[str, Any] = {
        "mass": mass,
        "center": center,
        "I1": I1,
        "I3": I3,
        "inertia_ratio": I1 / I3,
        "surfaces": [
            {
                "kind": zone.name,
                "radius": zone.radius or zone.tube,
                "tube": zone.tube if zone.radius else None,
                "center": zone.height - center,
                "from_tilt": zone.low,
                "to_tilt": zone.high,
                "protrusion": hull.protrusion(zone)[0],
            }
            for zone in hull.zones
        ],
        "lies_on_lines_at_tilts": list(hull.flats),
    }
    return {**told, **_expected(piece, whole)}


def _expected(piece: "Workpiece", whole: bool) -> dict[str, Any]:
    """What the theory says of it, and why it cannot be simulated, if so."""
    from tippetop.bodies import Body, touching  # noqa: PLC0415 - slow to import
    from tippetop.theory.prospects import prospects  # noqa: PLC0415

    trouble = None
    try:
        Body.turned(piece, whole=whole)
    except InvalidInput as error:
        trouble = str(error)
    try:
        shapes = touching(piece, whole=True)
    except InvalidInput:
        return {"trouble": trouble, "group": None, "touch": None, "stem": None}
    mass, _, I1, I3 = piece.mass_properties
    found = prospects(Body(mass=mass, shape=shapes[0], I1=I1, I3=I3), shapes)
    return {
        "trouble": trouble,
        "eccentricity": found and found.eccentricity,
        "group": found and found.group.value,
        "group_description": found and found.group.description,
        "omega_c1": found and finite(found.critical_spins.upright),
        "omega_c2": found and finite(found.critical_spins.inverted),
        "omega_c_tilt": found and found.tilt,
        "touch": found
        and found.touch
        and {
            "surface": found.touch.surface,
            "tilt": found.touch.tilt,
            "least_launch_spin": finite(found.touch.spin),
        },
        "stem": found
        and found.stem
        and {
            "least_jellett": finite(found.stem.jellett),
            "least_spin": finite(found.stem.spin),
            # Where something else touches first, nothing is known of it.
            **({} if math.isnan(found.stem.launch) else {"least_launch_spin": finite(found.stem.launch)}),
        },
    }


def _write(piece: "Workpiece", path: Path, force: bool) -> None:
    if path.suffix.lower() in ENDINGS["plot"]:
        from tippetop.figures.section import section  # noqa: PLC0415 - slow to import
        from tippetop.figures.style import save  # noqa: PLC0415

        with written_beside(path, force) as beside:
            save(section(piece), beside)
    else:
        from tippetop.export.solid import write_solid  # noqa: PLC0415

        write_solid(piece, path, force)


def _print(told: dict[str, Any], files: list[Path]) -> None:
    from rich.console import Console  # noqa: PLC0415

    console = Console()
    if told["group"]:
        upto = told["surfaces"][0]["to_tilt"]
        within = f" That is on its sphere, up to a tilt of {upto:.6g} rad." if upto < math.pi else ""
        console.print(
            f"[bold]Group {told['group']}[/]: {told['group_description']}.{within}", highlight=False
        )
    console.print(facts(_rows(told)))
    headings = ("surface", "radius", "tube", "height of its centre", "from tilt", "to tilt")
    rows = (_surface_row(one) for one in told["surfaces"])
    console.print(listing("Stands on", headings, rows, words=("surface",)))
    console.print("[dim]mm, from the centre of mass; rad.[/]", highlight=False)
    if told["trouble"]:
        console.print(f"Cannot be simulated: {told['trouble']}", highlight=False, markup=False)
    for path in files:
        console.print(f"wrote {path}", highlight=False)


def _surface_row(one: dict[str, Any]) -> tuple[str, ...]:
    lengths = ("" if one[name] is None else f"{1e3 * one[name]:.6g}" for name in ("radius", "tube", "center"))
    return (one["kind"], *lengths, f"{one['from_tilt']:.6g}", f"{one['to_tilt']:.6g}")


def _rows(told: dict[str, Any]) -> list[tuple[str, str, str]]:
    rows = [
        ("mass", f"{told['mass']:.7g}", "kg"),
        ("height of the centre of mass, as in the profile", f"{1e3 * told['center']:.7g}", "mm"),
        ("I1, transverse to the axis", f"{told['I1']:.7g}", "kg m²"),
        ("I3, along the axis", f"{told['I3']:.7g}", "kg m²"),
        ("γ = I1/I3", f"{told['inertia_ratio']:.7g}", ""),
    ]
    if told["group"]:
        rows += [
            ("α, the centre of mass below the sphere's centre", f"{told['eccentricity']:.7g}", "radii"),
            ("upright spin is left above ω_c1", _shown(told["omega_c1"]), "rad/s"),
            ("inverted spin holds above ω_c2", _shown(told["omega_c2"]), "rad/s"),
        ]
    if told["touch"]:
        spin = _shown(told["touch"]["least_launch_spin"])
        rows.append(
            (f"surface {told['touch']['surface']} comes down to the table, launched above", spin, "rad/s")
        )
    if told["stem"]:
        rows.append(("stands on its stem above", _shown(told["stem"]["least_spin"]), "rad/s"))
        if "least_launch_spin" in told["stem"]:
            rows.append(("that is, launched above", _shown(told["stem"]["least_launch_spin"]), "rad/s"))
    between = [tilt for tilt in told["lies_on_lines_at_tilts"] if 0.0 < tilt < math.pi]
    rows += [("touches in two points or a line at tilt", f"{tilt:.7g}", "rad") for tilt in between]
    ends = {0.0: "below", math.pi: "above"}
    rows += [
        ("lies flat", f"on its end {ends[tilt]}", "")
        for tilt in told["lies_on_lines_at_tilts"]
        if tilt in ends
    ]
    return rows


def _shown(value: float | None) -> str:
    return "never" if value is None else f"{value:.7g}"
