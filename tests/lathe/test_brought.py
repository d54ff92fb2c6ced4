"""Profiles and drawings as people bring them: rounded numbers, points, curves, files of others."""

import json
import math
from itertools import pairwise

import numpy as np
import pytest
from typer.testing import CliRunner

import tippetop as tt
from tippetop.cli.commands import app
from tippetop.lathe.files import read_with_remarks
from tippetop.theory.outlook import outlook

R = 20.0
HALF = R / math.sqrt(2.0)


def bowl(*corners):
    """A hollow ball with a stem, whose rim has some corners; mm."""
    return [(0, -R), *corners, (4, -7), (4, 30), (0, 34, 4)]


EXACT = bowl((R, 0, R), (HALF, HALF, R), (HALF, -7))
ROUNDED = {
    "five digits": bowl((20, 0, 20), (14.142, 14.142, 20), (14.142, -7)),
    "one arc": bowl((14.142, 14.142, 20), (14.142135623730951, -7)),
    "an edge of the last digit": bowl(
        (20, 0, 20), (14.142, 14.142, 20), (14.142, 14.1416), (14.142, -7)
    ),
    "a point twice": bowl((R, 0, R), (R, 0), (HALF, HALF, R), (HALF, -7)),
    "in inches": [
        tuple(round(number / 25.4, 6) for number in point)
        for point in bowl((R, 0, R), (HALF, HALF, R), (HALF, -7))
    ],
}


@pytest.mark.parametrize("name", ROUNDED)
def test_rounded_numbers_are_the_top_that_was_meant(name):
    exact = tt.Body.turned(EXACT, 7000.0, unit="mm")
    body = tt.Body.turned(ROUNDED[name], 7000.0, unit="in" if "inches" in name else "mm")
    assert [shape.kind for shape in body.shapes] == ["sphere", "sphere"]
    assert body.mass == pytest.approx(exact.mass, rel=1e-3)
    for shape, meant in zip(body.shapes, exact.shapes, strict=True):
        assert shape.radius == pytest.approx(meant.radius, rel=1e-5)
        assert shape.center == pytest.approx(meant.center, abs=1e-6)
    between = body.shapes[1].center - body.shapes[0].center
    assert between == pytest.approx(0.03, rel=1e-5)


def test_an_arc_that_is_off_the_axis_by_more_than_its_digits_stays_there():
    profile = [(0, 0), (8, 0), (10.5, 2, 2.6), (10.5, 10), (0, 10)]
    piece = tt.Workpiece(profile=profile, density=700.0, unit="mm")
    assert piece.fit.points == tuple(tuple(map(float, point)) for point in profile)


def test_a_zero_width_edge_is_none():
    """A ball of an inch cut at 45 degrees, with a stem of a quarter, in eight digits."""
    profile = [(0, -0.5), (0.5, 0, 0.5), (0.35355339, 0.35355339, 0.5), (0.125, 0.35355339)]
    stem = [(0.125, 0.875), (0, 1.0, 0.125)]
    piece = tt.Workpiece(profile=[*profile, *stem], density=2700.0, unit="in")
    assert [zone.name for zone in piece.hull.zones] == ["sphere", "sphere"]
    assert 1e3 * piece.mass_properties.center == pytest.approx(0.35, abs=0.005)


def along_ball(count, digits=4, radius=15.0):
    angles = [math.pi * (k / count - 0.5) for k in range(count + 1)]
    line = [
        (round(radius * math.cos(a), digits), round(radius * math.sin(a), digits)) for a in angles
    ]
    return [(0.0, -radius), *line[1:-1], (0.0, radius)]


@pytest.mark.parametrize("count", [24, 60, 500])
@pytest.mark.parametrize("digits", [2, 4, 15])
def test_points_along_a_ball_are_a_ball(count, digits):
    points = along_ball(count, digits)
    piece = tt.Workpiece(profile=points, density=700.0, unit="mm")
    assert [zone.name for zone in piece.hull.zones] == ["sphere"]
    assert piece.hull.zones[0].tube == pytest.approx(0.015, rel=3e-4)
    assert piece.fit.edges == 2
    apart = max(abs(math.hypot(*point) - 15.0) for point in points)
    assert piece.fit.deviation <= 2.0 * apart + 1e-12


