"""Drawings, points and meshes of the kinds that people bring, with the masses that they have."""

import math
from itertools import pairwise

import numpy as np
import pytest
from typer.testing import CliRunner

import tippetop as tt
from tippetop.cli.commands import app
from tippetop.lathe.files import read_with_remarks

BALL = 4.0 / 3.0 * math.pi * 15.0**3
"""Volume of a ball of 15 mm, mm^3."""


def cap(radius, from_center):
    """Volume of a ball beyond a plane at a distance from its centre."""
    height = radius - from_center
    return math.pi * height**2 * (3.0 * radius - height) / 3.0


def sunk(radius, r):
    """How far up a cylinder of radius r meets a ball about the origin."""
    return math.sqrt(radius**2 - r**2)


WITH_STEM = BALL - cap(15.0, sunk(15.0, 3.0)) + math.pi * 9.0 * (25.0 - sunk(15.0, 3.0))
"""Volume of the ball with a stem of radius 3 mm, its end 25 mm above the centre."""


def mass(path, **options):
    piece, _ = read_with_remarks(path, density=1000.0, **options)
    return piece.mass_properties.mass * 1e6  # mm^3 of water


def svg(tmp_path, content):
    head = '<svg xmlns="http://www.w3.org/2000/svg" width="100mm" height="100mm"'
    path = tmp_path / "a.svg"
    path.write_text(f'{head} viewBox="0 0 100 100">{content}</svg>')
    return path


# A ball of 15 mm about (50, 60) with a stem up to 25 mm above its centre, half and whole.
RIM = 60.0 - sunk(15.0, 3.0)
HALF = f'<path d="M50 75 A15 15 0 0 0 65 60 A15 15 0 0 0 53 {RIM:.9f} V35 H50 Z"/>'
WHOLE = (
    f'<path d="M50 75 A15 15 0 0 0 65 60 A15 15 0 0 0 53 {RIM:.9f} V35 H47 V{RIM:.9f}'
    ' A15 15 0 0 0 35 60 A15 15 0 0 0 50 75 Z"/>'
)
PAGE = '<rect width="100" height="100" fill="#eee"/>'
FRAME = '<rect x="6" y="6" width="90" height="90" fill="none" stroke="#000"/>'
CENTRED = '<rect x="10" y="10" width="80" height="80" fill="none" stroke="#000"/>'
TITLE = '<path d="M60 96 V86 H96"/>'


@pytest.mark.parametrize(
    "content",
    [HALF, WHOLE, PAGE + HALF, PAGE + WHOLE, FRAME + HALF, FRAME + WHOLE, FRAME + TITLE + HALF,
     PAGE + FRAME + WHOLE, '<rect x="2" y="2" width="96" height="96"/>' + FRAME + HALF],
)  # fmt: skip
def test_pages_and_frames_are_no_bodies(tmp_path, content):
    assert mass(svg(tmp_path, content)) == pytest.approx(WITH_STEM, rel=1e-7)


def test_a_rectangle_that_may_be_a_body_with_a_bore_is_asked_about(tmp_path):
    path = svg(tmp_path, CENTRED + WHOLE)
    with pytest.raises(tt.InvalidInput, match=r"may be a frame .* --frame or --no-frame"):
        mass(path)
    assert mass(path, frame=True) == pytest.approx(WITH_STEM, rel=1e-7)
    cylinder = math.pi * 40.0**2 * 80.0
    assert mass(path, frame=False) == pytest.approx(cylinder - WITH_STEM, rel=1e-7)


def test_parts_that_overlap_or_touch_are_one_body(tmp_path):
    stem = '<rect x="47" y="35" width="6" height="20"/>'
    ball = '<circle cx="50" cy="60" r="15"/>'
    assert mass(svg(tmp_path, ball + stem)) == pytest.approx(WITH_STEM, rel=1e-7)
    disk = '<rect x="40" y="50" width="20" height="10"/>'
    pin = '<rect x="47" y="20" width="6" height="30"/>'
    flush = math.pi * (100.0 * 10.0 + 9.0 * 30.0)
    assert mass(svg(tmp_path, disk + pin)) == pytest.approx(flush, rel=1e-9)


