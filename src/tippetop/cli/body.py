"""`tippetop body`: mass properties, surfaces and prospects of a body turned on a lathe."""

import math
from collections.abc import Iterator, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Annotated, Any

import typer

import tippetop as tt
from tippetop.cli.options import (
    DRAWINGS,
    Force,
    Json,
    density_in,
    density_option,
    write_figure,
)
from tippetop.cli.problem import commented_toml
from tippetop.cli.terminal import facts, listing, show, show_json, spelled
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
from tippetop.support.errors import InvalidInput
from tippetop.support.files import place_for, require_ending

FILE_ENDINGS = {
    "plot": DRAWINGS,
    "stl": (".stl",),
    "3mf": (".3mf",),
    "mjcf": (".xml",),
    "urdf": (".urdf",),
}
"""Accepted suffixes of files."""

ROUND_FEET = ("sphere", "eccentric_sphere", "spheroid", "oval")
"""Kinds of surfaces on which a body can be spun so that friction raises it."""


def body(
    file: Annotated[
        Path,
        typer.Argument(
            help="Workpiece (.toml), or its profile: points (.csv), a drawing (.svg or .dxf) or a"
            " surface (.stl, .obj, .ply or .off)."
        ),
    ],
    density: Annotated[
        str | None,
        density_option("Density"),
    ] = None,
    unit: Unit = None,
    axis: Axis = None,
    frame: Frame = None,
    upside_down: UpsideDown = False,
    tolerance: Tolerance = None,
    whole: Whole = False,
    runs: Annotated[
        bool,
        typer.Option(
            "--runs/--no-runs",
            help="Follow runs to find the spin from which a body with a round foot turns over and"
            " stands: some seconds.",
        ),
    ] = True,
    plot: Annotated[Path | None, typer.Option(help="Draw the section: .png, .svg or .pdf.")] = None,
    stl: Annotated[Path | None, typer.Option(help="Write the solid for printing, mm.")] = None,
    three_mf: Annotated[
        Path | None, typer.Option("--3mf", help="Write all parts for printing, mm.")
    ] = None,
    mjcf: Annotated[
        Path | None, typer.Option(help="Write the body for MuJoCo, with table and launch: .xml.")
    ] = None,
    urdf: Annotated[
        Path | None, typer.Option(help="Write the body for other programs: .urdf.")
    ] = None,
    as_toml: Annotated[
        bool, typer.Option("--toml", help="Print a problem with this body as TOML.")
    ] = False,
    as_json: Json = False,
    force: Force = False,
) -> None:
    """Show the mass, moments of inertia, surfaces and prospects of a body turned on a lathe.

    A drawing shows half an outline from the axis to the axis, or a full one on both sides, and
    bores inside it. A body that cannot be simulated is shown too, with exit code 2.
    """
    from rich.markup import escape  # noqa: PLC0415 - slow to import

    from tippetop.fit.standing import drilling_launch  # noqa: PLC0415 - slow to import

    requested = {"plot": plot, "stl": stl, "3mf": three_mf, "mjcf": mjcf, "urdf": urdf}
    files = {kind: path for kind, path in requested.items() if path is not None}
    for kind, path in files.items():
        require_ending(f"--{kind}", path, FILE_ENDINGS[kind])
        place_for(path, force)
    workpiece, remarks = workpiece_in(
        file,
        upside_down,
        density=density_in(density),
        unit=unit,
        axis=axis,
        frame=frame,
        tolerance=tolerance,
    )
    require_one_format(as_toml, as_json)
    if as_toml:
        turned = tt.Body.turned(workpiece, whole=whole)
        launch = drilling_launch(turned, SPIN)
    else:
        summary = {"remarks": remarks, **_summary(workpiece, whole, runs)}
    outputs = [_write(workpiece, path, force, whole) for path in files.values()]
    not_mapped = list(dict.fromkeys(remark for _, further in outputs for remark in further))
    paths = [path for written_paths, _ in outputs for path in written_paths]
    if as_toml:
        typer.echo(commented_toml(launch, [*remarks, *not_mapped]).rstrip())
    elif as_json:
        names = {kind: str(path) for kind, path in files.items()}
        show_json({**summary, "files": names, "not_mapped": not_mapped})
    else:
        show(*_sentences(summary, upside_down), *map(escape, not_mapped), files=paths)
    if not as_toml and summary["trouble"]:
        raise typer.Exit(2)