EDGE = math.sqrt(375.0)
BORED = {
    "through": [(5, -19.365), (20, 0, 20), (5, EDGE, 20), (5, -19.365)],
    "to a depth": [(5, -19.365), (20, 0, 20), (0, 20, 20), (0, 10), (5, 10), (5, -19.365)],
    "closed in other digits": [
        (5, -19.365),
        (20, 0, 20),
        (0, 20, 20),
        (0, 10),
        (5, 10),
        (5, -EDGE),
    ],
    "begun above": [(5, 10), (5, -19.365), (20, 0, 20), (0, 20, 20), (0, 10), (5, 10)],
}


@pytest.mark.parametrize("profile", BORED.values(), ids=BORED)
def test_a_bored_ball_of_two_arcs_is_one_ball_to_its_digits(profile):
    piece = tt.Workpiece(profile=profile, density=700.0, unit="mm")
    (ball,) = [zone for zone in piece.hull.zones if not zone.radius]
    assert ball.tube == pytest.approx(0.02, rel=1e-12)
    assert ball.height == pytest.approx(0.0, abs=1e-15)
    cap = math.pi * (20.0 - EDGE) ** 2 * (40.0 + EDGE) / 3.0
    bore = 25.0 * math.pi * (2.0 * EDGE if profile is BORED["through"] else EDGE + 10.0)
    ends = 2.0 * cap if profile is BORED["through"] else cap
    volume = 4.0 / 3.0 * math.pi * 8000.0 - bore - ends
    assert piece.mass_properties.mass == pytest.approx(700e-9 * volume, rel=1e-5)


def test_what_digits_allow_and_leave_open_is_remarked_on(tmp_path):
    def remarks(profile, *options):
        rows = [",".join(map(str, point)) for point in profile]
        (tmp_path / "a.csv").write_text("\n".join(rows))
        command = ["body", str(tmp_path / "a.csv"), "--density", "700", "--unit", "mm", "--json"]
        done = CliRunner().invoke(app, [*command, "--no-runs", "--whole", *options])
        return " ".join(json.loads(done.stdout)["remarks"])

    assert "moved by up to 0.0001" in remarks(ROUNDED["five digits"])
    assert "moved" not in remarks(ROUNDED["five digits"], "--tolerance", "0")
    assert remarks(EXACT) == ""
    coarse = remarks(bowl((20, 0, 20), (14, 14.3, 20), (14, -7)))
    assert "beside the axis" in coarse


@pytest.mark.parametrize("count", [12, 24, 60])
def test_a_ball_has_no_eccentricity_of_rounding(count):
    """A body whose centre of mass is in the middle belongs to no group of tippe tops."""
    body = tt.Body.turned(along_ball(count, 15), 700.0, unit="mm")
    assert body.shape.center == 0.0
    problem = tt.Problem(
        body=body, friction=tt.ViscousFriction(mu=0.3), launch=tt.Launch(tilt=0.1, spin=100.0)
    )
    assert outlook(problem).group is None


@pytest.mark.parametrize("count", [3, 6])
def test_a_polygon_of_few_edges_is_one(count):
    points = along_ball(count, 15)
    piece = tt.Workpiece(profile=points, density=700.0, unit="mm")
    assert piece.fit.edges == count
    assert piece.fit.deviation == 0.0


def test_without_tolerance_every_edge_is_as_stated():
    points = along_ball(60)
    piece = tt.Workpiece(profile=points, density=700.0, unit="mm", tolerance=0.0)
    assert piece.fit.points == tuple(points)