def test_a_heading_may_have_the_unit(tmp_path):
    volume = math.pi * 60.0**2 * 50.0
    for heading in ("r (mm),z (mm)", "r [mm];z [mm]", "r_mm\tz_mm", "r/mm,z/mm", "r,z (MM)"):
        between = next(mark for mark in ";\t," if mark in heading)
        rows = [f"{r}{between}{z}" for r, z in ((0, 0), (60, 0), (60, 50), (0, 50))]
        (tmp_path / "a.csv").write_text("\n".join([heading, *rows]))
        assert mass(tmp_path / "a.csv") == pytest.approx(volume, rel=1e-12), heading
        assert mass(tmp_path / "a.csv", unit="mm") == pytest.approx(volume, rel=1e-12)
    with pytest.raises(tt.InvalidInput, match=r"unit.*'cm'.*write mm"):
        mass(tmp_path / "a.csv", unit="cm")
    (tmp_path / "b.toml").write_text('density = 1000\nprofile = "a.csv"')
    assert mass(tmp_path / "b.toml") == pytest.approx(volume, rel=1e-12)
    (tmp_path / "a.csv").write_text("r (mm),z (cm)\n0,0\n60,0\n60,50\n0,50")
    with pytest.raises(tt.InvalidInput, match="one unit for all columns"):
        mass(tmp_path / "a.csv")


@pytest.mark.parametrize(
    "heading",
    [
        *("r (furlong),z", "r_furlong,z", "r in furlong,z", "r ft,z ft", "r,z (1/64 in)"),
        *("r_mil,z", "r_um,z", "r yd.,z", "r (mil thick),z", "r (tenths of mm),z", "r (foot),z"),
        "r (ft, outer),z",
    ],
)
def test_units_that_profiles_do_not_have_are_not_taken_for_metres(tmp_path, heading):
    (tmp_path / "a.csv").write_text(f"{heading}\n0,0\n60,0\n60,50\n0,50")
    with pytest.raises(tt.InvalidInput, match="a heading with a unit of m, cm, mm or in"):
        mass(tmp_path / "a.csv")


@pytest.mark.parametrize(
    "heading",
    [
        *("r_outer,z", "r (from the axis),z", "radius in mm,height in mm", "r_foot,z_foot"),
        *("r_point,z", "r pole,z pole", "r_link,z", "r_hand,z"),
    ],
)
def test_words_in_headings_are_no_units(tmp_path, heading):
    (tmp_path / "a.csv").write_text(f"{heading}\n0,0\n60,0\n60,50\n0,50")
    volume = math.pi * 60.0**2 * 50.0
    stated = {} if "mm" in heading else {"unit": "mm"}
    assert mass(tmp_path / "a.csv", **stated) == pytest.approx(volume, rel=1e-12)


@pytest.mark.parametrize(
    ("heading", "unit"),
    [
        ("r (mm, outer),z (mm, up)", "mm"),
        ("r (mm, outer);z", "mm"),
        ("r (outer, mm),z", "mm"),
        ("r (mm) outer;z (mm) height", "mm"),
        ("r (m m);z (m m)", "mm"),
        ("r mm.;z mm.", "mm"),
        ("r (mm.);z", "mm"),
        ("r Millimeter;z Millimeter", "mm"),
        ("r (millimetres);z", "mm"),
        ("r in Zentimetern;z", "cm"),
        ("r [Zoll];z", "in"),
        ("r_metres;z", "m"),
    ],
)
def test_units_are_read_from_headings_as_people_write_them(tmp_path, heading, unit):
    rows = "\n0,0\n60,0\n60,50\n0,50".replace(",", ";" if ";" in heading else ",")
    (tmp_path / "a.csv").write_text(heading + rows)
    workpiece, remarks = read_with_remarks(tmp_path / "a.csv", density=1.0)
    assert (workpiece.unit, remarks) == (unit, [])


@pytest.mark.parametrize("heading", ["d (mm),z (mm)", "Durchmesser,z", "Ø,z"])
def test_diameters_are_not_taken_for_radii(tmp_path, heading):
    (tmp_path / "a.csv").write_text(f"{heading}\n0,0\n60,0\n60,50\n0,50")
    with pytest.raises(tt.InvalidInput, match=r"half the diameters, in a column such as r \(mm\)"):
        mass(tmp_path / "a.csv")