def _summary(workpiece: "tt.Workpiece", whole: bool, runs: bool) -> dict[str, Any]:
    """Return the mass properties, surfaces and prospects of a body.

    `trouble` is the reason for which it cannot be simulated, or None. `stands_from` is the least
    spin from which runs turn over and stand, rad/s, inf if there is none; None without runs.
    """
    from tippetop.fit.standing import (  # noqa: PLC0415 - slow to import
        drilling_launch,
        least_standing_spin,
    )
    from tippetop.problem.implausible import warn_if_implausible  # noqa: PLC0415

    mass, center, I1, I3 = workpiece.mass_properties
    trouble, stands_from = None, None
    try:
        turned = tt.Body.turned(workpiece, whole=whole)
        if runs and turned.shapes[0].kind in ROUND_FEET and not _is_top_heavy(turned):
            stands_from = least_standing_spin(drilling_launch(turned))
    except InvalidInput as error:
        trouble = str(error)
        # Mass and size are in doubt whatever the surfaces: those of a ball around the body.
        size = 0.5 * workpiece.outline.size
        ball = tt.Sphere(radius=size, center=0.0)
        turned = tt.Body(mass=mass, shape=ball, I1=0.4 * mass * size**2, I3=0.4 * mass * size**2)
    warn_if_implausible(drilling_launch(turned, SPIN))
    hull = workpiece.hull
    return {
        "mass": mass,
        "center": center,
        "I1": I1,
        "I3": I3,
        "inertia_ratio": I1 / I3,
        "surfaces": _surfaces(workpiece),
        "lies_on_lines_at_tilts": hull.flats,
        "trouble": trouble,
        **_prospects(workpiece),
        "upside_down": _prospects(workpiece.turned_over()),
        "stands_from": stands_from,
    }


def _is_top_heavy(turned: "tt.Body") -> bool:
    """Return whether a body, set upright without spin, does not return there when tilted."""
    surface = turned.shapes[0].surface
    return bool(surface.height(math.cos(0.05)) <= surface.height(1.0) + 1e-12 * surface.size)


def _surfaces(workpiece: "tt.Workpiece") -> list[dict[str, Any]]:
    """Return the surfaces on which a body stands, by tilt; a smooth curve is one surface."""
    from tippetop.problem.turned import allowance  # noqa: PLC0415 - slow to import

    hull, center = workpiece.hull, workpiece.mass_properties.center
    reach = allowance(workpiece)
    spheroid = hull.spheroid(reach) if len(hull.zones) > 2 else None
    if spheroid is not None:
        across, along, height = spheroid
        numbers = {"radius": across, "along": along, "center": height - center}
        return [{"kind": "spheroid", **numbers, "from_tilt": 0.0, "to_tilt": math.pi}]
    smooth = hull.smooth_parts(reach)
    surfaces = [{"kind": "oval", "from_tilt": low, "to_tilt": high} for low, high in smooth]
    surfaces += [
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
        if not any(low <= zone.low and zone.high <= high for low, high in smooth)
    ]
    return sorted(surfaces, key=lambda surface: surface["from_tilt"])


def _prospects(workpiece: "tt.Workpiece") -> dict[str, Any]:
    """Return what theory predicts for the body; all values are None unless it stands on a
    sphere.
    """
    from tippetop.problem.turned import touching_surfaces  # noqa: PLC0415 - slow to import
    from tippetop.theory.prospects import prospects  # noqa: PLC0415

    mass, _, I1, I3 = workpiece.mass_properties
    outlook = None
    with suppress(InvalidInput):
        try:
            shapes = touching_surfaces(workpiece)
        except InvalidInput:
            shapes = touching_surfaces(workpiece, completed=True)
        outlook = prospects(tt.Body(mass=mass, shape=shapes[0], I1=I1, I3=I3), shapes)
    if outlook is None:
        sphere = (
            "eccentricity",
            "group",
            "group_description",
            "omega_c1",
            "omega_c2",
            "omega_c_tilt",
        )
        return dict.fromkeys((*sphere, "touch", "stem"))
    spins, touch, stem = outlook.critical_spins, outlook.touch, outlook.stem
    # If another surface touches before the stem, the theory knows no launch that reaches the stem.
    reached = {} if stem is None or math.isnan(stem.launch) else {"least_launch_spin": stem.launch}
    return {
        "eccentricity": outlook.eccentricity,
        "group": outlook.group,
        "group_description": outlook.group.description,
        "omega_c1": spins.upright,
        "omega_c2": spins.inverted,
        "omega_c_tilt": outlook.tilt,
        "touch": touch
        and {"surface": touch.surface, "tilt": touch.tilt, "least_launch_spin": touch.spin},
        "stem": stem and {"least_jellett": stem.jellett, "least_spin": stem.spin, **reached},
    }


def _write(
    workpiece: "tt.Workpiece", path: Path, force: bool, whole: bool
) -> tuple[Sequence[Path], Sequence[str]]:
    """Write a file; return the written files, and remarks on what their format cannot express."""
    from tippetop.engines.bodies import save_mjcf, save_urdf  # noqa: PLC0415 - slow to import
    from tippetop.fit.standing import drilling_launch  # noqa: PLC0415

    ending = path.suffix.lower()
    if ending in (*FILE_ENDINGS["mjcf"], *FILE_ENDINGS["urdf"]):
        launch = drilling_launch(tt.Body.turned(workpiece, whole=whole), SPIN)
        problem = launch.replace({"friction.pressure": "ellipsoidal"})
        return (save_mjcf if ending == ".xml" else save_urdf)(problem, path, force)
    if ending in FILE_ENDINGS["plot"]:
        from tippetop.figures.section import section  # noqa: PLC0415 - slow to import

        write_figure(section(workpiece), path, force)
    else:
        tt.write_solid(workpiece, path, force)
    return [path], []