@pytest.mark.parametrize("tolerance", [1e-3, 1e-4, 1e-5])
def test_a_smooth_curve_is_tangent_arcs_within_the_tolerance(tolerance):
    angles = np.linspace(0.0, math.pi, 241)
    across = 15.0 * np.sin(angles) * (1.0 - 0.2 * np.cos(angles))
    points = [(float(r), float(z)) for r, z in zip(across, -22.0 * np.cos(angles), strict=True)]
    points[0], points[-1] = (0.0, -22.0), (0.0, 22.0)
    piece = tt.Workpiece(profile=points, density=700.0, unit="mm", tolerance=tolerance)
    edges = piece.outline.edges
    assert piece.fit.deviation <= tolerance * 44.0
    apart = [min(edge.distance(1e-3 * complex(*point)) for edge in edges) for point in points]
    assert 1e3 * max(apart) == pytest.approx(piece.fit.deviation, abs=1e-9)
    turns = [
        abs(np.angle(other.direction(0.0) / one.direction(1.0))) for one, other in pairwise(edges)
    ]
    assert max(turns) < 1e-9
    # Halving the error takes so many more arcs only: it goes with the cube of their length.
    assert len(edges) < 2.5 / tolerance ** (1 / 3)


def test_an_ellipse_is_a_spheroid(tmp_path):
    drawing = '<svg xmlns="http://www.w3.org/2000/svg" width="8cm" viewBox="0 0 80 80">{}</svg>'
    (tmp_path / "a.svg").write_text(drawing.format('<ellipse cx="30" cy="40" rx="16" ry="25"/>'))
    body = tt.Body.turned(tmp_path / "a.svg", 700.0)
    assert isinstance(body.shape, tt.Spheroid)
    assert (body.shape.across, body.shape.along) == pytest.approx((0.016, 0.025), rel=1e-3)
    assert body.shape.center == pytest.approx(0.0, abs=1e-5)


TOP = [(0, -15), (15, 0, 15), (9, 12, 15), (2.5, 12), (2.5, 16), (0, 18.5, 2.5)]
CAVITY = {"profile": [(0, -8), (0, 4, 6)], "density": 0}


def test_a_solid_that_is_written_is_read_back(tmp_path):
    pytest.importorskip("trimesh", reason="it comes with the lathe extra")
    piece = tt.Workpiece(profile=TOP, density=700.0, unit="mm", inserts=[CAVITY])
    tt.write_solid(piece, tmp_path / "a.stl", facets=90)
    found, (remark,) = read_with_remarks(tmp_path / "a.stl", density=700.0)
    assert found.mass_properties[0] == pytest.approx(piece.mass_properties[0], rel=1e-5)
    assert found.mass_properties[2:] == pytest.approx(piece.mass_properties[2:], rel=1e-5)
    body, written = tt.Body.turned(found), tt.Body.turned(piece)
    for shape, meant in zip(body.shapes, written.shapes, strict=True):
        assert (shape.radius, shape.center) == pytest.approx((meant.radius, meant.center), abs=1e-7)
    assert "axis is along (0, 0, 1)" in remark


def squashed(tmp_path, factor):
    creation = pytest.importorskip("trimesh.creation", reason="it comes with the lathe extra")
    mesh = creation.icosphere(subdivisions=3, radius=15.0)
    mesh.apply_scale((1.0, factor, 1.5))
    mesh.export(tmp_path / "a.stl")
    return tmp_path / "a.stl"


def test_how_round_a_surface_is_is_said(tmp_path):
    _, (remark,) = read_with_remarks(squashed(tmp_path, 0.995), density=700.0)
    # Of 45 mm, 0.075 mm are 0.17 %; facets add to that, and take from it.
    assert 0.1 < float(remark.split(" by ")[1].split(" %")[0]) < 0.4
    with pytest.raises(tt.InvalidInput, match=r"a surface out of round by \d\.\d+ % of its size"):
        read_with_remarks(squashed(tmp_path, 0.9), density=700.0)


def drawing(tmp_path, content, size='width="80mm" height="80mm"'):
    head = '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 80 80"'
    (tmp_path / "a.svg").write_text(f"{head} {size}>{content}</svg>")
    return tmp_path / "a.svg"


RECT = '<rect x="30" y="10" width="10" height="20"/>'


