"""Tables, films and models of a run hold its numbers, and are refused where they cannot be made."""

import csv
import shutil
import struct
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from PIL import Image
from scipy.spatial.transform import Rotation

import tippetop as tt
from children import posix_only
from tippetop.export import movie
from tippetop.export.glb import key_times, write_glb
from tippetop.export.html import write_html
from tippetop.export.movie import write_movie
from tippetop.export.poses import Poses, poses_at
from tippetop.export.raycast import fine_path
from tippetop.export.tables import write_csv

pygltflib = pytest.importorskip(
    "pygltflib", reason="pygltflib opens .glb files; it comes with the test extra"
)


def numbers(model: "pygltflib.GLTF2", accessor: int) -> np.ndarray:
    entry = model.accessors[accessor]
    view = model.bufferViews[entry.bufferView]
    width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[entry.type]
    kind = {5126: "<f4", 5125: "<u4"}[entry.componentType]
    return np.frombuffer(model.binary_blob(), kind, entry.count * width, view.byteOffset).reshape(
        -1, width
    )


def test_csv_holds_every_number_with_its_unit(flying: xr.Dataset, tmp_path: Path) -> None:
    path = write_csv(flying, tmp_path / "run.csv")
    with path.open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == flying.sizes["time"]
    assert [float(row["tilt (rad)"]) for row in rows] == flying["tilt"].values.tolist()
    assert [float(row["velocity_z (m s-1)"]) for row in rows] == flying["velocity"].values[
        :, 2
    ].tolist()
    assert {row["mode"] for row in rows} == {"sliding", "flight"}


def test_csv_leaves_what_is_not_a_number_empty(tmp_path: Path) -> None:
    run = tt.simulate(tt.presets.report_problem(spin=10.0, tilt=0.0), 0.1, samples=3)
    with write_csv(run, tmp_path / "run.csv").open(newline="", encoding="utf-8") as file:
        assert next(csv.DictReader(file))["precession (rad s-1)"] == ""


def test_glb_plays_the_run(flying: xr.Dataset, tmp_path: Path) -> None:
    path = write_glb(flying, tmp_path / "run.glb")
    model = pygltflib.GLTF2().load(str(path))
    (animation,) = model.animations
    moves, turns = animation.samplers
    times = numbers(model, moves.input)[:, 0]
    exact = poses_at(flying, times)
    assert times[-1] == pytest.approx(float(flying["time"][-1]))
    assert numbers(model, moves.output) == pytest.approx(exact.positions, abs=1e-7)
    quaternions = numbers(model, turns.output)
    overlap = np.einsum("ij,ij->i", quaternions, exact.turns.as_quat())
    assert np.abs(overlap) == pytest.approx(1.0, abs=1e-5)
    steps = np.einsum("ij,ij->i", quaternions[1:], quaternions[:-1])
    assert (steps > np.cos(0.3)).all(), "the shortest way between two keys is the way the top turns"


