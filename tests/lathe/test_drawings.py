"""Drawings as Inkscape, Illustrator, FreeCAD and OpenSCAD write them, against the true shapes."""

import math

import numpy as np
import pytest
from drawn import (
    BALL,
    BARREL,
    BORED,
    CUT,
    EGG,
    FACE,
    GOBLET,
    SLIM,
    SPHEROID,
    SPINDLE,
    TIP,
    TOP,
    TORUS,
    R,
    polyline,
    weighed,
)

from tippetop.lathe.files import read_workpiece

DENSITY = 700.0
WITHIN = 1e-3
PX = 96.0 / 25.4
"""Pixels in a millimetre."""

HEAD = '<?xml version="1.0" encoding="UTF-8" standalone="no"?>\n'


def svg(content, size="210mm 297mm", box="0 0 210 297"):
    """A drawing of a size with numbers in a box; without a size, the numbers are pixels."""
    sized = 'width="{}" height="{}" '.format(*size.split()) if size else ""
    return f'{HEAD}<svg xmlns="http://www.w3.org/2000/svg" {sized}viewBox="{box}">{content}</svg>'


def d(command, points, scale=1.0, at=0j, digits=4):
    """A path command of SVG with points, whose y goes down."""
    moved = [at + scale * complex(point).conjugate() for point in points]
    return command + " ".join(f"{p.real:.{digits}f},{p.imag:.{digits}f}" for p in moved)


def mirrored(points):
    """The points of a half outline, and back on the other side of the axis."""
    return [*points, *(-complex(p).conjugate() for p in points[-2:0:-1])]


def whole_top(at, scale=1.0):
    """The top drawn on both sides by arcs and lines, clockwise on the sheet."""
    r, slim = scale * R, scale * SLIM

    def to(*points):
        return [f"{p.real:.5f} {p.imag:.5f}" for p in (at + scale * q.conjugate() for q in points)]

    right, inner, tip = to(CUT + FACE * 1j, SLIM + FACE * 1j, SLIM + TIP * 1j)
    left, outer, other = to(-CUT + FACE * 1j, -SLIM + FACE * 1j, -SLIM + TIP * 1j)
    return (
        f"M {left} L {outer} L {other} A {slim} {slim} 0 0 1 {tip} L {inner} L {right}"
        f" A {r} {r} 0 1 1 {left} Z"
    )


def rounded_ellipse(rx, ry, cx, cy, digits=2):
    """An ellipse of four Bezier curves as Illustrator writes it: relative, few digits."""
    k = 0.5522847
    parts = [
        f"M{cx + rx:.{digits}f},{cy:.{digits}f}",
        *(
            "c" + ",".join(f"{number:.{digits}f}" for number in numbers)
            for numbers in (
                (0, ry * k, -rx * (1 - k), ry, -rx, ry),
                (-rx * k, 0, -rx, -ry * (1 - k), -rx, -ry),
                (0, -ry * k, rx * (1 - k), -ry, rx, -ry),
                (rx * k, 0, rx, ry * (1 - k), rx, ry),
            )
        ),
        "Z",
    ]
    return "".join(parts)


def egg_path(command, at, scale=1.0):
    """The egg as two cubic curves, absolute or relative, of a half outline."""
    first = [-20j, 11.0 - 20j, 15.0 - 9j, 15.0 - 1j, 15.0 + 12j, 8.0 + 24j, 24j]
    if command == "C":
        return d("M", first[:1], scale, at) + " " + d("C", first[1:], scale, at)
    steps = [
        *(point - first[0] for point in first[1:4]),
        *(point - first[3] for point in first[4:]),
    ]
    return d("m", first[:1], scale, at) + " " + d("c", steps, scale)


def csv(points, header="x,y", digits=4):
    return header + "\n" + "".join(f"{p.real:.{digits}f},{p.imag:.{digits}f}\n" for p in points)


