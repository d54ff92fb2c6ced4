"""The mesh of a toy touches the table where the model does, and rays meet it where it is."""

import numpy as np
import pytest
from matplotlib.colors import to_rgb

import tippetop as tt
from tippetop.export.geometry import lathe
from tippetop.figures.appearance import size, toy_parts
from tippetop.figures.meridian import stated_profile
from tippetop.figures.toy import FAR, Toy
from tippetop.mechanics.surfaces.hull import outer_height
from tippetop.mechanics.surfaces.outline import outline

EGG = tt.Body(mass=0.02, shape=tt.Spheroid(across=0.015, along=0.025), I1=4e-6, I3=2e-6)
STEMMED = tt.Body(
    mass=6e-3,
    shape=[tt.Sphere(radius=0.015, center=0.003), tt.Sphere(radius=0.005, center=0.016)],
    I1=8e-7,
    I3=7e-7,
)
COIN = tt.Body(
    mass=4e-3,
    shape=[tt.Ring(radius=0.01, center=-0.001), tt.Ring(radius=0.01, center=0.001)],
    I1=1e-7,
    I3=2e-7,
)
TURNED, BALLS = tt.presets.WOODEN, tt.presets.HURRICANE_BALLS
BODIES = [tt.presets.REPORT, EGG, STEMMED, COIN, TURNED, BALLS]
NAMES = ["top", "egg", "stem", "coin", "turned", "balls"]


HOOP = tt.Body(mass=4e-3, shape=tt.Ring(radius=0.01, center=0.0), I1=1e-7, I3=2e-7)
OUTLINED = {**tt.presets.BODIES, "hoop": HOOP}


@pytest.mark.parametrize("body", OUTLINED.values(), ids=OUTLINED)
def test_an_outline_reaches_down_to_the_table_at_every_tilt(body: tt.Body) -> None:
    lines = outline(body.surface)
    r, z = np.concatenate(lines).T
    tilts = np.linspace(0.0, np.pi, 200)[:, None]
    lowest = (r * np.sin(tilts) - z * np.cos(tilts)).max(axis=1)
    heights = outer_height(body.surface, np.cos(tilts[:, 0]))
    assert lowest == pytest.approx(heights, abs=3e-3 * size(body))
    assert (r[0], r[-1]) == (0.0, 0.0), "it is closed by the axis"
    # Lines between surfaces that follow one another; rings are corners, and end in faces.
    rings = sum(isinstance(shape, tt.Ring) for shape in body.shapes)
    assert len(lines) == (rings + 1 if rings else 2 * len(body.shapes) - 1)


@pytest.mark.parametrize("body", BODIES, ids=NAMES)
def test_the_toy_touches_the_table_where_the_model_does(body: tt.Body) -> None:
    points = np.concatenate([part.profile for part in toy_parts(body)])
    for tilt in np.linspace(0.0, np.pi, 61):
        # The lowest point of a circle of the body with radius r at height z along the axis.
        lowest = (points[:, 1] * np.cos(tilt) - points[:, 0] * np.sin(tilt)).min()
        height = outer_height(body.surface, np.cos(tilt))
        assert lowest == pytest.approx(-height / size(body), abs=0.004)


@pytest.mark.parametrize("body", BODIES, ids=NAMES)
def test_triangles_and_normals_point_outwards(body: tt.Body) -> None:
    for part in toy_parts(body):
        mesh = lathe(part, size(body))
        a, b, c = (mesh.points[mesh.triangles[:, k]] for k in range(3))
        across = np.cross(b - a, c - a)
        assert np.linalg.norm(mesh.normals, axis=1) == pytest.approx(1.0)
        assert (np.einsum("ij,ij->i", across, mesh.normals[mesh.triangles[:, 0]]) > 0).all()