def test_films_and_models_of_a_part_of_a_run_begin_where_it_does(
    flying: xr.Dataset, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    part = flying.isel(time=slice(flying.sizes["time"] // 2, None))
    start, end = part["time"].values[[0, -1]]
    model = pygltflib.GLTF2().load(str(write_glb(part, tmp_path / "part.glb")))
    moves, _ = model.animations[0].samplers
    times = numbers(model, moves.input)[:, 0]
    assert times[[0, -1]] == pytest.approx([0.0, end - start])
    exact = poses_at(flying, np.linspace(start, end, len(times)))
    assert numbers(model, moves.output) == pytest.approx(exact.positions, abs=1e-5)
    drawn = list[np.ndarray]()

    def seen(run: xr.Dataset, times: np.ndarray) -> Poses:
        drawn.append(times)
        return poses_at(run, times)

    monkeypatch.setattr("tippetop.export.movie.poses_at", seen)
    write_movie(part, tmp_path / "part.gif", frame_rate=10.0, pixels=(96, 72))
    assert drawn[0] == pytest.approx(start + 0.1 * np.arange(len(drawn[0])))
    assert end - 0.1 < drawn[0][-1] <= end


def test_a_run_that_ended_at_its_launch_is_a_still_model(tmp_path: Path) -> None:
    launch = tt.Launch(tilt=1.5, spin=155.0, precession=100.0)
    contact = tt.Contact(liftoff="stop")
    problem = tt.presets.report_problem().model_copy(update={"launch": launch, "contact": contact})
    run = tt.simulate(problem, 20.0)
    assert float(run["time"][-1]) == 0.0
    model = pygltflib.GLTF2().load(str(write_glb(run, tmp_path / "run.glb")))
    assert not model.animations
    assert model.nodes[1].translation[2] > 0
    assert write_movie(run, tmp_path / "run.gif", pixels=(32, 32)).stat().st_size > 100


def test_glb_is_a_model_in_metres_with_y_up(flying: xr.Dataset, tmp_path: Path) -> None:
    path = write_glb(flying, tmp_path / "run.glb")
    magic, version, length = struct.unpack("<4sII", path.read_bytes()[:12])
    assert (magic, version, length) == (b"glTF", 2, path.stat().st_size)
    model = pygltflib.GLTF2().load(str(path))
    root = Rotation.from_quat(model.nodes[model.scenes[0].nodes[0]].rotation)
    assert root.apply([0.0, 0.0, 1.0]) == pytest.approx([0, 1, 0], abs=1e-12)
    toy = model.meshes[model.nodes[1].mesh]
    corners = np.concatenate(
        [numbers(model, primitive.attributes.POSITION) for primitive in toy.primitives]
    )
    assert np.linalg.norm(corners, axis=1).max() == pytest.approx(1.3 * 0.02, rel=1e-6)
    for primitive in toy.primitives:
        assert (
            numbers(model, primitive.indices).max()
            < model.accessors[primitive.attributes.POSITION].count
        )


def test_a_run_with_too_many_keys_is_refused(
    flying: xr.Dataset, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("tippetop.export.glb.MOST_KEYS", 100)
    with pytest.raises(tt.InvalidInput, match="duration"):
        key_times(flying, tt.presets.REPORT)


@pytest.fixture(scope="module")
def short() -> xr.Dataset:
    return tt.simulate(tt.presets.report_problem(spin=155.0), 0.5, samples=201)


def test_gif_has_a_picture_for_every_moment(short: xr.Dataset, tmp_path: Path) -> None:
    told: list[tuple[int, int]] = []
    path = write_movie(
        short,
        tmp_path / "run.gif",
        frame_rate=10.0,
        pixels=(96, 72),
        progress=lambda *so_far: told.append(so_far),
    )
    assert told == [(number, len(told)) for number in range(1, len(told) + 1)]
    with Image.open(path) as film:
        assert film.size == (96, 72)
        assert film.n_frames == 6
        assert film.info["duration"] == 100


@pytest.mark.skipif(
    shutil.which("ffmpeg") is None, reason="ffmpeg makes .mp4 files and is not on the PATH"
)
def test_mp4_is_written_whole(short: xr.Dataset, tmp_path: Path) -> None:
    path = write_movie(short, tmp_path / "run.mp4", frame_rate=10.0, pixels=(96, 72))
    assert path.read_bytes()[4:8] == b"ftyp"
    assert [entry.name for entry in tmp_path.iterdir()] == ["run.mp4"]


def test_mp4_without_ffmpeg_is_refused_with_a_way_out(
    short: xr.Dataset, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(tt.Unavailable, match=r"ffmpeg.*\.gif"):
        write_movie(short, tmp_path / "run.mp4")


@posix_only
def test_what_ffmpeg_says_is_passed_on(
    short: xr.Dataset, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    fake = tmp_path / "ffmpeg"
    fake.write_text("#!/bin/sh\necho no such codec >&2\nexit 3\n")
    fake.chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}:/bin:/usr/bin")
    with pytest.raises(tt.FileTrouble, match="no such codec"):
        write_movie(short, tmp_path / "run.mp4", pixels=(96, 72))
    assert [entry.name for entry in tmp_path.iterdir()] == ["ffmpeg"]


@pytest.mark.parametrize(
    "wrong",
    [{"frame_rate": 0.0}, {"speed": -1.0}, {"pixels": (97, 72)}, {"speed": 1e-9}],
    ids=str,
)
def test_films_that_cannot_be_are_refused(
    short: xr.Dataset, tmp_path: Path, wrong: dict[str, object]
) -> None:
    with pytest.raises(tt.InvalidInput):
        write_movie(short, tmp_path / "run.gif", **wrong)
    with pytest.raises(tt.InvalidInput, match=r"\.mp4 or \.gif"):
        write_movie(short, tmp_path / "run.avi")


def test_the_film_shows_the_top_where_it_is(short: xr.Dataset) -> None:
    (drawn, *_) = movie.frames(short, 10.0, 1.0, (160, 120))
    paint = drawn.astype(float)
    blue = (paint[..., 2] > paint[..., 0] + 40).nonzero()
    assert abs(blue[1].mean() - 80) < 12, "the toy is in the middle"
    assert 300 < len(blue[0]) < 6000, "and of a size to be seen"


@pytest.mark.parametrize("write", [write_csv, write_glb, write_html, write_movie])
def test_a_file_that_exists_is_kept_unless_told_otherwise(
    short: xr.Dataset, tmp_path: Path, write
) -> None:  # type: ignore[no-untyped-def]
    suffix = "gif" if write is write_movie else write.__name__.removeprefix("write_")
    path = tmp_path / f"run.{suffix}"
    path.write_text("mine")
    with pytest.raises(tt.FileTrouble, match="overwrite=True"):
        write(short, path)
    assert path.read_text() == "mine"
    options = {"frame_rate": 2.0, "pixels": (32, 32)} if write is write_movie else {}
    write(short, path, True, **options)
    assert path.stat().st_size > 100


@pytest.mark.parametrize(("asked", "each"), [(30.0, 30), (20.0, 50), (240.0, 20), (7.0, 140)])
def test_a_gif_plays_in_time_at_any_rate(
    short: xr.Dataset, tmp_path: Path, asked: float, each: int
) -> None:
    with Image.open(
        write_movie(short, tmp_path / "run.gif", frame_rate=asked, pixels=(32, 32))
    ) as film:
        assert film.info["duration"] == each
        total = sum(_shown(film, number) for number in range(film.n_frames))
    assert 500 < total <= 500 + each


def _shown(film: Image.Image, number: int) -> int:
    film.seek(number)
    return int(film.info["duration"])


def test_the_trace_of_a_film_stops_where_the_top_flies(flying: xr.Dataset) -> None:
    touching = flying["normal_force"].values != 0.0
    assert not touching.all()
    trace = flying[["x", "y"]].to_array().values.T / 0.02
    path, reached = fine_path(trace, touching)
    drawn = np.diff(reached) > 0
    assert (drawn == (touching[1:] & touching[:-1])).all()
    assert len(path) == reached[-1]