def test_numbers_of_millimetres_without_a_unit_are_remarked_on(tmp_path):
    (tmp_path / "a.csv").write_text("r,z\n0,0\n20,0\n20,10\n0,10")
    _, remarks = read_with_remarks(tmp_path / "a.csv", density=1.0)
    assert any("metres were taken" in remark for remark in remarks)
    _, remarks = read_with_remarks(tmp_path / "a.csv", density=1.0, unit="mm")
    assert remarks == []


def old_dxf(points):
    """Lines with the codes in the order 10, 11, 20, 21, as old exporters write them."""
    lines = ["  0", "SECTION", "  2", "ENTITIES"]
    for (x, y), (u, v) in pairwise(points):
        lines += ["  0", "LINE", "  8", "0"]
        for code, value in ((10, x), (11, u), (20, y), (21, v)):
            lines += [f" {code}", f"{value}"]
    return "\n".join([*lines, "  0", "ENDSEC", "  0", "EOF", ""])


def test_lines_of_old_exporters_are_read(tmp_path):
    pytest.importorskip("ezdxf", reason="it comes with the lathe extra")
    (tmp_path / "a.dxf").write_text(old_dxf([(0, 0), (25, 0), (25, 4), (3, 8), (3, 30), (0, 30)]))
    frustum = math.pi * 4.0 / 3.0 * (25.0**2 + 25.0 * 3.0 + 9.0)
    volume = math.pi * 25.0**2 * 4.0 + frustum + math.pi * 9.0 * 22.0
    assert mass(tmp_path / "a.dxf") == pytest.approx(volume, rel=1e-9)


def test_layers_that_are_hidden_are_left_out(tmp_path):
    ezdxf = pytest.importorskip("ezdxf", reason="it comes with the lathe extra")
    document = ezdxf.new(units=4)
    document.layers.add("notes").off()
    document.modelspace().add_circle((0.0, 0.0), 15.0)
    document.modelspace().add_circle((9.0, 0.0), 30.0, dxfattribs={"layer": "notes"})
    document.saveas(tmp_path / "a.dxf")
    assert mass(tmp_path / "a.dxf") == pytest.approx(BALL, rel=1e-9)


def lathed(trimesh, profile, sides):
    """A mesh of revolution as a lathe tool makes it: rings of vertices, and poles on the axis."""
    is_loop = profile[0] == profile[-1]
    points = profile[:-1] if is_loop else profile
    angles = 2.0 * math.pi * np.arange(sides) / sides
    vertices = [(r * math.cos(a), r * math.sin(a), z) for r, z in points for a in angles]
    faces = []
    for k in range(len(points) if is_loop else len(points) - 1):
        low, high = sides * k, sides * ((k + 1) % len(points))
        for one in range(sides):
            other = (one + 1) % sides
            faces += [(low + one, low + other, high + other), (low + one, high + other, high + one)]
    mesh = trimesh.Trimesh(vertices, faces)
    mesh.update_faces(mesh.nondegenerate_faces())
    return mesh


def ball_points(radius, edges, end=0.0):
    tilts = np.linspace(end, math.pi - end, edges + 1)
    points = [(radius * math.sin(t), -radius * math.cos(t)) for t in tilts]
    return [(0.0, -radius), *points[1:-1], (0.0, radius)] if not end else points