@pytest.mark.parametrize("body", BODIES, ids=NAMES)
def test_rays_meet_the_toy_where_the_triangles_are(body: tt.Body) -> None:
    """From just outside through the middle of a triangle, a ray ends there."""
    toy = Toy(body)
    for part in toy_parts(body):
        if part.opacity < 1:
            continue
        mesh = lathe(part, 1.0, 240)
        middles, normals = (
            mesh.points[mesh.triangles].mean(axis=1),
            mesh.normals[mesh.triangles].mean(axis=1),
        )
        start = middles + 0.02 * normals
        distance, normal, parts = toy.meet(start, -normals)
        assert distance.max() < FAR
        seen = np.abs(distance - 0.02) < 0.005
        assert seen.mean() > 0.85
        assert (
            np.einsum("ij,ij->i", normal, normals)[seen] > 0.9 * (normals**2).sum(axis=1)[seen]
        ).all()
        # Near the borders of a part and of its sectors, facets and surface differ.
        colours = toy.paint(start - distance[:, None] * normals, parts)[seen]
        assert (np.isin(colours, [to_rgb(colour) for colour in part.colours])).mean() > 0.9
        first = np.arctan2(middles[:, 1], middles[:, 0]) % (2 * np.pi) < 2 * np.pi / len(
            part.colours
        )
        sector = (colours == to_rgb(part.colours[0])).all(axis=1)
        assert sector[first[seen]].mean() > 0.8


def test_a_turned_body_is_drawn_as_it_was_turned() -> None:
    pieces = stated_profile(TURNED)
    assert pieces is not None
    points = np.concatenate(pieces)
    inside = (points[:, 1] > 0.0) & (points[:, 1] < 0.013) & (points[:, 0] < 0.012)
    assert points[inside, 0].min() == pytest.approx(0.125 * 25.4e-3), (
        "the spindle in the bore, no hull"
    )
    toy = Toy(TURNED)
    beside = (0.25 + 0.875) / 4 * 25.4e-3 / toy.size
    floor = points[inside, 1].min() / toy.size
    hits = toy.meet(
        np.array([[beside, 0.0, 5.0], [0.0, 0.0, 5.0]]), np.tile([0.0, 0.0, -1.0], (2, 1))
    )
    assert hits.distances == pytest.approx(
        [5.0 - floor, 5.0 - points[:, 1].max() / toy.size], abs=1e-6
    )
    assert hits.normals == pytest.approx(np.tile([0.0, 0.0, 1.0], (2, 1)), abs=1e-6)


def test_a_profile_that_is_not_of_the_surfaces_is_not_drawn() -> None:
    longer = tt.Sphere(radius=0.004, center=0.03)
    other = TURNED.model_copy(update={"shape": (TURNED.shapes[0], longer)})
    assert stated_profile(other) is None
    assert max(part.profile[:, 1].max() for part in toy_parts(other)) * size(
        other
    ) == pytest.approx(0.034)
    alone = TURNED.model_copy(update={"shape": tt.EccentricSphere(radius=0.01, eccentricity=0.1)})
    assert [part.name for part in toy_parts(alone)] == [
        part.name for part in toy_parts(tt.presets.REPORT)
    ]


def test_the_corners_of_a_disk_are_met() -> None:
    toy = Toy(COIN)
    start = np.array([[0.999, -5.0, 0.099]])
    assert toy.meet(start, np.array([[0.0, 1.0, 0.0]])).distances < FAR


def test_rays_that_pass_the_toy_by_miss_it() -> None:
    toy = Toy(tt.presets.REPORT)
    beside = toy.middle + np.array([[-5.0, 1.01, 0.0], [-5.0, 0.3, 0.6], [-5.0, 0.0, 1.01]])
    ahead = np.tile([1.0, 0.0, 0.0], (3, 1))
    assert (toy.meet(beside, ahead).distances == FAR).all(), (
        "beside the sphere, the stem, and above it"
    )
    through = toy.middle + np.array([[-5.0, 0.0, 0.6], [-5.0, 0.0, 0.99]])
    assert (toy.meet(through, ahead[:2]).distances < 5).all(), "the stem is there"


def test_the_solid_is_closed_and_holds_what_the_formulas_say() -> None:
    parts = [part for part in toy_parts(EGG) if part.opacity == 1]
    volume = 0.0
    for part in parts:
        mesh = lathe(part, size(EGG), 480)
        a, b, c = (mesh.points[mesh.triangles[:, k]] for k in range(3))
        volume += np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6
    assert volume == pytest.approx(4 / 3 * np.pi * 0.015**2 * 0.025, rel=0.01)