@pytest.mark.parametrize(
    ("axis", "radius", "length"),
    [
        (None, 5, 20),
        ("x", 5, 20),
        ("y", 10, 10),
        ("x=30", 10, 20),
        ("x = 40", 10, 20),
        ("y=10", 20, 10),
    ],
)
def test_the_axis_is_where_it_is_stated(tmp_path, axis, radius, length):
    piece, (remark, *others) = read_with_remarks(drawing(tmp_path, RECT), density=700.0, axis=axis)
    exact = 700.0 * math.pi * 1e-9 * radius**2 * length
    assert piece.mass_properties.mass == pytest.approx(exact, rel=1e-9)
    place = {"x": "x = 35", "y": "y = 20"}.get(
        axis or "x", axis and axis.replace(" ", "").replace("=", " = ")
    )
    assert f"at {place} mm" in remark
    assert bool(others) == place.startswith("y")


def test_a_ring_around_a_stated_axis(tmp_path):
    path = drawing(tmp_path, '<circle cx="40" cy="30" r="5"/>')
    piece, _ = read_with_remarks(path, density=700.0, axis="x=20")
    assert piece.mass_properties.mass == pytest.approx(
        700e-9 * 2.0 * math.pi**2 * 20.0 * 25.0, rel=1e-9
    )


@pytest.mark.parametrize(
    ("unit", "size", "millimetres"),
    [
        (None, 'width="80mm"', 1.0),
        (None, 'width="8cm" height="8cm"', 1.0),
        (None, 'width="20in"', 25.4 / 4.0),
        (None, "", 25.4 / 96.0),
        (None, 'width="100%"', 25.4 / 96.0),
        ("mm", "", 1.0),
        ("in", 'width="80mm"', 25.4),
    ],
)
def test_lengths_are_physical_unless_a_unit_is_stated(tmp_path, unit, size, millimetres):
    path = drawing(tmp_path, '<circle cx="40" cy="30" r="5"/>', size)
    options = {"unit": unit} if unit else {}
    piece, _ = read_with_remarks(path, density=700.0, **options)
    exact = 700.0 * 4.0 / 3.0 * math.pi * (5e-3 * millimetres) ** 3
    assert piece.mass_properties.mass == pytest.approx(exact, rel=1e-9)


@pytest.mark.parametrize(
    ("content", "sentence"),
    [
        ('<path id="a" d="M 20 5 H 30 V 15 H 20"/><path id="b" d="M 20 25 H 30 V 45 H 20"/>',
         "path 'a', which is beside path 'b'"),
        ('<circle cx="40" cy="30" r="9"/><circle cx="40" cy="30" r="6"/>'
         '<circle cx="40" cy="30" r="3"/>', "which is inside circle 2 of 3"),
        ('<path d="M 20 5 L 30 7 L 33 25 L 22 30 Z"/>', "two sides that differ by"),
        ('<path d="M 20 5 L 30 5 L 33 25"/>', "an open line from (20, -5) to (33, -25)"),
        ('<text x="3" y="9">top</text>', "a drawing without lines"),
    ],
)  # fmt: skip
def test_what_is_no_body_is_refused_by_name(tmp_path, content, sentence):
    with pytest.raises(tt.InvalidInput) as refusal:
        read_with_remarks(drawing(tmp_path, content), density=700.0)
    assert sentence in str(refusal.value)


@pytest.mark.parametrize("axis", ["z", "x=", "x=one", "10", "x=nan", 3])
def test_an_axis_that_is_none_is_refused(tmp_path, axis):
    with pytest.raises(tt.InvalidInput, match=r"^axis: "):
        read_with_remarks(drawing(tmp_path, RECT), density=700.0, axis=axis)


