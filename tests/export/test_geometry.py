import numpy as np
import pytest

import tippetop as tt
from tippetop.export import geometry
from tippetop.mechanics.surface import contact_vector

EGG = tt.Body(mass=0.02, shape=tt.Spheroid(across=0.015, along=0.025), I1=4e-6, I3=2e-6)
BODIES = [tt.presets.REPORT, EGG]


@pytest.mark.parametrize("body", BODIES, ids=["top", "egg"])
def test_the_toy_touches_the_table_where_the_model_does(body: tt.Body) -> None:
    points = np.concatenate([part.profile for part in geometry.toy_parts(body)])
    for tilt in np.linspace(0.0, np.pi, 61):
        axis = (np.sin(tilt), 0.0, np.cos(tilt))
        # The lowest point of a circle of the body with radius r at height z along the axis.
        lowest = (points[:, 1] * np.cos(tilt) - points[:, 0] * np.sin(tilt)).min()
        assert lowest == pytest.approx(
            contact_vector(axis, body.shape.surface)[2], abs=0.004 * geometry.size(body)
        )


@pytest.mark.parametrize("body", BODIES, ids=["top", "egg"])
def test_triangles_and_normals_point_outwards(body: tt.Body) -> None:
    for part in geometry.toy_parts(body):
        mesh = geometry.lathe(part)
        a, b, c = (mesh.points[mesh.triangles[:, k]] for k in range(3))
        across = np.cross(b - a, c - a)
        assert np.linalg.norm(mesh.normals, axis=1) == pytest.approx(1.0)
        assert (np.einsum("ij,ij->i", across, mesh.normals[mesh.triangles[:, 0]]) > 0).all()


def test_the_solid_is_closed_and_holds_what_the_formulas_say() -> None:
    parts = [part for part in geometry.toy_parts(EGG) if part.opacity == 1]
    mesh = geometry.joined([geometry.lathe(part, 480) for part in parts])
    a, b, c = (mesh.points[mesh.triangles[:, k]] for k in range(3))
    volume = np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6
    assert volume == pytest.approx(4 / 3 * np.pi * 0.015**2 * 0.025, rel=0.01)


def test_reach_is_the_farthest_point_of_the_surface() -> None:
    radius, eccentricity = tt.presets.REPORT.shape.radius, tt.presets.REPORT.shape.eccentricity
    assert geometry.reach(tt.presets.REPORT) == pytest.approx(radius * (1 + eccentricity))
