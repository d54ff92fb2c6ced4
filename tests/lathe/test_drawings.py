"""Drawings as Inkscape, Illustrator, FreeCAD and OpenSCAD write them, against the true shapes."""

import math

import numpy as np
import pytest

from drawings import SVG, csv, mirrored
from drawn import (
    BALL,
    BARREL,
    CUT,
    EGG,
    FACE,
    SLIM,
    SPHEROID,
    TOP,
    R,
    polyline,
    weighed,
)
from tippetop.lathe.files import read_workpiece

DENSITY = 700.0
WITHIN = 1e-3


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