SVG = {
    "inkscape-circle": (
        BALL,
        svg('<g id="layer1" transform="translate(12.5,-30)"><circle cx="80" cy="120" r="15"/></g>'),
    ),
    "inkscape-arc-path": (
        BALL,
        svg(
            '<path transform="matrix(1,0,0,-1,3,290)" d="m 95,120 a 15,15 0 0 1 -15,15 15,15 0 0 1'
            ' -15,-15 15,15 0 0 1 15,-15 15,15 0 0 1 15,15 z"/>'
        ),
    ),
    "inkscape-two-arcs": (BALL, svg('<path d="M 65,120 a 15 15 0 1 0 30 0 a 15 15 0 1 0 -30 0"/>')),
    "inkscape-egg-relative": (EGG, svg(f'<path d="{egg_path("c", 60 + 150j)} z"/>')),
    "inkscape-whole-top": (
        TOP,
        svg(f'<g transform="scale(2)"><path d="{whole_top(50 + 60j, 0.5)}"/></g>'),
    ),
    "inkscape-lying-top": (
        TOP,
        svg(f'<path transform="rotate(90,70,80)" d="{whole_top(70 + 80j)}"/>'),
    ),
    "inkscape-bored": (
        BORED,
        svg(
            f'<path style="fill-rule:evenodd" d="{whole_top(70 + 80j)} M 78,82 a 8,8 0 0 0 -16,0 '
            '8,8 0 1 0 16,0 z"/>'
        ),
    ),
    "inkscape-polygon": (
        SPINDLE,
        svg(d('<polygon points="', mirrored(polyline(SPINDLE, 1)), 1.0, 40 + 60j) + '"/>'),
    ),
    "inkscape-center-line": (
        EGG,
        svg(
            f'<path d="{egg_path("C", 60 + 150j)}"/>'
            '<path style="stroke-dasharray:4,1" d="M 60,120 V 180"/>'
        ).replace("z", ""),
    ),
    "inkscape-goblet": (
        GOBLET,
        svg(
            '<path d="m 60,150 c 14,0 18,-8 18,-16 h -3 c 0,6 -3,12 -15,12 -12,0 -15,-6 -15,-12'
            ' h -3 c 0,8 4,16 18,16 z"/>'
        ),
    ),
    "illustrator-circle": (
        BALL,
        svg(
            f'<path class="st0" d="{rounded_ellipse(56.69, 56.69, 120.5, 90.2)}"/>',
            "",
            "0 0 400 300",
        ),
    ),
    "illustrator-ellipse": (
        SPHEROID,
        svg(
            '<style>.a{fill:none}</style><ellipse class="a" cx="200" cy="150" '
            f'rx="{25 * PX:.3f}" ry="{16 * PX:.3f}" transform="rotate(-90 200 150)"/>',
            "400px 300px",
            "0 0 400 300",
        ),
    ),
    "illustrator-rounded-rect": (
        BARREL,
        svg('<rect x="1in" y="20" width="98.268" height="75.591" rx="11.339"/>', "", "0 0 300 300"),
    ),
    "illustrator-top-in-points": (
        TOP,
        svg(f'<path d="{whole_top(100 + 90j, 72 / 25.4)}"/>', "200pt 200pt", "0 0 200 200"),
    ),
    "illustrator-egg-both-sides": (
        EGG,
        svg(
            f'<path d="{egg_path("C", 60 + 50j, 1)} C 52 26 45 38 45 51 C 45 59 49 70 60 70 Z"/>',
            "10cm 10cm",
            "0 0 100 100",
        ),
    ),
    "illustrator-ring-cut": (
        TORUS,
        svg('<circle cx="32" cy="40" r="5"/><circle cx="68" cy="40" r="5"/>'),
    ),
    "freecad-loose-edges": (
        TOP,
        svg(
            '<g transform="translate(50,60) scale(1,-1)">'
            f'<path d="M {CUT} {FACE} L {SLIM} {FACE}"/>'
            f'<path d="M {SLIM} {TIP} A {SLIM} {SLIM} 0 0 1 0 {TIP + SLIM}"/>'
            f'<path d="M {SLIM} {FACE} L {SLIM} {TIP}"/>'
            f'<path d="M {CUT} {FACE} A {R} {R} 0 0 0 0 {-R}"/></g>'
        ),
    ),
    "openscad-top": (
        TOP,
        svg(
            d('<path d="M ', mirrored(polyline(TOP, 48)), 1.0, 0j, 5) + ' z" stroke-width="0.5"/>',
            "40mm 53mm",
            "-20 -33 40 53",
        ),
    ),
    "openscad-spheroid": (
        SPHEROID,
        svg(
            d('<path d="M ', mirrored(polyline(SPHEROID, 60)), 1.0, 0j, 5) + ' z"/>',
            "32mm 50mm",
            "-16 -25 32 50",
        ),
    ),
}
"""True curves, and the drawing."""


