"""Solids for printing: closed, and as heavy as the profile says, to the error of their facets."""

import numpy as np
import pytest

import tippetop as tt
from tippetop.export.solid import solids

trimesh = pytest.importorskip(
    "trimesh", reason="solids are written with trimesh; it comes with the lathe extra"
)

TOP = tt.Workpiece(
    unit="mm",
    density=700.0,
    profile=[(0, -15), (15, 0, 15), (9, 12, 15), (2.5, 12), (2.5, 16), (0, 18.5, 2.5)],
    inserts=[
        {"profile": [(0, 0), (7, 7, 7), (7, 9), (0, 9)], "density": 0.0},
        {"profile": [(0, -10), (0, -6, 2)], "density": 8000.0},
        {"profile": [(11, 0), (12, 1, 1), (10, 1, 1), (11, 0, 1)], "density": 8000.0},
        {"profile": [(0, -9), (0, -8, 0.5)], "density": 0.0},
    ],
)
RING = tt.Workpiece(density=1.0, profile=[(0.02, 0), (0.02, 0.01, 0.005), (0.02, 0, 0.005)])
CONE = tt.Workpiece(density=1.0, profile=[(0, 0), (0.01, 0.02), (0, 0.02)])


def weighed(loaded, densities):
    """Mass, height of the centre of mass, I1 and I3 of meshes in millimetres."""
    masses = np.array(
        [rho * mesh.volume * 1e-9 for mesh, rho in zip(loaded, densities, strict=True)]
    )
    heights = np.array([mesh.center_mass[2] * 1e-3 for mesh in loaded])
    center = (masses @ heights) / masses.sum()
    found = np.zeros(2)
    for mesh, rho, mass, height in zip(loaded, densities, masses, heights, strict=True):
        inertia = rho * mesh.moment_inertia * 1e-15
        found += [inertia[0, 0] + mass * (height - center) ** 2, inertia[2, 2]]
    return np.array([masses.sum(), center, *found])


@pytest.mark.parametrize("piece", [TOP, RING, CONE], ids=["top", "ring", "cone"])
def test_files_are_closed_and_converge_at_second_order(tmp_path, piece):
    densities = [piece.density, *(insert.density for insert in piece.inserts if insert.density)]
    exact = np.array(piece.mass_properties)
    errors = []
    for facets in (24, 48, 96):
        tt.write_solid(piece, tmp_path / f"{facets}.3mf", facets=facets)
        scene = trimesh.load(tmp_path / f"{facets}.3mf")
        assert scene.units == "millimeter"
        meshes = list(scene.geometry.values())
        assert all(mesh.is_watertight and mesh.is_winding_consistent for mesh in meshes)
        assert all(mesh.volume > 0 for mesh in meshes)
        errors.append(np.abs(weighed(meshes, densities) - exact))
    amounts = np.array(errors)[:, [0, 2, 3]]
    assert np.log2(amounts[:-1] / amounts[1:]) == pytest.approx(np.full((2, 3), 2.0), abs=0.2)
    assert errors[-1][1] < 1e-3 * piece.outline.size


def test_stl_is_the_body_alone(tmp_path):
    tt.write_solid(TOP, tmp_path / "top.stl", facets=96)
    mesh = trimesh.load(tmp_path / "top.stl")
    assert mesh.is_watertight
    assert mesh.bounds[:, 2] == pytest.approx([-15.0, 18.5])
    assert mesh.volume == pytest.approx(solids(TOP, 96)["body"].volume, rel=1e-6)
    hollow = TOP.model_copy(
        update={"inserts": [{"profile": i.profile, "density": 0} for i in TOP.inserts[:3]]}
    )
    assert mesh.volume * 1e-9 * TOP.density == pytest.approx(hollow.mass_properties.mass, rel=5e-3)


def test_what_cannot_be_printed_is_refused_and_nothing_is_left(tmp_path):
    flush = TOP.model_copy(
        update={"inserts": [{"profile": [(0, -15), (15, 0, 15), (0, 0)], "density": 1e3}]}
    )
    with pytest.raises(tt.InvalidInput, match="an insert that touches a surface"):
        tt.write_solid(flush, tmp_path / "a.stl")
    with pytest.raises(tt.InvalidInput, match=r"ends in \.stl or \.3mf"):
        tt.write_solid(TOP, tmp_path / "a.obj")
    with pytest.raises(tt.InvalidInput, match="facets: 3"):
        tt.write_solid(TOP, tmp_path / "a.stl", facets=3)
    assert list(tmp_path.iterdir()) == []
    (tmp_path / "a.stl").write_text("mine")
    with pytest.raises(tt.FileTrouble, match="exists"):
        tt.write_solid(TOP, tmp_path / "a.stl")
    assert (tmp_path / "a.stl").read_text() == "mine"
    tt.write_solid(TOP, tmp_path / "a.stl", overwrite=True)


def test_without_trimesh_it_is_said_what_to_install(tmp_path, monkeypatch):
    monkeypatch.setattr("tippetop.export.solid.find_spec", lambda name: None)
    with pytest.raises(tt.Unavailable, match=r"\[lathe\]"):
        tt.write_solid(CONE, tmp_path / "a.stl")