def test_an_axis_off_the_middle_is_refused_with_the_figure(tmp_path):
    with pytest.raises(tt.InvalidInput, match=r"sides that differ by \d+"):
        read_with_remarks(drawing(tmp_path, RECT), density=700.0, axis="x=33")


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("a.stl", b"solid nothing\nendsolid nothing\n"),
        ("a.stl", b"\0" * 10),
        ("a.dxf", b"0\nSECTION\n"),
        ("a.dxf", b"\xff\xfe\0"),
        ("a.svg", b"<svg xmlns='http://www.w3.org/2000/svg'><path d='M 0 0 C 1'/></svg>"),
    ],
)
def test_files_that_are_broken_are_refused(tmp_path, name, content):
    pytest.importorskip("ezdxf", reason="it comes with the lathe extra")
    (tmp_path / name).write_bytes(content)
    with pytest.raises(tt.TippetopError):
        read_with_remarks(tmp_path / name, density=700.0)


def test_the_command_says_how_a_drawing_was_read(tmp_path):
    path = drawing(tmp_path, '<ellipse cx="30" cy="40" rx="16" ry="25"/>')
    done = CliRunner().invoke(app, ["body", str(path), "--density", "700", "--json", "--no-runs"])
    assert done.exit_code == 0, done.output
    remarks = json.loads(done.stdout)["remarks"]
    assert remarks[0].startswith("The axis is the middle of the outline, at x = 30 mm")
    assert remarks[1].endswith("mm from its points.")


def test_a_body_that_cannot_be_simulated_ends_with_exit_code_2(tmp_path):
    path = drawing(tmp_path, '<path d="M 20 5 H 30 A 50 50 0 0 1 25 25 H 20"/>')
    for options in ([], ["--json"]):
        done = CliRunner().invoke(
            app, ["body", str(path), "--density", "700", "--no-runs", *options]
        )
        assert done.exit_code == 2
        assert "an arc around a point beyond" in done.stdout.replace("\n", " ")


def egg_points(count=121):
    """Points of an egg that is no spheroid, mm."""
    angles = np.linspace(0.0, math.pi, count)
    across = 15.0 * np.sin(angles) * (1.0 - 0.2 * np.cos(angles))
    points = [(float(r), float(z)) for r, z in zip(across, -22.0 * np.cos(angles), strict=True)]
    points[0], points[-1] = (0.0, -22.0), (0.0, 22.0)
    return points


def test_an_egg_is_an_oval_that_touches_where_its_points_do():
    piece = tt.Workpiece(profile=egg_points(), density=700.0, unit="mm")
    body = tt.Body.turned(piece)
    (oval,) = body.shapes
    assert isinstance(oval, tt.Oval)
    line = 1e-3 * np.array(egg_points(4001))
    heights = line[:, 1] - piece.mass_properties.center
    for tilt in np.linspace(0.0, math.pi, 91):
        support = np.max(line[:, 0] * math.sin(tilt) - heights * math.cos(tilt))
        assert oval.surface.height(math.cos(tilt)) == pytest.approx(support, abs=3e-4 * 0.044)


def test_an_egg_with_a_stem_has_an_oval_and_a_sphere():
    egg = [point for point in egg_points() if point[1] < 12.0]
    profile = [*egg, (2.0, egg[-1][1]), (2.0, 33.0), (0.0, 35.0, 2.0)]
    body = tt.Body.turned(profile, 700.0, unit="mm", whole=True)
    kinds = [shape.kind for shape in body.shapes]
    assert (kinds[0], kinds[-1]) == ("oval", "sphere")


def test_an_incomplete_curve_may_be_accepted(tmp_path):
    bowl = '<path d="M 30 60 C 44 60 48 52 48 44 H 30 Z"/>'
    with pytest.raises(tt.InvalidInput, match=r"a curve of which only tilts 0 to .*--whole"):
        tt.Body.turned(drawing(tmp_path, bowl), 700.0)
    body = tt.Body.turned(drawing(tmp_path, bowl), 700.0, whole=True)
    assert "oval" in [shape.kind for shape in body.shapes]