def test_meshes_as_they_are(tmp_path):
    trimesh = pytest.importorskip("trimesh", reason="it comes with the lathe extra")
    for kind in ("obj", "ply", "off", "stl"):
        lathed(trimesh, ball_points(15.0, 40), 48).export(tmp_path / f"a.{kind}")
        assert mass(tmp_path / f"a.{kind}") == pytest.approx(BALL, rel=1e-5), kind
    stem = lathed(trimesh, [(0.0, 5.0), (3.0, 5.0), (3.0, 25.0), (0.0, 25.0)], 48)
    trimesh.util.concatenate([lathed(trimesh, ball_points(15.0, 40), 48), stem]).export(
        tmp_path / "a.stl"
    )
    assert mass(tmp_path / "a.stl") == pytest.approx(WITH_STEM, rel=1e-4)
    disk = lathed(trimesh, [(0.0, 0.0), (20.0, 0.0), (20.0, 5.0), (0.0, 5.0)], 48)
    cone = lathed(trimesh, [(0.0, 5.0), (20.0, 5.0), (0.0, 25.0)], 48)
    trimesh.util.concatenate([disk, stem.copy(), cone]).export(tmp_path / "a.stl")
    beyond = math.pi * 9.0 * 3.0 - math.pi * 27.0 / 3.0  # of the stem out of the cone
    volume = math.pi * 400.0 * (5.0 + 20.0 / 3.0) + beyond
    assert mass(tmp_path / "a.stl") == pytest.approx(volume, rel=1e-6)


def test_a_bored_ball_is_read_from_its_mesh(tmp_path):
    trimesh = pytest.importorskip("trimesh", reason="it comes with the lathe extra")
    bore = 4.0
    profile = ball_points(15.0, 40, math.asin(bore / 15.0))
    lathed(trimesh, [*profile, profile[0]], 48).export(tmp_path / "a.stl")
    napkin_ring = 4.0 / 3.0 * math.pi * sunk(15.0, bore) ** 3
    assert mass(tmp_path / "a.stl") == pytest.approx(napkin_ring, rel=1e-5)


def test_it_is_said_how_far_facets_are_inside(tmp_path):
    trimesh = pytest.importorskip("trimesh", reason="it comes with the lathe extra")
    for sides in (12, 16):
        mesh = lathed(trimesh, ball_points(15.0, 60), sides)
        mesh.export(tmp_path / "a.stl")
        _, (remark,) = read_with_remarks(tmp_path / "a.stl", density=1000.0)
        depth = 15.0 * (1.0 - math.cos(math.pi / sides)) / 30.0
        area = sides / (2.0 * math.pi) * math.sin(2.0 * math.pi / sides)  # of the polygon, by disk
        assert f"up to {100.0 * depth:.2g} % of the size inside" in remark
        assert f"{100.0 * (1.0 - area):.2g} % less volume" in remark
        assert mass(tmp_path / "a.stl") == pytest.approx(BALL, rel=1e-4)
    lathed(trimesh, ball_points(15.0, 60), 8).export(tmp_path / "a.stl")
    with pytest.raises(tt.InvalidInput, match=r"out of round .* --tolerance 0.05"):
        mass(tmp_path / "a.stl")
    assert mass(tmp_path / "a.stl", tolerance=0.05) == pytest.approx(BALL, rel=2e-2)


@pytest.mark.parametrize("digits", [3, 4, 5, 6])
@pytest.mark.parametrize("count", [9, 20, 36])
def test_a_flat_foot_of_few_digits_is_flat(digits, count):
    tilts = np.linspace(0.0, math.pi / 2.0, count)
    rim = [(25.0 + 2.0 * math.sin(t), 2.0 - 2.0 * math.cos(t)) for t in tilts]
    points = [(0, 0), *rim, (27, 5), (3, 9), (3, 40), (0, 40)]
    written = [tuple(float(f"{number:.{digits}g}") for number in point) for point in points]
    assert 0.0 in tt.Workpiece(profile=written, density=700.0, unit="mm").hull.flats


def test_files_of_two_parts_that_touch_are_body_and_insert(tmp_path):
    """The insert's arc is the body's, in other digits."""
    tilts = np.linspace(0.0, math.pi / 3.0, 25)
    ring = [(20.0 * math.sin(t), -20.0 * math.cos(t)) for t in tilts]
    level = ring[-1][1]
    insert = [tuple(round(x, 3) for x in point) for point in ring] + [(0.0, round(level, 3))]
    body = [(0, -20), (0, 20, 20)]
    piece = tt.Workpiece(
        profile=body, density=700.0, unit="mm", inserts=[{"profile": insert, "density": 7800.0}]
    )
    volume = 4.0 / 3.0 * math.pi * 20.0**3
    exact = 1e-9 * (700.0 * volume + 7100.0 * cap(20.0, 10.0))
    assert piece.mass_properties.mass == pytest.approx(exact, rel=1e-4)
    outside = [(0, -21), (5, -15), (0, -15)]
    with pytest.raises(tt.InvalidInput, match="tolerance = 0"):
        tt.Workpiece(
            profile=body, density=700.0, unit="mm", inserts=[{"profile": outside, "density": 1.0}]
        )