def _sentences(summary: dict[str, Any], is_turned: bool) -> Iterator[Any]:
    from rich.markup import escape  # noqa: PLC0415 - slow to import

    over = summary["upside_down"]
    if over["group"]:
        stands = summary["surfaces"][0]["kind"]
        turning = (
            "Leave --upside-down out to have it as drawn."
            if is_turned
            else "--upside-down turns it over."
        )
        placed = "turned over" if is_turned else "drawn"
        stem_down = (
            f"It is {placed} with its ball above: as {placed} it stands on"
            f" {'an' if stands[0] in 'aeo' else 'a'} {stands}."
            if not summary["group"] or _radius_above(summary)
            else "It stands on a ball at either end."
        )
        yield (
            f"[bold]Upside down: group {over['group']}[/]: {over['group_description']}."
            f" {stem_down} {turning}"
        )
    if not summary["group"] and not over["group"]:
        yield (
            "No critical spins: at neither end does it stand on a ball with the centre of mass"
            " below the ball's centre."
        )
    if summary["group"]:
        upto = summary["surfaces"][0]["to_tilt"]
        within = (
            f" That is on its sphere, up to a tilt of {upto:.6g} rad." if upto < math.pi else ""
        )
        yield f"[bold]Group {summary['group']}[/]: {summary['group_description']}.{within}"
    for remark in summary["remarks"]:
        yield escape(remark)
    yield facts(_rows(summary))
    names = ("surface", "radius", "tube", "along the axis", "height of its centre")
    headings = (*names, "from tilt", "to tilt")
    rows = (_surface_row(one) for one in summary["surfaces"])
    yield listing("Stands on", headings, rows, words=("surface",))
    yield "[dim]mm, from the centre of mass; rad.[/]"
    if summary["trouble"]:
        yield escape(f"Cannot be simulated: {summary['trouble']}")


def _radius_above(summary: dict[str, Any]) -> bool:
    """Return whether the ball at the upper end is the larger one."""
    lower, upper = summary["surfaces"][0], summary["surfaces"][-1]
    return bool(upper.get("radius", 0.0) > lower.get("radius", 0.0))


def _millimetres(length: float) -> str:
    """Return a length in mm; what is below a nanometre is the rounding of larger lengths."""
    return f"{round(1e3 * length, 6) + 0.0:.7g}"


def _surface_row(one: dict[str, Any]) -> tuple[str, ...]:
    lengths = (
        "" if one.get(name) is None else _millimetres(one[name])
        for name in ("radius", "tube", "along", "center")
    )
    return (one["kind"], *lengths, f"{one['from_tilt']:.6g}", f"{one['to_tilt']:.6g}")


def _rows(summary: dict[str, Any]) -> list[tuple[str, str, str]]:
    rows = [
        ("mass", f"{summary['mass']:.7g}", "kg"),
        (
            "height of the centre of mass, as in the profile",
            _millimetres(summary["center"]),
            "mm",
        ),
        ("I1, transverse to the axis", f"{summary['I1']:.7g}", "kg m²"),
        ("I3, along the axis", f"{summary['I3']:.7g}", "kg m²"),
        ("γ = I1/I3", f"{summary['inertia_ratio']:.7g}", ""),
    ]
    if summary["group"]:
        rows += [
            (
                "α, the centre of mass below the sphere's centre",
                f"{summary['eccentricity']:.7g}",
                "radii",
            ),
            ("upright spin unstable above ω_c1", spelled(summary["omega_c1"], 7), "rad/s"),
        ]
    if summary["group"] and summary["surfaces"][0]["to_tilt"] == math.pi:
        rows.append(("inverted spin stable above ω_c2", spelled(summary["omega_c2"], 7), "rad/s"))
    if summary["touch"]:
        spin = spelled(summary["touch"]["least_launch_spin"], 7)
        number = summary["touch"]["surface"]
        lower = f"surface {number}" if number else "the edge of the cut ball"
        rows.append(
            (
                f"{lower} comes down to the table, launched above",
                spin,
                "rad/s",
            )
        )
    if summary["stem"]:
        rows.append(
            ("stands on its stem above", spelled(summary["stem"]["least_spin"], 7), "rad/s")
        )
        if "least_launch_spin" in summary["stem"]:
            rows.append(
                (
                    "that is, without loss while both touch, launched above",
                    spelled(summary["stem"]["least_launch_spin"], 7),
                    "rad/s",
                )
            )
    if summary["stands_from"] is not None:
        never = math.isinf(summary["stands_from"])
        least = "no spin" if never else f"{summary['stands_from']:.3g}"
        units = "" if never else "rad/s"
        rows.append(("turns over and stands in runs (mu 0.3, patch of 0.5 mm) from", least, units))
    between = [tilt for tilt in summary["lies_on_lines_at_tilts"] if 0.0 < tilt < math.pi]
    rows += [("touches in two points or a line at tilt", f"{tilt:.7g}", "rad") for tilt in between]
    ends = {0.0: "below", math.pi: "above"}
    rows += [
        ("lies flat", f"on its end {ends[tilt]}", "")
        for tilt in summary["lies_on_lines_at_tilts"]
        if tilt in ends
    ]
    return rows
