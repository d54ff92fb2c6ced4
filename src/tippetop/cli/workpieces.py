"""Files with a workpiece or a profile: the options on how to read them, and their reading."""

import math
from pathlib import Path
from typing import Annotated, Any

import typer

import tippetop as tt
from tippetop.cli.options import number_option
from tippetop.support.errors import MISSING, Described, InvalidInput

Unit = Annotated[
    str | None,
    typer.Option(
        help="Unit of the profile's numbers: m, cm, mm or in. By default m in .toml and .csv,"
        " mm in meshes, and the physical size of a drawing; a heading of points may have it."
    ),
]
Axis = Annotated[
    str | None,
    typer.Option(
        help="Axis of a drawing, such as x=10 in its numbers, or x or y for its direction; of a"
        " surface x, y or z. Sought by default."
    ),
]
Frame = Annotated[
    bool | None,
    typer.Option(
        "--frame/--no-frame",
        help="Whether a rectangle around all else in a drawing is a frame, or the body.",
    ),
]
UpsideDown = Annotated[
    bool, typer.Option("--upside-down", help="Turn the body over: what is below comes up.")
]
Tolerance = Annotated[
    float | None,
    number_option(
        float,
        "Largest distance of the body from points that arcs are fitted to, in sizes of it;"
        " 0.0001 by default, 0 to fit none.",
    ),
]

Whole = Annotated[
    bool, typer.Option("--whole", help="Accept incomplete surfaces as if they were complete.")
]

SPIN = 155.0
"""Axial spin of a launch in a file that is written, rad/s, where no other is known: that of the
report.
"""

SURELY_MOVED, DOUBTFUL = 1e-9, 10.0
"""Distance in sizes of the profile above which it is not rounding of floats; and in roundings of
the profile's numbers up to which an arc's centre beside the axis may be due to them.
"""


def require_one_format(as_toml: bool, as_json: bool) -> None:
    """Refuse --toml beside --json."""
    if as_toml and as_json:
        raise InvalidInput(
            "--toml", Described("beside --json"), "one of the two", "asks for two formats"
        )


def workpiece_in(file: Path, upside_down: bool, **options: Any) -> "tuple[tt.Workpiece, list[str]]":
    """Return the workpiece of a file, and remarks on how it was read.

    Options are those of `tippetop.read_workpiece`; None leaves one to the file. Raises
    `InvalidInput` and `FileTrouble` as that function does.
    """
    from tippetop.lathe.files import read_with_remarks  # noqa: PLC0415 - slow to import

    stated = {name: value for name, value in options.items() if value is not None}
    try:
        workpiece, remarks = read_with_remarks(file, **stated)
    except InvalidInput as error:
        if error.field != "density" or error.value is not MISSING:
            raise
        accepted = "a number in kg/m^3 or a material such as beech"
        field = "density" if error.file else "--density"
        raise InvalidInput(field, MISSING, accepted, file=error.file) from None
    if upside_down:
        workpiece = workpiece.turned_over()
    return workpiece, [*remarks, *_fit(workpiece)]


def _fit(workpiece: "tt.Workpiece") -> list[str]:
    """Return remarks on the fit of the profile to points, and on what its digits leave open."""
    from tippetop.lathe.rounding import usual_rounding  # noqa: PLC0415 - slow to import
    from tippetop.lathe.workpiece import UNITS  # noqa: PLC0415

    fit, unit, remarks = workpiece.fit, 1e3 * UNITS[workpiece.unit], list[str]()
    if fit.edges != fit.stated or fit.deviation:
        remarks.append(
            f"{fit.edges} arcs and lines for the {fit.stated} edges of the profile, at most"
            f" {1e3 * workpiece.deviation:.2g} mm from its points."
        )
    else:
        pairs = zip(fit.points, workpiece.profile, strict=True)
        moved = max(math.dist(point[:2], stated[:2]) for point, stated in pairs)
        if moved > SURELY_MOVED * workpiece.outline.size / UNITS[workpiece.unit]:
            remarks.append(
                f"Points of the profile are moved by up to {unit * moved:.2g} mm, as their digits"
                " allow, so that arcs are centred on the axis (--tolerance 0 takes them as stated)."
            )
    digits = DOUBTFUL * usual_rounding(workpiece.profile) * unit
    for edge in workpiece.outline.edges:
        beside = 1e3 * abs(edge.center.real) if edge.turn else 0.0
        if 1e3 * SURELY_MOVED * workpiece.outline.size < beside <= digits:
            remarks.append(
                f"An arc of radius {1e3 * abs(edge.radius):.4g} mm has its centre {beside:.2g} mm"
                " beside the axis, which the rounding of its numbers may have made: it is taken as"
                " stated, as a ring. Write them with more digits to have a ball."
            )
    return remarks