def test_densities_may_be_materials():
    profile = [(0, -15), (0, 15, 15)]
    inner = {"profile": [(0, -5), (0, 5, 5)], "density": "Stahl"}
    piece = tt.Workpiece(profile=profile, density="PLA 20 %", unit="mm", inserts=[inner])
    assert (piece.density, piece.inserts[0].density) == (248.0, 7850.0)
    for text in ("20 % PLA", "pla at 20 % infill", "PLA, 20 % infill"):
        assert tt.Body.turned(profile, text, unit="mm").mass == pytest.approx(248e-9 * BALL)
    assert tt.Workpiece(profile=profile, density="0.7 g/cm^3").density == pytest.approx(700.0)
    for text, sentence in (("beach", "did you mean beech"), ("oak 0 %", "above 0 %"), ("%", "PLA")):
        with pytest.raises(tt.InvalidInput, match=sentence):
            tt.Workpiece(profile=profile, density=text)


TIPPE = [(0, -15), (15, 0, 15), (9, 12, 15), (2.5, 12), (2.5, 16), (0, 18.5, 2.5)]


def test_a_body_drawn_stem_down_is_judged_at_both_ends(tmp_path):
    down = [(point[0], -point[1], *(-r for r in point[2:])) for point in TIPPE]
    upright, turned = (tt.Body.turned(shape, 700.0, unit="mm") for shape in (TIPPE, down))
    assert turned.shapes[0].radius == pytest.approx(0.0025)
    again = tt.Body.turned(down, 700.0, unit="mm", upside_down=True)
    assert [shape.radius for shape in again.shapes] == [shape.radius for shape in upright.shapes]
    assert (again.mass, again.I1, again.I3) == pytest.approx((upright.mass, upright.I1, upright.I3))
    rows = [",".join(map(str, point)) for point in down]
    (tmp_path / "a.csv").write_text("\n".join(["r (mm),z (mm),radius (mm)", *rows]))
    inside = CliRunner().invoke(
        app, ["body", str(tmp_path / "a.csv"), "--density", "beech", "--no-runs"]
    )
    assert "Upside down: group" in inside.stdout
    assert "drawn with its ball above" in inside.stdout.replace("\n", " ")
    over = ["body", str(tmp_path / "a.csv"), "--density", "beech", "--upside-down", "--no-runs"]
    assert CliRunner().invoke(app, over).stdout.startswith("Group ")


def test_a_drawing_that_lies_is_said_to_lie(tmp_path):
    lying = f'<g transform="rotate(90 50 50)">{WHOLE}</g>'
    piece, remarks = read_with_remarks(svg(tmp_path, lying), density=700.0)
    assert piece.mass_properties.mass == pytest.approx(700e-9 * WITH_STEM, rel=1e-7)
    assert any("lies on the sheet" in remark for remark in remarks)


def test_half_an_outline_that_may_be_one_that_lies_is_asked_about(tmp_path):
    path = svg(tmp_path, '<path d="M 30 20 H 35 V 47 H 60 V 53 H 35 V 80 H 30 Z"/>')
    with pytest.raises(tt.InvalidInput, match=r"full one that lies .*--axis"):
        mass(path)
    assert mass(path, axis="x") == pytest.approx(math.pi * (25 * 54 + 900 * 6), rel=1e-9)
    assert mass(path, axis="y") == pytest.approx(math.pi * (900 * 5 + 9 * 25), rel=1e-9)


def test_masses_are_doubted_where_the_body_cannot_be_simulated(tmp_path):
    (tmp_path / "a.csv").write_text("0,0\n60,60\n58,64,3\n0,20")
    with pytest.warns(tt.Implausible, match="the mass is"):
        refused = CliRunner().invoke(app, ["body", str(tmp_path / "a.csv"), "--density", "7000"])
    assert refused.exit_code == 2