def test_points_on_both_sides_are_a_whole_outline(tmp_path):
    half = along_ball(30)
    whole = [*half, *((-r, z) for r, z in half[-2:0:-1])]
    rows = [f"{r + 7.0:.4f} {z}" for r, z in whole]
    (tmp_path / "a.csv").write_text("\n".join(rows))
    piece, (remark,) = read_with_remarks(tmp_path / "a.csv", density=700.0, unit="mm", axis="x=7")
    assert piece.mass_properties.mass == pytest.approx(700e-9 * 4.5e3 * math.pi, rel=1e-3)
    assert "x = 7 mm" in remark
    (tmp_path / "b.csv").write_text("\n".join(f"{r},{z}" for r, z in whole))
    found, _ = read_with_remarks(tmp_path / "b.csv", density=700.0, unit="mm")
    assert found.mass_properties.mass == pytest.approx(piece.mass_properties.mass, rel=1e-6)


def test_an_axis_is_refused_where_the_profile_is_stated_from_it(tmp_path):
    (tmp_path / "a.toml").write_text("density = 1\nprofile = [[0, -1], [0, 1, 1]]")
    for body in (tmp_path / "a.toml", [(0, -1), (0, 1, 1)]):
        with pytest.raises(tt.InvalidInput, match="stated from the axis"):
            tt.Body.turned(body, 1.0, axis="x=0")


SHEET = """<?xml version="1.0" encoding="UTF-8"?>
<svg width="210mm" height="297mm" viewBox="0 0 210 297" version="1.1" id="svg1"
   inkscape:version="1.3" sodipodi:docname="a.svg"
   xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape"
   xmlns:sodipodi="http://sodipodi.sourceforge.net/DTD/sodipodi-0.dtd"
   xmlns:xlink="http://www.w3.org/1999/xlink" xmlns="http://www.w3.org/2000/svg">
  <sodipodi:namedview id="view1" pagecolor="#ffffff" inkscape:document-units="mm"/>
  <defs id="defs1"><circle id="hidden" cx="0" cy="0" r="80"/><circle id="ball" r="15"/></defs>
  <metadata>made</metadata>
  <g inkscape:label="Layer 1" inkscape:groupmode="layer" id="layer1">{}</g>
  <text x="3" y="30">R15</text>
</svg>"""


@pytest.mark.parametrize(
    "content",
    [
        '<use xlink:href="#ball" x="80" y="90"/>',
        '<g style="display:none"><path d="M 0 0 H 9"/></g><circle cx="80" cy="90" r="15"/>',
        '<svg x="10" y="10"><circle cx="80" cy="90" r="15"/></svg>',
        '<path sodipodi:type="arc" d="M 95,90 A 15,15 0 0 1 80,105 15,15 0 0 1 65,90 15,15 0 0 1'
        ' 80,75 15,15 0 0 1 95,90 Z"/>',
        '<path d="m 80,75 a 15,15 0 0 0 -15,15 15,15 0 0 0 15,15 z"/>',
        '<path d="m 80,75 c 8.284,0 15,6.716 15,15 0,8.284 -6.716,15 -15,15"/>',
        '<path d="M 80 75 Q 80 75 80 75 T 80 75 A 15 15 0 1 1 80 105 L 80 75"/>',
    ],
)  # fmt: skip
def test_what_inkscape_puts_around_a_drawing_is_left_out(tmp_path, content):
    (tmp_path / "a.svg").write_text(SHEET.format(content))
    piece, _ = read_with_remarks(tmp_path / "a.svg", density=700.0)
    exact = 700e-9 * 4.0 / 3.0 * math.pi * 15.0**3
    assert piece.mass_properties.mass == pytest.approx(exact, rel=1e-3)


@pytest.mark.parametrize(("sides", "is_round"), [(4, False), (6, False), (8, False), (48, True)])
def test_a_prism_is_not_round(tmp_path, sides, is_round):
    trimesh = pytest.importorskip("trimesh", reason="it comes with the lathe extra")
    trimesh.creation.cylinder(radius=15.0, height=20.0, sections=sides).export(tmp_path / "a.stl")
    if is_round:
        piece, _ = read_with_remarks(tmp_path / "a.stl", density=700.0, axis="z")
        assert piece.mass_properties.mass == pytest.approx(700e-9 * 4500.0 * math.pi, rel=1e-6)
    else:
        with pytest.raises(tt.InvalidInput, match="out of round"):
            read_with_remarks(tmp_path / "a.stl", density=700.0)