def measured(path, density=DENSITY, **options):
    piece = read_workpiece(path, density=density, **options)
    return piece, np.array(piece.mass_properties)


def check(piece, found, curves):
    """The weight, centre and moments; heights differ by where the sheet's origin is."""
    mass, center, I1, I3 = weighed(curves, DENSITY)
    assert found[0] == pytest.approx(mass, rel=WITHIN)
    assert [found[2], found[3]] == pytest.approx([I1, I3], rel=WITHIN)
    points = piece.outline.points(8)
    lowest = min(complex(curve(t)).imag for curve in curves for t in np.linspace(0, 1, 201))
    above, size = found[1] - points.imag.min(), piece.outline.size
    from_below = center - 1e-3 * lowest
    upside_down = points.imag.max() - found[1]
    assert min(abs(above - from_below), abs(upside_down - from_below)) <= WITHIN * size


@pytest.mark.parametrize("name", SVG)
def test_a_drawing_is_the_body_that_it_shows(tmp_path, name):
    curves, text = SVG[name]
    (tmp_path / "a.svg").write_text(text)
    check(*measured(tmp_path / "a.svg"), curves)


def with_dxf(draw, unit=4):
    """A DXF file of what a function draws in it."""
    ezdxf = pytest.importorskip("ezdxf", reason="it comes with the lathe extra")
    document = ezdxf.new("R2010")
    document.units = unit
    draw(document.modelspace())
    return document


def loose_top(space):
    """Half of the top in edges one by one, in no order, as a sketch of FreeCAD has them."""
    space.add_line((105, 62 - 50), (105, 80 - 50))
    space.add_arc((102, 80 - 50), SLIM, 0, 90)
    space.add_line((102 + CUT, 62 - 50), (105, 62 - 50))
    space.add_arc((102, 0), R, -90, math.degrees(math.asin(FACE / R)))
    space.add_text("R20").set_placement((150, 10))


def bulged_barrel(space):
    """The barrel on both sides as a polyline with bulges, in inches."""
    bulge, scale = math.tan(math.pi / 8), 1 / 25.4
    corners = [
        *((10, 0, bulge), (13, 3, 0), (13, 17, bulge), (10, 20, 0)),
        *((-10, 20, bulge), (-13, 17, 0), (-13, 3, bulge), (-10, 0, 0)),
    ]
    points = [(scale * x, scale * y, b) for x, y, b in corners]
    space.add_lwpolyline(points, format="xyb", close=True)


def curved_egg(space):
    """The egg as splines, with the axis as a line."""
    space.add_open_spline([(0, -20), (11, -20), (15, -9), (15, -1)], degree=3)
    space.add_open_spline([(15, -1), (15, 12), (8, 24), (0, 24)], degree=3)
    space.add_line((0, -20), (0, 24))


def spheroid(space):
    space.add_ellipse((30, 40), major_axis=(0, 25), ratio=16 / 25)


def polygon_top(space):
    """The top as points, as OpenSCAD exports it."""
    points = [(p.real, p.imag) for p in mirrored(polyline(TOP, 48))]
    for one, other in zip(points, [*points[1:], points[0]], strict=True):
        space.add_line(one, other)


DXF = {
    "freecad-edges": (TOP, loose_top, 4),
    "freecad-polyline-in-inches": (BARREL, bulged_barrel, 1),
    "librecad-splines": (EGG, curved_egg, 4),
    "librecad-ellipse": (SPHEROID, spheroid, 0),
    "openscad-lines": (TOP, polygon_top, 0),
}


@pytest.mark.parametrize("name", DXF)
def test_a_drawing_in_dxf_is_the_body_that_it_shows(tmp_path, name):
    curves, draw, unit = DXF[name]
    with_dxf(draw, unit).saveas(tmp_path / "a.dxf")
    check(*measured(tmp_path / "a.dxf"), curves)


def revolved(curves, count, facets):
    """The triangles of a body of revolution about z, from points along its curves."""
    creation = pytest.importorskip("trimesh.creation", reason="it comes with the lathe extra")
    line = np.array([(p.real, p.imag) for p in polyline(curves, count)])
    line[:, 0] = np.where(line[:, 0] < 1e-9, 0.0, line[:, 0])
    return creation.revolve(line, sections=facets)


def tilted(mesh):
    """The mesh with its axis in no direction of the file's, and off its origin."""
    trimesh = pytest.importorskip("trimesh")
    turn = trimesh.transformations.rotation_matrix(0.7, (1.0, 2.0, 0.5), (3.0, 4.0, 5.0))
    mesh.apply_transform(turn)
    mesh.apply_translation((10.0, -7.0, 30.0))
    return mesh


def ball_without_poles():
    """A ball as OpenSCAD makes it: rings half a step from the poles, and flat ends."""
    angles = [(k + 0.5) * math.pi / 30 - math.pi / 2 for k in range(30)]
    ends = [15.0 * math.sin(angles[0]), 15.0 * math.sin(angles[-1])]
    points = [(15.0 * math.cos(a), 15.0 * math.sin(a)) for a in angles]
    creation = pytest.importorskip("trimesh.creation", reason="it comes with the lathe extra")
    return creation.revolve(np.array([(0.0, ends[0]), *points, (0.0, ends[1])]), sections=60)


def scattered_ball():
    """A ball whose vertices are in no rings."""
    creation = pytest.importorskip("trimesh.creation", reason="it comes with the lathe extra")
    return creation.icosphere(subdivisions=4, radius=15.0)


STL = {
    "freecad-egg": (EGG, lambda: revolved(EGG, 40, 72), "stl"),
    "freecad-tilted-top": (TOP, lambda: tilted(revolved(TOP, 60, 90)), "stl"),
    "openscad-ball": (BALL, ball_without_poles, "stl_ascii"),
    "blender-ball": (BALL, scattered_ball, "stl"),
}


@pytest.mark.parametrize("name", STL)
def test_a_surface_is_the_body_that_it_encloses(tmp_path, name):
    curves, make, kind = STL[name]
    (tmp_path / "a.stl").write_bytes(_bytes(make().export(file_type=kind)))
    check(*measured(tmp_path / "a.stl"), curves)


def _bytes(content):
    return content.encode() if isinstance(content, str) else content


CSV = {
    "openscad-egg": (EGG, csv(polyline(EGG, 40), digits=3), {"unit": "mm"}),
    "digitized-spheroid-in-inches": (
        SPHEROID,
        csv([p / 25.4 for p in polyline(SPHEROID, 90)], "r,z", 5),
        {"unit": "in"},
    ),
    "points-of-a-top": (TOP, csv(polyline(TOP, 30), digits=3), {"unit": "mm"}),
}


@pytest.mark.parametrize("name", CSV)
def test_points_are_the_body_around_them(tmp_path, name):
    curves, text, options = CSV[name]
    (tmp_path / "a.csv").write_text(text)
    check(*measured(tmp_path / "a.csv", **options), curves)
